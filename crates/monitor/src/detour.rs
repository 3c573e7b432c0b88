//! The way around the bridge or the ground if the straight way to the next place is blocked: one or two places on the way, from
//! which the rest is clear.

use spandrel_mavlink::contract::guidance::DetourKind;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::bridges::Lane;
use spandrel_model::site::geometry::Geometry;
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;

const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);
/// Distance from the bridge below which the straight way counts as blocked, m (estimate: half a drone and a control error).
const MIN_CLEARANCE_M: f64 = 1.0;
/// Distance from the bridge that a way around keeps if there is such a way, m (estimate).
const WIDE_CLEARANCE_M: f64 = 2.0;
/// Margins to try, in order. Avoiding lanes takes precedence over the wider clearance: hitting the bridge damages the drone, but falling
/// onto a road endangers people.
const MARGINS: [Margin; 4] = [
    Margin { clearance_m: WIDE_CLEARANCE_M, may_cross_lanes: false },
    Margin { clearance_m: MIN_CLEARANCE_M, may_cross_lanes: false },
    Margin { clearance_m: WIDE_CLEARANCE_M, may_cross_lanes: true },
    Margin { clearance_m: MIN_CLEARANCE_M, may_cross_lanes: true },
];
/// Distance from the axis of a lane within which a place counts as above it, m (estimate: half a lane of 3.66 m and half a drone).
const LANE_REACH_M: f64 = 2.3;
/// Length of the ends of a line on which only the structure itself blocks it, m (estimate: the drone may be close to the surface
/// that it inspects).
const END_M: f64 = 3.0;
/// Length of the end of a line that may be in a surface, m (estimate: a place on a surface).
const CONTACT_M: f64 = 0.3;
/// Distance between two samples of a line, m.
const SPACING_M: f64 = 1.0;
/// Distances and number of directions of the places that are tried around both ends, m (estimate: from the width of a narrow deck
/// to that of a wide one, seen from its other edge).
const DISTANCES_M: [f64; 5] = [6.0, 10.0, 16.0, 26.0, 42.0];
const DIRECTIONS: u32 = 8;
/// Height above the highest obstacle on the straight way at which it can be crossed, m (estimate).
const CROSSING_HEIGHT_M: f64 = 4.0;
/// Height above the highest ground or water along the straight way at which a way may pass under a deck, m (estimate).
const UNDERPASS_HEIGHT_M: f64 = 4.0;
/// Smallest height of a place above ground and water, m (estimate).
const MIN_HEIGHT_M: f64 = 2.0;
/// Largest height of a structure that the drone can be under, m (estimate).
const MAX_ROOF_M: f64 = 40.0;
/// Shortest time between two searches.
const SEARCH_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Largest number of ways with two places that are tried, the shortest first.
const MAX_PAIRS: usize = 200;
/// Distance from a place at which it is reached, m, and by which the destination may move before the way is searched again, m
/// (estimate).
const ARRIVAL_M: f64 = 3.0;
const MAX_SHIFT_M: f64 = 5.0;

/// The first place of a way around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetourPlace {
    /// Position, m.
    pub place_m: Vec3<Enu>,
    /// First maneuver on the way to it.
    pub kind: DetourKind,
}

/// Clearance of a way around, and whether it avoids traffic.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Margin {
    /// Distance from the bridge, m.
    clearance_m: f64,
    /// Whether the way may pass above lanes and walkways.
    may_cross_lanes: bool,
}

/// A way around: places from which the rest of the way is clear.
#[derive(Debug, Clone, PartialEq)]
struct Route {
    places_m: Vec<Vec3<Enu>>,
    to_m: Vec3<Enu>,
    margin: Margin,
}

impl Route {
    /// Leaves out the places that need not be passed any more. Returns false if none is visible.
    fn advance(&mut self, space: &FreeSpace<'_>, from_m: Vec3<Enu>) -> bool {
        let visible = |place_m: &Vec3<Enu>| space.is_clear((from_m, *place_m), self.margin);
        let last = self.places_m.iter().rposition(visible);
        self.places_m.drain(..last.unwrap_or(0));
        last.is_some()
    }

    /// Returns whether the way has to be searched again.
    fn is_outdated(&self, from_m: Vec3<Enu>, to_m: Vec3<Enu>) -> bool {
        let is_reached = self.places_m.first().is_none_or(|place_m| (*place_m - from_m).norm() <= ARRIVAL_M);
        is_reached || (to_m - self.to_m).norm() > MAX_SHIFT_M
    }
}

/// Finds ways around, and keeps the present one while it is possible.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DetourFinder {
    route: Option<Route>,
    searched: Option<SimTime>,
}

impl DetourFinder {
    /// Returns the place to fly to first; `None` if the straight way is clear, or if there is no way around.
    pub fn update(&mut self, site: &Site, now: SimTime, (from_m, to_m): (Vec3<Enu>, Vec3<Enu>)) -> Option<DetourPlace> {
        let space = FreeSpace::new(site);
        // A way around ends only where the straight way is as clear as the way around.
        let straight = Margin { clearance_m: MIN_CLEARANCE_M, may_cross_lanes: true };
        let needed = self.route.as_ref().map_or(straight, |route| route.margin);
        if space.is_clear((from_m, to_m), needed) {
            self.route = None;
            return None;
        }
        let is_outdated =
            self.route.as_mut().is_none_or(|route| !route.advance(&space, from_m) || route.is_outdated(from_m, to_m));
        if is_outdated && self.searched.is_none_or(|searched| now - searched >= SEARCH_INTERVAL) {
            (self.searched, self.route) = (Some(now), space.route(from_m, to_m));
        }
        let place_m = self.route.as_ref()?.places_m.first().copied()?;
        Some(DetourPlace { place_m, kind: space.kind(from_m, place_m) })
    }
}

/// A line between two places.
type Line = (Vec3<Enu>, Vec3<Enu>);

/// The space around the static geometry, and the lanes to avoid.
struct FreeSpace<'a> {
    geometry: &'a Geometry,
    lanes: &'a [Lane],
}

impl<'a> FreeSpace<'a> {
    fn new(site: &'a Site) -> Self {
        Self { geometry: site.geometry(), lanes: site.lanes() }
    }

    /// Returns whether a line passes through no member, and away from its ends keeps the margin and stays above ground and water.
    fn is_clear(&self, (from_m, to_m): Line, margin: Margin) -> bool {
        let length_m = (to_m - from_m).norm();
        if length_m <= CONTACT_M {
            return true;
        }
        let hit = self.geometry.ray(from_m, (to_m - from_m).unit(), length_m - CONTACT_M);
        let is_free = |p: Vec3<Enu>| self.keeps(p, margin) && p.up() > self.floor_m(p);
        hit.is_none_or(|hit| hit.surface != Surface::Bridge) && samples((from_m, to_m), END_M).all(is_free)
    }

    /// Returns whether a place satisfies a margin.
    fn keeps(&self, p: Vec3<Enu>, margin: Margin) -> bool {
        self.geometry.nearest_member(p, margin.clearance_m).is_none() && (margin.may_cross_lanes || !self.is_over_lane(p))
    }

    /// Returns whether a place is above a lane or walkway.
    fn is_over_lane(&self, p: Vec3<Enu>) -> bool {
        let segments = self.lanes.iter().flat_map(|lane| lane.points_m.windows(2));
        segments.map(|ends| level_nearest(p, ends[0], ends[1])).any(|near_m| {
            let offset_m = p - near_m;
            offset_m.up() > 0.0 && offset_m.horizontal_norm() < LANE_REACH_M
        })
    }

    /// Returns the height of the ground or water below a place, m.
    fn floor_m(&self, p: Vec3<Enu>) -> f64 {
        self.geometry.ground_up_m(p.east(), p.north()).max(self.geometry.terrain.water_m)
    }

    /// Returns the shortest of the ways that lead via one place, or else via two.
    fn route(&self, from_m: Vec3<Enu>, to_m: Vec3<Enu>) -> Option<Route> {
        let line = (from_m, to_m);
        let floor_m = self.highest_floor_m(line);
        let crossing_m = self.highest_member_m(line).max(floor_m) + CROSSING_HEIGHT_M;
        let heights_m = [from_m.up(), to_m.up(), crossing_m, floor_m + UNDERPASS_HEIGHT_M];
        MARGINS.into_iter().find_map(|margin| {
            let free =
                |place_m: &Vec3<Enu>| self.keeps(*place_m, margin) && place_m.up() >= self.floor_m(*place_m) + MIN_HEIGHT_M;
            let around = |middle_m: Vec3<Enu>| {
                places(middle_m, heights_m)
                    .filter(free)
                    .filter(move |place_m| self.is_clear((middle_m, *place_m), margin))
                    .collect::<Vec<_>>()
            };
            let (first, last) = (around(from_m), around(to_m));
            let ends = (first.as_slice(), last.as_slice());
            let places_m = self.via_one(line, margin, ends);
            let places_m = places_m.or_else(|| self.via_two(line, margin, ends))?;
            Some(Route { places_m, to_m, margin })
        })
    }

    /// Returns the shortest way via a place that is visible from one end.
    fn via_one(
        &self,
        (from_m, to_m): Line,
        margin: Margin,
        (first, last): (&[Vec3<Enu>], &[Vec3<Enu>]),
    ) -> Option<Vec<Vec3<Enu>>> {
        let length = |place_m: &Vec3<Enu>| (*place_m - from_m).norm() + (to_m - *place_m).norm();
        let onward = first.iter().map(|place_m| (*place_m, (*place_m, to_m)));
        let toward = last.iter().map(|place_m| (*place_m, (from_m, *place_m)));
        let mut ways: Vec<(Vec3<Enu>, Line)> = onward.chain(toward).collect();
        ways.sort_by(|(a, _), (b, _)| length(a).total_cmp(&length(b)));
        ways.into_iter().find(|(_, rest)| self.is_clear(*rest, margin)).map(|(place_m, _)| vec![place_m])
    }

    /// Returns the shortest way via a place that is visible from the beginning and one that is visible from the end.
    fn via_two(
        &self,
        (from_m, to_m): Line,
        margin: Margin,
        (first, last): (&[Vec3<Enu>], &[Vec3<Enu>]),
    ) -> Option<Vec<Vec3<Enu>>> {
        let length = |(a, b): &Line| (*a - from_m).norm() + (*b - *a).norm() + (to_m - *b).norm();
        let mut pairs: Vec<Line> = first.iter().flat_map(|a| last.iter().map(|b| (*a, *b))).collect();
        pairs.sort_by(|a, b| length(a).total_cmp(&length(b)));
        let pairs = pairs.into_iter().take(MAX_PAIRS);
        pairs.into_iter().find(|pair| self.is_clear(*pair, margin)).map(|(a, b)| vec![a, b])
    }

    /// Returns the height of the highest member on a line, m; negative infinity if there is none.
    fn highest_member_m(&self, line: Line) -> f64 {
        let top_m = |p: Vec3<Enu>| {
            let member = self.geometry.nearest_member(p, WIDE_CLEARANCE_M);
            let shape = member.and_then(|member| self.geometry.shape(member.object.0 as usize));
            shape.map_or(f64::NEG_INFINITY, |shape| shape.bounds().1.up())
        };
        samples(line, 0.0).map(top_m).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the height of the highest ground or water below a line, m.
    fn highest_floor_m(&self, line: Line) -> f64 {
        samples(line, 0.0).map(|p| self.floor_m(p)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the maneuver to the first place.
    fn kind(&self, from_m: Vec3<Enu>, place_m: Vec3<Enu>) -> DetourKind {
        let is_under = |p: Vec3<Enu>| self.geometry.ray(p, UP, MAX_ROOF_M).is_some_and(|hit| hit.surface == Surface::Bridge);
        let way_m = place_m - from_m;
        let beside_m = way_m.horizontal_norm();
        match way_m.up() {
            up_m if up_m.abs() < beside_m && is_under(from_m) && !is_under(place_m) => DetourKind::OutFromUnder,
            up_m if up_m.abs() < beside_m => DetourKind::Around,
            up_m if up_m > 0.0 => DetourKind::Climb,
            _ => DetourKind::Descend,
        }
    }
}

/// Returns the point of a segment that is nearest to a place, seen from above.
fn level_nearest(p: Vec3<Enu>, from_m: Vec3<Enu>, to_m: Vec3<Enu>) -> Vec3<Enu> {
    let (way, to_place) = (to_m - from_m, p - from_m);
    let level_dot = |a: Vec3<Enu>, b: Vec3<Enu>| a.east() * b.east() + a.north() * b.north();
    let along = level_dot(to_place, way) / level_dot(way, way).max(f64::MIN_POSITIVE);
    from_m.lerp(to_m, along.clamp(0.0, 1.0))
}

/// Returns places on a line at least `end_m` away from its ends.
fn samples((from_m, to_m): Line, end_m: f64) -> impl Iterator<Item = Vec3<Enu>> {
    let length_m = (to_m - from_m).norm();
    let count = (length_m / SPACING_M).ceil().max(1.0) as u32;
    let along = (0..=count).map(move |k| f64::from(k) / f64::from(count));
    let inner = along.filter(move |share| (end_m..=length_m - end_m).contains(&(share * length_m)));
    inner.map(move |share| from_m.lerp(to_m, share))
}

/// Returns the places that are tried around one end: above and below it, and beside it in all directions.
fn places(middle_m: Vec3<Enu>, heights_m: [f64; 4]) -> impl Iterator<Item = Vec3<Enu>> {
    let beside = DISTANCES_M.into_iter().flat_map(|distance_m| {
        (0..DIRECTIONS).map(move |k| {
            let (sin, cos) = math::sin_cos(math::TAU * f64::from(k) / f64::from(DIRECTIONS));
            (distance_m * sin, distance_m * cos)
        })
    });
    let offsets = std::iter::once((0.0, 0.0)).chain(beside);
    offsets.flat_map(move |(east_m, north_m)| {
        heights_m.map(|up_m| Vec3::new(middle_m.east() + east_m, middle_m.north() + north_m, up_m))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::{self, Scenario};
    use spandrel_model::shipped;

    /// Interval of the guidance.
    const STEP: SimTime = SimTime::from_ms(200);
    /// Rounding error at the destination, m.
    const ARRIVAL_TOLERANCE_M: f64 = 1e-6;
    /// Distance that the drone of the tests flies in a step, m (2.5 m/s).
    const STEP_M: f64 = 0.5;

    fn job(text: &str) -> (Scenario, Site) {
        let job = scenario::read("job.toml", text, &|file| Err(file.to_owned())).unwrap();
        let site = Site::build(&job, 1);
        (job, site)
    }

    /// Returns the middle of the lowest member that has a deck above it and air below, and the height of the deck's top there.
    fn under_deck(job: &Scenario, geometry: &Geometry) -> (Vec3<Enu>, f64) {
        let paths = job.tasks.iter().flat_map(|task| task.path_m.iter().copied());
        let roofed = |p: &Vec3<Enu>| geometry.ray(*p, UP, MAX_ROOF_M).filter(|hit| hit.surface == Surface::Bridge).is_some();
        let under_m = paths.into_iter().find(roofed).unwrap();
        let hit = geometry.ray(under_m, UP, MAX_ROOF_M).unwrap();
        let top_m = geometry.members().iter().enumerate().filter_map(|(k, _)| geometry.shape(k)).filter(|shape| {
            let (low, high) = shape.bounds();
            let inside = |p: f64, low: f64, high: f64| (low..=high).contains(&p);
            inside(under_m.east(), low.east(), high.east()) && inside(under_m.north(), low.north(), high.north())
        });
        (under_m, top_m.map(|shape| shape.bounds().1.up()).fold(under_m.up() + hit.distance_m, f64::max))
    }

    /// A flight where the guidance leads.
    #[derive(Debug, Default)]
    struct Flown {
        /// Kinds of detours, in order.
        kinds: Vec<DetourKind>,
        /// Whether the place was reached without a collision.
        reached: bool,
        /// Length of the detours above lanes and walkways, m.
        over_lanes_m: f64,
    }

    fn fly(site: &Site, from_m: Vec3<Enu>, to_m: Vec3<Enu>) -> Flown {
        let space = FreeSpace::new(site);
        let (mut finder, mut at_m, mut now, mut flown) = (DetourFinder::default(), from_m, SimTime::ZERO, Flown::default());
        for _ in 0..4_000 {
            let next = finder.update(site, now, (at_m, to_m));
            if let Some(place) = next.filter(|place| flown.kinds.last() != Some(&place.kind)) {
                flown.kinds.push(place.kind);
            }
            let step_m = (next.map_or(to_m, |place| place.place_m) - at_m).limited(STEP_M);
            let hit = step_m.norm() > 0.0
                && site.geometry().ray(at_m, step_m.unit(), step_m.norm()).is_some_and(|hit| hit.surface == Surface::Bridge);
            at_m += step_m;
            now += STEP;
            if next.is_some() && space.is_over_lane(at_m) {
                flown.over_lanes_m += step_m.norm();
            }
            if hit || (at_m - to_m).norm() < ARRIVAL_TOLERANCE_M {
                return Flown { reached: !hit, ..flown };
            }
        }
        flown
    }

    #[test]
    fn regress_the_way_to_a_place_above_the_deck_leads_out_from_under_it_first() {
        let (job, site) = job(shipped::TWO_BRIDGES);
        let (under_m, top_m) = under_deck(&job, site.geometry());
        let above_m = Vec3::new(under_m.east(), under_m.north(), top_m + 6.0);
        let place = DetourFinder::default().update(&site, SimTime::ZERO, (under_m, above_m)).unwrap();
        assert_eq!(place.kind, DetourKind::OutFromUnder, "{place:?} from {under_m:?}");
        let up = fly(&site, under_m, above_m);
        assert!(up.reached && up.kinds.first() == Some(&DetourKind::OutFromUnder), "{up:?}");
        let back = fly(&site, above_m, under_m);
        assert!(back.reached && !back.kinds.is_empty(), "the way back: {back:?}");
    }

    #[test]
    fn exact_a_clear_way_has_no_detour() {
        let (job, site) = job(shipped::TWO_BRIDGES);
        let pad_m = job.ground_team.pad_m;
        let (low_m, high_m) = (pad_m + UP * 5.0, pad_m + UP * 30.0);
        assert_eq!(DetourFinder::default().update(&site, SimTime::ZERO, (low_m, high_m)), None);
    }

    #[test]
    fn prop_detours_reach_every_task_from_every_other_without_a_collision_and_not_over_lanes() {
        for (_, text) in shipped::SCENARIOS {
            let (job, site) = job(text);
            let pad_m = job.ground_team.pad_m + UP * 5.0;
            let ends = job.tasks.iter().flat_map(|task| [task.path_m.first().copied(), task.path_m.last().copied()]).flatten();
            let stops: Vec<Vec3<Enu>> = std::iter::once(pad_m).chain(ends).collect();
            for from_m in &stops {
                for to_m in &stops {
                    let flown = fly(&site, *from_m, *to_m);
                    assert!(flown.reached, "{}: from {from_m:?} to {to_m:?}: {flown:?}", job.name);
                    assert!(flown.over_lanes_m <= 0.0, "{}: from {from_m:?} to {to_m:?} over a lane: {flown:?}", job.name);
                }
            }
        }
    }
}
