//! A quadrotor with round numbers for closed-form tests.

use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::vehicle::{
    Aerodynamics, BatterySpec, Camera, Drag, FlightLimits, Hull, Lamp, Rotor, RotorModel, SensorSpec, Vehicle,
};

/// Returns a 1.3 kg quadrotor about the size of a Phantom.
#[expect(clippy::too_many_lines, reason = "one value, field by field")]
pub fn quad() -> Vehicle {
    let arm = 0.1237;
    let rotor = |x: f64, y: f64, spin| Rotor { position_m: Vec3::new(x, y, -0.02), spin };
    Vehicle {
        id: "test".into(),
        name: "test".into(),
        mass_kg: 1.3,
        inertia_kg_m2: [0.0097, 0.0097, 0.017],
        rotors: vec![rotor(arm, arm, 1.0), rotor(-arm, -arm, 1.0), rotor(arm, -arm, -1.0), rotor(-arm, arm, -1.0)],
        rotor: RotorModel {
            radius_m: 0.12,
            thrust_coefficient_n_s2: 1.0e-5,
            torque_coefficient_n_m_s2: 1.6e-7,
            time_constant_s: 0.03,
            max_speed_rad_s: 1000.0,
            idle_speed_rad_s: 100.0,
            speed_spread: 0.0,
            inertia_kg_m2: 4e-5,
            drag_coefficient_n_s2_m: 4e-5,
            efficiency: 0.5,
        },
        drag: Drag { area_m2: [0.03, 0.03, 0.05], angular_damping_n_m_s: [0.003, 0.003, 0.003] },
        aerodynamics: Aerodynamics::default(),
        hull: Hull {
            tip_to_tip_m: 0.59,
            has_propeller_guard: false,
            body_half_extent_m: [0.1, 0.06, 0.05],
            feet_m: [(0.1, 0.1), (-0.1, -0.1), (0.1, -0.1), (-0.1, 0.1)].map(|(x, y)| Vec3::new(x, y, 0.12)).to_vec(),
            restitution: 0.3,
            friction: 0.6,
        },
        battery: BatterySpec {
            cells: 3,
            capacity_ah: 5.2,
            internal_resistance_ohm: 0.03,
            ocv_cell_v: [3.3, 3.6, 3.68, 3.72, 3.76, 3.8, 3.85, 3.92, 4.0, 4.1, 4.2],
            avionics_power_w: 6.0,
            lamp_power_w: 20.0,
            paper_endurance_s: 1500.0,
        },
        limits: FlightLimits {
            forward_m_s: 13.4,
            sideways_speed_m_s: 10.0,
            climb_m_s: 6.0,
            descend_m_s: 2.0,
            yaw_rate_rad_s: 2.0,
            tilt_rad: 0.6,
            rate_rad_s: 3.8,
            slow_down_time_s: 1.5,
        },
        sensors: SensorSpec {
            imu_rate_hz: 400.0,
            accel_noise_density: 0.002,
            accel_bias_m_s2: 0.05,
            gyro_noise_density: 1e-4,
            gyro_bias_rad_s: 0.003,
            accel_vibration_m_s2: 0.0,
            gyro_vibration_rad_s: 0.0,
            gnss_rate_hz: 5.0,
            gnss_horizontal_noise_m: 0.5,
            gnss_vertical_noise_m: 0.8,
            gnss_velocity_noise_m_s: 0.1,
            gnss_delay_s: 0.0,
            baro_rate_hz: 50.0,
            baro_noise_m: 0.1,
            baro_drift_m_sqrt_s: 0.005,
            baro_airflow: 0.0,
            mag_rate_hz: 50.0,
            mag_noise_gauss: 0.003,
            mag_bias_gauss: 0.001,
            range_rate_hz: 20.0,
            range_noise_m: 0.02,
            range_bias_m: 0.01,
            range_max_m: 10.0,
            flow_velocity_m_s: 0.1,
        },
        camera: Camera {
            position_m: Vec3::new(0.08, 0.0, 0.03),
            width_px: 4000,
            height_px: 3000,
            hfov_rad: 1.2,
            zoom_max: 1.0,
            f_number: 2.8,
            iso_max: 1600.0,
            max_exposure_time_s: 0.02,
            gimbal_pitch_min_rad: -math::FRAC_PI_2,
            gimbal_pitch_max_rad: math::FRAC_PI_2,
            gimbal_rate_rad_s: 2.0,
        },
        lamp: Lamp { luminous_flux_lm: 2200.0, beam_angle_rad: 1.05 },
    }
}
