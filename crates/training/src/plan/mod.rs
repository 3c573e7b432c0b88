//! The training plan: recommends which scenarios to fly next, when and why, based on scores and their causes. It also
//! reports changes since the previous session. The rules come from a data file.

mod changes;
mod rules;

pub use changes::{MeasureChange, SessionChanges};
pub use rules::{DEFAULT_RULES, PlanRule, PlanRules, RuleMeasure, read_rules};

use super::record::{Crashes, DefectRecord, IncompletePolicy, SessionOutcome, SessionRecord, TaskRecord};
use serde::Serialize;
use spandrel_model::numbers::format_with_limit;
use std::cmp::Ordering;

/// Minimum condition state of a severe missed defect: poor (AASHTO MBEI).
const MIN_SEVERE_CONDITION_STATE: u8 = 3;
/// Maximum number of missed defects named in a reason.
const MAX_DEFECTS_LISTED: usize = 3;
/// Length of a day, µs.
const DAY_US: f64 = 86_400e6;
/// A landing with less battery charge than this counts as late, % (docs/src/reference/assessment.md, "Certification").
const BATTERY_RESERVE_PCT: f64 = 20.0;
/// Points lost per minute beyond the time for full efficiency (TASBID).
const EFFICIENCY_LOSS_PER_MIN: f64 = 10.0;
/// Factor by which one direction must exceed the other for a deviation to be described by that direction alone.
const DOMINANCE_RATIO: f64 = 2.0;

/// Scenarios recommended for one trainee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrainingPlan {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// ID of the latest session, the basis of the plan.
    pub session: String,
    /// Scenarios to fly, most urgent first; never empty.
    pub steps: Vec<PlanStep>,
    /// Earliest time of the next session, µs since the Unix epoch.
    pub from_unix_us: u64,
    /// Latest time of the next session, µs since the Unix epoch.
    pub until_unix_us: u64,
    /// Whether more time has passed since the last flight than the retention period allows.
    pub overdue: bool,
    /// Changes since the previous session on the same job, if there is one.
    pub changes: Option<SessionChanges>,
    /// Number of incomplete sessions excluded from the plan.
    pub left_out: usize,
}

/// One scenario to fly.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanStep {
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Sum of weight × value / limit over all rules that recommend this scenario.
    pub urgency: f64,
    /// Reasons, most urgent first.
    pub reasons: Vec<PlanReason>,
}

/// Reason to fly a scenario, as determined by one rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanReason {
    /// Name of the rule that fired.
    pub rule: String,
    /// ID of the session in which the value was measured.
    pub session: String,
    /// Reason shown to the trainee.
    pub words: String,
    /// Measured value. Fractions range from 0 to 1.
    pub value: f64,
    /// Limit that the value must exceed for the rule to fire.
    pub limit: f64,
}

/// A measured value and its source flight.
struct Finding<'a> {
    value: f64,
    task: Option<&'a TaskRecord>,
    record: &'a SessionRecord,
}

/// Creates a plan from one trainee's records in chronological order; `None` if there are no records.
#[must_use]
pub fn plan(records: &[SessionRecord], rules: &PlanRules, now_unix_us: u64) -> Option<TrainingPlan> {
    let last = records.last()?;
    let mut found: Vec<(f64, &PlanRule, Finding<'_>)> = Vec::new();
    for rule in &rules.rules {
        let over = findings(rule, records).into_iter().filter(|finding| finding.value > rule.limit);
        found.extend(over.map(|finding| (rule.weight * finding.value / rule.limit, rule, finding)));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut steps: Vec<PlanStep> = Vec::new();
    for (urgency, rule, finding) in &found {
        add(&mut steps, &rule.scenario, *urgency, reason(rule, finding));
    }
    steps.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    steps.truncate(rules.steps);
    let days = now_unix_us.saturating_sub(last.started_unix_us) as f64 / DAY_US;
    let overdue = days > rules.retention_days;
    if overdue {
        let words = rules.retention_reason.replace("{value}", &format!("{days:.0}"));
        steps.insert(0, single_reason_step(&rules.retention_scenario, last, ("retention", words), (days, rules.retention_days)));
    } else if steps.is_empty() {
        steps.push(single_reason_step(&rules.job, last, ("job", rules.job_reason.clone()), (0.0, 0.0)));
    }
    let after = |days: f64| last.started_unix_us.saturating_add((days * DAY_US) as u64);
    Some(TrainingPlan {
        trainee: last.trainee.clone(),
        session: last.id.clone(),
        steps,
        from_unix_us: after(rules.rest_days),
        until_unix_us: after(rules.retention_days),
        overdue,
        changes: changes::changes(records),
        left_out: 0,
    })
}

/// Creates a plan from the sessions that the policy allows. If there are none, recommends the job.
#[must_use]
pub fn plan_for_policy(
    mut records: Vec<SessionRecord>,
    incomplete: IncompletePolicy,
    rules: &PlanRules,
    now_unix_us: u64,
) -> Option<TrainingPlan> {
    let newest = records.last()?.clone();
    let all = records.len();
    records.retain(|record| incomplete.counts(record));
    let left_out = all - records.len();
    if let Some(plan) = plan(&records, rules, now_unix_us) {
        return Some(TrainingPlan { left_out, ..plan });
    }
    let words = format!("No complete session yet. Latest session: {}.", newest.completion_summary());
    let steps = vec![single_reason_step(&rules.job, &newest, ("job", words), (0.0, 0.0))];
    let after = |days: f64| newest.started_unix_us.saturating_add((days * DAY_US) as u64);
    let (trainee, session) = (newest.trainee.clone(), newest.id.clone());
    let (from_unix_us, until_unix_us) = (newest.started_unix_us, after(rules.retention_days));
    Some(TrainingPlan { trainee, session, steps, from_unix_us, until_unix_us, overdue: false, changes: None, left_out })
}

fn add(steps: &mut Vec<PlanStep>, scenario: &str, urgency: f64, reason: PlanReason) {
    match steps.iter_mut().find(|step| step.scenario == scenario) {
        Some(step) => {
            step.urgency += urgency;
            step.reasons.push(reason);
        }
        None => steps.push(PlanStep { scenario: scenario.to_owned(), urgency, reasons: vec![reason] }),
    }
}

fn single_reason_step(
    scenario: &str,
    record: &SessionRecord,
    (rule, words): (&str, String),
    (value, limit): (f64, f64),
) -> PlanStep {
    let reason = PlanReason { rule: rule.to_owned(), session: record.id.clone(), words, value, limit };
    PlanStep { scenario: scenario.to_owned(), urgency: 0.0, reasons: vec![reason] }
}

/// Returns the values that a rule evaluates: for task rules, one per task from its latest flight; for session rules,
/// the value from the latest session that has one.
fn findings<'a>(rule: &PlanRule, records: &'a [SessionRecord]) -> Vec<Finding<'a>> {
    match rule.measure {
        RuleMeasure::OffPath
        | RuleMeasure::OffHeight
        | RuleMeasure::Speeding
        | RuleMeasure::Crashes
        | RuleMeasure::NotAttempted => {
            let fits = |task: &&TaskRecord| rule.task.is_none_or(|kind| task.kind == kind);
            let newest = latest_flights_by_task(records).into_iter().filter(|(_, task)| fits(task));
            let of = |(record, task)| Some(Finding { value: task_value(rule, task)?, task: Some(task), record });
            newest.filter_map(of).collect()
        }
        RuleMeasure::CrashesOutside
        | RuleMeasure::CrashesAll
        | RuleMeasure::Missed
        | RuleMeasure::MissedSevere
        | RuleMeasure::MissedInView
        | RuleMeasure::FalseSnapshots
        | RuleMeasure::Overtime
        | RuleMeasure::NotLanded
        | RuleMeasure::BatteryLow => {
            let of = |record| Some(Finding { value: session_value(rule, record)?, task: None, record });
            records.iter().rev().find_map(of).into_iter().collect()
        }
    }
}

/// Returns each task's latest flight. Tasks are matched by kind, and free tasks by name.
fn latest_flights_by_task(records: &[SessionRecord]) -> Vec<(&SessionRecord, &TaskRecord)> {
    let mut newest: Vec<(&SessionRecord, &TaskRecord)> = Vec::new();
    for (record, task) in records.iter().rev().flat_map(|record| record.tasks.iter().map(move |task| (record, task))) {
        let same = |(_, other): &(&SessionRecord, &TaskRecord)| {
            other.kind == task.kind && (task.kind != "free" || other.name == task.name)
        };
        // A session may contain two tasks of the same kind; both are evaluated.
        if !newest.iter().any(|seen| same(seen) && seen.0.id != record.id) {
            newest.push((record, task));
        }
    }
    newest
}

fn task_value(rule: &PlanRule, task: &TaskRecord) -> Option<f64> {
    let flown = task.attempted.then_some(());
    match rule.measure {
        RuleMeasure::OffPath => flown.map(|()| 1.0 - task.on_path),
        RuleMeasure::OffHeight => task.off_height_m,
        RuleMeasure::Speeding => flown.filter(|()| task.seconds > 0.0).map(|()| task.speeding_s / task.seconds),
        RuleMeasure::Crashes => Some(count(rule, task.crashes)),
        RuleMeasure::NotAttempted => Some(f64::from(u8::from(!task.attempted))),
        RuleMeasure::CrashesOutside
        | RuleMeasure::CrashesAll
        | RuleMeasure::Missed
        | RuleMeasure::MissedSevere
        | RuleMeasure::MissedInView
        | RuleMeasure::FalseSnapshots
        | RuleMeasure::Overtime
        | RuleMeasure::NotLanded
        | RuleMeasure::BatteryLow => None,
    }
}

fn session_value(rule: &PlanRule, record: &SessionRecord) -> Option<f64> {
    let yes = |is: bool| Some(f64::from(u8::from(is)));
    let share = |part: usize, whole: usize| (whole > 0).then(|| part as f64 / whole as f64);
    match rule.measure {
        RuleMeasure::CrashesOutside => Some(count(rule, record.crashes_outside)),
        RuleMeasure::CrashesAll => Some(count(rule, record.crashes())),
        RuleMeasure::Missed => {
            let lacked = |lacked: &[String]| rule.lacked.is_empty() || lacked.iter().any(|word| word.starts_with(&rule.lacked));
            let missed = record.defects.iter().filter(|defect| !defect.found && lacked(&defect.lacked)).count();
            share(missed, record.defects.len())
        }
        RuleMeasure::MissedSevere => Some(missed(rule, record).len() as f64),
        RuleMeasure::MissedInView => {
            let longest_s = missed(rule, record).iter().filter_map(|defect| defect.in_view_s).fold(0.0, f64::max);
            Some(longest_s)
        }
        RuleMeasure::FalseSnapshots => share(record.snapshots - record.hits.min(record.snapshots), record.snapshots),
        // An efficiency score of 0 to 100 corresponds to -100 to 100 points. After a battery failure, the points don't
        // reflect the time.
        RuleMeasure::Overtime => {
            let points = 2.0 * record.scores.efficiency - 100.0;
            (!record.battery_failed).then(|| (100.0 - points) / EFFICIENCY_LOSS_PER_MIN)
        }
        RuleMeasure::NotLanded => yes(record.end_reason != "landed"),
        RuleMeasure::BatteryLow => yes(record.battery_at_end_pct < BATTERY_RESERVE_PCT),
        RuleMeasure::OffPath
        | RuleMeasure::OffHeight
        | RuleMeasure::Speeding
        | RuleMeasure::Crashes
        | RuleMeasure::NotAttempted => None,
    }
}

/// Returns the missed defects that a rule applies to (severe ones, or those clearly visible), most severe first.
fn missed<'a>(rule: &PlanRule, record: &'a SessionRecord) -> Vec<&'a DefectRecord> {
    let about = |defect: &&DefectRecord| match rule.measure {
        RuleMeasure::MissedInView => defect.in_view_s.is_some_and(|seconds| seconds > rule.limit),
        RuleMeasure::OffPath
        | RuleMeasure::OffHeight
        | RuleMeasure::Speeding
        | RuleMeasure::Crashes
        | RuleMeasure::CrashesOutside
        | RuleMeasure::CrashesAll
        | RuleMeasure::NotAttempted
        | RuleMeasure::Missed
        | RuleMeasure::MissedSevere
        | RuleMeasure::FalseSnapshots
        | RuleMeasure::Overtime
        | RuleMeasure::NotLanded
        | RuleMeasure::BatteryLow => defect.condition_state >= MIN_SEVERE_CONDITION_STATE,
    };
    let mut missed: Vec<&DefectRecord> = record.defects.iter().filter(|defect| !defect.found).filter(about).collect();
    missed.sort_by(|a, b| {
        (b.condition_state, b.in_view_s.unwrap_or(0.0))
            .partial_cmp(&(a.condition_state, a.in_view_s.unwrap_or(0.0)))
            .unwrap_or(Ordering::Equal)
    });
    missed
}

/// Describes the missed defects that a rule applies to, listing at most [`MAX_DEFECTS_LISTED`] of them.
fn missed_summary(rule: &PlanRule, record: &SessionRecord) -> String {
    let missed = missed(rule, record);
    let name = |defect: &&DefectRecord| {
        format!("defect {} ({}, condition state {})", defect.id, defect.kind_name, defect.condition_state)
    };
    let mut names: Vec<String> = missed.iter().take(MAX_DEFECTS_LISTED).map(name).collect();
    if missed.len() > MAX_DEFECTS_LISTED {
        names.push(format!("{} more", missed.len() - MAX_DEFECTS_LISTED));
    }
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

fn count(rule: &PlanRule, crashes: Crashes) -> f64 {
    let counted = crashes.by_kind().into_iter().filter(|(kind, _)| rule.with.is_none_or(|with| with == *kind));
    counted.map(|(_, count)| count as f64).sum()
}

fn reason(rule: &PlanRule, finding: &Finding<'_>) -> PlanReason {
    let task = finding.task.map_or(String::new(), |task| task.name.clone());
    let fastest = finding.task.map_or(0.0, |task| task.fastest_m_s);
    let axis = finding.task.map_or("", deviation_direction);
    let words = rule.reason.replace("{value}", &displayed_value(rule.measure, finding.value, rule.limit));
    let words = words.replace("{limit}", &displayed_value(rule.measure, rule.limit, rule.limit));
    let words = words.replace("{defects}", &missed_summary(rule, finding.record));
    // Scenario text is substituted last so that braces in it are not expanded.
    let words = words.replace("{axis}", axis).replace("{fastest}", &format!("{fastest:.1} m/s")).replace("{task}", &task);
    PlanReason { rule: rule.name.clone(), session: finding.record.id.clone(), words, value: finding.value, limit: rule.limit }
}

/// Describes the direction of the deviation from the task's path.
fn deviation_direction(task: &TaskRecord) -> &'static str {
    match (task.off_sideways_m, task.off_height_m) {
        (Some(sideways), Some(height)) if sideways > DOMINANCE_RATIO * height => "mainly sideways",
        (Some(sideways), Some(height)) if height > DOMINANCE_RATIO * sideways => "mainly vertically",
        (Some(_), Some(_)) => "both sideways and vertically",
        (Some(_) | None, None) | (None, Some(_)) => "and far from it",
    }
}

/// Formats a value with enough digits to distinguish it from the limit.
fn displayed_value(measure: RuleMeasure, value: f64, limit: f64) -> String {
    match measure {
        RuleMeasure::OffPath | RuleMeasure::Speeding | RuleMeasure::Missed | RuleMeasure::FalseSnapshots => {
            format!("{}%", format_with_limit(100.0 * value, 100.0 * limit, 0))
        }
        RuleMeasure::OffHeight => format!("{} m", format_with_limit(value, limit, 1)),
        RuleMeasure::Overtime => format!("{} min", format_with_limit(value, limit, 1)),
        RuleMeasure::MissedInView => format!("{} s", format_with_limit(value, limit, 1)),
        RuleMeasure::Crashes
        | RuleMeasure::CrashesOutside
        | RuleMeasure::CrashesAll
        | RuleMeasure::NotAttempted
        | RuleMeasure::MissedSevere
        | RuleMeasure::NotLanded
        | RuleMeasure::BatteryLow => format!("{value:.0}"),
    }
}

#[cfg(test)]
mod tests;
