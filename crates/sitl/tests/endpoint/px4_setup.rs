//! Functions behind QGroundControl's setup pages and console for PX4: calibration, the MAVLink console, follow-me.

use spandrel_mavlink::dialect::*;
use spandrel_testkit::station::{Station, one, p};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const CALIBRATE: MavCmd = MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION;
/// Maximum gyroscope offset found by a calibration: this aircraft class's bias plus the noise of the mean, rad/s.
const MAX_GYRO_OFFSET_RAD_S: f32 = 0.05;

fn ready() -> Station {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    station
}

fn param(station: &mut Station, name: &str) -> f32 {
    let asked = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
    });
    station.ask(&asked, |m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.param_value) } else { None }).expect("parameter")
}

#[test]
fn regress_gyro_calibration_sends_the_texts_that_qgroundcontrol_parses() {
    let mut station = ready();
    assert_eq!(station.command(1, CALIBRATE, one(1.0)), ACCEPTED);
    station.run_ms(5_000);
    let texts: Vec<String> = station.texts().into_iter().filter(|text| text.starts_with("[cal]")).collect();
    let expected = [
        "[cal] calibration started: 2 gyro",
        "[cal] progress <20>",
        "[cal] progress <40>",
        "[cal] progress <60>",
        "[cal] progress <80>",
        "[cal] progress <100>",
        "[cal] calibration done: gyro",
    ];
    assert_eq!(texts, expected);
    let offsets = ["CAL_GYRO0_XOFF", "CAL_GYRO0_YOFF", "CAL_GYRO0_ZOFF"].map(|name| param(&mut station, name));
    assert!(
        offsets.iter().all(|offset| offset.abs() < MAX_GYRO_OFFSET_RAD_S) && offsets.iter().any(|offset| *offset != 0.0),
        "{offsets:?}"
    );
}

#[test]
fn regress_radio_calibration_is_accepted_and_other_calibrations_respond() {
    let mut station = ready();
    assert_eq!(station.command(1, CALIBRATE, p(&[0.0, 0.0, 0.0, 1.0])), ACCEPTED, "start of the radio calibration");
    assert_eq!(station.command(1, CALIBRATE, p(&[])), ACCEPTED, "end of the radio calibration");
    assert_eq!(station.command(1, CALIBRATE, p(&[0.0, 1.0])), ACCEPTED);
    station.run_ms(5);
    assert!(station.has_text("[cal] calibration failed"), "{:?}", station.texts());
    assert_eq!(station.command(1, CALIBRATE, p(&[0.0, 0.0, 0.0, 0.0, 2.0])), ACCEPTED);
    assert_eq!(
        station.command(1, CALIBRATE, one(1.0)),
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
        "the command must be rejected while another calibration is running"
    );
    station.run_ms(5_000);
    assert!(station.has_text("[cal] calibration done: level"), "{:?}", station.texts());
    assert_eq!(station.command(1, CALIBRATE, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, CALIBRATE, p(&[])), ACCEPTED);
    station.run_ms(5);
    assert!(station.has_text("[cal] calibration cancelled"), "{:?}", station.texts());
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, CALIBRATE, one(1.0)), MavResult::MAV_RESULT_TEMPORARILY_REJECTED, "armed");
}

/// Enters a line in the console and returns the output.
fn console(station: &mut Station, line: &str) -> String {
    station.received.clear();
    for chunk in format!("{line}\n").as_bytes().chunks(70) {
        let mut data = [0; 70];
        data[..chunk.len()].copy_from_slice(chunk);
        station.send(&MavMessage::SERIAL_CONTROL(SERIAL_CONTROL_DATA {
            device: SerialControlDev::SERIAL_CONTROL_DEV_SHELL,
            // Flags that QGroundControl sends: respond, exclusive, multi.
            flags: SerialControlFlag::from_bits_retain(2 | 4 | 16),
            count: chunk.len() as u8,
            data,
            ..Default::default()
        }));
    }
    station.run_ms(1_000);
    let bytes = station.all(|m| match m {
        MavMessage::SERIAL_CONTROL(s) => Some(s.data[..usize::from(s.count)].to_vec()),
        _ => None,
    });
    String::from_utf8(bytes.concat()).unwrap()
}

#[test]
fn regress_mavlink_console_responds() {
    let mut station = ready();
    let help = console(&mut station, "help");
    assert!(help.starts_with("nsh> help\n") && help.contains("  listener\n") && help.ends_with("nsh> "), "{help}");
    let version = console(&mut station, "ver all");
    assert!(version.contains("HW arch:") && version.contains("FW version: 1.16.0"), "{version}");
    assert!(console(&mut station, "param set MIS_TAKEOFF_ALT 7.5").contains("curr: 7.5"));
    assert_eq!(param(&mut station, "MIS_TAKEOFF_ALT"), 7.5);
    assert!(console(&mut station, "param show MIS_TAKEOFF*").contains("MIS_TAKEOFF_ALT : 7.5000"));
    assert!(console(&mut station, "param set MIS_TAKEOFF_ALT 9000").contains("ERROR"));
    assert_eq!(param(&mut station, "MIS_TAKEOFF_ALT"), 7.5);
    let all = console(&mut station, "param show");
    assert!(all.contains("SYS_AUTOSTART") && all.ends_with("nsh> "), "{all}");
    let attitude = console(&mut station, "listener vehicle_attitude");
    assert!(attitude.contains("TOPIC: vehicle_attitude") && attitude.contains("q: ["), "{attitude}");
    assert!(console(&mut station, "commander check").contains("Preflight check: OK"));
    assert!(console(&mut station, "commander arm").ends_with("nsh> "));
    station.run_ms(1_100);
    let armed = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(b) if b.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(b.base_mode),
        _ => None,
    });
    assert!(armed.unwrap().contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED));
    assert!(console(&mut station, "commander mode nowhere").contains("unknown mode nowhere"));
    assert!(console(&mut station, "reboot now").contains("reboot: command not found"));
    let mut copter = Station::with_flavor(&spandrel_sitl::endpoint::flavor::ardupilot::FLAVOR, "drill-hover", 7);
    copter.run_ms(1_000);
    assert_eq!(console(&mut copter, "help"), "", "ArduPilot must not have a console");
}

#[test]
fn regress_follow_me_keeps_its_distance() {
    let mut station = Station::airborne("drill-hover", 7);
    station.sticks(0, 0, 500, 0);
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: 12.0,
        target_system: 1,
        target_component: 1,
        param_id: "FLW_TGT_DST".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }));
    station.run_ms(5);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 4.0, 8.0])), ACCEPTED);
    let start = station.local_position_after(100);
    // A person walks north at 2 m/s, starting at the drill's pad.
    for k in 0..250 {
        station.send(&MavMessage::FOLLOW_TARGET(FOLLOW_TARGET_DATA {
            est_capabilities: 3,
            lat: 467_052_000 + (0.4 * f64::from(k) / 0.011_132) as i32,
            lon: 83_814_000,
            alt: 440.0,
            vel: [2.0, 0.0, 0.0],
            ..Default::default()
        }));
        station.run_ms(200);
    }
    let end = station.place();
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
    let here = station.last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(g.clone()) } else { None }).unwrap();
    let behind = 0.4 * 249.0 + 0.4 - f64::from(here.lat - 467_052_000) * 0.011_132;
    assert!((behind - 12.0).abs() < 2.0, "{behind} m behind the target, {start:?} to {end:?}");
    // FLW_TGT_HT is relative to home.
    assert!((here.relative_alt - 8_000).abs() < 700, "{} mm above home", here.relative_alt);
    station.run_ms(1_100);
    assert_eq!(station.mode(), Some(8 << 24 | 4 << 16));
}

/// The events must have the order that libevents expects: a summary of the checks, one event for each failed check, and
/// a summary of the health. The definitions served by FTP contain their texts.
#[test]
fn regress_arming_checks_are_events_that_can_be_requested_again() {
    let events = |s: &Station| s.all(|m| if let MavMessage::EVENT(event) = m { Some(event.clone()) } else { None });
    let name = |name: &str| {
        let hash = name.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
        hash & 0x00ff_ffff | 1 << 24
    };
    let word = |event: &EVENT_DATA, at: usize| u32::from_le_bytes(event.arguments[at..at + 4].try_into().unwrap());
    let mut station = ready();
    station.received.clear();
    station.sticks(0, 900, 500, 0);
    station.run_ms(300);
    station.sticks(0, 900, 500, 0);
    station.run_ms(300);
    let report = events(&station);
    let ids: Vec<u32> = report.iter().rev().take(3).rev().map(|event| event.id).collect();
    let expected = ["commander_arming_check_summary", "check_sticks_not_centered", "commander_health_summary"].map(name);
    assert_eq!(ids, expected, "{report:?}");
    let summary = &report[report.len() - 3];
    // Remote control has an error (bit 7), no mode can be armed, and Position (bit 2) could be flown.
    assert_eq!((word(summary, 1), word(summary, 9)), (1 << 7, 0));
    assert!(word(summary, 13) & 1 << 2 != 0);
    station.received.clear();
    let [first, last] = [report[0].sequence, report[report.len() - 1].sequence];
    let asked = REQUEST_EVENT_DATA { first_sequence: first, last_sequence: last, target_system: 1, target_component: 1 };
    station.send(&MavMessage::REQUEST_EVENT(asked));
    station.run_ms(5);
    assert_eq!(events(&station), report, "again");
    station.send(&MavMessage::REQUEST_EVENT(REQUEST_EVENT_DATA {
        first_sequence: last + 100,
        last_sequence: last + 100,
        target_system: 1,
        target_component: 1,
    }));
    station.run_ms(5);
    let error = station.last_message(|m| if let MavMessage::RESPONSE_EVENT_ERROR(e) = m { Some(e.sequence) } else { None });
    assert_eq!(error, Some(last + 100));
    // If several events are missing, a single response must report where to continue.
    station.received.clear();
    station.send(&MavMessage::REQUEST_EVENT(REQUEST_EVENT_DATA {
        first_sequence: last + 100,
        last_sequence: last + 30_000,
        target_system: 1,
        target_component: 1,
    }));
    station.run_ms(5);
    let errors =
        station.all(|m| if let MavMessage::RESPONSE_EVENT_ERROR(e) = m { Some(e.sequence_oldest_available) } else { None });
    assert_eq!(errors.len(), 1, "{errors:?}");
    // When the sticks are released, every mode that does not require a mission can be armed, and QGroundControl's
    // request must return a new report.
    station.sticks(0, 0, 500, 0);
    station.run_ms(1_500);
    station.received.clear();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_RUN_PREARM_CHECKS, one(0.0)), ACCEPTED);
    station.run_ms(2_100);
    let healthy = events(&station);
    assert!(healthy.len() >= 2 && word(&healthy[0], 1) == 0 && word(&healthy[0], 9) & 1 << 17 != 0, "{healthy:?}");
    let newest = station.last_message(|m| if let MavMessage::CURRENT_EVENT_SEQUENCE(c) = m { Some(c.sequence) } else { None });
    assert_eq!(newest, healthy.last().map(|event| event.sequence));
}
