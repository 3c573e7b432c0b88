//! Plans: full and partial uploads, downloads, and execution.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::*;
use spandrel_testkit::plans::{ACCEPTED, PLAN, asked, count, home_north, item, origin, ready, result, upload};
use spandrel_testkit::station::Station;

const NAN: f32 = f32::NAN;

#[test]
fn wire_mission_is_uploaded_downloaded_and_flown() {
    let mut station = ready(7);
    let north = home_north(&station);
    let items = [
        item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, north, 6.0),
        item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 12.0, 8.0),
        MISSION_ITEM_INT_DATA {
            param2: 0.0,
            param3: 1.0,
            frame: MavFrame::MAV_FRAME_MISSION,
            ..item(2, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, north, 0.0)
        },
        MISSION_ITEM_INT_DATA {
            param1: -40.0,
            param3: NAN,
            frame: MavFrame::MAV_FRAME_MISSION,
            ..item(3, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, north, 0.0)
        },
        item(4, MavCmd::MAV_CMD_NAV_WAYPOINT, north + 4.0, 8.0),
        item(5, MavCmd::MAV_CMD_NAV_LAND, north, 0.0),
    ];
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    for (seq, sent) in items.iter().enumerate() {
        let request = MISSION_REQUEST_INT_DATA { seq: seq as u16, target_system: 1, target_component: 1, ..Default::default() };
        let got = station.ask(&MavMessage::MISSION_REQUEST_INT(request), |m| match m {
            MavMessage::MISSION_ITEM_INT(item) => Some((item.seq, item.command, item.x, item.y, item.z.to_bits(), item.param1)),
            _ => None,
        });
        assert_eq!(got, Some((sent.seq, sent.command, sent.x, sent.y, sent.z.to_bits(), sent.param1)));
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    let mut furthest = north;
    let ended = station.run_until(90.0, |s| {
        furthest = furthest.max(home_north(s));
        s.received
            .iter()
            .any(|f| matches!(&f.message, Some(MavMessage::STATUSTEXT(t)) if t.text.to_str() == Ok("Disarmed by landing")))
    });
    assert!(ended, "no automatic landing and disarm, position {:?}", station.place());
    let reached = station.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None });
    assert_eq!(reached, [0, 1, 2, 3, 4, 5]);
    assert!((furthest - north - 12.0).abs() < 2.5, "the waypoint is 12 m to the north; distance flown: {}", furthest - north);
    assert!((home_north(&station) - north).abs() < 1.0, "the landing position must match the plan");
    let status = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command: MavCmd::MAV_CMD_REQUEST_MESSAGE,
        param1: 262.0,
        target_system: 1,
        target_component: 100,
        ..Default::default()
    });
    let taken = station.ask(&status, |m| if let MavMessage::CAMERA_CAPTURE_STATUS(c) = m { Some(c.image_count) } else { None });
    assert_eq!(taken, Some(1), "item 2 must take a picture");
    let pitch =
        station.last_message(|m| if let MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) = m { Some(2.0 * g.q[2]) } else { None });
    assert!(pitch.is_none_or(|p| p < -0.6), "item 3 must point the gimbal down: {pitch:?}");
}

#[test]
fn wire_upload_recovers_from_lost_duplicated_and_reordered_items() {
    let mut station = ready(7);
    let items: Vec<_> = (0..4).map(|k| item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0 * f64::from(k), 6.0)).collect();
    let send = |s: &mut Station, k: usize| {
        s.ask(&MavMessage::MISSION_ITEM_INT(items[k].clone()), |m| asked(m).map(Ok).or(result(m).map(Err)))
    };
    assert_eq!(station.ask(&count(4, PLAN), asked), Some(0));
    assert_eq!(station.ask(&count(4, PLAN), asked), Some(0), "a repeated count must repeat the request");
    assert_eq!(send(&mut station, 0), Some(Ok(1)));
    assert_eq!(send(&mut station, 0), None, "a duplicate must not cause another request");
    assert_eq!(send(&mut station, 2), None, "an out-of-order item must not be answered");
    // Without a response from the client, the vehicle must repeat its request.
    station.received.clear();
    station.run_ms(2_000);
    let asked_again = station.all(asked);
    assert!(asked_again.starts_with(&[1, 1, 1]), "{asked_again:?}");
    // Datagrams were reordered: the client may be waiting for an earlier item, but the missing one must stay requested.
    assert!(asked_again.iter().rev().take(2).any(|seq| *seq == 1), "{asked_again:?}");
    assert_eq!(send(&mut station, 1), Some(Ok(2)));
    assert_eq!(send(&mut station, 2), Some(Ok(3)));
    assert_eq!(send(&mut station, 3), Some(Err(ACCEPTED)));
    assert_eq!(send(&mut station, 3), Some(Err(ACCEPTED)), "a repeated final item must be acknowledged again");
    assert_eq!(send(&mut station, 1), None, "a delayed item must not cause an error after the acknowledgment");
    let stranger = MavMessage::MISSION_ITEM_INT(item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, 99.0, 6.0));
    assert_eq!(station.ask(&stranger, result), Some(MavMissionResult::MAV_MISSION_ERROR), "the upload must be complete");
    let list = MISSION_REQUEST_LIST_DATA { target_system: 1, target_component: 1, mission_type: PLAN };
    let counted = station.ask(&MavMessage::MISSION_REQUEST_LIST(list), |m| {
        if let MavMessage::MISSION_COUNT(c) = m { Some(c.count) } else { None }
    });
    assert_eq!(counted, Some(4));
}

#[test]
fn wire_stalled_upload_is_aborted_and_a_second_station_waits() {
    let mut station = ready(7);
    assert_eq!(station.ask(&count(2, PLAN), asked), Some(0));
    station.send_as(254, 190);
    assert_eq!(station.ask(&count(1, PLAN), result), Some(MavMissionResult::MAV_MISSION_DENIED));
    station.received.clear();
    station.run_ms(11_000);
    assert_eq!(station.last_message(result), Some(MavMissionResult::MAV_MISSION_OPERATION_CANCELLED));
    assert_eq!(station.ask(&count(1, PLAN), asked), Some(0), "the second station must be able to upload now");
}

#[test]
fn wire_clear_command_affects_only_its_plan_type() {
    let mut station = ready(7);
    let fence = MISSION_ITEM_INT_DATA {
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        param1: 40.0,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    assert_eq!(upload(&mut station, &[fence]), ACCEPTED);
    assert_eq!(upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 5.0)]), ACCEPTED);
    let clear = |mission_type| {
        MavMessage::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA { target_system: 1, target_component: 1, mission_type })
    };
    assert_eq!(station.ask(&clear(PLAN), result), Some(ACCEPTED));
    let mut counted = |mission_type| {
        let list = MISSION_REQUEST_LIST_DATA { target_system: 1, target_component: 1, mission_type };
        station.ask(&MavMessage::MISSION_REQUEST_LIST(list), |m| {
            if let MavMessage::MISSION_COUNT(c) = m { Some(c.count) } else { None }
        })
    };
    assert_eq!((counted(PLAN), counted(MavMissionType::MAV_MISSION_TYPE_FENCE)), (Some(0), Some(1)));
    assert_eq!(station.ask(&clear(MavMissionType::MAV_MISSION_TYPE_ALL), result), Some(ACCEPTED));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_DENIED);
}

#[test]
fn wire_unflyable_items_are_rejected_with_the_faulty_parameter() {
    use MavMissionResult as R;
    let mut station = ready(7);
    let waypoint = || item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 5.0);
    for (wrong, expected) in [
        (MISSION_ITEM_INT_DATA { x: 910_000_000, ..waypoint() }, R::MAV_MISSION_INVALID_PARAM5_X),
        (MISSION_ITEM_INT_DATA { x: 0, ..waypoint() }, R::MAV_MISSION_INVALID_PARAM6_Y),
        (MISSION_ITEM_INT_DATA { z: NAN, ..waypoint() }, R::MAV_MISSION_INVALID_PARAM7),
        (MISSION_ITEM_INT_DATA { param1: -5.0, ..waypoint() }, R::MAV_MISSION_INVALID_PARAM1),
        (MISSION_ITEM_INT_DATA { frame: MavFrame::MAV_FRAME_LOCAL_ENU, ..waypoint() }, R::MAV_MISSION_UNSUPPORTED_FRAME),
        (
            MISSION_ITEM_INT_DATA { z: f32::INFINITY, ..item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 0.0) },
            R::MAV_MISSION_INVALID_PARAM7,
        ),
        (
            MISSION_ITEM_INT_DATA { x: 910_000_000, ..item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 5.0) },
            R::MAV_MISSION_INVALID_PARAM5_X,
        ),
        (
            MISSION_ITEM_INT_DATA { y: 1_810_000_000, ..item(0, MavCmd::MAV_CMD_NAV_LAND, 0.0, 0.0) },
            R::MAV_MISSION_INVALID_PARAM6_Y,
        ),
        (MISSION_ITEM_INT_DATA { param1: 7.0, ..item(0, MavCmd::MAV_CMD_DO_JUMP, 0.0, 0.0) }, R::MAV_MISSION_INVALID_PARAM1),
        (item(0, MavCmd::MAV_CMD_DO_PARACHUTE, 0.0, 0.0), R::MAV_MISSION_UNSUPPORTED),
    ] {
        assert_eq!(upload(&mut station, std::slice::from_ref(&wrong)), expected, "{wrong:?}");
    }
    assert_eq!(station.ask(&count(60_000, PLAN), result), Some(R::MAV_MISSION_NO_SPACE));
}

#[test]
fn wire_current_item_can_be_set_by_message_and_command() {
    let mut station = ready(7);
    let items: Vec<_> = (0..3).map(|k| item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0, 6.0)).collect();
    upload(&mut station, &items);
    let set = |seq| MavMessage::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA { seq, target_system: 1, target_component: 1 });
    let current = |m: &MavMessage| if let MavMessage::MISSION_CURRENT(c) = m { Some((c.seq, c.total)) } else { None };
    assert_eq!(station.ask(&set(2), current), Some((2, 3)));
    assert_eq!(station.ask(&set(77), result), Some(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE));
    let one = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one), MavResult::MAV_RESULT_ACCEPTED);
    assert_eq!(
        station.last_message(current),
        Some((1, 3)),
        "the change must be reported with the response, not only with the stream"
    );
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, [9.0; 7]), MavResult::MAV_RESULT_DENIED);
}

#[test]
fn wire_relative_heights_follow_a_new_home() {
    let mut station = Station::airborne("drill-hover", 7);
    let north = home_north(&station);
    let amsl = MISSION_ITEM_INT_DATA {
        frame: MavFrame::MAV_FRAME_GLOBAL,
        ..item(
            1,
            MavCmd::MAV_CMD_NAV_LOITER_UNLIM,
            north,
            spandrel_testkit::shipped::scenario("drill-hover").origin.altitude_m as f32 + 7.0,
        )
    };
    upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_LOITER_UNLIM, north, 5.0), amsl]);
    let set_home = MavMessage::COMMAND_INT(COMMAND_INT_DATA {
        command: MavCmd::MAV_CMD_DO_SET_HOME,
        x: origin().0,
        y: origin().1,
        z: spandrel_testkit::shipped::scenario("drill-hover").origin.altitude_m as f32 + 6.0,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    let answer = station.ask(&set_home, |m| if let MavMessage::COMMAND_ACK(a) = m { Some(a.result) } else { None });
    assert_eq!(answer, Some(MavResult::MAV_RESULT_ACCEPTED));
    // Home is 6 m above the origin, so the first item is 11 m above the origin; the second is 7 m above it regardless
    // of home.
    for (seq, up) in [(0.0, 11.0), (1.0, 7.0)] {
        station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, [seq, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [-1.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(10_000);
        assert!((-station.place()[2] - up).abs() < 0.4, "item {seq}: height {} m instead of {up} m", -station.place()[2]);
    }
}

#[test]
fn wire_superseded_and_partial_requests_are_always_answered() {
    use MavMissionResult as R;
    let mut station = ready(7);
    let origin = spandrel_testkit::shipped::scenario("drill-hover").origin;
    let old = MavMessage::MISSION_ITEM(MISSION_ITEM_DATA {
        param4: NAN,
        x: origin.latitude_deg as f32,
        y: origin.longitude_deg as f32,
        z: 5.0,
        command: MavCmd::MAV_CMD_NAV_WAYPOINT,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        ..Default::default()
    });
    assert_eq!(station.ask(&count(1, PLAN), asked), Some(0));
    assert_eq!(station.ask(&old, result), Some(ACCEPTED), "an item in floating-point degrees must be accepted");
    let part = MISSION_WRITE_PARTIAL_LIST_DATA { target_system: 1, target_component: 1, ..Default::default() };
    let asked_first = station.ask(&MavMessage::MISSION_WRITE_PARTIAL_LIST(part), asked);
    assert_eq!(asked_first, Some(0), "the only item must be requested");
    let part = MISSION_REQUEST_PARTIAL_LIST_DATA { target_system: 1, target_component: 1, ..Default::default() };
    assert_eq!(station.ask(&MavMessage::MISSION_REQUEST_PARTIAL_LIST(part), result), Some(R::MAV_MISSION_UNSUPPORTED));
    // A plan of a type that MAVLink does not define: MISSION_REQUEST_LIST, type 9.
    station.received.clear();
    station.send_payload(43, &[1, 1, 9]);
    station.run_ms(1);
    let refused = station.received.iter().find(|f| f.message_id == 47).map(|f| f.payload(4));
    assert_eq!(refused.as_deref(), Some(&[255, 190, R::MAV_MISSION_UNSUPPORTED as u8, 9][..]));
    // An item with an unknown command ends its upload.
    assert_eq!(station.ask(&count(1, PLAN), asked), Some(0));
    let mut unknown = [0u8; 38];
    unknown[30..32].copy_from_slice(&31_998u16.to_le_bytes());
    (unknown[32], unknown[33], unknown[34]) = (1, 1, 3);
    station.received.clear();
    station.send_payload(73, &unknown);
    station.run_ms(1);
    assert_eq!(station.last_message(result), Some(R::MAV_MISSION_UNSUPPORTED));
    assert_eq!(station.last_message(asked), None);
}

/// A station that connects later must be able to tell from the ID whether it has the current plan or must download it.
#[test]
fn wire_plan_id_changes_when_its_plan_changes() {
    let mut station = ready(7);
    let id_in_ack =
        |s: &Station| s.last_message(|m| if let MavMessage::MISSION_ACK(a) = m { Some(a.opaque_id) } else { None }).unwrap();
    let mut ids = Vec::new();
    for height in [6.0, 7.0, 6.0] {
        assert_eq!(upload(&mut station, &[item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 5.0, height)]), ACCEPTED);
        ids.push(id_in_ack(&station));
    }
    assert!(ids[0] != 0 && ids[0] != ids[1] && ids[0] == ids[2], "{ids:?}");
    station.run_ms(1_100);
    let told =
        station.last_message(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some((c.mission_id, c.fence_id)) } else { None });
    assert_eq!(told, Some((ids[2], 0)));
    let list = MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    let counted = station.ask(&list, |m| if let MavMessage::MISSION_COUNT(c) = m { Some(c.opaque_id) } else { None });
    assert_eq!(counted, Some(ids[2]));
}

#[test]
fn wire_500_items_are_uploaded_and_downloaded() {
    let mut station = ready(7);
    let items: Vec<_> = (0..500).map(|k| item(k, MavCmd::MAV_CMD_NAV_WAYPOINT, f64::from(k), 6.0)).collect();
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    for sent in items.iter().step_by(97) {
        let request = MISSION_REQUEST_INT_DATA { seq: sent.seq, target_system: 1, target_component: 1, ..Default::default() };
        let got = station.ask(&MavMessage::MISSION_REQUEST_INT(request), |m| {
            if let MavMessage::MISSION_ITEM_INT(i) = m { Some(i.x) } else { None }
        });
        assert_eq!(got, Some(sent.x));
    }
}
