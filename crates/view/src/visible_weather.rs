//! Fog, rain and snow in pictures: objects that fade into the air, wet or white surfaces, and drops and flakes near the lens.
//! A pure function of the scenario, the site and the camera. It changes nothing that is measured: collision geometry, light and
//! visibility of defects don't know it.

use super::camera::PinholeCamera;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::WeatherSpec;
use spandrel_model::site::Site;

/// Natural logarithm of the contrast that remains at the visual range, 2% (Koschmieder 1924).
const CONTRAST_EXPONENT: f64 = 3.912;
/// Attenuation by rain: dB/km at 1 mm/h, and its exponent (Carbonneau and Wisely 1998; also in ITU-R P.1814).
const RAIN_ATTENUATION: (f64, f64) = (1.076, 0.67);
/// Attenuation by dry snow: dB/km at 1 mm/h, and its exponent (ITU-R P.1814, section 4.3, at 550 nm).
const SNOW_ATTENUATION: (f64, f64) = (5.526, 1.38);
/// Decibels of a ratio of powers, per unit of its natural logarithm.
const DECIBELS_PER_E_FOLD: f64 = 4.343;
/// Thickness of the fog above the water, m (estimate: radiation fog in a valley).
const FOG_THICKNESS_M: f64 = 250.0;
/// Rain and snow at which surfaces are entirely wet or white, mm/h (estimates).
const WET_RAIN_MM_H: f64 = 1.0;
const WHITE_SNOW_MM_H: f64 = 0.5;
/// Distances of the layers in which drops and flakes are drawn, m; precipitation.wgsl has the same numbers.
pub const LAYER_DISTANCES_M: [f64; 4] = [1.5, 3.0, 6.0, 12.0];
/// Height above a layer up to which a roof keeps it dry, m.
const SHELTER_HEIGHT_M: f64 = 80.0;

/// Fog, rain and snow at one time, as pictures show them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleWeather {
    /// Rain, mm/h.
    pub rain_mm_h: f64,
    /// Snowfall as water, mm/h.
    pub snow_mm_h: f64,
    /// Extinction of the air, 1/m.
    pub extinction_per_m: f64,
    /// Share of the drops that falls in each layer in front of the camera, 0 under a roof to 1.
    pub open: [f64; LAYER_DISTANCES_M.len()],
}

impl VisibleWeather {
    /// Returns the weather of a scenario in front of a camera.
    #[must_use]
    pub fn at(spec: &WeatherSpec, site: &Site, eye: &PinholeCamera) -> Self {
        let falls = spec.rain_mm_h > 0.0 || spec.snow_mm_h > 0.0;
        let open = LAYER_DISTANCES_M.map(|distance_m| if falls { open_share(site, eye, distance_m) } else { 0.0 });
        Self {
            rain_mm_h: spec.rain_mm_h,
            snow_mm_h: spec.snow_mm_h,
            extinction_per_m: CONTRAST_EXPONENT / spec.visibility_m
                + attenuation_per_m(RAIN_ATTENUATION, spec.rain_mm_h)
                + attenuation_per_m(SNOW_ATTENUATION, spec.snow_mm_h),
            open,
        }
    }

    /// Returns whether drops or flakes are in the picture.
    #[must_use]
    pub fn falls_in_view(&self) -> bool {
        self.open.iter().any(|share| *share > 0.0)
    }

    /// Returns the optical depth of the fog between the water and the sky. A clear day has none, because the sky's model contains its
    /// haze.
    #[must_use]
    pub fn fog_depth(&self) -> f64 {
        let clear_per_m = CONTRAST_EXPONENT / WeatherSpec::CLEAR_VISIBILITY_M;
        FOG_THICKNESS_M * (self.extinction_per_m - clear_per_m).max(0.0)
    }

    /// Returns the share of light that passes through the air over a distance.
    #[must_use]
    pub fn transmittance(&self, distance_m: f64) -> f64 {
        math::exp(-self.extinction_per_m * distance_m)
    }

    /// Returns how wet open surfaces are, 0 to 1.
    #[must_use]
    pub fn wetness(&self) -> f64 {
        (self.rain_mm_h / WET_RAIN_MM_H).min(1.0)
    }

    /// Returns how much snow covers open level surfaces, 0 to 1.
    #[must_use]
    pub fn snow_cover(&self) -> f64 {
        (self.snow_mm_h / WHITE_SNOW_MM_H).min(1.0)
    }
}

fn attenuation_per_m((at_1_mm_h, exponent): (f64, f64), rate_mm_h: f64) -> f64 {
    at_1_mm_h * math::pow(rate_mm_h, exponent) / DECIBELS_PER_E_FOLD / 1_000.0
}

/// Returns the share of a layer's left, middle and right that has no roof.
fn open_share(site: &Site, eye: &PinholeCamera, distance_m: f64) -> f64 {
    const PLACES: [f64; 3] = [-0.6, 0.0, 0.6];
    let half = eye.half_extents(1.0).0;
    let is_open = |place: &&f64| {
        let from = eye.position_m + (eye.forward + eye.right * (*place * half)) * distance_m;
        site.geometry().ray(from, Vec3::<Enu>::new(0.0, 0.0, 1.0), SHELTER_HEIGHT_M).is_none()
    };
    PLACES.iter().filter(is_open).count() as f64 / PLACES.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::Scenario;
    use spandrel_model::shipped::TWO_BRIDGES;

    fn job() -> (Scenario, Site) {
        let job = spandrel_model::scenario::read("two-bridges.toml", TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        let site = Site::without_defects(&job);
        (job, site)
    }

    fn seen(spec: WeatherSpec, from: Vec3<Enu>) -> VisibleWeather {
        let eye = PinholeCamera::at(from, from + Vec3::new(0.0, 50.0, 0.0), 1.0, 1.6);
        VisibleWeather::at(&spec, &job().1, &eye)
    }

    #[test]
    fn exact_contrast_at_the_visual_range_is_two_percent() {
        // The exponent has four digits.
        const TOLERANCE: f64 = 1e-5;
        for visibility_m in [50.0, 800.0, 12_000.0] {
            let spec = WeatherSpec { visibility_m, ..WeatherSpec::default() };
            let left = seen(spec, Vec3::new(0.0, 80.0, 20.0)).transmittance(visibility_m);
            assert!((left - 0.02).abs() < TOLERANCE, "{left}");
        }
        assert_eq!(seen(WeatherSpec::default(), Vec3::new(0.0, 80.0, 20.0)).fog_depth(), 0.0);
    }

    #[test]
    fn val_rain_and_snow_shorten_the_visual_range_as_measured() {
        // ITU-R P.1814, tables 3 and 5: rain of 25 mm/h attenuates by 9.3 dB/km; dry snow of 2 mm/h by 5.54 × 2^1.38 = 14.4 dB/km.
        const TOLERANCE: f64 = 0.01;
        let clear = seen(WeatherSpec::default(), Vec3::new(0.0, 80.0, 20.0)).extinction_per_m;
        for (rain_mm_h, snow_mm_h, db_per_km) in [(25.0, 0.0, 9.3), (0.0, 2.0, 14.4)] {
            let spec = WeatherSpec { rain_mm_h, snow_mm_h, ..WeatherSpec::default() };
            let found = (seen(spec, Vec3::new(0.0, 80.0, 20.0)).extinction_per_m - clear) * 1_000.0 * DECIBELS_PER_E_FOLD;
            assert!((found / db_per_km - 1.0).abs() < TOLERANCE, "{found} dB/km");
        }
    }

    #[test]
    fn exact_drops_fall_beside_a_bridge_and_not_below_it() {
        let rain = WeatherSpec { rain_mm_h: 5.0, ..WeatherSpec::default() };
        assert_eq!(seen(rain, Vec3::new(0.0, 80.0, 20.0)).open, [1.0; 4]);
        // Below the deck of the arch bridge, which is 9 m wide; the last layer is beside it.
        let below = seen(rain, Vec3::new(0.0, -2.0, 20.0)).open;
        assert_eq!((below[0], below[3]), (0.0, 1.0));
        assert!(!seen(WeatherSpec::default(), Vec3::new(0.0, 80.0, 20.0)).falls_in_view());
    }
}
