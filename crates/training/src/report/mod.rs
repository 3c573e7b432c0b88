//! A finished session made into one page that opens offline: [`Review::of`] reads the telemetry again by the scorer's own code and works out
//! what the page tells, [`page::session`] writes it. Pure: bytes and names in, text out.
//!
//! Whatever a user wrote (names, titles) reaches the page through maud's escaping, the tables of [`table`] or the data block of
//! [`page::series`], and through nothing else.

pub mod assets;
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

use crate::plan::{self, PlanStep, RULES, read_rules};
use crate::record::{RecordSource, SourceHashes, record};
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_mavlink::telemetry::timeline::LinkCounts;
use spandrel_mavlink::telemetry::{Flight, Frame, Timeline};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::assessment::{Assessment, identified_flight};
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::crash::{self, Crash};
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_monitor::{AssessError, AssessedSession, ScoringJob, assess};

/// What the folder says besides the flight itself.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SessionFacts {
    /// Who flew.
    pub trainee: String,
    /// `practice` or `assessment`, where somebody chose.
    pub purpose: Option<String>,
    /// Wall time of simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// The same for people, UTC.
    pub started_utc: String,
    /// Name of the session folder.
    pub folder: String,
    /// SHA-256 of the scenario file, hexadecimal.
    pub scenario_sha256: String,
    /// SHA-256 of the vehicle file, hexadecimal.
    pub vehicle_sha256: String,
    /// SHA-256 of the telemetry, hexadecimal.
    pub telemetry_sha256: String,
    /// Pictures by their running number in the folder, small enough to be shown as they are.
    pub pictures: Vec<(u32, Jpeg)>,
}

/// A picture's file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jpeg {
    /// JPEG.
    pub bytes: Vec<u8>,
}

/// Everything that a report tells of one session, worked out once.
#[derive(Debug)]
pub struct Review {
    /// Who, when, which files.
    pub about: SessionFacts,
    /// The job.
    pub scenario: Scenario,
    /// The aircraft.
    pub vehicle: Vehicle,
    /// The site of this session's seed.
    pub site: Site,
    /// Seed.
    pub seed: u64,
    /// The scores.
    pub assessment: Assessment,
    /// Frames 1 to N.
    pub frames: Vec<Frame>,
    /// Frame by frame, how the drone stood to the tasks.
    pub track: Vec<track::TaskProximityStep>,
    /// Windows and on-path frames.
    pub on_path: OnPath,
    /// Onsets of contact.
    pub crashes: Vec<Crash>,
    /// What each task's window holds.
    pub tasks: Vec<track::TaskFacts>,
    /// Feedback and what the trainee did.
    pub feedback: cues::CueText,
    /// Pictures.
    pub pictures: Vec<pictures::ReviewedPicture>,
    /// Defects.
    pub defects: Vec<defects::DefectOutcome>,
    /// Surface seen, by element.
    pub coverage: coverage::SurfaceCoverage,
    /// What to fly next, by this session alone and the shipped rules.
    pub next: Vec<PlanStep>,
    /// What the link did.
    pub link: LinkCounts,
}

impl Review {
    /// Reads a session's telemetry again.
    ///
    /// # Errors
    /// When the log cannot be read, is of another scenario or seed, or holds no session.
    pub fn of(
        log: &(impl TelemetryLog + ?Sized),
        scenario: &Scenario,
        vehicle: &Vehicle,
        about: SessionFacts,
    ) -> Result<Self, AssessError> {
        // Before the flight is in memory: the sidecar that hears the log holds a second one until it has ended.
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

    /// Flight time of a frame, s since lift-off.
    #[must_use]
    pub fn t_s(&self, frame: usize) -> f64 {
        let first = self.frames.first().map_or(0.0, |frame| frame.time.s());
        self.frames.get(frame).map_or(0.0, |frame| frame.time.s() - first)
    }
}

/// What the shipped rules say of one session; nothing when they cannot be read, which a test excludes.
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

/// What the parts of a review look at.
#[derive(Debug, Clone, Copy)]
pub struct ReviewContext<'a> {
    /// The flight.
    pub flight: &'a Flight,
    /// Its frames.
    pub frames: &'a [Frame],
    /// The job.
    pub scenario: &'a Scenario,
    /// The aircraft.
    pub vehicle: &'a Vehicle,
    /// The site.
    pub site: &'a Site,
}

impl ReviewContext<'_> {
    /// Seconds since lift-off of a simulation time.
    #[must_use]
    pub fn time_since_lift_off_s(&self, time: spandrel_model::time::SimTime) -> f64 {
        self.frames.first().map_or(0.0, |first| (time - first.time).s())
    }
}
