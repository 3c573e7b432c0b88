//! Test aircraft: a Phantom-sized quadrotor with round numbers (estimates).

use spandrel_model::frames::Vec3;
use spandrel_model::vehicle::{
    Aerodynamics, BatterySpec, Camera, Drag, FlightLimits, Hull, Lamp, Rotor, RotorModel, SensorSpec, Vehicle,
};

/// Returns the test aircraft with these sensors.
#[must_use]
pub fn vehicle_with(sensors: SensorSpec) -> Vehicle {
    let arm = |x: f64, y: f64, spin: f64| Rotor { position_m: Vec3::new(x, y, -0.02), spin };
    Vehicle {
        id: "test".into(),
        name: "Test quadrotor".into(),
        mass_kg: 1.3,
        inertia_kg_m2: [0.012, 0.012, 0.02],
        rotors: vec![arm(0.12, 0.12, 1.0), arm(-0.12, -0.12, 1.0), arm(0.12, -0.12, -1.0), arm(-0.12, 0.12, -1.0)],
        rotor: RotorModel {
            radius_m: 0.12,
            thrust_coefficient_n_s2: 9.0e-6,
            torque_coefficient_n_m_s2: 1.4e-7,
            time_constant_s: 0.04,
            max_speed_rad_s: 890.0,
            idle_speed_rad_s: 120.0,
            speed_spread: 0.0,
            inertia_kg_m2: 3.5e-5,
            drag_coefficient_n_s2_m: 3.0e-5,
            efficiency: 0.55,
        },
        drag: Drag { area_m2: [0.015, 0.018, 0.03], angular_damping_n_m_s: [0.003, 0.003, 0.003] },
        aerodynamics: Aerodynamics::default(),
        hull: Hull {
            tip_to_tip_m: 0.59,
            has_propeller_guard: false,
            body_half_extent_m: [0.09, 0.09, 0.05],
            feet_m: vec![
                Vec3::new(0.1, 0.1, 0.12),
                Vec3::new(0.1, -0.1, 0.12),
                Vec3::new(-0.1, 0.1, 0.12),
                Vec3::new(-0.1, -0.1, 0.12),
            ],
            restitution: 0.2,
            friction: 0.6,
        },
        battery: BatterySpec {
            cells: 3,
            capacity_ah: 5.2,
            internal_resistance_ohm: 0.03,
            ocv_cell_v: [3.3, 3.6, 3.69, 3.74, 3.78, 3.82, 3.87, 3.93, 4.0, 4.09, 4.2],
            avionics_power_w: 6.0,
            lamp_power_w: 0.0,
            paper_endurance_s: 1500.0,
        },
        limits: FlightLimits {
            forward_m_s: 10.0,
            sideways_speed_m_s: 8.0,
            climb_m_s: 4.0,
            descend_m_s: 2.0,
            yaw_rate_rad_s: 1.5,
            tilt_rad: 0.61,
            rate_rad_s: 3.5,
            slow_down_time_s: 2.0,
        },
        sensors,
        camera: Camera {
            position_m: Vec3::new(0.1, 0.0, 0.05),
            width_px: 4384,
            height_px: 3288,
            hfov_rad: 1.9,
            zoom_max: 1.0,
            f_number: 2.8,
            iso_max: 1600.0,
            max_exposure_time_s: 0.02,
            gimbal_pitch_min_rad: -1.57,
            gimbal_pitch_max_rad: 1.57,
            gimbal_rate_rad_s: 1.5,
        },
        lamp: Lamp { luminous_flux_lm: 0.0, beam_angle_rad: 1.0 },
    }
}
