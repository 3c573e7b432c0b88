//! Settings of the window from the command line.

use crate::errors::AppError;
use spandrel_view::quality::Quality;
use std::net::IpAddr;
use std::path::PathBuf;
use std::time::Duration;

/// Settings of the window from the command line.
#[derive(Debug, Clone)]
pub struct WindowConfig {
    /// Local address to bind.
    pub listen: IpAddr,
    /// Quality preset; `None` to choose by the device.
    pub quality: Option<Quality>,
    /// Size of the window, px: width, height.
    pub size_px: (u32, u32),
    /// True if the map may be shown.
    pub map: bool,
    /// Screenshot to save before exiting, if any.
    pub picture: Option<CaptureRequest>,
    /// File to save the camera's view to.
    pub keep: Option<PathBuf>,
    /// True to report on standard output when both views have been rendered.
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

/// Returns the quality preset with this name; `None` for auto.
pub fn quality(name: &str) -> Result<Option<Quality>, AppError> {
    if name == "auto" { Ok(None) } else { crate::render::quality(name).map(Some) }
}
