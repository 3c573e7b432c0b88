//! ArduCopter's modes and the commands behind QGroundControl's buttons: offsets, Smart RTL, circle, follow, acro,
//! landing sequence, pause, mode switch, and the streams of ArduPilot's dialect.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter::{
    ARM, AUTO, BRAKE, GUIDED, LOITER, METERS_PER_E7_DEGREE, PAD, SET_MODE, copter, copter_at, mode, next_heartbeat,
};
use super::copter_plans::item;
use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::upload;
use spandrel_testkit::station::{Station, one, p};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
/// Tolerance within which a position counts as reached, m (the autopilot's 0.4 m, plus deceleration).
const POSITION_TOLERANCE_M: f32 = 0.7;
/// Maximum deviation from the path on the way back, m (Smart RTL's accuracy of 2 m, at which it turns to the next
/// point, and the deviations of both flights).
const MAX_PATH_DEVIATION_M: f32 = 3.0;
/// Minimum braking deceleration, m/s2 (WPNAV_ACCEL).
const MIN_DECELERATION_M_S2: f32 = 2.5;
const SMART_RTL: f32 = 21.0;
const CIRCLE: f32 = 7.0;

fn local(frame: MavFrame, mask: u16, [x, y, z]: [f32; 3]) -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: frame,
        type_mask: PositionTargetTypemask::from_bits_retain(mask),
        x,
        y,
        z,
        ..Default::default()
    })
}

fn set_param(station: &mut Station, name: &str, value: f32, param_type: MavParamType) {
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
        param_value: value,
        param_type,
    }));
    station.run_ms(5);
}

fn yaw(station: &mut Station) -> f32 {
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(30.0));
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw) } else { None }).unwrap()
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// QGroundControl's altitude slider: GUIDED mode, then one offset with only the mask's position bits clear.
#[test]
fn regress_qgroundcontrols_altitude_slider_climbs_a_copter() {
    for before in [GUIDED, BRAKE] {
        let mut station = copter_at(5.0);
        let start = station.place();
        assert_eq!(station.command(1, SET_MODE, mode(before)), ACCEPTED);
        assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
        station.send(&local(MavFrame::MAV_FRAME_LOCAL_OFFSET_NED, 0xFFF8, [0.0, 0.0, -3.0]));
        station.run_ms(12_000);
        let end = station.place();
        assert!((start[2] - end[2] - 3.0).abs() < POSITION_TOLERANCE_M, "{start:?} to {end:?}: {:?}", station.texts());
        assert!((start[0] - end[0]).hypot(start[1] - end[1]) < POSITION_TOLERANCE_M);
        assert!(!station.has_text("Setpoint"), "{:?}", station.texts());
    }
}

#[test]
fn regress_body_frame_offsets_are_relative_to_position_and_heading() {
    for frame in [MavFrame::MAV_FRAME_BODY_NED, MavFrame::MAV_FRAME_BODY_OFFSET_NED] {
        let mut station = copter_at(5.0);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, p(&[90.0, 0.0, 1.0, 0.0])), ACCEPTED);
        station.run_ms(6_000);
        let start = station.place();
        // Forward is east and right is south.
        station.send(&local(frame, 0x0DF8, [6.0, 2.0, 1.0]));
        station.run_ms(12_000);
        let wanted = [start[0] - 2.0, start[1] + 6.0, start[2] + 1.0];
        assert!(distance(station.place(), wanted) < 1.0, "{frame:?}: {:?} not {wanted:?}", station.place());
    }
}

/// QGroundControl's Return button sends mode 21.
#[test]
fn regress_smart_rtl_retraces_its_path_and_lands_at_the_start() {
    let mut station = copter_at(6.0);
    let pad = station.place();
    let corner = [pad[0] + 20.0, pad[1], pad[2] - 2.0];
    let end = [pad[0] + 20.0, pad[1] + 20.0, pad[2] - 2.0];
    // The actual flight path, with rounded corners and overshoots.
    let mut path = Vec::new();
    for place in [corner, end] {
        station.send(&local(MavFrame::MAV_FRAME_LOCAL_NED, 0x0DF8, place));
        let there = |s: &mut Station| {
            path.push(s.place());
            distance(s.place(), place) < 1.0
        };
        assert!(station.run_until(40.0, there), "{:?}", station.place());
    }
    assert_eq!(station.command(1, SET_MODE, mode(SMART_RTL)), ACCEPTED);
    assert_eq!(next_heartbeat(&mut station).custom_mode, SMART_RTL as u32);
    let mut nearest = f32::INFINITY;
    let mut path_back = Vec::new();
    let landed = station.run_until(120.0, |s| {
        let here = s.place();
        nearest = nearest.min(distance(here, corner));
        path_back.push(here);
        s.last_message(|m| if let MavMessage::EXTENDED_SYS_STATE(e) = m { Some(e.landed_state) } else { None })
            == Some(MavLandedState::MAV_LANDED_STATE_ON_GROUND)
    });
    assert!(landed, "{:?} {:?}", station.place(), station.texts());
    let off =
        |here: &[f32; 3]| path.iter().map(|there| (here[0] - there[0]).hypot(here[1] - there[1])).fold(f32::INFINITY, f32::min);
    let farthest_off = path_back.iter().map(off).fold(0.0, f32::max);
    assert!(nearest < MAX_PATH_DEVIATION_M && farthest_off < MAX_PATH_DEVIATION_M, "corner {nearest} m, path {farthest_off} m");
    let here = station.place();
    assert!((here[0] - pad[0]).hypot(here[1] - pad[1]) < 1.0, "{here:?} is not above {pad:?}");
}

#[test]
fn regress_available_modes_match_copters_names_numbers_and_order() {
    let mut station = copter();
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(435.0));
    let modes = station.all(|m| match m {
        MavMessage::AVAILABLE_MODES(m) => {
            Some((m.custom_mode, m.mode_name.to_str().unwrap().to_owned(), m.standard_mode as u32, m.properties))
        }
        _ => None,
    });
    let expected = [
        (27, "AUTO RTL"),
        (3, "AUTO"),
        (1, "ACRO"),
        (0, "STABILIZE"),
        (2, "ALT_HOLD"),
        (7, "CIRCLE"),
        (5, "LOITER"),
        (4, "GUIDED"),
        (9, "LAND"),
        (6, "RTL"),
        (16, "POSHOLD"),
        (17, "BRAKE"),
        (21, "SMARTRTL"),
        (23, "FOLLOW"),
    ];
    let expected = expected.map(|(number, name)| (number, name.to_owned(), 0, MavModeProperty::empty()));
    assert_eq!(modes, expected);
}

#[test]
fn regress_circle_mode_orbits_a_point_ahead_of_the_vehicle() {
    let mut station = copter_at(5.0);
    let (start, heading) = (station.place(), yaw(&mut station));
    set_param(&mut station, "CIRCLE_RADIUS", 600.0, MavParamType::MAV_PARAM_TYPE_REAL32);
    assert_eq!(station.command(1, SET_MODE, mode(CIRCLE)), ACCEPTED);
    let middle = [start[0] + 6.0 * heading.cos(), start[1] + 6.0 * heading.sin()];
    station.run_ms(6_000);
    let bearing = |s: &Station| (s.place()[1] - middle[1]).atan2(s.place()[0] - middle[0]);
    let before = bearing(&station);
    for _ in 0..40 {
        station.run_ms(100);
        let radius = (station.place()[0] - middle[0]).hypot(station.place()[1] - middle[1]);
        assert!((radius - 6.0).abs() < POSITION_TOLERANCE_M, "{radius}");
    }
    let turned = (bearing(&station) - before).rem_euclid(std::f32::consts::TAU).to_degrees();
    // CIRCLE_RATE is 20 deg/s clockwise.
    assert!((turned - 80.0).abs() < 15.0, "{turned} deg in 4 s");
    assert_eq!(next_heartbeat(&mut station).custom_mode, CIRCLE as u32);
}

#[test]
fn regress_loiter_without_sticks_holds_and_reports_loiter() {
    let mut station = copter_at(5.0);
    for (command, p) in [(MavCmd::MAV_CMD_NAV_LOITER_UNLIM, [0.0; 7]), (SET_MODE, mode(LOITER))] {
        // The previous stick input has expired (3 s).
        station.run_ms(4_000);
        assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
        let start = station.local_position_after(100);
        assert_eq!(station.command(1, command, p), ACCEPTED);
        station.run_ms(8_000);
        let beat = next_heartbeat(&mut station);
        assert_eq!((beat.custom_mode, beat.system_status), (LOITER as u32, MavState::MAV_STATE_ACTIVE), "{:?}", station.texts());
        assert!(distance(start, station.local_position_after(100)) < POSITION_TOLERANCE_M);
        // Centered sticks must have no effect.
        for _ in 0..60 {
            station.sticks(0, 0, 500, 0);
            station.run_ms(50);
        }
        assert_eq!(next_heartbeat(&mut station).custom_mode, LOITER as u32);
        assert!(distance(start, station.local_position_after(100)) < POSITION_TOLERANCE_M);
    }
}

#[test]
fn regress_attitude_thrust_sets_the_climb_rate() {
    let mut station = copter_at(5.0);
    let level = |thrust: f32| {
        MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            target_system: 1,
            target_component: 1,
            q: [1.0, 0.0, 0.0, 0.0],
            type_mask: AttitudeTargetTypemask::from_bits_retain(7),
            thrust,
            ..Default::default()
        })
    };
    set_param(&mut station, "WPNAV_SPEED_UP", 250.0, MavParamType::MAV_PARAM_TYPE_REAL32);
    // A thrust of 0.5 holds the height, 0.7 climbs at 0.4 times WPNAV_SPEED_UP, and 0.25 descends at half of
    // WPNAV_SPEED_DN (150 cm/s).
    for (thrust, climb) in [(0.5, 0.0), (0.7, 1.0), (0.25, -0.75)] {
        for _ in 0..60 {
            station.send(&level(thrust));
            station.run_ms(50);
        }
        let vz = station.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some(p.vz) } else { None }).unwrap();
        assert!((-vz - climb).abs() < 0.2, "thrust {thrust}: climbs {} m/s, not {climb}", -vz);
    }
}

#[test]
fn regress_condition_yaw_respects_rate_and_direction() {
    let mut station = copter_at(5.0);
    let point = |s: &mut Station, angle: f32| {
        assert_eq!(s.command(1, MavCmd::MAV_CMD_CONDITION_YAW, p(&[angle, 0.0, 0.0, 0.0])), ACCEPTED);
        s.run_ms(8_000);
    };
    point(&mut station, 0.0);
    // Turning counterclockwise to 90 degrees is a 270-degree turn at 30 deg/s.
    assert_eq!(station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, p(&[90.0, 30.0, -1.0, 0.0])), ACCEPTED);
    station.run_ms(4_000);
    let on_the_way = yaw(&mut station).to_degrees();
    assert!((-130.0..=-90.0).contains(&on_the_way), "{on_the_way} deg after 4 s");
    station.run_ms(9_000);
    let there = yaw(&mut station).to_degrees();
    assert!((there - 90.0).abs() < 3.0, "{there} deg");
    point(&mut station, 0.0);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, p(&[90.0, 10.0, 1.0, 0.0])), ACCEPTED);
    station.run_ms(4_000);
    let slow = yaw(&mut station).to_degrees();
    assert!((28.0..=44.0).contains(&slow), "{slow} deg after 4 s at 10 deg/s");
}

#[test]
fn regress_pause_holds_and_continue_resumes_in_guided() {
    let mut station = copter_at(5.0);
    let start = station.place();
    let target = [start[0] + 30.0, start[1], start[2]];
    station.send(&local(MavFrame::MAV_FRAME_LOCAL_NED, 0x0DF8, target));
    station.run_ms(4_000);
    let pause = MavCmd::MAV_CMD_DO_PAUSE_CONTINUE;
    let (from, speed) = (station.place(), station.speed());
    assert_eq!(station.command(1, pause, one(0.0)), ACCEPTED);
    station.run_ms(4_000);
    let [first, second] = [station.place(), station.local_position_after(3_000)];
    assert!(distance(first, second) < 0.4 && distance(second, target) > 2.0, "{first:?} {second:?}");
    let stopping_m = speed * speed / (2.0 * MIN_DECELERATION_M_S2);
    assert!(first[0] - from[0] < stopping_m, "paused at {from:?}, {speed} m/s: {first:?}");
    assert_eq!(next_heartbeat(&mut station).custom_mode, GUIDED as u32);
    assert_eq!(station.command(1, pause, one(1.0)), ACCEPTED);
    assert!(station.run_until(20.0, |s| distance(s.place(), target) < 1.0), "{:?}", station.place());
    assert_eq!(station.command(1, SET_MODE, mode(BRAKE)), ACCEPTED);
    assert_eq!(station.command(1, pause, one(0.0)), FAILED, "pause must be rejected in other modes");
}

/// The mission takes off, waits until a given time of day, and lands. The drill starts on a whole minute.
#[test]
fn regress_mission_supports_time_of_day_pause_and_landing_sequence() {
    let mut station = copter_at(5.0);
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(2.0));
    let unix_s = station
        .last_message(|m| if let MavMessage::SYSTEM_TIME(t) = m { Some(t.time_unix_usec / 1_000_000) } else { None })
        .unwrap();
    let then = (unix_s + 25) % 86_400;
    let clock = |mut item: MISSION_ITEM_INT_DATA| {
        item.param1 = -1.0;
        [item.param2, item.param3, item.param4] = [then / 3_600, then % 3_600 / 60, then % 60].map(|part| part as f32);
        item
    };
    let plan = [
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0),
        item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, 4.0, 6.0),
        clock(item(2, MavCmd::MAV_CMD_NAV_DELAY, 0.0, 0.0)),
        item(3, MavCmd::MAV_CMD_NAV_WAYPOINT, 24.0, 6.0),
        item(4, MavCmd::MAV_CMD_NAV_WAYPOINT, 60.0, 6.0),
        item(5, MavCmd::MAV_CMD_DO_LAND_START, 0.0, 0.0),
        item(6, MavCmd::MAV_CMD_NAV_WAYPOINT, 10.0, 6.0),
        item(7, MavCmd::MAV_CMD_NAV_LAND, 10.0, 0.0),
    ];
    assert_eq!(station.command(1, SET_MODE, mode(27.0)), FAILED, "the mission must not contain a landing sequence yet");
    assert_eq!(upload(&mut station, &plan), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    let home = station.local_position_after(100)[0];
    station.run_ms(20_000);
    assert!((station.place()[0] - home - 4.0).abs() < 1.5, "the vehicle must wait: {:?}", station.place());
    assert!(
        station.run_until(12.0, |s| s.place()[0] > home + 8.0),
        "the vehicle must continue at the planned time: {:?}",
        station.place()
    );
    let pause = MavCmd::MAV_CMD_DO_PAUSE_CONTINUE;
    assert_eq!(station.command(1, pause, one(0.0)), ACCEPTED);
    station.run_ms(4_000);
    assert!(distance(station.place(), station.local_position_after(2_000)) < 0.4, "paused");
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(42.0));
    let state = station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some(c.mission_state) } else { None });
    assert_eq!(state, Some(MissionState::MISSION_STATE_PAUSED));
    assert_eq!(next_heartbeat(&mut station).custom_mode, AUTO as u32);
    assert_eq!(station.command(1, pause, one(1.0)), ACCEPTED);
    assert!(station.run_until(20.0, |s| s.place()[0] > home + 30.0), "resumed: {:?}", station.place());
    assert_eq!(station.command(1, SET_MODE, mode(27.0)), ACCEPTED);
    assert_eq!(next_heartbeat(&mut station).custom_mode, 27);
    assert!(station.run_until(60.0, |s| s.has_text("Landing detected")), "{:?} {:?}", station.place(), station.texts());
    assert!((station.place()[0] - home - 10.0).abs() < 1.5, "{:?}", station.place());
}

#[test]
fn regress_acro_follows_stick_rates_and_levels_on_release() {
    let mut station = copter_at(15.0);
    station.sticks(0, 0, 500, 0);
    station.run_ms(20);
    assert_eq!(station.command(1, SET_MODE, mode(1.0)), ACCEPTED);
    let roll = |s: &mut Station| {
        s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(30.0));
        s.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.roll.to_degrees()) } else { None }).unwrap()
    };
    for _ in 0..10 {
        station.sticks(0, 300, 500, 0);
        station.run_ms(40);
    }
    let leaned = roll(&mut station);
    assert!((8.0..=40.0).contains(&leaned), "{leaned} deg after 0.4 s");
    for _ in 0..100 {
        station.sticks(0, 0, 520, 0);
        station.run_ms(40);
    }
    let level = roll(&mut station);
    assert!(level.abs() < 4.0, "{level} deg after release");
    assert_eq!(next_heartbeat(&mut station).custom_mode, 1);
}

#[test]
fn regress_follow_mode_keeps_its_offset() {
    let mut station = copter_at(5.0);
    assert_eq!(station.command(1, SET_MODE, mode(23.0)), FAILED);
    station.run_ms(5);
    assert!(station.has_text("FOLL_ENABLE"), "{:?}", station.texts());
    set_param(&mut station, "FOLL_ENABLE", 1.0, MavParamType::MAV_PARAM_TYPE_INT8);
    set_param(&mut station, "FOLL_OFS_X", -8.0, MavParamType::MAV_PARAM_TYPE_REAL32);
    set_param(&mut station, "FOLL_OFS_Z", -4.0, MavParamType::MAV_PARAM_TYPE_REAL32);
    let home = station.local_position_after(100);
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
    let alt = station
        .last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(g.alt - g.relative_alt) } else { None })
        .unwrap();
    assert_eq!(station.command(1, SET_MODE, mode(23.0)), ACCEPTED);
    // A person on the ground walks east at 1.5 m/s, starting 10 m north of the pad. Here, a degree of longitude is
    // 0.6858 times as long as a degree of latitude.
    let east_m_per_e7 = METERS_PER_E7_DEGREE * 0.6858;
    let mut east = 0.0;
    for k in 0..120 {
        east = 0.3 * f64::from(k);
        station.send_as(42, 1);
        station.send(&MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
            lat: PAD.0 + (10.0 / METERS_PER_E7_DEGREE) as i32,
            lon: PAD.1 + (east / east_m_per_e7) as i32,
            alt,
            vy: 150,
            hdg: 9_000,
            ..Default::default()
        }));
        station.run_ms(200);
    }
    station.send_as(255, 190);
    let here = station.place();
    // The target is 8 m south of the person and 4 m above.
    let (n, e) = (here[0] - home[0] - 2.0, f64::from(here[1] - home[1]) - east);
    assert!(n.abs() < 1.5 && e.abs() < 2.5, "{n} m north and {e} m east of the target");
    assert_eq!(next_heartbeat(&mut station).custom_mode, 23);
}

#[test]
fn regress_rc_channels_and_mode_switch_work_without_sticks() {
    let mut station = copter();
    let channels = |s: &mut Station| {
        s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(65.0));
        s.last_message(|m| if let MavMessage::RC_CHANNELS(c) = m { Some(c.clone()) } else { None }).expect("RC_CHANNELS")
    };
    let idle = channels(&mut station);
    let raw = [idle.chan1_raw, idle.chan2_raw, idle.chan3_raw, idle.chan4_raw, idle.chan5_raw, idle.chan16_raw];
    assert_eq!((idle.chancount, raw), (16, [1500, 1500, 1000, 1500, 1800, 1500]));
    set_param(&mut station, "FLTMODE1", 2.0, MavParamType::MAV_PARAM_TYPE_INT8);
    set_param(&mut station, "FLTMODE4", 16.0, MavParamType::MAV_PARAM_TYPE_INT8);
    for (chan5_raw, number) in [(1_100, 2), (1_550, 16), (1_100, 2)] {
        station.send(&MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
            chan1_raw: 1500,
            chan2_raw: 1500,
            chan3_raw: 1500,
            chan4_raw: 1500,
            chan5_raw,
            chan10_raw: 1700,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        }));
        assert_eq!(next_heartbeat(&mut station).custom_mode, number, "channel 5 at {chan5_raw}");
        let shown = channels(&mut station);
        assert_eq!((shown.chan5_raw, shown.chan10_raw), (chan5_raw, 1700));
    }
}

#[test]
fn regress_copter_streams_ardupilot_messages_as_a_multicopter() {
    let mut station = copter();
    use MavDataStream as D;
    let groups = [
        (D::MAV_DATA_STREAM_EXTENDED_STATUS, vec![125, 152]),
        (D::MAV_DATA_STREAM_EXTRA1, vec![164]),
        (D::MAV_DATA_STREAM_EXTRA3, vec![163, 168, 193]),
    ];
    for (group, ids) in groups {
        station.received.clear();
        station.send(&MavMessage::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA {
            req_message_rate: 5,
            target_system: 1,
            target_component: 1,
            req_stream_id: group,
            start_stop: 1,
        }));
        station.run_ms(1_000);
        for id in ids {
            let count = station.received.iter().filter(|frame| frame.message_id == id).count();
            assert!((4..=6).contains(&count), "message {id}: {count} in 1 s");
        }
    }
    station.received.clear();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(193.0)), ACCEPTED);
    let report = station.received.iter().find(|frame| frame.message_id == 193).expect("EKF_STATUS_REPORT").payload(26);
    // Flags recorded from a healthy ArduCopter: 831.
    assert_eq!(u16::from_le_bytes([report[20], report[21]]), 831);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(245.0)), ACCEPTED);
    let vtol = station.last_message(|m| if let MavMessage::EXTENDED_SYS_STATE(e) = m { Some(e.vtol_state) } else { None });
    assert_eq!(vtol, Some(MavVtolState::MAV_VTOL_STATE_MC));
    let mut px4 = Station::new("drill-hover", 7);
    px4.run_ms(1_000);
    assert_eq!(px4.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(193.0)), MavResult::MAV_RESULT_DENIED);
    assert_eq!(px4.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, p(&[193.0, 1e5])), FAILED);
    assert_eq!(px4.command(1, ARM, one(0.0)), ACCEPTED);
}
