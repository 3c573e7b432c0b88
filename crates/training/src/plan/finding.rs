//! Values of the rules' measures in a trainee's records.

use super::measure::{RuleMeasure, SessionMeasure, TaskMeasure};
use super::rules::PlanRule;
use crate::record::{Crashes, DefectRecord, SessionOutcome, SessionRecord, TaskRecord};
use spandrel_monitor::score::completion::TaskState;
use std::cmp::Ordering;

/// Minimum condition state of a severe missed defect: poor (AASHTO MBEI).
pub const MIN_SEVERE_CONDITION_STATE: u8 = 3;
/// A landing with less battery charge than this counts as late, % (docs/src/reference/assessment.md, "Certification").
pub const BATTERY_RESERVE_PCT: f64 = 20.0;
/// Points lost per minute beyond the time for full efficiency (TASBID).
const EFFICIENCY_LOSS_PER_MIN: f64 = 10.0;
/// Fraction of a path that the drone must fly, or pass within 8 m, for its task to count as attempted (estimate: less is a
/// transit that happens to pass by).
const MIN_PASSED_FRACTION: f64 = 0.4;
/// Fraction of a task's time off its path from which the height there says something about holding it (estimate: a few frames are
/// those in which the drone leaves).
const MIN_OFF_PATH_FRACTION: f64 = 0.1;
/// Minimum number of defects of a kind for a fraction of them to be meaningful (estimate: one missed defect is chance).
const MIN_DEFECTS: usize = 2;
/// Minimum number of pictures near a path for a fraction of them to be meaningful (estimate: a single one is chance).
const MIN_TASK_PICTURES: usize = 2;
/// Minimum time near a path for rates, changes, the lamp and the camera's direction there to be meaningful, s (estimate: in shorter tasks,
/// arriving and leaving determine them).
const MIN_NEAR_S: f64 = 20.0;
/// Minimum number of pictures for a fraction of them to be meaningful (estimate: of fewer, one is chance).
const MIN_PICTURES: usize = 4;

/// A measured value and its source flight.
#[derive(Clone, Copy)]
pub(super) struct Finding<'a> {
    pub rule: &'a PlanRule,
    pub value: f64,
    /// Task that the value belongs to; `None` for a session, or for several tasks.
    pub task: Option<&'a TaskRecord>,
    /// Number of tasks above the limit, and of all tasks with a value; (0, 0) for a session.
    pub tasks_over: (usize, usize),
    pub record: &'a SessionRecord,
}

impl Finding<'_> {
    /// Returns whether two findings may have a common cause: they are from the same session, and not from different
    /// tasks.
    pub(super) fn shares_scope_with(&self, other: &Self) -> bool {
        let tasks = self.task.zip(other.task);
        self.record.id == other.record.id && tasks.is_none_or(|(a, b)| a.id == b.id)
    }

    /// Returns the numbers of the tasks in which the value exceeds the limit; empty for a session.
    pub(super) fn tasks_over_limit(&self) -> Vec<u32> {
        let RuleMeasure::Task(measure) = self.rule.measure else { return Vec::new() };
        let is_over = |task: &&TaskRecord| task_value(self.rule, measure, task).is_some_and(|value| value > self.rule.limit);
        match self.task {
            Some(task) => vec![task.id],
            None => self.record.tasks.iter().filter(|task| fits(self.rule, task)).filter(is_over).map(|task| task.id).collect(),
        }
    }
}

/// Returns the values that a rule evaluates: for task rules, one per task from its latest flight that has a value; for
/// rules on several tasks and for session rules, the value from the latest session that has one.
pub(super) fn findings<'a>(rule: &'a PlanRule, records: &[&'a SessionRecord]) -> Vec<Finding<'a>> {
    match rule.measure {
        RuleMeasure::Task(measure) if rule.in_tasks > 1 => {
            let of = |record| in_several_tasks(rule, measure, record);
            records.iter().copied().rev().find_map(of).into_iter().collect()
        }
        RuleMeasure::Task(measure) => in_each_task(rule, measure, records),
        RuleMeasure::Session(measure) => {
            let of = |record: &'a SessionRecord| {
                let value = session_value(rule, measure, record)?;
                Some(Finding { rule, value, task: None, tasks_over: (0, 0), record })
            };
            records.iter().copied().rev().find_map(of).into_iter().collect()
        }
    }
}

fn fits(rule: &PlanRule, task: &TaskRecord) -> bool {
    rule.task.is_none_or(|kind| task.kind == kind)
}

/// Returns the value that `in_tasks` tasks of a session reach.
fn in_several_tasks<'a>(rule: &'a PlanRule, measure: TaskMeasure, record: &'a SessionRecord) -> Option<Finding<'a>> {
    let tasks = record.tasks.iter().filter(|task| fits(rule, task));
    let mut values: Vec<f64> = tasks.filter_map(|task| task_value(rule, measure, task)).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    let value = *values.get(rule.in_tasks - 1)?;
    let over = values.iter().filter(|value| **value > rule.limit).count();
    Some(Finding { rule, value, task: None, tasks_over: (over, values.len()), record })
}

/// Returns each task's value from its latest flight that has one. Tasks are matched by kind, and free tasks by name.
fn in_each_task<'a>(rule: &'a PlanRule, measure: TaskMeasure, records: &[&'a SessionRecord]) -> Vec<Finding<'a>> {
    let mut newest: Vec<Finding<'a>> = Vec::new();
    for record in records.iter().copied().rev() {
        for task in record.tasks.iter().filter(|task| fits(rule, task)) {
            let same = |seen: &Finding<'_>| {
                let matches = |other: &TaskRecord| other.kind == task.kind && (task.kind != "free" || other.name == task.name);
                // A session may contain two tasks of the same kind; both are evaluated.
                seen.record.id != record.id && seen.task.is_some_and(matches)
            };
            if newest.iter().any(same) {
                continue;
            }
            if let Some(value) = task_value(rule, measure, task) {
                newest.push(Finding { rule, value, task: Some(task), tasks_over: (1, 1), record });
            }
        }
    }
    newest
}

fn task_value(rule: &PlanRule, measure: TaskMeasure, task: &TaskRecord) -> Option<f64> {
    let technique = task.technique;
    let reached = match technique {
        Some(technique) => technique.passed.max(task.covered.unwrap_or(0.0)) >= MIN_PASSED_FRACTION,
        None => task.attempted,
    };
    let flown = (task.attempted && reached).then_some(());
    let near = technique.filter(|technique| reached && technique.near_s > 0.0);
    let lasting = near.filter(|near| near.near_s >= MIN_NEAR_S);
    let beside = technique.zip(task.covered).map(|(technique, covered)| (technique.passed - covered).max(0.0));
    let surplus = |error_m: Option<f64>, sign: f64| error_m.map(|error_m| (sign * error_m).max(0.0));
    match measure {
        TaskMeasure::OffPath => flown.map(|()| 1.0 - task.on_path),
        TaskMeasure::OffHeight => task.off_height_m.filter(|_| 1.0 - task.on_path > MIN_OFF_PATH_FRACTION),
        TaskMeasure::Speeding => flown.filter(|()| task.seconds > 0.0).map(|()| task.speeding_s / task.seconds),
        TaskMeasure::Crashes => Some(count(rule, task.contacts())),
        TaskMeasure::NotAttempted => Some(f64::from(u8::from(!reached))),
        TaskMeasure::NotCovered => {
            let covered = task.covered.filter(|_| reached)?;
            // Who hardly left the path passed the rest of it only on another side of it, such as that of the pier.
            let left_path = !task.attempted || 1.0 - task.on_path > MIN_OFF_PATH_FRACTION;
            Some((1.0 - covered - beside.filter(|_| left_path).unwrap_or(0.0)).max(0.0))
        }
        TaskMeasure::BesidePath => beside.filter(|_| reached),
        TaskMeasure::TooFar => surplus(near?.stand_off_error_m, 1.0),
        TaskMeasure::TooClose => surplus(near?.stand_off_error_m, -1.0),
        TaskMeasure::UnevenStandOff => lasting?.stand_off_spread_m,
        TaskMeasure::TooLow => surplus(near?.height_error_m, -1.0),
        TaskMeasure::TooHigh => surplus(near?.height_error_m, 1.0),
        TaskMeasure::UnevenHeight => lasting?.height_spread_m,
        TaskMeasure::LowClearance => near.map(|near| near.low_clearance),
        TaskMeasure::Framing => lasting?.rms_framing_deg,
        TaskMeasure::LampOff => lasting?.lamp_off,
        TaskMeasure::StickReversals => lasting.map(|near| near.stick_reversals_per_min),
        TaskMeasure::YawReversals => lasting.map(|near| near.yaw_reversals_per_min),
        TaskMeasure::StickJumps => lasting?.stick_jumps_per_min,
        TaskMeasure::UnlitPictures => near.filter(|near| near.pictures >= Some(MIN_TASK_PICTURES))?.unlit_pictures,
        TaskMeasure::MissedAtTask => {
            let searched = task.state == Some(TaskState::Done) && task.defects_placed >= MIN_DEFECTS;
            searched.then(|| 1.0 - task.defects_found as f64 / task.defects_placed as f64)
        }
    }
}

fn session_value(rule: &PlanRule, measure: SessionMeasure, record: &SessionRecord) -> Option<f64> {
    let yes = |is: bool| Some(f64::from(u8::from(is)));
    let has_pictures = record.snapshots >= MIN_PICTURES;
    let share = |part: usize, whole: usize| (whole > 0).then(|| part as f64 / whole as f64);
    let missed_of = |least: usize, about: fn(&DefectRecord) -> bool| {
        let (missed, all) = searched(record)
            .filter(|defect| about(defect))
            .fold((0, 0), |(missed, all), defect| (missed + usize::from(!defect.found), all + 1));
        if all >= least { share(missed, all) } else { None }
    };
    let has_reason = |reasons: &[String]| rule.lacked.is_empty() || reasons.iter().any(|text| text.starts_with(&rule.lacked));
    match measure {
        SessionMeasure::CrashesOutside => Some(count(rule, record.contacts_outside())),
        SessionMeasure::CrashesAll => Some(count(rule, record.contacts())),
        SessionMeasure::Missed => {
            // A picture of something else may show a defect by chance and fail for several reasons.
            let is_only_reason = |reasons: &[String]| rule.lacked.is_empty() || (reasons.len() == 1 && has_reason(reasons));
            let missed = searched(record).filter(|defect| !defect.found && is_only_reason(&defect.lacked)).count();
            share(missed, searched(record).count())
        }
        SessionMeasure::MissedSevere => Some(missed(rule, record).len() as f64),
        SessionMeasure::MissedInView => {
            let longest_s = missed(rule, record).iter().filter_map(|defect| defect.in_view_s).fold(0.0, f64::max);
            Some(longest_s)
        }
        SessionMeasure::MissedHidden => missed_of(MIN_DEFECTS, |defect| defect.hidden),
        SessionMeasure::MissedLines => missed_of(MIN_DEFECTS, |defect| defect.line),
        SessionMeasure::PoorPictures => {
            let found = searched(record).filter(|defect| defect.found);
            let poor = found.clone().filter(|defect| !defect.shortfalls.is_empty() && has_reason(&defect.shortfalls)).count();
            let all = found.count();
            if all >= MIN_DEFECTS { share(poor, all) } else { None }
        }
        SessionMeasure::NoPictures => searched(record).next().map(|_| f64::from(u8::from(record.snapshots == 0))),
        SessionMeasure::FalseSnapshots => {
            let has_defects = has_pictures && !record.defects.is_empty();
            has_defects.then(|| 1.0 - record.hits.min(record.snapshots) as f64 / record.snapshots as f64)
        }
        // An efficiency score of 0 to 100 corresponds to -100 to 100 points. After a battery failure, the points don't
        // reflect the time.
        SessionMeasure::Overtime => {
            let points = 2.0 * record.scores.efficiency - 100.0;
            (!record.battery_failed).then(|| (100.0 - points) / EFFICIENCY_LOSS_PER_MIN)
        }
        SessionMeasure::NotLanded => yes(record.end_reason != "landed"),
        SessionMeasure::BatteryLow => yes(record.battery_at_end_pct < BATTERY_RESERVE_PCT),
        SessionMeasure::BatteryFailed => yes(record.battery_failed),
        SessionMeasure::MovingPictures => record.technique?.moving_pictures.filter(|_| has_pictures),
        SessionMeasure::DriftingPictures => record.technique?.drifting_pictures.filter(|_| has_pictures),
        SessionMeasure::TurningPictures => record.technique?.turning_pictures.filter(|_| has_pictures),
        SessionMeasure::Landing => record.technique?.landing_s,
        SessionMeasure::Slow => {
            let ratio = record.certification.as_ref()?.time_ratio.filter(|_| record.is_complete())?;
            Some((ratio - 1.0).max(0.0))
        }
        SessionMeasure::Exposure => record.technique.map(|technique| technique.exposure_s),
    }
}

/// Returns the defects that the trainee had the opportunity to find: those at done tasks, or all in a complete session.
fn searched(record: &SessionRecord) -> impl Iterator<Item = &DefectRecord> + Clone {
    let is_done = |id: u32| record.tasks.iter().any(|task| task.id == id && task.state == Some(TaskState::Done));
    let all = record.is_complete() || record.completion.is_none();
    record.defects.iter().filter(move |defect| all || defect.task.is_none_or(is_done))
}

/// Returns the missed defects that a rule applies to (severe ones, or those clearly visible), most severe first.
pub(super) fn missed<'a>(rule: &PlanRule, record: &'a SessionRecord) -> Vec<&'a DefectRecord> {
    let in_view = rule.measure == RuleMeasure::Session(SessionMeasure::MissedInView);
    let about = |defect: &&DefectRecord| {
        if in_view {
            defect.in_view_s.is_some_and(|seconds| seconds > rule.limit)
        } else {
            defect.condition_state >= MIN_SEVERE_CONDITION_STATE
        }
    };
    let mut missed: Vec<&DefectRecord> = searched(record).filter(|defect| !defect.found).filter(about).collect();
    missed.sort_by(|a, b| {
        (b.condition_state, b.in_view_s.unwrap_or(0.0))
            .partial_cmp(&(a.condition_state, a.in_view_s.unwrap_or(0.0)))
            .unwrap_or(Ordering::Equal)
    });
    missed
}

fn count(rule: &PlanRule, crashes: Crashes) -> f64 {
    let counted = crashes.by_kind().into_iter().filter(|(kind, _)| rule.with.is_none_or(|with| with == *kind));
    counted.map(|(_, count)| count as f64).sum()
}
