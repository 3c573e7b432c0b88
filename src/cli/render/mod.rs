//! `spandrel render`: renders images of a recorded session, or of a scenario from any viewpoint.

mod args;

use crate::errors::AppError;
#[cfg(feature = "view")]
mod dataset;
#[cfg(feature = "view")]
mod dataset_folder;
#[cfg(feature = "view")]
mod draw;
#[cfg(feature = "view")]
mod masks;
#[cfg(feature = "view")]
mod recorded;
#[cfg(feature = "view")]
pub mod scene_drawing;
#[cfg(feature = "view")]
mod snapshots;
#[cfg(feature = "view")]
mod video;

pub use args::Args;

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, the time is outside the session, or there is no graphics adapter.
#[cfg(feature = "view")]
pub fn run(args: &Args) -> Result<(), AppError> {
    if args.nice {
        crate::window::priority::lower_priority();
    }
    draw::run(args)
}

/// Reports that the program was built without the view.
///
/// # Errors
/// Always returns an error.
#[cfg(not(feature = "view"))]
pub fn run(args: &Args) -> Result<(), AppError> {
    Err(AppError::failed(format!(
        "this program was built without the view, so '{}' cannot be rendered: rebuild it with `cargo build --release --features view`",
        args.what
    )))
}
