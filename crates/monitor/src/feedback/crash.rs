//! Crash cue, raised at first contact. Its text names the object that was hit and takes priority over all other texts.
//! Contacts in quick succession produce only one text.

use super::input::FeedbackInput;
use super::pilot_text::{Cooldown, PilotText};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::FeedbackThresholds;
use spandrel_model::time::SimTime;

/// How long the cue stays on after the last contact (estimate: long enough to read it).
const CUE_HOLD_TIME: SimTime = SimTime::from_ms(2_000);
/// Contacts within this interval count as one crash (docs/src/reference/assessment.md, "Certification": contacts less than a
/// second apart).
const SAME_CRASH_INTERVAL: SimTime = SimTime::from_ms(1_000);

/// Crash rule.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrashCue {
    previous_contact: ContactKind,
    last_contact_time: Option<SimTime>,
    cooldown: Cooldown,
}

impl CrashCue {
    /// Updates the rule and returns the cue bits and any text to send.
    pub fn update(&mut self, input: &FeedbackInput, _limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let contact = if input.in_session { input.contact } else { ContactKind::None };
        let worse = contact.severity() > self.previous_contact.severity();
        self.previous_contact = contact;
        // A collision with a person or vehicle always produces a separate text.
        if worse && matches!(contact, ContactKind::Person | ContactKind::Vehicle) {
            self.cooldown = Cooldown::default();
        }
        if contact != ContactKind::None {
            self.last_contact_time = Some(input.time);
        }
        let message = || {
            let what = input.contact_name.as_deref().unwrap_or(contact.label());
            format!("Crash: {what}").chars().take(50).collect()
        };
        let text = worse.then(|| self.cooldown.rate_limited_text(input.time, SAME_CRASH_INTERVAL, cue::CRASH, message)).flatten();
        let shown = self.last_contact_time.is_some_and(|last| input.time - last < CUE_HOLD_TIME);
        (if shown { cue::CRASH } else { 0 }, text)
    }
}
