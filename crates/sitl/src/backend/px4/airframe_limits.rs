//! PX4's parameters for the flight limits of an aircraft.

use super::param_table::ParamTable;
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::vehicle::FlightLimits;

/// PX4's default speeds in automatic modes, m/s: cruise, climb, descent, takeoff and landing. The built-in autopilot has the
/// same ones, and never flies faster than the aircraft's limits.
const CRUISE_M_S: f64 = 5.0;
const AUTO_CLIMB_M_S: f64 = 3.0;
const AUTO_DESCENT_M_S: f64 = 1.5;
const TAKEOFF_M_S: f64 = 1.5;
const LANDING_M_S: f64 = 0.7;
/// PX4's default yaw rate in automatic modes, deg/s.
const AUTO_YAW_DEG_S: f64 = 45.0;
/// Yaw rate that the attitude loop may use to follow a yaw that turns at the maximum rate, as a multiple of that rate. The ratio
/// of PX4's defaults, 200 and 150 deg/s.
const YAW_LOOP_MARGIN: f64 = 4.0 / 3.0;
/// Time to build up full horizontal acceleration, s (estimate: a tilt rate of about 110 deg/s).
const ACCELERATION_RAMP_S: f64 = 0.3;
/// Share of the slow-down time in which PX4's velocity setpoint would stop at constant deceleration. The rest is for the lag of
/// the loops (tuned in flights with PX4 1.16).
const SETPOINT_STOP_SHARE: f64 = 0.7;
/// Gains of the velocity loop, 1/s and 1/s². PX4's defaults of 1.8 and 0.4 lag behind where air drag is strong: in position mode,
/// the Phantom 2 class reached 94 % of its full speed and needed 4 s to stop (tuned in flights with PX4 1.16).
const VELOCITY_GAIN: f64 = 3.0;
const VELOCITY_INTEGRAL_GAIN: f64 = 1.0;
/// Dead zone of centered sticks. The program has already applied the controller's own.
const STICK_DEAD_ZONE: f64 = 0.01;

/// Adds all parameters that depend on the limits.
pub(super) fn add(table: &mut ParamTable, limits: &FlightLimits) {
    horizontal(table, limits);
    vertical(table, limits);
    rotation(table, limits);
    sticks(table);
}

/// Speed is proportional to the stick, and the aircraft stops within the slow-down time.
fn horizontal(table: &mut ParamTable, limits: &FlightLimits) {
    let fastest_m_s = limits.forward_m_s.max(limits.sideways_speed_m_s);
    table.real("MPC_VEL_MANUAL", limits.forward_m_s, (3.0, 20.0));
    table.real("MPC_VEL_MAN_BACK", limits.forward_m_s, (-1.0, 20.0));
    table.real("MPC_VEL_MAN_SIDE", limits.sideways_speed_m_s, (-1.0, 20.0));
    table.real("MPC_XY_VEL_MAX", fastest_m_s, (0.0, 20.0));
    table.real("MPC_XY_CRUISE", CRUISE_M_S.min(fastest_m_s), (3.0, 20.0));
    let tilt_m_s2 = GRAVITY_M_S2 * math::tan(limits.tilt_rad);
    table.real("MPC_ACC_HOR", fastest_m_s / (SETPOINT_STOP_SHARE * limits.slow_down_time_s), (2.0, 15.0));
    table.real("MPC_ACC_HOR_MAX", tilt_m_s2, (2.0, 15.0));
    table.real("MPC_JERK_MAX", tilt_m_s2 / ACCELERATION_RAMP_S, (0.5, 500.0));
    table.real("MPC_XY_VEL_P_ACC", VELOCITY_GAIN, (1.2, 5.0));
    table.real("MPC_XY_VEL_I_ACC", VELOCITY_INTEGRAL_GAIN, (0.0, 60.0));
}

fn vertical(table: &mut ParamTable, limits: &FlightLimits) {
    table.real("MPC_Z_VEL_MAX_UP", limits.climb_m_s, (0.5, 8.0));
    table.real("MPC_Z_VEL_MAX_DN", limits.descend_m_s, (0.5, 4.0));
    table.real("MPC_Z_V_AUTO_UP", AUTO_CLIMB_M_S.min(limits.climb_m_s), (0.5, 8.0));
    table.real("MPC_Z_V_AUTO_DN", AUTO_DESCENT_M_S.min(limits.descend_m_s), (0.5, 4.0));
    table.real("MPC_TKO_SPEED", TAKEOFF_M_S.min(limits.climb_m_s), (1.0, 5.0));
    table.real("MPC_LAND_SPEED", LANDING_M_S.min(limits.descend_m_s), (0.6, 4.0));
}

fn rotation(table: &mut ParamTable, limits: &FlightLimits) {
    let (yaw, rate, tilt) = (limits.yaw_rate_rad_s.to_degrees(), limits.rate_rad_s.to_degrees(), limits.tilt_rad.to_degrees());
    table.real("MPC_TILTMAX_AIR", tilt, (20.0, 89.0));
    table.real("MPC_MAN_TILT_MAX", tilt, (1.0, 70.0));
    table.real("MPC_MAN_Y_MAX", yaw, (0.0, 400.0));
    table.real("MPC_YAWRAUTO_MAX", AUTO_YAW_DEG_S.min(yaw), (5.0, 360.0));
    for (name, value) in [
        ("MC_ROLLRATE_MAX", rate),
        ("MC_PITCHRATE_MAX", rate),
        ("MC_YAWRATE_MAX", yaw * YAW_LOOP_MARGIN),
        ("MC_ACRO_R_MAX", rate),
        ("MC_ACRO_P_MAX", rate),
        ("MC_ACRO_Y_MAX", yaw),
    ] {
        table.real(name, value, (0.0, 1800.0));
    }
}

/// The vehicle file gives speeds at full stick, and half the stick is half the speed. Controller profiles have their own curves.
fn sticks(table: &mut ParamTable) {
    for name in ["MPC_XY_MAN_EXPO", "MPC_Z_MAN_EXPO", "MPC_YAW_EXPO", "MC_ACRO_EXPO", "MC_ACRO_EXPO_Y"] {
        table.real(name, 0.0, (0.0, 1.0));
    }
    table.real("MC_ACRO_SUPEXPO", 0.0, (0.0, 0.95));
    table.real("MC_ACRO_SUPEXPOY", 0.0, (0.0, 0.95));
    table.real("MPC_HOLD_DZ", STICK_DEAD_ZONE, (0.0, 1.0));
}
