//! Feedback during the task, with one file per rule. Each rule processes the same [`FeedbackInput`] and returns whether its cue
//! is on and, when the cue turns on, a text. Thresholds come from the scenario. All times are simulation times.

pub mod battery;
pub mod crash;
pub mod off_path;
pub mod speed;
pub mod speeding;
pub mod texts;
pub mod too_close;

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;

/// Position of the drone relative to one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximity {
    /// Distance to the task's path (l*), m.
    pub distance_m: f64,
    /// On-path threshold of the task, m.
    pub threshold_m: f64,
    /// Clearance below which the drone is too close in this task, m; `None` for the scenario's value.
    pub too_close_m: Option<f64>,
    /// Number of the task in the scenario.
    pub id: u32,
    /// Whether the trainee may leave the task: its path was flown, or the nearest point is an end of the path.
    pub may_leave: bool,
}

/// Input of the feedback rules at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackInput {
    /// Simulation time at this instant.
    pub time: SimTime,
    /// Whether the session is running, from lift-off to its end.
    pub in_session: bool,
    /// Whether the drone is airborne. Proximity warnings are suppressed on the ground.
    pub airborne: bool,
    /// Magnitude of the velocity, m/s.
    pub speed_m_s: f64,
    /// Remaining battery charge, 0 to 100 %.
    pub battery_pct: Option<f64>,
    /// Distance to the nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Kind of object in contact, after touchdowns on the pad are removed.
    pub contact: ContactKind,
    /// Name of the object in contact, if the site provides one.
    pub touched: Option<String>,
    /// Proximity to each task, in scenario order.
    pub tasks: Vec<TaskProximity>,
    /// Index of the task whose path the drone is on, if any.
    pub current_task: Option<usize>,
    /// Index of the last task entered, if any.
    pub last: Option<usize>,
}

/// A text for the pilot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PilotText {
    /// Cue bit of the rule that raised the text.
    pub cue: i32,
    /// Text of at most 50 bytes.
    pub text: String,
}

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

    /// Updates all rules. Returns the mask of active cues, and the texts with the most urgent first.
    pub fn update(&mut self, moment: &FeedbackInput) -> (i32, Vec<PilotText>) {
        let mut mask = 0;
        let mut texts = Vec::new();
        let mut put = |(bits, text): (i32, Option<PilotText>)| {
            mask |= bits;
            texts.extend(text);
        };
        put(self.crash.update(moment, &self.limits));
        put(self.too_close.update(moment, &self.limits));
        put(self.speeding.update(moment, self.speed_limit_m_s, &self.limits));
        put(self.off_path.update(moment, &self.limits));
        put(self.battery.update(moment, &self.limits));
        (mask, texts)
    }
}

/// Rate limit for a rule's texts: after a text, none is sent until the interval has passed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct CoolDown {
    last_sent: Option<SimTime>,
}

impl CoolDown {
    pub(super) fn cue_text(
        &mut self,
        now: SimTime,
        interval: SimTime,
        cue: i32,
        words: impl FnOnce() -> String,
    ) -> Option<PilotText> {
        if self.last_sent.is_some_and(|said| now - said < interval) {
            return None;
        }
        self.last_sent = Some(now);
        Some(PilotText { cue, text: words() })
    }
}
