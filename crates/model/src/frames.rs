//! Coordinate frames as types. The type of a [`Vec3`] includes its frame, and the type of a [`Rotation`] its source and
//! target frames.
//!
//! * [`Ned`]: local tangent plane at the scenario origin, axes north, east, down. Used by flight control and MAVLink.
//! * [`LocalNed`]: MAVLink's local frame, with the axes of [`Ned`] and the origin where the vehicle's estimator was initialized.
//! * [`Enu`]: the same plane and origin, axes east, north, up. Used by site, scenario and assessment.
//! * [`Frd`]: body frame, axes forward, right, down, origin at the center of mass.
//!
//! Only [`Ned`] and [`Enu`] convert to each other directly; all other conversions require a [`Rotation`].

use super::math;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Local tangent plane: x north, y east, z down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ned;
/// MAVLink's local frame: axes of [`Ned`], origin where the vehicle's estimator was initialized.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocalNed;
/// Local tangent plane: x east, y north, z up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Enu;
/// Body frame: x forward, y right, z down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frd;

/// A vector with three components expressed in frame `F`. Variable names state the quantity and its unit.
pub struct Vec3<F> {
    v: Vector3<f64>,
    frame: PhantomData<F>,
}

impl<F> Vec3<F> {
    /// Creates a vector from its components in the frame's axis order.
    #[must_use]
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { v: Vector3::new(x, y, z), frame: PhantomData }
    }

    /// Returns the zero vector.
    #[must_use]
    pub const fn zero() -> Self {
        Self::new(0.0, 0.0, 0.0)
    }

    /// Creates a vector from raw components that are known to be expressed in `F`. State the reason at the call site:
    /// `// FRAME: …`.
    #[must_use]
    pub const fn assume(v: Vector3<f64>) -> Self {
        Self { v, frame: PhantomData }
    }

    /// Returns the components without the frame type, for matrix algebra.
    #[must_use]
    pub const fn raw(self) -> Vector3<f64> {
        self.v
    }

    /// Returns the components as an array, in the frame's axis order.
    #[must_use]
    pub fn array(self) -> [f64; 3] {
        [self.v.x, self.v.y, self.v.z]
    }

    /// Returns the dot product.
    #[must_use]
    pub fn dot(self, other: Self) -> f64 {
        self.v.dot(&other.v)
    }

    /// Returns the cross product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::assume(self.v.cross(&other.v))
    }

    /// Returns the Euclidean length.
    #[must_use]
    pub fn norm(self) -> f64 {
        self.v.norm()
    }

    /// Returns the square of the Euclidean length.
    #[must_use]
    pub fn norm_squared(self) -> f64 {
        self.v.norm_squared()
    }

    /// Returns the unit vector in the same direction; zero for a vector shorter than 1e-300.
    #[must_use]
    pub fn unit(self) -> Self {
        let norm = self.norm();
        if norm < 1e-300 { Self::zero() } else { self / norm }
    }

    /// Returns the vector with its length limited to `limit`.
    #[must_use]
    pub fn limited(self, limit: f64) -> Self {
        let norm = self.norm();
        if norm > limit { self * (limit / norm) } else { self }
    }

    /// Returns true if all components are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.v.iter().all(|c| c.is_finite())
    }

    /// Interpolates linearly: `t` = 0 returns this vector, 1 returns `other`.
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self + (other - self) * t
    }
}

impl Vec3<Ned> {
    /// Returns the north component.
    #[must_use]
    pub fn north(self) -> f64 {
        self.v.x
    }
    /// Returns the east component.
    #[must_use]
    pub fn east(self) -> f64 {
        self.v.y
    }
    /// Returns the down component.
    #[must_use]
    pub fn down(self) -> f64 {
        self.v.z
    }
    /// Converts the vector to east, north, up.
    #[must_use]
    pub fn enu(self) -> Vec3<Enu> {
        Vec3::new(self.v.y, self.v.x, -self.v.z)
    }
    /// Returns the horizontal length.
    #[must_use]
    pub fn horizontal_norm(self) -> f64 {
        (self.v.x * self.v.x + self.v.y * self.v.y).sqrt()
    }
}

impl Vec3<Enu> {
    /// Returns the east component.
    #[must_use]
    pub fn east(self) -> f64 {
        self.v.x
    }
    /// Returns the north component.
    #[must_use]
    pub fn north(self) -> f64 {
        self.v.y
    }
    /// Returns the up component.
    #[must_use]
    pub fn up(self) -> f64 {
        self.v.z
    }
    /// Converts the vector to north, east, down.
    #[must_use]
    pub fn ned(self) -> Vec3<Ned> {
        Vec3::new(self.v.y, self.v.x, -self.v.z)
    }
    /// Returns the horizontal length.
    #[must_use]
    pub fn horizontal_norm(self) -> f64 {
        (self.v.x * self.v.x + self.v.y * self.v.y).sqrt()
    }
}

impl Vec3<Frd> {
    /// Returns the forward component.
    #[must_use]
    pub fn forward(self) -> f64 {
        self.v.x
    }
    /// Returns the right component.
    #[must_use]
    pub fn right(self) -> f64 {
        self.v.y
    }
    /// Returns the down component.
    #[must_use]
    pub fn down(self) -> f64 {
        self.v.z
    }
}

impl<F> Clone for Vec3<F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Vec3<F> {}
impl<F> PartialEq for Vec3<F> {
    fn eq(&self, other: &Self) -> bool {
        self.v == other.v
    }
}
impl<F> Default for Vec3<F> {
    fn default() -> Self {
        Self::zero()
    }
}
impl<F> fmt::Debug for Vec3<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}, {}]", self.v.x, self.v.y, self.v.z)
    }
}
impl<F> Add for Vec3<F> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self::assume(self.v + rhs.v)
    }
}
impl<F> Sub for Vec3<F> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self::assume(self.v - rhs.v)
    }
}
impl<F> AddAssign for Vec3<F> {
    fn add_assign(&mut self, rhs: Self) {
        self.v += rhs.v;
    }
}
impl<F> SubAssign for Vec3<F> {
    fn sub_assign(&mut self, rhs: Self) {
        self.v -= rhs.v;
    }
}
impl<F> Neg for Vec3<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::assume(-self.v)
    }
}
impl<F> Mul<f64> for Vec3<F> {
    type Output = Self;
    fn mul(self, rhs: f64) -> Self {
        Self::assume(self.v * rhs)
    }
}
impl<F> Div<f64> for Vec3<F> {
    type Output = Self;
    fn div(self, rhs: f64) -> Self {
        Self::assume(self.v / rhs)
    }
}

/// Converts a vector's components from frame `From` to frame `To` (`to_from * vector_in_from`). `Rotation<Frd, Ned>` is the
/// attitude of the body: the quaternion that MAVLink sends.
pub struct Rotation<From, To> {
    q: UnitQuaternion<f64>,
    frames: PhantomData<(From, To)>,
}

impl<A, B> Rotation<A, B> {
    /// Returns the identity: the axes of both frames coincide.
    #[must_use]
    pub fn identity() -> Self {
        Self::assume(UnitQuaternion::identity())
    }

    /// Creates a rotation from a quaternion that is known to rotate from `A` to `B`. State the reason at the call site:
    /// `// FRAME: …`.
    #[must_use]
    pub fn assume(q: UnitQuaternion<f64>) -> Self {
        Self { q, frames: PhantomData }
    }

    /// Creates a rotation from the quaternion components w, x, y, z and normalizes them; `None` if they are not finite or all
    /// near zero.
    #[must_use]
    pub fn from_wxyz(wxyz: [f64; 4]) -> Option<Self> {
        let q = Quaternion::new(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
        let norm = q.norm();
        (norm.is_finite() && norm > 1e-9).then(|| Self::assume(UnitQuaternion::new_normalize(q)))
    }

    /// Returns the quaternion components w, x, y, z.
    #[must_use]
    pub fn wxyz(self) -> [f64; 4] {
        [self.q.w, self.q.i, self.q.j, self.q.k]
    }

    /// Returns the quaternion without the frame types.
    #[must_use]
    pub fn raw(self) -> UnitQuaternion<f64> {
        self.q
    }

    /// Returns the rotation matrix.
    #[must_use]
    pub fn matrix(self) -> Matrix3<f64> {
        *self.q.to_rotation_matrix().matrix()
    }

    /// Returns the inverse rotation.
    #[must_use]
    pub fn inverse(self) -> Rotation<B, A> {
        Rotation::assume(self.q.inverse())
    }

    /// Composes two rotations: first `self` (A to B), then `next` (B to C).
    #[must_use]
    pub fn then<C>(self, next: Rotation<B, C>) -> Rotation<A, C> {
        Rotation::assume(next.q * self.q)
    }

    /// Interpolates to another rotation along the shorter arc: `t` = 0 returns this rotation, 1 returns `other`. For nearby
    /// rotations the angular rate is constant up to fourth order in their angle.
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        let (a, b) = (self.q.into_inner(), other.q.into_inner());
        let b = if a.dot(&b) < 0.0 { -b } else { b };
        let between = a * (1.0 - t) + b * t;
        // Opposite quaternions represent the same rotation. After the sign change the two are at most 90 degrees apart, so their
        // weighted sum does not vanish.
        if between.norm() > 1e-9 { Self::assume(UnitQuaternion::new_normalize(between)) } else { self }
    }

    /// Applies another rotation, given as a rotation vector (axis times angle in radians) in the source frame `A`.
    #[must_use]
    pub fn rotated_by(self, rotation_vector_rad: Vec3<A>) -> Self {
        let v = rotation_vector_rad.raw();
        let angle = v.norm();
        let (s, c) = math::sin_cos(angle * 0.5);
        // The limit of the quotient as the angle approaches zero avoids a division by zero.
        let k = if angle > 1e-9 { s / angle } else { 0.5 };
        let dq = Quaternion::new(c, v.x * k, v.y * k, v.z * k);
        Self::assume(UnitQuaternion::new_normalize(self.q.into_inner() * dq))
    }
}

impl Rotation<Frd, Ned> {
    /// Creates a rotation from roll, pitch and yaw in radians (intrinsic z-y-x, as in MAVLink's ATTITUDE).
    #[must_use]
    pub fn from_euler(roll_rad: f64, pitch_rad: f64, yaw_rad: f64) -> Self {
        let (sr, cr) = math::sin_cos(roll_rad * 0.5);
        let (sp, cp) = math::sin_cos(pitch_rad * 0.5);
        let (sy, cy) = math::sin_cos(yaw_rad * 0.5);
        Self::assume(UnitQuaternion::new_normalize(Quaternion::new(
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        )))
    }

    /// Returns roll, pitch and yaw in radians (intrinsic z-y-x).
    #[must_use]
    pub fn euler(self) -> (f64, f64, f64) {
        let [w, x, y, z] = self.wxyz();
        let roll = math::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
        let pitch = math::asin(2.0 * (w * y - z * x));
        let yaw = math::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
        (roll, pitch, yaw)
    }

    /// Returns yaw in radians, clockwise from north.
    #[must_use]
    pub fn yaw_rad(self) -> f64 {
        let [w, x, y, z] = self.wxyz();
        math::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    }
}

impl<A, B> Clone for Rotation<A, B> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A, B> Copy for Rotation<A, B> {}
impl<A, B> PartialEq for Rotation<A, B> {
    fn eq(&self, other: &Self) -> bool {
        self.q == other.q
    }
}
impl<A, B> fmt::Debug for Rotation<A, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.wxyz())
    }
}
impl<A, B> Mul<Vec3<A>> for Rotation<A, B> {
    type Output = Vec3<B>;
    fn mul(self, rhs: Vec3<A>) -> Vec3<B> {
        Vec3::assume(self.q * rhs.raw())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors of a few f64 operations, dimensionless.
    const ROUNDING_TOLERANCE: f64 = 1e-14;

    #[test]
    fn exact_ned_and_enu_conversions_are_inverse() {
        let v: Vec3<Ned> = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(v.enu(), Vec3::new(2.0, 1.0, -3.0));
        assert_eq!(v.enu().ned(), v);
    }

    #[test]
    fn exact_yaw_of_90_degrees_points_the_nose_east() {
        let attitude = Rotation::from_euler(0.0, 0.0, math::FRAC_PI_2);
        let nose = attitude * Vec3::<Frd>::new(1.0, 0.0, 0.0);
        assert!((nose - Vec3::new(0.0, 1.0, 0.0)).norm() < ROUNDING_TOLERANCE);
    }

    #[test]
    fn exact_positive_pitch_raises_the_nose() {
        let nose = Rotation::from_euler(0.0, 0.1, 0.0) * Vec3::<Frd>::new(1.0, 0.0, 0.0);
        assert!(nose.down() < 0.0);
    }

    #[test]
    fn exact_euler_angles_round_trip() {
        let (r, p, y) = Rotation::from_euler(0.3, -0.4, 2.5).euler();
        assert!(
            (r - 0.3).abs() < ROUNDING_TOLERANCE && (p + 0.4).abs() < ROUNDING_TOLERANCE && (y - 2.5).abs() < ROUNDING_TOLERANCE
        );
    }

    #[test]
    fn exact_lerp_interpolates_headings_on_the_shorter_arc() {
        let deg = |yaw: f64| Rotation::from_euler(0.0, 0.0, yaw.to_radians());
        let yaw = |a: f64, b: f64, t: f64| deg(a).lerp(deg(b), t).yaw_rad().to_degrees();
        assert!((yaw(10.0, 50.0, 0.5) - 30.0).abs() < 1e-9);
        assert!((yaw(170.0, -170.0, 0.5).abs() - 180.0).abs() < 1e-9, "the shorter arc");
        assert!((yaw(0.0, 4.0, 0.25) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn exact_positive_yaw_rotates_clockwise_seen_from_above() {
        let turned = Rotation::from_euler(0.0, 0.0, 0.0).rotated_by(Vec3::new(0.0, 0.0, 0.2));
        assert!((turned.yaw_rad() - 0.2).abs() < ROUNDING_TOLERANCE);
    }
}
