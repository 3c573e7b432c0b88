//! Texts of the reasons in a plan.

use super::default_reasons::{ReasonValues, default_reason};
use super::finding::{Finding, missed};
use super::measure::{MEASURES, MeasureUnit, RuleMeasure};
use super::rules::PlanRule;
use crate::record::{SessionRecord, TaskRecord};
use crate::terms::task_title;
use spandrel_model::numbers::format_with_limit;
use spandrel_text::{Language, text};

/// Maximum number of missed defects named in a reason.
const MAX_DEFECTS_LISTED: usize = 3;
/// Factor by which one direction must exceed the other for a deviation to be described by that direction alone.
const DOMINANCE_RATIO: f64 = 2.0;

/// Returns the reason shown to the trainee. A reason other than the default one is the user's and stays in its language.
pub(super) fn words(finding: &Finding<'_>, language: Language) -> String {
    let rule = finding.rule;
    let own = filled_in(finding, &values(finding, Language::English), Language::English);
    if language == Language::English {
        return own;
    }
    let is_default = default_reason(&rule.name, &values(finding, Language::English), Language::English).as_ref() == Some(&own);
    let values = values(finding, language);
    let translated = default_reason(&rule.name, &values, language).filter(|_| is_default);
    translated.unwrap_or_else(|| filled_in(finding, &values, language))
}

/// Returns the rule's own reason with its values.
fn filled_in(finding: &Finding<'_>, values: &ReasonValues, language: Language) -> String {
    let rule = finding.rule;
    let words = rule.reason.replace("{value}", &values.value);
    let words = words.replace("{limit}", &displayed_value(rule.measure, rule.limit, rule.limit, language));
    let words = words.replace("{defects}", &values.defects);
    // Scenario text is substituted last so that braces in it are not expanded.
    words.replace("{axis}", &values.axis).replace("{fastest}", &values.fastest).replace("{task}", &values.task)
}

fn values(finding: &Finding<'_>, language: Language) -> ReasonValues {
    let rule = finding.rule;
    let (over, all) = finding.tasks_over;
    let fastest_m_s = finding.task.map_or(0.0, |task| task.fastest_m_s);
    ReasonValues {
        task: match finding.task {
            Some(task) => task_title(&finding.record.scenario, &task.name, language),
            None => text!(language, "plan-tasks-over", over = over, all = all),
        },
        value: displayed_value(rule.measure, finding.value, rule.limit, language),
        axis: finding.task.map_or_else(String::new, |task| deviation_direction(task, language)),
        fastest: format!("{fastest_m_s:.1} m/s"),
        defects: missed_summary(rule, finding.record, language),
    }
}

/// Describes a limit of a drill's criterion, such as "off path at most 10%".
pub(super) fn limit_words(rule: &PlanRule, language: Language) -> String {
    let name = MEASURES.iter().find(|(_, measure)| *measure == rule.measure).map_or("", |(name, _)| *name);
    let measure = measure_title(name, language);
    if rule.measure.unit() == MeasureUnit::Count && rule.limit < 1.0 {
        return text!(language, "plan-limit-none", measure = measure);
    }
    let shown = |limit: f64| displayed_value(rule.measure, limit, rule.limit, language);
    let limit = match rule.measure.unit() {
        // Counts are whole numbers.
        MeasureUnit::Count => shown(rule.limit.floor()),
        MeasureUnit::PerMinute => {
            text!(language, "plan-limit-per-minute", value = format_with_limit(rule.limit, rule.limit, 0))
        }
        MeasureUnit::Fraction | MeasureUnit::Meters | MeasureUnit::Minutes | MeasureUnit::Seconds | MeasureUnit::Degrees => {
            shown(rule.limit)
        }
    };
    text!(language, "plan-limit-at-most", measure = measure, limit = limit)
}

/// Returns the name of the measure with this keyword.
fn measure_title(keyword: &str, language: Language) -> String {
    match keyword {
        "off_path" => text!(language, "plan-measure-off-path"),
        "off_height" => text!(language, "plan-measure-off-height"),
        "speeding" => text!(language, "plan-measure-speeding"),
        "crashes" => text!(language, "plan-measure-crashes"),
        "not_attempted" => text!(language, "plan-measure-not-attempted"),
        "not_covered" => text!(language, "plan-measure-not-covered"),
        "beside_path" => text!(language, "plan-measure-beside-path"),
        "too_far" => text!(language, "plan-measure-too-far"),
        "too_close" => text!(language, "plan-measure-too-close"),
        "uneven_stand_off" => text!(language, "plan-measure-uneven-stand-off"),
        "too_low" => text!(language, "plan-measure-too-low"),
        "too_high" => text!(language, "plan-measure-too-high"),
        "uneven_height" => text!(language, "plan-measure-uneven-height"),
        "low_clearance" => text!(language, "plan-measure-low-clearance"),
        "framing" => text!(language, "plan-measure-framing"),
        "lamp_off" => text!(language, "plan-measure-lamp-off"),
        "stick_reversals" => text!(language, "plan-measure-stick-reversals"),
        "yaw_reversals" => text!(language, "plan-measure-yaw-reversals"),
        "stick_jumps" => text!(language, "plan-measure-stick-jumps"),
        "unlit_pictures" => text!(language, "plan-measure-unlit-pictures"),
        "missed_at_task" => text!(language, "plan-measure-missed-at-task"),
        "crashes_outside" => text!(language, "plan-measure-crashes-outside"),
        "crashes_all" => text!(language, "plan-measure-crashes-all"),
        "missed" => text!(language, "plan-measure-missed"),
        "missed_severe" => text!(language, "plan-measure-missed-severe"),
        "missed_in_view" => text!(language, "plan-measure-missed-in-view"),
        "missed_hidden" => text!(language, "plan-measure-missed-hidden"),
        "missed_lines" => text!(language, "plan-measure-missed-lines"),
        "poor_pictures" => text!(language, "plan-measure-poor-pictures"),
        "no_pictures" => text!(language, "plan-measure-no-pictures"),
        "false_snapshots" => text!(language, "plan-measure-false-snapshots"),
        "moving_pictures" => text!(language, "plan-measure-moving-pictures"),
        "drifting_pictures" => text!(language, "plan-measure-drifting-pictures"),
        "turning_pictures" => text!(language, "plan-measure-turning-pictures"),
        "landing" => text!(language, "plan-measure-landing"),
        "overtime" => text!(language, "plan-measure-overtime"),
        "slow" => text!(language, "plan-measure-slow"),
        "not_landed" => text!(language, "plan-measure-not-landed"),
        "battery_low" => text!(language, "plan-measure-battery-low"),
        "battery_failed" => text!(language, "plan-measure-battery-failed"),
        "exposure" => text!(language, "plan-measure-exposure"),
        _ => keyword.replace('_', " "),
    }
}

/// Describes the missed defects that a rule applies to, listing at most [`MAX_DEFECTS_LISTED`] of them.
fn missed_summary(rule: &PlanRule, record: &SessionRecord, language: Language) -> String {
    let missed = missed(rule, record);
    let mut names: Vec<String> = missed
        .iter()
        .take(MAX_DEFECTS_LISTED)
        .map(|defect| {
            let (id, state) = (defect.id.to_string(), defect.condition_state.to_string());
            text!(language, "plan-missed-defect", defect = id, kind = defect.kind_title(language), state = state)
        })
        .collect();
    if missed.len() > MAX_DEFECTS_LISTED {
        let more = missed.len() - MAX_DEFECTS_LISTED;
        names.push(text!(language, "plan-more-defects", count = more.to_string()));
    }
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            text!(language, "plan-and", first = rest.join(", "), last = last.as_str())
        }
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// Describes the direction of the deviation from the task's path.
fn deviation_direction(task: &TaskRecord, language: Language) -> String {
    match (task.off_sideways_m, task.off_height_m) {
        (Some(sideways), Some(height)) if sideways > DOMINANCE_RATIO * height => text!(language, "plan-mainly-sideways"),
        (Some(sideways), Some(height)) if height > DOMINANCE_RATIO * sideways => text!(language, "plan-mainly-vertically"),
        (Some(_), Some(_)) => text!(language, "plan-both-ways"),
        (Some(_) | None, None) | (None, Some(_)) => text!(language, "plan-far-away"),
    }
}

/// Formats a value with enough digits to distinguish it from the limit.
fn displayed_value(measure: RuleMeasure, value: f64, limit: f64, language: Language) -> String {
    match measure.unit() {
        MeasureUnit::Fraction => format!("{}%", format_with_limit(100.0 * value, 100.0 * limit, 0)),
        MeasureUnit::Meters => format!("{} m", format_with_limit(value, limit, 1)),
        MeasureUnit::Minutes => format!("{} min", format_with_limit(value, limit, 1)),
        MeasureUnit::Seconds => format!("{} s", format_with_limit(value, limit, 1)),
        MeasureUnit::Degrees => text!(language, "plan-degrees", value = format_with_limit(value, limit, 0)),
        MeasureUnit::PerMinute => text!(language, "plan-per-minute", value = format_with_limit(value, limit, 0)),
        MeasureUnit::Count => format!("{value:.0}"),
    }
}
