//! The camera's settings by name and number, and the file that describes them.

use spandrel_mavlink::dialect::*;
use spandrel_mavlink::ftp::{ACK, FtpPacket, NAK, Opcode};
use spandrel_testkit::station::Station;

const CAMERA: u8 = 100;
const UINT32: MavParamExtType = MavParamExtType::MAV_PARAM_EXT_TYPE_UINT32;

fn on_the_pad() -> Station {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    station
}

fn number(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

/// Returns the name, value, index and count of each reported setting.
fn announced(station: &Station) -> Vec<(String, u32, u16, u16)> {
    station.all(|m| match m {
        MavMessage::PARAM_EXT_VALUE(v) => {
            Some((v.param_id.to_str().unwrap().to_owned(), number(&v.param_value[..]), v.param_index, v.param_count))
        }
        _ => None,
    })
}

fn ask(station: &mut Station, message: &MavMessage) {
    station.received.clear();
    station.send(message);
    station.run_ms(5);
}

fn list(target_component: u8) -> MavMessage {
    MavMessage::PARAM_EXT_REQUEST_LIST(PARAM_EXT_REQUEST_LIST_DATA { target_system: 1, target_component })
}

fn read(name: &str, param_index: i16) -> MavMessage {
    MavMessage::PARAM_EXT_REQUEST_READ(PARAM_EXT_REQUEST_READ_DATA {
        param_index,
        param_id: name.into(),
        target_system: 1,
        target_component: CAMERA,
    })
}

/// Returns the result and the value in the acknowledgment.
fn set(station: &mut Station, name: &str, value: u32, param_type: MavParamExtType) -> (ParamAck, u32) {
    let mut data = [0; 128];
    data[..4].copy_from_slice(&value.to_le_bytes());
    let message = MavMessage::PARAM_EXT_SET(PARAM_EXT_SET_DATA {
        target_system: 1,
        target_component: CAMERA,
        param_id: name.into(),
        param_value: data.into(),
        param_type,
    });
    ask(station, &message);
    let ack = station.last_message(|m| match m {
        MavMessage::PARAM_EXT_ACK(a) if a.param_id.to_str() == Ok(name) => Some((a.param_result, number(&a.param_value[..]))),
        _ => None,
    });
    ack.unwrap_or_else(|| panic!("no acknowledgment of {name}"))
}

#[test]
fn wire_only_the_camera_lists_and_changes_its_settings() {
    use ParamAck as A;
    let mut station = on_the_pad();
    ask(&mut station, &list(1));
    assert!(announced(&station).is_empty(), "the autopilot must not have camera settings");
    let delivered = [("CAM_PHOTOQUAL", 1), ("CAM_VIDRATE", 60)];
    for component in [CAMERA, 0] {
        ask(&mut station, &list(component));
        let expected = delivered.iter().zip(0..).map(|((name, value), k)| ((*name).to_owned(), *value, k, 2));
        assert_eq!(announced(&station), expected.collect::<Vec<_>>());
        assert!(station.received.iter().filter(|f| f.message_id == 322).all(|f| f.component_id == CAMERA));
    }
    for message in [read("CAM_VIDRATE", -1), read("", 1)] {
        ask(&mut station, &message);
        assert_eq!(announced(&station), [("CAM_VIDRATE".to_owned(), 60, 1, 2)]);
    }
    for message in [read("CAM_NONE", -1), read("", 2)] {
        ask(&mut station, &message);
        let error = station.last_message(|m| if let MavMessage::PARAM_ERROR(e) = m { Some(e.error) } else { None });
        assert_eq!(error, Some(MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST));
    }
    assert_eq!(set(&mut station, "CAM_VIDRATE", 80, UINT32), (A::PARAM_ACK_ACCEPTED, 80));
    assert_eq!(announced(&station), [("CAM_VIDRATE".to_owned(), 80, 1, 2)], "the change must be broadcast");
    for (name, value, kind, result) in [
        ("CAM_VIDRATE", 85, UINT32, (A::PARAM_ACK_VALUE_UNSUPPORTED, 80)),
        ("CAM_VIDRATE", 110, UINT32, (A::PARAM_ACK_VALUE_UNSUPPORTED, 80)),
        ("CAM_VIDRATE", 50, MavParamExtType::MAV_PARAM_EXT_TYPE_REAL32, (A::PARAM_ACK_VALUE_UNSUPPORTED, 80)),
        ("CAM_NONE", 1, UINT32, (A::PARAM_ACK_FAILED, 0)),
        ("CAM_PHOTOQUAL", 0, UINT32, (A::PARAM_ACK_ACCEPTED, 0)),
    ] {
        assert_eq!(set(&mut station, name, value, kind), result, "{name} {value}");
    }
    station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_MODE, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_START_CAPTURE, [0.0; 7]);
    assert_eq!(
        set(&mut station, "CAM_VIDRATE", 20, UINT32),
        (A::PARAM_ACK_FAILED, 80),
        "the setting must not change while recording"
    );
    station.command(CAMERA, MavCmd::MAV_CMD_VIDEO_STOP_CAPTURE, [0.0; 7]);
    station.command(CAMERA, MavCmd::MAV_CMD_RESET_CAMERA_SETTINGS, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    ask(&mut station, &list(CAMERA));
    assert_eq!(
        announced(&station).iter().map(|setting| setting.1).collect::<Vec<_>>(),
        [1, 60],
        "a reset must restore the defaults"
    );
}

fn transfer(
    station: &mut Station,
    component: u8,
    opcode: Opcode,
    (session, offset): (u8, u32),
    data: &[u8],
    size: u8,
) -> FtpPacket {
    let mut all = [0; spandrel_mavlink::ftp::DATA_MAX];
    all[..data.len()].copy_from_slice(data);
    let sequence = (station.sim.now().ms() % 60_000) as u16;
    let request =
        FtpPacket { sequence, session, opcode: opcode as u8, size, request: 0, burst_complete: false, offset, data: all };
    ask(
        station,
        &MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: 1,
            target_component: component,
            payload: request.write(),
        }),
    );
    let answer = station.received.iter().filter(|frame| frame.component_id == component).find_map(|frame| match &frame.message {
        Some(MavMessage::FILE_TRANSFER_PROTOCOL(f)) => Some(FtpPacket::read(&f.payload)),
        _ => None,
    });
    answer.unwrap_or_else(|| panic!("no response to {opcode:?}"))
}

#[test]
fn wire_camera_serves_only_its_definition_file() {
    let mut station = on_the_pad();
    station.command(CAMERA, MavCmd::MAV_CMD_REQUEST_MESSAGE, [259.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let uri = station.last_message(|m| match m {
        MavMessage::CAMERA_INFORMATION(i) => Some(i.cam_definition_uri.to_str().unwrap().to_owned()),
        _ => None,
    });
    let uri = uri.unwrap();
    let path = uri.strip_prefix("mftp://").unwrap();
    let opened = transfer(&mut station, CAMERA, Opcode::OpenFileRo, (0, 0), path.as_bytes(), path.len() as u8);
    assert_eq!(opened.opcode, ACK);
    let size = number(&opened.data);
    let mut file = Vec::new();
    while (file.len() as u32) < size {
        let part = transfer(&mut station, CAMERA, Opcode::ReadFile, (opened.session, file.len() as u32), &[], 200);
        assert_eq!(part.opcode, ACK);
        file.extend_from_slice(part.data_in_use().unwrap());
    }
    let xml = String::from_utf8(file).unwrap();
    assert!(xml.starts_with("<?xml") && xml.trim_end().ends_with("</mavlinkcamera>"), "{xml}");
    for setting in ["CAM_PHOTOQUAL", "CAM_VIDRATE"] {
        assert!(xml.contains(&format!("<parameter name=\"{setting}\" type=\"uint32\"")), "{setting}");
    }
    // Uses the path as QGroundControl parses it.
    let rooted = transfer(&mut station, CAMERA, Opcode::OpenFileRo, (0, 0), b"/camera.xml", 11);
    assert_eq!((rooted.opcode, number(&rooted.data)), (ACK, size));
    for (component, path) in [(CAMERA, "/etc/extras/parameter.json.xz"), (CAMERA, "../camera"), (1, "camera.xml")] {
        let refused = transfer(&mut station, component, Opcode::OpenFileRo, (0, 0), path.as_bytes(), path.len() as u8);
        assert_eq!(refused.opcode, NAK, "{component} {path}");
    }
}
