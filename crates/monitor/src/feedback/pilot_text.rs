//! Texts for the pilot and the per-rule rate limit.

use spandrel_model::time::SimTime;

/// A text for the pilot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PilotText {
    /// Cue bit of the rule that raised the text.
    pub cue: i32,
    /// Text of at most 50 bytes.
    pub text: String,
}

/// Rate limit for one rule's texts: after a text, no further text is sent until the interval has passed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Cooldown {
    last_sent: Option<SimTime>,
}

impl Cooldown {
    pub(super) fn rate_limited_text(
        &mut self,
        now: SimTime,
        interval: SimTime,
        cue: i32,
        message: impl FnOnce() -> String,
    ) -> Option<PilotText> {
        if self.last_sent.is_some_and(|said| now - said < interval) {
            return None;
        }
        self.last_sent = Some(now);
        Some(PilotText { cue, text: message() })
    }
}

#[cfg(test)]
mod tests {
    use spandrel_mavlink::contract::cue;
    use spandrel_mavlink::contract::guidance::{Detour, DetourKind, Guidance, GuidanceStep, WayTo};
    use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};
    use spandrel_text::Language;
    use spandrel_text::monitor_texts::{Warning, message_words};

    /// Panics unless German and Spanish have a text of their own, and the English one is as sent.
    fn assert_translated(sent: &str) {
        let [english, german, spanish] = Language::ALL.map(|language| message_words(sent, language).unwrap_or_default());
        assert_eq!(english, sent);
        assert!(german != sent && spanish != sent && german != spanish, "{sent}: {german}, {spanish}");
        assert!(!german.is_empty() && !spanish.is_empty(), "{sent}");
    }

    #[test]
    fn exact_every_text_of_the_contract_is_translated() {
        for (bit, _) in cue::ALL {
            let label = cue::label(bit).unwrap();
            let warning = Warning::of_text(label, Language::English, |name| name).unwrap();
            assert_eq!((warning.name.as_str(), warning.words.as_str()), (label, label));
            assert_translated(label);
        }
        for (task, target) in LessonTask::ALL.into_iter().flat_map(|task| [(task, 0.5), (task, -0.5), (task, 10.0)]) {
            let status =
                LessonStatus { task, step: 3, steps: 11, progress: 0.5, way: None, radius_m: None, target: Some(target) };
            assert_translated(&status.words());
        }
        let way = Some(WayTo { distance_m: 140.0, bearing_rad: -0.5, up_m: 12.0 });
        for (step, way) in GuidanceStep::ALL.into_iter().flat_map(|step| [(step, None), (step, way)]) {
            let guidance = Guidance {
                step,
                task: Some(2),
                way,
                progress: None,
                tasks_done: 1,
                tasks: 4,
                deviation: None,
                stand_off: None,
                flown_s: 75.0,
                needed_s: 480.0,
                detour: None,
            };
            assert_translated(&guidance.words());
            assert_translated(&Guidance { progress: Some(0.4), ..guidance }.words());
            for kind in DetourKind::ALL {
                let detour = Detour { kind, way: WayTo { distance_m: 12.0, bearing_rad: 0.5, up_m: 3.0 } };
                let guidance = Guidance { detour: Some(detour), ..guidance };
                assert_translated(&guidance.words());
                assert_translated(&guidance.detour_words().unwrap());
            }
        }
    }
}
