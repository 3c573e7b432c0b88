//! The inspector's position as a function of time: places, and straight walks between them over the ground.

use super::inspector_walks::{InspectorWalks, MAX_TURNS, Walk};
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::{GroundTeam, INSPECTOR_EYE_HEIGHT_M};
use crate::time::SimTime;

/// Walking speed over the ground, horizontal, m/s (Bohannon 1997, Age and Ageing 26:15-19: comfortable gait, means of 1.27 to 1.46 m/s
/// for adults from 20 to 79 years). It does not depend on the slope (estimate).
pub const WALKING_SPEED_M_S: f64 = 1.4;
/// Distance between two heights of the ground along a walk, m. Between them, the height is linear.
const HEIGHT_SPACING_M: f64 = 0.25;
/// Length below which a walk has no direction, m.
const MIN_LENGTH_M: f64 = 1e-6;

/// Function that returns the height of the ground at a point (east, north), m above the origin.
pub type GroundHeight<'a> = &'a dyn Fn(f64, f64) -> f64;

/// The inspector at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InspectorPosition {
    /// Position of the feet, m.
    pub feet_m: Vec3<Enu>,
    /// Horizontal unit vector in the direction in which the inspector faces.
    pub forward: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Number of the place where the inspector stands or to which the inspector walks.
    pub place: u8,
    /// Time until the arrival, s; 0 while the inspector stands.
    pub remaining_s: f64,
}

impl InspectorPosition {
    /// Returns the position of the eyes, m.
    #[must_use]
    pub fn eye_m(&self) -> Vec3<Enu> {
        self.feet_m + Vec3::new(0.0, 0.0, INSPECTOR_EYE_HEIGHT_M)
    }

    /// Returns true if the inspector is on the way to a place.
    #[must_use]
    pub fn walks(&self) -> bool {
        self.remaining_s > 0.0
    }
}

/// A walk with its ends and the ground below.
#[derive(Debug, Clone, PartialEq)]
struct Leg {
    walk: Walk,
    from_m: Vec3<Enu>,
    to_m: Vec3<Enu>,
    forward: Vec3<Enu>,
    duration_s: f64,
    /// Heights of the feet at equal distances, m above the origin.
    heights_m: Vec<f64>,
}

/// Places and walks of the inspector. Plain data: the position depends only on the time that is passed to a query.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectorPath {
    places_m: Vec<Vec3<Enu>>,
    first_forward: Vec3<Enu>,
    walks: InspectorWalks,
    legs: Vec<Leg>,
}

impl InspectorPath {
    /// Creates the path of an inspector who stays at place 1.
    #[must_use]
    pub fn new(team: &GroundTeam) -> Self {
        let (s, c) = math::sin_cos(team.pad_heading_deg.to_radians());
        Self {
            places_m: team.inspector_places_m().collect(),
            first_forward: Vec3::new(s, c, 0.0),
            walks: InspectorWalks::default(),
            legs: Vec::new(),
        }
    }

    /// Returns the path with other walks. Walks to places that the job does not have are ignored. Without `ground`, the height changes
    /// evenly along a walk.
    #[must_use]
    pub fn with_walks(&self, walks: InspectorWalks, ground: Option<GroundHeight>) -> Self {
        let mut path = Self { walks, legs: Vec::new(), ..self.clone() };
        for walk in path.walks.clone().all() {
            let leg = path.leg(*walk, ground);
            path.legs.extend(leg);
        }
        path
    }

    fn leg(&self, walk: Walk, ground: Option<GroundHeight>) -> Option<Leg> {
        let before = self.at(walk.at);
        let to_m = self.place_m(walk.to)?;
        let from_m = walk.from.map_or(Some(before.feet_m), |from| self.place_m(from))?;
        let way = Vec3::new(to_m.east() - from_m.east(), to_m.north() - from_m.north(), 0.0);
        let length_m = way.norm();
        let forward = if length_m > MIN_LENGTH_M { way / length_m } else { before.forward };
        let heights_m = heights_m(from_m, to_m, ground);
        Some(Leg { walk, from_m, to_m, forward, duration_s: length_m / WALKING_SPEED_M_S, heights_m })
    }

    /// Returns the number of places, at least 1.
    #[must_use]
    pub fn place_count(&self) -> u8 {
        u8::try_from(self.places_m.len()).unwrap_or(u8::MAX)
    }

    /// Returns the position of the feet at a place, m; `None` if there is no place with this number.
    #[must_use]
    pub fn place_m(&self, number: u8) -> Option<Vec3<Enu>> {
        self.places_m.get(usize::from(number).checked_sub(1)?).copied()
    }

    /// Returns the walks.
    #[must_use]
    pub fn walks(&self) -> &InspectorWalks {
        &self.walks
    }

    /// Returns the inspector at a time.
    #[must_use]
    pub fn at(&self, at: SimTime) -> InspectorPosition {
        match self.legs.iter().rev().find(|leg| leg.walk.at <= at) {
            Some(leg) => leg.at((at - leg.walk.at).s()),
            None => self.at_first_place(),
        }
    }

    fn at_first_place(&self) -> InspectorPosition {
        let feet_m = self.places_m.first().copied().unwrap_or_else(Vec3::zero);
        InspectorPosition { feet_m, forward: self.first_forward, velocity_m_s: Vec3::zero(), place: 1, remaining_s: 0.0 }
    }

    /// Returns the number of the place after the one where the inspector is or to which the inspector walks; place 1 follows the
    /// last one. `None` if there is no other place.
    #[must_use]
    pub fn next_place(&self, at: SimTime) -> Option<u8> {
        let count = self.place_count();
        (count > 1).then(|| self.at(at).place % count + 1)
    }

    /// Returns whether the inspector may turn at this time. After [`MAX_TURNS`] walks without an arrival, only the arrival ends a
    /// walk.
    #[must_use]
    pub fn may_turn(&self, now: SimTime) -> bool {
        !self.at(now).walks() || self.walks.since_last_place().len() < MAX_TURNS
    }

    /// Returns the walk that begins if the inspector is sent to a place now; `None` if the inspector is there or on the way there,
    /// or if there is no such place.
    #[must_use]
    pub fn walk_to(&self, place: u8, now: SimTime) -> Option<Walk> {
        let last = self.walks.all().last();
        let at = last.map_or_else(|| Walk::start_at(now), |last| Walk::start_after(last.at, now));
        let then = self.at(at);
        let from = (!then.walks()).then_some(then.place);
        (self.place_m(place).is_some() && then.place != place).then_some(Walk { at, from, to: place })
    }

    /// Returns the way of each walk up to its end or to the next turn: from, to, m.
    pub fn ways_m(&self) -> impl Iterator<Item = (&Walk, Vec3<Enu>, Vec3<Enu>)> + '_ {
        self.legs.iter().enumerate().map(|(k, leg)| {
            let next = self.legs.get(k + 1).map_or(f64::INFINITY, |next| (next.walk.at - leg.walk.at).s());
            (&leg.walk, leg.from_m, leg.at(next.min(leg.duration_s)).feet_m)
        })
    }
}

impl Leg {
    fn at(&self, walked_s: f64) -> InspectorPosition {
        let place = self.walk.to;
        if walked_s >= self.duration_s {
            let zero = Vec3::zero();
            return InspectorPosition { feet_m: self.to_m, forward: self.forward, velocity_m_s: zero, place, remaining_s: 0.0 };
        }
        let share = walked_s / self.duration_s;
        let level = self.from_m.lerp(self.to_m, share);
        InspectorPosition {
            feet_m: Vec3::new(level.east(), level.north(), self.height_m(share)),
            forward: self.forward,
            velocity_m_s: self.forward * WALKING_SPEED_M_S,
            place,
            remaining_s: self.duration_s - walked_s,
        }
    }

    fn height_m(&self, share: f64) -> f64 {
        let steps = self.heights_m.len() - 1;
        let along = share * steps as f64;
        let k = (along as usize).min(steps - 1);
        math::lerp(self.heights_m[k], self.heights_m[k + 1], along - k as f64)
    }
}

/// Returns the heights of the feet at equal distances along a walk, at least two. Where a place is above or below the ground, the
/// difference fades out toward the other end.
fn heights_m(from_m: Vec3<Enu>, to_m: Vec3<Enu>, ground: Option<GroundHeight>) -> Vec<f64> {
    let Some(ground) = ground else { return vec![from_m.up(), to_m.up()] };
    let over = |place: Vec3<Enu>| place.up() - ground(place.east(), place.north());
    let (first_m, last_m) = (over(from_m), over(to_m));
    let steps = ((to_m - from_m).horizontal_norm() / HEIGHT_SPACING_M).ceil().max(1.0);
    let height = |k: u32| {
        let share = f64::from(k) / steps;
        let level = from_m.lerp(to_m, share);
        ground(level.east(), level.north()) + math::lerp(first_m, last_m, share)
    };
    (0..=steps as u32).map(height).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding error of positions, m.
    const ROUNDING_ERROR_M: f64 = 1e-9;

    fn team() -> GroundTeam {
        GroundTeam {
            pad_m: Vec3::new(-50.0, 0.0, 0.0),
            pad_heading_deg: 90.0,
            pad_half_m: 1.0,
            inspector_m: Vec3::new(0.0, 0.0, 0.0),
            places_m: vec![Vec3::new(28.0, 0.0, 0.0), Vec3::new(0.0, 14.0, 0.0)],
            truck_m: Vec3::new(-60.0, 8.0, 0.0),
            truck_heading_deg: 90.0,
            home_radius_m: 5.0,
        }
    }

    fn ms(ms: i64) -> SimTime {
        SimTime::from_ms(ms)
    }

    /// Sends the inspector to places at times in ms, as the vehicle does.
    fn path(sent: &[(i64, u8)]) -> InspectorPath {
        sent.iter().fold(InspectorPath::new(&team()), |path, (at, place)| {
            let mut walks = path.walks().clone();
            walks.apply_code(path.walk_to(*place, ms(*at)).and_then(Walk::code).unwrap_or(0));
            path.with_walks(walks, None)
        })
    }

    fn assert_at(path: &InspectorPath, at_ms: i64, east_m: f64, north_m: f64) {
        let feet = path.at(ms(at_ms)).feet_m;
        let off = (feet - Vec3::new(east_m, north_m, 0.0)).norm();
        assert!(off < ROUNDING_ERROR_M, "at {at_ms} ms: {feet:?} instead of {east_m}, {north_m}");
    }

    #[test]
    fn exact_inspector_walks_at_constant_speed_and_stops_at_the_place() {
        let path = path(&[(10_000, 2)]);
        assert_at(&path, 9_999, 0.0, 0.0);
        assert_eq!(path.at(ms(9_999)), InspectorPath::new(&team()).at(ms(0)));
        assert_at(&path, 15_000, 7.0, 0.0);
        let walking = path.at(ms(15_000));
        assert_eq!((walking.place, walking.walks()), (2, true));
        assert!((walking.remaining_s - 15.0).abs() < ROUNDING_ERROR_M);
        assert!((walking.velocity_m_s - Vec3::new(1.4, 0.0, 0.0)).norm() < ROUNDING_ERROR_M);
        assert_at(&path, 30_000, 28.0, 0.0);
        let there = path.at(ms(30_000));
        assert_eq!((there.feet_m, there.walks(), there.velocity_m_s), (team().places_m[0], false, Vec3::zero()));
        assert_eq!((there.eye_m() - there.feet_m).up(), INSPECTOR_EYE_HEIGHT_M);
    }

    #[test]
    fn exact_turn_begins_at_the_current_position() {
        // After 10 s, the inspector is in the middle between places 1 and 2.
        let back = path(&[(10_000, 2), (20_000, 1)]);
        assert_eq!(back.walks().all()[1], Walk { at: ms(20_000), from: None, to: 1 });
        assert_at(&back, 20_000, 14.0, 0.0);
        assert_at(&back, 25_000, 7.0, 0.0);
        assert_eq!((back.at(ms(30_000)).feet_m, back.at(ms(30_000)).walks()), (team().inspector_m, false));
        let aside = path(&[(10_000, 2), (20_000, 3)]);
        let length_m = 14.0 * 2.0_f64.sqrt();
        assert!((aside.at(ms(20_000)).remaining_s - length_m / WALKING_SPEED_M_S).abs() < ROUNDING_ERROR_M);
        let ways: Vec<_> = aside.ways_m().map(|(walk, from, to)| (walk.to, from, to)).collect();
        assert_eq!((ways[0].0, ways[0].1, ways[1].0, ways[1].2), (2, team().inspector_m, 3, team().places_m[1]));
        assert_eq!(ways[0].2, ways[1].1, "the first walk ends where the second one begins");
    }

    #[test]
    fn exact_request_for_the_same_place_changes_nothing() {
        let one = path(&[(10_000, 2)]);
        assert_eq!((one.walk_to(2, ms(12_000)), one.walk_to(2, ms(99_000)), one.walk_to(4, ms(99_000))), (None, None, None));
        assert_eq!(one.walk_to(1, ms(99_001)), Some(Walk { at: ms(99_010), from: Some(2), to: 1 }));
        assert_eq!(path(&[]).walk_to(1, ms(0)), None);
        // A second request within the resolution of the codes follows the first one.
        let two = path(&[(10_001, 2), (10_002, 3)]);
        let starts: Vec<i64> = two.walks().all().iter().map(|walk| walk.at.ms()).collect();
        assert_eq!((starts, two.walks().all()[1].from), (vec![10_010, 10_020], None));
    }

    #[test]
    fn exact_next_place_follows_the_destination_in_a_circle() {
        let next = |sent: &[(i64, u8)], at: i64| path(sent).next_place(ms(at));
        assert_eq!(next(&[], 0), Some(2));
        assert_eq!(next(&[(0, 2)], 1_000), Some(3), "already on the way to place 2");
        assert_eq!(next(&[(0, 2), (1_000, 3)], 99_000), Some(1));
        let alone = GroundTeam { places_m: Vec::new(), ..team() };
        assert_eq!(InspectorPath::new(&alone).next_place(ms(0)), None);
    }

    #[test]
    fn prop_position_is_continuous_and_every_subscriber_computes_the_same() {
        let sent = [(1_000, 2), (4_500, 3), (5_123, 1), (30_000, 3), (33_333, 2), (90_000, 1), (90_007, 2), (90_009, 3)];
        let whole = path(&sent);
        let late = InspectorPath::new(&team()).with_walks(InspectorWalks::from_codes(whole.walks().last_codes()), None);
        let since = whole.walks().since_last_place()[0].at;
        let mut last = whole.at(ms(0));
        for k in 0..15_000 {
            let at = ms(10 * k);
            let now = whole.at(at);
            assert!((now.feet_m - last.feet_m).norm() <= 0.01 * WALKING_SPEED_M_S + ROUNDING_ERROR_M, "jump at {at}");
            assert!(at < since || late.at(at) == now, "late subscriber at {at}");
            last = now;
        }
        assert!(since > ms(60_000), "{since}");
    }

    #[test]
    fn exact_feet_follow_the_ground_and_end_at_the_place() {
        let mut team = team();
        team.inspector_m = Vec3::new(0.0, 0.0, 0.2);
        team.places_m = vec![Vec3::new(28.0, 0.0, 2.8)];
        // A ridge with its top in the middle.
        let ground = |east: f64, _: f64| 0.5 * east.min(28.0 - east) + 0.1 * east;
        let walks = InspectorWalks::from_codes([Walk { at: ms(0), from: Some(1), to: 2 }.code().unwrap()]);
        let path = InspectorPath::new(&team).with_walks(walks, Some(&ground));
        let up = |at: i64| path.at(ms(at)).feet_m.up();
        assert!((up(0) - 0.2).abs() < ROUNDING_ERROR_M, "{}", up(0));
        assert!((up(10_000) - (7.0 + 1.4 + 0.1)).abs() < ROUNDING_ERROR_M, "{}", up(10_000));
        assert!((up(5_000) - (3.5 + 0.7 + 0.15)).abs() < ROUNDING_ERROR_M, "{}", up(5_000));
        assert_eq!(up(20_000), 2.8);
    }

    #[test]
    fn exact_turns_are_limited_until_the_arrival() {
        let sent: Vec<(i64, u8)> = (0..MAX_TURNS as i64).map(|k| (1_000 * k, if k % 2 == 0 { 2 } else { 3 })).collect();
        let (fewer, most) = (path(&sent[1..]), path(&sent));
        assert_eq!((fewer.may_turn(ms(8_000)), most.may_turn(ms(8_000)), most.may_turn(ms(99_000))), (true, false, true));
    }

    #[test]
    fn exact_codes_for_places_that_do_not_exist_are_ignored() {
        let walks = InspectorWalks::from_codes([100_012, 200_027, 300_005]);
        let path = InspectorPath::new(&team()).with_walks(walks, None);
        assert_eq!((path.at(ms(60_000)).place, path.ways_m().count()), (2, 1));
    }
}
