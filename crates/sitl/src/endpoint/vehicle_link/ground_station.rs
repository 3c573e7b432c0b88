//! The ground station: its heartbeats, and whether it may send stick input.

use super::VehicleLink;
use super::inbound::InboundMessage;
use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavType};

pub(super) fn heartbeat(v: &mut VehicleLink, beat: &HEARTBEAT_DATA, a: &mut InboundMessage) {
    if beat.mavtype == MavType::MAV_TYPE_GCS && is_accepted_station(v, a) {
        a.autopilot.record_ground_station_heartbeat(a.now());
    }
}

/// Checks whether the sender is the configured ground station, if a parameter specifies one.
pub(super) fn is_accepted_station(v: &VehicleLink, a: &InboundMessage) -> bool {
    v.params.ground_station().is_none_or(|system| system == a.from.0)
}
