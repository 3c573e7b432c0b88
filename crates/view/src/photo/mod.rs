//! Photos as cameras write them: JPEG with EXIF and XMP metadata of position, time and exposure, for photogrammetry.

mod jpeg;
mod tags;
mod xmp;

use super::picture::Picture;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Camera;

/// Errors of writing a photo.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PhotoError {
    /// The photo exceeds the limits of JPEG or EXIF.
    #[error("the picture cannot be written as JPEG: {0}")]
    Refused(String),
}

/// Metadata of a photo.
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
    pub over_pad_m: f64,
    /// Heading of the optical axis, degrees clockwise from true north, 0 to 360.
    pub yaw_deg: f64,
    /// Pitch of the optical axis above the horizon, degrees, down negative.
    pub pitch_deg: f64,
    /// Heading, pitch and roll of the aircraft, degrees.
    pub aircraft_deg: [f64; 3],
    /// Lens at its current zoom.
    pub lens: Camera,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Sensitivity, ISO.
    pub iso: f64,
    /// Whether the lamp was on.
    pub lamp: bool,
    /// Distance to the surface at the center of the picture, m; `None` if there is none within range.
    pub distance_m: Option<f64>,
    /// Model of the aircraft.
    pub model: String,
    /// Name of the job.
    pub job: String,
}

impl PhotoInfo {
    /// Returns the ground sampling distance at the center of a picture of this width, mm/px.
    #[must_use]
    pub fn gsd_mm(&self, width_px: u32) -> Option<f64> {
        let wide = 2.0 * math::tan(0.5 * self.lens.hfov_rad);
        self.distance_m.map(|distance| 1000.0 * distance * wide / f64::from(width_px.max(1)))
    }
}

/// Returns the direction of a pose's optical axis: heading clockwise from true north (0 to 360) and elevation, degrees.
#[must_use]
pub fn direction_deg(pose: &CameraPose) -> (f64, f64) {
    let (forward, right): (Vec3<Enu>, Vec3<Enu>) = (pose.forward, pose.right);
    // Uses the image's right axis, which the gimbal keeps level, because a vertical optical axis has no heading.
    let yaw = (math::atan2(right.east(), right.north()).to_degrees() - 90.0).rem_euclid(360.0);
    (yaw, math::asin(forward.up().clamp(-1.0, 1.0)).to_degrees())
}

/// Maximum width of a copy, px: the largest that a report shows.
const COPY_WIDEST_PX: u32 = 1280;
/// Minimum width of a copy, px; narrower copies would not show defects.
const COPY_NARROWEST_PX: u32 = 320;

/// Encodes the photo without visible loss, regardless of size.
///
/// # Errors
/// If it exceeds the limits of JPEG or EXIF.
pub fn jpeg(picture: &Picture, about: &PhotoInfo) -> Result<Vec<u8>, PhotoError> {
    let size = (picture.width, picture.height);
    jpeg::encode(picture, Some((&tags::write(about, size)?, &xmp::write(about, size))), usize::MAX)
}

/// Encodes a copy without metadata for a report, as wide and with as high a quality as `most` bytes allow. Exceeds the
/// limit only if even the narrowest copy at the lowest quality does.
///
/// # Errors
/// If it exceeds the limits of JPEG.
pub fn copy(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    let mut small = picture.narrowed(COPY_WIDEST_PX);
    loop {
        let file = plain(&small, most)?;
        if file.len() <= most || small.width / 2 < COPY_NARROWEST_PX {
            return Ok(file);
        }
        small = small.narrowed(small.width / 2);
    }
}

/// Encodes a picture without metadata at the highest quality that `most` bytes allow. Exceeds the limit only if even
/// the lowest quality does.
///
/// # Errors
/// If it exceeds the limits of JPEG.
pub fn plain(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    jpeg::encode(picture, None, most)
}

#[cfg(test)]
mod tests;
