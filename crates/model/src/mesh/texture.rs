//! Pictures on the surfaces of models, of which the colors at the vertices are used.

use super::vertex_colors::{Color, of_srgb};
use image::{ImageReader, Limits, RgbImage};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;

/// Maximum width and height of a picture, pixels (estimate: the usual textures of photogrammetry programs have up to 8192).
const MAX_SIDE_PX: u32 = 8_192;
/// Maximum memory for decoding a picture, bytes: four per pixel.
const MAX_BYTES: u64 = 256 * 1024 * 1024;
/// Maximum number of a model's pictures that are used, and of their pixels (estimate: 64 pictures of 2048 pixels; 0.8 GB).
const MAX_PICTURES: usize = 64;
const MAX_PIXELS: u64 = 256 * 1024 * 1024;

/// The pictures of a model by their keys in its file, each read once.
#[derive(Debug)]
pub(super) struct Pictures<Key> {
    read: BTreeMap<Key, Option<Texture>>,
    pixels: u64,
}

impl<Key: Ord> Pictures<Key> {
    pub(super) fn new() -> Self {
        Self { read: BTreeMap::new(), pixels: 0 }
    }

    /// Reads a picture, unless it was read before. One that cannot be read, or is too large beside the others, is missing.
    pub(super) fn read<'a>(&mut self, key: Key, load: impl FnOnce() -> Option<Cow<'a, [u8]>>) {
        if self.read.contains_key(&key) || self.read.len() >= MAX_PICTURES {
            return;
        }
        let picture = load().and_then(|bytes| Texture::read(&bytes, MAX_PIXELS - self.pixels));
        self.pixels += picture.as_ref().map_or(0, |picture| pixels(picture.0.dimensions()));
        self.read.insert(key, picture);
    }

    /// Returns a picture; `None` if it is missing.
    pub(super) fn get(&self, key: &Key) -> Option<&Texture> {
        self.read.get(key)?.as_ref()
    }
}

fn pixels((width, height): (u32, u32)) -> u64 {
    u64::from(width) * u64::from(height)
}

/// A picture that repeats in both directions.
#[derive(Debug)]
pub(super) struct Texture(RgbImage);

impl Texture {
    /// Decodes a PNG or JPEG picture of at most `max_pixels`; `None` for anything else.
    fn read(bytes: &[u8], max_pixels: u64) -> Option<Self> {
        let reader = || ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok();
        if pixels(reader()?.into_dimensions().ok()?) > max_pixels {
            return None;
        }
        let mut reader = reader()?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        RgbImage::new(width, height).write_to(&mut file, image::ImageFormat::Png).unwrap();
        file.into_inner()
    }

    #[test]
    fn exact_pictures_are_read_once_and_only_up_to_the_limit() {
        let file = png(3, 2);
        assert!(Texture::read(&file, 6).is_some() && Texture::read(&file, 5).is_none() && Texture::read(b"text", 6).is_none());
        let (mut pictures, mut loads) = (Pictures::new(), 0);
        for key in [1, 1, 2] {
            pictures.read(key, || {
                loads += 1;
                (key == 1).then(|| Cow::Borrowed(&file[..]))
            });
        }
        assert_eq!((loads, pictures.pixels), (2, 6));
        assert!(pictures.get(&1).is_some() && pictures.get(&2).is_none() && pictures.get(&3).is_none());
    }
}
