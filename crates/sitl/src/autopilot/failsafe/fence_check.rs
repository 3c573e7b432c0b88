//! Checks of positions and paths against the geofence, and the actions on a breach.

use super::fence::{Breach, Fence, FenceState};
use super::input::FailsafeInput;
use super::operator_rules::FenceAction;
use super::response::FailsafeRequest;
use crate::autopilot::events::{EventQueue, Severity};
use crate::autopilot::flight_state::{FlightMode, LandedState};
use crate::autopilot::tuning::Tuning;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;

/// Number of polygon sides used to check a circle.
const CIRCLE_POLYGON_SIDES: usize = 36;

/// The geofence with its settings and home.
#[derive(Debug, Clone, Copy)]
pub struct FenceCheck<'a> {
    fence: &'a Fence,
    tuning: &'a Tuning,
    home_m: Vec3<Ned>,
}

impl<'a> FenceCheck<'a> {
    /// Creates a check. If there is no home, the origin is used as home.
    #[must_use]
    pub fn new(fence: &'a Fence, tuning: &'a Tuning, home_m: Option<Vec3<Ned>>) -> Self {
        Self { fence, tuning, home_m: home_m.unwrap_or_default() }
    }

    fn is_active(&self) -> bool {
        self.tuning.fence_enabled && self.tuning.fence_action != FenceAction::None
    }

    /// Returns true if any limit is active.
    fn has_active_limits(&self) -> bool {
        let (t, parts) = (self.tuning, self.tuning.rules.fence);
        let limits = parts.height && t.fence_height_m > 0.0 || parts.distance && t.fence_distance_m > 0.0;
        let areas = parts.areas && !self.fence.is_empty();
        self.is_active() && (limits || areas || parts.floor_m.is_some())
    }

    /// Returns the limit that a position would breach, or `None`.
    #[must_use]
    pub fn breach_at(&self, position_m: Vec3<Ned>) -> Option<Breach> {
        let t = self.tuning;
        if !self.is_active() {
            return None;
        }
        let from_home = position_m - self.home_m;
        let parts = t.rules.fence;
        if parts.height && t.fence_height_m > 0.0 && -from_home.down() > t.fence_height_m {
            return Some(Breach::Height);
        }
        let far = parts.distance && t.fence_distance_m > 0.0 && from_home.horizontal_norm() > t.fence_distance_m;
        (far || parts.areas && !self.fence.allows((position_m.north(), position_m.east()))).then_some(Breach::Boundary)
    }

    /// Returns true if a position is below the minimum fence height above home.
    fn below_floor(&self, position_m: Vec3<Ned>) -> bool {
        let floor_m = self.tuning.rules.fence.floor_m;
        self.is_active() && floor_m.is_some_and(|floor_m| self.home_m.down() - position_m.down() < floor_m)
    }

    /// Returns true if the straight path between two allowed positions leaves the fence.
    #[must_use]
    pub fn path_leaves_fence(&self, from: Vec3<Ned>, to: Vec3<Ned>) -> bool {
        self.is_active()
            && self.tuning.rules.fence.areas
            && !self.fence.allows_path((from.north(), from.east()), (to.north(), to.east()))
    }

    /// Returns true if a circle leaves the fence.
    #[must_use]
    pub fn circle_leaves_fence(&self, center_m: Vec3<Ned>, radius_m: f64) -> bool {
        let at = |k: usize| {
            let (s, c) = math::sin_cos(k as f64 * 2.0 * math::PI / CIRCLE_POLYGON_SIDES as f64);
            center_m + Vec3::new(radius_m * c, radius_m * s, 0.0)
        };
        (0..CIRCLE_POLYGON_SIDES).any(|k| self.breach_at(at(k)).is_some() || self.path_leaves_fence(at(k), at(k + 1)))
    }

    /// Returns the reason to reject a target, or `None` if it is allowed. `from_m` is the vehicle position, if known.
    #[must_use]
    pub fn target_refusal(&self, from_m: Option<Vec3<Ned>>, target_m: Vec3<Ned>) -> Option<&'static str> {
        if self.breach_at(target_m).is_some() || self.below_floor(target_m) {
            return Some("Target outside geofence");
        }
        // A vehicle outside the fence is allowed to fly back in.
        let leaves = from_m.is_some_and(|from| self.breach_at(from).is_none() && self.path_leaves_fence(from, target_m));
        leaves.then_some("Path to target leaves geofence")
    }
}

/// State of the geofence failsafe.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FenceMonitor {
    /// State for telemetry.
    pub state: FenceState,
    /// Whether the vehicle has been above the minimum fence height in this flight.
    has_been_above_floor: bool,
}

impl FenceMonitor {
    /// Resets the monitor at the start of a flight.
    pub fn begin_flight(&mut self) {
        self.has_been_above_floor = false;
    }

    /// Updates the flag that shows whether any limit is active.
    pub fn update_active_limits(&mut self, fence: &FenceCheck) {
        self.state.set = fence.has_active_limits();
    }

    /// Returns the fence action request when a breach begins. The action triggers once per breach so that the pilot can
    /// fly back in.
    pub fn enforce(&mut self, fence: &FenceCheck, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        if !input.estimate.position_valid {
            return None;
        }
        let here = input.estimate.position_m;
        // The minimum height applies once the vehicle has been above it, except while landing.
        let low = fence.below_floor(here);
        self.has_been_above_floor |= !low && fence.is_active();
        let flight = &input.flight;
        let coming_down = matches!(flight.mode, FlightMode::Land | FlightMode::Return) || flight.landed == LandedState::Landing;
        self.has_been_above_floor &= !(low && coming_down);
        let floor = (low && self.has_been_above_floor && !coming_down).then_some(Breach::Floor);
        let breach = fence.breach_at(here).or(floor);
        let before = std::mem::replace(&mut self.state.breach, breach);
        match (before, breach) {
            (None, Some(breach)) => self.act(breach, input, events),
            (Some(_), None) => {
                events.push(Severity::Info, "Back inside geofence");
                None
            }
            (None, None) | (Some(_), Some(_)) => None,
        }
    }

    fn act(&mut self, breach: Breach, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        self.state.count = self.state.count.saturating_add(1);
        self.state.at = input.now;
        let (consequence, mode) = match input.tuning.fence_action {
            FenceAction::None => return None,
            FenceAction::Warning => ("", None),
            FenceAction::Hold => (", holding", Some(FlightMode::Hold)),
            FenceAction::Return => (", returning", Some(FlightMode::Return)),
            FenceAction::Land => (", landing", Some(FlightMode::Land)),
            FenceAction::Terminate => (", motors off", None),
        };
        let limit = match breach {
            Breach::Floor => "too low",
            Breach::Height => "too high",
            Breach::Boundary => "out of bounds",
        };
        events.push(Severity::Critical, format!("Geofence breached: {limit}{consequence}"));
        if input.tuning.fence_action == FenceAction::Terminate {
            return Some(FailsafeRequest::terminate("geofence"));
        }
        let mode = mode?;
        self.state.taken = self.state.taken.saturating_add(1);
        Some(FailsafeRequest::SetMode { mode, ends_override: true })
    }
}
