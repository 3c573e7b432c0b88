//! Starts and restarts of the autopilot's process, and its misbehavior.

use crate::rig::{MONITOR, Rig};
use mavlink::MessageData;
use spandrel_mavlink::dialect::*;
use spandrel_model::scenario::AfterCrash;
use spandrel_model::time::SimTime;
use spandrel_sitl::sim::{AutopilotState, SimEvent};

/// Height of the takeoff in these tests, m.
const HEIGHT_M: f64 = 3.0;
/// Parameters of MAV_CMD_INJECT_FAILURE: FAILURE_UNIT_SYSTEM_MOTOR, FAILURE_TYPE_OFF, FAILURE_TYPE_OK.
const MOTOR: f32 = 101.0;
const FAILURE_OFF: f32 = 1.0;
const FAILURE_OK: f32 = 0.0;
/// Tolerance for the position on the pad, m: the aircraft settles on its feet.
const PAD_TOLERANCE_M: f64 = 0.05;

#[test]
fn flight_external_autopilot_takes_off_and_holds_the_aircraft() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    let start_m = rig.height_m();
    rig.take_off(HEIGHT_M);
    assert!(rig.events.contains(&SimEvent::LiftOff), "{:?}", rig.events);
    assert!(rig.height_m() > start_m + HEIGHT_M && rig.sim.truth().rigid.attitude.euler().0.abs() < 0.3);
}

#[test]
fn exact_simulation_time_is_stopped_until_the_autopilot_is_ready() {
    let mut rig = Rig::new(AfterCrash::Continue);
    for _ in 0..100 {
        rig.exchange();
    }
    assert_eq!(rig.sim.autopilot_state(), Some(AutopilotState::Disconnected));
    assert_eq!(rig.sim.now(), SimTime::ZERO, "nobody has connected");
    rig.connect();
    for _ in 0..100 {
        rig.exchange();
    }
    assert!(matches!(rig.sim.autopilot_state(), Some(AutopilotState::Starting { has_answered: true, .. })));
    assert_eq!(rig.sim.now(), SimTime::ZERO, "the autopilot cannot arm yet");
    assert!(rig.heard(MONITOR, HIL_STATE_QUATERNION_DATA::ID).is_empty(), "no scored time passes");
    rig.exchange_until(|rig| matches!(rig.sim.autopilot_state(), Some(AutopilotState::Running { .. })));
    let started = rig.events.iter().any(|event| matches!(event, SimEvent::AutopilotStarted { is_ready: true, .. }));
    assert!(started, "{:?}", rig.events);
    rig.run_s(0.5);
    assert!(!rig.heard(MONITOR, HIL_STATE_QUATERNION_DATA::ID).is_empty());
}

#[test]
fn exact_simulation_time_waits_for_each_answer() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.run_s(0.1);
    let before = rig.sim.now();
    // The readings are sent, but no answer arrives.
    for _ in 0..50 {
        rig.sim.handle_timeout(before + SimTime::from_s(1.0));
    }
    let period = SimTime::from_ms(4);
    assert!(rig.sim.now() - before <= period, "{}", rig.sim.now() - before);
    assert_eq!(rig.sim.autopilot_state(), Some(AutopilotState::Running { is_waiting: true }));
}

#[test]
fn flight_aircraft_is_placed_on_the_pad_after_a_crash_and_takes_off_again() {
    let mut rig = Rig::ready(AfterCrash::Respawn);
    let start = rig.sim.truth().rigid.position_m;
    rig.take_off(HEIGHT_M);
    // Without one motor, the aircraft tips over.
    rig.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, &[MOTOR, FAILURE_OFF, 1.0]);
    rig.exchange_until(|rig| rig.events.contains(&SimEvent::Respawn));
    rig.command(1, MavCmd::MAV_CMD_INJECT_FAILURE, &[MOTOR, FAILURE_OK, 1.0]);
    let placed = rig.sim.truth().rigid.position_m;
    assert!((placed - start).norm() < PAD_TOLERANCE_M, "{placed:?} {start:?}");
    assert!(rig.events.iter().any(|event| matches!(event, SimEvent::AutopilotRestart { .. })));
    let (stopped_at, hits) = (rig.sim.now(), rig.sim.hits());
    for _ in 0..100 {
        rig.exchange();
    }
    assert_eq!(rig.sim.now(), stopped_at, "session time is stopped until a new process is ready");
    rig.connect();
    rig.exchange_until(|rig| matches!(rig.sim.autopilot_state(), Some(AutopilotState::Running { .. })));
    // The exchange that ends the start also runs the first control period.
    assert!(rig.sim.now() - stopped_at <= SimTime::from_ms(4), "{} {stopped_at}", rig.sim.now());
    assert!(!rig.sim.armed(), "a new process starts disarmed");
    rig.take_off(HEIGHT_M);
    assert_eq!(rig.sim.hits(), hits, "the respawn is no contact");
}

#[test]
fn flight_after_a_crash_the_autopilot_goes_on_or_the_flight_ends() {
    for (rule, ends) in [(AfterCrash::Continue, false), (AfterCrash::End, true)] {
        let mut rig = Rig::ready(rule);
        rig.take_off(HEIGHT_M);
        rig.throttle(0);
        rig.exchange_until(|rig| rig.events.iter().any(|event| matches!(event, SimEvent::Crash { .. })));
        let crashed_at = rig.sim.now();
        rig.run_s(2.0);
        assert!(!rig.events.iter().any(|event| matches!(event, SimEvent::AutopilotRestart { .. })), "{rule:?}: {:?}", rig.events);
        assert_eq!(rig.events.iter().any(|event| matches!(event, SimEvent::Ended { .. })), ends, "{rule:?}: {:?}", rig.events);
        let placed = rig.events.iter().any(|event| matches!(event, SimEvent::Respawn));
        assert!(!placed && rig.sim.now() > crashed_at, "{rule:?}: {:?}", rig.events);
    }
}

#[test]
fn exact_start_ends_once_the_autopilot_stays_ready() {
    let mut rig = Rig::new(AfterCrash::Continue);
    rig.connect();
    rig.exchange_until(|rig| rig.px4.is_ready());
    // As PX4 does while its height estimate settles.
    rig.px4.withdraw_readiness();
    rig.exchange_until(|rig| matches!(rig.sim.autopilot_state(), Some(AutopilotState::Running { .. })));
    let took = rig.events.iter().find_map(|event| match event {
        SimEvent::AutopilotStarted { took, is_ready: true } => Some(*took),
        _ => None,
    });
    // One second until the first report, another one after it was withdrawn, and then three seconds without a break; reports are 0.2 s
    // apart.
    let took = took.unwrap_or_else(|| panic!("{:?}", rig.events));
    assert!((took.s() - 5.0).abs() < 0.5, "{took}");
}

#[test]
fn exact_autopilot_clock_rises_while_simulation_time_is_stopped() {
    let mut rig = Rig::new(AfterCrash::Continue);
    rig.connect();
    let mut times = Vec::new();
    for _ in 0..400 {
        rig.sim.handle_timeout(rig.sim.now() + SimTime::from_ms(4));
        while let Some(bytes) = rig.sim.poll_autopilot_transmit() {
            for frame in spandrel_mavlink::codec::Decoder::new().datagram(&bytes) {
                if let Some(MavMessage::HIL_SENSOR(sensor)) = &frame.message
                    && sensor.id == 0
                {
                    times.push(sensor.time_usec);
                }
            }
            let answer = rig.px4.simulator(&bytes);
            rig.sim.handle_autopilot_bytes(&answer);
        }
        for datagram in rig.px4.take_mavlink() {
            rig.sim.handle_datagram(crate::rig::AUTOPILOT, &datagram);
        }
    }
    assert!(times.len() > 300 && times[0] > 0, "{} {:?}", times.len(), times.first());
    assert!(times.windows(2).all(|pair| pair[1] == pair[0] + 4_000), "one reading each period, in order");
}

#[test]
fn wire_garbage_and_half_frames_do_not_stop_the_exchange() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.run_s(0.1);
    rig.sim.handle_autopilot_bytes(&[0xFD, 3, 0, 7, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
    rig.sim.handle_autopilot_bytes(b"\xFD\x51\x00");
    rig.run_s(1.0);
    let problems = rig.events.iter().filter(|event| matches!(event, SimEvent::AutopilotProblem { .. })).count();
    assert_eq!(problems, 1, "{:?}", rig.events);
}

#[test]
fn exact_reboot_command_restarts_a_disarmed_autopilot_only() {
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.take_off(1.0);
    rig.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, &[1.0]);
    rig.run_s(0.2);
    let ack = rig.last_ack(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN);
    assert_eq!(ack, Some((1, MavResult::MAV_RESULT_TEMPORARILY_REJECTED)));
    let mut rig = Rig::ready(AfterCrash::Continue);
    rig.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, &[1.0]);
    rig.exchange_until(|rig| rig.sim.autopilot_state() == Some(AutopilotState::Disconnected));
    assert!(rig.events.iter().any(|event| matches!(event, SimEvent::AutopilotRestart { .. })));
}
