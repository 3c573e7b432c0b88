//! What is asked of the window on the command line.

use spandrel_clients::rc::keyboard::KeyBindings;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::quality::Quality;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

/// What is asked for on the command line.
#[derive(Debug, Clone)]
pub struct WindowConfig {
    /// Local address to bind.
    pub listen: IpAddr,
    /// A preset; `None`: by the device.
    pub quality: Option<Quality>,
    /// Size of the window.
    pub size_px: (u32, u32),
    /// The map may be shown.
    pub map: bool,
    /// A picture to keep.
    pub picture: Option<CaptureRequest>,
    /// Where the camera's view is kept for others.
    pub keep: Option<PathBuf>,
    /// Say on standard output when both views are drawn.
    pub announce: bool,
}

/// A picture of the window.
#[derive(Debug, Clone)]
pub struct CaptureRequest {
    /// Where it goes.
    pub path: PathBuf,
    /// When, from the first drawn view.
    pub after: Duration,
}

/// Everything that the window starts with.
#[derive(Debug)]
pub struct WindowSetup {
    /// The window itself.
    pub config: WindowConfig,
    /// The job to show.
    pub scenario: Scenario,
    /// The aircraft to show.
    pub vehicle: Vehicle,
    /// Seed until the vehicle reports one.
    pub seed: Option<u64>,
    /// Key bindings.
    pub keys: KeyBindings,
    /// Payload port of the vehicle to watch.
    pub connect: SocketAddr,
    /// Ground station port of the vehicle to fly.
    pub fly: Option<SocketAddr>,
    /// Controller, by its ID or part of its name; `None` for the only one.
    pub device: Option<String>,
    /// Folder of calibration profiles; `None` for the user's.
    pub profiles: Option<PathBuf>,
    /// Destination of the camera's view as H.264 over RTP.
    pub stream: Option<SocketAddr>,
    /// Sound is on.
    pub sound: bool,
    /// Pages and flights come from a parent process over standard input.
    pub led: bool,
    /// The window closes when standard input closes.
    pub leash: bool,
}
