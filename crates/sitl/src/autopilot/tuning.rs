//! Settings that an operator can change in flight. The endpoint maps each field to the parameter named in its comment.

use super::failsafe::operator_rules::{FenceAction, OperatorRules};
use super::navigator::follow::FollowRule;
use spandrel_model::stick_response::StickResponse;

/// Action on link loss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkLossAction {
    /// Warn only.
    Ignore,
    /// Stop and hold position.
    Hold,
    /// Return to home and land.
    Return,
    /// Land at the current position.
    Land,
    /// Stop the motors.
    Terminate,
}

impl LinkLossAction {
    /// Returns the action for a parameter value: 0 = ignore, 1 = hold, 2 = return, 3 = land, 5 and 6 = terminate.
    #[must_use]
    pub fn from_number(n: i32) -> Option<Self> {
        Some(match n {
            0 => Self::Ignore,
            1 => Self::Hold,
            2 => Self::Return,
            3 => Self::Land,
            5 | 6 => Self::Terminate,
            _ => return None,
        })
    }

    /// Returns the parameter value.
    #[must_use]
    pub fn number(self) -> i32 {
        match self {
            Self::Ignore => 0,
            Self::Hold => 1,
            Self::Return => 2,
            Self::Land => 3,
            Self::Terminate => 5,
        }
    }
}

/// Adjustable settings with their PX4 parameters. Settings that exist only in ArduPilot are marked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// `MPC_XY_VEL_MAX`: maximum horizontal speed in automatic modes, m/s.
    pub horizontal_speed_max_m_s: f64,
    /// `MPC_XY_CRUISE`: horizontal speed in missions, returns and go-to commands, m/s.
    pub cruise_speed_m_s: f64,
    /// `MPC_Z_V_AUTO_UP`: climb rate in automatic modes, m/s.
    pub climb_m_s: f64,
    /// `MPC_Z_V_AUTO_DN`: descent rate in automatic modes, m/s.
    pub descend_m_s: f64,
    /// `MPC_TKO_SPEED`: climb rate at takeoff, m/s.
    pub takeoff_speed_m_s: f64,
    /// From the ground, takeoffs climb at `climb_m_s` (ArduPilot: WPNAV_SPEED_UP).
    pub takeoff_at_climb_speed: bool,
    /// `MPC_LAND_SPEED`: descent rate in the last meters of a landing, m/s.
    pub land_speed_m_s: f64,
    /// `MPC_LAND_ALT2`: height above ground (or home) below which the vehicle lands slowly, m.
    pub slow_landing_height_m: f64,
    /// `MIS_TAKEOFF_ALT`: default takeoff height above home, m.
    pub takeoff_height_m: f64,
    /// `RTL_RETURN_ALT`: return height above home, m.
    pub return_height_m: f64,
    /// `NAV_ACC_RAD`: acceptance radius of waypoints, m.
    pub default_acceptance_radius_m: f64,
    /// `COM_RC_LOSS_T`: manual control timeout, s.
    pub manual_loss_timeout_s: f64,
    /// `COM_FAIL_ACT_T`: hold time before a failsafe action, s.
    pub failsafe_delay_s: f64,
    /// `NAV_RCL_ACT`: action on loss of manual control.
    pub manual_loss: LinkLossAction,
    /// `COM_DL_LOSS_T`: ground station link timeout, s.
    pub data_link_loss_timeout_s: f64,
    /// `NAV_DLL_ACT`: action on loss of the ground station.
    pub data_link_loss: LinkLossAction,
    /// `COM_OF_LOSS_T`: external setpoint timeout, s.
    pub offboard_loss_timeout_s: f64,
    /// Simulation seconds per second of the clients' clocks without lockstep. Client timeouts scale with it.
    pub client_speed_factor: f64,
    /// `BAT_LOW_THR`: low battery level, %.
    pub battery_low_pct: f64,
    /// `BAT_CRIT_THR`: critical battery level, %.
    pub battery_critical_pct: f64,
    /// `COM_DISARM_LAND`: delay before automatic disarming after landing, s; 0 or less disables it.
    pub disarm_after_landing_s: f64,
    /// `COM_DISARM_PRFLT`: timeout for takeoff after arming, s; 0 or less disables it.
    pub disarm_before_flight_s: f64,
    /// `GF_ACTION`: action on a geofence breach.
    pub fence_action: FenceAction,
    /// `FENCE_ENABLE` (ArduPilot): whether the geofence is enabled. Commands and mission items can change it.
    pub fence_enabled: bool,
    /// The fence switch is a persistent parameter visible to ground stations. Otherwise, the fence is re-enabled after
    /// the flight (ArduPilot).
    pub fence_switch_persists: bool,
    /// `GF_MAX_HOR_DIST`: maximum distance from home, m; 0: no limit.
    pub fence_distance_m: f64,
    /// `GF_MAX_VER_DIST`: maximum height above home, m; 0: no limit.
    pub fence_height_m: f64,
    /// `COM_RC_OVERRIDE`: stick movement takes over from automatic modes.
    pub stick_takeover: bool,
    /// When external setpoints end, the vehicle continues to the last target or stops. Otherwise, their end is treated
    /// as a failure (ArduPilot).
    pub setpoint_end_is_normal: bool,
    /// Arming requires stick input and a position only if the mode needs them. Stick checks run when motors are armed,
    /// not before (ArduPilot).
    pub arming_depends_on_mode: bool,
    /// After a completed mission, the vehicle stays in mission mode and takes off again once the throttle is raised
    /// (ArduPilot).
    pub stays_in_mission_mode: bool,
    /// Displayed number of the first mission item: 1 if home is item 0 (ArduPilot).
    pub first_item: usize,
    /// `CIRCLE_RATE` (ArduPilot): angular rate of a circle entered by a mode change, rad/s, clockwise positive. Not
    /// used for other circles.
    pub circle_rate_rad_s: f64,
    /// Follow mode settings.
    pub follow: FollowRule,
    /// UTC time at the start of the simulation, Unix seconds.
    pub start_unix_s: i64,
    /// `MPC_HOLD_DZ`: stick deadband as a fraction of full deflection.
    pub stick_deadband: f64,
    /// `SPAN_RESPONSE`: response to the sticks in position mode.
    pub stick_response: StickResponse,
    /// Other operator settings.
    pub rules: OperatorRules,
}

impl Tuning {
    /// Manual control timeout, s of simulation time.
    #[must_use]
    pub fn manual_timeout_s(&self) -> f64 {
        self.manual_loss_timeout_s * self.client_speed_factor
    }

    /// External setpoint timeout, s of simulation time.
    #[must_use]
    pub fn offboard_timeout_s(&self) -> f64 {
        self.offboard_loss_timeout_s * self.client_speed_factor
    }

    /// Ground station link timeout, s of simulation time.
    #[must_use]
    pub fn data_link_timeout_s(&self) -> f64 {
        self.data_link_loss_timeout_s * self.client_speed_factor
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            horizontal_speed_max_m_s: 12.0,
            cruise_speed_m_s: 5.0,
            climb_m_s: 3.0,
            descend_m_s: 1.5,
            takeoff_speed_m_s: 1.5,
            takeoff_at_climb_speed: false,
            land_speed_m_s: 0.7,
            slow_landing_height_m: 5.0,
            takeoff_height_m: 2.5,
            return_height_m: 30.0,
            default_acceptance_radius_m: 2.0,
            manual_loss_timeout_s: 0.5,
            failsafe_delay_s: 5.0,
            manual_loss: LinkLossAction::Hold,
            data_link_loss_timeout_s: 10.0,
            data_link_loss: LinkLossAction::Ignore,
            offboard_loss_timeout_s: 1.0,
            client_speed_factor: 1.0,
            battery_low_pct: 15.0,
            battery_critical_pct: 7.0,
            disarm_after_landing_s: 2.0,
            disarm_before_flight_s: 10.0,
            fence_action: FenceAction::Hold,
            fence_enabled: true,
            fence_switch_persists: false,
            fence_distance_m: 0.0,
            fence_height_m: 0.0,
            stick_takeover: true,
            setpoint_end_is_normal: false,
            arming_depends_on_mode: false,
            stays_in_mission_mode: false,
            first_item: 0,
            // ArduCopter's defaults: 10 m, 20 deg/s.
            circle_rate_rad_s: 0.349,
            follow: FollowRule::default(),
            start_unix_s: 0,
            stick_deadband: 0.03,
            stick_response: StickResponse::default(),
            rules: OperatorRules::default(),
        }
    }
}
