//! The training plan: recommends which scenarios to fly next, when and why, based on scores and their causes. It also
//! reports changes since the previous session. The rules come from a data file.

mod causes;
mod changes;
mod finding;
mod measure;
mod rules;
mod wording;

pub use changes::{MeasureChange, SessionChanges};
pub use measure::{MEASURES, MeasureUnit, RuleMeasure, SessionMeasure, TaskMeasure};
pub use rules::{DEFAULT_RULES, PlanRule, PlanRules, read_rules};

use super::record::{IncompletePolicy, SessionOutcome, SessionRecord};
use causes::RankedFinding;
use finding::Finding;
use serde::Serialize;

/// Length of a day, µs.
const DAY_US: f64 = 86_400e6;

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
    /// Note that the latest session is incomplete and counts nevertheless; absent otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// One scenario to fly.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanStep {
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Sum of weight × (1 + log2(value / limit)) over all findings that recommend this scenario, and over their consequences.
    pub urgency: f64,
    /// Reasons: the causes first, most urgent first, then their consequences.
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
    /// Name of the rule whose finding caused this one; absent for a cause.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub consequence_of: Option<String>,
}

/// Creates a plan from one trainee's records in chronological order; `None` if there are no records.
#[must_use]
pub fn plan(records: &[SessionRecord], rules: &PlanRules, now_unix_us: u64) -> Option<TrainingPlan> {
    let last = records.last()?;
    let mut steps = recommended_steps(records, rules);
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
        note: None,
    })
}

/// Creates a plan from the sessions that the policy allows and from the latest session, which always counts: even an
/// incomplete flight shows which paths were not flown, and how the others were. An incomplete session that the policy
/// excludes is never compared with others.
#[must_use]
pub fn plan_for_policy(
    mut records: Vec<SessionRecord>,
    incomplete: IncompletePolicy,
    rules: &PlanRules,
    now_unix_us: u64,
) -> Option<TrainingPlan> {
    let newest = records.last()?.clone();
    let all = records.len();
    records.retain(|record| incomplete.counts(record) || record.id == newest.id);
    let left_out = all - records.len();
    let plan = plan(&records, rules, now_unix_us)?;
    if incomplete.counts(&newest) {
        return Some(TrainingPlan { left_out, ..plan });
    }
    let note = format!(
        "The latest session counts although it is not complete ({}). It is not compared with other sessions.",
        newest.completion_summary()
    );
    Some(TrainingPlan { left_out, changes: None, note: Some(note), ..plan })
}

/// Returns the scenarios that the rules recommend, most urgent first.
fn recommended_steps(records: &[SessionRecord], rules: &PlanRules) -> Vec<PlanStep> {
    let findings = rules.rules.iter().flat_map(|rule| finding::findings(rule, records));
    let ranked = causes::rank(findings.filter(|finding| finding.value > finding.rule.limit).collect());
    let mut steps: Vec<PlanStep> = Vec::new();
    let is_cause = |one: &&RankedFinding<'_>| one.cause.is_none();
    for one in ranked.iter().filter(is_cause).chain(ranked.iter().filter(|one| one.cause.is_some())) {
        let cause = one.cause.map(|index| ranked[index].finding.rule);
        let scenario = &cause.unwrap_or(one.finding.rule).scenario;
        add(&mut steps, scenario, one.urgency, reason(&one.finding, cause.map(|rule| rule.name.clone())));
    }
    steps.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    steps
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

fn reason(finding: &Finding<'_>, consequence_of: Option<String>) -> PlanReason {
    PlanReason {
        rule: finding.rule.name.clone(),
        session: finding.record.id.clone(),
        words: wording::words(finding),
        value: finding.value,
        limit: finding.rule.limit,
        consequence_of,
    }
}

fn single_reason_step(
    scenario: &str,
    record: &SessionRecord,
    (rule, words): (&str, String),
    (value, limit): (f64, f64),
) -> PlanStep {
    let reason = PlanReason { rule: rule.to_owned(), session: record.id.clone(), words, value, limit, consequence_of: None };
    PlanStep { scenario: scenario.to_owned(), urgency: 0.0, reasons: vec![reason] }
}

#[cfg(test)]
mod tests;
