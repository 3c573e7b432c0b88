//! Tests of the six MAVLink feedback cues, including their thresholds and timing.

use crate::live::{new_monitor, sent_messages};
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{GuidancePolicy, LessonPlace, LessonStep, StandOff};
use spandrel_model::speed_unit::SpeedUnit;
use spandrel_model::time::SimTime;
use spandrel_monitor::Monitor;
use spandrel_testkit::job::*;

struct MonitoredFlight {
    monitor: Monitor,
    tape: Tape,
    texts: Vec<String>,
}

impl MonitoredFlight {
    fn in_flight() -> Self {
        Self::of(one_task())
    }

    fn of(scenario: spandrel_model::scenario::Scenario) -> Self {
        let mut monitored = Self { monitor: new_monitor(scenario), tape: Tape::new(), texts: Vec::new() };
        monitored.tape.fly((0.0, 0.0, 10.0), 2.0);
        monitored.run();
        monitored
    }

    /// Sends the tape's datagrams to the monitor and returns the time and active cues after each one.
    fn run(&mut self) -> Vec<(u32, i32)> {
        let mut cues = Vec::new();
        for datagram in std::mem::take(&mut self.tape.datagrams) {
            self.monitor.handle_datagram(&datagram);
            cues.push((u32::try_from(self.monitor.now().ms()).unwrap(), self.monitor.cues()));
            for message in sent_messages(&mut self.monitor) {
                if let MavMessage::STATUSTEXT(text) = message {
                    self.texts.push(text.text.to_str().unwrap().to_owned());
                }
            }
        }
        cues
    }

    fn has(&self, bit: i32) -> bool {
        self.monitor.cues() & bit != 0
    }
}

/// A lesson's hover near the path of a later step must not be disturbed by its warnings, and the step along the path must have them.
#[test]
fn exact_a_lesson_warns_off_the_path_only_in_its_step() {
    let warns_at = |steps: &[LessonStep]| {
        let mut job = one_task();
        (job.feedback.guidance, job.lesson) = (GuidancePolicy::Practice, steps.to_vec());
        let mut monitored = MonitoredFlight::of(job);
        monitored.tape.fly((30.0, 0.0, 10.0), 20.0);
        monitored.tape.fly((30.0, 5.0, 10.0), 10.0);
        monitored.tape.hold(3.0);
        monitored.run().iter().any(|(_, cues)| cues & cue::OFF_PATH != 0)
    };
    let place = LessonPlace { position_m: Vec3::new(0.0, 50.0, 10.0), radius_m: 2.0, duration: SimTime::from_ms(10_000) };
    assert!(!warns_at(&[LessonStep::Hover(place), LessonStep::FlyPath { task: 1 }]));
    assert!(warns_at(&[LessonStep::FlyPath { task: 1 }]));
}

#[test]
fn exact_off_path_cue_has_delay_and_hold_time() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((30.0, 0.0, 10.0), 20.0);
    monitored.run();
    // The drone moves sideways at 10 m/s. A distance of 5 m is beyond the 3 m threshold but within 8 m.
    monitored.tape.fly((30.0, 5.0, 10.0), 10.0);
    let left = monitored.tape.now_ms;
    monitored.tape.hold(3.0);
    let cues = monitored.run();
    let on = cues.iter().find(|(_, cues)| cues & cue::OFF_PATH != 0).unwrap().0;
    // The drone passed 3 m about 0.2 s before it reached 5 m. Messages are 20 ms apart.
    assert!((on as i64 - (i64::from(left) - 200 + 1_000)).abs() <= 20, "left path at {left}, cue on at {on}");
    // The drone returns to the path within half a second, but the cue stays on for two seconds.
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((30.0, 0.0, 10.0), 20.0);
    monitored.tape.fly((30.0, 5.0, 10.0), 10.0);
    monitored.tape.hold(0.9);
    monitored.tape.fly((30.0, 0.0, 10.0), 10.0);
    monitored.tape.hold(3.0);
    let cues = monitored.run();
    let on: Vec<u32> = cues.iter().filter(|(_, cues)| cues & cue::OFF_PATH != 0).map(|(time, _)| *time).collect();
    let shown = on.last().unwrap() - on.first().unwrap();
    assert!((1_960..2_000).contains(&shown), "{shown} ms");
}

#[test]
fn exact_short_swerve_and_distant_drone_are_not_off_path() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((30.0, 0.0, 10.0), 20.0);
    monitored.tape.fly((30.0, 5.0, 10.0), 10.0);
    monitored.tape.hold(0.5);
    monitored.tape.fly((30.0, 0.0, 10.0), 10.0);
    monitored.tape.hold(2.0);
    monitored.tape.fly((30.0, 20.0, 10.0), 30.0);
    monitored.tape.hold(3.0);
    assert!(monitored.run().iter().all(|(_, cues)| cues & cue::OFF_PATH == 0));
}

#[test]
fn regress_entering_or_leaving_at_path_end_is_not_off_path() {
    // The path runs from 10 to 60 m east; its threshold is 3 m.
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((-20.0, 20.0, 10.0), 4.0);
    monitored.tape.fly((30.0, 20.0, 10.0), 8.0);
    monitored.tape.fly((30.0, 0.0, 10.0), 1.0);
    monitored.tape.fly((60.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((80.0, 0.0, 10.0), 1.0);
    assert!(monitored.run().iter().all(|(_, cues)| cues & cue::OFF_PATH == 0), "{:?}", monitored.texts);
    // Once the drone has left the task, passing near its path on the way home doesn't raise the cue.
    monitored.tape.fly((70.0, 6.0, 10.0), 4.0);
    monitored.tape.fly((0.0, 6.0, 10.0), 4.0);
    assert!(monitored.run().iter().all(|(_, cues)| cues & cue::OFF_PATH == 0), "{:?}", monitored.texts);
}

#[test]
fn regress_overshooting_the_beginning_is_off_path() {
    // The drone enters the path near its first point, at 10 m east, drifts past it and comes back.
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((14.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((4.0, 0.0, 10.0), 3.0);
    monitored.tape.fly((14.0, 0.0, 10.0), 3.0);
    assert!(monitored.run().iter().any(|(_, cues)| cues & cue::OFF_PATH != 0));
    // Flying away from there for longer ends the visit, and the cue with it.
    monitored.tape.fly((10.0, 6.0, 10.0), 1.0);
    monitored.tape.hold(1.0);
    monitored.tape.fly((10.0, 30.0, 10.0), 3.0);
    monitored.tape.fly((10.0, 6.0, 10.0), 8.0);
    let cues = monitored.run();
    assert_eq!(cues.last().unwrap().1 & cue::OFF_PATH, 0, "{:?}", monitored.texts);
}

#[test]
fn regress_hovering_beside_path_end_or_leaving_mid_path_is_off_path() {
    for (from_m, to_m) in [((60.0, 0.0), (64.0, 0.0)), ((40.0, 0.0), (40.0, 4.0))] {
        let mut monitored = MonitoredFlight::in_flight();
        // Only part of the path is flown.
        monitored.tape.fly((0.0, 20.0, 10.0), 4.0);
        monitored.tape.fly((30.0, 20.0, 10.0), 4.0);
        monitored.tape.fly((30.0, 0.0, 10.0), 4.0);
        monitored.tape.fly((from_m.0, from_m.1, 10.0), 4.0);
        monitored.tape.fly((to_m.0, to_m.1, 10.0), 4.0);
        monitored.tape.hold(3.0);
        monitored.run();
        assert!(monitored.has(cue::OFF_PATH), "{to_m:?}");
    }
}

#[test]
fn exact_off_path_text_states_distance_and_way_back() {
    // The path runs east. (heading, position beside the path, text)
    let cases = [
        (0.0, (40.0, 4.0, 10.0), "Off path 4.0 m: back"),
        (90.0, (40.0, 4.0, 10.0), "Off path 4.0 m: right"),
        (270.0, (40.0, 4.0, 10.0), "Off path 4.0 m: left"),
        (90.0, (40.0, -3.0, 6.0), "Off path 5.0 m: left and up"),
        (180.0, (40.0, 0.0, 13.04), "Off path 3.04 m: down"),
    ];
    for (heading_deg, to_m, text) in cases {
        let mut monitored = MonitoredFlight::in_flight();
        monitored.tape.yaw_rad = f64::to_radians(heading_deg);
        monitored.tape.fly((40.0, 0.0, 10.0), 4.0);
        monitored.tape.fly(to_m, 4.0);
        monitored.tape.hold(1.5);
        monitored.run();
        assert_eq!(monitored.texts, [text], "heading {heading_deg}");
    }
}

#[test]
fn regress_a_task_that_is_done_raises_no_cue_until_it_is_visited_again() {
    let off_path = |cues: Vec<(u32, i32)>| cues.iter().any(|(_, cues)| cues & cue::OFF_PATH != 0);
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((10.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((60.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((60.0, 20.0, 10.0), 4.0);
    monitored.run();
    // Crossing the path takes 1.5 s. Then the drone hovers 5 m beside it.
    monitored.tape.fly((40.0, 20.0, 10.0), 4.0);
    monitored.tape.fly((40.0, -5.0, 10.0), 4.0);
    monitored.tape.hold(5.0);
    assert!(!off_path(monitored.run()), "{:?}", monitored.texts);
    // Another visit begins after 3 s on the path.
    monitored.tape.fly((40.0, 0.0, 10.0), 4.0);
    monitored.tape.hold(2.9);
    monitored.tape.fly((40.0, -5.0, 10.0), 4.0);
    monitored.tape.hold(3.0);
    assert!(off_path(monitored.run()));
}

#[test]
fn regress_crossing_another_path_does_not_change_the_task() {
    let mut scenario = one_task();
    // The second path crosses the first one at 40 m.
    scenario.tasks.push(task(2, line((40.0, 3.0, 10.0), (40.0, 40.0, 10.0)), 2.0));
    let mut monitored = MonitoredFlight::of(scenario);
    monitored.tape.fly((20.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((40.0, 3.5, 10.0), 4.0);
    monitored.tape.fly((36.0, 3.5, 10.0), 4.0);
    monitored.tape.hold(2.0);
    monitored.run();
    assert_eq!(monitored.texts, ["Off path 3.5 m: back"], "from the first path, not from the second one");
}

/// Returns the job with one task whose path is 6 m south of a wall.
fn task_at_wall() -> spandrel_model::scenario::Scenario {
    let mut scenario = one_task();
    let toward_surface = vec![Vec3::new(0.0, 1.0, 0.0); scenario.tasks[0].path_m.len()];
    scenario.tasks[0].stand_off = Some(StandOff { recommended_m: 6.0, tolerance_m: 3.0, toward_surface });
    scenario
}

#[test]
fn exact_stand_off_cue_states_actual_and_recommended_distance() {
    let both = cue::STAND_OFF | cue::OFF_PATH;
    for (to_m, cues, text) in [
        ((40.0, -4.0, 10.0), both, "Stand-off too large: 10.0 m, recommended 6 m"),
        ((40.0, 4.5, 10.0), both, "Stand-off too small: 1.5 m, recommended 6 m"),
        // 4 m below the path, and too far below to correct only the stand-off.
        ((40.0, 0.0, 6.0), cue::OFF_PATH, "Off path 4.0 m: up"),
        ((40.0, -4.0, 6.0), cue::OFF_PATH, "Off path 5.7 m: forward and up"),
    ] {
        let mut monitored = MonitoredFlight::of(task_at_wall());
        monitored.tape.fly((40.0, 0.0, 10.0), 4.0);
        monitored.tape.fly(to_m, 4.0);
        monitored.tape.hold(1.5);
        monitored.run();
        assert_eq!((monitored.monitor.cues(), monitored.texts.as_slice()), (cues, [text.to_owned()].as_slice()), "{to_m:?}");
    }
}

#[test]
fn exact_stand_off_cue_needs_no_off_path_cue() {
    let mut scenario = task_at_wall();
    scenario.tasks[0].stand_off.as_mut().unwrap().tolerance_m = 1.0;
    let mut monitored = MonitoredFlight::of(scenario);
    monitored.tape.fly((40.0, -0.9, 10.0), 4.0);
    monitored.tape.hold(2.0);
    monitored.run();
    assert_eq!(monitored.monitor.cues(), 0, "within the tolerance");
    monitored.tape.fly((40.0, -1.1, 10.0), 4.0);
    monitored.tape.hold(2.0);
    monitored.run();
    assert_eq!((monitored.monitor.cues(), monitored.texts.len()), (cue::STAND_OFF, 1));
    assert_eq!(monitored.texts, ["Stand-off too large: 7.1 m, recommended 6 m"]);
}

#[test]
fn exact_too_close_cue_has_hysteresis() {
    let mut monitored = MonitoredFlight::in_flight();
    for (meters, on) in [(3.0, false), (2.6, false), (2.4, true), (2.6, true), (2.79, true), (2.81, false), (2.6, false)] {
        monitored.tape.clearance(meters);
        monitored.tape.hold(0.1);
        monitored.run();
        assert_eq!(monitored.has(cue::TOO_CLOSE), on, "{meters} m");
    }
    assert_eq!(monitored.texts, ["Too close: 2.4 m, limit 2.5 m"]);
}

#[test]
fn exact_task_clearance_limit_applies_on_its_path() {
    let mut scenario = one_task();
    scenario.tasks[0].too_close_m = Some(1.0);
    let mut monitored = MonitoredFlight::of(scenario);
    monitored.tape.fly((30.0, 0.0, 10.0), 4.0);
    for (meters, on) in [(1.5, false), (0.9, true), (1.2, true), (1.31, false)] {
        monitored.tape.clearance(meters);
        monitored.tape.hold(0.1);
        monitored.run();
        assert_eq!(monitored.has(cue::TOO_CLOSE), on, "{meters} m");
    }
}

#[test]
fn regress_task_clearance_limit_applies_near_its_path() {
    let mut scenario = one_task();
    scenario.tasks[0].too_close_m = Some(1.0);
    let mut monitored = MonitoredFlight::of(scenario);
    monitored.tape.fly((30.0, 20.0, 10.0), 8.0);
    monitored.tape.fly((30.0, 6.0, 10.0), 4.0);
    monitored.tape.clearance(1.5);
    monitored.tape.hold(0.1);
    monitored.run();
    assert!(!monitored.has(cue::TOO_CLOSE));
    monitored.tape.fly((30.0, 12.0, 10.0), 4.0);
    monitored.run();
    assert!(monitored.has(cue::TOO_CLOSE), "away from the task, the scenario's limit applies");
}

#[test]
fn exact_too_close_cue_is_off_before_lift_off() {
    let mut monitored = MonitoredFlight { monitor: new_monitor(one_task()), tape: Tape::new(), texts: Vec::new() };
    monitored.tape.clearance(0.5);
    monitored.tape.hold(1.0);
    monitored.run();
    assert!(!monitored.has(cue::TOO_CLOSE));
}

#[test]
fn exact_speeding_cue_is_raised_only_on_or_near_path() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((30.0, 0.0, 10.0), 4.4);
    monitored.run();
    assert!(!monitored.has(cue::SPEEDING));
    monitored.tape.fly((40.0, 0.0, 10.0), 6.0);
    monitored.run();
    assert!(monitored.has(cue::SPEEDING));
    assert_eq!(monitored.texts.last().unwrap(), "Too fast: 13 mph, limit 10 mph");
    monitored.tape.hold(1.0);
    monitored.run();
    assert!(!monitored.has(cue::SPEEDING));
    monitored.tape.fly((40.0, 9.0, 10.0), 4.0);
    monitored.tape.fly((40.0, 40.0, 10.0), 6.0);
    monitored.run();
    assert!(!monitored.has(cue::SPEEDING));
}

#[test]
fn exact_speeding_cue_has_margin_hysteresis_and_minimum_duration() {
    // The limit is 4.4704 m/s (10 mph), and the margin 5%: 4.694 m/s.
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((20.0, 0.0, 10.0), 4.0);
    monitored.tape.fly((25.0, 0.0, 10.0), 4.68);
    assert!(monitored.run().iter().all(|(_, cues)| cues & cue::SPEEDING == 0), "within the margin");
    monitored.tape.fly((30.0, 0.0, 10.0), 4.7);
    monitored.tape.fly((40.0, 0.0, 10.0), 4.5);
    monitored.run();
    assert!(monitored.has(cue::SPEEDING), "still above the limit");
    assert_eq!(monitored.texts, ["Too fast: 11 mph, limit 10 mph"]);
    monitored.tape.hold(0.6);
    monitored.run();
    assert!(!monitored.has(cue::SPEEDING));
    // Above the margin for 0.2 s: the cue stays on for a second.
    monitored.tape.fly((41.0, 0.0, 10.0), 5.0);
    monitored.tape.hold(3.0);
    let on: Vec<u32> = monitored.run().iter().filter(|(_, cues)| cues & cue::SPEEDING != 0).map(|(time, _)| *time).collect();
    let shown = on.last().unwrap() - on.first().unwrap();
    assert!((960..1_000).contains(&shown), "{shown} ms");
}

#[test]
fn exact_speeding_text_has_the_unit_of_the_limit() {
    let mut scenario = one_task();
    (scenario.scoring.speed_limit_m_s, scenario.scoring.speed_limit_unit) = (4.5, SpeedUnit::MetersPerSecond);
    let mut monitored = MonitoredFlight::of(scenario);
    monitored.tape.fly((25.0, 0.0, 10.0), 4.8);
    monitored.run();
    assert_eq!(monitored.texts, ["Too fast: 4.8 m/s, limit 4.5 m/s"]);
}

#[test]
fn exact_texts_of_one_rule_are_rate_limited() {
    let mut monitored = MonitoredFlight::in_flight();
    for _ in 0..20 {
        monitored.tape.clearance(2.4);
        monitored.tape.hold(0.1);
        monitored.tape.clearance(3.0);
        monitored.tape.hold(0.1);
    }
    monitored.run();
    // The cue toggles for four seconds, but texts are at least five seconds apart.
    assert_eq!(monitored.texts.len(), 1);
}

#[test]
fn exact_crash_is_reported_immediately_and_first() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.clearance(2.0);
    monitored.tape.hold(0.02);
    monitored.tape.contact(1);
    let cues = monitored.run();
    assert!(cues.last().unwrap().1 & cue::CRASH != 0, "the cue is not on after the datagram with the contact");
    assert_eq!(monitored.texts, ["Too close: 2.0 m, limit 2.5 m", "Crash: fence"]);
    monitored.tape.contact(0);
    monitored.tape.hold(1.9);
    monitored.run();
    assert!(monitored.has(cue::CRASH));
    monitored.tape.hold(0.2);
    monitored.run();
    assert!(!monitored.has(cue::CRASH));
}

#[test]
fn exact_battery_cue_turns_yellow_then_red() {
    let mut monitored = MonitoredFlight::in_flight();
    for (pct, bits) in [(70, 0), (69, cue::BATTERY_YELLOW), (30, cue::BATTERY_YELLOW), (29, cue::BATTERY_RED)] {
        monitored.tape.battery(pct);
        monitored.tape.hold(2.0);
        monitored.run();
        assert_eq!(monitored.monitor.cues(), bits, "{pct}%");
    }
    assert_eq!(monitored.texts, ["Battery 69%", "Battery 29%"]);
}

#[test]
fn exact_cues_are_repeated_at_five_hertz() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.hold(10.0);
    let mut count = 0;
    for datagram in std::mem::take(&mut monitored.tape.datagrams) {
        monitored.monitor.handle_datagram(&datagram);
        count += sent_messages(&mut monitored.monitor)
            .iter()
            .filter(|message| matches!(message, MavMessage::NAMED_VALUE_INT(_)))
            .count();
    }
    assert_eq!(count, 50);
}

#[test]
fn exact_too_close_cue_works_below_pad_height() {
    // In the TASBID job, the circle around the pier is 2 m below the pad.
    let mut monitored = MonitoredFlight::of(one_task());
    monitored.tape.fly((30.0, 0.0, 10.0), 10.0);
    monitored.tape.fly((30.0, 0.0, -2.0), 4.0);
    monitored.tape.clearance(2.0);
    monitored.tape.hold(0.1);
    monitored.run();
    assert!(monitored.has(cue::TOO_CLOSE));
    assert_eq!(monitored.texts.last().unwrap(), "Too close: 2.0 m, limit 2.5 m");
}

#[test]
fn exact_landing_on_pad_raises_no_too_close_cue() {
    let mut monitored = MonitoredFlight::in_flight();
    monitored.tape.fly((0.0, 0.0, 0.2), 4.0);
    monitored.tape.clearance(0.2);
    monitored.tape.hold(0.1);
    monitored.run();
    assert!(!monitored.has(cue::TOO_CLOSE));
}

#[test]
fn exact_person_collision_text_is_not_rate_limited() {
    let mut monitored = MonitoredFlight::in_flight();
    for code in [1, 5] {
        monitored.tape.contact(code);
        monitored.tape.hold(0.1);
    }
    monitored.run();
    assert_eq!(monitored.texts, ["Crash: fence", "Crash: person"]);
}

#[test]
fn exact_texts_continue_after_simulator_restart_on_ground() {
    let mut monitored = MonitoredFlight { monitor: new_monitor(one_task()), tape: Tape::new(), texts: Vec::new() };
    for seconds in [20.0, 0.2] {
        monitored.tape.hold(seconds);
        monitored.tape.battery(60);
        monitored.tape.hold(2.0);
        monitored.run();
        monitored.tape = Tape::new();
    }
    assert_eq!(monitored.texts, ["Battery 60%", "Battery 60%"]);
}
