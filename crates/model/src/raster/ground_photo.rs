//! An aerial photograph of a site, rectified to a map (orthophoto), from a GeoTIFF file.

use super::geotiff::{GeoTiff, RasterPlace};
use crate::frames::Vec3;
use crate::geodesy::LocalPlane;
use crate::math;
use std::fmt;
use std::sync::Arc;
use tiff::ColorType;
use tiff::decoder::DecodingResult;

/// Number of cells per side between the places at which the photograph's coordinates are computed; they are interpolated between them. On a
/// site of 4 km, a cell is 62 m wide, within which a map projection differs from a linear one by less than 1 mm.
const PLACE_CELLS: usize = 64;
/// Largest number of samples per side of a pixel whose mean is its color.
const MAX_SAMPLES: usize = 4;

/// An aerial photograph of a site. It keeps the bytes of its file, which are decoded again when the picture is needed.
#[derive(Clone, PartialEq, Eq)]
pub struct GroundPhoto {
    /// Name of the file in the scenario's folder or below.
    pub file: String,
    bytes: Arc<[u8]>,
}

/// A square picture of the ground: rows from north to south, pixels of red, green, blue and opacity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroundPicture {
    /// Number of pixels per side.
    pub side_px: usize,
    /// Pixels. An opacity of 0 marks places outside the photograph.
    pub pixels: Vec<[u8; 4]>,
}

impl fmt::Debug for GroundPhoto {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "GroundPhoto({}, {} bytes)", self.file, self.bytes.len())
    }
}

impl GroundPhoto {
    /// Creates the photograph from the bytes of its file.
    ///
    /// # Errors
    /// Returns what is wrong, and what is allowed.
    pub fn new(file: String, bytes: Vec<u8>, plane: &LocalPlane) -> Result<Self, String> {
        let photo = Pixels::read(&bytes)?;
        let [x, y] = photo.place.pixel(plane.origin())?;
        if !photo.contains([x, y]) {
            let [width, height] = photo.size;
            return Err(format!(
                "the origin is at pixel {x:.0}, {y:.0} of {width} x {height} (allowed: a photograph that shows the origin)"
            ));
        }
        Ok(Self { file, bytes: bytes.into() })
    }

    /// Returns a picture of the square with sides of `size_m` around the origin, facing east and north.
    ///
    /// # Errors
    /// Returns a message if the file is damaged.
    pub fn picture(&self, plane: &LocalPlane, size_m: f64, side_px: usize) -> Result<GroundPicture, String> {
        let photo = Pixels::read(&self.bytes)?;
        let places = PlaceGrid::new(&photo.place, plane, size_m)?;
        let step = places.pixels_per_side() / side_px as f64;
        let across = (step.ceil() as usize).clamp(1, MAX_SAMPLES);
        let color = |x: f64, y: f64| {
            let [column, row] = places.pixel(x, y);
            photo.color([column, row])
        };
        let pixel = |k: usize| {
            mean_color(across, |dx, dy| {
                let (column, row) = ((k % side_px) as f64, (k / side_px) as f64);
                color((column + dx) / side_px as f64, 1.0 - (row + dy) / side_px as f64)
            })
        };
        Ok(GroundPicture { side_px, pixels: (0..side_px * side_px).map(pixel).collect() })
    }
}

/// The decoded pixels of a photograph.
struct Pixels {
    place: RasterPlace,
    size: [usize; 2],
    /// Number of samples per pixel: gray, RGB or RGBA.
    samples: usize,
    values: Vec<u8>,
    /// Value of all samples of a pixel without data.
    no_data: Option<u8>,
}

impl Pixels {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut file = GeoTiff::open(bytes)?;
        let samples = samples_per_pixel(file.color)?;
        let no_data = file.no_data().filter(|value| (0.0..=255.0).contains(value)).map(|value| value as u8);
        let DecodingResult::U8(values) = file.pixels()? else {
            return Err("pixels that are not bytes (allowed: 8 bits per color)".into());
        };
        let [width, height] = file.size;
        if values.len() != samples * width * height {
            return Err(format!(
                "{} bytes for {width} x {height} pixels (allowed: the colors of a pixel next to each other)",
                values.len()
            ));
        }
        Ok(Self { place: file.place, size: file.size, samples, values, no_data })
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let inside = |at: f64, size: usize| (-0.5..size as f64 - 0.5).contains(&at);
        inside(x, self.size[0]) && inside(y, self.size[1])
    }

    /// Returns the color at a place, interpolated between the four nearest pixels, with the opacity of the nearest one; `None` outside.
    fn color(&self, [x, y]: [f64; 2]) -> Option<[u8; 4]> {
        if !self.contains([x, y]) {
            return None;
        }
        let [_, _, _, opacity] = self.pixel(x.round(), y.round());
        let (left, top) = (x.floor(), y.floor());
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(right, down)| {
            let share = |at: f64, one: f64| if one > 0.0 { at } else { 1.0 - at };
            let color = self.pixel(left + right, top + down);
            // Invisible pixels have no color.
            (share(x - left, right) * share(y - top, down) * f64::from(color[3]), color)
        });
        let total = corners.iter().map(|(weight, _)| weight).sum::<f64>().max(f64::MIN_POSITIVE);
        let mix =
            |k: usize| (corners.iter().map(|(weight, color)| weight * f64::from(color[k])).sum::<f64>() / total).round() as u8;
        Some([mix(0), mix(1), mix(2), opacity])
    }

    /// Returns a pixel; beyond the edge, the nearest one.
    fn pixel(&self, column: f64, row: f64) -> [u8; 4] {
        let [column, row] =
            [(column, self.size[0]), (row, self.size[1])].map(|(at, size)| at.clamp(0.0, (size - 1) as f64) as usize);
        let at = self.samples * (row * self.size[0] + column);
        let samples = &self.values[at..at + self.samples];
        if self.no_data.is_some_and(|none| samples.iter().all(|sample| *sample == none)) { [0; 4] } else { rgba(samples) }
    }
}

/// The photograph's pixels at the places of a coarse grid on the site.
struct PlaceGrid(Vec<[f64; 2]>);

impl PlaceGrid {
    fn new(place: &RasterPlace, plane: &LocalPlane, size_m: f64) -> Result<Self, String> {
        let at = |k: usize| size_m * (k as f64 / PLACE_CELLS as f64 - 0.5);
        let row = |north: usize| {
            (0..=PLACE_CELLS).map(move |east| place.pixel(plane.geo_from_enu(Vec3::new(at(east), at(north), 0.0))))
        };
        (0..=PLACE_CELLS).flat_map(row).collect::<Result<_, _>>().map(Self)
    }

    /// Returns the photograph's pixel at a place: shares of the site's side from the south-western corner.
    fn pixel(&self, x: f64, y: f64) -> [f64; 2] {
        let cells = PLACE_CELLS as f64;
        let [(column, across), (row, up)] = [x, y].map(|share| {
            let first = (share * cells).floor().clamp(0.0, cells - 1.0);
            (first as usize, share * cells - first)
        });
        let at = |row: usize, column: usize| self.0[row * (PLACE_CELLS + 1) + column];
        let [(south_west, south_east), (north_west, north_east)] =
            [row, row + 1].map(|row| (at(row, column), at(row, column + 1)));
        let mix = |k: usize| {
            math::lerp(math::lerp(south_west[k], south_east[k], across), math::lerp(north_west[k], north_east[k], across), up)
        };
        [mix(0), mix(1)]
    }

    /// Returns the number of the photograph's pixels along the southern side of the site.
    fn pixels_per_side(&self) -> f64 {
        let [west, east] = [self.0[0], self.0[PLACE_CELLS]];
        math::hypot(east[0] - west[0], east[1] - west[1])
    }
}

/// Returns the mean of the visible samples of a pixel; invisible if most of them are.
fn mean_color(across: usize, sample: impl Fn(f64, f64) -> Option<[u8; 4]>) -> [u8; 4] {
    let at = |k: usize| (k as f64 + 0.5) / across as f64;
    let places = (0..across * across).map(|k| (at(k % across), at(k / across)));
    let seen: Vec<[u8; 4]> = places.filter_map(|(dx, dy)| sample(dx, dy)).filter(|color| color[3] >= 128).collect();
    if 2 * seen.len() < across * across {
        return [0; 4];
    }
    let mean = |k: usize| ((seen.iter().map(|color| usize::from(color[k])).sum::<usize>() + seen.len() / 2) / seen.len()) as u8;
    [mean(0), mean(1), mean(2), u8::MAX]
}

fn samples_per_pixel(color: ColorType) -> Result<usize, String> {
    match color {
        ColorType::Gray(8) => Ok(1),
        ColorType::RGB(8) => Ok(3),
        ColorType::RGBA(8) => Ok(4),
        other => Err(format!("pixels of type {other:?} (allowed: gray, RGB or RGBA with 8 bits each)")),
    }
}

fn rgba(samples: &[u8]) -> [u8; 4] {
    match *samples {
        [gray] => [gray, gray, gray, u8::MAX],
        [red, green, blue] => [red, green, blue, u8::MAX],
        [red, green, blue, opacity] => [red, green, blue, opacity],
        _ => [0; 4],
    }
}
