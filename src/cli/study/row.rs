//! One flight's row in the results: both scoring profiles and the counts behind them.

use super::flight::{FlightError, FlownFlight};
use super::plan::PlannedFlight;
use crate::io::parquet::{TableColumn, TypedValues};
use serde::{Deserialize, Serialize};

/// A flight's results. Fields that describe results are `None` if the flight failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightRow {
    pub scenario: String,
    pub vehicle: String,
    pub pilot: String,
    pub seed: u64,
    pub fingerprint: String,
    /// Reason why the flight failed.
    pub error: Option<String>,
    pub result: Option<FlightResult>,
}

/// Results of a flight that did not fail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightResult {
    pub conformity: Option<f64>,
    pub efficiency: f64,
    pub safety: f64,
    pub accuracy: Option<f64>,
    pub overall: f64,
    pub complete: bool,
    pub tasks_done: i64,
    pub path_share: f64,
    pub certified: bool,
    pub unmet: String,
    pub certification_conformity: Option<f64>,
    pub certification_efficiency: f64,
    pub certification_safety: f64,
    pub certification_accuracy: Option<f64>,
    pub certification_precision: Option<f64>,
    /// Sum of the five; one without evidence adds nothing.
    pub certification_sum: f64,
    pub certification_sum_max: f64,
    pub seconds: f64,
    pub end_reason: String,
    pub crashes: i64,
    /// Crashes in each task, then outside of all tasks, separated by spaces.
    pub crashes_by_task: String,
    pub speeding_tasks: i64,
    pub off_path_tasks: i64,
    pub pictures: i64,
    pub hits: i64,
    pub defects_found: i64,
    pub defects_placed: i64,
    pub digest: String,
    pub cue_texts: i64,
    pub off_path_cues: i64,
    pub off_path_cues_outside: i64,
    pub speeding_cues: i64,
    pub speeding_cues_short: i64,
    pub stand_off_cues: i64,
    pub too_close_cues: i64,
    pub deviations: i64,
    pub deviations_missed: i64,
}

impl FlightRow {
    /// Returns the row of a flight; `None` if it was stopped.
    pub fn of(flight: &PlannedFlight, vehicle: &str, flown: Result<FlownFlight, FlightError>) -> Option<Self> {
        let (result, error) = match flown {
            Ok(flown) => (Some(FlightResult::of(&flown)), None),
            Err(FlightError::Failed(words)) => (None, Some(words)),
            Err(FlightError::Stopped) => return None,
        };
        Some(Self {
            scenario: flight.id.scenario.clone(),
            vehicle: vehicle.to_owned(),
            pilot: flight.id.pilot.clone(),
            seed: flight.id.seed,
            fingerprint: flight.fingerprint.clone(),
            error,
            result,
        })
    }
}

impl FlightResult {
    fn of(flown: &FlownFlight) -> Self {
        let one = &flown.assessment;
        let scores = &one.certification.scores;
        let count = |number: usize| i64::try_from(number).unwrap_or(i64::MAX);
        Self {
            conformity: one.scores.conformity.map(|score| score.pct),
            efficiency: one.scores.efficiency.pct,
            safety: one.scores.safety.pct,
            accuracy: one.scores.accuracy.map(|score| score.pct),
            overall: one.scores.overall,
            complete: one.completion.complete,
            tasks_done: count(one.completion.tasks_done),
            path_share: one.completion.path_share,
            certified: one.certification.passed,
            unmet: one.certification.unmet.join("; "),
            certification_conformity: scores.conformity,
            certification_efficiency: scores.efficiency,
            certification_safety: scores.safety,
            certification_accuracy: scores.accuracy,
            certification_precision: scores.precision,
            certification_sum: scores.sum,
            certification_sum_max: scores.sum_max,
            seconds: one.end.seconds,
            end_reason: one.end.reason.label().to_owned(),
            crashes: count(one.crashes.other + one.crashes.person + one.crashes.vehicle),
            crashes_by_task: one.crashes.by_task.values().map(ToString::to_string).collect::<Vec<_>>().join(" "),
            speeding_tasks: count(one.tasks.iter().filter(|task| task.speeding > 0.0).count()),
            off_path_tasks: count(one.tasks.iter().filter(|task| task.on_path < 1.0).count()),
            pictures: count(one.snapshots.taken),
            hits: count(one.snapshots.hits),
            defects_found: count(one.snapshots.defects_found),
            defects_placed: count(one.snapshots.defects_placed),
            digest: flown.digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            cue_texts: count(flown.cues.texts),
            off_path_cues: count(flown.cues.off_path),
            off_path_cues_outside: count(flown.cues.off_path_outside),
            speeding_cues: count(flown.cues.speeding),
            speeding_cues_short: count(flown.cues.speeding_short),
            stand_off_cues: count(flown.cues.stand_off),
            too_close_cues: count(flown.cues.too_close),
            deviations: count(flown.cues.deviations),
            deviations_missed: count(flown.cues.deviations_missed),
        }
    }
}

/// Reads a column's value from a row.
enum Read {
    Text(fn(&FlightRow) -> Option<String>),
    Integer(fn(&FlightRow) -> Option<i64>),
    Float(fn(&FlightRow) -> Option<f64>),
    Boolean(fn(&FlightRow) -> Option<bool>),
}

macro_rules! result {
    ($kind:ident, $field:ident) => {
        Read::$kind(|row| row.result.as_ref().map(|result| result.$field.clone()))
    };
    ($kind:ident, $field:ident, optional) => {
        Read::$kind(|row| row.result.as_ref().and_then(|result| result.$field))
    };
}

/// Name, unit, definition and value of each column. All columns but the first five are empty for failed flights.
const COLUMNS: &[(&str, &str, &str, Read)] = &[
    ("scenario", "", "Scenario name, with @ and the form if it has forms.", Read::Text(|row| Some(row.scenario.clone()))),
    ("vehicle", "", "Aircraft ID.", Read::Text(|row| Some(row.vehicle.clone()))),
    ("pilot", "", "Pilot, as specified with --skill or --pilot.", Read::Text(|row| Some(row.pilot.clone()))),
    ("seed", "", "Seed.", Read::Integer(|row| i64::try_from(row.seed).ok())),
    (
        "fingerprint",
        "",
        "SHA-256 of the scenario, aircraft, pilot and program version.",
        Read::Text(|row| Some(row.fingerprint.clone())),
    ),
    ("error", "", "Reason why the flight failed; empty if it did not.", Read::Text(|row| row.error.clone())),
    ("conformity", "points", "Conformity (TASBID), 0 to 100.", result!(Float, conformity, optional)),
    ("efficiency", "points", "Efficiency (TASBID), 0 to 100.", result!(Float, efficiency)),
    ("safety", "points", "Safety (TASBID), 0 to 100.", result!(Float, safety)),
    ("accuracy", "points", "Accuracy (TASBID), 0 to 100.", result!(Float, accuracy, optional)),
    ("overall", "points", "Sum of the applicable scores (TASBID).", result!(Float, overall)),
    ("complete", "", "True if every task is done and the flight ended by landing at home.", result!(Boolean, complete)),
    ("tasks_done", "", "Number of tasks done.", result!(Integer, tasks_done)),
    ("path_share", "", "Fraction of all paths that was flown, 0 to 1.", result!(Float, path_share)),
    ("certified", "", "True if all certification requirements are met.", result!(Boolean, certified)),
    ("unmet", "", "Unmet certification requirements, separated by semicolons.", result!(Text, unmet)),
    (
        "certification_conformity",
        "points",
        "Conformity of the certification profile, 0 to 100.",
        result!(Float, certification_conformity, optional),
    ),
    (
        "certification_efficiency",
        "points",
        "Efficiency of the certification profile, 0 to 100.",
        result!(Float, certification_efficiency),
    ),
    ("certification_safety", "points", "Safety of the certification profile, 0 to 100.", result!(Float, certification_safety)),
    (
        "certification_accuracy",
        "points",
        "Accuracy of the certification profile, 0 to 100.",
        result!(Float, certification_accuracy, optional),
    ),
    (
        "certification_precision",
        "points",
        "Precision of the certification profile, 0 to 100.",
        result!(Float, certification_precision, optional),
    ),
    ("certification_sum", "points", "Sum of the five; one without evidence adds nothing.", result!(Float, certification_sum)),
    (
        "certification_sum_max",
        "points",
        "Highest possible sum: 100 per score that applies to the job.",
        result!(Float, certification_sum_max),
    ),
    ("seconds", "s", "Flight duration.", result!(Float, seconds)),
    ("end_reason", "", "Reason why the flight ended.", result!(Text, end_reason)),
    ("crashes", "", "Number of crashes.", result!(Integer, crashes)),
    (
        "crashes_by_task",
        "",
        "Number of crashes in each task, then outside of all tasks, separated by spaces.",
        result!(Text, crashes_by_task),
    ),
    ("speeding_tasks", "", "Number of tasks with speeding.", result!(Integer, speeding_tasks)),
    ("off_path_tasks", "", "Number of tasks with time off the path.", result!(Integer, off_path_tasks)),
    ("pictures", "", "Number of pictures taken.", result!(Integer, pictures)),
    ("hits", "", "Number of pictures that show a new defect.", result!(Integer, hits)),
    ("defects_found", "", "Number of distinct defects shown.", result!(Integer, defects_found)),
    ("defects_placed", "", "Number of defects at the site.", result!(Integer, defects_placed)),
    ("digest", "", "SHA-256 of the vehicle's state at every tick.", result!(Text, digest)),
    ("cue_texts", "", "Number of texts that belong to a cue.", result!(Integer, cue_texts)),
    ("off_path_cues", "", "Number of off-path cues.", result!(Integer, off_path_cues)),
    (
        "off_path_cues_outside",
        "",
        "Number of off-path cues that started while no task was being flown.",
        result!(Integer, off_path_cues_outside),
    ),
    ("speeding_cues", "", "Number of speeding cues.", result!(Integer, speeding_cues)),
    ("speeding_cues_short", "", "Number of speeding cues shorter than 1 s.", result!(Integer, speeding_cues_short)),
    ("stand_off_cues", "", "Number of stand-off cues.", result!(Integer, stand_off_cues)),
    ("too_close_cues", "", "Number of too-close cues.", result!(Integer, too_close_cues)),
    (
        "deviations",
        "",
        "Number of deviations of more than 3 s from the path of the task that was being flown.",
        result!(Integer, deviations),
    ),
    (
        "deviations_missed",
        "",
        "Number of these deviations without an off-path or stand-off cue.",
        result!(Integer, deviations_missed),
    ),
];

/// Number of columns that are never empty.
const REQUIRED_COLUMNS: usize = 5;

/// Returns the rows as typed columns.
pub fn columns(rows: &[FlightRow]) -> Vec<TableColumn<'static>> {
    let values = |read: &Read| match read {
        Read::Text(value) => TypedValues::Text(rows.iter().map(value).collect()),
        Read::Integer(value) => TypedValues::Integer(rows.iter().map(value).collect()),
        Read::Float(value) => TypedValues::Float(rows.iter().map(value).collect()),
        Read::Boolean(value) => TypedValues::Boolean(rows.iter().map(value).collect()),
    };
    let column = |(k, (name, unit, description, read)): (usize, &(&'static str, &'static str, &'static str, Read))| TableColumn {
        name,
        unit,
        frame: "",
        description,
        optional: k >= REQUIRED_COLUMNS,
        values: values(read),
    };
    COLUMNS.iter().enumerate().map(column).collect()
}
