//! In-flight feedback, with one file per rule. Every rule processes the same [`FeedbackInput`]. It returns whether its
//! cue is on and, when the cue turns on, a text. Thresholds come from the scenario. All times are simulation times.

pub mod battery;
pub mod crash;
mod input;
pub mod off_path;
mod pilot_text;
pub mod speed;
pub mod speeding;
pub mod texts;
pub mod too_close;

pub use input::{FeedbackInput, TaskProximity};
pub use pilot_text::PilotText;

use spandrel_model::scenario::Scenario;

/// All feedback rules.
#[derive(Debug, Clone)]
pub struct FeedbackRules {
    speed_limit_m_s: f64,
    limits: spandrel_model::scenario::FeedbackThresholds,
    battery: battery::BatteryCue,
    speeding: speeding::SpeedingCue,
    off_path: off_path::OffPathCue,
    too_close: too_close::TooCloseCue,
    crash: crash::CrashCue,
}

impl FeedbackRules {
    /// Creates the rules with the scenario's thresholds.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            speed_limit_m_s: scenario.scoring.speed_limit_m_s,
            limits: scenario.feedback.clone(),
            battery: battery::BatteryCue::default(),
            speeding: speeding::SpeedingCue::default(),
            off_path: off_path::OffPathCue::default(),
            too_close: too_close::TooCloseCue::default(),
            crash: crash::CrashCue::default(),
        }
    }

    /// Updates all rules and returns the active cue mask and the texts to send, most urgent first.
    pub fn update(&mut self, input: &FeedbackInput) -> (i32, Vec<PilotText>) {
        let mut mask = 0;
        let mut texts = Vec::new();
        let mut put = |(bits, text): (i32, Option<PilotText>)| {
            mask |= bits;
            texts.extend(text);
        };
        put(self.crash.update(input, &self.limits));
        put(self.too_close.update(input, &self.limits));
        put(self.speeding.update(input, self.speed_limit_m_s, &self.limits));
        put(self.off_path.update(input, &self.limits));
        put(self.battery.update(input, &self.limits));
        (mask, texts)
    }
}
