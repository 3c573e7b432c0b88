//! `spandrel render`: pictures of a recorded session, or of a scenario from anywhere.

use super::args;
use super::errors::{AppError, EXIT_CODES};
use std::path::PathBuf;
#[cfg(feature = "view")]
mod draw;
#[cfg(feature = "view")]
mod masks;
#[cfg(feature = "view")]
mod recorded;
#[cfg(feature = "view")]
mod snapshots;
#[cfg(feature = "view")]
mod video;
#[cfg(feature = "view")]
pub(super) use draw::{png, quality, size};

/// Draw any moment of a recorded session, or a scenario from anywhere, as a PNG picture
///
/// Of a session: what the aircraft's camera saw at a simulation time, what the inspector at the pad saw, or both side by side, with the
/// head-up display. Of a scenario: from any point towards another. No window and no graphics card are needed: a software Vulkan driver
/// does (Debian and Ubuntu: mesa-vulkan-drivers). --snapshots draws all photographs of a session as JPEG files with EXIF and XMP into its
/// folder, --video a film of the camera's view with the photographs as chapters beside it (WebVTT).
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "help and errors are the same with and without the view"))]
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel render sessions/20260801T... --at 95 --out both.png
  spandrel render sessions/20260801T... --at 95 --view camera --size 4000x3000 --quality high --no-hud
  spandrel render sessions/20260801T... --snapshots
  spandrel render sessions/20260801T... --snapshots --masks
  spandrel render sessions/20260801T... --video flight.mp4 --span 60,90 --size 960x540
  spandrel render two-bridges --from=-150,-60,12 --look 0,0,25 --utc 2026-06-20T08:00:00Z --cloud 0.2
  spandrel render two-bridges --from 20,-1,28 --look 0,0,31 --lamp --seed 7

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder, scenario file, or the name of a shipped scenario
    #[arg(value_name = "SESSION|SCENARIO")]
    what: String,
    /// Simulation time, s; of a session without it: the middle of the flight
    #[arg(long, value_name = "S")]
    at: Option<f64>,
    /// Where the picture goes; '-' for standard output
    #[arg(long, value_name = "FILE", default_value = "picture.png")]
    out: String,
    /// Which view of a session
    #[arg(long, value_name = "VIEW", value_parser = ["camera", "inspector", "both"], default_value = "both")]
    view: String,
    /// Size of each view, px; the camera's, and photographs, keep its sensor's shape within it [default: 1280x720; of photographs the
    /// camera's, without a graphics card smaller]
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// How much the picture may cost: low, medium, high or ultra
    #[arg(long, value_name = "PRESET", default_value = "high")]
    quality: String,
    /// Beside each picture what its pixels show, to train detectors: NAME.elements.png (AASHTO element numbers), NAME.defects.png (numbers of
    /// defects), both 16 bits grey, and NAME.masks.json (kind, condition state, box of each defect)
    #[arg(long, conflicts_with = "video")]
    masks: bool,
    /// Without the head-up display
    #[arg(long)]
    no_hud: bool,
    /// All photographs of a session into its folder snapshots (JPEG), small copies for the report into its folder small, and the report anew
    #[arg(long, conflicts_with_all = ["at", "out", "view", "video"])]
    snapshots: bool,
    /// A film of a session's camera view (MP4, H.264), and beside it its chapters (.vtt)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["at", "out", "view"])]
    video: Option<PathBuf>,
    /// Pictures a second of the film, 1 to 60
    #[arg(long, value_name = "HZ", default_value_t = 15.0, requires = "video")]
    fps: f64,
    /// Part of the flight in the film, s of simulation time [default: all of it]
    #[arg(long, value_name = "FROM,TO", requires = "video")]
    span: Option<String>,
    /// Where the eye is, m from the scenario's origin: east, north, up; only of a scenario
    #[arg(long, value_name = "E,N,U", allow_hyphen_values = true, requires = "look")]
    from: Option<String>,
    /// What it looks at, m
    #[arg(long, value_name = "E,N,U", allow_hyphen_values = true, requires = "from")]
    look: Option<String>,
    /// Horizontal field of view, deg; without it the aircraft's camera's; only of a scenario
    #[arg(long, value_name = "DEG")]
    fov: Option<f64>,
    /// The lamp is on, at the eye; only of a scenario
    #[arg(long)]
    lamp: bool,
    /// Another start of the session, UTC, for another sun (2026-06-20T08:00:00Z); only of a scenario
    #[arg(long, value_name = "UTC")]
    utc: Option<String>,
    /// Another share of clouds, 0 to 1; only of a scenario
    #[arg(long, value_name = "SHARE")]
    cloud: Option<f64>,
    /// Aircraft of a scenario: a file, or the name of a shipped one
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    vehicle: String,
    /// Leave the processor to others who want it
    #[arg(long)]
    nice: bool,
    /// Seed that places defects and traffic of a scenario [default: its own]
    #[arg(long, value_name = "N", value_parser = args::seed)]
    seed: Option<u64>,
}

/// Runs the subcommand.
///
/// # Errors
/// When files are wrong, there is no such moment, or nothing to draw with.
#[cfg(feature = "view")]
pub fn run(args: &Args) -> Result<(), AppError> {
    if args.nice {
        super::priority::lower_priority();
    }
    draw::run(args)
}

/// Says what is missing.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(args: &Args) -> Result<(), AppError> {
    Err(AppError::failed(format!(
        "this program was built without the view, so '{}' cannot be drawn: build it with `cargo build --release --features view`",
        args.what
    )))
}
