//! Photo metadata, and errors that occur when a photo is written.

use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::vehicle::Camera;

/// Errors that occur when a photo is written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PhotoError {
    /// The photo exceeds the limits of JPEG or EXIF.
    #[error("cannot encode the picture as JPEG: {0}")]
    Refused(String),
}

/// Photo metadata.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoInfo {
    /// Sequence number, from 1.
    pub number: u32,
    /// Wall time of the shutter release, µs since the Unix epoch.
    pub taken_unix_us: u64,
    /// UTC date (2026:06:20) and time (08:15:30) in EXIF format.
    pub taken_utc: (String, String),
    /// Simulation time, s.
    pub at_s: f64,
    /// Position of the lens.
    pub place: Geo,
    /// Height above the takeoff pad, m.
    pub height_over_pad_m: f64,
    /// Heading of the optical axis, degrees clockwise from true north, 0 to 360.
    pub yaw_deg: f64,
    /// Pitch of the optical axis above the horizon, degrees, down negative.
    pub pitch_deg: f64,
    /// Heading, pitch, and roll of the aircraft, degrees.
    pub aircraft_attitude_deg: [f64; 3],
    /// Lens at its current zoom.
    pub lens: Camera,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// ISO sensitivity.
    pub iso: f64,
    /// Whether the lamp was on.
    pub lamp: bool,
    /// Distance to the surface at the center of the picture, m; `None` if no surface is within range.
    pub distance_m: Option<f64>,
    /// Model of the aircraft.
    pub model: String,
    /// Name of the job.
    pub job: String,
}

impl PhotoInfo {
    /// Returns the ground sampling distance at the center of a picture with the given width, in mm/px.
    #[must_use]
    pub fn gsd_mm(&self, width_px: u32) -> Option<f64> {
        let wide = 2.0 * math::tan(0.5 * self.lens.hfov_rad);
        self.distance_m.map(|distance| 1000.0 * distance * wide / f64::from(width_px.max(1)))
    }
}
