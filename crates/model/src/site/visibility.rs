//! Decides whether a photo captures a defect, according to the rule in docs/src/reference/assessment.md, "Photographs".
//! The defect must be inside the central 80% of the image, unoccluded, viewed at most 60 degrees from its normal, at
//! least 10 px long in its longest visible dimension, at least 0.5 px wide if it is a line, and lit well enough for an
//! exposure within the camera's limits. The camera is an ideal pinhole; the lamp is at the lens and points along the
//! optical axis.

use super::camera_pose::CameraPose;
use super::light::RayCast;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::numbers::{format_limit, format_with_limit};
use crate::scenario::PlacedDefect;
use crate::vehicle::{Camera, Lamp};

/// Maximum distance from the lens at which defects are evaluated, m.
pub const MAX_RANGE_M: f64 = 60.0;
/// Central fraction of the image's width and height in which defects count as captured.
pub const CENTRAL_FRACTION: f64 = 0.8;
/// Maximum angle between the line of sight and the defect's normal, rad.
pub const MAX_INCIDENCE_RAD: f64 = math::PI / 3.0;
/// Minimum length of the longest visible dimension, px.
pub const MIN_EXTENT_PX: f64 = 10.0;
/// Minimum width of a line defect, px.
pub const MIN_LINE_WIDTH_PX: f64 = 0.5;
/// Calibration constant of an incident-light meter, lx s ISO (ISO 2720 specifies 240 to 400).
const LIGHT_METER_CONSTANT: f64 = 250.0;
/// Offsets of the occlusion test's sample points from the center of a defect, as fractions of the defect's length.
const SAMPLE_OFFSETS: [f64; 5] = [-0.48, -0.24, 0.0, 0.24, 0.48];
/// Height above the surface at which lines of sight end, m.
const SURFACE_OFFSET_M: f64 = 0.005;
/// Length at the end of a line of sight that is excluded from the occlusion test, m.
const OCCLUSION_MARGIN_M: f64 = 0.01;

/// Visibility of one defect in a photo, with the measurements for each condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectView {
    /// Defect ID ([`PlacedDefect::id`]).
    pub defect_id: u32,
    /// True if the defect is inside the central 80% of the image.
    pub in_frame: bool,
    /// True if most of the defect's sample points have a clear line of sight.
    pub unoccluded: bool,
    /// Angle between the line of sight and the defect's normal, rad.
    pub incidence_rad: f64,
    /// Longest visible dimension, px.
    pub extent_px: f64,
    /// Width, px. Only line defects have a minimum width.
    pub width_px: f64,
    /// Illuminance at the defect from sun, sky, reflections and lamp, lx.
    pub illuminance_lux: f64,
    /// Illuminance needed for an exposure within the camera's limits, lx.
    pub required_illuminance_lux: f64,
    /// Distance between the defect and the lens, m.
    pub distance_m: f64,
    /// True for a line defect, which must have a minimum width in the image.
    pub line: bool,
    /// True if the lamp was on.
    pub lamp_on: bool,
    /// True if the photo captures the defect: all conditions are met.
    pub hit: bool,
}

/// Function that returns the ambient illuminance, lx, at a position on a surface with the given normal.
pub type AmbientLight<'a> = &'a dyn Fn(Vec3<Enu>, Vec3<Enu>) -> f64;

/// Returns the illuminance needed for an exposure within the camera's limits, in lx: C N²/(t S).
#[must_use]
pub fn required_illuminance_lux(camera: &Camera) -> f64 {
    LIGHT_METER_CONSTANT * camera.f_number * camera.f_number / (camera.max_exposure_time_s * camera.iso_max)
}

/// Returns the illuminance that a lamp at the lens produces on a surface, in lx: flux over the solid angle of the beam,
/// with the inverse square and cosine laws.
#[must_use]
pub fn lamp_lux(lamp: &Lamp, pose: &CameraPose, point_m: Vec3<Enu>, normal: Vec3<Enu>) -> f64 {
    let to = point_m - pose.position_m;
    let distance = to.norm();
    if !pose.lamp_on || lamp.luminous_flux_lm <= 0.0 || distance <= 0.0 {
        return 0.0;
    }
    let edge = math::cos(0.5 * lamp.beam_angle_rad);
    let ray = to / distance;
    if ray.dot(pose.forward) < edge {
        return 0.0;
    }
    let candela = lamp.luminous_flux_lm / (math::TAU * (1.0 - edge));
    candela * (-ray.dot(normal)).max(0.0) / (distance * distance)
}

/// Returns whether the center of a defect is inside the central 80% of the image.
#[must_use]
pub fn is_framed(defect: &PlacedDefect, pose: &CameraPose, camera: &Camera) -> bool {
    project(pose, camera, defect.position_m).is_some_and(|px| is_in_frame(px, camera, CENTRAL_FRACTION))
}

/// Evaluates the visibility of one defect; `None` if it is too far away or behind the camera. Calls `cast` for the lines of sight
/// and `ambient` once, and only if it returns a result.
#[must_use]
pub fn evaluate_defect(
    defect: &PlacedDefect,
    pose: &CameraPose,
    (camera, lamp): (&Camera, &Lamp),
    cast: RayCast,
    ambient: AmbientLight,
) -> Option<DefectView> {
    let to = defect.position_m - pose.position_m;
    let distance_m = to.norm();
    if distance_m > MAX_RANGE_M || to.dot(pose.forward) <= 0.0 {
        return None;
    }
    let incidence_rad = math::acos(-to.dot(defect.normal) / distance_m.max(1e-9));
    let samples = SAMPLE_OFFSETS.map(|s| defect.position_m + defect.along * (s * defect.length_m));
    let seen = samples.map(|p| has_line_of_sight(pose.position_m, p + defect.normal * SURFACE_OFFSET_M, cast));
    // A majority of the sample points must be visible: three of five.
    let unoccluded = 2 * seen.iter().filter(|s| **s).count() > SAMPLE_OFFSETS.len();
    // A hidden defect fails only the occlusion condition, not the size condition as well.
    let counted = if unoccluded { seen } else { [true; SAMPLE_OFFSETS.len()] };
    let in_frame = is_framed(defect, pose, camera);
    let width_px = length_px(pose, camera, defect, defect.normal.cross(defect.along), defect.width_m);
    let along_px = visible_px(pose, camera, defect, samples.iter().zip(counted));
    let mut view = DefectView {
        defect_id: defect.id,
        in_frame,
        unoccluded,
        incidence_rad,
        extent_px: if defect.line { along_px } else { along_px.max(width_px) },
        width_px,
        illuminance_lux: ambient(defect.position_m, defect.normal) + lamp_lux(lamp, pose, defect.position_m, defect.normal),
        required_illuminance_lux: required_illuminance_lux(camera),
        distance_m,
        line: defect.line,
        lamp_on: pose.lamp_on,
        hit: false,
    };
    view.hit = view.conditions().iter().all(|c| *c);
    Some(view)
}

impl DefectView {
    /// Returns whether each of the six conditions is met, in the order of docs/src/reference/assessment.md, "Photographs":
    /// framing, occlusion, incidence, extent, line width, light.
    #[must_use]
    pub fn conditions(&self) -> [bool; 6] {
        [
            self.in_frame,
            self.unoccluded,
            self.incidence_rad <= MAX_INCIDENCE_RAD,
            self.extent_px >= MIN_EXTENT_PX,
            !self.line || self.width_px >= MIN_LINE_WIDTH_PX,
            self.illuminance_lux >= self.required_illuminance_lux,
        ]
    }

    /// Returns the reasons why the photo does not capture the defect; empty if it does.
    #[must_use]
    pub fn reasons(&self) -> Vec<String> {
        let lamp = if self.lamp_on { "lamp on" } else { "lamp off" };
        let (incidence_deg, incidence_max_deg) = (self.incidence_rad.to_degrees(), MAX_INCIDENCE_RAD.to_degrees());
        // The required illuminance is displayed as an integer unless the measured value is between the rounded and the exact
        // limit.
        let whole = self.required_illuminance_lux.round();
        let required_illuminance_lux = if self.illuminance_lux < whole { whole } else { self.required_illuminance_lux };
        let words = [
            "not in the central 80% of the image".to_owned(),
            "hidden behind something".to_owned(),
            format!(
                "too oblique: {} deg, limit {} deg",
                format_with_limit(incidence_deg, incidence_max_deg, 0),
                format_limit(incidence_max_deg)
            ),
            format!("too small: {} px, at least {MIN_EXTENT_PX} px", format_with_limit(self.extent_px, MIN_EXTENT_PX, 1)),
            format!(
                "line too thin: {} px, at least {MIN_LINE_WIDTH_PX} px",
                format_with_limit(self.width_px, MIN_LINE_WIDTH_PX, 2)
            ),
            format!(
                "too dark: {lamp}, {} lx of {} lx needed",
                format_with_limit(self.illuminance_lux, required_illuminance_lux, 0),
                format_limit(required_illuminance_lux)
            ),
        ];
        words.into_iter().zip(self.conditions()).filter_map(|(word, holds)| (!holds).then_some(word)).collect()
    }
}

fn has_line_of_sight(from: Vec3<Enu>, to: Vec3<Enu>, cast: RayCast) -> bool {
    let line = to - from;
    let reach = line.norm() - OCCLUSION_MARGIN_M;
    reach <= 0.0 || cast(from, line.unit(), reach).is_none()
}

/// Returns pixel coordinates from the image center, right and down; `None` behind the lens.
fn project(pose: &CameraPose, camera: &Camera, point_m: Vec3<Enu>) -> Option<(f64, f64)> {
    let to = point_m - pose.position_m;
    let depth = to.dot(pose.forward);
    let down = pose.forward.cross(pose.right);
    let focal = camera.focal_px();
    (depth > 1e-6).then(|| (focal * to.dot(pose.right) / depth, focal * to.dot(down) / depth))
}

fn is_in_frame(px: (f64, f64), camera: &Camera, share: f64) -> bool {
    px.0.abs() <= 0.5 * share * f64::from(camera.width_px) && px.1.abs() <= 0.5 * share * f64::from(camera.height_px)
}

/// Returns the visible length of a defect in pixels. Each counted sample point inside the image represents an equal part of the
/// length.
fn visible_px<'a>(
    pose: &CameraPose,
    camera: &Camera,
    defect: &PlacedDefect,
    samples: impl Iterator<Item = (&'a Vec3<Enu>, bool)>,
) -> f64 {
    let framed = |p: &Vec3<Enu>| project(pose, camera, *p).is_some_and(|px| is_in_frame(px, camera, 1.0));
    let shown = samples.filter(|(p, counts)| *counts && framed(p)).count();
    length_px(pose, camera, defect, defect.along, defect.length_m) * shown as f64 / SAMPLE_OFFSETS.len() as f64
}

/// Returns the length in pixels of a segment of `length_m` along a unit direction through the center of the defect. Uses the
/// scale at the center, which preserves the precision of sub-pixel widths.
pub(super) fn length_px(pose: &CameraPose, camera: &Camera, defect: &PlacedDefect, direction: Vec3<Enu>, length_m: f64) -> f64 {
    let to = defect.position_m - pose.position_m;
    let distance = to.norm().max(1e-9);
    let ray = to / distance;
    let across = (direction - ray * direction.dot(ray)).norm();
    // A pinhole camera has more pixels per radian off its axis, so the on-axis value is conservative.
    camera.focal_px() * across * length_m / distance
}

#[cfg(test)]
mod tests {
    use super::super::query_types::{ObjectId, RayHit, Surface};
    use super::*;

    const CAMERA: Camera = Camera {
        position_m: Vec3::new(0.0, 0.0, 0.0),
        width_px: 4000,
        height_px: 3000,
        hfov_rad: math::FRAC_PI_2,
        zoom_max: 1.0,
        f_number: 2.8,
        iso_max: 1600.0,
        max_exposure_time_s: 0.01,
        gimbal_pitch_min_rad: -1.57,
        gimbal_pitch_max_rad: 1.57,
        gimbal_rate_rad_s: 1.0,
    };
    const LAMP: Lamp = Lamp { luminous_flux_lm: 2200.0, beam_angle_rad: math::PI / 3.0 };

    /// Creates a 0.5 m by 2 mm crack that is 3 m north of the camera and faces it.
    fn crack() -> PlacedDefect {
        PlacedDefect {
            id: 1,
            element: crate::elements::Element::RcArch,
            member: "arch".into(),
            kind: 1130,
            condition_state: 3,
            position_m: Vec3::new(0.0, 3.0, 0.0),
            normal: Vec3::new(0.0, -1.0, 0.0),
            along: Vec3::new(1.0, 0.0, 0.0),
            length_m: 0.5,
            width_m: 0.002,
            line: true,
            cause: None,
            stain: None,
        }
    }

    fn pose() -> CameraPose {
        CameraPose {
            position_m: Vec3::zero(),
            forward: Vec3::new(0.0, 1.0, 0.0),
            right: Vec3::new(1.0, 0.0, 0.0),
            lamp_on: false,
        }
    }

    fn unobstructed(_: Vec3<Enu>, _: Vec3<Enu>, _: f64) -> Option<RayHit> {
        None
    }

    fn obstructed(_: Vec3<Enu>, d: Vec3<Enu>, _: f64) -> Option<RayHit> {
        Some(RayHit { distance_m: 1.0, normal: -d, surface: Surface::Bridge, object: ObjectId(0) })
    }

    fn evaluate(defect: &PlacedDefect, pose: &CameraPose, cast: RayCast, lux: f64) -> DefectView {
        evaluate_defect(defect, pose, (&CAMERA, &LAMP), cast, &|_, _| lux).expect("in front of the camera and within reach")
    }

    fn assert_only_failing(view: &DefectView, index: usize, word: &str) {
        let expected: Vec<bool> = (0..6).map(|k| k != index).collect();
        assert_eq!(view.conditions().to_vec(), expected, "{view:?}");
        assert!(!view.hit);
        assert_eq!(view.reasons().len(), 1);
        assert!(view.reasons()[0].contains(word), "{:?}", view.reasons());
    }

    #[test]
    fn exact_frontal_photo_captures_the_defect_with_pinhole_dimensions() {
        let view = evaluate(&crack(), &pose(), &unobstructed, 1000.0);
        // A field of view of 90 deg and a width of 4000 px yield a focal length of 2000 px.
        assert!(view.hit && view.reasons().is_empty(), "{view:?}");
        assert!((view.extent_px - 2000.0 * 0.5 / 3.0).abs() < 1e-9);
        assert!((view.width_px - 2000.0 * 0.002 / 3.0).abs() < 1e-9);
        // C N²/(t S) = 250 * 2.8² / (0.01 * 1600).
        assert!((view.required_illuminance_lux - 122.5).abs() < 1e-9);
    }

    #[test]
    fn exact_framing_and_occlusion_fail_independently() {
        let mut aside = pose();
        // 40 deg off axis: tan 40 deg = 0.839, just outside 80% of the half image, but still in front of the camera.
        let (s, c) = math::sin_cos(40.0_f64.to_radians());
        (aside.forward, aside.right) = (Vec3::new(s, c, 0.0), Vec3::new(c, -s, 0.0));
        assert_only_failing(&evaluate(&crack(), &aside, &unobstructed, 1000.0), 0, "central");
        assert_only_failing(&evaluate(&crack(), &pose(), &obstructed, 1000.0), 1, "hidden");
    }

    #[test]
    fn exact_incidence_size_width_and_light_fail_independently() {
        let mut oblique = crack();
        let (s, c) = math::sin_cos(61.0_f64.to_radians());
        (oblique.normal, oblique.along) = (Vec3::new(s, -c, 0.0), Vec3::new(0.0, 0.0, 1.0));
        oblique.width_m = 0.01;
        assert_only_failing(&evaluate(&oblique, &pose(), &unobstructed, 1000.0), 2, "61 deg");
        let small = PlacedDefect { length_m: 0.014, line: false, width_m: 0.01, ..crack() };
        assert_only_failing(&evaluate(&small, &pose(), &unobstructed, 1000.0), 3, "9.3 px");
        let thin = PlacedDefect { width_m: 0.0007, ..crack() };
        assert_only_failing(&evaluate(&thin, &pose(), &unobstructed, 1000.0), 4, "0.47 px");
        assert_only_failing(&evaluate(&crack(), &pose(), &unobstructed, 122.0), 5, "lamp off");
    }

    #[test]
    fn val_lamp_illuminance_matches_published_values() {
        // docs/src/reference/domain.md, "Light levels": a 2200 lm, 60 deg light: 2600, 650, 290, 105 lx at 1, 2, 3, 5 m;
        // tolerance is the table's rounding.
        let lit = CameraPose { lamp_on: true, ..pose() };
        for (distance, lux) in [(1.0, 2600.0), (2.0, 650.0), (3.0, 290.0), (5.0, 105.0)] {
            let got = lamp_lux(&LAMP, &lit, Vec3::new(0.0, distance, 0.0), Vec3::new(0.0, -1.0, 0.0));
            assert!((got / lux - 1.0).abs() < 0.02, "{got} at {distance} m");
        }
        let outside = lamp_lux(&LAMP, &lit, Vec3::new(2.0, 3.0, 0.0), Vec3::new(0.0, -1.0, 0.0));
        assert_eq!(outside, 0.0, "33.7 deg is outside a 60 deg beam");
        let dark = evaluate(&crack(), &lit, &unobstructed, 0.0);
        assert!(dark.hit, "the lamp alone lights 3 m: {dark:?}");
    }

    #[test]
    fn exact_defects_behind_or_out_of_range_are_ignored() {
        let behind = CameraPose { forward: Vec3::new(0.0, -1.0, 0.0), ..pose() };
        assert!(evaluate_defect(&crack(), &behind, (&CAMERA, &LAMP), &unobstructed, &|_, _| 1e3).is_none());
        let far = PlacedDefect { position_m: Vec3::new(0.0, 60.1, 0.0), ..crack() };
        assert!(evaluate_defect(&far, &pose(), (&CAMERA, &LAMP), &unobstructed, &|_, _| 1e3).is_none());
    }

    #[test]
    fn exact_only_the_visible_part_of_a_crack_counts() {
        // Lines of sight to the right half are blocked: three of five samples remain.
        let right_blocked = |_: Vec3<Enu>, d: Vec3<Enu>, _: f64| {
            (d.east() > 0.01).then_some(RayHit { distance_m: 1.0, normal: -d, surface: Surface::Other, object: ObjectId(0) })
        };
        let view = evaluate(&crack(), &pose(), &right_blocked, 1000.0);
        assert!(view.unoccluded);
        assert!((view.extent_px - 0.6 * 2000.0 * 0.5 / 3.0).abs() < 1e-9);
    }
}
