//! Merges the triangles of a solid's surface into planar faces.

use super::topology::{Component, Neighbors};
use super::vectors::{Point, cross, dot, norm, sub, unit};
use super::{Mesh, fans};
use std::collections::BTreeMap;

/// Distance from a face's plane within which a triangle belongs to the face, m (estimate: rounding errors of 32-bit floats at 500 m,
/// and much less than any edge of a member).
pub const FLAT_TOLERANCE_M: f64 = 1e-4;
/// Minimum cosine of the angle between the normals of a face and of its triangles (estimate).
const MIN_NORMAL_COSINE: f64 = 0.99;
/// Height below which a triangle has no reliable normal, m (estimate: ten times the tolerance of its corners).
const SLIVER_HEIGHT_M: f64 = 1e-3;

/// A planar face.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Vertex indices, counterclockwise seen from outside.
    pub corners: Vec<u32>,
    /// Outward unit normal.
    pub normal: Point,
    /// Distance of the plane from the origin along the normal, m.
    pub offset_m: f64,
}

/// A closed convex polyhedron.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ConvexPart {
    /// Corners, m.
    pub corners_m: Vec<Point>,
    /// Planar faces: three or more corner indices each, counterclockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
}

impl ConvexPart {
    /// Returns the faces as triangle fans from each face's first corner.
    #[must_use]
    pub fn mesh(&self) -> Mesh {
        Mesh { vertices_m: self.corners_m.clone(), triangles: fans(self.faces.iter().map(Vec::as_slice)) }
    }
}

/// Merges triangles in one plane. The largest triangle of a face determines its plane. Omits narrow triangles that are in no face's plane.
#[must_use]
pub fn faces(part: &Component) -> Vec<Face> {
    let mesh = &part.mesh;
    let areas: Vec<f64> = mesh.triangles.iter().map(|triangle| norm(mesh.area_vector(*triangle))).collect();
    // A narrow triangle has no reliable plane of its own, so it can only join a face.
    let mut order: Vec<usize> = (0..mesh.triangles.len()).filter(|k| !is_sliver(mesh, mesh.triangles[*k])).collect();
    order.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]).then(a.cmp(b)));
    let mut is_used = vec![false; mesh.triangles.len()];
    let mut faces = Vec::new();
    for seed in order {
        if is_used[seed] {
            continue;
        }
        let Some(normal) = unit(mesh.area_vector(mesh.triangles[seed])) else { continue };
        let offset_m = dot(normal, mesh.vertices_m[mesh.triangles[seed][0] as usize]);
        let region = grow(mesh, &part.neighbors, seed, (normal, offset_m), &mut is_used);
        match outline(mesh, &part.neighbors, &region) {
            Some(corners) => faces.push(Face { corners, normal, offset_m }),
            // A region with a hole or a pinched outline stays in triangles.
            None => faces.extend(region.iter().filter_map(|k| triangle_face(mesh, mesh.triangles[*k as usize]))),
        }
    }
    faces
}

fn triangle_face(mesh: &Mesh, triangle: [u32; 3]) -> Option<Face> {
    let normal = unit(mesh.area_vector(triangle))?;
    Some(Face { corners: triangle.to_vec(), normal, offset_m: dot(normal, mesh.vertices_m[triangle[0] as usize]) })
}

/// Collects the connected triangles in a plane.
fn grow(mesh: &Mesh, neighbors: &[Neighbors], seed: usize, plane: (Point, f64), is_used: &mut [bool]) -> Vec<u32> {
    is_used[seed] = true;
    let mut region = vec![seed as u32];
    let mut next = 0;
    while let Some(k) = region.get(next).copied() {
        next += 1;
        for other in neighbors[k as usize].into_iter().flatten() {
            if !is_used[other as usize] && is_in_plane(mesh, mesh.triangles[other as usize], plane) {
                is_used[other as usize] = true;
                region.push(other);
            }
        }
    }
    region
}

fn is_in_plane(mesh: &Mesh, triangle: [u32; 3], (normal, offset_m): (Point, f64)) -> bool {
    let corners = mesh.corners(triangle);
    if corners.iter().any(|corner| (dot(normal, *corner) - offset_m).abs() > FLAT_TOLERANCE_M) {
        return false;
    }
    is_sliver(mesh, triangle) || unit(mesh.area_vector(triangle)).is_some_and(|own| dot(own, normal) >= MIN_NORMAL_COSINE)
}

fn is_sliver(mesh: &Mesh, triangle: [u32; 3]) -> bool {
    let corners = mesh.corners(triangle);
    let longest_m = (0..3).map(|k| norm(sub(corners[k], corners[(k + 1) % 3]))).fold(0.0, f64::max);
    norm(mesh.area_vector(triangle)) <= SLIVER_HEIGHT_M * longest_m
}

/// Returns the corners around a region of triangles; `None` if its outline is not a single loop.
fn outline(mesh: &Mesh, neighbors: &[Neighbors], region: &[u32]) -> Option<Vec<u32>> {
    let mut is_inside = region.to_vec();
    is_inside.sort_unstable();
    let mut next: BTreeMap<u32, u32> = BTreeMap::new();
    for k in region {
        let triangle = mesh.triangles[*k as usize];
        for side in 0..3 {
            let other = neighbors[*k as usize][side];
            if other.is_none_or(|other| is_inside.binary_search(&other).is_err())
                && next.insert(triangle[side], triangle[(side + 1) % 3]).is_some()
            {
                return None;
            }
        }
    }
    let (first, _) = next.first_key_value()?;
    let mut corners = vec![*first];
    loop {
        let at = *next.get(corners.last()?)?;
        if at == corners[0] {
            break;
        }
        if corners.len() > next.len() {
            return None;
        }
        corners.push(at);
    }
    (corners.len() == next.len() && corners.len() >= 3).then_some(corners)
}

/// Returns a convex part without the points inside its faces and on its straight edges: each of them belongs to two faces only, and lies on
/// the line between the corners before and after it.
#[must_use]
pub fn without_edge_points(vertices_m: &[Point], faces: &[Face]) -> ConvexPart {
    let mut face_counts = vec![0u32; vertices_m.len()];
    faces.iter().flat_map(|face| &face.corners).for_each(|k| face_counts[*k as usize] += 1);
    // Each edge is between two faces, which must agree: the first one decides about the points on it.
    let mut is_kept: Vec<Option<bool>> = face_counts.iter().map(|count| (*count > 2).then_some(true)).collect();
    for Face { corners, .. } in faces {
        let start = corners.iter().position(|k| face_counts[*k as usize] > 2).unwrap_or(0);
        let around: Vec<u32> = corners[start..].iter().chain(&corners[..=start]).copied().collect();
        let mut last = 0;
        for k in 1..around.len() {
            let decided = is_kept[around[k] as usize];
            let must_stay = || {
                let (from, to) = (vertices_m[around[last] as usize], vertices_m[around[k + 1] as usize]);
                around[last + 1..=k].iter().any(|point| line_distance_m(vertices_m[*point as usize], from, to) > FLAT_TOLERANCE_M)
            };
            let stays = decided.unwrap_or_else(|| k + 1 == around.len() || must_stay());
            is_kept[around[k] as usize] = Some(stays);
            if stays {
                last = k;
            }
        }
    }
    let is_corner = |k: u32| is_kept[k as usize] == Some(true);
    let numbers: Vec<u32> = (0..vertices_m.len() as u32).filter(|k| is_corner(*k)).collect();
    let renumbered = |face: &Face| {
        let corners = face.corners.iter().filter(|k| is_corner(**k)).map(|k| numbers.partition_point(|other| other < k) as u32);
        corners.collect::<Vec<u32>>()
    };
    ConvexPart {
        corners_m: numbers.iter().map(|k| vertices_m[*k as usize]).collect(),
        faces: faces.iter().map(renumbered).filter(|corners| corners.len() >= 3).collect(),
    }
}

/// Returns the distance of a point from the line through two others, m.
fn line_distance_m(p: Point, from: Point, to: Point) -> f64 {
    let along = sub(to, from);
    unit(along).map_or_else(|| norm(sub(p, from)), |direction| norm(cross(direction, sub(p, from))))
}

/// Returns how far the highest vertex is above the plane of a face, m: 0 for a convex solid. Stops early above `enough_m`.
#[must_use]
pub fn bulge_m(vertices_m: &[Point], faces: &[Face], enough_m: f64) -> f64 {
    let mut highest_m: f64 = 0.0;
    for face in faces {
        for vertex in vertices_m {
            highest_m = highest_m.max(dot(face.normal, *vertex) - face.offset_m);
        }
        if highest_m > enough_m {
            return highest_m;
        }
    }
    highest_m
}

#[cfg(test)]
mod tests {
    use super::super::topology::components;
    use super::super::vectors::add_scaled;
    use super::super::weld::weld;
    use super::*;

    #[test]
    fn exact_a_box_has_six_quadrilaterals_and_no_bulge() {
        let part = &components(&Mesh::of_box([10.0, -3.0, 2.0], [12.0, -2.5, 7.0]))[0];
        let faces = faces(part);
        assert_eq!(faces.iter().map(|face| face.corners.len()).collect::<Vec<_>>(), [4; 6]);
        assert_eq!(bulge_m(&part.mesh.vertices_m, &faces, 1.0), 0.0);
    }

    #[test]
    fn exact_points_on_edges_and_in_faces_are_removed() {
        // A box whose triangles are divided in four, three times.
        let mut mesh = Mesh::of_box([0.0; 3], [8.0, 1.0, 2.0]);
        for _ in 0..3 {
            let coarse = std::mem::take(&mut mesh);
            for triangle in &coarse.triangles {
                let [a, b, c] = coarse.corners(*triangle);
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| add_scaled(p, sub(q, p), 0.5));
                for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                    let first = mesh.vertices_m.len() as u32;
                    mesh.vertices_m.extend(corners);
                    mesh.triangles.push([first, first + 1, first + 2]);
                }
            }
        }
        let part = &components(&weld(&mesh).mesh)[0];
        let solid = without_edge_points(&part.mesh.vertices_m, &faces(part));
        assert_eq!((solid.corners_m.len(), solid.faces.len()), (8, 6));
        assert!(solid.faces.iter().all(|face| face.len() == 4));
        assert!((solid.mesh().volume_m3() - 16.0).abs() < 1e-9);
    }
}
