//! Encodes PNG files.

use crate::errors::AppError;
use spandrel_view::picture::Picture;

/// Encodes an image as a PNG file.
pub fn png(picture: &Picture) -> Result<Vec<u8>, AppError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let rgb: Vec<u8> = picture.rgba.chunks(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut writer = encoder.write_header().map_err(|error| AppError::failed(error.to_string()))?;
    writer.write_image_data(&rgb).map_err(|error| AppError::failed(error.to_string()))?;
    writer.finish().map_err(|error| AppError::failed(error.to_string()))?;
    Ok(bytes)
}
