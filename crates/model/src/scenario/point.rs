//! Reads points from scenario files.

use crate::frames::{Enu, Vec3};
use crate::toml::{Reader, Section};

/// Maximum absolute value of each coordinate of a point, m.
pub const MAX_COORDINATE_M: f64 = 5_000.0;

/// Reads a key whose value is a point [east, north, up], m.
pub(super) fn point(r: &mut Reader, s: &mut Section, key: &'static str, default: Option<[f64; 3]>) -> Vec3<Enu> {
    let [e, n, u] = r.numbers(s, key, (-MAX_COORDINATE_M, MAX_COORDINATE_M), default);
    Vec3::new(e, n, u)
}
