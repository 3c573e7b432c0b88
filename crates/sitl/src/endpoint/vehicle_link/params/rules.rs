//! Converts parameters to the autopilot's rules.

use super::Params;
use crate::autopilot::operator_rules::{
    BatteryResponses, FailsafeResponse, FenceAutoEnable, FenceParts, FlightEnvelope, GuidedOptions, HeadingRule, HeightReference,
    LinkLossExceptions, MissionRequirement, OffboardLoss, OperatorRules, ReturnRules, ReturnTargets, SCENARIO_BATTERY_ACTIONS,
};

/// Bits in ArduPilot's `FS_OPTIONS`.
const AUTO_WITHOUT_STICKS: i32 = 1;
const AUTO_WITHOUT_STATION: i32 = 1 << 1;
const GUIDED_WITHOUT_STICKS: i32 = 1 << 2;
const PILOT_WITHOUT_STATION: i32 = 1 << 4;

/// Converts a `COM_ACT_FAIL_ACT` value to a motor failure response.
fn actuator_response(number: i32) -> FailsafeResponse {
    match number {
        1 => FailsafeResponse::Hold,
        2 => FailsafeResponse::Land,
        3 => FailsafeResponse::Return,
        4 => FailsafeResponse::Terminate,
        _ => FailsafeResponse::Warn,
    }
}

/// Converts a `BATT_FS_LOW_ACT` value to a battery response.
fn battery_response(number: i32) -> Option<FailsafeResponse> {
    match number {
        1 => Some(FailsafeResponse::Land),
        2 | 3 => Some(FailsafeResponse::Return),
        4 => Some(FailsafeResponse::Land),
        5 => Some(FailsafeResponse::Terminate),
        6 => Some(FailsafeResponse::Return),
        7 => Some(FailsafeResponse::Hold),
        _ => None,
    }
}

impl Params {
    /// Applies the values to the rules.
    pub(super) fn apply_rules(&self, rules: &mut OperatorRules) {
        let copter = self.view.cast;
        self.apply_responses(rules);
        rules.return_rules = if copter { self.copter_return() } else { self.px4_return() };
        rules.envelope = self.envelope();
        rules.heading = self.heading();
        rules.mission_requirement = MissionRequirement::from_number(self.integer("MIS_TKO_LAND_REQ")).unwrap_or_default();
        rules.height_reference = HeightReference::from_number(self.integer("EKF2_HGT_REF"));
        rules.dead_reckoning_limit_s = f64::from(self.integer("EKF2_NOAID_TOUT")) * 1e-6;
        rules.max_first_waypoint_distance_m = self.number("MIS_DIST_1WP");
        if copter {
            rules.mission_restarts = self.integer("MIS_RESTART") == 1;
            rules.mission_takes_off_after_arming = self.integer("AUTO_OPTIONS") & 1 << 1 != 0;
            rules.orbit_radius_m = self.number("CIRCLE_RADIUS") / 100.0;
            rules.fence = self.fence_parts();
            rules.guided = GuidedOptions::from_bits(self.integer("GUID_OPTIONS"));
        }
    }

    fn integer(&self, name: &str) -> i32 {
        self.whole(name).unwrap_or_default()
    }

    fn apply_responses(&self, rules: &mut OperatorRules) {
        let out = &mut rules.responses;
        out.manual_loss_exceptions = LinkLossExceptions::from_bits(self.integer("COM_RCL_EXCEPT"));
        out.data_link_loss_exceptions = LinkLossExceptions::from_bits(self.integer("COM_DLL_EXCEPT"));
        if let Some(loss) = OffboardLoss::from_number(self.integer("COM_OBL_RC_ACT")) {
            out.offboard_loss = loss;
        }
        let detected = self.integer("FD_ACT_EN") != 0;
        out.motor_failure = if detected { actuator_response(self.integer("COM_ACT_FAIL_ACT")) } else { FailsafeResponse::Warn };
        out.battery = self.battery_responses();
        out.battery_emergency_pct = 100.0 * self.number("BAT_EMERGEN_THR");
        out.lands_without_position = self.integer("COM_POSCTL_NAVL") == 1;
        out.takeover_deflection = self.number("COM_RC_STICK_OV") / 100.0;
        out.takeover_in_offboard = self.integer("COM_RC_OVERRIDE") & 1 << 1 != 0;
        out.min_arming_charge_pct = 100.0 * self.number("COM_ARM_BAT_MIN").max(0.0);
        out.arming_requires_mission = self.integer("COM_ARM_MIS_REQ") == 1;
        if self.view.cast {
            let options = self.integer("FS_OPTIONS");
            let has = |bit: i32| options & bit != 0;
            out.manual_loss_exceptions = LinkLossExceptions {
                mission: has(AUTO_WITHOUT_STICKS),
                hold: has(GUIDED_WITHOUT_STICKS),
                offboard: has(GUIDED_WITHOUT_STICKS),
                manual: false,
            };
            out.data_link_loss_exceptions = LinkLossExceptions {
                mission: has(AUTO_WITHOUT_STATION),
                manual: has(PILOT_WITHOUT_STATION),
                ..LinkLossExceptions::default()
            };
            out.battery_low_v = [self.number("BATT_LOW_VOLT"), self.number("BATT_CRT_VOLT")];
            out.battery_low_time_s = self.number("BATT_LOW_TIMER");
            out.lands_without_position = self.integer("FS_EKF_ACTION") != 2;
            out.crash_check = self.integer("FS_CRASH_CHECK") != 0;
            out.min_arming_voltage_v = self.number("BATT_ARM_VOLT");
        }
    }

    fn battery_responses(&self) -> BatteryResponses {
        if self.view.cast {
            let action = |name| battery_response(self.integer(name));
            return [action("BATT_FS_LOW_ACT"), action("BATT_FS_CRT_ACT"), None];
        }
        match self.integer("COM_LOW_BAT_ACT") {
            1 => SCENARIO_BATTERY_ACTIONS,
            2 => [None, Some(FailsafeResponse::Land), Some(FailsafeResponse::Land)],
            3 => [None, Some(FailsafeResponse::Return), Some(FailsafeResponse::Land)],
            _ => [None; 3],
        }
    }

    fn px4_return(&self) -> ReturnRules {
        let angle_rad = self.number("RTL_CONE_ANG").to_radians();
        ReturnRules {
            places: ReturnTargets::from_number(self.integer("RTL_TYPE")).unwrap_or_default(),
            speed_m_s: None,
            min_climb_m: 0.0,
            cone_slope: if angle_rad > 0.0 { 1.0 / spandrel_model::math::tan(angle_rad) } else { 0.0 },
            no_climb_distance_m: self.number("RTL_MIN_DIST"),
            loiter_height_m: Some(self.number("RTL_DESCEND_ALT")),
            wait_s: self.number("RTL_LAND_DELAY"),
            uses_rally_height: false,
            turns_to_takeoff_heading: false,
            final_height_m: 0.0,
        }
    }

    fn copter_return(&self) -> ReturnRules {
        ReturnRules {
            places: ReturnTargets { home: self.integer("RALLY_INCL_HOME") != 0, rally: true, mission_landing: false },
            speed_m_s: Some(self.number("RTL_SPEED") / 100.0).filter(|speed| *speed > 0.0),
            min_climb_m: self.number("RTL_CLIMB_MIN") / 100.0,
            cone_slope: self.number("RTL_CONE_SLOPE"),
            no_climb_distance_m: OperatorRules::default().return_rules.no_climb_distance_m,
            loiter_height_m: None,
            wait_s: self.number("RTL_LOIT_TIME") / 1000.0,
            uses_rally_height: true,
            turns_to_takeoff_heading: matches!(self.integer("WP_YAW_BEHAVIOR"), 1 | 3),
            final_height_m: self.number("RTL_ALT_FINAL") / 100.0,
        }
    }

    fn heading(&self) -> HeadingRule {
        if !self.view.cast {
            return HeadingRule::from_number(self.integer("MPC_YAW_MODE")).unwrap_or(HeadingRule::Target);
        }
        match self.integer("WP_YAW_BEHAVIOR") {
            0 => HeadingRule::Fixed,
            1 => HeadingRule::Target,
            3 => HeadingRule::Path,
            _ => HeadingRule::TargetExceptReturn,
        }
    }

    /// Returns a limit changed by an operator; infinity at its default, where only the airframe limits apply.
    fn limit(&self, name: &str) -> f64 {
        let value = self.values.get(name);
        if value == self.frame.get(name) { f64::INFINITY } else { self.number(name) }
    }

    fn envelope(&self) -> FlightEnvelope {
        let centimeters = |name: &str| Some(self.number(name) / 100.0).filter(|value| *value > 0.0).unwrap_or(f64::INFINITY);
        let mut out = FlightEnvelope {
            manual_speed_m_s: self.limit("MPC_VEL_MANUAL"),
            manual_yaw_rate_rad_s: self.limit("MPC_MAN_Y_MAX").to_radians(),
            manual_tilt_rad: self.limit("MPC_MAN_TILT_MAX").to_radians(),
            acceleration_m_s2: self.limit("MPC_ACC_HOR"),
            climb_acceleration_m_s2: self.limit("MPC_ACC_UP_MAX").min(self.limit("MPC_ACC_DOWN_MAX")),
            ..FlightEnvelope::UNLIMITED
        };
        if self.view.cast {
            out.manual_climb_rate_m_s = self.limit("PILOT_SPEED_UP") / 100.0;
            out.manual_descent_rate_m_s =
                Some(centimeters("PILOT_SPEED_DN")).filter(|value| value.is_finite()).unwrap_or(out.manual_climb_rate_m_s);
            out.landing_descent_rate_m_s = centimeters("LAND_SPEED_HIGH");
        }
        out
    }

    fn fence_parts(&self) -> FenceParts {
        let parts = self.integer("FENCE_TYPE");
        let has = |bit: i32| parts & 1 << bit != 0;
        FenceParts {
            height: has(0),
            distance: has(1),
            areas: has(2),
            floor_m: has(3).then(|| self.number("FENCE_ALT_MIN")),
            auto: FenceAutoEnable::from_number(self.integer("FENCE_AUTOENABLE")),
        }
    }
}
