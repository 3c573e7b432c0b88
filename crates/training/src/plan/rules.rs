//! Training plan rules and their file format.

use spandrel_model::toml::{Problems, Reader, Section};

/// Default rules of the training plan, in TOML.
pub const DEFAULT_RULES: &str = include_str!("rules.toml");

/// File format version.
const FORMAT_VERSION: i64 = 1;

/// Measure that a rule evaluates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleMeasure {
    /// Fraction of a task's time off its path.
    OffPath,
    /// Mean vertical distance from a task's path while off it, m.
    OffHeight,
    /// Fraction of a task's time above the speed limit.
    Speeding,
    /// Number of crashes in a task's window.
    Crashes,
    /// Number of crashes outside all windows.
    CrashesOutside,
    /// Total number of crashes.
    CrashesAll,
    /// 1 if the task was not attempted.
    NotAttempted,
    /// Fraction of defects not shown in any picture.
    Missed,
    /// Number of missed defects in condition state 3 (poor) or worse.
    MissedSevere,
    /// Longest time that a missed defect was clearly visible, s; available only if the session has a report.
    MissedInView,
    /// Fraction of pictures that show no new defect.
    FalseSnapshots,
    /// Flight time beyond the time for full efficiency, min.
    Overtime,
    /// 1 if the flight did not end with a landing at home.
    NotLanded,
    /// 1 if the battery charge was below 20% at the end.
    BatteryLow,
}

const MEASURES: &[(&str, RuleMeasure)] = &[
    ("off_path", RuleMeasure::OffPath),
    ("off_height", RuleMeasure::OffHeight),
    ("speeding", RuleMeasure::Speeding),
    ("crashes", RuleMeasure::Crashes),
    ("crashes_outside", RuleMeasure::CrashesOutside),
    ("crashes_all", RuleMeasure::CrashesAll),
    ("not_attempted", RuleMeasure::NotAttempted),
    ("missed", RuleMeasure::Missed),
    ("missed_severe", RuleMeasure::MissedSevere),
    ("missed_in_view", RuleMeasure::MissedInView),
    ("false_snapshots", RuleMeasure::FalseSnapshots),
    ("overtime", RuleMeasure::Overtime),
    ("not_landed", RuleMeasure::NotLanded),
    ("battery_low", RuleMeasure::BatteryLow),
];
const TASK_KINDS: &[(&str, Option<&str>)] = &[
    ("any", None),
    ("slab_side", Some("slab_side")),
    ("arch_bottom", Some("arch_bottom")),
    ("interlayer", Some("interlayer")),
    ("pier_circle", Some("pier_circle")),
    ("free", Some("free")),
];
const CRASH_OBJECTS: &[(&str, Option<&str>)] = &[
    ("any", None),
    ("bridge", Some("bridge")),
    ("terrain", Some("terrain")),
    ("water", Some("water")),
    ("other", Some("other")),
    ("vehicle", Some("vehicle")),
    ("person", Some("person")),
];

/// A rule of the training plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRule {
    /// Unique name of the rule.
    pub name: String,
    /// Measure that is compared with the limit.
    pub measure: RuleMeasure,
    /// Kind of task; `None` for all kinds.
    pub task: Option<&'static str>,
    /// Kind of object hit; `None` for all kinds.
    pub with: Option<&'static str>,
    /// Reason why a missed defect's best picture did not count; empty for any reason.
    pub lacked: String,
    /// Value above which the rule fires.
    pub limit: f64,
    /// Weight relative to other rules.
    pub weight: f64,
    /// Scenario to fly.
    pub scenario: String,
    /// Text shown to the trainee, with placeholders for values.
    pub reason: String,
}

/// Rules and parameters of the training plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRules {
    /// Maximum break between sessions, days.
    pub retention_days: f64,
    /// Scenario to fly after a longer break.
    pub retention_scenario: String,
    /// Reason for the retention scenario.
    pub retention_reason: String,
    /// Minimum break between sessions, days.
    pub rest_days: f64,
    /// Scenario to fly if no rule fires.
    pub job: String,
    /// Reason for flying the job.
    pub job_reason: String,
    /// Maximum number of scenarios in a plan.
    pub steps: usize,
    /// Rules in file order.
    pub rules: Vec<PlanRule>,
}

/// Reads the rules from TOML.
///
/// # Errors
/// Returns all errors in the file.
pub fn read_rules(file: &str, text: &str) -> Result<PlanRules, Problems> {
    let mut reader = Reader::new(file, text);
    let rules = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        read(&mut reader, &mut root)
    });
    match rules {
        Some(rules) if reader.problems.is_empty() => Ok(rules),
        Some(_) | None => Err(Problems(reader.problems)),
    }
}

fn read(reader: &mut Reader<'_>, root: &mut Section<'_>) -> PlanRules {
    reader.integer(root, "format", (FORMAT_VERSION, FORMAT_VERSION), None);
    let steps = reader.integer(root, "steps", (1, 20), Some(3));
    let mut rules: Vec<PlanRule> = Vec::new();
    for mut section in reader.sections(root, "rules") {
        let rule = read_rule(reader, &mut section);
        if rules.iter().any(|other| other.name == rule.name) {
            reader.add_problem(&section, "name", &rule.name, "a unique name", "duplicate rule name");
        }
        reader.finish(&section);
        rules.push(rule);
    }
    let rules = PlanRules {
        retention_days: reader.number(root, "retention_days", (1.0, 3650.0), None),
        retention_scenario: reader.text(root, "retention_scenario", None),
        retention_reason: reader.text(root, "retention_reason", None),
        rest_days: reader.number(root, "rest_days", (0.0, 365.0), None),
        job: reader.text(root, "job", None),
        job_reason: reader.text(root, "job_reason", None),
        steps: usize::try_from(steps).unwrap_or(1),
        rules,
    };
    reader.finish(root);
    rules
}

fn read_rule(reader: &mut Reader<'_>, section: &mut Section<'_>) -> PlanRule {
    PlanRule {
        name: reader.text(section, "name", None),
        measure: reader.keyword(section, "measure", MEASURES, None),
        task: reader.keyword(section, "task", TASK_KINDS, Some(0)),
        with: reader.keyword(section, "with", CRASH_OBJECTS, Some(0)),
        lacked: reader.text(section, "lacked", Some("")),
        limit: reader.number(section, "limit", (0.001, 1000.0), None),
        weight: reader.number(section, "weight", (0.01, 100.0), Some(1.0)),
        scenario: reader.text(section, "scenario", None),
        reason: reader.text(section, "reason", None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_shipped_rules_are_valid_and_errors_name_line_and_key() {
        assert!(read_rules("rules.toml", DEFAULT_RULES).unwrap().rules.len() > 20);
        let wrong = DEFAULT_RULES.replacen("measure = \"off_path\"", "measure = \"elegance\"", 1).replacen(
            "limit = 0.1\n",
            "limit = -1\n",
            1,
        );
        let told = read_rules("rules.toml", &wrong).unwrap_err().to_string();
        assert!(told.contains("measure = \"elegance\"") && told.contains("limit = -1"), "{told}");
        let twice = DEFAULT_RULES.replace("name = \"crashes into water\"", "name = \"hit a person\"");
        assert!(read_rules("rules.toml", &twice).unwrap_err().to_string().contains("duplicate rule name"));
    }
}
