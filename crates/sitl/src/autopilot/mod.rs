//! The built-in autopilot: estimator, rate, attitude, velocity and position control, modes, failsafes, mission. Its inputs are
//! sensor readings, sticks and requests, never the true state.

mod acro;
pub mod attitude;
mod automatic;
mod commands;
pub mod core;
pub mod estimator;
pub mod failsafe;
pub mod fence;
pub mod follow;
pub mod gains;
pub mod landed;
pub mod link_status;
mod manual;
pub mod mission;
mod mission_executor;
pub mod mixer;
pub mod modes;
pub mod operator_rules;
pub mod orbit;
mod pause;
pub mod sensor_health;
pub mod shaper;
pub mod smart_return;
#[cfg(test)]
pub(crate) mod testing;
pub mod trajectory;
pub mod tuning;
pub mod velocity;

pub use self::core::{Autopilot, AutopilotEvent, CONTROL_HZ, Severity};
pub use self::fence::FenceAction;
pub use self::operator_rules::OperatorRules;
pub use self::tuning::{LinkLossAction, Tuning};

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

/// Flight modes. The endpoint maps them to the MAVLink numbers of each emulated autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlightMode {
    /// Sticks control roll, pitch, yaw rate and thrust.
    Stabilized,
    /// As stabilized, with height hold.
    Altitude,
    /// Sticks control velocity. With sticks centered, the vehicle stops and holds position.
    Position,
    /// Hold position.
    Hold,
    /// Automatic take-off, then hold.
    Takeoff,
    /// Land at the current position.
    Land,
    /// Return to home and land.
    Return,
    /// Fly the uploaded mission.
    Mission,
    /// Track external setpoints.
    Offboard,
    /// Circle a point.
    Orbit,
    /// Sticks control body rates and thrust.
    Acro,
    /// Return to the take-off point along the recorded path, and land.
    SmartReturn,
    /// Follow a moving target.
    Follow,
}

/// Stick inputs, each from -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Forward (+), backward (-).
    pub forward: f64,
    /// Right (+), left (-).
    pub right: f64,
    /// Up (+), down (-).
    pub up: f64,
    /// Clockwise (+), counterclockwise (-).
    pub yaw: f64,
}

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
    /// Fly to a position and hold. `None` components keep their current values.
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
    Orbit(orbit::OrbitRequest),
    /// Point the nose at a position in automatic modes, m relative to the origin. `None` ends this.
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

/// An external setpoint. Axes set to `None` are not controlled by it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffboardSetpoint {
    /// Position, m, NED.
    pub position_m: [Option<f64>; 3],
    /// Velocity, m/s (north, east, down).
    pub velocity_m_s: [Option<f64>; 3],
    /// Acceleration, m/s² (north, east, down): flown directly without position or velocity, otherwise fed forward.
    pub acceleration_m_s2: [Option<f64>; 3],
    /// Heading, rad.
    pub yaw_rad: Option<f64>,
    /// Heading rate, rad/s.
    pub yaw_rate_rad_s: Option<f64>,
    /// Attitude and thrust (0 to 1) instead of position or velocity.
    pub attitude: Option<(Rotation<Frd, Ned>, f64)>,
    /// Body rates, rad/s, and thrust (0 to 1) instead of everything else.
    pub rates: Option<(Vec3<Frd>, f64)>,
    /// Climb rate that replaces the thrust of an attitude or of body rates, m/s up.
    pub climb_m_s: Option<f64>,
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

/// The current estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Position relative to the origin, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Angular rate with bias removed, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Horizontal position accuracy, m (1 sigma).
    pub horizontal_m: f64,
    /// Vertical position accuracy, m (1 sigma).
    pub vertical_m: f64,
    /// Position at which the estimator was initialized, relative to the origin, m. It is the origin of MAVLink's local frame.
    pub local_origin_m: Vec3<Ned>,
    /// Whether the origin of the local frame is set.
    pub local_origin_set: bool,
    /// Whether horizontal position and velocity are usable for control.
    pub position_valid: bool,
    /// Whether the attitude is aligned.
    pub attitude_valid: bool,
}

/// Landed state, as in EXTENDED_SYS_STATE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandedState {
    /// On the ground.
    OnGround,
    /// Climbing in take-off mode.
    TakingOff,
    /// Flying.
    InAir,
    /// Descending to land.
    Landing,
}

/// Status of the autopilot for telemetry.
#[derive(Debug, Clone, PartialEq)]
pub struct AutopilotStatus {
    /// Whether the motors are armed.
    pub armed: bool,
    /// The active mode.
    pub mode: FlightMode,
    /// The requested mode. A failsafe may fly another one.
    pub intended: FlightMode,
    /// Low battery level, %.
    pub battery_low_pct: f64,
    /// Critical battery level, %.
    pub battery_critical_pct: f64,
    /// Landed state.
    pub landed: LandedState,
    /// Whether a take-off climb is in progress, as a mode or a mission item.
    pub climbing_out: bool,
    /// Reasons that prevent arming now; empty if none.
    pub arming_reasons: Vec<String>,
    /// Reason of the active failsafe.
    pub failsafe: Option<String>,
    /// Home relative to the origin, m; `None` before the first fix.
    pub home_m: Option<Vec3<Ned>>,
    /// Current target position, m.
    pub target_m: Option<Vec3<Ned>>,
    /// The active external setpoint.
    pub setpoint: Option<OffboardSetpoint>,
    /// Attitude setpoint.
    pub attitude_target: Rotation<Frd, Ned>,
    /// Collective thrust setpoint, 0 to 1.
    pub thrust: f64,
    /// Current mission item, zero-based.
    pub mission_current: usize,
    /// Mission item reached since the last query, for MISSION_ITEM_REACHED.
    pub mission_reached: Option<usize>,
    /// Whether the mission is complete.
    pub mission_finished: bool,
    /// Whether the mission was interrupted and can be continued.
    pub mission_paused: bool,
    /// State of the geofence.
    pub fence: fence::FenceState,
    /// The active circle.
    pub orbit: Option<orbit::Orbit>,
    /// Number of position resets to GNSS.
    pub position_resets: u32,
    /// Sensor health.
    pub health: sensor_health::SensorStatus,
}

/// One mission item as the autopilot flies it. The endpoint keeps the corresponding MAVLink items.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MissionStep {
    /// Fly to a point.
    Waypoint {
        /// Position relative to the origin, m.
        position_m: Vec3<Ned>,
        /// Acceptance radius, m.
        accept_m: f64,
        /// Hold time, s.
        hold_s: f64,
        /// Heading at the waypoint, rad; `None` for toward the target.
        yaw_rad: Option<f64>,
    },
    /// Take off.
    Takeoff {
        /// Height above the origin, m. `None` uses the parameter, above home.
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
    /// Jump to another item, a limited number of times.
    Jump {
        /// Item index.
        to: usize,
        /// Repetitions.
        times: u32,
    },
    /// Point the nose at a position from now on, m. `None` ends this.
    LookAt(Option<Vec3<Ned>>),
    /// Circle a point with the nose toward it.
    Circle {
        /// Center relative to the origin, m.
        centre_m: Vec3<Ned>,
        /// Radius, m; negative for counterclockwise from above.
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
    /// Fly toward the next position until this close to it, m. The following items run on the way.
    Near(f64),
    /// Set home to a position from now on, m. `None` uses the vehicle position at that time.
    Home(Option<Vec3<Ned>>),
    /// Enable or disable the geofence from now on.
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
