//! Merges vertices that coincide, as at the edges of a mesh whose triangles have their own vertices.

use super::Mesh;
use super::vectors::{Point, norm, sub};
use std::collections::{BTreeMap, BTreeSet};

/// Distance within which vertices are one vertex, m (estimate: three times the spacing of 32-bit floats at 500 m, and less than the
/// thickness of any part).
pub const WELD_DISTANCE_M: f64 = 1e-4;
/// Edge length of the cells in which neighbors are searched, as a multiple of the distance: so large that most vertices have a single
/// cell within reach.
const CELL_DISTANCES: f64 = 16.0;

/// A mesh after welding.
#[derive(Debug, Clone, PartialEq)]
pub struct Welded {
    /// The mesh, without degenerate triangles.
    pub mesh: Mesh,
    /// Number of triangles that were removed because welding left fewer than three different vertices, or because they occur twice.
    pub dropped_triangles: usize,
}

/// Merges vertices within [`WELD_DISTANCE_M`] and removes degenerate and repeated triangles. A merged vertex keeps the position of the
/// first one.
#[must_use]
pub fn weld(mesh: &Mesh) -> Welded {
    weld_within(mesh, WELD_DISTANCE_M)
}

/// Merges vertices within a distance in meters; otherwise like [`weld`].
#[must_use]
pub fn weld_within(mesh: &Mesh, distance_m: f64) -> Welded {
    let mut grid: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut vertices_m: Vec<Point> = Vec::new();
    let mut merged = Vec::with_capacity(mesh.vertices_m.len());
    for vertex in &mesh.vertices_m {
        let near = |k: &u32| norm(sub(vertices_m[*k as usize], *vertex)) <= distance_m;
        let known = cells_within_reach(*vertex, distance_m).find_map(|cell| grid.get(&cell)?.iter().copied().find(near));
        merged.push(known.unwrap_or_else(|| {
            let k = vertices_m.len() as u32;
            vertices_m.push(*vertex);
            grid.entry(vertex.map(|value| cell_of(value, distance_m))).or_default().push(k);
            k
        }));
    }
    let mut seen = BTreeSet::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| merged[k as usize]);
        // The rotation that starts with the lowest index identifies a triangle and its direction.
        let rotated = if a < b && a < c {
            [a, b, c]
        } else if b < c {
            [b, c, a]
        } else {
            [c, a, b]
        };
        if a != b && b != c && c != a && seen.insert(rotated) {
            triangles.push([a, b, c]);
        }
    }
    let dropped_triangles = mesh.triangles.len() - triangles.len();
    Welded { mesh: Mesh { vertices_m, triangles }, dropped_triangles }
}

fn cell_of(value: f64, distance_m: f64) -> i64 {
    (value / (CELL_DISTANCES * distance_m)).floor() as i64
}

/// Returns the cells that may contain vertices within a distance.
fn cells_within_reach(p: Point, distance_m: f64) -> impl Iterator<Item = [i64; 3]> {
    let range = |k: usize| cell_of(p[k] - distance_m, distance_m)..=cell_of(p[k] + distance_m, distance_m);
    let (xs, ys, zs) = (range(0), range(1), range(2));
    xs.flat_map(move |x| {
        let zs = zs.clone();
        ys.clone().flat_map(move |y| zs.clone().map(move |z| [x, y, z]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_near_vertices_merge_and_degenerate_triangles_go() {
        let near = 0.5 * WELD_DISTANCE_M;
        // Two triangles with a common edge, whose vertices are on both sides of a cell's border, and two degenerate ones.
        let vertices_m = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0 - near, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0 + near, -near],
        ];
        let mesh = Mesh { vertices_m, triangles: vec![[0, 1, 2], [3, 4, 5], [1, 3, 4], [2, 0, 3]] };
        let welded = weld(&mesh);
        assert_eq!(welded.mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!((welded.mesh.vertices_m.len(), welded.dropped_triangles), (4, 2));
    }
}
