//! Geofence: allowed areas and actions on a breach.

use super::core::{Autopilot, Severity};
use super::{FlightMode, LandedState, MissionStep, RequestOutcome};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Number of polygon sides used to check a circle.
const RING_SIDES: usize = 36;

/// Outline of a zone, north and east relative to the origin, m.
#[derive(Debug, Clone, PartialEq)]
pub enum FenceOutline {
    /// Corners in order; the last connects to the first.
    Polygon(Vec<(f64, f64)>),
    /// A circle.
    Circle {
        /// Center.
        centre_m: (f64, f64),
        /// Radius, m.
        radius_m: f64,
    },
}

impl FenceOutline {
    /// Returns true if a point is inside.
    #[must_use]
    pub fn holds(&self, (n, e): (f64, f64)) -> bool {
        match self {
            Self::Circle { centre_m, radius_m } => {
                let (dn, de) = (n - centre_m.0, e - centre_m.1);
                dn * dn + de * de <= radius_m * radius_m
            }
            // A ray to the east crosses the outline an odd number of times from inside.
            Self::Polygon(corners) => {
                let last = corners.len().saturating_sub(1);
                let sides = corners.iter().enumerate().map(|(k, to)| (corners[if k == 0 { last } else { k - 1 }], *to));
                sides.filter(|(a, b)| (a.0 > n) != (b.0 > n) && e < (b.1 - a.1) * (n - a.0) / (b.0 - a.0) + a.1).count() % 2 == 1
            }
        }
    }

    /// Intersections of a straight path with the outline, as fractions of the path length.
    fn crossings(&self, from: (f64, f64), to: (f64, f64)) -> Vec<f64> {
        let way = (to.0 - from.0, to.1 - from.1);
        match self {
            Self::Circle { centre_m, radius_m } => {
                let off = (from.0 - centre_m.0, from.1 - centre_m.1);
                let (a, b) = (way.0 * way.0 + way.1 * way.1, off.0 * way.0 + off.1 * way.1);
                let root = b * b - a * (off.0 * off.0 + off.1 * off.1 - radius_m * radius_m);
                if a > 0.0 && root > 0.0 { vec![(-b - root.sqrt()) / a, (-b + root.sqrt()) / a] } else { Vec::new() }
            }
            Self::Polygon(corners) => {
                let last = corners.len().saturating_sub(1);
                let sides = corners.iter().enumerate().map(|(k, end)| (corners[if k == 0 { last } else { k - 1 }], *end));
                let cross = |a: (f64, f64), b: (f64, f64)| a.0 * b.1 - a.1 * b.0;
                let meet = |(start, end): ((f64, f64), (f64, f64))| {
                    let (side, gap) = ((end.0 - start.0, end.1 - start.1), (start.0 - from.0, start.1 - from.1));
                    let d = cross(way, side);
                    // On the side itself, its midpoint decides.
                    let share = cross(gap, way) / d;
                    (d != 0.0 && (0.0..=1.0).contains(&share)).then(|| cross(gap, side) / d)
                };
                sides.filter_map(meet).collect()
            }
        }
    }
}

/// One zone of the geofence.
#[derive(Debug, Clone, PartialEq)]
pub struct FenceZone {
    /// Outline.
    pub outline: FenceOutline,
    /// Inclusion or exclusion zone. Flight is allowed inside at least one inclusion zone, if there are any, and outside all
    /// exclusion zones.
    pub inclusion: bool,
}

/// A rally point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RallyPoint {
    /// Position relative to the origin, m.
    pub place_m: Vec3<Ned>,
    /// Whether its height is relative to home and moves with it.
    pub over_home: bool,
}

/// Breached limit, numbered as MAVLink's FENCE_BREACH.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breach {
    /// Minimum height above home (1).
    Floor,
    /// Maximum height above home (2).
    Height,
    /// Zone boundary or maximum distance from home (3).
    Boundary,
}

/// Action on a breach, numbered as PX4's `GF_ACTION`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FenceAction {
    /// None (0).
    None,
    /// Warn only (1).
    Warning,
    /// Stop and hold position (2).
    Hold,
    /// Return and land (3).
    Return,
    /// Stop the motors (4).
    Terminate,
    /// Land at the current position (5).
    Land,
}

impl FenceAction {
    /// Returns the action for a parameter value, or `None` if it is unknown.
    #[must_use]
    pub fn from_number(n: i32) -> Option<Self> {
        let all = [Self::None, Self::Warning, Self::Hold, Self::Return, Self::Terminate, Self::Land];
        all.get(usize::try_from(n).ok()?).copied()
    }
}

/// State of the geofence for telemetry.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FenceState {
    /// Whether any limit is active.
    pub set: bool,
    /// The current breach.
    pub breach: Option<Breach>,
    /// Number of breaches so far.
    pub count: u16,
    /// Number of breaches that changed the mode.
    pub taken: u16,
    /// Start time of the last breach.
    pub at: SimTime,
}

/// The zones of the geofence.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fence {
    zones: Vec<FenceZone>,
}

impl Fence {
    /// Returns true if a position is allowed by all zones.
    #[must_use]
    pub fn allows(&self, place_m: (f64, f64)) -> bool {
        let mut inclusions = self.zones.iter().filter(|zone| zone.inclusion).peekable();
        let within = inclusions.peek().is_none() || inclusions.any(|zone| zone.outline.holds(place_m));
        within && !self.zones.iter().any(|zone| !zone.inclusion && zone.outline.holds(place_m))
    }

    /// Returns true if an entire straight path is allowed by all zones.
    #[must_use]
    pub fn allows_path(&self, from_m: (f64, f64), to_m: (f64, f64)) -> bool {
        let mut cuts: Vec<f64> = self.zones.iter().flat_map(|zone| zone.outline.crossings(from_m, to_m)).collect();
        cuts.retain(|cut| (0.0..1.0).contains(cut));
        cuts.extend([0.0, 1.0]);
        cuts.sort_by(f64::total_cmp);
        // Between two intersections a path is entirely inside or outside.
        cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-9).all(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let at = |a: f64, b: f64| a + middle * (b - a);
            self.allows((at(from_m.0, to_m.0), at(from_m.1, to_m.1)))
        })
    }
}

impl Autopilot {
    /// Replaces the zones.
    pub fn set_fence(&mut self, zones: Vec<FenceZone>) {
        self.fence.zones = zones;
    }

    /// Enables or disables the geofence.
    pub(super) fn enable_fence(&mut self, on: bool) -> RequestOutcome {
        self.tuning.fence_enabled = on;
        self.push_event(Severity::Info, if on { "Geofence enabled" } else { "Geofence disabled" });
        RequestOutcome::Accepted
    }

    /// Returns the limit that a position would breach, or `None`.
    pub(super) fn breach_at(&self, place_m: Vec3<Ned>) -> Option<Breach> {
        let t = &self.tuning;
        if !self.is_active() {
            return None;
        }
        let home = self.status.home_m.unwrap_or_default();
        let from_home = place_m - home;
        let parts = t.rules.fence;
        if parts.height && t.fence_height_m > 0.0 && -from_home.down() > t.fence_height_m {
            return Some(Breach::Height);
        }
        let far = parts.distance && t.fence_distance_m > 0.0 && from_home.horizontal_norm() > t.fence_distance_m;
        (far || parts.areas && !self.fence.allows((place_m.north(), place_m.east()))).then_some(Breach::Boundary)
    }

    /// Returns the rejection of a target outside the fence, or `None` if it is allowed.
    pub(super) fn fence_refusal(&self, target_m: Vec3<Ned>) -> Option<RequestOutcome> {
        let here = self.estimate.position_m;
        if self.breach_at(target_m).is_some() || self.below_floor(target_m) {
            return Some(RequestOutcome::Denied("Target outside geofence".into()));
        }
        // A vehicle outside the fence may fly back in.
        let out = self.estimate.position_valid && self.breach_at(here).is_none() && self.leaves_between(here, target_m);
        out.then(|| RequestOutcome::Denied("Path to target leaves geofence".into()))
    }

    /// Returns true if a position is below the minimum fence height above home.
    fn below_floor(&self, place_m: Vec3<Ned>) -> bool {
        let home = self.status.home_m.unwrap_or_default();
        self.is_active() && self.tuning.rules.fence.floor_m.is_some_and(|floor_m| home.down() - place_m.down() < floor_m)
    }

    /// Returns the rejection of a circle that leaves the fence, or `None` if it is allowed.
    pub(super) fn ring_refusal(&self, centre_m: Vec3<Ned>, radius_m: f64) -> Option<RequestOutcome> {
        self.ring_leaves(centre_m, radius_m).then(|| RequestOutcome::Denied("Circle leaves geofence".into()))
    }

    /// Returns true if the straight path between two allowed positions leaves the fence.
    fn leaves_between(&self, from: Vec3<Ned>, to: Vec3<Ned>) -> bool {
        self.is_active()
            && self.tuning.rules.fence.areas
            && !self.fence.allows_path((from.north(), from.east()), (to.north(), to.east()))
    }

    fn ring_leaves(&self, centre_m: Vec3<Ned>, radius_m: f64) -> bool {
        let at = |k: usize| {
            let (s, c) = math::sin_cos(k as f64 * 2.0 * math::PI / RING_SIDES as f64);
            centre_m + Vec3::new(radius_m * c, radius_m * s, 0.0)
        };
        (0..RING_SIDES).any(|k| self.breach_at(at(k)).is_some() || self.leaves_between(at(k), at(k + 1)))
    }

    /// Returns the reason to reject the mission: the first item outside the fence, or with a straight path to it that leaves the
    /// fence.
    pub(super) fn mission_leaves_fence(&self) -> Option<String> {
        let flying = self.status.armed && self.status.landed != LandedState::OnGround;
        let home = self.status.home_m.unwrap_or_default();
        let start = if flying { self.estimate.position_m } else { home };
        let mut from = (self.mission.current == 0 && self.breach_at(start).is_none()).then_some(start);
        for (step, what) in self.mission.all() {
            let step = step + self.tuning.first_item;
            let outside = format!("Mission item {step} outside geofence");
            let to = match what {
                MissionStep::Waypoint { position_m, .. } | MissionStep::Land { position_m: Some(position_m) } => position_m,
                MissionStep::Circle { centre_m, radius_m, .. } if self.ring_leaves(centre_m, radius_m.abs()) => {
                    return Some(outside);
                }
                MissionStep::Circle { centre_m, .. } => centre_m,
                MissionStep::Takeoff { up_m } => {
                    let over = from.unwrap_or(home);
                    Vec3::new(over.north(), over.east(), -up_m.unwrap_or_else(|| self.default_takeoff_up_m()))
                }
                MissionStep::Land { position_m: None }
                | MissionStep::Return
                | MissionStep::Speed(_)
                | MissionStep::Delay(_)
                | MissionStep::DelayUntil(_)
                | MissionStep::Jump { .. }
                | MissionStep::LookAt(_)
                | MissionStep::Turn { .. }
                | MissionStep::Near(_)
                | MissionStep::Home(_)
                | MissionStep::Fence(_)
                | MissionStep::LandingSequence
                | MissionStep::Payload => continue,
            };
            if self.breach_at(to).is_some() {
                return Some(outside);
            }
            if from.is_some_and(|from| self.leaves_between(from, to)) {
                return Some(format!("Path to mission item {step} leaves geofence"));
            }
            from = Some(to);
        }
        let back = self.mission.left_at.filter(|_| flying && self.breach_at(self.estimate.position_m).is_none());
        let cut_off = back.is_some_and(|place| self.leaves_between(self.estimate.position_m, place));
        cut_off.then(|| "Return path to mission leaves geofence".into())
    }

    fn is_active(&self) -> bool {
        self.tuning.fence_enabled && self.tuning.fence_action != FenceAction::None
    }

    /// Updates whether any limit is active.
    pub(super) fn update_fence_state(&mut self) {
        let t = &self.tuning;
        let parts = t.rules.fence;
        let limits = parts.height && t.fence_height_m > 0.0 || parts.distance && t.fence_distance_m > 0.0;
        let areas = parts.areas && !self.fence.zones.is_empty();
        self.status.fence.set = self.is_active() && (limits || areas || parts.floor_m.is_some());
    }

    /// Applies the fence action when a breach begins. It acts once per breach so that the pilot can fly back in.
    pub(super) fn enforce_fence(&mut self, now: SimTime) {
        if !self.estimate.position_valid {
            return;
        }
        let here = self.estimate.position_m;
        // The minimum height applies once the vehicle has been above it, except while landing.
        let low = self.below_floor(here);
        self.failsafe.above_floor |= !low && self.is_active();
        let coming_down =
            matches!(self.status.mode, FlightMode::Land | FlightMode::Return) || self.status.landed == LandedState::Landing;
        self.failsafe.above_floor &= !(low && coming_down);
        let floor = (low && self.failsafe.above_floor && !coming_down).then_some(Breach::Floor);
        let breach = self.breach_at(here).or(floor);
        let before = std::mem::replace(&mut self.status.fence.breach, breach);
        match (before, breach) {
            (None, Some(breach)) => self.breached(breach, now),
            (Some(_), None) => self.push_event(Severity::Info, "Back inside geofence"),
            (None, None) | (Some(_), Some(_)) => {}
        }
    }

    fn breached(&mut self, breach: Breach, now: SimTime) {
        self.status.fence.count = self.status.fence.count.saturating_add(1);
        self.status.fence.at = now;
        let (consequence, mode) = match self.tuning.fence_action {
            FenceAction::None => return,
            FenceAction::Warning => ("", None),
            FenceAction::Hold => (", holding", Some(FlightMode::Hold)),
            FenceAction::Return => (", returning", Some(FlightMode::Return)),
            FenceAction::Land => (", landing", Some(FlightMode::Land)),
            FenceAction::Terminate => (", motors off", None),
        };
        let what = match breach {
            Breach::Floor => "too low",
            Breach::Height => "too high",
            Breach::Boundary => "out of bounds",
        };
        self.push_event(Severity::Critical, format!("Geofence breached: {what}{consequence}"));
        if self.tuning.fence_action == FenceAction::Terminate {
            self.disarm("Disarmed: geofence");
        } else if let Some(mode) = mode {
            self.status.fence.taken = self.status.fence.taken.saturating_add(1);
            self.failsafe.intended = mode;
            self.failsafe.overridden = false;
            self.enter(mode, now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> FenceOutline {
        FenceOutline::Polygon(vec![(-half, -half), (-half, half), (half, half), (half, -half)])
    }

    #[test]
    fn exact_areas_hold_what_lies_within() {
        let notched = FenceOutline::Polygon(vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 5.0), (0.0, 10.0)]);
        for (place, within) in
            [((2.0, 2.0), true), ((5.0, 4.0), true), ((5.0, 6.0), false), ((-1.0, 5.0), false), ((11.0, 1.0), false)]
        {
            assert_eq!(notched.holds(place), within, "{place:?}");
        }
        let circle = FenceOutline::Circle { centre_m: (3.0, 4.0), radius_m: 5.0 };
        assert!(circle.holds((0.0, 0.0)) && !circle.holds((-0.01, 0.0)));
    }

    #[test]
    fn exact_a_way_is_allowed_only_where_all_of_it_is() {
        let zone = |outline, inclusion| FenceZone { outline, inclusion };
        let circle = |n, radius_m| FenceOutline::Circle { centre_m: (n, 0.0), radius_m };
        let fence = Fence {
            // Two overlapping zones, a hole in one of them, and a separate third zone.
            zones: vec![
                zone(square(10.0), true),
                zone(circle(15.0, 8.0), true),
                zone(circle(60.0, 5.0), true),
                zone(circle(0.0, 2.0), false),
            ],
        };
        for (from, to, allowed) in [
            ((-5.0, 5.0), (5.0, 5.0), true),
            ((-5.0, 0.0), (5.0, 0.0), false),
            ((-5.0, 2.5), (20.0, 1.0), true),
            ((20.0, 0.0), (60.0, 0.0), false),
            ((9.0, 9.5), (15.0, 7.5), false),
            ((5.0, 5.0), (5.0, 5.0), true),
            ((0.0, 0.0), (0.0, 0.0), false),
        ] {
            assert_eq!(fence.allows_path(from, to), allowed, "{from:?} to {to:?}");
        }
        assert!(Fence::default().allows_path((0.0, 0.0), (1e6, 0.0)));
    }

    #[test]
    fn exact_flight_is_allowed_in_any_inclusion_and_in_no_exclusion() {
        let zone = |outline, inclusion| FenceZone { outline, inclusion };
        let circle = |n, radius_m| FenceOutline::Circle { centre_m: (n, 0.0), radius_m };
        let fence =
            Fence { zones: vec![zone(square(10.0), true), zone(circle(100.0, 5.0), true), zone(circle(0.0, 2.0), false)] };
        for (place, allowed) in [((5.0, 5.0), true), ((0.0, 0.0), false), ((50.0, 0.0), false), ((100.0, 0.0), true)] {
            assert_eq!(fence.allows(place), allowed, "{place:?}");
        }
        assert!(Fence::default().allows((1e6, 0.0)), "without areas there is no boundary");
    }
}
