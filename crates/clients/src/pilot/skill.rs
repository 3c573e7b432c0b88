//! Human operator model with five skill parameters. Errors result from these parameters; none are scripted.

use std::str::FromStr;

/// Skill parameters of a pilot. Sources: docs/src/reference/domain.md, "Human operators" (crossover model by McRuer;
/// gaze of drone pilots 1.5 s ahead, n = 21).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skill {
    /// Delay from an event to the control response, s.
    pub delay_s: f64,
    /// Gain of the position and heading loops, relative to the trained pilot.
    pub gain: f64,
    /// Noise of perception and motor control, relative to the trained pilot. Also scales the smallest defect that the
    /// pilot notices.
    pub noise: f64,
    /// Visual preview time, s.
    pub preview_s: f64,
    /// Attention lapses per minute; during a lapse, the sticks do not move.
    pub lapses_per_min: f64,
}

/// One of the five skill parameters; used to swap a single parameter between pilots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkillFactor {
    /// Selects [`Skill::delay_s`].
    Delay,
    /// Selects [`Skill::gain`].
    Gain,
    /// Selects [`Skill::noise`].
    Noise,
    /// Selects [`Skill::preview_s`].
    Preview,
    /// Selects [`Skill::lapses_per_min`].
    Lapses,
}

impl SkillFactor {
    /// All five factors.
    pub const ALL: [Self; 5] = [Self::Delay, Self::Gain, Self::Noise, Self::Preview, Self::Lapses];
}

impl FromStr for SkillFactor {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "delay" => Ok(Self::Delay),
            "gain" => Ok(Self::Gain),
            "noise" => Ok(Self::Noise),
            "preview" => Ok(Self::Preview),
            "lapses" => Ok(Self::Lapses),
            other => Err(format!("unknown factor '{other}' (allowed: delay, gain, noise, preview, lapses)")),
        }
    }
}

impl Skill {
    /// A beginner: slow, cautious, noisy, with a short preview, and easily distracted (lapses: estimate; other values
    /// from the sources given at [`Skill`]).
    pub const NOVICE: Self = Self { delay_s: 0.35, gain: 0.6, noise: 2.0, preview_s: 0.7, lapses_per_min: 0.5 };
    /// A pilot after training.
    pub const TRAINED: Self = Self { delay_s: 0.22, gain: 1.0, noise: 1.0, preview_s: 1.5, lapses_per_min: 0.1 };
    /// A professional pilot.
    pub const EXPERT: Self = Self { delay_s: 0.18, gain: 1.0, noise: 0.7, preview_s: 1.5, lapses_per_min: 0.02 };

    /// Returns this skill with one parameter replaced by that of `from`.
    #[must_use]
    pub fn with(mut self, factor: SkillFactor, from: Self) -> Self {
        match factor {
            SkillFactor::Delay => self.delay_s = from.delay_s,
            SkillFactor::Gain => self.gain = from.gain,
            SkillFactor::Noise => self.noise = from.noise,
            SkillFactor::Preview => self.preview_s = from.preview_s,
            SkillFactor::Lapses => self.lapses_per_min = from.lapses_per_min,
        }
        self
    }

    /// Returns the defect length, in mm, that is detected with a probability of 50%: 26 for the trained pilot (Campbell
    /// et al. 2020), 15 for the expert, and 60 for the novice (docs/src/reference/domain.md, "Human operators"). A
    /// power law in the noise parameter fits these values within 10%.
    #[must_use]
    pub fn median_length_mm(&self) -> f64 {
        26.0 * spandrel_model::math::pow(self.noise, 1.3)
    }
}

impl FromStr for Skill {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "novice" => Ok(Self::NOVICE),
            "trained" => Ok(Self::TRAINED),
            "expert" => Ok(Self::EXPERT),
            other => Err(format!("unknown skill '{other}' (allowed: novice, trained, expert)")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_replacing_all_factors_turns_a_novice_into_an_expert() {
        let gifted = SkillFactor::ALL.into_iter().fold(Skill::NOVICE, |pilot, factor| pilot.with(factor, Skill::EXPERT));
        assert_eq!(gifted, Skill::EXPERT);
    }
}
