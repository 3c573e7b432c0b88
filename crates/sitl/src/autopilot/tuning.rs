//! What an operator may change in flight; the endpoint maps each field to the parameter name in its doc line.

/// What a lost link leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkLossAction {
    /// Nothing but a warning.
    Ignore,
    /// Stop and hold.
    Hold,
    /// Return to home and land.
    Return,
    /// Land here.
    Land,
    /// Motors off.
    Terminate,
}

impl LinkLossAction {
    /// From a parameter's number: 0 nothing, 1 hold, 2 return, 3 land, 5 and 6 motors off.
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

    /// The parameter's number.
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

/// Changeable values, with the PX4 parameter that each stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// `MPC_XY_VEL_MAX`: largest horizontal speed in automatic modes, m/s.
    pub horizontal_speed_max_m_s: f64,
    /// `MPC_XY_CRUISE`: horizontal speed in missions, returns and go-to, m/s.
    pub cruise_m_s: f64,
    /// `MPC_Z_V_AUTO_UP`: climb in automatic modes, m/s.
    pub climb_m_s: f64,
    /// `MPC_Z_V_AUTO_DN`: descent in automatic modes, m/s.
    pub descend_m_s: f64,
    /// `MPC_TKO_SPEED`: climb at take-off, m/s.
    pub takeoff_speed_m_s: f64,
    /// Take-offs climb at `climb_m_s` from the ground on. (ArduPilot: WPNAV_SPEED_UP)
    pub takeoff_at_climb_speed: bool,
    /// `MPC_LAND_SPEED`: last metres of a landing, m/s.
    pub land_speed_m_s: f64,
    /// `MPC_LAND_ALT2`: below this height over the ground (or home) the landing is slow, m.
    pub land_slow_below_m: f64,
    /// `MIS_TAKEOFF_ALT`: take-off height over home, m.
    pub takeoff_height_m: f64,
    /// `RTL_RETURN_ALT`: height over home at which it returns, m.
    pub return_height_m: f64,
    /// `NAV_ACC_RAD`: a waypoint counts as reached within, m.
    pub accept_radius_m: f64,
    /// `COM_RC_LOSS_T`: manual control is lost after, s.
    pub manual_loss_s: f64,
    /// `COM_FAIL_ACT_T`: it holds this long before the failsafe's action, s.
    pub failsafe_delay_s: f64,
    /// `NAV_RCL_ACT`: what lost manual control leads to.
    pub manual_loss: LinkLossAction,
    /// `COM_DL_LOSS_T`: the ground station is lost after, s.
    pub data_link_loss_s: f64,
    /// `NAV_DLL_ACT`: what a lost ground station leads to.
    pub data_link_loss: LinkLossAction,
    /// `COM_OF_LOSS_T`: external set-points are lost after, s.
    pub offboard_loss_s: f64,
    /// Seconds of simulation time in a second of the clients' time, where they are not kept in step: their time-outs grow by it.
    pub client_pace: f64,
    /// `BAT_LOW_THR`: low battery, %.
    pub battery_low_pct: f64,
    /// `BAT_CRIT_THR`: critical battery, %.
    pub battery_critical_pct: f64,
    /// `COM_DISARM_LAND`: disarms this long after landing, s; not above zero: never.
    pub disarm_after_landing_s: f64,
    /// `COM_DISARM_PRFLT`: disarms when not taken off within, s; not above zero: never.
    pub disarm_before_flight_s: f64,
    /// `GF_ACTION`: what a breach of the geofence leads to.
    pub fence_action: super::FenceAction,
    /// `FENCE_ENABLE` (ArduPilot): the geofence acts. A command or an item of a mission switches it, too.
    pub fence_enabled: bool,
    /// The switch is a parameter that stations see, and stays as it is; otherwise the fence acts again after the flight. (ArduPilot)
    pub fence_switch_stays: bool,
    /// `GF_MAX_HOR_DIST`: farthest from home, m; 0: no limit.
    pub fence_distance_m: f64,
    /// `GF_MAX_VER_DIST`: highest over home, m; 0: no limit.
    pub fence_height_m: f64,
    /// `COM_RC_OVERRIDE`: moved sticks take over from automatic modes.
    pub stick_takeover: bool,
    /// The end of external set-points is the end of an errand: it goes to the last place, or stops; otherwise it is a failure. (ArduPilot)
    pub setpoints_end: bool,
    /// Arming asks for sticks and position as the mode uses them; sticks count only when motors are armed, not in the checks before.
    /// (ArduPilot)
    pub arms_by_mode: bool,
    /// A mission that has ended stays in its mode, and takes off once the throttle is off its lower end. (ArduPilot)
    pub mission_mode_stays: bool,
    /// The number that people give the mission's first step: 1 where home is 0. (ArduPilot)
    pub first_item: usize,
    /// `CIRCLE_RATE` (ArduPilot): rate around a circle entered by its mode alone, rad/s, clockwise positive.
    pub circle_rate_rad_s: f64,
    /// How a target is followed.
    pub follow: super::follow::FollowRule,
    /// UTC at simulation start, Unix seconds.
    pub start_unix_s: i64,
    /// `MPC_HOLD_DZ`: sticks within this share of their travel count as centred.
    pub stick_deadband: f64,
    /// What an operator sets beyond these.
    pub rules: super::OperatorRules,
}

impl Tuning {
    /// After this much silence manual control is lost, s of simulation time.
    #[must_use]
    pub fn manual_timeout_s(&self) -> f64 {
        self.manual_loss_s * self.client_pace
    }

    /// After this much silence external set-points are lost, s of simulation time.
    #[must_use]
    pub fn offboard_timeout_s(&self) -> f64 {
        self.offboard_loss_s * self.client_pace
    }

    /// After this much silence the ground station is lost, s of simulation time.
    #[must_use]
    pub fn data_link_timeout_s(&self) -> f64 {
        self.data_link_loss_s * self.client_pace
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            horizontal_speed_max_m_s: 12.0,
            cruise_m_s: 5.0,
            climb_m_s: 3.0,
            descend_m_s: 1.5,
            takeoff_speed_m_s: 1.5,
            takeoff_at_climb_speed: false,
            land_speed_m_s: 0.7,
            land_slow_below_m: 5.0,
            takeoff_height_m: 2.5,
            return_height_m: 30.0,
            accept_radius_m: 2.0,
            manual_loss_s: 0.5,
            failsafe_delay_s: 5.0,
            manual_loss: LinkLossAction::Hold,
            data_link_loss_s: 10.0,
            data_link_loss: LinkLossAction::Ignore,
            offboard_loss_s: 1.0,
            client_pace: 1.0,
            battery_low_pct: 15.0,
            battery_critical_pct: 7.0,
            disarm_after_landing_s: 2.0,
            disarm_before_flight_s: 10.0,
            fence_action: super::FenceAction::Hold,
            fence_enabled: true,
            fence_switch_stays: false,
            fence_distance_m: 0.0,
            fence_height_m: 0.0,
            stick_takeover: true,
            setpoints_end: false,
            arms_by_mode: false,
            mission_mode_stays: false,
            first_item: 0,
            // ArduCopter's defaults: 10 m, 20 deg/s.
            circle_rate_rad_s: 0.349,
            follow: super::follow::FollowRule::default(),
            start_unix_s: 0,
            stick_deadband: 0.03,
            rules: super::OperatorRules::default(),
        }
    }
}
