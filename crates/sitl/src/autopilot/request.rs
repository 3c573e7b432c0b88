//! Requests to the autopilot and their outcomes.

use super::flight_state::FlightMode;
use super::navigator::orbit::OrbitRequest;
use spandrel_model::frames::{Ned, Vec3};

/// A request from the endpoint or a failsafe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AutopilotRequest {
    /// Arm the motors.
    Arm {
        /// Skip the arming checks.
        force: bool,
    },
    /// Disarm the motors.
    Disarm {
        /// Disarm even in the air.
        force: bool,
    },
    /// Change the mode.
    SetMode(FlightMode),
    /// Take off. Does not arm.
    Takeoff {
        /// Height above home, m. `None` uses the parameter.
        height_m: Option<f64>,
    },
    /// Land at the current position.
    Land,
    /// Fly to a position and hold. Components set to `None` keep their current values.
    GoTo {
        /// North and east, m.
        north_east_m: Option<(f64, f64)>,
        /// Height above the origin, m.
        up_m: Option<f64>,
        /// Heading, rad.
        yaw_rad: Option<f64>,
        /// Ground speed, m/s.
        speed_m_s: Option<f64>,
    },
    /// Turn to a heading in the current automatic mode.
    Turn(TurnCommand),
    /// Start or continue the mission.
    StartMission {
        /// Zero-based index of the first item; `None` continues at the current one.
        first: Option<usize>,
    },
    /// Cruise speed for automatic modes until the end of the flight, m/s. `None` restores the parameter.
    SetSpeed(Option<f64>),
    /// Set the home position, relative to the origin, m.
    SetHome(Vec3<Ned>),
    /// Circle a point.
    Orbit(OrbitRequest),
    /// Point the nose at a position in automatic modes, m relative to the origin. `None` stops this.
    LookAt(Option<Vec3<Ned>>),
    /// Enable or disable the geofence.
    EnableFence(bool),
    /// Circle a point one radius ahead of the nose.
    CircleAhead,
    /// Continue the mission at its landing sequence.
    LandingSequence,
    /// Pause (true) or resume without leaving the mode.
    Pause(bool),
}

/// A turn to a heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnCommand {
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Turn rate, rad/s; `None` for the default.
    pub rate_rad_s: Option<f64>,
    /// Direction of rotation; `None` for the shorter one.
    pub clockwise: Option<bool>,
}

/// The outcome of an [`AutopilotRequest`]. Each variant maps to one MAV_RESULT.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RequestOutcome {
    /// Accepted or in progress.
    Accepted,
    /// Rejected for now, with the reason.
    TemporarilyRejected(String),
    /// Rejected in this state, with the reason.
    Denied(String),
    /// Failed, with the reason.
    Failed(String),
    /// Not supported by this vehicle.
    Unsupported,
}
