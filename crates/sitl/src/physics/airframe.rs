//! Constants of one aircraft, precomputed for the models.

use super::inflow::Inflow;
use super::multirotor_surfaces::RotorLayout;
use super::rotor_lanes::RotorGroup;
use super::state::{Actuators, BatteryState, MAX_ROTORS};
use super::vortex_ring::VortexRing;
use super::walls::Walls;
use nalgebra::{Vector2, Vector3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::BatteryModel;
use spandrel_model::site::aircraft_hull::{BodyProbe, hull_radius_m, probes};
use spandrel_model::vehicle::{AirDensity, BatterySpec, Lamp, Rotor, RotorModel, SurfaceEffects, Vehicle};
use std::sync::Arc;

/// Step for which the decay of the rotor speeds is computed in advance, s.
const USUAL_STEP_S: f64 = 1e-3;
/// Largest deviation of a rotor's speed, in standard deviations: makers sort out worse motors.
const MAX_SPREAD_SIGMAS: f64 = 2.5;

fn decay(rotor: &RotorModel, dt_s: f64) -> [f64; 2] {
    [math::exp(-0.5 * dt_s / rotor.time_constant_s), math::exp(-dt_s / rotor.time_constant_s)]
}

/// Constants of an aircraft in the form that the physics models use.
#[derive(Debug, Clone)]
pub struct AirframeModel {
    /// Mass, kg.
    pub mass_kg: f64,
    pub(super) inverse_mass: f64,
    pub(super) inertia: Vector3<f64>,
    pub(super) inverse_inertia: Vector3<f64>,
    /// Gravity factor: 1 on Earth, 0 in tests of torque-free motion.
    pub gravity_scale: f64,
    pub(super) rotors: Vec<Rotor>,
    pub(super) rotor: RotorModel,
    /// Speed of each rotor at a command relative to the nominal one.
    speed_factors: [f64; MAX_ROTORS],
    usual_decay: [f64; 2],
    pub(super) rotor_groups: Vec<RotorGroup>,
    pub(super) inflow: Inflow,
    pub(super) vortex_ring: Option<VortexRing>,
    pub(super) walls: Option<Walls>,
    pub(super) surface_effects: SurfaceEffects,
    pub(super) layout: RotorLayout,
    air_density: AirDensity,
    pub(super) drag_area_m2: Vector3<f64>,
    pub(super) angular_damping: Vector3<f64>,
    pub(crate) probes: Arc<[BodyProbe]>,
    pub(super) hull_radius_m: f64,
    pub(super) restitution: f64,
    pub(super) friction: f64,
    pub(super) battery: BatterySpec,
    pub(super) battery_model: BatteryModel,
    pub(super) lamp: Lamp,
}

impl AirframeModel {
    /// Builds the model from an aircraft and the battery model of the scenario.
    #[must_use]
    pub fn new(vehicle: &Vehicle, battery_model: BatteryModel) -> Self {
        let inertia = Vector3::from(vehicle.inertia_kg_m2);
        let probes = probes(vehicle);
        let hull_radius_m = hull_radius_m(&probes);
        Self {
            mass_kg: vehicle.mass_kg,
            inverse_mass: 1.0 / vehicle.mass_kg,
            inertia,
            inverse_inertia: inertia.map(|i| 1.0 / i),
            gravity_scale: 1.0,
            rotors: vehicle.rotors.clone(),
            rotor: vehicle.rotor,
            speed_factors: [1.0; MAX_ROTORS],
            usual_decay: decay(&vehicle.rotor, USUAL_STEP_S),
            rotor_groups: RotorGroup::all(&vehicle.rotors),
            inflow: Inflow::of(&vehicle.aerodynamics),
            vortex_ring: VortexRing::of(vehicle),
            walls: Walls::of(vehicle),
            surface_effects: vehicle.aerodynamics.surface_effects,
            layout: RotorLayout {
                hubs_m: vehicle.rotors.iter().map(|r| Vector2::new(r.position_m.forward(), r.position_m.right())).collect(),
                radius_m: vehicle.rotor.radius_m,
            },
            air_density: vehicle.aerodynamics.air_density,
            drag_area_m2: Vector3::from(vehicle.drag.area_m2),
            angular_damping: Vector3::from(vehicle.drag.angular_damping_n_m_s),
            probes: probes.into(),
            hull_radius_m,
            restitution: vehicle.hull.restitution,
            friction: vehicle.hull.friction,
            battery: vehicle.battery.clone(),
            battery_model,
            lamp: vehicle.lamp,
        }
    }

    /// Returns the radius of the sphere about the center of mass that contains the hull, m.
    #[must_use]
    pub fn hull_radius_m(&self) -> f64 {
        self.hull_radius_m
    }

    /// Returns the model with a battery at a temperature, °C.
    #[must_use]
    pub fn with_battery_at(mut self, temperature_c: f64) -> Self {
        self.battery.internal_resistance_ohm = self.battery.resistance_ohm(temperature_c);
        self
    }

    /// Returns the model with rotors that differ as the motors and speed controllers of one aircraft do, drawn for a seed.
    #[must_use]
    pub fn with_rotor_spread(mut self, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "rotors.spread");
        for factor in &mut self.speed_factors {
            *factor = 1.0 + self.rotor.speed_spread * stream.normal().clamp(-MAX_SPREAD_SIGMAS, MAX_SPREAD_SIGMAS);
        }
        self
    }

    /// Returns the density of the air around the aircraft at an altitude above mean sea level, kg/m³.
    #[must_use]
    pub fn air_density_kg_m3(&self, altitude_m: f64) -> f64 {
        self.air_density.kg_m3(altitude_m)
    }

    /// Returns the fractions of a difference of the rotor speeds from their targets that are left after half a step and after the
    /// whole step.
    pub(super) fn rotor_decay(&self, dt_s: f64) -> [f64; 2] {
        if dt_s == USUAL_STEP_S { self.usual_decay } else { decay(&self.rotor, dt_s) }
    }

    /// Returns the rotor speed at hover, in rad/s.
    #[must_use]
    pub fn hover_rotor_rad_s(&self) -> f64 {
        self.rotor.hover_speed_rad_s(self.mass_kg, self.rotors.len())
    }

    /// Returns the motor command (0 to 1) at hover with a full battery.
    #[must_use]
    pub fn hover_command(&self) -> f64 {
        let speed = self.hover_rotor_rad_s();
        (speed - self.rotor.idle_speed_rad_s) / (self.rotor.max_speed_rad_s - self.rotor.idle_speed_rad_s)
    }

    /// Returns the target rotor speeds, in rad/s.
    pub(super) fn target_rotor_speeds(&self, actuators: &Actuators, battery: &BatteryState) -> [f64; MAX_ROTORS] {
        let mut out = [0.0; MAX_ROTORS];
        if !actuators.armed || battery.empty() {
            return out;
        }
        let top = self.rotor.max_speed_rad_s * battery.speed_factor;
        let commands = actuators.motors.iter().zip(self.speed_factors);
        for (target, (command, factor)) in out.iter_mut().zip(commands).take(self.rotors.len()) {
            let nominal = self.rotor.idle_speed_rad_s + command.clamp(0.0, 1.0) * (top - self.rotor.idle_speed_rad_s).max(0.0);
            *target = factor * nominal;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::testing::vehicle_with;
    use crate::sensors::tests::error_free_sensors;

    fn speeds(spread: f64, seed: u64) -> [f64; MAX_ROTORS] {
        let mut vehicle = vehicle_with(error_free_sensors());
        vehicle.rotor.speed_spread = spread;
        let model = AirframeModel::new(&vehicle, BatteryModel::Paper).with_rotor_spread(seed);
        model.target_rotor_speeds(&Actuators { armed: true, motors: [0.5; MAX_ROTORS] }, &BatteryState::FULL)
    }

    #[test]
    fn exact_rotor_speeds_differ_by_their_spread() {
        const SPREAD: f64 = 0.01;
        // Relative tolerance: four standard errors of the deviation of 1,600 speeds, and 2% that the cut at 2.5 deviations takes.
        const TOLERANCE: f64 = 0.09;
        let nominal = speeds(0.0, 1)[0];
        let deviations: Vec<f64> =
            (0..400).flat_map(|seed| speeds(SPREAD, seed).into_iter().take(4)).map(|s| s / nominal - 1.0).collect();
        let square = deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64;
        assert!((square.sqrt() / SPREAD - 1.0).abs() < TOLERANCE, "{}", square.sqrt());
        assert_eq!(speeds(SPREAD, 3), speeds(SPREAD, 3));
        assert_ne!(speeds(SPREAD, 3), speeds(SPREAD, 4));
        assert!(speeds(0.0, 3).iter().take(4).all(|speed| *speed == nominal));
    }
}
