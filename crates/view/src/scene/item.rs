//! Meshes of a scene with their instances.

use crate::mesh::{Mesh, Vertex, single};
use spandrel_model::frames::{Enu, Vec3};

/// Transform and attributes of a mesh instance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Instance {
    /// Rows of the affine transform from mesh axes to the site.
    pub rows: [[f32; 4]; 3],
    /// Color of painted parts, linear; the last component is 1 if the color applies.
    pub paint: [f32; 4],
    /// Indirect light (fractions of sky and sun) on upward surfaces and on downward surfaces.
    pub around: [f32; 4],
}

impl Instance {
    /// Identity transform; keeps the light stored in the mesh.
    pub const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], paint: [0.0; 4], around: [1.0; 4] };

    /// Creates an instance from an origin and three axis vectors, whose lengths set the scale.
    #[must_use]
    pub fn placed(origin_m: Vec3<Enu>, axes: [Vec3<Enu>; 3], around: [f32; 4]) -> Self {
        let [x, y, z] = axes.map(single);
        let o = single(origin_m);
        Self { rows: [0, 1, 2].map(|k| [x[k], y[k], z[k], o[k]]), paint: [0.0; 4], around }
    }

    /// Transforms and lights a vertex the same way as the shaders do.
    pub(super) fn transformed(&self, v: &Vertex) -> Vertex {
        let turned = |of: [f32; 3]| self.rows.map(|row| row[0] * of[0] + row[1] * of[1] + row[2] * of[2]);
        let [x, y, z] = turned(v.normal);
        let length = (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE);
        let moved = turned(v.position);
        let up = 0.5 + 0.5 * z / length;
        let light = |k: usize| v.light[k] * (self.around[2 + k] + (self.around[k] - self.around[2 + k]) * up);
        Vertex {
            position: [0, 1, 2].map(|k| moved[k] + self.rows[k][3]),
            normal: [x, y, z].map(|c| c / length),
            light: [light(0), light(1)],
            ..*v
        }
    }

    pub(super) fn with_material(self, [r, g, b]: [f32; 3]) -> Self {
        Self { paint: [r, g, b, 1.0], ..self }
    }
}

/// A mesh and its instances.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneItem {
    /// Name of the item.
    pub name: &'static str,
    /// Mesh in its own axes.
    pub mesh: Mesh,
    /// Instances of the mesh.
    pub instances: Vec<Instance>,
    /// Whether the item is drawn into shadow maps.
    pub casts_shadows: bool,
    /// Visibility range in the direct view and in the reflection.
    pub visible_range: VisibleRange,
    /// Whether the item belongs to the backdrop, which is split into sectors.
    pub backdrop: bool,
}

/// Minimum and maximum distance for drawing an object, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleRange {
    /// Distances in the direct view, m.
    pub direct_m: [f64; 2],
    /// Distances in the lake's reflection, m.
    pub in_lake_m: [f64; 2],
}

impl VisibleRange {
    /// Matches any distance.
    pub const ANY_DISTANCE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    /// Matches no distance.
    pub const NO_DISTANCE: [f64; 2] = [f64::INFINITY, f64::INFINITY];
    /// Visible in the direct view and in the lake's reflection at any distance.
    pub const EVERYWHERE: Self = Self { direct_m: Self::ANY_DISTANCE, in_lake_m: Self::ANY_DISTANCE };
    /// Visible only in the direct view.
    pub const DIRECT_ONLY: Self = Self { in_lake_m: Self::NO_DISTANCE, ..Self::EVERYWHERE };
    /// Visible only in the lake's reflection, for simplified substitutes.
    pub const LAKE_ONLY: Self = Self { direct_m: Self::NO_DISTANCE, ..Self::EVERYWHERE };

    /// Returns the range of distances up to `most_m`.
    #[must_use]
    pub const fn within(most_m: f64) -> [f64; 2] {
        [f64::NEG_INFINITY, most_m]
    }

    /// Returns the range of distances beyond `least_m`.
    #[must_use]
    pub const fn beyond(least_m: f64) -> [f64; 2] {
        [least_m, f64::INFINITY]
    }

    /// Checks whether the object is drawn at the given distance, in the direct view or in the lake's reflection.
    #[must_use]
    pub fn shows(&self, in_lake: bool, from_m: f64) -> bool {
        let [begins, ends] = if in_lake { self.in_lake_m } else { self.direct_m };
        begins <= from_m && from_m < ends
    }
}

impl SceneItem {
    /// Creates an item with one instance at the identity transform.
    pub(super) fn here(name: &'static str, mesh: Mesh, casts_shadows: bool) -> Self {
        Self {
            name,
            mesh,
            instances: vec![Instance::IDENTITY],
            casts_shadows,
            visible_range: VisibleRange::EVERYWHERE,
            backdrop: false,
        }
    }
}
