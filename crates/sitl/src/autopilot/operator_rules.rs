//! What an operator sets beyond speeds and thresholds: reactions to failures, the way home, limits of sticks and automatic flight. The endpoint maps
//! parameters to these; each doc line names them (PX4; ArduPilot).

use super::FlightMode;

/// A reaction to a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailsafeResponse {
    /// A text.
    Warn,
    /// Stop and hold.
    Hold,
    /// Return to home and land.
    Return,
    /// Land here.
    Land,
    /// Motors off.
    Terminate,
}

/// Modes in which a lost link changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkLossExceptions {
    /// Missions.
    pub mission: bool,
    /// Hold, take-off and go-to.
    pub hold: bool,
    /// External set-points.
    pub offboard: bool,
    /// Flight by the sticks.
    pub manual: bool,
}

impl LinkLossExceptions {
    /// From PX4's mask: 1 mission, 2 hold, 4 offboard.
    #[must_use]
    pub fn from_bits(bits: i32) -> Self {
        Self { mission: bits & 1 != 0, hold: bits & 2 != 0, offboard: bits & 4 != 0, manual: false }
    }

    /// Whether a lost link changes nothing in a mode. Landing and returning go on in any case.
    #[must_use]
    pub fn cover(&self, mode: FlightMode) -> bool {
        match mode {
            FlightMode::Mission => self.mission,
            FlightMode::Hold | FlightMode::Takeoff | FlightMode::Orbit | FlightMode::Follow => self.hold,
            FlightMode::Offboard => self.offboard,
            FlightMode::Stabilized | FlightMode::Altitude | FlightMode::Position | FlightMode::Acro => self.manual,
            FlightMode::Land | FlightMode::Return | FlightMode::SmartReturn => true,
        }
    }
}

/// Reaction to lost external set-points; the stick modes need fresh sticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OffboardLoss {
    /// A stick mode where somebody has the sticks, else the reaction to lost manual control.
    Sticks(FlightMode),
    /// A fixed reaction.
    Fixed(FailsafeResponse),
}

impl OffboardLoss {
    /// From the number of `COM_OBL_RC_ACT`.
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

/// Reactions to the battery: when it is low, critical, and an emergency.
pub type BatteryResponses = [Option<FailsafeResponse>; 3];
/// The job's rule: back when low, down when critical.
pub const JOB_BATTERY: BatteryResponses = [Some(FailsafeResponse::Return), Some(FailsafeResponse::Land), None];

/// Reactions to failures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeResponses {
    /// `COM_RCL_EXCEPT`; `FS_OPTIONS`: where lost sticks change nothing.
    pub manual_loss_except: LinkLossExceptions,
    /// `COM_DLL_EXCEPT`; `FS_OPTIONS`: where a lost ground station changes nothing.
    pub data_link_loss_except: LinkLossExceptions,
    /// `COM_OBL_RC_ACT`: lost external set-points.
    pub offboard_loss: OffboardLoss,
    /// `COM_ACT_FAIL_ACT` with `FD_ACT_EN`: a failed motor.
    pub motor_failure: FailsafeResponse,
    /// `COM_LOW_BAT_ACT`; `BATT_FS_LOW_ACT`, `BATT_FS_CRT_ACT`: the battery.
    pub battery: BatteryResponses,
    /// `BAT_EMERGEN_THR`: emergency, %.
    pub battery_emergency_pct: f64,
    /// `BATT_LOW_VOLT`, `BATT_CRT_VOLT`: low and critical voltage, V; 0: not looked at.
    pub battery_low_v: [f64; 2],
    /// `BATT_LOW_TIMER`: for this long before it counts, s.
    pub battery_low_s: f64,
    /// `COM_POSCTL_NAVL`; `FS_EKF_ACTION`: a pilot without position lands, too.
    pub blind_lands: bool,
    /// `FS_CRASH_CHECK`: motors stop after a crash.
    pub crash_check: bool,
    /// `COM_RC_STICK_OV`: sticks take over beyond this share of their travel.
    pub takeover_share: f64,
    /// `COM_RC_OVERRIDE`: sticks take over from external set-points, too.
    pub takeover_offboard: bool,
    /// `COM_ARM_BAT_MIN`: least charge for arming, %; 0: none.
    pub arm_charge_pct: f64,
    /// `BATT_ARM_VOLT`: least voltage for arming, V; 0: none.
    pub arm_voltage_v: f64,
    /// `COM_ARM_MIS_REQ`: arming needs a mission.
    pub arm_needs_mission: bool,
}

/// When the fence is switched by itself, by the number of `FENCE_AUTOENABLE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FenceSwitching {
    /// Never.
    #[default]
    Never,
    /// On in the air, off when motors stop.
    InTheAir,
    /// On when motors are armed, off when they stop.
    AtArming,
}

impl FenceSwitching {
    /// From the parameter's number.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        match number {
            1 | 2 => Self::InTheAir,
            3 => Self::AtArming,
            _ => Self::Never,
        }
    }
}

/// Where a return goes, by the number of `RTL_TYPE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReturnTargets {
    /// Home is one of the places; it is the last resort in any case.
    pub home: bool,
    /// Rally points.
    pub rally: bool,
    /// The landing of the mission.
    pub mission_landing: bool,
}

impl ReturnTargets {
    /// From the parameter's number.
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

/// How a return is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturnRules {
    /// `RTL_TYPE`; `RALLY_INCL_HOME`: where to.
    pub places: ReturnTargets,
    /// `RTL_SPEED`: horizontal speed, m/s; `None`: the cruise speed.
    pub speed_m_s: Option<f64>,
    /// `RTL_CLIMB_MIN`: it climbs at least this much, m.
    pub climb_min_m: f64,
    /// `RTL_CONE_ANG`; `RTL_CONE_SLOPE`: height over distance within which it climbs less; 0: none.
    pub cone_slope: f64,
    /// `RTL_MIN_DIST`: nearer than this it does not climb, m.
    pub near_m: f64,
    /// `RTL_DESCEND_ALT`: height over the place at which it waits, m; `None`: where it arrives.
    pub wait_height_m: Option<f64>,
    /// `RTL_LAND_DELAY`; `RTL_LOIT_TIME`: it waits this long, s; negative: for good.
    pub wait_s: f64,
    /// A rally point's height is the return's (ArduPilot).
    pub rally_height: bool,
    /// `WP_YAW_BEHAVIOR` 1, 3: over its place it turns to the heading of the take-off.
    pub turns_back: bool,
    /// `RTL_ALT_FINAL`: it stays at this height instead of landing, m; 0: it lands.
    pub final_height_m: f64,
}

/// Where the nose points in automatic modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeadingRule {
    /// To the target.
    Target,
    /// To the target, but not on the way home.
    TargetExceptReturn,
    /// To home.
    Home,
    /// Away from home.
    AwayFromHome,
    /// Along the path.
    Path,
    /// Where it points.
    Fixed,
}

impl HeadingRule {
    /// From the number of `MPC_YAW_MODE`.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        let all = [Self::Target, Self::Home, Self::AwayFromHome, Self::Path, Self::Target, Self::Fixed];
        all.get(usize::try_from(number).ok()?).copied()
    }
}

/// Limits within the airframe's own; infinite: those alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightEnvelope {
    /// `MPC_VEL_MANUAL`; `LOIT_SPEED`: horizontal speed by the sticks, m/s.
    pub manual_m_s: f64,
    /// `PILOT_SPEED_UP`: climb by the stick, m/s.
    pub manual_up_m_s: f64,
    /// `PILOT_SPEED_DN`: descent by the stick, m/s.
    pub manual_down_m_s: f64,
    /// `MPC_MAN_Y_MAX`; `PILOT_Y_RATE`: yaw rate by the stick, rad/s.
    pub manual_yaw_rad_s: f64,
    /// `MPC_MAN_TILT_MAX`; `ANGLE_MAX`: tilt by the sticks, rad.
    pub manual_tilt_rad: f64,
    /// `MPC_ACC_HOR`; `WPNAV_ACCEL`: horizontal acceleration of automatic modes, m/s².
    pub acceleration_m_s2: f64,
    /// `MPC_ACC_UP_MAX`, `MPC_ACC_DOWN_MAX`; `WPNAV_ACCEL_Z`: vertical acceleration of automatic modes, m/s².
    pub climb_acceleration_m_s2: f64,
    /// `LAND_SPEED_HIGH`: descent of a landing before its last meters, m/s.
    pub landing_m_s: f64,
}

impl FlightEnvelope {
    /// The airframe's limits alone.
    pub const OPEN: Self = Self {
        manual_m_s: f64::INFINITY,
        manual_up_m_s: f64::INFINITY,
        manual_down_m_s: f64::INFINITY,
        manual_yaw_rad_s: f64::INFINITY,
        manual_tilt_rad: f64::INFINITY,
        acceleration_m_s2: f64::INFINITY,
        climb_acceleration_m_s2: f64::INFINITY,
        landing_m_s: f64::INFINITY,
    };
}

/// What a mission must have, by the numbers of `MIS_TKO_LAND_REQ`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MissionNeeds {
    /// Anything (0).
    #[default]
    Nothing,
    /// A take-off (1).
    Takeoff,
    /// A landing (2).
    Landing,
    /// Both (3).
    Both,
    /// Both or neither (4).
    BothOrNeither,
}

impl MissionNeeds {
    /// From the parameter's number.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        let all = [Self::Nothing, Self::Takeoff, Self::Landing, Self::Both, Self::BothOrNeither];
        all.get(usize::try_from(number).ok()?).copied()
    }
}

/// Which parts of the geofence act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FenceParts {
    /// Bit 0 of `FENCE_TYPE`: the greatest height.
    pub height: bool,
    /// Bit 1: the distance from home.
    pub distance: bool,
    /// Bit 2: the areas.
    pub areas: bool,
    /// Bit 3, `FENCE_ALT_MIN`: least height over home once it has been above, m.
    pub floor_m: Option<f64>,
    /// `FENCE_AUTOENABLE`: when it is switched by itself.
    pub auto: FenceSwitching,
}

/// The sensor whose slow changes the height follows, by the numbers of `EKF2_HGT_REF` (ArduPilot: `EK3_SRC1_POSZ`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HeightReference {
    /// Barometer: the receiver's height counts as off by a slow error of its own.
    Barometer,
    /// GNSS, with the barometer weighed by its drift.
    #[default]
    Gnss,
    /// Range finder: height over the ground below.
    RangeFinder,
}

impl HeightReference {
    /// From the parameter's number. There is no vision: GNSS is next.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        match number {
            0 => Self::Barometer,
            2 => Self::RangeFinder,
            _ => Self::Gnss,
        }
    }
}

/// The bits of `GUID_OPTIONS` that have a meaning here (ArduCopter).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GuidedOptions {
    /// Bit 0: the transmitter may arm the motors in GUIDED.
    pub transmitter_arms: bool,
    /// The yaw stick turns the nose in GUIDED; bit 2 switches that off.
    pub pilot_yaw: bool,
    /// The thrust of an attitude setpoint is a climb rate; with bit 3 it is thrust.
    pub thrust_climbs: bool,
}

impl GuidedOptions {
    /// From the parameter's bits.
    #[must_use]
    pub fn from_bits(bits: i32) -> Self {
        let has = |bit: i32| bits & 1 << bit != 0;
        Self { transmitter_arms: has(0), pilot_yaw: !has(2), thrust_climbs: !has(3) }
    }
}

/// All of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperatorRules {
    /// Reactions to failures.
    pub responses: FailsafeResponses,
    /// The way home.
    pub homeward: ReturnRules,
    /// `MPC_YAW_MODE`; `WP_YAW_BEHAVIOR`: the nose.
    pub heading: HeadingRule,
    /// Limits.
    pub envelope: FlightEnvelope,
    /// `MIS_TKO_LAND_REQ`: what a mission must have.
    pub mission_needs: MissionNeeds,
    /// `MIS_DIST_1WP`: farthest first waypoint from home, m; not above zero: any.
    pub first_waypoint_m: f64,
    /// `MIS_RESTART`: a mission begins anew whenever it is entered.
    pub mission_restarts: bool,
    /// Bit 1 of `AUTO_OPTIONS`: a mission that is armed takes off at once; otherwise it waits for the throttle or the start command.
    pub mission_starts_armed: bool,
    /// `FENCE_TYPE`, `FENCE_ALT_MIN`.
    pub fence: FenceParts,
    /// `CIRCLE_RADIUS`: radius of an orbit that names none, and of a circle entered by its mode alone, m.
    pub orbit_radius_m: f64,
    /// `GUID_OPTIONS`: flight by errands and external setpoints.
    pub guided: GuidedOptions,
    /// `EKF2_HGT_REF`; `EK3_SRC1_POSZ`: what the height follows.
    pub height_reference: HeightReference,
    /// `EKF2_NOAID_TOUT`: without GNSS and optical flow for this long the position counts as lost, s.
    pub no_aid_s: f64,
}

/// Longest dead reckoning by default, s. PX4 allows 5 s; an aircraft below a deck over water often has neither GNSS nor optical flow, and this
/// estimator's drift stays within its limits for about that long (`crates/sitl/tests/flight`).
pub const NO_AID_S: f64 = 60.0;

impl Default for OperatorRules {
    fn default() -> Self {
        Self {
            responses: FailsafeResponses {
                manual_loss_except: LinkLossExceptions::from_bits(7),
                data_link_loss_except: LinkLossExceptions::default(),
                offboard_loss: OffboardLoss::Sticks(FlightMode::Position),
                motor_failure: FailsafeResponse::Warn,
                battery: [None; 3],
                battery_emergency_pct: 5.0,
                battery_low_v: [0.0; 2],
                battery_low_s: 10.0,
                blind_lands: false,
                crash_check: true,
                takeover_share: 0.3,
                takeover_offboard: false,
                arm_charge_pct: 0.0,
                arm_voltage_v: 0.0,
                arm_needs_mission: false,
            },
            homeward: ReturnRules {
                places: ReturnTargets { home: true, rally: true, mission_landing: false },
                speed_m_s: None,
                climb_min_m: 0.0,
                cone_slope: 0.0,
                near_m: 5.0,
                wait_height_m: Some(10.0),
                wait_s: 0.0,
                rally_height: false,
                turns_back: false,
                final_height_m: 0.0,
            },
            heading: HeadingRule::Target,
            envelope: FlightEnvelope::OPEN,
            mission_needs: MissionNeeds::Nothing,
            first_waypoint_m: 10_000.0,
            mission_restarts: false,
            mission_starts_armed: true,
            fence: FenceParts { height: true, distance: true, areas: true, floor_m: None, auto: FenceSwitching::Never },
            orbit_radius_m: 5.0,
            guided: GuidedOptions::default(),
            height_reference: HeightReference::default(),
            no_aid_s: NO_AID_S,
        }
    }
}
