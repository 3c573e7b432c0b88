//! The certification profile, computed in addition to the four TASBID scores. It decides whether a flight meets the
//! scenario's requirements. docs/src/reference/assessment.md, "Certification", contains all formulas; the weights are
//! this project's estimates.

pub mod contacts;
pub mod inputs;
pub mod job_time;
pub mod names;
pub mod pictures;
pub mod precision;
pub mod requirements;
pub mod visits;

use crate::measures::attention;
use contacts::MergedCrash;
use inputs::CertificationInputs;
use job_time::JobTime;
use pictures::{Accuracy, Detection};
use precision::{PrecisionMeasures, PrecisionSums};
use requirements::{Reached, Requirement, Requirements};
use serde::{Deserialize, Serialize};
use visits::{TaskConformity, VisitRanges};

/// Certification results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Certification {
    /// Whether all requirements were met.
    pub passed: bool,
    /// Requirements without numbers.
    pub gates: Requirements,
    /// Unmet requirements as text, each with its actual and required value.
    pub unmet: Vec<String>,
    /// Scores from 0 to 100. Conformity and precision are absent if no path was entered; accuracy is absent if no defect
    /// is gradable.
    pub scores: CertificationScores,
    /// Flags: `not_attempted:ID` for each task not attempted, `not_inspected:ID` for each task of which too little was
    /// flown, `no_evidence` if no path was entered.
    pub flags: Vec<String>,
    /// Per-task results, based on visits.
    pub tasks: Vec<TaskVisits>,
    /// Crashes, merged if they are less than a second apart.
    pub crashes: Vec<MergedCrash>,
    /// Number of contacts before merging.
    pub crash_onsets: usize,
    /// Time spent below the scenario's minimum clearance, s.
    pub exposure_s: f64,
    /// Battery charge in the last frame, %.
    pub battery_at_end_pct: f64,
    /// Defects found and placed, by element, kind and condition state.
    pub detection: Detection,
    /// Every requirement with its limit and the value reached.
    pub requirements: Vec<Requirement>,
    /// Precision measures over the visits to all tasks; absent if no path was entered.
    pub precision: Option<PrecisionMeasures>,
    /// Pictures and defects, graded by image quality.
    pub accuracy: Accuracy,
    /// Flight time and the time that the job needs.
    pub time: JobTime,
}

/// Certification profile scores, each from 0 to 100.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CertificationScores {
    /// Conformity, weighted by the coverage of the paths.
    pub conformity: Option<f64>,
    /// Efficiency, compared with the time that the job needs; 0 if the session is incomplete.
    pub efficiency: f64,
    /// Safety, based on contact speed and clearance.
    pub safety: f64,
    /// Detection accuracy, based on pictures of sufficient quality. The kind of defect is not graded.
    pub accuracy: Option<f64>,
    /// Precision of path, speed, camera direction and clearance.
    pub precision: Option<f64>,
    /// Sum of the scores. A score without evidence adds nothing.
    pub sum: f64,
    /// Maximum possible sum: 100 per score that applies to the job.
    pub sum_max: f64,
}

/// Visits to one task, with results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskVisits {
    /// Task number in the scenario.
    pub id: u32,
    /// First and last frame of each visit.
    pub visits: Vec<(u32, u32)>,
    /// Fraction of the reference path that was flown, 0 to 1.
    pub coverage: f64,
    /// Fraction of the visits' frames that are on the path, 0 to 1.
    pub on_path: f64,
    /// TASBID speeding loss, computed over the frames in the visits.
    pub speeding: f64,
    /// Number of frames in the visits.
    pub frames: usize,
    /// Whether enough of the path was flown to count as inspected.
    pub inspected: bool,
    /// Precision measures over the visits; absent if the path was not entered.
    pub precision: Option<PrecisionMeasures>,
}

/// Evaluates a session against the certification profile.
#[must_use]
pub fn grade(inputs: &CertificationInputs<'_>) -> Certification {
    let frames = &inputs.session.frames;
    let rate = inputs.frame_rate_hz();
    let count = inputs.scenario.tasks.len();
    let visits: Vec<VisitRanges> = (0..count).map(|task| VisitRanges::of_task(inputs.on_path, task, rate)).collect();
    let shares: Vec<TaskConformity> =
        visits.iter().enumerate().map(|(task, visits)| TaskConformity::measure(inputs, task, visits)).collect();
    let sums: Vec<PrecisionSums> =
        visits.iter().enumerate().map(|(task, visits)| PrecisionSums::of_task(inputs, task, visits)).collect();
    let precision = sums.iter().fold(PrecisionSums::default(), |sum, task| sum.combined_with(*task)).measures();
    let accuracy = Accuracy::grade(inputs);
    let crashes = contacts::merge(inputs);
    let exposure_s = contacts::exposure_s(inputs);
    let battery_at_end_pct = frames.last().map_or(0.0, |frame| frame.battery_pct);
    let gates = requirements::gates(inputs, battery_at_end_pct);
    let found = attention::found_defects(inputs.pictures).len();
    let time = JobTime::new(inputs.scenario, inputs.covered, found, inputs.session.seconds(rate));
    let scores = CertificationScores {
        conformity: visits::conformity(inputs, &shares),
        efficiency: time.score(inputs.scenario, inputs.completion.complete),
        safety: contacts::safety(!gates.no_person_or_vehicle_hit, &crashes, exposure_s),
        accuracy: accuracy.score(inputs.scenario.scoring.beta),
        precision: precision.map(|measures| measures.score()),
        sum: 0.0,
        sum_max: 0.0,
    }
    .with_sum();
    let reached = Reached {
        battery_pct: battery_at_end_pct,
        crashes: &crashes,
        conformity: scores.conformity,
        precision: scores.precision,
        safety: scores.safety,
        accuracy: scores.accuracy,
    };
    let requirements = requirements::requirements(inputs, &reached);
    Certification {
        passed: requirements.iter().all(|requirement| requirement.met),
        gates,
        unmet: requirements::unmet(inputs, &requirements),
        scores,
        flags: flags(inputs, &shares),
        tasks: tasks(inputs, &visits, &shares, &sums),
        crash_onsets: inputs.crashes.len(),
        crashes,
        exposure_s,
        battery_at_end_pct,
        detection: pictures::detection(inputs),
        requirements,
        precision,
        accuracy,
        time,
    }
}

impl CertificationScores {
    fn with_sum(self) -> Self {
        let scores = [self.conformity, self.precision, Some(self.safety), self.accuracy, Some(self.efficiency)];
        let sum_max = if self.accuracy.is_some() { 500.0 } else { 400.0 };
        Self { sum: scores.iter().flatten().fold(0.0, |sum, score| sum + score), sum_max, ..self }
    }
}

fn tasks(
    inputs: &CertificationInputs<'_>,
    visits: &[VisitRanges],
    shares: &[TaskConformity],
    sums: &[PrecisionSums],
) -> Vec<TaskVisits> {
    let frames = &inputs.session.frames;
    let one = |(t, task): (usize, &spandrel_model::scenario::Task)| TaskVisits {
        id: task.id,
        visits: visits[t].0.iter().map(|visit| (frames[*visit.start()].index, frames[*visit.end()].index)).collect(),
        coverage: inputs.covered[t].share,
        on_path: shares[t].on_path,
        speeding: shares[t].speeding,
        frames: shares[t].frames,
        inspected: shares[t].inspected,
        precision: sums[t].measures(),
    };
    inputs.scenario.tasks.iter().enumerate().map(one).collect()
}

fn flags(inputs: &CertificationInputs<'_>, shares: &[TaskConformity]) -> Vec<String> {
    let tasks = || inputs.scenario.tasks.iter().zip(shares);
    let skipped = tasks().filter(|(_, share)| share.frames == 0).map(|(task, _)| format!("not_attempted:{}", task.id));
    let hardly = tasks().filter(|(_, share)| share.frames > 0 && !share.inspected);
    let mut flags: Vec<String> = skipped.chain(hardly.map(|(task, _)| format!("not_inspected:{}", task.id))).collect();
    if !shares.is_empty() && shares.iter().all(|share| share.frames == 0) {
        flags.push("no_evidence".to_owned());
    }
    flags
}
