use super::*;
use crate::testing::{aborted_record, perfect_record};

const NOW: u64 = 1_700_000_000_000_000 + 864_000_000_000;

fn rules() -> PlanRules {
    read_rules("rules.toml", DEFAULT_RULES).unwrap()
}

/// Returns a record in which the rule's measure is `factor` times its limit.
fn record_with_measure(rule: &PlanRule, factor: f64) -> SessionRecord {
    let mut record = perfect_record("anna", 1);
    let value = factor * rule.limit;
    // Counts are integers. If the limit is 0.5, a count of 1 exceeds it and a count of 0 does not.
    let count = if factor > 1.0 { value.ceil().max(1.0) as usize } else { 0 };
    let mut crashes = Crashes::default();
    match rule.with {
        Some("terrain") => crashes.terrain = count,
        Some("water") => crashes.water = count,
        Some("vehicle") => crashes.vehicle = count,
        Some("person") => crashes.person = count,
        _ => crashes.bridge = count,
    }
    if rule.task == Some("free") {
        record.tasks[0].kind = "free".into();
    }
    let task = record.tasks.iter_mut().find(|task| rule.task.is_none_or(|kind| task.kind == kind)).unwrap();
    match rule.measure {
        RuleMeasure::OffPath => task.on_path = 1.0 - value,
        RuleMeasure::OffHeight => task.off_height_m = Some(value),
        RuleMeasure::Speeding => task.speeding_s = value * task.seconds,
        RuleMeasure::Crashes => task.crashes = crashes,
        RuleMeasure::NotAttempted => task.attempted = count == 0,
        RuleMeasure::CrashesOutside | RuleMeasure::CrashesAll => record.crashes_outside = crashes,
        RuleMeasure::Missed => {
            let missed = (10.0 * value + if factor > 1.0 { 0.999 } else { 0.0 }).floor() as usize;
            let lacked = format!("{}: 1 lx of 50 lx needed", rule.lacked);
            record
                .defects
                .iter_mut()
                .take(missed)
                .for_each(|defect| (defect.found, defect.lacked) = (false, vec![lacked.clone()]));
        }
        RuleMeasure::MissedSevere => record.defects[0].found = count == 0,
        RuleMeasure::MissedInView => (record.defects[0].found, record.defects[0].in_view_s) = (false, Some(value)),
        RuleMeasure::FalseSnapshots => (record.snapshots, record.hits) = (1000, (1000.0 * (1.0 - value)).round() as usize),
        RuleMeasure::Overtime => record.scores.efficiency = 100.0 - value * 5.0,
        RuleMeasure::NotLanded => record.end_reason = if count > 0 { "abort".into() } else { "landed".into() },
        RuleMeasure::BatteryLow => record.battery_at_end_pct = if count > 0 { 19.0 } else { 21.0 },
    }
    record
}

#[test]
fn exact_shipped_rules_apply_only_above_their_limit() {
    let rules = rules();
    for rule in &rules.rules {
        let fired = |factor: f64| {
            let plan = plan(&[record_with_measure(rule, factor)], &rules, NOW).unwrap();
            let step = plan.steps.into_iter().find(|step| step.reasons.iter().any(|reason| reason.rule == rule.name));
            step.map(|step| (step.scenario, step.reasons.into_iter().find(|reason| reason.rule == rule.name).unwrap().words))
        };
        let (scenario, words) = fired(1.2).unwrap_or_else(|| panic!("{} does not fire", rule.name));
        assert_eq!(scenario, rule.scenario);
        assert!(!words.contains(['{', '}']) && words.len() > 20, "{}: {words}", rule.name);
        assert_eq!(fired(0.8), None, "{} fires below its limit", rule.name);
    }
}

#[test]
fn exact_poor_interlayer_flight_recommends_gap_drill() {
    let mut record = perfect_record("anna", 1);
    record.tasks[2].on_path = 0.3;
    record.tasks[2].off_sideways_m = Some(0.4);
    record.tasks[2].off_height_m = Some(2.1);
    record.tasks[0].on_path = 0.85;
    let plan = plan(&[record], &rules(), NOW).unwrap();
    assert_eq!(plan.steps[0].scenario, "drill-gap");
    let words = &plan.steps[0].reasons[0].words;
    assert_eq!(words, "The interlayer: off the path for 70% of the time, mainly vertically. Practice flying in tight spaces.");
    assert_eq!(plan.steps[1].scenario, "drill-straight-line");
}

#[test]
fn exact_good_drill_flight_recommends_job() {
    let mut job = perfect_record("anna", 1);
    job.tasks[2].on_path = 0.3;
    let mut drill = perfect_record("anna", 2);
    drill.scenario = "drill-gap".into();
    drill.tasks.retain(|task| task.kind == "interlayer");
    drill.defects.clear();
    (drill.snapshots, drill.hits) = (0, 0);
    let plan = plan(&[job, drill], &rules(), NOW).unwrap();
    assert_eq!((plan.steps.len(), plan.steps[0].scenario.as_str()), (1, "two-bridges"));
    assert_eq!(plan.changes, None, "a drill must not be compared with the job");
}

#[test]
fn exact_refresher_is_recommended_after_long_break() {
    let record = perfect_record("anna", 0);
    let day = 86_400_000_000;
    let at = |days: u64| plan(std::slice::from_ref(&record), &rules(), record.started_unix_us + days * day).unwrap();
    assert!(!at(90).overdue);
    assert!(at(91).overdue);
    assert_eq!(at(91).steps[0].scenario, "practice");
    assert!(at(91).steps[0].reasons[0].words.contains("91 days"));
    assert_eq!(at(3).from_unix_us, record.started_unix_us + 2 * day);
    assert_eq!(at(3).until_unix_us, record.started_unix_us + 90 * day);
}

#[test]
fn exact_changes_mark_improvements_and_regressions() {
    let (mut then, mut now) = (perfect_record("anna", 1), perfect_record("anna", 2));
    then.scores.safety = 64.0;
    then.tasks[1].crashes.bridge = 12;
    now.scores.accuracy = Some(60.0);
    let mut drill = perfect_record("anna", 1);
    drill.scenario = "drill-gap".into();
    let changes = plan(&[then, drill, now], &rules(), NOW).unwrap().changes.unwrap();
    let of = |what: &str| changes.changes.iter().find(|change| change.what == what).unwrap();
    assert_eq!(changes.since, "session-anna-001");
    assert_eq!((of("safety").before, of("safety").now, of("safety").better), (64.0, 100.0, Some(true)));
    assert_eq!(of("accuracy").better, Some(false));
    assert_eq!(of("efficiency").better, None);
    assert_eq!((of("The arch_bottom: crashes").better, of("crashes: bridge").before), (Some(true), 12.0));
}

#[test]
fn exact_no_plan_without_sessions() {
    assert_eq!(plan(&[], &rules(), NOW), None);
}

#[test]
fn exact_braces_in_task_names_are_not_expanded() {
    let mut record = perfect_record("anna", 1);
    record.tasks[2].name = "{value} {axis}".into();
    record.tasks[2].on_path = 0.5;
    let plan = plan(&[record], &rules(), NOW).unwrap();
    assert!(plan.steps[0].reasons[0].words.starts_with("{value} {axis}: off the path for 50%"));
}

#[test]
fn regress_plan_excludes_and_counts_incomplete_sessions() {
    let records = vec![perfect_record("anna", 1), aborted_record("anna", 2)];
    let of = |records: &[SessionRecord], incomplete| plan_for_policy(records.to_vec(), incomplete, &rules(), NOW).unwrap();
    let without = of(&records, IncompletePolicy::Exclude);
    assert_eq!((without.session.as_str(), without.left_out), ("session-anna-001", 1));
    let with = of(&records, IncompletePolicy::Include);
    assert_eq!((with.session.as_str(), with.left_out), ("session-anna-002", 0));
    let none = of(&records[1..], IncompletePolicy::Exclude);
    assert_eq!((none.steps[0].scenario.as_str(), none.left_out), (rules().job.as_str(), 1));
    assert!(none.steps[0].reasons[0].words.contains("Incomplete: 0 of 4 tasks, 15% of the path"), "{:?}", none.steps);
}

#[test]
fn regress_missed_visible_severe_defect_is_reported() {
    let mut record = perfect_record("anna", 1);
    record.defects[3].found = false;
    record.defects[3].kind_name = "spalling".into();
    record.defects[3].in_view_s = Some(5.5);
    let plan = plan(&[record], &rules(), NOW).unwrap();
    let words: Vec<&str> = plan.steps.iter().flat_map(|step| &step.reasons).map(|reason| reason.words.as_str()).collect();
    assert!(words.iter().all(|words| !words.contains("No particular weakness found")), "{words:?}");
    let plain = words.iter().find(|words| words.contains("Clearly visible for up to 5.5 s")).unwrap();
    assert!(plain.contains("defect 4 (spalling, condition state 3)"), "{plain}");
    assert_eq!(plan.steps[0].scenario, "practice");
}
