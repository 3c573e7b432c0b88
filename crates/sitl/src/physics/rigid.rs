//! Free flight: one classical Runge-Kutta step for rigid body and rotors. Within the step, rotor speeds follow their
//! exact exponential solution, so that only the rigid body is integrated numerically.

use super::airframe::AirframeModel;
use super::state::{AirState, MAX_ROTORS, RigidState};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
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

/// Rotor speeds and accelerations at one instant of a step.
#[derive(Clone, Copy)]
struct RotorInstant {
    speed: [f64; MAX_ROTORS],
    acceleration: [f64; MAX_ROTORS],
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
    let start = model.rotor_instant(state, target_rad_s, 1.0);
    let half = model.rotor_instant(state, target_rad_s, model.decay_half_step(dt_s));
    let end = model.rotor_instant(state, target_rad_s, model.decay(dt_s));
    let k1 = derivative(model, &y, &start, air, effect);
    let k2 = derivative(model, &y.plus(&k1, 0.5 * dt_s), &half, air, effect);
    let k3 = derivative(model, &y.plus(&k2, 0.5 * dt_s), &half, air, effect);
    let k4 = derivative(model, &y.plus(&k3, dt_s), &end, air, effect);
    let sixth = dt_s / 6.0;
    // FRAME: each component keeps its frame.
    state.position_m = Vec3::assume(y.p + (k1.p + (k2.p + k3.p) * 2.0 + k4.p) * sixth);
    state.velocity_m_s = Vec3::assume(y.v + (k1.v + (k2.v + k3.v) * 2.0 + k4.v) * sixth);
    let q = y.q + (k1.q + (k2.q + k3.q) * 2.0 + k4.q) * sixth;
    state.attitude = Rotation::assume(UnitQuaternion::new_normalize(q));
    state.rates_rad_s = Vec3::assume(y.w + (k1.w + (k2.w + k3.w) * 2.0 + k4.w) * sixth);
    state.rotor_rad_s = end.speed;
}

fn derivative(
    model: &AirframeModel,
    y: &IntegratedState,
    rotors: &RotorInstant,
    air: &AirState,
    effect: &[f64; MAX_ROTORS],
) -> IntegratedState {
    let attitude = UnitQuaternion::new_normalize(y.q);
    // FRAME: the stage's quaternion is the body's attitude, and its velocity is the NED velocity over ground.
    let attitude = Rotation::<Frd, Ned>::assume(attitude);
    let air_velocity = attitude.inverse() * (Vec3::assume(y.v) - air.velocity_m_s);
    // One matrix for all rotors takes less time than a quaternion for each.
    let to_body = air.rotors_m_s.as_ref().map(|_| attitude.inverse().matrix());
    let wrench = wrench(model, (air_velocity, to_body), Vec3::assume(y.w), rotors, air, effect);
    let force = (attitude * wrench.force_n + air.force_n).raw();
    let acceleration = force * model.inverse_mass + Vector3::new(0.0, 0.0, GRAVITY_M_S2 * model.gravity_scale);
    let momentum = model.inertia.component_mul(&y.w) + model.rotor_momentum(&rotors.speed);
    let spin = (wrench.torque_n_m.raw() - y.w.cross(&momentum)).component_mul(&model.inverse_inertia);
    let q_dot = y.q * Quaternion::new(0.0, y.w.x, y.w.y, y.w.z) * 0.5;
    IntegratedState { p: y.v, v: acceleration, q: q_dot, w: spin }
}

/// Returns the wrench for a velocity relative to the air at the center of mass, and the rotation to the body if the wind differs at the
/// rotors.
fn wrench(
    model: &AirframeModel,
    (air_velocity_m_s, to_body): (Vec3<Frd>, Option<Matrix3<f64>>),
    rates_rad_s: Vec3<Frd>,
    rotors: &RotorInstant,
    air: &AirState,
    effect: &[f64; MAX_ROTORS],
) -> Wrench {
    let mut total = body_drag(model, air_velocity_m_s, rates_rad_s, air.density_kg_m3);
    let density_ratio = air.density_ratio();
    for (i, rotor) in model.rotors.iter().enumerate() {
        let (speed_rad_s, acceleration_rad_s2) = (rotors.speed[i], rotors.acceleration[i]);
        // FRAME: the matrix turns NED into body axes.
        let added_m_s = to_body.zip(air.rotors_m_s.as_ref()).map(|(to_body, winds)| Vec3::assume(to_body * winds[i].raw()));
        let hub_air_m_s = hub_velocity(air_velocity_m_s, rates_rad_s, rotor.position_m, added_m_s);
        let conditions = RotorConditions { hub_air_m_s, speed_rad_s, acceleration_rad_s2, effect: effect[i], density_ratio };
        let one = model.rotor_wrench(i, &conditions);
        total.force_n += one.force_n;
        total.torque_n_m += one.torque_n_m;
    }
    total
}

/// Returns the velocity of a rotor's hub relative to the air, m/s.
pub(super) fn hub_air_velocity(rigid: &RigidState, air: &AirState, index: usize, position_m: Vec3<Frd>) -> Vec3<Frd> {
    let to_body = rigid.attitude.inverse();
    let added_m_s = air.rotors_m_s.as_ref().map(|added| to_body * added[index]);
    hub_velocity(to_body * (rigid.velocity_m_s - air.velocity_m_s), rigid.rates_rad_s, position_m, added_m_s)
}

/// Returns the velocity of a hub relative to the air, from that of the center of mass and the wind that is added at the hub, m/s.
fn hub_velocity(
    air_velocity_m_s: Vec3<Frd>,
    rates_rad_s: Vec3<Frd>,
    position_m: Vec3<Frd>,
    added_m_s: Option<Vec3<Frd>>,
) -> Vec3<Frd> {
    let hub = air_velocity_m_s + rates_rad_s.cross(position_m);
    added_m_s.map_or(hub, |wind| hub - wind)
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
    /// Returns the rotor speeds and accelerations at the time when their difference from the target has decayed to the
    /// fraction `left` of its initial value.
    fn rotor_instant(&self, state: &RigidState, target_rad_s: &[f64; MAX_ROTORS], left: f64) -> RotorInstant {
        let mut out = RotorInstant { speed: [0.0; MAX_ROTORS], acceleration: [0.0; MAX_ROTORS] };
        let pairs = state.rotor_rad_s.iter().zip(target_rad_s).take(self.rotors.len());
        for (i, (now, target)) in pairs.enumerate() {
            let gap = (now - target) * left;
            out.speed[i] = target + gap;
            out.acceleration[i] = -gap / self.rotor.time_constant_s;
        }
        out
    }

    fn rotor_momentum(&self, speed: &[f64; MAX_ROTORS]) -> Vector3<f64> {
        // A counterclockwise rotation, as seen from above, has a rotation vector that points up, opposite to the body's
        // down axis.
        let z: f64 = self.rotors.iter().zip(speed).map(|(r, w)| -r.spin * self.rotor.inertia_kg_m2 * w).sum();
        Vector3::new(0.0, 0.0, z)
    }

    /// Returns the wrench of one rotor about the center of mass: thrust, in-plane drag, drag torque and the reaction to
    /// its acceleration.
    #[must_use]
    pub fn rotor_wrench(&self, index: usize, at: &RotorConditions) -> Wrench {
        let rotor = &self.rotors[index];
        let m = &self.rotor;
        let squared = at.speed_rad_s * at.speed_rad_s;
        let h = -m.drag_coefficient_n_s2_m * at.speed_rad_s * at.density_ratio;
        let thrust_n = self.thrust_n(at) * at.density_ratio;
        let force_n = Vec3::new(h * at.hub_air_m_s.forward(), h * at.hub_air_m_s.right(), -thrust_n);
        let torque = m.torque_coefficient_n_m_s2 * squared * at.density_ratio;
        let yaw = rotor.spin * (torque + m.inertia_kg_m2 * at.acceleration_rad_s2);
        let torque_n_m = rotor.position_m.cross(force_n) + Vec3::new(0.0, 0.0, yaw);
        Wrench { force_n, torque_n_m }
    }

    /// Returns the thrust of a rotor at sea-level density, N.
    fn thrust_n(&self, at: &RotorConditions) -> f64 {
        let static_n = self.rotor.thrust_coefficient_n_s2 * (at.speed_rad_s * at.speed_rad_s) * at.effect;
        match &self.inflow {
            None => static_n,
            Some(inflow) => static_n + inflow.change_n(at.hub_air_m_s, at.speed_rad_s, static_n),
        }
    }
}
