//! In-task feedback: one rule per file, all fed with the same [`Moment`], each answering whether its cue is on and what to say when
//! that begins. Thresholds come from the scenario. Everything runs on simulation time.

pub mod battery;
pub mod crash;
pub mod off_path;
pub mod speed;
pub mod speeding;
pub mod texts;
pub mod too_close;

use spandrel_mavlink::contract::contact::Contact;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;

/// One task as the drone stands to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskNow {
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
pub struct Moment {
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
    pub contact: Contact,
    /// Name of what is touched, if the site knows.
    pub touched: Option<String>,
    /// All tasks.
    pub tasks: Vec<TaskNow>,
    /// Task whose path the drone is on.
    pub on: Option<usize>,
    /// Task entered last.
    pub last: Option<usize>,
}

/// What to say, and how urgent it is: lower goes first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text {
    /// Bit of the rule that says it.
    pub cue: i32,
    /// At most 50 bytes.
    pub words: String,
}

/// All rules.
#[derive(Debug, Clone)]
pub struct Feedback {
    speed_limit_m_s: f64,
    limits: spandrel_model::scenario::Feedback,
    battery: battery::Battery,
    speeding: speeding::Speeding,
    off_path: off_path::OffPath,
    too_close: too_close::TooClose,
    crash: crash::Crash,
}

impl Feedback {
    /// Rules with the scenario's thresholds.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            speed_limit_m_s: scenario.scoring.speed_limit_m_s,
            limits: scenario.feedback.clone(),
            battery: battery::Battery::default(),
            speeding: speeding::Speeding::default(),
            off_path: off_path::OffPath::default(),
            too_close: too_close::TooClose::default(),
            crash: crash::Crash::default(),
        }
    }

    /// Runs all rules: the mask of cues that are on, and texts in order of urgency.
    pub fn see(&mut self, moment: &Moment) -> (i32, Vec<Text>) {
        let mut mask = 0;
        let mut texts = Vec::new();
        let mut put = |(bits, text): (i32, Option<Text>)| {
            mask |= bits;
            texts.extend(text);
        };
        put(self.crash.see(moment, &self.limits));
        put(self.too_close.see(moment, &self.limits));
        put(self.speeding.see(moment, self.speed_limit_m_s, &self.limits));
        put(self.off_path.see(moment, &self.limits));
        put(self.battery.see(moment, &self.limits));
        (mask, texts)
    }
}

/// Text of a rule with a cool-down of its own: said when the cue begins, and not again within the interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct CoolDown {
    said: Option<SimTime>,
}

impl CoolDown {
    pub(super) fn say(&mut self, now: SimTime, interval: SimTime, cue: i32, words: impl FnOnce() -> String) -> Option<Text> {
        if self.said.is_some_and(|said| now - said < interval) {
            return None;
        }
        self.said = Some(now);
        Some(Text { cue, words: words() })
    }
}
