//! Named random streams, one per consumer, so that a new consumer does not change the numbers of existing ones.

use super::math;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sha2::{Digest, Sha256};

/// A reproducible stream of random numbers. Plain data, so it can be part of a snapshot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RandomStream {
    generator: Xoshiro256PlusPlus,
}

impl RandomStream {
    /// Creates the `name` stream for `seed`: an xoshiro256++ generator initialized with the SHA-256 of both.
    #[must_use]
    pub fn new(seed: u64, name: &str) -> Self {
        let mut hasher = Sha256::new();
        hasher.update(seed.to_le_bytes());
        hasher.update(name.as_bytes());
        let mut key = [0u8; 32];
        key.copy_from_slice(&hasher.finalize());
        Self { generator: Xoshiro256PlusPlus::from_seed(key) }
    }

    /// Returns 64 random bits as an integer.
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Returns a uniform number in [0, 1) with 53 random bits.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns a uniform number in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Returns a random integer in 0..n; zero if n is zero.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Returns a standard normal number, using Marsaglia's polar method. Discards the method's second value, so the
    /// generator is the only state.
    pub fn normal(&mut self) -> f64 {
        loop {
            let u = self.range(-1.0, 1.0);
            let v = self.range(-1.0, 1.0);
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                return u * (-2.0 * math::ln(s) / s).sqrt();
            }
        }
    }

    /// Returns two independent standard normal numbers for little more than the cost of one.
    pub fn normal_pair(&mut self) -> (f64, f64) {
        loop {
            let u = self.range(-1.0, 1.0);
            let v = self.range(-1.0, 1.0);
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                let k = (-2.0 * math::ln(s) / s).sqrt();
                return (u * k, v * k);
            }
        }
    }

    /// Returns three independent standard normal numbers.
    pub fn normal3(&mut self) -> [f64; 3] {
        [self.normal(), self.normal(), self.normal()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_streams_depend_only_on_seed_and_name() {
        let mut a = RandomStream::new(7, "gust");
        let mut b = RandomStream::new(7, "imu");
        assert_ne!(a.bits(), b.bits());
        assert_eq!(RandomStream::new(7, "gust").bits(), RandomStream::new(7, "gust").bits());
    }

    #[test]
    fn exact_normal_has_zero_mean_and_unit_variance() {
        const N: usize = 200_000;
        // Five standard errors of the mean and of the variance at N samples.
        const MEAN_TOLERANCE: f64 = 0.0112;
        const VARIANCE_TOLERANCE: f64 = 0.0159;
        let mut stream = RandomStream::new(1, "normal");
        let values: Vec<f64> = (0..N).map(|_| stream.normal()).collect();
        let mean = values.iter().sum::<f64>() / N as f64;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / N as f64;
        assert!(mean.abs() < MEAN_TOLERANCE, "mean {mean}");
        assert!((variance - 1.0).abs() < VARIANCE_TOLERANCE, "variance {variance}");
    }
}
