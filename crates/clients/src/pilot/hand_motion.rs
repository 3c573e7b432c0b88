//! Motor response of the pilot's hands: lag, noise proportional to the deflection, and attention lapses, during which
//! the sticks do not move.

use super::perception::DriftProcess;
use super::skill::Skill;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;

/// Neuromuscular lag, s (docs/src/reference/domain.md, "Human operators").
const NEUROMUSCULAR_LAG_S: f64 = 0.1;
/// Motor noise of a trained pilot as a fraction of the deflection (-25 dB, docs/src/reference/domain.md, "Human
/// operators").
const PROPORTIONAL_NOISE: f64 = 0.056;
/// Tremor of a trained pilot around the stick center (estimate).
const TREMOR_AMPLITUDE: f64 = 0.006;
/// Correlation time of the motor noise, s (estimate).
const NOISE_TAU_S: f64 = 0.25;
/// Shortest and longest duration of a lapse, s (estimate).
const LAPSE_DURATION_S: (f64, f64) = (1.0, 3.0);

/// Stick axes in [-1, 1]: forward, right, up, yaw.
pub type StickAxes = [f64; 4];

/// State of the motor response.
#[derive(Debug, Clone, PartialEq)]
pub struct HandMotion {
    random: RandomStream,
    noise: [DriftProcess; 4],
    out: StickAxes,
    lapse_until: SimTime,
}

impl HandMotion {
    /// Creates the state with centered sticks.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed, "pilot hand");
        let noise = [(); 4].map(|()| DriftProcess::new(NOISE_TAU_S, &mut random));
        Self { random, noise, out: [0.0; 4], lapse_until: SimTime::ZERO }
    }

    /// Checks whether an attention lapse is active.
    #[must_use]
    pub fn is_lapsed(&self, now: SimTime) -> bool {
        now < self.lapse_until
    }

    /// Moves the sticks toward `wanted` and returns the axes in [-1, 1].
    pub fn step(&mut self, wanted: StickAxes, skill: &Skill, now: SimTime, dt_s: f64) -> StickAxes {
        let lapse = self.random.uniform() < skill.lapses_per_min / 60.0 * dt_s;
        if lapse && !self.is_lapsed(now) {
            self.lapse_until = now + SimTime::from_s(self.random.range(LAPSE_DURATION_S.0, LAPSE_DURATION_S.1));
        }
        // Self-centering sticks that the pilot has let go of do not move.
        let released = wanted.iter().all(|axis| axis.abs() < 1e-9);
        let skilled_noise = if released { 0.0 } else { skill.noise };
        let follow = 1.0 - math::exp(-dt_s / NEUROMUSCULAR_LAG_S);
        for (axis, target) in wanted.iter().enumerate() {
            let drift = self.noise[axis].step(dt_s, &mut self.random);
            if now < self.lapse_until {
                continue;
            }
            let noisy = target + drift * skilled_noise * (PROPORTIONAL_NOISE * target.abs() + TREMOR_AMPLITUDE);
            self.out[axis] += follow * (noisy.clamp(-1.0, 1.0) - self.out[axis]);
        }
        self.out
    }

    /// Centers the sticks.
    pub fn release(&mut self) {
        self.out = [0.0; 4];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_released_sticks_center_without_tremor() {
        // After 40 time constants, nothing of the deflection is left.
        let mut hand = HandMotion::new(1);
        let steady = Skill { lapses_per_min: 0.0, ..Skill::NOVICE };
        let held = hand.step([0.5; 4], &steady, SimTime::from_ms(0), 0.5);
        assert!(held.iter().all(|axis| *axis > 0.3));
        let released = hand.step([0.0; 4], &steady, SimTime::from_ms(20), 40.0 * NEUROMUSCULAR_LAG_S);
        assert!(released.iter().all(|axis| axis.abs() < 1e-12), "{released:?}");
    }

    #[test]
    fn exact_lapse_freezes_the_sticks() {
        let mut hand = HandMotion::new(1);
        let dreamer = Skill { lapses_per_min: 6000.0, ..Skill::TRAINED };
        let frozen = hand.step([0.5; 4], &dreamer, SimTime::from_ms(0), 0.02);
        let first = hand.step([0.5; 4], &dreamer, SimTime::from_ms(20), 0.02);
        assert!(hand.is_lapsed(SimTime::from_ms(40)));
        assert_eq!(first, hand.step([-1.0; 4], &dreamer, SimTime::from_ms(40), 0.02));
        assert!(frozen.iter().all(|a| a.abs() < 0.5));
    }
}
