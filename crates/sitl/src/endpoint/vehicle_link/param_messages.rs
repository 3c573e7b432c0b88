//! Builds PARAM_VALUE messages.

use super::VehicleLink;
use super::params::{HASH_NAME, OutgoingParam};
use spandrel_mavlink::dialect::{MavMessage, MavParamType, PARAM_VALUE_DATA};

/// Creates the PARAM_VALUE message for a parameter.
pub(super) fn param_value(param: OutgoingParam, index: usize, count: u16) -> MavMessage {
    MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: param.wire,
        param_count: count,
        param_index: index as u16,
        param_id: param.name.into(),
        param_type: param.kind,
    })
}

/// Creates PARAM_VALUE by index.
pub(super) fn param_at(v: &VehicleLink, index: Option<usize>) -> Option<MavMessage> {
    let index = index?;
    Some(param_value(v.params.outgoing(index)?, index, v.params.count() as u16))
}

/// Creates PARAM_VALUE by name.
pub(super) fn param_named(v: &VehicleLink, name: &str) -> Option<MavMessage> {
    param_at(v, param_index(v, name))
}

pub(super) fn param_index(v: &VehicleLink, name: &str) -> Option<usize> {
    v.params.find(name).map(|(index, ..)| index)
}

/// Creates PARAM_VALUE with the checksum of all parameters, which is not in the list (PX4: index -1).
pub(super) fn param_hash(v: &VehicleLink) -> MavMessage {
    MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: f32::from_bits(v.params.hash()),
        param_count: v.params.count() as u16,
        param_index: u16::MAX,
        param_id: HASH_NAME.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_UINT32,
    })
}
