//! `spandrel assess`: scores a recorded flight again.

use super::{args, table};
use crate::errors::{AppError, EXIT_CODES};
use crate::io::files::ScenarioFile;
use crate::io::log_file::LogFile;
use crate::io::session_folder::StoredSession;
use crate::io::{files, log_check, scoring};
use serde_json::json;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessError, assess_log, export};
use spandrel_training::advice::SessionAdvice;
use spandrel_training::report::{SessionMetadata, advice_of};
use std::path::PathBuf;

/// Score a recorded flight again
///
/// Scores a session folder, or a telemetry log with its scenario and vehicle, using only the telemetry. The result is
/// byte-identical to the live result.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel assess sessions/20260801T...                       print the scores as a table
  spandrel assess sessions/20260801T... --json -              print the scores in the format of assessment.json
  spandrel assess flight.tlog --scenario two-bridges --vehicle phantom2 --json scores.json

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder, or a telemetry log (.tlog)
    #[arg(value_name = "SESSION|TLOG")]
    flight: PathBuf,
    /// Scenario for a telemetry log: a file, or the name of a shipped scenario
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// Form of the scenario for a telemetry log, if it has forms [default: the one in the log]
    #[arg(long, value_name = "NAME", requires = "scenario")]
    form: Option<String>,
    /// Difficulty level of the scenario for a telemetry log, if it has levels [default: the one in the log]
    #[arg(long, value_name = "N", requires = "scenario", conflicts_with = "form")]
    level: Option<u8>,
    /// Aircraft for a telemetry log: a file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME")]
    vehicle: Option<String>,
    /// Seed of the flight (0 to 2147483647), which determines the positions of the defects, for a log that doesn't contain
    /// it [default: the seed in the log or in the scenario]
    #[arg(long, value_name = "N", value_parser = args::parse_seed, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Write the assessment as JSON to this file; '-' for standard output [default: print a table]
    #[arg(long, value_name = "FILE")]
    json: Option<String>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid or there is nothing to score.
pub fn run(args: &Args) -> Result<(), AppError> {
    let (mut scenario, vehicle, log, trainee) = inputs(args)?;
    scenario.scenario.seed = args.seed.or(scenario.scenario.seed);
    let selected = args.form.is_some() || args.level.is_some();
    let scored = match selected {
        true => assess_log(&log, &scenario.scenario, &vehicle, build_site).map(|assessed| (scenario, assessed)),
        false => scoring::assess_any_variant(&log, scenario, &vehicle),
    };
    let (scenario, assessed_session) = match scored {
        Ok(scored) => scored,
        Err(error) => return Err(explain(&error, args, &log)?),
    };
    for warning in log_check::warnings(&log, &scenario.scenario, &vehicle)? {
        tracing::warn!("{warning}");
    }
    match &args.json {
        Some(target) => files::write(target, export::json_text(&assessed_session.assessment).as_bytes()),
        None => {
            let advice = advice(trainee, &scenario.scenario, &vehicle, &log);
            files::write("-", table::scores_text(&json!(assessed_session.assessment), advice.as_ref()).as_bytes())
        }
    }
}

/// Returns the advice for the scored flight; `None` if it cannot be computed, because the scores do not depend on it.
fn advice(trainee: String, scenario: &Scenario, vehicle: &Vehicle, log: &LogFile) -> Option<SessionAdvice> {
    let advice = advice_of(log, scenario, vehicle, &SessionMetadata { trainee, ..SessionMetadata::default() });
    advice.inspect_err(|error| tracing::warn!("cannot compute what to do better: {error}")).ok()
}

/// Returns the error to report, with the file and the options that can solve the problem.
///
/// # Errors
/// Returns an error if the log cannot be read.
fn explain(error: &AssessError, args: &Args, log: &LogFile) -> Result<AppError, AppError> {
    let path = log.path().display();
    match error {
        AssessError::NotTelemetry => log_check::foreign_file_error(log),
        AssessError::NoSeed => Ok(AppError::invalid(format!(
            "{path}: neither the log nor the scenario contains the flight's seed: specify it with --seed N"
        ))),
        AssessError::OtherSeed { received, .. } if args.seed.is_some_and(|asked| asked != *received) => {
            Ok(AppError::invalid(format!("{path}: the flight's seed is {received}: omit --seed")))
        }
        AssessError::OtherSeed { .. }
        | AssessError::OtherScenario { .. }
        | AssessError::NeverFlown
        | AssessError::NoTruth
        | AssessError::Unreadable(_) => Ok(scoring::scoring_error(error)),
    }
}

/// Trainee in the advice for a telemetry log, which does not name one.
const UNKNOWN_TRAINEE: &str = "NAME";

/// Returns the scenario, the vehicle, the log and the trainee.
fn inputs(args: &Args) -> Result<(ScenarioFile, Vehicle, LogFile, String), AppError> {
    if args.flight.is_dir() {
        let stored = StoredSession::read(&args.flight)?;
        let scenario = match &args.scenario {
            Some(other) => files::scenario(&files::with_variant(other, args.form.as_deref(), args.level))?,
            None => stored.scenario,
        };
        let vehicle = match &args.vehicle {
            Some(other) => files::vehicle(other)?.vehicle,
            None => stored.vehicle.vehicle,
        };
        return Ok((scenario, vehicle, stored.log, stored.trainee));
    }
    let (Some(scenario), Some(vehicle)) = (&args.scenario, &args.vehicle) else {
        return Err(AppError::invalid(format!(
            "{}: not a session folder; a telemetry log needs --scenario and --vehicle",
            args.flight.display()
        )));
    };
    let scenario = files::scenario(&files::with_variant(scenario, args.form.as_deref(), args.level))?;
    Ok((scenario, files::vehicle(vehicle)?.vehicle, LogFile::open(&args.flight)?, UNKNOWN_TRAINEE.to_owned()))
}
