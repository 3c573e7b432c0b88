//! Uniform structures, with the layouts declared in the shaders (common.wgsl, develop.wgsl).

use super::super::camera::NEAR_PLANE_M;
use super::super::matrix::Matrix;
use super::super::noise::CELLS;
use super::super::quality::Quality;
use super::super::shadows::ShadowMap;
use super::super::shot::Shot;
use super::super::visible_wind::tree_phase_rad;
use nalgebra::Matrix4;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;

/// Maximum number of shadow maps in a shader.
pub const MAX_SHADOW_MAPS: usize = 5;

/// Distance after which the pattern of gusts repeats, m: the noise tile's cells (noise.rs) over those per meter (`GUST_CELLS_PER_M` in
/// water.wgsl).
const GUST_PERIOD_M: f64 = CELLS as f64 / 0.025;

/// Uniforms of the `Globals` shader structure.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Globals {
    view_proj: [[f32; 4]; 4],
    eye: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    sun: [f32; 4],
    sun_rgb: [f32; 4],
    sky_rgb: [f32; 4],
    scene: [f32; 4],
    lamp: [f32; 4],
    lamp_dir: [f32; 4],
    look: [f32; 4],
    shadow: [f32; 4],
    texel: [f32; 4],
    size: [f32; 4],
    shadow_proj: [[[f32; 4]; 4]; MAX_SHADOW_MAPS],
    air: [f32; 4],
    trees: [f32; 4],
    weather: [f32; 4],
    open: [f32; 4],
}

/// Uniforms of the `Occlusion` shader structure.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct OcclusionUniforms {
    lens: [f32; 4],
    size: [f32; 4],
}

/// Uniforms of the `DevelopUniforms` shader structure.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct DevelopUniforms {
    reproject: [[f32; 4]; 4],
    grain: [f32; 4],
    size: [f32; 4],
}

fn with_w(v: Vec3<Enu>, last: f64) -> [f32; 4] {
    let [x, y, z] = v.array();
    [x as f32, y as f32, z as f32, last as f32]
}

fn color_with_w(rgb: [f64; 3], last: f64) -> [f32; 4] {
    [rgb[0] as f32, rgb[1] as f32, rgb[2] as f32, last as f32]
}

/// Shadow maps of a shot.
pub struct ShadowMaps<'a> {
    /// Maps of the sun.
    pub sun: &'a [ShadowMap],
    /// Map of the lamp.
    pub lamp: Option<&'a ShadowMap>,
}

impl Globals {
    /// Returns the globals of a shot, or of its reflection in the water at `water_m`. `photo_half_m` is half the side of the photograph on
    /// the ground, or 0.
    pub fn new(shot: &Shot, (water_m, photo_half_m): (f64, f64), maps: &ShadowMaps, mirrored: bool) -> Self {
        let flip = |v: Vec3<Enu>| if mirrored { Vec3::new(v.east(), v.north(), -v.up()) } else { v };
        let eye_m = shot.eye.position_m;
        let eye = if mirrored { Vec3::new(eye_m.east(), eye_m.north(), 2.0 * water_m - eye_m.up()) } else { eye_m };
        let projection = shot.eye.view_projection(shot.aspect());
        let projection = if mirrored { projection.after(&Matrix::mirror(water_m)) } else { projection };
        let (half_w, half_h) = shot.eye.half_extents(shot.aspect());
        let pixel_rad = 2.0 * half_w / f64::from(shot.size_px.0.max(1));
        let (sky, weather) = (&shot.sky, &shot.weather);
        let (wind, towards, bend_m) = (shot.wind.speed_m_s(), shot.wind.waves_toward, shot.wind.tree_bend_m());
        // The pattern of gusts repeats, so that large displacements lose no digits.
        let drift = |of_m: f64| of_m.rem_euclid(GUST_PERIOD_M) as f32;
        let (east_m, north_m) = shot.wind.drift_m;
        let (lamp, lamp_dir) = shot.beam.map_or(([0.0; 4], [0.0; 4]), |beam| {
            (with_w(beam.position_m, math::cos(beam.half_angle_rad)), with_w(beam.forward, beam.intensity_cd))
        });
        let mut shadow_proj = [Matrix::mirror(0.0).columns(); MAX_SHADOW_MAPS];
        let mut texel = [0.0; 4];
        for (k, map) in maps.sun.iter().chain(maps.lamp).take(MAX_SHADOW_MAPS).enumerate() {
            shadow_proj[k] = map.projection.columns();
            if let Some(slot) = texel.get_mut(k) {
                *slot = map.texel_m as f32;
            }
        }
        let (width, height) = shot.size_px;
        Self {
            view_proj: projection.columns(),
            eye: with_w(eye, shot.time_s),
            right: with_w(flip(shot.eye.right * half_w), 0.0),
            up: with_w(flip(shot.eye.up() * half_h), 0.0),
            forward: with_w(flip(shot.eye.forward), pixel_rad),
            sun: with_w(sky.sun, sky.direct_lux),
            sun_rgb: color_with_w(sky.sun_rgb, sky.cloud),
            sky_rgb: color_with_w(sky.sky_rgb, sky.sky_lux),
            scene: [sky.scale as f32, water_m as f32, weather.extinction_per_m as f32, weather.fog_depth() as f32],
            lamp,
            lamp_dir,
            look: [(1.0 / shot.finish.exposure.white_lux) as f32, wind as f32, towards.0 as f32, towards.1 as f32],
            shadow: [if maps.lamp.is_some() { maps.sun.len() as f32 } else { -1.0 }, 0.0, 0.0, 0.0],
            texel,
            size: [width as f32, height as f32, photo_half_m as f32, 0.0],
            shadow_proj,
            air: [drift(east_m), drift(north_m), shot.wind.gust_intensity as f32, shot.wind.breaking_share() as f32],
            trees: [bend_m.0 as f32, bend_m.1 as f32, tree_phase_rad(shot.time_s) as f32, 0.0],
            weather: [weather.wetness(), weather.snow_cover(), weather.rain_mm_h, weather.snow_mm_h].map(|value| value as f32),
            open: weather.open.map(|share| share as f32),
        }
    }
}

impl OcclusionUniforms {
    /// Returns the uniforms of a shot.
    pub fn new(shot: &Shot) -> Self {
        let (half_w, half_h) = shot.eye.half_extents(shot.aspect());
        let (width, height) = shot.size_px;
        Self { lens: [half_w as f32, half_h as f32, NEAR_PLANE_M as f32, 0.0], size: [width as f32, height as f32, 0.0, 0.0] }
    }
}

impl DevelopUniforms {
    /// Returns the uniforms of a shot.
    pub fn new(shot: &Shot, quality: &Quality) -> Self {
        let now = shot.eye.view_projection(shot.aspect());
        let moved = shot.finish.before.filter(|_| quality.blur_taps > 1);
        let reproject = moved.and_then(|before| {
            let inverse = Matrix4::from_fn(|i, j| now.0[i][j]).try_inverse()?;
            let rows = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| inverse[(i, j)]));
            Some(before.view_projection(shot.aspect()).after(&Matrix(rows)))
        });
        let taps = if reproject.is_some() { quality.blur_taps } else { 1 };
        // The noise differs between pictures but is reproducible for a given time.
        let number = (shot.time_s * 1000.0).rem_euclid(1e6).round();
        let (width, height) = shot.size_px;
        Self {
            reproject: reproject.unwrap_or(Matrix::mirror(0.0)).columns(),
            grain: [shot.finish.noise as f32, number as f32, taps as f32, shot.finish.vignette as f32],
            size: [
                width as f32,
                height as f32,
                shot.finish.lost_blocks as f32,
                shot.finish.exposure.max_brightening_stops() as f32,
            ],
        }
    }
}
