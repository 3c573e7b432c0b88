//! A live flight from telemetry: processes datagrams and returns the moment to draw. It subscribes to telemetry like
//! any other client, so it can show any MAVLink vehicle: the simulated vehicle from ground truth, other vehicles from
//! their own estimates. It does not access sockets or clocks.

pub mod clock;
mod estimate;
mod other_traces;
mod series;
mod trace;
mod video;

pub use trace::MotionHistory;
pub use video::VideoStatus;

use super::feed::Feed;
use super::flown_path::FlownPath;
use super::scene::DronePose;
use super::stage::{HudInputs, LIFTOFF_HEIGHT_M, SceneMoment};
use clock::Playhead;
use estimate::EstimatedPose;
use other_traces::OtherTraces;
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::contract::continuity::RESTART_CONFIRM_COUNT;
use spandrel_mavlink::contract::continuity::RESTART_THRESHOLD;
use spandrel_mavlink::contract::other_drones::{self, OtherDrone};
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_mavlink::station;
use spandrel_mavlink::telemetry::sample::{self, Sample, SampleContent, SampleValue};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::CameraPose;
use spandrel_model::site::aircraft_hull::{BodyProbe, hull_radius_m};
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::drones::{LiveDrone, live_drone_object};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// System ID of a viewer, distinct from those of vehicles and ground stations (255 is QGroundControl, 254 is `spandrel
/// rc`).
pub const SYSTEM_ID: u8 = 253;
/// MAV_COMP_ID_ONBOARD_COMPUTER2: distinct from the monitor's.
const COMPONENT_ID: u8 = 192;
const AUTOPILOT_COMPONENT: u8 = 1;
const HEARTBEAT_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// After this time without ground truth, this client assumes that the vehicle is real and requests its estimates.
const TRUTH_TIMEOUT: SimTime = SimTime::from_ms(3_000);
/// Interval for repeating requests, in case one is lost.
const REQUEST_INTERVAL: SimTime = SimTime::from_ms(5_000);
/// Messages used instead of ground truth, and their rates, Hz: ATTITUDE_QUATERNION, GLOBAL_POSITION_INT,
/// GIMBAL_DEVICE_ATTITUDE_STATUS.
const ESTIMATE_STREAMS: [(u32, f32); 3] = [(31, 50.0), (33, 50.0), (285, 25.0)];
/// SERVO_OUTPUT_RAW and its requested rate, Hz, for the rotor sound (a delay of 0.1 s between picture and sound is
/// noticeable).
const ROTOR_STREAM: (u32, f32) = (36, 20.0);
/// OBSTACLE_DISTANCE and its requested rate, Hz.
const OBSTACLE_STREAM: (u32, f32) = (330, 10.0);
/// FLIGHT_INFORMATION, which contains the takeoff time, for viewers that connect during a flight.
const FLIGHT_INFORMATION_ID: u32 = 264;
/// Pulse widths of idle and full outputs, µs (SERVO_OUTPUT_RAW).
const PULSE_RANGE_US: (f64, f64) = (1_000.0, 2_000.0);
/// Maximum time between pictures of an active video stream; a hidden window renders no pictures.
const VIDEO_TIMEOUT: SimTime = SimTime::from_ms(3_000);

/// State of a live flight.
#[derive(Debug, Clone)]
pub struct LiveFlight {
    plane: LocalPlane,
    pad_height_m: f64,
    decoder: Decoder,
    encoder: Encoder,
    out: VecDeque<Vec<u8>>,
    next_heartbeat: SimTime,
    next_truth_request: Option<SimTime>,
    system: Option<u8>,
    /// Wall time of the first message from the vehicle.
    first_message_at: Option<SimTime>,
    seed: Option<u64>,
    scenario_crc: Option<u32>,
    /// Wall time of the next request for rotor outputs; `None` if they are not needed.
    next_rotors: Option<SimTime>,
    /// Wall time of the next request for distances of obstacles; `None` if they are not needed.
    next_obstacles: Option<SimTime>,
    truth_requested: bool,
    estimate: EstimatedPose,
    time_reversals: usize,
    last_sample_at: Option<SimTime>,
    playhead: Playhead,
    state: SimulatorRun,
    /// Video stream status and wall time of its last picture.
    video: Option<(VideoStatus, SimTime)>,
}

/// State that is reset when the simulator restarts.
#[derive(Debug, Clone, Default)]
struct SimulatorRun {
    feed: Feed,
    trace: MotionHistory,
    others: OtherTraces,
    flown: FlownPath,
    lamp: bool,
    armed: bool,
    is_frozen: bool,
    /// Rotor outputs, 0 to 1; `None` while disarmed.
    outputs: Option<[f64; 4]>,
    battery_pct: Option<f64>,
    lift_off: Option<SimTime>,
    /// Wall time of the next request for the takeoff time, if the vehicle was already flying when its first position
    /// arrived.
    next_takeoff_request: Option<SimTime>,
    pictures: BTreeSet<(i32, Option<SimTime>)>,
    last_picture: Option<SimTime>,
    site_changes: SiteChanges,
}

/// The moment to draw, with its HUD inputs and the changes of the site.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveMoment {
    /// State of the aircraft and its camera.
    pub moment: SceneMoment,
    /// Additional HUD inputs.
    pub hud: HudInputs,
    /// Bridge closures and walks of the inspector.
    pub site_changes: SiteChanges,
    /// Other vehicles that share the site.
    pub others: Vec<OtherDrone>,
}

impl LiveMoment {
    /// Returns the other vehicles as parts of the site. They have the hull of this aircraft.
    #[must_use]
    pub fn live_drones(&self, parts: &Arc<[BodyProbe]>) -> Vec<LiveDrone> {
        let here_m = self.moment.drone.pose.position_m;
        let drone = |other: &OtherDrone| LiveDrone {
            object: live_drone_object(other.system_id.saturating_sub(1)),
            parts: Arc::clone(parts),
            reach_m: hull_radius_m(parts),
            position_m: here_m + other.offset_m.enu(),
            attitude: other.attitude,
            armed: other.armed,
        };
        self.others.iter().map(drone).collect()
    }

    /// Returns the time since lift-off, s; 0 before it.
    #[must_use]
    pub fn flown_s(&self) -> f64 {
        self.hud.lift_off.map_or(0.0, |begun| (self.moment.at - begun).s())
    }
}

impl LiveFlight {
    /// Creates the state before the first datagram.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            plane: LocalPlane::new(scenario.origin),
            pad_height_m: scenario.ground_team.pad_m.up(),
            decoder: Decoder::new(),
            encoder: Encoder::new(SYSTEM_ID, COMPONENT_ID),
            out: VecDeque::new(),
            next_heartbeat: SimTime::ZERO,
            next_truth_request: None,
            system: None,
            first_message_at: None,
            seed: None,
            scenario_crc: None,
            next_rotors: None,
            next_obstacles: None,
            truth_requested: false,
            estimate: EstimatedPose::default(),
            time_reversals: 0,
            last_sample_at: None,
            playhead: Playhead::default(),
            state: SimulatorRun::default(),
            video: None,
        }
    }

    /// Returns the vehicle's system ID, once received.
    #[must_use]
    pub fn system(&self) -> Option<u8> {
        self.system
    }

    /// Returns the session's seed, once received; it determines defects and traffic.
    #[must_use]
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// Returns the checksum of the simulator's scenario, once received.
    #[must_use]
    pub fn scenario_crc(&self) -> Option<u32> {
        self.scenario_crc
    }

    /// Checks whether the poses are the vehicle's own estimate, because no ground truth is available.
    #[must_use]
    pub fn is_estimated(&self) -> bool {
        self.last_sample_at.is_some() && !self.truth_requested
    }

    /// Checks whether no ground truth has arrived despite a request. Such a vehicle is not the simulator and does not
    /// send a seed.
    #[must_use]
    pub fn has_no_truth(&self, wall: SimTime) -> bool {
        !self.truth_requested && self.first_message_at.is_some_and(|met| wall >= met + TRUTH_TIMEOUT + TRUTH_TIMEOUT)
    }

    /// Returns the path flown so far.
    #[must_use]
    pub fn flown_path(&self) -> &FlownPath {
        &self.state.flown
    }

    /// Returns the flight mode, satellites, cues, and texts.
    #[must_use]
    pub fn feed(&self) -> &Feed {
        &self.state.feed
    }

    /// Processes a datagram received at the given wall time.
    pub fn handle_datagram(&mut self, bytes: &[u8], wall: SimTime) {
        for frame in self.decoder.datagram(bytes) {
            self.handle_frame(&frame, wall);
        }
    }

    fn handle_frame(&mut self, frame: &ReceivedFrame, wall: SimTime) {
        let beats = matches!(frame.message, Some(MavMessage::HEARTBEAT(_))) && frame.component_id == AUTOPILOT_COMPONENT;
        if self.system.is_none() && (beats || sample::truth_time(&frame.bytes).is_some()) {
            self.system = Some(frame.system_id);
            self.first_message_at = Some(wall);
            self.next_truth_request = Some(wall + TRUTH_TIMEOUT);
        }
        if self.system != Some(frame.system_id) {
            return;
        }
        let now = self.state.trace.newest().unwrap_or_default();
        if Feed::is_relevant(frame.message_id) {
            self.state.feed.handle_frame(frame, now);
        }
        if let Some(MavMessage::SERVO_OUTPUT_RAW(servos)) = &frame.message {
            self.next_rotors = self.next_rotors.map(|_| wall + REQUEST_INTERVAL);
            let pulses = [servos.servo1_raw, servos.servo2_raw, servos.servo3_raw, servos.servo4_raw].map(f64::from);
            let turn = pulses.iter().any(|pulse| *pulse >= PULSE_RANGE_US.0);
            self.state.outputs = turn.then(|| {
                pulses.map(|pulse| ((pulse - PULSE_RANGE_US.0) / (PULSE_RANGE_US.1 - PULSE_RANGE_US.0)).clamp(0.0, 1.0))
            });
        }
        if matches!(frame.message, Some(MavMessage::OBSTACLE_DISTANCE(_))) {
            self.next_obstacles = self.next_obstacles.map(|_| wall + REQUEST_INTERVAL);
        }
        if let Some(MavMessage::DEBUG_FLOAT_ARRAY(array)) = &frame.message
            && let Some(others) = frame.message.as_ref().and_then(other_drones::of)
        {
            self.state.others.push(SimTime::from_us(i64::try_from(array.time_usec).unwrap_or(0)), others);
        }
        if let (Some(MavMessage::FLIGHT_INFORMATION(flight)), Some(_)) = (&frame.message, self.state.next_takeoff_request)
            && let Ok(took_off_us @ 1..) = i64::try_from(flight.takeoff_time_utc)
        {
            // The field contains the time since boot despite its name (MAVLink common).
            (self.state.lift_off, self.state.next_takeoff_request) = (Some(SimTime::from_us(took_off_us)), None);
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
                    // Ground truth replaces the estimates, which may use a different clock.
                    self.truth_requested = true;
                    self.restart();
                }
                self.handle_truth(truth, wall);
            }
            SampleContent::Value(value) => {
                if value == SampleValue::Frozen(true) {
                    // While simulation time is stopped, there is no ground truth, but the link is not lost.
                    self.last_sample_at = self.last_sample_at.map(|_| wall);
                }
                self.handle_value(value, sample.message_time);
            }
        }
    }

    fn handle_value(&mut self, value: SampleValue, message_time: Option<SimTime>) {
        let now = self.state.trace.newest().unwrap_or_default();
        let state = &mut self.state;
        let time = message_time.filter(|own| *own <= now + RESTART_THRESHOLD).unwrap_or(now);
        match value {
            SampleValue::GimbalPitch(pitch_rad) => state.trace.push_gimbal(time, pitch_rad),
            SampleValue::Light(on) => state.lamp = on,
            SampleValue::Battery(pct) => state.battery_pct = Some(pct),
            SampleValue::FieldOfView(rad) => state.trace.push_lens(time, rad),
            SampleValue::Heartbeat { armed, .. } => state.armed = armed,
            SampleValue::Snapshot(number) => {
                if state.pictures.insert((number, message_time)) {
                    state.last_picture = Some(message_time.unwrap_or(now));
                }
            }
            SampleValue::Frozen(on) => state.is_frozen = on,
            SampleValue::Traffic(code) => state.site_changes.closures.apply_code(code),
            SampleValue::Walk(code) => state.site_changes.walks.apply_code(code),
            SampleValue::Seed(seed) => self.handle_seed(seed),
            SampleValue::ScenarioCrc(crc) => self.scenario_crc = Some(crc),
            SampleValue::Sticks(_)
            | SampleValue::Contact(_)
            | SampleValue::Hits(_)
            | SampleValue::Respawns(_)
            | SampleValue::Freezes(_)
            | SampleValue::Rewinds(_)
            | SampleValue::Clearance(_)
            | SampleValue::OnGround(_) => {}
        }
    }

    fn handle_truth(&mut self, truth: Truth, wall: SimTime) {
        if self.state.trace.newest().is_some_and(|newest| truth.time + RESTART_THRESHOLD < newest) {
            self.time_reversals += 1;
            if self.time_reversals < RESTART_CONFIRM_COUNT {
                return;
            }
            self.restart();
            // A restarted simulator sends its own seed and checksum.
            (self.seed, self.scenario_crc) = (None, None);
        }
        self.time_reversals = 0;
        self.last_sample_at = Some(wall);
        self.playhead.handle_sample_time(wall, truth.time);
        if self.state.lift_off.is_none() && truth.motion.position_m.up() - self.pad_height_m > LIFTOFF_HEIGHT_M {
            self.state.lift_off = Some(truth.time);
            self.state.next_takeoff_request = self.state.trace.newest().is_none().then_some(wall);
        }
        self.state.flown.push(truth.motion.position_m);
        self.state.trace.push(truth);
    }

    /// Handles a seed. A different seed means a new session, even if the clock has not gone backward.
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

    /// Sets the status of the camera view's video stream and the wall time of its last picture; `None` if the stream is
    /// off. The vehicle receives the status every second and announces the stream.
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

    /// Queues the periodic messages: a heartbeat, which registers this client with the vehicle, and requests to a
    /// vehicle without ground truth.
    pub fn handle_timeout(&mut self, wall: SimTime) {
        if wall >= self.next_heartbeat {
            self.next_heartbeat = wall + HEARTBEAT_INTERVAL;
            self.send(&station::companion_heartbeat());
            match self.video {
                Some((_, last)) if wall.saturating_sub(last) > VIDEO_TIMEOUT => self.end_video(),
                Some((video, _)) => self.send(&video.status(true)),
                None => {}
            }
        }
        if let (Some(system), Some(due)) = (self.system, self.next_rotors)
            && wall >= due
        {
            self.next_rotors = Some(wall + REQUEST_INTERVAL);
            self.send(&message_interval_request(system, ROTOR_STREAM));
        }
        if let (Some(system), Some(due)) = (self.system, self.next_obstacles)
            && wall >= due
        {
            self.next_obstacles = Some(wall + REQUEST_INTERVAL);
            self.send(&message_interval_request(system, OBSTACLE_STREAM));
        }
        if let (Some(system), Some(due)) = (self.system, self.state.next_takeoff_request)
            && wall >= due
        {
            self.state.next_takeoff_request = Some(wall + REQUEST_INTERVAL);
            self.send(&message_request(system, FLIGHT_INFORMATION_ID));
        }
        if let (Some(system), false, Some(due)) = (self.system, self.truth_requested, self.next_truth_request)
            && wall >= due
        {
            self.next_truth_request = Some(wall + REQUEST_INTERVAL);
            for wanted in ESTIMATE_STREAMS {
                self.send(&message_interval_request(system, wanted));
            }
        }
    }

    /// Requests rotor outputs, and repeats the request whenever they stop.
    pub fn request_rotor_outputs(&mut self) {
        self.next_rotors.get_or_insert(SimTime::ZERO);
    }

    /// Requests distances of obstacles, and repeats the request whenever they stop.
    pub fn request_obstacles(&mut self) {
        self.next_obstacles.get_or_insert(SimTime::ZERO);
    }

    /// Returns the rotor speeds, in rad/s, calculated from the autopilot's outputs; empty if the rotors are stopped or
    /// their speed is unknown.
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

    /// Returns the next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// Returns the moment to draw at the given wall time, or `None` before the first position.
    pub fn moment(&mut self, wall: SimTime, vehicle: &Vehicle) -> Option<LiveMoment> {
        let at = self.playhead.advance(wall)?;
        let state = &self.state;
        let motion = state.trace.at(at)?;
        let lens = state.trace.lens_at(at).map_or(vehicle.camera, |hfov_rad| Camera { hfov_rad, ..vehicle.camera });
        let gimbal_rad = state.trace.gimbal_at(at);
        let moment = SceneMoment {
            at,
            drone: DronePose { pose: motion.pose(), spinning: state.armed },
            velocity_m_s: motion.velocity_m_s,
            camera: CameraPose::on_aircraft(&vehicle.camera, motion.pose(), gimbal_rad, state.lamp),
            lens,
            turn: state.trace.turn_at(at),
        };
        let told = HudInputs {
            battery_pct: state.battery_pct,
            lift_off: state.lift_off,
            telemetry_age_s: self.last_sample_at.map_or(0.0, |heard| (wall - heard).s().max(0.0)),
            pictures: state.pictures.len(),
            last_picture: state.last_picture,
            blink_time_s: wall.s(),
            is_frozen: state.is_frozen,
        };
        Some(LiveMoment { moment, hud: told, site_changes: state.site_changes.clone(), others: state.others.at(at) })
    }
}

/// Returns a request to send a message at the given rate in Hz.
fn message_interval_request(system: u8, (id, rate_hz): (u32, f32)) -> MavMessage {
    let params = [id as f32, 1e6 / rate_hz, 0.0, 0.0, 0.0, 0.0, 0.0];
    MavMessage::COMMAND_LONG(station::command(system, AUTOPILOT_COMPONENT, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, params))
}

/// Returns a request to send a message once.
fn message_request(system: u8, id: u32) -> MavMessage {
    let params = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    MavMessage::COMMAND_LONG(station::command(system, AUTOPILOT_COMPONENT, MavCmd::MAV_CMD_REQUEST_MESSAGE, params))
}

#[cfg(test)]
mod tests;
