//! Terrain of a scenario: flat, a valley with a lake, or from a file. Earthworks add bridge approaches, openings under bridges,
//! and level ground around the landing pad.

use super::heights::HeightGrid;
use crate::frames::Vec3;
use crate::math;
use crate::random::RandomStream;
use crate::scenario::{Bridge, GroundTeam, Scenario, TerrainSource, TerrainSpec as Settings};

/// Radius of level ground around the landing pad, m.
const LEVEL_GROUND_RADIUS_M: f64 = 16.0;
/// Earthwork slope, as horizontal distance per unit height.
const EARTHWORK_SLOPE: f64 = 1.2;
/// Downward grade of the roads that lead away from the bridges (estimate: maximum grade on mountain highways).
const ROAD_GRADE: f64 = 0.07;
/// Depth of the excavation below an arch's springings, m.
const EXCAVATION_DEPTH_M: f64 = 1.0;
/// Minimum embedment depth of structures in the ground, m.
const MIN_EMBEDMENT_DEPTH_M: f64 = 0.5;

/// Ground surface and water level.
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    /// Ground surface.
    pub ground: HeightGrid,
    /// Water level above the origin, m.
    pub water_m: f64,
}

impl Terrain {
    /// Creates a scenario's terrain.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let settings = &scenario.terrain;
        let side = (settings.size_m / settings.spacing_m).round().max(1.0) as usize + 1;
        let origin_m = -0.5 * settings.spacing_m * (side - 1) as f64;
        let raw = HeightSource::new(settings);
        let mut heights_m = Vec::with_capacity(side * side);
        for row in 0..side {
            for column in 0..side {
                let east = origin_m + column as f64 * settings.spacing_m;
                let north = origin_m + row as f64 * settings.spacing_m;
                let natural = raw.height_m(row, column, east, north);
                heights_m.push(apply_earthworks(natural, east, north, scenario));
            }
        }
        Self { ground: HeightGrid::new(heights_m, settings.spacing_m), water_m: settings.water_level_m }
    }
}

/// Source of the natural heights, before earthworks.
enum HeightSource<'a> {
    Flat(f64),
    Valley { noise: ValueNoise, settings: &'a Settings, axis: (f64, f64), lake_half_m: f64, mountain_height_m: f64, depth_m: f64 },
    File(&'a [Vec<f64>]),
}

impl<'a> HeightSource<'a> {
    fn new(settings: &'a Settings) -> Self {
        match &settings.source {
            TerrainSource::Flat { height_m } => Self::Flat(*height_m),
            TerrainSource::Valley { seed, lake_width_m, axis_deg, mountain_height_m, lake_depth_m } => Self::Valley {
                noise: ValueNoise::new(*seed),
                settings,
                axis: math::sin_cos(axis_deg.to_radians()),
                lake_half_m: 0.5 * lake_width_m,
                mountain_height_m: *mountain_height_m,
                depth_m: *lake_depth_m,
            },
            TerrainSource::File { heights_m } => Self::File(heights_m),
        }
    }

    fn height_m(&self, row: usize, column: usize, east: f64, north: f64) -> f64 {
        match self {
            Self::Flat(height) => *height,
            Self::File(rows) => {
                let row = &rows[row.min(rows.len() - 1)];
                row[column.min(row.len() - 1)]
            }
            Self::Valley { noise, settings, axis, lake_half_m, mountain_height_m, depth_m } => {
                // Distance from the shore, which is varied by noise.
                let across = east * axis.1 - north * axis.0;
                let waver = 0.1 * lake_half_m * (noise.at(east / 90.0, north / 90.0) - 0.5);
                let d = across.abs() - lake_half_m + waver;
                let rough = noise.at(east / 35.0 + 17.0, north / 35.0 - 5.0);
                let water = settings.water_level_m;
                if d < 0.0 {
                    water - depth_m * (1.0 - math::exp(d / 12.0))
                } else {
                    let climb = 1.0 - math::exp(-d * d / (160.0 * 160.0));
                    water
                        + 5.0 * (1.0 - math::exp(-d / 8.0))
                        + mountain_height_m * climb * (0.55 + 0.45 * rough)
                        + 1.5 * rough * climb
                }
            }
        }
    }
}

/// Returns the height after earthworks: openings under bridges, approaches at their ends, level ground around the landing pad.
fn apply_earthworks(natural: f64, east: f64, north: f64, scenario: &Scenario) -> f64 {
    let spacing_m = scenario.terrain.spacing_m;
    let height = scenario.bridges.iter().fold(natural, |h, bridge| bridge_earthworks(h, east, north, bridge, spacing_m));
    level_pad(height, east, north, &scenario.ground_team)
}

fn bridge_earthworks(height: f64, east: f64, north: f64, bridge: &Bridge, spacing_m: f64) -> f64 {
    let Some(underside_m) = bridge.underside_depth_m() else { return height };
    let [x, y, _] = bridge.placement().local(Vec3::new(east, north, 0.0));
    let deck = bridge.center_m.up();
    let half_length = 0.5 * bridge.deck_length_m();
    let opening = bridge.opening_half_length_m();
    let off_side = (y.abs() - 0.5 * bridge.deck_width_m() - 2.0).max(0.0);
    let cut = if x.abs() < opening + 4.0 {
        // The ground under the span slopes down from the springings to avoid covering any part of the bridge.
        let inside = (opening + 4.0 - x.abs()).max(0.0);
        height.min(deck - underside_m - EXCAVATION_DEPTH_M - 0.3 * inside + off_side / EARTHWORK_SLOPE)
    } else {
        // The approaches reach just below the road surface, continue level for a short distance, and then descend to the natural
        // ground.
        let beyond = (x.abs() - half_length - 12.0).max(0.0);
        let reach = if x.abs() > half_length { 0.0 } else { half_length - x.abs() };
        height.max(deck - 0.15 - off_side / EARTHWORK_SLOPE - ROAD_GRADE * beyond - reach * 2.5)
    };
    // The ground rises to meet each footing, extending one grid cell beyond it.
    bridge.footings().iter().fold(cut, |height, foot| {
        let out = |at: f64, (low, high): (f64, f64)| (low - at).max(at - high).max(0.0);
        let away = (math::hypot(out(x, foot.x_m), out(y, foot.y_m)) - spacing_m).max(0.0);
        height.max(deck + foot.up_m + MIN_EMBEDMENT_DEPTH_M - away / EARTHWORK_SLOPE)
    })
}

fn level_pad(height: f64, east: f64, north: f64, team: &GroundTeam) -> f64 {
    let away = math::hypot(east - team.pad_m.east(), north - team.pad_m.north());
    let blend = ((away - LEVEL_GROUND_RADIUS_M) / 10.0).clamp(0.0, 1.0);
    // The surface of the pad is slightly above the leveled ground.
    math::lerp(team.pad_m.up() - 0.05, height, blend)
}

/// Smooth value noise between 0 and 1 with two octaves.
struct ValueNoise {
    lattice: Vec<f64>,
}

const LATTICE_SIZE: usize = 64;

impl ValueNoise {
    fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed, "terrain");
        Self { lattice: (0..LATTICE_SIZE * LATTICE_SIZE).map(|_| random.uniform()).collect() }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        0.7 * self.octave(x, y) + 0.3 * self.octave(2.7 * x + 11.3, 2.7 * y - 7.1)
    }

    fn octave(&self, x: f64, y: f64) -> f64 {
        let cell = |v: f64| (v.floor() as i64).rem_euclid(LATTICE_SIZE as i64) as usize;
        let fade = |v: f64| {
            let t = v - v.floor();
            t * t * (3.0 - 2.0 * t)
        };
        let (cx, cy) = (cell(x), cell(y));
        let at = |i: usize, j: usize| self.lattice[(j % LATTICE_SIZE) * LATTICE_SIZE + i % LATTICE_SIZE];
        let south = math::lerp(at(cx, cy), at(cx + 1, cy), fade(x));
        let north = math::lerp(at(cx, cy + 1), at(cx + 1, cy + 1), fade(x));
        math::lerp(south, north, fade(y))
    }
}
