//! Limits of speed, rate, tilt and braking: from the aircraft's flight limits.

use super::table::Table;
use spandrel_model::math;
use spandrel_model::vehicle::{FlightLimits, Vehicle};

/// Speed in missions and go-to flights, m/s, as with the built-in autopilot (MPC_XY_CRUISE).
const CRUISE_SPEED_M_S: f64 = 5.0;
/// Braking acceleration in Loiter after the sticks are released, m/s² (the maximum that ArduPilot documents).
const BRAKE_ACCELERATION_M_S2: f64 = 2.5;
/// Jerk with which braking starts, m/s³.
const BRAKE_JERK_M_S3: f64 = 10.0;
/// Time for the aircraft to follow the commanded deceleration and to settle, s, which is part of the slow-down time.
const BRAKE_LAG_S: f64 = 0.4;
/// Lowest and highest acceleration angle in Loiter, degrees.
const LOITER_ANGLE_RANGE_DEG: (f64, f64) = (10.0, 45.0);
/// Landing speed close to the ground, m/s.
const LANDING_SPEED_M_S: f64 = 0.5;

/// Adds the parameters.
pub fn add(table: &mut Table, vehicle: &Vehicle) {
    // Without `..`, a new limit has to be added here. ArduPilot has only one horizontal speed limit, so the sideways limit has no
    // effect; the tilt and rate limits are also used for the motors.
    let FlightLimits {
        forward_m_s,
        sideways_speed_m_s: _,
        climb_m_s,
        descend_m_s,
        yaw_rate_rad_s,
        tilt_rad,
        rate_rad_s: _,
        slow_down_time_s: _,
    } = vehicle.limits;
    let tilt_deg = tilt_rad.to_degrees();
    table.renamed(("ANGLE_MAX", "ATC_ANGLE_MAX"), tilt_deg, (10.0, 80.0));
    add_loiter(table, &vehicle.limits);
    table.renamed(("PHLD_BRAKE_ANGLE", "PHLD_BRK_ANGLE"), tilt_deg, (20.0, 45.0));
    table.renamed(("WPNAV_SPEED", "WP_SPD"), forward_m_s.min(CRUISE_SPEED_M_S), (0.1, 20.0));
    table.renamed(("WPNAV_SPEED_UP", "WP_SPD_UP"), climb_m_s, (0.1, 10.0));
    table.renamed(("WPNAV_SPEED_DN", "WP_SPD_DN"), descend_m_s, (0.1, 5.0));
    table.renamed(("PILOT_SPEED_UP", "PILOT_SPD_UP"), climb_m_s, (0.5, 5.0));
    table.renamed(("PILOT_SPEED_DN", "PILOT_SPD_DN"), descend_m_s, (0.0, 5.0));
    table.renamed(("LAND_SPEED", "LAND_SPD_MS"), LANDING_SPEED_M_S, (0.3, 2.0));
    let yaw_rate_deg_s = yaw_rate_rad_s.to_degrees();
    table.real("PILOT_Y_RATE", yaw_rate_deg_s, (1.0, 360.0));
    table.real("PILOT_Y_EXPO", 0.0, (-0.5, 1.0));
    table.real("ATC_RATE_Y_MAX", 1.5 * yaw_rate_deg_s, (0.0, 1080.0));
    table.renamed(("ATC_SLEW_YAW", "ATC_RATE_WPY_MAX"), yaw_rate_deg_s, (5.0, 180.0));
}

/// Adds the parameters of Loiter, in which the trainee flies by default.
fn add_loiter(table: &mut Table, limits: &FlightLimits) {
    table.renamed(("LOIT_SPEED", "LOIT_SPEED_MS"), limits.forward_m_s, (0.2, 35.0));
    table.real("LOIT_ANG_MAX", loiter_angle_deg(limits), (0.0, 45.0));
    let acceleration_m_s2 = math::GRAVITY_M_S2 * math::tan(limits.tilt_rad);
    table.renamed(("LOIT_ACC_MAX", "LOIT_ACC_MAX_M"), acceleration_m_s2, (1.0, 9.81));
    table.renamed(("LOIT_BRK_ACCEL", "LOIT_BRK_ACC_M"), BRAKE_ACCELERATION_M_S2, (0.25, 2.5));
    table.renamed(("LOIT_BRK_JERK", "LOIT_BRK_JRK_M"), BRAKE_JERK_M_S3, (5.0, 50.0));
    table.real("LOIT_BRK_DELAY", 0.0, (0.0, 2.0));
}

/// Returns the tilt in Loiter at full stick for which the aircraft stops within its slow-down time, degrees.
///
/// ArduPilot accelerates at a = g tan(angle) x stick and decelerates at a v / `LOIT_SPEED`, so full stick gives `LOIT_SPEED`. After
/// the release it also brakes at b: v stops at `LOIT_SPEED` / a x ln(1 + a / b).
fn loiter_angle_deg(limits: &FlightLimits) -> f64 {
    let stop_s = |acceleration: f64| {
        limits.forward_m_s / acceleration * math::ln(1.0 + acceleration / BRAKE_ACCELERATION_M_S2) + BRAKE_LAG_S
    };
    let acceleration = |angle_deg: f64| math::GRAVITY_M_S2 * math::tan(angle_deg.to_radians());
    let (mut low, mut high) = LOITER_ANGLE_RANGE_DEG;
    high = high.min(limits.tilt_rad.to_degrees()).max(low);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if stop_s(acceleration(middle)) > limits.slow_down_time_s {
            low = middle;
        } else {
            high = middle;
        }
    }
    (high * 10.0).round() / 10.0
}
