//! Crash: the onset of any contact, with what was hit. Said at once and before all else; a chatter of onsets is said once.

use super::{CoolDown, Moment, Text};
use spandrel_mavlink::contract::contact::Contact;
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::Feedback;
use spandrel_model::time::SimTime;

/// The cue stays this long after the last contact (estimate: time to read it).
const SHOWN_FOR: SimTime = SimTime::from_ms(2_000);
/// Onsets this close together are one bump (docs/src/reference/assessment.md, "Certification": contacts less than a second
/// apart).
const SAME_BUMP: SimTime = SimTime::from_ms(1_000);

/// The rule.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Crash {
    before: Contact,
    last: Option<SimTime>,
    cool_down: CoolDown,
}

impl Crash {
    /// Cue and text at one instant.
    pub fn see(&mut self, moment: &Moment, _limits: &Feedback) -> (i32, Option<Text>) {
        let contact = if moment.in_session { moment.contact } else { Contact::None };
        let worse = contact.severity() > self.before.severity();
        self.before = contact;
        // A person or a vehicle is no chatter of the bump before.
        if worse && matches!(contact, Contact::Person | Contact::Vehicle) {
            self.cool_down = CoolDown::default();
        }
        if contact != Contact::None {
            self.last = Some(moment.time);
        }
        let words = || {
            let what = moment.touched.as_deref().unwrap_or(contact.word());
            format!("Crash: {what}").chars().take(50).collect()
        };
        let text = worse.then(|| self.cool_down.say(moment.time, SAME_BUMP, cue::CRASH, words)).flatten();
        let shown = self.last.is_some_and(|last| moment.time - last < SHOWN_FOR);
        (if shown { cue::CRASH } else { 0 }, text)
    }
}
