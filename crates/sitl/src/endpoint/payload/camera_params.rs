//! The camera's settings over PARAM_EXT.

use super::PayloadLink;
use super::camera::settings::{ALL, CameraSetting};
use super::inbound::PayloadMessage;
use crate::endpoint::component_ids::CAMERA;
use mavlink::types::CharArray;
use spandrel_mavlink::dialect::*;

/// The type of every setting.
const SETTING_TYPE: MavParamExtType = MavParamExtType::MAV_PARAM_EXT_TYPE_UINT32;

/// Checks whether the message targets the camera or all components; the autopilot has no extended parameters.
fn is_for_camera(component: u8) -> bool {
    matches!(component, 0 | CAMERA)
}

/// Encodes a value for the wire: little-endian, in the first bytes of the field.
fn bytes(value: u32) -> CharArray<128> {
    let mut data = [0; 128];
    data[..4].copy_from_slice(&value.to_le_bytes());
    data.into()
}

fn value(p: &PayloadLink, index: usize, setting: &CameraSetting) -> MavMessage {
    MavMessage::PARAM_EXT_VALUE(PARAM_EXT_VALUE_DATA {
        param_count: ALL.len() as u16,
        param_index: index as u16,
        param_id: setting.name.into(),
        param_value: bytes(setting.value(&p.equipment.camera)),
        param_type: SETTING_TYPE,
    })
}

pub(super) fn list(p: &mut PayloadLink, m: &PARAM_EXT_REQUEST_LIST_DATA, a: &mut PayloadMessage) {
    if is_for_camera(m.target_component) {
        for (index, setting) in ALL.iter().enumerate() {
            let message = value(p, index, setting);
            a.answer(&message);
        }
    }
}

/// Sends a setting by index, or by name if the index is -1.
pub(super) fn read(p: &mut PayloadLink, m: &PARAM_EXT_REQUEST_READ_DATA, a: &mut PayloadMessage) {
    if !is_for_camera(m.target_component) {
        return;
    }
    let name = m.param_id.to_str().unwrap_or_default();
    let found = match usize::try_from(m.param_index) {
        Ok(index) => ALL.get(index).map(|setting| (index, setting)),
        Err(_) => CameraSetting::named(name),
    };
    let message = match found {
        Some((index, setting)) => value(p, index, setting),
        None => MavMessage::PARAM_ERROR(PARAM_ERROR_DATA {
            param_index: m.param_index,
            target_system: a.from.0,
            target_component: a.from.1,
            param_id: name.into(),
            error: MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
        }),
    };
    a.answer(&message);
}

/// Changes a setting. The acknowledgment contains the resulting value; a change is broadcast on every link.
pub(super) fn set(p: &mut PayloadLink, m: &PARAM_EXT_SET_DATA, a: &mut PayloadMessage) {
    if !is_for_camera(m.target_component) {
        return;
    }
    let [first, second, third, fourth, ..] = *m.param_value;
    let requested = u32::from_le_bytes([first, second, third, fourth]);
    let found = CameraSetting::named(m.param_id.to_str().unwrap_or_default());
    let done = match found {
        Some((_, setting)) if m.param_type == SETTING_TYPE => {
            setting.change(&mut p.equipment.camera, requested).map_err(|refusal| {
                refusal.text().map_or(ParamAck::PARAM_ACK_VALUE_UNSUPPORTED, |text| {
                    p.equipment.changes.add_warning(text);
                    ParamAck::PARAM_ACK_FAILED
                })
            })
        }
        Some(_) => Err(ParamAck::PARAM_ACK_VALUE_UNSUPPORTED),
        None => Err(ParamAck::PARAM_ACK_FAILED),
    };
    let now = found.map_or(0, |(_, setting)| setting.value(&p.equipment.camera));
    let acknowledgement = MavMessage::PARAM_EXT_ACK(PARAM_EXT_ACK_DATA {
        param_id: m.param_id,
        param_value: bytes(now),
        param_type: SETTING_TYPE,
        param_result: done.err().unwrap_or(ParamAck::PARAM_ACK_ACCEPTED),
    });
    a.answer(&acknowledgement);
    if let (Ok(()), Some((index, setting))) = (done, found) {
        let message = value(p, index, setting);
        a.links.broadcast(CAMERA, &message);
    }
}

/// Rejects a PARAM_EXT_SET with a type that MAVLink does not define.
pub(super) fn unknown_type(payload: &[u8], a: &mut PayloadMessage) {
    let mut param_id = [0; 16];
    param_id.copy_from_slice(&payload[2..18]);
    let refusal = MavMessage::PARAM_EXT_ACK(PARAM_EXT_ACK_DATA {
        param_id: param_id.into(),
        param_value: bytes(0),
        param_type: SETTING_TYPE,
        param_result: ParamAck::PARAM_ACK_VALUE_UNSUPPORTED,
    });
    a.answer(&refusal);
}
