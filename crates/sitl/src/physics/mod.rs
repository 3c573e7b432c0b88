//! Rigid body, rotors, surface effects, drag, battery and contact. State is plain data; models are functions.

pub mod battery;
pub mod contact;
pub mod hull;
pub mod rigid;
pub mod surface_effects;

use nalgebra::Vector3;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::BatteryModel;
use spandrel_model::site::{Contact, HullProbe, ObjectId, RayHit, Site, Surface};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{BatterySpec, Lamp, Rotor, RotorModel, Vehicle};

/// Maximum number of rotors.
pub const MAX_ROTORS: usize = 8;

/// True motion state of the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidState {
    /// Position of the center of mass, m, local NED.
    pub position_m: Vec3<Ned>,
    /// Velocity over ground, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude: body to NED.
    pub attitude: Rotation<Frd, Ned>,
    /// Angular velocity relative to the ground, rad/s, in body axes.
    pub rates_rad_s: Vec3<Frd>,
    /// Rotor speeds, rad/s.
    pub rotor_rad_s: [f64; MAX_ROTORS],
}

/// Actuator commands from the flight controller.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Actuators {
    /// Motor commands, 0 to 1 of the speed range (idle to maximum), in rotor order. Ignored while disarmed.
    pub motors: [f64; MAX_ROTORS],
    /// Whether the motors are armed.
    pub armed: bool,
}

/// Sea-level air density, kg/m³ (ISA, 15 °C, 1013.25 hPa).
pub const AIR_DENSITY_KG_M3: f64 = 1.225;
/// Upper bound for the speed of objects at the site, m/s: cars drive at most 35 m/s, and lane speeds vary by a tenth.
/// It limits how long a measured clearance stays valid.
pub const MAX_OBJECT_SPEED_M_S: f64 = 38.5;
/// Search radius for clearance, m.
const CLEARANCE_REACH_M: f64 = 4.0;
/// Update interval of surface effects, s.
const SURFACE_EFFECT_INTERVAL_S: f64 = 0.02;

/// The air around the aircraft, constant over one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirState {
    /// Wind at the aircraft, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Air density, kg/m³.
    pub density_kg_m3: f64,
    /// External force at the center of mass, N (TASBID's wind model).
    pub force_n: Vec3<Ned>,
}

impl AirState {
    /// Still air at sea level.
    pub const STILL: Self = Self { velocity_m_s: Vec3::zero(), density_kg_m3: AIR_DENSITY_KG_M3, force_n: Vec3::zero() };
}

/// Collision queries against the environment. [`Site`] implements this trait; tests use planes and boxes.
pub trait Obstacles {
    /// Appends contacts and near-contacts of a probe.
    fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>);
    /// Returns the distance to the nearest solid object within `max_m`, including the landing pad, m.
    fn clearance(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<f64>;
    /// Returns the first hit along a ray within `max_m`.
    fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit>;
}

impl Obstacles for Site {
    fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>) {
        Site::contacts(self, probe, margin_m, at, out);
    }
    fn clearance(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<f64> {
        self.free_radius(position_m, max_m, at)
    }
    fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit> {
        Site::ray(self, origin_m, direction, max_m, at)
    }
}

/// An environment without obstacles.
#[derive(Debug, Clone, Copy)]
pub struct OpenSky;

impl Obstacles for OpenSky {
    fn contacts(&self, _: &HullProbe, _: f64, _: SimTime, _: &mut Vec<Contact>) {}
    fn clearance(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
        None
    }
    fn ray(&self, _: Vec3<Enu>, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<RayHit> {
        None
    }
}

/// Constants of an aircraft in the form that the physics models use.
#[derive(Debug, Clone)]
pub struct AirframeModel {
    /// Mass, kg.
    pub mass_kg: f64,
    inverse_mass: f64,
    inertia: Vector3<f64>,
    inverse_inertia: Vector3<f64>,
    /// Factor on gravity: 1 on Earth, 0 in tests of torque-free motion.
    pub gravity_scale: f64,
    rotors: Vec<Rotor>,
    rotor: RotorModel,
    drag_area_m2: Vector3<f64>,
    angular_damping: Vector3<f64>,
    probes: Vec<hull::BodyProbe>,
    hull_radius_m: f64,
    restitution: f64,
    friction: f64,
    battery: BatterySpec,
    battery_model: BatteryModel,
    lamp: Lamp,
}

/// Complete physical state. It is plain data, so a clone is a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct PhysicsState {
    /// Rigid body and rotors.
    pub rigid: RigidState,
    /// Battery state.
    pub battery: battery::BatteryState,
    /// Specific force of the last step, m/s²: non-gravitational force per mass, as measured by an accelerometer.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Contacts of the last step.
    pub contact: contact::ContactReport,
    warm: contact::WarmStart,
    effect: [f64; MAX_ROTORS],
    effect_due: SimTime,
    clear_sphere: ClearSphere,
}

/// A sphere that was free of obstacles at one time. For some time after that, no contacts are possible well inside the
/// sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ClearSphere {
    center_m: Vec3<Enu>,
    radius_m: f64,
    since: SimTime,
}

impl ClearSphere {
    /// Returns the radius around `position_m` that is guaranteed to be free now, m.
    fn remaining_radius_m(&self, position_m: Vec3<Enu>, now: SimTime) -> f64 {
        self.radius_m - (position_m - self.center_m).norm() - MAX_OBJECT_SPEED_M_S * (now - self.since).s()
    }
}

impl PhysicsState {
    /// Returns the state at rest at a position and heading, with the motors off and a full battery.
    #[must_use]
    pub fn at_rest(position_m: Vec3<Ned>, yaw_rad: f64) -> Self {
        Self {
            rigid: RigidState {
                position_m,
                velocity_m_s: Vec3::zero(),
                attitude: Rotation::from_euler(0.0, 0.0, yaw_rad),
                rates_rad_s: Vec3::zero(),
                rotor_rad_s: [0.0; MAX_ROTORS],
            },
            battery: battery::BatteryState::FULL,
            specific_force_m_s2: Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2),
            contact: contact::ContactReport::default(),
            warm: contact::WarmStart::default(),
            effect: [1.0; MAX_ROTORS],
            effect_due: SimTime::ZERO,
            clear_sphere: ClearSphere { center_m: Vec3::zero(), radius_m: -1.0, since: SimTime::ZERO },
        }
    }

    /// Moves the aircraft to a position, level and at rest. The rotor speeds do not change.
    pub fn place(&mut self, position_m: Vec3<Ned>, yaw_rad: f64) {
        let fresh = Self::at_rest(position_m, yaw_rad);
        let rotor_rad_s = self.rigid.rotor_rad_s;
        self.rigid = RigidState { rotor_rad_s, ..fresh.rigid };
        self.clear_sphere = fresh.clear_sphere;
        self.warm = fresh.warm;
        self.contact = fresh.contact;
    }
}

impl AirframeModel {
    /// Builds the model from an aircraft and the battery model of the scenario.
    #[must_use]
    pub fn new(vehicle: &Vehicle, battery_model: BatteryModel) -> Self {
        let inertia = Vector3::from(vehicle.inertia_kg_m2);
        let probes = hull::probes(vehicle);
        let hull_radius_m = probes.iter().map(hull::BodyProbe::reach_m).fold(0.0, f64::max);
        Self {
            mass_kg: vehicle.mass_kg,
            inverse_mass: 1.0 / vehicle.mass_kg,
            inertia,
            inverse_inertia: inertia.map(|i| 1.0 / i),
            gravity_scale: 1.0,
            rotors: vehicle.rotors.clone(),
            rotor: vehicle.rotor,
            drag_area_m2: Vector3::from(vehicle.drag.area_m2),
            angular_damping: Vector3::from(vehicle.drag.angular_n_m_s),
            probes,
            hull_radius_m,
            restitution: vehicle.hull.restitution,
            friction: vehicle.hull.friction,
            battery: vehicle.battery.clone(),
            battery_model,
            lamp: vehicle.lamp,
        }
    }

    fn decay(&self, dt_s: f64) -> f64 {
        math::exp(-dt_s / self.rotor.time_constant_s)
    }

    fn decay_half_step(&self, dt_s: f64) -> f64 {
        math::exp(-0.5 * dt_s / self.rotor.time_constant_s)
    }

    /// Returns the rotor speed in hover, rad/s.
    #[must_use]
    pub fn hover_rotor_rad_s(&self) -> f64 {
        let per_rotor = self.mass_kg * math::GRAVITY_M_S2 / self.rotors.len() as f64;
        (per_rotor / self.rotor.thrust_coefficient_n_s2).sqrt()
    }

    /// Returns the motor command (0 to 1) in hover with a full battery.
    #[must_use]
    pub fn hover_command(&self) -> f64 {
        let speed = self.hover_rotor_rad_s();
        (speed - self.rotor.idle_speed_rad_s) / (self.rotor.max_speed_rad_s - self.rotor.idle_speed_rad_s)
    }

    /// Returns the target rotor speeds, rad/s.
    fn target_rotor_speeds(&self, actuators: &Actuators, battery: &battery::BatteryState) -> [f64; MAX_ROTORS] {
        let mut out = [0.0; MAX_ROTORS];
        if !actuators.armed || battery.empty() {
            return out;
        }
        let top = self.rotor.max_speed_rad_s * battery.speed_factor;
        for (target, command) in out.iter_mut().zip(actuators.motors).take(self.rotors.len()) {
            *target = self.rotor.idle_speed_rad_s + command.clamp(0.0, 1.0) * (top - self.rotor.idle_speed_rad_s).max(0.0);
        }
        out
    }

    /// Runs one physics step that starts at `now`.
    #[allow(clippy::too_many_arguments, reason = "inputs of one step, all of different types")]
    pub fn advance(
        &self,
        state: &mut PhysicsState,
        actuators: &Actuators,
        air: &AirState,
        obstacles: &impl Obstacles,
        load: PowerLoad,
        now: SimTime,
        dt: SimTime,
    ) {
        let dt_s = dt.s();
        let target_rotor_speeds = self.target_rotor_speeds(actuators, &state.battery);
        let position = state.rigid.position_m.enu();
        self.refresh_clearance(state, obstacles, position, now);
        self.refresh_effects(state, obstacles, now);
        let start = state.rigid;
        let before = start.velocity_m_s;
        rigid::advance(self, &mut state.rigid, &target_rotor_speeds, air, &state.effect, dt_s);
        let reach = self.hull_radius_m + state.rigid.velocity_m_s.norm().max(before.norm()) * dt_s + contact::MARGIN_M;
        if state.clear_sphere.remaining_radius_m(state.rigid.position_m.enu(), now + dt) <= reach {
            contact::resolve(self, state, &start, obstacles, now + dt, dt_s);
        } else if state.contact.touching() {
            state.contact = contact::ContactReport::default();
            state.warm = contact::WarmStart::default();
        }
        let gravity = Vec3::<Ned>::new(0.0, 0.0, math::GRAVITY_M_S2 * self.gravity_scale);
        let felt = (state.rigid.velocity_m_s - before) / dt_s - gravity;
        state.specific_force_m_s2 = state.rigid.attitude.inverse() * felt;
        battery::advance(self, state, load, dt_s);
    }

    fn refresh_clearance(&self, state: &mut PhysicsState, obstacles: &impl Obstacles, position_m: Vec3<Enu>, now: SimTime) {
        let speed = state.rigid.velocity_m_s.norm();
        let need = self.hull_radius_m.max(surface_effects::reach_m(self)) + 0.05 + 0.002 * speed;
        if state.clear_sphere.remaining_radius_m(position_m, now) > need {
            return;
        }
        let radius_m = obstacles.clearance(position_m, CLEARANCE_REACH_M, now).unwrap_or(CLEARANCE_REACH_M);
        state.clear_sphere = ClearSphere { center_m: position_m, radius_m, since: now };
    }

    fn refresh_effects(&self, state: &mut PhysicsState, obstacles: &impl Obstacles, now: SimTime) {
        if now < state.effect_due {
            return;
        }
        state.effect_due = now + SimTime::from_s(SURFACE_EFFECT_INTERVAL_S);
        let reach = surface_effects::reach_m(self);
        let spinning = state.rigid.rotor_rad_s[0] > 0.0;
        if !spinning || state.clear_sphere.remaining_radius_m(state.rigid.position_m.enu(), now) > reach + self.hull_radius_m {
            state.effect = [1.0; MAX_ROTORS];
            return;
        }
        state.effect = surface_effects::factors(self, &state.rigid, obstacles, now);
    }
}

/// Inputs to the battery model for one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PowerLoad {
    /// Whether the lamp is on.
    pub lamp_on: bool,
    /// Whether the vehicle has lifted off, which starts the clock of the `paper` battery model.
    pub airborne: bool,
}

/// Returns the more severe of two surfaces for reports. The order is person, vehicle, bridge, terrain, water, other
/// (docs/src/reference/wire.md, "Scoring data").
#[must_use]
pub fn more_severe_surface(a: Surface, b: Surface) -> Surface {
    const ORDER: [Surface; 7] =
        [Surface::Person, Surface::Vehicle, Surface::Bridge, Surface::Terrain, Surface::Water, Surface::Other, Surface::Pad];
    let rank = |s: Surface| ORDER.iter().position(|o| *o == s).unwrap_or(ORDER.len());
    if rank(a) <= rank(b) { a } else { b }
}

/// ID of a touched object, re-exported for reports.
pub type Touched = ObjectId;
