//! Encodes and decodes PNG files.

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

/// Reads an image from a PNG file without transparency. Returns `None` if there is no such file or it cannot be decoded.
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "only the window shows picture files"))]
pub fn read_picture(path: &str) -> Option<Picture> {
    let read = || -> Result<Picture, png::DecodingError> {
        let mut reader = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path)?)).read_info()?;
        let mut rgb = vec![0; reader.output_buffer_size().unwrap_or_default()];
        let frame = reader.next_frame(&mut rgb)?;
        let rgba = rgb[..frame.buffer_size()].chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], u8::MAX]).collect();
        Ok(Picture { width: frame.width, height: frame.height, rgba })
    };
    let picture = read().inspect_err(|error| tracing::warn!("{path}: {error}")).ok()?;
    // Other color types have another number of bytes per pixel.
    (picture.rgba.len() == 4 * picture.width as usize * picture.height as usize).then_some(picture)
}
