//! MAVLink connection of the synthetic pilot's ground station.

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::guidance::Guidance;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::stick_request::{self, StickRequest};
use spandrel_mavlink::contract::truth::{self, Truth};
use spandrel_mavlink::dialect::{
    MANUAL_CONTROL_DATA, MavAutopilot, MavCmd, MavLandedState, MavMessage, MavModeFlag, MavSysStatusSensor,
    PARAM_REQUEST_READ_DATA, TIMESYNC_DATA,
};
use spandrel_mavlink::station;
use spandrel_model::frames::Rotation;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::math;
use spandrel_model::stick_response::StickResponse;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

use super::hand_motion::StickAxes;
use super::perception::MotionState;

/// System and component ID of a ground station (QGroundControl's values).
const SYSTEM_ID: u8 = 255;
const COMPONENT_ID: u8 = 190;
const AUTOPILOT_COMPONENT: u8 = 1;
/// Messages that the pilot needs (ground truth, system status, landed state, battery, gimbal) and their rates, Hz
/// (PX4's rates for a ground station).
const REQUESTED_STREAMS: [(u32, f32); 5] = [(115, 50.0), (1, 2.0), (245, 5.0), (147, 2.0), (285, 10.0)];

/// Number of requests for the parameter of the response to the sticks after which the vehicle is taken not to have it.
const MAX_RESPONSE_REQUESTS: u8 = 10;

/// Latest state reported by the vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VehicleStatus {
    /// The vehicle's system ID.
    pub system: Option<u8>,
    /// Autopilot type from the heartbeat.
    pub autopilot: Option<MavAutopilot>,
    /// Whether ground truth has arrived since the last heartbeat.
    truth_received: bool,
    /// Whether the vehicle is armed.
    pub armed: bool,
    /// Whether the vehicle reports that it is ready to arm.
    pub ready: bool,
    /// Whether the vehicle reports that it is on the ground.
    pub on_ground: bool,
    /// Battery level, %.
    pub battery_pct: Option<f64>,
    /// The session's seed.
    pub seed: Option<u64>,
    /// Number of times the aircraft has respawned.
    pub respawns: i32,
    /// Kind of object that the aircraft is in contact with.
    pub contact: ContactKind,
    /// Gimbal pitch, rad.
    pub gimbal_pitch_rad: f64,
    /// Response to the sticks, as soon as the vehicle has reported it.
    stick_response: Option<StickResponse>,
    /// Number of requests for the parameter of the response.
    response_requests: u8,
    /// Distance to the next place in the monitor's latest guidance, m; `None` without guidance or without a place.
    pub guided_distance_m: Option<f64>,
}

impl VehicleStatus {
    /// Returns the response to the sticks. A vehicle without the parameter responds in proportion to them.
    #[must_use]
    pub fn stick_response(&self) -> StickResponse {
        self.stick_response.unwrap_or(StickResponse::Sport)
    }
}

/// Encoder, decoder, and outgoing datagrams.
#[derive(Debug, Clone)]
pub struct VehicleLink {
    decoder: Decoder,
    encoder: Encoder,
    out: VecDeque<Vec<u8>>,
    /// Latest state reported by the vehicle.
    pub status: VehicleStatus,
}

/// An update that the pilot handles immediately.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VehicleUpdate {
    /// Current motion of the aircraft (ground truth).
    Truth(MotionState),
    /// Lockstep request. The pilot returns this token after sending all messages for this step.
    Timesync(i64),
}

impl VehicleLink {
    /// Creates a link that has not exchanged messages yet.
    #[must_use]
    pub fn new() -> Self {
        let encoder = Encoder::new(SYSTEM_ID, COMPONENT_ID);
        Self { decoder: Decoder::new(), encoder, out: VecDeque::new(), status: VehicleStatus::default() }
    }

    /// Decodes a datagram, stores the state, and returns the updates.
    pub fn receive(&mut self, bytes: &[u8], plane: &LocalPlane) -> Vec<VehicleUpdate> {
        let mut news = Vec::new();
        for frame in self.decoder.datagram(bytes) {
            let from_autopilot = frame.component_id == AUTOPILOT_COMPONENT;
            match frame.message {
                Some(MavMessage::HIL_STATE_QUATERNION(state)) => {
                    self.status.truth_received = true;
                    news.extend(truth::read(&state, plane).map(|truth| VehicleUpdate::Truth(motion(&truth))));
                }
                Some(MavMessage::TIMESYNC(sync)) if sync.tc1 == 0 => news.push(VehicleUpdate::Timesync(sync.ts1)),
                Some(MavMessage::HEARTBEAT(beat)) if from_autopilot => {
                    self.status.system = Some(frame.system_id);
                    self.status.autopilot = Some(beat.autopilot);
                    if !std::mem::take(&mut self.status.truth_received) {
                        self.request_streams();
                    }
                    self.request_stick_response();
                    self.status.armed = beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
                }
                Some(MavMessage::PARAM_VALUE(value))
                    if from_autopilot && value.param_id.to_str() == Ok(stick_request::PARAMETER) =>
                {
                    self.status.stick_response = StickResponse::from_number(whole(value.param_value));
                }
                Some(message) => self.update_status(&message),
                None => {}
            }
        }
        news
    }

    fn update_status(&mut self, message: &MavMessage) {
        match message {
            MavMessage::SYS_STATUS(status) => {
                let prearm = MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK;
                self.status.ready = status.onboard_control_sensors_health.contains(prearm);
            }
            MavMessage::EXTENDED_SYS_STATE(state) => {
                self.status.on_ground = state.landed_state == MavLandedState::MAV_LANDED_STATE_ON_GROUND;
            }
            MavMessage::BATTERY_STATUS(battery) if battery.battery_remaining >= 0 => {
                self.status.battery_pct = Some(f64::from(battery.battery_remaining));
            }
            MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(gimbal) => {
                if let Some(attitude) = Rotation::from_wxyz(gimbal.q.map(f64::from)) {
                    self.status.gimbal_pitch_rad = attitude.euler().1;
                }
            }
            MavMessage::DEBUG_FLOAT_ARRAY(_) => {
                if let Some(guidance) = Guidance::of(message) {
                    self.status.guided_distance_m = guidance.way.map(|way| math::hypot(way.distance_m, way.up_m));
                }
            }
            MavMessage::NAMED_VALUE_INT(named) => match NamedValue::from_int(named) {
                Some(NamedValue::Seed(seed)) => self.status.seed = Some(u64::from(seed)),
                Some(NamedValue::Respawns(count)) => self.status.respawns = count,
                Some(NamedValue::Contact(contact)) => self.status.contact = contact,
                _ => {}
            },
            _ => {}
        }
    }

    /// Requests the streams until they arrive, because not every vehicle sends them by default.
    fn request_streams(&mut self) {
        for (id, rate_hz) in REQUESTED_STREAMS {
            self.send_command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [id as f32, 1e6 / rate_hz, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
    }

    /// Selects the response to the sticks for which the pilot's numbers were adjusted, and asks whether the vehicle has it. Lost messages
    /// are repeated with the next heartbeat.
    fn request_stick_response(&mut self) {
        if self.status.stick_response.is_some() || self.status.response_requests >= MAX_RESPONSE_REQUESTS {
            return;
        }
        self.status.response_requests += 1;
        let (command, params) = StickRequest::Select(StickResponse::Sport).command(0);
        self.send_command(command, params);
        self.send(&MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            target_system: self.status.system.unwrap_or(1),
            target_component: AUTOPILOT_COMPONENT,
            param_index: -1,
            param_id: stick_request::PARAMETER.into(),
        }));
    }

    /// Requests position mode, where the sticks command velocity.
    pub fn set_position_mode(&mut self) {
        let (command, params) = station::position_mode(self.status.autopilot);
        self.send_command(command, params);
    }

    /// Queues a message.
    pub fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.out.push_back(bytes);
    }

    /// Returns the next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// Sends the ground station's heartbeat.
    pub fn send_heartbeat(&mut self) {
        self.send(&station::heartbeat());
    }

    /// Responds to a lockstep request.
    pub fn respond_to_timesync(&mut self, token: i64, now: SimTime) {
        let system = self.status.system.unwrap_or(1);
        self.send(&MavMessage::TIMESYNC(TIMESYNC_DATA {
            tc1: now.ns().max(1),
            ts1: token,
            target_system: system,
            target_component: AUTOPILOT_COMPONENT,
        }));
    }

    /// Sends a command to the autopilot.
    pub fn send_command(&mut self, command: MavCmd, params: [f32; 7]) {
        self.send_command_to(AUTOPILOT_COMPONENT, command, params);
    }

    /// Sends a command to one of the vehicle's components.
    pub fn send_command_to(&mut self, component: u8, command: MavCmd, params: [f32; 7]) {
        let system = self.status.system.unwrap_or(1);
        self.send(&MavMessage::COMMAND_LONG(station::command(system, component, command, params)));
    }

    /// Sends the sticks: forward, right, up, yaw in [-1, 1]. Throttle is centered at 500 (PX4's convention).
    pub fn send_sticks(&mut self, axes: StickAxes) {
        let scale = |value: f64| (value.clamp(-1.0, 1.0) * 1000.0).round() as i16;
        self.send(&MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            target: self.status.system.unwrap_or(1),
            x: scale(axes[0]),
            y: scale(axes[1]),
            z: 500 + scale(axes[2]) / 2,
            r: scale(axes[3]),
            ..MANUAL_CONTROL_DATA::default()
        }));
    }
}

impl Default for VehicleLink {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns a small whole parameter value, which PX4 sends as the bits of an integer and ArduPilot as a float.
fn whole(wire: f32) -> i32 {
    if wire >= 1.0 { wire as i32 } else { wire.to_bits().cast_signed() }
}

fn motion(truth: &Truth) -> MotionState {
    MotionState {
        time: truth.time,
        position_m: truth.motion.position_m,
        velocity_m_s: truth.motion.velocity_m_s,
        yaw_rad: truth.motion.ned_from_frd.yaw_rad(),
    }
}
