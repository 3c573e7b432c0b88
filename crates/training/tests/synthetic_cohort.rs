//! Tests with the example study (examples/cohort, created by `tools/cohort`): 22 synthetic trainees, eight with three
//! sessions. Checks that Spandrel can compute the TASBID study's tables from flights and that the plans match the
//! flights.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_text::Language;
use spandrel_training::cohort::{Cohort, Selection, cohort, tables};
use spandrel_training::plan::{DEFAULT_RULES, plan, read_rules};
use spandrel_training::record::{IncompletePolicy, SessionRecord};

const RECORDS: &str = include_str!("../../../examples/cohort/records.jsonl");
/// Limits from the shipped rules. An interlayer flight is poor if it exceeds one of them or includes a crash.
const MAX_OFF_PATH_SHARE: f64 = 0.1;
const MAX_SPEEDING_SHARE: f64 = 0.02;
const RULES_OF_THE_INTERLAYER: [&str; 4] =
    ["off the interlayer path", "too fast in the interlayer", "crashes in the interlayer", "interlayer not attempted"];

fn records() -> Vec<SessionRecord> {
    RECORDS.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn study() -> Cohort {
    cohort(&records(), &Selection { scenarios: Vec::new(), repetitions: 3, incomplete: IncompletePolicy::Include })
}

#[test]
fn val_pilot_study_design_yields_expected_tables() {
    let records = records();
    assert!(records.iter().all(|record| record.check().is_ok() && record.answers.as_ref().is_some_and(|a| a.given.len() == 24)));
    let study = study();
    assert_eq!((study.trainees, study.sessions, study.group.len()), (22, 38, 8));
    assert_eq!((study.distributions.len(), study.individuals.len(), study.boxes.len(), study.tests.len()), (5, 22, 15, 15));
    assert_eq!((study.likert.len(), study.crashes.rows.len(), study.progress.len()), (96, 22, 22));
    assert_eq!(study.self_rating.people.len(), 22);
    assert!(study.causal.is_some() && study.homogeneity.len() >= 3);
    assert!(study.limitations.iter().any(|one| one.words(Language::English).contains("fewer than 78")));
    // Three repetitions are too few for a learning curve, and none of these answers contradicts the measurements.
    let expected = ["contradictions.csv", "learning_curves.csv", "learning_of_the_group.csv"];
    let empty: Vec<_> =
        tables(&study).into_iter().filter(|(_, table)| table.lines().count() <= 1).map(|(name, _)| name).collect();
    assert_eq!(empty, expected);
}

#[test]
fn val_less_stick_noise_improves_scores() {
    let study = study();
    let safety = study.tests.iter().find(|test| test.score == "safety" && (test.earlier, test.later) == (1, 3)).unwrap();
    assert!(safety.test.mean_difference > 0.0);
    let spread = |repetition: usize| {
        let one = study.boxes.iter().find(|one| one.score == "overall" && one.repetition == repetition).unwrap();
        one.plot.q3 - one.plot.q1
    };
    assert!(spread(3) < spread(1), "the spread decreases");
}

#[test]
fn val_only_poor_interlayer_flights_are_found_in_the_plan() {
    let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap();
    let (mut sent, mut spared) = (0, 0);
    for record in records() {
        let task = record.tasks.iter().find(|task| task.kind == "interlayer").unwrap();
        let steady = 1.0 - task.on_path <= MAX_OFF_PATH_SHARE && task.speeding_s / task.seconds <= MAX_SPEEDING_SHARE;
        let holds = task.attempted && steady && task.crashes.total() == 0;
        let whole = spandrel_training::plan::PlanRules { steps: 20, focus: 0.0, ..rules.clone() };
        let plan = plan(std::slice::from_ref(&record), &whole, record.started_unix_us, Language::English).unwrap();
        // A finding that follows from a fault in all tasks is listed with its cause, whose drill is another one.
        let about_the_task = |rule: &str| RULES_OF_THE_INTERLAYER.contains(&rule);
        let found: Vec<_> = plan.steps.iter().flat_map(|step| &step.reasons).filter(|one| about_the_task(&one.rule)).collect();
        assert_eq!(!found.is_empty(), !holds, "{}: {task:?}", record.id);
        if !holds {
            assert!(found.iter().all(|reason| reason.words.starts_with(&task.name)));
            sent += 1;
        } else {
            spared += 1;
        }
    }
    assert!(sent >= 5 && spared >= 5, "{sent} flights found, {spared} spared");
}
