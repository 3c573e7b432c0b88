//! Operator settings other than speeds and thresholds: failsafe actions, returns, and limits for manual and automatic
//! flight. The endpoint maps parameters to these fields; each comment names the parameters (PX4; ArduPilot).

use crate::autopilot::estimator::DEAD_RECKONING_LIMIT_S;
pub use crate::autopilot::estimator::height_reference::HeightReference;
use crate::autopilot::flight_state::FlightMode;

/// A failsafe action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailsafeResponse {
    /// Warn only.
    Warn,
    /// Stop and hold position.
    Hold,
    /// Return to home and land.
    Return,
    /// Land at the current position.
    Land,
    /// Stop the motors.
    Terminate,
}

/// Modes in which a lost link is ignored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkLossExceptions {
    /// Missions.
    pub mission: bool,
    /// Hold, takeoff and go-to.
    pub hold: bool,
    /// External setpoints.
    pub offboard: bool,
    /// Manual flight.
    pub manual: bool,
}

impl LinkLossExceptions {
    /// Returns the exceptions for PX4's bit mask: 1 = mission, 2 = hold, 4 = offboard.
    #[must_use]
    pub fn from_bits(bits: i32) -> Self {
        Self { mission: bits & 1 != 0, hold: bits & 2 != 0, offboard: bits & 4 != 0, manual: false }
    }

    /// Returns true if a lost link is ignored in a mode. Landing and returning always continue.
    #[must_use]
    pub fn includes(&self, mode: FlightMode) -> bool {
        match mode {
            FlightMode::Mission => self.mission,
            FlightMode::Hold | FlightMode::Takeoff | FlightMode::Orbit | FlightMode::Follow => self.hold,
            FlightMode::Offboard => self.offboard,
            FlightMode::Stabilized | FlightMode::Altitude | FlightMode::Position | FlightMode::Acro => self.manual,
            FlightMode::Land | FlightMode::Return | FlightMode::SmartReturn => true,
        }
    }
}

/// Action on loss of external setpoints. Manual modes require recent stick input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OffboardLoss {
    /// A manual mode with recent stick input, otherwise the action for loss of manual control.
    Sticks(FlightMode),
    /// A fixed action.
    Fixed(FailsafeResponse),
}

impl OffboardLoss {
    /// Returns the action for a value of `COM_OBL_RC_ACT`.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        Some(match number {
            0 => Self::Sticks(FlightMode::Position),
            1 => Self::Sticks(FlightMode::Altitude),
            2 => Self::Sticks(FlightMode::Stabilized),
            3 => Self::Fixed(FailsafeResponse::Return),
            4 => Self::Fixed(FailsafeResponse::Land),
            5 => Self::Fixed(FailsafeResponse::Hold),
            6 | 7 => Self::Fixed(FailsafeResponse::Terminate),
            _ => return None,
        })
    }
}

/// Failsafe actions for low, critical and emergency battery levels.
pub type BatteryResponses = [Option<FailsafeResponse>; 3];
/// The scenario's rule: return at the low level, land at the critical level.
pub const SCENARIO_BATTERY_ACTIONS: BatteryResponses = [Some(FailsafeResponse::Return), Some(FailsafeResponse::Land), None];

/// Failsafe actions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeResponses {
    /// `COM_RCL_EXCEPT`; `FS_OPTIONS`: modes in which loss of manual control is ignored.
    pub manual_loss_exceptions: LinkLossExceptions,
    /// `COM_DLL_EXCEPT`; `FS_OPTIONS`: modes in which loss of the ground station is ignored.
    pub data_link_loss_exceptions: LinkLossExceptions,
    /// `COM_OBL_RC_ACT`: action on loss of external setpoints.
    pub offboard_loss: OffboardLoss,
    /// `COM_ACT_FAIL_ACT` with `FD_ACT_EN`: action on motor failure.
    pub motor_failure: FailsafeResponse,
    /// `COM_LOW_BAT_ACT`; `BATT_FS_LOW_ACT`, `BATT_FS_CRT_ACT`: battery actions.
    pub battery: BatteryResponses,
    /// `BAT_EMERGEN_THR`: emergency battery level, %.
    pub battery_emergency_pct: f64,
    /// `BATT_LOW_VOLT`, `BATT_CRT_VOLT`: low and critical voltage, V; 0 disables the check.
    pub battery_low_v: [f64; 2],
    /// `BATT_LOW_TIMER`: time the voltage must stay below a threshold before it counts, s.
    pub battery_low_time_s: f64,
    /// `COM_POSCTL_NAVL`; `FS_EKF_ACTION`: on loss of position, also land in manual position mode.
    pub lands_without_position: bool,
    /// `FS_CRASH_CHECK`: stop the motors after a crash.
    pub crash_check: bool,
    /// `COM_RC_STICK_OV`: stick deflection for takeover, as a fraction of full deflection.
    pub takeover_deflection: f64,
    /// `COM_RC_OVERRIDE`: stick movement also takes over from external setpoints.
    pub takeover_in_offboard: bool,
    /// `COM_ARM_BAT_MIN`: minimum battery level for arming, %; 0: no minimum.
    pub min_arming_charge_pct: f64,
    /// `BATT_ARM_VOLT`: minimum voltage for arming, V; 0: no minimum.
    pub min_arming_voltage_v: f64,
    /// `COM_ARM_MIS_REQ`: arming requires a mission.
    pub arming_requires_mission: bool,
}

/// Action on a geofence breach, with the values of PX4's `GF_ACTION`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FenceAction {
    /// None (0).
    None,
    /// Warn only (1).
    Warning,
    /// Stop and hold position (2).
    Hold,
    /// Return and land (3).
    Return,
    /// Stop the motors (4).
    Terminate,
    /// Land at the current position (5).
    Land,
}

impl FenceAction {
    /// Returns the action for a parameter value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(n: i32) -> Option<Self> {
        let all = [Self::None, Self::Warning, Self::Hold, Self::Return, Self::Terminate, Self::Land];
        all.get(usize::try_from(n).ok()?).copied()
    }
}

/// Automatic enabling of the geofence, with the values of `FENCE_AUTOENABLE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FenceAutoEnable {
    /// Never.
    #[default]
    Never,
    /// Enabled in the air, disabled when the motors stop.
    InFlight,
    /// Enabled at arming, disabled when the motors stop.
    OnArming,
}

impl FenceAutoEnable {
    /// Returns the setting for a parameter value.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        match number {
            1 | 2 => Self::InFlight,
            3 => Self::OnArming,
            _ => Self::Never,
        }
    }
}

/// Candidate destinations for a return, with the values of `RTL_TYPE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReturnTargets {
    /// Whether home is a candidate. It is always the last resort.
    pub home: bool,
    /// Rally points.
    pub rally: bool,
    /// Landing position of the mission.
    pub mission_landing: bool,
}

impl ReturnTargets {
    /// Returns the destinations for a parameter value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        let (home, rally, mission_landing) = match number {
            0 => (true, true, false),
            1 => (false, true, true),
            2 | 4 => (false, false, true),
            3 => (true, true, true),
            5 => (false, true, false),
            _ => return None,
        };
        Some(Self { home, rally, mission_landing })
    }
}

/// Return settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturnRules {
    /// `RTL_TYPE`; `RALLY_INCL_HOME`: destinations.
    pub places: ReturnTargets,
    /// `RTL_SPEED`: horizontal speed, m/s; `None` for the cruise speed.
    pub speed_m_s: Option<f64>,
    /// `RTL_CLIMB_MIN`: minimum climb, m.
    pub min_climb_m: f64,
    /// `RTL_CONE_ANG`; `RTL_CONE_SLOPE`: slope (height over distance) of the cone around the destination within which
    /// the return height is lower; 0: no cone.
    pub cone_slope: f64,
    /// `RTL_MIN_DIST`: distance below which the vehicle does not climb, m.
    pub no_climb_distance_m: f64,
    /// `RTL_DESCEND_ALT`: height above the destination at which the vehicle waits, m; `None` for the arrival height.
    pub loiter_height_m: Option<f64>,
    /// `RTL_LAND_DELAY`; `RTL_LOIT_TIME`: waiting time, s; negative to wait forever.
    pub wait_s: f64,
    /// Whether a rally point's height is the return height (ArduPilot).
    pub uses_rally_height: bool,
    /// `WP_YAW_BEHAVIOR` 1, 3: turn to the takeoff heading at the destination.
    pub turns_to_takeoff_heading: bool,
    /// `RTL_ALT_FINAL`: hold at this height instead of landing, m; 0: land.
    pub final_height_m: f64,
}

/// Heading in automatic modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeadingRule {
    /// Toward the target.
    Target,
    /// Toward the target, except during a return.
    TargetExceptReturn,
    /// Toward home.
    Home,
    /// Away from home.
    AwayFromHome,
    /// Along the path.
    Path,
    /// Unchanged.
    Fixed,
}

impl HeadingRule {
    /// Returns the rule for a value of `MPC_YAW_MODE`.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        let all = [Self::Target, Self::Home, Self::AwayFromHome, Self::Path, Self::Target, Self::Fixed];
        all.get(usize::try_from(number).ok()?).copied()
    }
}

/// Limits in addition to the airframe's; infinite for no limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightEnvelope {
    /// `MPC_VEL_MANUAL`; `LOIT_SPEED`: horizontal speed in manual flight, m/s.
    pub manual_speed_m_s: f64,
    /// `PILOT_SPEED_UP`: climb rate in manual flight, m/s.
    pub manual_climb_rate_m_s: f64,
    /// `PILOT_SPEED_DN`: descent rate in manual flight, m/s.
    pub manual_descent_rate_m_s: f64,
    /// `MPC_MAN_Y_MAX`; `PILOT_Y_RATE`: yaw rate in manual flight, rad/s.
    pub manual_yaw_rate_rad_s: f64,
    /// `MPC_MAN_TILT_MAX`; `ANGLE_MAX`: tilt in manual flight, rad.
    pub manual_tilt_rad: f64,
    /// `MPC_ACC_HOR`; `WPNAV_ACCEL`: horizontal acceleration in automatic modes, m/s².
    pub acceleration_m_s2: f64,
    /// `MPC_ACC_UP_MAX`, `MPC_ACC_DOWN_MAX`; `WPNAV_ACCEL_Z`: vertical acceleration in automatic modes, m/s².
    pub climb_acceleration_m_s2: f64,
    /// `LAND_SPEED_HIGH`: descent rate during a landing, except for the last few meters, m/s.
    pub landing_descent_rate_m_s: f64,
}

impl FlightEnvelope {
    /// No limits beyond the airframe's.
    pub const UNLIMITED: Self = Self {
        manual_speed_m_s: f64::INFINITY,
        manual_climb_rate_m_s: f64::INFINITY,
        manual_descent_rate_m_s: f64::INFINITY,
        manual_yaw_rate_rad_s: f64::INFINITY,
        manual_tilt_rad: f64::INFINITY,
        acceleration_m_s2: f64::INFINITY,
        climb_acceleration_m_s2: f64::INFINITY,
        landing_descent_rate_m_s: f64::INFINITY,
    };
}

/// Required mission items, with the values of `MIS_TKO_LAND_REQ`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MissionRequirement {
    /// None (0).
    #[default]
    Nothing,
    /// Takeoff (1).
    Takeoff,
    /// Landing (2).
    Landing,
    /// Both (3).
    Both,
    /// Both or neither (4).
    BothOrNeither,
}

impl MissionRequirement {
    /// Returns the requirement for a parameter value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        let all = [Self::Nothing, Self::Takeoff, Self::Landing, Self::Both, Self::BothOrNeither];
        all.get(usize::try_from(number).ok()?).copied()
    }
}

/// Active parts of the geofence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FenceParts {
    /// Bit 0 of `FENCE_TYPE`: maximum height.
    pub height: bool,
    /// Bit 1: maximum distance from home.
    pub distance: bool,
    /// Bit 2: inclusion and exclusion zones.
    pub areas: bool,
    /// Bit 3, `FENCE_ALT_MIN`: minimum height above home, m. Active once the vehicle has been above it.
    pub floor_m: Option<f64>,
    /// `FENCE_AUTOENABLE`: automatic enabling.
    pub auto: FenceAutoEnable,
}

/// Supported bits of `GUID_OPTIONS` (ArduCopter).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GuidedOptions {
    /// Bit 0: the transmitter can arm in GUIDED.
    pub transmitter_can_arm: bool,
    /// The yaw stick controls the heading in GUIDED. Bit 2 disables this.
    pub yaw_stick_enabled: bool,
    /// The thrust field of an attitude setpoint is a climb rate; with bit 3, it is the thrust.
    pub thrust_is_climb_rate: bool,
}

impl GuidedOptions {
    /// Returns the options for a parameter value.
    #[must_use]
    pub fn from_bits(bits: i32) -> Self {
        let has = |bit: i32| bits & 1 << bit != 0;
        Self { transmitter_can_arm: has(0), yaw_stick_enabled: !has(2), thrust_is_climb_rate: !has(3) }
    }
}

/// All operator settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperatorRules {
    /// Failsafe actions.
    pub responses: FailsafeResponses,
    /// Return settings.
    pub return_rules: ReturnRules,
    /// `MPC_YAW_MODE`; `WP_YAW_BEHAVIOR`: heading in automatic modes.
    pub heading: HeadingRule,
    /// Additional limits.
    pub envelope: FlightEnvelope,
    /// `MIS_TKO_LAND_REQ`: required mission items.
    pub mission_requirement: MissionRequirement,
    /// `MIS_DIST_1WP`: maximum distance of the first waypoint from home, m; 0 or less: no limit.
    pub max_first_waypoint_distance_m: f64,
    /// `MIS_RESTART`: restart the mission on every entry into mission mode.
    pub mission_restarts: bool,
    /// Bit 1 of `AUTO_OPTIONS`: a mission takes off immediately after arming. Otherwise it waits for a raised throttle
    /// or a start command.
    pub mission_takes_off_after_arming: bool,
    /// `FENCE_TYPE`, `FENCE_ALT_MIN`: parts of the geofence.
    pub fence: FenceParts,
    /// `CIRCLE_RADIUS`: default radius for an orbit, or for a circle entered by a mode change, m.
    pub orbit_radius_m: f64,
    /// `GUID_OPTIONS`: options for guided flight and external setpoints.
    pub guided: GuidedOptions,
    /// `EKF2_HGT_REF`; `EK3_SRC1_POSZ`: height reference.
    pub height_reference: HeightReference,
    /// `EKF2_NOAID_TOUT`: time without GNSS and optical flow after which the position is lost, s.
    pub dead_reckoning_limit_s: f64,
}

impl Default for OperatorRules {
    fn default() -> Self {
        Self {
            responses: FailsafeResponses {
                manual_loss_exceptions: LinkLossExceptions::from_bits(7),
                data_link_loss_exceptions: LinkLossExceptions::default(),
                offboard_loss: OffboardLoss::Sticks(FlightMode::Position),
                motor_failure: FailsafeResponse::Warn,
                battery: [None; 3],
                battery_emergency_pct: 5.0,
                battery_low_v: [0.0; 2],
                battery_low_time_s: 10.0,
                lands_without_position: false,
                crash_check: true,
                takeover_deflection: 0.3,
                takeover_in_offboard: false,
                min_arming_charge_pct: 0.0,
                min_arming_voltage_v: 0.0,
                arming_requires_mission: false,
            },
            return_rules: ReturnRules {
                places: ReturnTargets { home: true, rally: true, mission_landing: false },
                speed_m_s: None,
                min_climb_m: 0.0,
                cone_slope: 0.0,
                no_climb_distance_m: 5.0,
                loiter_height_m: Some(10.0),
                wait_s: 0.0,
                uses_rally_height: false,
                turns_to_takeoff_heading: false,
                final_height_m: 0.0,
            },
            heading: HeadingRule::Target,
            envelope: FlightEnvelope::UNLIMITED,
            mission_requirement: MissionRequirement::Nothing,
            max_first_waypoint_distance_m: 10_000.0,
            mission_restarts: false,
            mission_takes_off_after_arming: true,
            fence: FenceParts { height: true, distance: true, areas: true, floor_m: None, auto: FenceAutoEnable::Never },
            orbit_radius_m: 5.0,
            guided: GuidedOptions::default(),
            height_reference: HeightReference::default(),
            dead_reckoning_limit_s: DEAD_RECKONING_LIMIT_S,
        }
    }
}
