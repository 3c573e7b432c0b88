//! Turns connected parts of a mesh into shapes for collisions: convex solids where they fit, and otherwise the triangles themselves.

use super::Mesh;
use super::bsp;
use super::faces::ConvexPart;
use super::faces::faces;
use super::hull::{CONVEX_TOLERANCE_M, MAX_FACES, hull, own_faces, sound};
use super::plane_solid::PlaneSolid;
use super::surface_mesh::SurfaceMesh;
use super::topology::Component;
use super::vectors::{Point, dot, middle};
use super::vertex_colors::ColorsByPlace;
use rapier3d::parry::math::Vector;
use rapier3d::parry::transformation::vhacd::{VHACD, VHACDParameters};
use std::borrow::Cow;

/// Number of extreme points of a simplified hull: a hull of n points has at most 2 n triangles.
const EXTREME_POINTS: usize = MAX_FACES / 2;
/// Maximum number of planar faces of a part that is cut exactly; a part with more keeps its triangles, or becomes voxels (estimate: 1 s of work).
const MAX_EXACT_FACES: usize = 1_500;
/// Maximum number of convex parts that replace one connected part.
pub const MAX_PARTS: usize = 256;
/// Share of the volume that the approximation by voxels may add to a convex part (estimate: a curved, rough rib of 60 m becomes 19 parts
/// that deviate by 0.11 m; with parry's default of 0.01, 8 parts that deviate by 0.27 m).
const VOXEL_CONCAVITY: f64 = 0.002;
/// Maximum number of points at which the deviation is measured.
const MAX_SAMPLES: usize = 20_000;

/// Angle between two points of a spiral that covers a sphere evenly, rad.
const GOLDEN_ANGLE_RAD: f64 = 2.399_963_229_728_653;

/// How the shapes of a part were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The part is convex: its own faces.
    Convex,
    /// The part is nearly convex, or a convex part with holes: its hull.
    Hull,
    /// Cut along its own faces: exact.
    Cut,
    /// Its own triangles: exact.
    Mesh,
    /// Approximated by the hulls of groups of voxels.
    Voxels,
    /// The surface of the voxels that contain the points of a cloud.
    Points,
}

impl Method {
    /// Returns the word for tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Convex => "convex",
            Self::Hull => "hull",
            Self::Cut => "cut",
            Self::Mesh => "mesh",
            Self::Voxels => "voxels",
            Self::Points => "points",
        }
    }
}

/// A shape that collides.
#[derive(Debug, Clone, PartialEq)]
pub enum PartShape {
    /// A convex solid.
    Convex(ConvexPart),
    /// Triangles.
    Mesh(SurfaceMesh),
}

impl PartShape {
    /// Returns the corners, m.
    #[must_use]
    pub fn corners_m(&self) -> &[Point] {
        match self {
            Self::Convex(solid) => &solid.corners_m,
            Self::Mesh(surface) => &surface.mesh().vertices_m,
        }
    }

    /// Returns the triangles.
    #[must_use]
    pub fn mesh(&self) -> Cow<'_, Mesh> {
        match self {
            Self::Convex(solid) => Cow::Owned(solid.mesh()),
            Self::Mesh(surface) => Cow::Borrowed(surface.mesh()),
        }
    }

    /// Applies a function to each corner.
    pub fn move_corners(&mut self, place: impl Fn(Point) -> Point) {
        match self {
            Self::Convex(solid) => solid.corners_m.iter_mut().for_each(|corner| *corner = place(*corner)),
            Self::Mesh(surface) => surface.move_vertices(place),
        }
    }

    /// Sets the colors of a mesh's vertices by their places. Convex solids have no colors: their elements determine how they look.
    pub fn set_colors(&mut self, table: &ColorsByPlace) {
        match self {
            Self::Convex(_) => {}
            Self::Mesh(surface) => surface.set_colors(table),
        }
    }

    /// Returns a shape that can be read again after its corners were rounded to 32-bit floats, as in a file; `None` if nothing is left of
    /// it then.
    #[must_use]
    pub fn sound(self) -> Option<Self> {
        match self {
            Self::Convex(solid) => sound(solid).map(Self::Convex),
            Self::Mesh(surface) => surface.rounded().map(Self::Mesh),
        }
    }
}

/// Shapes that replace a connected part.
#[derive(Debug, Clone, PartialEq)]
pub struct PartShapes {
    /// The shapes.
    pub parts: Vec<PartShape>,
    /// How they were made.
    pub method: Method,
    /// Largest distance of the sampled points of the part's surface from the surface of the shapes, m.
    pub deviation_m: f64,
}

/// Replacement of a part that is not convex and cannot be cut into convex parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConcaveShape {
    /// Its own triangles.
    Mesh,
    /// Hulls of groups of voxels.
    Voxels {
        /// Number of voxels along the longest side of the part.
        resolution: u32,
    },
}

/// Limits of the conversion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeLimits {
    /// Maximum deviation at which convex solids replace a part, m.
    pub tolerance_m: f64,
    /// Replacement of parts that are neither convex nor cut.
    pub concave: ConcaveShape,
}

/// Converts a connected part to shapes that collide; `None` if it has no volume.
#[must_use]
pub fn part_shapes(part: &Component, limits: ShapeLimits) -> Option<PartShapes> {
    let of_solids = |parts: Vec<ConvexPart>, method, deviation_m| PartShapes {
        parts: parts.into_iter().map(PartShape::Convex).collect(),
        method,
        deviation_m,
    };
    let own = faces(part);
    if let Some(solid) = own_faces(part, &own, CONVEX_TOLERANCE_M) {
        return Some(of_solids(vec![solid], Method::Convex, 0.0));
    }
    let whole = hull(&part.mesh.vertices_m)?;
    let of_hull = deviation_m(&part.mesh, std::slice::from_ref(&whole));
    if of_hull <= limits.tolerance_m {
        let parts = vec![if whole.faces.len() > MAX_FACES { simple_hull(&part.mesh.vertices_m)? } else { whole }];
        let deviation_m = deviation_m(&part.mesh, &parts);
        return Some(of_solids(parts, Method::Hull, deviation_m));
    }
    let can_be_cut = part.open_edges == 0 && own.len() <= MAX_EXACT_FACES;
    if let Some(cut) = can_be_cut.then(|| bsp::convex_cells(&part.mesh, &own, MAX_PARTS)).flatten() {
        let deviation_m = deviation_m(&part.mesh, &cut);
        // Cells between faces that aren't flat can leave gaps.
        if deviation_m <= limits.tolerance_m {
            return Some(of_solids(cut, Method::Cut, deviation_m));
        }
    }
    match limits.concave {
        ConcaveShape::Mesh => SurfaceMesh::new(&part.mesh).map(|surface| PartShapes {
            parts: vec![PartShape::Mesh(surface)],
            method: Method::Mesh,
            deviation_m: 0.0,
        }),
        ConcaveShape::Voxels { resolution } => {
            let parts = voxel_parts(&part.mesh, resolution);
            let deviation_m = deviation_m(&part.mesh, &parts);
            (!parts.is_empty()).then(|| of_solids(parts, Method::Voxels, deviation_m))
        }
    }
}

/// Returns the hulls of groups of voxels that fill the mesh.
fn voxel_parts(mesh: &Mesh, resolution: u32) -> Vec<ConvexPart> {
    let points: Vec<Vector> = mesh.vertices_m.iter().map(|p| Vector::new(p[0], p[1], p[2])).collect();
    let settings = VHACDParameters {
        resolution,
        concavity: VOXEL_CONCAVITY,
        max_convex_hulls: MAX_PARTS as u32,
        ..VHACDParameters::default()
    };
    let groups = VHACD::decompose(&settings, &points, &mesh.triangles, true);
    let cut = groups.compute_primitive_intersections(&points, &mesh.triangles);
    cut.iter().filter_map(|group| simple_hull(&group.iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>())).collect()
}

/// Returns the hull of points, or of their extreme points in evenly distributed directions if it had too many faces.
fn simple_hull(points_m: &[Point]) -> Option<ConvexPart> {
    let exact = hull(points_m);
    if exact.as_ref().is_some_and(|part| part.faces.len() <= MAX_FACES) {
        return exact;
    }
    let extreme = directions(EXTREME_POINTS)
        .filter_map(|direction| points_m.iter().copied().max_by(|a, b| dot(direction, *a).total_cmp(&dot(direction, *b))));
    hull(&extreme.collect::<Vec<_>>())
}

/// Returns unit vectors on a spiral around a sphere.
fn directions(count: usize) -> impl Iterator<Item = Point> {
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (s, c) = crate::math::sin_cos(GOLDEN_ANGLE_RAD * k as f64);
        let radius = (1.0 - z * z).sqrt();
        [radius * c, radius * s, z]
    })
}

/// Returns the largest distance of points on a mesh from the surface of convex parts: its vertices and the middles of its triangles, or
/// an even selection of them.
#[must_use]
pub fn deviation_m(mesh: &Mesh, parts: &[ConvexPart]) -> f64 {
    let solids: Vec<PlaneSolid> = parts.iter().map(PlaneSolid::new).collect();
    let middles = mesh.triangles.iter().map(|triangle| middle(&mesh.corners(*triangle)));
    let step = ((mesh.vertices_m.len() + mesh.triangles.len()) / MAX_SAMPLES).max(1);
    let samples = mesh.vertices_m.iter().copied().chain(middles).step_by(step);
    let nearest_m = |p: Point| solids.iter().map(|solid| solid.distance_m(p)).fold(f64::INFINITY, f64::min).abs();
    samples.map(nearest_m).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::topology::components;
    use super::super::topology::tests::joined;
    use super::super::weld::weld;
    use super::*;

    const LIMITS: ShapeLimits = ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh };

    fn converted(mesh: &Mesh) -> PartShapes {
        let part = components(&weld(mesh).mesh).swap_remove(0);
        part_shapes(&part, LIMITS).unwrap()
    }

    fn face_count(shapes: &PartShapes) -> usize {
        match &shapes.parts[0] {
            PartShape::Convex(solid) => solid.faces.len(),
            PartShape::Mesh(surface) => surface.faces().len(),
        }
    }

    #[test]
    fn exact_a_box_keeps_its_faces_and_an_open_one_becomes_its_hull() {
        let closed = converted(&Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]));
        assert_eq!((closed.method, face_count(&closed), closed.deviation_m), (Method::Convex, 6, 0.0));
        let mut open = Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]);
        open.triangles.truncate(10);
        let hull = converted(&open);
        assert_eq!((hull.method, face_count(&hull)), (Method::Hull, 6));
        assert!((hull.parts[0].mesh().volume_m3() - 2.0).abs() < 1e-9);
    }

    #[test]
    fn exact_a_flat_part_has_no_volume() {
        let mut flat = Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]);
        flat.triangles.truncate(2);
        let part = components(&flat).swap_remove(0);
        assert_eq!(part_shapes(&part, LIMITS), None);
    }

    #[test]
    fn exact_a_dented_surface_keeps_its_triangles() {
        // A block whose upper side is a paraboloid of 40 x 40 cells: its faces are too many to be cut along.
        const CELLS: u32 = 40;
        let at = |i: u32, j: u32| {
            let [x, y] = [i, j].map(|k| f64::from(k) / f64::from(CELLS));
            [4.0 * x, 4.0 * y, 1.0 + (2.0 * x - 1.0) * (2.0 * x - 1.0) + (2.0 * y - 1.0) * (2.0 * y - 1.0)]
        };
        let number = |i: u32, j: u32| i * (CELLS + 1) + j;
        let mut mesh = Mesh::default();
        mesh.vertices_m.extend((0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| at(i, j))));
        for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| number(i, j));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        let around = (0..CELLS).map(|k| (k, 0)).chain((0..CELLS).map(|k| (CELLS, k)));
        let around = around.chain((0..CELLS).map(|k| (CELLS - k, CELLS))).chain((0..CELLS).map(|k| (0, CELLS - k)));
        let rim: Vec<u32> = around.map(|(i, j)| number(i, j)).collect();
        let first = mesh.vertices_m.len() as u32;
        let bottom: Vec<Point> = rim.iter().map(|k| mesh.vertices_m[*k as usize]).map(|[x, y, _]| [x, y, 0.0]).collect();
        mesh.vertices_m.extend(bottom);
        mesh.vertices_m.push([2.0, 2.0, 0.0]);
        let count = rim.len() as u32;
        for k in 0..count {
            let (next, center) = ((k + 1) % count, first + count);
            let [top, top_next] = [k, next].map(|k| rim[k as usize]);
            mesh.triangles.extend([
                [first + k, first + next, top_next],
                [first + k, top_next, top],
                [first + next, first + k, center],
            ]);
        }
        let shapes = converted(&mesh);
        assert_eq!((shapes.method, shapes.parts.len(), shapes.deviation_m), (Method::Mesh, 1, 0.0));
        let PartShape::Mesh(surface) = &shapes.parts[0] else { panic!("not a mesh") };
        assert!(surface.is_closed());
        assert!((surface.mesh().volume_m3() - mesh.volume_m3()).abs() < 1e-9);
        let voxels = ShapeLimits { concave: ConcaveShape::Voxels { resolution: 48 }, ..LIMITS };
        let part = components(&weld(&mesh).mesh).swap_remove(0);
        assert_eq!(part_shapes(&part, voxels).unwrap().method, Method::Voxels);
    }

    #[test]
    fn exact_a_warped_deck_keeps_its_triangles_where_a_cut_would_leave_gaps() {
        // A deck with a trapezoidal section, along a curve with a growing crossfall: the quadrilaterals of its sides aren't flat.
        const SECTIONS: u32 = 9;
        const RADIUS_M: f64 = 416.0;
        let section = [[-5.0, 0.0], [5.0, 0.0], [4.0, -1.0], [-4.0, -1.0]];
        let mut mesh = Mesh::default();
        for k in 0..SECTIONS {
            let (s, c) = crate::math::sin_cos(0.05 * f64::from(k));
            let (sine_of_slope, cosine_of_slope) = crate::math::sin_cos(0.002 * f64::from(k));
            mesh.vertices_m.extend(section.map(|[y, z]| {
                let (y, z) = (y * cosine_of_slope - z * sine_of_slope, y * sine_of_slope + z * cosine_of_slope);
                [(RADIUS_M - y) * s, RADIUS_M - (RADIUS_M - y) * c, z]
            }));
        }
        for first in (0..SECTIONS - 1).map(|k| 4 * k) {
            for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(a, b)| (first + a, first + b)) {
                mesh.triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        let last = 4 * (SECTIONS - 1);
        mesh.triangles.extend([[0, 2, 1], [0, 3, 2], [last, last + 1, last + 2], [last, last + 2, last + 3]]);
        let part = components(&weld(&mesh).mesh).swap_remove(0);
        assert_eq!(part.open_edges, 0);
        let cut = bsp::convex_cells(&part.mesh, &faces(&part), MAX_PARTS);
        assert!(cut.is_some_and(|cut| deviation_m(&part.mesh, &cut) > LIMITS.tolerance_m), "a cut would do");
        let shapes = converted(&mesh);
        assert_eq!((shapes.method, shapes.deviation_m), (Method::Mesh, 0.0));
    }

    #[test]
    fn exact_voxels_are_the_same_every_time_and_near_the_surface() {
        // A ring of stones: neither convex nor, here, cut exactly.
        let stones: Vec<Mesh> = (0..24)
            .map(|k| {
                let angle = f64::from(k) * crate::math::TAU / 24.0;
                let (s, c) = crate::math::sin_cos(angle);
                Mesh::of_box([5.0 * c - 1.0, 5.0 * s - 1.0, 0.0], [5.0 * c + 1.0, 5.0 * s + 1.0, 2.0])
            })
            .collect();
        let mesh = joined(&stones);
        let parts = voxel_parts(&mesh, 48);
        assert_eq!(parts, voxel_parts(&mesh, 48));
        /// Two voxels of 12 m / 48.
        const TOLERANCE_M: f64 = 0.5;
        let outside = |p: &Point| parts.iter().all(|part| PlaneSolid::new(part).distance_m(*p) > TOLERANCE_M);
        assert!(parts.len() > 2 && !mesh.vertices_m.iter().any(outside), "{}", parts.len());
    }
}
