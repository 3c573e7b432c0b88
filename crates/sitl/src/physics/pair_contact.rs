//! Contact between two simulated aircraft: the impulses act on both, equal and opposite, so momentum is conserved.

use super::airframe::AirframeModel;
use super::contact::{
    CONTACT_SEARCH_MARGIN_M, CORRECTION_FRACTION, ContactBody, ContactConstraint, PENETRATION_SLOP_M, iterate, prepare, report,
    slow_rotors, solve_contact,
};
use super::state::{ContactReport, PhysicsState, RigidState};
use nalgebra::Vector3;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::site::hull_shape::HullShape;
use spandrel_model::site::{Contact, HullProbe, ObjectId, Surface};

/// One of the two aircraft.
pub struct PairMember<'a> {
    /// Constants of the aircraft.
    pub model: &'a AirframeModel,
    /// Its state after a step. The contact changes its motion in the next step.
    pub state: &'a mut PhysicsState,
    /// ID in the other aircraft's report.
    pub object: ObjectId,
}

/// Lever arm from the second aircraft's center to a contact, and the rotor at the part that is touched, if any.
struct FarSide {
    arm: Vector3<f64>,
    rotor: Option<usize>,
}

/// Linear and angular velocity of the second aircraft.
struct FarMotion {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
}

impl FarMotion {
    fn at(&self, arm: &Vector3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(arm)
    }
}

/// Returns whether two aircraft are so close that they may touch in the next step.
#[must_use]
pub fn may_touch(a: (&AirframeModel, &RigidState), b: (&AirframeModel, &RigidState), dt_s: f64) -> bool {
    let distance_m = (a.1.position_m - b.1.position_m).norm();
    distance_m <= a.0.hull_radius_m + b.0.hull_radius_m + search_margin_m(a, b, dt_s)
}

/// Returns the gap that two aircraft can close within one step, with a margin, m.
fn search_margin_m(a: (&AirframeModel, &RigidState), b: (&AirframeModel, &RigidState), dt_s: f64) -> f64 {
    let turn = |(model, rigid): (&AirframeModel, &RigidState)| model.hull_radius_m * rigid.rates_rad_s.norm();
    ((a.1.velocity_m_s - b.1.velocity_m_s).norm() + turn(a) + turn(b)) * dt_s + CONTACT_SEARCH_MARGIN_M
}

/// Changes the velocities of two aircraft so that they don't enter each other in the next step. Returns the report of each.
pub fn resolve_pair(a: &mut PairMember, b: &mut PairMember, dt_s: f64) -> [ContactReport; 2] {
    let (mut constraints, far) = gather(a, b, dt_s);
    if constraints.is_empty() {
        return [ContactReport::default(); 2];
    }
    let bodies = [&*a, &*b].map(|one| ContactBody::new(one.model, &one.state.rigid));
    let mut motion = FarMotion {
        linear: b.state.rigid.velocity_m_s.raw(),
        angular: (b.state.rigid.attitude * b.state.rigid.rates_rad_s).raw(),
    };
    for (c, far) in constraints.iter_mut().zip(&far) {
        c.object_velocity = motion.at(&far.arm);
    }
    let mean = |of: fn(&AirframeModel) -> f64| 0.5 * (of(a.model) + of(b.model));
    prepare(&mut constraints, &bodies[0], &a.state.rigid, mean(|model| model.restitution), dt_s);
    let responses: Vec<_> = far.iter().map(|far| bodies[1].impulse_response(&far.arm)).collect();
    for (c, response) in constraints.iter_mut().zip(&responses) {
        c.response.linear += response.linear;
        c.inverse_effective = 1.0 / c.normal.dot(&(c.response.linear * c.normal));
    }
    let friction = mean(|model| model.friction);
    let mut v = a.state.rigid.velocity_m_s.raw();
    let mut w = (a.state.rigid.attitude * a.state.rigid.rates_rad_s).raw();
    iterate(a.model.mass_kg.min(b.model.mass_kg), dt_s, || {
        let mut largest: f64 = 0.0;
        for (c, (far, response)) in constraints.iter_mut().zip(far.iter().zip(&responses)) {
            let before = c.impulse;
            c.object_velocity = motion.at(&far.arm);
            largest = largest.max(solve_contact(c, &bodies[0], &mut v, &mut w, friction));
            let change = c.impulse - before;
            motion.linear -= change * bodies[1].inverse_mass;
            motion.angular -= response.angular * change;
        }
        largest
    });
    for c in &mut constraints {
        c.active = c.impulse.dot(&c.normal) > 0.0;
    }
    if constraints.iter().any(|c| c.active) {
        let inverse_masses = bodies.each_ref().map(|body| body.inverse_mass);
        let share = |side: usize| inverse_masses[side] / (inverse_masses[0] + inverse_masses[1]);
        push(a, &constraints, (v, w), 1.0, share(0));
        push(b, &constraints, (motion.linear, motion.angular), -1.0, share(1));
        let struck = || constraints.iter().zip(&far).filter(|(c, _)| c.active);
        slow_rotors(struck().filter_map(|(c, _)| c.rotor), &mut a.state.rigid, dt_s);
        slow_rotors(struck().filter_map(|(_, far)| far.rotor), &mut b.state.rigid, dt_s);
    }
    let of_a = report(&constraints, dt_s);
    let of_b = ContactReport { surface: of_a.surface.map(|(surface, _)| (surface, a.object)), ..of_a };
    [of_a, of_b]
}

/// Applies the resulting velocities to an aircraft, and moves it out of the other one by its share.
fn push(one: &mut PairMember, constraints: &[ContactConstraint], (v, w): (Vector3<f64>, Vector3<f64>), side: f64, share: f64) {
    let rigid = &mut one.state.rigid;
    // FRAME: the solver works in NED; the body's rates are in body axes.
    let velocity_m_s = Vec3::assume(v);
    one.state.pushed_m_s += velocity_m_s - rigid.velocity_m_s;
    rigid.velocity_m_s = velocity_m_s;
    rigid.rates_rad_s = rigid.attitude.inverse() * Vec3::<Ned>::assume(w);
    let deepest = constraints.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
    if let Some(c) = deepest.filter(|c| c.gap < -PENETRATION_SLOP_M) {
        // FRAME: `gather` converted the normals to NED.
        rigid.position_m += Vec3::assume(c.normal * (side * share * CORRECTION_FRACTION * (-c.gap - PENETRATION_SLOP_M)));
    }
}

/// Returns the contacts of the first aircraft's parts with those of the second one.
fn gather(a: &PairMember, b: &PairMember, dt_s: f64) -> (Vec<ContactConstraint>, Vec<FarSide>) {
    let (near, other) = (&a.state.rigid, &b.state.rigid);
    let margin_m = search_margin_m((a.model, near), (b.model, other), dt_s);
    let probes: Vec<HullProbe> = a.model.probes.iter().map(|probe| probe.transformed(near.position_m, near.attitude)).collect();
    let (mut constraints, mut far) = (Vec::new(), Vec::new());
    for part in b.model.probes.iter() {
        let shape = HullShape::of(&part.transformed(other.position_m, other.attitude));
        for (index, probe) in probes.iter().enumerate() {
            shape.contacts(probe, margin_m, |gap_m, point_m, normal| {
                let contact =
                    Contact { point_m, normal, gap_m, velocity_m_s: Vec3::zero(), surface: Surface::Vehicle, object: b.object };
                let key = (index, b.object.0, constraints.len());
                constraints.push(ContactConstraint::new(key, a.model.probes[index].rotor, &contact, near.position_m));
                far.push(FarSide { arm: (point_m.ned() - other.position_m).raw(), rotor: part.rotor });
            });
        }
    }
    (constraints, far)
}
