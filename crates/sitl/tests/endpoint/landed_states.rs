//! EXTENDED_SYS_STATE.landed_state: both autopilots report TAKEOFF until the takeoff height is reached.

use super::copter::{ARM, GUIDED, SET_MODE, copter, mode};
use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{home_north, item, ready, upload};
use spandrel_testkit::station::{Station, one, p};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
/// Height above the ground, m, well above the liftoff detection height.
const CLEAR_HEIGHT_M: f64 = 1.5;
/// Takeoff height in these tests, m above home, and distance within which it counts as reached (the autopilot's 0.4 m
/// and the error of the estimate).
const TAKEOFF_HEIGHT_M: f32 = 8.0;
const HEIGHT_TOLERANCE_M: f64 = 1.0;

const GLOBAL_POSITION_INT: u32 = 33;

/// Returns the sequence of landed states, each with the height above home at which it was first reported, m.
fn states(station: &mut Station, limit_s: f64, last: MavLandedState) -> Vec<(MavLandedState, f64)> {
    let mut seen: Vec<(MavLandedState, f64)> = Vec::new();
    let done = station.run_until(limit_s, |s| {
        let up = s.last_message(|m| {
            if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(f64::from(g.relative_alt) * 1e-3) } else { None }
        });
        for state in s.all(|m| if let MavMessage::EXTENDED_SYS_STATE(e) = m { Some(e.landed_state) } else { None }) {
            if seen.last().is_none_or(|(before, _)| *before != state) {
                seen.push((state, up.unwrap_or_default()));
            }
        }
        s.received.retain(|frame| frame.message_id == GLOBAL_POSITION_INT);
        seen.last().is_some_and(|(state, _)| *state == last)
    });
    assert!(done, "{seen:?}");
    seen
}

/// Checks the sequence ON_GROUND, then TAKEOFF until the height is reached, then IN_AIR.
fn assert_take_off_states(seen: &[(MavLandedState, f64)]) {
    use MavLandedState as L;
    let order: Vec<L> = seen.iter().map(|(state, _)| *state).filter(|state| *state != L::MAV_LANDED_STATE_ON_GROUND).collect();
    assert_eq!(order, [L::MAV_LANDED_STATE_TAKEOFF, L::MAV_LANDED_STATE_IN_AIR], "{seen:?}");
    let up = seen.last().map_or(0.0, |(_, up)| *up);
    assert!(
        up > CLEAR_HEIGHT_M && up > f64::from(TAKEOFF_HEIGHT_M) - HEIGHT_TOLERANCE_M,
        "IN_AIR was first reported at {up} m: {seen:?}"
    );
}

#[test]
fn regress_px4_landed_state_covers_takeoff_and_landing() {
    use MavLandedState as L;
    let mut station = ready(7);
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(33.0));
    let ground = station
        .last_message(|m| if let MavMessage::GLOBAL_POSITION_INT(g) = m { Some(g.alt as f32 * 1e-3) } else { None })
        .unwrap();
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let up = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, ground + TAKEOFF_HEIGHT_M];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, up), ACCEPTED);
    assert_take_off_states(&states(&mut station, 30.0, L::MAV_LANDED_STATE_IN_AIR));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 4.0, 6.0])), ACCEPTED);
    let down: Vec<L> = states(&mut station, 60.0, L::MAV_LANDED_STATE_ON_GROUND).iter().map(|(state, _)| *state).collect();
    assert_eq!(down, [L::MAV_LANDED_STATE_LANDING, L::MAV_LANDED_STATE_ON_GROUND]);
}

#[test]
fn regress_mission_and_copter_takeoffs_report_takeoff_until_their_height() {
    let mut mission = ready(7);
    let north = home_north(&mission);
    let plan = [
        item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, north, TAKEOFF_HEIGHT_M),
        item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 20.0, TAKEOFF_HEIGHT_M),
    ];
    assert_eq!(upload(&mut mission, &plan), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(mission.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(mission.command(1, MavCmd::MAV_CMD_MISSION_START, p(&[])), ACCEPTED);
    assert_take_off_states(&states(&mut mission, 30.0, MavLandedState::MAV_LANDED_STATE_IN_AIR));
    let mut station = copter();
    assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, p(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, TAKEOFF_HEIGHT_M])), ACCEPTED);
    assert_take_off_states(&states(&mut station, 30.0, MavLandedState::MAV_LANDED_STATE_IN_AIR));
}
