//! Picture exposure: metering and camera limits. The metered mean weights the middle of the picture and surfaces. Parts that are
//! darker or brighter than the mean are adapted when the picture is developed (shaders/adapt.wgsl), within the same limits.

use super::camera::PinholeCamera;
use super::sky::Sky;
use super::visible_weather::VisibleWeather;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::{CameraPose, QueryTime, RayHit, Site, Surface, visibility};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Lamp};

/// Number of metered points, horizontally and vertically.
const METERING_GRID: (u32, u32) = (7, 5);
/// Target for the metered mean, as a fraction of white (estimate: typical outdoor setting; the tone curve accounts for
/// a fifth of it).
const METERING_TARGET: f64 = 0.24;
/// Reflectance assumed for every surface (estimate: between wet concrete and grass).
const ALBEDO: f64 = 0.25;
/// Maximum weight of a bright point relative to the middle points; keeps a bright sky from underexposing a soffit.
const MAX_HIGHLIGHT_WEIGHT: f64 = 5.0;
/// Weight of a point of the sky relative to one of a surface (estimate: metering by scene recognition nearly ignores the sky).
const SKY_WEIGHT: f64 = 0.25;
/// Decrease of the weights with the square of the distance from the middle, which is 1 at an edge: the corner points weigh a quarter
/// (estimate: center-weighted metering).
const CENTER_WEIGHTING: f64 = 1.2;
/// Largest local brightening, stops (estimate: cameras that merge exposures recover three to four stops from shadows).
const MAX_BRIGHTENING_STOPS: f64 = 3.5;
/// Minimum illuminance to which the inspector's eyes adapt, lx (estimate: limit of color vision).
const MIN_EYE_ADAPTATION_LUX: f64 = 3.0;
/// Lowest ISO sensitivity of any camera.
const MIN_ISO: f64 = 100.0;
/// Sine of the lowest elevation at which fog is metered against the sky; below, it hides the sky.
const MIN_FOG_SINE: f64 = 0.02;
/// Maximum metering distance, m.
const METERING_RANGE_M: f64 = 600.0;

/// Exposure of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Illuminance that makes a white surface appear white, lx.
    pub white_lux: f64,
    /// Lowest illuminance that can make a white surface appear white in a part of the picture, lx.
    pub min_white_lux: f64,
    /// Exposure time, s.
    pub time_s: f64,
    /// ISO sensitivity.
    pub iso: f64,
}

/// Light of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Lighting<'a> {
    /// Sun and sky.
    pub sky: &'a Sky,
    /// Fog, rain and snow between the camera and the surfaces.
    pub weather: &'a VisibleWeather,
    /// The aircraft's lamp and its pose, if it is on.
    pub lamp: Option<(&'a Lamp, &'a CameraPose)>,
    /// Simulation time of the site query.
    pub query_time: QueryTime,
}

impl Exposure {
    /// Returns the exposure of the aircraft's camera, limited by its longest exposure time and highest sensitivity.
    #[must_use]
    pub fn camera(metered_lux: f64, camera: &Camera) -> Self {
        let limit = visibility::required_illuminance_lux(camera);
        let lux = metered_lux.max(limit);
        // limit = C N²/(t_max S_max), so t S = t_max S_max limit / lux.
        let product = camera.max_exposure_time_s * camera.iso_max * limit / lux;
        let time_s = (product / MIN_ISO).min(camera.max_exposure_time_s);
        let iso = (product / time_s).clamp(MIN_ISO, camera.iso_max.max(MIN_ISO));
        Self { white_lux: lux, min_white_lux: limit, time_s, iso }
    }

    /// Returns the exposure of a person's eyes.
    #[must_use]
    pub fn eyes(metered_lux: f64) -> Self {
        let white_lux = metered_lux.max(MIN_EYE_ADAPTATION_LUX);
        Self { white_lux, min_white_lux: MIN_EYE_ADAPTATION_LUX, time_s: 0.0, iso: MIN_ISO }
    }

    /// Returns the largest brightening of a part of the picture, in stops. Surfaces with less light than the camera's limits
    /// allow stay dark, as in the scores.
    #[must_use]
    pub fn max_brightening_stops(&self) -> f64 {
        (math::ln(self.white_lux / self.min_white_lux) / std::f64::consts::LN_2).clamp(0.0, MAX_BRIGHTENING_STOPS)
    }
}

/// Adaptation time constant of a camera's exposure and of a person's eyes, s (estimate: cameras settle in about a
/// second).
const ADAPTATION_TIME_S: f64 = 0.35;
/// Minimum time gap that restarts the adaptation, s.
const ADAPTATION_RESET_GAP_S: f64 = 2.0;

/// Smooths the metered illuminance over a sequence of pictures. Prevents flicker when an object crosses the picture.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExposureMeter(Option<(SimTime, f64)>);

impl ExposureMeter {
    /// Returns the smoothed illuminance for the picture at time `at`, in lx. The first picture, and the first one after
    /// a jump in time, uses the metered value directly.
    pub fn smoothed_lux(&mut self, metered_lux: f64, at: SimTime) -> f64 {
        let before = self
            .0
            .filter(|(then, lux)| *then <= at && (at - *then).s() <= ADAPTATION_RESET_GAP_S && *lux > 0.0 && metered_lux > 0.0);
        let lux = before.map_or(metered_lux, |(then, lux)| {
            let kept = math::exp(-(at - then).s() / ADAPTATION_TIME_S);
            metered_lux * math::pow(lux / metered_lux, kept)
        });
        self.0 = Some((at, lux));
        lux
    }
}

/// Returns the metered illuminance that sets the picture's exposure, in lx.
#[must_use]
pub fn meter(site: &Site, eye: &PinholeCamera, aspect: f64, light: &Lighting) -> f64 {
    let mut seen: Vec<MeteredPoint> = Vec::new();
    for row in 0..METERING_GRID.1 {
        for column in 0..METERING_GRID.0 {
            let place = |k: u32, of: u32| (f64::from(2 * k + 1) / f64::from(of) - 1.0) * 0.9;
            let (x, y) = (place(column, METERING_GRID.0), place(row, METERING_GRID.1));
            let (lux, weight) = metered_point(site, eye.position_m, eye.ray(x, y, aspect), light);
            seen.push((lux, weight * math::exp(-CENTER_WEIGHTING * (x * x + y * y))));
        }
    }
    metered(seen)
}

/// π times the luminance of a point, lx, and its weight.
type MeteredPoint = (f64, f64);

/// Returns the mean of the metered values divided by the target, in lx. A bright point counts at most
/// [`MAX_HIGHLIGHT_WEIGHT`] times the geometric mean of the middle half, which starts at the lower quartile. When one
/// point changes from dark to bright, this mean moves only slightly, whereas a median would jump from the soffit to the
/// sky.
fn metered(mut seen: Vec<MeteredPoint>) -> f64 {
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = seen.iter().map(|point| point.1).sum();
    let (from, to) = (0.25 * whole, 0.75 * whole);
    let mut below = 0.0;
    let mut logs = 0.0;
    for (lux, weight) in &seen {
        let in_middle = ((below + weight).min(to) - below.max(from)).max(0.0);
        logs += in_middle * math::ln(lux.max(MIN_EYE_ADAPTATION_LUX * METERING_TARGET));
        below += weight;
    }
    let most = MAX_HIGHLIGHT_WEIGHT * math::exp(logs / (to - from));
    let mean = seen.iter().map(|(lux, weight)| weight * lux.min(most)).sum::<f64>() / whole;
    mean / METERING_TARGET
}

/// Returns π times the luminance along a ray, in lx, and the weight of what is there.
fn metered_point(site: &Site, from: Vec3<Enu>, ray: Vec3<Enu>, light: &Lighting) -> MeteredPoint {
    let (lux, weight, clear) = match site.ray(from, ray, METERING_RANGE_M, light.query_time) {
        Some(hit) => {
            let lux = surface_lux(site, (ray, from + ray * hit.distance_m), &hit, light);
            (lux, 1.0, light.weather.transmittance(hit.distance_m))
        }
        None => {
            let lux = light.sky.visible_lux(Vec3::new(ray.east(), ray.north(), ray.up().max(0.0)));
            (lux, SKY_WEIGHT, math::exp(-light.weather.fog_depth() / ray.up().max(MIN_FOG_SINE)))
        }
    };
    (math::lerp(light.sky.veil_lux(ray), lux, clear), weight)
}

/// Returns π times the luminance of a point on a surface, in lx.
fn surface_lux(site: &Site, (ray, point): (Vec3<Enu>, Vec3<Enu>), hit: &RayHit, light: &Lighting) -> f64 {
    let ambient_lux = site.ambient_lux(point, Some(hit.normal), light.query_time);
    if hit.surface == Surface::Water {
        // Water reflects the sky, more strongly at grazing angles (Schlick), and is dark below the surface.
        let mirrored = Vec3::new(ray.east(), ray.north(), ray.up().abs());
        let glance = 1.0 - ray.up().abs();
        let fresnel = 0.02 + 0.98 * glance * glance * glance * glance * glance;
        return fresnel * light.sky.visible_lux(mirrored) + 0.04 * ambient_lux;
    }
    let lamp = light.lamp.map_or(0.0, |(lamp, pose)| visibility::lamp_lux(lamp, pose, point, hit.normal));
    ALBEDO * (ambient_lux + lamp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::random::RandomStream;
    use spandrel_model::site::defects::REFERENCE_CAMERA;

    /// Number of metered points.
    const METERED_POINTS: usize = (METERING_GRID.0 * METERING_GRID.1) as usize;
    /// Relative rounding error when adding 35 numbers.
    const ROUNDING_ERROR: f64 = 1e-12;

    fn near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < ROUNDING_ERROR
    }

    #[test]
    fn exact_uniform_light_is_metered_by_its_mean() {
        for lux in [1.0, 300.0, 20_000.0] {
            assert!(near(metered(vec![(lux, 1.0); METERED_POINTS]), lux / METERING_TARGET));
        }
        // The values range from 1 to 4.4, so no point exceeds the middle points fivefold.
        let slope: Vec<MeteredPoint> = (0..METERED_POINTS).map(|k| (1_000.0 + 100.0 * k as f64, 1.0)).collect();
        assert!(near(metered(slope), 2_700.0 / METERING_TARGET));
    }

    #[test]
    fn exact_bright_points_have_limited_weight() {
        let mut seen = vec![(100.0, 1.0); METERED_POINTS];
        seen[..5].fill((1e5, 1.0));
        assert!(near(
            metered(seen),
            (30.0 * 100.0 + 5.0 * MAX_HIGHLIGHT_WEIGHT * 100.0) / METERED_POINTS as f64 / METERING_TARGET
        ));
    }

    #[test]
    fn exact_points_count_by_their_weights() {
        // A point with a weight of two counts as much as two points; one without weight does not count.
        let twice = vec![(100.0, 2.0), (150.0, 1.0), (220.0, 1.0), (1e5, 0.0)];
        let single = vec![(100.0, 1.0), (100.0, 1.0), (150.0, 1.0), (220.0, 1.0)];
        assert!(near(metered(twice), metered(single)));
    }

    #[test]
    fn exact_brightening_stops_at_the_limits_of_the_camera() {
        let limit = visibility::required_illuminance_lux(&REFERENCE_CAMERA);
        for (metered_lux, stops) in [(0.1 * limit, 0.0), (limit, 0.0), (4.0 * limit, 2.0), (1e4 * limit, MAX_BRIGHTENING_STOPS)] {
            let found = Exposure::camera(metered_lux, &REFERENCE_CAMERA).max_brightening_stops();
            assert!((found - stops).abs() < 1e-9, "{found} instead of {stops}");
        }
    }

    #[test]
    fn prop_one_brightening_point_changes_the_exposure_smoothly() {
        // The values range from a soffit at noon to the sky near the sun.
        const DARK_LUX: f64 = 30.0;
        const RANGE: f64 = 1_000.0;
        // The middle half shares the logarithm of the range. With the cap, all points together weigh at least as much as three
        // quarters in the middle: the middle half (whose mean is no less than its geometric mean) and the quarter above.
        // The changed point weighs at most as much as five.
        let in_middle = 1.0 / (0.5 * METERED_POINTS as f64);
        let capped = MAX_HIGHLIGHT_WEIGHT / (0.75 * METERED_POINTS as f64);
        let leap = math::pow(RANGE, in_middle) * (1.0 + capped);
        // Changing a point by 1% changes the result by less than 1% of the point's shares of the geometric mean and
        // the cap.
        let nudge = 1.0 + 0.01 * (in_middle + capped);
        let mut stream = RandomStream::new(7, "view.exposure");
        for bright in 0..METERED_POINTS {
            for turn in 0..100 {
                let other = |stream: &mut RandomStream| DARK_LUX * math::pow(RANGE, stream.uniform());
                let mut seen: Vec<f64> =
                    (0..METERED_POINTS).map(|k| if k < bright { DARK_LUX * RANGE } else { DARK_LUX }).collect();
                // Every other iteration has random values in between.
                seen.iter_mut().filter(|_| turn % 2 == 1).for_each(|lux| *lux = other(&mut stream));
                let at = if turn == 0 { bright } else { stream.below(METERED_POINTS) };
                let with = |lux: f64| {
                    let mut seen = seen.clone();
                    seen[at] = lux;
                    metered(seen.into_iter().map(|lux| (lux, 1.0)).collect())
                };
                let (dark, light) = (with(DARK_LUX), with(DARK_LUX * RANGE));
                assert!(light >= dark && light < dark * leap, "{dark} to {light} lx among {seen:?}");
                let nudged = with(seen[at] * 1.01) / with(seen[at]);
                assert!((1.0 - ROUNDING_ERROR..nudge).contains(&nudged), "{nudged} among {seen:?}");
            }
        }
    }

    #[test]
    fn exact_adaptation_does_not_depend_on_the_frame_rate() {
        let end = |steps: i64| {
            let mut meter = ExposureMeter::default();
            assert_eq!(meter.smoothed_lux(100.0, SimTime::ZERO), 100.0);
            (1..=steps).fold(0.0, |_, k| meter.smoothed_lux(1e4, SimTime::from_ms(k * 700 / steps)))
        };
        // After two time constants, e⁻² of the initial difference of two decades remains.
        let expected = 1e4 * math::pow(1e-2, math::exp(-2.0));
        assert!(near(end(1), expected) && (end(70) / expected - 1.0).abs() < 1e-9, "{} and {}", end(1), end(70));
    }

    #[test]
    fn exact_time_jump_restarts_the_adaptation() {
        let mut meter = ExposureMeter::default();
        meter.smoothed_lux(100.0, SimTime::from_ms(5_000));
        assert_eq!(meter.smoothed_lux(9.0, SimTime::from_ms(4_000)), 9.0);
        assert_eq!(meter.smoothed_lux(700.0, SimTime::from_ms(6_001)), 700.0);
    }

    #[test]
    fn exact_camera_exposure_stops_at_its_limits() {
        let limit = visibility::required_illuminance_lux(&REFERENCE_CAMERA);
        let dark = Exposure::camera(0.1 * limit, &REFERENCE_CAMERA);
        assert_eq!((dark.white_lux, dark.time_s), (limit, REFERENCE_CAMERA.max_exposure_time_s));
        assert!((dark.iso - REFERENCE_CAMERA.iso_max).abs() < 1e-6);
        // 160 times the light requires a tenth of the exposure time at a sixteenth of the sensitivity.
        let bright = Exposure::camera(160.0 * limit, &REFERENCE_CAMERA);
        assert!((bright.iso - 100.0).abs() < 1e-6 && (bright.time_s - 0.1 * REFERENCE_CAMERA.max_exposure_time_s).abs() < 1e-9);
    }
}
