//! Optical flow and the range finder below over water. A flow camera finds no fixed texture on water: from a few meters, it sees
//! the waves and what drifts on the surface, and from higher up nothing to track. A range finder's light returns only now and then.

use super::surroundings::Surroundings;
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;

/// Height above water up to which the flow sensor tracks the surface, m (makers of vision positioning systems warn of flight
/// over water at any height; the value is an estimate).
const MAX_FLOW_HEIGHT_M: f64 = 2.0;
/// Speed of the surface, relative to the wind (Wu, Journal of Fluid Mechanics 68, 1975: 3.5% of the wind at 10 m).
const SURFACE_DRIFT: f64 = 0.035;
/// Velocity of the waves' texture, m/s (1 sigma per axis; estimate: ripples of a decimeter), and its correlation time, s.
const WAVE_VELOCITY_M_S: f64 = 0.25;
const WAVE_TAU_S: f64 = 1.0;
/// Share of the range finder's readings over water without a result (estimate: a mirror-like surface returns the light only from
/// waves that face the sensor).
const LOST_RANGES: f64 = 0.5;
/// Largest difference between the measured range and the distance to the water for which the water counts as the surface below, m, and
/// relative to the distance (tilt and noise).
const SAME_SURFACE: (f64, f64) = (0.3, 0.1);

/// Motion of the water's texture.
#[derive(Debug, Clone, PartialEq)]
pub struct WaterSurface {
    stream: RandomStream,
    waves_m_s: [f64; 2],
}

/// Surface below the aircraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Below {
    /// Ground, a structure, or nothing in range.
    Solid,
    /// Water at a height from which a flow camera tracks its texture.
    NearWater,
    /// Water farther below.
    FarWater,
}

impl WaterSurface {
    /// Creates the surface from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "water surface");
        let waves_m_s = [(); 2].map(|()| WAVE_VELOCITY_M_S * stream.normal());
        Self { stream, waves_m_s }
    }

    /// Returns the surface below the aircraft, from its position and the range finder that looks down, and loses readings over water:
    /// `down_m` becomes infinite.
    pub fn look_down<S: Surroundings>(&mut self, position_m: Vec3<Enu>, down_m: &mut f64, site: &S) -> Below {
        let Some(water_up_m) = site.water_up_m(position_m.east(), position_m.north()) else { return Below::Solid };
        let height_m = position_m.up() - water_up_m;
        if (*down_m - height_m).abs() > SAME_SURFACE.0 + SAME_SURFACE.1 * height_m {
            return Below::Solid;
        }
        if self.stream.uniform() < LOST_RANGES {
            *down_m = f64::INFINITY;
        }
        if height_m <= MAX_FLOW_HEIGHT_M { Below::NearWater } else { Below::FarWater }
    }

    /// Advances the waves by a flow camera's sample and returns the velocity of the surface in a wind, m/s.
    pub fn velocity_m_s(&mut self, wind_m_s: Vec3<Ned>, dt_s: f64) -> Vec3<Ned> {
        let keep = math::exp(-dt_s / WAVE_TAU_S);
        let push = WAVE_VELOCITY_M_S * (1.0 - keep * keep).sqrt();
        for wave in &mut self.waves_m_s {
            *wave = *wave * keep + push * self.stream.normal();
        }
        let [north, east] = self.waves_m_s;
        Vec3::new(wind_m_s.north() * SURFACE_DRIFT + north, wind_m_s.east() * SURFACE_DRIFT + east, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::time::SimTime;

    /// Water at the height 0, except in the north.
    struct Lake;

    impl Surroundings for Lake {
        fn ray_m(&self, _: Vec3<Enu>, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
            None
        }
        fn lux(&self, _: Vec3<Enu>, _: SimTime) -> f64 {
            1e4
        }
        fn water_up_m(&self, _: f64, north_m: f64) -> Option<f64> {
            (north_m < 0.0).then_some(0.0)
        }
    }

    fn look(north_m: f64, up_m: f64, range_m: f64) -> Below {
        WaterSurface::new(1).look_down(Vec3::new(0.0, north_m, up_m), &mut { range_m }, &Lake)
    }

    #[test]
    fn exact_only_water_in_range_without_a_structure_above_it_counts_as_water() {
        assert_eq!(look(-5.0, 1.5, 1.52), Below::NearWater);
        assert_eq!(look(-5.0, 6.0, 6.1), Below::FarWater);
        assert_eq!(look(-5.0, 6.0, 3.0), Below::Solid, "a deck between aircraft and water");
        assert_eq!(look(-5.0, 60.0, f64::INFINITY), Below::Solid, "out of range");
        assert_eq!(look(5.0, 6.0, 6.0), Below::Solid, "on land");
    }

    #[test]
    fn exact_half_of_the_ranges_over_water_are_lost() {
        // Standard error of a share of 1/2 in 4,000 readings: 0.008.
        let mut water = WaterSurface::new(2);
        let lost = (0..4_000)
            .filter(|_| {
                let mut down_m = 3.0;
                water.look_down(Vec3::new(0.0, -5.0, 3.0), &mut down_m, &Lake);
                down_m.is_infinite()
            })
            .count();
        assert!((f64::from(lost as u32) / 4_000.0 - LOST_RANGES).abs() < 0.04, "{lost}");
    }

    #[test]
    fn exact_surface_drifts_with_the_wind_and_waves_have_their_velocity() {
        // Correlated samples: 2,000 s with a correlation time of 1 s are about 1,000 independent ones.
        const TOLERANCE: f64 = 0.05;
        let mut water = WaterSurface::new(3);
        let samples: Vec<Vec3<Ned>> = (0..40_000).map(|_| water.velocity_m_s(Vec3::new(10.0, 0.0, 0.0), 0.05)).collect();
        let count = samples.len() as f64;
        let mean = samples.iter().map(|v| v.north()).sum::<f64>() / count;
        let deviation = (samples.iter().map(|v| v.east() * v.east()).sum::<f64>() / count).sqrt();
        assert!((mean - 0.35).abs() < TOLERANCE && (deviation - WAVE_VELOCITY_M_S).abs() < TOLERANCE, "{mean} {deviation}");
    }
}
