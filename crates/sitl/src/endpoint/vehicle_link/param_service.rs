//! Handles parameter requests.

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::param_messages::{param_at, param_hash, param_index, param_named};
use super::params::{HASH_NAME, ParamRefusal};
use spandrel_mavlink::dialect::{
    MavMessage, MavParamError, PARAM_ERROR_DATA, PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA,
};

/// Queues the whole list, which is sent in parts over several ticks. The checksum is sent first, so that a station with
/// up-to-date values can stop the list. Flavors with a banner also send the banner.
pub(super) fn list(v: &mut VehicleLink, _: &PARAM_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    if v.flavor.params.hash {
        let hash = param_hash(v);
        a.answer(&hash);
    }
    v.flavor.banner.iter().for_each(|line| v.inform(line));
    v.param_lists.insert(a.link, (0..v.params.count()).collect());
}

pub(super) fn read(v: &mut VehicleLink, r: &PARAM_REQUEST_READ_DATA, a: &mut InboundMessage) {
    let name = r.param_id.to_str().unwrap_or_default();
    let index = usize::try_from(r.param_index).ok().or_else(|| param_index(v, name));
    let message = match param_at(v, index) {
        Some(message) => message,
        None if is_param_hash(v, name) => param_hash(v),
        None => param_error(a.from, name, r.param_index, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST),
    };
    a.answer(&message);
}

fn is_param_hash(v: &VehicleLink, name: &str) -> bool {
    v.flavor.params.hash && name == HASH_NAME
}

/// Changes a parameter. A change is broadcast to every link; a rejection is reported, followed by the old value as
/// older clients expect.
pub(super) fn set(v: &mut VehicleLink, set: &PARAM_SET_DATA, a: &mut InboundMessage) {
    let name = set.param_id.to_str().unwrap_or_default();
    if is_param_hash(v, name) {
        v.param_lists.remove(&a.link);
        return;
    }
    v.sync_fence_parameter(a.autopilot.tuning.fence_enabled, a.links);
    match v.params.set(name, set.param_value, set.param_type) {
        Err(refusal) => {
            let error = match refusal {
                ParamRefusal::Unknown => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
                ParamRefusal::OutOfRange => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
                ParamRefusal::Type => MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH,
                ParamRefusal::ReadOnly => MavParamError::MAV_PARAM_ERROR_READ_ONLY,
            };
            reject_param(v, name, error, a);
        }
        Ok(()) => v.parameter_changed(name, a),
    }
}

fn reject_param(v: &mut VehicleLink, name: &str, error: MavParamError, a: &mut InboundMessage) {
    let message = param_error(a.from, name, -1, error);
    a.answer(&message);
    if let Some(message) = param_named(v, name) {
        a.answer(&message);
    }
}

/// Rejects a PARAM_SET with a type that MAVLink does not define.
pub(super) fn unknown_type(v: &mut VehicleLink, name: &[u8], a: &mut InboundMessage) {
    let name = name.split(|byte| *byte == 0).next().unwrap_or_default();
    reject_param(v, std::str::from_utf8(name).unwrap_or_default(), MavParamError::MAV_PARAM_ERROR_TYPE_UNSUPPORTED, a);
}

fn param_error(to: (u8, u8), name: &str, index: i16, error: MavParamError) -> MavMessage {
    MavMessage::PARAM_ERROR(PARAM_ERROR_DATA {
        param_index: index,
        target_system: to.0,
        target_component: to.1,
        param_id: name.into(),
        error,
    })
}
