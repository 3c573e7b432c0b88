//! The live monitor processes datagrams and clock updates and returns datagrams and file contents. It performs no I/O;
//! the application manages sockets and files.
//!
//! ```text
//! monitor.handle_datagram(bytes)   then, until both return None: poll_transmit(), poll_record()
//! monitor.handle_timeout(now)      at least every 100 ms of wall time
//! monitor.finished()               if Some: write assessment.json and stop
//! ```

use crate::assessment::{AssessError, AssessedSession};
use crate::detour::DetourFinder;
use crate::feedback::{FeedbackRules, texts::TextQueue};
use crate::folder::SessionInfo;
use crate::guidance::StepAnnouncer;
use crate::lesson::LessonCoach;
use crate::measures::attention::SiteSurvey;
use crate::measures::coverage::FlownPath;
use crate::measures::on_path::ReferencePaths;
use crate::score::certification::job_time;
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
use spandrel_model::scenario::{GuidancePolicy, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::{BTreeMap, VecDeque};
use std::ops::ControlFlow;
use std::sync::Arc;

mod messages;
mod teaching;
mod telemetry_intake;

/// The monitor's component ID (MAV_COMP_ID_ONBOARD_COMPUTER).
pub const MONITOR_COMPONENT_ID: u8 = 191;
/// The autopilot's component ID (MAV_COMP_ID_AUTOPILOT1).
const AUTOPILOT_COMPONENT_ID: u8 = 1;
/// Purpose of a session that is an assessment, in `session.json`.
const ASSESSMENT: &str = "assessment";
/// Interval between two `guidance` messages (estimate: smooth enough for a display).
const GUIDANCE_INTERVAL: SimTime = SimTime::from_ms(200);
/// Interval at which the monitor repeats `cues`, 5 Hz (docs/src/reference/wire.md, "Scoring data").
const CUES_INTERVAL: SimTime = SimTime::from_ms(200);
/// Heartbeat interval in simulation time, which keeps runs reproducible at any simulation speed.
const HEARTBEAT_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Heartbeat interval in wall-clock time, used while no simulation time is received.
const HEARTBEAT_WALL_INTERVAL: SimTime = SimTime::from_ms(2_000);
/// Time to wait for late datagrams before scoring.
const SCORING_DELAY: SimTime = SimTime::from_ms(500);
/// Delay before the monitor retries scoring if the live rule detected the session's end but the scorer did not.
const END_RETRY_DELAY: SimTime = SimTime::from_ms(5_000);
/// Wall-clock time without telemetry after which the monitor closes an ended session.
const SILENCE_TIMEOUT: SimTime = SimTime::from_ms(3_000);
/// Radius around the drone's center to search for the object in contact, m (estimate: half the size of the largest
/// aircraft).
const CONTACT_SEARCH_RADIUS_M: f64 = 1.5;

/// Function that builds the site for a seed.
pub type SurveyBuilder = fn(&Scenario, u64) -> Arc<dyn SiteSurvey>;

/// Builds the real site; the default [`SurveyBuilder`].
#[must_use]
pub fn build_site(scenario: &Scenario, seed: u64) -> Arc<dyn SiteSurvey> {
    Arc::new(Site::build(scenario, seed))
}

/// Monitor configuration.
#[derive(Debug, Clone)]
pub struct MonitorConfig {
    /// The session's scenario.
    pub scenario: Scenario,
    /// Aircraft flown in the session.
    pub vehicle: Vehicle,
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    pub purpose: Option<String>,
    /// Wall-clock time of the session's first start, µs since the Unix epoch. Unchanged if the monitor restarts.
    pub started_unix_us: u64,
    /// System ID (1 + instance number) that the monitor uses until it detects the vehicle.
    pub system_id: u8,
    /// Seed specified on the command line. Telemetry with a different seed is rejected.
    pub seed: Option<u64>,
    /// Function that builds the site; [`build_site`] except in tests.
    pub survey_builder: SurveyBuilder,
}

/// Data to write to the session folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SessionOutput {
    /// Bytes to append to `telemetry.tlog`.
    Telemetry(Vec<u8>),
    /// Line to append to `events.jsonl`, including the newline.
    Event(String),
}

/// State of the monitored flight.
#[derive(Debug, Clone, PartialEq)]
struct LiveState {
    truth: Option<Truth>,
    battery_pct: Option<f64>,
    contact: ContactKind,
    /// The most severe contact since the last check for the session's end: one may end before the next position arrives.
    touched: ContactKind,
    /// Whether the current contact is a soft touchdown on the pad.
    on_pad: bool,
    clearance_m: Option<f64>,
    armed: Option<bool>,
    flown_by: Option<ControlSource>,
    /// Whether the aircraft flies home or lands by itself.
    is_return: bool,
    on_ground: bool,
    camera_pitch_rad: f64,
    /// Horizontal field of view, once received; `None` for a fixed lens.
    camera_fov_rad: Option<f64>,
    lamp: bool,
    lift_off: Option<SimTime>,
    current_task: Option<usize>,
    last_task: Option<usize>,
    /// For each task, the part of its path that was flown.
    flown: Vec<FlownPath>,
    /// For each task, the share of its path that was flown.
    flown_shares: Vec<f64>,
    /// For each task, whether enough of its path was flown for the task to be done.
    done: Vec<bool>,
    /// For each task, whether nothing of its path remains to be flown.
    finished: Vec<bool>,
    end_rule: EndRule,
    end: Option<(SimTime, EndReason)>,
    next_end_check: SimTime,
    cues: i32,
    cues_sent: Option<SimTime>,
    respawns: Option<i32>,
    /// Latest number of freezes and of rewinds, by event name.
    practice_aids: BTreeMap<&'static str, i32>,
    changes: SiteChanges,
}

/// Returns whether the monitor guides the pilot in a session with this purpose.
fn guides(policy: GuidancePolicy, purpose: Option<&str>) -> bool {
    match policy {
        GuidancePolicy::Always => true,
        GuidancePolicy::Practice => purpose != Some(ASSESSMENT),
        GuidancePolicy::Never => false,
    }
}

/// Returns the lesson before its first step, if the job is one and the monitor guides the pilot.
fn new_lesson(scenario: &Scenario, guides: bool) -> Option<LessonCoach> {
    LessonCoach::new(&scenario.lesson).filter(|_| guides)
}

/// Live monitor of one session.
#[derive(Debug, Clone)]
pub struct Monitor {
    config: MonitorConfig,
    paths: ReferencePaths,
    decoder: Decoder,
    encoder: Encoder,
    timeline: Timeline,
    /// Wall-clock time at simulation time zero, µs since the Unix epoch; `None` until a truth message is received.
    zero_unix_us: Option<u64>,
    feedback: FeedbackRules,
    texts: TextQueue,
    guides: bool,
    announcer: StepAnnouncer,
    guidance_sent: Option<SimTime>,
    detours: DetourFinder,
    /// The lesson, if the job is one.
    lesson: Option<LessonCoach>,
    lesson_sent: Option<SimTime>,
    /// Time that the job needs, s.
    needed_s: f64,
    live: LiveState,
    survey: Option<Arc<dyn SiteSurvey>>,
    seed: Option<u64>,
    outgoing: VecDeque<Vec<u8>>,
    records: VecDeque<SessionOutput>,
    replaying: bool,
    last_heartbeat_sim_time: Option<SimTime>,
    last_heartbeat_wall_time: Option<SimTime>,
    last_received_wall_time: Option<SimTime>,
    vehicle_received: bool,
    rejection: Option<AssessError>,
    outcome: Option<Result<AssessedSession, AssessError>>,
}

impl Monitor {
    /// Creates a monitor for a new session.
    #[must_use]
    pub fn new(config: MonitorConfig) -> Self {
        let scenario = &config.scenario;
        let paths = ReferencePaths::new(scenario);
        let guides = guides(scenario.feedback.guidance, config.purpose.as_deref());
        Self {
            decoder: Decoder::new(),
            encoder: Encoder::new(config.system_id, MONITOR_COMPONENT_ID),
            timeline: Timeline::new(LocalPlane::new(scenario.origin)),
            zero_unix_us: None,
            feedback: FeedbackRules::new(scenario),
            texts: TextQueue::default(),
            guides,
            announcer: StepAnnouncer::default(),
            guidance_sent: None,
            detours: DetourFinder::default(),
            lesson: new_lesson(scenario, guides),
            lesson_sent: None,
            needed_s: job_time::job_needed_s(scenario),
            live: LiveState::new(&config, &paths),
            survey: None,
            paths,
            seed: config.seed.or(scenario.seed),
            outgoing: VecDeque::new(),
            records: VecDeque::new(),
            replaying: false,
            last_heartbeat_sim_time: None,
            last_heartbeat_wall_time: None,
            last_received_wall_time: None,
            vehicle_received: false,
            rejection: None,
            outcome: None,
            config,
        }
    }

    /// Creates a monitor that resumes an interrupted session. `log` is the content of `telemetry.tlog`. Before appending to that
    /// file, the application must truncate it to [`tlog::complete_len`].
    ///
    /// # Errors
    /// Fails if the log cannot be read.
    pub fn resume(config: MonitorConfig, log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<Self> {
        let mut monitor = Self::new(config);
        monitor.replaying = true;
        log.for_each_record(&mut |record| {
            monitor.zero_unix_us = monitor.zero_unix_us.or_else(|| tlog::record_simulation_zero_us(&record));
            for received in monitor.decoder.datagram(record.frame) {
                monitor.ingest_frame(&received);
            }
            ControlFlow::Continue(())
        })?;
        monitor.replaying = false;
        let resumed_at_s = monitor.now().s();
        monitor.event("monitor_restarted", serde_json::json!({ "at_s": resumed_at_s }));
        Ok(monitor)
    }

    /// Returns whether a datagram comes from the vehicle: it contains a frame from the autopilot component and, once
    /// there is a scored flight, from the same system.
    #[must_use]
    pub fn is_from_vehicle(&self, bytes: &[u8]) -> bool {
        let system = self.timeline.system();
        let beats = |frame: &ReceivedFrame| match &frame.message {
            Some(MavMessage::HEARTBEAT(beat)) => beat.autopilot != MavAutopilot::MAV_AUTOPILOT_INVALID,
            message => message.is_some() && system.is_some(),
        };
        let fits = |frame: &ReceivedFrame| {
            frame.component_id == AUTOPILOT_COMPONENT_ID && system.is_none_or(|system| system == frame.system_id)
        };
        Decoder::new().datagram(bytes).iter().any(|frame| fits(frame) && beats(frame))
    }

    /// Processes a datagram from the vehicle. The first `seed` message causes the site to be built, which can take a
    /// while.
    pub fn handle_datagram(&mut self, bytes: &[u8]) {
        self.vehicle_received = true;
        for received in self.decoder.datagram(bytes) {
            if self.outcome.is_none() {
                let stamp = self.log_timestamp_us(&received);
                self.records.push_back(SessionOutput::Telemetry(tlog::record(stamp, &received.bytes)));
                self.ingest_frame(&received);
                self.log_instructor_note(&received);
            }
            self.handle_command(&received);
        }
    }

    /// Updates the wall-clock time, measured from an arbitrary fixed instant. Required only while simulation time does
    /// not advance.
    pub fn handle_timeout(&mut self, wall: SimTime) {
        if std::mem::take(&mut self.vehicle_received) || self.last_received_wall_time.is_none() {
            self.last_received_wall_time = Some(wall);
        }
        if self.last_heartbeat_wall_time.is_none_or(|last| wall - last >= HEARTBEAT_WALL_INTERVAL) {
            self.heartbeat();
            self.last_heartbeat_wall_time = Some(wall);
        }
        let silent = self.last_received_wall_time.is_some_and(|heard| wall - heard >= SILENCE_TIMEOUT);
        if silent && self.live.end.is_some() {
            self.close();
        }
    }

    /// Returns the next datagram to send to the vehicle, if any.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.outgoing.pop_front()
    }

    /// Returns the next data to write to the session folder, if any.
    pub fn poll_record(&mut self) -> Option<SessionOutput> {
        self.records.pop_front()
    }

    /// Returns the result; `None` while the session is still running.
    #[must_use]
    pub fn finished(&self) -> Option<&Result<AssessedSession, AssessError>> {
        self.outcome.as_ref()
    }

    /// Returns the reason why the telemetry was rejected; `None` if it was not.
    #[must_use]
    pub fn refused(&self) -> Option<&AssessError> {
        self.rejection.as_ref()
    }

    /// Ends the session immediately (user abort or closed link) and scores the flight up to this point.
    pub fn close(&mut self) {
        if self.outcome.is_none() {
            let outcome = self.score();
            self.finish(outcome);
        }
    }

    /// Sends a text to the pilot and logs it as an event.
    pub fn notify_pilot(&mut self, words: &str, severity: MavSeverity) {
        self.text(words, severity);
    }

    /// Frees the flight data after the session has been written. The assessment remains available.
    pub fn free_flight_data(&mut self) {
        self.timeline = Timeline::new(LocalPlane::new(self.config.scenario.origin));
        self.survey = None;
        self.records = VecDeque::new();
        if let Some(Ok(assessed_session)) = &mut self.outcome {
            assessed_session.frames = Vec::new();
        }
    }

    /// Returns the latest simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.timeline.newest().unwrap_or(SimTime::ZERO)
    }

    /// Returns the flight time so far; `None` before lift-off.
    #[must_use]
    pub fn flight_time(&self) -> Option<SimTime> {
        self.live.lift_off.map(|start| self.now().saturating_sub(start))
    }

    /// Returns the mask of active cues.
    #[must_use]
    pub fn cues(&self) -> i32 {
        self.live.cues
    }

    /// Returns the number of the task whose path the drone is on, if any.
    #[must_use]
    pub fn task(&self) -> Option<u32> {
        self.live.current_task.map(|task| self.config.scenario.tasks[task].id)
    }

    /// Returns the remaining battery charge in percent; `None` if not received yet.
    #[must_use]
    pub fn battery_pct(&self) -> Option<f64> {
        self.live.battery_pct
    }

    /// Returns the telemetry link statistics.
    #[must_use]
    pub fn link(&self) -> LinkCounts {
        self.timeline.counts()
    }

    /// Returns the seed; `None` until it is known.
    #[must_use]
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// Returns the site; `None` until the seed is known.
    #[must_use]
    pub fn survey(&self) -> Option<&Arc<dyn SiteSurvey>> {
        self.survey.as_ref()
    }

    /// Returns the contents of `session.json`. The caller provides the file contents and the start time as text.
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
            form: self.config.scenario.form.as_ref().map(|form| form.name.clone()),
            level: self.config.scenario.difficulty.as_ref().map(|difficulty| difficulty.level),
            scenario_crc: format!("{:08x}", self.config.scenario.crc),
            scenario_sha256: super::folder::sha256_hex(scenario_toml),
            vehicle: self.config.vehicle.id.clone(),
            vehicle_sha256: super::folder::sha256_hex(vehicle_toml),
            seed: self.seed,
            purpose: self.config.purpose.clone(),
            // Known only to the caller: it happens before the flight, and the monitor does not use it.
            site_check_unix_us: None,
            monitor_starts,
            link: self.link(),
            bad_bytes: self.decoder.bad_bytes(),
        }
    }
}

impl LiveState {
    fn new(config: &MonitorConfig, paths: &ReferencePaths) -> Self {
        Self {
            truth: None,
            battery_pct: None,
            contact: ContactKind::None,
            touched: ContactKind::None,
            on_pad: false,
            clearance_m: None,
            armed: None,
            is_return: false,
            flown_by: None,
            on_ground: false,
            camera_pitch_rad: 0.0,
            camera_fov_rad: None,
            lamp: false,
            lift_off: None,
            current_task: None,
            last_task: None,
            flown: (0..paths.len()).map(|task| FlownPath::of_task(paths, task)).collect(),
            flown_shares: vec![0.0; paths.len()],
            done: vec![false; paths.len()],
            finished: vec![false; paths.len()],
            end_rule: EndRule::new(&config.scenario, &config.vehicle),
            end: None,
            next_end_check: SimTime::ZERO,
            cues: 0,
            cues_sent: None,
            respawns: None,
            practice_aids: BTreeMap::new(),
            changes: SiteChanges::default(),
        }
    }
}
