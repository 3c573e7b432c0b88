//! Free flight: one classical Runge-Kutta step for rigid body and rotors. Within the step, rotor speeds follow their
//! exact exponential solution, so that only the rigid body is integrated numerically.

use super::airframe::AirframeModel;
use super::rotor_lanes::{AddedWinds, GROUPS, LANES, LaneVectors, RotorConditionLanes, RotorLoad};
use super::state::{AirState, MAX_ROTORS, RigidState};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math::GRAVITY_M_S2;

/// Force and torque about the center of mass, without gravity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force_n: Vec3<Frd>,
    /// Torque, N m.
    pub torque_n_m: Vec3<Frd>,
}

/// Motion and surroundings of one rotor at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorConditions {
    /// Velocity of the hub relative to the air, m/s.
    pub hub_air_m_s: Vec3<Frd>,
    /// Rotor speed, rad/s.
    pub speed_rad_s: f64,
    /// Acceleration of the rotor speed, rad/s².
    pub acceleration_rad_s2: f64,
    /// Thrust factor of surfaces and the vortex ring state; 1 without them.
    pub effect: f64,
    /// Air density divided by the one at sea level.
    pub density_ratio: f64,
}

impl RotorConditions {
    /// A rotor that turns at a constant speed and rests in open air at sea level.
    #[must_use]
    pub const fn at_rest(speed_rad_s: f64) -> Self {
        Self { hub_air_m_s: Vec3::zero(), speed_rad_s, acceleration_rad_s2: 0.0, effect: 1.0, density_ratio: 1.0 }
    }
}

/// The numerically integrated part of the state. The quaternion is not normalized between stages.
#[derive(Clone, Copy)]
struct IntegratedState {
    p: Vector3<f64>,
    v: Vector3<f64>,
    q: Quaternion<f64>,
    w: Vector3<f64>,
}

impl IntegratedState {
    fn plus(self, d: &Self, h: f64) -> Self {
        Self { p: self.p + d.p * h, v: self.v + d.v * h, q: self.q + d.q * h, w: self.w + d.w * h }
    }
}

/// Rotor speeds at one instant of a step, and the terms of the forces that depend only on them.
#[derive(Clone, Copy)]
struct RotorInstant {
    speed: [f64; MAX_ROTORS],
    momentum: Vector3<f64>,
    loads: [RotorLoad; GROUPS],
}

/// The air during one step.
struct StepAir<'a> {
    air: &'a AirState,
    added_winds: Option<AddedWinds>,
    density_ratio: f64,
}

impl<'a> StepAir<'a> {
    fn new(air: &'a AirState) -> Self {
        Self { air, added_winds: air.rotors_m_s.as_ref().map(AddedWinds::of), density_ratio: air.density_ratio() }
    }
}

/// Advances the state by `dt_s` while the rotor speeds approach `target_rad_s`. Wind and external force are constant
/// over the step.
pub fn advance(
    model: &AirframeModel,
    state: &mut RigidState,
    target_rad_s: &[f64; MAX_ROTORS],
    air: &AirState,
    effect: &[f64; MAX_ROTORS],
    dt_s: f64,
) {
    let y = IntegratedState {
        p: state.position_m.raw(),
        v: state.velocity_m_s.raw(),
        q: state.attitude.raw().into_inner(),
        w: state.rates_rad_s.raw(),
    };
    let air = StepAir::new(air);
    let rotors = |left| model.rotor_instant(state, target_rad_s, left, effect, air.density_ratio);
    let [decay_half, decay] = model.rotor_decay(dt_s);
    let (start, half, end) = (rotors(1.0), rotors(decay_half), rotors(decay));
    let k1 = derivative(model, &y, &start, &air);
    let k2 = derivative(model, &y.plus(&k1, 0.5 * dt_s), &half, &air);
    let k3 = derivative(model, &y.plus(&k2, 0.5 * dt_s), &half, &air);
    let k4 = derivative(model, &y.plus(&k3, dt_s), &end, &air);
    let sixth = dt_s / 6.0;
    // FRAME: each component keeps its frame.
    state.position_m = Vec3::assume(y.p + (k1.p + (k2.p + k3.p) * 2.0 + k4.p) * sixth);
    state.velocity_m_s = Vec3::assume(y.v + (k1.v + (k2.v + k3.v) * 2.0 + k4.v) * sixth);
    let q = y.q + (k1.q + (k2.q + k3.q) * 2.0 + k4.q) * sixth;
    state.attitude = Rotation::assume(UnitQuaternion::new_normalize(q));
    state.rates_rad_s = Vec3::assume(y.w + (k1.w + (k2.w + k3.w) * 2.0 + k4.w) * sixth);
    state.rotor_rad_s = end.speed;
}

fn derivative(model: &AirframeModel, y: &IntegratedState, rotors: &RotorInstant, air: &StepAir) -> IntegratedState {
    let attitude = UnitQuaternion::new_normalize(y.q);
    // FRAME: the stage's quaternion is the body's attitude, and its velocity is the NED velocity over ground.
    let attitude = Rotation::<Frd, Ned>::assume(attitude);
    let wrench = wrench(model, attitude, y, rotors, air);
    let force = (attitude * wrench.force_n + air.air.force_n).raw();
    let acceleration = force * model.inverse_mass + Vector3::new(0.0, 0.0, GRAVITY_M_S2 * model.gravity_scale);
    let momentum = model.inertia.component_mul(&y.w) + rotors.momentum;
    let spin = (wrench.torque_n_m.raw() - y.w.cross(&momentum)).component_mul(&model.inverse_inertia);
    let q_dot = y.q * Quaternion::new(0.0, y.w.x, y.w.y, y.w.z) * 0.5;
    IntegratedState { p: y.v, v: acceleration, q: q_dot, w: spin }
}

/// Returns the wrench of body and rotors.
#[inline]
fn wrench(
    model: &AirframeModel,
    attitude: Rotation<Frd, Ned>,
    y: &IntegratedState,
    rotors: &RotorInstant,
    air: &StepAir,
) -> Wrench {
    let to_body = attitude.inverse();
    let air_velocity_m_s = to_body * (Vec3::assume(y.v) - air.air.velocity_m_s);
    let rates_rad_s = Vec3::assume(y.w);
    let drag = body_drag(model, air_velocity_m_s, rates_rad_s, air.air.density_kg_m3);
    // One matrix for all rotors takes less time than a quaternion for each.
    let added = air.added_winds.as_ref().map(|winds| (winds, to_body.matrix()));
    let (mut force_n, mut torque_n_m) = (drag.force_n.raw(), drag.torque_n_m.raw());
    for (index, (group, load)) in model.rotor_groups.iter().zip(&rotors.loads).enumerate() {
        let mut hub_air_m_s = group.hub_velocities(air_velocity_m_s, rates_rad_s);
        if let Some((winds, to_body)) = &added {
            hub_air_m_s = winds.subtract_from(index, &hub_air_m_s, to_body);
        }
        for (force, torque) in group.wrenches(load, &hub_air_m_s, air.density_ratio) {
            force_n += force;
            torque_n_m += torque;
        }
    }
    // FRAME: the rotors' forces are in body axes, like the drag.
    Wrench { force_n: Vec3::assume(force_n), torque_n_m: Vec3::assume(torque_n_m) }
}

/// Returns the velocity of a rotor's hub relative to the air, m/s.
pub(super) fn hub_air_velocity(rigid: &RigidState, air: &AirState, index: usize, position_m: Vec3<Frd>) -> Vec3<Frd> {
    let to_body = rigid.attitude.inverse();
    let center_m_s = to_body * (rigid.velocity_m_s - air.velocity_m_s);
    let hub_m_s = center_m_s + rigid.rates_rad_s.cross(position_m);
    air.rotors_m_s.as_ref().map_or(hub_m_s, |added| hub_m_s - to_body * added[index])
}

fn body_drag(model: &AirframeModel, air_velocity_m_s: Vec3<Frd>, rates_rad_s: Vec3<Frd>, density_kg_m3: f64) -> Wrench {
    let v = air_velocity_m_s.raw();
    let k = -0.5 * density_kg_m3 * v.norm();
    // FRAME: areas and damping are about the body axes.
    Wrench {
        force_n: Vec3::assume(v.component_mul(&model.drag_area_m2) * k),
        torque_n_m: Vec3::assume(-rates_rad_s.raw().component_mul(&model.angular_damping)),
    }
}

impl AirframeModel {
    /// Returns the rotors at the time when the difference of their speeds from the target has decayed to the fraction `left` of its
    /// initial value.
    #[inline]
    fn rotor_instant(
        &self,
        state: &RigidState,
        target_rad_s: &[f64; MAX_ROTORS],
        left: f64,
        effect: &[f64; MAX_ROTORS],
        density_ratio: f64,
    ) -> RotorInstant {
        let (mut speed, mut acceleration) = ([0.0; MAX_ROTORS], [0.0; MAX_ROTORS]);
        let pairs = state.rotor_rad_s.iter().zip(target_rad_s).take(self.rotors.len());
        for (i, (now, target)) in pairs.enumerate() {
            let gap = (now - target) * left;
            speed[i] = target + gap;
            acceleration[i] = -gap / self.rotor.time_constant_s;
        }
        let mut loads = [RotorLoad::NONE; GROUPS];
        for (index, (load, group)) in loads.iter_mut().zip(&self.rotor_groups).enumerate() {
            let conditions = RotorConditionLanes::of(&speed, &acceleration, effect, index);
            *load = RotorLoad::new(&self.rotor, &self.inflow, group, &conditions, density_ratio);
        }
        RotorInstant { speed, momentum: self.rotor_momentum(&speed), loads }
    }

    fn rotor_momentum(&self, speed: &[f64; MAX_ROTORS]) -> Vector3<f64> {
        // A counterclockwise rotation, as seen from above, has a rotation vector that points up, opposite to the body's
        // down axis.
        let z: f64 = self.rotors.iter().zip(speed).map(|(r, w)| -r.spin * self.rotor.inertia_kg_m2 * w).sum();
        Vector3::new(0.0, 0.0, z)
    }

    /// Returns the wrench of one rotor about the center of mass: thrust, in-plane drag, drag torque and the reaction to
    /// its acceleration. There is none without such a rotor.
    #[must_use]
    pub fn rotor_wrench(&self, index: usize, at: &RotorConditions) -> Wrench {
        let lanes = |value| [value; MAX_ROTORS];
        let (speed, acceleration) = (lanes(at.speed_rad_s), lanes(at.acceleration_rad_s2));
        let wrench = self.rotor_groups.get(index / LANES).and_then(|group| {
            let conditions = RotorConditionLanes::of(&speed, &acceleration, &lanes(at.effect), index / LANES);
            let load = RotorLoad::new(&self.rotor, &self.inflow, group, &conditions, at.density_ratio);
            let hub_air_m_s = LaneVectors::splat(at.hub_air_m_s.raw());
            group.wrenches(&load, &hub_air_m_s, at.density_ratio).nth(index % LANES)
        });
        let (force_n, torque_n_m) = wrench.unwrap_or_default();
        // FRAME: both are in body axes.
        Wrench { force_n: Vec3::assume(force_n), torque_n_m: Vec3::assume(torque_n_m) }
    }
}
