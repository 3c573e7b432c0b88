//! The sensors' view of the environment: rays and ambient light.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;

/// Sensor queries against the environment. [`Site`] implements this trait; tests use [`FlatGround`].
pub trait Surroundings {
    /// Returns the distance, in meters, to the first hit along a unit direction, or `None` if there is none within
    /// `max_m`.
    fn ray_m(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<f64>;
    /// Returns true only if there is nothing solid within `max_m` in any direction, including the landing pad.
    /// Returning false is always safe and only costs time.
    fn is_clear_within(&self, _position_m: Vec3<Enu>, _max_m: f64, _at: SimTime) -> bool {
        false
    }
    /// Returns the mean ambient light at a point, in lx.
    fn lux(&self, position_m: Vec3<Enu>, at: SimTime) -> f64;
    /// Returns the height of the water's surface, m up; `None` on land.
    fn water_up_m(&self, _east_m: f64, _north_m: f64) -> Option<f64> {
        None
    }
}

impl Surroundings for Site {
    fn ray_m(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<f64> {
        self.ray(origin_m, direction, max_m, at).map(|hit| hit.distance_m)
    }
    fn is_clear_within(&self, position_m: Vec3<Enu>, max_m: f64, at: SimTime) -> bool {
        // `nearest` excludes the landing pad; the ground height below covers it.
        position_m.up() - self.ground_up_m(position_m.east(), position_m.north()) > max_m
            && self.nearest(position_m, max_m, at).is_none()
    }
    fn lux(&self, position_m: Vec3<Enu>, at: SimTime) -> f64 {
        self.ambient_lux(position_m, None, at)
    }
    fn water_up_m(&self, east_m: f64, north_m: f64) -> Option<f64> {
        self.water_up_m(east_m, north_m)
    }
}

/// Infinite level ground in daylight under an open sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatGround {
    /// Height of the ground, m up.
    pub up_m: f64,
}

impl Surroundings for FlatGround {
    fn ray_m(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<f64> {
        let distance = (self.up_m - origin_m.up()) / direction.up();
        (distance.is_finite() && distance >= 0.0 && distance <= max_m).then_some(distance)
    }
    fn lux(&self, _: Vec3<Enu>, _: SimTime) -> f64 {
        10_000.0
    }
}
