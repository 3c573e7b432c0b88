//! Parses vehicle files into [`Vehicle`]. Defines each key with its unit, range and default.

use super::{
    Aerodynamics, AirDensity, BatterySpec, Camera, Drag, FlightLimits, Hull, Lamp, Rotor, RotorModel, SensorSpec, SurfaceEffects,
    Vehicle,
};
use crate::frames::Vec3;
use crate::math::{self, GRAVITY_M_S2};
use crate::toml::{DocumentedKey, Problems, Reader, Section};
use std::collections::BTreeMap;

/// Latest supported format version.
pub const FORMAT: i64 = 1;
const MAX_ROTORS: usize = 8;
/// Minimum ratio of maximum thrust to weight for a controllable aircraft (estimate; typical multicopters have 1.8 or more).
const MIN_THRUST_TO_WEIGHT: f64 = 1.2;

/// Parses a vehicle file. `file` is the file name used in messages; its stem becomes [`Vehicle::id`].
///
/// # Errors
/// Returns all problems in the file, each with line, key, value and allowed range.
pub fn read(file: &str, text: &str) -> Result<Vehicle, Problems> {
    read_with_keys(file, text).0
}

/// Parses a vehicle file. Also returns the keys that were read, for the documentation test.
pub fn read_with_keys(file: &str, text: &str) -> (Result<Vehicle, Problems>, BTreeMap<String, DocumentedKey>) {
    let mut reader = Reader::new(file, text);
    let vehicle = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        let vehicle = read_vehicle(&mut reader, &mut root, file);
        reader.finish(&root);
        vehicle
    });
    let result = match vehicle {
        Some(vehicle) if reader.problems.is_empty() => Ok(vehicle),
        _ => Err(Problems(reader.problems)),
    };
    (result, reader.documented_keys)
}

fn file_stem(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.strip_suffix(".toml").unwrap_or(name).to_string()
}

fn read_vehicle(r: &mut Reader, root: &mut Section, file: &str) -> Vehicle {
    r.integer(root, "format", (1, FORMAT), None);
    let name = r.text(root, "name", None);
    let mass_kg = r.number(root, "mass_kg", (0.05, 50.0), None);
    let inertia_kg_m2 = r.numbers(root, "inertia_kg_m2", (1e-6, 50.0), None);
    let (rotors, rotor) = rotors(r, root);
    let lift_kg =
        rotors.len() as f64 * rotor.thrust_coefficient_n_s2 * rotor.max_speed_rad_s * rotor.max_speed_rad_s / GRAVITY_M_S2;
    if lift_kg < MIN_THRUST_TO_WEIGHT * mass_kg && r.problems.is_empty() {
        let most = format!("at most {:.3}, because the rotors can lift {lift_kg:.3} kg", lift_kg / MIN_THRUST_TO_WEIGHT);
        r.add_problem(root, "mass_kg", &mass_kg.to_string(), &most, "too heavy to fly");
    }
    if r.problems.is_empty()
        && let Some(allowed) = super::control_authority::unmet_requirement(&rotors, &rotor, mass_kg)
    {
        let places = rotors.iter().map(|rotor| format!("{:?}", rotor.position_m.array())).collect::<Vec<_>>().join(", ");
        r.add_problem(root, "rotors.position_m", &places, allowed, "insufficient control authority");
    }
    Vehicle {
        id: file_stem(file),
        name,
        mass_kg,
        inertia_kg_m2,
        rotors,
        rotor,
        drag: drag(r, root),
        aerodynamics: aerodynamics(r, root),
        hull: hull(r, root),
        battery: battery(r, root),
        limits: limits(r, root),
        sensors: sensors(r, root),
        camera: camera(r, root),
        lamp: lamp(r, root),
    }
}

fn rotors(r: &mut Reader, root: &mut Section) -> (Vec<Rotor>, RotorModel) {
    let mut s = r.section(root, "rotors");
    let places = r.points(&mut s, "position_m", (-5.0, 5.0));
    let spins = r.integers(&mut s, "spin", (-1, 1));
    if places.len() < 4 || places.len() > MAX_ROTORS || places.len() != spins.len() || spins.contains(&0) {
        r.add_problem(&s, "spin", "", "4 to 8 rotors, each with a spin of -1 or 1", "wrong number of rotors or invalid spin");
    }
    let model = RotorModel {
        radius_m: r.number(&mut s, "radius_m", (0.01, 1.0), None),
        thrust_coefficient_n_s2: r.number(&mut s, "thrust_coefficient_n_s2", (1e-9, 1e-2), None),
        torque_coefficient_n_m_s2: r.number(&mut s, "torque_coefficient_n_m_s2", (1e-12, 1e-3), None),
        time_constant_s: r.number(&mut s, "time_constant_s", (0.005, 0.5), None),
        max_speed_rad_s: r.number(&mut s, "max_speed_rad_s", (50.0, 10_000.0), None),
        idle_speed_rad_s: r.number(&mut s, "idle_speed_rad_s", (0.0, 2_000.0), None),
        speed_spread: r.number(&mut s, "speed_spread", (0.0, 0.05), Some(0.0)),
        inertia_kg_m2: r.number(&mut s, "inertia_kg_m2", (0.0, 0.1), None),
        drag_coefficient_n_s2_m: r.number(&mut s, "drag_coefficient_n_s2_m", (0.0, 0.01), None),
        efficiency: r.number(&mut s, "efficiency", (0.1, 1.0), None),
    };
    if model.idle_speed_rad_s >= model.max_speed_rad_s {
        r.add_problem(&s, "idle_speed_rad_s", &model.idle_speed_rad_s.to_string(), "less than max_speed_rad_s", "too high");
    }
    r.finish(&s);
    let rotors = places.iter().zip(&spins).map(|(p, spin)| Rotor { position_m: Vec3::new(p[0], p[1], p[2]), spin: *spin as f64 });
    (rotors.collect(), model)
}

fn drag(r: &mut Reader, root: &mut Section) -> Drag {
    let mut s = r.section(root, "drag");
    let drag = Drag {
        area_m2: r.numbers(&mut s, "area_m2", (0.0, 5.0), None),
        angular_damping_n_m_s: r.numbers(&mut s, "angular_n_m_s", (0.0, 1.0), None),
    };
    r.finish(&s);
    drag
}

/// Names of the density models; the first is the default.
const AIR_DENSITIES: [(&str, AirDensity); 2] = [("sea-level", AirDensity::SeaLevel), ("altitude", AirDensity::Altitude)];
/// Names of the models of surface effects; the first is the default.
const SURFACE_EFFECTS: [(&str, SurfaceEffects); 2] =
    [("single-rotor", SurfaceEffects::SingleRotor), ("multirotor", SurfaceEffects::Multirotor)];

fn aerodynamics(r: &mut Reader, root: &mut Section) -> Aerodynamics {
    let mut s = r.section(root, "aerodynamics");
    let aerodynamics = Aerodynamics {
        inflow_coefficient_n_s2_m: r.number(&mut s, "inflow_coefficient_n_s2_m", (0.0, 0.01), Some(0.0)),
        translational_lift_n_s2_m2: r.number(&mut s, "translational_lift_n_s2_m2", (0.0, 0.5), Some(0.0)),
        vortex_ring_loss: r.number(&mut s, "vortex_ring_loss", (0.0, 0.5), Some(0.0)),
        air_density: r.keyword(&mut s, "air_density", &AIR_DENSITIES, Some(0)),
        surface_effects: r.keyword(&mut s, "surface_effects", &SURFACE_EFFECTS, Some(0)),
        wall_suction: r.number(&mut s, "wall_suction", (0.0, 0.3), Some(0.0)),
        recirculation_loss: r.number(&mut s, "recirculation_loss", (0.0, 0.3), Some(0.0)),
    };
    r.finish(&s);
    aerodynamics
}

/// Minimum number of feet for a stable stance on the ground.
const MIN_FEET: usize = 3;

fn hull(r: &mut Reader, root: &mut Section) -> Hull {
    let mut s = r.section(root, "hull");
    let hull = Hull {
        tip_to_tip_m: r.number(&mut s, "tip_to_tip_m", (0.05, 5.0), None),
        has_propeller_guard: r.boolean(&mut s, "caged", false),
        body_half_extent_m: r.numbers(&mut s, "body_half_extent_m", (0.005, 2.0), None),
        feet_m: r.points(&mut s, "feet_m", (-2.0, 2.0)).iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect(),
        restitution: r.number(&mut s, "restitution", (0.0, 0.95), None),
        friction: r.number(&mut s, "friction", (0.0, 2.0), None),
    };
    // A spherical cage without feet would roll in the wind.
    let cage_m = 0.5 * hull.tip_to_tip_m;
    let carrying = hull.feet_m.iter().filter(|foot| foot.down() >= cage_m).count();
    if hull.has_propeller_guard && carrying < MIN_FEET {
        let allowed = format!("at least {MIN_FEET} landing feet, each at least {cage_m} m below the center");
        r.add_problem(&s, "feet_m", "", &allowed, "the aircraft would rest on its spherical cage and roll");
    }
    r.finish(&s);
    hull
}

fn battery(r: &mut Reader, root: &mut Section) -> BatterySpec {
    let mut s = r.section(root, "battery");
    let battery = BatterySpec {
        cells: r.integer(&mut s, "cells", (1, 14), None) as u32,
        capacity_ah: r.number(&mut s, "capacity_ah", (0.1, 100.0), None),
        internal_resistance_ohm: r.number(&mut s, "internal_resistance_ohm", (0.0, 1.0), None),
        ocv_cell_v: r.numbers(&mut s, "ocv_cell_v", (2.5, 4.5), None),
        avionics_power_w: r.number(&mut s, "avionics_w", (0.0, 200.0), None),
        lamp_power_w: r.number(&mut s, "lamp_w", (0.0, 500.0), None),
        paper_endurance_s: r.number(&mut s, "paper_endurance_s", (10.0, 10_000.0), Some(1500.0)),
    };
    if battery.ocv_cell_v.windows(2).any(|w| w[1] < w[0]) {
        r.add_problem(&s, "ocv_cell_v", "", "11 increasing values", "open-circuit voltage decreases with charge");
    }
    r.finish(&s);
    battery
}

fn limits(r: &mut Reader, root: &mut Section) -> FlightLimits {
    let mut s = r.section(root, "limits");
    let limits = FlightLimits {
        forward_m_s: r.number(&mut s, "forward_m_s", (0.5, 40.0), None),
        sideways_speed_m_s: r.number(&mut s, "sideward_m_s", (0.5, 40.0), None),
        climb_m_s: r.number(&mut s, "climb_m_s", (0.3, 20.0), None),
        descend_m_s: r.number(&mut s, "descend_m_s", (0.3, 20.0), None),
        yaw_rate_rad_s: r.number(&mut s, "yaw_rate_deg_s", (5.0, 720.0), None).to_radians(),
        tilt_rad: r.number(&mut s, "tilt_deg", (5.0, 60.0), None).to_radians(),
        rate_rad_s: r.number(&mut s, "rate_deg_s", (20.0, 1500.0), None).to_radians(),
        slow_down_time_s: r.number(&mut s, "slow_down_time_s", (0.2, 10.0), None),
    };
    // At maximum tilt, the braking deceleration is g tan(tilt). The effects of air drag and the time needed to tilt
    // roughly cancel out (verified in simulation for every shipped aircraft).
    let least_s = limits.forward_m_s.max(limits.sideways_speed_m_s) / (GRAVITY_M_S2 * math::tan(limits.tilt_rad));
    if limits.slow_down_time_s < least_s && r.problems.is_empty() {
        let allowed = format!("at least {least_s:.2}, which is full speed divided by g tan(tilt_deg)");
        r.add_problem(&s, "slow_down_time_s", &limits.slow_down_time_s.to_string(), &allowed, "too short for the maximum tilt");
    }
    r.finish(&s);
    limits
}

fn sensors(r: &mut Reader, root: &mut Section) -> SensorSpec {
    let mut s = r.section(root, "sensors");
    let mut n = |key: &'static str, range: (f64, f64), default: f64| r.number(&mut s, key, range, Some(default));
    let sensors = SensorSpec {
        imu_rate_hz: n("imu_rate_hz", (100.0, 1000.0), 400.0),
        accel_noise_density: n("accel_noise_density_m_s2_sqrt_hz", (0.0, 1.0), 0.002),
        accel_bias_m_s2: n("accel_bias_m_s2", (0.0, 2.0), 0.05),
        gyro_noise_density: n("gyro_noise_density_rad_s_sqrt_hz", (0.0, 0.1), 1e-4),
        gyro_bias_rad_s: n("gyro_bias_rad_s", (0.0, 0.2), 0.003),
        accel_vibration_m_s2: n("accel_vibration_m_s2", (0.0, 10.0), 0.0),
        gyro_vibration_rad_s: n("gyro_vibration_rad_s", (0.0, 1.0), 0.0),
        gnss_rate_hz: n("gnss_rate_hz", (1.0, 20.0), 5.0),
        gnss_horizontal_noise_m: n("gnss_horizontal_m", (0.0, 20.0), 0.5),
        gnss_vertical_noise_m: n("gnss_vertical_m", (0.0, 40.0), 0.8),
        gnss_velocity_noise_m_s: n("gnss_velocity_m_s", (0.0, 2.0), 0.1),
        gnss_delay_s: n("gnss_delay_s", (0.0, 0.3), 0.0),
        baro_rate_hz: n("baro_rate_hz", (5.0, 200.0), 50.0),
        baro_noise_m: n("baro_noise_m", (0.0, 10.0), 0.1),
        baro_drift_m_sqrt_s: n("baro_drift_m_sqrt_s", (0.0, 1.0), 0.005),
        baro_airflow: n("baro_airflow", (-2.0, 2.0), 0.0),
        mag_rate_hz: n("mag_rate_hz", (5.0, 200.0), 50.0),
        mag_noise_gauss: n("mag_noise_gauss", (0.0, 0.2), 0.003),
        mag_bias_gauss: n("mag_bias_gauss", (0.0, 0.1), 0.001),
        range_rate_hz: n("range_rate_hz", (1.0, 50.0), 20.0),
        range_noise_m: n("range_noise_m", (0.0, 1.0), 0.02),
        range_bias_m: n("range_bias_m", (0.0, 1.0), 0.01),
        range_max_m: n("range_max_m", (1.0, 100.0), 10.0),
        flow_velocity_m_s: n("flow_velocity_m_s", (0.0, 2.0), 0.0),
    };
    r.finish(&s);
    sensors
}

fn camera(r: &mut Reader, root: &mut Section) -> Camera {
    let mut s = r.section(root, "camera");
    let [x, y, z] = r.numbers(&mut s, "position_m", (-2.0, 2.0), None);
    let camera = Camera {
        position_m: Vec3::new(x, y, z),
        width_px: r.integer(&mut s, "width_px", (160, 20_000), None) as u32,
        height_px: r.integer(&mut s, "height_px", (120, 20_000), None) as u32,
        hfov_rad: r.number(&mut s, "hfov_deg", (5.0, 150.0), None).to_radians(),
        zoom_max: r.number(&mut s, "zoom_max", (1.0, 30.0), Some(1.0)),
        f_number: r.number(&mut s, "f_number", (0.9, 22.0), None),
        iso_max: r.number(&mut s, "iso_max", (50.0, 409_600.0), None),
        max_exposure_time_s: r.number(&mut s, "exposure_max_s", (1e-4, 1.0), None),
        gimbal_pitch_min_rad: r.number(&mut s, "gimbal_pitch_min_deg", (-120.0, 0.0), Some(-90.0)).to_radians(),
        gimbal_pitch_max_rad: r.number(&mut s, "gimbal_pitch_max_deg", (0.0, 120.0), Some(90.0)).to_radians(),
        gimbal_rate_rad_s: r.number(&mut s, "gimbal_rate_deg_s", (5.0, 720.0), None).to_radians(),
    };
    r.finish(&s);
    camera
}

fn lamp(r: &mut Reader, root: &mut Section) -> Lamp {
    let mut s = r.section(root, "lamp");
    let lamp = Lamp {
        luminous_flux_lm: r.number(&mut s, "flux_lm", (0.0, 100_000.0), Some(0.0)),
        beam_angle_rad: r.number(&mut s, "beam_deg", (5.0, 170.0), Some(60.0)).to_radians(),
    };
    r.finish(&s);
    lamp
}
