//! Scores logs and stored sessions.

use super::files::ScenarioFile;
use super::session_folder::StoredSession;
use crate::errors::AppError;
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::export::FrameRow;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessError, AssessedSession, assess_log, export};

/// Scores a log.
///
/// # Errors
/// Returns an error if there is nothing to score.
pub fn grade(log: &(impl TelemetryLog + ?Sized), scenario: &Scenario, vehicle: &Vehicle) -> Result<AssessedSession, AppError> {
    assess_log(log, scenario, vehicle, build_site).map_err(|error| scoring_error(&error))
}

/// Scores a log of a flight in this scenario, or in another form or difficulty level of it. Also returns the one that was flown.
///
/// # Errors
/// Returns an error if there is nothing to score, or if the flight was flown in another scenario.
pub fn assess_any_variant(
    log: &(impl TelemetryLog + ?Sized),
    scenario: ScenarioFile,
    vehicle: &Vehicle,
) -> Result<(ScenarioFile, AssessedSession), AssessError> {
    match assess_log(log, &scenario.scenario, vehicle, build_site) {
        Ok(assessed_session) => Ok((scenario, assessed_session)),
        Err(AssessError::OtherScenario { name, received, expected }) => {
            let Some(mut flown) = scenario.variant_with_crc(received) else {
                return Err(AssessError::OtherScenario { name, received, expected });
            };
            flown.scenario.seed = scenario.scenario.seed;
            let assessed_session = assess_log(log, &flown.scenario, vehicle, build_site)?;
            Ok((flown, assessed_session))
        }
        Err(error) => Err(error),
    }
}

/// Returns a stored session's scored frames, for exports.
///
/// # Errors
/// Returns an error if there is nothing to score.
pub fn frame_rows(stored: &StoredSession) -> Result<Vec<FrameRow>, AppError> {
    let rows = export::frame_rows(&stored.log, &stored.scenario.scenario, &stored.vehicle.vehicle);
    rows.map_err(|error| scoring_error(&error))
}

/// Converts a scorer's error to a subcommand's error.
pub fn scoring_error(error: &AssessError) -> AppError {
    match error {
        AssessError::OtherScenario { .. } | AssessError::OtherSeed { .. } => {
            AppError::invalid(format!("{error}: use the flight's scenario and seed"))
        }
        AssessError::NeverFlown
        | AssessError::NotTelemetry
        | AssessError::NoTruth
        | AssessError::NoSeed
        | AssessError::Unreadable(_) => AppError::failed(error.to_string()),
    }
}
