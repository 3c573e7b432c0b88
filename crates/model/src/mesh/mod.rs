//! Triangle meshes of bridge models: reads them from glTF, IFC, OBJ and PLY files, makes them of point clouds, welds and splits them into connected parts, and turns the parts into
//! shapes for collisions. All lengths are in meters.

mod bsp;
mod cloud_reader;
pub mod faces;
pub mod gltf_reader;
pub mod hull;
mod ifc_elements;
mod ifc_reader;
mod ifc_relations;
pub mod mesh_file;
mod obj_reader;
pub mod part_shapes;
pub mod plane_solid;
mod ply_reader;
pub mod point_cloud;
pub mod reader;
pub mod surface_mesh;
mod texture;
pub mod topology;
pub mod vectors;
pub mod vertex_colors;
mod voxel_grid;
pub mod voxel_surface;
pub mod weld;

use vectors::{Point, cross, dot, norm, sub};

/// Triangles with shared vertices. Seen from outside, the vertices of a triangle are counterclockwise.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, m.
    pub vertices_m: Vec<Point>,
    /// Three vertex indices per triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Faces of a box: indices of [`box_corners`], counterclockwise seen from outside.
pub const BOX_FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Returns the corners of a box between its lowest and its highest corner.
#[must_use]
pub fn box_corners(low: Point, high: Point) -> [Point; 8] {
    std::array::from_fn(|k| [0, 1, 2].map(|axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] }))
}

/// Returns faces as triangle fans from each face's first corner.
pub fn fans<'a>(faces: impl IntoIterator<Item = &'a [u32]>) -> Vec<[u32; 3]> {
    faces.into_iter().flat_map(|face| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]])).collect()
}

impl Mesh {
    /// Returns a box between its lowest and its highest corner.
    #[must_use]
    pub fn of_box(low: Point, high: Point) -> Self {
        Self { vertices_m: box_corners(low, high).to_vec(), triangles: fans(BOX_FACES.iter().map(<[u32; 4]>::as_slice)) }
    }

    /// Adds the vertices and triangles of another mesh.
    pub fn append(&mut self, other: &Self) {
        let first = self.vertices_m.len() as u32;
        self.vertices_m.extend(&other.vertices_m);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|k| first + k)));
    }

    /// Returns a mesh of some of the triangles, with the vertices that they use in the same order.
    #[must_use]
    pub fn part(&self, triangles: &[[u32; 3]]) -> Self {
        let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        // All vertices of the triangles are among those used.
        let number = |k: u32| used.partition_point(|other| *other < k) as u32;
        Self {
            vertices_m: used.iter().map(|k| self.vertices_m[*k as usize]).collect(),
            triangles: triangles.iter().map(|triangle| triangle.map(number)).collect(),
        }
    }

    /// Returns whether the mean thickness of a closed mesh, twice its volume divided by its surface, is more than this, m.
    #[must_use]
    pub fn is_thicker_than(&self, thickness_m: f64) -> bool {
        let surface_m2: f64 = self.triangles.iter().map(|triangle| 0.5 * norm(self.area_vector(*triangle))).sum();
        self.volume_m3() > 0.5 * thickness_m * surface_m2
    }

    /// Returns the corners of a triangle.
    #[must_use]
    pub fn corners(&self, triangle: [u32; 3]) -> [Point; 3] {
        triangle.map(|k| self.vertices_m[k as usize])
    }

    /// Returns the cross product of two sides of a triangle: its outward normal, twice as long as its area.
    #[must_use]
    pub fn area_vector(&self, triangle: [u32; 3]) -> Point {
        let [a, b, c] = self.corners(triangle);
        cross(sub(b, a), sub(c, a))
    }

    /// Returns the enclosed volume, m³; negative if the triangles face inward. Meaningless for an open mesh.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        let Some(origin) = self.vertices_m.first() else { return 0.0 };
        let six_fold = |triangle: &[u32; 3]| {
            let [a, b, c] = self.corners(*triangle).map(|corner| sub(corner, *origin));
            dot(a, cross(b, c))
        };
        self.triangles.iter().map(six_fold).sum::<f64>() / 6.0
    }

    /// Returns the corners of the bounding box; `None` if there are no vertices.
    #[must_use]
    pub fn bounds(&self) -> Option<(Point, Point)> {
        vectors::bounds(self.vertices_m.iter().copied())
    }
}
