//! `spandrel view`: opens a window that shows the inspector's view and the camera's view live, based on telemetry.

use super::args::JobArgs;
#[cfg(feature = "view")]
use super::picture_args::{parse_quality_or_auto, parse_size};
use crate::errors::{AppError, EXIT_CODES};
use crate::io::addresses;
#[cfg(feature = "view")]
use crate::io::user_settings::SettingsFile;
#[cfg(feature = "view")]
use crate::io::{controller, files};
#[cfg(feature = "view")]
use crate::window::{self, CaptureRequest, SettingsOverrides, WindowConfig, WindowSettings, WindowSetup};
use spandrel_view::arrange::ViewLayout;
use spandrel_view::path_guide::PathAids;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

/// Maximum screenshot delay, s.
#[cfg(feature = "view")]
const MAX_SCREENSHOT_DELAY_S: f64 = 3_600.0;

/// Watch a flight live in a window: the inspector's view and the camera's view, with head-up display
///
/// The view uses only the vehicle's telemetry and the scenario, so it also works with a real autopilot and on another
/// computer. Defects and traffic match the seed that the simulator reports, even after it restarts; --seed applies
/// until the first report, or if the vehicle reports no seed. With --fly, the keyboard in the window (and a calibrated
/// controller, if one is connected) flies the vehicle. Tab changes the layout, the mouse turns the inspector's view, the
/// wheel zooms, F follows the aircraft again, M hides the map, C shows it large, and V hides the path. It needs no graphics
/// card: a software Vulkan driver is enough (Debian and Ubuntu: mesa-vulkan-drivers).
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "help and errors are the same with and without the view"))]
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel view                                          watch the simulator on this machine
  spandrel view --fly 127.0.0.1:18570                    fly it with the keyboard: W S A D, arrows, 1 to arm, T to take off
  spandrel view --stream 127.0.0.1:5600                  also show the camera's view in QGroundControl
  spandrel view --listen 0.0.0.0 --connect 192.168.1.20:14280 --quality low
  spandrel view --layout inspector-only --second-screen  show only the inspector's view, on a second screen
  spandrel view --screenshot moment.png --after 10       save a picture of the window after 10 s and exit

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    /// Address of the vehicle's payload port
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address, default_value = "127.0.0.1:14280")]
    connect: SocketAddr,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = addresses::listen)]
    listen: IpAddr,
    /// Fly from the window: send stick input and commands to the vehicle's ground station port
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address, group = "pilot")]
    fly: Option<SocketAddr>,
    /// Key bindings (TOML: format = 1, push, [sticks], [actions], [window], [sound]); the same file as for `spandrel rc
    /// --keyboard` [default: the keys in the window's settings]
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    /// Controller ID or part of the controller name [default: the only connected controller]
    #[arg(long, value_name = "NAME", requires = "pilot")]
    device: Option<String>,
    /// Folder for calibration profiles [default: spandrel/controllers in the user's configuration folder]
    #[arg(long, value_name = "DIR", requires = "pilot")]
    profiles: Option<PathBuf>,
    /// Rendering quality: low, medium, high, ultra, or auto (high with a graphics card, low without) [default: as in the
    /// window's settings]
    #[arg(long, value_name = "PRESET")]
    quality: Option<String>,
    /// Window size in px
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: String,
    /// Disable sound; the [sound] table in the key bindings file configures propellers, warnings, speech and volume
    #[arg(long)]
    no_sound: bool,
    /// Layout of the views; Tab changes it
    #[arg(long, value_name = "LAYOUT", default_value = "camera", value_parser = ViewLayout::ALL.map(|(name, _)| name))]
    layout: String,
    /// Fill another display than the primary one, if there is one
    #[arg(long)]
    second_screen: bool,
    /// Most of the reference paths that is drawn into the pictures; V hides it
    #[arg(long, value_name = "AIDS", default_value = "full", value_parser = PathAids::ALL.map(|(name, _)| name))]
    path: String,
    /// Disable the map of the reference paths, for an assessment; M cannot show it
    #[arg(long)]
    no_map: bool,
    /// Send the camera's view to this address as H.264 over RTP; the vehicle then announces the stream so that ground
    /// stations show it (QGroundControl listens on UDP port 5600). The vehicle always announces port 5600: configure
    /// any other port in the ground station
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address)]
    stream: Option<SocketAddr>,
    /// Save a picture of the window (PNG) and exit
    #[arg(long, value_name = "FILE", requires = "after")]
    screenshot: Option<PathBuf>,
    /// Wall time in s between the first rendered frame and the picture
    #[arg(long, value_name = "S", requires = "screenshot")]
    after: Option<f64>,
    /// Save the camera's view to this file (JPEG) about once a second, for the live page of `spandrel serve --picture
    /// FILE`
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Print one line of JSON {"device", "quality", "width", "height"} on standard output after both views have been
    /// rendered
    #[arg(long)]
    announce: bool,
    /// Exit when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
    /// Receive pages and flights from the parent process as JSON lines on standard input; send the user's actions on
    /// standard output
    #[arg(long, requires = "leash", hide = true, group = "pilot")]
    led: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, or there is no display or no graphics adapter.
#[cfg(feature = "view")]
pub fn run(args: &Args) -> Result<(), AppError> {
    let scenario = args.job.load_scenario()?.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let config = WindowConfig {
        listen: args.listen,
        size_px: parse_size(&args.size)?,
        layout: ViewLayout::ALL
            .into_iter()
            .find(|(name, _)| *name == args.layout)
            .map_or_else(ViewLayout::default, |(_, one)| one),
        second_screen: args.second_screen,
        path_aids: PathAids::ALL.into_iter().find(|(word, _)| *word == args.path).map_or_else(PathAids::default, |(_, one)| one),
        map: !args.no_map,
        picture: picture(args)?,
        camera_file: args.picture.clone(),
        // With --led, standard output belongs to the pipe.
        announce: args.announce && !args.led,
    };
    window::run(WindowSetup {
        config,
        scenario,
        vehicle,
        seed: args.job.seed,
        settings: WindowSettings::load(SettingsFile::of_user(), overrides(args)?),
        connect: args.connect,
        fly: args.fly,
        device: args.device.clone(),
        profiles: args.profiles.clone(),
        stream: args.stream,
        led: args.led,
        leash: args.leash,
    })
}

#[cfg(feature = "view")]
fn overrides(args: &Args) -> Result<SettingsOverrides, AppError> {
    let keys = |path: &PathBuf| Ok::<_, AppError>((path.display().to_string(), controller::keys(Some(path))?));
    let quality = args.quality.as_deref().map(parse_quality_or_auto).transpose()?;
    Ok(SettingsOverrides {
        keys: args.keys.as_ref().map(keys).transpose()?,
        quality: quality.map(|preset| preset.map(|preset| preset.name)),
        no_sound: args.no_sound,
    })
}

#[cfg(feature = "view")]
fn picture(args: &Args) -> Result<Option<CaptureRequest>, AppError> {
    let (Some(path), Some(after)) = (&args.screenshot, args.after) else { return Ok(None) };
    if !(0.0..=MAX_SCREENSHOT_DELAY_S).contains(&after) {
        return Err(AppError::invalid(format!("--after {after}: out of range (allowed: 0 to {MAX_SCREENSHOT_DELAY_S} s)")));
    }
    Ok(Some(CaptureRequest { path: path.clone(), after: std::time::Duration::from_secs_f64(after) }))
}

/// Reports that the program was built without the view.
///
/// # Errors
/// Always returns an error.
#[cfg(not(feature = "view"))]
pub fn run(_: &Args) -> Result<(), AppError> {
    Err(AppError::failed("this program was built without the view: rebuild it with `cargo build --release --features view`"))
}
