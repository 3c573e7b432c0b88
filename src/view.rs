//! `spandrel view`: a window with the inspector's view and the camera's, live from telemetry.

use super::args::{self, JobArgs};
use super::errors::{AppError, EXIT_CODES};
#[cfg(feature = "view")]
mod cockpit;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

/// Watch a flight in a window, live: the inspector's view and the camera's, with the head-up display
///
/// Draws from the vehicle's telemetry and the scenario alone, so it also shows a real autopilot's vehicle, and it may run on another
/// machine. Defects and traffic are those of the seed that the simulator says, also when it begins anew; --seed is for a vehicle that says
/// none, and holds until the simulator has spoken. With --fly the keyboard in the window (and a calibrated controller, where one is
/// connected) flies. Tab swaps the views, the mouse looks around, the wheel zooms, F looks after the aircraft again, M hides the map. A
/// graphics card is not needed: a software Vulkan driver does (Debian and Ubuntu: mesa-vulkan-drivers).
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "help and errors are the same with and without the view"))]
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel view                                          what the simulator on this machine flies
  spandrel view --fly 127.0.0.1:18570                    and fly it with the keys: W S A D, arrows, 1 arms, T takes off
  spandrel view --stream 127.0.0.1:5600                  the camera's view in QGroundControl, too
  spandrel view --listen 0.0.0.0 --connect 192.168.1.20:14280 --quality low
  spandrel view --screenshot moment.png --after 10       a picture of the window after 10 s, then the end

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    pub(super) job: JobArgs,
    /// Dial the vehicle's payload port here
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address, default_value = "127.0.0.1:14280")]
    pub(super) connect: SocketAddr,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = args::listen)]
    pub(super) listen: IpAddr,
    /// Fly from the window: sticks and commands go to the vehicle's port for ground stations
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address, group = "pilot")]
    pub(super) fly: Option<SocketAddr>,
    /// Which key does what (TOML: format = 1, push, [sticks], [actions], [window], [sound]); the same file as that of `spandrel rc --keyboard`
    #[arg(long, value_name = "FILE")]
    pub(super) keys: Option<PathBuf>,
    /// Which controller, by a part of its name or its id [default: the only one]
    #[arg(long, value_name = "NAME", requires = "pilot")]
    pub(super) device: Option<String>,
    /// Folder of calibration profiles [default: spandrel/controllers in the user's configuration]
    #[arg(long, value_name = "DIR", requires = "pilot")]
    pub(super) profiles: Option<PathBuf>,
    /// How much a picture may cost: low, medium, high, ultra, or auto (high with a graphics card, low without)
    #[arg(long, value_name = "PRESET", default_value = "auto")]
    pub(super) quality: String,
    /// Size of the window, px
    #[arg(long, value_name = "WxH", default_value = "1600x560")]
    pub(super) size: String,
    /// Without sound; [sound] in the file of keys says what is played: propellers, warnings, speech, volume
    #[arg(long)]
    pub(super) no_sound: bool,
    /// Without the map of the reference paths, for an assessment: M does not bring it back
    #[arg(long)]
    pub(super) no_map: bool,
    /// Send the camera's view as H.264 over RTP there; the vehicle then announces the stream, and ground stations show it (QGroundControl
    /// listens at UDP 5600). It announces port 5600 always: who receives at another one must be told so by hand
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address)]
    pub(super) stream: Option<SocketAddr>,
    /// Keep a picture of the window (PNG), then end
    #[arg(long, value_name = "FILE", requires = "after")]
    pub(super) screenshot: Option<PathBuf>,
    /// Seconds of wall time from the first drawn view to the picture
    #[arg(long, value_name = "S", requires = "screenshot")]
    pub(super) after: Option<f64>,
    /// Keep the camera's view in this file (JPEG), about once a second, for the live page of `spandrel serve --picture FILE`
    #[arg(long, value_name = "FILE")]
    pub(super) picture: Option<PathBuf>,
    /// Print one JSON line {"device", "quality", "width", "height"} on standard output once both views are drawn
    #[arg(long)]
    pub(super) announce: bool,
    /// Finish when standard input closes (for a parent process)
    #[arg(long)]
    pub(super) leash: bool,
    /// Pages and flights as the parent process says them, a JSON line each on standard input; what is wished goes to standard output
    #[arg(long, requires = "leash", hide = true, group = "pilot")]
    pub(super) led: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When files are wrong, there is no display, or nothing to draw with.
#[cfg(feature = "view")]
pub fn run(args: &Args) -> Result<(), AppError> {
    cockpit::run(args)
}

/// Refuses a preset that there is not.
///
/// # Errors
/// When there is none of this name.
#[cfg(feature = "view")]
pub fn check_quality(name: &str) -> Result<(), AppError> {
    cockpit::window_config::quality(name).map(|_| ())
}

/// Says what is missing.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &Args) -> Result<(), AppError> {
    Err(AppError::failed("this program was built without the view: build it with `cargo build --release --features view`"))
}
