//! Summary of the camera's state for messages.

use super::capture_mode::CaptureMode;
use super::stream::VideoStream;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;

/// Summary of the camera's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSummary {
    /// Whether the camera sends heartbeats as a separate component.
    pub announced: bool,
    /// Number of images in the image log.
    pub pictures: usize,
    /// Interval of the time-lapse series in progress, s.
    pub interval_s: Option<f64>,
    /// Whether a distance-triggered series is in progress.
    pub series: bool,
    /// Capture mode.
    pub mode: CaptureMode,
    /// Duration of the recording in progress.
    pub recording: Option<SimTime>,
    /// Used storage, MiB.
    pub used_mib: f64,
    /// Zoom position, from 0 (wide) to 1 (tele).
    pub zoom: f64,
    /// Video bit rate, Mbit/s.
    pub video_bit_rate_mbit_s: u32,
    /// The active video stream.
    pub stream: Option<VideoStream>,
}

impl CameraSummary {
    /// Returns the camera at its current focal length.
    #[must_use]
    pub fn lens(&self, camera: &Camera) -> Camera {
        camera.zoomed(1.0 + self.zoom * (camera.zoom_max - 1.0))
    }
}
