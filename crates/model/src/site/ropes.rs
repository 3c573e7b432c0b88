//! Ropes and cables at the site, which hang from one point or between two. Like traffic, their shapes are a pure function of simulation time, and
//! nothing changes their motion. The scenario's wind blows them aside, and they swing about that position.

use super::hull_shape::HullShape;
use super::query_types::{Contact, HullProbe, NearestPoint, ObjectId, RayHit, Surface};
use super::wind;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::{RopeSpec, WindEvent, WindModel, WindSpec};
use crate::time::SimTime;
use crate::vehicle::SEA_LEVEL_AIR_DENSITY_KG_M3;

/// First object number of ropes, above those of drones.
pub const FIRST_ROPE_OBJECT: u32 = 2_500_000;
/// Longest segment, m.
const SEGMENT_M: f64 = 1.0;
/// Smallest number of segments.
const MIN_SEGMENTS: usize = 8;
/// Drag coefficient of a cylinder across the flow (Hoerner, Fluid-Dynamic Drag, 1965, subcritical).
const DRAG_COEFFICIENT: f64 = 1.2;
/// Amplitude of the swing relative to the drag, for the turbulence 1 (estimate: twice the intensity of the wind over open water, because drag grows
/// with its square).
const SWING: f64 = 0.2;
/// Angular frequency of the first mode of a hanging chain is this factor times the root of g/L (half the first zero of J0).
const HANGING_MODE: f64 = 1.2024;
/// Length of the pendulum that swings as a shallow parabola about its chord, relative to its sag.
const CHORD_PENDULUM: f64 = 0.8;
/// Smallest sag for the frequency of a rope between two points, m (estimate: a taut rope hardly swings).
const MIN_SAG_M: f64 = 0.1;
/// Time over which the velocity of a rope is measured, s.
const VELOCITY_TIME_S: f64 = 0.01;
/// Iterations of Newton's method for the catenary; four reach rounding errors.
const ITERATIONS: usize = 8;

/// A rope.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteRope {
    name: String,
    from_m: Vec3<Enu>,
    to_m: Option<Vec3<Enu>>,
    length_m: f64,
    radius_m: f64,
    /// Acceleration by drag divided by the square of the wind speed, 1/m.
    drag_per_m: f64,
    frequency_rad_s: f64,
    phase_rad: f64,
    /// Largest angle by which the wind moves a rope with one end away from the vertical, rad.
    largest_lean_rad: f64,
    segments: usize,
}

impl SiteRope {
    fn new(spec: &RopeSpec, wind: &WindSpec, stream: &mut RandomStream) -> Option<Self> {
        let from_m = *spec.points_m.first()?;
        let drag_per_m = 0.5 * SEA_LEVEL_AIR_DENSITY_KG_M3 * DRAG_COEFFICIENT * spec.diameter_m / spec.mass_kg_m;
        let to_m = spec.points_m.get(1).copied();
        let sag_m = to_m.map(|to_m| sag_m(spec.length_m, (to_m - from_m).norm()).max(MIN_SAG_M));
        let frequency_rad_s = match sag_m {
            Some(sag_m) => (math::GRAVITY_M_S2 / (CHORD_PENDULUM * sag_m)).sqrt(),
            None => HANGING_MODE * (math::GRAVITY_M_S2 / spec.length_m).sqrt(),
        };
        Some(Self {
            name: spec.name.clone(),
            from_m,
            to_m,
            length_m: spec.length_m,
            radius_m: 0.5 * spec.diameter_m,
            drag_per_m,
            frequency_rad_s,
            phase_rad: stream.range(0.0, math::TAU),
            largest_lean_rad: largest_lean_rad(drag_per_m, from_m.up(), wind),
            segments: ((spec.length_m / SEGMENT_M).ceil() as usize).max(MIN_SEGMENTS),
        })
    }

    /// Returns the name in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns half the diameter, m.
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Returns the sphere that always contains the rope's axis: center and radius, m.
    fn reach(&self) -> (Vec3<Enu>, f64) {
        match self.to_m {
            Some(to_m) => (self.from_m.lerp(to_m, 0.5), 0.5 * self.length_m),
            None => (self.from_m, self.length_m),
        }
    }

    /// Returns the points of the axis at a time: the ends of equally long segments.
    fn points_m(&self, wind: &WindSpec, at: SimTime) -> Vec<Vec3<Enu>> {
        let pull = self.pull(wind, at);
        match self.to_m {
            Some(to_m) => catenary(self.from_m, to_m, self.length_m, pull, self.segments),
            None => (0..=self.segments).map(|k| self.from_m + pull * (self.length_m * k as f64 / self.segments as f64)).collect(),
        }
    }

    /// Returns the direction in which weight and wind pull.
    fn pull(&self, wind: &WindSpec, at: SimTime) -> Vec3<Enu> {
        let down = Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2);
        if wind.model == WindModel::Paper {
            return down.unit();
        }
        let air = wind::velocity_at(wind, at).enu() * wind::profile(self.from_m.up());
        let swing = 1.0 + SWING * wind.turbulence * math::sin(self.frequency_rad_s * at.s() + self.phase_rad);
        (down + air * (self.drag_per_m * air.norm() * swing)).unit()
    }

    /// Returns a lower bound of the distance of the surface from a point at any time, m.
    fn min_distance_over_time_m(&self, point_m: Vec3<Enu>) -> f64 {
        let axis_m = match self.to_m {
            // Each point of the rope is at most this far from the chord.
            Some(to_m) => {
                HullShape::between(self.from_m, to_m, sag_m(self.length_m, (to_m - self.from_m).norm())).nearest(point_m).0
            }
            None => self.distance_from_cone_m(point_m),
        };
        axis_m - self.radius_m
    }

    /// Returns a lower bound of the distance of a point from all positions of a rope with one end.
    fn distance_from_cone_m(&self, point_m: Vec3<Enu>) -> f64 {
        let chord = 2.0 * math::sin(0.5 * self.largest_lean_rad);
        let segment = |k: usize| {
            let [near_m, far_m] = [k, k + 1].map(|end| self.length_m * end as f64 / self.segments as f64);
            let at = |down_m: f64| self.from_m + Vec3::new(0.0, 0.0, -down_m);
            HullShape::between(at(near_m), at(far_m), far_m * chord).nearest(point_m).0
        };
        (0..self.segments).map(segment).fold(f64::INFINITY, f64::min)
    }
}

/// Returns the largest angle by which the scenario's wind moves a rope away from the vertical, rad, for its drag (1/m) and the height of its end (m).
fn largest_lean_rad(drag_per_m: f64, up_m: f64, wind: &WindSpec) -> f64 {
    if wind.model == WindModel::Paper {
        return 0.0;
    }
    let (mut mean_m_s, mut gusts_m_s) = (wind.speed_m_s, 0.0);
    for event in &wind.events {
        match event {
            WindEvent::Change { speed_m_s, .. } => mean_m_s = mean_m_s.max(*speed_m_s),
            WindEvent::Gust { peak_speed_m_s, .. } => gusts_m_s += peak_speed_m_s,
        }
    }
    let speed_m_s = (mean_m_s + gusts_m_s) * wind::profile(up_m);
    math::atan(drag_per_m * speed_m_s * speed_m_s * (1.0 + SWING * wind.turbulence) / math::GRAVITY_M_S2)
}

/// Returns how far a rope can be from the straight line between its ends, m.
fn sag_m(length_m: f64, chord_m: f64) -> f64 {
    0.5 * (length_m * length_m - chord_m * chord_m).max(0.0).sqrt()
}

fn sinh(x: f64) -> f64 {
    0.5 * (math::exp(x) - math::exp(-x))
}

fn asinh(x: f64) -> f64 {
    math::ln(x.abs() + math::hypot(x, 1.0)).copysign(x)
}

/// Returns the points of a rope that hangs between two points in the direction `pull`: the ends of equally long segments.
fn catenary(from_m: Vec3<Enu>, to_m: Vec3<Enu>, length_m: f64, pull: Vec3<Enu>, segments: usize) -> Vec<Vec3<Enu>> {
    let chord = to_m - from_m;
    let rise_m = -chord.dot(pull);
    let across = chord + pull * rise_m;
    let span_m = across.norm().max(1e-3 * length_m);
    let across = if across.norm() > 0.0 { across.unit() } else { Vec3::zero() };
    // sinh(u)/u of the half span u, in units of the catenary's parameter a.
    let ratio = ((length_m * length_m - rise_m * rise_m).max(span_m * span_m).sqrt() / span_m).max(1.0 + 1e-9);
    let mut u = if ratio < 3.0 { (6.0 * (ratio - 1.0)).sqrt() } else { math::ln(2.0 * ratio) + math::ln(math::ln(2.0 * ratio)) };
    for _ in 0..ITERATIONS {
        let s = sinh(u);
        u -= (s / u - ratio) * u * u / (u * math::hypot(s, 1.0) - s);
    }
    let a_m = 0.5 * span_m / u;
    let lowest_m = 0.5 * span_m - a_m * asinh(0.5 * rise_m / (a_m * sinh(u)));
    let start = sinh(lowest_m / a_m);
    let point = |k: usize| {
        let along = length_m * k as f64 / segments as f64 / a_m - start;
        let x_m = lowest_m + a_m * asinh(along);
        let y_m = a_m * (math::hypot(along, 1.0) - math::hypot(start, 1.0));
        from_m + across * x_m - pull * y_m
    };
    (0..=segments).map(point).collect()
}

/// All ropes at the site.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SiteRopes {
    ropes: Vec<SiteRope>,
    wind: Option<WindSpec>,
}

/// A segment of a rope at a time.
struct Segment {
    object: ObjectId,
    shape: HullShape,
    rope: usize,
    number: usize,
}

impl SiteRopes {
    /// Creates the ropes. The seed determines the phases of their swings.
    #[must_use]
    pub fn new(specs: &[RopeSpec], wind: &WindSpec, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "site.ropes");
        let ropes: Vec<SiteRope> = specs.iter().filter_map(|spec| SiteRope::new(spec, wind, &mut stream)).collect();
        Self { wind: (!ropes.is_empty()).then(|| wind.clone()), ropes }
    }

    /// Returns the ropes, in the order of the scenario.
    #[must_use]
    pub fn all(&self) -> &[SiteRope] {
        &self.ropes
    }

    /// Returns the points of the axes of all ropes at a time, m: the ends of segments of at most 1 m.
    pub fn points_m(&self, at: SimTime) -> impl Iterator<Item = (&SiteRope, Vec<Vec3<Enu>>)> {
        self.wind.iter().flat_map(move |wind| self.ropes.iter().map(move |rope| (rope, rope.points_m(wind, at))))
    }

    /// Returns the name of one of these ropes; `None` for other objects.
    #[must_use]
    pub fn name(&self, object: ObjectId) -> Option<&str> {
        self.ropes.get(object.0.checked_sub(FIRST_ROPE_OBJECT)? as usize).map(SiteRope::name)
    }

    /// Returns the segments of the ropes that may be within a distance of a point.
    fn segments(&self, point_m: Vec3<Enu>, max_m: f64, at: SimTime) -> impl Iterator<Item = Segment> {
        let near = move |(_, rope): &(usize, &SiteRope)| {
            let (center_m, reach_m) = rope.reach();
            (center_m - point_m).norm() <= max_m + reach_m + rope.radius_m
        };
        let of_rope = move |(k, rope): (usize, &SiteRope)| {
            let points_m = self.wind.as_ref().map(|wind| rope.points_m(wind, at)).unwrap_or_default();
            let object = ObjectId(FIRST_ROPE_OBJECT + k as u32);
            let radius_m = rope.radius_m;
            let pairs: Vec<(Vec3<Enu>, Vec3<Enu>)> = points_m.windows(2).map(|pair| (pair[0], pair[1])).collect();
            pairs.into_iter().enumerate().map(move |(number, (a_m, b_m))| Segment {
                object,
                shape: HullShape::between(a_m, b_m, radius_m),
                rope: k,
                number,
            })
        };
        self.ropes.iter().enumerate().filter(near).flat_map(of_rope)
    }

    /// Returns the nearest point of a rope within `max_m`.
    #[must_use]
    pub fn nearest(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<NearestPoint> {
        let mut best: Option<NearestPoint> = None;
        for segment in self.segments(position_m, max_m, at) {
            let (distance_m, point_m, normal) = segment.shape.nearest(position_m);
            if distance_m <= best.map_or(max_m, |b| b.distance_m) {
                best = Some(NearestPoint { distance_m, point_m, normal, surface: Surface::Other, object: segment.object });
            }
        }
        best
    }

    /// Returns a lower bound for the distance of the ropes from a point at any time, in meters, if it is below `max_m`.
    #[must_use]
    pub fn min_distance_over_time_m(&self, position_m: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let distances_m = self.distances_over_time_m(position_m).map(|(_, distance_m)| distance_m);
        distances_m.filter(|distance_m| *distance_m < max_m).min_by(f64::total_cmp)
    }

    /// Returns the index of each rope and a lower bound for its distance from a point at any time, m.
    pub fn distances_over_time_m(&self, position_m: Vec3<Enu>) -> impl Iterator<Item = (usize, f64)> {
        self.ropes.iter().enumerate().map(move |(k, rope)| (k, rope.min_distance_over_time_m(position_m)))
    }

    /// Returns the first hit of a ray with a rope within `max_m`.
    #[must_use]
    pub fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit> {
        let wind = self.wind.as_ref()?;
        let mut best: Option<RayHit> = None;
        for (k, rope) in self.ropes.iter().enumerate() {
            let (center_m, reach_m) = rope.reach();
            if HullShape::between(center_m, center_m, reach_m + rope.radius_m).ray(origin_m, direction, max_m).is_none() {
                continue;
            }
            for pair in rope.points_m(wind, at).windows(2) {
                let within_m = best.map_or(max_m, |b| b.distance_m);
                let hit = HullShape::between(pair[0], pair[1], rope.radius_m).ray(origin_m, direction, within_m);
                if let Some((distance_m, normal)) = hit {
                    let object = ObjectId(FIRST_ROPE_OBJECT + k as u32);
                    best = Some(RayHit { distance_m, normal, surface: Surface::Other, object });
                }
            }
        }
        best
    }

    /// Appends a probe's contacts with the ropes. A contact has the velocity of the rope there.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>) {
        let (middle_m, radius_m) = super::boxes::bounding_sphere(probe);
        let segments: Vec<Segment> = self.segments(middle_m, radius_m + margin_m, at).collect();
        for Segment { object, shape, rope, number } in segments {
            let mut found = Vec::new();
            shape.contacts(probe, margin_m, |gap_m, point_m, normal| found.push((gap_m, point_m, normal)));
            if found.is_empty() {
                continue;
            }
            let velocity_m_s = self.velocity_m_s(rope, number, at);
            out.extend(found.into_iter().map(|(gap_m, point_m, normal)| Contact {
                point_m,
                normal,
                gap_m,
                velocity_m_s,
                surface: Surface::Other,
                object,
            }));
        }
    }

    /// Returns the mean velocity of a segment, m/s.
    fn velocity_m_s(&self, rope: usize, segment: usize, at: SimTime) -> Vec3<Enu> {
        let middle = |at: SimTime| {
            let points_m = self.ropes.get(rope).zip(self.wind.as_ref()).map(|(rope, wind)| rope.points_m(wind, at));
            points_m.and_then(|points| Some(points.get(segment)?.lerp(*points.get(segment + 1)?, 0.5))).unwrap_or_default()
        };
        (middle(at) - middle(at - SimTime::from_s(VELOCITY_TIME_S))) * (1.0 / VELOCITY_TIME_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding tolerance, m.
    const TOLERANCE_M: f64 = 1e-9;

    fn wind(speed_m_s: f64) -> WindSpec {
        WindSpec {
            model: WindModel::Physical,
            speed_m_s,
            paper_force_n: 0.0,
            from_deg: 0.0,
            up_m_s: 0.0,
            turbulence: 0.0,
            events: Vec::new(),
        }
    }

    fn spec(points_m: &[[f64; 3]], length_m: f64) -> RopeSpec {
        let points_m = points_m.iter().map(|[e, n, u]| Vec3::new(*e, *n, *u)).collect();
        RopeSpec { name: "line".into(), points_m, length_m, diameter_m: 0.02, mass_kg_m: 0.2 }
    }

    fn length_m(points_m: &[Vec3<Enu>]) -> f64 {
        points_m.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }

    #[test]
    fn exact_rope_between_two_points_is_a_catenary() {
        let ropes = SiteRopes::new(&[spec(&[[0.0, 0.0, 10.0], [30.0, 0.0, 14.0]], 36.0)], &wind(0.0), 1);
        let (_, points_m) = ropes.points_m(SimTime::ZERO).next().unwrap();
        assert!((*points_m.last().unwrap() - Vec3::new(30.0, 0.0, 14.0)).norm() < TOLERANCE_M, "{:?}", points_m.last());
        // The sum of chords is shorter than the arc: by less than a thousandth for segments of 1 m.
        assert!((length_m(&points_m) / 36.0 - 1.0).abs() < 1e-3, "{}", length_m(&points_m));
        // Segments of equal length pull with equal weights: the slope changes by the same amount from each one to the next.
        let slopes: Vec<f64> = points_m.windows(2).map(|p| (p[1].up() - p[0].up()) / (p[1].east() - p[0].east())).collect();
        let steps: Vec<f64> = slopes.windows(2).map(|s| s[1] - s[0]).collect();
        assert!(steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 0.01), "{steps:?}");
    }

    #[test]
    fn exact_hanging_rope_leans_as_far_as_drag_and_weight_balance() {
        let ropes = SiteRopes::new(&[spec(&[[0.0, 0.0, 20.0]], 8.0)], &wind(6.0), 1);
        let (_, points_m) = ropes.points_m(SimTime::ZERO).next().unwrap();
        let air_m_s = 6.0 * wind::profile(20.0);
        let lean = 0.5 * 1.225 * 1.2 * 0.02 / 0.2 * air_m_s * air_m_s / math::GRAVITY_M_S2;
        let end = *points_m.last().unwrap() - Vec3::new(0.0, 0.0, 20.0);
        // Wind from the north blows it south.
        assert!((-end.north() / -end.up() - lean).abs() < TOLERANCE_M && end.east().abs() < TOLERANCE_M, "{end:?}");
        assert!((end.norm() - 8.0).abs() < TOLERANCE_M);
        let paper = WindSpec { model: WindModel::Paper, ..wind(6.0) };
        let (_, still) = SiteRopes::new(&[spec(&[[0.0, 0.0, 20.0]], 8.0)], &paper, 1)
            .points_m(SimTime::ZERO)
            .next()
            .map(|(r, p)| (r.clone(), p))
            .unwrap();
        assert!((*still.last().unwrap() - Vec3::new(0.0, 0.0, 12.0)).norm() < TOLERANCE_M, "still air in the paper's model");
    }

    #[test]
    fn exact_queries_see_the_rope_where_it_hangs() {
        let ropes = SiteRopes::new(&[spec(&[[0.0, 0.0, 20.0]], 8.0)], &wind(0.0), 1);
        let beside = Vec3::new(2.0, 0.0, 15.0);
        let near = ropes.nearest(beside, 5.0, SimTime::ZERO).unwrap();
        assert!((near.distance_m - 1.99).abs() < TOLERANCE_M && near.surface == Surface::Other, "{near:?}");
        assert_eq!(ropes.nearest(beside, 1.0, SimTime::ZERO), None);
        let hit = ropes.ray(beside, Vec3::new(-1.0, 0.0, 0.0), 10.0, SimTime::ZERO).unwrap();
        assert!((hit.distance_m - 1.99).abs() < TOLERANCE_M, "{hit:?}");
        assert_eq!(ropes.ray(beside + Vec3::new(0.0, 0.05, 0.0), Vec3::new(-1.0, 0.0, 0.0), 10.0, SimTime::ZERO), None);
        let mut out = Vec::new();
        let probe = HullProbe::Ball { center_m: Vec3::new(0.3, 0.0, 15.0), radius_m: 0.25 };
        ropes.contacts(&probe, 0.1, SimTime::ZERO, &mut out);
        assert!(out.iter().any(|c| (c.gap_m - 0.04).abs() < TOLERANCE_M && c.surface == Surface::Other), "{out:?}");
        assert_eq!((ropes.name(near.object), ropes.name(ObjectId(FIRST_ROPE_OBJECT + 1))), (Some("line"), None));
    }

    #[test]
    fn prop_distance_over_time_is_never_more_than_a_distance_at_a_time() {
        let gust =
            WindEvent::Gust { at: SimTime::from_s(5.0), duration: SimTime::from_s(6.0), peak_speed_m_s: 8.0, from_deg: 70.0 };
        let windy = WindSpec { turbulence: 1.0, events: vec![gust], ..wind(6.0) };
        let specs = [spec(&[[0.0, 0.0, 20.0]], 8.0), spec(&[[5.0, 0.0, 20.0], [25.0, 4.0, 18.0]], 24.0)];
        let mut random = RandomStream::new(3, "points");
        for one in specs {
            let ropes = SiteRopes::new(&[one], &windy, 1);
            for _ in 0..100 {
                let p = Vec3::new(random.range(-5.0, 30.0), random.range(-6.0, 8.0), random.range(8.0, 22.0));
                let least = ropes.min_distance_over_time_m(p, 100.0).unwrap();
                for tenth in 0..150 {
                    let now = ropes.nearest(p, 100.0, SimTime::from_s(0.1 * f64::from(tenth))).unwrap();
                    assert!(least <= now.distance_m + TOLERANCE_M, "{p:?}: {least} {now:?}");
                }
            }
        }
    }

    #[test]
    fn prop_velocity_is_that_of_the_points() {
        let ropes = SiteRopes::new(&[spec(&[[0.0, 0.0, 20.0]], 8.0)], &WindSpec { turbulence: 1.0, ..wind(8.0) }, 2);
        let at = |s: f64| ropes.points_m(SimTime::from_s(s)).next().unwrap().1;
        let (a, b) = (at(3.0), at(3.01));
        let expected = (b[7].lerp(b[8], 0.5) - a[7].lerp(a[8], 0.5)) * 100.0;
        assert!((ropes.velocity_m_s(0, 7, SimTime::from_s(3.01)) - expected).norm() < 1e-6);
        assert!(expected.norm() > 0.01, "it swings: {expected:?}");
    }
}
