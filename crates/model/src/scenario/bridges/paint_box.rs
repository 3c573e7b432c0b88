//! Boxes in bridge axes, by which an import assigns elements to the triangles of a model.

use crate::math;
use crate::mesh::vectors::Point;
use crate::toml::{Reader, Section};

/// Maximum distance of a corner from the origin of the bridge axes along each of them, m.
const MAX_CORNER_M: f64 = 5_000.0;
/// Minimum length of a side, m (estimate: a shorter one is a mistake).
const MIN_SIDE_M: f64 = 0.01;

/// A box with a vertical axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaintBox {
    low: Point,
    high: Point,
    turn_deg: f64,
}

impl PaintBox {
    /// Returns a box between two opposite corners, turned counterclockwise about the vertical through its middle.
    #[must_use]
    pub fn new(corners: [Point; 2], turn_deg: f64) -> Self {
        let pick = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|k: usize| pick(corners[0][k], corners[1][k]));
        Self { low: pick(f64::min), high: pick(f64::max), turn_deg }
    }

    /// Reads `box_m` and `box_turn_deg`; `None` if the table has no box, or an invalid one.
    pub(super) fn read(r: &mut Reader, s: &mut Section) -> Option<Self> {
        let before = r.problems.len();
        let corners = r.points(s, "box_m", (-MAX_CORNER_M, MAX_CORNER_M));
        let turn_deg = r.number(s, "box_turn_deg", (-360.0, 360.0), Some(0.0));
        if !s.has("box_m") && s.has("box_turn_deg") {
            r.add_problem(s, "box_turn_deg", &turn_deg.to_string(), "only with box_m", "no box");
        }
        if !s.has("box_m") || r.problems.len() > before {
            return None;
        }
        let allowed = format!("two opposite corners [x, y, z], at least {MIN_SIDE_M} m apart along each axis");
        let own = <[Point; 2]>::try_from(corners.as_slice()).ok().map(|corners| Self::new(corners, turn_deg));
        let own = own.filter(|own| (0..3).all(|k| own.high[k] - own.low[k] >= MIN_SIDE_M));
        if own.is_none() {
            r.add_problem(s, "box_m", &format!("{corners:?}"), &allowed, "not a box");
        }
        own
    }

    /// Returns whether a point is in the box or on its surface.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        let [x, y, z] = p;
        let p = if self.turn_deg == 0.0 {
            p
        } else {
            let (s, c) = math::sin_cos(self.turn_deg.to_radians());
            let middle = [0, 1].map(|k: usize| 0.5 * (self.low[k] + self.high[k]));
            let (dx, dy) = (x - middle[0], y - middle[1]);
            [middle[0] + c * dx + s * dy, middle[1] - s * dx + c * dy, z]
        };
        (0..3).all(|k| (self.low[k]..=self.high[k]).contains(&p[k]))
    }

    /// Returns the box in the form of an elements file.
    #[must_use]
    pub fn words(&self) -> String {
        let turn = if self.turn_deg == 0.0 { String::new() } else { format!(" turned by {} degrees", self.turn_deg) };
        format!("{:?}{turn}", [self.low, self.high])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_box_contains_its_surface_in_any_order_of_corners() {
        let own = PaintBox::new([[3.0, -1.0, 2.0], [-1.0, 1.0, 0.0]], 0.0);
        for inside in [[3.0, 1.0, 2.0], [-1.0, -1.0, 0.0], [0.0, 0.5, 1.0]] {
            assert!(own.contains(inside), "{inside:?}");
        }
        for outside in [[3.01, 0.0, 1.0], [0.0, -1.01, 1.0], [0.0, 0.0, 2.01]] {
            assert!(!own.contains(outside), "{outside:?}");
        }
    }

    #[test]
    fn exact_a_turned_box_contains_what_its_middle_turns_to() {
        // 10 m long, 2 m wide, around (5, 1); a point 3 m along each of x and y is 4.2 m from the middle.
        let own = PaintBox::new([[0.0, 0.0, 0.0], [10.0, 2.0, 1.0]], 45.0);
        for inside in [[5.0, 1.0, 0.5], [8.0, 4.0, 0.5], [2.0, -2.0, 0.5]] {
            assert!(own.contains(inside), "{inside:?}");
        }
        for outside in [[9.0, 1.0, 0.5], [2.0, 4.0, 0.5], [8.6, 4.6, 0.5]] {
            assert!(!own.contains(outside), "{outside:?}");
        }
    }
}
