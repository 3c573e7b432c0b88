//! JPEG encoding at the highest quality that a size limit allows.

use super::info::PhotoError;
use crate::picture::Picture;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

/// Highest and lowest quality (on libjpeg's scale of up to 100): above the highest, differences are invisible; below
/// the lowest, cracks disappear.
const MAX_QUALITY: u8 = 92;
const MIN_QUALITY: u8 = 20;
/// Identifier of an XMP packet in an APP1 segment (XMP specification, part 3).
const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";

/// EXIF and XMP metadata of a photo.
pub type PhotoTags<'a> = (&'a [u8], &'a str);

/// Encodes the picture at the highest quality that keeps the file within `most` bytes, found by bisection.
pub fn encode(picture: &Picture, tags: Option<PhotoTags<'_>>, most: usize) -> Result<Vec<u8>, PhotoError> {
    let best = encode_with_quality(picture, tags, MAX_QUALITY)?;
    if best.len() <= most {
        return Ok(best);
    }
    let mut fits = encode_with_quality(picture, tags, MIN_QUALITY)?;
    let (mut low, mut high) = (MIN_QUALITY, MAX_QUALITY);
    while fits.len() <= most && high - low > 1 {
        let middle = low + (high - low) / 2;
        let tried = encode_with_quality(picture, tags, middle)?;
        if tried.len() <= most {
            (low, fits) = (middle, tried);
        } else {
            high = middle;
        }
    }
    Ok(fits)
}

fn encode_with_quality(picture: &Picture, tags: Option<PhotoTags<'_>>, quality: u8) -> Result<Vec<u8>, PhotoError> {
    let refused = |error: jpeg_encoder::EncodingError| PhotoError::Refused(error.to_string());
    let side = |px: u32| u16::try_from(px).map_err(|_| PhotoError::Refused(format!("{px} px is too large")));
    let (width, height) = (side(picture.width)?, side(picture.height)?);
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, quality);
    encoder.set_sampling_factor(SamplingFactor::F_2_2);
    encoder.set_optimized_huffman_tables(true);
    if let Some((exif, xmp)) = tags {
        encoder.add_exif_metadata(exif).map_err(refused)?;
        encoder.add_app_segment(1, [XMP, xmp.as_bytes()].concat()).map_err(refused)?;
    }
    encoder.encode(&picture.rgba, width, height, ColorType::Rgba).map_err(refused)?;
    Ok(out)
}
