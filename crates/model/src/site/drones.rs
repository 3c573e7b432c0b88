//! Other drones at the site. Those of the scenario fly along paths: like traffic, their positions are a pure function of simulation
//! time, and nothing changes their motion. Vehicles that share a site in one simulator see each other as of the last tick; their
//! contacts act on both, so the simulator computes them.

use super::aircraft_hull::{BodyProbe, hull_radius_m, probes};
use super::drone_path::{DronePath, PathState};
use super::hull_shape::HullShape;
use super::query_types::{Contact, HullProbe, NearestPoint, ObjectId, RayHit, Surface};
use crate::frames::{Enu, Frd, Ned, Rotation, Vec3};
use crate::random::RandomStream;
use crate::scenario::DroneSpec;
use crate::time::SimTime;
use crate::vehicle::{self, Vehicle};
use crate::{math, shipped};
use std::sync::Arc;

/// First object number of these drones, above all numbers of traffic.
pub const FIRST_DRONE_OBJECT: u32 = 2_000_000;
/// First object number of vehicles that share the site, above all others.
const FIRST_LIVE_DRONE_OBJECT: u32 = 3_000_000;

/// Returns the object ID of the vehicle with a zero-based number.
#[must_use]
pub fn live_drone_object(number: u8) -> ObjectId {
    ObjectId(FIRST_LIVE_DRONE_OBJECT + u32::from(number))
}

/// Returns the zero-based number of a vehicle that shares the site; `None` for other objects.
#[must_use]
pub fn live_drone_number(object: ObjectId) -> Option<u8> {
    u8::try_from(object.0.checked_sub(FIRST_LIVE_DRONE_OBJECT)?).ok()
}

/// Another vehicle that shares the site, at the last tick.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveDrone {
    /// Object ID.
    pub object: ObjectId,
    /// Parts of the hull.
    pub parts: Arc<[BodyProbe]>,
    /// Radius of the sphere about the center of mass that contains the hull, m.
    pub reach_m: f64,
    /// Position of the center of mass, m.
    pub position_m: Vec3<Enu>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Whether its motors are armed.
    pub armed: bool,
}

/// Hull of a drone at a time.
struct PlacedHull<'a> {
    object: ObjectId,
    parts: &'a [BodyProbe],
    reach_m: f64,
    position_m: Vec3<Enu>,
    attitude: Rotation<Frd, Ned>,
}

impl PlacedHull<'_> {
    fn shapes(&self) -> impl Iterator<Item = HullShape> + '_ {
        self.parts.iter().map(|part| HullShape::of(&part.transformed(self.position_m.ned(), self.attitude)))
    }
}

/// A drone with its path.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteDrone {
    name: String,
    vehicle: Arc<Vehicle>,
    parts: Vec<BodyProbe>,
    reach_m: f64,
    attitude: Rotation<Frd, Ned>,
    path: DronePath,
}

impl SiteDrone {
    /// Returns `None` if no aircraft with this ID ships with Spandrel.
    fn new(spec: &DroneSpec, start_s: f64) -> Option<Self> {
        let (id, text) = shipped::VEHICLES.iter().find(|(id, _)| *id == spec.vehicle)?;
        let vehicle = vehicle::read(&format!("{id}.toml"), text).ok()?;
        let parts = probes(&vehicle);
        Some(Self {
            name: spec.name.clone(),
            reach_m: hull_radius_m(&parts),
            parts,
            vehicle: Arc::new(vehicle),
            attitude: Rotation::from_euler(0.0, 0.0, math::wrap_pi(spec.heading_deg.to_radians())),
            path: DronePath::new(spec, start_s),
        })
    }

    /// Returns the name in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the aircraft.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Returns the attitude, which is level and constant.
    #[must_use]
    pub fn attitude(&self) -> Rotation<Frd, Ned> {
        self.attitude
    }

    /// Returns the path.
    #[must_use]
    pub fn path(&self) -> &DronePath {
        &self.path
    }

    /// Returns the position and the velocity at a time.
    #[must_use]
    pub fn at(&self, at: SimTime) -> PathState {
        self.path.at(at.s())
    }

    fn placed(&self, object: ObjectId, position_m: Vec3<Enu>) -> PlacedHull<'_> {
        PlacedHull { object, parts: &self.parts, reach_m: self.reach_m, position_m, attitude: self.attitude }
    }

    /// Returns the distance of the path of the center of mass from a point, m.
    fn path_distance_m(&self, point_m: Vec3<Enu>) -> f64 {
        let of = |(from, to): (Vec3<Enu>, Vec3<Enu>)| HullShape::between(from, to, 0.0).nearest(point_m).0;
        self.path.segments().map(of).fold(f64::INFINITY, f64::min)
    }
}

/// All drones at the site beside one vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SiteDrones {
    drones: Vec<SiteDrone>,
    live: Vec<LiveDrone>,
}

impl SiteDrones {
    /// Creates the drones. The seed determines when each one starts.
    #[must_use]
    pub fn new(specs: &[DroneSpec], seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "site.drones");
        let drone = |spec: &DroneSpec| SiteDrone::new(spec, spec.at_s + stream.range(0.0, spec.spread_s));
        Self { drones: specs.iter().filter_map(drone).collect(), live: Vec::new() }
    }

    /// Sets the other vehicles that share the site.
    pub fn set_live(&mut self, live: Vec<LiveDrone>) {
        self.live = live;
    }

    /// Returns the other vehicles that share the site.
    #[must_use]
    pub fn live(&self) -> &[LiveDrone] {
        &self.live
    }

    /// Returns the drones of the scenario, in its order.
    #[must_use]
    pub fn all(&self) -> &[SiteDrone] {
        &self.drones
    }

    /// Returns the name of one of these drones; `None` for other objects.
    #[must_use]
    pub fn name(&self, object: ObjectId) -> Option<&str> {
        self.drones.get(object.0.checked_sub(FIRST_DRONE_OBJECT)? as usize).map(SiteDrone::name)
    }

    fn with_ids(&self) -> impl Iterator<Item = (ObjectId, &SiteDrone)> {
        (FIRST_DRONE_OBJECT..).map(ObjectId).zip(&self.drones)
    }

    fn hulls(&self, at: SimTime) -> impl Iterator<Item = PlacedHull<'_>> {
        let on_paths = self.with_ids().map(move |(object, drone)| drone.placed(object, drone.at(at).position_m));
        on_paths.chain(self.live.iter().map(|drone| PlacedHull {
            object: drone.object,
            parts: &drone.parts,
            reach_m: drone.reach_m,
            position_m: drone.position_m,
            attitude: drone.attitude,
        }))
    }

    /// Returns the nearest point of a drone within `max_m`.
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<NearestPoint> {
        let mut best: Option<NearestPoint> = None;
        for hull in self.hulls(at) {
            if (hull.position_m - position_m).norm() > max_m + hull.reach_m {
                continue;
            }
            for (distance_m, point_m, normal) in hull.shapes().map(|shape| shape.nearest(position_m)) {
                if distance_m <= best.map_or(max_m, |b| b.distance_m) {
                    best = Some(NearestPoint { distance_m, point_m, normal, surface: Surface::Vehicle, object: hull.object });
                }
            }
        }
        best
    }

    /// Returns a lower bound for the distance of the scenario's drones from a point at any time, in meters, if it is below `max_m`.
    #[must_use]
    pub fn min_distance_over_time_m(&self, position_m: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let distances_m = self.drones.iter().map(|drone| drone.path_distance_m(position_m) - drone.reach_m);
        distances_m.filter(|distance_m| *distance_m < max_m).min_by(f64::total_cmp)
    }

    /// Returns the first hit of a ray with a drone within `max_m`.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit> {
        let mut best: Option<RayHit> = None;
        for hull in self.hulls(at) {
            let whole = HullShape::between(hull.position_m, hull.position_m, hull.reach_m);
            if whole.ray(origin_m, direction, max_m).is_none() {
                continue;
            }
            for shape in hull.shapes() {
                let reach_m = best.map_or(max_m, |b| b.distance_m);
                if let Some((distance_m, normal)) = shape.ray(origin_m, direction, reach_m) {
                    best = Some(RayHit { distance_m, normal, surface: Surface::Vehicle, object: hull.object });
                }
            }
        }
        best
    }

    /// Appends a probe's contacts with the scenario's drones. A contact has the drone's velocity.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>) {
        let (middle_m, radius_m) = super::boxes::bounding_sphere(probe);
        for (object, drone) in self.with_ids() {
            let PathState { position_m, velocity_m_s } = drone.at(at);
            if (position_m - middle_m).norm() > radius_m + margin_m + drone.reach_m {
                continue;
            }
            for shape in drone.placed(object, position_m).shapes() {
                shape.contacts(probe, margin_m, |gap_m, point_m, normal| {
                    out.push(Contact { point_m, normal, gap_m, velocity_m_s, surface: Surface::Vehicle, object });
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(name: &str, vehicle: &'static str, spread_s: f64) -> DroneSpec {
        DroneSpec {
            name: name.into(),
            vehicle,
            points_m: vec![Vec3::new(0.0, 0.0, 30.0), Vec3::new(40.0, 0.0, 30.0)],
            speed_m_s: 4.0,
            heading_deg: 90.0,
            at_s: 10.0,
            spread_s,
            wait_s: 0.0,
            repeat: true,
        }
    }

    /// A drone in a cage, whose hull is a ball.
    fn caged() -> (SiteDrones, f64) {
        let drones = SiteDrones::new(&[spec("caged", "elios3", 0.0)], 1);
        let radius_m = 0.5 * drones.all()[0].vehicle().hull.tip_to_tip_m;
        (drones, radius_m)
    }

    #[test]
    fn exact_queries_see_a_ball_that_moves() {
        let (drones, radius_m) = caged();
        // After 3 s: 2 s of acceleration to 4 m, and 1 s at 4 m/s.
        let at = SimTime::from_s(13.0);
        let center = Vec3::new(8.0, 0.0, 30.0);
        let near = drones.nearest(center + Vec3::new(0.0, 3.0, 0.0), 5.0, at).expect("near");
        assert!((near.distance_m - (3.0 - radius_m)).abs() < 1e-9, "{near:?}");
        assert_eq!((near.surface, near.object), (Surface::Vehicle, ObjectId(FIRST_DRONE_OBJECT)));
        assert_eq!(drones.nearest(center + Vec3::new(0.0, 3.0, 0.0), 1.0, at), None);
        let hit = drones.ray(center + Vec3::new(0.0, 0.0, -20.0), Vec3::new(0.0, 0.0, 1.0), 50.0, at).expect("hit from below");
        assert!((hit.distance_m - (20.0 - radius_m)).abs() < 1e-9 && (hit.normal.up() + 1.0).abs() < 1e-9, "{hit:?}");
        let mut out = Vec::new();
        let probe = HullProbe::Ball { center_m: center + Vec3::new(radius_m + 0.3, 0.0, 0.0), radius_m: 0.25 };
        drones.contacts(&probe, 0.1, at, &mut out);
        let ball = out.iter().find(|contact| (contact.gap_m - 0.05).abs() < 1e-9).expect("the cage");
        assert!((ball.velocity_m_s - Vec3::new(4.0, 0.0, 0.0)).norm() < 1e-9 && (ball.normal.east() - 1.0).abs() < 1e-9);
        assert_eq!(drones.name(ball.object), Some("caged"));
        assert_eq!(drones.name(ObjectId(FIRST_DRONE_OBJECT + 1)), None);
    }

    #[test]
    fn exact_parts_follow_the_heading() {
        let drones = SiteDrones::new(&[spec("open", "phantom2", 0.0)], 1);
        let rotor = drones.all()[0].vehicle().rotors[0].position_m;
        // Heading east: forward is east, and right is south.
        let hub = Vec3::new(rotor.forward(), -rotor.right(), 30.0 - rotor.down());
        let near = drones.nearest(hub, 1.0, SimTime::ZERO).expect("near");
        assert!(near.distance_m < 0.0, "{near:?}: the hub is inside its arm");
        let mirrored = Vec3::new(0.0, 0.0, 30.0) + Vec3::new(0.0, 2.0, 0.0);
        assert!(drones.nearest(mirrored, 5.0, SimTime::ZERO).is_some_and(|near| near.distance_m > 1.0));
    }

    #[test]
    fn prop_start_depends_on_the_seed_within_the_spread() {
        let start_s = |seed| {
            let drones = SiteDrones::new(&[spec("open", "phantom2", 30.0)], seed);
            let moves = |tenth: &i32| drones.all()[0].at(SimTime::from_s(0.1 * f64::from(*tenth))).velocity_m_s.norm() > 0.0;
            0.1 * f64::from((0..1_000).find(moves).expect("it starts"))
        };
        let starts: Vec<f64> = (0..20).map(start_s).collect();
        assert!(starts.iter().all(|s| (10.0..=40.1).contains(s)), "{starts:?}");
        assert!(starts.iter().any(|s| *s < 20.0) && starts.iter().any(|s| *s > 30.0), "{starts:?}");
        assert_eq!(start_s(3), start_s(3));
    }

    #[test]
    fn prop_distance_over_time_is_never_more_than_a_distance_at_a_time() {
        let drones = SiteDrones::new(&[spec("open", "m30", 0.0)], 1);
        let mut random = RandomStream::new(3, "points");
        let mut near = 0;
        for _ in 0..200 {
            let p = Vec3::new(random.range(-5.0, 45.0), random.range(-5.0, 5.0), random.range(25.0, 35.0));
            let least = drones.min_distance_over_time_m(p, 20.0).expect("near");
            for tenth in 0..400 {
                let now = drones.nearest(p, 50.0, SimTime::from_s(0.1 * f64::from(tenth))).expect("near");
                assert!(least <= now.distance_m + 1e-9);
                near += usize::from(now.distance_m < least + 0.5);
            }
        }
        assert!(near > 100, "{near}: the bound is close");
    }
}
