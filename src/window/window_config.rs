//! What is asked of the window on the command line.

use crate::errors::AppError;
use spandrel_view::quality::Quality;
use std::net::IpAddr;
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

/// The preset of a name; `None` for auto.
pub fn quality(name: &str) -> Result<Option<Quality>, AppError> {
    if name == "auto" { Ok(None) } else { crate::cli::render::quality(name).map(Some) }
}
