//! Motors, mixer, rate and attitude gains: from the rotor model and the moments of inertia.

use super::super::frame::Frame;
use super::table::Table;
use spandrel_model::math;
use spandrel_model::vehicle::Vehicle;

/// Number of the first motor function of an output (SERVOn_FUNCTION).
const FIRST_MOTOR_FUNCTION: i64 = 33;
/// Output of armed motors on the ground, as a fraction of the command range. It must be visible in whole microseconds: motors are
/// armed above 1,000 us.
const SPIN_ARM: f64 = 0.02;
/// Lowest output in flight.
const SPIN_MIN: f64 = 0.05;
/// Delay of the rate loop besides the motors, s: filters, one frame, integration.
const LOOP_DELAY_S: f64 = 0.02;
/// Limit of the feed-forward angular acceleration in roll and pitch, degrees/s² (ArduPilot's default).
const MAX_ACCELERATION_DEG_S2: f64 = 1100.0;
/// Limit of the yaw acceleration, degrees/s² (the maximum that ArduPilot documents).
const MAX_YAW_ACCELERATION_DEG_S2: f64 = 720.0;
/// Fractions of the angular acceleration for a command of 1 that the shaped setpoint uses in roll and pitch, and in yaw. The mixer
/// has less than 1 available in hover, and needs some of it for corrections.
const FEED_FORWARD_FRACTION: f64 = 0.3;
const YAW_FEED_FORWARD_FRACTION: f64 = 0.5;
/// Bandwidth of the yaw rate loop, rad/s (the motors' drag torque is weak).
const YAW_BANDWIDTH_RAD_S: f64 = 2.6;

/// Adds the parameters.
pub fn add(table: &mut Table, vehicle: &Vehicle, frame: &Frame) {
    table.integer("FRAME_CLASS", i64::from(frame.class));
    table.integer("FRAME_TYPE", i64::from(frame.kind));
    for (rotor, motor) in frame.motor_of_rotor.iter().enumerate() {
        table.integer(&format!("SERVO{}_FUNCTION", rotor + 1), FIRST_MOTOR_FUNCTION + *motor as i64);
    }
    add_thrust_curve(table, vehicle);
    let gyro_filter_hz = gyro_filter_hz(vehicle);
    table.real("INS_GYRO_FILTER", gyro_filter_hz, (0.0, 256.0));
    let [roll, pitch, yaw] = authority_rad_s2(vehicle);
    add_rate_loop(table, ["RLL", "R"], roll, vehicle);
    add_rate_loop(table, ["PIT", "P"], pitch, vehicle);
    for axis in ["RLL", "PIT", "YAW"] {
        table.real(&format!("ATC_RAT_{axis}_FLTT"), (0.5 * gyro_filter_hz).round(), (1.0, 100.0));
    }
    let yaw_gain = (YAW_BANDWIDTH_RAD_S / yaw).clamp(0.1, 2.5);
    table.real("ATC_RAT_YAW_P", yaw_gain, (0.1, 2.5));
    table.real("ATC_RAT_YAW_I", 0.1 * yaw_gain, (0.01, 1.0));
    let limit = (YAW_FEED_FORWARD_FRACTION * yaw.to_degrees()).min(MAX_YAW_ACCELERATION_DEG_S2);
    table.renamed(("ATC_ACCEL_Y_MAX", "ATC_ACC_Y_MAX"), limit.round(), (0.0, 720.0));
}

/// Adds the motors' output range, thrust curve and voltage compensation.
fn add_thrust_curve(table: &mut Table, vehicle: &Vehicle) {
    let rotor = &vehicle.rotor;
    let idle = rotor.idle_speed_rad_s / rotor.max_speed_rad_s;
    let lowest = idle + (1.0 - idle) * SPIN_MIN;
    table.integer("MOT_PWM_MIN", 1000);
    table.integer("MOT_PWM_MAX", 2000);
    table.real("MOT_SPIN_ARM", SPIN_ARM, (0.0, 1.0));
    table.real("MOT_SPIN_MIN", SPIN_MIN, (0.0, 1.0));
    table.real("MOT_SPIN_MAX", 1.0, (0.0, 1.0));
    // Thrust is proportional to the square of the speed lowest + (1 - lowest) x, where x is ArduPilot's output between MOT_SPIN_MIN
    // and MOT_SPIN_MAX. The fraction above the lowest thrust is (2 lowest x + (1 - lowest) x²) / (1 + lowest).
    table.real("MOT_THST_EXPO", (1.0 - lowest) / (1.0 + lowest), (-1.0, 1.0));
    let hover = hover_throttle(vehicle, lowest);
    table.real("MOT_THST_HOVER", hover, (0.125, 0.6875));
    table.integer("MOT_HOVER_LEARN", 1);
    table.real("PSC_ACCZ_P", hover, (0.2, 1.5));
    table.real("PSC_D_ACC_P", 0.1 * hover, (0.01, 0.25));
    table.real("PSC_ACCZ_I", 2.0 * hover, (0.0, 3.0));
    table.real("PSC_D_ACC_I", 0.2 * hover, (0.0, 0.5));
    let [lowest_v, .., highest_v] = vehicle.battery.ocv_cell_v;
    let cells = f64::from(vehicle.battery.cells);
    table.real("MOT_BAT_VOLT_MAX", cells * highest_v, (0.0, 53.0));
    table.real("MOT_BAT_VOLT_MIN", cells * lowest_v, (0.0, 42.0));
}

/// Returns the hover thrust as a fraction of the thrust range above the lowest thrust.
fn hover_throttle(vehicle: &Vehicle, lowest: f64) -> f64 {
    let weight_n = vehicle.mass_kg * math::GRAVITY_M_S2;
    let max_n = vehicle.rotors.len() as f64 * max_thrust_n(vehicle);
    (weight_n / max_n - lowest * lowest) / (1.0 - lowest * lowest)
}

/// Returns the maximum thrust of one rotor, N.
fn max_thrust_n(vehicle: &Vehicle) -> f64 {
    let rotor = &vehicle.rotor;
    rotor.thrust_coefficient_n_s2 * rotor.max_speed_rad_s * rotor.max_speed_rad_s
}

/// Returns the angular acceleration about each body axis for a command of 1, rad/s². ArduPilot scales the mixer so that the
/// strongest motor changes by half of its range.
fn authority_rad_s2(vehicle: &Vehicle) -> [f64; 3] {
    let rotor = &vehicle.rotor;
    let lever = |arm: fn(&spandrel_model::vehicle::Rotor) -> f64| {
        let arms = || vehicle.rotors.iter().map(|rotor| arm(rotor).abs());
        let longest = arms().fold(0.0, f64::max).max(1e-3);
        arms().map(|arm_m| 0.5 * arm_m * arm_m / longest).sum::<f64>()
    };
    let torque_n_m =
        0.5 * vehicle.rotors.len() as f64 * rotor.torque_coefficient_n_m_s2 * rotor.max_speed_rad_s * rotor.max_speed_rad_s;
    let [roll, pitch, yaw] = vehicle.inertia_kg_m2;
    [
        max_thrust_n(vehicle) * lever(|rotor| rotor.position_m.right()) / roll,
        max_thrust_n(vehicle) * lever(|rotor| rotor.position_m.forward()) / pitch,
        torque_n_m / yaw,
    ]
}

/// Adds the gains of the roll or pitch loop. The bandwidth follows from the motors' lag, and the gain from the bandwidth and the
/// angular acceleration for a command of 1.
fn add_rate_loop(table: &mut Table, [long, short]: [&str; 2], authority_rad_s2: f64, vehicle: &Vehicle) {
    let lag_s = vehicle.rotor.time_constant_s;
    let bandwidth_rad_s = 1.0 / (lag_s + LOOP_DELAY_S);
    let gain = (bandwidth_rad_s / authority_rad_s2).clamp(0.01, 0.5);
    table.real(&format!("ATC_RAT_{long}_P"), gain, (0.01, 0.5));
    table.real(&format!("ATC_RAT_{long}_I"), gain, (0.01, 2.0));
    table.real(&format!("ATC_RAT_{long}_D"), 0.8 * lag_s * gain, (0.0, 0.05));
    table.real(&format!("ATC_RAT_{long}_FLTD"), (0.5 * gyro_filter_hz(vehicle)).round(), (0.0, 200.0));
    table.real(&format!("ATC_ANG_{long}_P"), bandwidth_rad_s / 4.0, (3.0, 12.0));
    let limit = (FEED_FORWARD_FRACTION * authority_rad_s2.to_degrees()).min(MAX_ACCELERATION_DEG_S2);
    let names = (format!("ATC_ACCEL_{short}_MAX"), format!("ATC_ACC_{short}_MAX"));
    table.renamed((&names.0, &names.1), limit.round(), (0.0, 1800.0));
    let rate_deg_s = vehicle.limits.rate_rad_s.to_degrees().round();
    table.real(&format!("ATC_RATE_{short}_MAX"), rate_deg_s, (0.0, 1080.0));
}

/// Returns the cutoff frequency of the gyroscope filter for the propeller's size, Hz: ArduPilot's tuning guide recommends 20 Hz for
/// 20-inch propellers and more for smaller ones.
fn gyro_filter_hz(vehicle: &Vehicle) -> f64 {
    let diameter_in = 2.0 * vehicle.rotor.radius_m / 0.0254;
    (289.22 * math::pow(diameter_in, -0.838)).round().clamp(20.0, 80.0)
}
