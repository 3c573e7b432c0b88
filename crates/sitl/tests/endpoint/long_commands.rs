//! Lifetime of commands and settings: across arming, across a pause, and until the end of the flight.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_sitl::endpoint::flavor::ardupilot;
use spandrel_testkit::plans::{ACCEPTED, home_north, item, ready, upload};
use spandrel_testkit::station::Station;

const OK: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const NAN: f32 = f32::NAN;
const FENCE: MavMissionType = MavMissionType::MAV_MISSION_TYPE_FENCE;
const FORCED: [f32; 7] = [0.0, 21_196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;

fn one(p: f32) -> [f32; 7] {
    [p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
}

fn has_text(station: &Station, what: &str) -> bool {
    let text = |m: &MavMessage| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None };
    station.all(text).iter().any(|text| text.contains(what))
}

fn set(station: &mut Station, name: &str, value: f32) {
    assert!(station.set(name, value, MavParamType::MAV_PARAM_TYPE_REAL32).is_some());
}

fn speed(station: &Station) -> f32 {
    station.last_message(|m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some(p.vx.hypot(p.vy)) } else { None }).unwrap()
}

fn has_fence(station: &mut Station) -> bool {
    station.run_ms(1_100);
    let enabled = |m: &MavMessage| if let MavMessage::SYS_STATUS(s) = m { Some(s.onboard_control_sensors_enabled) } else { None };
    station.last_message(enabled).unwrap().contains(MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE)
}

#[test]
fn wire_command_and_parameter_both_switch_the_fence() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    let interval = [1.0, 200_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, interval), OK);
    let area = MISSION_ITEM_INT_DATA {
        param1: 60.0,
        mission_type: FENCE,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    assert_eq!(upload(&mut station, &[area]), ACCEPTED);
    set(&mut station, "FENCE_ENABLE", 0.0);
    assert!(!has_fence(&mut station));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_FENCE_ENABLE, one(1.0)), OK);
    station.run_ms(10);
    let shown = |m: &MavMessage| match m {
        MavMessage::PARAM_VALUE(v) if v.param_id.to_str() == Ok("FENCE_ENABLE") => Some(v.param_value),
        _ => None,
    };
    assert_eq!(station.last_message(shown), Some(1.0));
    assert!(has_fence(&mut station));
    // Another parameter must not affect the fence.
    set(&mut station, "WPNAV_SPEED", 300.0);
    assert!(has_fence(&mut station));
}

#[test]
fn wire_fence_disabled_in_flight_is_enabled_after_landing() {
    let mut station = Station::airborne("drill-hover", 7);
    let area = MISSION_ITEM_INT_DATA {
        param1: 500.0,
        mission_type: FENCE,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    let back = MISSION_ITEM_INT_DATA { mission_type: FENCE, ..item(1, MavCmd::MAV_CMD_NAV_FENCE_RETURN_POINT, 0.0, 5.0) };
    assert_eq!(upload(&mut station, &[area, back]), ACCEPTED, "a fence with a return point");
    station.run_ms(10);
    assert!(has_text(&station, "Fence return point not used"));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_FENCE_ENABLE, one(0.0)), OK);
    assert!(!has_fence(&mut station));
    set(&mut station, "MIS_TAKEOFF_ALT", 3.0);
    assert!(!has_fence(&mut station), "the wrong parameter must have no effect");
    assert_eq!(station.command(1, ARM, FORCED), OK);
    assert!(has_fence(&mut station));
}

#[test]
fn wire_arming_keeps_a_home_set_by_command() {
    let mut station = ready(7);
    let there = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 55.0, 0.0);
    let home = |s: &mut Station| {
        s.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(242.0));
        s.last_message(|m| if let MavMessage::HOME_POSITION(h) = m { Some(h.latitude) } else { None }).unwrap()
    };
    station.send(&MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command: MavCmd::MAV_CMD_DO_SET_HOME,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        x: there.x,
        y: there.y,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    }));
    station.run_ms(10);
    let before = home(&mut station);
    assert!((before - there.x).abs() < 5, "{before}");
    assert_eq!(station.command(1, ARM, one(1.0)), OK);
    assert_eq!(home(&mut station), before);
}

#[test]
fn flight_disarming_discards_an_unreached_takeoff_height() {
    let mut station = ready(7);
    let amsl = spandrel_testkit::shipped::scenario("drill-hover").origin.altitude_m as f32;
    let up = [0.0, 0.0, 0.0, NAN, NAN, NAN, amsl + 40.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, up), OK);
    assert_eq!(station.command(1, ARM, one(1.0)), OK);
    station.run_ms(3_000);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), OK);
    assert!(station.run_until(60.0, |s| has_text(s, "Disarmed by landing")), "{:?}", station.place());
    let ground = station.place()[2];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0]), OK);
    assert_eq!(station.command(1, ARM, one(1.0)), OK);
    station.run_ms(12_000);
    let height = ground - station.place()[2];
    assert!((1.5..4.0).contains(&height), "{height} m instead of the parameter's 2.5 m");
}

#[test]
fn flight_commanded_speed_lasts_until_its_parameter_changes() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    assert_eq!(upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 150.0, 8.0)]), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    let slow = [1.0, 2.0, -1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_CHANGE_SPEED, slow), OK);
    set(&mut station, "MIS_TAKEOFF_ALT", 3.0);
    station.run_ms(8_000);
    assert!((speed(&station) - 2.0).abs() < 0.3, "{}", speed(&station));
    set(&mut station, "MPC_XY_CRUISE", 4.0);
    station.run_ms(6_000);
    assert!((speed(&station) - 4.0).abs() < 0.4, "{}", speed(&station));
}

/// The circle is interrupted after more than half of its turns; only the rest must be flown.
#[test]
fn flight_paused_circle_resumes_with_the_remaining_turns() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    let round = MISSION_ITEM_INT_DATA { param1: 3.0, param3: 6.0, ..item(0, MavCmd::MAV_CMD_NAV_LOITER_TURNS, north, 8.0) };
    assert_eq!(upload(&mut station, &[round]), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    let began = station.sim.now();
    assert!(station.run_until(120.0, |s| has_text(s, "Mission finished")));
    let whole_s = (station.sim.now() - began).s();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    station.run_ms((whole_s * 700.0) as i64);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, [0.0; 7]), OK);
    station.run_ms(3_000);
    let state = station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some(c.mission_state) } else { None });
    assert_eq!(state, Some(MissionState::MISSION_STATE_PAUSED));
    let resumed = station.sim.now();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, one(1.0)), OK);
    assert!(station.run_until(120.0, |s| has_text(s, "Mission finished")));
    let rest_s = (station.sim.now() - resumed).s();
    assert!(rest_s < 0.65 * whole_s, "{rest_s} of {whole_s} s");
}

fn continued(station: &mut Station, go_on: bool) {
    let wish = one(f32::from(u8::from(go_on)));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, wish), OK);
}

fn fly_manually(station: &mut Station, right: i16, z: i16, ms: i64) {
    for _ in 0..ms / 20 {
        station.sticks(0, right, z, 0);
        station.run_ms(20);
    }
}

fn horizontal_distance_m(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Maximum horizontal and vertical distance between the interruption point and the point where a step resumes, m (the
/// estimation error, plus the 0.8 m within which a point counts as reached).
const RESUME_TOLERANCE_M: f32 = 1.5;

#[test]
fn flight_interrupted_takeoff_resumes_at_its_position() {
    let mut station = ready(7);
    let home = home_north(&station);
    let plan = [item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, home, 30.0), item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 40.0, 30.0)];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    assert_eq!(station.command(1, ARM, one(1.0)), OK);
    let over = station.local_position_after(25);
    assert!(station.run_until(30.0, |s| s.place()[2] < -8.0));
    fly_manually(&mut station, 1000, 500, 4_000);
    fly_manually(&mut station, 0, 500, 2_000);
    assert!(horizontal_distance_m(station.place(), over) > 8.0, "the pilot must have flown away");
    continued(&mut station, true);
    let mut up = f32::INFINITY;
    assert!(station.run_until(60.0, |s| {
        up = up.min(s.place()[2]);
        has_text(s, "Mission resumed from interruption point")
    }));
    assert!(horizontal_distance_m(station.place(), over) < RESUME_TOLERANCE_M, "{:?} is not above {over:?}", station.place());
    assert!(up > -14.0, "the vehicle must return before it climbs: {up}");
    assert!(station.run_until(60.0, |s| s.place()[2] < -27.0));
    assert!(horizontal_distance_m(station.place(), over) < RESUME_TOLERANCE_M, "{:?} is not above {over:?}", station.place());
    assert!(station.run_until(60.0, |s| has_text(s, "Mission finished")));
}

#[test]
fn flight_landing_paused_twice_resumes_its_descent() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let place = home + 20.0;
    let plan = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, place, 20.0), item(1, MavCmd::MAV_CMD_NAV_LAND, place, 0.0)];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    let sinking =
        |s: &mut Station| s.last_message(|m| if let MavMessage::EXTENDED_SYS_STATE(e) = m { Some(e.landed_state) } else { None });
    assert!(station.run_until(90.0, |s| sinking(s) == Some(MavLandedState::MAV_LANDED_STATE_LANDING) && s.place()[2] > -12.0));
    let left = station.place();
    fly_manually(&mut station, 1000, 500, 3_000);
    fly_manually(&mut station, 0, 500, 1_500);
    let state =
        |s: &Station| s.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some(c.mission_state) } else { None });
    assert_eq!(state(&station), Some(MissionState::MISSION_STATE_PAUSED), "the mission must be paused during landing");
    continued(&mut station, true);
    station.run_ms(400);
    continued(&mut station, false);
    station.run_ms(1_500);
    assert_eq!(state(&station), Some(MissionState::MISSION_STATE_PAUSED), "the mission must be paused on the way back");
    continued(&mut station, true);
    assert!(station.run_until(60.0, |s| has_text(s, "Mission resumed from interruption point")));
    let back = station.place();
    assert!(
        horizontal_distance_m(back, left) < RESUME_TOLERANCE_M && (back[2] - left[2]).abs() < RESUME_TOLERANCE_M,
        "{left:?} {back:?}"
    );
    station.run_ms(1_500);
    assert!(station.place()[2] > back[2] + 0.5, "the vehicle must descend immediately: {back:?} to {:?}", station.place());
    assert!(station.run_until(90.0, |s| has_text(s, "Disarmed by landing")));
    assert!(horizontal_distance_m(station.place(), left) < RESUME_TOLERANCE_M, "{left:?} {:?}", station.place());
}

#[test]
fn flight_return_interrupted_during_descent_does_not_climb() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let plan = [
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 40.0, 10.0),
        MISSION_ITEM_INT_DATA {
            frame: MavFrame::MAV_FRAME_MISSION,
            x: 0,
            y: 0,
            ..item(1, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0)
        },
    ];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    assert!(station.run_until(180.0, |s| has_text(s, "Home reached, landing") && s.place()[2] > -8.0), "{:?}", station.place());
    let left = station.place();
    fly_manually(&mut station, 1000, 500, 6_000);
    fly_manually(&mut station, 0, 500, 2_000);
    assert!(horizontal_distance_m(station.place(), left) > 10.0, "the pilot must have flown away");
    continued(&mut station, true);
    let mut highest = f32::INFINITY;
    assert!(station.run_until(120.0, |s| {
        highest = highest.min(s.place()[2]);
        has_text(s, "Disarmed by landing")
    }));
    assert!(highest > left[2].min(-8.0) - 4.0, "{left:?} up to {highest}");
    assert!((home_north(&station) - home).abs() < 2.0, "{:?}", station.place());
}

#[test]
fn wire_common_items_are_accepted_and_missions_move_the_gimbal() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    let plain = MavFrame::MAV_FRAME_MISSION;
    let order = |seq, command, param1| MISSION_ITEM_INT_DATA { x: 0, y: 0, param1, frame: plain, ..item(seq, command, 0.0, 0.0) };
    let plan = [
        order(0, MavCmd::MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET, 0.0),
        item(1, MavCmd::MAV_CMD_CONDITION_GATE, north + 6.0, 8.0),
        MISSION_ITEM_INT_DATA { param1: 1.0, ..item(2, MavCmd::MAV_CMD_NAV_LOITER_TO_ALT, north + 6.0, 11.0) },
        order(3, MavCmd::MAV_CMD_DO_SET_ROI_NONE, 0.0),
        MISSION_ITEM_INT_DATA { param3: NAN, ..order(4, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, -40.0) },
        order(5, MavCmd::MAV_CMD_NAV_DELAY, 5.0),
    ];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    let mine = [-2.0, -2.0, -1.0, -1.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, mine), OK);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), OK);
    assert!(station.run_until(60.0, |s| has_text(s, "Mission finished")), "{:?}", station.place());
    assert!(!has_text(&station, "Mission item 4:"));
    let q =
        station.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(g.q) } else { None }).unwrap();
    let pitch = (2.0 * q[2].atan2(q[0])).to_degrees();
    assert!((pitch + 40.0).abs() < 1.0, "{pitch}");
    let spline = [item(0, MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT, north, 8.0)];
    let grip = [order(0, MavCmd::MAV_CMD_DO_GRIPPER, 1.0)];
    for wrong in [&spline, &grip] {
        assert_eq!(upload(&mut station, wrong), MavMissionResult::MAV_MISSION_UNSUPPORTED);
    }
}

#[test]
fn wire_region_of_interest_at_zero_clears_it() {
    let mut station = Station::airborne("drill-hover", 7);
    let aim = [0.0, 0.0, 0.0, 0.0, 46.71, 8.38, 0.0];
    let pitch = |s: &mut Station| {
        s.run_ms(3_000);
        let q = s.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(g.q) } else { None }).unwrap();
        (2.0 * q[2].atan2(q[0])).to_degrees()
    };
    for command in [MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, MavCmd::MAV_CMD_DO_SET_ROI] {
        assert_eq!(station.command(1, command, aim), OK);
        assert!(pitch(&mut station) < -10.0);
        assert_eq!(station.command(1, command, [0.0; 7]), OK);
        assert!(pitch(&mut station).abs() < 0.5, "{command:?}");
    }
}
