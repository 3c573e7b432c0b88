//! The reference page of the training plan rules, generated from the shipped rules. Run this test with
//! `SPANDREL_REFERENCE=write` to regenerate the page.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_training::plan::{DEFAULT_RULES, MEASURES, MeasureUnit, PlanRule, PlanRules, RuleMeasure, read_rules};
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "# Training plan rules

<!-- Generated from the code: SPANDREL_REFERENCE=write cargo test -p spandrel-training --test plan_rules_page -->

A training plan evaluates these rules (`crates/training/src/plan/rules.toml`). A rule fires if its measure exceeds the limit, and recommends its
scenario. The urgency of a finding is weight × (1 + log2(value / limit)). A scenario's urgency is the sum over its findings. The plan omits scenarios
with less than 40% of the first one's urgency.

The findings of the rules in the last column, or of the rules whose group is there, follow from the rule in the first column if both fire in the same task or
session. They are listed as consequences, add their urgency to that of their cause, and do not recommend scenarios of their own. If several rules explain
a finding, the most urgent one counts.

Task rules evaluate each task's latest flight; a rule that requires several tasks evaluates the latest session. Session rules evaluate the latest
session that has a value. Older incomplete sessions are omitted by default; the latest session always counts. Rules on defects count only the defects of
tasks that were done. All limits and weights are estimates.
";

/// A rule that recommends the drill of the task, of every kind.
const ONE_TASK_RULE: &str = "task not attempted";

fn keyword(rule: &PlanRule) -> &'static str {
    MEASURES.iter().find(|(_, measure)| *measure == rule.measure).unwrap().0
}

fn limit(rule: &PlanRule) -> String {
    let limit = rule.limit;
    match rule.measure.unit() {
        MeasureUnit::Fraction => format!("{:.0}%", 100.0 * limit),
        MeasureUnit::Count => format!("{:.0}", limit.floor()),
        MeasureUnit::Meters => format!("{limit} m"),
        MeasureUnit::Seconds => format!("{limit} s"),
        MeasureUnit::Minutes => format!("{limit} min"),
        MeasureUnit::Degrees => format!("{limit} degrees"),
        MeasureUnit::PerMinute => format!("{limit} per minute"),
    }
}

fn scope(rule: &PlanRule) -> String {
    let details = [rule.with.map(str::to_owned), Some(rule.lacked.clone()).filter(|text| !text.is_empty())];
    let details: Vec<String> = details.into_iter().flatten().collect();
    let scope = match rule.measure {
        RuleMeasure::Session(_) => "session".to_owned(),
        RuleMeasure::Task(_) if rule.in_tasks > 1 => format!("{} tasks", rule.in_tasks),
        RuleMeasure::Task(_) => rule.task.map_or_else(|| "each task".to_owned(), |kind| format!("`{kind}`")),
    };
    if details.is_empty() { scope } else { format!("{scope}: {}", details.join(", ")) }
}

fn page() -> String {
    let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap();
    let mut out = format!(
        "{HEAD}\n| rule | group | measure | scope | more than | weight | scenario | explains |\n|---|---|---|---|---|---|---|---|\n"
    );
    // A rule that stands for one rule per kind of task has one row.
    for same in rules.rules.chunk_by(|a, b| a.name == b.name) {
        let rule = &same[0];
        let (scope, scenario) = match same.len() {
            1 => (scope(rule), format!("`{}`", rule.scenario)),
            _ => (scope(&PlanRule { task: None, ..rule.clone() }), "drill of the task".to_owned()),
        };
        let (measure, limit, weight, explains) = (keyword(rule), limit(rule), rule.weight, rule.explains.join(", "));
        let _ = writeln!(
            out,
            "| {} | {} | `{measure}` | {scope} | {limit} | {weight} | {scenario} | {explains} |",
            rule.name, rule.group
        );
    }
    out + &task_drills(&rules) + &drills(&rules.with_shipped_levels())
}

/// Returns the section on the drills of the kinds of tasks.
fn task_drills(rules: &PlanRules) -> String {
    let mut out = "\n## Drills of the tasks\n\nFor a mistake in one task only, the plan recommends the drill of its kind.\n\n| kind of task | drill |\n|---|---|\n".to_owned();
    assert!(rules.rules.iter().any(|rule| rule.name == ONE_TASK_RULE), "no rule {ONE_TASK_RULE}");
    for rule in rules.rules.iter().filter(|rule| rule.name == ONE_TASK_RULE) {
        let _ = writeln!(out, "| `{}` | `{}` |", rule.task.unwrap(), rule.scenario);
    }
    out
}

/// Returns the section on the drills: their criteria and difficulty levels.
fn drills(rules: &PlanRules) -> String {
    let rule = rules.staircase.unwrap();
    let (needed, of, up, down) = (rules.mastery_needed, rules.mastery_of, rule.up, rule.down);
    let mut out = format!(
        "
## Drills

A drill is done after {needed} of its latest {of} sessions that count were complete and within these limits. Sessions that met them at an easier level than
the standard one, or did not meet them at a harder one, don't count.

After a session within the limits, the next one is {up} level harder; after any other, {down} levels easier. This weighted up-down staircase (Kaernbach 1991)
settles where {down} of {} sessions are within the limits. [Difficulty of the drills](../instructor/records.md#difficulty-of-the-drills) describes the
rule.

| drill | limits | easiest level | standard level | hardest level |
|---|---|---|---|---|
",
        up + down
    );
    for drill in &rules.drills {
        let limits: Vec<String> = drill.limits.iter().map(|one| format!("`{}` {}", keyword(one), limit(one))).collect();
        let levels = drill.difficulty.as_ref().unwrap();
        let at = [1, levels.standard, levels.levels()].map(|level| format!("{level}: {}", levels.settings_at(level)));
        let _ = writeln!(out, "| `{}` | {} | {} |", drill.scenario, limits.join(", "), at.join(" | "));
    }
    out
}

#[test]
fn exact_page_lists_the_shipped_rules() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/reference/plan-rules.md");
    let text = page();
    if std::env::var_os("SPANDREL_REFERENCE").is_some_and(|value| value == "write") {
        std::fs::write(&path, text).unwrap();
        return;
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == text, "plan-rules.md is outdated; regenerate it with SPANDREL_REFERENCE=write");
}
