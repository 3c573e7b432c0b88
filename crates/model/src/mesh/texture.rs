//! Pictures on the surfaces of models, of which the colors at the vertices are used.

use super::vertex_colors::{Color, of_srgb};
use image::{ImageReader, Limits, RgbImage};
use std::io::Cursor;

/// Maximum width and height of a picture, pixels (estimate: the usual textures of photogrammetry programs have up to 8192).
const MAX_SIDE_PX: u32 = 8_192;
/// Maximum memory for decoding a picture, bytes: four per pixel.
const MAX_BYTES: u64 = 256 * 1024 * 1024;

/// A picture that repeats in both directions.
#[derive(Debug)]
pub(super) struct Texture(RgbImage);

impl Texture {
    /// Decodes a PNG or JPEG picture; `None` for anything else.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok()?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height, limits.max_alloc) =
            (Some(MAX_SIDE_PX), Some(MAX_SIDE_PX), Some(MAX_BYTES));
        reader.limits(limits);
        let picture = reader.decode().ok()?.into_rgb8();
        (picture.width() > 0 && picture.height() > 0).then_some(Self(picture))
    }

    /// Returns the color at a place: shares of the width from the left and of the height from the top.
    pub(super) fn at(&self, place: [f64; 2]) -> Color {
        let [x, y] = [(place[0], self.0.width()), (place[1], self.0.height())].map(|(share, size)| {
            let repeated = if share.is_finite() { share.rem_euclid(1.0) } else { 0.0 };
            ((repeated * f64::from(size)) as u32).min(size - 1)
        });
        of_srgb(self.0.get_pixel(x, y).0.map(|value| f64::from(value) / 255.0))
    }
}
