//! Efficiency: flight time compared with the time that this job needs.

use serde::Serialize;
use spandrel_model::scenario::{Scenario, Task};

use crate::measures::coverage::PathCoverage;

/// The time that a flight needs and the time that it took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JobTime {
    /// Total length of the paths, m.
    pub path_length_m: f64,
    /// Number of defects for which time is allowed: those that the pictures show.
    pub defects: usize,
    /// Time that the flight needs: path length over the inspection speed, plus the times for transit and for each
    /// of these defects, s.
    pub needed_s: f64,
    /// Flight time, s.
    pub flown_s: f64,
    /// Flight time divided by the time needed.
    pub ratio: f64,
}

impl JobTime {
    /// Computes the time that a flight needs in which the pictures show `defects` defects.
    #[must_use]
    pub fn new(scenario: &Scenario, covered: &[PathCoverage], defects: usize, flown_s: f64) -> Self {
        let path_length_m = covered.iter().fold(0.0, |sum, path| sum + path.length_m);
        let needed_s = needed_s(scenario, path_length_m, defects);
        let ratio = if needed_s > 0.0 { flown_s / needed_s } else { 1.0 };
        Self { path_length_m, defects, needed_s, flown_s, ratio }
    }

    /// Returns the efficiency, 0 to 100: full up to the time needed, then falling linearly to 0 at `max_time_ratio`
    /// times that. 0 if the session is not complete.
    #[must_use]
    pub fn score(&self, scenario: &Scenario, complete: bool) -> f64 {
        let most = scenario.certification.max_time_ratio;
        if complete { (100.0 * (most - self.ratio) / (most - 1.0)).clamp(0.0, 100.0) } else { 0.0 }
    }
}

/// Returns the time in seconds that a job needs with all its defects.
#[must_use]
pub fn job_needed_s(scenario: &Scenario) -> f64 {
    let path_length_m = scenario.tasks.iter().map(Task::length_m).sum();
    needed_s(scenario, path_length_m, scenario.defects.number())
}

/// Returns the time in seconds that a job needs: path length over the inspection speed, plus the times
/// for transit and for each defect.
#[must_use]
pub fn needed_s(scenario: &Scenario, path_length_m: f64, defects: usize) -> f64 {
    let params = &scenario.certification;
    path_length_m / params.inspection_speed_m_s + params.transit_time_s + params.time_per_defect_s * defects as f64
}
