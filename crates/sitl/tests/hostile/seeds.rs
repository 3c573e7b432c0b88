//! One or more valid messages of every type that the vehicle handles, as starting points for mutation.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use mavlink::Message;
use spandrel_mavlink::dialect::*;
use spandrel_model::random::RandomStream;

const NAN: f32 = f32::NAN;
/// Origin of the practice lake, the site of the job that these tests fly, in 1e-7 degrees.
pub const ORIGIN_E7: (i32, i32) = (467_052_000, 83_814_000);

pub fn all(number: u32) -> Vec<MavMessage> {
    let mut out = messages(number);
    // Adds the codec's default message, addressed to the vehicle.
    out.extend(MavMessage::default_message_from_id(number));
    // Only the camera has extended parameters.
    let camera = (320..=324).contains(&number);
    for message in &mut out {
        if let Some(system) = message.target_system_id_mut() {
            *system = 1;
        }
        if let Some(component) = message.target_component_id_mut() {
            *component = if camera { 100 } else { 1 };
        }
    }
    out
}

/// Returns handwritten messages; the test that counts them fails if there are none.
pub fn messages(number: u32) -> Vec<MavMessage> {
    let made = [connection(), files(), sticks(), setpoints(), gimbal(), parameters(), plans(), partial_plans(), commands()];
    made.into_iter().flatten().filter(|m| m.message_id() == number).collect()
}

fn connection() -> Vec<MavMessage> {
    vec![
        MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavtype: MavType::MAV_TYPE_GCS, mavlink_version: 3, ..Default::default() }),
        MavMessage::FOLLOW_TARGET(FOLLOW_TARGET_DATA {
            est_capabilities: 3,
            lat: ORIGIN_E7.0 + 900,
            lon: ORIGIN_E7.1,
            alt: 440.0,
            vel: [1.5, 0.0, 0.0],
            ..Default::default()
        }),
        MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
            lat: ORIGIN_E7.0,
            lon: ORIGIN_E7.1 + 900,
            alt: 440_000,
            vy: 150,
            hdg: 9_000,
            ..Default::default()
        }),
        {
            let mut data = [0; 70];
            data[..15].copy_from_slice(b"param show MIS*");
            data[15] = b'\n';
            MavMessage::SERIAL_CONTROL(SERIAL_CONTROL_DATA {
                device: SerialControlDev::SERIAL_CONTROL_DEV_SHELL,
                flags: SerialControlFlag::SERIAL_CONTROL_FLAG_RESPOND,
                count: 16,
                data,
                ..Default::default()
            })
        },
        MavMessage::REQUEST_EVENT(REQUEST_EVENT_DATA { first_sequence: 1, last_sequence: 3, ..Default::default() }),
        MavMessage::TIMESYNC(TIMESYNC_DATA { ts1: 123_456, ..Default::default() }),
        MavMessage::PING(PING_DATA { seq: 7, ..Default::default() }),
        MavMessage::TERRAIN_CHECK(TERRAIN_CHECK_DATA { lat: 470_000_000, lon: 80_000_000 }),
        MavMessage::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA { req_message_rate: 4, start_stop: 1, ..Default::default() }),
        MavMessage::LOG_REQUEST_LIST(LOG_REQUEST_LIST_DATA { end: u16::MAX, ..Default::default() }),
        MavMessage::VIDEO_STREAM_STATUS(VIDEO_STREAM_STATUS_DATA {
            framerate: 25.0,
            bitrate: 3_000_000,
            flags: VideoStreamStatusFlags::VIDEO_STREAM_STATUS_FLAGS_RUNNING,
            resolution_h: 1280,
            resolution_v: 720,
            stream_id: 1,
            ..Default::default()
        }),
        MavMessage::LOG_REQUEST_END(LOG_REQUEST_END_DATA::default()),
        MavMessage::LOG_ERASE(LOG_ERASE_DATA::default()),
        MavMessage::LOG_REQUEST_DATA(LOG_REQUEST_DATA_DATA { count: 90, ..Default::default() }),
    ]
}

/// Returns a request for each file service operation, and one for an unknown operation.
fn files() -> Vec<MavMessage> {
    let request = |opcode| {
        let mut payload = [0; 251];
        (payload[0], payload[3]) = (opcode, opcode);
        let data: &[u8] = if opcode == 13 { b"/log/a\0/log/b" } else { b"/log/a" };
        payload[4] = data.len() as u8;
        payload[12..12 + data.len()].copy_from_slice(data);
        MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA { payload, ..Default::default() })
    };
    let packed = |data: &[u8]| {
        let mut payload = [0; 251];
        (payload[0], payload[3], payload[4]) = (99, 4, data.len() as u8);
        payload[12..12 + data.len()].copy_from_slice(data);
        MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA { payload, ..Default::default() })
    };
    let mut out: Vec<MavMessage> = (0..=16).map(request).collect();
    out.push(packed(b"@PARAM/param.pck?withdefaults=1&start=3&count=70"));
    out
}

fn sticks() -> Vec<MavMessage> {
    let custom = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
    vec![
        MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { x: 400, y: -300, z: 700, r: 100, ..Default::default() }),
        MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { z: 500, ..Default::default() }),
        MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
            chan1_raw: 1500,
            chan2_raw: 1400,
            chan3_raw: 1700,
            chan4_raw: 1500,
            ..Default::default()
        }),
        MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: 3 << 16, ..Default::default() }),
        MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: 6 << 16, ..Default::default() }),
        // Copter's LOITER and GUIDED modes.
        MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: 5, base_mode: custom, ..Default::default() }),
        MavMessage::SET_MODE(SET_MODE_DATA { custom_mode: 4, base_mode: custom, ..Default::default() }),
    ]
}

fn setpoints() -> Vec<MavMessage> {
    use PositionTargetTypemask as P;
    let only_position = P::from_bits_retain(0b0000_1101_1111_1000);
    let only_velocity = P::from_bits_retain(0b0000_1101_1100_0111);
    let local = |coordinate_frame, type_mask| {
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            coordinate_frame,
            type_mask,
            x: 3.0,
            y: 2.0,
            z: -8.0,
            vx: 1.0,
            vy: -1.0,
            vz: 0.2,
            ..Default::default()
        })
    };
    let attitude = |type_mask| {
        MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
            q: [1.0, 0.05, 0.0, 0.0],
            thrust: 0.5,
            body_roll_rate: 0.1,
            type_mask: AttitudeTargetTypemask::from_bits_retain(type_mask),
            ..Default::default()
        })
    };
    vec![
        local(MavFrame::MAV_FRAME_LOCAL_NED, only_position),
        local(MavFrame::MAV_FRAME_LOCAL_NED, P::empty()),
        local(MavFrame::MAV_FRAME_BODY_NED, only_velocity),
        MavMessage::SET_POSITION_TARGET_GLOBAL_INT(SET_POSITION_TARGET_GLOBAL_INT_DATA {
            coordinate_frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
            type_mask: only_position,
            lat_int: ORIGIN_E7.0,
            lon_int: ORIGIN_E7.1,
            alt: 10.0,
            ..Default::default()
        }),
        attitude(0),
        attitude(128),
    ]
}

fn gimbal() -> Vec<MavMessage> {
    vec![
        MavMessage::GIMBAL_MANAGER_SET_ATTITUDE(GIMBAL_MANAGER_SET_ATTITUDE_DATA {
            flags: GimbalManagerFlags::empty(),
            q: [0.9, 0.0, 0.3, 0.0],
            angular_velocity_y: NAN,
            ..Default::default()
        }),
        MavMessage::GIMBAL_MANAGER_SET_PITCHYAW(GIMBAL_MANAGER_SET_PITCHYAW_DATA {
            flags: GimbalManagerFlags::empty(),
            pitch: -0.5,
            ..Default::default()
        }),
        MavMessage::GIMBAL_MANAGER_SET_PITCHYAW(GIMBAL_MANAGER_SET_PITCHYAW_DATA {
            flags: GimbalManagerFlags::empty(),
            pitch: NAN,
            pitch_rate: 0.3,
            ..Default::default()
        }),
        MavMessage::GIMBAL_DEVICE_SET_ATTITUDE(GIMBAL_DEVICE_SET_ATTITUDE_DATA {
            flags: GimbalDeviceFlags::empty(),
            q: [0.9, 0.0, -0.3, 0.0],
            angular_velocity_y: 0.2,
            ..Default::default()
        }),
        MavMessage::GIMBAL_MANAGER_SET_MANUAL_CONTROL(GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA {
            flags: GimbalManagerFlags::empty(),
            pitch: NAN,
            pitch_rate: -0.5,
            ..Default::default()
        }),
    ]
}

fn parameters() -> Vec<MavMessage> {
    let set = |name: &str, param_value, param_type| {
        MavMessage::PARAM_SET(PARAM_SET_DATA { param_value, param_id: name.into(), param_type, ..Default::default() })
    };
    let real = MavParamType::MAV_PARAM_TYPE_REAL32;
    vec![
        MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA::default()),
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index: -1,
            param_id: "NAV_RCL_ACT".into(),
            ..Default::default()
        }),
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA { param_index: 5, ..Default::default() }),
        MavMessage::PARAM_EXT_REQUEST_LIST(PARAM_EXT_REQUEST_LIST_DATA::default()),
        MavMessage::PARAM_EXT_REQUEST_READ(PARAM_EXT_REQUEST_READ_DATA {
            param_index: -1,
            param_id: "CAM_VIDRATE".into(),
            ..Default::default()
        }),
        MavMessage::PARAM_EXT_SET(PARAM_EXT_SET_DATA {
            param_id: "CAM_PHOTOQUAL".into(),
            param_value: "\u{1}".into(),
            param_type: MavParamExtType::MAV_PARAM_EXT_TYPE_UINT32,
            ..Default::default()
        }),
        set("MIS_TAKEOFF_ALT", 5.0, real),
        set("MPC_XY_VEL_MAX", 4.0, real),
        set("WPNAV_SPEED", 400.0, real),
        set("RTL_ALT", 2_000.0, MavParamType::MAV_PARAM_TYPE_INT32),
        set("FS_GCS_ENABLE", 5.0, MavParamType::MAV_PARAM_TYPE_INT8),
        set("COM_RC_LOSS_T", 1.0, real),
        set("NAV_DLL_ACT", f32::from_bits(2), MavParamType::MAV_PARAM_TYPE_INT32),
    ]
}

/// Returns a mission item for a short flight around the origin.
pub fn item(seq: u16) -> MISSION_ITEM_INT_DATA {
    let command = match seq {
        0 => MavCmd::MAV_CMD_NAV_TAKEOFF,
        1 => MavCmd::MAV_CMD_NAV_WAYPOINT,
        2 => MavCmd::MAV_CMD_DO_CHANGE_SPEED,
        3 => MavCmd::MAV_CMD_IMAGE_START_CAPTURE,
        _ => MavCmd::MAV_CMD_DO_JUMP,
    };
    let jump = command == MavCmd::MAV_CMD_DO_JUMP;
    MISSION_ITEM_INT_DATA {
        param1: if jump { 1.0 } else { 0.0 },
        param2: 3.0,
        param3: 1.0,
        param4: NAN,
        x: ORIGIN_E7.0 + i32::from(seq) * 500,
        y: ORIGIN_E7.1,
        z: 8.0,
        seq,
        command,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
        autocontinue: 1,
        ..Default::default()
    }
}

/// Returns an item without a position: a takeoff or landing at the vehicle's current position.
pub fn item_without_position(seq: u16) -> MISSION_ITEM_INT_DATA {
    let command = if seq == 0 { MavCmd::MAV_CMD_NAV_TAKEOFF } else { MavCmd::MAV_CMD_NAV_LAND };
    MISSION_ITEM_INT_DATA { command, x: 0, y: 0, ..item(seq) }
}

/// Returns a corner of a triangle around the origin.
pub fn corner(seq: u16) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA {
        command: MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION,
        param1: 3.0,
        x: ORIGIN_E7.0 + [-9_000, 9_000, 9_000][usize::from(seq) % 3],
        y: ORIGIN_E7.1 + [0, -9_000, 9_000][usize::from(seq) % 3],
        z: 0.0,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..item(seq)
    }
}

pub fn count_fence(count: u16) -> MavMessage {
    let mission_type = MavMissionType::MAV_MISSION_TYPE_FENCE;
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, mission_type, ..Default::default() })
}

pub fn count(count: u16) -> MavMessage {
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, ..Default::default() })
}

fn plans() -> Vec<MavMessage> {
    let mut out: Vec<MavMessage> = (0..5).map(|seq| MavMessage::MISSION_ITEM_INT(item(seq))).collect();
    out.extend((0..2).map(|seq| MavMessage::MISSION_ITEM_INT(item_without_position(seq))));
    out.extend([1, 2, 5].map(count));
    out.push(MavMessage::MISSION_ITEM(MISSION_ITEM_DATA {
        x: 46.7052,
        y: 8.3814,
        z: 9.0,
        command: MavCmd::MAV_CMD_NAV_WAYPOINT,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        ..Default::default()
    }));
    out.push(MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA { current: 2, ..item(1) }));
    out.push(MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA::default()));
    out.push(MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA { seq: 1, ..Default::default() }));
    out.push(MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA { seq: 1, ..Default::default() }));
    out.push(MavMessage::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA { seq: 1, ..Default::default() }));
    out
}

fn partial_plans() -> Vec<MavMessage> {
    vec![
        MavMessage::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA::default()),
        MavMessage::MISSION_ACK(MISSION_ACK_DATA::default()),
        MavMessage::MISSION_REQUEST_PARTIAL_LIST(MISSION_REQUEST_PARTIAL_LIST_DATA::default()),
        MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA::default()),
    ]
}

fn commands() -> Vec<MavMessage> {
    let long = |command, p: [f32; 7]| {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command,
            param1: p[0],
            param2: p[1],
            param3: p[2],
            param4: p[3],
            param5: p[4],
            param6: p[5],
            param7: p[6],
            ..Default::default()
        })
    };
    vec![
        long(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 4.0, 4.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0]),
        long(MavCmd::MAV_CMD_DO_SET_MODE, [1.0, 17.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_NAV_TAKEOFF, [-1.0, 0.0, 0.0, NAN, NAN, NAN, NAN]),
        long(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_SET_CAMERA_MODE, [0.0, 1.0, NAN, NAN, NAN, NAN, NAN]),
        long(MavCmd::MAV_CMD_VIDEO_START_CAPTURE, [0.0, 1.0, 0.0, NAN, NAN, NAN, NAN]),
        long(MavCmd::MAV_CMD_STORAGE_FORMAT, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, [-2.0, -2.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        long(MavCmd::MAV_CMD_DO_MOUNT_CONTROL, [-30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]),
        long(MavCmd::MAV_CMD_DO_REPEAT_RELAY, [0.0, 3.0, 0.5, 0.0, 0.0, 0.0, 0.0]),
        long(MavCmd::MAV_CMD_REQUEST_MESSAGE, [435.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        MavMessage::COMMAND_INT(COMMAND_INT_DATA {
            command: MavCmd::MAV_CMD_DO_REPOSITION,
            param1: 2.0,
            param4: NAN,
            x: ORIGIN_E7.0,
            y: ORIGIN_E7.1,
            z: 12.0,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            ..Default::default()
        }),
    ]
}

/// Returns a command with any number and parameters that are often small integers, as in real commands.
pub fn command(number: u16, stream: &mut RandomStream) -> (u32, Vec<u8>) {
    // Message requests, mostly for messages that the vehicle sends.
    let spoken = &spandrel_sitl::endpoint::streams::STREAMS;
    let asks = matches!(number, 510..=512) && stream.below(4) > 0;
    let whole = stream.below(3) > 0;
    let id = if whole { 76 } else { 75 };
    let mut payload = vec![0; if whole { 33 } else { 35 }];
    for k in 0..7 {
        let value = match stream.below(7) {
            _ if asks && k == 0 && stream.below(4) > 0 => spoken[stream.below(spoken.len())].id as f32,
            _ if asks && k == 0 => 435.0,
            0 => 0.0,
            1 => 1.0,
            2 => NAN,
            3 => stream.below(5) as f32,
            4 => stream.range(-100.0, 100.0) as f32,
            5 => stream.range(-1e9, 1e9) as f32,
            _ => -1.0,
        };
        payload[4 * k..4 * k + 4].copy_from_slice(&value.to_le_bytes());
    }
    payload[28..30].copy_from_slice(&number.to_le_bytes());
    payload[30] = 1;
    payload[31] = [0, 1, 100][stream.below(3)];
    (id, payload)
}
