//! Mission items as the autopilot flies them.

use spandrel_model::frames::{Ned, Vec3};

/// One mission item as the autopilot flies it. The endpoint stores the corresponding MAVLink items.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MissionStep {
    /// Fly to a point.
    Waypoint {
        /// Position relative to the origin, m.
        position_m: Vec3<Ned>,
        /// Acceptance radius, m.
        acceptance_radius_m: f64,
        /// Hold time, s.
        hold_s: f64,
        /// Heading at the waypoint, rad; `None`: toward the target.
        yaw_rad: Option<f64>,
    },
    /// Take off.
    Takeoff {
        /// Height above the origin, m. `None` uses the parameter, which is relative to home.
        up_m: Option<f64>,
    },
    /// Land.
    Land {
        /// Landing position, m; `None` for the current position.
        position_m: Option<Vec3<Ned>>,
    },
    /// Return to home and land.
    Return,
    /// Change the cruise speed, m/s. `None` restores the parameter.
    Speed(Option<f64>),
    /// Wait, s.
    Delay(f64),
    /// Wait until a time of day in UTC.
    DelayUntil(TimeOfDay),
    /// Jump to another item a limited number of times.
    Jump {
        /// Item index.
        to: usize,
        /// Number of repetitions.
        times: u32,
    },
    /// From now on, point the nose at a position, m. `None` stops this.
    LookAt(Option<Vec3<Ned>>),
    /// Circle a point with the nose toward it.
    Circle {
        /// Center relative to the origin, m.
        center_m: Vec3<Ned>,
        /// Radius, m; negative for counterclockwise as seen from above.
        radius_m: f64,
        /// Number of turns.
        turns: f64,
    },
    /// Turn to a heading.
    Turn {
        /// Heading, or angle relative to the current heading (clockwise positive), rad.
        yaw_rad: f64,
        /// Whether the angle is relative to the current heading.
        relative: bool,
        /// Turn rate, rad/s; `None` for the default.
        rate_rad_s: Option<f64>,
    },
    /// Fly toward the next position until within this distance of it, m. The following items run en route.
    Near(f64),
    /// Set home to a position, m. `None` uses the vehicle position at that time.
    Home(Option<Vec3<Ned>>),
    /// Enable or disable the geofence.
    Fence(bool),
    /// Start of the landing sequence.
    LandingSequence,
    /// A payload action that the endpoint performs when this item becomes current.
    Payload,
}

/// A time of day, UTC. Parts set to `None` match any value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeOfDay {
    /// Hour, 0 to 23.
    pub hour: Option<u8>,
    /// Minute, 0 to 59.
    pub minute: Option<u8>,
    /// Second, 0 to 59.
    pub second: Option<u8>,
}

impl TimeOfDay {
    const HOUR_S: i64 = 3_600;
    const MINUTE_S: i64 = 60;
    const DAY_S: i64 = 86_400;

    /// Seconds from a UTC time (Unix seconds) to the next matching time; 0 if it matches now.
    #[must_use]
    pub fn wait_s(self, unix_s: i64) -> i64 {
        let fits = |part: Option<u8>, value: i64| part.is_none_or(|part| i64::from(part) == value);
        let matches = |at: i64| {
            let s = at.rem_euclid(Self::DAY_S);
            let (hour, minute, second) = (s / Self::HOUR_S, s % Self::HOUR_S / Self::MINUTE_S, s % Self::MINUTE_S);
            fits(self.hour, hour) && fits(self.minute, minute) && fits(self.second, second)
        };
        (0..Self::DAY_S).find(|wait| matches(unix_s + wait)).unwrap_or(0)
    }
}

impl MissionStep {
    /// Returns the item's position for modification, if it has one.
    pub fn position_mut(&mut self) -> Option<&mut Vec3<Ned>> {
        match self {
            Self::Waypoint { position_m, .. } | Self::Land { position_m: Some(position_m) } => Some(position_m),
            Self::Circle { center_m, .. } => Some(center_m),
            Self::Takeoff { .. }
            | Self::Land { position_m: None }
            | Self::Return
            | Self::Speed(_)
            | Self::Delay(_)
            | Self::DelayUntil(_)
            | Self::Jump { .. }
            | Self::LookAt(_)
            | Self::Turn { .. }
            | Self::Near(_)
            | Self::Home(_)
            | Self::Fence(_)
            | Self::LandingSequence
            | Self::Payload => None,
        }
    }

    /// Returns true if the item flies along the trajectory or waits at its end.
    pub fn stops_before_end(&self) -> bool {
        matches!(self, Self::Waypoint { .. } | Self::Near(_) | Self::Delay(_) | Self::Turn { .. })
    }

    /// Returns true if the item takes time and can resume after an interruption.
    pub fn continues(&self) -> bool {
        use MissionStep as S;
        match self {
            S::Waypoint { .. } | S::Takeoff { .. } | S::Land { .. } | S::Return | S::Delay(_) | S::DelayUntil(_) => true,
            S::Circle { .. } | S::Turn { .. } | S::Near(_) => true,
            S::Speed(_) | S::Jump { .. } | S::LookAt(_) | S::Home(_) | S::Fence(_) => false,
            S::LandingSequence | S::Payload => false,
        }
    }
}
