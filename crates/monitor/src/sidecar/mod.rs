//! The live sidecar, sans-IO: datagrams and clock in, datagrams and file contents out. The shell owns sockets and files.
//!
//! ```text
//! monitor.handle_datagram(bytes)   then, until empty: poll_transmit(), poll_record()
//! monitor.handle_timeout(now)      at least every 100 ms of wall time
//! monitor.finished()               once Some: write assessment.json, stop
//! ```

use crate::assessment::{AssessError, AssessedSession};
use crate::feedback::{FeedbackRules, texts::TextQueue};
use crate::folder::SessionInfo;
use crate::measures::attention::SiteSurvey;
use crate::measures::on_path::ReferencePaths;
use crate::session::{EndReason, EndRule};
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::modes::ControlSource;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{MavAutopilot, MavMessage, MavSeverity};
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_mavlink::telemetry::timeline::LinkCounts;
use spandrel_mavlink::telemetry::{Timeline, tlog};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::bridge_closures::BridgeClosures;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

mod messages;
mod telemetry_intake;

/// The monitor's component id (MAV_COMP_ID_ONBOARD_COMPUTER).
pub const COMPONENT: u8 = 191;
/// The autopilot's component id (MAV_COMP_ID_AUTOPILOT1).
const AUTOPILOT: u8 = 1;
/// `cues` are repeated at 5 Hz (docs/src/reference/wire.md, "Scoring data").
const CUES_EVERY: SimTime = SimTime::from_ms(200);
/// Heartbeats run on simulation time, so that a run flat out says the same in every run.
const HEARTBEAT_EVERY: SimTime = SimTime::from_ms(1_000);
/// Without simulation time, heartbeats run on wall time at this distance.
const HEARTBEAT_SILENT: SimTime = SimTime::from_ms(2_000);
/// Late datagrams are waited for this long before the score is made.
const SETTLE: SimTime = SimTime::from_ms(500);
/// When the scorer sees no end where the live view saw one, the next try waits this long.
const RETRY: SimTime = SimTime::from_ms(5_000);
/// After an end in sight, silence of this much wall time closes the session.
const SILENCE_CLOSES: SimTime = SimTime::from_ms(3_000);
/// How far from the drone's centre the thing that it touches is looked for, m (estimate: half the largest aircraft).
const TOUCH_REACH_M: f64 = 1.5;

/// Makes the site of a seed.
pub type SurveyBuilder = fn(&Scenario, u64) -> Arc<dyn SiteSurvey>;

/// Builds the real site.
#[must_use]
pub fn build_site(scenario: &Scenario, seed: u64) -> Arc<dyn SiteSurvey> {
    Arc::new(Site::build(scenario, seed))
}

/// What a monitor needs to know.
#[derive(Debug, Clone)]
pub struct MonitorConfig {
    /// Scenario.
    pub scenario: Scenario,
    /// Aircraft.
    pub vehicle: Vehicle,
    /// Who flies.
    pub trainee: String,
    /// What for, where somebody chose: practice or assessment.
    pub purpose: Option<String>,
    /// Wall time of the session's start, µs since the Unix epoch; on a restart that of the first start.
    pub started_unix_us: u64,
    /// System id until the vehicle has been heard: 1 + instance.
    pub system_id: u8,
    /// Seed asked for on the command line; another one on the wire is refused.
    pub seed: Option<u64>,
    /// Makes the site; [`build_site`] outside tests.
    pub survey_builder: SurveyBuilder,
}

/// Something to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SessionOutput {
    /// Append to `telemetry.tlog`.
    Telemetry(Vec<u8>),
    /// Append to `events.jsonl` (a line, with its line end).
    Event(String),
}

/// State of the live view.
#[derive(Debug, Clone, PartialEq)]
struct LiveState {
    truth: Option<Truth>,
    battery_pct: Option<f64>,
    contact: ContactKind,
    /// The running contact is a soft touch of the pad.
    on_pad: bool,
    clearance_m: Option<f64>,
    armed: Option<bool>,
    flown_by: Option<ControlSource>,
    on_ground: bool,
    lift_off: Option<SimTime>,
    current_task: Option<usize>,
    last_task: Option<usize>,
    /// Per task the points of its path that the drone was nearest to while on it.
    visited_points: Vec<Vec<bool>>,
    rule: EndRule,
    end: Option<(SimTime, EndReason)>,
    no_end_before: SimTime,
    cues: i32,
    cues_sent: Option<SimTime>,
    respawns: Option<i32>,
    closures: BridgeClosures,
}

/// The sidecar.
#[derive(Debug, Clone)]
pub struct Monitor {
    config: MonitorConfig,
    paths: ReferencePaths,
    decoder: Decoder,
    encoder: Encoder,
    timeline: Timeline,
    /// Wall time of simulation time zero, µs since the Unix epoch, once a truth has come.
    zero_unix_us: Option<u64>,
    feedback: FeedbackRules,
    texts: TextQueue,
    live: LiveState,
    survey: Option<Arc<dyn SiteSurvey>>,
    seed: Option<u64>,
    out: VecDeque<Vec<u8>>,
    records: VecDeque<SessionOutput>,
    replaying: bool,
    heartbeat_sim: Option<SimTime>,
    heartbeat_wall: Option<SimTime>,
    last_heard_wall: Option<SimTime>,
    vehicle_heard: bool,
    refusal: Option<AssessError>,
    outcome: Option<Result<AssessedSession, AssessError>>,
}

impl Monitor {
    /// A monitor at the start of a session.
    #[must_use]
    pub fn new(config: MonitorConfig) -> Self {
        let scenario = &config.scenario;
        Self {
            paths: ReferencePaths::new(scenario),
            decoder: Decoder::new(),
            encoder: Encoder::new(config.system_id, COMPONENT),
            timeline: Timeline::new(LocalPlane::new(scenario.origin)),
            zero_unix_us: None,
            feedback: FeedbackRules::new(scenario),
            texts: TextQueue::default(),
            live: LiveState::new(&config),
            survey: None,
            seed: config.seed.or(scenario.seed),
            out: VecDeque::new(),
            records: VecDeque::new(),
            replaying: false,
            heartbeat_sim: None,
            heartbeat_wall: None,
            last_heard_wall: None,
            vehicle_heard: false,
            refusal: None,
            outcome: None,
            config,
        }
    }

    /// A monitor that goes on where a killed one stopped: `log` is what `telemetry.tlog` holds. The shell cuts the file to
    /// [`tlog::whole_len`] before it appends.
    ///
    /// # Errors
    /// When the log cannot be read.
    pub fn resume(config: MonitorConfig, log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<Self> {
        let mut monitor = Self::new(config);
        monitor.replaying = true;
        log.for_each_record(&mut |record| {
            monitor.zero_unix_us = monitor.zero_unix_us.or_else(|| tlog::zero_us(&record));
            for received in monitor.decoder.datagram(record.frame) {
                monitor.take_frame(&received);
            }
            ControlFlow::Continue(())
        })?;
        monitor.replaying = false;
        let resumed_at_s = monitor.now().s();
        monitor.event("monitor_restarted", serde_json::json!({ "at_s": resumed_at_s }));
        Ok(monitor)
    }

    /// Whether the vehicle sends this datagram: it holds a frame of the autopilot's component, and of the system whose flight is scored as
    /// soon as there is one.
    #[must_use]
    pub fn is_from_vehicle(&self, bytes: &[u8]) -> bool {
        let system = self.timeline.system();
        let beats = |frame: &ReceivedFrame| match &frame.message {
            Some(MavMessage::HEARTBEAT(beat)) => beat.autopilot != MavAutopilot::MAV_AUTOPILOT_INVALID,
            message => message.is_some() && system.is_some(),
        };
        let fits =
            |frame: &ReceivedFrame| frame.component_id == AUTOPILOT && system.is_none_or(|system| system == frame.system_id);
        Decoder::new().datagram(bytes).iter().any(|frame| fits(frame) && beats(frame))
    }

    /// Takes one datagram from the vehicle. The site is built while the first `seed` is handled, which may take a while.
    pub fn handle_datagram(&mut self, bytes: &[u8]) {
        self.vehicle_heard = true;
        for received in self.decoder.datagram(bytes) {
            if self.outcome.is_none() {
                let stamp = self.stamp_us(&received);
                self.records.push_back(SessionOutput::Telemetry(tlog::record(stamp, &received.bytes)));
                self.take_frame(&received);
                self.take_note(&received);
            }
            self.handle_command(&received);
        }
    }

    /// Tells the wall time since some fixed instant; needed only while simulation time stands still.
    pub fn handle_timeout(&mut self, wall: SimTime) {
        if std::mem::take(&mut self.vehicle_heard) || self.last_heard_wall.is_none() {
            self.last_heard_wall = Some(wall);
        }
        if self.heartbeat_wall.is_none_or(|last| wall - last >= HEARTBEAT_SILENT) {
            self.heartbeat();
            self.heartbeat_wall = Some(wall);
        }
        let silent = self.last_heard_wall.is_some_and(|heard| wall - heard >= SILENCE_CLOSES);
        if silent && self.live.end.is_some() {
            self.close();
        }
    }

    /// The next datagram for the vehicle.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// The next thing to write.
    pub fn poll_record(&mut self) -> Option<SessionOutput> {
        self.records.pop_front()
    }

    /// The result, once the session is over.
    #[must_use]
    pub fn finished(&self) -> Option<&Result<AssessedSession, AssessError>> {
        self.outcome.as_ref()
    }

    /// Why this simulator's telemetry is refused.
    #[must_use]
    pub fn refused(&self) -> Option<&AssessError> {
        self.refusal.as_ref()
    }

    /// Ends the session now (somebody aborts, or the link is closed) and scores what there is.
    pub fn close(&mut self) {
        if self.outcome.is_none() {
            let outcome = self.score();
            self.finish(outcome);
        }
    }

    /// Sends the pilot a text and records it as an event.
    pub fn notify_pilot(&mut self, words: &str, severity: MavSeverity) {
        self.text(words, severity);
    }

    /// Frees the flight once its session is over and written; the assessment stays.
    pub fn release_flight(&mut self) {
        self.timeline = Timeline::new(LocalPlane::new(self.config.scenario.origin));
        self.survey = None;
        self.records = VecDeque::new();
        if let Some(Ok(graded)) = &mut self.outcome {
            graded.frames = Vec::new();
        }
    }

    /// Newest simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.timeline.newest().unwrap_or(SimTime::ZERO)
    }

    /// Flight time so far; `None` before lift-off.
    #[must_use]
    pub fn flight_time(&self) -> Option<SimTime> {
        self.live.lift_off.map(|start| self.now().saturating_sub(start))
    }

    /// Mask of the cues that are on.
    #[must_use]
    pub fn cues(&self) -> i32 {
        self.live.cues
    }

    /// Number of the task whose path the drone is on.
    #[must_use]
    pub fn task(&self) -> Option<u32> {
        self.live.current_task.map(|task| self.config.scenario.tasks[task].id)
    }

    /// Battery, %.
    #[must_use]
    pub fn battery_pct(&self) -> Option<f64> {
        self.live.battery_pct
    }

    /// What the link did.
    #[must_use]
    pub fn link(&self) -> LinkCounts {
        self.timeline.counts()
    }

    /// Seed, once known.
    #[must_use]
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// The site, once the seed is known.
    #[must_use]
    pub fn survey(&self) -> Option<&Arc<dyn SiteSurvey>> {
        self.survey.as_ref()
    }

    /// `session.json`; the shell gives the hashes and the UTC text.
    #[must_use]
    pub fn session_info(
        &self,
        scenario_toml: &[u8],
        vehicle_toml: &[u8],
        started_utc: String,
        monitor_starts: u32,
    ) -> SessionInfo {
        SessionInfo {
            trainee: self.config.trainee.clone(),
            started_unix_us: self.config.started_unix_us,
            started_utc,
            spandrel_version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: self.config.scenario.name.clone(),
            scenario_crc: format!("{:08x}", self.config.scenario.crc),
            scenario_sha256: super::folder::sha256_hex(scenario_toml),
            vehicle: self.config.vehicle.id.clone(),
            vehicle_sha256: super::folder::sha256_hex(vehicle_toml),
            seed: self.seed,
            purpose: self.config.purpose.clone(),
            monitor_starts,
            link: self.link(),
            bad_bytes: self.decoder.bad_bytes(),
        }
    }
}

impl LiveState {
    fn new(config: &MonitorConfig) -> Self {
        Self {
            truth: None,
            battery_pct: None,
            contact: ContactKind::None,
            on_pad: false,
            clearance_m: None,
            armed: None,
            flown_by: None,
            on_ground: false,
            lift_off: None,
            current_task: None,
            last_task: None,
            visited_points: config.scenario.tasks.iter().map(|task| vec![false; task.path_m.len()]).collect(),
            rule: EndRule::new(&config.scenario, &config.vehicle),
            end: None,
            no_end_before: SimTime::ZERO,
            cues: 0,
            cues_sent: None,
            respawns: None,
            closures: BridgeClosures::default(),
        }
    }
}
