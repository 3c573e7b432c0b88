//! Photos in the format that cameras write: JPEG with EXIF and XMP metadata (position, time, exposure) for
//! photogrammetry.

mod info;
mod jpeg;
mod tags;
mod xmp;

pub use info::{PhotoError, PhotoInfo};

use super::picture::Picture;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::CameraPose;

/// Returns the direction of a pose's optical axis: heading clockwise from true north (0 to 360) and elevation, in
/// degrees.
#[must_use]
pub fn direction_deg(pose: &CameraPose) -> (f64, f64) {
    let (forward, right): (Vec3<Enu>, Vec3<Enu>) = (pose.forward, pose.right);
    // Uses the image's right axis, which the gimbal keeps level, because a vertical optical axis has no heading.
    let yaw = (math::atan2(right.east(), right.north()).to_degrees() - 90.0).rem_euclid(360.0);
    (yaw, math::asin(forward.up().clamp(-1.0, 1.0)).to_degrees())
}

/// Maximum width of a copy, px: the largest width shown in a report.
const MAX_COPY_WIDTH_PX: u32 = 1280;
/// Minimum width of a copy, px; narrower copies would not show defects.
const MIN_COPY_WIDTH_PX: u32 = 320;

/// Encodes the photo without visible loss, regardless of size.
///
/// # Errors
/// Returns an error if the photo exceeds the limits of JPEG or EXIF.
pub fn jpeg(picture: &Picture, about: &PhotoInfo) -> Result<Vec<u8>, PhotoError> {
    let size = (picture.width, picture.height);
    jpeg::encode(picture, Some((&tags::write(about, size)?, &xmp::write(about, size))), usize::MAX)
}

/// Encodes a copy without metadata for a report, at the largest width and highest quality that `most` bytes allow.
/// Exceeds the limit only if even the narrowest copy at the lowest quality does.
///
/// # Errors
/// Returns an error if the picture exceeds the limits of JPEG.
pub fn copy(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    let mut small = picture.scaled_to_width(MAX_COPY_WIDTH_PX);
    loop {
        let file = plain(&small, most)?;
        if file.len() <= most || small.width / 2 < MIN_COPY_WIDTH_PX {
            return Ok(file);
        }
        small = small.scaled_to_width(small.width / 2);
    }
}

/// Encodes a picture without metadata at the highest quality that `most` bytes allow. Exceeds the limit only if even
/// the lowest quality does.
///
/// # Errors
/// Returns an error if the picture exceeds the limits of JPEG.
pub fn plain(picture: &Picture, most: usize) -> Result<Vec<u8>, PhotoError> {
    jpeg::encode(picture, None, most)
}

#[cfg(test)]
mod tests;
