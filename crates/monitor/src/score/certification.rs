//! The certification profile, computed in addition to the four TASBID scores. It adds pass/fail requirements, counts
//! only the flown part of a path, and weights crashes by speed. The weights are this project's estimates.

use crate::measures::coverage::PathCoverage;
use crate::measures::crash::{self, Crash};
use crate::measures::on_path::{OnPath, ReferencePaths};
use crate::score::completion::{Completion, TaskState, describe_unfinished_task};
use crate::score::{Score, accuracy, conformity, efficiency};
use crate::session::{EndReason, Session};
use serde::Serialize;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::elements::Element;
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_model::scenario::{PlacedDefect, Scenario};
use std::collections::{BTreeMap, BTreeSet};

/// On-path intervals closer together than this count as one visit, s (docs/src/reference/assessment.md, "Certification").
const VISIT_MERGE_GAP_S: f64 = 10.0;
/// Contacts closer together than this count as one crash, s (docs/src/reference/assessment.md, "Certification").
const CRASH_MERGE_GAP_S: f64 = 1.0;
/// Minimum battery charge at landing, % (docs/src/reference/assessment.md, "Certification").
const MIN_LANDING_BATTERY_PCT: f64 = 20.0;
/// Minimum loss per crash, points (equal to TASBID's fixed loss per crash).
const MIN_CRASH_LOSS: f64 = 3.0;
/// Speed at which a crash costs twice the minimum loss, m/s (estimate). Energy increases with the square of the speed,
/// so at twice this speed the loss is five times the minimum.
const CRASH_REFERENCE_SPEED_M_S: f64 = 2.0;
/// Maximum loss per crash, points (estimate).
const MAX_CRASH_LOSS: f64 = 30.0;
/// Points lost per second below the minimum clearance (estimate: one minute costs as much as two minimum-loss crashes).
const LOW_CLEARANCE_LOSS_PER_S: f64 = 0.1;
/// Maximum loss for low clearance, points (estimate).
const MAX_LOW_CLEARANCE_LOSS: f64 = 50.0;

/// Certification results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Certification {
    /// Whether all requirements were met.
    pub passed: bool,
    /// Result of each requirement.
    pub gates: Requirements,
    /// Unmet requirements as text, each with its actual and required value.
    pub unmet: Vec<String>,
    /// Scores from 0 to 100. Conformity is absent if no path was entered; accuracy is absent if no defect was placed.
    pub scores: CertificationScores,
    /// Flags: `not_attempted:ID` for each task not attempted; `no_evidence` if no path was entered.
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
}

/// Certification requirements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Requirements {
    /// Whether every task is done and the session ended with a landing at home.
    pub session_complete: bool,
    /// Whether every task's path was entered.
    pub all_tasks_attempted: bool,
    /// Whether no person or vehicle was hit.
    pub no_person_or_vehicle_hit: bool,
    /// Whether the drone landed near the ground team.
    pub landed_at_home: bool,
    /// Whether the drone landed with a battery charge of at least 20%.
    pub battery_reserve: bool,
}

/// Certification profile scores, each from 0 to 100.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CertificationScores {
    /// Conformity, weighted by the coverage of the paths.
    pub conformity: Option<f64>,
    /// Efficiency; 0 if the session ended early or a task was skipped.
    pub efficiency: f64,
    /// Safety, based on contact speed and clearance.
    pub safety: f64,
    /// Detection accuracy. The kind of defect is not graded.
    pub accuracy: Option<f64>,
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
}

/// A crash. Contacts close together in time are merged into one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedCrash {
    /// Number of the first frame.
    pub frame: u32,
    /// Time since lift-off, s.
    pub t_s: f64,
    /// Most severe object hit.
    pub with: ContactKind,
    /// Maximum speed around the time of first contact, m/s.
    pub speed_m_s: f64,
    /// Points lost by this crash.
    pub loss: f64,
    /// Number of the task whose window contains the crash, if any.
    pub task: Option<u32>,
}

/// Number of defects found and placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct DetectionCounts {
    /// Number of defects found.
    pub found: usize,
    /// Number of defects placed in the scene.
    pub placed: usize,
}

/// Number of defects found and placed, by element, kind and condition state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detection {
    /// Always true: only detection is graded, because trainees cannot yet report a defect's kind and condition state.
    pub detection_only: bool,
    /// Counts by AASHTO MBEI element number.
    pub by_element: BTreeMap<Element, DetectionCounts>,
    /// Counts by AASHTO MBEI defect code.
    pub by_kind: BTreeMap<u32, DetectionCounts>,
    /// Counts by condition state, 1 to 4.
    pub by_condition_state: BTreeMap<u8, DetectionCounts>,
}

/// Inputs to the certification profile.
#[derive(Debug)]
pub struct CertificationInputs<'a> {
    /// The session's scenario.
    pub scenario: &'a Scenario,
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
    /// Counts for the accuracy score.
    pub counts: accuracy::DetectionTally,
    /// Defects placed in the session.
    pub defects: &'a [PlacedDefect],
    /// IDs of the defects found.
    pub found: &'a BTreeSet<u32>,
}

/// Evaluates a session against the certification profile.
#[must_use]
pub fn grade(inputs: &CertificationInputs<'_>) -> Certification {
    let scenario = inputs.scenario;
    let frames = &inputs.session.frames;
    let tasks = visits(inputs);
    let attempted: Vec<bool> = inputs.on_path.windows.iter().map(Option::is_some).collect();
    let crashes = merge_crashes(inputs);
    let exposure_s = low_clearance_time_s(inputs);
    let battery_at_end_pct = frames.last().map_or(0.0, |frame| frame.battery_pct);
    let gates = check_requirements(inputs, attempted.iter().all(|a| *a), battery_at_end_pct);
    let unmet = unmet(inputs, &gates, battery_at_end_pct);
    let none_entered = !attempted.is_empty() && attempted.iter().all(|a| !a);
    let whole = gates.landed_at_home && gates.all_tasks_attempted;
    let scores = CertificationScores {
        conformity: if none_entered { None } else { coverage_weighted_conformity(&tasks, scenario) },
        efficiency: if whole { tasbid_efficiency(inputs) } else { 0.0 },
        safety: safety(&gates, &crashes, exposure_s),
        accuracy: inputs.counts.score(scenario.scoring.beta).map(|score| score.pct),
    };
    Certification {
        passed: unmet.is_empty(),
        gates,
        unmet,
        scores,
        flags: flags(scenario, &attempted, none_entered),
        tasks,
        crash_onsets: inputs.crashes.len(),
        crashes,
        exposure_s,
        battery_at_end_pct,
        detection: detection(inputs),
    }
}

fn check_requirements(inputs: &CertificationInputs<'_>, all_tasks_attempted: bool, battery_pct: f64) -> Requirements {
    let landed = inputs.session.reason == EndReason::Landed;
    let traffic = |crash: &Crash| matches!(crash.with, ContactKind::Person | ContactKind::Vehicle);
    Requirements {
        session_complete: inputs.completion.complete,
        all_tasks_attempted,
        no_person_or_vehicle_hit: !inputs.crashes.iter().any(traffic),
        landed_at_home: landed,
        battery_reserve: landed && battery_pct >= MIN_LANDING_BATTERY_PCT,
    }
}

/// Returns the unmet requirements as text. Omits the battery reserve if the drone did not land.
fn unmet(inputs: &CertificationInputs<'_>, gates: &Requirements, battery_pct: f64) -> Vec<String> {
    let done_share = inputs.completion.done_share;
    let tasks = inputs.scenario.tasks.iter().zip(inputs.states).zip(inputs.covered);
    let mut unmet = Vec::new();
    if !gates.no_person_or_vehicle_hit {
        unmet.push("a person or vehicle was hit".to_owned());
    }
    unmet.extend(
        tasks.filter_map(|((task, state), covered)| describe_unfinished_task(task.id, *state, covered.share, done_share)),
    );
    if !gates.landed_at_home {
        unmet.push("not landed at home".to_owned());
    } else if !gates.battery_reserve {
        let reached = format_with_limit(battery_pct, MIN_LANDING_BATTERY_PCT, 0);
        unmet.push(format!("{reached}% battery at landing, {}% needed", format_limit(MIN_LANDING_BATTERY_PCT)));
    }
    unmet
}

fn flags(scenario: &Scenario, attempted: &[bool], none_entered: bool) -> Vec<String> {
    let skipped = scenario.tasks.iter().zip(attempted).filter(|(_, attempted)| !**attempted);
    let mut flags: Vec<String> = skipped.map(|(task, _)| format!("not_attempted:{}", task.id)).collect();
    if none_entered {
        flags.push("no_evidence".to_owned());
    }
    flags
}

fn tasbid_efficiency(inputs: &CertificationInputs<'_>) -> f64 {
    let scoring = &inputs.scenario.scoring;
    efficiency::score(inputs.session.seconds(scoring.frame_rate_hz), false, scoring.time_best_s, scoring.time_max_s).pct
}

/// Returns the visits to a task: on-path intervals, merged if they are less than `apart_frames` apart.
fn visit_ranges(on_path: &OnPath, task: usize, apart_frames: f64) -> Vec<(usize, usize)> {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for (i, _) in on_path.task.iter().enumerate().filter(|(_, on)| on.is_some_and(|(t, _)| t == task)) {
        match ranges.last_mut() {
            Some(last) if ((i - last.1) as f64) < apart_frames => last.1 = i,
            Some(_) | None => ranges.push((i, i)),
        }
    }
    ranges
}

fn visits(inputs: &CertificationInputs<'_>) -> Vec<TaskVisits> {
    let scenario = inputs.scenario;
    let apart = VISIT_MERGE_GAP_S * scenario.scoring.frame_rate_hz;
    let limit = scenario.scoring.speed_limit_m_s;
    let frames = &inputs.session.frames;
    let ranges: Vec<Vec<(usize, usize)>> =
        (0..scenario.tasks.len()).map(|task| visit_ranges(inputs.on_path, task, apart)).collect();
    let one = |(task, ranges): (usize, &Vec<(usize, usize)>)| {
        let count: usize = ranges.iter().map(|(first, last)| last - first + 1).sum();
        let on = inputs.on_path.task.iter().filter(|on| on.is_some_and(|(t, _)| t == task)).count();
        let inside = ranges.iter().flat_map(|(first, last)| &frames[*first..=*last]);
        let loss: f64 = inside.map(Frame::speed_m_s).filter(|v| *v > limit).map(|v| v / limit).sum();
        let per_frame = |sum: f64| if count == 0 { 0.0 } else { (sum + 0.0) / count as f64 };
        TaskVisits {
            id: scenario.tasks[task].id,
            visits: ranges.iter().map(|(first, last)| (frames[*first].index, frames[*last].index)).collect(),
            coverage: inputs.covered[task].share,
            on_path: per_frame(on as f64),
            speeding: per_frame(loss),
        }
    };
    ranges.iter().enumerate().map(one).collect()
}

fn coverage_weighted_conformity(tasks: &[TaskVisits], scenario: &Scenario) -> Option<f64> {
    let shares: Vec<conformity::TaskShares> = tasks
        .iter()
        .map(|task| conformity::TaskShares { on_path: task.coverage * task.on_path, speeding: task.speeding })
        .collect();
    conformity::score(&shares, scenario.scoring.speed_limit_m_s, scenario.scoring.max_speed_m_s).map(|score| score.pct)
}

fn crash_loss(speed_m_s: f64) -> f64 {
    let ratio = speed_m_s / CRASH_REFERENCE_SPEED_M_S;
    (MIN_CRASH_LOSS * (1.0 + ratio * ratio)).min(MAX_CRASH_LOSS)
}

fn merge_crashes(inputs: &CertificationInputs<'_>) -> Vec<MergedCrash> {
    let rate = inputs.scenario.scoring.frame_rate_hz;
    crash::merge_crashes(inputs.crashes, CRASH_MERGE_GAP_S * rate)
        .iter()
        .map(|crash| MergedCrash {
            frame: inputs.session.frames[crash.frame].index,
            t_s: crash.frame as f64 / rate,
            with: crash.with,
            speed_m_s: crash.speed_m_s,
            loss: crash_loss(crash.speed_m_s),
            task: crash.task.map(|task| inputs.scenario.tasks[task].id),
        })
        .collect()
}

/// Returns the time spent below the minimum clearance in seconds. The limit is the scenario's or, if lower, that of the
/// last task entered, as for the too-close cue.
fn low_clearance_time_s(inputs: &CertificationInputs<'_>) -> f64 {
    let scenario = inputs.scenario;
    let mut current: Option<usize> = None;
    let mut frames = 0usize;
    for (frame, on) in inputs.session.frames.iter().zip(&inputs.on_path.task) {
        current = on.map(|(task, _)| task).or(current);
        let own = current.and_then(|task| scenario.tasks[task].too_close_m);
        let limit = own.unwrap_or(f64::INFINITY).min(scenario.scoring.clearance_m);
        let home = (frame.position_m - scenario.ground_team.pad_m).horizontal_norm() <= scenario.ground_team.home_radius_m;
        let close = frame.clearance_m.is_some_and(|clearance| clearance < limit);
        frames += usize::from(close && !home && !frame.missing);
    }
    frames as f64 / scenario.scoring.frame_rate_hz
}

fn safety(gates: &Requirements, crashes: &[MergedCrash], exposure_s: f64) -> f64 {
    if !gates.no_person_or_vehicle_hit {
        return 0.0;
    }
    let crashes: f64 = crashes.iter().map(|crash| crash.loss).sum();
    let closeness = (LOW_CLEARANCE_LOSS_PER_S * exposure_s).min(MAX_LOW_CLEARANCE_LOSS);
    Score::clamped_to_scale(-crashes - closeness, -100.0, 0.0).pct
}

fn detection(inputs: &CertificationInputs<'_>) -> Detection {
    let mut detection = Detection {
        detection_only: true,
        by_element: BTreeMap::new(),
        by_kind: BTreeMap::new(),
        by_condition_state: BTreeMap::new(),
    };
    for defect in inputs.defects {
        let found = usize::from(inputs.found.contains(&defect.id));
        let add = |entry: &mut DetectionCounts| {
            entry.placed += 1;
            entry.found += found;
        };
        add(detection.by_element.entry(defect.element).or_default());
        add(detection.by_kind.entry(defect.kind).or_default());
        add(detection.by_condition_state.entry(defect.condition_state).or_default());
    }
    detection
}
