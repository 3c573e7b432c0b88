//! Georeferenced rasters of a real site: heights and an aerial photograph, from GeoTIFF files.

mod coordinate_system;
pub mod elevation;
mod geotiff;
pub mod ground_photo;

/// Largest number of pixels of a raster that is decoded (estimate: a square of 4 km at the finest spacing that a terrain can have, with
/// room around it).
const MAX_PIXELS: usize = 25_000_000;
/// Largest size of a file, bytes (estimate: an uncompressed photograph of that many pixels with three bytes each).
const MAX_FILE_BYTES: usize = 80_000_000;
