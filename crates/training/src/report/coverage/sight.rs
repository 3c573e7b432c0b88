//! Lines of sight, and the distance at which a picture has sufficient resolution.

use crate::report::context::ReviewContext;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::visibility::MIN_LINE_WIDTH_PX;
use spandrel_model::vehicle::Camera;

/// Crack width that separates condition states 2 and 3 of reinforced concrete (0.05 in, AASHTO MBEI), m.
const CRACK_WIDTH_M: f64 = 0.001_27;
/// Pixel size on the surface at which that crack covers half a pixel, as a hit requires, m.
pub const REQUIRED_GSD_M: f64 = CRACK_WIDTH_M / MIN_LINE_WIDTH_PX;
/// Distance between a sight line's end and the surface, m.
const SIGHT_LINE_MARGIN_M: f64 = 0.02;

/// Returns the distance in meters at which pixels have the required size on the surface.
#[must_use]
pub fn reach_m(camera: &Camera) -> f64 {
    REQUIRED_GSD_M * camera.focal_px()
}

pub(super) fn is_clear(from: Vec3<Enu>, to: Vec3<Enu>, scene: &ReviewContext<'_>) -> bool {
    !scene.site.geometry().hides(from, to, SIGHT_LINE_MARGIN_M)
}
