//! Controller gains from the aircraft's physical parameters. Each loop is as fast as the motor lag allows, and each outer loop is
//! slower than its inner loop by a fixed ratio. No manual tuning is needed.

use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::vehicle::{Rotor, SEA_LEVEL_AIR_DENSITY_KG_M3, Vehicle};

/// Lead factor that compensates for motor lag (first order; a higher factor would amplify gyroscope noise).
const MOTOR_LEAD_FACTOR: f64 = 2.0;
/// Delay from sampling, filtering and computation, s: one and a half control ticks.
const CONTROL_DELAY_S: f64 = 0.004;
/// Product of rate-loop bandwidth and lag; 0.35 gives a damping ratio of 0.85 for an integrator with a first-order lag.
const RATE_BANDWIDTH_LAG_PRODUCT: f64 = 0.35;
/// Maximum bandwidth of the rate loop, rad/s.
const RATE_BANDWIDTH_MAX_RAD_S: f64 = 22.0;
/// Ratio of each outer loop's bandwidth to that of its inner loop.
const ATTITUDE_BANDWIDTH_RATIO: f64 = 0.3;
const VELOCITY_BANDWIDTH_RATIO: f64 = 0.4;
const POSITION_BANDWIDTH_RATIO: f64 = 0.5;
/// Ratio of the yaw rate bandwidth to the roll and pitch rate bandwidth; rotor drag produces little yaw torque.
const YAW_BANDWIDTH_RATIO: f64 = 0.3;
/// Fraction of the full-tilt acceleration available to trajectory plans. The rest is reserved for wind and control
/// errors.
const PLANNED_ACCELERATION_FRACTION: f64 = 0.85;
/// Fraction of the moment against a turn that is compensated. The compensation lags with the motors, so that the whole would turn the nose
/// back when a turn ends.
const YAW_DAMPING_FRACTION: f64 = 0.85;
/// Fraction of the maximum collective thrust reserved for roll and pitch.
const CONTROL_THRUST_RESERVE_FRACTION: f64 = 0.08;

/// All gains and limits of the control cascade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// Moments of inertia about the forward, right and down axes, kg m².
    pub inertia_kg_m2: [f64; 3],
    /// Lead factor for motor lag compensation.
    pub lead: f64,
    /// Roll and pitch rate gain, rad/s² per rad/s.
    pub rate: f64,
    /// Integral gain on the roll and pitch rate error, 1/s².
    pub rate_integral: f64,
    /// Yaw rate gain, rad/s² per rad/s.
    pub yaw_rate: f64,
    /// Roll and pitch gain, rad/s per rad.
    pub attitude: f64,
    /// Yaw gain, rad/s per rad.
    pub yaw: f64,
    /// Horizontal velocity gain, m/s² per m/s.
    pub velocity: f64,
    /// Integral gain on the horizontal velocity error, 1/s².
    pub velocity_integral: f64,
    /// Horizontal position gain, m/s per m.
    pub position: f64,
    /// Vertical velocity gain, m/s² per m/s.
    pub climb: f64,
    /// Integral gain on the vertical velocity error, 1/s².
    pub climb_integral: f64,
    /// Height gain, m/s per m.
    pub height: f64,
    /// Maximum tilt, rad.
    pub tilt_rad: f64,
    /// Tangent of the maximum tilt.
    pub tilt_tangent: f64,
    /// Maximum planned horizontal acceleration, m/s².
    pub acceleration_m_s2: f64,
    /// Maximum planned vertical acceleration, m/s².
    pub climb_acceleration_m_s2: f64,
    /// Attitude response lag, s.
    pub attitude_lag_s: f64,
    /// Horizontal drag in still air divided by mass: the linear coefficient, 1/s, and the quadratic one, 1/m.
    pub drag: (f64, f64),
    /// Thrust lost in a climb through still air, divided by mass and climb rate, 1/s.
    pub heave_damping_1_s: f64,
    /// Thrust gained in translational lift, divided by mass and the square of the airspeed in the disk plane, 1/m.
    pub translational_lift_1_m: f64,
    /// Compensated moment of body and rotor drag in hover against a turn about the down axis, divided by the yaw rate, N m s.
    pub yaw_damping_n_m_s: f64,
    /// Maximum roll and pitch rate, rad/s.
    pub rate_max_rad_s: f64,
    /// Maximum yaw rate, rad/s.
    pub yaw_rate_max_rad_s: f64,
    /// Collective thrust at hover, N.
    pub hover_thrust_n: f64,
    /// Maximum collective thrust that leaves control authority, N.
    pub thrust_max_n: f64,
    /// Minimum collective thrust in flight, N.
    pub thrust_min_n: f64,
}

impl Gains {
    /// Computes the gains for an aircraft.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let r = &vehicle.rotor;
        let lag_s = r.time_constant_s / MOTOR_LEAD_FACTOR + CONTROL_DELAY_S;
        let rate = (RATE_BANDWIDTH_LAG_PRODUCT / lag_s).min(RATE_BANDWIDTH_MAX_RAD_S);
        let attitude = ATTITUDE_BANDWIDTH_RATIO * rate;
        let velocity = VELOCITY_BANDWIDTH_RATIO * attitude;
        let climb = 0.5 * attitude;
        let n = vehicle.rotors.len() as f64;
        let hover_n = vehicle.mass_kg * GRAVITY_M_S2;
        let full_n = n * r.thrust_coefficient_n_s2 * r.max_speed_rad_s * r.max_speed_rad_s;
        let thrust_max_n = full_n * (1.0 - CONTROL_THRUST_RESERVE_FRACTION);
        let idle_n = n * r.thrust_coefficient_n_s2 * r.idle_speed_rad_s * r.idle_speed_rad_s;
        // The vehicle must hold its height at full tilt, so the available thrust also limits the tilt.
        let tilt_rad = vehicle.limits.tilt_rad.min(math::acos((1.05 * hover_n / thrust_max_n).min(1.0)));
        let spare = (thrust_max_n / hover_n - 1.0) * GRAVITY_M_S2;
        let yaw_rate = YAW_BANDWIDTH_RATIO * rate;
        Self {
            inertia_kg_m2: vehicle.inertia_kg_m2,
            lead: MOTOR_LEAD_FACTOR,
            rate,
            rate_integral: 0.5 * rate,
            yaw_rate,
            attitude,
            yaw: 0.35 * yaw_rate,
            velocity,
            velocity_integral: 0.25 * velocity * velocity,
            position: POSITION_BANDWIDTH_RATIO * velocity,
            climb,
            climb_integral: 0.25 * climb * climb,
            height: 0.4 * climb,
            tilt_rad,
            tilt_tangent: math::tan(tilt_rad),
            acceleration_m_s2: PLANNED_ACCELERATION_FRACTION * GRAVITY_M_S2 * math::tan(tilt_rad),
            climb_acceleration_m_s2: (0.6 * spare).clamp(1.0, 5.0),
            attitude_lag_s: 1.0 / attitude + lag_s,
            drag: drag(vehicle, hover_n / n),
            heave_damping_1_s: vehicle.heave_damping_1_s(),
            translational_lift_1_m: n * vehicle.aerodynamics.translational_lift_n_s2_m2 / vehicle.mass_kg,
            yaw_damping_n_m_s: yaw_damping_n_m_s(vehicle),
            rate_max_rad_s: vehicle.limits.rate_rad_s,
            yaw_rate_max_rad_s: vehicle.limits.yaw_rate_rad_s,
            hover_thrust_n: hover_n,
            thrust_max_n,
            thrust_min_n: idle_n.max(0.12 * hover_n),
        }
    }
}

/// Body and rotor drag at hover divided by mass, at sea-level air density.
fn drag(vehicle: &Vehicle, rotor_n: f64) -> (f64, f64) {
    let r = &vehicle.rotor;
    let speed = (rotor_n / r.thrust_coefficient_n_s2).sqrt();
    let linear = vehicle.rotors.len() as f64 * r.drag_coefficient_n_s2_m * speed;
    let area = 0.5 * (vehicle.drag.area_m2[0] + vehicle.drag.area_m2[1]);
    (linear / vehicle.mass_kg, 0.5 * SEA_LEVEL_AIR_DENSITY_KG_M3 * area / vehicle.mass_kg)
}

/// Most of the moment against a turn about the down axis, in which the rotors meet the air sideways.
fn yaw_damping_n_m_s(vehicle: &Vehicle) -> f64 {
    let squared_arm_m2 = |rotor: &Rotor| {
        let (forward, right) = (rotor.position_m.forward(), rotor.position_m.right());
        forward * forward + right * right
    };
    let arms_m2: f64 = vehicle.rotors.iter().map(squared_arm_m2).sum();
    let whole =
        vehicle.drag.angular_damping_n_m_s[2] + vehicle.rotor.drag_coefficient_n_s2_m * vehicle.hover_rotor_rad_s() * arms_m2;
    YAW_DAMPING_FRACTION * whole
}
