//! Missions and fences in the ArduCopter interface: item 0 is home, and the fence is active only if its parameter
//! enables it.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter::{ARM, AUTO, BRAKE, GUIDED, METERS_PER_E7_DEGREE, PAD, SET_MODE, copter, copter_at, mode, next_heartbeat};
use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::upload;
use spandrel_testkit::station::{Station, one};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;

pub(super) fn item(seq: u16, command: MavCmd, north_m: f64, z: f32) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA {
        seq,
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        x: PAD.0 + (north_m / METERS_PER_E7_DEGREE) as i32,
        y: PAD.1,
        z,
        target_system: 1,
        target_component: 1,
        autocontinue: 1,
        ..Default::default()
    }
}

fn counted(station: &mut Station) -> u16 {
    let list = MISSION_REQUEST_LIST_DATA { target_system: 1, target_component: 1, ..Default::default() };
    station
        .ask(&MavMessage::MISSION_REQUEST_LIST(list), |m| if let MavMessage::MISSION_COUNT(c) = m { Some(c.count) } else { None })
        .unwrap()
}

fn current(station: &mut Station) -> (u16, u16) {
    station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(42.0));
    station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some((c.seq, c.total)) } else { None }).unwrap()
}

#[test]
fn flight_fence_takes_effect_only_if_enabled() {
    let mut station = copter_at(5.0);
    let circle = MISSION_ITEM_INT_DATA {
        param1: 30.0,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    assert_eq!(upload(&mut station, &[circle]), MavMissionResult::MAV_MISSION_ACCEPTED);
    let north = PAD.0 + (60.0 / METERS_PER_E7_DEGREE) as i32;
    let there = [-1.0, 1.0, 0.0, f32::NAN, (f64::from(north) * 1e-7) as f32, (f64::from(PAD.1) * 1e-7) as f32, 470.0];
    for (enabled, result) in [(1.0, FAILED), (0.0, ACCEPTED)] {
        station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
            target_system: 1,
            target_component: 1,
            param_id: "FENCE_ENABLE".into(),
            param_value: enabled,
            param_type: MavParamType::MAV_PARAM_TYPE_INT8,
        }));
        assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_REPOSITION, there), result, "enabled {enabled}");
    }
}

/// After a fence has stopped the vehicle, setpoints outside the fence must be ignored even if they keep arriving.
#[test]
fn flight_fence_breach_ends_guided_flight() {
    let mut station = copter_at(5.0);
    let circle = MISSION_ITEM_INT_DATA {
        param1: 15.0,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    assert_eq!(upload(&mut station, &[circle]), MavMissionResult::MAV_MISSION_ACCEPTED);
    let north = MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system: 1,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(0x0DC7),
        vx: 2.0,
        ..Default::default()
    });
    station.received.clear();
    for _ in 0..150 {
        station.send(&north);
        station.run_ms(100);
    }
    assert!(station.has_text("Geofence breached: out of bounds, holding"), "{:?}", station.texts());
    assert_eq!(next_heartbeat(&mut station).custom_mode, BRAKE as u32);
    let [away, ..] = station.local_position_after(100);
    assert!((13.0..20.0).contains(&away), "{away} m north of the pad");
}

#[test]
#[expect(clippy::too_many_lines, reason = "one complete flight")]
fn wire_mission_item_0_is_home() {
    let mut station = copter();
    let accepted = MavMissionResult::MAV_MISSION_ACCEPTED;
    let place = MavCmd::MAV_CMD_NAV_WAYPOINT;
    assert_eq!(counted(&mut station), 0);
    assert_eq!(current(&mut station), (0, 0));
    // Item 0 must be accepted whatever it contains, even an unreachable position.
    let home = MISSION_ITEM_INT_DATA { x: 1_900_000_000, z: 1e9, ..item(0, place, 0.0, 0.0) };
    let jump = MISSION_ITEM_INT_DATA { param1: 1.0, param2: 1.0, ..item(3, MavCmd::MAV_CMD_DO_JUMP, 0.0, 0.0) };
    let items = [home.clone(), item(1, place, 10.0, 5.0), item(2, place, 20.0, 5.0), jump];
    assert_eq!(upload(&mut station, &items), accepted);
    assert_eq!(counted(&mut station), 4);
    assert_eq!(current(&mut station), (1, 3));
    let fetch = |station: &mut Station, seq| {
        let request = MISSION_REQUEST_INT_DATA { seq, target_system: 1, target_component: 1, ..Default::default() };
        station.ask(&MavMessage::MISSION_REQUEST_INT(request), |m| match m {
            MavMessage::MISSION_ITEM_INT(item) => Some(item.clone()),
            _ => None,
        })
    };
    let first = fetch(&mut station, 0).unwrap();
    assert!((first.x - PAD.0).abs() < 500 && (first.y - PAD.1).abs() < 500, "item 0 must be home: {first:?}");
    assert_eq!(first.frame, MavFrame::MAV_FRAME_GLOBAL);
    for sent in &items[1..] {
        let back = fetch(&mut station, sent.seq).unwrap();
        assert_eq!((back.seq, back.command, back.x, back.z, back.param1), (sent.seq, sent.command, sent.x, sent.z, sent.param1));
    }
    assert!(fetch(&mut station, 4).is_none());
    let older = MISSION_REQUEST_DATA { seq: 2, target_system: 1, target_component: 1, ..Default::default() };
    let degrees =
        station.ask(&MavMessage::MISSION_REQUEST(older), |m| if let MavMessage::MISSION_ITEM(i) = m { Some(i.x) } else { None });
    assert!((f64::from(degrees.unwrap()) - f64::from(items[2].x) * 1e-7).abs() < 1e-5);
    let answer = |m: &MavMessage| match m {
        MavMessage::MISSION_REQUEST(r) => Some(Ok(r.seq)),
        MavMessage::MISSION_ACK(ack) => Some(Err(ack.mavtype)),
        _ => None,
    };
    let again = MavMessage::MISSION_ITEM_INT(items[3].clone());
    assert_eq!(station.ask(&again, answer), Some(Err(accepted)), "a repeated final item must be acknowledged again");
    let part = |start_index, end_index| {
        MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA {
            start_index,
            end_index,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    assert_eq!(station.ask(&part(2, 2), answer), Some(Ok(2)));
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(item(2, place, 30.0, 6.0)), answer), Some(Err(accepted)));
    assert_eq!(station.ask(&part(0, 1), answer), Some(Ok(0)), "replacing item 0 must be accepted, without effect");
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(items[0].clone()), answer), Some(Ok(1)));
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(item(1, place, 12.0, 7.0)), answer), Some(Err(accepted)));
    let heights: Vec<f32> = (1..=3).map(|seq| fetch(&mut station, seq).unwrap().z).collect();
    assert_eq!((counted(&mut station), heights), (4, vec![7.0, 6.0, 0.0]));
    assert_eq!(station.ask(&part(3, 4), answer), Some(Err(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE)));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one(2.0)), ACCEPTED);
    assert_eq!(current(&mut station), (2, 3));
    assert_ne!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one(4.0)), ACCEPTED);
    assert_eq!(upload(&mut station, &[home]), accepted, "a plan that contains only home must clear the mission");
    assert_eq!(counted(&mut station), 0);
    let fence = MISSION_COUNT_DATA {
        count: 1,
        target_system: 1,
        target_component: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..Default::default()
    };
    let asked = station.ask(&MavMessage::MISSION_COUNT(fence), |m| match m {
        MavMessage::MISSION_REQUEST(r) => Some((r.seq, r.mission_type)),
        _ => None,
    });
    assert_eq!(asked, Some((0, MavMissionType::MAV_MISSION_TYPE_FENCE)));
}

#[test]
fn flight_mission_uses_copters_item_numbers() {
    let mut station = copter();
    let place = MavCmd::MAV_CMD_NAV_WAYPOINT;
    let jump = MISSION_ITEM_INT_DATA { param1: 2.0, param2: 1.0, ..item(4, MavCmd::MAV_CMD_DO_JUMP, 0.0, 0.0) };
    let items = [
        item(0, place, 0.0, 0.0),
        item(1, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 5.0),
        item(2, place, 10.0, 5.0),
        item(3, place, 20.0, 5.0),
        jump,
        item(5, MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0),
    ];
    assert_eq!(upload(&mut station, &items), MavMissionResult::MAV_MISSION_ACCEPTED);
    assert_eq!(station.command(1, SET_MODE, mode(AUTO)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED, "AUTO must not be armable");
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, one(0.0)), ACCEPTED);
    station.received.clear();
    let mut reached = Vec::new();
    let landed = station.run_until(240.0, |s| {
        reached.extend(s.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None }));
        let armed = s.received.iter().filter_map(|f| f.message.as_ref()).find_map(|m| match m {
            MavMessage::HEARTBEAT(b) if b.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(b.base_mode),
            _ => None,
        });
        s.received.clear();
        armed.is_some_and(|mode| !mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED))
    });
    assert!(landed, "{reached:?}");
    assert_eq!(reached, [1, 2, 3, 4, 2, 3, 4, 5]);
}
