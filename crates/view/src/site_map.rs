//! Map tiles of a job's site, for the map of a ground station: the view from straight above, with the tasks' paths and the
//! landing pad. The tiles have the addresses of web maps (Web Mercator, z/x/y from the north-west).

use crate::ground_photo::GroundColors;
use crate::picture::Picture;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;

/// Width and height of a tile, px.
pub const TILE_PX: u32 = 256;
/// Largest zoom level: 1 px is then about 2 cm.
pub const MAX_ZOOM: u8 = 22;
/// Height above the origin from which the site is seen, m; above every structure.
const EYE_UP_M: f64 = 2_000.0;
/// Length of the rays, m: also reaches the bottom of the deepest valley.
const RAY_LENGTH_M: f64 = 4_000.0;
/// Direction from which the light comes, as on most maps: from the north-west, 45 degrees above the horizon.
const LIGHT: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
/// Share of the light that reaches a surface facing away.
const AMBIENT: f64 = 0.45;
/// Half the line width of a path, and the radius of the mark at its start, px.
const LINE_RADIUS_PX: f64 = 1.6;
const MARK_RADIUS_PX: f64 = 8.5;
/// Half the side of the landing pad's mark, px.
const PAD_PX: f64 = 6.0;
const OUTSIDE_COLOR: [u8; 3] = [222, 224, 218];
const PATH_COLOR: [u8; 3] = [120, 40, 190];
const WHITE: [u8; 3] = [255, 255, 255];
const BLACK: [u8; 3] = [20, 20, 20];

/// Address of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TileAddress {
    zoom: u8,
    column: u32,
    row: u32,
}

impl TileAddress {
    /// Creates an address; `None` if it is out of range.
    #[must_use]
    pub fn new(zoom: u8, column: u32, row: u32) -> Option<Self> {
        let count = 1_u32.checked_shl(u32::from(zoom)).filter(|_| zoom <= MAX_ZOOM)?;
        (column < count && row < count).then_some(Self { zoom, column, row })
    }

    /// Returns the address of the tile that contains a position.
    #[must_use]
    pub fn containing(geo: Geo, zoom: u8) -> Option<Self> {
        let (x, y) = pixel_of(geo, zoom);
        let tile = |px: f64| (px / f64::from(TILE_PX)).floor() as u32;
        Self::new(zoom, tile(x), tile(y))
    }

    /// Returns the position of the center of a pixel.
    fn geo_at(self, x: u32, y: u32) -> Geo {
        let world = world_px(self.zoom);
        let across = (f64::from(self.column) * f64::from(TILE_PX) + f64::from(x) + 0.5) / world;
        let down = (f64::from(self.row) * f64::from(TILE_PX) + f64::from(y) + 0.5) / world;
        let mercator = math::PI * (1.0 - 2.0 * down);
        // The Gudermannian function: the inverse of the Mercator projection.
        let latitude_rad = 2.0 * math::atan2(math::exp(mercator), 1.0) - 0.5 * math::PI;
        Geo { latitude_deg: latitude_rad.to_degrees(), longitude_deg: 360.0 * across - 180.0, altitude_m: 0.0 }
    }

    /// Returns a position in pixels from the tile's north-west corner.
    fn place(self, geo: Geo) -> (f64, f64) {
        let (x, y) = pixel_of(geo, self.zoom);
        (x - f64::from(self.column) * f64::from(TILE_PX), y - f64::from(self.row) * f64::from(TILE_PX))
    }
}

fn world_px(zoom: u8) -> f64 {
    f64::from(TILE_PX) * f64::from(1_u32 << zoom.min(MAX_ZOOM))
}

/// Returns a position in pixels from the north-west corner of the world map.
fn pixel_of(geo: Geo, zoom: u8) -> (f64, f64) {
    let latitude_rad = geo.latitude_deg.to_radians();
    let mercator = math::ln(math::tan(0.25 * math::PI + 0.5 * latitude_rad));
    let world = world_px(zoom);
    ((geo.longitude_deg + 180.0) / 360.0 * world, (1.0 - mercator / math::PI) / 2.0 * world)
}

/// Draws the tiles of one job.
#[derive(Debug)]
pub struct SiteMap<'a> {
    scenario: &'a Scenario,
    site: &'a Site,
    ground: Option<&'a GroundColors>,
}

impl<'a> SiteMap<'a> {
    /// Creates the map of a job. `ground` are the colors of its aerial photograph.
    #[must_use]
    pub fn new(scenario: &'a Scenario, site: &'a Site, ground: Option<&'a GroundColors>) -> Self {
        Self { scenario, site, ground }
    }

    /// Draws a tile. Outside the terrain, it has one color.
    #[must_use]
    pub fn tile(&self, address: TileAddress) -> Picture {
        let mut canvas = Canvas::new((TILE_PX, TILE_PX));
        for y in 0..TILE_PX {
            for x in 0..TILE_PX {
                let here_m =
                    self.site.plane().enu_from_geo(Geo { altitude_m: self.scenario.origin.altitude_m, ..address.geo_at(x, y) });
                canvas.set(x, y, self.color_at(here_m));
            }
        }
        let place = |point_m: Vec3<Enu>| address.place(self.site.plane().geo_from_enu(point_m));
        for task in &self.scenario.tasks {
            let mut points: Vec<(f64, f64)> = task.path_m.iter().map(|point_m| place(*point_m)).collect();
            points.extend(points.first().copied().filter(|_| task.closed));
            canvas.line(&points);
            if let Some(start) = points.first() {
                canvas.disc(*start, MARK_RADIUS_PX, PATH_COLOR);
                canvas.number(*start, task.id);
            }
        }
        canvas.pad(place(self.scenario.ground_team.pad_m));
        canvas.into_picture()
    }

    fn color_at(&self, here_m: Vec3<Enu>) -> [u8; 3] {
        let half_m = 0.5 * self.scenario.terrain.size_m;
        if here_m.east().abs() > half_m || here_m.north().abs() > half_m {
            return OUTSIDE_COLOR;
        }
        let eye_m = Vec3::new(here_m.east(), here_m.north(), EYE_UP_M);
        let down = Vec3::new(0.0, 0.0, -1.0);
        let Some(hit) = self.site.ray(eye_m, down, RAY_LENGTH_M, SimTime::ZERO) else { return OUTSIDE_COLOR };
        let up_m = EYE_UP_M - hit.distance_m;
        let photographed = self.ground.filter(|_| hit.surface == Surface::Terrain).and_then(|ground| ground.at(here_m));
        photographed.unwrap_or_else(|| surface_color(hit.surface, hit.normal, up_m - self.scenario.terrain.water_level_m))
    }
}

/// Returns the color of a surface with this unit normal, at a height above the water in m.
pub(crate) fn surface_color(surface: Surface, normal: Vec3<Enu>, above_water_m: f64) -> [u8; 3] {
    let facing = normal.array().iter().zip(LIGHT).map(|(a, b)| a * b).sum::<f64>().max(0.0);
    let light = AMBIENT + (1.0 - AMBIENT) * facing / LIGHT[2];
    base_color(surface, above_water_m).map(|value| (value * light).clamp(0.0, 255.0) as u8)
}

/// Returns the color of a surface in the light. Traffic and people look like the deck, because they move.
fn base_color(surface: Surface, above_water_m: f64) -> [f64; 3] {
    match surface {
        Surface::Bridge | Surface::Vehicle | Surface::Person => [176.0, 174.0, 170.0],
        Surface::Water => [96.0, 140.0, 168.0],
        Surface::Pad => [230.0, 230.0, 230.0],
        Surface::Other => [150.0, 130.0, 110.0],
        // Meadow near the water, rock far above it.
        Surface::Terrain => {
            let height = (above_water_m / 120.0).clamp(0.0, 1.0);
            let mix = |low: f64, high: f64| low + (high - low) * height;
            [mix(128.0, 170.0), mix(150.0, 160.0), mix(100.0, 140.0)]
        }
    }
}

/// A picture that is being drawn.
pub(crate) struct Canvas {
    picture: Picture,
}

/// Digits 0 to 9, three columns and five rows each, one bit per pixel from the upper left.
const DIGITS: [u16; 10] = [
    0b111_101_101_101_111,
    0b010_110_010_010_111,
    0b111_001_111_100_111,
    0b111_001_111_001_111,
    0b101_101_111_001_001,
    0b111_100_111_001_111,
    0b111_100_111_101_111,
    0b111_001_010_010_010,
    0b111_101_111_101_111,
    0b111_101_111_001_111,
];
/// Size of a digit's pixel, px.
const DIGIT_SCALE: i32 = 2;

impl Canvas {
    /// Creates a white picture of this width and height, px.
    pub(crate) fn new((width, height): (u32, u32)) -> Self {
        Self { picture: Picture { width, height, rgba: vec![255; 4 * width as usize * height as usize] } }
    }

    /// Returns the finished picture.
    pub(crate) fn into_picture(self) -> Picture {
        self.picture
    }

    /// Sets a pixel; outside the picture, does nothing.
    pub(crate) fn set(&mut self, x: u32, y: u32, color: [u8; 3]) {
        let width = self.picture.width;
        let k = 4 * (y as usize * width as usize + x as usize);
        if let Some(pixel) = self.picture.rgba.get_mut(k..k + 3).filter(|_| x < width) {
            pixel.copy_from_slice(&color);
        }
    }

    /// Sets a pixel if it is in the picture.
    fn dot(&mut self, x: i32, y: i32, color: [u8; 3]) {
        if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) {
            self.set(x, y, color);
        }
    }

    fn disc(&mut self, (x, y): (f64, f64), radius: f64, color: [u8; 3]) {
        let far = |value: f64, size: u32| !(-radius..f64::from(size) + radius).contains(&value);
        if far(x, self.picture.width) || far(y, self.picture.height) {
            return;
        }
        let reach = radius.ceil() as i32;
        let (middle_x, middle_y) = (x.floor() as i32, y.floor() as i32);
        for (right, down) in (-reach..=reach).flat_map(|down| (-reach..=reach).map(move |right| (right, down))) {
            let (px, py) = (middle_x + right, middle_y + down);
            let away = math::hypot(f64::from(px) + 0.5 - x, f64::from(py) + 0.5 - y);
            if away <= radius {
                self.dot(px, py, color);
            }
        }
    }

    /// Draws a path.
    pub(crate) fn line(&mut self, points: &[(f64, f64)]) {
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            // Below one step per pixel, the discs still overlap. Long segments far outside the picture are skipped by `disc`.
            let steps = math::hypot(to.0 - from.0, to.1 - from.1).ceil().clamp(1.0, 4_096.0);
            for k in 0..=steps as u32 {
                let share = f64::from(k) / steps;
                let place = (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share);
                self.disc(place, LINE_RADIUS_PX, PATH_COLOR);
            }
        }
    }

    /// Draws a number, centered on a position.
    fn number(&mut self, (x, y): (f64, f64), number: u32) {
        let digits: Vec<usize> = number.to_string().bytes().map(|digit| usize::from(digit - b'0')).collect();
        let width = (4 * digits.len() as i32 - 1) * DIGIT_SCALE;
        let (left, top) = (x.round() as i32 - width / 2, y.round() as i32 - 5 * DIGIT_SCALE / 2);
        for (place, digit) in digits.into_iter().enumerate() {
            for bit in 0..15 {
                if DIGITS[digit] & (1 << (14 - bit)) == 0 {
                    continue;
                }
                let (column, row) = (4 * place as i32 + bit % 3, bit / 3);
                for (right, down) in (0..DIGIT_SCALE).flat_map(|down| (0..DIGIT_SCALE).map(move |right| (right, down))) {
                    self.dot(left + column * DIGIT_SCALE + right, top + row * DIGIT_SCALE + down, WHITE);
                }
            }
        }
    }

    /// Draws the mark of the landing pad: a white square with a black edge.
    pub(crate) fn pad(&mut self, (x, y): (f64, f64)) {
        let reach = PAD_PX as i32;
        for (right, down) in (-reach..=reach).flat_map(|down| (-reach..=reach).map(move |right| (right, down))) {
            let edge = right.abs().max(down.abs()) >= reach - 1;
            self.dot(x.round() as i32 + right, y.round() as i32 + down, if edge { BLACK } else { WHITE });
        }
    }
}

#[cfg(test)]
mod tests;
