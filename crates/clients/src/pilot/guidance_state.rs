//! In-flight guidance state: the leg, its progress, and the defect being photographed.

use super::goals::FlightGoal;
use super::track::{LegProgress, TrackLeg};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;

/// A noticed defect that is being photographed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhotoTarget {
    pub(super) defect: u32,
    pub(super) position_m: Vec3<Enu>,
    pub(super) normal: Vec3<Enu>,
    pub(super) since: SimTime,
    pub(super) triggered: Option<SimTime>,
    pub(super) attempts: u32,
    /// The pilot's judgment error for this defect, as a multiple of a trained pilot's standard deviation.
    pub(super) judgment_error: f64,
}

/// In-flight guidance state.
#[derive(Debug, Clone, PartialEq)]
pub struct Guidance {
    pub(super) leg: Option<(FlightGoal, TrackLeg)>,
    pub(super) progress: LegProgress,
    pub(super) best_along_m: f64,
    pub(super) best_since: SimTime,
    pub(super) back_off_until: SimTime,
    pub(super) needs_plan: bool,
    pub(super) target: Option<PhotoTarget>,
    pub(super) distractor_trigger: Option<SimTime>,
}

impl Guidance {
    /// Creates the state before the first leg.
    #[must_use]
    pub fn new() -> Self {
        Self {
            leg: None,
            progress: LegProgress::default(),
            best_along_m: 0.0,
            best_since: SimTime::ZERO,
            back_off_until: SimTime::ZERO,
            needs_plan: false,
            target: None,
            distractor_trigger: None,
        }
    }

    /// Requests a route back to the leg after the aircraft has been repositioned.
    pub fn replan(&mut self) {
        self.needs_plan = true;
        self.target = None;
    }

    /// Returns the index of the active task, if any.
    #[must_use]
    pub fn task(&self) -> Option<usize> {
        let (_, leg) = self.leg.as_ref()?;
        leg.task.get(self.progress.next).copied().flatten()
    }

    pub(super) fn begin_leg(&mut self, leg: TrackLeg, job: FlightGoal, now: SimTime) {
        self.leg = Some((job, leg));
        self.progress = LegProgress { next: 1, along_m: 0.0 };
        self.best_along_m = 0.0;
        self.best_since = now;
        self.needs_plan = false;
    }
}
