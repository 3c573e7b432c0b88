//! What comes in: routing first, then what is meant for us.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::commands::{self, Command};
use super::mission::Reply;
use super::params::{Refusal, Value};
use super::streams::{AUTOPILOT, CAMERA};
use super::view::View;
use super::{Context, Endpoint, LinkId, px4};
use crate::base::frames::Rotation;
use crate::mav::codec::Received;
use crate::mav::dialect::{
    FILE_TRANSFER_PROTOCOL_DATA, MavMessage, MavMissionResult, MavMissionType, MavParamError, MavParamType, MavType,
    PARAM_ERROR_DATA, PARAM_SET_DATA, PARAM_VALUE_DATA, PING_DATA, PositionTargetTypemask, SET_ATTITUDE_TARGET_DATA,
    SET_POSITION_TARGET_GLOBAL_INT_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA, TIMESYNC_DATA,
};
use crate::mav::{router, units};
use crate::sitl::autopilot::{Autopilot, OffboardSetpoint, Outcome, Request};

/// Messages of MAVLink whose bodies an unknown number makes unreadable.
const SET_MODE: u32 = 11;
const MISSION_ITEM_INT: u32 = 73;
const COMMAND_ACK: u32 = 77;

/// PARAM_VALUE of one parameter.
pub(super) fn param_value(name: &str, value: Value, index: usize, count: u16) -> MavMessage {
    let param_type = match value {
        Value::Int(_) => MavParamType::MAV_PARAM_TYPE_INT32,
        Value::Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
    };
    MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: value.to_wire(),
        param_count: count,
        param_index: index as u16,
        param_id: name.into(),
        param_type,
    })
}

impl Endpoint {
    /// Reads a datagram of a link. Returns the tokens of lockstep answers that it held.
    pub fn receive(&mut self, id: LinkId, bytes: &[u8], view: &View, autopilot: &mut Autopilot) -> Vec<i64> {
        let Some(link) = self.links.get_mut(&id) else { return Vec::new() };
        let before = link.decoder.bad_bytes();
        let frames = link.decoder.datagram(bytes);
        self.bad_bytes += link.decoder.bad_bytes() - before;
        let mut answers = Vec::new();
        for frame in frames {
            if let Some(MavMessage::TIMESYNC(sync)) = &frame.message
                && sync.tc1 != 0
            {
                answers.push(sync.ts1);
                continue;
            }
            self.route(id, &frame);
            if self.meant_for_us(&frame) {
                self.act(id, &frame, view, autopilot);
            }
        }
        answers
    }

    fn route(&mut self, from: LinkId, frame: &Received) {
        self.router.note(from, frame);
        // Nobody may speak in our own components' names.
        if frame.system_id == self.system_id && matches!(frame.component_id, AUTOPILOT | CAMERA) {
            return;
        }
        let all: Vec<LinkId> = self.links.keys().copied().collect();
        for onward in self.router.onward(from, frame, &all) {
            if let Some(link) = self.links.get_mut(&onward) {
                link.queue(frame.bytes.clone());
            }
        }
    }

    fn meant_for_us(&self, frame: &Received) -> bool {
        let (system, component) = router::target(frame);
        let ours = system == 0 || system == self.system_id;
        ours && matches!(component, 0 | AUTOPILOT | CAMERA)
    }

    fn act(&mut self, id: LinkId, frame: &Received, view: &View, autopilot: &mut Autopilot) {
        if let Some(command) = Command::of(frame) {
            self.command(id, &command, view, autopilot);
            return;
        }
        let from = (frame.system_id, frame.component_id);
        match &frame.message {
            Some(message) => self.message(id, from, message, view, autopilot),
            None if frame.message_id == SET_MODE => self.set_mode(&frame.payload(6), view, autopilot),
            None if frame.message_id == MISSION_ITEM_INT => {
                let reply = self.plans.receive_unknown(from);
                self.reply(id, reply, view, autopilot);
            }
            None => {}
        }
    }

    fn command(&mut self, id: LinkId, command: &Command, view: &View, autopilot: &mut Autopilot) {
        let Some(link) = self.links.get_mut(&id) else { return };
        let mut context = Context { view: *view, autopilot, payload: &mut self.payload, link, texts: &mut self.texts };
        let result = commands::handle(command, &mut context);
        let component = if command.component == CAMERA { CAMERA } else { AUTOPILOT };
        let number = command.number.to_le_bytes();
        // Laid out by hand: the number may be one that the dialect does not know.
        let payload = [number[0], number[1], result as u8, 0, 0, 0, 0, 0, command.from.0, command.from.1];
        if let Some(link) = self.links.get_mut(&id) {
            link.send_payload(component, COMMAND_ACK, &payload);
        }
    }

    fn message(&mut self, id: LinkId, from: (u8, u8), message: &MavMessage, view: &View, autopilot: &mut Autopilot) {
        let now = view.now;
        match message {
            MavMessage::HEARTBEAT(beat) if beat.mavtype == MavType::MAV_TYPE_GCS => autopilot.ground_station_alive(now),
            MavMessage::MANUAL_CONTROL(m) if m.target == self.system_id || m.target == 0 => {
                self.manual.manual_control(from, m, now).into_iter().for_each(|sticks| autopilot.sticks(sticks, now));
            }
            MavMessage::RC_CHANNELS_OVERRIDE(c) => {
                self.manual.channels(from, c, now).into_iter().for_each(|sticks| autopilot.sticks(sticks, now));
            }
            MavMessage::SET_MODE(m) => self.enter_mode(m.custom_mode, view, autopilot),
            MavMessage::SET_POSITION_TARGET_LOCAL_NED(t) => local_target(t).into_iter().for_each(|s| autopilot.offboard(s, now)),
            MavMessage::SET_POSITION_TARGET_GLOBAL_INT(t) => {
                global_target(t, view).into_iter().for_each(|s| autopilot.offboard(s, now));
            }
            MavMessage::SET_ATTITUDE_TARGET(t) => attitude_target(t).into_iter().for_each(|s| autopilot.offboard(s, now)),
            MavMessage::TIMESYNC(sync) => self.answer(id, &timesync(sync, from, view)),
            MavMessage::PING(ping) if ping.target_system == 0 => self.answer(id, &pong(ping, from)),
            MavMessage::FILE_TRANSFER_PROTOCOL(request) => self.answer(id, &ftp_refusal(request, from)),
            MavMessage::REQUEST_DATA_STREAM(r) => {
                self.data_stream(id, r.req_stream_id as u8, r.req_message_rate, r.start_stop, view)
            }
            other => self.protocol(id, from, other, view, autopilot),
        }
    }

    /// Parameters and plans.
    fn protocol(&mut self, id: LinkId, from: (u8, u8), message: &MavMessage, view: &View, autopilot: &mut Autopilot) {
        let reply = match message {
            MavMessage::PARAM_REQUEST_LIST(_) => {
                self.param_lists.insert(id, (0..self.params.count()).collect());
                return;
            }
            MavMessage::PARAM_REQUEST_READ(r) => {
                let name = r.param_id.to_str().unwrap_or_default().to_string();
                return self.read_param(id, from, r.param_index, &name);
            }
            MavMessage::PARAM_SET(set) => return self.set_param(id, from, set, autopilot),
            MavMessage::MISSION_REQUEST_LIST(r) => Reply::Say(self.plans.list(from, r.mission_type)),
            MavMessage::MISSION_REQUEST_INT(r) => Reply::Say(self.plans.item(from, r.mission_type, r.seq)),
            MavMessage::MISSION_REQUEST(r) => Reply::Say(self.plans.item(from, r.mission_type, r.seq)),
            MavMessage::MISSION_COUNT(c) => self.plans.begin(from, c.mission_type, c.count, view.now),
            MavMessage::MISSION_ITEM_INT(item) => self.plans.receive(from, item, view.plane, view.now),
            MavMessage::MISSION_CLEAR_ALL(c) => self.plans.clear(from, c.mission_type),
            MavMessage::MISSION_ACK(_) => {
                self.plans.acknowledged(from);
                return;
            }
            MavMessage::MISSION_SET_CURRENT(c) => {
                if !autopilot.set_mission_current(usize::from(c.seq)) {
                    let result = MavMissionResult::MAV_MISSION_INVALID_SEQUENCE;
                    let nack = super::mission::ack(from, MavMissionType::MAV_MISSION_TYPE_MISSION, result);
                    return self.answer(id, &nack);
                }
                return;
            }
            _ => return,
        };
        self.reply(id, reply, view, autopilot);
    }

    fn reply(&mut self, id: LinkId, reply: Reply, view: &View, autopilot: &mut Autopilot) {
        match reply {
            Reply::Say(message) => self.answer(id, &message),
            Reply::NewMission(message) => {
                let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
                autopilot.set_mission(self.plans.steps(view.plane, home_up, autopilot.tuning.accept_radius_m));
                self.payload.camera.mission_items = self.plans.mission().len() as u16;
                self.answer(id, &message);
            }
            Reply::Nothing => {}
        }
    }

    fn answer(&mut self, id: LinkId, message: &MavMessage) {
        if let Some(link) = self.links.get_mut(&id) {
            link.send(AUTOPILOT, message);
        }
    }

    fn set_mode(&mut self, payload: &[u8], view: &View, autopilot: &mut Autopilot) {
        let custom = u32::from_le_bytes([payload[0], payload[1], payload[2], payload[3]]);
        self.enter_mode(custom, view, autopilot);
    }

    /// SET_MODE has no acknowledgement: a refusal becomes a text.
    fn enter_mode(&mut self, custom_mode: u32, view: &View, autopilot: &mut Autopilot) {
        use crate::mav::dialect::MavSeverity;
        let outcome = match px4::from_custom_mode(custom_mode) {
            Some(mode) => autopilot.request(Request::SetMode(mode), view.now),
            None => Outcome::Denied(format!("No such mode: {custom_mode}")),
        };
        if let Outcome::TemporarilyRejected(reason) | Outcome::Denied(reason) | Outcome::Failed(reason) = outcome {
            self.tell(MavSeverity::MAV_SEVERITY_WARNING, &reason);
        }
    }

    fn read_param(&mut self, id: LinkId, from: (u8, u8), index: i16, name: &str) {
        let count = self.params.count() as u16;
        let found = match usize::try_from(index) {
            Ok(index) => self.params.at(index).map(|(name, value)| (index, name, value)),
            Err(_) => self.params.find(name),
        };
        let message = match found {
            Some((index, name, value)) => param_value(name, value, index, count),
            None => param_error(from, name, index, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST),
        };
        self.answer(id, &message);
    }

    /// A change is told to every link; a refusal is named, and the old value is sent as older clients expect.
    fn set_param(&mut self, id: LinkId, from: (u8, u8), set: &PARAM_SET_DATA, autopilot: &mut Autopilot) {
        let name = set.param_id.to_str().unwrap_or_default().to_string();
        let real = set.param_type == MavParamType::MAV_PARAM_TYPE_REAL32;
        let outcome = self.params.set(&name, set.param_value, real);
        let count = self.params.count() as u16;
        let found = self.params.find(&name);
        if let Err(refusal) = outcome {
            let error = match refusal {
                Refusal::Unknown => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
                Refusal::OutOfRange => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
                Refusal::Type => MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH,
                Refusal::ReadOnly => MavParamError::MAV_PARAM_ERROR_READ_ONLY,
            };
            self.answer(id, &param_error(from, &name, -1, error));
            if let Some((index, name, value)) = found {
                self.answer(id, &param_value(name, value, index, count));
            }
            return;
        }
        self.params.apply(&mut autopilot.tuning);
        if let Some((index, name, value)) = found {
            let message = param_value(name, value, index, count);
            self.broadcast(AUTOPILOT, &message);
        }
    }

    /// The legacy way of asking for rates: groups of messages (Mission Planner, MAVProxy).
    fn data_stream(&mut self, id: LinkId, group: u8, rate_hz: u16, start: u8, view: &View) {
        const GROUPS: [(u8, &[u32]); 7] = [
            (1, &[24, 29, 105]),
            (2, &[1, 147, 230, 42, 24]),
            (3, &[65, 36]),
            (6, &[33, 32]),
            (10, &[30, 31]),
            (11, &[74]),
            (12, &[2, 242, 231]),
        ];
        let Some(link) = self.links.get_mut(&id) else { return };
        let us = if start == 0 || rate_hz == 0 { -1.0 } else { 1e6 / f64::from(rate_hz) };
        for (_, ids) in GROUPS.iter().filter(|(g, _)| group == 0 || *g == group) {
            for (row, _) in ids.iter().flat_map(|id| super::streams::rows_of(*id)) {
                link.set_interval(row, us, view.now);
            }
        }
    }
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

fn timesync(sync: &TIMESYNC_DATA, from: (u8, u8), view: &View) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA {
        tc1: view.now.ns().max(1),
        ts1: sync.ts1,
        target_system: from.0,
        target_component: from.1,
    })
}

fn pong(ping: &PING_DATA, from: (u8, u8)) -> MavMessage {
    MavMessage::PING(PING_DATA { target_system: from.0, target_component: from.1, ..ping.clone() })
}

/// No files are served: every request is refused at once (opcode 129 NAK, error 2 FailErrno's plain sibling 1 Fail), so that clients go on.
fn ftp_refusal(request: &FILE_TRANSFER_PROTOCOL_DATA, from: (u8, u8)) -> MavMessage {
    const NAK: u8 = 129;
    const FILE_NOT_FOUND: u8 = 10;
    let mut payload = [0u8; 251];
    let sequence = u16::from_le_bytes([request.payload[0], request.payload[1]]).wrapping_add(1).to_le_bytes();
    payload[..2].copy_from_slice(&sequence);
    payload[2] = request.payload[2];
    payload[3] = NAK;
    payload[4] = 1;
    payload[5] = request.payload[3];
    payload[12] = FILE_NOT_FOUND;
    MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system: from.0,
        target_component: from.1,
        payload,
    })
}

/// What a mask leaves of three axes; `None` when a wanted value is no number.
fn axes(values: [f32; 3], ignored: [bool; 3]) -> Option<[Option<f64>; 3]> {
    let mut out = [None; 3];
    for k in 0..3 {
        if !ignored[k] {
            if !values[k].is_finite() || values[k].abs() > 1e5 {
                return None;
            }
            out[k] = Some(f64::from(values[k]));
        }
    }
    Some(out)
}

fn mask(m: PositionTargetTypemask) -> ([bool; 3], [bool; 3], bool, bool) {
    use PositionTargetTypemask as P;
    (
        [P::POSITION_TARGET_TYPEMASK_X_IGNORE, P::POSITION_TARGET_TYPEMASK_Y_IGNORE, P::POSITION_TARGET_TYPEMASK_Z_IGNORE]
            .map(|f| m.contains(f)),
        [P::POSITION_TARGET_TYPEMASK_VX_IGNORE, P::POSITION_TARGET_TYPEMASK_VY_IGNORE, P::POSITION_TARGET_TYPEMASK_VZ_IGNORE]
            .map(|f| m.contains(f)),
        m.contains(P::POSITION_TARGET_TYPEMASK_YAW_IGNORE),
        m.contains(P::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE),
    )
}

fn number(value: f32, ignored: bool) -> Option<f64> {
    (!ignored && value.is_finite()).then(|| f64::from(value))
}

fn local_target(t: &SET_POSITION_TARGET_LOCAL_NED_DATA) -> Option<OffboardSetpoint> {
    use crate::mav::dialect::MavFrame;
    if t.coordinate_frame != MavFrame::MAV_FRAME_LOCAL_NED {
        return None;
    }
    let (p, v, yaw, rate) = mask(t.type_mask);
    Some(OffboardSetpoint {
        position_m: axes([t.x, t.y, t.z], p)?,
        velocity_m_s: axes([t.vx, t.vy, t.vz], v)?,
        yaw_rad: number(t.yaw, yaw),
        yaw_rate_rad_s: number(t.yaw_rate, rate),
        attitude: None,
    })
}

fn global_target(t: &SET_POSITION_TARGET_GLOBAL_INT_DATA, view: &View) -> Option<OffboardSetpoint> {
    use crate::mav::dialect::MavFrame as F;
    let (p, v, yaw, rate) = mask(t.type_mask);
    let origin = view.plane.origin();
    let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
    let relative = matches!(t.coordinate_frame, F::MAV_FRAME_GLOBAL_RELATIVE_ALT | F::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT);
    let altitude = f64::from(t.alt) + if relative { origin.altitude_m + home_up } else { 0.0 };
    let geo = units::geo(t.lat_int, t.lon_int, altitude).filter(|_| altitude.is_finite());
    let position_m = match geo.map(|g| view.plane.enu_from_geo(g)) {
        Some(enu) if enu.norm() < 20_000.0 => {
            let ned = enu.ned().array();
            [0, 1, 2].map(|k: usize| (!p[k]).then_some(ned[k]))
        }
        _ if p == [true; 3] => [None; 3],
        _ => return None,
    };
    Some(OffboardSetpoint {
        position_m,
        velocity_m_s: axes([t.vx, t.vy, t.vz], v)?,
        yaw_rad: number(t.yaw, yaw),
        yaw_rate_rad_s: number(t.yaw_rate, rate),
        attitude: None,
    })
}

fn attitude_target(t: &SET_ATTITUDE_TARGET_DATA) -> Option<OffboardSetpoint> {
    use crate::mav::dialect::AttitudeTargetTypemask as A;
    if t.type_mask.contains(A::ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE) || !t.thrust.is_finite() {
        return None;
    }
    let attitude = Rotation::from_wxyz(t.q.map(f64::from))?;
    let rate = t.type_mask.contains(A::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE);
    Some(OffboardSetpoint {
        attitude: Some((attitude, f64::from(t.thrust))),
        yaw_rate_rad_s: number(t.body_yaw_rate, rate),
        ..OffboardSetpoint::default()
    })
}
