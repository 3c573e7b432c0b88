//! Cars, trucks and pedestrians on the decks, the ground crew, and drones that fly along paths. The plan is generated from the seed;
//! positions are a pure function of simulation time. All objects in a lane have the same speed, which prevents overtaking. They move
//! on a loop longer than the lane, so that they appear and disappear beyond the ends of the bridge.

use super::boxes::{OrientedBox, bounding_sphere};
use super::bridge_closures::BridgeClosures;
use super::changes::SiteChanges;
use super::drones::{LiveDrone, SiteDrones};
use super::inspector_path::{GroundHeight, InspectorPath, InspectorPosition};
use super::lane_track::{LaneTrack, arc_lengths, without_collinear_points};
use super::movers::{MoverKind, MoverPlacement, boxes};
use super::query_types::{Contact, HullProbe, NearestPoint, ObjectId, RayHit, Surface};
use super::ropes::SiteRopes;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::bridges::Lane;
use crate::scenario::{GroundTeam, TrafficSpec as TrafficSettings};
use crate::time::SimTime;

/// First object number used for traffic and crew. Lower numbers are bridge members and other static objects.
pub const FIRST_TRAFFIC_OBJECT: u32 = 1_000_000;
/// Inspector's object ID.
pub const INSPECTOR: ObjectId = ObjectId(FIRST_TRAFFIC_OBJECT - 2);
/// Crew truck's object ID.
pub const CREW_TRUCK: ObjectId = ObjectId(FIRST_TRAFFIC_OBJECT - 1);

/// Minimum spacing of vehicles in a lane, center to center, m (estimate: a truck and a gap).
const MIN_VEHICLE_SPACING_M: f64 = 24.0;
/// Minimum spacing of pedestrians on a walkway, center to center, m (estimate).
const MIN_PEDESTRIAN_SPACING_M: f64 = 4.0;
/// Minimum length of the part of a loop beyond the ends of the lane, m (estimate).
const MIN_LENGTH_BEYOND_LANE_M: f64 = 40.0;
/// Maximum offset of an object from even spacing, as a fraction of the spacing.
const SPACING_JITTER: f64 = 0.25;
/// Mean and standard deviation of the walking speed, m/s (Fruin, Pedestrian Planning and Design).
const WALKING_SPEED_M_S: (f64, f64) = (1.34, 0.26);
/// Maximum deviation of a lane's speed from the mean car speed, as a fraction of it (estimate).
const LANE_SPEED_SPREAD: f64 = 0.1;

/// A moving object in the traffic plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mover {
    /// Object type.
    pub kind: MoverKind,
    /// Number among the objects of the same type, from 1.
    pub number: u32,
    track: usize,
    phase_m: f64,
}

/// Traffic plan of a session. Positions depend only on the time that is passed to a query.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficPlan {
    tracks: Vec<LaneTrack>,
    movers: Vec<Mover>,
    inspector: InspectorPath,
    truck: MoverPlacement,
    closures: BridgeClosures,
    drones: SiteDrones,
    ropes: SiteRopes,
}

impl TrafficPlan {
    /// Draws a plan from a seed. Objects are assigned to the lanes in turn. Objects without a suitable lane, such as pedestrians
    /// on a bridge without a walkway, are omitted.
    #[must_use]
    pub fn new(lanes: &[Lane], settings: &TrafficSettings, team: &GroundTeam, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "site.traffic");
        let mut plan = Self {
            tracks: Vec::new(),
            movers: Vec::new(),
            inspector: InspectorPath::new(team),
            truck: parked_truck(team),
            closures: BridgeClosures::default(),
            drones: SiteDrones::default(),
            ropes: SiteRopes::default(),
        };
        let roads: Vec<&Lane> = lanes.iter().filter(|l| !l.walkway && l.points_m.len() >= 2).collect();
        let walkways: Vec<&Lane> = lanes.iter().filter(|l| l.walkway && l.points_m.len() >= 2).collect();
        let mut vehicles = vec![MoverKind::Car; settings.cars];
        vehicles.extend(vec![MoverKind::Truck; settings.trucks]);
        // A Fisher-Yates shuffle mixes the trucks among the cars.
        for k in (1..vehicles.len()).rev() {
            vehicles.swap(k, stream.below(k + 1));
        }
        let mut numbers = [0; 3];
        for (lane, kinds) in assign_lanes(&roads, &vehicles) {
            let speed = settings.car_speed_m_s * (1.0 + stream.range(-LANE_SPEED_SPREAD, LANE_SPEED_SPREAD));
            plan.add_lane(lane, &kinds, (speed, MIN_VEHICLE_SPACING_M), &mut numbers, &mut stream);
        }
        for (lane, kinds) in assign_lanes(&walkways, &vec![MoverKind::Pedestrian; settings.pedestrians]) {
            let speed = (WALKING_SPEED_M_S.0 + WALKING_SPEED_M_S.1 * stream.normal()).clamp(0.8, 1.9);
            plan.add_lane(lane, &kinds, (speed, MIN_PEDESTRIAN_SPACING_M), &mut numbers, &mut stream);
        }
        plan
    }

    /// Returns the plan with drones that fly along paths.
    #[must_use]
    pub fn with_drones(self, drones: SiteDrones) -> Self {
        Self { drones, ..self }
    }

    /// Returns the plan with ropes.
    #[must_use]
    pub fn with_ropes(self, ropes: SiteRopes) -> Self {
        Self { ropes, ..self }
    }

    /// Returns the ropes.
    #[must_use]
    pub fn ropes(&self) -> &SiteRopes {
        &self.ropes
    }

    /// Sets the other vehicles that share the site.
    pub(super) fn set_live_drones(&mut self, live: Vec<LiveDrone>) {
        self.drones.set_live(live);
    }

    /// Returns the other drones.
    #[must_use]
    pub fn drones(&self) -> &SiteDrones {
        &self.drones
    }

    fn add_lane(
        &mut self,
        lane: &Lane,
        kinds: &[MoverKind],
        (speed_m_s, spacing_m): (f64, f64),
        numbers: &mut [u32; 3],
        stream: &mut RandomStream,
    ) {
        let points_m = without_collinear_points(&lane.points_m);
        let arc_lengths_m = arc_lengths(&points_m);
        let length_m = arc_lengths_m.last().copied().unwrap_or(0.0);
        if kinds.is_empty() || length_m <= 0.0 {
            return;
        }
        // A crowded lane gets a longer loop, which preserves the minimum spacing of objects despite the random offsets.
        let loop_length_m =
            (length_m + MIN_LENGTH_BEYOND_LANE_M).max(kinds.len() as f64 * spacing_m / (1.0 - 2.0 * SPACING_JITTER));
        let slot_m = loop_length_m / kinds.len() as f64;
        let turn_m = stream.range(0.0, loop_length_m);
        let first = self.movers.len();
        for (k, kind) in kinds.iter().enumerate() {
            let number = &mut numbers[*kind as usize];
            *number += 1;
            let phase_m =
                (turn_m + slot_m * (k as f64 + stream.range(-SPACING_JITTER, SPACING_JITTER))).rem_euclid(loop_length_m);
            self.movers.push(Mover { kind: *kind, number: *number, track: self.tracks.len(), phase_m });
        }
        let reach_m = kinds.iter().map(|k| k.reach_m() + k.half_length_m()).fold(0.0, f64::max);
        let range = |k: usize| math::range(points_m.iter().map(|point| point.array()[k]));
        let [east, north, up] = [range(0), range(1), range(2)];
        self.tracks.push(LaneTrack {
            bounds_m: (Vec3::new(east.0, north.0, up.0), Vec3::new(east.1, north.1, up.1)),
            points_m,
            arc_lengths_m,
            length_m,
            loop_length_m,
            speed_m_s,
            first,
            count: kinds.len(),
            reach_m,
        });
    }

    /// Sets the bridge closures and the inspector's walks over this ground.
    pub fn set_changes(&mut self, changes: SiteChanges, ground: GroundHeight) {
        self.closures = changes.closures;
        self.inspector = self.inspector.with_walks(changes.walks, Some(ground));
    }

    /// Returns whether the traffic and the inspector have these changes.
    #[must_use]
    pub fn has_changes(&self, changes: &SiteChanges) -> bool {
        self.closures == changes.closures && self.inspector.walks() == &changes.walks
    }

    /// Returns the bridge closures.
    #[must_use]
    pub fn closures(&self) -> &BridgeClosures {
        &self.closures
    }

    /// Returns the inspector's places and walks.
    #[must_use]
    pub fn inspector(&self) -> &InspectorPath {
        &self.inspector
    }

    /// Returns the inspector and the truck at a time.
    fn crew(&self, at: SimTime) -> [(ObjectId, MoverKind, MoverPlacement); 2] {
        let InspectorPosition { feet_m: position_m, forward, velocity_m_s, .. } = self.inspector.at(at);
        let inspector = MoverPlacement { position_m, forward, velocity_m_s };
        [(INSPECTOR, MoverKind::Pedestrian, inspector), (CREW_TRUCK, MoverKind::Truck, self.truck)]
    }

    /// Returns whether the crew's truck is within a distance of a point.
    pub(super) fn is_truck_near(&self, point_m: Vec3<Enu>, max_m: f64) -> bool {
        boxes(MoverKind::Truck, self.truck).any(|solid| solid.nearest(point_m).0 < max_m)
    }

    /// Returns all moving objects in the plan.
    #[must_use]
    pub fn movers(&self) -> &[Mover] {
        &self.movers
    }

    /// Returns the placement of an object at a time; `None` while it is beyond the ends of the bridge, or on a lap that
    /// it could not begin because the bridge was closed.
    #[must_use]
    pub fn placement(&self, mover: &Mover, at: SimTime) -> Option<MoverPlacement> {
        let track = &self.tracks[mover.track];
        let half = mover.kind.half_length_m();
        let driven_m = (mover.phase_m + track.speed_m_s * at.s()).rem_euclid(track.loop_length_m);
        let s = driven_m - half;
        let entered = s <= track.length_m + half && self.closures.is_open_at(at.s() - driven_m / track.speed_m_s);
        entered.then(|| track.at(s))
    }

    /// Returns the boxes of traffic and crew at a time, for rendering and tests.
    #[must_use]
    pub fn solids(&self, at: SimTime) -> Vec<(ObjectId, Surface, OrientedBox)> {
        let moving = self.movers.iter().enumerate().filter_map(|(k, mover)| {
            let placed = self.placement(mover, at)?;
            Some((ObjectId(FIRST_TRAFFIC_OBJECT + k as u32), mover.kind, placed))
        });
        let all = self.crew(at).into_iter().chain(moving);
        all.flat_map(|(object, kind, placed)| boxes(kind, placed).map(move |solid| (object, kind.surface(), solid))).collect()
    }

    /// Returns the nearest point of traffic, crew, drones or ropes within `max_m`.
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<NearestPoint> {
        let mut best: Option<NearestPoint> = None;
        self.visit_near(position_m, max_m, at, |object, surface, solid, _| {
            let (distance_m, point_m, normal) = solid.nearest(position_m);
            if distance_m <= best.map_or(max_m, |b| b.distance_m) {
                best = Some(NearestPoint { distance_m, point_m, normal, surface, object });
            }
        });
        let best = self.drones.nearest(position_m, best.map_or(max_m, |b| b.distance_m), at).or(best);
        self.ropes.nearest(position_m, best.map_or(max_m, |b| b.distance_m), at).or(best)
    }

    /// Returns the minimum distance of traffic, drones and ropes from a point at any time, in meters, if it is below `max_m`. Assumes
    /// that every vehicle type in the plan uses every lane, and that pedestrians use every walkway.
    #[must_use]
    pub fn min_distance_over_time_m(&self, position_m: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let lanes_m = self.min_lane_distance_m(position_m, max_m);
        let drones_m = self.drones.min_distance_over_time_m(position_m, lanes_m.unwrap_or(max_m)).or(lanes_m);
        self.ropes.min_distance_over_time_m(position_m, drones_m.unwrap_or(max_m)).or(drones_m)
    }

    /// Returns the minimum distance of traffic at any time, and of the crew at the start, from a point, in meters, if it is below
    /// `max_m`.
    #[must_use]
    pub fn min_distance_of_others_m(&self, position_m: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let crew = self.crew(SimTime::ZERO).into_iter().flat_map(|(_, kind, placed)| boxes(kind, placed));
        let crew_m =
            crew.map(|solid| solid.nearest(position_m).0).filter(|distance_m| *distance_m < max_m).min_by(f64::total_cmp);
        self.min_lane_distance_m(position_m, crew_m.unwrap_or(max_m)).or(crew_m)
    }

    /// Returns the minimum distance of traffic from a point at any time, in meters, if it is below `max_m`. Assumes
    /// that every vehicle type in the plan uses every lane, and that pedestrians use every walkway.
    fn min_lane_distance_m(&self, position_m: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let mut least: Option<f64> = None;
        let tracks = self.tracks.iter().filter(|track| track.count > 0);
        for track in tracks.filter(|track| track.distance_m(position_m) <= max_m + MoverKind::MAX_MOVER_EXTENT_M) {
            let surface = self.movers[track.first].kind.surface();
            for kind in MoverKind::ALL.into_iter().filter(|kind| kind.surface() == surface && self.has_kind(*kind)) {
                let placed = track.at(track.nearest_arc_length_m(position_m, kind.half_length_m()));
                let distance_m = boxes(kind, placed).map(|solid| solid.nearest(position_m).0).fold(max_m, f64::min);
                least = Some(distance_m).filter(|d| *d < least.unwrap_or(max_m)).or(least);
            }
        }
        least
    }

    fn has_kind(&self, kind: MoverKind) -> bool {
        self.movers.iter().any(|mover| mover.kind == kind)
    }

    /// Returns the first hit of a ray with traffic, crew, drones or ropes within `max_m`.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit> {
        let mut best: Option<RayHit> = None;
        let mut test = |object, kind: MoverKind, placed: MoverPlacement| {
            let to = placed.position_m - origin_m;
            let along = to.dot(direction).clamp(0.0, max_m);
            let reach = kind.reach_m();
            if (to - direction * along).norm_squared() > reach * reach {
                return;
            }
            for solid in boxes(kind, placed) {
                let reach = best.map_or(max_m, |b| b.distance_m);
                if let Some((distance_m, normal)) = solid.ray(origin_m, direction, reach) {
                    best = Some(RayHit { distance_m, normal, surface: kind.surface(), object });
                }
            }
        };
        for (object, kind, placed) in self.crew(at) {
            test(object, kind, placed);
        }
        for track in self.tracks.iter().filter(|t| t.ray_may_hit(origin_m, direction, max_m)) {
            for k in track.first..track.first + track.count {
                let mover = &self.movers[k];
                let Some(placed) = self.placement(mover, at) else { continue };
                test(ObjectId(FIRST_TRAFFIC_OBJECT + k as u32), mover.kind, placed);
            }
        }
        let best = self.drones.ray(origin_m, direction, best.map_or(max_m, |b| b.distance_m), at).or(best);
        self.ropes.ray(origin_m, direction, best.map_or(max_m, |b| b.distance_m), at).or(best)
    }

    /// Appends a probe's contacts with traffic, crew, drones and ropes. A contact has the object's velocity.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>) {
        let (center_m, radius_m) = bounding_sphere(probe);
        self.visit_near(center_m, radius_m + margin_m, at, |object, surface, solid, velocity_m_s| {
            solid.contacts(probe, margin_m, |gap_m, point_m, normal| {
                out.push(Contact { point_m, normal, gap_m, velocity_m_s, surface, object });
            });
        });
        self.drones.contacts(probe, margin_m, at, out);
        self.ropes.contacts(probe, margin_m, at, out);
    }

    /// Returns the name of an object of traffic or crew, of a drone or of a rope, such as `truck 2`; `None` for other objects.
    #[must_use]
    pub fn name(&self, object: ObjectId) -> Option<String> {
        if object == INSPECTOR {
            return Some("inspector".into());
        }
        if object == CREW_TRUCK {
            return Some("crew truck".into());
        }
        if let Some(name) = self.drones.name(object) {
            return Some(format!("drone {name}"));
        }
        if let Some(name) = self.ropes.name(object) {
            return Some(format!("rope {name}"));
        }
        let mover = self.movers.get(object.0.checked_sub(FIRST_TRAFFIC_OBJECT)? as usize)?;
        let kind = match mover.kind {
            MoverKind::Car => "car",
            MoverKind::Truck => "truck",
            MoverKind::Pedestrian => "pedestrian",
        };
        Some(format!("{kind} {}", mover.number))
    }

    /// Calls `visit` for each box that may be within `reach_m` of a point. Far from all lanes, this computes only one distance
    /// per lane segment.
    fn visit_near(
        &self,
        point_m: Vec3<Enu>,
        reach_m: f64,
        at: SimTime,
        mut visit: impl FnMut(ObjectId, Surface, &OrientedBox, Vec3<Enu>),
    ) {
        let mut visit_object = |object, kind: MoverKind, placed: MoverPlacement| {
            if (placed.position_m - point_m).norm() <= reach_m + kind.reach_m() {
                for solid in boxes(kind, placed) {
                    visit(object, kind.surface(), &solid, placed.velocity_m_s);
                }
            }
        };
        for (object, kind, placed) in self.crew(at) {
            visit_object(object, kind, placed);
        }
        for track in &self.tracks {
            if track.distance_m(point_m) > reach_m + track.reach_m {
                continue;
            }
            for k in track.first..track.first + track.count {
                let mover = &self.movers[k];
                let Some(placed) = self.placement(mover, at) else { continue };
                visit_object(ObjectId(FIRST_TRAFFIC_OBJECT + k as u32), mover.kind, placed);
            }
        }
    }
}

/// Assigns objects to lanes in turn; assigns none if there are no lanes.
fn assign_lanes<'a>(lanes: &[&'a Lane], kinds: &[MoverKind]) -> Vec<(&'a Lane, Vec<MoverKind>)> {
    let mut dealt: Vec<(&Lane, Vec<MoverKind>)> = lanes.iter().map(|l| (*l, Vec::new())).collect();
    for (k, kind) in kinds.iter().enumerate().take(if lanes.is_empty() { 0 } else { usize::MAX }) {
        dealt[k % lanes.len()].1.push(*kind);
    }
    dealt
}

fn parked_truck(team: &GroundTeam) -> MoverPlacement {
    let (s, c) = math::sin_cos(team.truck_heading_deg.to_radians());
    MoverPlacement { position_m: team.truck_m, forward: Vec3::new(s, c, 0.0), velocity_m_s: Vec3::zero() }
}

#[cfg(test)]
mod tests {
    use super::super::inspector_path;
    use super::super::inspector_walks::InspectorWalks;
    use super::*;

    fn lanes() -> Vec<Lane> {
        let line = |north: f64, walkway: bool, backwards: bool| {
            let mut points_m: Vec<Vec3<Enu>> =
                (0..=40).map(|k| Vec3::new(f64::from(k) * 5.0, north, 20.0 + 0.0005 * f64::from(k * (40 - k)))).collect();
            if backwards {
                points_m.reverse();
            }
            Lane { bridge: 0, points_m, walkway }
        };
        vec![line(-1.8, false, false), line(1.8, false, true), line(4.5, true, false)]
    }

    fn team() -> GroundTeam {
        GroundTeam {
            pad_m: Vec3::new(-50.0, 0.0, 0.0),
            pad_heading_deg: 0.0,
            pad_half_m: 2.0,
            inspector_m: Vec3::new(-55.0, 0.0, 0.0),
            places_m: vec![Vec3::new(-55.0, -14.0, 0.0)],
            truck_m: Vec3::new(-60.0, 8.0, 0.0),
            truck_heading_deg: 90.0,
            home_radius_m: 5.0,
        }
    }

    fn plan(seed: u64) -> TrafficPlan {
        let settings = TrafficSettings { cars: 8, trucks: 3, pedestrians: 6, car_speed_m_s: 13.4 };
        TrafficPlan::new(&lanes(), &settings, &team(), seed)
    }

    #[test]
    fn prop_rays_that_lanes_exclude_miss_all_their_objects() {
        let plan = plan(3);
        let mut random = RandomStream::new(2, "rays");
        let (mut excluded, mut hits) = (0, 0);
        for k in 0..20_000 {
            let at = SimTime::from_ms(37 * k);
            // Every second ray starts near the lanes.
            let (side_m, up_m) = if k % 2 == 0 { (12.0, 6.0) } else { (60.0, 40.0) };
            let (north_m, above_m) = (random.range(-side_m, side_m), random.range(-up_m, up_m));
            let origin = Vec3::new(random.range(-60.0, 260.0), north_m, 21.0 + above_m);
            let direction = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
            let max_m = random.range(1.0, 60.0);
            excluded += plan.tracks.iter().filter(|track| !track.ray_may_hit(origin, direction, max_m)).count();
            let all = plan.solids(at).into_iter().filter_map(|(.., solid)| solid.ray(origin, direction, max_m));
            let nearest = all.map(|(distance_m, _)| distance_m).min_by(f64::total_cmp);
            hits += usize::from(nearest.is_some());
            assert_eq!(plan.ray(origin, direction, max_m, at).map(|hit| hit.distance_m), nearest, "{origin:?} {direction:?}");
        }
        assert!(excluded > 1_000 && hits > 50, "{excluded} {hits}");
    }

    #[test]
    fn prop_traffic_is_continuous_and_periodic() {
        let plan = plan(3);
        assert_eq!(plan.movers().len(), 17);
        for mover in plan.movers() {
            let track = &plan.tracks[mover.track];
            let mut last = plan.placement(mover, SimTime::ZERO);
            for ms in (10..60_000).step_by(10) {
                let now = plan.placement(mover, SimTime::from_ms(ms));
                if let (Some(a), Some(b)) = (last, now) {
                    // The tolerance is one centimeter at bends of the lane.
                    assert!((b.position_m - a.position_m).norm() < track.speed_m_s * 0.01 + 0.01, "jump at {ms} ms");
                }
                last = now;
            }
            let later = SimTime::from_s(7.0 + track.loop_length_m / track.speed_m_s);
            let (a, b) = (plan.placement(mover, SimTime::from_s(7.0)), plan.placement(mover, later));
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a.position_m - b.position_m).norm() < 1e-6);
            }
        }
    }

    #[test]
    fn prop_movers_stay_in_their_lane_and_between_its_ends() {
        let plan = plan(9);
        for ms in (0..120_000).step_by(250) {
            for mover in plan.movers() {
                let Some(p) = plan.placement(mover, SimTime::from_ms(ms)) else { continue };
                let lane = match mover.kind {
                    MoverKind::Pedestrian => 4.5,
                    MoverKind::Car | MoverKind::Truck => 1.8,
                };
                assert!((p.position_m.north().abs() - lane).abs() < 1e-6, "{mover:?}");
                let half = mover.kind.half_length_m() + 1e-6;
                assert!((-half..=200.0 + half).contains(&p.position_m.east()), "{mover:?} {p:?}");
            }
        }
    }

    #[test]
    fn prop_vehicles_leave_but_do_not_enter_a_closed_bridge() {
        let open = plan(3);
        let (closed_s, opened_s) = (40.0, 130.0);
        let mut gated = open.clone();
        let closures = BridgeClosures::from_codes([-40_000, 130_000]);
        gated.set_changes(SiteChanges { closures, ..SiteChanges::default() }, &|_, _| 0.0);
        // The closure lasts long enough for all vehicles to leave; the traffic recovers well before the end of the test.
        let (mut least, mut shown) = (usize::MAX, [None; 17]);
        for tenth in 0..4_000 {
            let t_s = 0.1 * f64::from(tenth);
            let at = SimTime::from_s(t_s);
            let mut vehicles = 0;
            for (k, mover) in open.movers().iter().enumerate() {
                let (free, held) = (open.placement(mover, at), gated.placement(mover, at));
                // A closure does not change the position of any object on the bridge.
                assert!(held.is_none() || held == free, "{mover:?} at {t_s} s");
                if t_s < closed_s {
                    assert_eq!(held, free);
                }
                let entered = held.is_some() && shown[k] == Some(false);
                assert!(!entered || !(closed_s + 0.1..opened_s).contains(&t_s), "{mover:?} enters at {t_s} s");
                let vanished = held.is_none() && shown[k] == Some(true);
                assert!(!vanished || free.is_none(), "{mover:?} vanishes at {t_s} s");
                shown[k] = Some(held.is_some());
                vehicles += usize::from(held.is_some() && mover.kind != MoverKind::Pedestrian);
            }
            if (closed_s..opened_s).contains(&t_s) {
                least = least.min(vehicles);
            }
        }
        assert_eq!(least, 0, "vehicles remain on the closed bridges");
        let late = SimTime::from_s(399.0);
        assert_eq!(gated.solids(late), open.solids(late), "traffic has not recovered after the reopening");
    }

    #[test]
    fn prop_movers_never_overlap() {
        let plan = plan(4);
        for s in 0..200 {
            let solids = plan.solids(SimTime::from_s(f64::from(s) * 1.7));
            for (a, _, x) in &solids {
                for (b, _, y) in solids.iter().filter(|(b, _, _)| b.0 > a.0) {
                    assert!(x.nearest(y.center_m).0 > 0.0, "{a:?} in {b:?}");
                }
            }
        }
    }

    #[test]
    fn prop_culled_queries_match_brute_force() {
        let plan = plan(5);
        let mut stream = RandomStream::new(1, "test");
        for _ in 0..3000 {
            let at = SimTime::from_s(stream.range(0.0, 500.0));
            let p = Vec3::new(stream.range(-70.0, 210.0), stream.range(-8.0, 8.0), stream.range(0.0, 30.0));
            let solids = plan.solids(at);
            let brute = solids.iter().map(|(_, _, b)| b.nearest(p).0).fold(f64::INFINITY, f64::min);
            let found = plan.nearest(p, 6.0, at).map(|n| n.distance_m);
            assert_eq!(found, (brute <= 6.0).then_some(brute));
            let d = Vec3::new(stream.normal(), stream.normal(), stream.normal()).unit();
            let brute = solids.iter().filter_map(|(_, _, b)| b.ray(p, d, 80.0)).map(|h| h.0).fold(f64::INFINITY, f64::min);
            assert_eq!(plan.ray(p, d, 80.0, at).map(|h| h.distance_m), brute.is_finite().then_some(brute));
        }
    }

    #[test]
    fn prop_contacts_have_the_velocity_of_the_vehicle() {
        let plan = plan(6);
        let at = SimTime::from_s(12.0);
        let (k, placed) = plan
            .movers()
            .iter()
            .enumerate()
            .find_map(|(k, m)| plan.placement(m, at).filter(|_| m.kind == MoverKind::Truck).map(|p| (k, p)))
            .expect("a truck is on the deck at 12 s");
        let over = placed.position_m - placed.forward * 1.2 + Vec3::new(0.0, 0.0, 3.7);
        let mut out = Vec::new();
        plan.contacts(&HullProbe::Ball { center_m: over, radius_m: 0.25 }, 0.01, at, &mut out);
        assert_eq!(out.len(), 1, "{out:?}");
        assert_eq!(out[0].surface, Surface::Vehicle);
        assert_eq!(out[0].velocity_m_s, placed.velocity_m_s);
        let name = plan.name(out[0].object).expect("named");
        assert_eq!(name, format!("truck {}", plan.movers()[k].number));
    }

    #[test]
    fn prop_plan_depends_on_the_seed() {
        assert_eq!(plan(1), plan(1));
        assert_ne!(plan(1), plan(2));
    }

    #[test]
    fn exact_crew_is_a_person_and_a_vehicle() {
        let plan = plan(1);
        let hit = plan.nearest(Vec3::new(-55.0, 1.0, 1.0), 3.0, SimTime::ZERO).expect("inspector");
        assert_eq!((hit.surface, hit.object), (Surface::Person, INSPECTOR));
        let down = plan.ray(Vec3::new(-60.0, 8.0, 10.0), Vec3::new(0.0, 0.0, -1.0), 20.0, SimTime::ZERO).expect("truck");
        assert_eq!(down.surface, Surface::Vehicle);
        assert!((down.distance_m - 6.5).abs() < 1e-9);
        assert_eq!(plan.name(CREW_TRUCK).as_deref(), Some("crew truck"));
    }

    #[test]
    fn exact_body_of_the_inspector_moves_with_the_walk() {
        let mut plan = plan(1);
        let standing = plan.solids(SimTime::ZERO);
        // From 5 s on, 10 s to the south.
        let walks = InspectorWalks::from_codes([50_012]);
        plan.set_changes(SiteChanges { walks, ..SiteChanges::default() }, &|_, _| 0.0);
        assert_eq!(plan.solids(SimTime::ZERO), standing, "before the walk");
        let at = |s: f64| SimTime::from_s(s);
        let nearest = |north: f64, s: f64| plan.nearest(Vec3::new(-55.0, north, 1.0), 0.3, at(s)).map(|near| near.object);
        assert_eq!((nearest(0.0, 4.9), nearest(0.0, 10.0)), (Some(INSPECTOR), None));
        assert_eq!([nearest(-7.0, 10.0), nearest(-14.0, 15.0), nearest(-14.0, 500.0)], [Some(INSPECTOR); 3]);
        let ray = |s: f64| plan.ray(Vec3::new(-65.0, -7.0, 1.0), Vec3::new(1.0, 0.0, 0.0), 20.0, at(s)).map(|hit| hit.surface);
        assert_eq!((ray(10.0), ray(15.0)), (Some(Surface::Person), None));
        let mut contacts = Vec::new();
        plan.contacts(&HullProbe::Ball { center_m: Vec3::new(-55.0, -7.2, 1.0), radius_m: 0.25 }, 0.01, at(10.0), &mut contacts);
        assert_eq!(contacts.len(), 1, "{contacts:?}");
        assert_eq!((contacts[0].object, contacts[0].velocity_m_s.up()), (INSPECTOR, 0.0));
        assert!((contacts[0].velocity_m_s.north() + inspector_path::WALKING_SPEED_M_S).abs() < 1e-12, "{contacts:?}");
    }
}
