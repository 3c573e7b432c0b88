//! Time synchronization, pings and stream groups.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::VehicleLink;
use super::inbound::InboundMessage;
use spandrel_mavlink::dialect::{MavMessage, PING_DATA, REQUEST_DATA_STREAM_DATA, TIMESYNC_DATA};

pub(super) fn timesync(_: &mut VehicleLink, sync: &TIMESYNC_DATA, a: &mut InboundMessage) {
    // A response to another system's request.
    if sync.tc1 != 0 {
        return;
    }
    let Some(link) = a.links.get(a.link) else { return };
    a.answer(&a.aircraft.clock.for_link(link.kind).time_response(sync, a.from));
}

/// Answers a ping request. A ping without a target is a request; one with a target is a response.
pub(super) fn ping(_: &mut VehicleLink, ping: &PING_DATA, a: &mut InboundMessage) {
    if ping.target_system == 0 {
        let (target_system, target_component) = a.from;
        a.answer(&MavMessage::PING(PING_DATA { target_system, target_component, ..ping.clone() }));
    }
}

/// Handles the superseded request for message groups (Mission Planner, MAVProxy).
pub(super) fn data_stream(v: &mut VehicleLink, r: &REQUEST_DATA_STREAM_DATA, a: &mut InboundMessage) {
    let now = a.now();
    let Some(link) = a.links.get_mut(a.link) else { return };
    let requested = r.req_stream_id as u8;
    let stop = r.start_stop == 0 || r.req_message_rate == 0;
    let us = if stop { -1.0 } else { 1e6 / f64::from(r.req_message_rate) };
    for (_, ids) in v.flavor.groups.iter().filter(|(group, _)| requested == 0 || *group == requested) {
        ids.iter().for_each(|id| link.streams.set_message_interval(*id, us, now));
    }
}
