//! The PREFLIGHT_STORAGE command, which loads, saves or resets the parameters.

use super::super::VehicleLink;
use super::super::host_requests::StorageRequest;
use super::super::inbound::InboundMessage;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::MavResult;

/// Handles PREFLIGHT_STORAGE. Parameter 1 is 0 to load the file, 1 to save it, and 2 to restore the defaults (MAVLink
/// common).
pub(super) fn preflight_storage(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let request = match c.p[0] {
        0.0 => StorageRequest::Load,
        1.0 => StorageRequest::Save,
        2.0 => {
            if v.params.reset(v.storage.defaults()) {
                v.parameters_changed(a.autopilot, a.payload, a.links);
            }
            return MavResult::MAV_RESULT_ACCEPTED;
        }
        // A value of -1 does nothing.
        -1.0 => return MavResult::MAV_RESULT_ACCEPTED,
        _ => return MavResult::MAV_RESULT_DENIED,
    };
    if !v.storage.has_file {
        v.warn("No parameter file: start with --params FILE");
        return MavResult::MAV_RESULT_DENIED;
    }
    v.storage.request = Some(request);
    MavResult::MAV_RESULT_ACCEPTED
}
