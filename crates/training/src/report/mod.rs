//! The report of a finished session, a single page that works offline. [`Review::of`] reads the telemetry with the scorer's code
//! and computes the contents; [`page::session`] renders the page. Pure functions: bytes and names in, text out.
//!
//! User-provided text (names, titles) reaches the page only through maud's escaping, the tables of [`table`] or the data block of
//! [`page::series`].

pub mod assets;
mod context;
pub mod coverage;
pub mod cues;
pub mod defects;
pub mod outline;
pub mod page;
pub mod pictures;
pub mod plots;
pub mod scorm;
pub mod sketch;
pub mod table;
pub mod track;
pub mod words;

pub use context::ReviewContext;

use crate::plan::{self, PlanStep, RULES, read_rules};
use crate::record::{RecordSource, SourceHashes, record};
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_mavlink::telemetry::timeline::LinkCounts;
use spandrel_mavlink::telemetry::{Frame, Timeline};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::assessment::{Assessment, identified_flight};
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::crash::{self, Crash};
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_monitor::{AssessError, AssessedSession, ScoringJob, assess};

/// Session metadata from the session folder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SessionFacts {
    /// Trainee name.
    pub trainee: String,
    /// `practice` or `assessment`, if chosen.
    pub purpose: Option<String>,
    /// Wall-clock time of simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// The start time in UTC as text.
    pub started_utc: String,
    /// Name of the session folder.
    pub folder: String,
    /// SHA-256 of the scenario file, hexadecimal.
    pub scenario_sha256: String,
    /// SHA-256 of the vehicle file, hexadecimal.
    pub vehicle_sha256: String,
    /// SHA-256 of the telemetry, hexadecimal.
    pub telemetry_sha256: String,
    /// Pictures by sequence number in the folder, small enough to embed.
    pub pictures: Vec<(u32, Jpeg)>,
}

/// A JPEG file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jpeg {
    /// File contents.
    pub bytes: Vec<u8>,
}

/// All data of a session report.
#[derive(Debug)]
pub struct Review {
    /// Session metadata.
    pub about: SessionFacts,
    /// Scenario of the session.
    pub scenario: Scenario,
    /// Vehicle that was flown.
    pub vehicle: Vehicle,
    /// Site built from the session's seed.
    pub site: Site,
    /// Seed of the session.
    pub seed: u64,
    /// Assessment of the session.
    pub assessment: Assessment,
    /// Frames 1 to N.
    pub frames: Vec<Frame>,
    /// Position relative to the tasks, frame by frame.
    pub track: Vec<track::TaskProximityStep>,
    /// Task windows and on-path frames.
    pub on_path: OnPath,
    /// Onsets of contact.
    pub crashes: Vec<Crash>,
    /// Measures of each task's window.
    pub tasks: Vec<track::TaskFacts>,
    /// Measures of each task's window.
    pub feedback: cues::CueText,
    /// Feedback and the trainee's responses.
    pub pictures: Vec<pictures::ReviewedPicture>,
    /// Pictures with their verdicts.
    pub defects: Vec<defects::DefectOutcome>,
    /// Surface coverage by element.
    pub coverage: coverage::SurfaceCoverage,
    /// Recommended next steps, based on this session alone and the default rules.
    pub next: Vec<PlanStep>,
    /// Link statistics.
    pub link: LinkCounts,
}

impl Review {
    /// Reads a session's telemetry and computes the review.
    ///
    /// # Errors
    /// If the log cannot be read, belongs to a different scenario or seed, or contains no session.
    pub fn of(
        log: &(impl TelemetryLog + ?Sized),
        scenario: &Scenario,
        vehicle: &Vehicle,
        about: SessionFacts,
    ) -> Result<Self, AssessError> {
        // Runs before the flight is loaded, because the monitor keeps its own copy until it is done.
        let events = cues::events(log, scenario, vehicle)?;
        let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
        timeline.push_log(log)?;
        let (flight, seed) = identified_flight(&timeline, scenario, vehicle)?;
        let link = timeline.counts();
        drop(timeline);
        let site = Site::build(scenario, seed).with_closures(attention::gates(&flight));
        let (assessment, frames) = assess(&flight, &ScoringJob { scenario, vehicle, survey: &site })?;
        let paths = ReferencePaths::new(scenario);
        let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
        let scene = ReviewContext { flight: &flight, frames: &frames, scenario, vehicle, site: &site };
        let track = track::steps(&paths, &on_path, &scene);
        let pictures = pictures::judged(&scene, &assessment, &track);
        let coverage = coverage::covered(&scene, &pictures);
        let (crashes, tasks) = (crash::crashes(&frames, &on_path), track::tasks(&scene, &on_path, &track));
        let (feedback, defects) = (cues::cue_text(events, &scene, &track), defects::fates(&scene, &assessment));
        let graded = AssessedSession { assessment, frames, seed };
        let next = next(&about, scenario, vehicle, &graded, (&site, &defects));
        let AssessedSession { assessment, frames, .. } = graded;
        Ok(Self {
            crashes,
            tasks,
            feedback,
            defects,
            coverage,
            next,
            link,
            about,
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

    /// Returns the time of a frame, s since lift-off.
    #[must_use]
    pub fn t_s(&self, frame: usize) -> f64 {
        let first = self.frames.first().map_or(0.0, |frame| frame.time.s());
        self.frames.get(frame).map_or(0.0, |frame| frame.time.s() - first)
    }
}

/// Evaluates the default rules for one session; empty if the rules are invalid, which tests rule out.
fn next(
    about: &SessionFacts,
    scenario: &Scenario,
    vehicle: &Vehicle,
    graded: &AssessedSession,
    (site, fates): (&Site, &[defects::DefectOutcome]),
) -> Vec<PlanStep> {
    let hashes = SourceHashes {
        scenario: about.scenario_sha256.clone(),
        vehicle: about.vehicle_sha256.clone(),
        telemetry: about.telemetry_sha256.clone(),
        answers: String::new(),
    };
    let mut record = record(&RecordSource {
        id: &about.folder,
        trainee: &about.trainee,
        purpose: about.purpose.as_deref(),
        started_unix_us: about.started_unix_us,
        spandrel_version: env!("CARGO_PKG_VERSION"),
        scenario,
        vehicle: &vehicle.id,
        hashes: &hashes,
        graded,
        placed: site.defects(),
        answers: None,
    });
    for defect in &mut record.defects {
        let fate = fates.iter().find(|fate| fate.defect.id == defect.id);
        defect.in_view_s = fate.and_then(|fate| fate.chance.as_ref()).map(|chance| chance.in_view_s);
    }
    let rules = read_rules("rules.toml", RULES).ok();
    rules.and_then(|rules| plan::plan(&[record], &rules, about.started_unix_us)).map_or_else(Vec::new, |plan| plan.steps)
}
