//! The built-in autopilot: estimator, rate, attitude, velocity, position, modes, failsafes, mission. Sees sensor readings,
//! stick intents and requests; never the truth.

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

/// Flight modes; the MAVLink numbers of each flavour live in the endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlightMode {
    /// Sticks command roll, pitch, yaw rate and thrust.
    Stabilized,
    /// As stabilized, height held by the autopilot.
    Altitude,
    /// Sticks command velocity; let go, it stops and holds.
    Position,
    /// Hold position.
    Hold,
    /// Automatic take-off, then hold.
    Takeoff,
    /// Land here.
    Land,
    /// Return to home and land.
    Return,
    /// Fly the uploaded mission.
    Mission,
    /// Follow external set-points.
    Offboard,
    /// Circle a place.
    Orbit,
    /// Sticks command body rates and thrust.
    Acro,
    /// Return to the take-off point along the path flown, and land.
    SmartReturn,
    /// Follow a moving target.
    Follow,
}

/// Stick intent, each in [-1, 1]: forward, right, up, clockwise positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Forward (+), backward (-).
    pub forward: f64,
    /// Right (+), left (-).
    pub right: f64,
    /// Up (+), down (-).
    pub up: f64,
    /// Clockwise (+), counter-clockwise (-).
    pub yaw: f64,
}

/// What the endpoint (or a failsafe) asks of the autopilot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AutopilotRequest {
    /// Arm; `force` skips the checks.
    Arm {
        /// Skip the checks.
        force: bool,
    },
    /// Disarm; `force` also in the air.
    Disarm {
        /// Also in the air.
        force: bool,
    },
    /// Change the mode.
    SetMode(FlightMode),
    /// Take off to a height above home, m (`None`: the parameter's), arming is not implied.
    Takeoff {
        /// Height above home, m.
        height_m: Option<f64>,
    },
    /// Land here.
    Land,
    /// Fly to a position and hold; `None` components keep the present value.
    GoTo {
        /// North, east, m.
        north_east_m: Option<(f64, f64)>,
        /// Height, m up about the origin.
        up_m: Option<f64>,
        /// Heading, rad.
        yaw_rad: Option<f64>,
        /// Ground speed, m/s.
        speed_m_s: Option<f64>,
    },
    /// Turn to a heading in the automatic mode that is flown.
    Turn(TurnCommand),
    /// Start or go on with the mission at an item.
    StartMission {
        /// First item, or `None` to go on.
        first: Option<usize>,
    },
    /// Cruise speed for automatic modes until the end of the flight, m/s; `None`: the parameter's again.
    SetSpeed(Option<f64>),
    /// Home position about the origin, m.
    SetHome(Vec3<Ned>),
    /// Circle a place.
    Orbit(orbit::OrbitRequest),
    /// Turn towards a place in automatic modes, m about the origin; `None`: no more.
    LookAt(Option<Vec3<Ned>>),
    /// The geofence on or off.
    EnableFence(bool),
    /// Circle a point one radius ahead of the nose.
    CircleAhead,
    /// Fly the mission from its landing sequence on.
    LandingSequence,
    /// Pause (true) or resume what is flown, without leaving the mode.
    Pause(bool),
}

/// A turn to a heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnCommand {
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Turn rate, rad/s; `None`: the vehicle's own.
    pub rate_rad_s: Option<f64>,
    /// Direction of rotation; `None`: the shorter way.
    pub clockwise: Option<bool>,
}

/// An offboard set-point; `None` axes are not controlled by it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OffboardSetpoint {
    /// Position, m.
    pub position_m: [Option<f64>; 3],
    /// Velocity, m/s (north, east, down).
    pub velocity_m_s: [Option<f64>; 3],
    /// Acceleration, m/s² (north, east, down): flown where neither position nor velocity is asked for, fed forward elsewhere.
    pub acceleration_m_s2: [Option<f64>; 3],
    /// Heading, rad.
    pub yaw_rad: Option<f64>,
    /// Heading rate, rad/s.
    pub yaw_rate_rad_s: Option<f64>,
    /// Attitude and thrust (0..1) instead of position or velocity.
    pub attitude: Option<(Rotation<Frd, Ned>, f64)>,
    /// Body rates, rad/s, and thrust (0..1) instead of all else.
    pub rates: Option<(Vec3<Frd>, f64)>,
    /// Climb rate in place of the thrust of an attitude or of body rates, m/s up.
    pub climb_m_s: Option<f64>,
}

/// The answer to a [`AutopilotRequest`]; maps one to one to MAV_RESULT.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RequestOutcome {
    /// Done or begun.
    Accepted,
    /// Not now; the reason in words.
    TemporarilyRejected(String),
    /// Never in this state; the reason in words.
    Denied(String),
    /// Tried and failed; the reason in words.
    Failed(String),
    /// Not a thing this vehicle does.
    Unsupported,
}

/// What the estimator believes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Position about the origin, m.
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
    /// Where the estimator was initialized, about the origin, m: the origin of MAVLink's local frame.
    pub local_origin_m: Vec3<Ned>,
    /// The local frame's origin is known and stays.
    pub local_origin_set: bool,
    /// Horizontal position and velocity are usable for control.
    pub position_valid: bool,
    /// Attitude is aligned.
    pub attitude_valid: bool,
}

/// Ground or air, as EXTENDED_SYS_STATE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandedState {
    /// On the ground.
    OnGround,
    /// Climbing away in take-off mode.
    TakingOff,
    /// Flying.
    InAir,
    /// Descending to land.
    Landing,
}

/// What the autopilot tells the world.
#[derive(Debug, Clone, PartialEq)]
pub struct AutopilotStatus {
    /// Motors may turn.
    pub armed: bool,
    /// Mode.
    pub mode: FlightMode,
    /// The mode that was asked for; a failsafe may fly another meanwhile.
    pub intended: FlightMode,
    /// Charge below which it warns, and below which it is critical, percent.
    pub battery_low_pct: f64,
    /// See `battery_low_pct`.
    pub battery_critical_pct: f64,
    /// Ground or air.
    pub landed: LandedState,
    /// A take-off climbs to its height, as a mode or as a mission's step.
    pub climbing_out: bool,
    /// Why arming would be refused now; empty when it would not.
    pub arming_reasons: Vec<String>,
    /// A failsafe acts; its reason.
    pub failsafe: Option<String>,
    /// Home about the origin, m; `None` before the first fix.
    pub home_m: Option<Vec3<Ned>>,
    /// Present position target, if any, m.
    pub target_m: Option<Vec3<Ned>>,
    /// The external setpoint that is flown.
    pub setpoint: Option<OffboardSetpoint>,
    /// Attitude set-point.
    pub attitude_target: Rotation<Frd, Ned>,
    /// Collective thrust set-point 0..1.
    pub thrust: f64,
    /// Current mission item (0-based).
    pub mission_current: usize,
    /// A mission item reached since the last look, for MISSION_ITEM_REACHED.
    pub mission_reached: Option<usize>,
    /// The mission has been flown to its end.
    pub mission_finished: bool,
    /// The mission was left on its way and goes on where it was left.
    pub mission_paused: bool,
    /// The geofence.
    pub fence: fence::FenceState,
    /// The circle that is flown.
    pub orbit: Option<orbit::Orbit>,
    /// How often the position was set to the receiver's.
    pub position_resets: u32,
    /// What works.
    pub health: sensor_health::SensorStatus,
}

/// One mission step as the autopilot flies it; the endpoint keeps the MAVLink items beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MissionStep {
    /// Fly to a point.
    Waypoint {
        /// Target about the origin, m.
        position_m: Vec3<Ned>,
        /// Counts as reached within, m.
        accept_m: f64,
        /// Stay, s.
        hold_s: f64,
        /// Heading there, rad; `None`: towards the target.
        yaw_rad: Option<f64>,
    },
    /// Take off to a height, m up about the origin.
    Takeoff {
        /// Height, m up about the origin; `None`: the parameter's over home.
        up_m: Option<f64>,
    },
    /// Land at a point; `None`: here.
    Land {
        /// Where, m.
        position_m: Option<Vec3<Ned>>,
    },
    /// Return to home and land.
    Return,
    /// Change the cruise speed, m/s; `None`: back to the parameter's.
    Speed(Option<f64>),
    /// Wait, s.
    Delay(f64),
    /// Wait until a time of day in UTC.
    DelayUntil(TimeOfDay),
    /// Go to another item a number of times.
    Jump {
        /// Item index.
        to: usize,
        /// Repetitions.
        times: u32,
    },
    /// Turn towards a place from here on, m; `None`: no more.
    LookAt(Option<Vec3<Ned>>),
    /// Fly round a place, the nose to it.
    Circle {
        /// Its middle about the origin, m.
        centre_m: Vec3<Ned>,
        /// Its radius, m; counter-clockwise from above where negative.
        radius_m: f64,
        /// How often.
        turns: f64,
    },
    /// Turn to a heading, rad.
    Turn {
        /// The heading, or the way to turn from the present one (clockwise positive).
        yaw_rad: f64,
        /// From the present heading.
        relative: bool,
        /// Turn rate, rad/s; `None`: the vehicle's own.
        rate_rad_s: Option<f64>,
    },
    /// Fly on towards the next place until this near to it, m: what follows is done on the way.
    Near(f64),
    /// Home is at a place from here on, m; `None`: where the vehicle is then.
    Home(Option<Vec3<Ned>>),
    /// The geofence on or off from here on.
    Fence(bool),
    /// The landing sequence begins after this step.
    LandingSequence,
    /// Something for the payload that the endpoint does when this item becomes current.
    Payload,
}

/// A time of day, UTC. A part that is `None` matches whatever the clock shows.
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

    /// Seconds from a UTC time (Unix seconds) until the next moment that matches; 0 if it matches now.
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
