//! Tests of the selection and of the sentences without frames. Planted flights are in `tests/advice.rs`.

use super::*;
use crate::plan::{DEFAULT_RULES, PlanStep, plan, read_rules};
use crate::testing::{aborted_record, perfect_record};

fn rules() -> PlanRules {
    read_rules("rules.toml", DEFAULT_RULES).unwrap()
}

fn steps(record: &SessionRecord) -> Vec<PlanStep> {
    plan(std::slice::from_ref(record), &rules(), record.started_unix_us, Language::English).unwrap().steps
}

/// Returns a record with faults of many kinds.
fn poor_record() -> SessionRecord {
    let mut record = perfect_record("anna", 1);
    record.tasks[0].technique.as_mut().unwrap().stand_off_error_m = Some(3.0);
    record.tasks[3].technique.as_mut().unwrap().contacts.bridge = 2;
    (record.snapshots, record.hits) = (10, 2);
    record.end_reason = "abort".into();
    record
}

#[test]
fn exact_causes_follow_the_plan_and_are_at_most_three() {
    let (rules, steps) = (rules(), steps(&poor_record()));
    let chosen = chosen(causes(&steps, &rules));
    assert!((2..=MAX_POINTS).contains(&chosen.len()), "{}", chosen.len());
    let listed: Vec<&str> = steps
        .iter()
        .flat_map(|step| step.reasons.iter().filter(|reason| reason.consequence_of.is_none()))
        .map(|reason| reason.rule.as_str())
        .collect();
    let places: Vec<usize> =
        chosen.iter().map(|cause| listed.iter().position(|rule| *rule == cause.rule.name).unwrap()).collect();
    assert!(places.is_sorted() && places[0] == 0, "{places:?} of {listed:?}");
}

#[test]
fn prop_causes_have_no_duplicates() {
    let (rules, base) = (rules(), poor_record());
    for left_out in 0..base.tasks.len() {
        let mut record = base.clone();
        record.tasks[left_out] = perfect_record("anna", 1).tasks[left_out].clone();
        for cut in [0.5, 2.0, 10.0] {
            record.tasks.iter_mut().for_each(|task| task.speeding_s = cut);
            let steps = steps(&record);
            let chosen = chosen(causes(&steps, &rules));
            for (k, cause) in chosen.iter().enumerate() {
                assert!(chosen[..k].iter().all(|other| other.rule.name != cause.rule.name), "{}", cause.rule.name);
                let same = |other: &Cause<'_>| (other.rule.measure, other.rule.with) == (cause.rule.measure, cause.rule.with);
                assert!(!chosen[..k].iter().any(|other| same(other) && other.rule.lacked == cause.rule.lacked));
            }
        }
    }
}

#[test]
fn exact_one_habit_in_several_tasks_is_one_cause() {
    let mut record = perfect_record("anna", 1);
    for task in [0, 3] {
        record.tasks[task].technique.as_mut().unwrap().contacts.bridge = 2;
    }
    let (rules, steps) = (rules(), steps(&record));
    let chosen = chosen(causes(&steps, &rules));
    assert_eq!(chosen.iter().map(|cause| cause.tasks.clone()).collect::<Vec<_>>(), [vec![1, 4]]);
}

#[test]
fn exact_flight_without_findings_is_not_praised_falsely() {
    let perfect = perfect_record("anna", 1);
    assert_eq!(no_findings(&perfect, None, Language::English), "Nothing to correct: fly the next job.");
    let missed = || Some("You missed 2 of 9 defects.".to_owned());
    assert_eq!(
        no_findings(&perfect, missed(), Language::English),
        "You are certified, and no single mistake stands out. You missed 2 of 9 defects."
    );
    let mut record = perfect_record("anna", 1);
    (record.certified, record.unmet) = (false, vec!["precision 60, 70 needed".into()]);
    let words = "No single mistake stands out, but you are not certified yet: flight precision 60, 70 needed.";
    assert_eq!(no_findings(&record, None, Language::English), words);
    assert_eq!(no_findings(&record, missed(), Language::English), format!("{words} You missed 2 of 9 defects."));
    assert!(no_findings(&aborted_record("anna", 1), None, Language::English).contains("not finished"));
    let german = no_findings(&record, None, Language::German);
    assert_eq!(german, "Kein einzelner Fehler fällt auf, aber Sie sind noch nicht zertifiziert: Flugpräzision 60, 70 nötig.");
    let (rules, steps) = (rules(), steps(&perfect_record("anna", 1)));
    assert!(causes(&steps, &rules).is_empty(), "the job's own step is no cause");
}
