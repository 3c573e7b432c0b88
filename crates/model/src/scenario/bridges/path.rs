//! Reference paths of tasks in bridge axes. Each bridge type derives its own paths from its dimensions.

use super::solid::{LocalPoint, Placement};
use crate::frames::{Enu, Vec3};
use crate::math;

/// Maximum spacing of reference points, m (at most 1 m is allowed: docs/src/reference/assessment.md, "On path").
pub const SPACING_M: f64 = 0.8;

pub use super::task_kind::TaskKind;

/// Part of a bridge at which a path is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PathPlace {
    /// Number of the span, from 1 at the start; `None` for the middle one.
    pub span: Option<usize>,
    /// Number of the support: 0 for the abutment at the start, then the piers; `None` for the first pier.
    pub support: Option<usize>,
}

/// Reference path of a task, with a viewing direction at each point.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskPath {
    /// Points, at most 1 m apart, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Unit vectors toward the inspected surface.
    pub viewing_directions: Vec<Vec3<Enu>>,
    /// True if the path returns to its start.
    pub closed: bool,
}

/// A path in bridge axes.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalPath {
    /// Points, m.
    pub(super) points: Vec<LocalPoint>,
    /// Directions toward the inspected surface, of any length.
    pub(super) viewing_directions: Vec<LocalPoint>,
    /// True if the path returns to its start.
    pub(super) closed: bool,
}

impl LocalPath {
    /// Transforms the path to site coordinates.
    #[must_use]
    pub fn to_site(&self, placement: &Placement) -> TaskPath {
        TaskPath {
            path_m: self.points.iter().map(|p| placement.point(*p)).collect(),
            viewing_directions: self.viewing_directions.iter().map(|d| placement.direction(*d).unit()).collect(),
            closed: self.closed,
        }
    }
}

/// Returns values from `a` to `b` in equal steps of at most [`SPACING_M`].
pub(super) fn equal_steps(a: f64, b: f64) -> Vec<f64> {
    let n = ((b - a).abs() / SPACING_M).ceil().max(1.0);
    (0..=n as i32).map(|k| a + (b - a) * f64::from(k) / n).collect()
}

/// Returns the points of a level loop around a rectangle on the bridge's centerline, at a distance in meters from its sides and rounded
/// at its corners, and the horizontal unit vectors that point away from the rectangle.
pub(super) fn rectangle_loop((x, z): (f64, f64), (hx, hy): (f64, f64), off_m: f64) -> (Vec<LocalPoint>, Vec<[f64; 2]>) {
    let mut points = Vec::new();
    let mut normals = Vec::new();
    let mut add = |from_x: f64, from_y: f64, nx: f64, ny: f64| {
        points.push([x + from_x, from_y, z]);
        normals.push([nx, ny]);
    };
    let corner_steps = (0.5 * math::PI * off_m / SPACING_M).ceil() as i32;
    let corners = [(hx, -hy, -math::FRAC_PI_2), (hx, hy, 0.0), (-hx, hy, math::FRAC_PI_2), (-hx, -hy, math::PI)];
    for (k, (cx, cy, from)) in corners.into_iter().enumerate() {
        for step in 0..=corner_steps {
            let angle = from + math::FRAC_PI_2 * f64::from(step) / f64::from(corner_steps);
            let (s, c) = math::sin_cos(angle);
            add(cx + off_m * c, cy + off_m * s, c, s);
        }
        // The line along the face to the next corner, without its endpoints, which are part of the corners.
        let (nx, ny, _) = corners[(k + 1) % 4];
        let (s, c) = math::sin_cos(from + math::FRAC_PI_2);
        let along = equal_steps(0.0, (nx - cx).abs().max((ny - cy).abs()));
        let last = along.len() - 1;
        for share in along.iter().take(last).skip(1).map(|d| d / along[last]) {
            let (x, y) = (math::lerp(cx, nx, share), math::lerp(cy, ny, share));
            add(x + off_m * c, y + off_m * s, c, s);
        }
    }
    (points, normals)
}
