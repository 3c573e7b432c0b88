//! Photographs as cameras write them: JPEG with EXIF and XMP that tell where, when and how they were taken, for photogrammetry.

mod jpeg;
mod tags;
mod xmp;

use super::picture::Picture;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Camera;

/// Why a photograph cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PhotoError {
    /// It is larger than JPEG or EXIF can say.
    #[error("the picture cannot be written as JPEG: {0}")]
    Refused(String),
}

/// What a photograph tells of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoInfo {
    /// Running number, from 1.
    pub number: u32,
    /// Wall time of the press, µs since the Unix epoch.
    pub taken_unix_us: u64,
    /// The same for people, UTC: date (2026:06:20) and time (08:15:30) as EXIF writes them.
    pub taken_utc: (String, String),
    /// Simulation time, s.
    pub at_s: f64,
    /// Where the lens was.
    pub place: Geo,
    /// Height over the take-off pad, m.
    pub over_pad_m: f64,
    /// Heading of the optical axis, degrees clockwise from true north, 0 to 360.
    pub yaw_deg: f64,
    /// Pitch of the optical axis over the horizon, degrees, down negative.
    pub pitch_deg: f64,
    /// Heading, pitch and roll of the aircraft, degrees.
    pub aircraft_deg: [f64; 3],
    /// The lens as it was zoomed.
    pub lens: Camera,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Sensitivity, ISO.
    pub iso: f64,
    /// The lamp was on.
    pub lamp: bool,
    /// Distance to the surface in the middle of the picture, m; `None` when there is none near.
    pub distance_m: Option<f64>,
    /// What took it.
    pub model: String,
    /// Of which job.
    pub job: String,
}

impl PhotoInfo {
    /// Ground sampling distance in the middle of a picture of this width, mm a pixel.
    #[must_use]
    pub fn gsd_mm(&self, width_px: u32) -> Option<f64> {
        let wide = 2.0 * math::tan(0.5 * self.lens.hfov_rad);
        self.distance_m.map(|distance| 1000.0 * distance * wide / f64::from(width_px.max(1)))
    }
}

/// Direction of a pose's optical axis: degrees clockwise from true north (0 to 360), degrees over the horizon.
#[must_use]
pub fn direction_deg(pose: &CameraPose) -> (f64, f64) {
    let (forward, right): (Vec3<Enu>, Vec3<Enu>) = (pose.forward, pose.right);
    // From the image's right, which the gimbal holds level: straight up and down the axis itself has no heading.
    let yaw = (math::atan2(right.east(), right.north()).to_degrees() - 90.0).rem_euclid(360.0);
    (yaw, math::asin(forward.up().clamp(-1.0, 1.0)).to_degrees())
}

/// Widest copy, px: what a report shows at most.
const COPY_WIDEST_PX: u32 = 1280;
/// Narrowest copy, px: in a narrower one no defect would be seen.
const COPY_NARROWEST_PX: u32 = 320;

/// The photograph as a file, at the quality of which one sees no loss, however large.
///
/// # Errors
/// When JPEG or EXIF cannot say it.
pub fn jpeg(picture: &Picture, about: &PhotoInfo) -> Result<Vec<u8>, PhotoError> {
    let size = (picture.width, picture.height);
    jpeg::encode(picture, Some((&tags::write(about, size)?, &xmp::write(about, size))), usize::MAX)
}

/// A copy for a report that tells nothing of itself, as wide and as good as fits into `most` bytes; larger only where even the narrowest and
/// coarsest is.
///
/// # Errors
/// When JPEG cannot say it.
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

/// A picture that tells nothing of itself, as good as fits into `most` bytes; larger only where even the coarsest JPEG is.
///
/// # Errors
/// When JPEG cannot say it.
pub fn plain(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    jpeg::encode(picture, None, most)
}

#[cfg(test)]
mod tests;
