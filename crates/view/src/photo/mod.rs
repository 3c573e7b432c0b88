//! Photos as cameras write them: JPEG with EXIF and XMP metadata of position, time and exposure, for photogrammetry.

mod info;
mod jpeg;
mod tags;
mod xmp;

pub use info::{PhotoError, PhotoInfo};

use super::picture::Picture;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::CameraPose;

/// Direction of a pose's optical axis: heading clockwise from true north (0 to 360) and elevation, degrees.
#[must_use]
pub fn direction_deg(pose: &CameraPose) -> (f64, f64) {
    let (forward, right): (Vec3<Enu>, Vec3<Enu>) = (pose.forward, pose.right);
    // Uses the image's right axis, which the gimbal keeps level: a vertical optical axis has no heading of its own.
    let yaw = (math::atan2(right.east(), right.north()).to_degrees() - 90.0).rem_euclid(360.0);
    (yaw, math::asin(forward.up().clamp(-1.0, 1.0)).to_degrees())
}

/// Maximum width of a copy, px: the largest that a report shows.
const COPY_WIDEST_PX: u32 = 1280;
/// Minimum width of a copy, px: narrower ones would not show any defect.
const COPY_NARROWEST_PX: u32 = 320;

/// Encodes the photo without visible loss, regardless of size.
///
/// # Errors
/// If it exceeds the limits of JPEG or EXIF.
pub fn jpeg(picture: &Picture, about: &PhotoInfo) -> Result<Vec<u8>, PhotoError> {
    let size = (picture.width, picture.height);
    jpeg::encode(picture, Some((&tags::write(about, size)?, &xmp::write(about, size))), usize::MAX)
}

/// Encodes a copy without metadata for a report, as wide and as good as fits into `most` bytes. Exceeds the limit only if even
/// the narrowest copy at the lowest quality does.
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

/// Encodes a picture without metadata at the best quality that fits into `most` bytes. Exceeds the limit only if even the lowest
/// quality does.
///
/// # Errors
/// If it exceeds the limits of JPEG.
pub fn plain(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    jpeg::encode(picture, None, most)
}

#[cfg(test)]
mod tests;
