//! State of a flight in progress for the instructor's live page: processes telemetry and returns a JSON snapshot.
//! Performs no I/O. Uses only data available to every subscriber of the payload port.

use super::live_hazards::HazardState;
use crate::terms::task_title;
use serde_json::{Value, json};
use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_mavlink::contract::guidance::{self, Guidance};
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::{MavAutopilot, MavMessage, MavSeverity};
use spandrel_mavlink::telemetry::sample;
use spandrel_mavlink::telemetry::sample::{Sample, SampleContent, SampleValue};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::site::inspector_path::InspectorPath;
use spandrel_model::time::SimTime;
use spandrel_monitor::measures::on_path::ReferencePaths;
use spandrel_text::monitor_texts::{Warning, message_words, way_words};
use spandrel_text::{Language, Translated, text};
use std::collections::VecDeque;

/// Placeholder origin for decoding before the job is known. Positions decoded with it are never displayed.
const PLACEHOLDER_ORIGIN: Geo = Geo { latitude_deg: 0.0, longitude_deg: 0.0, altitude_m: 0.0 };
/// Component ID of the autopilot, whose texts are no cues.
const AUTOPILOT_COMPONENT_ID: u8 = 1;
/// Maximum number of messages kept for the page.
const MAX_MESSAGES: usize = 40;
/// Identity of the job being flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JobIdentity {
    /// Scenario CRC.
    pub crc: u32,
    /// The session's seed.
    pub seed: u64,
}

/// Job whose origin and paths are used to interpret positions.
#[derive(Debug)]
struct TrackedJob {
    key: JobIdentity,
    /// Machine-readable name of the job.
    scenario: String,
    plane: LocalPlane,
    paths: ReferencePaths,
    /// Task numbers and names.
    tasks: Vec<(u32, String)>,
    /// The inspector's places, without walks.
    inspector: InspectorPath,
}

/// Words of a message with their language: texts of the vehicle itself are in English.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogWords {
    /// Language of the words.
    pub language: Language,
    /// The words.
    pub words: String,
}

impl LogWords {
    /// Returns a text that the vehicle or the monitor has sent, in a language if it is one of the monitor's.
    fn received(text: &str, language: Language) -> Self {
        match message_words(text, language) {
            Some(words) => Self { language, words },
            None => Self { language: Language::English, words: text.to_owned() },
        }
    }
}

/// A line of the message log.
#[derive(Debug)]
struct LogLine {
    id: u64,
    t_s: f64,
    /// CSS class.
    kind: &'static str,
    words: Translated<LogWords>,
}

/// Live state of the flight.
#[derive(Debug)]
pub struct LiveFlightState {
    crc: Option<u32>,
    seed: Option<u64>,
    job: Option<TrackedJob>,
    truth: Option<Truth>,
    current_task: Option<usize>,
    battery_pct: Option<f64>,
    clearance_m: Option<f64>,
    contact: ContactKind,
    armed: bool,
    is_frozen: bool,
    changes: SiteChanges,
    cues: i32,
    cue_texts: CueTexts,
    /// Simulation time, s, and text of the latest displayed cue, which may have ended.
    last_cue: Option<(f64, String)>,
    /// The next step, and the simulation time when it was received.
    guidance: Option<(SimTime, Guidance)>,
    hazards: HazardState,
    messages: VecDeque<LogLine>,
    message_count: u64,
    /// The vehicle's system ID, once received.
    pub system: Option<u8>,
    /// Autopilot type, once received.
    pub autopilot: Option<MavAutopilot>,
}

impl Default for LiveFlightState {
    fn default() -> Self {
        Self::new()
    }
}

impl LiveFlightState {
    /// Creates a state without a job or telemetry.
    #[must_use]
    pub fn new() -> Self {
        Self {
            crc: None,
            seed: None,
            job: None,
            truth: None,
            current_task: None,
            battery_pct: None,
            clearance_m: None,
            contact: ContactKind::None,
            armed: false,
            is_frozen: false,
            changes: SiteChanges::default(),
            cues: 0,
            cue_texts: CueTexts::default(),
            last_cue: None,
            guidance: None,
            hazards: HazardState::default(),
            messages: VecDeque::new(),
            message_count: 0,
            system: None,
            autopilot: None,
        }
    }

    /// Returns the key of the job being flown; `None` until received.
    #[must_use]
    pub fn announced_job(&self) -> Option<JobIdentity> {
        let key = JobIdentity { crc: self.crc?, seed: self.seed? };
        Some(key)
    }

    /// Returns the key of the job set with [`Self::set_job`].
    #[must_use]
    pub fn job(&self) -> Option<JobIdentity> {
        self.job.as_ref().map(|job| job.key)
    }

    /// Sets the job after the application has loaded its scenario.
    pub fn set_job(&mut self, key: JobIdentity, scenario: &Scenario) {
        let tasks = scenario.tasks.iter().map(|task| (task.id, task.name.clone())).collect();
        self.job = Some(TrackedJob {
            key,
            scenario: scenario.name.clone(),
            plane: LocalPlane::new(scenario.origin),
            paths: ReferencePaths::new(scenario),
            tasks,
            inspector: InspectorPath::new(&scenario.ground_team),
        });
        self.truth = None;
        // The vehicle repeats its current changes.
        self.changes = SiteChanges::default();
    }

    /// Updates the state from a received frame.
    pub fn handle_frame(&mut self, frame: &ReceivedFrame) {
        self.record_sender(frame);
        match &frame.message {
            Some(MavMessage::STATUSTEXT(text)) => {
                let kind = if text.severity as u8 <= MavSeverity::MAV_SEVERITY_WARNING as u8 { "warn" } else { "info" };
                let words: String = text.text.to_str().unwrap_or_default().chars().filter(|c| !c.is_control()).collect();
                if frame.component_id != AUTOPILOT_COMPONENT_ID {
                    self.cue_texts.add(&words);
                    self.remember_cue();
                }
                self.push(kind, Translated::new(|language| LogWords::received(&words, language)));
            }
            Some(message) => {
                if let Some(NamedValue::Cues(cues)) = NamedValue::of(message) {
                    self.cues = cues;
                    self.cue_texts.retain_active(cues);
                    self.remember_cue();
                }
                let now = self.truth.map_or(SimTime::ZERO, |truth| truth.time);
                self.hazards.handle(message, frame.component_id, now);
                self.guidance = Guidance::of(message).map(|guidance| (now, guidance)).or(self.guidance);
            }
            None => {}
        }
        // Messages with a position cannot be decoded until the job is known. The vehicle repeats them.
        let nowhere = LocalPlane::new(PLACEHOLDER_ORIGIN);
        let plane = self.job.as_ref().map_or(&nowhere, |job| &job.plane);
        if let Some(sample) = sample::read(&frame.bytes, plane) {
            self.handle_sample(sample);
        }
    }

    fn record_sender(&mut self, frame: &ReceivedFrame) {
        if let Some(MavMessage::HEARTBEAT(beat)) = &frame.message
            && frame.component_id == AUTOPILOT_COMPONENT_ID
        {
            self.system = Some(frame.system_id);
            self.autopilot = Some(beat.autopilot);
        }
    }

    fn handle_sample(&mut self, sample: Sample) {
        match sample.content {
            SampleContent::Truth(truth) => self.handle_truth(truth),
            SampleContent::Value(value) => self.handle_value(value),
        }
    }

    fn handle_value(&mut self, value: SampleValue) {
        match value {
            SampleValue::Battery(pct) => self.battery_pct = Some(pct),
            SampleValue::Contact(contact) => self.contact = contact,
            SampleValue::Clearance(meters) => self.clearance_m = Some(meters),
            SampleValue::Heartbeat { armed, .. } => self.armed = armed,
            SampleValue::Traffic(code) => self.changes.closures.apply_code(code),
            SampleValue::Walk(code) => self.changes.walks.apply_code(code),
            SampleValue::Seed(seed) => self.seed = Some(seed),
            SampleValue::ScenarioCrc(crc) => self.crc = Some(crc),
            SampleValue::Frozen(on) => self.is_frozen = on,
            SampleValue::Snapshot(index) => {
                self.push_message("info", |language| text!(language, "live-message-picture", number = index));
            }
            SampleValue::Sticks(_)
            | SampleValue::Light(_)
            | SampleValue::Hits(_)
            | SampleValue::Respawns(_)
            | SampleValue::Freezes(_)
            | SampleValue::Rewinds(_)
            | SampleValue::GimbalPitch(_)
            | SampleValue::FieldOfView(_)
            | SampleValue::OnGround(_) => {}
        }
    }

    fn handle_truth(&mut self, truth: Truth) {
        let Some(job) = &self.job else { return };
        // If the clock jumps backward, a new flight has started. Earlier messages remain visible.
        if self.truth.is_some_and(|before| truth.time < before.time) {
            (self.current_task, self.cues, self.changes) = (None, 0, SiteChanges::default());
            (self.cue_texts, self.last_cue, self.guidance) = (CueTexts::default(), None, None);
            self.hazards = HazardState::default();
        }
        self.current_task = job.paths.task_on_path(truth.motion.position_m, self.current_task).map(|(task, _)| task);
        self.truth = Some(truth);
    }

    /// Returns the texts of the displayed cues, the most important one first.
    fn displayed_cues(&self) -> Vec<&str> {
        let shown = cue::displayed(self.cues);
        cue::ALL.iter().filter(|(bit, _)| shown & bit != 0).filter_map(|(bit, _)| self.cue_texts.text(*bit)).collect()
    }

    /// Keeps the most important displayed cue, so that it remains known after it ends.
    fn remember_cue(&mut self) {
        if let Some(text) = self.displayed_cues().first().map(|text| (*text).to_owned()) {
            self.last_cue = Some((self.truth.map_or(0.0, |truth| truth.time.s()), text));
        }
    }

    /// Adds a line to the message log; `words` returns it in a language.
    pub fn push_message(&mut self, kind: &'static str, words: impl Fn(Language) -> String) {
        self.push(kind, Translated::new(|language| LogWords { language, words: words(language) }));
    }

    fn push(&mut self, kind: &'static str, words: Translated<LogWords>) {
        self.message_count += 1;
        let t_s = self.truth.map_or(0.0, |truth| truth.time.s());
        self.messages.push_back(LogLine { id: self.message_count, t_s, kind, words });
        while self.messages.len() > MAX_MESSAGES {
            self.messages.pop_front();
        }
    }

    /// Returns the name of the current task in a language.
    fn task_words(&self, language: Language) -> Option<String> {
        let job = self.job.as_ref()?;
        let (id, name) = job.tasks.get(self.current_task?)?;
        Some(format!("{id} · {}", task_title(&job.scenario, name, language)))
    }

    /// Returns the position of the inspector's feet, once the job is known.
    fn inspector(&self) -> Option<Value> {
        let (job, now) = (self.job.as_ref()?, self.truth?.time);
        Some(point(job.inspector.with_walks(self.changes.walks.clone(), None).at(now).feet_m))
    }

    /// Returns the current state for the page's script in a language. `heard` indicates whether telemetry was received recently.
    #[must_use]
    pub fn to_json(&self, heard: bool, language: Language) -> Value {
        let key = self.job().map(|key| format!("{:08x}-{}", key.crc, key.seed));
        let place = self.truth.map(|truth| point(truth.motion.position_m));
        let line = |line: &LogLine| {
            let LogWords { language, words } = line.words.get(language);
            json!({ "id": line.id, "t_s": line.t_s, "kind": line.kind, "lang": language.tag(), "words": words })
        };
        let words: Vec<Value> = self.messages.iter().map(line).collect();
        let cues: Vec<String> = self.displayed_cues().into_iter().map(|text| cue_words(text, language)).collect();
        let last_cue = self.last_cue.as_ref().map(|(t_s, text)| json!({ "t_s": t_s, "words": cue_words(text, language) }));
        let now = self.truth.map_or(SimTime::ZERO, |truth| truth.time);
        let guidance = self.guidance.filter(|(at, _)| now.saturating_sub(*at) <= guidance::TIMEOUT).map(|(_, guidance)| guidance);
        let open = self.changes.closures.is_open_at(self.truth.map_or(f64::INFINITY, |truth| truth.time.s()));
        json!({
            "heard": heard,
            "traffic": if open { "open" } else { "closed" },
            "job": key,
            "t_s": self.truth.map(|truth| truth.time.s()),
            "place": place,
            "inspector": self.inspector(),
            "speed_m_s": self.truth.map(|truth| truth.motion.velocity_m_s.norm()),
            "height_m": self.truth.map(|truth| truth.motion.position_m.up()),
            "battery_pct": self.battery_pct,
            "clearance_m": self.clearance_m.filter(|meters| meters.is_finite()),
            "contact": self.contact.label(),
            "armed": self.armed,
            "frozen": self.is_frozen,
            "task": self.task_words(language),
            "step": guidance.as_ref().map(|guidance| step_words(guidance, language)),
            "progress": guidance.and_then(|guidance| guidance.progress),
            "wind": self.hazards.wind(language),
            "gnss": self.hazards.gnss(language),
            "compass": self.hazards.compass(now, language),
            "radio": self.hazards.radio(now, language),
            "hazards": self.hazards.warnings(now, language),
            "cues": cues,
            "last_cue": last_cue,
            "words": words,
        })
    }
}

/// Returns a cue's text in a language.
fn cue_words(text: &str, language: Language) -> String {
    Warning::of_text(text, language, |name| name).map_or_else(|| text.to_owned(), |warning| warning.words)
}

/// Returns the next step in a language: the words of the monitor's text message and, if the step leads around an obstacle, the
/// way to the place that is reached first.
fn step_words(guidance: &Guidance, language: Language) -> String {
    let sent = guidance.words();
    let step = message_words(&sent, language).unwrap_or(sent);
    let first = guidance.detour.map(|detour| detour.way.words());
    let first = first.map(|way| way_words(&way, language).unwrap_or(way));
    match first {
        Some(way) => format!("{step}: {way}"),
        None => step,
    }
}

/// Returns a position with centimeters.
fn point(position_m: Vec3<Enu>) -> Value {
    let [e, n, u] = position_m.array().map(|m| (m * 100.0).round() / 100.0);
    json!([e, n, u])
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::{Decoder, Encoder};
    use spandrel_mavlink::contract::guidance::{Detour, DetourKind, GuidanceStep, WayTo};
    use spandrel_mavlink::dialect::{HEARTBEAT_DATA, HIL_STATE_QUATERNION_DATA, NAMED_VALUE_INT_DATA, STATUSTEXT_DATA};
    use spandrel_model::scenario::read;

    fn feed_message(live_state: &mut LiveFlightState, message: &MavMessage) {
        let bytes = Encoder::new(1, 1).encode(message);
        Decoder::new().datagram(&bytes).iter().for_each(|frame| live_state.handle_frame(frame));
    }

    fn number(live_state: &mut LiveFlightState, name: &str, value: i32) {
        feed_message(
            live_state,
            &MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { time_boot_ms: 0, value, name: name.into() }),
        );
    }

    #[test]
    fn wire_flight_is_tracked_once_job_is_known() {
        let scenario = read("j.toml", include_str!("../../../../scenarios/two-bridges.toml"), &|_| Err("none".into())).unwrap();
        let mut live_state = LiveFlightState::new();
        assert_eq!(live_state.to_json(false, Language::English)["place"], Value::Null);
        number(&mut live_state, "seed", 7);
        number(&mut live_state, "scn_crc", scenario.crc.cast_signed());
        let key = JobIdentity { crc: scenario.crc, seed: 7 };
        assert_eq!((live_state.announced_job(), live_state.job()), (Some(key), None));
        live_state.set_job(key, &scenario);
        let origin = scenario.origin;
        feed_message(
            &mut live_state,
            &MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
                time_usec: 2_000_000,
                attitude_quaternion: [1.0, 0.0, 0.0, 0.0],
                lat: (origin.latitude_deg * 1e7).round() as i32,
                lon: (origin.longitude_deg * 1e7).round() as i32,
                alt: ((origin.altitude_m + 12.0) * 1e3).round() as i32,
                vx: 300,
                ..HIL_STATE_QUATERNION_DATA::default()
            }),
        );
        number(&mut live_state, "cues", cue::TOO_CLOSE | cue::SPEEDING);
        assert_eq!(live_state.to_json(true, Language::English)["traffic"], json!("open"));
        number(&mut live_state, "frozen", 1);
        assert_eq!(live_state.to_json(true, Language::English)["frozen"], json!(true));
        number(&mut live_state, "frozen", 0);
        assert_eq!(live_state.to_json(true, Language::English)["frozen"], json!(false));
        number(&mut live_state, "traffic", -1_500);
        let moment = live_state.to_json(true, Language::English);
        assert_eq!(moment["traffic"], json!("closed"));
        let team = &scenario.ground_team;
        assert_eq!(moment["inspector"], point(team.inspector_m));
        // Half a second before this moment.
        number(&mut live_state, "walk", 15_012);
        let walked = &live_state.to_json(true, Language::English)["inspector"];
        let walked: Vec<f64> = walked.as_array().unwrap().iter().filter_map(Value::as_f64).collect();
        let way_m = spandrel_model::math::hypot(walked[0] - team.inspector_m.east(), walked[1] - team.inspector_m.north());
        assert!((way_m - 0.7).abs() < 0.02, "{walked:?}");
        // The resolution is about 1 cm for degE7 and 1 mm for MAVLink altitudes.
        let place: Vec<f64> = moment["place"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
        assert!(place[0].abs() < 0.02 && place[1].abs() < 0.02 && (place[2] - 12.0).abs() < 0.02, "{moment}");
        assert_eq!((&moment["speed_m_s"], &moment["t_s"]), (&json!(3.0), &json!(2.0)));
        assert_eq!(moment["cues"], json!(["Too close", "Too fast"]), "without a text, the label");
        let text = STATUSTEXT_DATA { text: "Too close: 2.1 m, limit 2.5 m".into(), ..STATUSTEXT_DATA::default() };
        let bytes = Encoder::new(1, 191).encode(&MavMessage::STATUSTEXT(text));
        Decoder::new().datagram(&bytes).iter().for_each(|frame| live_state.handle_frame(frame));
        assert_eq!(live_state.to_json(true, Language::English)["cues"], json!(["Too close: 2.1 m, limit 2.5 m", "Too fast"]));
        number(&mut live_state, "cues", 0);
        let ended = live_state.to_json(true, Language::English);
        assert_eq!((&ended["cues"], &ended["last_cue"]["words"]), (&json!([]), &json!("Too close: 2.1 m, limit 2.5 m")));
        assert_eq!((&ended["last_cue"]["t_s"], &ended["step"]), (&json!(2.0), &Value::Null));
        let guidance = Guidance {
            step: GuidanceStep::FollowPath,
            task: Some(3),
            way: None,
            progress: Some(0.5),
            tasks_done: 2,
            tasks: 4,
            deviation: None,
            stand_off: None,
            flown_s: 90.0,
            needed_s: 300.0,
            detour: None,
        };
        feed_message(&mut live_state, &guidance.message(2_000_000));
        let moment = live_state.to_json(true, Language::English);
        assert_eq!((&moment["step"], &moment["progress"]), (&json!("Task 3: follow the path"), &json!(0.5)));
        let german = live_state.to_json(true, Language::German);
        assert_eq!(german["step"], "Aufgabe 3: der Bahn folgen");
        assert_eq!(german["last_cue"]["words"], "Zu nah: 2.1 m, mindestens 2.5 m");
    }

    #[test]
    fn wire_messages_are_ordered_and_bounded() {
        let mut live_state = LiveFlightState::new();
        feed_message(
            &mut live_state,
            &MavMessage::HEARTBEAT(HEARTBEAT_DATA { autopilot: MavAutopilot::MAV_AUTOPILOT_PX4, ..HEARTBEAT_DATA::default() }),
        );
        assert_eq!(live_state.system, Some(1));
        for k in 0..100 {
            feed_message(
                &mut live_state,
                &MavMessage::STATUSTEXT(STATUSTEXT_DATA {
                    text: format!("<b>{k}\n").as_str().into(),
                    ..STATUSTEXT_DATA::default()
                }),
            );
        }
        let moment = live_state.to_json(true, Language::English);
        let words = moment["words"].as_array().unwrap();
        assert_eq!((words.len(), &words[39]["words"], &words[39]["id"]), (MAX_MESSAGES, &json!("<b>99"), &json!(100)));
    }

    #[test]
    fn exact_texts_of_the_monitor_are_translated_and_those_of_the_vehicle_are_not() {
        let mut live_state = LiveFlightState::new();
        for text in ["Too fast: 11 mph, limit 10 mph", "Task 2: follow the path", "Failsafe enabled: no RC"] {
            feed_message(
                &mut live_state,
                &MavMessage::STATUSTEXT(STATUSTEXT_DATA { text: text.into(), ..STATUSTEXT_DATA::default() }),
            );
        }
        live_state.push_message("info", |language| text!(language, "live-message-picture", number = 3));
        let lines = |language| {
            let moment = live_state.to_json(true, language);
            let lines = moment["words"].as_array().unwrap().clone();
            lines.iter().map(|line| format!("{}: {}", line["lang"], line["words"])).collect::<Vec<_>>()
        };
        assert_eq!(
            lines(Language::German),
            [
                "\"de\": \"Zu schnell: 11 mph, höchstens 10 mph\"",
                "\"de\": \"Aufgabe 2: der Bahn folgen\"",
                "\"en\": \"Failsafe enabled: no RC\"",
                "\"de\": \"Bild 3\""
            ]
        );
        assert!(lines(Language::English).iter().all(|line| line.starts_with("\"en\"")));
    }

    fn guidance() -> Guidance {
        Guidance {
            step: GuidanceStep::FlyToTask,
            task: Some(2),
            way: Some(WayTo { distance_m: 140.4, bearing_rad: 0.0, up_m: 0.0 }),
            progress: None,
            tasks_done: 1,
            tasks: 4,
            deviation: None,
            stand_off: None,
            flown_s: 75.0,
            needed_s: 480.0,
            detour: None,
        }
    }

    #[test]
    fn exact_every_step_is_translated() {
        let way = |bearing_rad, up_m| Some(WayTo { distance_m: 140.4, bearing_rad, up_m });
        let ways = [None, way(0.01, 0.5), way(-0.5, 12.0), way(0.5, -12.0), way(3.1, 0.0)];
        for (step, way) in GuidanceStep::ALL.into_iter().flat_map(|step| ways.map(|way| (step, way))) {
            let guidance = Guidance { step, way, ..guidance() };
            let [english, german, spanish] = Language::ALL.map(|language| step_words(&guidance, language));
            assert_eq!(english, guidance.words());
            assert!(german != english && spanish != english && german != spanish, "{english}: {german}, {spanish}");
        }
    }

    #[test]
    fn regress_the_step_leads_around_an_obstacle_first() {
        for kind in DetourKind::ALL {
            let way = WayTo { distance_m: 12.0, bearing_rad: 0.5, up_m: 3.0 };
            let blocked = Guidance { detour: Some(Detour { kind, way }), ..guidance() };
            let home = Guidance { step: GuidanceStep::FlyHome, task: None, ..blocked };
            for guidance in [blocked, home] {
                let [english, german, spanish] = Language::ALL.map(|language| step_words(&guidance, language));
                assert_eq!(english, format!("{}: {}", guidance.words(), way.words()));
                assert!(german != english && spanish != english && german != spanish, "{english}: {german}, {spanish}");
            }
        }
    }
}
