//! The vehicle emulating three autopilots: identification, modes, parameters, files, and streams.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::copter::{SET_MODE, beat, copter, copter_at, mode, next_heartbeat};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::ftp::{ACK, FtpPacket, Opcode};
use spandrel_sitl::endpoint::flavor::{ardupilot, generic, px4};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_testkit::station::{GCS, Station, one};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;

#[test]
fn wire_each_flavor_identifies_as_its_autopilot() {
    let c_cast = MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT;
    for (flavor, autopilot, number) in [
        (&px4::FLAVOR, MavAutopilot::MAV_AUTOPILOT_PX4, 3 << 16),
        (&ardupilot::FLAVOR, MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA, 5),
        (&generic::FLAVOR, MavAutopilot::MAV_AUTOPILOT_GENERIC, 3 << 16),
    ] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.run_ms(5);
        let first = if flavor.name == "ardupilot" { MavState::MAV_STATE_BOOT } else { MavState::MAV_STATE_STANDBY };
        assert_eq!(beat(&station).system_status, first, "{}: first heartbeat", flavor.name);
        station.run_ms(2_500);
        let heard = beat(&station);
        assert_eq!((heard.autopilot, heard.custom_mode), (autopilot, number), "{}", flavor.name);
        assert_eq!(heard.system_status, MavState::MAV_STATE_STANDBY);
        station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(148.0));
        let version =
            station.last_message(|m| if let MavMessage::AUTOPILOT_VERSION(v) = m { Some(v.clone()) } else { None }).unwrap();
        assert_eq!(version.flight_sw_version, flavor.software_version);
        assert_eq!(version.capabilities.contains(c_cast), flavor.name == "ardupilot");
        let own =
            PARAM_REQUEST_READ_DATA { target_system: 1, target_component: 1, param_index: -1, param_id: "SPAN_FLAVOUR".into() };
        let value = station.ask(&MavMessage::PARAM_REQUEST_READ(own), |m| match m {
            MavMessage::PARAM_VALUE(v) => Some(v.param_value),
            _ => None,
        });
        let number = flavor.params.number;
        let expected = if flavor.params.cast { number as f32 } else { f32::from_bits(number.cast_unsigned()) };
        assert_eq!(value, Some(expected), "the version must match the emulated autopilot");
    }
}

#[test]
fn wire_every_available_mode_can_be_entered_with_each_message() {
    for flavor in [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.run_ms(2_500);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(435.0)), ACCEPTED);
        let modes = station.all(|m| if let MavMessage::AVAILABLE_MODES(mode) = m { Some(mode.clone()) } else { None });
        assert_eq!(modes.len(), flavor.modes.len());
        let offered = |m: &AVAILABLE_MODES_DATA| !m.properties.contains(MavModeProperty::MAV_MODE_PROPERTY_NOT_USER_SELECTABLE);
        // Mission mode requires a mission.
        let needs_mission = |m: &AVAILABLE_MODES_DATA| m.standard_mode == MavStandardMode::MAV_STANDARD_MODE_MISSION;
        // Copter's AUTO and AUTO RTL also require a mission, and FOLLOW requires its parameter.
        let needs_more = |m: &AVAILABLE_MODES_DATA| flavor.name == "ardupilot" && [3, 23, 27].contains(&m.custom_mode);
        for mode in modes.iter().filter(|mode| offered(mode) && !needs_mission(mode) && !needs_more(mode)) {
            let target_system = 1;
            let base_mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
            station.send(&MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: mode.custom_mode, target_system, base_mode }));
            assert_eq!(
                next_heartbeat(&mut station).custom_mode,
                mode.custom_mode,
                "{}: SET_MODE {:?}",
                flavor.name,
                mode.mode_name
            );
            if mode.standard_mode != MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD {
                let standard = one(mode.standard_mode as u32 as f32);
                assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_STANDARD_MODE, standard), ACCEPTED);
                station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(436.0));
                let now = station
                    .last_message(|m| if let MavMessage::CURRENT_MODE(mode) = m { Some(mode.clone()) } else { None })
                    .unwrap();
                assert_eq!((now.standard_mode, now.custom_mode), (mode.standard_mode, mode.custom_mode));
            }
        }
        if flavor.name == "generic" {
            let standard = |m: &AVAILABLE_MODES_DATA| m.standard_mode != MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD;
            assert!(modes.iter().filter(|mode| offered(mode)).all(standard), "only standard modes must be offered");
            assert_eq!(station.command(1, SET_MODE, mode(f32::from(4u8) * 65_536.0 + 5.0 * 16_777_216.0)), ACCEPTED);
            assert_eq!(
                next_heartbeat(&mut station).custom_mode,
                4 << 16 | 5 << 24,
                "parameter 2 must accept a complete custom mode"
            );
        }
    }
}

#[test]
fn wire_copter_parameters_are_cast_to_float_and_take_effect() {
    let mut station = copter();
    station.send(&MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 }));
    station.run_ms(500);
    let values = station.all(|m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.clone()) } else { None });
    assert_eq!(values.len(), usize::from(values[0].param_count), "each parameter must arrive once, without a leading checksum");
    let of = |name: &str| values.iter().find(|v| v.param_id.to_str() == Ok(name)).unwrap_or_else(|| panic!("{name}"));
    assert_eq!((of("FRAME_CLASS").param_value, of("FRAME_CLASS").param_type), (1.0, MavParamType::MAV_PARAM_TYPE_INT8));
    assert_eq!(of("RTL_ALT").param_value, 3_000.0);
    assert!(station.texts().iter().any(|text| text.starts_with("ArduCopter V") && text.contains("Spandrel")));
    for name in [
        "RCMAP_ROLL",
        "FLTMODE6",
        "INS_ACCOFFS_X",
        "COMPASS_DEV_ID",
        "COMPASS_USE3",
        "SYSID_THISMAV",
        "FS_THR_ENABLE",
        "BATT_MONITOR",
    ] {
        of(name);
    }
    let set = |name: &str, param_value, param_type| {
        MavMessage::PARAM_SET(PARAM_SET_DATA {
            target_system: 1,
            target_component: 1,
            param_id: name.into(),
            param_value,
            param_type,
        })
    };
    let answer = |m: &MavMessage| match m {
        MavMessage::PARAM_VALUE(v) => Some(Ok(v.param_value)),
        MavMessage::PARAM_ERROR(e) => Some(Err(e.error)),
        _ => None,
    };
    let real = MavParamType::MAV_PARAM_TYPE_REAL32;
    assert_eq!(
        station.ask(&set("RTL_ALT", 2_000.0, real), answer),
        Some(Ok(2_000.0)),
        "an integer sent as a float must be accepted"
    );
    assert_eq!(station.ask(&set("FRAME_TYPE", 0.0, real), answer), Some(Err(MavParamError::MAV_PARAM_ERROR_READ_ONLY)));
    assert_eq!(
        station.ask(&set("WPNAV_SPEED", -9e9, real), answer),
        Some(Err(MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE))
    );
    assert_eq!(station.ask(&set("_HASH_CHECK", 0.0, real), answer), Some(Err(MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST)));
    assert_eq!(station.ask(&set("WPNAV_SPEED_UP", 100.0, real), answer), Some(Ok(100.0)));
}

#[test]
fn flight_copter_climb_rate_follows_its_parameter() {
    let mut station = copter_at(5.0);
    let set = PARAM_SET_DATA {
        target_system: 1,
        target_component: 1,
        param_id: "WPNAV_SPEED_UP".into(),
        param_value: 80.0,
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    };
    station.send(&MavMessage::PARAM_SET(set));
    let up = [-1.0, 1.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 470.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_REPOSITION, up), ACCEPTED);
    station.run_ms(3_000);
    let low = station.place()[2];
    let high = station.local_position_after(4_000)[2];
    let speed = (low - high) / 4.0;
    assert!((speed - 0.8).abs() < 0.15, "{speed} m/s instead of 0.8 m/s");
}

#[test]
fn wire_only_ardupilot_serves_packed_parameters_over_ftp() {
    for (flavor, there) in [(&ardupilot::FLAVOR, true), (&px4::FLAVOR, false), (&generic::FLAVOR, false)] {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.run_ms(100);
        let open = file(&mut station, Opcode::OpenFileRo, 0, 0, b"@PARAM/param.pck?withdefaults=1", 1);
        assert_eq!(open.opcode == ACK, there, "{}", flavor.name);
        if !there {
            continue;
        }
        let size = u32::from_le_bytes(open.data_in_use().unwrap().try_into().unwrap());
        let mut bytes = Vec::new();
        let mut sequence = 3;
        while (bytes.len() as u32) < size {
            let part = file(&mut station, Opcode::ReadFile, open.session, bytes.len() as u32, &[0; 200], sequence);
            assert_eq!(part.opcode, ACK);
            bytes.extend_from_slice(part.data_in_use().unwrap());
            sequence += 2;
        }
        let number = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        assert_eq!((bytes.len() as u32, number(0), number(2)), (size, 0x671c, number(4)));
    }
}

fn file(station: &mut Station, opcode: Opcode, session: u8, offset: u32, data: &[u8], sequence: u16) -> FtpPacket {
    let mut payload = [0u8; 251];
    payload[..2].copy_from_slice(&sequence.to_le_bytes());
    (payload[2], payload[3], payload[4]) = (session, opcode as u8, data.len() as u8);
    payload[8..12].copy_from_slice(&offset.to_le_bytes());
    payload[12..12 + data.len()].copy_from_slice(data);
    let request = FILE_TRANSFER_PROTOCOL_DATA { target_network: 0, target_system: 1, target_component: 1, payload };
    station
        .ask(&MavMessage::FILE_TRANSFER_PROTOCOL(request), |m| match m {
            MavMessage::FILE_TRANSFER_PROTOCOL(answer) => Some(FtpPacket::read(&answer.payload)),
            _ => None,
        })
        .expect("an immediate response")
}

#[test]
fn wire_copter_sends_only_heartbeats_until_other_streams_are_requested() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(3_000);
    let unasked: std::collections::BTreeSet<u32> = station.received.iter().map(|f| f.message_id).collect();
    assert_eq!(unasked.into_iter().collect::<Vec<_>>(), [0], "only heartbeats must be sent");
    let sidecar = LinkId(9);
    station.sim.open_link(sidecar, LinkKind::Payload, false);
    let mut told = std::collections::BTreeSet::new();
    let until = station.sim.now() + spandrel_model::time::SimTime::from_ms(6_000);
    station.sim.handle_timeout(until);
    while let Some(transmit) = station.sim.poll_transmit() {
        if transmit.link == sidecar {
            told.extend(spandrel_mavlink::codec::Decoder::new().datagram(&transmit.bytes).iter().map(|f| f.message_id));
        } else {
            assert_eq!(transmit.link, GCS);
        }
    }
    for id in [115, 1, 245, 147, 285, 440, 251, 252] {
        assert!(told.contains(&id), "the sidecar must receive message {id}");
    }
    station.sim.close_link(sidecar);
    let groups = |req_stream_id, req_message_rate, start_stop| {
        MavMessage::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA {
            req_message_rate,
            target_system: 1,
            target_component: 1,
            req_stream_id,
            start_stop,
        })
    };
    station.send(&groups(MavDataStream::MAV_DATA_STREAM_POSITION, 5, 1));
    station.run_ms(10);
    station.received.clear();
    station.run_ms(2_000);
    let count = |station: &Station, id| station.received.iter().filter(|f| f.message_id == id).count();
    assert_eq!((count(&station, 33), count(&station, 32), count(&station, 30)), (10, 10, 0), "the group must arrive at 5 Hz");
    station.send(&groups(MavDataStream::MAV_DATA_STREAM_ALL, 4, 1));
    station.run_ms(10);
    station.received.clear();
    station.run_ms(2_000);
    for id in [1, 24, 27, 30, 33, 62, 65, 74, 147] {
        // Stick positions are streamed only while a client controls the sticks.
        assert!(id == 65 || count(&station, id) == 8, "message {id}: {}", count(&station, id));
    }
    station.send(&groups(MavDataStream::MAV_DATA_STREAM_ALL, 4, 0));
    station.run_ms(10);
    station.received.clear();
    station.run_ms(2_000);
    assert!(station.received.iter().all(|f| f.message_id == 0));
}

#[test]
fn wire_requests_for_unsupported_messages_are_answered_like_each_autopilot() {
    for (flavor, message, interval) in
        [(&px4::FLAVOR, DENIED, FAILED), (&ardupilot::FLAVOR, FAILED, DENIED), (&generic::FLAVOR, DENIED, FAILED)]
    {
        let mut station = Station::with_flavor(flavor, "drill-hover", 7);
        station.run_ms(100);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(9_999.0)), message, "{}", flavor.name);
        let often = [9_999.0, 20_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, often), interval, "{}", flavor.name);
    }
}
