//! Speaks warnings with a system program.

use super::inputs::Inputs;
use spandrel_text::Language;
use spandrel_view::sound::{ActiveAlarms, spoken};
use std::process::{Child, Command, Stdio};

/// Programs that speak their last argument, with their options for a language tag.
const SPEECH_PROGRAMS: [(&str, &str); 2] = [("spd-say", "-l"), ("espeak-ng", "-v")];

/// Returns the language tag of the voice.
const fn voice(language: Language) -> &'static str {
    match language {
        Language::English | Language::Pseudo => Language::English.tag(),
        Language::German | Language::Spanish => language.tag(),
    }
}

/// Speaks new warnings, one at a time.
#[derive(Default)]
pub struct SpeechVoice {
    /// True once no program for speech was found.
    is_missing: bool,
    alarms: ActiveAlarms,
    speaking: Option<Child>,
}

impl SpeechVoice {
    /// Speaks a warning that has become active, unless the previous one is still being spoken.
    pub fn update_inputs(&mut self, (now, settings): &Inputs) {
        let alarms = if now.silent { ActiveAlarms::default() } else { now.alarms };
        let words = spoken(std::mem::replace(&mut self.alarms, alarms), alarms, &now.cue_texts, now.style);
        let busy = self.speaking.as_mut().is_some_and(|child| matches!(child.try_wait(), Ok(None)));
        let (Some(words), true, false) = (words, settings.speech && !self.is_missing, busy) else { return };
        let started = SPEECH_PROGRAMS.iter().find_map(|(name, option)| {
            let mut command = Command::new(name);
            command.args([option, voice(now.style.language), &words]);
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
        });
        if started.is_none() {
            self.is_missing = true;
            tracing::warn!(
                "no spoken warnings: none of {} is installed (on Debian and Ubuntu, run apt-get install espeak-ng)",
                SPEECH_PROGRAMS.map(|(name, _)| name).join(", ")
            );
        }
        self.speaking = started;
    }
}
