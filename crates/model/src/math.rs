//! Wrappers for the transcendental functions of libm, which are bit-identical on every machine, unlike those of the standard
//! library. Clippy bans the std methods elsewhere (`clippy.toml`). `sqrt`, `abs`, `floor` and the four operations are exact in
//! IEEE 754.

pub use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Standard gravity, m/s² (CGPM 1901).
pub const GRAVITY_M_S2: f64 = 9.806_65;
/// Meters per second in one mile per hour (exact by definition).
pub const M_S_PER_MPH: f64 = 0.447_04;

/// Returns the sine of an angle in radians.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Returns the cosine of an angle in radians.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Returns the sine and cosine of an angle in radians.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
/// Returns the tangent of an angle in radians.
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}
/// Returns the arc sine in radians; the argument is clamped to [-1, 1].
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x.clamp(-1.0, 1.0))
}
/// Returns the arc cosine in radians; the argument is clamped to [-1, 1].
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}
/// Returns the four-quadrant arc tangent of y/x in radians.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// Returns the arc tangent in radians.
#[must_use]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}
/// Returns e to the power of x.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// Returns the natural logarithm of x.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// Returns the decimal logarithm of x.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}
/// Returns x to the power of y.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// Returns the hyperbolic tangent of x.
#[must_use]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}
/// Returns the complementary error function of x.
#[must_use]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}
/// Returns the cube root of x.
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}
/// Returns the length of (x, y), without overflow of intermediate results.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}
/// Returns the direction of a horizontal vector, clockwise from north, in [0, 360] degrees; 360 only by rounding.
#[must_use]
pub fn bearing_deg(east: f64, north: f64) -> f64 {
    atan2(east, north).to_degrees().rem_euclid(360.0)
}
/// Wraps an angle to (-π, π].
#[must_use]
pub fn wrap_pi(angle_rad: f64) -> f64 {
    // Most angles are within half a turn, and the arithmetic below leaves them unchanged, except for the sign of a zero.
    const WITHIN_HALF_A_TURN_RAD: f64 = 3.0;
    if angle_rad.abs() < WITHIN_HALF_A_TURN_RAD && angle_rad != 0.0 {
        return angle_rad;
    }
    let turned = angle_rad - TAU * (angle_rad / TAU).round();
    if turned <= -PI { turned + TAU } else { turned }
}
/// Returns the smallest and the largest value; infinity and minus infinity without values.
#[must_use]
pub fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}
/// Interpolates linearly: `t` = 0 yields `a`, 1 yields `b`.
#[must_use]
pub fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}
