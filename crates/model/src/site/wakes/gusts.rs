//! Turbulence in wakes, as an aircraft feels it: one gust at its center and one at each rotor, which are correlated over the size of the
//! eddies.

use super::air::LocalAir;
use crate::frames::{Ned, Vec3};
use crate::math;
use crate::random::RandomStream;

/// Three independent components with unit variance, each with an exponential correlation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gust(Vec3<Ned>);

impl Gust {
    fn start(stream: &mut RandomStream) -> Self {
        Self(fresh(stream))
    }

    /// Returns the next value, whose correlation with the present one is `kept`.
    fn step(&mut self, kept: f64, stream: &mut RandomStream) -> Vec3<Ned> {
        self.0 = mixed(self.0, fresh(stream), kept);
        self.0
    }
}

/// Returns a value of unit variance with a correlation to a first value, from that and an independent second one.
fn mixed(first: Vec3<Ned>, second: Vec3<Ned>, correlation: f64) -> Vec3<Ned> {
    first * correlation + second * (1.0 - correlation * correlation).max(0.0).sqrt()
}

fn fresh(stream: &mut RandomStream) -> Vec3<Ned> {
    let [north, east, down] = stream.normal3();
    Vec3::new(north, east, down)
}

/// Gusts at the center of an aircraft and at its rotors.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeGusts {
    stream: RandomStream,
    center: Gust,
    /// The part of each rotor that the center does not have.
    rotors: Vec<Gust>,
    /// Distances of the rotors from the center, m.
    arms_m: Vec<f64>,
}

impl WakeGusts {
    /// Creates gusts for rotors at distances from the aircraft's center, m.
    #[must_use]
    pub fn new(arms_m: Vec<f64>, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "wind.wake-gusts");
        let center = Gust::start(&mut stream);
        let rotors = arms_m.iter().map(|_| Gust::start(&mut stream)).collect();
        Self { stream, center, rotors, arms_m }
    }

    /// Draws the gusts after the aircraft has moved by a distance through the air, m: at the center, and at each rotor, m/s. Draws nothing
    /// and returns `None` where there is no turbulence. The correlation of a rotor's gust with the center's falls exponentially over the
    /// length of the eddies, as it does along the way.
    pub fn sample<const N: usize>(
        &mut self,
        center: &LocalAir,
        rotors: &[LocalAir],
        moved_m: f64,
    ) -> Option<(Vec3<Ned>, [Vec3<Ned>; N])> {
        let length_m = center.eddy_m.max(rotors.iter().map(|air| air.eddy_m).fold(0.0, f64::max));
        if length_m <= 0.0 {
            return None;
        }
        let kept = math::exp(-moved_m / length_m);
        let common = self.center.step(kept, &mut self.stream);
        let mut gusts_m_s = [Vec3::zero(); N];
        for (((own, arm_m), air), gust_m_s) in self.rotors.iter_mut().zip(&self.arms_m).zip(rotors).zip(&mut gusts_m_s) {
            let correlation = math::exp(-arm_m / length_m);
            let own = own.step(kept, &mut self.stream);
            *gust_m_s = mixed(common, own, correlation) * air.turbulence_m_s;
        }
        Some((common * center.turbulence_m_s, gusts_m_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: usize = 40_000;
    const ARM_M: f64 = 0.3;
    const EDDY_M: f64 = 0.5;

    fn air(turbulence_m_s: f64) -> LocalAir {
        LocalAir { velocity_m_s: Vec3::zero(), turbulence_m_s, eddy_m: if turbulence_m_s > 0.0 { EDDY_M } else { 0.0 } }
    }

    #[test]
    fn val_gusts_have_the_stated_intensity_and_correlation() {
        // Statistical, of 40,000 samples that are a length of the eddies apart: three standard errors are about 2%.
        const TOLERANCE: f64 = 0.03;
        let mut gusts = WakeGusts::new(vec![ARM_M, ARM_M], 3);
        let (mut center, mut rotor, mut product, mut between) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..SAMPLES {
            let (common, rotors) = gusts.sample::<2>(&air(2.0), &[air(1.0), air(1.0)], EDDY_M).unwrap();
            let [a, b] = [rotors[0].north(), rotors[1].north()];
            center += common.north() * common.north();
            rotor += a * a;
            product += common.north() * a;
            between += a * b;
        }
        let count = SAMPLES as f64;
        assert!(((center / count).sqrt() / 2.0 - 1.0).abs() < TOLERANCE, "{center}");
        assert!(((rotor / count).sqrt() - 1.0).abs() < TOLERANCE, "{rotor}");
        let expected = math::exp(-ARM_M / EDDY_M);
        assert!((product / (center * rotor).sqrt() - expected).abs() < TOLERANCE, "{product}");
        assert!((between / rotor - expected * expected).abs() < TOLERANCE, "{between}");
    }

    #[test]
    fn exact_gusts_repeat_with_the_seed_and_need_turbulence() {
        let (mut first, mut second) = (WakeGusts::new(vec![ARM_M], 3), WakeGusts::new(vec![ARM_M], 3));
        for _ in 0..100 {
            assert_eq!(first.sample::<1>(&air(1.0), &[air(1.0)], 0.1), second.sample::<1>(&air(1.0), &[air(1.0)], 0.1));
        }
        let before = first.clone();
        assert_eq!(first.sample::<1>(&air(0.0), &[air(0.0)], 0.1), None);
        assert_eq!(first, before, "still air draws nothing");
    }
}
