//! A point cloud: points of a surface without triangles, in the file's axes and units.

use super::vectors::{Point, check_vertex};
use super::vertex_colors::Color;

/// Maximum number of points.
pub const MAX_POINTS: usize = 20_000_000;

/// Points with or without colors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointCloud {
    /// The first point: the others are stored relative to it, because 32-bit floats are too coarse for coordinates of maps.
    origin: Point,
    offsets: Vec<[f32; 3]>,
    colors: Vec<Color>,
    /// Number of points that were left out because the file marks them as no part of a bridge.
    pub left_out: usize,
}

impl PointCloud {
    /// Adds a point; all points must have a color, or none.
    ///
    /// # Errors
    /// Returns the point and what is allowed if a coordinate is too large or no number, or there are too many points.
    pub fn push(&mut self, p: Point, color: Option<Color>) -> Result<(), String> {
        check_vertex(self.offsets.len(), p)?;
        if self.offsets.len() == MAX_POINTS {
            return Err(format!("more than {MAX_POINTS} points (allowed: at most {MAX_POINTS}; thin the cloud out)"));
        }
        if self.offsets.is_empty() {
            self.origin = p;
        }
        self.offsets.push([0, 1, 2].map(|k: usize| (p[k] - self.origin[k]) as f32));
        self.colors.extend(color);
        Ok(())
    }

    /// Returns the cloud with a color for each point.
    #[must_use]
    pub fn with_colors(self, colors: Vec<Color>) -> Self {
        Self { colors, ..self }
    }

    /// Returns the number of points.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.offsets.len()
    }

    /// Returns whether there are no points.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.offsets.is_empty()
    }

    /// Returns whether all points have colors.
    #[must_use]
    pub const fn is_colored(&self) -> bool {
        !self.colors.is_empty() && self.colors.len() == self.offsets.len()
    }

    /// Returns the points with their colors; white without colors.
    pub fn points(&self) -> impl Iterator<Item = (Point, Color)> + Clone {
        let is_colored = self.is_colored();
        self.offsets.iter().enumerate().map(move |(k, offset)| {
            let color = if is_colored { self.colors[k] } else { [255; 3] };
            ([0, 1, 2].map(|axis: usize| self.origin[axis] + f64::from(offset[axis])), color)
        })
    }
}
