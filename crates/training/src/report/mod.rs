//! The report on a finished session: a single page that works offline. [`Review::of`] reads the telemetry with the
//! scorer's code and computes the contents; [`page::session`] renders the page. Neither performs I/O.
//!
//! User-provided text (names, titles) reaches the page only through maud, the tables in [`table`] or the data block in
//! [`page::series`], all of which escape it.

pub mod assets;
pub mod bridge_air;
pub mod bridge_zone;
pub mod cold_battery;
mod context;
pub mod coverage;
pub mod defects;
pub mod disturbed_air;
pub mod feedback;
pub mod formatting;
pub mod interval_total;
pub mod line_of_sight;
pub mod mesh;
pub mod navigation_errors;
pub mod page;
pub mod pictures;
pub mod plots;
pub mod radio_losses;
pub mod scorm;
pub mod sketch;
pub mod table;
pub mod task_proximity;
pub mod water_losses;

pub use context::ReviewContext;

use crate::advice::{FlightEvidence, MissedDefect, SessionAdvice, lesson_advice, session_advice, translation_languages};
use crate::marks::TimelineMark;
use crate::plan::{self, DEFAULT_RULES, PlanRules, PlanStep, read_rules};
use crate::record::{RecordSource, SessionRecord, SourceHashes, record};
use crate::standing::SessionStanding;
use crate::terms::{scenario_title, task_title};
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_mavlink::telemetry::timeline::LinkCounts;
use spandrel_mavlink::telemetry::{Frame, NavigationReader, Timeline};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::shipped::SCENARIOS;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::assessment::{Assessment, IdentifiedFlight, flight_with_seed, identified_flight};
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::crash::{self, Crash};
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_monitor::{AssessError, AssessedSession, ScoringJob, assess};
use spandrel_text::Language;

/// Session metadata, from the session folder.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SessionMetadata {
    /// Language of the report.
    pub language: Language,
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    pub purpose: Option<String>,
    /// Wall-clock time at simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Start time in UTC, as text.
    pub started_utc: String,
    /// Session folder name.
    pub folder: String,
    /// SHA-256 of the scenario file, hexadecimal.
    pub scenario_sha256: String,
    /// SHA-256 of the vehicle file, hexadecimal.
    pub vehicle_sha256: String,
    /// SHA-256 of the telemetry, hexadecimal.
    pub telemetry_sha256: String,
    /// Pictures by sequence number, downsized for embedding.
    pub pictures: Vec<(u32, Jpeg)>,
    /// The instructor's marks on the timeline, by moment.
    pub marks: Vec<TimelineMark>,
    /// File name of the video beside the report, which begins at lift-off; `None` without a video.
    pub video: Option<&'static str>,
    /// Comparison with the trainee's earlier sessions of the job; `None` without any.
    pub standing: Option<SessionStanding>,
}

/// A JPEG picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jpeg {
    /// Contents of the JPEG file.
    pub bytes: Vec<u8>,
}

/// All data of a session report.
#[derive(Debug)]
pub struct Review {
    /// Metadata from the session folder.
    pub metadata: SessionMetadata,
    /// The session's scenario.
    pub scenario: Scenario,
    /// Aircraft flown in the session.
    pub vehicle: Vehicle,
    /// Site built from the session's seed.
    pub site: Site,
    /// The session's seed.
    pub seed: u64,
    /// The session's assessment.
    pub assessment: Assessment,
    /// Session frames; frame 1 has index 0.
    pub frames: Vec<Frame>,
    /// The drone's position relative to the tasks in each frame.
    pub track: Vec<task_proximity::TaskProximityStep>,
    /// Task windows and on-path frames.
    pub on_path: OnPath,
    /// All contacts, in order of onset.
    pub crashes: Vec<Crash>,
    /// Measures for each task's window.
    pub tasks: Vec<task_proximity::TaskTotals>,
    /// Feedback and the trainee's reactions.
    pub feedback: feedback::SessionFeedback,
    /// Pictures with their verdicts.
    pub pictures: Vec<pictures::ReviewedPicture>,
    /// Defects with their outcomes.
    pub defects: Vec<defects::DefectOutcome>,
    /// Surface coverage by element.
    pub coverage: coverage::SurfaceCoverage,
    /// Recommended scenarios, based on this session and the default rules.
    pub next: Vec<PlanStep>,
    /// Things to do better, and the scenario to fly next. The sentences are in English with translations.
    pub advice: SessionAdvice,
    /// Errors of the aircraft's own position and heading, and time without GNSS.
    pub navigation: navigation_errors::NavigationErrors,
    /// Time with a poor video link, and losses of control.
    pub radio: radio_losses::RadioLosses,
    /// Time in air that the bridges disturbed, and where they did most.
    pub air: disturbed_air::DisturbedAir,
    /// Failures of optical flow and range finder over water.
    pub water: water_losses::WaterLosses,
    /// Costs of a cold battery; `None` if it was not cold.
    pub cold_battery: Option<cold_battery::ColdBattery>,
    /// Wind at the drone in each frame, m/s; `None` where the vehicle did not report it.
    pub wind_m_s: Vec<Option<Vec3<Enu>>>,
    /// Time out of the inspector's sight.
    pub out_of_sight: interval_total::IntervalTotal,
    /// Statistics of the telemetry link.
    pub link: LinkCounts,
}

impl Review {
    /// Reads a session's telemetry and computes the review.
    ///
    /// # Errors
    /// Fails if the log cannot be read, belongs to a different scenario or seed, or contains no session.
    pub fn of(
        log: &(impl TelemetryLog + ?Sized),
        scenario: &Scenario,
        vehicle: &Vehicle,
        metadata: SessionMetadata,
    ) -> Result<Self, AssessError> {
        // The replay runs first because the monitor keeps its own copy of the flight until it is dropped.
        let events = feedback::events(log, scenario, vehicle)?;
        let (timeline, navigation) = NavigationReader::read_log(log, LocalPlane::new(scenario.origin))?;
        let IdentifiedFlight { epoch, flight, seed } = identified_flight(&timeline, scenario, vehicle)?;
        let navigation = navigation.of(epoch);
        let link = timeline.counts();
        drop(timeline);
        let site = Site::build(scenario, seed).with_changes(attention::site_changes(&flight));
        let (assessment, frames) = assess(&flight, &ScoringJob { scenario, vehicle, survey: &site })?;
        let assessed_session = AssessedSession { assessment, frames, seed };
        let (assessment, frames) = (&assessed_session.assessment, &assessed_session.frames);
        let paths = ReferencePaths::new(scenario);
        let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
        let scene = ReviewContext { flight: &flight, frames, scenario, vehicle, site: &site };
        let track = task_proximity::steps(&paths, &on_path, &scene);
        let pictures = pictures::evaluate_pictures(&scene, assessment, &track);
        let coverage = coverage::compute_coverage(&scene, &pictures);
        let (crashes, tasks) = (crash::crashes(frames, &on_path), task_proximity::tasks(&scene, &on_path, &track));
        let (feedback, defects) =
            (feedback::collect_feedback(events, &scene, &track), defects::defect_outcomes(&scene, assessment));
        let scored = ScoredFlight { scene, metadata: &metadata, assessed_session: &assessed_session };
        let (next, advice) = scored.plan_and_advice(&defects);
        let radio = radio_losses::RadioLosses::measure(frames, &navigation);
        let air = disturbed_air::DisturbedAir::measure(scenario, frames, &navigation);
        let water = water_losses::WaterLosses::measure(frames, &navigation);
        let cold_battery = cold_battery::ColdBattery::measure(scenario, &vehicle.battery, frames, &navigation);
        let wind_m_s = frames.iter().map(|frame| navigation.wind_m_s(frame.time)).collect();
        let navigation = navigation_errors::NavigationErrors::measure(&flight, frames, &navigation);
        let out_of_sight = line_of_sight::out_of_sight(&site, frames);
        let AssessedSession { assessment, frames, .. } = assessed_session;
        Ok(Self {
            crashes,
            tasks,
            feedback,
            defects,
            coverage,
            next,
            advice,
            navigation,
            radio,
            air,
            water,
            cold_battery,
            wind_m_s,
            out_of_sight,
            link,
            metadata,
            scenario: scenario.clone(),
            vehicle: vehicle.clone(),
            seed,
            assessment,
            track,
            on_path,
            pictures,
            frames,
            site,
        })
    }

    /// Returns the title of the job.
    #[must_use]
    pub fn title(&self, language: Language) -> String {
        scenario_title(&self.scenario.name, &self.scenario.title, language)
    }

    /// Returns the name of the task with this index; empty if there is none.
    #[must_use]
    pub fn task_name(&self, task: usize, language: Language) -> String {
        let task = self.scenario.tasks.get(task);
        task.map_or_else(String::new, |task| task_title(&self.scenario.name, &task.name, language))
    }

    /// Returns whether the vehicle reported the wind.
    #[must_use]
    pub fn has_wind(&self) -> bool {
        self.wind_m_s.iter().any(Option::is_some)
    }

    /// Returns the wind at the drone in a frame: its horizontal speed, m/s, and the direction from which it comes, degrees.
    #[must_use]
    pub fn wind(&self, frame: usize) -> Option<(f64, f64)> {
        let wind_m_s = self.wind_m_s.get(frame).copied().flatten()?;
        let from_deg = math::bearing_deg(-wind_m_s.east(), -wind_m_s.north());
        Some((wind_m_s.horizontal_norm(), from_deg))
    }

    /// Returns what the job's hazards did in this flight, as sentences.
    #[must_use]
    pub fn hazard_sentences(&self, language: Language) -> Vec<String> {
        let battery = self.cold_battery.map(|battery| battery.sentence(language));
        let mut lines = self.navigation.sentences(language);
        lines.extend(self.radio.sentences(language));
        lines.extend(self.air.sentences(&self.scenario, language));
        lines.extend(self.water.sentences(language));
        lines.extend(battery);
        lines
    }

    /// Returns the time of a frame in seconds since lift-off.
    #[must_use]
    pub fn t_s(&self, frame: usize) -> f64 {
        let first = self.frames.first().map_or(0.0, |frame| frame.time.s());
        self.frames.get(frame).map_or(0.0, |frame| frame.time.s() - first)
    }
}

/// Computes a session's advice without the rest of the review.
///
/// # Errors
/// Fails if the log cannot be read, belongs to a different scenario or seed, or contains no session.
pub fn advice_of(
    log: &(impl TelemetryLog + ?Sized),
    scenario: &Scenario,
    vehicle: &Vehicle,
    metadata: &SessionMetadata,
) -> Result<SessionAdvice, AssessError> {
    let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
    timeline.push_log(log)?;
    let (flight, seed) = flight_with_seed(&timeline, scenario, vehicle)?;
    drop(timeline);
    let site = Site::build(scenario, seed).with_changes(attention::site_changes(&flight));
    let (assessment, frames) = assess(&flight, &ScoringJob { scenario, vehicle, survey: &site })?;
    let assessed_session = AssessedSession { assessment, frames, seed };
    let scene = ReviewContext { flight: &flight, frames: &assessed_session.frames, scenario, vehicle, site: &site };
    let defects = defects::defect_outcomes(&scene, &assessed_session.assessment);
    Ok(ScoredFlight { scene, metadata, assessed_session: &assessed_session }.plan_and_advice(&defects).1)
}

/// A scored session, from which its plan and advice are computed.
struct ScoredFlight<'a> {
    scene: ReviewContext<'a>,
    metadata: &'a SessionMetadata,
    assessed_session: &'a AssessedSession,
}

impl ScoredFlight<'_> {
    /// Returns the scenarios recommended by the default rules for this session alone, and the advice; both are empty if the
    /// rules are invalid, which a test rules out.
    fn plan_and_advice(&self, defect_outcomes: &[defects::DefectOutcome]) -> (Vec<PlanStep>, SessionAdvice) {
        let Some(rules) = rules_for(self.scene.scenario) else { return Default::default() };
        let record = self.record(defect_outcomes);
        if !self.scene.scenario.lesson.is_empty() {
            return (Vec::new(), lesson_advice(&record.trainee));
        }
        let missed: Vec<MissedDefect> = defect_outcomes.iter().filter_map(defects::DefectOutcome::missed).collect();
        let plan = |language| self.plan_steps(&record, &rules, language);
        let advice = session_advice(
            plan,
            &rules,
            &FlightEvidence {
                scenario: self.scene.scenario,
                vehicle: self.scene.vehicle,
                flight: self.scene.flight,
                assessed_session: self.assessed_session,
                record: &record,
                missed: &missed,
            },
            translation_languages(),
        );
        (plan(self.metadata.language), advice)
    }

    /// Returns the scenarios that the rules recommend after this session, in a language.
    fn plan_steps(&self, record: &SessionRecord, rules: &PlanRules, language: Language) -> Vec<PlanStep> {
        let plan = plan::plan(std::slice::from_ref(record), rules, self.metadata.started_unix_us, language);
        let mut steps = plan.map_or_else(Vec::new, |plan| plan.steps);
        // A level depends on the trainee's other sessions, which are unknown here.
        steps.iter_mut().for_each(|step| step.level = None);
        steps
    }

    /// Creates the session's record, with the times for which missed defects were in view.
    fn record(&self, defect_outcomes: &[defects::DefectOutcome]) -> SessionRecord {
        let metadata = self.metadata;
        let hashes = SourceHashes {
            scenario: metadata.scenario_sha256.clone(),
            vehicle: metadata.vehicle_sha256.clone(),
            telemetry: metadata.telemetry_sha256.clone(),
            answers: String::new(),
        };
        let mut record = record(&RecordSource {
            id: &metadata.folder,
            trainee: &metadata.trainee,
            purpose: metadata.purpose.as_deref(),
            started_unix_us: metadata.started_unix_us,
            spandrel_version: env!("CARGO_PKG_VERSION"),
            scenario: self.scene.scenario,
            vehicle: &self.scene.vehicle.id,
            hashes: &hashes,
            assessed_session: self.assessed_session,
            placed: self.scene.site.defects(),
            answers: None,
        });
        for defect in &mut record.defects {
            let outcome = defect_outcomes.iter().find(|outcome| outcome.defect.id == defect.id);
            defect.in_view_s = outcome.and_then(|outcome| outcome.best_approach.as_ref()).map(|approach| approach.in_view_s);
        }
        record
    }
}

/// Returns the default rules with the difficulty levels of the shipped drills and of the flown scenario, which may be an
/// uploaded one.
fn rules_for(scenario: &Scenario) -> Option<PlanRules> {
    let is_installed = |name: &str| SCENARIOS.iter().any(|(stem, _)| *stem == name);
    let rules = read_rules("rules.toml", DEFAULT_RULES).ok()?.for_installed(is_installed);
    let own = |name: &str| scenario.difficulty.clone().filter(|_| name == scenario.name);
    Some(rules.with_shipped_levels().with_levels(own))
}
