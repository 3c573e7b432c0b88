//! The ArduCopter interface in flight: modes, arming, takeoff, GUIDED, and manual control.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter_plans::item;
use spandrel_mavlink::dialect::*;
use spandrel_sitl::endpoint::flavor::ardupilot;
use spandrel_testkit::station::{Station, one};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
pub(super) const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
pub(super) const SET_MODE: MavCmd = MavCmd::MAV_CMD_DO_SET_MODE;
/// Copter's mode numbers.
const ALT_HOLD: f32 = 2.0;
pub(super) const AUTO: f32 = 3.0;
pub(super) const GUIDED: f32 = 4.0;
pub(super) const LOITER: f32 = 5.0;
const RTL: f32 = 6.0;
const POSHOLD: f32 = 16.0;
pub(super) const BRAKE: f32 = 17.0;
/// Tolerance within which a height counts as reached, m (the autopilot's 0.4 m, plus deceleration).
const HEIGHT_TOLERANCE_M: f32 = 0.6;
/// Position of the drill's pad in 1e-7 degrees, and meters north per 1e-7 degree.
pub(super) const PAD: (i32, i32) = (467_052_000, 83_814_000);
pub(super) const METERS_PER_E7_DEGREE: f64 = 0.011_132;

pub(super) fn mode(number: f32) -> [f32; 7] {
    [1.0, number, 0.0, 0.0, 0.0, 0.0, 0.0]
}

pub(super) fn beat(station: &Station) -> HEARTBEAT_DATA {
    station
        .last_message(|m| match m {
            MavMessage::HEARTBEAT(beat) if beat.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(beat.clone()),
            _ => None,
        })
        .unwrap()
}

pub(super) fn next_heartbeat(station: &mut Station) -> HEARTBEAT_DATA {
    station.received.clear();
    station.run_ms(1_100);
    beat(station)
}

/// Returns a Copter on the ground, ready to arm, with the streams that these tests use.
pub(super) fn copter() -> Station {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    for id in [32.0, 33.0, 245.0, 65.0] {
        let interval = [id, 50_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, interval), ACCEPTED);
    }
    station
}

/// Returns a Copter in GUIDED at a given height above home in meters.
pub(super) fn copter_at(height_m: f32) -> Station {
    let mut station = copter();
    assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let take_off = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, take_off), ACCEPTED);
    let ground = station.local_position_after(100)[2];
    assert!(
        station.run_until(30.0, |s| ground - s.place()[2] > height_m - HEIGHT_TOLERANCE_M),
        "no takeoff: {:?}",
        station.texts()
    );
    station.run_ms(3_000);
    station
}

#[test]
fn wire_mode_rejections_match_copter() {
    let mut station = copter();
    for (number, name) in [(77.0, "No such mode 77"), (AUTO, "Mode change to AUTO failed: No mission to fly")] {
        assert_eq!(station.command(1, SET_MODE, mode(number)), FAILED);
        station.run_ms(5);
        assert!(station.texts().iter().any(|text| text.starts_with(name)), "{:?}", station.texts());
    }
    assert_eq!(station.command(1, SET_MODE, [0.0, GUIDED, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED, "a custom mode requires its flag");
    let switch = SET_MODE_DATA { custom_mode: 0, target_system: 1, base_mode: MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED };
    station.send(&MavMessage::SET_MODE(switch));
    assert_eq!(
        next_heartbeat(&mut station).custom_mode,
        LOITER as u32,
        "MAVProxy's encoding of the safety switch must not change the mode"
    );
    assert_eq!(station.command(1, SET_MODE, mode(RTL)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED);
    station.run_ms(5);
    assert!(station.texts().contains(&"Arm: RTL mode not armable".to_owned()), "{:?}", station.texts());
    station.command(1, SET_MODE, mode(LOITER));
    station.sticks(0, 900, 500, 0);
    station.run_ms(100);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED);
    station.run_ms(5);
    assert!(station.texts().contains(&"Arm: Sticks not centered".to_owned()), "{:?}", station.texts());
    assert_eq!(station.command(1, MavCmd::MAV_CMD_RUN_PREARM_CHECKS, one(0.0)), ACCEPTED);
    station.run_ms(5);
    assert!(!station.texts().contains(&"PreArm: Sticks not centered".to_owned()), "sticks must be checked only when arming");
    let forced = [1.0, 2989.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, ARM, forced), ACCEPTED, "ArduPilot's magic number must force arming");
}

#[test]
fn wire_low_throttle_does_not_prevent_arming() {
    let low = |chan3_raw| {
        MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
            chan1_raw: 1500,
            chan2_raw: 1500,
            chan3_raw,
            chan4_raw: 1500,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    let mut station = copter();
    station.command(1, SET_MODE, mode(ALT_HOLD));
    for (pulse, result) in [(1_900, FAILED), (1_000, ACCEPTED)] {
        station.send(&low(pulse));
        station.run_ms(200);
        assert_eq!(station.command(1, ARM, one(1.0)), result, "throttle {pulse}");
    }
    station.send(&low(1_000));
    assert_eq!(next_heartbeat(&mut station).custom_mode, ALT_HOLD as u32);
    let mut px4 = Station::new("drill-hover", 7);
    px4.run_ms(2_500);
    px4.send(&low(1_000));
    px4.run_ms(200);
    assert_eq!(px4.command(1, ARM, one(1.0)), MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
}

#[test]
fn flight_guided_takeoff_is_relative_to_home_and_stays_in_guided() {
    let mut station = copter();
    let take_off = |height: f32| [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height];
    let command = MavCmd::MAV_CMD_NAV_TAKEOFF;
    assert_eq!(station.command(1, command, take_off(6.0)), FAILED, "takeoff requires GUIDED");
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, command, take_off(6.0)), FAILED, "takeoff requires armed motors");
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let on_ground = next_heartbeat(&mut station);
    assert_eq!(
        (on_ground.custom_mode, on_ground.system_status),
        (GUIDED as u32, MavState::MAV_STATE_STANDBY),
        "the vehicle must be armed on the ground"
    );
    assert_eq!(station.command(1, command, take_off(0.0)), FAILED);
    assert_eq!(station.command(1, command, take_off(f32::NAN)), FAILED);
    assert_eq!(station.command(1, command, take_off(6.0)), ACCEPTED);
    let flying = next_heartbeat(&mut station);
    assert!(station.run_until(5.0, |s| beat(s).system_status == MavState::MAV_STATE_ACTIVE));
    assert_eq!(flying.custom_mode, GUIDED as u32, "the mode must stay GUIDED during takeoff");
    let ground = 0.0;
    assert!(station.run_until(30.0, |s| ground - s.place()[2] > 6.0 - HEIGHT_TOLERANCE_M));
    station.run_ms(2_000);
    let height = -station.local_position_after(100)[2];
    assert!((height - 6.0).abs() < 2.0 * HEIGHT_TOLERANCE_M, "the height must count from home, not from sea level: {height}");
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32, "the mode must stay GUIDED after takeoff");
    assert_eq!(station.command(1, command, take_off(9.0)), FAILED, "a second takeoff in the air must be rejected");
    assert_eq!(station.command(1, ARM, one(0.0)), FAILED, "disarming in the air must be rejected");
}

#[test]
fn flight_guided_follows_setpoints_and_single_positions() {
    let mut station = copter_at(5.0);
    let target = |type_mask: u16, x, y, z, vx| {
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            target_system: 1,
            target_component: 1,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
            type_mask: PositionTargetTypemask::from_bits_retain(type_mask),
            x,
            y,
            z,
            vx,
            ..Default::default()
        })
    };
    let [north, east, down] = station.place();
    station.send(&target(0x0DF8, north + 12.0, east, down, 0.0));
    let there = |s: &mut Station| (s.place()[0] - north - 12.0).abs() < 0.6;
    assert!(station.run_until(20.0, there), "{:?}", station.place());
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
    for _ in 0..30 {
        station.send(&target(0x0DC7, 0.0, 0.0, 0.0, -2.0));
        station.run_ms(100);
    }
    let [then, ..] = station.place();
    assert!(then < north + 9.0, "the vehicle must fly south: {then}");
    station.run_ms(9_000);
    let [first, ..] = station.place();
    let [second, ..] = station.local_position_after(2_000);
    assert!((first - second).abs() < 0.2, "the vehicle must stop when setpoints end: {first} {second}");
    let status = next_heartbeat(&mut station);
    assert_eq!(
        (status.custom_mode, status.system_status),
        (GUIDED as u32, MavState::MAV_STATE_ACTIVE),
        "the end of setpoints is not a failure"
    );
    station.command(1, SET_MODE, mode(BRAKE));
    station.send(&target(0x0DF8, north, east, down, 0.0));
    station.run_ms(3_000);
    assert!((station.place()[0] - second).abs() < 0.5, "other modes must ignore setpoints");
}

#[test]
fn flight_goto_requires_or_enters_guided_and_brake_stops_it() {
    let mut station = copter_at(5.0);
    let place = |flags: f32| {
        MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            target_system: 1,
            target_component: 1,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            param1: -1.0,
            param2: flags,
            param4: f32::NAN,
            x: PAD.0 + (40.0 / METERS_PER_E7_DEGREE) as i32,
            y: PAD.1,
            z: 5.0,
            ..Default::default()
        })
    };
    let result = |m: &MavMessage| match m {
        MavMessage::COMMAND_ACK(ack) if ack.command == MavCmd::MAV_CMD_DO_REPOSITION => Some(ack.result),
        _ => None,
    };
    station.command(1, SET_MODE, mode(BRAKE));
    assert_eq!(station.ask(&place(0.0), result), Some(DENIED));
    assert_eq!(station.ask(&place(1.0), result), Some(ACCEPTED));
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
    station.run_ms(2_000);
    assert_eq!(station.command(1, SET_MODE, mode(BRAKE)), ACCEPTED);
    station.run_ms(5_000);
    let [first, ..] = station.place();
    let [second, ..] = station.local_position_after(2_000);
    assert!((first - second).abs() < 0.3 && first < 39.0, "the vehicle must have stopped before the target: {first} {second}");
    assert_eq!(next_heartbeat(&mut station).custom_mode, BRAKE as u32);
    // The single-item message that MAVProxy and older ground stations use.
    station.command(1, SET_MODE, mode(GUIDED));
    let errand = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 6.0);
    let answer = station.ask(&MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA { current: 2, ..errand }), |m| match m {
        MavMessage::MISSION_ACK(ack) => Some(ack.mavtype),
        _ => None,
    });
    assert_eq!(answer, Some(MavMissionResult::MAV_MISSION_ACCEPTED));
    assert!(station.run_until(30.0, |s| s.place()[0].abs() < 1.0), "the vehicle must return to the pad: {:?}", station.place());
}

#[test]
fn flight_stick_input_takes_over_and_stick_modes_keep_their_number() {
    let mut station = copter_at(5.0);
    for _ in 0..20 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(50);
    }
    for _ in 0..40 {
        station.sticks(700, 0, 500, 0);
        station.run_ms(50);
    }
    assert_eq!(beat(&station).custom_mode, LOITER as u32, "stick input must switch to LOITER");
    assert_eq!(station.command(1, SET_MODE, mode(POSHOLD)), ACCEPTED);
    for _ in 0..40 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(50);
    }
    assert_eq!(beat(&station).custom_mode, POSHOLD as u32);
    station.run_ms(5_000);
    let lost = next_heartbeat(&mut station);
    assert_eq!(
        (lost.custom_mode, lost.system_status),
        (BRAKE as u32, MavState::MAV_STATE_CRITICAL),
        "lost sticks must trigger a failsafe"
    );
}
