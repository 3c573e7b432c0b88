//! Mission protocol requests.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::mission::{ItemEncoding, PlanReply, ack, ardupilot_items};
use super::streams::system;
use crate::autopilot::Autopilot;
use crate::endpoint::component_ids::AUTOPILOT;
use spandrel_mavlink::dialect::*;
use spandrel_model::geodesy::LocalPlane;

const MISSION_ACK: u32 = 47;

pub(super) fn list(v: &mut VehicleLink, r: &MISSION_REQUEST_LIST_DATA, a: &mut InboundMessage) {
    let message = v.plans.list(a.from, r.mission_type);
    a.answer(&message);
}

pub(super) fn item_int(v: &mut VehicleLink, r: &MISSION_REQUEST_INT_DATA, a: &mut InboundMessage) {
    let message = plan_item(v, r.mission_type, r.seq, a);
    a.answer(&message);
}

/// Answers the superseded request in the current form, as MAVLink requires, or in the older one, as ArduPilot's clients
/// expect.
pub(super) fn item(v: &mut VehicleLink, r: &MISSION_REQUEST_DATA, a: &mut InboundMessage) {
    let message = match plan_item(v, r.mission_type, r.seq, a) {
        MavMessage::MISSION_ITEM_INT(item) if v.flavor.uses_float_items => {
            MavMessage::MISSION_ITEM(ardupilot_items::in_degrees(&item))
        }
        other => other,
    };
    a.answer(&message);
}

fn plan_item(v: &VehicleLink, kind: MavMissionType, seq: u16, a: &InboundMessage) -> MavMessage {
    if v.plans.is_home(kind, seq) { ardupilot_items::home_item(a) } else { v.plans.item(a.from, kind, seq) }
}

pub(super) fn count(v: &mut VehicleLink, c: &MISSION_COUNT_DATA, a: &mut InboundMessage) {
    let reply = v.plans.begin(a.from, c.mission_type, c.count, a.now());
    apply_plan_reply(v, reply, a);
}

pub(super) fn receive_int(v: &mut VehicleLink, item: &MISSION_ITEM_INT_DATA, a: &mut InboundMessage) {
    v.plans.use_encoding_of(a.from, ItemEncoding::Int);
    receive_item(v, item, a);
}

fn receive_item(v: &mut VehicleLink, item: &MISSION_ITEM_INT_DATA, a: &mut InboundMessage) {
    if v.flavor.goto_mode.is_some() && ardupilot_items::is_fly_now_item(item) {
        let result = ardupilot_items::fly_now(v, item, a);
        let message = ack(a.from, item.mission_type, result);
        a.answer(&message);
        return;
    }
    let reply = v.plans.receive(a.from, item, a.aircraft.plane, a.now());
    apply_plan_reply(v, reply, a);
}

/// Handles an item with floating-point degrees, from clients that do not support MISSION_ITEM_INT.
pub(super) fn receive(v: &mut VehicleLink, item: &MISSION_ITEM_DATA, a: &mut InboundMessage) {
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
    v.plans.use_encoding_of(a.from, ItemEncoding::Float);
    receive_item(v, &whole, a);
}

pub(super) fn clear(v: &mut VehicleLink, c: &MISSION_CLEAR_ALL_DATA, a: &mut InboundMessage) {
    let reply = v.plans.clear(a.from, c.mission_type);
    apply_plan_reply(v, reply, a);
}

/// Handles MISSION_ACK. An uploader that does not support the requested encoding rejects it, and the request is
/// repeated in the other one (as in PX4).
pub(super) fn acknowledgement(v: &mut VehicleLink, m: &MISSION_ACK_DATA, a: &mut InboundMessage) {
    if m.mavtype != MavMissionResult::MAV_MISSION_UNSUPPORTED {
        v.plans.acknowledged(a.from);
    } else if let Some(question) = v.plans.switch_encoding(a.from, a.now()) {
        a.answer(&question);
    }
}

/// Changes the current item; rejects an invalid one. MISSION_CURRENT is broadcast in either case.
pub(super) fn set_current(v: &mut VehicleLink, c: &MISSION_SET_CURRENT_DATA, a: &mut InboundMessage) {
    if !a.autopilot.set_mission_current(usize::from(c.seq.saturating_sub(v.plans.summary().lead)), false) {
        let result = MavMissionResult::MAV_MISSION_INVALID_SEQUENCE;
        let refusal = ack(a.from, MavMissionType::MAV_MISSION_TYPE_MISSION, result);
        a.answer(&refusal);
    }
    if let Some(message) = system::mission_current(&a.view(v)) {
        a.broadcast(&message);
    }
}

/// Rejects a partial list request: MAVLink does not define the response, and no autopilot supports it.
pub(super) fn request_partial(_: &mut VehicleLink, r: &MISSION_REQUEST_PARTIAL_LIST_DATA, a: &mut InboundMessage) {
    let refusal = ack(a.from, r.mission_type, MavMissionResult::MAV_MISSION_UNSUPPORTED);
    a.answer(&refusal);
}

pub(super) fn write_partial(v: &mut VehicleLink, w: &MISSION_WRITE_PARTIAL_LIST_DATA, a: &mut InboundMessage) {
    let reply = v.plans.begin_partial(a.from, w.mission_type, (w.start_index, w.end_index), a.now());
    apply_plan_reply(v, reply, a);
}

/// Rejects an upload that contains an item with a command, frame or plan type that MAVLink does not define.
pub(super) fn unknown_item(v: &mut VehicleLink, mission_type: u8, a: &mut InboundMessage) {
    match v.plans.receive_undefined_item(a.from) {
        PlanReply::Nothing => unknown_plan(mission_type, a),
        reply @ (PlanReply::Reply(_) | PlanReply::Updated(..)) => apply_plan_reply(v, reply, a),
    }
}

/// Rejects a request for an unknown plan type.
pub(super) fn unknown_plan(mission_type: u8, a: &mut InboundMessage) {
    let refusal = [a.from.0, a.from.1, MavMissionResult::MAV_MISSION_UNSUPPORTED as u8, mission_type];
    if let Some(link) = a.links.get_mut(a.link) {
        link.send_payload(AUTOPILOT, MISSION_ACK, &refusal);
    }
}

fn apply_plan_reply(v: &mut VehicleLink, reply: PlanReply, a: &mut InboundMessage) {
    match reply {
        PlanReply::Reply(message) => a.answer(&message),
        PlanReply::Updated(kind, message) => {
            v.update_autopilot_plan(kind, a.aircraft.plane, a.autopilot);
            a.answer(&message);
            if kind == MavMissionType::MAV_MISSION_TYPE_FENCE && v.plans.has_fence_return() {
                v.push_text(
                    MavSeverity::MAV_SEVERITY_INFO,
                    "Fence return point not used: after a breach, the vehicle returns to home or a rally point",
                );
            }
        }
        PlanReply::Nothing => {}
    }
}

impl VehicleLink {
    /// Passes changed plans to the autopilot.
    pub(super) fn update_autopilot_plan(&mut self, kind: MavMissionType, plane: &LocalPlane, autopilot: &mut Autopilot) {
        let is = |one| kind == one || kind == MavMissionType::MAV_MISSION_TYPE_ALL;
        let home_m = autopilot.status().home_m;
        if is(MavMissionType::MAV_MISSION_TYPE_MISSION) {
            autopilot.set_mission(self.plans.steps(plane, home_m));
            autopilot.set_deferred_fields(self.plans.deferred_fields());
            autopilot.set_home_relative_steps(self.plans.home_relative_steps());
        }
        if is(MavMissionType::MAV_MISSION_TYPE_FENCE) {
            autopilot.set_fence(self.plans.zones(plane));
        }
        if is(MavMissionType::MAV_MISSION_TYPE_RALLY) {
            autopilot.set_rally_points(self.plans.rally_points(plane, home_m.map_or(0.0, |home| -home.down())));
        }
    }
}
