//! `spandrel assess`: scores a recorded flight again.

use super::table;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::io::log_file::LogFile;
use crate::io::scoring::grade;
use crate::io::session_folder::StoredSession;
use serde_json::json;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::export;
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
    /// Aircraft for a telemetry log: a file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME")]
    vehicle: Option<String>,
    /// Write the assessment as JSON to this file; '-' for standard output [default: print a table]
    #[arg(long, value_name = "FILE")]
    json: Option<String>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid or there is nothing to score.
pub fn run(args: &Args) -> Result<(), AppError> {
    let (scenario, vehicle, log) = inputs(args)?;
    let assessed_session = grade(&log, &scenario, &vehicle)?;
    match &args.json {
        Some(target) => files::write(target, export::json_text(&assessed_session.assessment).as_bytes()),
        None => files::write("-", table::scores_text(&json!(assessed_session.assessment)).as_bytes()),
    }
}

fn inputs(args: &Args) -> Result<(Scenario, Vehicle, LogFile), AppError> {
    if args.flight.is_dir() {
        let stored = StoredSession::read(&args.flight)?;
        let scenario = match &args.scenario {
            Some(other) => files::scenario(other)?.scenario,
            None => stored.scenario.scenario,
        };
        let vehicle = match &args.vehicle {
            Some(other) => files::vehicle(other)?.vehicle,
            None => stored.vehicle.vehicle,
        };
        return Ok((scenario, vehicle, stored.log));
    }
    let (Some(scenario), Some(vehicle)) = (&args.scenario, &args.vehicle) else {
        return Err(AppError::invalid(format!(
            "{}: not a session folder; a telemetry log needs --scenario and --vehicle",
            args.flight.display()
        )));
    };
    Ok((files::scenario(scenario)?.scenario, files::vehicle(vehicle)?.vehicle, LogFile::open(&args.flight)?))
}
