//! `spandrel plan`: recommends a trainee's next exercises.

use super::invocation::typed;
use super::records::RecordsArgs;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::clock;
use crate::io::files;
use crate::io::plan_rules::rules;
use crate::io::trainee_id::TraineeId;
use crate::records::read_json_lines;
use spandrel_monitor::export::json_text;
use spandrel_text::{Language, text};
use spandrel_training::cohort::job_reliability;
use spandrel_training::plan::{PlanHeadlines, PlanRules, SessionChanges, TrainingPlan, plan_for_policy};
use spandrel_training::record::{IncompletePolicy, SessionRecord, excluded_sessions_note};
use std::fmt::Write;
use std::path::PathBuf;

/// Recommend a trainee's next exercises, with reasons
///
/// Analyzes the trainee's records (see `spandrel records import`): what was not flown, the weakest tasks and axes,
/// stand-off and height, speed, crashes, camera direction and lamp, and why pictures missed defects. A mistake that
/// follows from another one is listed with its cause. The latest session always counts, even if it is incomplete. For a
/// drill with difficulty levels, the plan recommends the level that follows from the earlier sessions. The rules come from
/// a file; --rules selects another one.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel plan anna
  spandrel plan anna --json
  spandrel plan anna --rules our-rules.toml

{EXIT_CODES}"))]
pub struct Args {
    /// Trainee ID (pseudonym)
    #[arg(value_name = "ID")]
    trainee: TraineeId,
    #[command(flatten)]
    records_location: RecordsArgs,
    /// Read records from this file, as written by `spandrel records export`, instead of a database
    #[arg(long, value_name = "FILE")]
    records: Option<PathBuf>,
    /// Rules file to use instead of the default rules
    #[arg(long, value_name = "FILE")]
    rules: Option<PathBuf>,
    /// Include incomplete sessions
    #[arg(long)]
    include_incomplete: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or the database are invalid, or the trainee has no session.
pub fn run(args: &Args) -> Result<(), AppError> {
    let trainee = args.trainee.as_str();
    let incomplete = IncompletePolicy::included(args.include_incomplete);
    let everyone = match &args.records {
        Some(file) => read_json_lines(file)?,
        None => args.records_location.location().open()?.records(None)?,
    };
    let Some(plan) = plan_of(trainee, &everyone, incomplete, &rules(args.rules.as_deref())?) else {
        return Err(AppError::invalid(format!(
            "the records contain no sessions of '{trainee}'; to add sessions, use `{}`",
            typed("spandrel records import")
        )));
    };
    let text = if args.json { json_text(&plan) } else { plan_text(&plan) };
    files::write("-", text.as_bytes())
}

/// Returns a trainee's plan from everyone's records; `None` if there are none of the trainee.
pub fn plan_of(
    trainee: &str,
    everyone: &[SessionRecord],
    incomplete: IncompletePolicy,
    rules: &PlanRules,
) -> Option<TrainingPlan> {
    let mut records: Vec<SessionRecord> = everyone.iter().filter(|record| record.trainee == trainee).cloned().collect();
    records.sort_by(|a, b| (a.started_unix_us, &a.id).cmp(&(b.started_unix_us, &b.id)));
    let job = records.last().map(SessionRecord::scenario_with_level);
    let mut plan = plan_for_policy(records, incomplete, rules, clock::unix_us(), Language::English)?;
    if let (Some(changes), Some(job)) = (&mut plan.changes, job) {
        changes.label(&job_reliability(everyone, &job, incomplete));
    }
    Some(plan)
}

fn plan_text(plan: &TrainingPlan) -> String {
    let day = |unix_us: u64| clock::utc(unix_us).0.chars().take(10).collect::<String>();
    let PlanHeadlines { completion, certification, .. } = &plan.headlines;
    let mut out = format!(
        "Last session: {completion}. {certification}.\nRecommended exercises after {}, to fly between {} and {}:\n",
        plan.session,
        day(plan.from_unix_us),
        day(plan.until_unix_us)
    );
    for (k, step) in plan.steps.iter().enumerate() {
        let _ = writeln!(out, "{}. {}", k + 1, step.scenario);
        if let Some(level) = &step.level {
            let _ = writeln!(out, "   {}", level.words);
        }
        for reason in &step.reasons {
            let label = if reason.consequence_of.is_some() { "Consequence: " } else { "" };
            let _ = writeln!(out, "   {label}{}", reason.words);
        }
        let _ = writeln!(out, "   To fly it: {}", typed(&step.command(&plan.trainee)));
    }
    for drill in &plan.drills {
        let next = drill.next_level.as_ref().map(|next| format!("; next level: {}", next.level)).unwrap_or_default();
        let _ = writeln!(out, "Drill {}: {}{next}", drill.scenario, drill.words(Language::English));
    }
    if let Some(note) = &plan.note {
        let _ = writeln!(out, "{note}");
    }
    if let Some(note) = excluded_sessions_note(plan.left_out, Language::English) {
        let _ = writeln!(out, "{note} (use --include-incomplete to count them)");
    }
    if let Some(changes) = plan.changes.as_ref().filter(|changes| changes.shown().next().is_some()) {
        out += &changes_text(changes);
    }
    out
}

fn changes_text(changes: &SessionChanges) -> String {
    let forms = match &changes.forms {
        Some([before, now]) => format!(" (form {before}, now form {now}, which is equally difficult)"),
        None => String::new(),
    };
    let mut out = format!("Since {}{forms}:\n", changes.since);
    for change in changes.shown() {
        let better = if change.better == Some(true) { "better" } else { "worse" };
        let error = if changes.is_labeled() { format!(" ({})", change.error_label(Language::English)) } else { String::new() };
        let _ = writeln!(out, "   {}: {:.1} -> {:.1}, {better}{error}", change.what, change.before, change.now);
    }
    if !changes.is_labeled() {
        out += &text!(Language::English, "compare-error-unknown");
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_training::cohort::MeasureReliability;
    use spandrel_training::record::SessionLevel;
    use spandrel_training::testing::perfect_record;

    #[test]
    fn exact_plan_prints_the_level_and_the_command_that_flies_it() {
        let mut record = perfect_record("anna", 1);
        (record.scenario, record.level) = ("drill-gap".into(), Some(SessionLevel { level: 5, levels: 9, standard: 5 }));
        let plan = plan_for_policy(vec![record], IncompletePolicy::Exclude, &rules(None).unwrap(), 0, Language::English).unwrap();
        let text = plan_text(&plan);
        let level = "1. drill-gap\n   Level 6 of 9 (wind 1.99 m/s, gap 3.25 m): the last session met the criterion at level 5.\n";
        assert!(text.contains(level), "{text}");
        let command = "   To fly it: spandrel train --trainee anna --scenario drill-gap --level 6\nDrill drill-gap: ";
        assert!(text.contains(command) && text.contains("level 5 or harder); next level: 6\n"), "{text}");
        let json = json_text(&plan);
        assert!(json.contains("\"level\": 6") && json.contains("\"next_level\": {"), "{json}");
    }

    #[test]
    fn exact_plan_labels_changes_with_the_error_of_the_measure() {
        let mut everyone = Vec::new();
        for (trainee, safety) in [("anna", [50.0, 52.0]), ("ben", [70.0, 76.0]), ("cleo", [90.0, 95.0])] {
            for (number, safety) in (1..).zip(safety) {
                let mut record = perfect_record(trainee, number);
                record.scores.safety = safety;
                everyone.push(record);
            }
        }
        let flown = everyone[..2].to_vec();
        let of = |known: &[MeasureReliability]| {
            let mut plan =
                plan_for_policy(flown.clone(), IncompletePolicy::Exclude, &rules(None).unwrap(), 0, Language::English).unwrap();
            plan.changes.as_mut().unwrap().label(known);
            (plan_text(&plan), serde_json::from_str::<serde_json::Value>(&json_text(&plan)).unwrap())
        };
        let (text, json) = of(&job_reliability(&everyone, "two-bridges", IncompletePolicy::Exclude));
        assert!(text.starts_with("Last session: Complete: 4 of 4 tasks, 100% of the path. Certified.\n"), "{text}");
        assert!(text.contains("   safety: 50.0 -> 52.0, better (within error)\n"), "{text}");
        let change = |json: &serde_json::Value| {
            let changes = json["changes"]["changes"].as_array().unwrap().clone();
            changes.into_iter().find(|one| one["what"] == "safety").unwrap()
        };
        assert_eq!((&change(&json)["better"], &change(&json)["within_error"]), (&true.into(), &true.into()));
        let headlines = &json["headlines"];
        assert_eq!((&headlines["certified"], &headlines["certification"]), (&true.into(), &"Certified".into()));
        assert_eq!(headlines["completion"], "Complete: 4 of 4 tasks, 100% of the path");
        let (text, json) = of(&[]);
        assert!(text.contains("   safety: 50.0 -> 52.0, better\n") && change(&json).get("within_error").is_none(), "{text}");
        assert!(text.contains("\nThe changes are not labeled, because the error of the measures is unknown"), "{text}");
    }

    #[test]
    fn regress_equal_sessions_print_no_heading_of_changes() {
        let records = vec![perfect_record("anna", 1), perfect_record("anna", 2)];
        let plan = plan_for_policy(records, IncompletePolicy::Exclude, &rules(None).unwrap(), 0, Language::English).unwrap();
        assert!(plan.changes.is_some());
        let text = plan_text(&plan);
        assert!(!text.contains("Since ") && !text.contains("not labeled"), "{text}");
    }

    #[test]
    fn exact_plan_names_the_forms_of_both_sessions() {
        let mut records = vec![perfect_record("anna", 1), perfect_record("anna", 2)];
        for (record, form) in records.iter_mut().zip(["A", "B"]) {
            (record.form, record.form_detection_pct) = (Some(form.into()), Some(95.0));
        }
        records[1].scores.safety -= 10.0;
        let since = format!("Since {} (form A, now form B, which is equally difficult):\n", records[0].id);
        let plan = plan_for_policy(records, IncompletePolicy::Exclude, &rules(None).unwrap(), 0, Language::English).unwrap();
        assert!(plan_text(&plan).contains(&since), "{}", plan_text(&plan));
    }

    #[test]
    fn exact_scenarios_in_the_rules_are_shipped() {
        let rules = rules(None).unwrap();
        let names = rules.rules.iter().map(|rule| &rule.scenario).chain([&rules.job, &rules.retention_scenario]);
        for name in names {
            assert!(files::scenario_names().contains(&name.as_str()), "{name}");
        }
    }
}
