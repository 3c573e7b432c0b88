//! Range finders: one pointing down, one up and eight spread around the body plane, modeled as rays into the site.

use super::surroundings::Surroundings;
use crate::physics::RigidState;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;

/// Readings of all range finders at one instant, m; infinite if nothing is in range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeReadings {
    /// Downward range.
    pub down_m: f64,
    /// Upward range.
    pub up_m: f64,
    /// Ranges in eight directions clockwise from the nose.
    pub around_m: [f64; 8],
}

impl RangeReadings {
    /// Returns the shortest range, in meters.
    #[must_use]
    pub fn min_range_m(&self) -> f64 {
        self.around_m.iter().fold(self.down_m.min(self.up_m), |a, b| a.min(*b))
    }
}

/// State of the range finders.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeFinders {
    stream: RandomStream,
    due: Schedule,
    noise_m: f64,
    /// Bias of each sensor: down, up, then the eight horizontal ones.
    bias_m: [f64; 10],
    max_m: f64,
    around: [Vec3<Frd>; 8],
}

impl RangeFinders {
    /// Creates the sensors with the aircraft's rate, noise and maximum range.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, seed: u64) -> Self {
        let mut around = [Vec3::zero(); 8];
        for (i, direction) in around.iter_mut().enumerate() {
            let (s, c) = math::sin_cos(i as f64 * math::PI / 4.0);
            *direction = Vec3::new(c, s, 0.0);
        }
        let mut stream = RandomStream::new(seed, "range");
        Self {
            bias_m: std::array::from_fn(|_| sensors.range_bias_m * stream.normal()),
            stream,
            due: Schedule::new(SimTime::ZERO, sensors.range_rate_hz),
            noise_m: sensors.range_noise_m,
            max_m: sensors.range_max_m,
            around,
        }
    }

    /// Returns all ranges from the center of mass, if a sample is due.
    pub fn read<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> Option<RangeReadings> {
        if !self.due.fire(now) {
            return None;
        }
        if site.is_clear_within(rigid.position_m.enu(), self.max_m, now) {
            let far = f64::INFINITY;
            return Some(RangeReadings { down_m: far, up_m: far, around_m: [far; 8] });
        }
        let [down, up, beside @ ..] = self.bias_m;
        let down_m = self.measure(rigid, (Vec3::new(0.0, 0.0, 1.0), down), site, now);
        let up_m = self.measure(rigid, (Vec3::new(0.0, 0.0, -1.0), up), site, now);
        let mut around_m = [0.0; 8];
        for (range, looks) in around_m.iter_mut().zip(self.around.into_iter().zip(beside)) {
            *range = self.measure(rigid, looks, site, now);
        }
        Some(RangeReadings { down_m, up_m, around_m })
    }

    /// Measures one range along a direction, with the bias of its sensor.
    fn measure<S: Surroundings>(
        &mut self,
        rigid: &RigidState,
        (direction, bias_m): (Vec3<Frd>, f64),
        site: &S,
        now: SimTime,
    ) -> f64 {
        let hit = site.ray_m(rigid.position_m.enu(), (rigid.attitude * direction).enu(), self.max_m, now);
        hit.map_or(f64::INFINITY, |d| (d + bias_m + self.noise_m * self.stream.normal()).max(0.0))
    }
}
