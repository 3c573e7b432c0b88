//! Compatibility with pilots and scripts written for ArduCopter: channel switches, arming by mode, the end of a
//! mission, and the order of responses (all used by ArduPilot's autotest).
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter::{ARM, AUTO, GUIDED, LOITER, SET_MODE, copter, copter_at, mode, next_heartbeat};
use super::copter_plans::item;
use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::upload;
use spandrel_testkit::station::{Station, one, p};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
/// Copter's mode numbers.
const STABILIZE: f32 = 0.0;
const ALT_HOLD: f32 = 2.0;
const RTL: f32 = 6.0;
const LAND: u32 = 9;
/// Commands that are not in the common dialect.
const DO_AUX_FUNCTION: u16 = 218;
const DO_JUMP_TAG: u16 = 601;
const COMMAND_LONG: u32 = 76;

fn set(station: &mut Station, name: &str, value: f32) {
    assert_eq!(station.set(name, value, MavParamType::MAV_PARAM_TYPE_REAL32), Some(value), "{name}");
}

/// Returns RC channels with all sticks centered except the throttle, and with switches on channels 5, 8 and 9.
fn switches(throttle: u16, chan5_raw: u16, chan8_raw: u16, chan9_raw: u16) -> MavMessage {
    MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        chan1_raw: 1500,
        chan2_raw: 1500,
        chan3_raw: throttle,
        chan4_raw: 1500,
        chan5_raw,
        chan8_raw,
        chan9_raw,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    })
}

fn turn(station: &mut Station, switches: &MavMessage) -> u32 {
    station.send(switches);
    next_heartbeat(station).custom_mode
}

fn is_armed(station: &mut Station) -> bool {
    next_heartbeat(station).base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
}

/// Returns the result of a command that is not in the dialect.
fn unknown_command(station: &mut Station, number: u16, values: [f32; 2]) -> u8 {
    let mut payload = [0u8; 33];
    payload[..4].copy_from_slice(&values[0].to_le_bytes());
    payload[4..8].copy_from_slice(&values[1].to_le_bytes());
    payload[28..30].copy_from_slice(&number.to_le_bytes());
    (payload[30], payload[31]) = (1, 1);
    station.received.clear();
    station.send_payload(COMMAND_LONG, &payload);
    station.run_ms(2);
    let ack = station.received.iter().find(|frame| frame.message_id == 77).expect("an acknowledgement");
    ack.payload(10)[2]
}

#[test]
fn wire_mode_option_switch_overrides_the_mode_switch() {
    let mut station = copter();
    set(&mut station, "FLTMODE1", ALT_HOLD);
    set(&mut station, "RC9_OPTION", 18.0);
    assert_eq!(
        turn(&mut station, &switches(1000, 1000, 1500, 1900)),
        ALT_HOLD as u32,
        "the initial switch position must not count as a change"
    );
    turn(&mut station, &switches(1000, 1000, 1500, 1000));
    assert_eq!(turn(&mut station, &switches(1000, 1000, 1500, 1900)), LAND);
    assert_eq!(turn(&mut station, &switches(1000, 1000, 1500, 1000)), ALT_HOLD as u32);
    let [accepted, denied, failed, unsupported] = [0, 2, 4, 3];
    assert_eq!(unknown_command(&mut station, DO_AUX_FUNCTION, [56.0, 2.0]), accepted);
    assert_eq!(next_heartbeat(&mut station).custom_mode, LOITER as u32);
    assert_eq!(unknown_command(&mut station, DO_AUX_FUNCTION, [56.0, 3.0]), denied, "a fourth position must be rejected");
    assert_eq!(unknown_command(&mut station, DO_AUX_FUNCTION, [299.0, 2.0]), failed);
    let mut px4 = Station::new("drill-hover", 7);
    px4.run_ms(2_500);
    assert_eq!(unknown_command(&mut px4, DO_AUX_FUNCTION, [56.0, 2.0]), unsupported);
}

#[test]
fn wire_arming_switch_acts_only_when_moved() {
    let mut station = copter();
    station.command(1, SET_MODE, mode(ALT_HOLD));
    set(&mut station, "RC8_OPTION", 153.0);
    set(&mut station, "FLTMODE_CH", 0.0);
    station.send(&switches(1000, 1500, 1000, 1500));
    assert!(!is_armed(&mut station));
    station.send(&switches(1000, 1500, 2000, 1500));
    assert!(is_armed(&mut station));
    station.send(&switches(1000, 1500, 1000, 1500));
    assert!(!is_armed(&mut station));
    station.send(&switches(1000, 1500, 2000, 1500));
    assert!(is_armed(&mut station));
    station.command(1, ARM, one(0.0));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, one(1.0)), ACCEPTED);
    station.run_ms(2_500);
    station.send(&switches(1000, 1500, 2000, 1500));
    assert!(!is_armed(&mut station));
}

#[test]
fn flight_switches_save_and_clear_waypoints() {
    let mut station = copter_at(5.0);
    set(&mut station, "RC8_OPTION", 7.0);
    set(&mut station, "RC9_OPTION", 58.0);
    set(&mut station, "FLTMODE_CH", 0.0);
    let total = |station: &mut Station| {
        station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(42.0));
        station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some(c.total) } else { None }).unwrap()
    };
    // A takeoff item precedes the first waypoint.
    for (chan8_raw, count) in [(1000, 0), (2000, 2), (1000, 2), (2000, 3)] {
        station.send(&switches(1500, 1500, chan8_raw, 1000));
        station.run_ms(100);
        assert_eq!(total(&mut station), count, "switch at {chan8_raw}");
    }
    station.send(&switches(1500, 1500, 2000, 2000));
    station.run_ms(100);
    assert_eq!(total(&mut station), 0);
}

#[test]
fn wire_throttle_arming_check_depends_on_the_mode() {
    let mut station = copter();
    set(&mut station, "FLTMODE_CH", 0.0);
    let middle = switches(1500, 1500, 1500, 1500);
    let high = switches(1800, 1500, 1500, 1500);
    station.command(1, SET_MODE, mode(LOITER));
    station.send(&high);
    station.run_ms(100);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_RUN_PREARM_CHECKS, one(0.0)), ACCEPTED);
    station.run_ms(5);
    assert!(!station.has_text("PreArm"), "sticks must be checked only when arming: {:?}", station.texts());
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED);
    station.run_ms(5);
    assert!(station.has_text("Arm: Throttle too high"), "{:?}", station.texts());
    station.command(1, SET_MODE, mode(GUIDED));
    station.send(&high);
    station.run_ms(100);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED, "GUIDED must ignore the throttle");
    station.send(&middle);
    station.run_ms(100);
    assert_eq!(
        station.command(1, SET_MODE, mode(STABILIZE)),
        FAILED,
        "the mode change must be rejected because of the high throttle"
    );
    station.run_ms(5);
    assert!(station.has_text("throttle too high"), "{:?}", station.texts());
    station.send(&switches(1000, 1500, 1500, 1500));
    station.run_ms(100);
    assert_eq!(station.command(1, SET_MODE, mode(STABILIZE)), ACCEPTED);
}

#[test]
fn flight_mission_ends_in_auto_and_can_be_repeated() {
    let mut station = copter();
    let place = MavCmd::MAV_CMD_NAV_WAYPOINT;
    let items = [
        item(0, place, 0.0, 0.0),
        item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 4.0),
        item(2, place, 4.0, 4.0),
        item(3, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0),
    ];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    set(&mut station, "AUTO_OPTIONS", 3.0);
    set(&mut station, "RTL_LOIT_TIME", 0.0);
    set(&mut station, "RTL_ALT", 500.0);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    for flight in 1..=2 {
        assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED, "flight {flight}: {:?}", station.texts());
        assert!(station.run_until(20.0, |s| s.place()[2] < -2.0), "flight {flight} takes off: {:?}", station.texts());
        assert!(station.run_until(90.0, |s| s.has_text("Disarmed by landing")), "flight {flight}: {:?}", station.texts());
        assert_eq!(next_heartbeat(&mut station).custom_mode, AUTO as u32, "flight {flight}");
    }
}

#[test]
fn flight_auto_takeoff_requires_raised_throttle() {
    let mut station = copter();
    set(&mut station, "FLTMODE_CH", 0.0);
    let items = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0), item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 4.0)];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    station.command(1, SET_MODE, mode(LOITER));
    station.send(&switches(1000, 1500, 1500, 1500));
    station.run_ms(100);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    let ground = station.local_position_after(100)[2];
    for (throttle, rises) in [(1000, false), (1500, true)] {
        let flies = station.run_until(4.0, |s| {
            s.send(&switches(throttle, 1500, 1500, 1500));
            ground - s.place()[2] > 1.0
        });
        assert_eq!(flies, rises, "throttle {throttle}: {:?}", station.texts());
    }
}

#[test]
fn wire_delay_item_without_seconds_waits_for_a_time_of_day() {
    let mut station = copter();
    let clock =
        station.last_message(|m| if let MavMessage::SYSTEM_TIME(t) = m { Some(t.time_unix_usec / 1_000_000) } else { None });
    let clock = clock.unwrap_or_else(|| {
        station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(2.0));
        station
            .last_message(|m| if let MavMessage::SYSTEM_TIME(t) = m { Some(t.time_unix_usec / 1_000_000) } else { None })
            .unwrap()
    });
    const DELAY_S: u64 = 30;
    let due = (clock + DELAY_S) % 86_400;
    let delay = MISSION_ITEM_INT_DATA {
        param1: 0.0,
        param2: (due / 3_600) as f32,
        param3: (due / 60 % 60) as f32,
        param4: (due % 60) as f32,
        ..item(1, MavCmd::MAV_CMD_NAV_DELAY, 0.0, 0.0)
    };
    let items = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0), delay, item(2, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 4.0)];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    set(&mut station, "AUTO_OPTIONS", 3.0);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let up = |s: &mut Station| s.has_text("Takeoff detected");
    assert!(!station.run_until(DELAY_S as f64 - 5.0, up), "takeoff before the set time");
    assert!(station.run_until(10.0, up), "no takeoff at the set time: {:?}", station.texts());
}

#[test]
fn wire_acknowledgment_precedes_the_requested_message() {
    let mut station = copter();
    for (command, values, shown) in [
        (MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[49.0]), 49),
        (MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[108.0]), 108),
        (MavCmd::MAV_CMD_DO_SET_HOME, p(&[1.0]), 242),
    ] {
        assert_eq!(station.command(1, command, values), ACCEPTED, "{shown}");
        station.run_ms(5);
        let order: Vec<u32> = station.received.iter().map(|f| f.message_id).filter(|id| *id == 77 || *id == shown).collect();
        assert_eq!(order, [77, shown]);
    }
}

#[test]
fn wire_rejections_match_copter() {
    let mut station = copter();
    let items = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0), item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 4.0)];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    for values in [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
        assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, p(&values)), DENIED, "{values:?}");
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one(-1.0)), DENIED);
    let [denied, failed] = [2, 4];
    assert_eq!(unknown_command(&mut station, DO_JUMP_TAG, [65_535.0, 0.0]), failed);
    assert_eq!(unknown_command(&mut station, DO_JUMP_TAG, [65_536.0, 0.0]), denied);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_VTOL_LAND, p(&[])), ACCEPTED);
    assert_eq!(next_heartbeat(&mut station).custom_mode, LAND);
}

#[test]
fn flight_return_uses_the_rally_points_height_and_restores_the_heading() {
    let mut station = copter();
    set(&mut station, "WP_YAW_BEHAVIOR", 1.0);
    set(&mut station, "RALLY_INCL_HOME", 0.0);
    let heading = |s: &mut Station| {
        s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
        s.run_ms(5);
        s.last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(f32::from(g.hdg) / 100.0) } else { None })
            .unwrap()
    };
    let armed = heading(&mut station);
    let rally = MISSION_ITEM_INT_DATA {
        mission_type: MavMissionType::MAV_MISSION_TYPE_RALLY,
        ..item(0, MavCmd::MAV_CMD_NAV_RALLY_POINT, 15.0, 12.0)
    };
    assert_eq!(upload(&mut station, &[rally]), MavMissionResult::MAV_MISSION_ACCEPTED);
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let ground = station.local_position_after(100)[2];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0]), ACCEPTED);
    assert!(station.run_until(30.0, |s| ground - s.place()[2] > 4.5));
    station.command(1, SET_MODE, mode(RTL));
    let mut highest = 0.0f32;
    let there = station.run_until(90.0, |s| {
        highest = highest.max(ground - s.place()[2]);
        s.has_text("Rally point reached")
    });
    assert!(there, "{:?}", station.texts());
    assert!((highest - 12.0).abs() < HEIGHT_TOLERANCE_M, "{highest} m");
    station.run_ms(4_500);
    let off = (heading(&mut station) - armed + 540.0).rem_euclid(360.0) - 180.0;
    assert!(off.abs() < HEADING_TOLERANCE_DEG, "heading {off} degrees off the one at arming");
}

/// Height tolerance, m, and heading tolerance, degrees, during a return (ArduPilot's autotest: 5 degrees).
const HEIGHT_TOLERANCE_M: f32 = 1.0;
const HEADING_TOLERANCE_DEG: f32 = 5.0;

#[test]
fn flight_fence_autoenable_follows_takeoff_and_landing() {
    let mut station = copter();
    set(&mut station, "FENCE_ENABLE", 0.0);
    set(&mut station, "FENCE_ALT_MAX", 50.0);
    set(&mut station, "FENCE_AUTOENABLE", 3.0);
    let status = |s: &mut Station| s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(162.0));
    assert_eq!(status(&mut station), FAILED, "a disabled fence must not have a status");
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    station.run_ms(100);
    assert_eq!(status(&mut station), ACCEPTED);
    station.command(1, ARM, one(0.0));
    station.run_ms(100);
    assert_eq!(status(&mut station), FAILED);
}

#[test]
fn flight_guided_faces_a_position_without_heading() {
    let mut station = copter_at(5.0);
    let [x, y, z] = station.place();
    let target = MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(0x0DF8),
        x,
        y: y + 40.0,
        z,
        ..Default::default()
    });
    let yaw = |s: &mut Station| {
        s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(30.0));
        s.run_ms(5);
        s.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw.to_degrees()) } else { None }).unwrap()
    };
    assert!((yaw(&mut station) - 90.0).abs() > 30.0, "the initial heading must be different");
    station.send(&target);
    station.run_ms(2_500);
    station.send(&target);
    station.run_ms(2_500);
    let looks = yaw(&mut station);
    assert!((looks - 90.0).abs() < HEADING_TOLERANCE_DEG, "{looks}");
}
