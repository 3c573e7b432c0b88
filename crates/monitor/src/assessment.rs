//! Flight assessment. External tools read `assessment.json`, whose keys are the field names.

use super::measures::attention::{self, SiteSurvey, Snapshot};
use super::measures::coverage::{self, PathCoverage};
use super::measures::crash::{self, Crash};
use super::measures::on_path::{OnPath, ReferencePaths};
use super::measures::on_speed;
use super::measures::practice_aids::PracticeAids;
use super::score::accuracy::DetectionTally;
use super::score::certification::inputs::CertificationInputs;
use super::score::certification::{self, Certification};
use super::score::completion::{Completion, TaskState};
use super::score::conformity::TaskShares;
use super::score::{Score, conformity, efficiency, safety};
use super::session::{EndReason, Session, lift_off_height_m};
use serde::Serialize;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::modes::ControlSource;
use spandrel_mavlink::telemetry::log_stream::{self, TelemetryLog};
use spandrel_mavlink::telemetry::{Flight, Frame, Timeline};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;

/// The scenario, vehicle and site that a flight is scored against.
#[derive(Debug, Clone, Copy)]
pub struct ScoringJob<'a> {
    /// The session's scenario.
    pub scenario: &'a Scenario,
    /// Aircraft flown in the session.
    pub vehicle: &'a Vehicle,
    /// Site built from the session's seed; determines which defects are visible.
    pub survey: &'a dyn SiteSurvey,
}

/// Reason why a flight cannot be scored.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AssessError {
    /// The drone never rose above the lift-off height.
    #[error("no lift-off: the drone never rose more than 0.3 m above the pad, so there is no session to score")]
    NeverFlown,
    /// The log is not a telemetry log.
    #[error("not a telemetry log: it contains no MAVLink messages")]
    NotTelemetry,
    /// The telemetry contains no ground-truth messages.
    #[error("the telemetry contains no HIL_STATE_QUATERNION messages; scoring requires their timestamps and true states")]
    NoTruth,
    /// The telemetry was recorded in a different scenario.
    #[error("the simulator runs a different scenario: it reports scn_crc {received:#010x}, but `{name}` has {expected:#010x}")]
    OtherScenario {
        /// Name of the session's scenario.
        name: String,
        /// `scn_crc` value received from the simulator.
        received: u32,
        /// CRC of the session's scenario.
        expected: u32,
    },
    /// The telemetry was recorded with a different seed.
    #[error("the simulator uses seed {received}, but the session uses seed {expected}, which places different defects")]
    OtherSeed {
        /// Seed received from the simulator.
        received: u64,
        /// The session's seed.
        expected: u64,
    },
    /// No seed is available from the telemetry, the scenario or the command line.
    #[error(
        "no seed available: the telemetry contains no `seed` message, and neither the scenario nor the command line specifies one"
    )]
    NoSeed,
    /// The telemetry log could not be read.
    #[error("cannot read the telemetry: {0}")]
    Unreadable(String),
}

impl From<std::io::Error> for AssessError {
    fn from(error: std::io::Error) -> Self {
        Self::Unreadable(error.to_string())
    }
}

/// Session assessment: TASBID scores and certification results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assessment {
    /// Scoring profile used for `scores`; always `paper`.
    pub profile: &'static str,
    /// Form of the scenario: the set of defects; `None` if the scenario has no forms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<String>,
    /// Difficulty level of the scenario; `None` if the scenario has no levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u8>,
    /// The four scores and their sum.
    pub scores: Scores,
    /// Job completion.
    pub completion: Completion,
    /// Results per task, in scenario order.
    pub tasks: Vec<TaskResult>,
    /// Crash counts by kind of object hit.
    pub crashes: CrashCounts,
    /// Picture results: totals and individual results.
    pub snapshots: SnapshotCounts,
    /// End of the session: reason, length and battery failure.
    pub end: SessionEnd,
    /// Fraction of frames for which telemetry was received, and the number of gaps.
    pub telemetry: TelemetryCoverage,
    /// Control source over time. Does not affect any score.
    pub flown_by: Vec<ControlInterval>,
    /// Freezes and rewinds, with which the session is not certified.
    pub practice_aids: PracticeAids,
    /// Result of the certification profile.
    pub certification: Certification,
}

/// An interval of consecutive frames with the same control source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ControlInterval {
    /// Number of the first frame.
    pub from_frame: u32,
    /// Number of the last frame, inclusive.
    pub to_frame: u32,
    /// Control source; `None` before the first heartbeat.
    pub by: Option<ControlSource>,
}

/// Scores as defined in the TASBID paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Scores {
    /// Conformity; `None` for a job without tasks.
    pub conformity: Option<Score>,
    /// Efficiency, based on flight time and return.
    pub efficiency: Score,
    /// Safety, based on crashes.
    pub safety: Score,
    /// Accuracy; `None` for a job without defects.
    pub accuracy: Option<Score>,
    /// Sum of the score percentages.
    pub overall: f64,
    /// Maximum possible `overall`: 100 per applicable score.
    pub overall_max: f64,
}

/// One task's path and speed results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TaskResult {
    /// Task number in the scenario.
    pub id: u32,
    /// Whether the drone entered the task's path. If not, the task is flagged `not_attempted`.
    pub attempted: bool,
    /// Task state: done, partly flown or not attempted.
    pub state: TaskState,
    /// Fraction of the task's path that was flown, 0 to 1.
    pub covered: f64,
    /// Number of the first frame on the path.
    pub first_frame: Option<u32>,
    /// Number of the last frame on the path.
    pub last_frame: Option<u32>,
    /// Fraction of the task window's frames that are on the path (P_p), 0 to 1.
    pub on_path: f64,
    /// The task's speeding loss (P_s in TASBID).
    pub speeding: f64,
}

/// Crash counts by kind of object hit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrashCounts {
    /// Number of contacts with anything except people and vehicles (X_o).
    pub other: usize,
    /// 1 if a person was hit, otherwise 0 (X_h).
    pub person: usize,
    /// 1 if a vehicle was hit, otherwise 0 (X_v).
    pub vehicle: usize,
    /// Crash counts by task number; the `outside` key counts crashes outside all windows.
    pub by_task: serde_json::Map<String, serde_json::Value>,
}

/// Pictures taken and defects found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SnapshotCounts {
    /// Number of pictures taken (X_pd).
    pub taken: usize,
    /// Number of pictures that show a new defect.
    pub hits: usize,
    /// Number of distinct defects shown (X_td).
    pub defects_found: usize,
    /// Number of defects placed in the scene (X_d).
    pub defects_placed: usize,
    /// Precision: `hits` / `taken`.
    pub precision: f64,
    /// Recall: `defects_found` / `defects_placed`; `None` if no defect was placed.
    pub recall: Option<f64>,
    /// F-measure of precision and recall; `None` if no defect was placed.
    pub f_beta: Option<f64>,
    /// Result of each picture in order, including any unmet conditions.
    pub each: Vec<Snapshot>,
}

/// End of the session: reason, length and battery failure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SessionEnd {
    /// Reason for the end.
    pub reason: EndReason,
    /// Number of frames (N).
    pub frames: usize,
    /// Session duration, s: number of frames divided by the frame rate (N/f).
    pub seconds: f64,
    /// Whether the session ended because the battery was empty or the time limit was reached (X_b).
    pub battery_failed: bool,
}

/// Fraction of the session for which telemetry was received, and the gaps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TelemetryCoverage {
    /// Number of frames in gaps longer than 1 s. They repeat the last position and velocity.
    pub missing_frames: usize,
    /// Number of frames in gaps of 0.2 to 1 s. Their position and velocity are interpolated.
    pub interpolated_frames: usize,
    /// Number of gaps longer than 0.2 s.
    pub gaps: usize,
    /// Fraction of frames that are not missing, 0 to 1.
    pub covered: f64,
}

/// An assessment and the frames from which it was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct AssessedSession {
    /// The session's assessment.
    pub assessment: Assessment,
    /// Session frames; frame 1 has index 0.
    pub frames: Vec<Frame>,
    /// Seed used to place the defects.
    pub seed: u64,
}

/// Scores one flight and returns the assessment and its frames.
///
/// # Errors
/// Fails if the telemetry contains no ground-truth messages, or if the drone never lifted off.
pub fn assess(flight: &Flight, job: &ScoringJob<'_>) -> Result<(Assessment, Vec<Frame>), AssessError> {
    if flight.truths.is_empty() {
        return Err(AssessError::NoTruth);
    }
    let scenario = job.scenario;
    let session = Session::from_flight(flight, scenario, job.vehicle).ok_or(AssessError::NeverFlown)?;
    let paths = ReferencePaths::new(scenario);
    let on_path = OnPath::measure(&paths, session.frames.iter().map(|frame| frame.position_m));
    let crashes = crash::crashes(&session.frames, &on_path);
    let pictures = attention::snapshots(flight, &session.frames, job.vehicle, job.survey);
    let counts = DetectionTally {
        taken: pictures.len(),
        hits: pictures.iter().filter(|picture| picture.hit).count(),
        found: attention::found_defects(&pictures).len(),
        placed: job.survey.defects().len(),
    };
    let shares = shares(scenario, &session, &on_path);
    let covered = coverage::coverage(&paths, &on_path);
    let done_share = scenario.scoring.task_completion_fraction;
    let attempted = on_path.windows.iter().map(Option::is_some);
    let states: Vec<TaskState> =
        attempted.zip(&covered).map(|(attempted, covered)| TaskState::of(attempted, covered.share, done_share)).collect();
    let completion = Completion::of(&states, &covered, session.reason == EndReason::Landed, done_share);
    let practice_aids = PracticeAids::measure(flight, &session.frames);
    let evidence = CertificationInputs {
        scenario,
        vehicle: job.vehicle,
        flight,
        paths: &paths,
        session: &session,
        on_path: &on_path,
        covered: &covered,
        states: &states,
        completion,
        crashes: &crashes,
        pictures: &pictures,
        defects: job.survey.defects(),
        practice_aids,
    };
    let certification = certification::grade(&evidence);
    let end = end(scenario, &session);
    let assessment = Assessment {
        profile: "paper",
        form: scenario.form.as_ref().map(|form| form.name.clone()),
        level: scenario.difficulty.as_ref().map(|difficulty| difficulty.level),
        scores: scores(scenario, &shares, &end, &crashes, counts),
        completion,
        tasks: tasks(scenario, &on_path, &shares, (&states, &covered)),
        crashes: crash_counts(scenario, &crashes),
        snapshots: snapshot_counts(scenario, counts, pictures),
        end,
        telemetry: telemetry_coverage(&session.frames),
        flown_by: control_intervals(flight, &session.frames),
        practice_aids,
        certification,
    };
    Ok((assessment, session.frames))
}

/// Scores a telemetry log. `build` creates the site from the seed.
///
/// # Errors
/// Fails if the log cannot be read or is not a telemetry log, if it belongs to a different scenario or seed, or if it
/// contains no session.
pub fn assess_log(
    log: &(impl TelemetryLog + ?Sized),
    scenario: &Scenario,
    vehicle: &Vehicle,
    build: impl FnOnce(&Scenario, u64) -> std::sync::Arc<dyn SiteSurvey>,
) -> Result<AssessedSession, AssessError> {
    let mut timeline = Timeline::new(LocalPlane::new(scenario.origin));
    timeline.push_log(log)?;
    if timeline.newest().is_none() && !log_stream::contains_messages(log)? {
        return Err(AssessError::NotTelemetry);
    }
    let (flight, seed) = flight_with_seed(&timeline, scenario, vehicle)?;
    // The flight contains all the data that scoring needs. Keeping the timeline as well would double the memory use.
    drop(timeline);
    let survey = attention::with_flight_changes(build(scenario, seed), &flight);
    let (assessment, frames) = assess(&flight, &ScoringJob { scenario, vehicle, survey: survey.as_ref() })?;
    Ok(AssessedSession { assessment, frames, seed })
}

/// A flight that belongs to a scenario, and its seed.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedFlight {
    /// Number of earlier simulator runs in the timeline.
    pub epoch: usize,
    /// The flight.
    pub flight: Flight,
    /// The session's seed.
    pub seed: u64,
}

/// Returns the flight to score.
///
/// # Errors
/// Fails if the telemetry belongs to a different scenario or seed, or contains no session.
pub fn identified_flight(timeline: &Timeline, scenario: &Scenario, vehicle: &Vehicle) -> Result<IdentifiedFlight, AssessError> {
    let (epoch, flight) = flight_and_prior_runs(timeline, scenario, vehicle);
    if flight.truths.is_empty() {
        return Err(AssessError::NoTruth);
    }
    let seed = check_identity(&flight, scenario, None)?;
    Ok(IdentifiedFlight { epoch, flight, seed })
}

/// Returns the flight to score and its seed.
///
/// # Errors
/// Fails if the telemetry belongs to a different scenario or seed, or contains no session.
pub fn flight_with_seed(timeline: &Timeline, scenario: &Scenario, vehicle: &Vehicle) -> Result<(Flight, u64), AssessError> {
    identified_flight(timeline, scenario, vehicle).map(|IdentifiedFlight { flight, seed, .. }| (flight, seed))
}

/// Returns the flight to score: the first one with a lift-off or, if none has one, the last.
#[must_use]
pub fn scored_flight(timeline: &Timeline, scenario: &Scenario, vehicle: &Vehicle) -> Flight {
    flight_and_prior_runs(timeline, scenario, vehicle).1
}

/// Returns the flight to score and the number of earlier simulator runs in the timeline.
#[must_use]
pub fn flight_and_prior_runs(timeline: &Timeline, scenario: &Scenario, vehicle: &Vehicle) -> (usize, Flight) {
    let height_m = lift_off_height_m(vehicle);
    let mut last = (0, Flight::default());
    for epoch in 0..timeline.epoch_count() {
        last = (epoch, timeline.flight(epoch));
        if last.1.lift_off(scenario.ground_team.pad_m.up(), height_m).is_some() {
            break;
        }
    }
    last
}

/// Checks that the telemetry, the session and the command line agree on the scenario and seed. Returns the seed.
///
/// # Errors
/// Fails if the scenario or the seed differs, or if no seed is available.
pub fn check_identity(flight: &Flight, scenario: &Scenario, asked: Option<u64>) -> Result<u64, AssessError> {
    for (_, _, heard) in flight.scenario_crcs.all() {
        check_scenario(scenario, *heard)?;
    }
    let mut seed = asked.or(scenario.seed);
    for (_, _, heard) in flight.seeds.all() {
        check_seed(seed, *heard)?;
        seed = Some(*heard);
    }
    seed.ok_or(AssessError::NoSeed)
}

/// Checks the scenario CRC received from the simulator.
///
/// # Errors
/// Fails if the CRCs differ.
pub fn check_scenario(scenario: &Scenario, received: u32) -> Result<(), AssessError> {
    if received == scenario.crc {
        return Ok(());
    }
    Err(AssessError::OtherScenario { name: scenario.name.clone(), received, expected: scenario.crc })
}

/// Checks the seed received from the simulator.
///
/// # Errors
/// Fails if the session has a different seed.
pub fn check_seed(expected: Option<u64>, received: u64) -> Result<(), AssessError> {
    match expected {
        Some(ours) if ours != received => Err(AssessError::OtherSeed { received, expected: ours }),
        Some(_) | None => Ok(()),
    }
}

fn shares(scenario: &Scenario, session: &Session, on_path: &OnPath) -> Vec<TaskShares> {
    let limit = scenario.scoring.speed_limit_m_s;
    let speeds: Vec<f64> = session.frames.iter().map(Frame::speed_m_s).collect();
    let speeding = on_speed::speeding(&speeds, &on_path.windows, limit);
    let one = |(task, window): (usize, &Option<_>)| TaskShares {
        on_path: on_path.share(task),
        speeding: on_speed::loss(&speeds, &speeding, *window, limit),
    };
    on_path.windows.iter().enumerate().map(one).collect()
}

/// Computes the scores defined in the TASBID paper from the measures.
#[must_use]
pub fn scores(scenario: &Scenario, shares: &[TaskShares], end: &SessionEnd, crashes: &[Crash], counts: DetectionTally) -> Scores {
    let scoring = &scenario.scoring;
    let hit = |with: ContactKind| crashes.iter().any(|crash| crash.with == with);
    let others = crashes.iter().filter(|crash| crash.with.is_other_crash()).count();
    let conformity = conformity::score(shares, scoring.speed_limit_m_s, scoring.max_speed_m_s);
    let efficiency = efficiency::score(end.seconds, end.battery_failed, scoring.time_best_s, scoring.time_max_s);
    let safety = safety::score(hit(ContactKind::Person), hit(ContactKind::Vehicle), others);
    let accuracy = counts.score(scoring.beta);
    let applying = [conformity, Some(efficiency), Some(safety), accuracy];
    let overall = applying.iter().flatten().map(|score| score.pct).sum();
    let overall_max = 100.0 * applying.iter().flatten().count() as f64;
    Scores { conformity, efficiency, safety, accuracy, overall, overall_max }
}

fn tasks(
    scenario: &Scenario,
    on_path: &OnPath,
    shares: &[TaskShares],
    (states, covered): (&[TaskState], &[PathCoverage]),
) -> Vec<TaskResult> {
    let number = |i: usize| u32::try_from(i + 1).unwrap_or(u32::MAX);
    let one = |(t, task): (usize, &spandrel_model::scenario::Task)| {
        let window = on_path.windows[t];
        TaskResult {
            id: task.id,
            attempted: window.is_some(),
            state: states[t],
            covered: covered[t].share,
            first_frame: window.map(|w| number(w.first)),
            last_frame: window.map(|w| number(w.last)),
            on_path: shares[t].on_path,
            speeding: shares[t].speeding,
        }
    };
    scenario.tasks.iter().enumerate().map(one).collect()
}

fn crash_counts(scenario: &Scenario, crashes: &[Crash]) -> CrashCounts {
    let among = |task: Option<usize>| crashes.iter().filter(|crash| crash.task == task).count();
    let of = |with: ContactKind| usize::from(crashes.iter().any(|crash| crash.with == with));
    let tasks = scenario.tasks.iter().enumerate().map(|(t, task)| (task.id.to_string(), among(Some(t)).into()));
    CrashCounts {
        other: crashes.iter().filter(|crash| crash.with.is_other_crash()).count(),
        person: of(ContactKind::Person),
        vehicle: of(ContactKind::Vehicle),
        by_task: tasks.chain([("outside".to_owned(), among(None).into())]).collect(),
    }
}

fn snapshot_counts(scenario: &Scenario, counts: DetectionTally, each: Vec<Snapshot>) -> SnapshotCounts {
    SnapshotCounts {
        taken: counts.taken,
        hits: counts.hits,
        defects_found: counts.found,
        defects_placed: counts.placed,
        precision: counts.precision(),
        recall: counts.recall(),
        f_beta: counts.f_beta(scenario.scoring.beta),
        each,
    }
}

fn end(scenario: &Scenario, session: &Session) -> SessionEnd {
    SessionEnd {
        reason: session.reason,
        frames: session.frames.len(),
        seconds: session.seconds(scenario.scoring.frame_rate_hz),
        battery_failed: matches!(session.reason, EndReason::Battery | EndReason::TimeLimit),
    }
}

fn control_intervals(flight: &Flight, frames: &[Frame]) -> Vec<ControlInterval> {
    let mut stretches: Vec<ControlInterval> = Vec::new();
    for frame in frames {
        let by = flight.flown_by.at(frame.time);
        match stretches.last_mut() {
            Some(last) if last.by == by => last.to_frame = frame.index,
            Some(_) | None => stretches.push(ControlInterval { from_frame: frame.index, to_frame: frame.index, by }),
        }
    }
    stretches
}

fn telemetry_coverage(frames: &[Frame]) -> TelemetryCoverage {
    let gap = |frame: &Frame| frame.missing || frame.interpolated;
    let starts = frames.iter().enumerate().filter(|(i, frame)| gap(frame) && (*i == 0 || !gap(&frames[i - 1]))).count();
    let missing = frames.iter().filter(|frame| frame.missing).count();
    TelemetryCoverage {
        missing_frames: missing,
        interpolated_frames: frames.iter().filter(|frame| frame.interpolated).count(),
        gaps: starts,
        covered: 1.0 - missing as f64 / frames.len().max(1) as f64,
    }
}
