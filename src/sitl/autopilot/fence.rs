//! The geofence: where flight is allowed, and what its breach leads to.

use super::core::{Autopilot, Severity};
use super::{Mode, Outcome};
use crate::base::frames::{Ned, Vec3};
use crate::base::time::SimTime;

/// An area's outline, north and east about the origin, m.
#[derive(Debug, Clone, PartialEq)]
pub enum Outline {
    /// Corners in order; the last joins the first.
    Polygon(Vec<(f64, f64)>),
    /// A circle.
    Circle {
        /// Its middle.
        centre_m: (f64, f64),
        /// Its radius, m.
        radius_m: f64,
    },
}

impl Outline {
    /// Whether a place lies within.
    #[must_use]
    pub fn holds(&self, (n, e): (f64, f64)) -> bool {
        match self {
            Self::Circle { centre_m, radius_m } => {
                let (dn, de) = (n - centre_m.0, e - centre_m.1);
                dn * dn + de * de <= radius_m * radius_m
            }
            // A ray towards the east crosses the outline an odd number of times from within.
            Self::Polygon(corners) => {
                let last = corners.len().saturating_sub(1);
                let sides = corners.iter().enumerate().map(|(k, to)| (corners[if k == 0 { last } else { k - 1 }], *to));
                sides.filter(|(a, b)| (a.0 > n) != (b.0 > n) && e < (b.1 - a.1) * (n - a.0) / (b.0 - a.0) + a.1).count() % 2 == 1
            }
        }
    }
}

/// One area of a fence.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Where.
    pub outline: Outline,
    /// Flight is allowed within some inclusion, and within no exclusion.
    pub inclusion: bool,
}

/// What was breached, by the numbers of MAVLink's FENCE_BREACH.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breach {
    /// Too high over home (2).
    Height,
    /// Out of an area, or too far from home (3).
    Boundary,
}

/// What a breach leads to, by the numbers of PX4's `GF_ACTION`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FenceAction {
    /// Nothing (0).
    None,
    /// A text (1).
    Warning,
    /// Stop and hold (2).
    Hold,
    /// Return and land (3).
    Return,
    /// Motors off (4).
    Terminate,
    /// Land here (5).
    Land,
}

impl FenceAction {
    /// From the parameter's number.
    #[must_use]
    pub fn from_number(n: i32) -> Option<Self> {
        let all = [Self::None, Self::Warning, Self::Hold, Self::Return, Self::Terminate, Self::Land];
        all.get(usize::try_from(n).ok()?).copied()
    }
}

/// What the fence tells the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FenceState {
    /// There is something to breach.
    pub set: bool,
    /// The breach of now.
    pub breach: Option<Breach>,
    /// Breaches so far.
    pub count: u16,
    /// When the last one began.
    pub at: SimTime,
}

/// The areas.
#[derive(Debug, Clone, PartialEq)]
pub struct Fence {
    zones: Vec<Zone>,
    on: bool,
}

impl Default for Fence {
    fn default() -> Self {
        Self { zones: Vec::new(), on: true }
    }
}

impl Fence {
    /// Whether a place is within the areas.
    #[must_use]
    pub fn allows(&self, place_m: (f64, f64)) -> bool {
        let mut inclusions = self.zones.iter().filter(|zone| zone.inclusion).peekable();
        let within = inclusions.peek().is_none() || inclusions.any(|zone| zone.outline.holds(place_m));
        within && !self.zones.iter().any(|zone| !zone.inclusion && zone.outline.holds(place_m))
    }
}

impl Autopilot {
    /// Replaces the fence's areas.
    pub fn set_fence(&mut self, zones: Vec<Zone>) {
        self.fence.zones = zones;
    }

    /// Switches the fence on or off.
    pub(super) fn enable_fence(&mut self, on: bool) -> Outcome {
        self.fence.on = on;
        self.say(Severity::Info, if on { "Geofence on" } else { "Geofence off" });
        Outcome::Accepted
    }

    /// What a place breaches, if anything.
    pub(super) fn breach_at(&self, place_m: Vec3<Ned>) -> Option<Breach> {
        let t = &self.tuning;
        if !self.fence.on || t.fence_action == FenceAction::None {
            return None;
        }
        let home = self.status.home_m.unwrap_or_default();
        let from_home = place_m - home;
        if t.fence_height_m > 0.0 && -from_home.down() > t.fence_height_m {
            return Some(Breach::Height);
        }
        let far = t.fence_distance_m > 0.0 && from_home.horizontal_norm() > t.fence_distance_m;
        (far || !self.fence.allows((place_m.north(), place_m.east()))).then_some(Breach::Boundary)
    }

    /// Why a target is refused, if it is.
    pub(super) fn fence_refusal(&self, target_m: Vec3<Ned>) -> Option<Outcome> {
        self.breach_at(target_m).map(|_| Outcome::Denied("Target lies outside the geofence".into()))
    }

    /// The first step of the mission that lies outside.
    pub(super) fn step_outside_fence(&self) -> Option<usize> {
        self.mission.places().find(|(_, place)| self.breach_at(*place).is_some()).map(|(step, _)| step)
    }

    /// Whether there is a fence at all.
    pub(super) fn note_fence(&mut self) {
        let t = &self.tuning;
        let limits = t.fence_height_m > 0.0 || t.fence_distance_m > 0.0;
        let acts = self.fence.on && t.fence_action != FenceAction::None;
        self.status.fence.set = acts && (limits || !self.fence.zones.is_empty());
    }

    /// Acts when a breach begins: once, so that the pilot can fly back in by hand.
    pub(super) fn keep_fence(&mut self, now: SimTime) {
        if !self.estimate.position_valid {
            return;
        }
        let breach = self.breach_at(self.estimate.position_m);
        let before = std::mem::replace(&mut self.status.fence.breach, breach);
        match (before, breach) {
            (None, Some(breach)) => self.breached(breach, now),
            (Some(_), None) => self.say(Severity::Info, "Within the geofence again"),
            (None, None) | (Some(_), Some(_)) => {}
        }
    }

    fn breached(&mut self, breach: Breach, now: SimTime) {
        self.status.fence.count = self.status.fence.count.saturating_add(1);
        self.status.fence.at = now;
        let (consequence, mode) = match self.tuning.fence_action {
            FenceAction::None => return,
            FenceAction::Warning => ("", None),
            FenceAction::Hold => (", holding", Some(Mode::Hold)),
            FenceAction::Return => (", returning", Some(Mode::Return)),
            FenceAction::Land => (", landing", Some(Mode::Land)),
            FenceAction::Terminate => (", motors off", None),
        };
        let what = if breach == Breach::Height { "too high" } else { "out of bounds" };
        self.say(Severity::Critical, format!("Geofence breached: {what}{consequence}"));
        if self.tuning.fence_action == FenceAction::Terminate {
            self.disarm("Disarmed: geofence");
        } else if let Some(mode) = mode {
            self.watch.intended = mode;
            self.watch.overridden = false;
            self.enter(mode, now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Outline {
        Outline::Polygon(vec![(-half, -half), (-half, half), (half, half), (half, -half)])
    }

    #[test]
    fn exact_areas_hold_what_lies_within() {
        let notched = Outline::Polygon(vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 5.0), (0.0, 10.0)]);
        for (place, within) in
            [((2.0, 2.0), true), ((5.0, 4.0), true), ((5.0, 6.0), false), ((-1.0, 5.0), false), ((11.0, 1.0), false)]
        {
            assert_eq!(notched.holds(place), within, "{place:?}");
        }
        let circle = Outline::Circle { centre_m: (3.0, 4.0), radius_m: 5.0 };
        assert!(circle.holds((0.0, 0.0)) && !circle.holds((-0.01, 0.0)));
    }

    #[test]
    fn exact_flight_is_allowed_in_any_inclusion_and_in_no_exclusion() {
        let zone = |outline, inclusion| Zone { outline, inclusion };
        let circle = |n, radius_m| Outline::Circle { centre_m: (n, 0.0), radius_m };
        let fence = Fence {
            zones: vec![zone(square(10.0), true), zone(circle(100.0, 5.0), true), zone(circle(0.0, 2.0), false)],
            on: true,
        };
        for (place, allowed) in [((5.0, 5.0), true), ((0.0, 0.0), false), ((50.0, 0.0), false), ((100.0, 0.0), true)] {
            assert_eq!(fence.allows(place), allowed, "{place:?}");
        }
        assert!(Fence::default().allows((1e6, 0.0)), "without areas there is no boundary");
    }
}
