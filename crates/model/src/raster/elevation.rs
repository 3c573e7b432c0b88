//! Heights of the ground from a digital elevation model in a GeoTIFF file.

use super::geotiff::{GeoKey, GeoTiff, RasterPlace};
use crate::frames::Vec3;
use crate::geodesy::{Geo, LocalPlane};
use crate::math;
use tiff::ColorType;
use tiff::decoder::DecodingResult;

/// Heights above mean sea level that exist on the earth's land, m. Other values mark missing heights, whatever the file says.
const LAND_HEIGHTS_M: (f64, f64) = (-500.0, 9_000.0);
/// Units of heights (EPSG 9001, 9002, 9003), m: meter, international foot, U.S. survey foot.
const HEIGHT_UNITS: [(u16, f64); 3] = [(9001, 1.0), (9002, 0.3048), (9003, 1_200.0 / 3_937.0)];
/// Rounding of heights, m. It hides differences between the mathematical functions of machines, so that all build the same ground.
const ROUNDING_M: f64 = 1e-3;

/// A digital elevation model.
pub struct Elevation {
    place: RasterPlace,
    size: [usize; 2],
    /// Heights above mean sea level, m, with rows from north to south. NaN where the file has none.
    heights_m: Vec<f32>,
}

/// A square grid of places around the origin of a site.
#[derive(Debug, Clone, Copy)]
pub struct SiteGrid {
    /// Number of places per side.
    pub side: usize,
    /// Distance between places, m.
    pub spacing_m: f64,
}

impl SiteGrid {
    /// Returns the coordinate of a row or column, m.
    fn at(self, k: usize) -> f64 {
        self.spacing_m * (k as f64 - 0.5 * (self.side - 1) as f64)
    }
}

impl Elevation {
    /// Reads an elevation model: one value per pixel, of any number type.
    ///
    /// # Errors
    /// Returns what is wrong, and what is allowed.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut file = GeoTiff::open(bytes)?;
        if !matches!(file.color, ColorType::Gray(_)) {
            return Err(format!("pixels of type {:?} (allowed: one height per pixel)", file.color));
        }
        let unit_m = match file.key(GeoKey::VerticalUnit) {
            None => 1.0,
            Some(code) => HEIGHT_UNITS
                .into_iter()
                .find_map(|(unit, size_m)| (unit == code).then_some(size_m))
                .ok_or_else(|| format!("heights in the unit {code} (allowed: 9001 meter, 9002 foot, 9003 U.S. survey foot)"))?,
        };
        let no_data = file.no_data();
        let height = |value: f64| {
            let height_m = value * unit_m;
            // Files with 32-bit floats round the value that the text states.
            let is_missing = no_data.is_some_and(|none| value == none || value as f32 == none as f32);
            let is_height = !is_missing && (LAND_HEIGHTS_M.0..=LAND_HEIGHTS_M.1).contains(&height_m);
            if is_height { height_m as f32 } else { f32::NAN }
        };
        let heights_m: Vec<f32> = values(file.pixels()?)?.into_iter().map(height).collect();
        if heights_m.len() != file.size[0] * file.size[1] {
            return Err(format!("{} heights for {} x {} pixels", heights_m.len(), file.size[0], file.size[1]));
        }
        Ok(Self { place: file.place, size: file.size, heights_m })
    }

    /// Returns the height above mean sea level at a position, m, interpolated between the four nearest pixels; `None` where the model has no
    /// height.
    ///
    /// # Errors
    /// Returns a message if the model's coordinate system does not contain the position.
    pub fn height_m(&self, geo: Geo) -> Result<Option<f64>, String> {
        let [x, y] = self.place.pixel(geo)?;
        let [(column, across), (row, down)] = [(x, self.size[0]), (y, self.size[1])].map(|(at, size)| cell(at, size));
        if across.is_nan() || down.is_nan() {
            return Ok(None);
        }
        let at = |row: usize, column: usize| f64::from(self.heights_m[row * self.size[0] + column]);
        let pair = |row: usize| mix(at(row, column), at(row, column + 1), across);
        Ok(Some(mix(pair(row), pair(row + 1), down)).filter(|height| height.is_finite()))
    }

    /// Returns the heights above the origin at the places of a grid, m: rows from south to north, columns from west to east.
    ///
    /// # Errors
    /// Returns the first place without a height.
    pub fn heights_on_grid(&self, plane: &LocalPlane, grid: SiteGrid) -> Result<Vec<Vec<f64>>, String> {
        let row = |k: usize| (0..grid.side).map(|column| self.up_m(plane, grid.at(column), grid.at(k))).collect();
        (0..grid.side).map(row).collect()
    }

    /// Returns the height above the origin at a place, m.
    fn up_m(&self, plane: &LocalPlane, east_m: f64, north_m: f64) -> Result<f64, String> {
        let geo = plane.geo_from_enu(Vec3::new(east_m, north_m, 0.0));
        let altitude_m = self.height_m(geo)?.ok_or_else(|| {
            format!(
                "no height {east_m:.0} m east and {north_m:.0} m north of the origin ({:.6}, {:.6})",
                geo.latitude_deg, geo.longitude_deg
            )
        })?;
        let up_m = plane.enu_from_geo(Geo { altitude_m, ..geo }).up();
        Ok((up_m / ROUNDING_M).round() * ROUNDING_M)
    }
}

/// Returns the first of two neighboring pixels, and the share of the way to the second one; NaN outside the raster. Each pixel reaches half
/// a pixel beyond its center.
fn cell(at: f64, size: usize) -> (usize, f64) {
    let last = (size - 1) as f64;
    if !(-0.5..=last + 0.5).contains(&at) {
        return (0, f64::NAN);
    }
    let first = at.clamp(0.0, last).floor().min(last - 1.0);
    (first as usize, at.clamp(0.0, last) - first)
}

/// Interpolates, without the influence of a missing value whose share is 0.
fn mix(a: f64, b: f64, share: f64) -> f64 {
    if share == 0.0 {
        a
    } else if share == 1.0 {
        b
    } else {
        math::lerp(a, b, share)
    }
}

fn values(pixels: DecodingResult) -> Result<Vec<f64>, String> {
    fn wide<T: Into<f64>>(values: Vec<T>) -> Vec<f64> {
        values.into_iter().map(Into::into).collect()
    }
    Ok(match pixels {
        DecodingResult::U8(values) => wide(values),
        DecodingResult::I8(values) => wide(values),
        DecodingResult::U16(values) => wide(values),
        DecodingResult::I16(values) => wide(values),
        DecodingResult::U32(values) => wide(values),
        DecodingResult::I32(values) => wide(values),
        DecodingResult::F32(values) => wide(values),
        DecodingResult::F64(values) => values,
        DecodingResult::F16(values) => values.into_iter().map(f64::from).collect(),
        DecodingResult::U64(_) | DecodingResult::I64(_) => {
            return Err("64-bit integers (allowed: floats, or integers of 8 to 32 bits)".into());
        }
    })
}
