//! Geofence actions, rally points, and missions interrupted by the pilot.

use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{ACCEPTED, home_north, item, ready, upload};
use spandrel_testkit::station::Station;

const FENCE: MavMissionType = MavMissionType::MAV_MISSION_TYPE_FENCE;
const RALLY: MavMissionType = MavMissionType::MAV_MISSION_TYPE_RALLY;
const HOLD: u32 = 3 << 24 | 4 << 16;
const MISSION: u32 = 4 << 24 | 4 << 16;
const RETURN: u32 = 5 << 24 | 4 << 16;
const POSITION: u32 = 3 << 16;

fn area(seq: u16, command: MavCmd, north_m: f64, param1: f32) -> MISSION_ITEM_INT_DATA {
    let frame = MavFrame::MAV_FRAME_GLOBAL;
    MISSION_ITEM_INT_DATA { param1, frame, mission_type: FENCE, ..item(seq, command, north_m, 0.0) }
}

fn circle(north_m: f64, radius_m: f32) -> Vec<MISSION_ITEM_INT_DATA> {
    vec![area(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, north_m, radius_m)]
}

fn set(station: &mut Station, name: &str, value: i32) {
    let bits = f32::from_bits(value.cast_unsigned());
    assert!(station.set(name, bits, MavParamType::MAV_PARAM_TYPE_INT32).is_some());
}

/// Sends stick input for a while at a ground station's rate.
fn fly(station: &mut Station, forward: i16, right: i16, z: i16, ms: i64) {
    for _ in 0..ms / 40 {
        station.sticks(forward, right, z, 0);
        station.run_ms(40);
    }
}

#[test]
fn wire_fence_breach_triggers_one_hold_and_the_pilot_can_return() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    assert_eq!(upload(&mut station, &circle(home, 15.0)), ACCEPTED);
    for _ in 0..100 {
        fly(&mut station, 1000, 0, 500, 120);
        if station.has_text("Geofence breached") {
            break;
        }
    }
    assert!(station.has_text("Geofence breached: out of bounds, holding"), "{:?}", station.texts());
    station.run_ms(4_000);
    assert_eq!(station.mode(), Some(HOLD));
    let status = station.last_message(|m| match m {
        MavMessage::FENCE_STATUS(f) => Some((f.breach_status, f.breach_count, f.breach_type)),
        _ => None,
    });
    assert_eq!(status, Some((1, 1, FenceBreach::FENCE_BREACH_BOUNDARY)));
    station.received.clear();
    for _ in 0..100 {
        fly(&mut station, -1000, 0, 500, 120);
        if station.has_text("Back inside geofence") {
            break;
        }
    }
    assert!(station.has_text("Pilot took over") && station.has_text("Back inside geofence"), "{:?}", station.texts());
    assert!(!station.has_text("breached"), "the same breach must be reported only once");
}

#[test]
fn wire_targets_outside_the_fence_are_rejected() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    assert_eq!(upload(&mut station, &circle(home, 15.0)), ACCEPTED);
    let plan = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 5.0, 6.0), item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 40.0, 6.0)];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_DENIED);
    assert!(station.has_text("Mission item 1 outside geofence"));
    let (lat, lon) = (f64::from(plan[1].x) * 1e-7, f64::from(plan[1].y) * 1e-7);
    let there = [-1.0, 1.0, 0.0, f32::NAN, lat as f32, lon as f32, f32::NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_REPOSITION, there), MavResult::MAV_RESULT_DENIED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_FENCE_ENABLE, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
}

/// The path must be rejected even though both of its ends are allowed.
#[test]
fn wire_paths_through_exclusion_areas_or_above_the_limit_are_rejected() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    assert_eq!(upload(&mut station, &[area(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, home + 30.0, 5.0)]), ACCEPTED);
    let plan = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 5.0, 6.0), item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 60.0, 6.0)];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    let start = |s: &mut Station| s.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_DENIED);
    assert!(station.has_text("Path to mission item 1 leaves geofence"), "{:?}", station.texts());
    let round = MISSION_ITEM_INT_DATA { param1: 1.0, param3: 26.0, ..item(0, MavCmd::MAV_CMD_NAV_LOITER_TURNS, home, 6.0) };
    assert_eq!(upload(&mut station, &[round]), ACCEPTED);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_DENIED);
    assert!(station.has_text("Mission item 0 outside geofence"), "{:?}", station.texts());
    station.set("GF_MAX_VER_DIST", 20.0, MavParamType::MAV_PARAM_TYPE_REAL32);
    assert_eq!(upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, home, 30.0)]), ACCEPTED);
    assert_eq!(start(&mut station), MavResult::MAV_RESULT_DENIED);
    let amsl = spandrel_testkit::shipped::scenario("drill-hover").origin.altitude_m as f32 + 50.0;
    let up = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, amsl];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, up), MavResult::MAV_RESULT_DENIED);
}

#[test]
fn wire_arming_outside_the_fence_is_rejected() {
    let mut station = ready(7);
    let home = home_north(&station);
    assert_eq!(upload(&mut station, &circle(home + 100.0, 20.0)), ACCEPTED);
    station.run_ms(100);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
    assert!(station.has_text("geofence"), "{:?}", station.texts());
}

#[test]
fn wire_inconsistent_fence_is_rejected_with_the_faulty_parameter() {
    use MavMissionResult as R;
    let mut station = ready(7);
    let corner = MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION;
    let corners = |says: f32, count: u16| (0..count).map(|k| area(k, corner, 20.0 * f64::from(k), says)).collect::<Vec<_>>();
    let mut mixed = corners(4.0, 4);
    mixed[2].command = MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION;
    for (items, expected) in [
        (corners(2.0, 2), R::MAV_MISSION_INVALID_PARAM1),
        (corners(4.0, 3), R::MAV_MISSION_INVALID_PARAM1),
        (mixed, R::MAV_MISSION_INVALID_PARAM1),
        (circle(0.0, -3.0), R::MAV_MISSION_INVALID_PARAM1),
        (vec![area(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 0.0)], R::MAV_MISSION_UNSUPPORTED),
        (corners(3.0, 3), ACCEPTED),
    ] {
        assert_eq!(upload(&mut station, &items), expected);
    }
}

#[test]
fn wire_return_uses_the_nearest_rally_point() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let rally =
        |seq, north| MISSION_ITEM_INT_DATA { mission_type: RALLY, ..item(seq, MavCmd::MAV_CMD_NAV_RALLY_POINT, north, 0.0) };
    assert_eq!(upload(&mut station, &[rally(0, home + 300.0), rally(1, home + 30.0)]), ACCEPTED);
    set(&mut station, "GF_ACTION", 3);
    assert_eq!(upload(&mut station, &circle(home, 20.0)), ACCEPTED);
    for _ in 0..100 {
        fly(&mut station, 1000, 0, 500, 120);
        if station.has_text("Geofence breached: out of bounds, returning") {
            break;
        }
    }
    station.run_ms(1_500);
    assert_eq!(station.mode(), Some(RETURN));
    assert!(station.run_until(120.0, |s| s.has_text("Rally point reached")), "{:?} {:?}", station.place(), station.texts());
    assert!((home_north(&station) - home - 30.0).abs() < 1.5, "{:?}", station.place());
}

/// The mission must continue from the point where the pilot took over. It must not start at the beginning of the item
/// or go directly to its end.
#[test]
fn wire_interrupted_mission_resumes_at_the_interruption_point() {
    let mut station = Station::airborne("drill-hover", 7);
    let home = home_north(&station);
    let plan = [item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 5.0, 8.0), item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, home + 60.0, 8.0)];
    assert_eq!(upload(&mut station, &plan), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(60.0, |s| home_north(s) > home + 30.0), "{:?}", station.place());
    fly(&mut station, 0, 0, 500, 80);
    assert_eq!(station.mode(), Some(MISSION), "centered sticks must not interrupt the mission");
    // The vehicle's estimated position at that time.
    let left = station.place();
    fly(&mut station, 0, 1000, 500, 3_000);
    fly(&mut station, 0, 0, 500, 2_000);
    assert!(station.has_text("Mission paused: pilot took over with sticks"), "{:?}", station.texts());
    assert_eq!(station.mode(), Some(POSITION));
    let state = station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some(c.mission_state) } else { None });
    assert_eq!(state, Some(MissionState::MISSION_STATE_PAUSED));
    let away = station.place();
    assert!((away[1] - left[1]).abs() > 5.0, "the pilot must have flown away: {left:?} to {away:?}");
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, [1.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    let mut nearest = f32::INFINITY;
    let mut furthest_before = f32::NEG_INFINITY;
    let ended = station.run_until(90.0, |s| {
        let p = s.place();
        let from_left = ((p[0] - left[0]).powi(2) + (p[1] - left[1]).powi(2)).sqrt();
        if !s.has_text("Mission resumed from interruption point") {
            furthest_before = furthest_before.max(p[0]);
        }
        nearest = nearest.min(from_left);
        s.has_text("Mission finished")
    });
    assert!(ended);
    assert!(station.has_text("Mission resumed from interruption point"));
    assert!(nearest < 1.5, "passed {nearest} m from the interruption point");
    assert!(
        furthest_before < away[0].max(left[0]) + 1.0,
        "the vehicle must return before it continues: {furthest_before}, interrupted at {left:?}"
    );
}
