//! In-task feedback: one rule per file, all fed with the same [`FeedbackInput`], each answering whether its cue is on and what to say when
//! that begins. Thresholds come from the scenario. Everything runs on simulation time.

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

/// One task as the drone stands to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximity {
    /// l*, m.
    pub distance_m: f64,
    /// Threshold, m.
    pub threshold_m: f64,
    /// The task's own too-close distance, m.
    pub too_close_m: Option<f64>,
    /// Number for people.
    pub id: u32,
    /// Flying away from here ends the task: it has been flown, or the nearest point is an end of its path.
    pub may_leave: bool,
}

/// What the rules see, at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackInput {
    /// Simulation time.
    pub time: SimTime,
    /// Between lift-off and the end.
    pub in_session: bool,
    /// In the air (a standing drone is close to the ground and that is no news).
    pub airborne: bool,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Battery, %.
    pub battery_pct: Option<f64>,
    /// Nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Contact after the pad rule.
    pub contact: ContactKind,
    /// Name of what is touched, if the site knows.
    pub touched: Option<String>,
    /// All tasks.
    pub tasks: Vec<TaskProximity>,
    /// Task whose path the drone is on.
    pub current_task: Option<usize>,
    /// Task entered last.
    pub last: Option<usize>,
}

/// What to say, and how urgent it is: lower goes first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PilotText {
    /// Bit of the rule that says it.
    pub cue: i32,
    /// At most 50 bytes.
    pub text: String,
}

/// All rules.
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
    /// Rules with the scenario's thresholds.
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

    /// Runs all rules: the mask of cues that are on, and texts in order of urgency.
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

/// Text of a rule with a cool-down of its own: said when the cue begins, and not again within the interval.
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
