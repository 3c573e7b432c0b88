//! Texts of the reasons in a plan.

use super::finding::{Finding, missed};
use super::measure::{MEASURES, MeasureUnit, RuleMeasure};
use super::rules::PlanRule;
use crate::record::{SessionRecord, TaskRecord};
use spandrel_model::numbers::format_with_limit;

/// Maximum number of missed defects named in a reason.
const MAX_DEFECTS_LISTED: usize = 3;
/// Factor by which one direction must exceed the other for a deviation to be described by that direction alone.
const DOMINANCE_RATIO: f64 = 2.0;

/// Returns the reason shown to the trainee.
pub(super) fn words(finding: &Finding<'_>) -> String {
    let rule = finding.rule;
    let task = match finding.task {
        Some(task) => task.name.clone(),
        None => format!("{} of {} tasks", finding.tasks_over.0, finding.tasks_over.1),
    };
    let fastest = finding.task.map_or(0.0, |task| task.fastest_m_s);
    let axis = finding.task.map_or("", deviation_direction);
    let words = rule.reason.replace("{value}", &displayed_value(rule.measure, finding.value, rule.limit));
    let words = words.replace("{limit}", &displayed_value(rule.measure, rule.limit, rule.limit));
    let words = words.replace("{defects}", &missed_summary(rule, finding.record));
    // Scenario text is substituted last so that braces in it are not expanded.
    words.replace("{axis}", axis).replace("{fastest}", &format!("{fastest:.1} m/s")).replace("{task}", &task)
}

/// Describes a limit of a drill's criterion, such as "off path at most 10%".
pub(super) fn limit_words(rule: &PlanRule) -> String {
    let name = MEASURES.iter().find(|(_, measure)| *measure == rule.measure).map_or("", |(name, _)| *name).replace('_', " ");
    if rule.measure.unit() == MeasureUnit::Count && rule.limit < 1.0 {
        return format!("no {name}");
    }
    let limit = match rule.measure.unit() {
        // Counts are whole numbers.
        MeasureUnit::Count => rule.limit.floor(),
        MeasureUnit::Fraction
        | MeasureUnit::Meters
        | MeasureUnit::Minutes
        | MeasureUnit::Seconds
        | MeasureUnit::Degrees
        | MeasureUnit::PerMinute => rule.limit,
    };
    format!("{name} at most {}", displayed_value(rule.measure, limit, rule.limit))
}

/// Describes the missed defects that a rule applies to, listing at most [`MAX_DEFECTS_LISTED`] of them.
fn missed_summary(rule: &PlanRule, record: &SessionRecord) -> String {
    let missed = missed(rule, record);
    let mut names: Vec<String> = missed
        .iter()
        .take(MAX_DEFECTS_LISTED)
        .map(|defect| format!("defect {} ({}, condition state {})", defect.id, defect.kind_name, defect.condition_state))
        .collect();
    if missed.len() > MAX_DEFECTS_LISTED {
        names.push(format!("{} more", missed.len() - MAX_DEFECTS_LISTED));
    }
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
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
    match measure.unit() {
        MeasureUnit::Fraction => format!("{}%", format_with_limit(100.0 * value, 100.0 * limit, 0)),
        MeasureUnit::Meters => format!("{} m", format_with_limit(value, limit, 1)),
        MeasureUnit::Minutes => format!("{} min", format_with_limit(value, limit, 1)),
        MeasureUnit::Seconds => format!("{} s", format_with_limit(value, limit, 1)),
        MeasureUnit::Degrees => format!("{} degrees", format_with_limit(value, limit, 0)),
        MeasureUnit::PerMinute => format!("{} per minute", format_with_limit(value, limit, 0)),
        MeasureUnit::Count => format!("{value:.0}"),
    }
}
