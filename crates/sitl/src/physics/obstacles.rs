//! The physics models' view of the environment: contacts, clearance and rays.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::{Contact, HullProbe, ObjectId, RayHit, Site, Surface};
use spandrel_model::time::SimTime;

/// Upper bound on the speed of objects at the site, m/s: cars drive at no more than 35 m/s, and lane speeds vary by a
/// tenth. It limits how long a measured clearance stays valid.
pub const MAX_OBJECT_SPEED_M_S: f64 = 38.5;

/// Collision queries against the environment. [`Site`] implements this trait; tests use planes and boxes.
pub trait Obstacles {
    /// Appends contacts and near-contacts of a probe.
    fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>);
    /// Returns the distance, in meters, to the nearest solid object within `max_m`, including the landing pad.
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

/// Returns the more severe of two surfaces, for reports. The order is person, vehicle, bridge, terrain, water, other
/// (docs/src/reference/wire.md, "Scoring data").
#[must_use]
pub fn more_severe_surface(a: Surface, b: Surface) -> Surface {
    const ORDER: [Surface; 7] =
        [Surface::Person, Surface::Vehicle, Surface::Bridge, Surface::Terrain, Surface::Water, Surface::Other, Surface::Pad];
    let rank = |s: Surface| ORDER.iter().position(|o| *o == s).unwrap_or(ORDER.len());
    if rank(a) <= rank(b) { a } else { b }
}

/// ID of an object in contact, re-exported for reports.
pub type Touched = ObjectId;
