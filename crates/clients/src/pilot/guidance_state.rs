//! In-flight guidance state: the leg, its progress, stops, setbacks, and the defect being photographed.

use super::goals::FlightGoal;
use super::hold::Hold;
use super::setbacks::Setbacks;
use super::track::{LegProgress, TrackLeg};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::DefectView;
use spandrel_model::time::SimTime;

/// Phase of photographing a defect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PhotoPhase {
    /// Follows the path until the spot is near.
    Noticed,
    /// Flies to the spot.
    Approach,
    /// Frames the defect with the drone stopped.
    Settle { steady_since: Option<SimTime> },
    /// Looks at the picture that was taken.
    Review { pressed: SimTime, view: Option<DefectView> },
}

/// Direction of a look, relative to the surface straight ahead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LookDirection {
    Up,
    Down,
    Left,
    Right,
}

impl LookDirection {
    /// The order in which a pilot looks around: with the gimbal first, which needs no turning of the drone.
    pub(super) const ALL: [Self; 4] = [Self::Up, Self::Down, Self::Left, Self::Right];

    /// Returns the components to the right and up of a unit step in this direction.
    pub(super) fn components(self) -> (f64, f64) {
        match self {
            Self::Up => (0.0, 1.0),
            Self::Down => (0.0, -1.0),
            Self::Left => (-1.0, 0.0),
            Self::Right => (1.0, 0.0),
        }
    }
}

/// A noticed defect that is being photographed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhotoTarget {
    pub(super) defect: u32,
    pub(super) position_m: Vec3<Enu>,
    /// Position from which the pilot wants to photograph.
    pub(super) spot_m: Vec3<Enu>,
    /// Smallest distance to the spot so far, m.
    pub(super) nearest_m: f64,
    pub(super) since: SimTime,
    pub(super) phase: PhotoPhase,
    pub(super) shots: u32,
    /// Number of spots from which the picture did not seem good enough.
    pub(super) poor_spots: u32,
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
    /// Speed that the pilot chooses for the surroundings, m/s, and when to choose anew.
    pub(super) pace_m_s: f64,
    pub(super) pace_due: SimTime,
    /// Since when the aircraft has been off the task's path, and until when the pilot follows the cue about it.
    pub(super) off_path_since: Option<SimTime>,
    pub(super) cued_until: SimTime,
    /// Position along the leg of the next stop to look, m.
    pub(super) next_look_m: f64,
    /// Directions left to look in during the present stop.
    pub(super) looks: Vec<LookDirection>,
    /// Beginning, duration (s) and end of the present look.
    pub(super) look_since: SimTime,
    pub(super) look_duration_s: f64,
    pub(super) look_until: SimTime,
    /// Progress of holding position at the end of a very short path.
    pub(super) hold: Option<Hold>,
    pub(super) setbacks: Setbacks,
    /// Whether the aircraft was in contact in the previous step.
    pub(super) touching: bool,
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
            pace_m_s: 1.0,
            pace_due: SimTime::ZERO,
            off_path_since: None,
            cued_until: SimTime::ZERO,
            next_look_m: 0.0,
            looks: Vec::new(),
            look_since: SimTime::ZERO,
            look_duration_s: 0.0,
            look_until: SimTime::ZERO,
            hold: None,
            setbacks: Setbacks::default(),
            touching: false,
        }
    }

    /// Requests a route back to the leg after the aircraft has been repositioned.
    pub fn replan(&mut self) {
        self.needs_plan = true;
        self.target = None;
        self.looks.clear();
        self.look_until = SimTime::ZERO;
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
        self.next_look_m = 0.0;
        self.hold = None;
        self.needs_plan = false;
    }

    /// Moves the progress to the first point of the leg that is at least `distance_m` away from a place and lies behind it.
    /// Returns false if there is none.
    pub(super) fn leave_out(&mut self, place_m: Vec3<Enu>, distance_m: f64) -> bool {
        let Some((_, leg)) = &self.leg else { return false };
        let next = self.progress.next;
        let behind = (next..leg.points_m.len()).find(|k| (leg.points_m[*k] - place_m).norm() >= distance_m);
        if let Some(k) = behind {
            self.progress.next = k;
            self.needs_plan = true;
        }
        behind.is_some()
    }
}
