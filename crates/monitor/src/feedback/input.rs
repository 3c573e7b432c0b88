//! Inputs to the feedback rules.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::guidance::WayTo;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// A displacement relative to the aircraft's heading. Up is vertical, regardless of the aircraft's tilt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeadingOffset {
    /// Horizontal distance ahead, m.
    pub forward_m: f64,
    /// Horizontal distance to the right, m.
    pub right_m: f64,
    /// Vertical distance, m.
    pub up_m: f64,
}

impl HeadingOffset {
    /// Converts a displacement in the scenario frame, m. `heading_rad` is clockwise from north.
    #[must_use]
    pub fn new(displacement_m: Vec3<Enu>, heading_rad: f64) -> Self {
        let [east, north, up_m] = displacement_m.array();
        let (sin, cos) = math::sin_cos(heading_rad);
        Self { forward_m: east * sin + north * cos, right_m: east * cos - north * sin, up_m }
    }

    /// Returns the way to the place at this offset.
    #[must_use]
    pub fn way(&self) -> WayTo {
        WayTo {
            distance_m: math::hypot(self.forward_m, self.right_m),
            bearing_rad: math::atan2(self.right_m, self.forward_m),
            up_m: self.up_m,
        }
    }

    /// Returns the length of the displacement, m.
    #[must_use]
    pub fn length_m(self) -> f64 {
        (self.forward_m * self.forward_m + self.right_m * self.right_m + self.up_m * self.up_m).sqrt()
    }
}

/// The drone's distance from the inspected surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceDistance {
    /// Distance from the surface, computed from the position relative to the path, m; negative behind the surface.
    pub actual_m: f64,
    /// Recommended distance, m.
    pub recommended_m: f64,
    /// Largest deviation from the recommended distance without a cue, m.
    pub tolerance_m: f64,
    /// Distance from the path if the drone were at the recommended distance from the surface, m.
    pub sideways_m: f64,
}

/// The drone's position relative to one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximity {
    /// Distance to the task's path (l*), m.
    pub distance_m: f64,
    /// The task's on-path threshold, m.
    pub threshold_m: f64,
    /// Displacement from the drone to the nearest position on the path.
    pub way_back: HeadingOffset,
    /// Distance from the inspected surface; `None` if the task has no recommended distance.
    pub surface: Option<SurfaceDistance>,
    /// Minimum clearance in this task, m; `None` to use the scenario's value.
    pub too_close_m: Option<f64>,
    /// Task number in the scenario.
    pub id: u32,
    /// Whether the drone is nearest to an end of the path.
    pub at_path_end: bool,
    /// Share of the path that the drone has flown.
    pub flown_share: f64,
    /// Whether the drone has flown enough of the path for the task to be done.
    pub done: bool,
    /// Whether nothing of the path remains to be flown.
    pub finished: bool,
}

/// Inputs to the feedback rules at one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackInput {
    /// Current simulation time.
    pub time: SimTime,
    /// Whether the session is running (from lift-off to its end).
    pub in_session: bool,
    /// Whether the drone is in the air. On the ground, proximity warnings are suppressed.
    pub airborne: bool,
    /// Speed (magnitude of the velocity), m/s.
    pub speed_m_s: f64,
    /// Remaining battery charge, %.
    pub battery_pct: Option<f64>,
    /// Distance to the nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Kind of object in contact, excluding touchdowns on the pad.
    pub contact: ContactKind,
    /// Name of the object in contact, if the site knows it.
    pub contact_name: Option<String>,
    /// The drone's proximity to each task, in scenario order.
    pub tasks: Vec<TaskProximity>,
    /// Index of the task whose path the drone is on, if any.
    pub current_task: Option<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest rounding error of the rotation, m.
    const ROUNDING_TOLERANCE_M: f64 = 1e-12;

    #[test]
    fn exact_displacements_are_relative_to_the_heading() {
        // 3 m east, 4 m north, 12 m up.
        let displacement_m = Vec3::new(3.0, 4.0, 12.0);
        for (heading_deg, forward_m, right_m) in [(0.0, 4.0, 3.0), (90.0, 3.0, -4.0), (180.0, -4.0, -3.0), (270.0_f64, -3.0, 4.0)]
        {
            let offset = HeadingOffset::new(displacement_m, heading_deg.to_radians());
            assert!((offset.forward_m - forward_m).abs() < ROUNDING_TOLERANCE_M, "{heading_deg}: {offset:?}");
            assert!((offset.right_m - right_m).abs() < ROUNDING_TOLERANCE_M, "{heading_deg}: {offset:?}");
            assert_eq!(offset.up_m, 12.0);
            assert!((offset.length_m() - 13.0).abs() < ROUNDING_TOLERANCE_M);
        }
    }
}
