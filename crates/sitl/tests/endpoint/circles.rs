//! Orbits, regions of interest, and a reboot.

use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{ACCEPTED, home_north, item, ready, upload};
use spandrel_testkit::station::Station;

/// Maximum orbit radius error in the vehicle's own estimate, m.
const RADIUS_TOLERANCE_M: f64 = 0.6;
/// Maximum heading error, rad.
const YAW_TOLERANCE: f32 = 0.2;
const NAN: f32 = f32::NAN;

fn yaw(station: &Station) -> f32 {
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw) } else { None }).unwrap()
}

fn angle_between(a: f32, b: f32) -> f32 {
    let d = (a - b).rem_euclid(std::f32::consts::TAU);
    d.min(std::f32::consts::TAU - d)
}

#[test]
fn flight_orbit_keeps_radius_and_speed_and_faces_the_center() {
    let mut station = Station::airborne("drill-hover", 7);
    station.sticks(0, 0, 500, 0);
    let center = station.place();
    let orbit = [-8.0, 2.0, 0.0, 0.0, NAN, NAN, NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_ORBIT, orbit), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(12_000);
    assert_eq!(station.mode(), Some(1 << 24 | 3 << 16));
    let status = station.last_message(|m| if let MavMessage::ORBIT_EXECUTION_STATUS(o) = m { Some(o.radius) } else { None });
    assert_eq!(status, Some(-8.0));
    let mut turned = 0.0f32;
    let mut before: Option<f32> = None;
    for _ in 0..120 {
        station.run_ms(100);
        let p = station.place();
        let (n, e) = (p[0] - center[0], p[1] - center[1]);
        let radius = f64::from(n.hypot(e));
        assert!((radius - 8.0).abs() < RADIUS_TOLERANCE_M, "{radius}");
        assert!(angle_between(yaw(&station), (-e).atan2(-n)) < YAW_TOLERANCE, "{} at {p:?}", yaw(&station));
        let bearing = e.atan2(n);
        turned += before
            .map_or(0.0, |b| (bearing - b + 3.0 * std::f32::consts::PI).rem_euclid(std::f32::consts::TAU) - std::f32::consts::PI);
        before = Some(bearing);
    }
    // A counterclockwise arc: twelve seconds at 2 m/s, with a radius of 8 m.
    assert!((turned + 11.9 * 2.0 / 8.0).abs() < 0.3, "{turned} rad");
    let too_wide = [5_000.0, 2.0, 0.0, 0.0, NAN, NAN, NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_ORBIT, too_wide), MavResult::MAV_RESULT_DENIED);
}

#[test]
fn flight_half_orbit_ends_in_hold() {
    let mut station = Station::airborne("drill-hover", 7);
    let orbit = [5.0, 2.0, 0.0, std::f32::consts::PI, NAN, NAN, NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_ORBIT, orbit), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(40.0, |s| s.mode() == Some(3 << 24 | 4 << 16)), "{:?}", station.place());
}

#[test]
fn flight_mission_heading_follows_the_region_of_interest_until_cleared() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let mut aim = item(1, MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, home + 20.0, 2.0);
    aim.y += 3_000;
    let plan = [
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 2.0, 8.0),
        aim.clone(),
        item(2, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 40.0, 8.0),
        item(3, MavCmd::MAV_CMD_DO_SET_ROI_NONE, home, 0.0),
        item(4, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 20.0, 8.0),
    ];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(60.0, |s| home_north(s) > home + 25.0));
    // Position of the region of interest, m; a degree of longitude is shorter than a degree of latitude.
    let east = 3_000.0 * 1e-7 * 40_000_000.0 / 360.0 * 46.7f32.to_radians().cos();
    let p = station.place();
    let wanted = (east - p[1]).atan2(home as f32 + 20.0 - p[0]);
    assert!(angle_between(yaw(&station), wanted) < 2.0 * YAW_TOLERANCE, "{} instead of {wanted} at {p:?}", yaw(&station));
    assert!(station.run_until(60.0, |s| s.mode() == Some(3 << 24 | 4 << 16)));
    assert!(
        angle_between(yaw(&station), std::f32::consts::PI) < 2.0 * YAW_TOLERANCE,
        "the nose must point south along the path again: {}",
        yaw(&station)
    );
}

#[test]
fn wire_reboot_keeps_parameters_and_plans_and_is_rejected_in_flight() {
    let mut station = ready(7);
    let home = home_north(&station);
    assert_eq!(upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 5.0, 6.0)]), ACCEPTED);
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: 7.0,
        target_system: 1,
        target_component: 1,
        param_id: "MIS_TAKEOFF_ALT".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }));
    station.run_ms(10);
    let reboot = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, reboot), MavResult::MAV_RESULT_ACCEPTED);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(
        station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm),
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
        "the heartbeat must report booting"
    );
    station.run_ms(2_500);
    let asked = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: "MIS_TAKEOFF_ALT".into(),
    });
    let height = station.ask(&asked, |m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.param_value) } else { None });
    assert_eq!(height, Some(7.0));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    let take_off = [0.0, 0.0, 0.0, NAN, NAN, NAN, NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, take_off), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(50);
    let base = station.place()[2];
    assert!(station.run_until(30.0, |s| base - s.place()[2] > 6.0), "the height parameter must be preserved");
    assert_eq!(station.command(1, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, reboot), MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
    assert_eq!(
        station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]),
        MavResult::MAV_RESULT_ACCEPTED,
        "the plan must be preserved"
    );
}

#[test]
fn flight_yaw_command_does_not_interrupt_the_mission() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let plan = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 60.0, 8.0)];
    let turn = [90.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    station.sticks(0, 0, 500, 0);
    assert_eq!(
        station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, turn),
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
        "manual flight must reject the command"
    );
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(3_000);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, turn), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(5_000);
    assert_eq!(station.mode(), Some(4 << 24 | 4 << 16));
    assert!(angle_between(yaw(&station), std::f32::consts::FRAC_PI_2) < YAW_TOLERANCE, "{}", yaw(&station));
}

/// Sets a home position relative to home; its height is relative to the current home.
#[test]
fn wire_set_home_accepts_relative_heights_and_rejects_other_frames() {
    let mut station = ready(7);
    let home_mm = |s: &mut Station| {
        s.run_ms(2_100);
        s.last_message(|m| if let MavMessage::HOME_POSITION(h) = m { Some(h.altitude) } else { None }).unwrap()
    };
    let before = home_mm(&mut station);
    let there = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0);
    let set = |s: &mut Station, frame: MavFrame, z: f32| {
        s.received.clear();
        s.send(&MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            command: MavCmd::MAV_CMD_DO_SET_HOME,
            frame,
            x: there.x,
            y: there.y,
            z,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        }));
        s.run_ms(5);
        s.last_message(|m| if let MavMessage::COMMAND_ACK(ack) = m { Some(ack.result) } else { None }).unwrap()
    };
    assert_eq!(set(&mut station, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT, 3.0), MavResult::MAV_RESULT_ACCEPTED);
    assert!((home_mm(&mut station) - before - 3_000).abs() < 50);
    assert_eq!(set(&mut station, MavFrame::MAV_FRAME_LOCAL_NED, 3.0), MavResult::MAV_RESULT_DENIED);
}

/// Returns the current orbit's center as COMMAND_INT encodes it.
fn orbit_center(station: &Station) -> (i32, i32, f32) {
    station.last_message(|m| if let MavMessage::ORBIT_EXECUTION_STATUS(o) = m { Some((o.x, o.y, o.z)) } else { None }).unwrap()
}

/// QGroundControl's orbit does not set a yaw behavior (5, unchanged). A PX4 vehicle that is not yet in an orbit then
/// turns its nose toward the center.
#[test]
fn regress_orbit_with_yaw_unchanged_keeps_the_current_yaw_behavior() {
    let mut station = Station::airborne("drill-hover", 7);
    station.sticks(0, 0, 500, 0);
    let center = station.place();
    let orbit = |yaw: f32| [8.0, 2.0, yaw, 0.0, NAN, NAN, NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_ORBIT, orbit(5.0)), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(15_000);
    let [n, e, _] = std::array::from_fn(|k| station.place()[k] - center[k]);
    assert!(angle_between(yaw(&station), (-e).atan2(-n)) < YAW_TOLERANCE, "{} at {n} {e}", yaw(&station));
    // An orbit around the same center with the nose along the circle (3), then with the yaw behavior unchanged.
    let (x, y, z) = orbit_center(&station);
    for behavior in [3.0, 5.0] {
        let orbit = COMMAND_INT_DATA {
            command: MavCmd::MAV_CMD_DO_ORBIT,
            frame: MavFrame::MAV_FRAME_GLOBAL,
            param1: 8.0,
            param2: 2.0,
            param3: behavior,
            x,
            y,
            z,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        };
        station.received.clear();
        station.send(&MavMessage::COMMAND_INT(orbit));
        // The status is streamed at 2 Hz.
        station.run_ms(1_000);
        let result = station.last_message(|m| if let MavMessage::COMMAND_ACK(ack) = m { Some(ack.result) } else { None });
        assert_eq!(result, Some(MavResult::MAV_RESULT_ACCEPTED));
        let radius = station.last_message(|m| if let MavMessage::ORBIT_EXECUTION_STATUS(o) = m { Some(o.radius) } else { None });
        assert_eq!(radius, Some(8.0));
    }
    station.run_ms(8_000);
    let [n, e, _] = std::array::from_fn(|k| station.place()[k] - center[k]);
    assert!(angle_between(yaw(&station), n.atan2(-e)) < YAW_TOLERANCE, "{} at {n} {e}", yaw(&station));
}
