//! A flight as it is heard over the wire: bytes in, the moment to draw out. One more subscriber of telemetry, so it shows any vehicle that
//! speaks MAVLink, the simulated one by its truth and any other by its own estimate. No socket and no clock in here.

pub mod clock;
mod estimate;
mod series;
mod trace;
mod video;

pub use trace::{AircraftMotion, MotionHistory};
pub use video::VideoStatus;

use super::feed::Feed;
use super::scene::DronePose;
use super::stage::{HudInputs, LIFT_OFF_M, SceneMoment};
use clock::Playhead;
use estimate::EstimatedPose;
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::contract::continuity::RESTART_AFTER;
use spandrel_mavlink::contract::continuity::RESTART_CONFIRM;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_mavlink::station;
use spandrel_mavlink::telemetry::sample::{self, Sample, SampleContent, SampleValue};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::CameraPose;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use std::collections::{BTreeSet, VecDeque};

/// The system id of a view: no vehicle's and no ground station's (255 is QGroundControl's, 254 `spandrel rc`'s).
pub const SYSTEM: u8 = 253;
/// MAV_COMP_ID_ONBOARD_COMPUTER2: a listener beside the monitor.
const COMPONENT: u8 = 192;
const AUTOPILOT: u8 = 1;
const HEARTBEAT_EVERY: SimTime = SimTime::from_ms(1_000);
/// A vehicle that says no truth for so long is a real one and is asked for what is drawn instead.
const NO_TRUTH_AFTER: SimTime = SimTime::from_ms(3_000);
/// And asked again, in case the question was lost.
const ASK_EVERY: SimTime = SimTime::from_ms(5_000);
/// What is drawn instead of the truth, by message number and rate, Hz: ATTITUDE_QUATERNION, GLOBAL_POSITION_INT,
/// GIMBAL_DEVICE_ATTITUDE_STATUS.
const INSTEAD: [(u32, f32); 3] = [(31, 50.0), (33, 50.0), (285, 25.0)];
/// SERVO_OUTPUT_RAW, asked for at this rate, Hz: the rotors are heard (a tenth of a second is a person's limit for sound and picture).
const ROTORS: (u32, f32) = (36, 20.0);
/// FLIGHT_INFORMATION: when the vehicle took off, for who begins to listen in flight.
const FLIGHT: u32 = 264;
/// Pulses of outputs that are at rest and full, µs (SERVO_OUTPUT_RAW).
const PULSE_US: (f64, f64) = (1_000.0, 2_000.0);
/// A stream without a picture for so long has ended: a window that is hidden draws none.
const VIDEO_LASTS: SimTime = SimTime::from_ms(3_000);

/// A flight as it is heard.
#[derive(Debug, Clone)]
pub struct LiveFlight {
    plane: LocalPlane,
    pad_up_m: f64,
    decoder: Decoder,
    encoder: Encoder,
    out: VecDeque<Vec<u8>>,
    next_heartbeat: SimTime,
    next_truth_request: Option<SimTime>,
    system: Option<u8>,
    /// When the vehicle was first heard.
    first_heard: Option<SimTime>,
    seed: Option<u64>,
    scenario_crc: Option<u32>,
    /// When the rotors' outputs are asked for next; none: nobody hears them.
    next_rotors: Option<SimTime>,
    truth_requested: bool,
    estimate: EstimatedPose,
    time_reversals: usize,
    last_heard: Option<SimTime>,
    playhead: Playhead,
    state: SimulatorRun,
    /// And when its last picture went out, wall time.
    video: Option<(VideoStatus, SimTime)>,
}

/// What begins anew with the simulator.
#[derive(Debug, Clone, Default)]
struct SimulatorRun {
    feed: Feed,
    trace: MotionHistory,
    lamp: bool,
    armed: bool,
    /// Outputs of the rotors, 0 to 1; none while they stand.
    outputs: Option<[f64; 4]>,
    battery_pct: Option<f64>,
    lift_off: Option<SimTime>,
    /// It flew already when it was first heard, and the vehicle is asked since when; when it is asked next.
    since_when: Option<SimTime>,
    pictures: BTreeSet<(i32, Option<SimTime>)>,
    last_picture: Option<SimTime>,
    closures: BridgeClosures,
}

/// What is drawn at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveMoment {
    /// Where everything is.
    pub moment: SceneMoment,
    /// What the display tells besides.
    pub hud: HudInputs,
    /// When traffic was stopped and let go.
    pub closures: BridgeClosures,
}

impl LiveFlight {
    /// Nothing has been heard yet.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            plane: LocalPlane::new(scenario.origin),
            pad_up_m: scenario.ground_team.pad_m.up(),
            decoder: Decoder::new(),
            encoder: Encoder::new(SYSTEM, COMPONENT),
            out: VecDeque::new(),
            next_heartbeat: SimTime::ZERO,
            next_truth_request: None,
            system: None,
            first_heard: None,
            seed: None,
            scenario_crc: None,
            next_rotors: None,
            truth_requested: false,
            estimate: EstimatedPose::default(),
            time_reversals: 0,
            last_heard: None,
            playhead: Playhead::default(),
            state: SimulatorRun::default(),
            video: None,
        }
    }

    /// The vehicle's system id, once it has been heard.
    #[must_use]
    pub fn system(&self) -> Option<u8> {
        self.system
    }

    /// The session's seed, once it has been said: it places defects and traffic.
    #[must_use]
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// The checksum of the scenario that the simulator runs, once it has been said.
    #[must_use]
    pub fn scenario_crc(&self) -> Option<u32> {
        self.scenario_crc
    }

    /// The aircraft's poses are its own estimate: nobody says the truth.
    #[must_use]
    pub fn is_estimated(&self) -> bool {
        self.last_heard.is_some() && !self.truth_requested
    }

    /// Nobody says the truth, though it was asked for: no simulator of ours, and no seed will be said.
    #[must_use]
    pub fn lacks_truth(&self, wall: SimTime) -> bool {
        !self.truth_requested && self.first_heard.is_some_and(|met| wall >= met + NO_TRUTH_AFTER + NO_TRUTH_AFTER)
    }

    /// Mode, satellites, cues and words.
    #[must_use]
    pub fn feed(&self) -> &Feed {
        &self.state.feed
    }

    /// A datagram, heard at a wall time.
    pub fn handle_datagram(&mut self, bytes: &[u8], wall: SimTime) {
        for frame in self.decoder.datagram(bytes) {
            self.handle_frame(&frame, wall);
        }
    }

    fn handle_frame(&mut self, frame: &ReceivedFrame, wall: SimTime) {
        let beats = matches!(frame.message, Some(MavMessage::HEARTBEAT(_))) && frame.component_id == AUTOPILOT;
        if self.system.is_none() && (beats || sample::truth_time(&frame.bytes).is_some()) {
            self.system = Some(frame.system_id);
            self.first_heard = Some(wall);
            self.next_truth_request = Some(wall + NO_TRUTH_AFTER);
        }
        if self.system != Some(frame.system_id) {
            return;
        }
        let now = self.state.trace.newest().unwrap_or_default();
        if Feed::is_relevant(frame.message_id) {
            self.state.feed.handle_frame(frame, now);
        }
        if let Some(MavMessage::SERVO_OUTPUT_RAW(servos)) = &frame.message {
            self.next_rotors = self.next_rotors.map(|_| wall + ASK_EVERY);
            let pulses = [servos.servo1_raw, servos.servo2_raw, servos.servo3_raw, servos.servo4_raw].map(f64::from);
            let turn = pulses.iter().any(|pulse| *pulse >= PULSE_US.0);
            self.state.outputs =
                turn.then(|| pulses.map(|pulse| ((pulse - PULSE_US.0) / (PULSE_US.1 - PULSE_US.0)).clamp(0.0, 1.0)));
        }
        if let (Some(MavMessage::FLIGHT_INFORMATION(flight)), Some(_)) = (&frame.message, self.state.since_when)
            && let Ok(took_off_us @ 1..) = i64::try_from(flight.takeoff_time_utc)
        {
            // A time since boot, whatever the field is called (MAVLink common).
            (self.state.lift_off, self.state.since_when) = (Some(SimTime::from_us(took_off_us)), None);
        }
        if !self.truth_requested
            && let Some(truth) = frame.message.as_ref().and_then(|message| self.estimate.take(message, &self.plane))
        {
            self.handle_truth(truth, wall);
        }
        if let Some(sample) = sample::read(&frame.bytes, &self.plane) {
            self.handle_sample(&sample, wall);
        }
    }

    fn handle_sample(&mut self, sample: &Sample, wall: SimTime) {
        match sample.content {
            SampleContent::Truth(truth) => {
                if !self.truth_requested {
                    // From now on the truth is drawn; estimates may run on another clock.
                    self.truth_requested = true;
                    self.restart();
                }
                self.handle_truth(truth, wall);
            }
            SampleContent::Value(value) => self.handle_value(value, sample.own_time),
        }
    }

    fn handle_value(&mut self, value: SampleValue, own_time: Option<SimTime>) {
        let now = self.state.trace.newest().unwrap_or_default();
        let state = &mut self.state;
        let time = own_time.filter(|own| *own <= now + RESTART_AFTER).unwrap_or(now);
        match value {
            SampleValue::GimbalPitch(pitch_rad) => state.trace.push_gimbal(time, pitch_rad),
            SampleValue::Light(on) => state.lamp = on,
            SampleValue::Battery(pct) => state.battery_pct = Some(pct),
            SampleValue::FieldOfView(rad) => state.trace.push_lens(time, rad),
            SampleValue::Beat { armed, .. } => state.armed = armed,
            SampleValue::Snapshot(number) => {
                if state.pictures.insert((number, own_time)) {
                    state.last_picture = Some(own_time.unwrap_or(now));
                }
            }
            SampleValue::Traffic(code) => state.closures.apply_codes(code),
            SampleValue::Seed(seed) => self.handle_seed(seed),
            SampleValue::ScenarioCrc(crc) => self.scenario_crc = Some(crc),
            SampleValue::Sticks(_)
            | SampleValue::Contact(_)
            | SampleValue::Hits(_)
            | SampleValue::Respawns(_)
            | SampleValue::Clearance(_)
            | SampleValue::OnGround(_) => {}
        }
    }

    fn handle_truth(&mut self, truth: Truth, wall: SimTime) {
        if self.state.trace.newest().is_some_and(|newest| truth.time + RESTART_AFTER < newest) {
            self.time_reversals += 1;
            if self.time_reversals < RESTART_CONFIRM {
                return;
            }
            self.restart();
            // What has begun anew says its own.
            (self.seed, self.scenario_crc) = (None, None);
        }
        self.time_reversals = 0;
        self.last_heard = Some(wall);
        self.playhead.handle_sample_time(wall, truth.time);
        if self.state.lift_off.is_none() && truth.position_m.up() - self.pad_up_m > LIFT_OFF_M {
            self.state.lift_off = Some(truth.time);
            self.state.since_when = self.state.trace.newest().is_none().then_some(wall);
        }
        self.state.trace.push(truth);
    }

    /// Another seed is another session, even where its clock has not gone back.
    fn handle_seed(&mut self, seed: u64) {
        if self.seed.is_some_and(|known| known != seed) {
            self.restart();
        }
        self.seed = Some(seed);
    }

    fn restart(&mut self) {
        self.playhead.restart();
        self.time_reversals = 0;
        self.state = SimulatorRun::default();
    }

    /// The camera's view is streamed, a picture went out at a wall time; or it is not. The vehicle hears of it every second, and announces it.
    pub fn set_video_status(&mut self, video: Option<VideoStatus>, wall: SimTime) {
        match video {
            Some(video) => self.video = Some((video, wall)),
            None => self.end_video(),
        }
    }

    fn end_video(&mut self) {
        if let Some((video, _)) = self.video.take() {
            self.send(&video.status(false));
        }
    }

    /// Queues what is due to be said: a heartbeat, so that the vehicle knows its listener, and questions to one that says no truth.
    pub fn handle_timeout(&mut self, wall: SimTime) {
        if wall >= self.next_heartbeat {
            self.next_heartbeat = wall + HEARTBEAT_EVERY;
            self.send(&station::companion_heartbeat());
            match self.video {
                Some((_, last)) if wall.saturating_sub(last) > VIDEO_LASTS => self.end_video(),
                Some((video, _)) => self.send(&video.status(true)),
                None => {}
            }
        }
        if let (Some(system), Some(due)) = (self.system, self.next_rotors)
            && wall >= due
        {
            self.next_rotors = Some(wall + ASK_EVERY);
            self.send(&message_interval_request(system, ROTORS));
        }
        if let (Some(system), Some(due)) = (self.system, self.state.since_when)
            && wall >= due
        {
            self.state.since_when = Some(wall + ASK_EVERY);
            self.send(&message_request(system, FLIGHT));
        }
        if let (Some(system), false, Some(due)) = (self.system, self.truth_requested, self.next_truth_request)
            && wall >= due
        {
            self.next_truth_request = Some(wall + ASK_EVERY);
            for wanted in INSTEAD {
                self.send(&message_interval_request(system, wanted));
            }
        }
    }

    /// The rotors are heard from now on: their outputs are asked for, and again when they fall silent.
    pub fn request_rotor_outputs(&mut self) {
        self.next_rotors.get_or_insert(SimTime::ZERO);
    }

    /// How fast the rotors turn by what the autopilot puts out, rad/s; empty while they stand or nobody says.
    #[must_use]
    pub fn rotors_rad_s(&self, vehicle: &Vehicle) -> Vec<f64> {
        let (idle, full) = (vehicle.rotor.idle_speed_rad_s, vehicle.rotor.max_speed_rad_s);
        let outputs = self.state.outputs.filter(|_| self.state.armed);
        outputs.map_or(Vec::new(), |outputs| outputs.map(|output| idle + output * (full - idle)).to_vec())
    }

    fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.out.push_back(bytes);
    }

    /// The next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// What to draw at a wall time; `None` while nobody has said where the aircraft is.
    pub fn moment(&mut self, wall: SimTime, vehicle: &Vehicle) -> Option<LiveMoment> {
        let at = self.playhead.advance(wall)?;
        let state = &self.state;
        let pose = state.trace.at(at)?;
        let lens = state.trace.lens_at(at).map_or(vehicle.camera, |hfov_rad| Camera { hfov_rad, ..vehicle.camera });
        let gimbal_rad = state.trace.gimbal_at(at);
        let moment = SceneMoment {
            at,
            drone: DronePose { position_m: pose.position_m, ned_from_frd: pose.ned_from_frd, spinning: state.armed },
            velocity_m_s: pose.velocity_m_s,
            camera: CameraPose::on(&vehicle.camera, (pose.position_m, pose.ned_from_frd), gimbal_rad, state.lamp),
            lens,
            turn: state.trace.turn_at(at),
        };
        let told = HudInputs {
            battery_pct: state.battery_pct,
            lift_off: state.lift_off,
            silent_s: self.last_heard.map_or(0.0, |heard| (wall - heard).s().max(0.0)),
            pictures: state.pictures.len(),
            last_picture: state.last_picture,
            flash_s: wall.s(),
        };
        Some(LiveMoment { moment, hud: told, closures: state.closures.clone() })
    }
}

/// The question for a message at a rate, Hz.
fn message_interval_request(system: u8, (id, rate_hz): (u32, f32)) -> MavMessage {
    let params = [id as f32, 1e6 / rate_hz, 0.0, 0.0, 0.0, 0.0, 0.0];
    MavMessage::COMMAND_LONG(station::command(system, AUTOPILOT, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, params))
}

/// The question for a message, once.
fn message_request(system: u8, id: u32) -> MavMessage {
    let params = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    MavMessage::COMMAND_LONG(station::command(system, AUTOPILOT, MavCmd::MAV_CMD_REQUEST_MESSAGE, params))
}

#[cfg(test)]
mod tests;
