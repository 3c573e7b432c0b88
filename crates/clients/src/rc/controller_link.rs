//! MAVLink link from a controller to a vehicle: MANUAL_CONTROL at 50 Hz, commands with retries, and a heartbeat.
//!
//! After a device is lost, the link sends centered sticks for [`CENTERED_STICKS_DURATION_S`] and then stops sending, so that
//! the vehicle's own failsafe takes over.

use super::{ControllerAction, Sticks};
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::practice::{DEFAULT_REWIND, PracticeRequest, request_number};
use spandrel_mavlink::contract::stick_request::StickRequest;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_mavlink::dialect::{
    COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag, MavResult,
};
use spandrel_mavlink::station;
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};
use std::collections::VecDeque;

/// System ID of a second ground station, next to QGroundControl's 255.
pub const SYSTEM_ID: u8 = 254;
/// MAV_COMP_ID_MISSIONPLANNER, the component ID of a ground station.
const COMPONENT_ID: u8 = 190;
const AUTOPILOT_COMPONENT: u8 = 1;
const CAMERA_COMPONENT: u8 = 100;
/// Interval between MANUAL_CONTROL messages, s (50 Hz, the monitor's recording rate).
const STICK_INTERVAL_S: f64 = 0.02;
const HEARTBEAT_INTERVAL_S: f64 = 1.0;
/// Time for which the link sends centered sticks after a device is lost, s (estimate: long enough to get through a poor
/// radio link).
pub const CENTERED_STICKS_DURATION_S: f64 = 0.3;
/// Retry interval for an unacknowledged command, s, and the maximum number of transmissions (MAVLink command protocol;
/// estimate).
const RETRY_INTERVAL_S: f64 = 0.5;
const MAX_TRANSMISSIONS: u8 = 5;
/// Messages that button actions depend on, and their rates, Hz: ILLUMINATOR_STATUS, GIMBAL_DEVICE_ATTITUDE_STATUS.
const REQUESTED_STREAMS: [(u32, f32); 2] = [(440, 5.0), (285, 5.0)];
/// Retry interval for missing streams, s, in case an acknowledgment was lost or the vehicle restarted (estimate).
const STREAM_RETRY_S: f64 = 5.0;
/// ZOOM_TYPE_STEP of CAMERA_ZOOM_TYPE: each press zooms the camera by one step.
const ZOOM_STEP: f32 = 0.0;
/// Gimbal step per button press, degrees.
const GIMBAL_STEP_DEG: f32 = 10.0;
/// Time window after a gimbal step, s, in which another press adds to the last commanded pitch, because the gimbal may
/// still be moving (estimate: enough for two taps and a move of several steps). Later presses add to the reported
/// pitch, because other clients also control the gimbal.
const AIM_WINDOW_S: f64 = 2.0;

/// Latest state reported by the vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LastReported {
    /// System ID, once a heartbeat has arrived.
    pub system: Option<u8>,
    /// Autopilot type from the heartbeat.
    pub autopilot: Option<MavAutopilot>,
    /// Whether the vehicle is armed.
    pub armed: bool,
    /// Whether the lamp is on.
    pub lamp: bool,
    /// Gimbal pitch above the horizon, degrees.
    pub gimbal_deg: Option<f32>,
    /// Whether the flight is frozen.
    pub frozen: bool,
}

/// Purpose of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// An action of the user.
    Action(ControllerAction),
    /// A walk of the inspector.
    Walk,
    /// A request of streams.
    Streams,
}

impl Purpose {
    fn title(self, language: Language) -> String {
        match self {
            Self::Action(action) => action.short_title(language),
            Self::Walk => text!(language, "keys-short-walk"),
            Self::Streams => text!(language, "keys-message-telemetry"),
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
struct PendingCommand {
    purpose: Purpose,
    command: COMMAND_LONG_DATA,
    sent: u8,
    next: SimTime,
}

/// Link from a controller to a vehicle.
#[derive(Debug, Clone)]
pub struct ControllerLink {
    decoder: Decoder,
    encoder: Encoder,
    out: VecDeque<Vec<u8>>,
    messages: VecDeque<String>,
    next_stream_request: SimTime,
    /// Flags for the [`REQUESTED_STREAMS`] that have arrived since the last check.
    streams_received: [bool; 2],
    /// Latest state reported by the vehicle.
    pub vehicle: LastReported,
    sticks: Sticks,
    device_lost: Option<SimTime>,
    next_sticks: SimTime,
    next_heartbeat: SimTime,
    pending: Vec<PendingCommand>,
    aim: Option<(f32, SimTime)>,
    /// Whether the result of the stream requests has been reported.
    streams_reported: bool,
    pictures: u16,
    /// Name of the key that arms the motors.
    arm_key: Option<String>,
    language: Language,
}

impl Default for ControllerLink {
    fn default() -> Self {
        Self {
            decoder: Decoder::new(),
            encoder: Encoder::new(SYSTEM_ID, COMPONENT_ID),
            out: VecDeque::new(),
            messages: VecDeque::new(),
            next_stream_request: SimTime::ZERO,
            streams_received: [false; 2],
            vehicle: LastReported::default(),
            sticks: Sticks::default(),
            device_lost: Some(SimTime::ZERO - SimTime::from_s(CENTERED_STICKS_DURATION_S)),
            next_sticks: SimTime::ZERO,
            next_heartbeat: SimTime::ZERO,
            pending: Vec::new(),
            aim: None,
            streams_reported: false,
            pictures: 0,
            arm_key: None,
            language: Language::default(),
        }
    }
}

impl ControllerLink {
    /// Sets the stick positions; `None` if there is no device. Sends only heartbeats until a device has been connected.
    pub fn set_sticks(&mut self, sticks: Option<Sticks>, now: SimTime) {
        match sticks {
            Some(sticks) => {
                if self.device_lost.take().is_some() {
                    self.next_sticks = now;
                }
                self.sticks = sticks;
            }
            None => {
                self.device_lost.get_or_insert(now);
                self.sticks = Sticks::default();
            }
        }
    }

    /// Processes a datagram from the vehicle.
    pub fn receive(&mut self, bytes: &[u8]) {
        for frame in self.decoder.datagram(bytes) {
            match frame.message {
                Some(MavMessage::HEARTBEAT(beat)) if frame.component_id == AUTOPILOT_COMPONENT => {
                    self.vehicle.system = Some(frame.system_id);
                    self.vehicle.autopilot = Some(beat.autopilot);
                    self.vehicle.armed = beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
                }
                Some(MavMessage::ILLUMINATOR_STATUS(status)) => {
                    (self.streams_received[0], self.streams_reported) = (true, true);
                    self.vehicle.lamp = status.enable != 0;
                }
                Some(MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(status)) => {
                    (self.streams_received[1], self.streams_reported) = (true, true);
                    let attitude =
                        spandrel_model::frames::Rotation::<spandrel_model::frames::Frd, spandrel_model::frames::Ned>::from_wxyz(
                            status.q.map(f64::from),
                        );
                    self.vehicle.gimbal_deg = attitude.map(|q| q.euler().1.to_degrees() as f32);
                }
                Some(message @ MavMessage::NAMED_VALUE_INT(_)) => {
                    if let Some(NamedValue::Frozen(on)) = NamedValue::of(&message) {
                        self.vehicle.frozen = on;
                    }
                }
                Some(MavMessage::COMMAND_ACK(ack)) if ack.target_system == SYSTEM_ID || ack.target_system == 0 => {
                    self.handle_ack(ack.command, ack.result)
                }
                Some(MavMessage::STATUSTEXT(text)) => {
                    if let Ok(words) = text.text.to_str() {
                        // A trailing tab marks a text that the vehicle also sends as an event.
                        self.messages.push_back(words.trim_end().to_owned());
                    }
                }
                _ => {}
            }
        }
    }

    fn handle_ack(&mut self, command: MavCmd, result: MavResult) {
        if result == MavResult::MAV_RESULT_IN_PROGRESS {
            return;
        }
        if let Some(k) = self.pending.iter().position(|p| p.command.command == command) {
            let done = self.pending.remove(k);
            if command == MavCmd::MAV_CMD_COMPONENT_ARM_DISARM && result == MavResult::MAV_RESULT_ACCEPTED {
                // Updates the state immediately, because the next heartbeat may be a second away.
                self.vehicle.armed = done.command.param1 == 1.0;
            }
            let known = done.purpose == Purpose::Streams && std::mem::replace(&mut self.streams_reported, true);
            if result != MavResult::MAV_RESULT_ACCEPTED && !known {
                if command == MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW {
                    self.aim = None;
                }
                self.push_message(done.purpose, rejection_text(command, result, self.language));
            }
        }
    }

    /// Requests an action from the vehicle. Queues a message if no vehicle is connected.
    pub fn request_action(&mut self, action: ControllerAction, now: SimTime) {
        let Some(system) = self.vehicle.system else {
            return self.push_message(Purpose::Action(action), text!(self.language, "keys-message-no-vehicle"));
        };
        if action == ControllerAction::TakeOff && !self.vehicle.armed && !self.is_arming() {
            self.messages.push_back(match &self.arm_key {
                Some(key) => text!(self.language, "keys-message-arm-first-key", key = key.as_str()),
                None => text!(self.language, "keys-message-arm-first"),
            });
            return;
        }
        let (component, command, params) = self.command_for(action, now);
        self.queue(Purpose::Action(action), station::command(system, component, command, params), now);
    }

    /// Sends the inspector to a place. Queues a message if no vehicle is connected.
    pub fn request_walk(&mut self, place: u8, now: SimTime) {
        let Some(system) = self.vehicle.system else {
            return self.push_message(Purpose::Walk, text!(self.language, "keys-message-no-vehicle"));
        };
        let (command, params) = WalkRequest { place }.command();
        self.queue(Purpose::Walk, station::command(system, AUTOPILOT_COMPONENT, command, params), now);
    }

    fn queue(&mut self, purpose: Purpose, command: COMMAND_LONG_DATA, now: SimTime) {
        // A newer command of the same kind replaces the older one.
        self.pending.retain(|p| p.command.command != command.command);
        self.pending.push(PendingCommand { purpose, command, sent: 0, next: now });
    }

    /// Checks whether an arm command is awaiting acknowledgment.
    fn is_arming(&self) -> bool {
        self.pending.iter().any(|p| p.purpose == Purpose::Action(ControllerAction::Arm))
    }

    /// Sets the name of the arm key for the hint that appears when the user requests takeoff while disarmed.
    pub fn set_arm_key(&mut self, key: &str) {
        self.arm_key = Some(key.to_owned());
    }

    /// Sets the language of the messages to the user.
    pub fn set_language(&mut self, language: Language) {
        self.language = language;
    }

    /// Requests the streams that button actions depend on when a vehicle connects, and again whenever they stop.
    fn request_streams(&mut self, now: SimTime) {
        let Some(system) = self.vehicle.system.filter(|_| now >= self.next_stream_request) else { return };
        self.next_stream_request = now + SimTime::from_s(STREAM_RETRY_S);
        let came = std::mem::take(&mut self.streams_received);
        for (n, (id, rate_hz)) in REQUESTED_STREAMS.into_iter().enumerate() {
            if came[n] {
                continue;
            }
            let params = [id as f32, 1e6 / rate_hz, 0.0, 0.0, 0.0, 0.0, 0.0];
            let command = station::command(system, AUTOPILOT_COMPONENT, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, params);
            self.pending.retain(|p| p.command != command);
            self.pending.push(PendingCommand { purpose: Purpose::Streams, command, sent: 0, next: now });
        }
    }

    fn command_for(&mut self, action: ControllerAction, now: SimTime) -> (u8, MavCmd, [f32; 7]) {
        use MavCmd as M;
        const NAN: f32 = f32::NAN;
        let one = |value: f32| [value, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        match action {
            ControllerAction::Lamp => {
                (AUTOPILOT_COMPONENT, M::MAV_CMD_ILLUMINATOR_ON_OFF, one(if self.vehicle.lamp { 0.0 } else { 1.0 }))
            }
            ControllerAction::Snapshot => self.snapshot(),
            ControllerAction::Arm => (AUTOPILOT_COMPONENT, M::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0)),
            ControllerAction::Disarm => (AUTOPILOT_COMPONENT, M::MAV_CMD_COMPONENT_ARM_DISARM, one(0.0)),
            ControllerAction::TakeOff => (AUTOPILOT_COMPONENT, M::MAV_CMD_NAV_TAKEOFF, [NAN; 7]),
            ControllerAction::Land => (AUTOPILOT_COMPONENT, M::MAV_CMD_NAV_LAND, [0.0, 0.0, 0.0, NAN, NAN, NAN, NAN]),
            ControllerAction::Return => (AUTOPILOT_COMPONENT, M::MAV_CMD_NAV_RETURN_TO_LAUNCH, [0.0; 7]),
            ControllerAction::Hold => (AUTOPILOT_COMPONENT, M::MAV_CMD_NAV_LOITER_UNLIM, [0.0, 0.0, 0.0, NAN, NAN, NAN, NAN]),
            ControllerAction::Position => {
                let (command, params) = station::position_mode(self.vehicle.autopilot);
                (AUTOPILOT_COMPONENT, command, params)
            }
            ControllerAction::GimbalUp => self.aim(GIMBAL_STEP_DEG, now),
            ControllerAction::GimbalDown => self.aim(-GIMBAL_STEP_DEG, now),
            ControllerAction::CameraZoomIn => {
                (CAMERA_COMPONENT, M::MAV_CMD_SET_CAMERA_ZOOM, [ZOOM_STEP, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
            }
            ControllerAction::CameraZoomOut => {
                (CAMERA_COMPONENT, M::MAV_CMD_SET_CAMERA_ZOOM, [ZOOM_STEP, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
            }
            ControllerAction::Freeze if self.vehicle.frozen => practice(PracticeRequest::Resume, now),
            ControllerAction::Freeze => practice(PracticeRequest::Freeze, now),
            ControllerAction::Rewind => practice(PracticeRequest::Rewind { by: DEFAULT_REWIND }, now),
            ControllerAction::StickResponse => {
                let (command, params) = StickRequest::Next.command(request_number(clock_ms(now)));
                (AUTOPILOT_COMPONENT, command, params)
            }
        }
    }

    /// Returns a capture command. Picture numbers start at 1 and let the camera recognize a retransmitted command.
    fn snapshot(&mut self) -> (u8, MavCmd, [f32; 7]) {
        const NAN: f32 = f32::NAN;
        self.pictures = self.pictures.checked_add(1).unwrap_or(1);
        let number = f32::from(self.pictures);
        (CAMERA_COMPONENT, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, [0.0, 0.0, 1.0, number, NAN, NAN, NAN])
    }

    fn aim(&mut self, step: f32, now: SimTime) -> (u8, MavCmd, [f32; 7]) {
        let aimed = self.aim.map(|(aim, _)| aim);
        let fresh = self.aim.filter(|(_, at)| (now - *at).s() < AIM_WINDOW_S).map(|(aim, _)| aim);
        let from = fresh.or(self.vehicle.gimbal_deg).or(aimed).unwrap_or(0.0);
        let to = (from + step).clamp(-90.0, 90.0);
        self.aim = Some((to, now));
        // A yaw of 0 follows the heading. PX4 would ignore the pitch without a yaw.
        (AUTOPILOT_COMPONENT, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [to, 0.0, f32::NAN, f32::NAN, 0.0, 0.0, 0.0])
    }

    /// Queues the periodic messages. Call it at least 50 times per second.
    pub fn handle_timeout(&mut self, now: SimTime) {
        self.request_streams(now);
        if now >= self.next_heartbeat {
            self.next_heartbeat = now + SimTime::from_s(HEARTBEAT_INTERVAL_S);
            self.send(&station::heartbeat());
        }
        let pilot = self.device_lost.is_none_or(|since| (now - since).s() < CENTERED_STICKS_DURATION_S);
        if pilot && now >= self.next_sticks {
            self.next_sticks = (self.next_sticks + SimTime::from_s(STICK_INTERVAL_S)).max(now);
            self.send_sticks();
        }
        self.send_commands(now);
    }

    fn send_sticks(&mut self) {
        let Some(target) = self.vehicle.system else { return };
        let scale = |value: f64| (value.clamp(-1.0, 1.0) * 1000.0).round() as i16;
        let s = self.sticks;
        // Throttle ranges from 0 to 1000 and is centered at 500, as in PX4, ArduPilot, and QGroundControl.
        let z = (500.0 + 500.0 * s.up.clamp(-1.0, 1.0)).round() as i16;
        self.send(&MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            target,
            x: scale(s.forward),
            y: scale(s.right),
            z,
            r: scale(s.yaw),
            ..MANUAL_CONTROL_DATA::default()
        }));
    }

    fn send_commands(&mut self, now: SimTime) {
        let mut pending = std::mem::take(&mut self.pending);
        pending.retain_mut(|p| {
            if now < p.next {
                return true;
            }
            if p.sent == MAX_TRANSMISSIONS {
                // Stream requests are repeated anyway, and a vehicle that has responded before may simply be paused.
                if p.purpose != Purpose::Streams || !std::mem::replace(&mut self.streams_reported, true) {
                    self.push_message(p.purpose, text!(self.language, "keys-message-no-response"));
                }
                return false;
            }
            p.command.confirmation = p.sent;
            (p.sent, p.next) = (p.sent + 1, now + SimTime::from_s(RETRY_INTERVAL_S));
            let bytes = self.encoder.encode(&MavMessage::COMMAND_LONG(p.command.clone()));
            self.out.push_back(bytes);
            true
        });
        self.pending = pending;
    }

    fn push_message(&mut self, purpose: Purpose, result: String) {
        let language = self.language;
        self.messages.push_back(text!(language, "keys-message", action = purpose.title(language), result = result));
    }

    fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.out.push_back(bytes);
    }

    /// Returns the next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// Returns the next message for the user: rejections, timeouts, and status texts from the vehicle.
    pub fn poll_message(&mut self) -> Option<String> {
        self.messages.pop_front()
    }
}

/// Returns a request that is allowed in practice only. Its number lets the vehicle recognize a retransmitted command.
fn practice(request: PracticeRequest, now: SimTime) -> (u8, MavCmd, [f32; 7]) {
    let (command, params) = request.command(request_number(clock_ms(now)));
    (AUTOPILOT_COMPONENT, command, params)
}

fn clock_ms(now: SimTime) -> u64 {
    u64::try_from(now.ms()).unwrap_or_default()
}

fn rejection_text(command: MavCmd, result: MavResult, language: Language) -> String {
    match (command, result) {
        (_, MavResult::MAV_RESULT_TEMPORARILY_REJECTED) => text!(language, "keys-message-temporarily-rejected"),
        (_, MavResult::MAV_RESULT_DENIED) => text!(language, "keys-message-denied"),
        (MavCmd::MAV_CMD_SET_CAMERA_ZOOM, MavResult::MAV_RESULT_UNSUPPORTED) => text!(language, "keys-message-no-zoom"),
        (_, MavResult::MAV_RESULT_UNSUPPORTED) => text!(language, "keys-message-unsupported"),
        (_, MavResult::MAV_RESULT_CANCELLED) => text!(language, "keys-message-canceled"),
        _ => text!(language, "keys-message-failed"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::dialect::{COMMAND_ACK_DATA, HEARTBEAT_DATA};

    fn at(s: f64) -> SimTime {
        SimTime::from_s(s)
    }

    fn known() -> ControllerLink {
        let mut link = ControllerLink::default();
        let beat =
            MavMessage::HEARTBEAT(HEARTBEAT_DATA { autopilot: MavAutopilot::MAV_AUTOPILOT_PX4, ..HEARTBEAT_DATA::default() });
        link.receive(&Encoder::new(1, 1).encode(&beat));
        link.handle_timeout(SimTime::ZERO);
        let asked: Vec<_> = std::iter::from_fn(|| link.poll_transmit()).collect();
        assert_eq!(asked.len(), 1 + REQUESTED_STREAMS.len(), "a heartbeat and the stream requests");
        link.pending.clear();
        link
    }

    /// Returns the messages sent during a time interval, polling every millisecond.
    fn sent(link: &mut ControllerLink, from: f64, to: f64) -> Vec<MavMessage> {
        let mut decoder = Decoder::new();
        let mut found = Vec::new();
        for ms in (from * 1000.0) as i64..(to * 1000.0) as i64 {
            link.handle_timeout(SimTime::from_us(ms * 1000));
            while let Some(bytes) = link.poll_transmit() {
                found.extend(decoder.datagram(&bytes).into_iter().filter_map(|frame| frame.message));
            }
        }
        found
    }

    fn sticks(messages: &[MavMessage]) -> Vec<(i16, i16, i16, i16)> {
        messages
            .iter()
            .filter_map(|m| if let MavMessage::MANUAL_CONTROL(c) = m { Some((c.x, c.y, c.z, c.r)) } else { None })
            .collect()
    }

    #[test]
    fn exact_missing_streams_are_requested_again_and_reported_once() {
        let mut link = known();
        let asked = |messages: &[MavMessage]| -> Vec<u32> {
            let ids =
                messages.iter().filter_map(|m| if let MavMessage::COMMAND_LONG(c) = m { Some(c.param1 as u32) } else { None });
            ids.collect()
        };
        let gimbal =
            MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(spandrel_mavlink::dialect::GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::default());
        link.receive(&Encoder::new(1, 1).encode(&gimbal));
        let again = sent(&mut link, 0.0, STREAM_RETRY_S + 0.1);
        assert_eq!(asked(&again), [REQUESTED_STREAMS[0].0], "only the missing stream must be requested");
        answer(&mut link, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, MavResult::MAV_RESULT_UNSUPPORTED);
        let later = sent(&mut link, STREAM_RETRY_S + 0.1, 2.0 * STREAM_RETRY_S + 0.1);
        assert_eq!(asked(&later), REQUESTED_STREAMS.map(|(id, _)| id), "all stopped streams must be requested");
        sent(&mut link, 2.0 * STREAM_RETRY_S + 0.1, 60.0);
        let told = |link: &mut ControllerLink| std::iter::from_fn(|| link.poll_message()).collect::<Vec<_>>();
        assert!(told(&mut link).is_empty(), "no message if one of the streams arrives");
        let mut refused = known();
        sent(&mut refused, 0.0, STREAM_RETRY_S + 0.1);
        for _ in REQUESTED_STREAMS {
            answer(&mut refused, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, MavResult::MAV_RESULT_UNSUPPORTED);
        }
        assert_eq!(told(&mut refused), ["lamp and gimbal telemetry: not supported by this vehicle"]);
        let mut deaf = known();
        sent(&mut deaf, 0.0, 60.0);
        assert_eq!(told(&mut deaf), ["lamp and gimbal telemetry: no response from vehicle"]);
        let mut stands = known();
        stands.receive(&Encoder::new(1, 1).encode(&gimbal));
        sent(&mut stands, 0.0, 60.0);
        assert!(told(&mut stands).is_empty(), "a paused vehicle is not an error");
    }

    #[test]
    fn regress_takeoff_while_disarmed_prompts_the_user_to_arm() {
        let take_offs = |messages: &[MavMessage]| {
            let is = |m: &&MavMessage| matches!(m, MavMessage::COMMAND_LONG(c) if c.command == MavCmd::MAV_CMD_NAV_TAKEOFF);
            messages.iter().filter(is).count()
        };
        let mut link = known();
        link.vehicle.armed = false;
        link.set_arm_key("M");
        link.request_action(ControllerAction::TakeOff, at(0.0));
        assert_eq!(link.poll_message().as_deref(), Some("Arm the motors first (key M)"));
        assert_eq!(take_offs(&sent(&mut link, 0.0, 0.1)), 0, "no takeoff command must be sent");
        // Both keys are pressed in quick succession; takeoff must not wait for a heartbeat.
        link.request_action(ControllerAction::Arm, at(0.1));
        link.request_action(ControllerAction::TakeOff, at(0.1));
        assert_eq!((take_offs(&sent(&mut link, 0.1, 0.2)), link.poll_message()), (1, None));
        let mut armed = known();
        armed.vehicle.armed = false;
        armed.request_action(ControllerAction::Arm, at(0.0));
        sent(&mut armed, 0.0, 0.1);
        answer(&mut armed, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, MavResult::MAV_RESULT_ACCEPTED);
        armed.request_action(ControllerAction::TakeOff, at(0.1));
        assert_eq!((take_offs(&sent(&mut armed, 0.1, 0.2)), armed.poll_message()), (1, None));
    }

    #[test]
    fn wire_walk_is_requested_until_it_is_answered() {
        let walks = |messages: &[MavMessage]| -> Vec<f32> {
            let place = |m: &MavMessage| match m {
                MavMessage::COMMAND_LONG(c) if c.command == MavCmd::MAV_CMD_USER_4 => Some(c.param1),
                _ => None,
            };
            messages.iter().filter_map(place).collect()
        };
        let mut link = known();
        link.request_walk(2, at(0.0));
        link.request_walk(3, at(0.0));
        assert_eq!(walks(&sent(&mut link, 0.0, 0.7)), [3.0; 2], "the newer request replaces the older one");
        answer(&mut link, MavCmd::MAV_CMD_USER_4, MavResult::MAV_RESULT_ACCEPTED);
        assert_eq!((walks(&sent(&mut link, 0.7, 2.0)), link.poll_message()), (Vec::new(), None));
        link.request_walk(9, at(2.0));
        sent(&mut link, 2.0, 2.1);
        answer(&mut link, MavCmd::MAV_CMD_USER_4, MavResult::MAV_RESULT_DENIED);
        let denied = link.poll_message().unwrap();
        assert!(denied.starts_with("walk: "), "{denied}");
        let mut alone = ControllerLink::default();
        alone.request_walk(2, at(0.0));
        assert!(alone.poll_message().is_some_and(|words| words.starts_with("walk: ")), "no vehicle");
    }

    #[test]
    fn exact_sticks_are_sent_at_50_hz() {
        let mut link = known();
        link.set_sticks(Some(Sticks { forward: 1.0, right: -0.5, up: -1.0, yaw: 0.25 }), at(0.0));
        assert_eq!(sticks(&sent(&mut link, 0.0, 1.0)), vec![(1000, -500, 0, 250); 50]);
    }

    #[test]
    fn exact_lost_device_centers_sticks_then_stops_until_it_returns() {
        let mut link = known();
        link.set_sticks(Some(Sticks { forward: 1.0, ..Sticks::default() }), at(0.0));
        sent(&mut link, 0.0, 0.1);
        for ms in 100..2000 {
            link.set_sticks(None, SimTime::from_us(ms * 1000));
        }
        let after = sticks(&sent(&mut link, 0.1, 2.0));
        assert_eq!(after, vec![(0, 0, 500, 0); (CENTERED_STICKS_DURATION_S / STICK_INTERVAL_S) as usize]);
        link.set_sticks(Some(Sticks { up: 1.0, ..Sticks::default() }), at(2.0));
        assert_eq!(sticks(&sent(&mut link, 2.0, 2.1)), vec![(0, 0, 1000, 0); 5]);
    }

    #[test]
    fn exact_sticks_are_sent_only_with_a_device() {
        let mut link = known();
        let messages = sent(&mut link, 0.0, 2.0);
        assert!(messages.iter().all(|m| matches!(m, MavMessage::HEARTBEAT(_))), "{messages:?}");
        assert_eq!(messages.len(), 1);
    }

    fn answer(link: &mut ControllerLink, command: MavCmd, result: MavResult) {
        let ack = COMMAND_ACK_DATA { command, result, target_system: SYSTEM_ID, ..Default::default() };
        link.receive(&Encoder::new(1, 1).encode(&MavMessage::COMMAND_ACK(ack)));
    }

    #[test]
    fn exact_camera_zooms_in_steps_or_reports_that_it_cannot() {
        let mut link = known();
        for (action, step) in [(ControllerAction::CameraZoomIn, 1.0), (ControllerAction::CameraZoomOut, -1.0)] {
            link.request_action(action, at(0.0));
            let messages = sent(&mut link, 0.0, 0.1);
            let asked = messages.iter().find_map(|m| if let MavMessage::COMMAND_LONG(c) = m { Some(c) } else { None }).unwrap();
            assert_eq!((asked.command, asked.target_component), (MavCmd::MAV_CMD_SET_CAMERA_ZOOM, CAMERA_COMPONENT));
            assert_eq!([asked.param1, asked.param2, asked.param3], [0.0, step, 0.0]);
        }
        answer(&mut link, MavCmd::MAV_CMD_SET_CAMERA_ZOOM, MavResult::MAV_RESULT_UNSUPPORTED);
        assert_eq!(link.poll_message().as_deref(), Some("camera zoom out: this camera cannot zoom"));
    }

    /// Returns the picture numbers of the capture commands.
    fn pictures(messages: &[MavMessage]) -> Vec<f32> {
        let number = |m: &MavMessage| if let MavMessage::COMMAND_LONG(c) = m { Some(c.param4) } else { None };
        messages.iter().filter_map(number).collect()
    }

    #[test]
    fn exact_retransmitted_capture_keeps_its_picture_number() {
        let mut link = known();
        link.request_action(ControllerAction::Snapshot, at(0.0));
        assert_eq!(pictures(&sent(&mut link, 0.0, 1.1)), [1.0; 3]);
        answer(&mut link, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, MavResult::MAV_RESULT_ACCEPTED);
        link.request_action(ControllerAction::Snapshot, at(1.2));
        assert_eq!(pictures(&sent(&mut link, 1.2, 1.8)), [2.0; 2]);
    }

    #[test]
    fn exact_gimbal_steps_start_from_the_last_command_or_the_reported_pitch() {
        let mut link = known();
        let aimed = |link: &mut ControllerLink, action: ControllerAction, s: f64| {
            link.request_action(action, at(s));
            let messages = sent(link, s, s + 0.1);
            messages.iter().find_map(|m| if let MavMessage::COMMAND_LONG(c) = m { Some(c.param1) } else { None }).unwrap()
        };
        assert_eq!(
            [0.0, 0.2].map(|s| aimed(&mut link, ControllerAction::GimbalDown, s)),
            [-10.0, -20.0],
            "the second press must add to the first"
        );
        link.vehicle.gimbal_deg = Some(-60.0);
        assert_eq!(
            aimed(&mut link, ControllerAction::GimbalUp, 0.2 + AIM_WINDOW_S),
            -50.0,
            "a late press must start from the reported pitch"
        );
        answer(&mut link, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, MavResult::MAV_RESULT_DENIED);
        assert_eq!(
            aimed(&mut link, ControllerAction::GimbalUp, 0.5 + AIM_WINDOW_S),
            -50.0,
            "a rejected command must not change the target"
        );
    }

    #[test]
    fn exact_freeze_action_continues_a_frozen_flight() {
        let mut link = known();
        let asked = |link: &mut ControllerLink, action: ControllerAction, s: f64| {
            link.request_action(action, at(s));
            let messages = sent(link, s, s + 0.1);
            let command = |m: &MavMessage| if let MavMessage::COMMAND_LONG(c) = m { Some((c.command, c.param1)) } else { None };
            messages.iter().filter_map(command).find(|(command, _)| *command != MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL)
        };
        let frozen = |on| Encoder::new(1, 1).encode(&NamedValue::Frozen(on).message(0));
        assert_eq!(asked(&mut link, ControllerAction::Freeze, 0.0), Some((MavCmd::MAV_CMD_USER_1, 1.0)));
        link.receive(&frozen(true));
        assert_eq!(asked(&mut link, ControllerAction::Freeze, 1.0), Some((MavCmd::MAV_CMD_USER_1, 0.0)));
        link.receive(&frozen(false));
        assert_eq!(asked(&mut link, ControllerAction::Freeze, 2.0), Some((MavCmd::MAV_CMD_USER_1, 1.0)));
        answer(&mut link, MavCmd::MAV_CMD_USER_1, MavResult::MAV_RESULT_ACCEPTED);
        assert_eq!(asked(&mut link, ControllerAction::Rewind, 3.0), Some((MavCmd::MAV_CMD_USER_2, 10.0)));
    }

    #[test]
    fn regress_a_retransmitted_rewind_keeps_its_number_and_the_next_one_has_another() {
        let mut link = known();
        let numbers = |link: &mut ControllerLink, from: f64, to: f64| {
            let rewind = |m: &MavMessage| match m {
                MavMessage::COMMAND_LONG(c) if c.command == MavCmd::MAV_CMD_USER_2 => Some(c.param2),
                _ => None,
            };
            sent(link, from, to).iter().filter_map(rewind).collect::<Vec<_>>()
        };
        link.request_action(ControllerAction::Rewind, at(3.0));
        assert_eq!(numbers(&mut link, 3.0, 3.7), [3_001.0, 3_001.0]);
        link.request_action(ControllerAction::Rewind, at(4.0));
        assert_eq!(numbers(&mut link, 4.0, 4.1), [4_001.0]);
    }

    #[test]
    fn exact_commands_are_repeated_until_acknowledged() {
        let mut link = known();
        link.streams_reported = true;
        link.request_action(ControllerAction::Lamp, at(0.0));
        let streams = MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL;
        let wished = |m: &&MavMessage| matches!(m, MavMessage::COMMAND_LONG(c) if c.command != streams);
        let count = |messages: &[MavMessage]| messages.iter().filter(wished).count();
        assert_eq!(count(&sent(&mut link, 0.0, 1.1)), 3);
        answer(&mut link, MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, MavResult::MAV_RESULT_DENIED);
        assert_eq!(count(&sent(&mut link, 1.1, 5.0)), 0);
        assert_eq!(link.poll_message().as_deref(), Some("lamp: denied"));
        link.request_action(ControllerAction::Snapshot, at(5.0));
        assert_eq!(count(&sent(&mut link, 5.0, 20.0)), usize::from(MAX_TRANSMISSIONS));
        assert_eq!(link.poll_message().as_deref(), Some("snapshot: no response from vehicle"));
        let mut alone = ControllerLink::default();
        alone.request_action(ControllerAction::Arm, at(0.0));
        assert_eq!(alone.poll_message().as_deref(), Some("arm: no vehicle connected"));
    }
}
