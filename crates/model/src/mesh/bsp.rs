//! Cuts a closed solid into convex cells along the planes of its own faces, as a binary space partition does. The result is exact: the
//! cells fill the solid, and nothing else.

use super::faces::{ConvexPart, Face};
use super::hull::{MAX_FACES, hull, sound};
use super::vectors::{Point, across, add_scaled, bounds, cross, dot, middle, norm, polygon_area_vector, sub};
use super::{BOX_FACES, Mesh, box_corners};
use crate::math;

/// Distance from a plane within which a point is on it, m (estimate: below the flatness of merged faces).
const ON_PLANE_M: f64 = 2e-4;
/// Minimum area of a face's piece, m² (estimate: rounding errors leave narrow pieces beside a cut).
const MIN_AREA_M2: f64 = 1e-8;
/// Minimum thickness of a cell, m (estimate).
const MIN_THICKNESS_M: f64 = 1e-3;
/// Maximum number of planes that are compared for each cut (estimate: enough for members with flanges, ribs and openings).
const MAX_CANDIDATES: usize = 48;
/// A plane: outward unit normal and offset, m.
type Plane = (Point, f64);

/// A piece of a face of the solid, inside a cell.
#[derive(Debug, Clone)]
struct Piece {
    plane: Plane,
    corners_m: Vec<Point>,
}

/// A convex cell: its faces, counterclockwise seen from outside.
#[derive(Debug, Clone)]
struct Cell {
    faces_m: Vec<Vec<Point>>,
}

/// Cuts a closed solid with these faces into convex parts. Returns `None` if there would be more than `max_parts`.
pub(super) fn convex_cells(mesh: &Mesh, faces: &[Face], max_parts: usize) -> Option<Vec<ConvexPart>> {
    let (low, high) = mesh.bounds()?;
    let pieces: Vec<Piece> = faces
        .iter()
        .flat_map(|face| {
            let corner = |k: usize| mesh.vertices_m[face.corners[k] as usize];
            // Faces need not be convex, but their triangles are.
            triangulated(face, mesh)
                .into_iter()
                .map(move |corners| Piece { plane: (face.normal, face.offset_m), corners_m: corners.map(corner).to_vec() })
        })
        .collect();
    // Pieces in the sides of the first cell need no cut.
    let is_on_side = |p: &Point, k: usize| (p[k] - low[k]).min(high[k] - p[k]) <= ON_PLANE_M;
    let is_on_first_cell =
        |piece: &Piece| (0..3).any(|k| piece.plane.0[k].abs() > 0.5 && piece.corners_m.iter().all(|p| is_on_side(p, k)));
    let pieces: Vec<Piece> = pieces.into_iter().filter(|piece| !is_on_first_cell(piece)).collect();
    let mut waiting = vec![(Cell::around(low, high), pieces)];
    let mut solid: Vec<Cell> = Vec::new();
    let max_cells = 16 * max_parts;
    let mut cells = 0;
    while let Some((cell, pieces)) = waiting.pop() {
        cells += 1;
        if cells > max_cells || solid.len() > 4 * max_parts {
            return None;
        }
        let Some(plane) = best_plane(&cell, &pieces) else {
            if is_inside(mesh, middle(&cell.corners())) {
                solid.push(cell);
            }
            continue;
        };
        let (behind, before) = cell.cut(plane);
        let (behind_pieces, before_pieces) = divide(pieces, plane);
        waiting.extend(before.map(|cell| (cell, before_pieces)));
        waiting.extend(behind.map(|cell| (cell, behind_pieces)));
    }
    let parts: Vec<ConvexPart> = merged(solid).iter().filter_map(Cell::part).collect();
    let are_simple = parts.iter().all(|part| part.faces.len() <= MAX_FACES);
    (!parts.is_empty() && parts.len() <= max_parts && are_simple).then_some(parts)
}

/// Divides a face into triangles by clipping ears. Returns positions in the face's list of corners.
fn triangulated(face: &Face, mesh: &Mesh) -> Vec<[usize; 3]> {
    let point = |k: usize| mesh.vertices_m[face.corners[k] as usize];
    let turn = |a: usize, b: usize, c: usize| dot(cross(sub(point(b), point(a)), sub(point(c), point(b))), face.normal);
    let mut left: Vec<usize> = (0..face.corners.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let is_ear = |k: usize| {
            let (a, b, c) = (left[(k + n - 1) % n], left[k], left[(k + 1) % n]);
            let inside = |p: usize| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            turn(a, b, c) > 0.0 && left.iter().all(|p| [a, b, c].contains(p) || !inside(*p))
        };
        // Without an ear, the rest has no area worth a cut.
        let ear = (0..n).find(|k| is_ear(*k)).unwrap_or(0);
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    triangles.extend(<[usize; 3]>::try_from(left).ok());
    triangles
}

/// Returns the plane that cuts the fewest pieces, and of those the one with the smallest cut that is not a face of the solid; `None`
/// without pieces.
fn best_plane(cell: &Cell, pieces: &[Piece]) -> Option<Plane> {
    let mut candidates: Vec<(f64, Plane)> = Vec::new();
    for piece in pieces {
        let area = area_m2(&piece.corners_m);
        match candidates.iter_mut().find(|(_, plane)| *plane == piece.plane) {
            Some((sum, _)) => *sum += area,
            None => candidates.push((area, piece.plane)),
        }
    }
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
    candidates.truncate(MAX_CANDIDATES);
    let cuts = |plane: Plane| pieces.iter().filter(|piece| is_cut(piece, plane)).count();
    let rated = candidates.into_iter().map(|(area, plane)| (cuts(plane), cell.cut_area_m2(plane) - area, plane));
    rated.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|best| best.2)
}

fn height_m(p: Point, (normal, offset_m): Plane) -> f64 {
    dot(normal, p) - offset_m
}

fn is_cut(piece: &Piece, plane: Plane) -> bool {
    let heights = || piece.corners_m.iter().map(|p| height_m(*p, plane));
    heights().any(|h| h > ON_PLANE_M) && heights().any(|h| h < -ON_PLANE_M)
}

/// Divides pieces into those behind and those before a plane. Pieces in the plane are done.
fn divide(pieces: Vec<Piece>, plane: Plane) -> (Vec<Piece>, Vec<Piece>) {
    let (mut behind, mut before) = (Vec::new(), Vec::new());
    for piece in pieces {
        let (back, front) = cut_polygon(&piece.corners_m, plane);
        let keep = |corners_m: Vec<Point>| {
            (corners_m.len() >= 3 && area_m2(&corners_m) > MIN_AREA_M2).then_some(Piece { plane: piece.plane, corners_m })
        };
        let is_in_plane = piece.corners_m.iter().all(|p| height_m(*p, plane).abs() <= ON_PLANE_M);
        if !is_in_plane && piece.plane != plane {
            behind.extend(keep(back));
            before.extend(keep(front));
        }
    }
    (behind, before)
}

/// Returns the parts of a convex polygon behind and before a plane. Points on the plane belong to both.
fn cut_polygon(corners_m: &[Point], plane: Plane) -> (Vec<Point>, Vec<Point>) {
    let (mut back, mut front) = (Vec::new(), Vec::new());
    for (k, a) in corners_m.iter().enumerate() {
        let b = corners_m[(k + 1) % corners_m.len()];
        let (at_a, at_b) = (height_m(*a, plane), height_m(b, plane));
        if at_a <= ON_PLANE_M {
            back.push(*a);
        }
        if at_a >= -ON_PLANE_M {
            front.push(*a);
        }
        if (at_a > ON_PLANE_M && at_b < -ON_PLANE_M) || (at_a < -ON_PLANE_M && at_b > ON_PLANE_M) {
            // Always from the lower to the higher end, so that both polygons at an edge get the same bits.
            let (low, high, at_low, at_high) = if at_a < at_b { (*a, b, at_a, at_b) } else { (b, *a, at_b, at_a) };
            let crossing = add_scaled(low, sub(high, low), at_low / (at_low - at_high));
            back.push(crossing);
            front.push(crossing);
        }
    }
    let lies_flat = |polygon: &[Point]| polygon.iter().all(|p| height_m(*p, plane).abs() <= ON_PLANE_M);
    if lies_flat(&back) {
        back.clear();
    }
    if lies_flat(&front) {
        front.clear();
    }
    (back, front)
}

fn area_m2(corners_m: &[Point]) -> f64 {
    0.5 * norm(polygon_area_vector(corners_m))
}

/// Returns whether a point is inside a closed mesh: the mesh fills the full solid angle around it.
fn is_inside(mesh: &Mesh, p: Point) -> bool {
    let solid_angle = |triangle: &[u32; 3]| {
        let [a, b, c] = mesh.corners(*triangle).map(|corner| sub(corner, p));
        let (la, lb, lc) = (norm(a), norm(b), norm(c));
        let divisor = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * math::atan2(dot(a, cross(b, c)), divisor)
    };
    mesh.triangles.iter().map(solid_angle).sum::<f64>() > math::TAU
}

impl Cell {
    fn around(low: Point, high: Point) -> Self {
        let corners = box_corners(low, high);
        Self { faces_m: BOX_FACES.iter().map(|face| face.map(|k| corners[k as usize]).to_vec()).collect() }
    }

    fn corners(&self) -> Vec<Point> {
        distinct(self.faces_m.iter().flatten())
    }

    /// Returns the parts behind and before a plane; `None` for a part without volume.
    fn cut(self, plane: Plane) -> (Option<Self>, Option<Self>) {
        let heights = || self.faces_m.iter().flatten().map(|p| height_m(*p, plane));
        if heights().all(|h| h <= ON_PLANE_M) {
            return (Some(self), None);
        }
        if heights().all(|h| h >= -ON_PLANE_M) {
            return (None, Some(self));
        }
        let (mut behind, mut before) = (Vec::new(), Vec::new());
        for face in &self.faces_m {
            let (back, front) = cut_polygon(face, plane);
            behind.extend((back.len() >= 3).then_some(back));
            before.extend((front.len() >= 3).then_some(front));
        }
        let rim = rim(&behind, plane);
        if rim.len() >= 3 {
            before.push(rim.iter().rev().copied().collect());
            behind.push(rim);
        }
        (Some(Self { faces_m: behind }), Some(Self { faces_m: before }))
    }

    /// Returns the area of the cut along a plane, m².
    fn cut_area_m2(&self, plane: Plane) -> f64 {
        let behind: Vec<Vec<Point>> = self.faces_m.iter().map(|face| cut_polygon(face, plane).0).collect();
        area_m2(&rim(&behind, plane))
    }

    /// Returns the cell as a convex part with shared corners; `None` if it is too thin.
    fn part(&self) -> Option<ConvexPart> {
        let corners_m = self.corners();
        let index = |p: &Point| corners_m.iter().position(|known| is_same(known, p));
        let mut faces: Vec<Vec<u32>> = Vec::new();
        for face in &self.faces_m {
            let mut corners: Vec<u32> = face.iter().filter_map(index).map(|k| k as u32).collect();
            corners.dedup();
            if corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            if corners.len() >= 3 {
                faces.push(corners);
            }
        }
        let part = ConvexPart { corners_m, faces };
        if part.faces.len() < 4 || !part.mesh().is_thicker_than(MIN_THICKNESS_M) {
            return None;
        }
        // Where rounding has merged corners, a hull closes the gap.
        sound(part)
    }

    fn volume_m3(&self) -> f64 {
        let Some(origin) = self.faces_m.first().and_then(|face| face.first()).copied() else { return 0.0 };
        let of_face = |face: &Vec<Point>| dot(polygon_area_vector(face), sub(face[0], origin)) / 6.0;
        self.faces_m.iter().map(of_face).sum()
    }
}

/// Returns whether two corners are one, but for rounding errors.
fn is_same(a: &Point, b: &Point) -> bool {
    norm(sub(*a, *b)) <= 0.5 * ON_PLANE_M
}

/// Returns each point that is not the same as one before it.
fn distinct<'a>(points: impl Iterator<Item = &'a Point>) -> Vec<Point> {
    let mut found: Vec<Point> = Vec::new();
    for p in points {
        if !found.iter().any(|known| is_same(known, p)) {
            found.push(*p);
        }
    }
    found
}

/// Returns the corners of the cut through a convex cell, counterclockwise seen from before the plane.
fn rim(faces_m: &[Vec<Point>], plane: Plane) -> Vec<Point> {
    let mut points = distinct(faces_m.iter().flatten().filter(|p| height_m(**p, plane).abs() <= ON_PLANE_M));
    let (center, [u, v]) = (middle(&points), across(plane.0));
    let angle = |p: &Point| {
        let away = sub(*p, center);
        math::atan2(dot(away, v), dot(away, u))
    };
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}

/// Joins cells whose union is convex, until there are no more.
fn merged(mut cells: Vec<Cell>) -> Vec<Cell> {
    let mut at = 0;
    while at < cells.len() {
        // A cell that has grown may also join one before it.
        let union = (0..cells.len()).filter(|k| *k != at).find_map(|k| Some((k, joined(&cells[at], &cells[k])?)));
        match union {
            Some((k, cell)) => {
                cells[at] = cell;
                cells.remove(k);
                at -= usize::from(k < at);
            }
            None => at += 1,
        }
    }
    cells
}

/// Returns the union of two cells if they touch and it is convex.
fn joined(a: &Cell, b: &Cell) -> Option<Cell> {
    let reach = |cell: &Cell| bounds(cell.faces_m.iter().flatten().copied());
    let ((a_low, a_high), (b_low, b_high)) = (reach(a)?, reach(b)?);
    if (0..3).any(|k| a_low[k] > b_high[k] + ON_PLANE_M || b_low[k] > a_high[k] + ON_PLANE_M) {
        return None;
    }
    let whole = hull(&[a.corners(), b.corners()].concat())?;
    let faces_m = whole.faces.iter().map(|face| face.iter().map(|k| whole.corners_m[*k as usize]).collect()).collect();
    let union = Cell { faces_m };
    let (whole, parts) = (union.volume_m3(), a.volume_m3() + b.volume_m3());
    // The gap must be thinner than a merged face's flatness.
    let surface_m2: f64 = union.faces_m.iter().map(|face| area_m2(face)).sum();
    (whole - parts <= 0.1 * ON_PLANE_M * surface_m2).then_some(union)
}

#[cfg(test)]
mod tests {
    use super::super::faces::faces;
    use super::super::topology::{Component, components};
    use super::super::weld::weld;
    use super::*;

    /// Tolerance for rounding errors of volumes, m³.
    const VOLUME_TOLERANCE_M3: f64 = 1e-6;

    /// Returns a prism with an outline in the y-z plane, counterclockwise seen from +x.
    fn prism(outline: &[[f64; 2]], length_m: f64) -> Component {
        let n = outline.len() as u32;
        let at = |x: f64| outline.iter().map(move |p| [x, p[0], p[1]]);
        let vertices_m: Vec<Point> = at(length_m).chain(at(0.0)).collect();
        let end = Face { corners: (0..n).collect(), normal: [1.0, 0.0, 0.0], offset_m: length_m };
        let mut mesh = Mesh { vertices_m, triangles: Vec::new() };
        let ends: Vec<[u32; 3]> = triangulated(&end, &mesh).into_iter().map(|t| t.map(|k| k as u32)).collect();
        mesh.triangles.extend(ends.iter().flat_map(|[a, b, c]| [[*a, *b, *c], [n + a, n + c, n + b]]));
        for k in 0..n {
            let next = (k + 1) % n;
            mesh.triangles.extend([[next, k, n + k], [next, n + k, n + next]]);
        }
        components(&weld(&mesh).mesh).swap_remove(0)
    }

    fn volumes(part: &Component) -> Vec<f64> {
        let cells = convex_cells(&part.mesh, &faces(part), 64).unwrap();
        let mut volumes: Vec<f64> = cells.iter().map(|cell| cell.mesh().volume_m3()).collect();
        volumes.sort_by(f64::total_cmp);
        volumes
    }

    #[track_caller]
    fn assert_volumes(part: &Component, expected: &[f64]) {
        let found = volumes(part);
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < VOLUME_TOLERANCE_M3);
        assert!(found.len() == expected.len() && near, "{found:?}");
    }

    #[test]
    fn exact_an_i_girder_becomes_two_flanges_and_a_web() {
        let (b, h, t, w) = (0.2, 0.8, 0.03, 0.01);
        let right = [[-b, -h], [b, -h], [b, t - h], [w, t - h], [w, h - t], [b, h - t], [b, h]];
        let left = [[-b, h], [-b, h - t], [-w, h - t], [-w, t - h], [-b, t - h]];
        let girder = prism(&[&right[..], &left[..]].concat(), 30.0);
        let flange = 2.0 * b * t * 30.0;
        assert_volumes(&girder, &[flange, flange, 2.0 * w * (2.0 * h - 2.0 * t) * 30.0]);
    }

    #[test]
    fn exact_an_angle_and_a_trough_fill_the_same_volume() {
        let angle = prism(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]], 2.0);
        let found = volumes(&angle);
        assert!(found.len() == 2 && (found.iter().sum::<f64>() - 12.0).abs() < VOLUME_TOLERANCE_M3, "{found:?}");
        let trough =
            prism(&[[-2.0, 0.0], [2.0, 0.0], [3.0, 2.0], [2.8, 2.0], [1.9, 0.2], [-1.9, 0.2], [-2.8, 2.0], [-3.0, 2.0]], 5.0);
        let found = volumes(&trough);
        let whole = trough.mesh.volume_m3();
        assert!(found.len() == 3 && (found.iter().sum::<f64>() - whole).abs() < VOLUME_TOLERANCE_M3, "{found:?} {whole}");
    }
}
