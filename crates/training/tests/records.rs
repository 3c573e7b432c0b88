//! Tests of session records: the recorded causes must match each test flight's known faults.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_model::scenario::{Difficulty, Scenario};
use spandrel_monitor::assessment::AssessedSession;
use spandrel_monitor::measures::attention::SiteSurvey;
use spandrel_testkit::job::*;
use spandrel_training::record::{RecordSource, SessionLevel, SessionRecord, SourceHashes, record};

/// Tolerance for fault durations, s: a fault can start and end anywhere within a frame (40 ms at 25 Hz).
const DURATION_TOLERANCE_S: f64 = 0.081;
/// Tolerance for positions, m; MAVLink sends them in 1e-7 degrees and millimeters.
const POSITION_TOLERANCE_M: f64 = 0.02;

/// Creates a job with two tasks at a height of 10 m: task 1 from 10 to 60 m east, task 2 from 70 to 100 m east.
fn two_tasks() -> Scenario {
    let near = task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 3.0);
    scenario(vec![near, task(2, line((70.0, 0.0, 10.0), (100.0, 0.0, 10.0)), 3.0)])
}

/// Records a flight of task 1 that includes each fault once. Task 2 is not flown.
fn faulty_flight() -> Tape {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.snapshot(1);
    tape.hold(0.2);
    // Too high: 1.5 s above the 3 m limit while climbing at 1 m/s, 2 s hovering, 4 s along the path, 1.5 s descending.
    tape.fly((30.0, 0.0, 14.5), 1.0);
    tape.hold(1.0);
    tape.contact(1);
    tape.hold(0.2);
    tape.contact(0);
    tape.hold(0.8);
    tape.fly((40.0, 0.0, 14.5), 2.5);
    tape.fly((40.0, 0.0, 10.0), 1.0);
    // Exceeds the speed limit for 10 m.
    tape.fly((50.0, 0.0, 10.0), 5.0);
    tape.lamp(true);
    tape.hold(0.2);
    tape.snapshot(2);
    tape.hold(0.2);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    tape.fly((2.0, 0.0, 10.0), 4.0);
    tape.contact(3);
    tape.hold(0.2);
    tape.contact(0);
    tape.hold(0.2);
    tape.land();
    tape
}

fn session_record(assessed_session: &AssessedSession, scenario: &Scenario) -> SessionRecord {
    record(&RecordSource {
        id: "20231114T221320Z-anna-test-job-000000",
        trainee: "anna",
        purpose: None,
        started_unix_us: 1_000_000,
        spandrel_version: "0.1.0",
        scenario,
        vehicle: "test",
        hashes: &SourceHashes::of(b"s", b"v", b"t", b""),
        assessed_session,
        placed: TestSurvey::of(10).defects(),
        answers: None,
    })
}

#[test]
fn exact_record_contains_known_faults() {
    let job = two_tasks();
    let assessed_session = score_tape(&faulty_flight(), &job);
    let record = session_record(&assessed_session, &job);
    let task = &record.tasks[0];
    assert!((task.off_path_s - 9.0).abs() < DURATION_TOLERANCE_S, "{}", task.off_path_s);
    // 1.5 s each while climbing and descending between 3 and 4.5 m above the path, 6 s at 4.5 m.
    assert!((task.off_height_m.unwrap() - 4.25).abs() < 0.05, "{:?}", task.off_height_m);
    assert!(task.off_sideways_m.unwrap() < POSITION_TOLERANCE_M);
    assert!((task.speeding_s - 2.0).abs() < DURATION_TOLERANCE_S, "{}", task.speeding_s);
    assert!((task.fastest_m_s - 5.0).abs() < 0.02);
    assert_eq!((task.crashes.bridge, task.crashes.total()), (1, 1));
    assert_eq!((record.crashes_outside.water, record.crashes().total()), (1, 2));
    assert!((task.on_path - assessed_session.assessment.tasks[0].on_path).abs() == 0.0 && task.on_path < 0.8);
    assert!(task.attempted && !record.tasks[1].attempted);
    assert_eq!((record.tasks[1].seconds, record.tasks[1].off_height_m), (0.0, None));
    assert_eq!(record.scores.overall, assessed_session.assessment.scores.overall);
    assert_eq!((record.end_reason.as_str(), record.battery_failed), ("landed", false));
}

#[test]
fn exact_defects_have_nearest_task_and_failed_conditions() {
    let job = two_tasks();
    let record = session_record(&score_tape(&faulty_flight(), &job), &job);
    assert_eq!(record.defects.iter().map(|defect| defect.task.unwrap()).collect::<Vec<_>>(), [1, 1, 1, 1, 1, 1, 2, 2, 2, 2]);
    assert_eq!(record.defects.iter().filter(|defect| defect.found).map(|defect| defect.id).collect::<Vec<_>>(), [5]);
    assert!(record.defects[2].lacked.iter().any(|lacked| lacked.starts_with("too dark: lamp off")), "{:?}", record.defects[2]);
    assert!(record.defects[0].lacked.is_empty(), "no picture was taken nearby");
    assert_eq!((record.tasks[0].defects_placed, record.tasks[0].defects_found, record.tasks[1].defects_placed), (6, 1, 4));
    assert_eq!((record.snapshots, record.hits), (2, 1));
}

#[test]
fn exact_record_round_trips() {
    let job = two_tasks();
    let record = session_record(&score_tape(&faulty_flight(), &job), &job);
    assert_eq!(record.check(), Ok(()));
    let again: SessionRecord = serde_json::from_str(&serde_json::to_string(&record).unwrap()).unwrap();
    assert_eq!(again, record);
}

#[test]
fn exact_sideways_deviation_is_not_a_height_deviation() {
    let job = one_task();
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.fly((30.0, 5.0, 10.0), 2.0);
    tape.hold(3.0);
    // If the drone is more than 8 m from the path, it counts as elsewhere rather than off the path.
    tape.fly((30.0, 20.0, 10.0), 4.0);
    tape.hold(5.0);
    tape.fly((30.0, 0.0, 10.0), 4.0);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    tape.land();
    let record = session_record(&score_tape(&tape, &job), &job);
    let task = &record.tasks[0];
    assert!(task.off_height_m.unwrap() < POSITION_TOLERANCE_M && task.off_sideways_m.unwrap() > 4.0);
    // 3 to 5 m at 2 m/s, 3 s hovering, 5 to 8 m at 4 m/s, 8 to 3 m at 4 m/s.
    assert!((task.off_path_s - (1.0 + 3.0 + 0.75 + 1.25)).abs() < 2.0 * DURATION_TOLERANCE_S, "{}", task.off_path_s);
}

#[test]
fn exact_record_states_the_level_that_was_flown() {
    let mut job = two_tasks();
    let record = |job: &Scenario| session_record(&score_tape(&faulty_flight(), job), job);
    assert_eq!((record(&job).level, record(&job).scenario_with_level()), (None, job.name.clone()));
    job.difficulty = Some(Difficulty { level: 2, standard: 1, settings: vec!["wind 1 m/s".into(), "wind 8 m/s".into()] });
    assert_eq!(record(&job).level, Some(SessionLevel { level: 2, levels: 2, standard: 1 }));
    assert_eq!(record(&job).scenario_with_level(), format!("{}@2", job.name));
    let kept = serde_json::to_value(record(&job)).unwrap();
    assert_eq!(kept["level"], serde_json::json!({ "level": 2, "levels": 2, "standard": 1 }));
    assert_eq!(serde_json::from_value::<SessionRecord>(kept).unwrap(), record(&job));
}
