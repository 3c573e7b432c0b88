//! How bright the picture comes out: what a meter in the camera sees, within what the camera can.

use super::camera::PinholeCamera;
use super::sky::Sky;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::{CameraPose, QueryTime, Site, Surface, visibility};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Lamp};

/// Metered places across and down.
const GRID: (u32, u32) = (7, 5);
/// What is metered comes out at this share of white (estimate: what people set outdoors; the tone curve takes a fifth of it).
const AIM: f64 = 0.24;
/// Reflectance taken for whatever is hit (estimate: between wet concrete and grass).
const ALBEDO: f64 = 0.25;
/// A bright place counts no more than this many times the middling ones: the sky does not black out a soffit.
const HIGHLIGHT: f64 = 5.0;
/// The inspector's eyes see no better than this, lx (estimate: end of colour vision).
const EYE_LUX: f64 = 3.0;
/// Lowest sensitivity of cameras.
const ISO_MIN: f64 = 100.0;
/// Reach of the meter, m.
const REACH_M: f64 = 600.0;

/// An exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Illuminance, lx, under which a white surface comes out white.
    pub white_lux: f64,
    /// Shutter, s.
    pub time_s: f64,
    /// Sensitivity.
    pub iso: f64,
}

/// What lights a picture.
#[derive(Debug, Clone, Copy)]
pub struct Lighting<'a> {
    /// Sun and sky.
    pub sky: &'a Sky,
    /// The aircraft's lamp and where it is, if it is on.
    pub lamp: Option<(&'a Lamp, &'a CameraPose)>,
    /// When.
    pub ambient_at: QueryTime,
}

impl Exposure {
    /// For the aircraft's camera: never brighter than its longest exposure at its highest sensitivity allows.
    #[must_use]
    pub fn camera(metered_lux: f64, camera: &Camera) -> Self {
        let limit = visibility::needed_lux(camera);
        let lux = metered_lux.max(limit);
        // limit = C N²/(t_max S_max), so t S = t_max S_max limit / lux.
        let product = camera.exposure_max_s * camera.iso_max * limit / lux;
        let time_s = (product / ISO_MIN).min(camera.exposure_max_s);
        Self { white_lux: lux, time_s, iso: (product / time_s).clamp(ISO_MIN, camera.iso_max.max(ISO_MIN)) }
    }

    /// For a person's eyes.
    #[must_use]
    pub fn eyes(metered_lux: f64) -> Self {
        Self { white_lux: metered_lux.max(EYE_LUX), time_s: 0.0, iso: ISO_MIN }
    }
}

/// How long an exposure or a person's eyes take to follow the light by all but a third, s (estimate: cameras settle in about a second).
const FOLLOWS_S: f64 = 0.35;
/// After a longer break it begins anew, s.
const BREAK_S: f64 = 2.0;

/// A meter from picture to picture: what passes the lens does not make the whole picture flicker.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExposureMeter(Option<(SimTime, f64)>);

impl ExposureMeter {
    /// What the picture at a time is exposed for, lx, when so much is metered. The first one, and one after a jump in time, for just that.
    pub fn follow(&mut self, metered_lux: f64, at: SimTime) -> f64 {
        let before = self.0.filter(|(then, lux)| *then <= at && (at - *then).s() <= BREAK_S && *lux > 0.0 && metered_lux > 0.0);
        let lux = before.map_or(metered_lux, |(then, lux)| {
            let kept = math::exp(-(at - then).s() / FOLLOWS_S);
            metered_lux * math::pow(lux / metered_lux, kept)
        });
        self.0 = Some((at, lux));
        lux
    }
}

/// What the meter finds: the illuminance, lx, under which the picture comes out right.
#[must_use]
pub fn meter(site: &Site, eye: &PinholeCamera, aspect: f64, light: &Lighting) -> f64 {
    let mut seen: Vec<f64> = Vec::new();
    for row in 0..GRID.1 {
        for column in 0..GRID.0 {
            let place = |k: u32, of: u32| (f64::from(2 * k + 1) / f64::from(of) - 1.0) * 0.9;
            let ray = eye.ray(place(column, GRID.0), place(row, GRID.1), aspect);
            seen.push(visible_lux(site, eye.position_m, ray, light));
        }
    }
    metered(seen)
}

/// The mean of what is seen, lx, over what it is to come out at. A bright place counts no more than [`HIGHLIGHT`] times the middling ones, which
/// are the half from the lower quartile on, taken together by their geometric mean: one place that is dark here and bright there moves that
/// a little, where a median would leap from a soffit to the sky.
fn metered(mut seen: Vec<f64>) -> f64 {
    seen.sort_by(f64::total_cmp);
    let middling = &seen[seen.len() / 4..seen.len() / 4 + seen.len() / 2];
    let logs = middling.iter().map(|lux| math::ln(lux.max(EYE_LUX * AIM))).sum::<f64>();
    let most = HIGHLIGHT * math::exp(logs / middling.len() as f64);
    let mean = seen.iter().map(|lux| lux.min(most)).sum::<f64>() / seen.len() as f64;
    mean / AIM
}

/// π times the luminance along a ray, lx.
fn visible_lux(site: &Site, from: Vec3<Enu>, ray: Vec3<Enu>, light: &Lighting) -> f64 {
    let Some(hit) = site.ray(from, ray, REACH_M, light.ambient_at) else {
        return light.sky.visible_lux(Vec3::new(ray.east(), ray.north(), ray.up().max(0.0)));
    };
    let point = from + ray * hit.distance_m;
    if hit.surface == Surface::Water {
        // Water mirrors the sky, the more the flatter one looks at it (Schlick), over a dark body.
        let mirrored = Vec3::new(ray.east(), ray.north(), ray.up().abs());
        let glance = 1.0 - ray.up().abs();
        let fresnel = 0.02 + 0.98 * glance * glance * glance * glance * glance;
        return fresnel * light.sky.visible_lux(mirrored) + 0.04 * site.ambient_lux(point, Some(hit.normal), light.ambient_at);
    }
    let lamp = light.lamp.map_or(0.0, |(lamp, pose)| visibility::lamp_lux(lamp, pose, point, hit.normal));
    ALBEDO * (site.ambient_lux(point, Some(hit.normal), light.ambient_at) + lamp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::random::RandomStream;
    use spandrel_model::site::defects::REFERENCE_CAMERA;

    /// Places that are metered.
    const PLACES: usize = (GRID.0 * GRID.1) as usize;
    /// Rounding of a sum of 35 numbers, a share of it.
    const ROUNDING: f64 = 1e-12;

    fn near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < ROUNDING
    }

    #[test]
    fn exact_calm_light_is_metered_by_its_mean() {
        for lux in [1.0, 300.0, 20_000.0] {
            assert!(near(metered(vec![lux; PLACES]), lux / AIM));
        }
        // From 1 to 4.4: nothing outshines the middling places five times.
        let slope: Vec<f64> = (0..PLACES).map(|k| 1_000.0 + 100.0 * k as f64).collect();
        assert!(near(metered(slope), 2_700.0 / AIM));
    }

    #[test]
    fn exact_a_few_bright_places_black_nothing_out() {
        let mut seen = vec![100.0; PLACES];
        seen[..5].fill(1e5);
        assert!(near(metered(seen), (30.0 * 100.0 + 5.0 * HIGHLIGHT * 100.0) / PLACES as f64 / AIM));
    }

    #[test]
    fn prop_one_place_that_turns_bright_never_makes_the_light_leap() {
        // From a soffit at noon to the sky beside the sun.
        const DARK_LUX: f64 = 30.0;
        const RANGE: f64 = 1_000.0;
        // The middling 17 of 35 share the logarithm of the range. Under their cap all places together count at least as 27 middling ones (the 17,
        // whose mean is no less than their geometric mean, and the 10 above), and the place itself as five at most.
        let leap = math::pow(RANGE, 1.0 / 17.0) * (1.0 + HIGHLIGHT / 27.0);
        // By a hundredth of its light a place moves the whole by less than its share of both.
        let nudge = 1.0 + 0.01 * (1.0 / 17.0 + HIGHLIGHT / 27.0);
        let mut stream = RandomStream::new(7, "view.exposure");
        for bright in 0..PLACES {
            for turn in 0..100 {
                let other = |stream: &mut RandomStream| DARK_LUX * math::pow(RANGE, stream.uniform());
                let mut seen: Vec<f64> = (0..PLACES).map(|k| if k < bright { DARK_LUX * RANGE } else { DARK_LUX }).collect();
                // Every other time there is all sorts of light between both.
                seen.iter_mut().filter(|_| turn % 2 == 1).for_each(|lux| *lux = other(&mut stream));
                let at = if turn == 0 { bright } else { stream.below(PLACES) };
                let with = |lux: f64| {
                    let mut seen = seen.clone();
                    seen[at] = lux;
                    metered(seen)
                };
                let (dark, light) = (with(DARK_LUX), with(DARK_LUX * RANGE));
                assert!(light >= dark && light < dark * leap, "{dark} to {light} lx among {seen:?}");
                let nudged = with(seen[at] * 1.01) / with(seen[at]);
                assert!((1.0 - ROUNDING..nudge).contains(&nudged), "{nudged} among {seen:?}");
            }
        }
    }

    #[test]
    fn exact_a_picture_follows_the_light_evenly_whatever_its_rate() {
        let end = |steps: i64| {
            let mut meter = ExposureMeter::default();
            assert_eq!(meter.follow(100.0, SimTime::ZERO), 100.0);
            (1..=steps).fold(0.0, |_, k| meter.follow(1e4, SimTime::from_ms(k * 700 / steps)))
        };
        // Two times the time constant: of two powers of ten those e⁻² are left.
        let expected = 1e4 * math::pow(1e-2, math::exp(-2.0));
        assert!(near(end(1), expected) && (end(70) / expected - 1.0).abs() < 1e-9, "{} and {}", end(1), end(70));
    }

    #[test]
    fn exact_a_picture_after_a_jump_is_exposed_for_itself() {
        let mut meter = ExposureMeter::default();
        meter.follow(100.0, SimTime::from_ms(5_000));
        assert_eq!(meter.follow(9.0, SimTime::from_ms(4_000)), 9.0);
        assert_eq!(meter.follow(700.0, SimTime::from_ms(6_001)), 700.0);
    }

    #[test]
    fn exact_the_camera_opens_up_to_its_limit_and_no_further() {
        let limit = visibility::needed_lux(&REFERENCE_CAMERA);
        let dark = Exposure::camera(0.1 * limit, &REFERENCE_CAMERA);
        assert_eq!((dark.white_lux, dark.time_s), (limit, REFERENCE_CAMERA.exposure_max_s));
        assert!((dark.iso - REFERENCE_CAMERA.iso_max).abs() < 1e-6);
        // 160 times the light: a tenth of the time at a sixteenth of the sensitivity.
        let bright = Exposure::camera(160.0 * limit, &REFERENCE_CAMERA);
        assert!((bright.iso - 100.0).abs() < 1e-6 && (bright.time_s - 0.1 * REFERENCE_CAMERA.exposure_max_s).abs() < 1e-9);
    }
}
