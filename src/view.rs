//! `spandrel view`: a window with the inspector's view and the camera's, live from telemetry.

use super::args::{self, JobArgs};
use super::errors::{AppError, EXIT_CODES};
#[cfg(feature = "view")]
mod cockpit;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

/// Watch a flight live in a window: the inspector's view and the camera's view, with head-up display
///
/// Uses only the vehicle's telemetry and the scenario, so it also works with a real autopilot and on another computer. Defects and traffic follow the
/// seed that the simulator reports, also after a restart; --seed applies until then, or if the vehicle reports none. With --fly, the keyboard in the
/// window (and a calibrated controller, if one is connected) flies the vehicle. Tab swaps the views, the mouse turns the inspector's view, the wheel
/// zooms, F follows the aircraft again, M hides the map. No graphics card is needed: a software Vulkan driver is enough (Debian and Ubuntu:
/// mesa-vulkan-drivers).
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "help and errors are the same with and without the view"))]
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel view                                          watch the simulator on this machine
  spandrel view --fly 127.0.0.1:18570                    fly it with the keyboard: W S A D, arrows, 1 arms, T takes off
  spandrel view --stream 127.0.0.1:5600                  also show the camera's view in QGroundControl
  spandrel view --listen 0.0.0.0 --connect 192.168.1.20:14280 --quality low
  spandrel view --screenshot moment.png --after 10       save a picture of the window after 10 s and exit

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    pub(super) job: JobArgs,
    /// Address of the vehicle's payload port
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address, default_value = "127.0.0.1:14280")]
    pub(super) connect: SocketAddr,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = args::listen)]
    pub(super) listen: IpAddr,
    /// Fly from the window: send sticks and commands to the vehicle's ground station port
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address, group = "pilot")]
    pub(super) fly: Option<SocketAddr>,
    /// Key bindings (TOML: format = 1, push, [sticks], [actions], [window], [sound]); the same file as for `spandrel rc
    /// --keyboard`
    #[arg(long, value_name = "FILE")]
    pub(super) keys: Option<PathBuf>,
    /// Controller, by its ID or part of its name [default: the only one]
    #[arg(long, value_name = "NAME", requires = "pilot")]
    pub(super) device: Option<String>,
    /// Folder of calibration profiles [default: spandrel/controllers in the user's configuration folder]
    #[arg(long, value_name = "DIR", requires = "pilot")]
    pub(super) profiles: Option<PathBuf>,
    /// Rendering quality: low, medium, high, ultra, or auto (high with a graphics card, low without)
    #[arg(long, value_name = "PRESET", default_value = "auto")]
    pub(super) quality: String,
    /// Window size, px
    #[arg(long, value_name = "WxH", default_value = "1600x560")]
    pub(super) size: String,
    /// Disable sound; [sound] in the key bindings file sets propellers, warnings, speech and volume
    #[arg(long)]
    pub(super) no_sound: bool,
    /// Disable the map of the reference paths, for an assessment; M does not show it
    #[arg(long)]
    pub(super) no_map: bool,
    /// Send the camera's view to this address as H.264 over RTP; the vehicle then announces the stream, and ground stations show
    /// it (QGroundControl listens on UDP port 5600). The vehicle always announces port 5600: configure any other port in the
    /// ground station
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address)]
    pub(super) stream: Option<SocketAddr>,
    /// Save a picture of the window (PNG) and exit
    #[arg(long, value_name = "FILE", requires = "after")]
    pub(super) screenshot: Option<PathBuf>,
    /// Wall time from the first drawn frame to the picture, s
    #[arg(long, value_name = "S", requires = "screenshot")]
    pub(super) after: Option<f64>,
    /// Save the camera's view to this file (JPEG) about once a second, for the live page of `spandrel serve --picture FILE`
    #[arg(long, value_name = "FILE")]
    pub(super) picture: Option<PathBuf>,
    /// Print one JSON line {"device", "quality", "width", "height"} on standard output when both views are drawn
    #[arg(long)]
    pub(super) announce: bool,
    /// Exit when standard input closes (for a parent process)
    #[arg(long)]
    pub(super) leash: bool,
    /// Receive pages and flights from the parent process as JSON lines on standard input; send the user's actions on standard
    /// output
    #[arg(long, requires = "leash", hide = true, group = "pilot")]
    pub(super) led: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// If files are invalid, or there is no display or no graphics adapter.
#[cfg(feature = "view")]
pub fn run(args: &Args) -> Result<(), AppError> {
    cockpit::run(args)
}

/// Checks the name of a quality preset.
///
/// # Errors
/// If there is no preset with this name.
#[cfg(feature = "view")]
pub fn check_quality(name: &str) -> Result<(), AppError> {
    cockpit::window_config::quality(name).map(|_| ())
}

/// Reports that the program was built without the view.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &Args) -> Result<(), AppError> {
    Err(AppError::failed("this program was built without the view: build it with `cargo build --release --features view`"))
}
