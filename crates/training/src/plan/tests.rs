use super::*;
use crate::record::{CertificationRecord, Crashes, DefectRecord, SessionLevel, TaskRecord};
use crate::testing::{aborted_record, perfect_record, untranslated_word};
use spandrel_monitor::score::certification::CertificationScores;
use spandrel_monitor::score::completion::TaskState;

const NOW: u64 = 1_700_000_000_000_000 + 864_000_000_000;

fn rules() -> PlanRules {
    read_rules("rules.toml", DEFAULT_RULES).unwrap()
}

fn sets(crashes: &mut Crashes, with: Option<&str>, count: usize) {
    match with {
        Some("terrain") => crashes.terrain = count,
        Some("water") => crashes.water = count,
        Some("vehicle") => crashes.vehicle = count,
        Some("person") => crashes.person = count,
        Some("other") => crashes.other = count,
        _ => crashes.bridge = count,
    }
}

/// Sets a measure of one task.
fn set_task(task: &mut TaskRecord, measure: TaskMeasure, value: f64, crashes: Crashes) {
    let technique = task.technique.as_mut().unwrap();
    match measure {
        TaskMeasure::OffPath => task.on_path = 1.0 - value,
        TaskMeasure::OffHeight => (task.off_height_m, task.on_path) = (Some(value), 0.85),
        TaskMeasure::Speeding => task.speeding_s = value * task.seconds,
        TaskMeasure::Crashes => technique.contacts = crashes,
        TaskMeasure::NotAttempted => {
            if value >= 1.0 {
                (task.attempted, task.covered, technique.passed) = (false, Some(0.0), 0.3);
            }
        }
        TaskMeasure::NotCovered => (task.covered, technique.passed) = (Some(1.0 - value), 1.0 - value),
        TaskMeasure::BesidePath => task.covered = Some(1.0 - value),
        TaskMeasure::TooFar => technique.stand_off_error_m = Some(value),
        TaskMeasure::TooClose => technique.stand_off_error_m = Some(-value),
        TaskMeasure::UnevenStandOff => technique.stand_off_spread_m = Some(value),
        TaskMeasure::TooLow => technique.height_error_m = Some(-value),
        TaskMeasure::TooHigh => technique.height_error_m = Some(value),
        TaskMeasure::UnevenHeight => technique.height_spread_m = Some(value),
        TaskMeasure::LowClearance => technique.low_clearance = value,
        TaskMeasure::Framing => technique.rms_framing_deg = Some(value),
        TaskMeasure::LampOff => technique.lamp_off = Some(value),
        TaskMeasure::StickReversals => technique.stick_reversals_per_min = value,
        TaskMeasure::YawReversals => technique.yaw_reversals_per_min = value,
        TaskMeasure::StickJumps => technique.stick_jumps_per_min = Some(value),
        TaskMeasure::UnlitPictures => (technique.pictures, technique.unlit_pictures) = (Some(2), Some(value)),
        TaskMeasure::MissedAtTask => {
            (task.state, task.defects_placed, task.defects_found) =
                (Some(TaskState::Done), 100, (100.0 * (1.0 - value)).round() as usize);
        }
    }
}

/// Marks the given fraction of the first ten defects, rounded up above the limit.
fn mark_defects(record: &mut SessionRecord, value: f64, mark: impl Fn(&mut DefectRecord)) {
    let marked = (10.0 * value).ceil() as usize;
    record.defects.iter_mut().take(marked).for_each(mark);
}

fn set_session(record: &mut SessionRecord, rule: &PlanRule, measure: SessionMeasure, (value, crashes): (f64, Crashes)) {
    let over = value > rule.limit;
    let reason = format!("{}: 1 of 50 needed", rule.lacked);
    match measure {
        SessionMeasure::CrashesOutside | SessionMeasure::CrashesAll => {
            record.technique.as_mut().unwrap().contacts_outside = crashes;
        }
        SessionMeasure::Missed => {
            mark_defects(record, value, |defect| (defect.found, defect.lacked) = (false, vec![reason.clone()]));
            if !over {
                record.defects[0] = perfect_record("anna", 1).defects[0].clone();
            }
        }
        SessionMeasure::MissedSevere => record.defects.iter_mut().take(value as usize).for_each(|defect| defect.found = false),
        SessionMeasure::MissedInView => (record.defects[0].found, record.defects[0].in_view_s) = (false, Some(value)),
        SessionMeasure::MissedHidden | SessionMeasure::MissedLines => {
            let hidden = measure == SessionMeasure::MissedHidden;
            for (k, defect) in record.defects.iter_mut().enumerate() {
                (defect.hidden, defect.line, defect.condition_state) = (hidden, !hidden, 2);
                defect.found = k as f64 >= 10.0 * value;
            }
        }
        SessionMeasure::PoorPictures => mark_defects(record, value, |defect| defect.shortfalls = vec![reason.clone()]),
        SessionMeasure::NoPictures => record.snapshots = if over { 0 } else { 10 },
        SessionMeasure::FalseSnapshots => (record.snapshots, record.hits) = (1000, (1000.0 * (1.0 - value)).round() as usize),
        SessionMeasure::MovingPictures => record.technique.as_mut().unwrap().moving_pictures = Some(value),
        SessionMeasure::TurningPictures => record.technique.as_mut().unwrap().turning_pictures = Some(value),
        SessionMeasure::Landing => record.technique.as_mut().unwrap().landing_s = Some(value),
        SessionMeasure::DriftingPictures => record.technique.as_mut().unwrap().drifting_pictures = Some(value),
        SessionMeasure::Slow => record.certification = Some(certification_with_time(1.0 + value)),
        SessionMeasure::Overtime => record.scores.efficiency = 100.0 - value * 5.0,
        SessionMeasure::NotLanded => record.end_reason = if over { "abort".into() } else { "landed".into() },
        SessionMeasure::BatteryLow => record.battery_at_end_pct = if over { 19.0 } else { 21.0 },
        SessionMeasure::BatteryFailed => record.battery_failed = over,
        SessionMeasure::Exposure => record.technique.as_mut().unwrap().exposure_s = value,
    }
}

fn certification_with_time(ratio: f64) -> CertificationRecord {
    let perfect = Some(100.0);
    let (conformity, accuracy, precision, safety) = (perfect, perfect, perfect, 100.0);
    let efficiency = 100.0 * (2.0 - ratio).clamp(0.0, 1.0);
    let scores =
        CertificationScores { conformity, efficiency, safety, accuracy, precision, sum: 400.0 + efficiency, sum_max: 500.0 };
    CertificationRecord { scores, requirements: Vec::new(), precision: None, time_ratio: Some(ratio) }
}

/// Returns a record in which the rule's measure is `factor` times its limit.
fn record_with_measure(rule: &PlanRule, factor: f64) -> SessionRecord {
    let mut record = perfect_record("anna", 1);
    // Counts are integers. If the limit is 0.5, a count of 1 exceeds it and a count of 0 does not.
    let is_count = rule.measure.unit() == MeasureUnit::Count;
    let value = match (is_count, factor > 1.0) {
        (true, true) => (factor * rule.limit).ceil(),
        (true, false) => 0.0,
        (false, _) => factor * rule.limit,
    };
    let mut crashes = Crashes::default();
    sets(&mut crashes, rule.with, value as usize);
    match rule.measure {
        RuleMeasure::Task(measure) => {
            if let Some(kind) = rule.task.filter(|kind| record.tasks.iter().all(|task| task.kind != *kind)) {
                record.tasks[0].kind = kind.into();
            }
            let fits = |task: &&mut TaskRecord| rule.task.is_none_or(|kind| task.kind == kind);
            record.tasks.iter_mut().filter(fits).take(rule.in_tasks).for_each(|task| set_task(task, measure, value, crashes));
        }
        RuleMeasure::Session(measure) => set_session(&mut record, rule, measure, (value, crashes)),
    }
    record
}

fn reason_of<'a>(plan: &'a TrainingPlan, rule: &str) -> Option<(&'a PlanStep, &'a PlanReason)> {
    plan.steps.iter().find_map(|step| Some(step).zip(step.reasons.iter().find(|reason| reason.rule == rule)))
}

#[test]
fn exact_shipped_rules_apply_only_above_their_limit() {
    let rules = PlanRules { steps: 20, focus: 0.0, ..rules() };
    for rule in &rules.rules {
        let of = |factor: f64| plan(&[record_with_measure(rule, factor)], &rules, NOW, Language::English).unwrap();
        let plan = of(1.2);
        let (step, reason) = reason_of(&plan, &rule.name).unwrap_or_else(|| panic!("{} does not fire", rule.name));
        if reason.consequence_of.is_none() {
            assert_eq!(step.scenario, rule.scenario, "{}", rule.name);
        }
        let words = &reason.words;
        assert!(!words.contains(['{', '}']) && words.len() > 20, "{}: {words}", rule.name);
        assert_eq!(reason_of(&of(0.8), &rule.name), None, "{} fires below its limit", rule.name);
    }
}

#[test]
fn exact_few_pictures_and_short_tasks_show_no_habit() {
    let of = |rule: &str, less: fn(&mut SessionRecord)| {
        let rules = PlanRules { steps: 20, focus: 0.0, ..rules() };
        let mut record = record_with_measure(rules.rules.iter().find(|one| one.name == rule).unwrap(), 1.2);
        let fires = |record: &SessionRecord| {
            reason_of(&plan(std::slice::from_ref(record), &rules, NOW, Language::English).unwrap(), rule).is_some()
        };
        let before = fires(&record);
        less(&mut record);
        (before, fires(&record))
    };
    let shorter: fn(&mut SessionRecord) = |record| record.tasks.iter_mut().for_each(|task| technique(task).near_s = 19.9);
    for rule in ["lamp off", "poor framing", "unsteady heading", "jerky sticks", "uneven height in one task"] {
        assert_eq!(of(rule, shorter), (true, false), "{rule}");
    }
    assert_eq!(of("too far in one task", shorter), (true, true), "a distance needs no time");
    let one_picture: fn(&mut SessionRecord) =
        |record| record.tasks.iter_mut().for_each(|task| technique(task).pictures = Some(1));
    assert_eq!(of("pictures with the lamp off", one_picture), (true, false));
    assert_eq!(of("pictures of nothing", |record| (record.snapshots, record.hits) = (3, 0)), (true, false));
    assert_eq!(of("pictures of nothing", |record| record.defects.clear()), (true, false), "nothing to photograph");
}

fn technique(task: &mut TaskRecord) -> &mut crate::record::TaskTechnique {
    task.technique.as_mut().unwrap()
}

/// Returns the names of the rules that recommend the first scenario, and those of their consequences.
fn first_step(record: SessionRecord) -> (String, Vec<String>, Vec<String>) {
    let plan = plan(&[record], &rules(), NOW, Language::English).unwrap();
    let first = &plan.steps[0];
    let (causes, effects): (Vec<_>, Vec<_>) = first.reasons.iter().partition(|reason| reason.consequence_of.is_none());
    let names = |reasons: Vec<&PlanReason>| reasons.iter().map(|reason| reason.rule.clone()).collect();
    (first.scenario.clone(), names(causes), names(effects))
}

#[test]
fn exact_cause_outranks_its_consequences() {
    let mut record = perfect_record("anna", 1);
    // 20 crashes are far more than their limit of 0.5, but speeding causes them.
    record.tasks[1].speeding_s = 30.0;
    record.tasks[1].technique.as_mut().unwrap().contacts.bridge = 20;
    let (scenario, causes, effects) = first_step(record.clone());
    assert_eq!((scenario.as_str(), causes), ("drill-curve-under-arch", vec!["too fast in one task".to_owned()]));
    assert_eq!(effects, ["crashes in one task"]);
    // Speeding in another task explains nothing here.
    (record.tasks[1].speeding_s, record.tasks[0].speeding_s) = (0.0, 30.0);
    let (scenario, causes, effects) = first_step(record);
    assert_eq!((scenario.as_str(), causes), ("drill-curve-under-arch", vec!["crashes in one task".to_owned()]));
    assert!(effects.is_empty());
}

#[test]
fn exact_chain_of_causes_ends_at_the_first() {
    let mut record = perfect_record("anna", 1);
    for task in &mut record.tasks {
        let technique = task.technique.as_mut().unwrap();
        (technique.yaw_reversals_per_min, technique.rms_framing_deg) = (100.0, Some(60.0));
    }
    for defect in &mut record.defects {
        (defect.found, defect.lacked) = (false, vec!["too oblique: 70 deg, limit 60 deg".into()]);
    }
    let plan = plan(&[record], &rules(), NOW, Language::English).unwrap();
    assert_eq!(plan.steps.len(), 1, "{:?}", plan.steps);
    let effects = plan.steps[0].reasons.iter().filter(|reason| reason.consequence_of.is_some());
    assert!(effects.clone().count() >= 4);
    assert!(effects.clone().all(|reason| reason.consequence_of.as_deref() == Some("unsteady heading")), "{:?}", plan.steps);
}

#[test]
fn exact_flight_beside_the_paths_is_not_called_skipped() {
    let mut record = perfect_record("anna", 1);
    for task in &mut record.tasks {
        (task.attempted, task.covered, task.state) = (false, Some(0.0), Some(TaskState::NotAttempted));
        task.technique.as_mut().unwrap().stand_off_error_m = Some(4.0);
    }
    let (scenario, causes, effects) = first_step(record);
    assert_eq!(scenario, "drill-stand-off");
    assert!(causes.contains(&"too far from the surface".to_owned()) && effects.iter().any(|rule| rule.starts_with("beside ")));
    assert!(!causes.iter().chain(&effects).any(|rule| rule.contains("not attempted")), "{causes:?} {effects:?}");
}

#[test]
fn exact_records_before_format_4_use_unmerged_crashes() {
    let mut record = perfect_record("anna", 1);
    record.technique = None;
    record.tasks.iter_mut().for_each(|task| task.technique = None);
    record.tasks[1].crashes.bridge = 3;
    let (scenario, causes, _) = first_step(record);
    assert_eq!((scenario.as_str(), causes), ("drill-curve-under-arch", vec!["crashes in one task".to_owned()]));
}

#[test]
fn exact_rule_without_its_scenario_uses_the_alternative() {
    let rules = rules().for_installed(|name| name != "drill-lamp");
    let lamp = rules.rules.iter().find(|rule| rule.name == "lamp off").unwrap();
    assert_eq!(lamp.scenario, "practice");
    assert!(rules.rules.iter().any(|rule| rule.scenario == "drill-framing"));
}

#[test]
fn exact_poor_interlayer_flight_recommends_gap_drill() {
    let mut record = perfect_record("anna", 1);
    record.tasks[2].on_path = 0.3;
    record.tasks[2].off_sideways_m = Some(0.4);
    record.tasks[2].off_height_m = Some(2.1);
    record.tasks[0].on_path = 0.6;
    let plan = plan(&[record], &rules(), NOW, Language::English).unwrap();
    assert_eq!(plan.steps[0].scenario, "drill-gap");
    let words = &plan.steps[0].reasons[0].words;
    assert_eq!(words, "The interlayer: off the path for 70% of the time, mainly vertically. Practice following the path.");
    assert_eq!(plan.steps[1].scenario, "drill-straight-line");
}

/// Returns a session of the gap drill; `on_path` is its on-path share.
fn gap_drill(number: usize, on_path: f64) -> SessionRecord {
    let mut drill = perfect_record("anna", number);
    drill.scenario = "drill-gap".into();
    drill.tasks.retain(|task| task.kind == "interlayer");
    drill.tasks[0].on_path = on_path;
    drill.defects.clear();
    (drill.snapshots, drill.hits) = (0, 0);
    drill
}

#[test]
fn exact_drill_is_done_after_two_of_three_sessions_at_its_criterion() {
    let mut job = perfect_record("anna", 1);
    job.tasks[2].on_path = 0.3;
    let of = |drills: &[f64]| {
        let flown = drills.iter().zip(2..).map(|(on_path, number)| gap_drill(number, *on_path));
        let records: Vec<SessionRecord> = std::iter::once(job.clone()).chain(flown).collect();
        let plan = plan(&records, &rules(), NOW, Language::English).unwrap();
        assert_eq!(plan.changes.is_some(), drills.len() > 1, "a drill must not be compared with the job");
        let progress = plan.drills.iter().find(|drill| drill.scenario == "drill-gap").unwrap();
        (plan.steps[0].scenario.clone(), progress.met, progress.done, progress.words(Language::English))
    };
    let (scenario, met, done, words) = of(&[]);
    assert_eq!((scenario.as_str(), met, done), ("drill-gap", 0, false));
    assert!(words.starts_with("not flown yet; done after 2 of 3 sessions"), "{words}");
    let (scenario, met, done, words) = of(&[0.95]);
    assert_eq!((scenario.as_str(), met, done), ("drill-gap", 1, false));
    assert!(words.contains("1 of 1 session met the criterion; done after 2 of 3 (complete, off path at most 10%"), "{words}");
    for done_now in [&[0.95, 0.95][..], &[0.95, 0.5, 0.95], &[0.5, 0.95, 0.95], &[0.5, 0.5, 0.95, 0.95]] {
        let (scenario, met, done, _) = of(done_now);
        assert_eq!((scenario.as_str(), met, done), ("two-bridges", 2, true), "{done_now:?}");
    }
    for open in [&[0.95, 0.5][..], &[0.95, 0.5, 0.5], &[0.95, 0.95, 0.5, 0.5]] {
        assert_eq!((of(open).0.as_str(), of(open).2), ("drill-gap", false), "{open:?}");
    }
}

#[test]
fn exact_only_jobs_are_slow() {
    let slow = |mut record: SessionRecord| {
        record.certification = Some(certification_with_time(2.5));
        record
    };
    let mut lesson = perfect_record("anna", 1);
    lesson.scenario = LESSON.into();
    for exercise in [gap_drill(2, 1.0), lesson] {
        let plan = plan(&[slow(exercise)], &rules(), NOW, Language::English).unwrap();
        assert_eq!(reason_of(&plan, "slow for the job"), None);
    }
    let plan = plan(&[slow(perfect_record("anna", 1)), gap_drill(2, 1.0)], &rules(), NOW, Language::English).unwrap();
    let (_, reason) = reason_of(&plan, "slow for the job").unwrap();
    assert_eq!(reason.session, "session-anna-001", "a drill afterward does not answer the question");
    assert!(reason.words.contains("took 150% longer"), "{}", reason.words);
}

#[test]
fn exact_done_drill_is_recommended_again_after_a_poor_flight() {
    let mut poor = perfect_record("anna", 4);
    poor.tasks[2].on_path = 0.3;
    let records = [gap_drill(2, 1.0), gap_drill(3, 1.0), poor];
    let plan = plan(&records, &rules(), NOW, Language::English).unwrap();
    assert_eq!(plan.steps[0].scenario, "drill-gap");
    assert!(plan.drills[0].done);
}

#[test]
fn exact_incomplete_drill_does_not_meet_its_criterion() {
    let mut broken_off = gap_drill(3, 1.0);
    broken_off.completion.as_mut().unwrap().complete = false;
    let records = vec![gap_drill(2, 1.0), broken_off, gap_drill(4, 0.5)];
    let plan = plan_for_policy(records, IncompletePolicy::Exclude, &rules(), NOW, Language::English).unwrap();
    assert_eq!((plan.drills[0].sessions, plan.drills[0].met, plan.drills[0].done), (3, 1, false));
}

#[test]
fn exact_scenarios_far_less_urgent_than_the_first_are_omitted() {
    let mut record = perfect_record("anna", 1);
    // Urgencies: 1 + log2 7 = 3.8 for the interlayer, 1 + log2 1.2 = 1.3 for the slab.
    (record.tasks[2].on_path, record.tasks[0].on_path) = (0.3, 0.88);
    let names = |focus: f64| {
        let plan = plan(std::slice::from_ref(&record), &PlanRules { focus, ..rules() }, NOW, Language::English).unwrap();
        plan.steps.into_iter().map(|step| step.scenario).collect::<Vec<_>>()
    };
    assert_eq!(names(0.4), ["drill-gap"]);
    assert_eq!(names(0.2), ["drill-gap", "drill-straight-line"]);
}

#[test]
fn exact_refresher_is_recommended_after_long_break() {
    let record = perfect_record("anna", 0);
    let day = 86_400_000_000;
    let at = |days: u64| {
        plan(std::slice::from_ref(&record), &rules(), record.started_unix_us + days * day, Language::English).unwrap()
    };
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
    let changes = plan(&[then, drill, now], &rules(), NOW, Language::English).unwrap().changes.unwrap();
    let of = |what: &str| changes.changes.iter().find(|change| change.what == what).unwrap();
    assert_eq!(changes.since, "session-anna-001");
    assert_eq!((of("safety").before, of("safety").now, of("safety").better), (64.0, 100.0, Some(true)));
    assert_eq!(of("accuracy").better, Some(false));
    assert_eq!(of("efficiency").better, None);
    assert_eq!((of("The arch_bottom: crashes").better, of("crashes: bridge").before), (Some(true), 12.0));
}

#[test]
fn exact_no_plan_without_sessions() {
    assert_eq!(plan(&[], &rules(), NOW, Language::English), None);
}

#[test]
fn exact_braces_in_task_names_are_not_expanded() {
    let mut record = perfect_record("anna", 1);
    record.tasks[2].name = "{value} {axis}".into();
    record.tasks[2].on_path = 0.5;
    let plan = plan(&[record], &rules(), NOW, Language::English).unwrap();
    assert!(plan.steps[0].reasons[0].words.starts_with("{value} {axis}: off the path for 50%"));
}

#[test]
fn regress_latest_session_counts_for_the_rules_even_if_incomplete() {
    let records = vec![perfect_record("anna", 1), aborted_record("anna", 2), aborted_record("anna", 3)];
    let of = |records: &[SessionRecord], incomplete| {
        plan_for_policy(records.to_vec(), incomplete, &rules(), NOW, Language::English).unwrap()
    };
    let without = of(&records, IncompletePolicy::Exclude);
    assert_eq!((without.session.as_str(), without.left_out), ("session-anna-003", 1));
    let note = without.note.as_ref().unwrap();
    assert!(note.contains("Incomplete: 0 of 4 tasks, 15% of the path"), "{note}");
    assert_eq!(without.changes, None, "an incomplete session is not compared");
    let skipped = reason_of(&without, "several tasks not attempted").unwrap().1;
    assert_eq!(skipped.words, "3 of 4 tasks were not flown. The practice job has short paths: fly every task to its end.");
    let with = of(&records, IncompletePolicy::Include);
    assert_eq!((with.session.as_str(), with.left_out, &with.note), ("session-anna-003", 0, &None));
    assert!(with.changes.is_some());
    // A complete flight afterward answers the question of what was not flown.
    let after = of(&[records[1].clone(), perfect_record("anna", 4)], IncompletePolicy::Exclude);
    assert_eq!((after.steps[0].scenario.as_str(), after.left_out, after.note), (rules().job.as_str(), 1, None));
}

#[test]
fn regress_unflown_task_keeps_the_advice_of_its_last_flight() {
    let (mut before, mut now) = (perfect_record("anna", 1), perfect_record("anna", 2));
    before.tasks[1].on_path = 0.5;
    (now.tasks[1].attempted, now.tasks[1].covered) = (false, Some(0.0));
    now.tasks[1].technique = Some(crate::record::TaskTechnique::default());
    let plan = plan(&[before, now], &rules(), NOW, Language::English).unwrap();
    assert_eq!(reason_of(&plan, "off the path in one task").unwrap().1.session, "session-anna-001");
    assert_eq!(reason_of(&plan, "task not attempted").unwrap().1.session, "session-anna-002");
}

#[test]
fn regress_missed_visible_severe_defect_is_reported() {
    let mut record = perfect_record("anna", 1);
    record.defects[3].found = false;
    record.defects[3].kind_name = "spalling".into();
    record.defects[3].in_view_s = Some(5.5);
    let plan = plan(&[record], &rules(), NOW, Language::English).unwrap();
    let words: Vec<&str> = plan.steps.iter().flat_map(|step| &step.reasons).map(|reason| reason.words.as_str()).collect();
    assert!(words.iter().all(|words| !words.contains("No particular weakness found")), "{words:?}");
    let plain = words.iter().find(|words| words.contains("Clearly visible for up to 5.5 s")).unwrap();
    assert!(plain.contains("defect 4 (spalling, condition state 3)"), "{plain}");
    assert_eq!(plan.steps[0].scenario, "drill-search");
}

/// Returns a session of the gap drill at a difficulty level.
fn gap_drill_at(number: usize, level: u8, met: bool) -> SessionRecord {
    let mut drill = gap_drill(number, if met { 1.0 } else { 0.5 });
    drill.level = Some(SessionLevel { level, levels: 9, standard: 5 });
    drill
}

/// Returns the plan after sessions of the gap drill at these levels, with whether they met the criterion.
fn plan_after(flown: &[(u8, bool)], rules: &PlanRules) -> TrainingPlan {
    let records: Vec<SessionRecord> = (1..).zip(flown).map(|(number, (level, met))| gap_drill_at(number, *level, *met)).collect();
    plan(&records, rules, NOW, Language::English).unwrap()
}

#[test]
fn exact_plan_names_the_level_and_the_reason() {
    let rules = rules().with_shipped_levels();
    let level = |flown: &[(u8, bool)]| plan_after(flown, &rules).steps[0].level.clone().unwrap();
    let after_success = level(&[(5, true)]);
    assert_eq!((after_success.level, after_success.levels, after_success.standard), (6, 9, 5));
    let words = "Level 6 of 9 (wind 1.99 m/s, gap 3.25 m): the last session met the criterion at level 5.";
    assert_eq!(after_success.words, words);
    assert_eq!(level(&[(5, false)]).level, 3);
    let mut job = perfect_record("anna", 1);
    job.tasks[2].on_path = 0.3;
    let first = plan(&[job], &rules, NOW, Language::English).unwrap();
    assert_eq!(first.steps[0].scenario, "drill-gap");
    assert!(
        first.steps[0].level.as_ref().unwrap().words.starts_with("Level 5 of 9 (wind 0.98 m/s, gap 3.4 m): start at this level")
    );
    // An incomplete session did not meet the criterion, although the policy leaves it out otherwise.
    let mut broken_off = gap_drill_at(1, 5, true);
    broken_off.completion.as_mut().unwrap().complete = false;
    let records = vec![broken_off, gap_drill_at(2, 3, true)];
    let plan = plan_for_policy(records, IncompletePolicy::Exclude, &rules, NOW, Language::English).unwrap();
    assert_eq!(plan.drills[0].next_level.as_ref().unwrap().level, 4);
    // A session of an older version has no level: its values are those of the standard level.
    let older = super::plan(&[gap_drill(1, 1.0)], &rules, NOW, Language::English).unwrap();
    assert_eq!(older.steps[0].level.as_ref().unwrap().level, 6);
}

#[test]
fn exact_mastery_counts_sessions_that_decide_about_the_standard_level() {
    let rules = rules().with_shipped_levels();
    let progress = |flown: &[(u8, bool)]| plan_after(flown, &rules).drills[0].clone();
    let counted = |flown: &[(u8, bool)]| (progress(flown).met, progress(flown).counted, progress(flown).done);
    assert_eq!(counted(&[(5, true), (6, true)]), (2, 2, true));
    // Mastering an easier level says nothing about the standard level, nor does failing at a harder one.
    assert_eq!(counted(&[(3, true), (4, true)]), (0, 0, false));
    assert_eq!(counted(&[(5, true), (6, true), (7, false), (9, false)]), (2, 2, true));
    assert_eq!(counted(&[(5, true), (6, true), (4, false), (2, false)]), (1, 3, false));
    assert_eq!(counted(&[(5, false), (3, true), (4, true), (5, true), (6, true)]), (2, 3, true));
    let words = progress(&[(3, true)]).words(Language::English);
    assert!(words.starts_with("no session at the standard level yet; done after 2 of 3 at the criterion (complete, "), "{words}");
    assert!(words.ends_with("crashes in the whole session, level 5 or harder)"), "{words}");
}

#[test]
fn exact_rewound_sessions_neither_master_a_drill_nor_change_its_level() {
    let rules = rules().with_shipped_levels();
    let mut records = vec![gap_drill_at(1, 5, true), gap_drill_at(2, 6, true)];
    let done = |records: &[SessionRecord]| plan(records, &rules, NOW, Language::English).unwrap().drills[0].clone();
    assert!(done(&records).done);
    let level = |records: &[SessionRecord]| done(records).next_level.unwrap().level;
    assert_eq!(level(&records), 7);
    records[1].practice_aids.rewinds = 1;
    let drill = done(&records);
    assert_eq!((drill.sessions, drill.met, drill.counted, drill.done), (2, 1, 1, false));
    assert_eq!(level(&records), 6, "the level follows the first session");
    records[0].practice_aids.freezes = 1;
    assert_eq!(done(&records).counted, 0);
}

#[test]
fn exact_levels_can_be_switched_off_and_changed() {
    let read = |from: &str, to: &str| {
        assert!(DEFAULT_RULES.contains(from), "{from}");
        read_rules("rules.toml", &DEFAULT_RULES.replacen(from, to, 1))
    };
    let off = read("adapt = true", "adapt = false").unwrap().with_shipped_levels();
    let plan = plan_after(&[(5, true)], &off);
    assert!(plan.steps.iter().all(|step| step.level.is_none()) && plan.drills[0].next_level.is_none());
    let other = read("up = 1\ndown = 2", "up = 2\ndown = 3").unwrap().with_shipped_levels();
    assert_eq!(plan_after(&[(5, true), (7, false)], &other).steps[0].level.as_ref().unwrap().level, 4);
    let error = read("down = 2", "down = 0").unwrap_err().to_string();
    assert!(error.ends_with("difficulty.down = 0: out of range (allowed: whole number 1 to 19)"), "{error}");
    let before = DEFAULT_RULES.replacen("[difficulty]\nadapt = true\nfirst = 0\nup = 1\ndown = 2\n", "", 1);
    assert_eq!(read_rules("rules.toml", &before).unwrap().staircase, rules().staircase, "rules written before there were levels");
}

#[test]
fn exact_sessions_at_different_levels_are_not_compared() {
    let changes = |levels: [u8; 2]| plan_after(&[(levels[0], true), (levels[1], true)], &rules()).changes;
    assert!(changes([5, 6]).is_none() && changes([6, 6]).is_some());
    let standard = [gap_drill(1, 1.0), gap_drill_at(2, 5, true)];
    assert!(
        plan(&standard, &rules(), NOW, Language::English).unwrap().changes.is_some(),
        "an older session was flown at the standard level"
    );
    assert_eq!(gap_drill_at(1, 6, true).scenario_with_level(), "drill-gap@6");
    assert_eq!(gap_drill_at(1, 5, true).scenario_with_level(), "drill-gap");
    let mut invalid = gap_drill_at(1, 5, true);
    invalid.level = Some(SessionLevel { level: 10, levels: 9, standard: 5 });
    assert_eq!(invalid.check().unwrap_err(), "level.level = 10, level.standard = 5 (allowed: 1 to 9)");
}

#[test]
fn exact_default_reasons_are_translated_by_their_rule_and_others_are_not() {
    let rules = PlanRules { steps: 20, focus: 0.0, ..rules() };
    for rule in &rules.rules {
        let record = record_with_measure(rule, 1.2);
        let words = |rules: &PlanRules, language| {
            let plan = plan(std::slice::from_ref(&record), rules, NOW, language).unwrap();
            let reasons = plan.steps.into_iter().flat_map(|step| step.reasons);
            reasons.filter(|reason| reason.rule == rule.name).map(|reason| reason.words).collect::<Vec<_>>()
        };
        let (english, german) = (words(&rules, Language::English), words(&rules, Language::German));
        assert!(!english.is_empty() && english.iter().zip(&german).all(|(a, b)| a != b), "{}: {english:?} {german:?}", rule.name);
        let mut own = rules.clone();
        own.rules.iter_mut().for_each(|rule| rule.reason = "Fly better.".into());
        assert!(words(&own, Language::German).iter().all(|words| words == "Fly better."));
    }
}

#[test]
fn exact_plan_is_in_the_language_of_the_page() {
    let rules = rules().with_shipped_levels();
    let records = [gap_drill_at(1, 5, true), gap_drill_at(2, 6, false)];
    let shown = |language| {
        let plan = plan(&records, &rules, NOW, language).unwrap();
        let reasons = plan.steps.iter().flat_map(|step| &step.reasons).map(|reason| reason.words.clone());
        let drills = plan.drills.iter().map(|drill| drill.words(language));
        reasons.chain(drills).collect::<Vec<_>>().join("\n")
    };
    let german = shown(Language::German);
    assert!(german.contains("Diese Übung ist noch nicht abgeschlossen: 1 von 1 Sitzung"), "{german}");
    let pseudo = shown(Language::Pseudo);
    assert_eq!(untranslated_word(&pseudo, &["The", "interlayer"]), None, "the task's name is not that of the job: {pseudo}");
    let advice = plan(&records, &rules, NOW, Language::German).unwrap().drills[0].next_level.clone().unwrap();
    assert!(advice.words.starts_with("Stufe 4 von 9") && advice.words.contains("Die letzte Sitzung"), "{}", advice.words);
    let changes = plan(&[perfect_record("anna", 1), perfect_record("anna", 2)], &rules, NOW, Language::German).unwrap().changes;
    let title = changes.unwrap().changes[5].title("two-bridges", Language::German);
    assert!(title.contains("Anteil auf der Bahn") || title.contains("Zeit über"), "{title}");
}

#[test]
fn exact_every_kind_of_task_has_rules_for_what_was_not_flown_and_off_its_path() {
    use spandrel_model::scenario::TaskKind;
    let rules = rules();
    for kind in TaskKind::ALL.iter().map(|kind| kind.key()).filter(|kind| *kind != "free") {
        for measure in [TaskMeasure::NotAttempted, TaskMeasure::NotCovered, TaskMeasure::OffPath] {
            let fits = |rule: &&PlanRule| rule.task == Some(kind) && rule.measure == RuleMeasure::Task(measure);
            let rule = rules.rules.iter().find(fits).unwrap_or_else(|| panic!("{kind}: no rule on {measure:?}"));
            assert!(SCENARIOS.iter().any(|(name, _)| *name == rule.scenario), "{kind}: {}", rule.scenario);
        }
    }
}

#[test]
fn exact_without_findings_the_flown_job_is_next_and_drills_lead_to_the_whole_job() {
    let rules = rules();
    let next = |scenario: &str| {
        let mut record = perfect_record("anna", 1);
        record.scenario = scenario.into();
        next_job(&rules, &record).to_owned()
    };
    assert_eq!([next("truss"), next("certification")], ["truss", "certification"]);
    for exercise in ["drill-gap", "practice", "first-flight", "our-own-job"] {
        assert_eq!(next(exercise), "two-bridges", "after {exercise}");
    }
}

#[test]
fn exact_rule_for_the_drill_of_the_task_needs_a_task() {
    let name = "name = \"task not attempted\"\n";
    assert!(DEFAULT_RULES.contains(name));
    let wrong = DEFAULT_RULES.replace(name, &format!("{name}in_tasks = 2\n"));
    assert!(read_rules("rules.toml", &wrong).unwrap_err().to_string().contains("this rule has no task"));
}
