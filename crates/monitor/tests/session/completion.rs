//! Tests of job completion: coverage by length, the headline, and the certification requirements.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_monitor::measures::coverage::coverage;
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_monitor::score::completion::TaskState;
use spandrel_monitor::session::EndReason;
use spandrel_testkit::job::*;
use spandrel_text::Language;

/// Tolerance for the end of a flown section, as a fraction of a 100 m path: the nearest point changes up to half a
/// point spacing (1 m) early or late.
const HALF_POINT_SPACING: f64 = 0.01;

/// Creates a job with one 100 m path at a height of 10 m, from 10 to 110 m east.
fn scenario_with_long_task() -> Scenario {
    scenario(vec![task(1, line((10.0, 0.0, 10.0), (110.0, 0.0, 10.0)), 3.0)])
}

/// Records a flight along the first `to_m` meters of the path. The drone then either returns to home, 20 m from the
/// path, or stops where it is.
fn flown(to_m: f64, home: bool) -> Tape {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((10.0 + to_m, 0.0, 10.0), 4.0);
    tape.fly((10.0 + to_m, 20.0, 10.0), 4.0);
    if home {
        tape.fly((0.0, 20.0, 10.0), 4.0);
        tape.fly((0.0, 0.0, 10.0), 4.0);
        tape.land();
    }
    tape
}

#[test]
fn regress_task_is_done_at_80_percent_coverage() {
    for (to_m, state) in [(78.0, TaskState::Part), (82.0, TaskState::Done)] {
        let assessment = score_tape(&flown(to_m, true), &scenario_with_long_task()).assessment;
        let task = &assessment.tasks[0];
        assert!((task.covered - to_m / 100.0).abs() <= HALF_POINT_SPACING, "{} of {to_m} m", task.covered);
        assert_eq!((task.state, assessment.completion.complete), (state, state == TaskState::Done));
        assert_eq!(task.covered, assessment.certification.tasks[0].coverage, "both profiles report the same coverage");
        assert_eq!(assessment.completion.path_share, task.covered);
        // The TASBID score does not depend on coverage.
        assert!(assessment.scores.conformity.is_some_and(|score| score.pct > 95.0), "{:?}", assessment.scores);
    }
    let mut easier = scenario_with_long_task();
    easier.scoring.task_completion_fraction = 0.5;
    assert!(score_tape(&flown(60.0, true), &easier).assessment.completion.complete, "the scenario sets the required coverage");
}

#[test]
fn regress_session_without_tasks_flown_is_incomplete() {
    let job = scenario(vec![
        task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 3.0),
        task(2, line((70.0, 0.0, 10.0), (100.0, 0.0, 10.0)), 3.0),
    ]);
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 5.0), 2.0);
    tape.hold(5.0);
    tape.land();
    let assessment = score_tape(&tape, &job).assessment;
    let scores = &assessment.scores;
    // The TASBID formulas give a conformity of 50 and an efficiency and safety of 100.
    assert_eq!((scores.conformity.map(|score| score.pct), scores.efficiency.pct, scores.safety.pct), (Some(50.0), 100.0, 100.0));
    let completion = assessment.completion;
    assert_eq!((completion.complete, completion.tasks_done, completion.tasks, completion.path_share), (false, 0, 2, 0.0));
    assert_eq!(completion.headline(Language::English), "Incomplete: 0 of 2 tasks, 0% of the path");
    assert!(assessment.tasks.iter().all(|task| task.state == TaskState::NotAttempted));
    assert_eq!(assessment.certification.unmet[..2], ["task 1 not attempted", "task 2 not attempted"]);
    assert!(!assessment.certification.passed && !assessment.certification.gates.session_complete);
}

#[test]
fn regress_session_without_landing_at_home_is_incomplete() {
    let assessed_session = score_tape(&flown(100.0, false), &scenario_with_long_task());
    let assessment = &assessed_session.assessment;
    assert_eq!((assessment.end.reason, assessment.tasks[0].state), (EndReason::Abort, TaskState::Done));
    assert!(!assessment.completion.complete);
    assert_eq!(
        assessment.completion.headline(Language::English),
        "Incomplete: 1 of 1 task, 100% of the path, not landed at home"
    );
    assert_eq!(assessment.certification.unmet, ["not landed at home", "accuracy 0, 50 needed"]);
}

#[test]
fn regress_half_flown_path_is_not_certified() {
    let mut job = scenario_with_long_task();
    job.scoring.task_completion_fraction = 0.8;
    let assessment = score_tape(&flown(49.0, true), &job).assessment;
    assert!(assessment.certification.gates.all_tasks_attempted, "the task counts as attempted");
    let first = &assessment.certification.unmet[0];
    assert!(first.starts_with("task 1 not done: ") && first.ends_with("% of its path, 80% needed"), "{first}");
    let share = assessment.completion.path_share;
    assert!((share - 0.49).abs() <= HALF_POINT_SPACING, "{share}");
    assert_eq!(
        assessment.completion.headline(Language::English),
        format!("Incomplete: 0 of 1 task, {:.0}% of the path", 100.0 * share)
    );
}

#[test]
fn regress_hold_position_must_be_held() {
    let job = scenario(vec![task(1, line((0.0, 15.0, 10.0), (0.0, 15.4, 10.0)), 2.0)]);
    let completion = |held_s: f64| {
        let mut tape = Tape::new();
        tape.fly((0.0, 0.0, 10.0), 2.0);
        tape.fly((0.0, 15.0, 10.0), 4.0);
        tape.hold(held_s);
        tape.fly((0.0, 0.0, 10.0), 4.0);
        tape.land();
        score_tape(&tape, &job).assessment.completion
    };
    assert!(completion(10.0).complete);
    let brushed = completion(0.0);
    assert!(!brushed.complete && brushed.path_share < 0.2, "{brushed:?}");
}

#[test]
fn regress_held_position_completes_task() {
    let job = scenario(vec![task(1, line((0.0, 15.0, 10.0), (0.0, 15.4, 10.0)), 2.0)]);
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((0.0, 14.5, 10.0), 2.0);
    tape.hold(10.0);
    tape.land();
    let assessment = score_tape(&tape, &job).assessment;
    assert_eq!((assessment.tasks[0].state, assessment.completion.complete), (TaskState::Done, true));
}

/// Frames for which a hold position is held: 10 s at the highest frame rate of the shipped jobs, 30 Hz.
const HELD_FRAMES: usize = 300;

/// Flies every path of all shipped jobs from end to end.
#[test]
fn prop_flying_all_shipped_paths_completes_all_tasks() {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenarios");
    let beside = |name: &str| std::fs::read(folder.join(name)).map_err(|error| error.to_string());
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let mut jobs = 0;
    for file in files.filter(|file| file.extension().is_some_and(|ending| ending == "toml")) {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let scenario = spandrel_model::scenario::read(&name, &std::fs::read_to_string(&file).unwrap(), &beside).unwrap();
        let paths = ReferencePaths::new(&scenario);
        let along = |task: &spandrel_model::scenario::Task| {
            let wrap = task.closed.then(|| task.path_m[0]);
            let points: Vec<Vec3<Enu>> = task.path_m.iter().copied().chain(wrap).collect();
            let steps = points.windows(2).flat_map(|pair| (0..4).map(|k| pair[0].lerp(pair[1], f64::from(k) / 4.0)));
            // A hold position is held; the frames on other paths only repeat their end.
            steps.chain(std::iter::repeat_n(points.last().copied(), HELD_FRAMES).flatten()).collect::<Vec<_>>()
        };
        let on_path = OnPath::measure(&paths, scenario.tasks.iter().flat_map(along));
        for (task, covered) in scenario.tasks.iter().zip(coverage(&paths, &on_path)) {
            assert!(covered.share > 1.0 - HALF_POINT_SPACING, "{name}, task {}: {covered:?}", task.id);
        }
        jobs += 1;
    }
    assert!(jobs >= 8, "{jobs} jobs");
}
