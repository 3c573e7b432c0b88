//! The same vehicle as three autopilots: modes, parameters, plans, take-off, streams.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::station::{GCS, Station};
use spandrel::mav::dialect::*;
use spandrel::mav::ftp::{ACK, Opcode, Packet};
use spandrel::sitl::endpoint::flavour::{ardupilot, generic, px4};
use spandrel::sitl::endpoint::{LinkId, LinkKind};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
const FAILED: MavResult = MavResult::MAV_RESULT_FAILED;
const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
const SET_MODE: MavCmd = MavCmd::MAV_CMD_DO_SET_MODE;
/// Copter's numbers.
const ALT_HOLD: f32 = 2.0;
const AUTO: f32 = 3.0;
const GUIDED: f32 = 4.0;
const LOITER: f32 = 5.0;
const RTL: f32 = 6.0;
const POSHOLD: f32 = 16.0;
const BRAKE: f32 = 17.0;
/// A height counts as reached within this, m (the autopilot's own 0.4 m and its way to rest).
const HEIGHT_M: f32 = 0.6;
/// The drill's pad in 1e-7 degrees, and metres for one of them north.
const PAD: (i32, i32) = (467_052_000, 83_814_000);
const M_PER_E7: f64 = 0.011_132;

fn one(p: f32) -> [f32; 7] {
    [p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
}

fn mode(number: f32) -> [f32; 7] {
    [1.0, number, 0.0, 0.0, 0.0, 0.0, 0.0]
}

fn beat(station: &Station) -> HEARTBEAT_DATA {
    station
        .last(|m| match m {
            MavMessage::HEARTBEAT(beat) if beat.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(beat.clone()),
            _ => None,
        })
        .unwrap()
}

fn next_beat(station: &mut Station) -> HEARTBEAT_DATA {
    station.heard.clear();
    station.run_ms(1_100);
    beat(station)
}

fn texts(station: &Station) -> Vec<String> {
    station.all(|m| if let MavMessage::STATUSTEXT(t) = m { t.text.to_str().ok().map(str::to_owned) } else { None })
}

/// A Copter on the ground, ready, with the streams that these tests look at.
fn copter() -> Station {
    let mut station = Station::speaking(&ardupilot::FLAVOUR, "drill-hover", 7);
    station.run_ms(2_500);
    for id in [32.0, 245.0, 65.0] {
        let interval = [id, 50_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, interval), ACCEPTED);
    }
    station
}

/// In GUIDED at a height over home, m.
fn copter_at(height_m: f32) -> Station {
    let mut station = copter();
    assert_eq!(station.command(1, SET_MODE, mode(GUIDED)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let take_off = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, take_off), ACCEPTED);
    let ground = station.place_after(100)[2];
    assert!(station.run_until(30.0, |s| ground - s.place()[2] > height_m - HEIGHT_M), "no take-off: {:?}", texts(&station));
    station.run_ms(3_000);
    station
}

#[test]
fn wire_each_flavour_beats_and_names_itself_as_its_autopilot() {
    let c_cast = MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT;
    for (flavour, autopilot, number) in [
        (&px4::FLAVOUR, MavAutopilot::MAV_AUTOPILOT_PX4, 3 << 16),
        (&ardupilot::FLAVOUR, MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA, 5),
        (&generic::FLAVOUR, MavAutopilot::MAV_AUTOPILOT_GENERIC, 3 << 16),
    ] {
        let mut station = Station::speaking(flavour, "drill-hover", 7);
        station.run_ms(5);
        let first = if flavour.name == "ardupilot" { MavState::MAV_STATE_BOOT } else { MavState::MAV_STATE_STANDBY };
        assert_eq!(beat(&station).system_status, first, "{}: the first beat", flavour.name);
        station.run_ms(2_500);
        let heard = beat(&station);
        assert_eq!((heard.autopilot, heard.custom_mode), (autopilot, number), "{}", flavour.name);
        assert_eq!(heard.system_status, MavState::MAV_STATE_STANDBY);
        station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(148.0));
        let version = station.last(|m| if let MavMessage::AUTOPILOT_VERSION(v) = m { Some(v.clone()) } else { None }).unwrap();
        assert_eq!(version.flight_sw_version, flavour.software_version);
        assert_eq!(version.capabilities.contains(c_cast), flavour.name == "ardupilot");
        let own =
            PARAM_REQUEST_READ_DATA { target_system: 1, target_component: 1, param_index: -1, param_id: "SPAN_FLAVOUR".into() };
        let value = station.ask(&MavMessage::PARAM_REQUEST_READ(own), |m| match m {
            MavMessage::PARAM_VALUE(v) => Some(v.param_value),
            _ => None,
        });
        let number = flavour.params.number;
        let expected = if flavour.params.cast { number as f32 } else { f32::from_bits(number.cast_unsigned()) };
        assert_eq!(value, Some(expected), "the flavour tells the truth about itself");
    }
}

#[test]
fn wire_every_mode_that_is_offered_is_entered_by_each_message_and_shown_under_its_number() {
    for flavour in [&px4::FLAVOUR, &ardupilot::FLAVOUR, &generic::FLAVOUR] {
        let mut station = Station::speaking(flavour, "drill-hover", 7);
        station.run_ms(2_500);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(435.0)), ACCEPTED);
        let modes = station.all(|m| if let MavMessage::AVAILABLE_MODES(mode) = m { Some(mode.clone()) } else { None });
        assert_eq!(modes.len(), flavour.modes.len());
        let offered = |m: &AVAILABLE_MODES_DATA| !m.properties.contains(MavModeProperty::MAV_MODE_PROPERTY_NOT_USER_SELECTABLE);
        // A mission has to be there before its mode.
        let needs_mission = |m: &AVAILABLE_MODES_DATA| m.standard_mode == MavStandardMode::MAV_STANDARD_MODE_MISSION;
        for mode in modes.iter().filter(|mode| offered(mode) && !needs_mission(mode)) {
            let target_system = 1;
            let base_mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
            station.send(&MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: mode.custom_mode, target_system, base_mode }));
            assert_eq!(next_beat(&mut station).custom_mode, mode.custom_mode, "{}: SET_MODE {:?}", flavour.name, mode.mode_name);
            if mode.standard_mode != MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD {
                let standard = one(mode.standard_mode as u32 as f32);
                assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_STANDARD_MODE, standard), ACCEPTED);
                station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(436.0));
                let now =
                    station.last(|m| if let MavMessage::CURRENT_MODE(mode) = m { Some(mode.clone()) } else { None }).unwrap();
                assert_eq!((now.standard_mode, now.custom_mode), (mode.standard_mode, mode.custom_mode));
            }
        }
        if flavour.name == "generic" {
            let standard = |m: &AVAILABLE_MODES_DATA| m.standard_mode != MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD;
            assert!(modes.iter().filter(|mode| offered(mode)).all(standard), "nothing but standard modes is offered");
            assert_eq!(station.command(1, SET_MODE, mode(f32::from(4u8) * 65_536.0 + 5.0 * 16_777_216.0)), ACCEPTED);
            assert_eq!(next_beat(&mut station).custom_mode, 4 << 16 | 5 << 24, "a whole custom mode in parameter 2");
        }
    }
}

#[test]
fn wire_copters_modes_are_refused_as_copter_refuses_them() {
    let mut station = copter();
    for (number, name) in [(77.0, "No such mode 77"), (AUTO, "Mode change to AUTO failed: No mission to fly")] {
        assert_eq!(station.command(1, SET_MODE, mode(number)), FAILED);
        station.run_ms(5);
        assert!(texts(&station).iter().any(|text| text.starts_with(name)), "{:?}", texts(&station));
    }
    assert_eq!(station.command(1, SET_MODE, [0.0, GUIDED, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED, "without the flag for custom modes");
    let switch = SET_MODE_DATA { custom_mode: 0, target_system: 1, base_mode: MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED };
    station.send(&MavMessage::SET_MODE(switch));
    assert_eq!(next_beat(&mut station).custom_mode, LOITER as u32, "MAVProxy's words for the safety switch are no mode");
    assert_eq!(station.command(1, SET_MODE, mode(RTL)), ACCEPTED);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED);
    station.run_ms(5);
    assert!(texts(&station).contains(&"Arm: RTL mode not armable".to_owned()), "{:?}", texts(&station));
    station.command(1, SET_MODE, mode(LOITER));
    station.sticks(0, 900, 500, 0);
    station.run_ms(100);
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED);
    station.run_ms(5);
    assert!(texts(&station).contains(&"Arm: Sticks not centred".to_owned()), "{:?}", texts(&station));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_RUN_PREARM_CHECKS, one(0.0)), ACCEPTED);
    station.run_ms(5);
    assert!(texts(&station).contains(&"PreArm: Sticks not centred".to_owned()));
    let forced = [1.0, 2989.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, ARM, forced), ACCEPTED, "ArduPilot's number forces it");
}

#[test]
fn wire_a_transmitters_throttle_that_is_down_does_not_keep_a_copter_from_arming() {
    let low = |chan3_raw| {
        MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
            chan1_raw: 1500,
            chan2_raw: 1500,
            chan3_raw,
            chan4_raw: 1500,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        })
    };
    let mut station = copter();
    station.command(1, SET_MODE, mode(ALT_HOLD));
    for (pulse, result) in [(1_900, FAILED), (1_000, ACCEPTED)] {
        station.send(&low(pulse));
        station.run_ms(200);
        assert_eq!(station.command(1, ARM, one(1.0)), result, "throttle {pulse}");
    }
    station.send(&low(1_000));
    assert_eq!(next_beat(&mut station).custom_mode, ALT_HOLD as u32);
    let mut px4 = Station::new("drill-hover", 7);
    px4.run_ms(2_500);
    px4.send(&low(1_000));
    px4.run_ms(200);
    assert_eq!(px4.command(1, ARM, one(1.0)), MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
}

#[test]
fn flight_guided_takes_off_over_home_and_keeps_its_number_in_the_air() {
    let mut station = copter();
    let take_off = |height: f32| [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height];
    let command = MavCmd::MAV_CMD_NAV_TAKEOFF;
    assert_eq!(station.command(1, command, take_off(6.0)), FAILED, "not in GUIDED");
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, command, take_off(6.0)), FAILED, "not armed");
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    let on_ground = next_beat(&mut station);
    assert_eq!(
        (on_ground.custom_mode, on_ground.system_status),
        (GUIDED as u32, MavState::MAV_STATE_STANDBY),
        "armed, on the ground"
    );
    assert_eq!(station.command(1, command, take_off(0.0)), FAILED);
    assert_eq!(station.command(1, command, take_off(f32::NAN)), FAILED);
    assert_eq!(station.command(1, command, take_off(6.0)), ACCEPTED);
    let flying = next_beat(&mut station);
    assert!(station.run_until(5.0, |s| beat(s).system_status == MavState::MAV_STATE_ACTIVE));
    assert_eq!(flying.custom_mode, GUIDED as u32, "while it takes off");
    let ground = 0.0;
    assert!(station.run_until(30.0, |s| ground - s.place()[2] > 6.0 - HEIGHT_M));
    station.run_ms(2_000);
    let height = -station.place_after(100)[2];
    assert!((height - 6.0).abs() < 2.0 * HEIGHT_M, "over home, not over the sea: {height}");
    assert_eq!(next_beat(&mut station).custom_mode, GUIDED as u32, "when it has taken off");
    assert_eq!(station.command(1, command, take_off(9.0)), FAILED, "in the air");
    assert_eq!(station.command(1, ARM, one(0.0)), FAILED, "not disarmed in the air");
}

#[test]
fn flight_guided_flies_set_points_as_they_come_and_a_place_sent_once_is_flown_to() {
    let mut station = copter_at(5.0);
    let target = |type_mask: u16, x, y, z, vx| {
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            target_system: 1,
            target_component: 1,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
            type_mask: PositionTargetTypemask::from_bits_retain(type_mask),
            x,
            y,
            z,
            vx,
            ..Default::default()
        })
    };
    let [north, east, down] = station.place();
    station.send(&target(0x0DF8, north + 12.0, east, down, 0.0));
    let there = |s: &mut Station| (s.place()[0] - north - 12.0).abs() < 0.6;
    assert!(station.run_until(20.0, there), "{:?}", station.place());
    assert_eq!(next_beat(&mut station).custom_mode, GUIDED as u32);
    for _ in 0..30 {
        station.send(&target(0x0DC7, 0.0, 0.0, 0.0, -2.0));
        station.run_ms(100);
    }
    let [then, ..] = station.place();
    assert!(then < north + 9.0, "it flies south: {then}");
    station.run_ms(9_000);
    let [first, ..] = station.place();
    let [second, ..] = station.place_after(2_000);
    assert!((first - second).abs() < 0.2, "it stops when nothing comes any more: {first} {second}");
    let status = next_beat(&mut station);
    assert_eq!((status.custom_mode, status.system_status), (GUIDED as u32, MavState::MAV_STATE_ACTIVE), "that is no failure");
    station.command(1, SET_MODE, mode(BRAKE));
    station.send(&target(0x0DF8, north, east, down, 0.0));
    station.run_ms(3_000);
    assert!((station.place()[0] - second).abs() < 0.5, "no other mode follows them");
}

#[test]
fn flight_go_to_needs_guided_or_asks_for_it_and_brake_stops_it() {
    let mut station = copter_at(5.0);
    let place = |flags: f32| {
        MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            target_system: 1,
            target_component: 1,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            param1: -1.0,
            param2: flags,
            param4: f32::NAN,
            x: PAD.0 + (40.0 / M_PER_E7) as i32,
            y: PAD.1,
            z: 5.0,
            ..Default::default()
        })
    };
    let result = |m: &MavMessage| match m {
        MavMessage::COMMAND_ACK(ack) if ack.command == MavCmd::MAV_CMD_DO_REPOSITION => Some(ack.result),
        _ => None,
    };
    station.command(1, SET_MODE, mode(BRAKE));
    assert_eq!(station.ask(&place(0.0), result), Some(DENIED));
    assert_eq!(station.ask(&place(1.0), result), Some(ACCEPTED));
    assert_eq!(next_beat(&mut station).custom_mode, GUIDED as u32);
    station.run_ms(2_000);
    assert_eq!(station.command(1, SET_MODE, mode(BRAKE)), ACCEPTED);
    station.run_ms(5_000);
    let [first, ..] = station.place();
    let [second, ..] = station.place_after(2_000);
    assert!((first - second).abs() < 0.3 && first < 39.0, "it has stopped on its way: {first} {second}");
    assert_eq!(next_beat(&mut station).custom_mode, BRAKE as u32);
    // MAVProxy's and older ground stations' way: a single item.
    station.command(1, SET_MODE, mode(GUIDED));
    let errand = item(0, MavCmd::MAV_CMD_NAV_WAYPOINT, 0.0, 6.0);
    let answer = station.ask(&MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA { current: 2, ..errand }), |m| match m {
        MavMessage::MISSION_ACK(ack) => Some(ack.mavtype),
        _ => None,
    });
    assert_eq!(answer, Some(MavMissionResult::MAV_MISSION_ACCEPTED));
    assert!(station.run_until(30.0, |s| s.place()[0].abs() < 1.0), "back over the pad: {:?}", station.place());
}

#[test]
fn wire_copters_parameters_are_cast_and_act() {
    let mut station = copter();
    station.send(&MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 }));
    station.run_ms(500);
    let values = station.all(|m| if let MavMessage::PARAM_VALUE(v) = m { Some(v.clone()) } else { None });
    assert_eq!(values.len(), usize::from(values[0].param_count), "each once, and no checksum before them");
    let of = |name: &str| values.iter().find(|v| v.param_id.to_str() == Ok(name)).unwrap_or_else(|| panic!("{name}"));
    assert_eq!((of("FRAME_CLASS").param_value, of("FRAME_CLASS").param_type), (1.0, MavParamType::MAV_PARAM_TYPE_INT8));
    assert_eq!(of("RTL_ALT").param_value, 3_000.0);
    assert!(texts(&station).iter().any(|text| text.starts_with("ArduCopter V") && text.contains("Spandrel")));
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
    assert_eq!(station.ask(&set("RTL_ALT", 2_000.0, real), answer), Some(Ok(2_000.0)), "a whole number, sent as a real one");
    assert_eq!(station.ask(&set("FRAME_TYPE", 0.0, real), answer), Some(Err(MavParamError::MAV_PARAM_ERROR_READ_ONLY)));
    assert_eq!(
        station.ask(&set("WPNAV_SPEED", -9e9, real), answer),
        Some(Err(MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE))
    );
    assert_eq!(station.ask(&set("_HASH_CHECK", 0.0, real), answer), Some(Err(MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST)));
    assert_eq!(station.ask(&set("WPNAV_SPEED_UP", 100.0, real), answer), Some(Ok(100.0)));
}

#[test]
fn flight_a_copters_climb_is_as_fast_as_its_parameter_says() {
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
    let high = station.place_after(4_000)[2];
    let speed = (low - high) / 4.0;
    assert!((speed - 0.8).abs() < 0.15, "{speed} m/s where 0.8 is set");
}

#[test]
fn flight_a_copters_fence_acts_while_its_parameter_says_so() {
    let mut station = copter_at(5.0);
    let count = MISSION_COUNT_DATA {
        count: 1,
        target_system: 1,
        target_component: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..Default::default()
    };
    station.send(&MavMessage::MISSION_COUNT(count));
    let circle = MISSION_ITEM_INT_DATA {
        param1: 30.0,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..item(0, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0)
    };
    let done = station.ask(&MavMessage::MISSION_ITEM_INT(circle), |m| match m {
        MavMessage::MISSION_ACK(ack) => Some(ack.mavtype),
        _ => None,
    });
    assert_eq!(done, Some(MavMissionResult::MAV_MISSION_ACCEPTED));
    let north = PAD.0 + (60.0 / M_PER_E7) as i32;
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

#[test]
fn wire_the_packed_parameters_come_whole_over_ftp_and_other_flavours_have_none() {
    for (flavour, there) in [(&ardupilot::FLAVOUR, true), (&px4::FLAVOUR, false), (&generic::FLAVOUR, false)] {
        let mut station = Station::speaking(flavour, "drill-hover", 7);
        station.run_ms(100);
        let open = file(&mut station, Opcode::OpenFileRo, 0, 0, b"@PARAM/param.pck?withdefaults=1", 1);
        assert_eq!(open.opcode == ACK, there, "{}", flavour.name);
        if !there {
            continue;
        }
        let size = u32::from_le_bytes(open.sized().unwrap().try_into().unwrap());
        let mut bytes = Vec::new();
        let mut sequence = 3;
        while (bytes.len() as u32) < size {
            let part = file(&mut station, Opcode::ReadFile, open.session, bytes.len() as u32, &[0; 200], sequence);
            assert_eq!(part.opcode, ACK);
            bytes.extend_from_slice(part.sized().unwrap());
            sequence += 2;
        }
        let number = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        assert_eq!((bytes.len() as u32, number(0), number(2)), (size, 0x671c, number(4)));
    }
}

fn file(station: &mut Station, opcode: Opcode, session: u8, offset: u32, data: &[u8], sequence: u16) -> Packet {
    let mut payload = [0u8; 251];
    payload[..2].copy_from_slice(&sequence.to_le_bytes());
    (payload[2], payload[3], payload[4]) = (session, opcode as u8, data.len() as u8);
    payload[8..12].copy_from_slice(&offset.to_le_bytes());
    payload[12..12 + data.len()].copy_from_slice(data);
    let request = FILE_TRANSFER_PROTOCOL_DATA { target_network: 0, target_system: 1, target_component: 1, payload };
    station
        .ask(&MavMessage::FILE_TRANSFER_PROTOCOL(request), |m| match m {
            MavMessage::FILE_TRANSFER_PROTOCOL(answer) => Some(Packet::read(&answer.payload)),
            _ => None,
        })
        .expect("an answer at once")
}

fn item(seq: u16, command: MavCmd, north_m: f64, z: f32) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA {
        seq,
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        x: PAD.0 + (north_m / M_PER_E7) as i32,
        y: PAD.1,
        z,
        target_system: 1,
        target_component: 1,
        autocontinue: 1,
        ..Default::default()
    }
}

/// Sends a mission as it is asked for; the answer at the end.
fn upload(station: &mut Station, items: &[MISSION_ITEM_INT_DATA]) -> MavMissionResult {
    let count = items.len() as u16;
    let mut message =
        MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, target_system: 1, target_component: 1, ..Default::default() });
    loop {
        let answer = station.ask(&message, |m| match m {
            MavMessage::MISSION_REQUEST_INT(r) => Some(Ok(r.seq)),
            MavMessage::MISSION_ACK(ack) => Some(Err(ack.mavtype)),
            _ => None,
        });
        match answer.expect("an answer") {
            Ok(seq) => message = MavMessage::MISSION_ITEM_INT(items[usize::from(seq)].clone()),
            Err(result) => return result,
        }
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
    station.last(|m| if let MavMessage::MISSION_CURRENT(c) = m { Some((c.seq, c.total)) } else { None }).unwrap()
}

#[test]
fn wire_item_0_of_a_copters_mission_is_home_and_all_numbers_count_from_it() {
    let mut station = copter();
    let accepted = MavMissionResult::MAV_MISSION_ACCEPTED;
    let place = MavCmd::MAV_CMD_NAV_WAYPOINT;
    assert_eq!(counted(&mut station), 0);
    assert_eq!(current(&mut station), (0, 0));
    // What stands in item 0 does not count, not even a place that nobody can fly to.
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
    assert!((first.x - PAD.0).abs() < 500 && (first.y - PAD.1).abs() < 500, "home, not what was sent: {first:?}");
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
        MavMessage::MISSION_REQUEST_INT(r) => Some(Ok(r.seq)),
        MavMessage::MISSION_ACK(ack) => Some(Err(ack.mavtype)),
        _ => None,
    };
    let again = MavMessage::MISSION_ITEM_INT(items[3].clone());
    assert_eq!(station.ask(&again, answer), Some(Err(accepted)), "the acknowledgement was lost");
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
    assert_eq!(station.ask(&part(0, 1), answer), Some(Ok(0)), "home, too, though nothing comes of it");
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(items[0].clone()), answer), Some(Ok(1)));
    assert_eq!(station.ask(&MavMessage::MISSION_ITEM_INT(item(1, place, 12.0, 7.0)), answer), Some(Err(accepted)));
    let heights: Vec<f32> = (1..=3).map(|seq| fetch(&mut station, seq).unwrap().z).collect();
    assert_eq!((counted(&mut station), heights), (4, vec![7.0, 6.0, 0.0]));
    assert_eq!(station.ask(&part(3, 4), answer), Some(Err(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE)));
    assert_eq!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one(2.0)), ACCEPTED);
    assert_eq!(current(&mut station), (2, 3));
    assert_ne!(station.command(1, MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, one(4.0)), ACCEPTED);
    assert_eq!(upload(&mut station, &[home]), accepted, "home alone is no mission");
    assert_eq!(counted(&mut station), 0);
    let fence = MISSION_COUNT_DATA {
        count: 1,
        target_system: 1,
        target_component: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..Default::default()
    };
    let asked = station.ask(&MavMessage::MISSION_COUNT(fence), |m| match m {
        MavMessage::MISSION_REQUEST_INT(r) => Some((r.seq, r.mission_type)),
        _ => None,
    });
    assert_eq!(asked, Some((0, MavMissionType::MAV_MISSION_TYPE_FENCE)));
}

#[test]
fn flight_a_copter_flies_its_mission_by_its_own_numbers() {
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
    assert_eq!(station.command(1, ARM, one(1.0)), FAILED, "AUTO is not armable");
    station.command(1, SET_MODE, mode(GUIDED));
    assert_eq!(station.command(1, ARM, one(1.0)), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, one(0.0)), ACCEPTED);
    station.heard.clear();
    let mut reached = Vec::new();
    let landed = station.run_until(240.0, |s| {
        reached.extend(s.all(|m| if let MavMessage::MISSION_ITEM_REACHED(r) = m { Some(r.seq) } else { None }));
        let armed = s.heard.iter().filter_map(|f| f.message.as_ref()).find_map(|m| match m {
            MavMessage::HEARTBEAT(b) if b.mavtype == MavType::MAV_TYPE_QUADROTOR => Some(b.base_mode),
            _ => None,
        });
        s.heard.clear();
        armed.is_some_and(|mode| !mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED))
    });
    assert!(landed, "{reached:?}");
    assert_eq!(reached, [1, 2, 3, 4, 2, 3, 4, 5]);
}

#[test]
fn wire_a_copter_says_nothing_but_heartbeats_until_it_is_asked_and_the_sidecar_is_told_all_the_same() {
    let mut station = Station::speaking(&ardupilot::FLAVOUR, "drill-hover", 7);
    station.run_ms(3_000);
    let unasked: std::collections::BTreeSet<u32> = station.heard.iter().map(|f| f.message_id).collect();
    assert_eq!(unasked.into_iter().collect::<Vec<_>>(), [0], "heartbeats alone");
    let sidecar = LinkId(9);
    station.sim.open_link(sidecar, LinkKind::Payload, false);
    let mut told = std::collections::BTreeSet::new();
    let until = station.sim.now() + spandrel::base::time::SimTime::from_ms(6_000);
    station.sim.handle_timeout(until);
    while let Some(transmit) = station.sim.poll_transmit() {
        if transmit.link == sidecar {
            told.extend(spandrel::mav::codec::Decoder::new().datagram(&transmit.bytes).iter().map(|f| f.message_id));
        } else {
            assert_eq!(transmit.link, GCS);
        }
    }
    for id in [115, 1, 245, 147, 285, 440, 251, 252] {
        assert!(told.contains(&id), "message {id} to the sidecar");
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
    station.heard.clear();
    station.run_ms(2_000);
    let count = |station: &Station, id| station.heard.iter().filter(|f| f.message_id == id).count();
    assert_eq!((count(&station, 33), count(&station, 32), count(&station, 30)), (10, 10, 0), "a group at 5 Hz");
    station.send(&groups(MavDataStream::MAV_DATA_STREAM_ALL, 4, 1));
    station.run_ms(10);
    station.heard.clear();
    station.run_ms(2_000);
    for id in [1, 24, 27, 30, 33, 62, 65, 74, 147] {
        // Sticks are told while somebody has them.
        assert!(id == 65 || count(&station, id) == 8, "message {id}: {}", count(&station, id));
    }
    station.send(&groups(MavDataStream::MAV_DATA_STREAM_ALL, 4, 0));
    station.run_ms(10);
    station.heard.clear();
    station.run_ms(2_000);
    assert!(station.heard.iter().all(|f| f.message_id == 0));
}

#[test]
fn wire_questions_about_what_is_not_spoken_are_answered_as_each_autopilot_does() {
    for (flavour, message, interval) in
        [(&px4::FLAVOUR, DENIED, FAILED), (&ardupilot::FLAVOUR, FAILED, DENIED), (&generic::FLAVOUR, DENIED, FAILED)]
    {
        let mut station = Station::speaking(flavour, "drill-hover", 7);
        station.run_ms(100);
        assert_eq!(station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, one(9_999.0)), message, "{}", flavour.name);
        let often = [9_999.0, 20_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, often), interval, "{}", flavour.name);
    }
}

#[test]
fn flight_a_copters_mode_is_the_pilots_once_sticks_move_and_each_stick_mode_keeps_its_number() {
    let mut station = copter_at(5.0);
    for _ in 0..20 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(50);
    }
    for _ in 0..40 {
        station.sticks(700, 0, 500, 0);
        station.run_ms(50);
    }
    assert_eq!(beat(&station).custom_mode, LOITER as u32, "the pilot took over");
    assert_eq!(station.command(1, SET_MODE, mode(POSHOLD)), ACCEPTED);
    for _ in 0..40 {
        station.sticks(0, 0, 500, 0);
        station.run_ms(50);
    }
    assert_eq!(beat(&station).custom_mode, POSHOLD as u32);
    station.run_ms(5_000);
    let lost = next_beat(&mut station);
    assert_eq!(
        (lost.custom_mode, lost.system_status),
        (BRAKE as u32, MavState::MAV_STATE_CRITICAL),
        "sticks that fall silent are a failsafe"
    );
}
