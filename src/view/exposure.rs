//! How bright the picture comes out: what a meter in the camera sees, within what the camera can.

use super::camera::Eye;
use super::sky::Sky;
use crate::base::frames::{Enu, Vec3};
use crate::site::{At, CameraPose, Site, Surface, look};
use crate::vehicle::{Camera, Lamp};

/// Metered places across and down.
const GRID: (u32, u32) = (7, 5);
/// What is metered comes out at this share of white (estimate: what people set outdoors; the tone curve takes a fifth of it).
const AIM: f64 = 0.24;
/// Reflectance taken for whatever is hit (estimate: between wet concrete and grass).
const ALBEDO: f64 = 0.25;
/// A bright place counts no more than this many times the middle one: the sky does not black out a soffit.
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
    pub at: At,
}

impl Exposure {
    /// For the aircraft's camera: never brighter than its longest exposure at its highest sensitivity allows.
    #[must_use]
    pub fn camera(metered_lux: f64, camera: &Camera) -> Self {
        let limit = look::needed_lux(camera);
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

/// What the meter finds: the illuminance, lx, under which the picture comes out right.
#[must_use]
pub fn meter(site: &Site, eye: &Eye, aspect: f64, light: &Lighting) -> f64 {
    let mut seen: Vec<f64> = Vec::new();
    for row in 0..GRID.1 {
        for column in 0..GRID.0 {
            let place = |k: u32, of: u32| (f64::from(2 * k + 1) / f64::from(of) - 1.0) * 0.9;
            let ray = eye.ray(place(column, GRID.0), place(row, GRID.1), aspect);
            seen.push(seen_lux(site, eye.position_m, ray, light));
        }
    }
    seen.sort_by(f64::total_cmp);
    let most = seen[seen.len() / 2] * HIGHLIGHT;
    let mean = seen.iter().map(|lux| lux.min(most)).sum::<f64>() / seen.len() as f64;
    mean / AIM
}

/// π times the luminance along a ray, lx.
fn seen_lux(site: &Site, from: Vec3<Enu>, ray: Vec3<Enu>, light: &Lighting) -> f64 {
    let Some(hit) = site.ray(from, ray, REACH_M, light.at) else {
        return light.sky.seen_lux(Vec3::new(ray.east(), ray.north(), ray.up().max(0.0)));
    };
    let point = from + ray * hit.distance_m;
    if hit.surface == Surface::Water {
        // Water mirrors the sky, the more the flatter one looks at it (Schlick), over a dark body.
        let mirrored = Vec3::new(ray.east(), ray.north(), ray.up().abs());
        let glance = 1.0 - ray.up().abs();
        let fresnel = 0.02 + 0.98 * glance * glance * glance * glance * glance;
        return fresnel * light.sky.seen_lux(mirrored) + 0.04 * site.ambient_lux(point, Some(hit.normal), light.at);
    }
    let lamp = light.lamp.map_or(0.0, |(lamp, pose)| look::lamp_lux(lamp, pose, point, hit.normal));
    ALBEDO * (site.ambient_lux(point, Some(hit.normal), light.at) + lamp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::defects::REFERENCE_CAMERA;

    #[test]
    fn exact_the_camera_opens_up_to_its_limit_and_no_further() {
        let limit = look::needed_lux(&REFERENCE_CAMERA);
        let dark = Exposure::camera(0.1 * limit, &REFERENCE_CAMERA);
        assert_eq!((dark.white_lux, dark.time_s), (limit, REFERENCE_CAMERA.exposure_max_s));
        assert!((dark.iso - REFERENCE_CAMERA.iso_max).abs() < 1e-6);
        // 160 times the light: a tenth of the time at a sixteenth of the sensitivity.
        let bright = Exposure::camera(160.0 * limit, &REFERENCE_CAMERA);
        assert!((bright.iso - 100.0).abs() < 1e-6 && (bright.time_s - 0.1 * REFERENCE_CAMERA.exposure_max_s).abs() < 1e-9);
    }
}
