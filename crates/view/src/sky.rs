//! Sky model: radiance and color in every direction, scaled to the horizontal illuminance of the light model. The
//! `sky.wgsl` shader contains the same function; its clouds are decorative and cast no light.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::light::Daylight;

/// Color of the clear sky's zenith, luminance 1 (estimate: about 15,000 K).
const ZENITH_COLOR: [f64; 3] = [0.62, 0.97, 2.0];
/// Color of the horizon, luminance 1 (estimate: about 8,000 K).
const HORIZON_COLOR: [f64; 3] = [0.94, 0.995, 1.24];
/// Color of clouds, luminance 1 (estimate: about 6,500 K).
const CLOUD_COLOR: [f64; 3] = [0.97, 1.0, 1.05];
/// Optical depths of clear air for red, green, and blue light, per air mass (Rayleigh scattering, inverse fourth power,
/// with slight haze; estimate).
const AIR_OPTICAL_DEPTH: [f64; 3] = [0.07, 0.12, 0.24];

/// Brightness of thick air relative to the sky at the horizon (estimate; common.wgsl has the same number).
const VEIL_SHARE: f64 = 0.85;
/// Fraction of the shadows' blue tint that a camera's white balance removes (estimate).
const WHITE_BALANCE_FRACTION: f64 = 0.55;

/// Sky parameters of the shaders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    /// Unit vector toward the sun.
    pub sun: Vec3<Enu>,
    /// Illuminance of the sun on a surface that faces it, lx.
    pub direct_lux: f64,
    /// Color of the sun, luminance 1.
    pub sun_rgb: [f64; 3],
    /// Horizontal illuminance of the sky, lx.
    pub sky_lux: f64,
    /// Color of the sky's total light, luminance 1.
    pub sky_rgb: [f64; 3],
    /// Cloud cover, 0 to 1.
    pub cloud: f64,
    /// Factor for [`relative_radiance`] that scales the hemisphere's illuminance to `sky_lux` (π times luminance, lx).
    pub scale: f64,
}

/// Returns the luminance of an RGB color (ITU-R BT.709).
#[must_use]
pub fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

fn with_luminance(rgb: [f64; 3], luminance_is: f64) -> [f64; 3] {
    let k = luminance_is / luminance(rgb);
    rgb.map(|c| c * k)
}

/// Returns the relative radiance of the sky in an upward direction.
#[must_use]
pub fn relative_radiance(direction: Vec3<Enu>, sun: Vec3<Enu>, cloud: f64) -> [f64; 3] {
    let up = direction.up().clamp(0.0, 1.0);
    let fall = math::pow(1.0 - up, 4.0);
    let towards = direction.dot(sun).clamp(-1.0, 1.0);
    let angle = math::acos(towards);
    // Brighter at the horizon and around the sun, like the CIE clear sky (general shape; estimate).
    let glow = 1.0 + 2.2 * math::exp(-3.2 * angle) + 5.0 * math::exp(-22.0 * angle);
    let clear = (0.32 + 0.68 * fall) * glow;
    // CIE overcast sky: three times as bright at the zenith as at the horizon.
    let grey = (1.0 + 2.0 * up) / 3.0;
    [0, 1, 2].map(|k| math::lerp(clear * math::lerp(ZENITH_COLOR[k], HORIZON_COLOR[k], fall), grey * CLOUD_COLOR[k], cloud))
}

impl Sky {
    /// Returns the sky for a daylight state and cloud cover.
    #[must_use]
    pub fn new(day: &Daylight, cloud: f64) -> Self {
        const ELEVATION_BANDS: u32 = 16;
        const AZIMUTH_STEPS: u32 = 32;
        let mut sum = [0.0; 3];
        // Each sample has an equal share of cos θ dω, so the horizontal illuminance is the mean of π L over the
        // samples.
        for band in 0..ELEVATION_BANDS {
            let up = ((f64::from(band) + 0.5) / f64::from(ELEVATION_BANDS)).sqrt();
            let out = (1.0 - up * up).sqrt();
            for turn in 0..AZIMUTH_STEPS {
                let (s, c) = math::sin_cos(math::TAU * (f64::from(turn) + 0.5) / f64::from(AZIMUTH_STEPS));
                let rgb = relative_radiance(Vec3::new(out * s, out * c, up), day.sun, cloud);
                sum = [0, 1, 2].map(|k| sum[k] + rgb[k] / f64::from(ELEVATION_BANDS * AZIMUTH_STEPS));
            }
        }
        let elevation_deg = math::asin(day.sun.up()).to_degrees().max(0.0);
        let mass = 1.0 / (day.sun.up().max(0.0) + 0.505_72 * math::pow(elevation_deg + 6.079_95, -1.6364));
        Self {
            sun: day.sun,
            direct_lux: day.direct_normal_lux,
            sun_rgb: with_luminance(AIR_OPTICAL_DEPTH.map(|depth| math::exp(-depth * mass)), 1.0),
            sky_lux: day.sky_lux,
            sky_rgb: with_luminance(sum, 1.0).map(|c| math::lerp(c, 1.0, WHITE_BALANCE_FRACTION)),
            cloud,
            scale: day.sky_lux / luminance(sum),
        }
    }

    /// Returns π times the luminance of thick air in the direction of a ray, in lx: about that of the sky at the horizon (`veil_radiance`
    /// in common.wgsl).
    #[must_use]
    pub fn veil_lux(&self, ray: Vec3<Enu>) -> f64 {
        let level = Vec3::new(ray.east(), ray.north(), 0.0);
        if level.norm() > 1e-9 { VEIL_SHARE * self.visible_lux(level.unit()) } else { VEIL_SHARE * self.sky_lux }
    }

    /// Returns π times the luminance in the given direction, in lx.
    #[must_use]
    pub fn visible_lux(&self, direction: Vec3<Enu>) -> f64 {
        self.scale * luminance(relative_radiance(direction, self.sun, self.cloud))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sky_radiance_integrates_to_the_illuminance() {
        // Compares with an independent quadrature over 20,000 directions; the tolerance allows for the coarser
        // quadrature in `Sky::new`.
        const TOLERANCE: f64 = 0.02;
        for (up, cloud) in [(0.9, 0.0), (0.2, 0.3), (0.5, 1.0)] {
            let sun = Vec3::new((1.0_f64 - up * up).sqrt(), 0.0, up);
            let sky = Sky::new(&Daylight::at(sun, cloud), cloud);
            let mut lux = 0.0;
            let (bands, turns) = (100, 200);
            for band in 0..bands {
                let up = (f64::from(band) + 0.5) / f64::from(bands);
                let out = (1.0 - up * up).sqrt();
                for turn in 0..turns {
                    let (s, c) = math::sin_cos(math::TAU * f64::from(turn) / f64::from(turns));
                    // dω = dup dφ, and `visible_lux` returns π L.
                    let share = 2.0 / f64::from(bands * turns);
                    lux += sky.visible_lux(Vec3::new(out * c, out * s, up)) * up * share;
                }
            }
            assert!((lux / sky.sky_lux - 1.0).abs() < TOLERANCE, "{lux} against {}", sky.sky_lux);
        }
    }

    #[test]
    fn prop_clear_sky_is_blue_and_low_sun_is_red() {
        let at = |up: f64| {
            let sun = Vec3::new((1.0_f64 - up * up).sqrt(), 0.0, up);
            Sky::new(&Daylight::at(sun, 0.0), 0.0)
        };
        assert!(at(0.8).sky_rgb[2] > 1.1 * at(0.8).sky_rgb[0]);
        assert!(at(0.05).sun_rgb[0] > 2.0 * at(0.05).sun_rgb[2]);
        assert!(at(0.8).sun_rgb[0] < 1.3 * at(0.8).sun_rgb[2]);
    }
}
