//! Tests of the live monitor: replies, output files, and a replay with identical results.

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::dialect::*;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_monitor::assessment::{AssessError, assess_log};
use spandrel_monitor::session::EndReason;
use spandrel_monitor::{Monitor, MonitorConfig, SessionOutput, export};
use spandrel_testkit::job::*;

const SESSION_START_US: u64 = 1_700_000_000_000_000;

pub fn new_monitor(scenario: Scenario) -> Monitor {
    Monitor::new(config(scenario))
}

pub fn new_monitor_with_purpose(scenario: Scenario, purpose: Option<&str>) -> Monitor {
    Monitor::new(MonitorConfig { purpose: purpose.map(str::to_owned), ..config(scenario) })
}

fn config(scenario: Scenario) -> MonitorConfig {
    MonitorConfig {
        scenario,
        vehicle: vehicle(),
        trainee: "tester".to_owned(),
        purpose: None,
        started_unix_us: SESSION_START_US,
        system_id: 1,
        seed: None,
        survey_builder: test_survey,
    }
}

pub fn sent_messages(monitor: &mut Monitor) -> Vec<MavMessage> {
    let mut decoder = Decoder::new();
    let mut messages = Vec::new();
    while let Some(bytes) = monitor.poll_transmit() {
        for frame in decoder.datagram(&bytes) {
            assert_eq!((frame.system_id, frame.component_id), (1, 191));
            messages.extend(frame.message);
        }
    }
    messages
}

fn session_output(monitor: &mut Monitor) -> (Vec<u8>, Vec<String>) {
    let (mut log, mut events) = (Vec::new(), Vec::new());
    while let Some(record) = monitor.poll_record() {
        match record {
            SessionOutput::Telemetry(bytes) => log.extend(bytes),
            SessionOutput::Event(line) => events.push(line),
        }
    }
    (log, events)
}

#[test]
fn exact_replay_matches_live_session() {
    let mut monitor = new_monitor(one_task());
    for datagram in &clean_flight().datagrams {
        monitor.handle_datagram(datagram);
    }
    let live = monitor.finished().expect("landed").clone().expect("scored");
    let (log, events) = session_output(&mut monitor);
    let replayed = assess_log(&log, &one_task(), &vehicle(), test_survey).unwrap();
    assert_eq!(export::json_text(&live.assessment), export::json_text(&replayed.assessment));
    assert!(live.frames == replayed.frames, "live and offline frames differ");
    let kinds: Vec<String> = events
        .iter()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["event"].as_str().unwrap().to_owned())
        .collect();
    for wanted in ["seed", "lift_off", "task_entered", "end"] {
        assert!(kinds.iter().any(|kind| kind == wanted), "{wanted} in {kinds:?}");
    }
}

/// A car that hits the drone touches it for less than the time between two positions.
#[test]
fn regress_a_brief_contact_with_a_vehicle_ends_the_session() {
    let mut monitor = new_monitor(one_task());
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    for kind in [ContactKind::Vehicle, ContactKind::Terrain, ContactKind::None] {
        tape.contact(kind.code());
    }
    tape.hold(2.0);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let assessed = monitor.finished().expect("the session is over").clone().expect("scored");
    assert_eq!(assessed.assessment.end.reason, EndReason::Vehicle);
}

/// Simulation time stops during a freeze and continues after a rewind, so the session remains one flight. Its events list both.
#[test]
fn exact_freezes_and_rewinds_are_events_of_one_session() {
    let mut monitor = new_monitor(one_task());
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    for (name, value) in [("freezes", 1), ("rewinds", 0), ("frozen", 1), ("frozen", 1), ("freezes", 1), ("frozen", 0)] {
        tape.int(name, value);
    }
    tape.fly((60.0, 0.0, 10.0), 4.0);
    let back = spandrel_model::frames::Vec3::new(30.0, 0.0, 10.0);
    for count in 1..=2 {
        tape.at_m = back;
        tape.int("rewinds", count);
        tape.int("rewinds", count);
        tape.fly((60.0, 0.0, 10.0), 4.0);
    }
    tape.land();
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let assessed_session = monitor.finished().expect("landed").clone().expect("scored");
    let (_, events) = session_output(&mut monitor);
    let events: Vec<serde_json::Value> = events.iter().map(|line| serde_json::from_str(line).unwrap()).collect();
    let counts = |kind: &str| -> Vec<i64> {
        events.iter().filter(|event| event["event"] == kind).filter_map(|event| event["count"].as_i64()).collect()
    };
    assert_eq!((counts("freeze"), counts("rewind")), (vec![1], vec![1, 2]));
    let assessment = assessed_session.assessment;
    assert_eq!((assessment.practice_aids.freezes, assessment.practice_aids.rewinds), (1, 2));
    assert!(!assessment.certification.passed);
    assert_eq!(assessment.certification.unmet[0], "rewound twice and frozen once, so it was practice");
    assert!(events.iter().all(|event| event["event"] != "simulator_restarted"), "{events:?}");
}

#[test]
fn exact_timestamps_are_session_start_plus_simulation_time() {
    let mut monitor = new_monitor(one_task());
    let mut tape = Tape::new();
    tape.hold(2.0);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let (log, _) = session_output(&mut monitor);
    let stamps: Vec<u64> = spandrel_mavlink::telemetry::tlog::TlogReader::new(&log).map(|record| record.timestamp_us).collect();
    assert_eq!(stamps.first(), Some(&SESSION_START_US));
    assert_eq!(stamps.last(), Some(&(SESSION_START_US + 2_000_000)));
    assert!(stamps.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(spandrel_mavlink::telemetry::tlog::session_start_us(&log), Some(SESSION_START_US));
}

/// A monitor that starts an hour after the vehicle must still send the current simulation time.
#[test]
fn regress_late_monitor_log_starts_at_session_start() {
    let mut tape = Tape::new();
    tape.hold(62.0);
    let late = tape.datagrams.len() * 30 / 31;
    let mut monitor = new_monitor(one_task());
    tape.datagrams[late..].iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let (mut log, _) = session_output(&mut monitor);
    let stamps = |log: &[u8]| -> Vec<u64> {
        spandrel_mavlink::telemetry::tlog::TlogReader::new(log).map(|record| record.timestamp_us).collect()
    };
    let (first, last) = (stamps(&log)[0], *stamps(&log).last().unwrap());
    assert_eq!(first, SESSION_START_US);
    assert!((SESSION_START_US + 1_900_000..=SESSION_START_US + 2_100_000).contains(&last), "{} us", last - SESSION_START_US);
    let zero = spandrel_mavlink::telemetry::tlog::simulation_zero_us(&log).unwrap();
    assert!((59_900_000..=60_100_000).contains(&(SESSION_START_US - zero)), "{} us", SESSION_START_US - zero);
    assert_eq!(monitor.session_info(b"", b"", String::new(), 1).started_unix_us, SESSION_START_US);
    // A monitor that was killed and resumed continues with the same clock.
    let mut second = Monitor::resume(config(one_task()), &log).unwrap();
    let mut more = Tape::new();
    more.hold(65.0);
    let rest = more.datagrams.len() * 63 / 65;
    more.datagrams[rest..].iter().for_each(|datagram| second.handle_datagram(datagram));
    log = session_output(&mut second).0;
    let last = *stamps(&log).last().unwrap();
    assert!((SESSION_START_US + 4_900_000..=SESSION_START_US + 5_100_000).contains(&last), "{} us", last - SESSION_START_US);
}

/// The monitor accepts only datagrams from an autopilot. Once there is a scored flight, it accepts only that vehicle's
/// datagrams.
#[test]
fn regress_monitor_accepts_only_its_vehicle() {
    let beat = |system: u8, component: u8, autopilot| {
        let body = HEARTBEAT_DATA { autopilot, ..HEARTBEAT_DATA::default() };
        Encoder::new(system, component).encode(&MavMessage::HEARTBEAT(body))
    };
    let (px4, none) = (MavAutopilot::MAV_AUTOPILOT_PX4, MavAutopilot::MAV_AUTOPILOT_INVALID);
    let mut monitor = new_monitor(one_task());
    for stranger in [vec![], vec![0xFD], vec![7; 60], beat(255, 190, none), beat(1, 191, none), beat(1, 1, none)] {
        assert!(!monitor.is_from_vehicle(&stranger), "{stranger:?}");
    }
    assert!(monitor.is_from_vehicle(&beat(1, 1, px4)) && monitor.is_from_vehicle(&beat(9, 1, px4)));
    let mut tape = Tape::new();
    tape.hold(2.0);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    assert!(monitor.is_from_vehicle(&beat(1, 1, px4)) && !monitor.is_from_vehicle(&beat(9, 1, px4)));
    // A forwarded heartbeat from another vehicle doesn't change the monitor's system ID; `sent_messages` checks the IDs in its
    // messages.
    sent_messages(&mut monitor);
    monitor.handle_datagram(&beat(9, 1, px4));
    tape.datagrams.clear();
    tape.hold(1.5);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    assert!(!sent_messages(&mut monitor).is_empty());
}

#[test]
fn exact_timestamps_increase_after_simulator_restart() {
    let mut monitor = new_monitor(one_task());
    for seconds in [20.0, 2.0] {
        let mut tape = Tape::new();
        tape.hold(seconds);
        tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    }
    let (log, _) = session_output(&mut monitor);
    let stamps: Vec<u64> = spandrel_mavlink::telemetry::tlog::TlogReader::new(&log).map(|record| record.timestamp_us).collect();
    assert_eq!(stamps.last(), Some(&(SESSION_START_US + 22_000_000)));
    assert!(stamps.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn exact_killed_monitor_resumes_at_end_of_log() {
    let tape = clean_flight();
    let half = tape.datagrams.len() / 2;
    let mut first = new_monitor(one_task());
    tape.datagrams[..half].iter().for_each(|datagram| first.handle_datagram(datagram));
    let (mut log, _) = session_output(&mut first);
    log.truncate(log.len() - 5);
    log.truncate(spandrel_mavlink::telemetry::tlog::complete_len(&log));
    let mut second = Monitor::resume(config(one_task()), &log).unwrap();
    assert!(second.flight_time().is_some());
    tape.datagrams[half..].iter().for_each(|datagram| second.handle_datagram(datagram));
    let outcome = second.finished().expect("landed").clone().unwrap();
    let (rest, events) = session_output(&mut second);
    assert!(events[0].contains("monitor_restarted"));
    log.extend(rest);
    let replayed = assess_log(&log, &one_task(), &vehicle(), test_survey).unwrap();
    assert!(outcome == replayed, "live and resumed results differ");
    assert_eq!(outcome.assessment.scores.conformity.unwrap().pct, 100.0);
}

#[test]
fn exact_timesync_reply_is_last_and_addressed_to_sender() {
    let mut monitor = new_monitor(one_task());
    let mut tape = Tape::new();
    tape.hold(1.5);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    sent_messages(&mut monitor);
    tape.datagrams.clear();
    tape.hold(0.6);
    let sync = TIMESYNC_DATA { tc1: 0, ts1: 4242, ..TIMESYNC_DATA::default() };
    tape.send(&MavMessage::TIMESYNC(sync));
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let messages = sent_messages(&mut monitor);
    assert!(messages.len() > 1, "heartbeat and cues are missing");
    let Some(MavMessage::TIMESYNC(answer)) = messages.last() else { panic!("last message is {:?}", messages.last()) };
    assert_eq!((answer.ts1, answer.target_system, answer.target_component), (4242, 1, 1));
    assert_eq!(answer.tc1, 2_100_000_000);
}

#[test]
fn exact_timesync_replies_and_requests_to_other_systems_are_ignored() {
    let mut monitor = new_monitor(one_task());
    let mut encoder = Encoder::new(1, 1);
    for sync in [
        TIMESYNC_DATA { tc1: 5, ts1: 6, ..TIMESYNC_DATA::default() },
        TIMESYNC_DATA { tc1: 0, ts1: 6, target_system: 1, target_component: 190 },
    ] {
        monitor.handle_datagram(&encoder.encode(&MavMessage::TIMESYNC(sync)));
    }
    assert!(sent_messages(&mut monitor).is_empty());
}

#[test]
fn exact_commands_are_rejected_and_parameter_requests_ignored() {
    let mut monitor = new_monitor(one_task());
    let mut encoder = Encoder::new(255, 190);
    let command = |target_component| {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command: MavCmd::MAV_CMD_REQUEST_MESSAGE,
            target_system: 1,
            target_component,
            ..COMMAND_LONG_DATA::default()
        })
    };
    monitor.handle_datagram(&encoder.encode(&command(191)));
    let messages = sent_messages(&mut monitor);
    let [MavMessage::COMMAND_ACK(ack)] = &messages[..] else { panic!("{messages:?}") };
    assert_eq!(ack.result, MavResult::MAV_RESULT_UNSUPPORTED);
    assert_eq!((ack.target_system, ack.target_component), (255, 190));
    monitor.handle_datagram(&encoder.encode(&command(1)));
    let list = PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 0 };
    monitor.handle_datagram(&encoder.encode(&MavMessage::PARAM_REQUEST_LIST(list)));
    assert!(sent_messages(&mut monitor).is_empty());
}

#[test]
fn exact_heartbeat_identifies_onboard_controller_at_1_hz() {
    let mut monitor = new_monitor(one_task());
    monitor.handle_timeout(SimTime::ZERO);
    let messages = sent_messages(&mut monitor);
    let [MavMessage::HEARTBEAT(beat)] = &messages[..] else { panic!("{messages:?}") };
    assert_eq!(beat.mavtype, MavType::MAV_TYPE_ONBOARD_CONTROLLER);
    assert_eq!(beat.autopilot, MavAutopilot::MAV_AUTOPILOT_INVALID);
    assert_eq!(beat.base_mode.bits(), 0);
    let mut tape = Tape::new();
    tape.hold(10.0);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    let beats = sent_messages(&mut monitor).iter().filter(|message| matches!(message, MavMessage::HEARTBEAT(_))).count();
    assert_eq!(beats, 11);
}

#[test]
fn exact_wrong_scenario_is_rejected_with_status_text() {
    let mut scenario = one_task();
    scenario.crc = 5;
    let mut monitor = new_monitor(scenario);
    Tape::new().datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    assert!(matches!(monitor.refused(), Some(AssessError::OtherScenario { .. })));
    assert!(matches!(monitor.finished(), Some(Err(AssessError::OtherScenario { .. }))));
    assert!(sent_messages(&mut monitor).iter().any(|message| matches!(message, MavMessage::STATUSTEXT(_))));
}

#[test]
fn exact_closing_in_flight_is_scored_as_abort() {
    let mut monitor = new_monitor(one_task());
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.datagrams.iter().for_each(|datagram| monitor.handle_datagram(datagram));
    monitor.close();
    let assessed_session = monitor.finished().unwrap().clone().unwrap();
    assert_eq!(assessed_session.assessment.end.reason, spandrel_monitor::session::EndReason::Abort);
    assert!(!assessed_session.assessment.certification.passed);
    let (log, _) = session_output(&mut monitor);
    assert!(
        assess_log(&log, &one_task(), &vehicle(), test_survey).unwrap() == assessed_session,
        "the replay gave different results"
    );
}
