//! Tests of the guidance that the monitor sends: steps, texts, and the flights that have none.

use crate::live::{new_monitor_with_purpose, sent_messages};
use spandrel_mavlink::contract::guidance::{Guidance, GuidanceStep};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{GuidancePolicy, Scenario};
use spandrel_monitor::Monitor;
use spandrel_testkit::job::*;
use std::collections::BTreeMap;

/// Largest difference between a distance and its value as a 32-bit float, m.
const FLOAT_TOLERANCE_M: f64 = 1e-3;

fn guided_job(guidance: GuidancePolicy) -> Scenario {
    let mut scenario = one_task();
    scenario.feedback.guidance = guidance;
    scenario
}

/// Sends the tape to the monitor. Returns the guidance and the texts that it sends.
fn run(monitor: &mut Monitor, tape: &mut Tape) -> (Vec<Guidance>, Vec<String>) {
    let (mut steps, mut texts) = (Vec::new(), Vec::new());
    for datagram in std::mem::take(&mut tape.datagrams) {
        monitor.handle_datagram(&datagram);
        for message in sent_messages(monitor) {
            steps.extend(Guidance::of(&message));
            if let MavMessage::STATUSTEXT(text) = message {
                texts.push(text.text.to_str().unwrap().to_owned());
            }
        }
    }
    (steps, texts)
}

#[test]
fn wire_guidance_leads_through_the_job() {
    let mut monitor = new_monitor_with_purpose(guided_job(GuidancePolicy::Practice), None);
    let mut tape = Tape::new();
    tape.hold(2.0);
    let (steps, texts) = run(&mut monitor, &mut tape);
    assert!(steps.iter().all(|guidance| guidance.step == GuidanceStep::TakeOff && guidance.way.is_none()));
    assert_eq!(texts, ["Take off"]);
    // The path leads from (10, 0, 10) to (60, 0, 10).
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((35.0, 0.0, 10.0), 4.0);
    let (steps, texts) = run(&mut monitor, &mut tape);
    let last = steps.last().unwrap();
    assert_eq!((last.step, last.task, last.tasks), (GuidanceStep::FollowPath, Some(1), 1));
    assert!((last.progress.unwrap() - 0.5).abs() < 0.03, "{last:?}");
    assert!(last.deviation.unwrap().distance_m < FLOAT_TOLERANCE_M, "{last:?}");
    assert_eq!(texts.last().map(String::as_str), Some("Task 1: follow the path"));
    tape.fly((60.0, 0.0, 10.0), 4.0);
    tape.fly((60.0, -30.0, 10.0), 5.0);
    tape.hold(2.0);
    let (steps, texts) = run(&mut monitor, &mut tape);
    assert_eq!(steps.last().map(|guidance| (guidance.step, guidance.tasks_done)), Some((GuidanceStep::FlyHome, 1)));
    assert!(texts.last().unwrap().starts_with("Fly home: "), "{texts:?}");
}

/// Largest difference between the progress in the panel and the assessed one, as a fraction: a message is up to 200 ms old, which is 2% of
/// a hold, and along a path of 50 m, 0.8 m at 4 m/s and the next point, 1 m apart.
const PROGRESS_TOLERANCE: f64 = 0.04;
/// Number of datagrams between two comparisons, about 2 s of flight.
const COMPARISON_INTERVAL: usize = 100;

/// The panel must promise neither more nor less than the assessment counts, along a path and at a hold position, whenever the flight
/// ends.
#[test]
fn flight_progress_in_the_panel_agrees_with_the_assessment() {
    let mut job =
        scenario(vec![task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 3.0), task(2, vec![Vec3::new(60.0, 30.0, 10.0)], 2.0)]);
    job.feedback.guidance = GuidancePolicy::Practice;
    let mut monitor = new_monitor_with_purpose(job, None);
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((40.0, 0.0, 10.0), 4.0);
    // Two stays of 6 s and 4 s don't add up.
    for stay_s in [6.0, 4.0, 11.0] {
        tape.fly((60.0, 28.5, 10.0), 4.0);
        tape.hold(stay_s);
        tape.fly((60.0, 20.0, 10.0), 4.0);
    }
    tape.fly((40.0, 0.0, 10.0), 4.0);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    tape.hold(1.0);
    let mut shown = BTreeMap::new();
    let (mut compared, mut assessed) = (0, vec![0.0; 2]);
    for part in std::mem::take(&mut tape.datagrams).chunks(COMPARISON_INTERVAL) {
        tape.datagrams = part.to_vec();
        let (steps, _) = run(&mut monitor, &mut tape);
        shown.extend(steps.iter().filter_map(|guidance| Some((guidance.task?, guidance.progress?))));
        let mut ended = monitor.clone();
        ended.close();
        let Some(Ok(session)) = ended.finished() else { continue };
        assessed = session.assessment.tasks.iter().map(|task| task.covered).collect();
        let last = steps.last().and_then(|guidance| Some((guidance.task?, guidance.progress?)));
        if let Some((task, progress)) = last {
            let covered = assessed[task as usize - 1];
            assert!((progress - covered).abs() <= PROGRESS_TOLERANCE, "task {task}: {progress} shown, {covered} assessed");
            compared += 1;
        }
    }
    assert!(compared > 10 && shown.len() == 2, "{compared} comparisons, {shown:?}");
    assert_eq!(assessed, [1.0, 1.0]);
}

#[test]
fn exact_policy_and_purpose_select_the_guided_flights() {
    for (policy, purpose, guided) in [
        (GuidancePolicy::Always, Some("assessment"), true),
        (GuidancePolicy::Practice, Some("assessment"), false),
        (GuidancePolicy::Practice, Some("practice"), true),
        (GuidancePolicy::Practice, None, true),
        (GuidancePolicy::Never, Some("practice"), false),
    ] {
        let mut monitor = new_monitor_with_purpose(guided_job(policy), purpose);
        let mut tape = Tape::new();
        tape.hold(2.0);
        let (steps, texts) = run(&mut monitor, &mut tape);
        assert_eq!((!steps.is_empty(), !texts.is_empty()), (guided, guided), "{policy:?}, {purpose:?}");
    }
}

#[test]
fn wire_ground_stations_get_bearing_and_distance_of_the_next_place() {
    let mut monitor = new_monitor_with_purpose(guided_job(GuidancePolicy::Practice), None);
    let mut tape = Tape::new();
    tape.hold(2.0);
    // The path leads from (10, 0, 10) to (60, 0, 10); from here, its start is 40 m north and 4 m up.
    tape.fly((10.0, -40.0, 6.0), 4.0);
    tape.hold(1.0);
    let mut shown = None;
    for datagram in std::mem::take(&mut tape.datagrams) {
        monitor.handle_datagram(&datagram);
        for message in sent_messages(&mut monitor) {
            if let MavMessage::NAV_CONTROLLER_OUTPUT(navigation) = message {
                shown = Some((navigation.target_bearing, navigation.wp_dist, navigation.alt_error.round()));
            }
        }
    }
    assert_eq!(shown, Some((0, 40, 4.0)));
    let mut monitor = new_monitor_with_purpose(guided_job(GuidancePolicy::Never), None);
    tape.hold(1.0);
    for datagram in std::mem::take(&mut tape.datagrams) {
        monitor.handle_datagram(&datagram);
        let sent = sent_messages(&mut monitor);
        assert!(!sent.iter().any(|message| matches!(message, MavMessage::NAV_CONTROLLER_OUTPUT(_))), "no guidance, no bearing");
    }
}
