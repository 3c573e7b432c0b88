//! Request handlers for parameters, plans, stream groups, time synchronization and logs.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::Endpoint;
use super::ardupilot_items;
use super::inbound::InboundMessage;
use super::mission::{ItemEncoding, PlanReply, ack};
use super::params::{HASH, OutgoingParam, ParamRefusal};
use super::snapshot::VehicleSnapshot;
use super::streams::{self, AUTOPILOT};
use crate::autopilot::Autopilot;
use mavlink::MessageData;
use spandrel_mavlink::dialect::*;

const MISSION_ACK: u32 = 47;

/// Creates the PARAM_VALUE message of a parameter.
pub(super) fn param_value(told: OutgoingParam, index: usize, count: u16) -> MavMessage {
    MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: told.wire,
        param_count: count,
        param_index: index as u16,
        param_id: told.name.into(),
        param_type: told.kind,
    })
}

/// Creates PARAM_VALUE by index.
fn param_at(e: &Endpoint, index: Option<usize>) -> Option<MavMessage> {
    let index = index?;
    Some(param_value(e.params.outgoing(index)?, index, e.params.count() as u16))
}

/// Creates PARAM_VALUE by name.
pub(super) fn param_named(e: &Endpoint, name: &str) -> Option<MavMessage> {
    param_at(e, param_index(e, name))
}

fn param_index(e: &Endpoint, name: &str) -> Option<usize> {
    e.params.find(name).map(|(index, ..)| index)
}

/// Creates PARAM_VALUE with the checksum of all parameters, which is not in the list (PX4: index -1).
fn param_hash(e: &Endpoint) -> MavMessage {
    MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: f32::from_bits(e.params.hash()),
        param_count: e.params.count() as u16,
        param_index: u16::MAX,
        param_id: HASH.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_UINT32,
    })
}

/// Queues the whole list, sent in parts over several ticks. The checksum is sent first, so that a station that knows all values
/// can stop the list; flavours with a banner send it, too.
pub(super) fn param_list(e: &mut Endpoint, _: &PARAM_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    if e.flavour.params.hash {
        let hash = param_hash(e);
        e.answer(a.link, &hash);
    }
    for line in e.flavour.banner {
        e.push_text(MavSeverity::MAV_SEVERITY_INFO, line);
    }
    e.param_lists.insert(a.link, (0..e.params.count()).collect());
}

pub(super) fn param_read(e: &mut Endpoint, r: &PARAM_REQUEST_READ_DATA, a: &mut InboundMessage) {
    let name = r.param_id.to_str().unwrap_or_default();
    let index = usize::try_from(r.param_index).ok().or_else(|| param_index(e, name));
    let message = match param_at(e, index) {
        Some(message) => message,
        None if is_param_hash(e, name) => param_hash(e),
        None => param_error(a.from, name, r.param_index, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST),
    };
    e.answer(a.link, &message);
}

fn is_param_hash(e: &Endpoint, name: &str) -> bool {
    e.flavour.params.hash && name == HASH
}

/// Changes a parameter. A change is broadcast to every link; a rejection is reported, followed by the old value as older clients
/// expect.
pub(super) fn param_set(e: &mut Endpoint, set: &PARAM_SET_DATA, a: &mut InboundMessage) {
    let name = set.param_id.to_str().unwrap_or_default();
    if is_param_hash(e, name) {
        e.param_lists.remove(&a.link);
        return;
    }
    e.note_fence_switch(a.autopilot.tuning.fence_enabled);
    match e.params.set(name, set.param_value, set.param_type) {
        Err(refusal) => {
            let error = match refusal {
                ParamRefusal::Unknown => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
                ParamRefusal::OutOfRange => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
                ParamRefusal::Type => MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH,
                ParamRefusal::ReadOnly => MavParamError::MAV_PARAM_ERROR_READ_ONLY,
            };
            refuse_param(e, name, error, a);
        }
        Ok(()) => {
            e.apply_parameters(a.autopilot);
            if let Some(message) = param_named(e, name) {
                e.broadcast(AUTOPILOT, &message);
            }
        }
    }
}

fn refuse_param(e: &mut Endpoint, name: &str, error: MavParamError, a: &InboundMessage) {
    e.answer(a.link, &param_error(a.from, name, -1, error));
    if let Some(message) = param_named(e, name) {
        e.answer(a.link, &message);
    }
}

/// Rejects a PARAM_SET with a type that MAVLink does not define.
pub(super) fn unknown_type(e: &mut Endpoint, name: &[u8], a: &InboundMessage) {
    let name = name.split(|byte| *byte == 0).next().unwrap_or_default();
    refuse_param(e, std::str::from_utf8(name).unwrap_or_default(), MavParamError::MAV_PARAM_ERROR_TYPE_UNSUPPORTED, a);
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

pub(super) fn mission_list(e: &mut Endpoint, r: &MISSION_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    let message = e.plans.list(a.from, r.mission_type);
    e.answer(a.link, &message);
}

pub(super) fn mission_item_int(e: &mut Endpoint, r: &MISSION_REQUEST_INT_DATA, a: &mut InboundMessage) {
    let message = plan_item(e, r.mission_type, r.seq, a);
    e.answer(a.link, &message);
}

/// Answers the superseded request in the current form, as MAVLink requires, or in the older one, as ArduPilot's clients expect.
pub(super) fn mission_item(e: &mut Endpoint, r: &MISSION_REQUEST_DATA, a: &mut InboundMessage) {
    let message = match plan_item(e, r.mission_type, r.seq, a) {
        MavMessage::MISSION_ITEM_INT(item) if e.flavour.float_items => {
            MavMessage::MISSION_ITEM(ardupilot_items::in_degrees(&item))
        }
        other => other,
    };
    e.answer(a.link, &message);
}

fn plan_item(e: &Endpoint, kind: MavMissionType, seq: u16, a: &InboundMessage) -> MavMessage {
    if e.plans.is_home(kind, seq) { ardupilot_items::home_item(a.view, a.from) } else { e.plans.item(a.from, kind, seq) }
}

pub(super) fn mission_count(e: &mut Endpoint, c: &MISSION_COUNT_DATA, a: &mut InboundMessage) {
    let reply = e.plans.begin(a.from, c.mission_type, c.count, a.view.now);
    apply_plan_reply(e, reply, a);
}

pub(super) fn mission_receive_int(e: &mut Endpoint, item: &MISSION_ITEM_INT_DATA, a: &mut InboundMessage) {
    e.plans.note_form(a.from, ItemEncoding::Int);
    receive_item(e, item, a);
}

fn receive_item(e: &mut Endpoint, item: &MISSION_ITEM_INT_DATA, a: &mut InboundMessage) {
    if e.flavour.errands.is_some() && ardupilot_items::is_fly_now_item(item) {
        let result = ardupilot_items::fly_now(e, item, a);
        e.answer(a.link, &ack(a.from, item.mission_type, result));
        return;
    }
    let reply = e.plans.receive(a.from, item, a.view.plane, a.view.now);
    apply_plan_reply(e, reply, a);
}

/// Handles an item with floating-point degrees, from clients without MISSION_ITEM_INT.
pub(super) fn mission_receive(e: &mut Endpoint, item: &MISSION_ITEM_DATA, a: &mut InboundMessage) {
    let scaled = |degrees: f32| if degrees.is_finite() { (f64::from(degrees) * 1e7).round() as i32 } else { i32::MAX };
    let whole = MISSION_ITEM_INT_DATA {
        param1: item.param1,
        param2: item.param2,
        param3: item.param3,
        param4: item.param4,
        x: scaled(item.x),
        y: scaled(item.y),
        z: item.z,
        seq: item.seq,
        command: item.command,
        target_system: item.target_system,
        target_component: item.target_component,
        frame: item.frame,
        current: item.current,
        autocontinue: item.autocontinue,
        mission_type: item.mission_type,
    };
    e.plans.note_form(a.from, ItemEncoding::Float);
    receive_item(e, &whole, a);
}

pub(super) fn mission_clear(e: &mut Endpoint, c: &MISSION_CLEAR_ALL_DATA, a: &mut InboundMessage) {
    let reply = e.plans.clear(a.from, c.mission_type);
    apply_plan_reply(e, reply, a);
}

/// Handles MISSION_ACK. An uploader that does not support the requested encoding rejects it, and the request is repeated in the
/// other one (as in PX4).
pub(super) fn mission_ack(e: &mut Endpoint, m: &MISSION_ACK_DATA, a: &mut InboundMessage) {
    if m.mavtype != MavMissionResult::MAV_MISSION_UNSUPPORTED {
        e.plans.acknowledged(a.from);
    } else if let Some(question) = e.plans.switch_encoding(a.from, a.view.now) {
        e.answer(a.link, &question);
    }
}

/// Changes the current item; rejects an invalid one. MISSION_CURRENT is broadcast in either case.
pub(super) fn mission_set_current(e: &mut Endpoint, c: &MISSION_SET_CURRENT_DATA, a: &mut InboundMessage) {
    if !a.autopilot.set_mission_current(usize::from(c.seq.saturating_sub(a.view.plans.lead)), false) {
        let result = MavMissionResult::MAV_MISSION_INVALID_SEQUENCE;
        let refusal = ack(a.from, MavMissionType::MAV_MISSION_TYPE_MISSION, result);
        e.answer(a.link, &refusal);
    }
    let now = super::snapshot::VehicleSnapshot { status: a.autopilot.status(), ..*a.view };
    for (_, row) in streams::rows_of(MISSION_CURRENT_DATA::ID) {
        if let Some(message) = row.build(&now) {
            e.broadcast(AUTOPILOT, &message);
        }
    }
}

/// Rejects a partial list request: MAVLink does not define the response, and no autopilot supports it.
pub(super) fn mission_request_partial(e: &mut Endpoint, r: &MISSION_REQUEST_PARTIAL_LIST_DATA, a: &mut InboundMessage) {
    let refusal = ack(a.from, r.mission_type, MavMissionResult::MAV_MISSION_UNSUPPORTED);
    e.answer(a.link, &refusal);
}

pub(super) fn mission_write_partial(e: &mut Endpoint, w: &MISSION_WRITE_PARTIAL_LIST_DATA, a: &mut InboundMessage) {
    let reply = e.plans.begin_part(a.from, w.mission_type, (w.start_index, w.end_index), a.view.now);
    apply_plan_reply(e, reply, a);
}

/// Rejects an upload with an item of a command, frame or plan type that MAVLink does not define.
pub(super) fn unknown_item(e: &mut Endpoint, mission_type: u8, a: &mut InboundMessage) {
    match e.plans.receive_unknown(a.from) {
        PlanReply::Nothing => unknown_plan(e, mission_type, a),
        reply @ (PlanReply::Say(_) | PlanReply::New(..)) => apply_plan_reply(e, reply, a),
    }
}

/// Rejects a request for an unknown plan type.
pub(super) fn unknown_plan(e: &mut Endpoint, mission_type: u8, a: &InboundMessage) {
    let refusal = [a.from.0, a.from.1, MavMissionResult::MAV_MISSION_UNSUPPORTED as u8, mission_type];
    if let Some(link) = e.links.get_mut(&a.link) {
        link.send_payload(AUTOPILOT, MISSION_ACK, &refusal);
    }
}

fn apply_plan_reply(e: &mut Endpoint, reply: PlanReply, a: &mut InboundMessage) {
    match reply {
        PlanReply::Say(message) => e.answer(a.link, &message),
        PlanReply::New(kind, message) => {
            update_autopilot_plan(e, kind, a.view, a.autopilot);
            e.answer(a.link, &message);
            if kind == MavMissionType::MAV_MISSION_TYPE_FENCE && e.plans.has_fence_return() {
                e.push_text(
                    MavSeverity::MAV_SEVERITY_INFO,
                    "Fence return point not used: a breach returns home or to a rally point",
                );
            }
        }
        PlanReply::Nothing => {}
    }
}

/// Passes changed plans to the autopilot.
pub(super) fn update_autopilot_plan(e: &mut Endpoint, kind: MavMissionType, view: &VehicleSnapshot, autopilot: &mut Autopilot) {
    let is = |one| kind == one || kind == MavMissionType::MAV_MISSION_TYPE_ALL;
    let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
    if is(MavMissionType::MAV_MISSION_TYPE_MISSION) {
        autopilot.set_mission(e.plans.steps(view.plane, view.status.home_m));
        autopilot.set_deferred_fields(e.plans.deferred_fields());
        autopilot.set_home_relative_steps(e.plans.home_relative_steps());
    }
    if is(MavMissionType::MAV_MISSION_TYPE_FENCE) {
        autopilot.set_fence(e.plans.zones(view.plane));
    }
    if is(MavMissionType::MAV_MISSION_TYPE_RALLY) {
        autopilot.set_rally_points(e.plans.rally_points(view.plane, home_up));
    }
}

pub(super) fn timesync(e: &mut Endpoint, sync: &TIMESYNC_DATA, a: &mut InboundMessage) {
    // A response to somebody else's request.
    if sync.tc1 != 0 {
        return;
    }
    let (target_system, target_component) = a.from;
    let Some(link) = e.links.get(&a.link) else { return };
    // Uses the same clock as the timestamps of our messages, so that clients can convert them.
    let tc1 = a.view.for_link(link.kind).since_boot(a.view.now).ns().max(1);
    e.answer(a.link, &MavMessage::TIMESYNC(TIMESYNC_DATA { tc1, ts1: sync.ts1, target_system, target_component }));
}

/// Answers a ping request. A ping without a target is a request, one with a target is a response.
pub(super) fn ping(e: &mut Endpoint, ping: &PING_DATA, a: &mut InboundMessage) {
    if ping.target_system == 0 {
        let (target_system, target_component) = a.from;
        e.answer(a.link, &MavMessage::PING(PING_DATA { target_system, target_component, ..ping.clone() }));
    }
}

/// Handles the superseded request for message groups (Mission Planner, MAVProxy).
pub(super) fn data_stream(e: &mut Endpoint, r: &REQUEST_DATA_STREAM_DATA, a: &mut InboundMessage) {
    let Some(link) = e.links.get_mut(&a.link) else { return };
    let wanted = r.req_stream_id as u8;
    let stop = r.start_stop == 0 || r.req_message_rate == 0;
    let us = if stop { -1.0 } else { 1e6 / f64::from(r.req_message_rate) };
    for (_, ids) in e.flavour.groups.iter().filter(|(group, _)| wanted == 0 || *group == wanted) {
        for (row, _) in ids.iter().flat_map(|id| streams::rows_of(*id)) {
            link.set_interval(row, us, a.view.now);
        }
    }
}

pub(super) fn log_list(e: &mut Endpoint, r: &LOG_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    e.logs.list(a.link, r.start, r.end);
}

pub(super) fn log_data(e: &mut Endpoint, r: &LOG_REQUEST_DATA_DATA, a: &mut InboundMessage) {
    e.logs.read(a.link, r.id, r.ofs, r.count);
}

pub(super) fn log_end(e: &mut Endpoint, _: &LOG_REQUEST_END_DATA, a: &mut InboundMessage) {
    e.logs.stop(a.link);
}

/// Erases the logs; rejected while armed because the current log is among them.
pub(super) fn log_erase(e: &mut Endpoint, _: &LOG_ERASE_DATA, a: &mut InboundMessage) {
    if a.view.status.armed {
        e.push_text(MavSeverity::MAV_SEVERITY_WARNING, "Cannot erase logs while armed");
    } else {
        e.logs.erase();
    }
}
