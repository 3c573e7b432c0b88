//! The training plan: recommends which scenarios to fly next, when and why, based on scores and their causes. It also
//! reports changes since the previous session. The rules come from a data file.

mod causes;
mod changes;
mod default_reasons;
mod finding;
mod level_settings;
mod mastery;
mod measure;
mod rules;
mod staircase;
mod wording;

pub(crate) use finding::{BATTERY_RESERVE_PCT, MIN_SEVERE_CONDITION_STATE};

pub use changes::{ChangedMeasure, MeasureChange, SessionChanges};
pub use default_reasons::rule_title;
pub use level_settings::level_settings;
pub use mastery::{DrillProgress, meets_criterion};
pub use measure::{MEASURES, MeasureUnit, RuleMeasure, SessionMeasure, TaskMeasure};
pub use rules::{DEFAULT_RULES, DrillCriterion, LESSON, PlanRule, PlanRules, StaircaseRule, read_rules};
pub use staircase::{LevelAdvice, StaircaseSession};

use super::record::{IncompletePolicy, SessionOutcome, SessionRecord};
use causes::RankedFinding;
use finding::Finding;
use serde::Serialize;
use spandrel_model::shipped::SCENARIOS;
use spandrel_text::{Language, text};

/// Length of a day, µs.
const DAY_US: f64 = 86_400e6;

/// Scenarios recommended for one trainee.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrainingPlan {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// ID of the latest session, the basis of the plan.
    pub session: String,
    /// Completion and certification verdict of that session.
    pub headlines: PlanHeadlines,
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
    /// Progress on the drills that were flown or are recommended.
    pub drills: Vec<DrillProgress>,
    /// Note that the latest session is incomplete and counts nevertheless; absent otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// The two headlines of the session on which a plan is based; they are always shown together.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlanHeadlines {
    /// Job completion, as text.
    pub completion: String,
    /// Whether the session meets all certification requirements.
    pub certified: bool,
    /// Certification verdict, as text.
    pub certification: String,
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
    /// Recommended difficulty level; absent if the scenario has no levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<LevelAdvice>,
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
    /// Numbers of the tasks in which the value exceeds the limit; empty if the measure applies to the whole session.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tasks: Vec<u32>,
    /// Name of the rule whose finding caused this one; absent for a cause.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub consequence_of: Option<String>,
}

impl PlanStep {
    /// Returns the command that flies this step.
    #[must_use]
    pub fn command(&self, trainee: &str) -> String {
        let level = self.level.as_ref().map(|level| format!(" --level {}", level.level)).unwrap_or_default();
        format!("spandrel train --trainee {trainee} --scenario {}{level}", self.scenario)
    }
}

/// Creates a plan in a language from one trainee's records in chronological order; `None` if there are no records.
#[must_use]
pub fn plan(records: &[SessionRecord], rules: &PlanRules, now_unix_us: u64, language: Language) -> Option<TrainingPlan> {
    plan_from(records, mastery::progress(records, rules, language), rules, now_unix_us, language)
}

/// Creates a plan from the records that count and the progress on the drills.
fn plan_from(
    records: &[SessionRecord],
    mut drills: Vec<DrillProgress>,
    rules: &PlanRules,
    now_unix_us: u64,
    language: Language,
) -> Option<TrainingPlan> {
    let last = records.last()?;
    let mut steps = recommended_steps(records, &drills, rules, language);
    add_begun_drills(&mut steps, &drills, last, language);
    steps.truncate(rules.steps);
    let days = now_unix_us.saturating_sub(last.started_unix_us) as f64 / DAY_US;
    let overdue = days > rules.retention_days;
    if overdue {
        let words = retention_words(rules, days, language);
        steps.insert(0, single_reason_step(&rules.retention_scenario, last, ("retention", words), (days, rules.retention_days)));
    } else if steps.is_empty() {
        steps.push(single_reason_step(next_job(rules, last), last, ("job", job_words(rules, last, language)), (0.0, 0.0)));
    }
    drills.retain(|drill| drill.sessions > 0 || steps.iter().any(|step| step.scenario == drill.scenario));
    for step in &mut steps {
        step.level = drills.iter().find(|drill| drill.scenario == step.scenario).and_then(|drill| drill.next_level.clone());
    }
    let after = |days: f64| last.started_unix_us.saturating_add((days * DAY_US) as u64);
    Some(TrainingPlan {
        trainee: last.trainee.clone(),
        session: last.id.clone(),
        headlines: PlanHeadlines {
            completion: last.completion_summary(language),
            certified: last.certified,
            certification: last.verdict(language),
        },
        steps,
        from_unix_us: after(rules.rest_days),
        until_unix_us: after(rules.retention_days),
        overdue,
        changes: changes::changes(records),
        left_out: 0,
        drills,
        note: None,
    })
}

/// Creates a plan in a language from the sessions that the policy allows and from the latest session, which always counts: even an
/// incomplete flight shows which paths were not flown, and how the others were. An incomplete session that the policy
/// excludes is never compared with others.
#[must_use]
pub fn plan_for_policy(
    mut records: Vec<SessionRecord>,
    incomplete: IncompletePolicy,
    rules: &PlanRules,
    now_unix_us: u64,
    language: Language,
) -> Option<TrainingPlan> {
    let newest = records.last()?.clone();
    // An attempt that was broken off is a session in which the criterion was not met.
    let drills = mastery::progress(&records, rules, language);
    let all = records.len();
    records.retain(|record| incomplete.counts(record) || record.id == newest.id);
    let left_out = all - records.len();
    let plan = plan_from(&records, drills, rules, now_unix_us, language)?;
    if incomplete.counts(&newest) {
        return Some(TrainingPlan { left_out, ..plan });
    }
    let note = text!(language, "plan-latest-incomplete", completion = newest.completion_summary(language));
    Some(TrainingPlan { left_out, changes: None, note: Some(note), ..plan })
}

/// Returns the scenarios that the rules recommend, most urgent first, except drills that were done after the flight that
/// calls for them.
fn recommended_steps(
    records: &[SessionRecord],
    drills: &[DrillProgress],
    rules: &PlanRules,
    language: Language,
) -> Vec<PlanStep> {
    let all: Vec<&SessionRecord> = records.iter().collect();
    let jobs: Vec<&SessionRecord> = records.iter().filter(|record| !rules.is_exercise(&record.scenario)).collect();
    let of = |rule| finding::findings(rule, if rule.measure.is_about_jobs() { &jobs } else { &all });
    let findings = rules.rules.iter().flat_map(of);
    let ranked = causes::rank(findings.filter(|finding| finding.value > finding.rule.limit).collect());
    let mut steps: Vec<PlanStep> = Vec::new();
    let is_open = |one: &&RankedFinding<'_>| !is_answered(&ranked[one.cause.unwrap_or(one.index)].finding, drills);
    let (causes, effects): (Vec<_>, Vec<_>) = ranked.iter().filter(is_open).partition(|one| one.cause.is_none());
    for one in causes.into_iter().chain(effects) {
        let cause = one.cause.map(|index| ranked[index].finding.rule);
        let scenario = &cause.unwrap_or(one.finding.rule).scenario;
        let reason = reason(&one.finding, cause.map(|rule| rule.name.clone()), language);
        add(&mut steps, scenario, one.urgency, reason);
    }
    steps.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    let least = steps.first().map_or(0.0, |first| rules.focus * first.urgency);
    steps.retain(|step| step.urgency >= least);
    steps
}

/// Returns whether the drill that a finding calls for was done after the finding's flight.
fn is_answered(finding: &Finding<'_>, drills: &[DrillProgress]) -> bool {
    let drill = drills.iter().find(|drill| drill.scenario == finding.rule.scenario);
    drill.is_some_and(|drill| drill.done && drill.last_unix_us > Some(finding.record.started_unix_us))
}

/// Adds the drills that were begun but are not done, with less urgency than any finding.
fn add_begun_drills(steps: &mut Vec<PlanStep>, drills: &[DrillProgress], last: &SessionRecord, language: Language) {
    for drill in drills.iter().filter(|drill| drill.sessions > 0 && !drill.done) {
        let reason = PlanReason {
            rule: "mastery".to_owned(),
            session: last.id.clone(),
            words: text!(language, "plan-drill-open", progress = drill.words(language)),
            value: drill.met as f64,
            limit: drill.needed as f64,
            tasks: Vec::new(),
            consequence_of: None,
        };
        add(steps, &drill.scenario, 0.0, reason);
    }
}

fn add(steps: &mut Vec<PlanStep>, scenario: &str, urgency: f64, reason: PlanReason) {
    match steps.iter_mut().find(|step| step.scenario == scenario) {
        Some(step) => {
            step.urgency += urgency;
            step.reasons.push(reason);
        }
        None => steps.push(PlanStep { scenario: scenario.to_owned(), urgency, reasons: vec![reason], level: None }),
    }
}

fn reason(finding: &Finding<'_>, consequence_of: Option<String>, language: Language) -> PlanReason {
    PlanReason {
        rule: finding.rule.name.clone(),
        session: finding.record.id.clone(),
        words: wording::words(finding, language),
        value: finding.value,
        limit: finding.rule.limit,
        tasks: finding.tasks_over_limit(),
        consequence_of,
    }
}

/// Returns the reason for a flight after a long break. A reason other than the default one stays in its language.
fn retention_words(rules: &PlanRules, days: f64, language: Language) -> String {
    let days = format!("{days:.0}");
    let own = rules.retention_reason.replace("{value}", &days);
    let of = |language| text!(language, "plan-retention", days = days.as_str());
    if of(Language::English) == own { of(language) } else { own }
}

/// Returns the job to fly if no rule fires: the shipped job that was flown last, and the rules' job after a drill, a lesson or a
/// job of the trainee's own.
fn next_job<'a>(rules: &'a PlanRules, last: &'a SessionRecord) -> &'a str {
    let name = last.scenario.as_str();
    let is_shipped = SCENARIOS.iter().any(|(shipped, _)| *shipped == name);
    if is_shipped && name != rules.retention_scenario && !rules.is_exercise(name) { name } else { &rules.job }
}

/// Returns the reason for flying the whole job. A reason other than the default one stays in its language.
fn job_words(rules: &PlanRules, last: &SessionRecord, language: Language) -> String {
    if !last.is_complete() && last.completion.is_some() {
        return text!(language, "plan-job-unfinished");
    }
    let of = |language| text!(language, "plan-job");
    if of(Language::English) == rules.job_reason { of(language) } else { rules.job_reason.clone() }
}

fn single_reason_step(
    scenario: &str,
    record: &SessionRecord,
    (rule, words): (&str, String),
    (value, limit): (f64, f64),
) -> PlanStep {
    let (rule, session) = (rule.to_owned(), record.id.clone());
    let reason = PlanReason { rule, session, words, value, limit, tasks: Vec::new(), consequence_of: None };
    PlanStep { scenario: scenario.to_owned(), urgency: 0.0, reasons: vec![reason], level: None }
}

#[cfg(test)]
mod tests;
