//! Requests for flight logs.

use super::VehicleLink;
use super::inbound::InboundMessage;
use spandrel_mavlink::dialect::{
    LOG_ERASE_DATA, LOG_REQUEST_DATA_DATA, LOG_REQUEST_END_DATA, LOG_REQUEST_LIST_DATA, MavSeverity,
};

pub(super) fn list(v: &mut VehicleLink, r: &LOG_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    v.logs.list(a.link, r.start, r.end);
}

pub(super) fn data(v: &mut VehicleLink, r: &LOG_REQUEST_DATA_DATA, a: &mut InboundMessage) {
    v.logs.read(a.link, r.id, r.ofs, r.count);
}

pub(super) fn end(v: &mut VehicleLink, _: &LOG_REQUEST_END_DATA, a: &mut InboundMessage) {
    v.logs.stop(a.link);
}

/// Erases the logs. Rejected while armed, because the current log would be erased as well.
pub(super) fn erase(v: &mut VehicleLink, _: &LOG_ERASE_DATA, a: &mut InboundMessage) {
    if a.autopilot.status().armed {
        v.push_text(MavSeverity::MAV_SEVERITY_WARNING, "Cannot erase logs while armed");
    } else {
        v.logs.erase();
    }
}
