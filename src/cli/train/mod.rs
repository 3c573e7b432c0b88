//! `spandrel train`: starts a simulator and a monitor for a trainee, and a window for choosing, flying and reviewing
//! flights.

mod aircraft;
mod args;
mod assigned;
mod connection_info;
mod expert_ghost;
mod flight_processes;
mod loading;
mod offers;
mod picture_jobs;
mod planned;
mod prompt;
mod questionnaire_state;
mod school;
mod station;
mod train_run;
mod window;

pub use args::Args;

use crate::errors::AppError;
use crate::io::stop::StopRequest;
use crate::io::{controller, files};
use aircraft::SelectedAircraft;
use train_run::TrainRun;

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or ports are invalid, a process fails, or the flight cannot be scored.
pub fn run(args: &Args, log: tracing::Level) -> Result<(), AppError> {
    if args.autopilot.flight_controller(&args.ports)?.is_some() {
        return Err(AppError::invalid(
            "--autopilot px4 with --serial: train pauses and restarts the simulation, and a flight controller cannot follow; run \
             sim, monitor and view instead (docs: \"A flight controller on your desk\")",
        ));
    }
    // Errors in the files are reported before any process starts.
    files::scenario(&args.scenario_argument())?;
    let aircraft = SelectedAircraft::read(&args.vehicle)?;
    controller::keys(args.keys.as_deref())?;
    args.quality.as_deref().map_or(Ok(()), check_quality)?;
    TrainRun::new(args, aircraft, log, StopRequest::install(false)?).run()
}

/// Checks a quality preset's name. Without the `view` feature, accepts every name.
fn check_quality(name: &str) -> Result<(), AppError> {
    #[cfg(feature = "view")]
    super::picture_args::parse_quality_or_auto(name)?;
    let _ = name;
    Ok(())
}
