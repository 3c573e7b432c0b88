//! Collision hull of an aircraft as convex probes: arms, rotor discs or cage, feet and body.

use super::query_types::HullProbe;
use crate::frames::{Enu, Frd, Ned, Rotation, Vec3};
use crate::vehicle::Vehicle;

/// Half thickness of arms and rotor discs, m (estimate).
const HALF_THICKNESS_M: f64 = 0.015;

/// One convex part of the hull in body axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyProbe {
    a_m: Vec3<Frd>,
    b_m: Vec3<Frd>,
    radius_m: f64,
    /// Index of the rotor at this probe, if any.
    pub rotor: Option<usize>,
}

impl BodyProbe {
    fn ball(center_m: Vec3<Frd>, radius_m: f64) -> Self {
        Self { a_m: center_m, b_m: center_m, radius_m, rotor: None }
    }

    fn capsule(a_m: Vec3<Frd>, b_m: Vec3<Frd>, radius_m: f64) -> Self {
        Self { a_m, b_m, radius_m, rotor: None }
    }

    /// Returns the largest distance of any point of the probe from the center of mass, in meters.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        self.a_m.norm().max(self.b_m.norm()) + self.radius_m
    }

    /// Returns the probe at a pose of the aircraft.
    #[must_use]
    pub fn transformed(&self, position_m: Vec3<Ned>, attitude: Rotation<Frd, Ned>) -> HullProbe {
        let place = |p: Vec3<Frd>| -> Vec3<Enu> { (position_m + attitude * p).enu() };
        if self.a_m == self.b_m {
            HullProbe::Ball { center_m: place(self.a_m), radius_m: self.radius_m }
        } else {
            HullProbe::Capsule { a_m: place(self.a_m), b_m: place(self.b_m), radius_m: self.radius_m }
        }
    }
}

/// Returns the probes of an aircraft. A caged aircraft has one ball the size of its cage. An open one has arms, feet, a
/// body, and for each rotor disc two crossed diameters and the outer edge.
#[must_use]
pub fn probes(vehicle: &Vehicle) -> Vec<BodyProbe> {
    let hull = &vehicle.hull;
    let mut out: Vec<BodyProbe> = hull.feet_m.iter().map(|foot| BodyProbe::ball(*foot, HALF_THICKNESS_M)).collect();
    if hull.has_propeller_guard {
        out.push(BodyProbe::ball(Vec3::zero(), 0.5 * hull.tip_to_tip_m));
        return out;
    }
    let [forward, right, down] = hull.body_half_extent_m;
    let radius = right.min(down);
    let along = (forward - radius).max(0.0);
    out.push(BodyProbe::capsule(Vec3::new(along, 0.0, 0.0), Vec3::new(-along, 0.0, 0.0), radius));
    for (index, rotor) in vehicle.rotors.iter().enumerate() {
        out.push(BodyProbe::capsule(Vec3::zero(), rotor.position_m, HALF_THICKNESS_M));
        out.extend(disc(rotor.position_m, vehicle.rotor.radius_m).map(|p| BodyProbe { rotor: Some(index), ..p }));
    }
    out
}

/// Returns the radius of the sphere about the center of mass that contains all probes, in meters.
#[must_use]
pub fn hull_radius_m(probes: &[BodyProbe]) -> f64 {
    probes.iter().map(BodyProbe::reach_m).fold(0.0, f64::max)
}

/// Returns two crossed diameters of a rotor disc, one radial and one tangential.
fn disc(hub_m: Vec3<Frd>, radius_m: f64) -> [BodyProbe; 2] {
    let radial = Vec3::new(hub_m.forward(), hub_m.right(), 0.0).unit();
    let tangential = Vec3::new(-radial.right(), radial.forward(), 0.0);
    let reach = radius_m - HALF_THICKNESS_M;
    [radial, tangential].map(|d| BodyProbe::capsule(hub_m - d * reach, hub_m + d * reach, HALF_THICKNESS_M))
}
