//! 4 x 4 matrices for the GPU: computed in f64, passed in column-major f32.

use spandrel_model::frames::{Enu, Vec3};

/// A row-major matrix that multiplies column vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matrix(pub [[f64; 4]; 4]);

impl Matrix {
    /// Returns the view matrix for an orientation (unit vectors right, up, back) and an eye position, which becomes the
    /// origin.
    #[must_use]
    pub fn view(eye: Vec3<Enu>, right: Vec3<Enu>, up: Vec3<Enu>, back: Vec3<Enu>) -> Self {
        let row = |axis: Vec3<Enu>| {
            let [x, y, z] = axis.array();
            [x, y, z, -axis.dot(eye)]
        };
        Self([row(right), row(up), row(back), [0.0, 0.0, 0.0, 1.0]])
    }

    /// Returns a perspective projection with half sizes at distance 1. Depth is `near`/distance: 1 at `near`, 0 at
    /// infinity.
    #[must_use]
    pub fn perspective(half_width: f64, half_height: f64, near: f64) -> Self {
        Self([
            [1.0 / half_width, 0.0, 0.0, 0.0],
            [0.0, 1.0 / half_height, 0.0, 0.0],
            [0.0, 0.0, 0.0, near],
            [0.0, 0.0, -1.0, 0.0],
        ])
    }

    /// Returns an orthographic projection with half size `radius` around the view axis. Depth is 1 at `near` and 0 at
    /// `far`.
    #[must_use]
    pub fn orthographic(radius: f64, near: f64, far: f64) -> Self {
        let depth = far - near;
        Self([
            [1.0 / radius, 0.0, 0.0, 0.0],
            [0.0, 1.0 / radius, 0.0, 0.0],
            [0.0, 0.0, 1.0 / depth, far / depth],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Returns the reflection in the horizontal plane at height `up_m`.
    #[must_use]
    pub fn mirror(up_m: f64) -> Self {
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 2.0 * up_m], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Returns the composition that applies `other` first, then `self`.
    #[must_use]
    pub fn after(&self, other: &Self) -> Self {
        let cell = |i: usize, j: usize| (0..4).map(|k| self.0[i][k] * other.0[k][j]).sum();
        Self([0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| cell(i, j))))
    }

    /// Transforms a point to clip space.
    #[must_use]
    pub fn apply(&self, p: Vec3<Enu>) -> [f64; 4] {
        let [x, y, z] = p.array();
        self.0.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
    }

    /// Returns the columns, as shaders read them.
    #[must_use]
    pub fn columns(&self) -> [[f32; 4]; 4] {
        [0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| self.0[i][j] as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_perspective_maps_the_frustum_to_the_unit_cube() {
        let view =
            Matrix::view(Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, -1.0, 0.0));
        let clip = Matrix::perspective(0.5, 0.25, 0.1).after(&view).apply(Vec3::new(3.0, 6.0, 2.0));
        // 4 m ahead, 2 m to the right and 1 m down: the corner of a frustum with half sizes 0.5 and 0.25.
        assert!((clip[3] - 4.0).abs() < 1e-12);
        assert!((clip[0] / clip[3] - 1.0).abs() < 1e-12 && (clip[1] / clip[3] + 1.0).abs() < 1e-12);
        assert!((clip[2] / clip[3] - 0.1 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn exact_orthographic_depth_ranges_from_one_to_zero() {
        let boxed = Matrix::orthographic(2.0, 10.0, 30.0);
        let depth = |back: f64| boxed.apply(Vec3::new(0.0, 0.0, back))[2];
        assert!((depth(-10.0) - 1.0).abs() < 1e-12 && depth(-30.0).abs() < 1e-12);
        let mirrored = Matrix::mirror(5.0).apply(Vec3::new(1.0, 2.0, 7.0));
        assert_eq!(mirrored, [1.0, 2.0, 3.0, 1.0]);
    }
}
