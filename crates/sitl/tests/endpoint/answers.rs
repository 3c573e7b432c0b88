//! Every request gets exactly one immediate response; components that are not addressed stay silent.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::units::deg_e7;
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::{LinkId, LinkKind, flavor};
use spandrel_sitl::sim::Sim;
use spandrel_testkit::station::{GCS, Station};

/// Returns the acknowledgments of a command, which may have any number. The frame is encoded manually, because not all
/// commands are in the dialect.
fn acknowledgements(sim: &mut Sim, encoder: &mut Encoder, id: u32, number: u16, target: (u8, u8)) -> Vec<(u16, u8)> {
    let mut payload = [0; 35];
    payload[28..30].copy_from_slice(&number.to_le_bytes());
    (payload[30], payload[31]) = target;
    sim.handle_datagram(GCS, &encoder.encode_payload(id, &payload[..if id == 76 { 33 } else { 35 }]));
    // No tick runs in between: the response must come before anything else happens.
    let now = sim.now();
    sim.handle_timeout(now);
    let mut out = Vec::new();
    while let Some(transmit) = sim.poll_transmit() {
        for frame in Decoder::new().datagram(&transmit.bytes).iter().filter(|f| f.message_id == 77) {
            let p = frame.payload(10);
            assert_eq!((p[8], p[9]), (255, 190), "the response must be addressed to the sender");
            out.push((u16::from_le_bytes([p[0], p[1]]), frame.component_id));
        }
    }
    out
}

#[test]
fn wire_every_command_gets_one_response_and_unaddressed_components_stay_silent() {
    let mut station = Station::airborne("drill-hover", 7);
    while station.sim.poll_transmit().is_some() {}
    let mut encoder = Encoder::new(255, 190);
    for number in 0..=u16::MAX {
        // One tick for each request, because the work per link per tick is limited.
        let next = station.sim.poll_timeout();
        station.sim.handle_timeout(next);
        while station.sim.poll_transmit().is_some() {}
        for id in [75, 76] {
            for (target, speaker) in [((1, 1), 1), ((1, 0), 1), ((1, 100), 100)] {
                let got = acknowledgements(&mut station.sim, &mut encoder, id, number, target);
                assert_eq!(got, [(number, speaker)], "message {id}, target {target:?}");
            }
        }
        let others = [(2, 1), (1, 191), (1, 42)];
        let target = others[usize::from(number) % others.len()];
        assert!(acknowledgements(&mut station.sim, &mut encoder, 76, number, target).is_empty(), "{number} to {target:?}");
    }
}

#[test]
fn wire_camera_component_rejects_flight_commands() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let one = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for command in [
        MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
        MavCmd::MAV_CMD_NAV_TAKEOFF,
        MavCmd::MAV_CMD_DO_SET_MODE,
        MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF,
        MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
        MavCmd::MAV_CMD_SET_CAMERA_ZOOM,
    ] {
        assert_eq!(station.command(100, command, one), MavResult::MAV_RESULT_UNSUPPORTED, "{command:?}");
    }
    station.run_ms(1_100);
    let armed = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(b) if b.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(b.base_mode),
        _ => None,
    });
    assert!(!armed.unwrap().contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED));
    let list = PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 100 };
    let value = station.ask(&MavMessage::PARAM_REQUEST_LIST(list), |m| matches!(m, MavMessage::PARAM_VALUE(_)).then_some(()));
    assert_eq!(value, None, "the camera must not have parameters");
}

#[test]
fn wire_messages_can_be_requested_once_or_at_a_rate() {
    use spandrel_sitl::endpoint::streams::STREAMS;
    let mut station = Station::airborne("two-bridges", 7);
    // Start an orbit to provide data for the orbit stream.
    let orbit = [3.0, 0.5, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_ORBIT, orbit), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(20);
    let mut unspoken = 0;
    for stream in STREAMS {
        let id = stream.id as f32;
        station.sticks(0, 0, 500, 0);
        if !stream.is_sent(&spandrel_sitl::endpoint::flavor::px4::FLAVOR) {
            let refused = station.command(stream.component, MavCmd::MAV_CMD_REQUEST_MESSAGE, [id, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let rate =
                station.command(stream.component, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [id, 5e4, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert_eq!((refused, rate), (MavResult::MAV_RESULT_DENIED, MavResult::MAV_RESULT_FAILED), "message {id}");
            unspoken += 1;
            continue;
        }
        let asked = station.command(stream.component, MavCmd::MAV_CMD_REQUEST_MESSAGE, [id, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(asked, MavResult::MAV_RESULT_ACCEPTED, "message {id}");
        assert!(station.received.iter().any(|f| f.message_id == stream.id && f.component_id == stream.component), "message {id}");
        let set = |us| [id, us, 0.0, 0.0, 0.0, 0.0, 0.0];
        let accepted = |s: &mut Station, us| {
            let result = s.command(stream.component, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, set(us));
            assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED, "message {id}");
        };
        let heard_in_a_second = |s: &mut Station| {
            s.received.clear();
            for _ in 0..5 {
                s.sticks(0, 0, 500, 0);
                s.run_ms(200);
            }
            // A message may have several rows, for example one for each direction of a distance sensor.
            let rows = STREAMS.iter().filter(|other| (other.id, other.component) == (stream.id, stream.component)).count();
            s.received.iter().filter(|f| f.message_id == stream.id && f.component_id == stream.component).count() / rows
        };
        accepted(&mut station, 50_000.0);
        let count = heard_in_a_second(&mut station);
        assert!((19..=21).contains(&count), "message {id} at 20 Hz: {count} in one second");
        accepted(&mut station, -1.0);
        assert_eq!(heard_in_a_second(&mut station), 0, "message {id} must be off");
        let interval = station.command(stream.component, MavCmd::MAV_CMD_GET_MESSAGE_INTERVAL, set(0.0));
        let told = station
            .last_message(|m| if let MavMessage::MESSAGE_INTERVAL(i) = m { Some((i.message_id, i.interval_us)) } else { None });
        assert_eq!((interval, told), (MavResult::MAV_RESULT_ACCEPTED, Some((stream.id as u16, -1))));
        accepted(&mut station, 0.0);
    }
    assert_eq!(unspoken, 7, "only POWER_STATUS, SIM_STATE and ArduPilot dialect messages may be absent");
    let unknown = [9_999.0, 20_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, unknown), MavResult::MAV_RESULT_FAILED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, unknown), MavResult::MAV_RESULT_DENIED);
}

fn value_of(m: &MavMessage) -> Option<(String, f32, u16)> {
    match m {
        MavMessage::PARAM_VALUE(v) => Some((v.param_id.to_str().ok()?.to_owned(), v.param_value, v.param_index)),
        _ => None,
    }
}

fn error_of(m: &MavMessage) -> Option<MavParamError> {
    if let MavMessage::PARAM_ERROR(e) = m { Some(e.error) } else { None }
}

#[test]
fn wire_parameters_are_read_by_name_and_index_with_errors_for_invalid_requests() {
    let mut station = Station::new("drill-hover", 7);
    let read = |name: &str, param_index| {
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index,
            target_system: 1,
            target_component: 1,
            param_id: name.into(),
        })
    };
    let (name, value, index) = station.ask(&read("MIS_TAKEOFF_ALT", -1), value_of).unwrap();
    assert_eq!((name.as_str(), value), ("MIS_TAKEOFF_ALT", 2.5));
    assert_eq!(station.ask(&read("", index as i16), value_of).unwrap().0, "MIS_TAKEOFF_ALT");
    for (name, index) in [("NOPE", -1), ("", -1), ("", 30_000), ("", i16::MIN)] {
        assert_eq!(
            station.ask(&read(name, index), error_of),
            Some(MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST),
            "{name} {index}"
        );
    }
    let set = |name: &str, param_value, param_type| {
        MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value,
            target_system: 1,
            target_component: 1,
            param_id: name.into(),
            param_type,
        })
    };
    let real = MavParamType::MAV_PARAM_TYPE_REAL32;
    assert_eq!(station.ask(&set("MIS_TAKEOFF_ALT", 4.0, real), value_of).unwrap().1, 4.0);
    for (name, value, kind, error) in [
        ("NOPE", 1.0, real, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST),
        ("MIS_TAKEOFF_ALT", 1e9, real, MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
        ("MIS_TAKEOFF_ALT", f32::NAN, real, MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE),
        ("MIS_TAKEOFF_ALT", 3.0, MavParamType::MAV_PARAM_TYPE_INT32, MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH),
        ("MAV_SYS_ID", f32::from_bits(9), MavParamType::MAV_PARAM_TYPE_INT32, MavParamError::MAV_PARAM_ERROR_READ_ONLY),
    ] {
        assert_eq!(station.ask(&set(name, value, kind), error_of), Some(error), "{name} {value}");
    }
    assert_eq!(station.ask(&read("MIS_TAKEOFF_ALT", -1), value_of).unwrap().1, 4.0, "rejected values must have no effect");
}

#[test]
fn wire_parameter_hash_precedes_the_list_and_setting_it_stops_the_list() {
    let mut station = Station::new("drill-hover", 7);
    let list = MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 0 });
    let (name, hash, index) = station.ask(&list, value_of).unwrap();
    assert_eq!((name.as_str(), index), ("_HASH_CHECK", u16::MAX));
    station.send(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: hash,
        target_system: 1,
        target_component: 1,
        param_id: "_HASH_CHECK".into(),
        param_type: MavParamType::MAV_PARAM_TYPE_UINT32,
    }));
    station.run_ms(2);
    station.received.clear();
    station.run_ms(500);
    assert!(station.all(value_of).is_empty(), "no parameters must follow");
}

#[test]
fn wire_terrain_check_is_answered_with_the_height_of_the_ground() {
    /// Half the resolution of an `f32` altitude near 500 m, m.
    const RESOLUTION_M: f64 = 3e-5;
    let mut station = Station::with_flavor(&flavor::ardupilot::FLAVOR, "two-bridges", 7);
    station.run_ms(2_500);
    let site = station.sim.site().clone();
    let report = |station: &mut Station, lat: i32, lon: i32| {
        station.ask(&MavMessage::TERRAIN_CHECK(TERRAIN_CHECK_DATA { lat, lon }), |m| match m {
            MavMessage::TERRAIN_REPORT(r) => Some(r.clone()),
            _ => None,
        })
    };
    for (east_m, north_m) in [(0.0, 0.0), (120.0, -80.0), (-300.0, 250.0)] {
        let up_m = site.terrain_up_m(east_m, north_m).unwrap();
        let geo = site.plane().geo_from_enu(Vec3::new(east_m, north_m, up_m));
        let (lat, lon) = (deg_e7(geo.latitude_deg), deg_e7(geo.longitude_deg));
        let answer = report(&mut station, lat, lon).unwrap();
        assert_eq!((answer.lat, answer.lon), (lat, lon));
        let expected = site.plane().origin().altitude_m + up_m;
        // A step of 1e-7 degrees is 1 cm, on a slope of at most 45 degrees.
        assert!((f64::from(answer.terrain_height) - expected).abs() < 0.01 + RESOLUTION_M, "{answer:?} for {expected}");
        assert_eq!(f64::from(answer.spacing), site.terrain_spacing_m());
        assert!(answer.current_height.is_finite());
    }
    let elsewhere = report(&mut station, 10_000_000, 20_000_000).unwrap();
    assert_eq!((elsewhere.spacing, elsewhere.loaded), (0, 0), "no heights outside of the site");
    assert!(report(&mut station, i32::MAX, i32::MIN).is_some_and(|answer| answer.spacing == 0));
    // PX4 has no terrain heights.
    assert!(report(&mut Station::new("two-bridges", 7), 0, 0).is_none());
}

#[test]
fn wire_timesync_ping_file_and_log_requests_are_answered() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    let sync = MavMessage::TIMESYNC(TIMESYNC_DATA { ts1: 123_456_789, ..Default::default() });
    let answer = station.ask(&sync, |m| match m {
        MavMessage::TIMESYNC(t) if t.tc1 != 0 => Some((t.ts1, t.tc1, t.target_system, t.target_component)),
        _ => None,
    });
    assert_eq!(answer, Some((123_456_789, SimTime::from_ms(100).ns(), 255, 190)));
    let ping = MavMessage::PING(PING_DATA { seq: 7, time_usec: 5, ..Default::default() });
    let pong =
        station.ask(&ping, |m| if let MavMessage::PING(p) = m { Some((p.seq, p.time_usec, p.target_system)) } else { None });
    assert_eq!(pong, Some((7, 5, 255)));
    for (component, opcode, expected) in
        [(1, 4, (129, 10)), (1, 3, (129, 10)), (1, 77, (129, 7)), (1, 2, (128, 0)), (100, 4, (129, 10))]
    {
        let mut payload = [0; 251];
        (payload[0], payload[3], payload[4]) = (8, opcode, 5);
        payload[12..17].copy_from_slice(b"@none");
        let request =
            FILE_TRANSFER_PROTOCOL_DATA { target_system: 1, target_component: component, payload, ..Default::default() };
        let answer = station.ask(&MavMessage::FILE_TRANSFER_PROTOCOL(request), |m| match m {
            MavMessage::FILE_TRANSFER_PROTOCOL(f) => Some((f.payload[0], f.payload[5], (f.payload[3], f.payload[12]))),
            _ => None,
        });
        assert_eq!(answer, Some((9, opcode, expected)));
    }
    let logs = LOG_REQUEST_LIST_DATA { target_system: 1, target_component: 1, end: u16::MAX, ..Default::default() };
    let entry = station
        .ask(&MavMessage::LOG_REQUEST_LIST(logs), |m| if let MavMessage::LOG_ENTRY(l) = m { Some(l.num_logs) } else { None });
    assert_eq!(entry, Some(0));
}

#[test]
fn wire_frames_are_forwarded_only_to_their_target() {
    let mut station = Station::new("drill-hover", 7);
    let (monitor, other) = (LinkId(2), LinkId(3));
    station.sim.open_link(monitor, LinkKind::Payload, false);
    station.sim.open_link(other, LinkKind::Sdk, false);
    let mut encoder = Encoder::new(1, 191);
    station.sim.handle_datagram(monitor, &encoder.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())));
    station.run_ms(2);
    let copies = |s: &mut Station, message: &MavMessage| {
        while s.sim.poll_transmit().is_some() {}
        s.send(message);
        let now = s.sim.now();
        s.sim.handle_timeout(now);
        std::iter::from_fn(|| s.sim.poll_transmit()).map(|t| t.link).collect::<Vec<_>>()
    };
    let sticks = |target| MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target, z: 500, ..Default::default() });
    assert_eq!(copies(&mut station, &sticks(9)), [], "system 9 must be unknown on all links");
    assert_eq!(copies(&mut station, &sticks(1)), [monitor], "system 1 must also be reachable through the monitor's link");
    assert_eq!(copies(&mut station, &sticks(0)), [monitor, other], "broadcast sticks must reach all links");
}

#[test]
fn wire_commands_without_effect_are_accepted() {
    let mut station = Station::airborne("drill-hover", 7);
    let change = |s: &mut Station, speed| s.command(1, MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, speed, -1.0, 0.0, 0.0, 0.0, 0.0]);
    for (speed, result) in [(3.0, true), (-1.0, true), (-2.0, true), (0.0, false), (f32::NAN, false)] {
        assert_eq!(change(&mut station, speed) == MavResult::MAV_RESULT_ACCEPTED, result, "{speed}");
    }
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_FLIGHTTERMINATION, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(1_100);
    let armed = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(b) if b.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(b.base_mode),
        _ => None,
    });
    assert!(armed.unwrap().contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED), "the vehicle must stay armed");
}
