//! Individual mission items: delay, loiter, turn, conditions, commands to the autopilot, and partial plans.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{ACCEPTED, PLAN, home_north, item, ready, upload};
use spandrel_testkit::station::Station;

const NAN: f32 = f32::NAN;
/// Maximum circle radius error, m (same as in the orbit test).
const RADIUS_TOLERANCE_M: f32 = 0.6;
/// Maximum heading error at the end of a turn in a mission, degrees (3 in flight, plus the error of the estimate).
const HEADING_TOLERANCE_DEG: f32 = 6.0;

fn order(seq: u16, command: MavCmd, p: [f32; 4]) -> MISSION_ITEM_INT_DATA {
    let [param1, param2, param3, param4] = p;
    let frame = MavFrame::MAV_FRAME_MISSION;
    MISSION_ITEM_INT_DATA { param1, param2, param3, param4, x: 0, y: 0, frame, ..item(seq, command, 0.0, 0.0) }
}

fn numbered(items: Vec<MISSION_ITEM_INT_DATA>) -> Vec<MISSION_ITEM_INT_DATA> {
    (0u16..).zip(items).map(|(seq, item)| MISSION_ITEM_INT_DATA { seq, ..item }).collect()
}

fn start(station: &mut Station) -> MavResult {
    station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7])
}

fn reached(station: &Station) -> Vec<u16> {
    station.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None })
}

fn heading_deg(station: &Station) -> f32 {
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw.to_degrees()) } else { None }).unwrap()
}

#[test]
fn flight_initial_delay_on_the_ground_does_not_disarm() {
    let mut station = ready(7);
    let north = home_north(&station);
    let items = [
        order(0, MavCmd::MAV_CMD_NAV_DELAY, [15.0, 0.0, 0.0, 0.0]),
        item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, north, 6.0),
        item(2, MavCmd::MAV_CMD_NAV_WAYPOINT, north, 6.0),
    ];
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_ACCEPTED);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(14_500);
    assert!(
        -station.place()[2] < 1.0 && reached(&station).is_empty(),
        "the vehicle must wait on the ground: {:?}",
        station.place()
    );
    assert!(station.run_until(30.0, |s| reached(s).ends_with(&[2])), "{:?} at {:?}", reached(&station), station.place());
}

#[test]
fn flight_mission_circles_have_the_specified_turns_and_direction() {
    for (radius, clockwise) in [(8.0_f32, true), (-8.0, false)] {
        let mut station = Station::airborne("drill-hover", 7);
        let north = home_north(&station);
        let circle =
            MISSION_ITEM_INT_DATA { param1: 1.5, param3: radius, ..item(0, MavCmd::MAV_CMD_NAV_LOITER_TURNS, north, 8.0) };
        assert_eq!(upload(&mut station, &[circle]), ACCEPTED);
        assert_eq!(start(&mut station), MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(12_000);
        let mut turned = 0.0_f32;
        let mut before: Option<f32> = None;
        let done = station.run_until(120.0, |s| {
            let [n, e, _] = s.place();
            let (n, e) = (n - north as f32, e);
            if !s.has_text("Mission finished") {
                assert!((n.hypot(e) - 8.0).abs() < RADIUS_TOLERANCE_M, "{n} {e}");
                let angle = e.atan2(n).to_degrees();
                turned += before.map_or(0.0, |b| (angle - b + 540.0).rem_euclid(360.0) - 180.0);
                before = Some(angle);
            }
            s.has_text("Mission finished")
        });
        assert!(done && reached(&station) == [0], "{:?}", reached(&station));
        assert!((turned > 180.0) == clockwise && turned.abs() < 540.0, "{turned} degrees at {radius} m");
    }
}

#[test]
fn flight_conditions_apply_between_waypoints_and_speed_is_restored() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    let items = numbered(vec![
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north, 8.0),
        order(0, MavCmd::MAV_CMD_CONDITION_YAW, [90.0, 0.0, 0.0, 0.0]),
        order(0, MavCmd::MAV_CMD_CONDITION_YAW, [30.0, 0.0, -1.0, 1.0]),
        order(0, MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, 2.0, -1.0, 0.0]),
        order(0, MavCmd::MAV_CMD_CONDITION_DISTANCE, [10.0, 0.0, 0.0, 0.0]),
        order(0, MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, -2.0, -1.0, 0.0]),
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 40.0, 8.0),
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north, 8.0),
    ]);
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(60.0, |s| reached(s).contains(&1)));
    assert!((heading_deg(&station) - 90.0).abs() < HEADING_TOLERANCE_DEG, "{}", heading_deg(&station));
    assert!(station.run_until(60.0, |s| reached(s).contains(&2)));
    assert!((heading_deg(&station) - 60.0).abs() < HEADING_TOLERANCE_DEG, "{}", heading_deg(&station));
    assert!(station.run_until(60.0, |s| home_north(s) > north + 20.0));
    assert!((station.speed() - 2.0).abs() < 0.3, "slowly: {}", station.speed());
    assert!(station.run_until(60.0, |s| reached(s).contains(&4)));
    let left = north + 40.0 - home_north(&station);
    assert!((left - 10.0).abs() < 1.0, "the condition must trigger ten meters before the waypoint: {left}");
    assert!(station.run_until(60.0, |s| reached(s).contains(&6) && home_north(s) < north + 20.0));
    assert!((station.speed() - 5.0).abs() < 0.5, "the speed must return to the parameter's value: {}", station.speed());
}

#[test]
fn flight_mission_can_set_home_and_switch_the_fence() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    let items = numbered(vec![
        item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 20.0, 8.0),
        order(0, MavCmd::MAV_CMD_DO_SET_HOME, [1.0, 0.0, 0.0, 0.0]),
        order(0, MavCmd::MAV_CMD_DO_FENCE_ENABLE, [0.0; 4]),
        item(0, MavCmd::MAV_CMD_NAV_DELAY, north, 0.0),
    ]);
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(60.0, |s| reached(s).contains(&2)));
    assert!(station.run_until(2.0, |s| s.has_text("Geofence disabled")));
    let request = [242.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, request);
    let home = station.last_message(|m| if let MavMessage::HOME_POSITION(h) = m { Some(h.x) } else { None }).unwrap();
    assert!((f64::from(home) - north - 20.0).abs() < 3.0, "home must be at the drone's position: {home}, drone at {north}");
}

#[test]
fn wire_items_out_of_range_are_rejected_with_the_faulty_parameter() {
    use MavMissionResult as R;
    let mut station = ready(7);
    let turns = |p1, p3| MISSION_ITEM_INT_DATA { param1: p1, param3: p3, ..item(0, MavCmd::MAV_CMD_NAV_LOITER_TURNS, 0.0, 5.0) };
    let terrain = MavFrame::MAV_FRAME_GLOBAL_TERRAIN_ALT;
    for (wrong, expected) in [
        (order(0, MavCmd::MAV_CMD_NAV_DELAY, [-1.0, 12.0, 0.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (order(0, MavCmd::MAV_CMD_CONDITION_YAW, [720.0, 0.0, 0.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (order(0, MavCmd::MAV_CMD_CONDITION_YAW, [NAN, 0.0, 0.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (order(0, MavCmd::MAV_CMD_CONDITION_YAW, [7.0, 0.0, 5.0, 0.0]), R::MAV_MISSION_INVALID_PARAM3),
        (order(0, MavCmd::MAV_CMD_CONDITION_YAW, [7.0, 0.0, 1.0, 2.0]), R::MAV_MISSION_INVALID_PARAM4),
        (order(0, MavCmd::MAV_CMD_DO_CHANGE_SPEED, [2.0, 3.0, -1.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (order(0, MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, -7.0, -1.0, 0.0]), R::MAV_MISSION_INVALID_PARAM2),
        (order(0, MavCmd::MAV_CMD_DO_FENCE_ENABLE, [5.0, 0.0, 0.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (order(0, MavCmd::MAV_CMD_DO_SET_HOME, [0.0, 0.0, 0.0, 0.0]), R::MAV_MISSION_UNSUPPORTED_FRAME),
        (order(0, MavCmd::MAV_CMD_DO_JUMP, [0.0, -1.0, 0.0, 0.0]), R::MAV_MISSION_INVALID_PARAM1),
        (turns(-1.0, 5.0), R::MAV_MISSION_INVALID_PARAM1),
        (turns(1.0, 0.2), R::MAV_MISSION_INVALID_PARAM3),
        (
            MISSION_ITEM_INT_DATA { frame: terrain, ..item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 5.0) },
            R::MAV_MISSION_UNSUPPORTED_FRAME,
        ),
        (
            MISSION_ITEM_INT_DATA {
                mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
                ..item(0, MavCmd::MAV_CMD_NAV_RALLY_POINT, 0.0, 5.0)
            },
            R::MAV_MISSION_UNSUPPORTED,
        ),
        (
            MISSION_ITEM_INT_DATA {
                mission_type: MavMissionType::MAV_MISSION_TYPE_RALLY,
                param1: 9.0,
                ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 5.0)
            },
            R::MAV_MISSION_UNSUPPORTED,
        ),
    ] {
        assert_eq!(upload(&mut station, std::slice::from_ref(&wrong)), expected, "{wrong:?}");
    }
}

fn asked(m: &MavMessage) -> Option<u16> {
    if let MavMessage::MISSION_REQUEST_INT(r) = m { Some(r.seq) } else { None }
}

fn result(m: &MavMessage) -> Option<MavMissionResult> {
    if let MavMessage::MISSION_ACK(a) = m { Some(a.mavtype) } else { None }
}

fn part(start_index: i16, end_index: i16) -> MavMessage {
    MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA {
        start_index,
        end_index,
        target_system: 1,
        target_component: 1,
        mission_type: PLAN,
    })
}

fn heights(station: &mut Station) -> Vec<f32> {
    let height = |m: &MavMessage| if let MavMessage::MISSION_ITEM_INT(i) = m { Some(i.z) } else { None };
    let get = |seq| MISSION_REQUEST_INT_DATA { seq, target_system: 1, target_component: 1, mission_type: PLAN };
    (0..).map_while(|seq| station.ask(&MavMessage::MISSION_REQUEST_INT(get(seq)), height)).collect()
}

#[test]
fn wire_partial_upload_replaces_only_its_items() {
    let mut station = ready(7);
    let plan: Vec<_> = (0..5).map(|k| item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0, 6.0)).collect();
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    let refused = Some(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE);
    for (first, last) in [(3, 2), (-1, 2), (2, 5), (9, 9)] {
        assert_eq!(station.ask(&part(first, last), result), refused, "{first} to {last}");
    }
    assert_eq!(station.ask(&part(2, 3), asked), Some(2));
    let higher = |seq| MavMessage::MISSION_ITEM_INT(item(seq, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0, 9.0));
    assert_eq!(station.ask(&higher(2), asked), Some(3));
    assert_eq!(heights(&mut station), [6.0; 5], "the old plan must stay active until the new one is complete");
    assert_eq!(station.ask(&higher(3), result), Some(ACCEPTED));
    assert_eq!(station.ask(&higher(3), result), Some(ACCEPTED), "a repeated final item must be acknowledged again");
    assert_eq!(heights(&mut station), [6.0, 6.0, 9.0, 9.0, 6.0]);
    // A partial upload that makes the mission endless must be rejected without effect.
    assert_eq!(station.ask(&part(0, 0), asked), Some(0));
    let jump = MavMessage::MISSION_ITEM_INT(order(0, MavCmd::MAV_CMD_DO_JUMP, [0.0, -1.0, 0.0, 0.0]));
    assert_eq!(station.ask(&jump, result), Some(MavMissionResult::MAV_MISSION_INVALID_PARAM1));
    assert_eq!(heights(&mut station), [6.0, 6.0, 9.0, 9.0, 6.0]);
}

/// MAVSDK sends NaN for unused parameters.
#[test]
fn wire_nan_is_accepted_for_unused_item_parameters() {
    let mut station = ready(7);
    let silent = |command| MISSION_ITEM_INT_DATA { param1: NAN, param2: NAN, param3: NAN, ..item(0, command, 0.0, 5.0) };
    for command in [MavCmd::MAV_CMD_NAV_TAKEOFF, MavCmd::MAV_CMD_NAV_WAYPOINT, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH] {
        assert_eq!(upload(&mut station, &[silent(command)]), ACCEPTED, "{command:?}");
    }
}
