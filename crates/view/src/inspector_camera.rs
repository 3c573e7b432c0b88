//! The inspector's view direction and zoom. The view follows the aircraft or looks around freely.

use super::camera::{INSPECTOR_FOV_RAD, PinholeCamera};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::INSPECTOR_EYE_HEIGHT_M;

/// Minimum distance at which the view zooms in on the aircraft automatically, as if through binoculars, m.
const AUTO_ZOOM_START_M: f64 = 60.0;
/// Minimum field of view when zooming in automatically, rad.
const MIN_AUTO_FOV_RAD: f64 = 0.22;
/// Distance from the inspector's position forward to the camera, m; keeps the inspector's body out of the picture.
const EYE_OFFSET_M: f64 = 0.45;
/// Maximum elevation, rad.
const MAX_PITCH_RAD: f64 = 1.4;
/// Range of the manual zoom: from a wider view to binoculars (estimate: 8 x is common).
const ZOOM_RANGE: std::ops::RangeInclusive<f64> = 0.6..=8.0;

/// The inspector's view direction and zoom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InspectorCamera {
    /// Whether the view follows the aircraft.
    pub follows: bool,
    bearing_rad: f64,
    pitch_rad: f64,
    zoom: f64,
}

impl Default for InspectorCamera {
    fn default() -> Self {
        Self { follows: true, bearing_rad: 0.0, pitch_rad: 0.0, zoom: 1.0 }
    }
}

impl InspectorCamera {
    /// Turns the view by the angles `right_rad` and `up_rad`. From then on, it no longer follows the aircraft. `to` is
    /// the vector from the inspector to the aircraft, m.
    pub fn turn(&mut self, right_rad: f64, up_rad: f64, to: Vec3<Enu>) {
        if self.follows {
            // Keeps the magnification of the narrowed view.
            let zoom = math::tan(0.5 * INSPECTOR_FOV_RAD) / math::tan(0.5 * self.vfov_rad(to.norm()));
            self.zoom = zoom.clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
            self.follows = false;
            self.bearing_rad = math::atan2(to.east(), to.north());
            self.pitch_rad = math::atan2(to.up() - INSPECTOR_EYE_HEIGHT_M, to.horizontal_norm());
        }
        self.bearing_rad = math::wrap_pi(self.bearing_rad + right_rad);
        self.pitch_rad = (self.pitch_rad + up_rad).clamp(-MAX_PITCH_RAD, MAX_PITCH_RAD);
    }

    /// Returns the view rotation per pixel, in radians, that makes the scene follow the pointer during a drag.
    /// `height_px` is the height of the view.
    #[must_use]
    pub fn rad_per_px(&self, height_px: f64, to: Vec3<Enu>) -> f64 {
        self.vfov_rad(to.norm()) / height_px.max(1.0)
    }

    /// Multiplies the zoom factor by `times`; values above 1 zoom in.
    pub fn zoom(&mut self, times: f64) {
        if times.is_finite() {
            self.zoom = (self.zoom * times).clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
        }
    }

    /// Returns the vertical field of view, in radians, for an aircraft at the given distance.
    fn vfov_rad(&self, distance_m: f64) -> f64 {
        let narrowed = if self.follows { AUTO_ZOOM_START_M / distance_m.max(AUTO_ZOOM_START_M) } else { 1.0 };
        let half = math::tan(0.5 * (INSPECTOR_FOV_RAD * narrowed).max(MIN_AUTO_FOV_RAD)) / self.zoom;
        2.0 * math::atan2(half, 1.0)
    }

    /// Returns the camera of an inspector standing at `inspector_m`.
    #[must_use]
    pub fn eye(&self, inspector_m: Vec3<Enu>, drone_m: Vec3<Enu>, aspect: f64) -> PinholeCamera {
        let to = drone_m - inspector_m;
        let level: Vec3<Enu> = Vec3::new(to.east(), to.north(), 0.0);
        let (s, c) = math::sin_cos(self.bearing_rad);
        let ahead = match (self.follows, level.norm() > 0.5) {
            (false, _) => Vec3::new(s, c, 0.0),
            (true, true) => level.unit(),
            (true, false) => Vec3::new(0.0, 1.0, 0.0),
        };
        let eye_m = inspector_m + ahead * EYE_OFFSET_M + Vec3::new(0.0, 0.0, INSPECTOR_EYE_HEIGHT_M);
        let (up, flat) = math::sin_cos(self.pitch_rad);
        let target = if self.follows { drone_m } else { eye_m + ahead * flat + Vec3::new(0.0, 0.0, up) };
        PinholeCamera::at(eye_m, target, self.vfov_rad((drone_m - eye_m).norm()), aspect)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INSPECTOR_M: Vec3<Enu> = Vec3::new(0.0, 0.0, 0.0);

    #[test]
    fn exact_view_follows_the_aircraft_until_the_user_turns_it() {
        let mut gaze = InspectorCamera::default();
        let north = Vec3::new(0.0, 40.0, INSPECTOR_EYE_HEIGHT_M);
        assert!((gaze.eye(INSPECTOR_M, north, 1.5).forward.north() - 1.0).abs() < 1e-9);
        gaze.turn(std::f64::consts::FRAC_PI_2, 0.0, north - INSPECTOR_M);
        let east = gaze.eye(INSPECTOR_M, north, 1.5).forward;
        assert!((east.east() - 1.0).abs() < 1e-9, "a right quarter turn from north must end at east: {east:?}");
        assert_eq!(gaze.eye(INSPECTOR_M, Vec3::new(-9.0, 3.0, 50.0), 1.5).forward, east, "the view must not follow the aircraft");
        gaze.turn(0.0, 99.0, north);
        assert!((math::asin(gaze.eye(INSPECTOR_M, north, 1.5).forward.up()) - MAX_PITCH_RAD).abs() < 1e-9);
    }

    #[test]
    fn exact_drag_tracks_the_pointer_and_keeps_the_magnification() {
        let mut gaze = InspectorCamera::default();
        let far = Vec3::new(0.0, 150.0, INSPECTOR_EYE_HEIGHT_M);
        let before = gaze.eye(INSPECTOR_M, far, 1.0).hfov_rad;
        // The camera is slightly closer to the aircraft than the inspector's position.
        let apart = 0.01;
        gaze.turn(0.0, 0.0, far);
        assert!((gaze.eye(INSPECTOR_M, far, 1.0).hfov_rad / before - 1.0).abs() < apart);
        assert!(
            (gaze.rad_per_px(500.0, far) * 500.0 / before - 1.0).abs() < apart,
            "a drag across the whole view must turn it by its field of view"
        );
    }

    #[test]
    fn exact_zoom_divides_the_tangent_and_is_limited() {
        let mut gaze = InspectorCamera::default();
        let far = Vec3::new(0.0, 30.0, INSPECTOR_EYE_HEIGHT_M);
        let half = |gaze: &InspectorCamera| math::tan(0.5 * gaze.eye(INSPECTOR_M, far, 1.0).hfov_rad);
        let plain = half(&gaze);
        gaze.zoom(2.0);
        assert!((half(&gaze) - 0.5 * plain).abs() < 1e-9);
        (0..20).for_each(|_| gaze.zoom(2.0));
        assert!((half(&gaze) - plain / ZOOM_RANGE.end()).abs() < 1e-9);
        gaze.zoom(f64::NAN);
        assert!((half(&gaze) - plain / ZOOM_RANGE.end()).abs() < 1e-9);
    }
}
