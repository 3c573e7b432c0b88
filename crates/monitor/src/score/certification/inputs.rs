//! Inputs to the certification profile.

use crate::measures::attention::Snapshot;
use crate::measures::coverage::PathCoverage;
use crate::measures::crash::Crash;
use crate::measures::on_path::{OnPath, ReferencePaths};
use crate::measures::practice_aids::PracticeAids;
use crate::score::completion::{Completion, TaskState};
use crate::session::Session;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::scenario::{PlacedDefect, Scenario, Task};
use spandrel_model::vehicle::Vehicle;

/// Inputs to the certification profile.
#[derive(Debug)]
pub struct CertificationInputs<'a> {
    /// The session's scenario.
    pub scenario: &'a Scenario,
    /// Aircraft flown in the session.
    pub vehicle: &'a Vehicle,
    /// Telemetry of the flight.
    pub flight: &'a Flight,
    /// Reference paths of the scenario's tasks.
    pub paths: &'a ReferencePaths,
    /// Session to evaluate.
    pub session: &'a Session,
    /// On-path state of each session frame.
    pub on_path: &'a OnPath,
    /// Path coverage of each task, in task order.
    pub covered: &'a [PathCoverage],
    /// Each task's state, in task order.
    pub states: &'a [TaskState],
    /// Session completion.
    pub completion: Completion,
    /// Crashes before merging.
    pub crashes: &'a [Crash],
    /// Evaluation of each picture.
    pub pictures: &'a [Snapshot],
    /// Defects placed in the session.
    pub defects: &'a [PlacedDefect],
    /// Freezes and rewinds.
    pub practice_aids: PracticeAids,
}

impl CertificationInputs<'_> {
    /// Returns the scoring frame rate f, Hz.
    #[must_use]
    pub fn frame_rate_hz(&self) -> f64 {
        self.scenario.scoring.frame_rate_hz
    }

    /// Returns the minimum clearance in meters while `task` is the last task entered: the scenario's or, if lower, the
    /// task's own, as for the too-close cue.
    #[must_use]
    pub fn clearance_limit_m(&self, task: Option<&Task>) -> f64 {
        task.and_then(|task| task.too_close_m).unwrap_or(f64::INFINITY).min(self.scenario.scoring.clearance_m)
    }

    /// Returns whether the drone is closer to a surface than `limit_m`, outside the home radius. False in a telemetry gap.
    #[must_use]
    pub fn is_too_close(&self, frame: &Frame, limit_m: f64) -> bool {
        let team = &self.scenario.ground_team;
        let home = (frame.position_m - team.pad_m).horizontal_norm() <= team.home_radius_m;
        frame.clearance_m.is_some_and(|clearance| clearance < limit_m) && !home && !frame.missing
    }
}
