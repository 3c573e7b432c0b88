//! Crash cue: raised at the onset of any contact, with the name of the object hit. Its text precedes all others; onsets in quick
//! succession produce one text.

use super::input::FeedbackInput;
use super::pilot_text::{CoolDown, PilotText};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::FeedbackThresholds;
use spandrel_model::time::SimTime;

/// The cue stays on for this long after the last contact (estimate: time to read it).
const SHOWN_FOR: SimTime = SimTime::from_ms(2_000);
/// Onsets within this interval count as one crash (docs/src/reference/assessment.md, "Certification": contacts less than a second
/// apart).
const SAME_BUMP: SimTime = SimTime::from_ms(1_000);

/// The crash rule.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrashCue {
    before: ContactKind,
    last: Option<SimTime>,
    cool_down: CoolDown,
}

impl CrashCue {
    /// Updates the rule and returns the cue bits and a text, if one is due.
    pub fn update(&mut self, moment: &FeedbackInput, _limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let contact = if moment.in_session { moment.contact } else { ContactKind::None };
        let worse = contact.severity() > self.before.severity();
        self.before = contact;
        // Contact with a person or a vehicle always gets its own text.
        if worse && matches!(contact, ContactKind::Person | ContactKind::Vehicle) {
            self.cool_down = CoolDown::default();
        }
        if contact != ContactKind::None {
            self.last = Some(moment.time);
        }
        let words = || {
            let what = moment.touched.as_deref().unwrap_or(contact.label());
            format!("Crash: {what}").chars().take(50).collect()
        };
        let text = worse.then(|| self.cool_down.cue_text(moment.time, SAME_BUMP, cue::CRASH, words)).flatten();
        let shown = self.last.is_some_and(|last| moment.time - last < SHOWN_FOR);
        (if shown { cue::CRASH } else { 0 }, text)
    }
}
