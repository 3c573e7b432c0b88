//! Window settings from the command line.

use super::window_settings::WindowSettings;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::ViewLayout;
use spandrel_view::path_guide::PathAids;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

/// Window settings from the command line.
#[derive(Debug, Clone)]
pub struct WindowConfig {
    /// Local address to bind.
    pub listen: IpAddr,
    /// Window width and height, px.
    pub size_px: (u32, u32),
    /// Layout at startup.
    pub layout: ViewLayout,
    /// True to fill another display than the primary one, if there is one.
    pub second_screen: bool,
    /// Most of the path that is drawn into the pictures.
    pub path_aids: PathAids,
    /// True if the map may be shown.
    pub map: bool,
    /// Screenshot to save before exiting, if any.
    pub picture: Option<CaptureRequest>,
    /// File to save the camera's view to.
    pub camera_file: Option<PathBuf>,
    /// True to print a line on standard output after both views have been rendered.
    pub announce: bool,
}

/// A screenshot of the window.
#[derive(Debug, Clone)]
pub struct CaptureRequest {
    /// PNG file for the screenshot.
    pub path: PathBuf,
    /// Delay after the first rendered frame.
    pub after: Duration,
}

/// The window's startup configuration.
#[derive(Debug)]
pub struct WindowSetup {
    /// Settings for the window itself.
    pub config: WindowConfig,
    /// The job to show.
    pub scenario: Scenario,
    /// The aircraft to show.
    pub vehicle: Vehicle,
    /// Seed to use until the vehicle reports one.
    pub seed: Option<u64>,
    /// Settings of the user and of the command line.
    pub settings: WindowSettings,
    /// Payload port of the vehicle to watch.
    pub connect: SocketAddr,
    /// Ground station port of the vehicle to fly.
    pub fly: Option<SocketAddr>,
    /// Controller ID or part of the controller name; `None` for the only connected controller.
    pub device: Option<String>,
    /// Folder for calibration profiles; `None` for the user's default folder.
    pub profiles: Option<PathBuf>,
    /// Address to stream the camera's view to, as H.264 over RTP.
    pub stream: Option<SocketAddr>,
    /// True if a parent process sends pages and flights over standard input.
    pub led: bool,
    /// True if the window closes when standard input closes.
    pub leash: bool,
}
