//! In-flight feedback, with one file per rule. Every rule processes the same [`FeedbackInput`]. It returns whether its
//! cue is on and, when the cue turns on, a text. Thresholds come from the scenario. All times are simulation times.

pub mod active_task;
pub mod battery;
pub mod crash;
mod delayed_cue;
pub mod direction;
mod input;
pub mod off_path;
mod pilot_text;
pub mod speeding;
pub mod stand_off;
pub mod texts;
pub mod too_close;

pub use input::{FeedbackInput, HeadingOffset, SurfaceDistance, TaskProximity};
pub use pilot_text::PilotText;

use spandrel_model::scenario::{FeedbackThresholds, Scenario, ScoringParams};

/// All feedback rules.
#[derive(Debug, Clone)]
pub struct FeedbackRules {
    scoring: ScoringParams,
    limits: FeedbackThresholds,
    active_task: active_task::ActiveTask,
    current: Option<usize>,
    battery: battery::BatteryCue,
    speeding: speeding::SpeedingCue,
    stand_off: stand_off::StandOffCue,
    off_path: off_path::OffPathCue,
    too_close: too_close::TooCloseCue,
    crash: crash::CrashCue,
}

impl FeedbackRules {
    /// Creates the rules with the scenario's thresholds.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            scoring: scenario.scoring.clone(),
            limits: scenario.feedback.clone(),
            active_task: active_task::ActiveTask::default(),
            current: None,
            battery: battery::BatteryCue::default(),
            speeding: speeding::SpeedingCue::default(),
            stand_off: stand_off::StandOffCue::default(),
            off_path: off_path::OffPathCue::default(),
            too_close: too_close::TooCloseCue::default(),
            crash: crash::CrashCue::default(),
        }
    }

    /// Returns the index of the task that is being flown; `None` between tasks.
    #[must_use]
    pub fn current_task(&self) -> Option<usize> {
        self.current
    }

    /// Updates all rules and returns the active cue mask and the texts to send, most urgent first.
    pub fn update(&mut self, input: &FeedbackInput) -> (i32, Vec<PilotText>) {
        self.current = self.active_task.update(input, &self.limits);
        let task = self.current.map(|task| &input.tasks[task]);
        let mut mask = 0;
        let mut texts = Vec::new();
        let mut put = |(bits, text): (i32, Option<PilotText>)| {
            mask |= bits;
            texts.extend(text);
        };
        put(self.crash.update(input, &self.limits));
        put(self.too_close.update(input, &self.limits));
        put(self.speeding.update(input, task, &self.scoring, &self.limits));
        put(self.stand_off.update(input, task, &self.limits));
        put(self.off_path.update(input, task, &self.limits));
        put(self.battery.update(input, &self.limits));
        (mask, texts)
    }
}
