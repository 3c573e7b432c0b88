//! `spandrel train`: simulator and monitor for a person's ground station, and a window that leads from one flight to the next.

mod args;
mod connection_info;
mod flight_processes;
mod offers;
mod photographs;
mod prompt;
mod questionnaire_state;
mod train_run;
mod window;

pub use args::Args;

use crate::errors::AppError;
use crate::io::stop::StopRequest;
use crate::io::{controller, files};
use args::USUAL;
use train_run::TrainRun;

/// Runs the subcommand.
///
/// # Errors
/// When files or ports are wrong, a process fails, or the flight cannot be scored.
pub fn run(args: &Args, log: tracing::Level) -> Result<(), AppError> {
    // What is wrong with the files is told before anything starts.
    files::scenario(args.scenario.as_deref().unwrap_or(USUAL))?;
    files::vehicle(&args.vehicle)?;
    controller::keys(args.keys.as_deref())?;
    check_quality(&args.quality)?;
    TrainRun::new(args, log, StopRequest::install(false)?).run()
}

/// Refuses a preset that there is not; a build without the window has none.
fn check_quality(name: &str) -> Result<(), AppError> {
    #[cfg(feature = "view")]
    super::picture_args::quality_or_auto(name)?;
    let _ = name;
    Ok(())
}
