//! Commands and settings must not outlast their flight, mission, or controlling client.

use super::copter::{AUTO, copter_at};
use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{ACCEPTED, home_north, item, ready, upload};
use spandrel_testkit::station::{Station, one, p};

const OK: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const NAN: f32 = f32::NAN;
const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
/// Distance within which a Copter's waypoint counts as reached, m (WPNAV_RADIUS, and deceleration).
const WAYPOINT_TOLERANCE_M: f64 = 2.5;

/// Takes off, flies some distance at the usual speed, and lands; returns the maximum speed in m/s.
fn max_flight_speed_m_s(station: &mut Station, slow: Option<f32>) -> f32 {
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 4.0, 2.0])), OK);
    assert_eq!(station.command(1, ARM, one(1.0)), OK);
    station.run_ms(8_000);
    if let Some(slow) = slow {
        assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_CHANGE_SPEED, p(&[1.0, slow, -1.0])), OK);
        let aside = item(0, MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, 0.0, 0.0);
        let look = COMMAND_INT_DATA {
            command: aside.command,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            x: aside.x + 40_000,
            y: aside.y + 60_000,
            z: 0.0,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        };
        station.send(&MavMessage::COMMAND_INT(look));
    }
    station.run_ms(100);
    let north = home_north(station);
    let mut fastest = 0.0f32;
    for there in [north + 30.0, north] {
        let aim = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, there, 0.0);
        let go = COMMAND_INT_DATA {
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            param1: -1.0,
            param2: 1.0,
            param4: NAN,
            x: aim.x,
            y: aim.y,
            z: 6.0,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        };
        station.send(&MavMessage::COMMAND_INT(go));
        assert!(station.run_until(60.0, |s| {
            fastest = fastest.max(s.speed());
            (s.place()[0] - there as f32).abs() < 1.0
        }));
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, p(&[])), OK);
    assert!(station.run_until(60.0, |s| s.has_text("Disarmed by landing")), "{:?}", station.place());
    fastest
}

fn heading_deg(station: &Station) -> f32 {
    station.last_message(|m| if let MavMessage::ATTITUDE(a) = m { Some(a.yaw.to_degrees()) } else { None }).unwrap()
}

/// One flight's speed and region of interest must not affect the next flight.
#[test]
fn flight_speed_and_region_of_interest_are_reset_after_the_flight() {
    let mut station = ready(7);
    let slow = max_flight_speed_m_s(&mut station, Some(1.5));
    assert!((1.2..2.0).contains(&slow), "{slow}");
    let looked = heading_deg(&station);
    let usual = max_flight_speed_m_s(&mut station, None);
    assert!(usual > 3.0, "{usual}");
    let ahead = heading_deg(&station);
    assert!((ahead - looked).abs() > 20.0, "{ahead} after {looked}: the region of interest must be cleared");
}

fn reached(station: &Station) -> Vec<u16> {
    station.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None })
}

/// Completed jumps must keep their count when another item becomes current, until a reset is requested (parameter 2),
/// as MAVLink specifies.
#[test]
fn flight_jump_counts_persist_until_a_mission_reset() {
    for (reset, then) in [(0.0, vec![0, 1, 2, 3]), (1.0, vec![0, 1, 2, 0, 1, 2, 3])] {
        let mut station = Station::airborne("drill-hover", 7);
        let north = home_north(&station);
        let jump = MISSION_ITEM_INT_DATA {
            param1: 0.0,
            param2: 1.0,
            frame: MavFrame::MAV_FRAME_MISSION,
            ..item(2, MavCmd::MAV_CMD_DO_JUMP, 0.0, 0.0)
        };
        let way = |seq, meters| item(seq, MavCmd::MAV_CMD_NAV_WAYPOINT, north + meters, 8.0);
        assert_eq!(upload(&mut station, &[way(0, 5.0), way(1, 10.0), jump, way(3, 7.0)]), ACCEPTED);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, p(&[])), OK);
        assert!(station.run_until(60.0, |s| reached(s) == [0, 1, 2]), "{:?}", reached(&station));
        assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, p(&[0.0, reset])), OK);
        assert!(station.run_until(120.0, |s| s.has_text("Mission finished")), "{:?}", station.place());
        assert_eq!(reached(&station), then, "reset {reset}");
    }
}

/// Copter's spline items are flown as waypoints; PX4 does not have them.
#[test]
fn flight_copter_spline_is_flown_as_a_waypoint() {
    let mut station = copter_at(5.0);
    let north = home_north(&station);
    let spline = |seq, meters| item(seq, MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT, north + meters, 6.0);
    let home = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, north, 0.0);
    assert_eq!(upload(&mut station, &[home, spline(1, 8.0), spline(2, 14.0)]), ACCEPTED);
    station.received.clear();
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, AUTO])), OK);
    assert!(station.run_until(60.0, |s| reached(s) == [1, 2]), "{:?}", reached(&station));
    assert!((f64::from(station.place()[0]) - north - 14.0).abs() < WAYPOINT_TOLERANCE_M, "{:?}", station.place());
}

/// The controlling client must keep gimbal control, but any client may clear the vehicle's region of interest.
#[test]
fn flight_clearing_the_region_of_interest_keeps_gimbal_control() {
    let mut station = Station::airborne("drill-hover", 7);
    let place = |station: &mut Station, command| {
        let there = item(0, command, 60.0, 0.0);
        let look = COMMAND_INT_DATA {
            command,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            x: there.x,
            y: there.y + 6_000,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        };
        station.ask(&MavMessage::COMMAND_INT(look), |m| if let MavMessage::COMMAND_ACK(a) = m { Some(a.result) } else { None })
    };
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 4.0, 3.0])), OK);
    assert_eq!(place(&mut station, MavCmd::MAV_CMD_DO_SET_ROI_LOCATION), Some(OK));
    station.run_ms(5_000);
    let (looked, aimed) = (heading_deg(&station), station.gimbal_deg());
    assert!(looked.abs() > 10.0 && aimed < -1.0, "{looked} {aimed}");
    let other = p(&[42.0, 17.0]);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, other), OK);
    assert_eq!(place(&mut station, MavCmd::MAV_CMD_DO_SET_ROI_LOCATION), Some(MavResult::MAV_RESULT_DENIED));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_ROI_NONE, p(&[])), OK);
    station.run_ms(20);
    assert!(station.has_text("ROI cleared"), "{:?}", station.texts());
    // The vehicle must turn freely again: it turns south, although the region of interest is elsewhere.
    assert_eq!(station.command(1, MavCmd::MAV_CMD_CONDITION_YAW, p(&[180.0, 30.0, 1.0])), OK);
    station.run_ms(9_000);
    assert!((heading_deg(&station).abs() - 180.0).abs() < 6.0, "{}", heading_deg(&station));
    assert!((station.gimbal_deg() - aimed).abs() < 3.0, "{} after {aimed}", station.gimbal_deg());
}

/// After the motors stop in flight, the vehicle falls and respawns; its next landing must then end the flight as usual.
#[test]
fn flight_respawned_vehicle_can_land_and_disarm() {
    let mut station = Station::airborne("drill-hover", 7);
    // Flies away from the pad, where contact with the ground is a crash.
    for _ in 0..200 {
        station.sticks(800, 0, 500, 0);
        station.run_ms(20);
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_FLIGHTTERMINATION, one(1.0)), OK);
    assert!(station.run_until(30.0, |s| s.has_text("Respawned at last safe hover")));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, p(&[])), OK);
    assert!(station.run_until(60.0, |s| s.has_text("Disarmed")), "{:?}", station.place());
    assert!(station.has_text("Disarmed by landing"), "{:?}", station.texts());
}
