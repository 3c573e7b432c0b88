//! Contact response as velocity impulses: restitution, Coulomb friction and a one-step look-ahead that prevents tunneling.

use super::airframe::AirframeModel;
use super::obstacles::{Obstacles, more_severe_surface};
use super::state::{ContactKey, ContactReport, PhysicsState, RigidState, WarmStart};
use nalgebra::{Matrix3, Vector3};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::site::{Contact, ObjectId, Surface};
use spandrel_model::time::SimTime;

/// Search margin for near-contacts beyond the travel of one step, m.
pub const CONTACT_SEARCH_MARGIN_M: f64 = 0.01;
/// Approach speed below which contacts do not bounce, m/s (keeps a resting body at rest).
const MIN_BOUNCE_SPEED_M_S: f64 = 0.3;
/// Gap below which bodies count as touching, m.
const TOUCH_DISTANCE_M: f64 = 1e-3;
/// Penetration depth that is not corrected, m.
pub(super) const PENETRATION_SLOP_M: f64 = 1e-5;
/// Fraction of the penetration corrected per step.
pub(super) const CORRECTION_FRACTION: f64 = 0.2;
/// Maximum iterations of the impulse solver. A resting body starts from the impulses of the last step and needs only a
/// few.
const MAX_ITERATIONS: usize = 16;
/// Convergence threshold: the largest impulse change, as a fraction of gravity's impulse over one step.
const CONVERGENCE_THRESHOLD: f64 = 1e-9;
/// Time constant with which a rotor loses speed during contact, s (estimate).
const ROTOR_STRIKE_TIME_CONSTANT_S: f64 = 0.08;

/// A contact and the impulse that resolves it.
pub(super) struct ContactConstraint {
    pub(super) key: ContactKey,
    pub(super) rotor: Option<usize>,
    pub(super) surface: Surface,
    pub(super) object: ObjectId,
    pub(super) arm: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
    pub(super) object_velocity: Vector3<f64>,
    pub(super) gap: f64,
    pub(super) target: f64,
    pub(super) approach: f64,
    /// Response of the body and the contact point to an impulse at that point.
    pub(super) response: ImpulseResponse,
    pub(super) inverse_effective: f64,
    pub(super) impulse: Vector3<f64>,
    pub(super) active: bool,
}

impl ContactConstraint {
    /// Creates a constraint without an impulse for a contact of an aircraft at a position.
    pub(super) fn new(key: ContactKey, rotor: Option<usize>, contact: &Contact, position_m: Vec3<Ned>) -> Self {
        Self {
            key,
            rotor,
            surface: contact.surface,
            object: contact.object,
            arm: (contact.point_m.ned() - position_m).raw(),
            normal: contact.normal.ned().raw(),
            object_velocity: contact.velocity_m_s.ned().raw(),
            gap: contact.gap_m,
            target: 0.0,
            approach: 0.0,
            response: ImpulseResponse::default(),
            inverse_effective: 0.0,
            impulse: Vector3::zeros(),
            active: false,
        }
    }
}

/// Corrects the free-flight step made from `start` for contacts with obstacles.
pub fn resolve(
    model: &AirframeModel,
    state: &mut PhysicsState,
    start: &RigidState,
    obstacles: &impl Obstacles,
    at: SimTime,
    dt_s: f64,
) {
    let travel = state.rigid.velocity_m_s.norm() * dt_s + model.hull_radius_m * state.rigid.rates_rad_s.norm() * dt_s;
    // Contacts are queried at the start of the step, before the body can pass through an obstacle.
    let mut constraints = gather(model, start, obstacles, at, travel + CONTACT_SEARCH_MARGIN_M);
    if constraints.is_empty() {
        state.contact = ContactReport::default();
        state.initial_guess.impulses.clear();
        return;
    }
    let body = ContactBody::new(model, &state.rigid);
    prepare(&mut constraints, &body, &state.rigid, model.restitution, dt_s);
    warm_start(&mut constraints, &state.initial_guess);
    let (velocity, spin) = solve(&mut constraints, &body, &state.rigid, model, dt_s);
    if constraints.iter().any(|c| c.active) {
        // FRAME: the solver works in NED; the body's rates are in body axes.
        state.rigid.velocity_m_s = Vec3::assume(velocity);
        state.rigid.rates_rad_s = state.rigid.attitude.inverse() * Vec3::<Ned>::assume(spin);
        // Repeats the step from its start with the velocities that the contacts allow.
        state.rigid.position_m = start.position_m + state.rigid.velocity_m_s * dt_s + penetration_correction(&constraints);
        state.rigid.attitude = start.attitude.rotated_by(state.rigid.rates_rad_s * dt_s);
        slow_rotors(constraints.iter().filter(|c| c.active).filter_map(|c| c.rotor), &mut state.rigid, dt_s);
    }
    state.contact = report(&constraints, dt_s);
    state.initial_guess.impulses = constraints.iter().filter(|c| c.active).map(|c| (c.key, c.impulse)).collect();
}

/// How an aircraft responds to impulses.
pub(super) struct ContactBody {
    pub(super) inverse_mass: f64,
    inverse_inertia: Matrix3<f64>,
}

impl ContactBody {
    pub(super) fn new(model: &AirframeModel, rigid: &RigidState) -> Self {
        let r = rigid.attitude.matrix();
        let inverse_inertia = r * Matrix3::from_diagonal(&model.inverse_inertia) * r.transpose();
        Self { inverse_mass: model.inverse_mass, inverse_inertia }
    }

    /// Returns the response to impulses at `arm`.
    pub(super) fn impulse_response(&self, arm: &Vector3<f64>) -> ImpulseResponse {
        let cross = arm.cross_matrix();
        let spin = self.inverse_inertia * cross;
        ImpulseResponse { angular: spin, linear: Matrix3::identity() * self.inverse_mass - cross * spin }
    }
}

/// Response of a body to an impulse at a contact point.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ImpulseResponse {
    /// Change of angular velocity per unit impulse.
    pub(super) angular: Matrix3<f64>,
    /// Change of the contact point's velocity per unit impulse.
    pub(super) linear: Matrix3<f64>,
}

fn gather(
    model: &AirframeModel,
    pose: &RigidState,
    obstacles: &impl Obstacles,
    at: SimTime,
    margin_m: f64,
) -> Vec<ContactConstraint> {
    let mut found: Vec<Contact> = Vec::new();
    let mut out: Vec<ContactConstraint> = Vec::new();
    for (index, probe) in model.probes.iter().enumerate() {
        found.clear();
        obstacles.contacts(&probe.transformed(pose.position_m, pose.attitude), margin_m, at, &mut found);
        for contact in &found {
            let same = |c: &&ContactConstraint| c.key.0 == index && c.key.1 == contact.object.0;
            let key = (index, contact.object.0, out.iter().filter(same).count());
            out.push(ContactConstraint::new(key, probe.rotor, contact, pose.position_m));
        }
    }
    out
}

/// Computes the approach, the target velocity and the response of each constraint.
pub(super) fn prepare(
    constraints: &mut [ContactConstraint],
    body: &ContactBody,
    rigid: &RigidState,
    restitution: f64,
    dt_s: f64,
) {
    let v = rigid.velocity_m_s.raw();
    let w = (rigid.attitude * rigid.rates_rad_s).raw();
    for c in constraints {
        let relative = v + w.cross(&c.arm) - c.object_velocity;
        c.approach = -relative.dot(&c.normal);
        let allowed = c.gap.max(0.0) / dt_s;
        c.target = if c.approach > allowed && c.approach > MIN_BOUNCE_SPEED_M_S { restitution * c.approach } else { -allowed };
        c.response = body.impulse_response(&c.arm);
        c.inverse_effective = 1.0 / c.normal.dot(&(c.response.linear * c.normal));
    }
}

fn warm_start(constraints: &mut [ContactConstraint], initial_guess: &WarmStart) {
    for c in constraints {
        if let Some((_, impulse)) = initial_guess.impulses.iter().find(|(key, _)| *key == c.key)
            && c.approach <= MIN_BOUNCE_SPEED_M_S
        {
            c.impulse = *impulse;
        }
    }
}

/// Runs projected Gauss-Seidel on normal and friction impulses. Returns the resulting linear and angular velocities.
fn solve(
    constraints: &mut [ContactConstraint],
    body: &ContactBody,
    rigid: &RigidState,
    model: &AirframeModel,
    dt_s: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let mut v = rigid.velocity_m_s.raw();
    let mut w = (rigid.attitude * rigid.rates_rad_s).raw();
    for c in constraints.iter() {
        v += c.impulse * body.inverse_mass;
        w += c.response.angular * c.impulse;
    }
    iterate(model.mass_kg, dt_s, || {
        let mut largest: f64 = 0.0;
        for c in constraints.iter_mut() {
            largest = largest.max(solve_contact(c, body, &mut v, &mut w, model.friction));
        }
        largest
    });
    for c in constraints.iter_mut() {
        c.active = c.impulse.dot(&c.normal) > 0.0;
    }
    (v, w)
}

/// Repeats a sweep over all contacts until the largest change of an impulse, which it returns, is small.
pub(super) fn iterate(mass_kg: f64, dt_s: f64, mut sweep: impl FnMut() -> f64) {
    let settled = CONVERGENCE_THRESHOLD * mass_kg * spandrel_model::math::GRAVITY_M_S2 * dt_s;
    for _ in 0..MAX_ITERATIONS {
        if sweep() < settled {
            break;
        }
    }
}

/// Updates one contact and returns the magnitude of its impulse change.
pub(super) fn solve_contact(
    c: &mut ContactConstraint,
    body: &ContactBody,
    v: &mut Vector3<f64>,
    w: &mut Vector3<f64>,
    friction: f64,
) -> f64 {
    let old = c.impulse;
    let relative = *v + w.cross(&c.arm) - c.object_velocity;
    let normal_old = old.dot(&c.normal);
    let normal_new = (normal_old + (c.target - relative.dot(&c.normal)) * c.inverse_effective).max(0.0);
    let relative = relative + c.response.linear * (c.normal * (normal_new - normal_old));
    let slide = relative - c.normal * relative.dot(&c.normal);
    let tangent_old = old - c.normal * normal_old;
    let speed = slide.norm();
    let mut tangent_new = tangent_old;
    if speed > 0.0 {
        let direction = slide / speed;
        tangent_new -= direction * (speed / direction.dot(&(c.response.linear * direction)));
    }
    let limit = friction * normal_new;
    let size = tangent_new.norm();
    if size > limit {
        tangent_new *= limit / size;
    }
    c.impulse = c.normal * normal_new + tangent_new;
    let change = c.impulse - old;
    *v += change * body.inverse_mass;
    *w += c.response.angular * change;
    change.norm()
}

/// Returns the position shift that corrects the deepest penetration without adding velocity.
fn penetration_correction(constraints: &[ContactConstraint]) -> Vec3<Ned> {
    let deepest = constraints.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
    deepest.filter(|c| c.gap < -PENETRATION_SLOP_M).map_or(Vec3::zero(), |c| {
        // FRAME: `gather` converted the normals to NED.
        Vec3::assume(c.normal * (CORRECTION_FRACTION * (-c.gap - PENETRATION_SLOP_M)))
    })
}

/// Slows the rotors that touch something, once for each contact.
pub(super) fn slow_rotors(struck: impl Iterator<Item = usize>, rigid: &mut RigidState, dt_s: f64) {
    let keep = spandrel_model::math::exp(-dt_s / ROTOR_STRIKE_TIME_CONSTANT_S);
    for rotor in struck {
        rigid.rotor_rad_s[rotor] *= keep;
    }
}

/// Summarizes the contacts in which the bodies touch.
pub(super) fn report(constraints: &[ContactConstraint], dt_s: f64) -> ContactReport {
    let mut out = ContactReport::default();
    for c in constraints.iter().filter(|c| c.active && c.gap < TOUCH_DISTANCE_M.max(c.approach * dt_s)) {
        out.surface = Some(match out.surface {
            Some((known, _)) if more_severe_surface(known, c.surface) == known => out.surface.unwrap_or((known, c.object)),
            _ => (c.surface, c.object),
        });
        out.impact_m_s = out.impact_m_s.max(c.approach);
        out.normal_force_n += c.impulse.dot(&c.normal) / dt_s;
    }
    out
}
