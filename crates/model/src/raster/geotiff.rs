//! Reads GeoTIFF files: the pixels, and where they lie (OGC GeoTIFF Standard 1.1). Reads the first image of a file; overviews and masks
//! behind it have no effect.

use super::coordinate_system::CoordinateSystem;
use super::{MAX_FILE_BYTES, MAX_PIXELS};
use crate::geodesy::Geo;
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// Kind of coordinate system (key 1024) with latitudes and longitudes; 1 is a projected one.
const GEOGRAPHIC_MODEL: u16 = 2;
const PROJECTED_MODEL: u16 = 1;
/// Raster type (key 1025) whose positions are those of the pixels' centers instead of their north-western corners.
const PIXEL_IS_POINT: u16 = 2;
/// Value of a key for a coordinate system that is described in the file instead of by a code.
const USER_DEFINED: u16 = 32_767;
/// Number of values of a key, and of the header, in the directory of keys.
const KEY_VALUES: usize = 4;

/// Keys of the directory (GeoTIFF 1.1, annex B).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GeoKey {
    Model = 1024,
    RasterType = 1025,
    GeographicSystem = 2048,
    ProjectedSystem = 3072,
    VerticalUnit = 4099,
}

/// An open GeoTIFF file.
pub(super) struct GeoTiff<'a> {
    decoder: Decoder<Cursor<&'a [u8]>>,
    keys: Vec<u16>,
    /// Number of pixels from west to east and from north to south.
    pub(super) size: [usize; 2],
    /// Color of the pixels.
    pub(super) color: ColorType,
    /// Where the pixels lie.
    pub(super) place: RasterPlace,
}

/// The place of a raster: converts positions to pixels.
pub(super) struct RasterPlace {
    system: CoordinateSystem,
    /// Coordinates of the center of the first pixel.
    first: [f64; 2],
    /// Rows of the inverse of the matrix whose columns are the steps from one pixel to the next in a row and in a column.
    inverse: [[f64; 2]; 2],
}

impl<'a> GeoTiff<'a> {
    /// Opens a file and finds its place on the earth. Does not decode the pixels.
    ///
    /// # Errors
    /// Returns what is wrong, and what is allowed.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, String> {
        if bytes.len() > MAX_FILE_BYTES {
            return Err(format!("{} bytes (allowed: at most {MAX_FILE_BYTES})", bytes.len()));
        }
        let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(|error| not_a_tiff(&error))?;
        let (width, height) = decoder.dimensions().map_err(|error| not_a_tiff(&error))?;
        let size = [width as usize, height as usize];
        if size[0].saturating_mul(size[1]) > MAX_PIXELS {
            return Err(format!("{width} x {height} pixels (allowed: at most {MAX_PIXELS} pixels)"));
        }
        if size[0] < 2 || size[1] < 2 {
            return Err(format!("{width} x {height} pixels (allowed: at least 2 x 2)"));
        }
        let color = decoder.colortype().map_err(|error| not_a_tiff(&error))?;
        let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag);
        let keys = keys.map_err(|_| "no GeoTIFF keys (allowed: a TIFF file with a coordinate system)".to_owned())?;
        let place = RasterPlace::new(&mut decoder, &keys)?;
        Ok(Self { decoder, keys, size, color, place })
    }

    /// Returns the value of a key.
    pub(super) fn key(&self, key: GeoKey) -> Option<u16> {
        key_value(&self.keys, key)
    }

    /// Returns the value that marks pixels without data.
    pub(super) fn no_data(&mut self) -> Option<f64> {
        let text = self.decoder.get_tag_ascii_string(Tag::GdalNodata).ok()?;
        text.trim_matches(|c: char| c.is_whitespace() || c == '\0').parse().ok()
    }

    /// Decodes the pixels: rows from north to south, with the samples of each pixel next to each other.
    ///
    /// # Errors
    /// Returns a message if the file is damaged or has a form that is not supported.
    pub(super) fn pixels(&mut self) -> Result<DecodingResult, String> {
        self.decoder.read_image().map_err(|error| format!("pixels: {error}"))
    }
}

impl RasterPlace {
    fn new(decoder: &mut Decoder<Cursor<&[u8]>>, keys: &[u16]) -> Result<Self, String> {
        let system_key = match key_value(keys, GeoKey::Model) {
            Some(GEOGRAPHIC_MODEL) => GeoKey::GeographicSystem,
            Some(PROJECTED_MODEL) => GeoKey::ProjectedSystem,
            other => return Err(format!("kind of coordinate system {other:?} (allowed: 1 projected, 2 geographic)")),
        };
        let code = key_value(keys, system_key).filter(|code| *code != USER_DEFINED && *code != 0);
        let code = code.ok_or("a coordinate system without an EPSG code (allowed: one with a code, for example EPSG:32632)")?;
        let system = CoordinateSystem::from_epsg(code)?;
        let ([a, b, x], [c, d, y]) = raster_to_map(decoder)?;
        let determinant = a * d - b * c;
        if ![a, b, c, d, x, y].iter().all(|value| value.is_finite()) || determinant == 0.0 {
            return Err("a place without an area (allowed: pixels with a width and a height)".into());
        }
        let inverse = [[d / determinant, -b / determinant], [-c / determinant, a / determinant]];
        let center = if key_value(keys, GeoKey::RasterType) == Some(PIXEL_IS_POINT) { 0.0 } else { 0.5 };
        let first = [x + center * (a + b), y + center * (c + d)];
        Ok(Self { system, first, inverse })
    }

    /// Returns the column and row of a position, counted from the center of the north-western pixel.
    ///
    /// # Errors
    /// Returns a message if the coordinate system does not contain the position.
    pub(super) fn pixel(&self, geo: Geo) -> Result<[f64; 2], String> {
        let [x, y] = self.system.coordinates(geo)?;
        let (dx, dy) = (x - self.first[0], y - self.first[1]);
        Ok(self.inverse.map(|row| row[0] * dx + row[1] * dy))
    }
}

/// Returns the two rows of the matrix that converts columns and rows of pixels to map coordinates.
fn raster_to_map(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<([f64; 3], [f64; 3]), String> {
    if let Ok(m) = decoder.get_tag_f64_vec(Tag::ModelTransformationTag)
        && m.len() >= 8
    {
        return Ok(([m[0], m[1], m[3]], [m[4], m[5], m[7]]));
    }
    let scale = decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).ok().filter(|scale| scale.len() >= 2);
    let tie = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).ok().filter(|tie| tie.len() >= 6);
    let (Some(scale), Some(tie)) = (scale, tie) else {
        return Err("no place on the earth (allowed: a tie point with a pixel scale, or a transformation)".into());
    };
    let (x, y) = (tie[3] - scale[0] * tie[0], tie[4] + scale[1] * tie[1]);
    Ok(([scale[0], 0.0, x], [0.0, -scale[1], y]))
}

/// Returns the value of a key that is stored in the directory itself.
fn key_value(keys: &[u16], key: GeoKey) -> Option<u16> {
    let entry = keys.chunks_exact(KEY_VALUES).skip(1).find(|entry| entry[0] == key as u16)?;
    (entry[1] == 0).then_some(entry[3])
}

fn not_a_tiff(error: &TiffError) -> String {
    format!("not a TIFF file: {error}")
}
