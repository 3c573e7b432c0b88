//! Spatial partition for culling: a grid of square cells for the site and angular sectors for the backdrop. Only
//! potentially visible cells are drawn.

use super::matrix::Matrix;
use super::mesh::{Mesh, Vertex};
use super::scene::Instance;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use std::collections::BTreeMap;

/// Side of a cell, m (estimate: most pictures show only a few cells).
const CELL_SIZE_M: f64 = 80.0;
/// Minimum distance of the backdrop from the origin, m.
const MIN_BACKDROP_DISTANCE_M: f64 = 500.0;
/// Number of backdrop sectors around the origin: a view of 84 degrees covers a third of them. With a software renderer,
/// a draw call costs as much as fifty triangles, which is a sixth of a mountain sector.
const BACKDROP_SECTORS: f64 = 16.0;

/// Bounding sphere of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingSphere {
    /// Center, ENU, m.
    pub center_m: Vec3<Enu>,
    /// Sphere radius, m.
    pub radius_m: f64,
}

impl BoundingSphere {
    /// Returns a sphere that encloses all points, each with its own radius in meters.
    #[must_use]
    pub fn around(points: &[(Vec3<Enu>, f64)]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (p, _) in points {
            for (k, x) in p.array().into_iter().enumerate() {
                low[k] = low[k].min(x);
                high[k] = high[k].max(x);
            }
        }
        let [x, y, z] = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let center_m = Vec3::new(x, y, z);
        let radius_m = points.iter().map(|(p, room)| (*p - center_m).norm() + room).fold(0.0, f64::max);
        Self { center_m, radius_m }
    }

    /// Returns the distance from a point to the sphere's surface, in meters; negative inside the sphere.
    #[must_use]
    pub fn distance_to_m(&self, point_m: Vec3<Enu>) -> f64 {
        (point_m - self.center_m).norm() - self.radius_m
    }

    /// Returns a sphere that encloses a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        Self::around(&mesh.vertices.iter().map(|v| (position(v), 0.0)).collect::<Vec<_>>())
    }
}

fn position(v: &Vertex) -> Vec3<Enu> {
    let [x, y, z] = v.position.map(f64::from);
    Vec3::new(x, y, z)
}

/// Bounds of a cell for frustum culling.
#[derive(Debug, Clone, PartialEq)]
pub struct CellBounds {
    /// Bounding sphere.
    pub sphere: BoundingSphere,
    /// Corners of the bounding box; empty if only the sphere is known.
    corners_m: Vec<Vec3<Enu>>,
}

impl CellBounds {
    /// Returns the bounds of a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        Self { sphere: BoundingSphere::of(mesh), corners_m: mesh.vertices.iter().map(position).collect() }
    }
}

impl From<BoundingSphere> for CellBounds {
    fn from(sphere: BoundingSphere) -> Self {
        Self { sphere, corners_m: Vec::new() }
    }
}

/// A grid cell (column and row) or a backdrop sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum SceneCell {
    Square(i64, i64),
    Sector(i64),
}

fn cell(p: Vec3<Enu>, backdrop: bool) -> SceneCell {
    if backdrop || p.east().abs().max(p.north().abs()) > MIN_BACKDROP_DISTANCE_M {
        return SceneCell::Sector((math::atan2(p.east(), p.north()) / math::TAU * BACKDROP_SECTORS).floor() as i64);
    }
    SceneCell::Square((p.east() / CELL_SIZE_M).floor() as i64, (p.north() / CELL_SIZE_M).floor() as i64)
}

/// Maps vertex indices of the whole mesh to those of a cell.
type VertexRemap = BTreeMap<u32, u32>;

/// Splits a mesh into cells. If `backdrop` is true, splits it into sectors only.
#[must_use]
pub fn split_into_cells(mesh: &Mesh, backdrop: bool) -> Vec<Mesh> {
    let mut cells: BTreeMap<SceneCell, (Mesh, VertexRemap)> = BTreeMap::new();
    for triangle in mesh.indices.chunks_exact(3) {
        let Some(first) = mesh.vertices.get(triangle[0] as usize) else { continue };
        let (part, known) = cells.entry(cell(position(first), backdrop)).or_default();
        for k in triangle {
            let Some(vertex) = mesh.vertices.get(*k as usize) else { continue };
            let index = *known.entry(*k).or_insert_with(|| {
                part.vertices.push(*vertex);
                part.vertices.len() as u32 - 1
            });
            part.indices.push(index);
        }
    }
    cells.into_values().map(|(part, _)| part).collect()
}

/// Returns the distance from the mesh's origin to its farthest vertex, in meters.
#[must_use]
pub fn max_vertex_distance_m(mesh: &Mesh) -> f64 {
    mesh.vertices.iter().map(|v| position(v).norm()).fold(0.0, f64::max)
}

/// Groups instances of a mesh by cell, each with a bounding sphere.
#[must_use]
pub fn group_instances(mesh: &Mesh, instances: &[Instance]) -> Vec<(Vec<Instance>, BoundingSphere)> {
    let reach_m = max_vertex_distance_m(mesh);
    let origin = |i: &Instance| Vec3::new(f64::from(i.rows[0][3]), f64::from(i.rows[1][3]), f64::from(i.rows[2][3]));
    let size = |i: &Instance| {
        let column = |k: usize| i.rows.iter().map(|row| f64::from(row[k]) * f64::from(row[k])).sum::<f64>().sqrt();
        column(0).max(column(1)).max(column(2))
    };
    let mut cells: BTreeMap<SceneCell, Vec<Instance>> = BTreeMap::new();
    for instance in instances {
        cells.entry(cell(origin(instance), false)).or_default().push(*instance);
    }
    let balled = |all: Vec<Instance>| {
        let points: Vec<_> = all.iter().map(|i| (origin(i), reach_m * size(i))).collect();
        let ball = BoundingSphere::around(&points);
        (all, ball)
    };
    cells.into_values().map(balled).collect()
}

/// The six planes of a view frustum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frustum([[f64; 4]; 6]);

impl Frustum {
    /// Extracts the frustum of a projection to clip space.
    #[must_use]
    pub fn of(projection: &Matrix) -> Self {
        let [x, y, z, w] = projection.0;
        let sum = |a: [f64; 4], b: [f64; 4], sign: f64| [0, 1, 2, 3].map(|k| a[k] + sign * b[k]);
        Self([sum(w, x, 1.0), sum(w, x, -1.0), sum(w, y, 1.0), sum(w, y, -1.0), sum(w, z, -1.0), z])
    }

    /// Returns false if the sphere is definitely outside the frustum.
    #[must_use]
    pub fn may_be_visible(&self, sphere: &BoundingSphere) -> bool {
        self.0.iter().all(|plane| {
            let [a, b, c, _] = plane;
            let length = (a * a + b * b + c * c).sqrt();
            // A projection with infinite depth has no far plane.
            length < 1e-12 || signed_distance(plane, sphere.center_m) >= -sphere.radius_m * length
        })
    }

    /// Returns false if the cell is definitely outside the frustum, because all its corners are beyond one plane.
    #[must_use]
    pub fn cell_may_be_visible(&self, bounds: &CellBounds) -> bool {
        let corners = &bounds.corners_m;
        let reaches =
            |plane: &[f64; 4]| corners.is_empty() || corners.iter().any(|corner| signed_distance(plane, *corner) >= 0.0);
        self.may_be_visible(&bounds.sphere) && self.0.iter().all(reaches)
    }
}

/// Returns the signed distance from a plane to a point, in units of the plane's normal; positive on the inner side.
fn signed_distance([a, b, c, d]: &[f64; 4], p: Vec3<Enu>) -> f64 {
    let [x, y, z] = p.array();
    a * x + b * y + c * z + d
}

#[cfg(test)]
mod tests {
    use super::super::camera::PinholeCamera;
    use super::super::mesh::{Material, SurfaceFinish};
    use super::*;

    #[test]
    fn exact_splitting_keeps_all_triangles() {
        let mut mesh = Mesh::default();
        mesh.block([-300.0, -5.0, 0.0], [-20.0, 5.0, 2.0], [0.0; 3], SurfaceFinish::new(Material::Rock, [9, 9, 9]));
        mesh.block([100.0, 100.0, 0.0], [101.0, 101.0, 2.0], [0.0; 3], SurfaceFinish::new(Material::Rock, [9, 9, 9]));
        let parts = split_into_cells(&mesh, false);
        assert!(parts.len() > 2);
        assert_eq!(parts.iter().map(Mesh::triangles).sum::<usize>(), mesh.triangles());
        for part in &parts {
            let ball = BoundingSphere::of(part);
            assert!(part.vertices.iter().all(|v| (position(v) - ball.center_m).norm() <= ball.radius_m + 1e-6));
        }
    }

    #[test]
    fn exact_spheres_outside_the_frustum_are_culled() {
        let eye = PinholeCamera::at(Vec3::new(0.0, 0.0, 10.0), Vec3::new(0.0, 100.0, 10.0), 1.0, 1.5);
        let frustum = Frustum::of(&eye.view_projection(1.5));
        let ball = |east: f64, north: f64| BoundingSphere { center_m: Vec3::new(east, north, 10.0), radius_m: 5.0 };
        assert!(
            frustum.may_be_visible(&ball(0.0, 50.0))
                && frustum.may_be_visible(&ball(0.0, 9_000.0))
                && frustum.may_be_visible(&ball(0.0, -4.0))
        );
        assert!(!frustum.may_be_visible(&ball(0.0, -20.0)) && !frustum.may_be_visible(&ball(100.0, 50.0)));
        // In the lake's reflection, objects above the water appear below it.
        let mirrored = Frustum::of(&eye.view_projection(1.5).after(&Matrix::mirror(0.0)));
        let high = BoundingSphere { center_m: Vec3::new(0.0, 40.0, 60.0), radius_m: 5.0 };
        assert!(!frustum.may_be_visible(&high) && !mirrored.may_be_visible(&high));
        let low = BoundingSphere { center_m: Vec3::new(0.0, 40.0, 6.0), radius_m: 1.0 };
        assert!(frustum.may_be_visible(&low) && mirrored.may_be_visible(&low));
    }

    #[test]
    fn exact_box_corners_cull_a_long_wall_that_the_sphere_keeps() {
        let eye = PinholeCamera::at(Vec3::new(0.0, 0.0, 10.0), Vec3::new(0.0, 100.0, 10.0), 1.0, 1.5);
        let frustum = Frustum::of(&eye.view_projection(1.5));
        let wall = |east: f64| {
            let mut mesh = Mesh::default();
            mesh.block([east, -50.0, 0.0], [east + 1.0, 250.0, 20.0], [0.0; 3], SurfaceFinish::new(Material::Rock, [9, 9, 9]));
            CellBounds::of(&mesh)
        };
        let (beside, across) = (wall(-260.0), wall(-60.0));
        assert!(frustum.may_be_visible(&beside.sphere) && !frustum.cell_may_be_visible(&beside));
        assert!(frustum.cell_may_be_visible(&across) && frustum.cell_may_be_visible(&CellBounds::from(across.sphere)));
        // The frustum test must keep a cell that contains the camera even though none of its corners are in view.
        let mut hall = Mesh::default();
        hall.block([-500.0, -500.0, -500.0], [500.0, 500.0, 500.0], [0.0; 3], SurfaceFinish::new(Material::Rock, [9, 9, 9]));
        assert!(frustum.cell_may_be_visible(&CellBounds::of(&hall)));
    }

    #[test]
    fn exact_bounding_spheres_contain_their_instances() {
        let mut mesh = Mesh::default();
        mesh.ball(Vec3::zero(), [1.0; 3], 0.0, SurfaceFinish::new(Material::Rock, [9, 9, 9]));
        let at = |east: f64| {
            let axes = [Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0), Vec3::new(0.0, 0.0, 3.0)];
            Instance::placed(Vec3::new(east, 0.0, 0.0), axes, [1.0; 4])
        };
        let groups = group_instances(&mesh, &[at(1.0), at(5.0), at(500.0)]);
        assert_eq!(groups.iter().map(|(all, _)| all.len()).collect::<Vec<_>>(), [2, 1]);
        assert!((groups[0].1.radius_m - 5.0).abs() < 1e-5, "half the distance and three meters: {}", groups[0].1.radius_m);
    }
}
