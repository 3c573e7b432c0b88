//! Home and rally points.

use spandrel_model::frames::{Ned, Vec3};

/// A rally point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RallyPoint {
    /// Position relative to the origin, m.
    pub position_m: Vec3<Ned>,
    /// Whether its height is relative to home and changes with it.
    pub home_relative: bool,
}

/// Home and the rally points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Home {
    /// Home relative to the origin, m.
    pub position_m: Option<Vec3<Ned>>,
    /// Whether a command set home. If so, arming does not change it.
    pub set_by_command: bool,
    /// Rally points to return to in addition to home.
    pub rally_points: Vec<RallyPoint>,
    /// Heading at arming, rad.
    pub arming_yaw_rad: Option<f64>,
}

impl Home {
    /// Moves home and the rally points whose heights are relative to it. Returns the increase in home height, in
    /// meters.
    pub fn move_to(&mut self, home_m: Vec3<Ned>) -> f64 {
        let rise_m = self.position_m.map_or(0.0, |h| h.down()) - home_m.down();
        for rally_point in self.rally_points.iter_mut().filter(|rally_point| rally_point.home_relative) {
            rally_point.position_m -= Vec3::new(0.0, 0.0, rise_m);
        }
        self.position_m = Some(home_m);
        rise_m
    }

    /// Height of home above the origin, m.
    #[must_use]
    pub fn up_m(&self) -> f64 {
        self.position_m.map_or(0.0, |h| -h.down())
    }
}
