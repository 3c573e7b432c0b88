//! The live sidecar, sans-IO: datagrams and clock in, datagrams and file contents out. The shell owns sockets and files.
//!
//! ```text
//! monitor.handle_datagram(bytes)   then, until empty: poll_transmit(), poll_record()
//! monitor.handle_timeout(now)      at least every 100 ms of wall time
//! monitor.finished()               once Some: write assessment.json, stop
//! ```

use super::assessment::{self, AssessError, Graded, Job};
use super::feedback::{Feedback, Moment, TaskNow, cue, texts::Texts};
use super::folder::SessionInfo;
use super::measures::attention::Survey;
use super::measures::crash::may_touch_pad;
use super::measures::on_path::Paths;
use super::session::{EndReason, EndRule, Moment as EndMoment, lift_off_height_m};
use crate::base::frames::{Enu, Vec3};
use crate::base::geodesy::LocalPlane;
use crate::base::time::SimTime;
use crate::mav::codec::{Decoder, Encoder, Received};
use crate::mav::dialect::{
    COMMAND_ACK_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag, MavResult, MavSeverity, MavState, MavType,
    NAMED_VALUE_INT_DATA, STATUSTEXT_DATA, TIMESYNC_DATA,
};
use crate::scenario::Scenario;
use crate::site::Site;
use crate::telemetry::sample::{Said, Sample};
use crate::telemetry::timeline::{LinkCounts, Pushed};
use crate::telemetry::{Contact, Timeline, Truth, frame::GAP_AFTER, tlog};
use crate::vehicle::Vehicle;
use serde_json::json;
use std::collections::VecDeque;
use std::sync::Arc;

/// The monitor's component id (MAV_COMP_ID_ONBOARD_COMPUTER).
pub const COMPONENT: u8 = 191;
/// `cues` are repeated at 5 Hz (design.md).
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
pub type BuildSurvey = fn(&Scenario, u64) -> Arc<dyn Survey>;

/// Builds the real site.
#[must_use]
pub fn build_site(scenario: &Scenario, seed: u64) -> Arc<dyn Survey> {
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
    /// Wall time of simulation time zero, µs since the Unix epoch; on a restart that of the first start.
    pub started_unix_us: u64,
    /// System id until the vehicle has been heard: 1 + instance.
    pub system_id: u8,
    /// Seed asked for on the command line; another one on the wire is refused.
    pub seed: Option<u64>,
    /// Makes the site; [`build_site`] outside tests.
    pub build: BuildSurvey,
}

/// Something to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Record {
    /// Append to `telemetry.tlog`.
    Telemetry(Vec<u8>),
    /// Append to `events.jsonl` (a line, with its line end).
    Event(String),
}

/// State of the live view.
#[derive(Debug, Clone, PartialEq)]
struct Live {
    truth: Option<Truth>,
    battery_pct: Option<f64>,
    contact: Contact,
    /// The running contact is a soft touch of the pad.
    on_pad: bool,
    clearance_m: Option<f64>,
    armed: Option<bool>,
    on_ground: bool,
    lift_off: Option<SimTime>,
    on: Option<usize>,
    last_task: Option<usize>,
    rule: EndRule,
    end: Option<(SimTime, EndReason)>,
    no_end_before: SimTime,
    cues: i32,
    cues_sent: Option<SimTime>,
    respawns: Option<i32>,
}

/// The sidecar.
#[derive(Debug, Clone)]
pub struct Monitor {
    config: MonitorConfig,
    paths: Paths,
    decoder: Decoder,
    encoder: Encoder,
    timeline: Timeline,
    feedback: Feedback,
    texts: Texts,
    live: Live,
    survey: Option<Arc<dyn Survey>>,
    seed: Option<u64>,
    out: VecDeque<Vec<u8>>,
    records: VecDeque<Record>,
    replaying: bool,
    stamp_base: SimTime,
    heartbeat_sim: Option<SimTime>,
    heartbeat_wall: Option<SimTime>,
    heard_wall: Option<SimTime>,
    heard: bool,
    refused: Option<AssessError>,
    outcome: Option<Result<Graded, AssessError>>,
}

impl Monitor {
    /// A monitor at the start of a session.
    #[must_use]
    pub fn new(config: MonitorConfig) -> Self {
        let scenario = &config.scenario;
        Self {
            paths: Paths::new(scenario),
            decoder: Decoder::new(),
            encoder: Encoder::new(config.system_id, COMPONENT),
            timeline: Timeline::new(LocalPlane::new(scenario.origin)),
            feedback: Feedback::new(scenario),
            texts: Texts::default(),
            live: Live::new(&config),
            survey: None,
            seed: config.seed.or(scenario.seed),
            out: VecDeque::new(),
            records: VecDeque::new(),
            replaying: false,
            stamp_base: SimTime::ZERO,
            heartbeat_sim: None,
            heartbeat_wall: None,
            heard_wall: None,
            heard: false,
            refused: None,
            outcome: None,
            config,
        }
    }

    /// A monitor that goes on where a killed one stopped: `log` is what `telemetry.tlog` holds. The shell cuts the file to
    /// [`tlog::whole_len`] before it appends.
    #[must_use]
    pub fn resume(mut config: MonitorConfig, log: &[u8]) -> Self {
        if let Some(start) = tlog::session_start_us(log) {
            config.started_unix_us = start;
        }
        let mut monitor = Self::new(config);
        monitor.replaying = true;
        for record in tlog::Reader::new(log) {
            for received in monitor.decoder.datagram(record.frame) {
                monitor.take(&received);
            }
        }
        monitor.replaying = false;
        let resumed_at_s = monitor.now().s();
        monitor.event("monitor_restarted", json!({ "at_s": resumed_at_s }));
        monitor
    }

    /// Takes one datagram from the vehicle. The site is built while the first `seed` is handled, which may take a while.
    pub fn handle_datagram(&mut self, bytes: &[u8]) {
        self.heard = true;
        for received in self.decoder.datagram(bytes) {
            if self.outcome.is_none() {
                let stamp = self.stamp_us(&received);
                self.records.push_back(Record::Telemetry(tlog::record(stamp, &received.bytes)));
                self.take(&received);
            }
            self.answer(&received);
        }
    }

    /// Tells the wall time since some fixed instant; needed only while simulation time stands still.
    pub fn handle_timeout(&mut self, wall: SimTime) {
        if std::mem::take(&mut self.heard) || self.heard_wall.is_none() {
            self.heard_wall = Some(wall);
        }
        if self.heartbeat_wall.is_none_or(|last| wall - last >= HEARTBEAT_SILENT) {
            self.heartbeat();
            self.heartbeat_wall = Some(wall);
        }
        let silent = self.heard_wall.is_some_and(|heard| wall - heard >= SILENCE_CLOSES);
        if silent && self.live.end.is_some() {
            self.close();
        }
    }

    /// The next datagram for the vehicle.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// The next thing to write.
    pub fn poll_record(&mut self) -> Option<Record> {
        self.records.pop_front()
    }

    /// The result, once the session is over.
    #[must_use]
    pub fn finished(&self) -> Option<&Result<Graded, AssessError>> {
        self.outcome.as_ref()
    }

    /// Why this simulator's telemetry is refused.
    #[must_use]
    pub fn refused(&self) -> Option<&AssessError> {
        self.refused.as_ref()
    }

    /// Ends the session now (somebody aborts, or the link is closed) and scores what there is.
    pub fn close(&mut self) {
        if self.outcome.is_none() {
            let outcome = self.score();
            self.finish(outcome);
        }
    }

    /// Newest simulation time.
    #[must_use]
    pub fn now(&self) -> SimTime {
        self.timeline.newest().unwrap_or(SimTime::ZERO)
    }

    /// Flight time so far; `None` before lift-off.
    #[must_use]
    pub fn flown(&self) -> Option<SimTime> {
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
        self.live.on.map(|task| self.config.scenario.tasks[task].id)
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
    pub fn survey(&self) -> Option<&Arc<dyn Survey>> {
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
            monitor_starts,
            link: self.link(),
            bad_bytes: self.decoder.bad_bytes(),
        }
    }
}

// Taking in.
impl Monitor {
    /// Session start plus simulation time; after a simulator's restart the stamps go on rising.
    fn stamp_us(&self, received: &Received) -> u64 {
        let own = crate::telemetry::sample::truth_time_us(&received.bytes).and_then(|us| i64::try_from(us).ok());
        let now = own.map_or(self.now(), |us| SimTime::from_us(us).max(self.now()));
        let since = u64::try_from((self.stamp_base + now).us()).unwrap_or(0);
        self.config.started_unix_us.saturating_add(since)
    }

    fn take(&mut self, received: &Received) {
        let before = self.timeline.newest();
        match self.timeline.push(&received.bytes) {
            Pushed::Nothing => {}
            Pushed::Restarted(sample) => {
                self.stamp_base += before.unwrap_or(SimTime::ZERO);
                self.restarted(sample);
            }
            Pushed::Kept(sample) => self.note(sample, before),
        }
    }

    fn restarted(&mut self, sample: Sample) {
        self.event("simulator_restarted", json!({}));
        if self.live.lift_off.is_some() {
            self.close();
            return;
        }
        self.live = Live::new(&self.config);
        self.feedback = Feedback::new(&self.config.scenario);
        self.heartbeat_sim = None;
        self.note(sample, None);
    }

    fn note(&mut self, sample: Sample, before: Option<SimTime>) {
        match sample.said {
            Said::Truth(truth) if before.is_none_or(|before| truth.time > before) => self.truth(truth, before),
            Said::Truth(_) | Said::Sticks(_) | Said::Hits(_) | Said::GimbalPitch(_) | Said::Light(_) => {}
            Said::Battery(pct) => self.live.battery_pct = Some(pct),
            Said::Contact(contact) => self.contact(contact),
            Said::Respawns(count) => self.respawns(count),
            Said::Seed(seed) => self.seed_heard(seed),
            Said::ScenarioCrc(crc) => {
                if let Err(error) = assessment::check_scenario(&self.config.scenario, crc) {
                    self.refuse(error);
                }
            }
            Said::Clearance(metres) => self.live.clearance_m = Some(metres),
            Said::Armed(armed) => self.live.armed = Some(armed),
            Said::OnGround(on_ground) => self.live.on_ground = on_ground,
            Said::Snapshot(index) => self.event("snapshot", json!({ "image": index })),
        }
    }

    fn seed_heard(&mut self, seed: u64) {
        if let Err(error) = assessment::check_seed(self.seed, seed) {
            self.refuse(error);
            return;
        }
        self.seed = Some(seed);
        if self.survey.is_none() {
            self.survey = Some((self.config.build)(&self.config.scenario, seed));
            self.event("seed", json!({ "seed": seed }));
        }
    }

    fn refuse(&mut self, error: AssessError) {
        if self.refused.is_none() {
            self.event("refused", json!({ "why": error.to_string() }));
            self.text("Monitor: other scenario or seed", MavSeverity::MAV_SEVERITY_WARNING);
            self.refused = Some(error.clone());
            self.outcome = Some(Err(error));
        }
    }

    fn respawns(&mut self, count: i32) {
        if self.live.respawns.is_some_and(|known| count > known) {
            self.event("respawn", json!({ "count": count }));
        }
        self.live.respawns = Some(count);
    }

    fn truth(&mut self, truth: Truth, before: Option<SimTime>) {
        if let Some(before) = before.filter(|before| truth.time - *before > GAP_AFTER) {
            self.event("telemetry_gap", json!({ "from_s": before.s(), "to_s": truth.time.s() }));
        }
        self.live.truth = Some(truth);
        if self.live.lift_off.is_none() && self.height_m(truth.position_m) > lift_off_height_m(&self.config.vehicle) {
            self.live.lift_off = Some(truth.time);
            self.event("lift_off", json!({}));
        }
        self.place(truth.position_m);
        self.speak();
        self.look_for_the_end(&truth);
        let due = |last: Option<SimTime>| last.is_none_or(|last| truth.time - last >= HEARTBEAT_EVERY);
        if due(self.heartbeat_sim) {
            self.heartbeat_sim = Some(truth.time);
            self.heartbeat();
        }
    }

    fn height_m(&self, position_m: Vec3<Enu>) -> f64 {
        position_m.up() - self.config.scenario.ground_team.pad_m.up()
    }

    fn place(&mut self, position_m: Vec3<Enu>) {
        if self.live.lift_off.is_none() {
            return;
        }
        let on = self.paths.on(position_m, self.live.last_task).map(|(task, _)| task);
        if let Some(task) = on.filter(|task| self.live.last_task != Some(*task)) {
            self.event("task_entered", json!({ "task": self.config.scenario.tasks[task].id }));
        }
        self.live.on = on;
        self.live.last_task = on.or(self.live.last_task);
    }

    fn contact(&mut self, contact: Contact) {
        let onset = self.live.contact == Contact::None && contact != Contact::None;
        if onset {
            self.live.on_pad = self.is_soft_pad_touch(contact);
        }
        let changed = self.live.contact != contact;
        self.live.contact = contact;
        if changed && contact != Contact::None && !self.live.on_pad && self.live.lift_off.is_some() {
            let what = self.touched();
            self.event("crash", json!({ "with": contact.word(), "what": what }));
        }
        if changed {
            self.speak();
        }
    }

    fn is_soft_pad_touch(&self, contact: Contact) -> bool {
        let team = &self.config.scenario.ground_team;
        matches!(contact, Contact::Terrain | Contact::Other)
            && self.live.truth.is_some_and(|truth| may_touch_pad(truth.position_m, truth.velocity_m_s.up(), team))
    }

    fn counted_contact(&self) -> Contact {
        if self.live.on_pad && !matches!(self.live.contact, Contact::Person | Contact::Vehicle) {
            Contact::None
        } else {
            self.live.contact
        }
    }

    fn touched(&self) -> Option<String> {
        let truth = self.live.truth?;
        self.survey.as_ref()?.name_near(truth.position_m, TOUCH_REACH_M, truth.time)
    }

    fn look_for_the_end(&mut self, truth: &Truth) {
        let Some(start) = self.live.lift_off else { return };
        if self.live.end.is_none() && truth.time >= self.live.no_end_before {
            let rate = self.config.scenario.scoring.frame_rate_hz;
            let moment = EndMoment {
                time: truth.time,
                flown_s: (truth.time - start).s() + 1.0 / rate,
                position_m: truth.position_m,
                speed_m_s: truth.velocity_m_s.norm(),
                contact: self.counted_contact(),
                battery_pct: self.live.battery_pct.unwrap_or(100.0),
                armed: self.live.armed,
                on_ground: self.live.on_ground,
            };
            self.live.end = self.live.rule.see(&moment).map(|(_, reason)| (truth.time, reason));
        }
        if let Some((time, _)) = self.live.end
            && truth.time - time >= SETTLE
            && !self.replaying
        {
            self.try_to_finish(truth.time);
        }
    }

    /// The live rule sees samples, the scorer frames: the scorer decides. When it sees no end yet, the watch goes on.
    fn try_to_finish(&mut self, now: SimTime) {
        let outcome = self.score();
        match &outcome {
            Ok(graded) if graded.assessment.end.reason == EndReason::Abort => {
                self.live.end = None;
                self.live.no_end_before = now + RETRY;
            }
            Ok(_) | Err(_) => self.finish(outcome),
        }
    }

    fn score(&mut self) -> Result<Graded, AssessError> {
        if let Some(refused) = &self.refused {
            return Err(refused.clone());
        }
        let Self { config, timeline, survey, .. } = self;
        let flight = assessment::scored_flight(timeline, &config.scenario, &config.vehicle);
        let seed = assessment::check_identity(&flight, &config.scenario, self.seed)?;
        let survey = survey.get_or_insert_with(|| (config.build)(&config.scenario, seed)).clone();
        let job = Job { scenario: &config.scenario, vehicle: &config.vehicle, survey: survey.as_ref() };
        let (assessment, frames) = assessment::assess(&flight, &job)?;
        Ok(Graded { assessment, frames, seed })
    }

    fn finish(&mut self, outcome: Result<Graded, AssessError>) {
        let (reason, words) = match &outcome {
            Ok(graded) => {
                let overall = graded.assessment.scores.overall;
                (json!(graded.assessment.end.reason), format!("Session over: {overall:.0} points"))
            }
            Err(error) => (json!(error.to_string()), "Session over: nothing to score".to_owned()),
        };
        let counts = self.link();
        self.event("end", json!({ "reason": reason, "link": counts }));
        self.text(&words, MavSeverity::MAV_SEVERITY_INFO);
        self.outcome = Some(outcome);
    }
}

// Speaking.
impl Monitor {
    fn speak(&mut self) {
        let Some(truth) = self.live.truth else { return };
        let moment = self.moment(&truth);
        let (cues, texts) = self.feedback.see(&moment);
        let changed = cues != self.live.cues;
        if changed {
            self.event("cues", json!({ "cues": cues }));
        }
        self.live.cues = cues;
        if changed || self.live.cues_sent.is_none_or(|sent| truth.time - sent >= CUES_EVERY) {
            self.live.cues_sent = Some(truth.time);
            self.send(&MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA {
                time_boot_ms: u32::try_from(truth.time.ms()).unwrap_or(u32::MAX),
                value: cues,
                name: "cues".into(),
            }));
        }
        self.texts.put(truth.time, texts);
        while let Some(text) = self.texts.next(truth.time) {
            let quiet = text.cue == cue::BATTERY_YELLOW;
            let severity = if quiet { MavSeverity::MAV_SEVERITY_INFO } else { MavSeverity::MAV_SEVERITY_WARNING };
            self.text(&text.words, severity);
        }
    }

    fn moment(&self, truth: &Truth) -> Moment {
        let scenario = &self.config.scenario;
        let in_session = self.live.lift_off.is_some() && self.live.end.is_none() && self.outcome.is_none();
        let near = |(t, task): (usize, &crate::scenario::Task)| TaskNow {
            distance_m: self.paths.nearest(t, truth.position_m).map_or(f64::INFINITY, |nearest| nearest.distance_m),
            threshold_m: task.threshold_m,
            too_close_m: task.too_close_m,
            id: task.id,
        };
        let contact = self.counted_contact();
        let onset = contact != Contact::None && self.live.cues & cue::CRASH == 0;
        Moment {
            time: truth.time,
            in_session,
            airborne: !self.live.on_ground && self.height_m(truth.position_m) > lift_off_height_m(&self.config.vehicle),
            speed_m_s: truth.velocity_m_s.norm(),
            battery_pct: self.live.battery_pct,
            clearance_m: self.live.clearance_m,
            contact,
            touched: if onset { self.touched() } else { None },
            tasks: scenario.tasks.iter().enumerate().map(near).collect(),
            on: self.live.on,
            last: self.live.last_task,
        }
    }

    fn answer(&mut self, received: &Received) {
        let ours = |system: u8, component: u8| {
            (system == 0 || system == self.encoder.system_id()) && (component == 0 || component == COMPONENT)
        };
        match &received.message {
            Some(MavMessage::TIMESYNC(sync)) if sync.tc1 == 0 && ours(sync.target_system, sync.target_component) => {
                let answer = TIMESYNC_DATA {
                    tc1: self.now().ns().max(1),
                    ts1: sync.ts1,
                    target_system: received.system_id,
                    target_component: received.component_id,
                };
                self.send(&MavMessage::TIMESYNC(answer));
            }
            Some(MavMessage::COMMAND_LONG(command)) if command.target_component == COMPONENT => {
                if ours(command.target_system, COMPONENT) {
                    self.unsupported(command.command, received);
                }
            }
            Some(MavMessage::COMMAND_INT(command)) if command.target_component == COMPONENT => {
                if ours(command.target_system, COMPONENT) {
                    self.unsupported(command.command, received);
                }
            }
            Some(MavMessage::HEARTBEAT(_)) if received.component_id == 1 && received.system_id != self.encoder.system_id() => {
                self.encoder = Encoder::new(received.system_id, COMPONENT);
            }
            Some(_) | None => {}
        }
    }

    fn unsupported(&mut self, command: MavCmd, asker: &Received) {
        self.send(&MavMessage::COMMAND_ACK(COMMAND_ACK_DATA {
            command,
            result: MavResult::MAV_RESULT_UNSUPPORTED,
            target_system: asker.system_id,
            target_component: asker.component_id,
            ..COMMAND_ACK_DATA::default()
        }));
    }

    fn heartbeat(&mut self) {
        self.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            mavtype: MavType::MAV_TYPE_ONBOARD_CONTROLLER,
            autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
            // The dialect's default says armed.
            base_mode: MavModeFlag::empty(),
            system_status: MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
            ..HEARTBEAT_DATA::default()
        }));
    }

    fn text(&mut self, words: &str, severity: MavSeverity) {
        self.event("text", json!({ "text": words }));
        self.send(&MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text: words.into(), ..STATUSTEXT_DATA::default() }));
    }

    fn send(&mut self, message: &MavMessage) {
        if !self.replaying {
            let bytes = self.encoder.encode(message);
            self.out.push_back(bytes);
        }
    }

    fn event(&mut self, kind: &str, mut detail: serde_json::Value) {
        if self.replaying {
            return;
        }
        let mut line = serde_json::Map::new();
        line.insert("t_s".to_owned(), json!(self.now().s()));
        line.insert("event".to_owned(), json!(kind));
        if let Some(detail) = detail.as_object_mut() {
            line.append(detail);
        }
        self.records.push_back(Record::Event(serde_json::Value::Object(line).to_string() + "\n"));
    }
}

impl Live {
    fn new(config: &MonitorConfig) -> Self {
        Self {
            truth: None,
            battery_pct: None,
            contact: Contact::None,
            on_pad: false,
            clearance_m: None,
            armed: None,
            on_ground: false,
            lift_off: None,
            on: None,
            last_task: None,
            rule: EndRule::new(&config.scenario, &config.vehicle),
            end: None,
            no_end_before: SimTime::ZERO,
            cues: 0,
            cues_sent: None,
            respawns: None,
        }
    }
}
