//! Speaks warnings. espeak-ng synthesizes them, and the window plays them among its other sounds; if only Speech Dispatcher is
//! installed, it plays them itself.

use super::inputs::{Inputs, lock_inputs};
use spandrel_text::Language;
use spandrel_view::sound::{ActiveAlarms, SpokenWords, spoken};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, Weak};
use std::thread::JoinHandle;

/// Program that writes spoken words as a WAV file, and program that plays them.
const SYNTHESIZER: &str = "espeak-ng";
const SPEAKER: &str = "spd-say";

/// Returns the language tag of the voice.
const fn voice(language: Language) -> &'static str {
    match language {
        Language::English | Language::Pseudo => Language::English.tag(),
        Language::German | Language::Spanish => language.tag(),
    }
}

/// Progress of the last words.
#[derive(Debug)]
enum Progress {
    /// They are being synthesized.
    Synthesis(JoinHandle<Option<SpokenWords>>),
    /// The window plays them, as long as they exist.
    Playback(Weak<SpokenWords>),
    /// The other program plays them.
    OtherProgram(Child),
}

/// Speaks new warnings, one at a time.
#[derive(Debug, Default)]
pub struct SpeechVoice {
    /// True once the synthesizer has failed.
    has_failed: bool,
    /// True once no program for speech was found.
    is_missing: bool,
    alarms: ActiveAlarms,
    progress: Option<Progress>,
}

impl SpeechVoice {
    /// Speaks a warning that has become active, unless the previous one is still being spoken. Without an audio device, words
    /// are discarded, because they would be late when there is one.
    pub fn update(&mut self, inputs: &Mutex<Inputs>, has_device: bool) {
        let mut now = lock_inputs(inputs);
        self.progress = self.progress.take().and_then(|progress| self.advance(progress, &mut now));
        if !has_device {
            now.words = None;
        }
        let alarms = if now.flight.silent { ActiveAlarms::default() } else { now.flight.alarms };
        let words = spoken(std::mem::replace(&mut self.alarms, alarms), alarms, &now.flight.cue_texts, now.flight.style);
        let (speech, language) = (now.settings.speech, now.flight.style.language);
        // Starting a program takes longer than the output can wait.
        drop(now);
        if let (Some(words), true, None, false) = (words, speech, &self.progress, self.is_missing) {
            let synthesis = if self.has_failed { None } else { synthesize(&words, language) };
            self.progress = synthesis.or_else(|| play(&words, language));
            self.is_missing = self.progress.is_none();
            if self.is_missing {
                tracing::warn!(
                    "no spoken warnings: neither {SYNTHESIZER} nor {SPEAKER} is installed (on Debian and Ubuntu, run apt-get install espeak-ng)"
                );
            }
        }
    }

    /// Hands finished words to the output. Returns `None` after they have been spoken.
    fn advance(&mut self, progress: Progress, now: &mut Inputs) -> Option<Progress> {
        match progress {
            Progress::Synthesis(thread) if thread.is_finished() => {
                let Some(words) = thread.join().ok().flatten() else {
                    self.has_failed = true;
                    tracing::warn!("{SYNTHESIZER} cannot speak: run it in a terminal to see why");
                    return None;
                };
                let words = Arc::new(words);
                let playback = Progress::Playback(Arc::downgrade(&words));
                now.words = Some(words);
                Some(playback)
            }
            Progress::Playback(words) if words.strong_count() == 0 => None,
            Progress::OtherProgram(mut child) => match child.try_wait() {
                Ok(None) => Some(Progress::OtherProgram(child)),
                Ok(Some(_)) | Err(_) => None,
            },
            Progress::Synthesis(_) | Progress::Playback(_) => Some(progress),
        }
    }
}

/// Starts the synthesizer; `None` if it is not installed.
fn synthesize(words: &str, language: Language) -> Option<Progress> {
    let mut command = Command::new(SYNTHESIZER);
    command.args(["--stdout", "-v", voice(language), "--", words]);
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
    Some(Progress::Synthesis(std::thread::spawn(move || read_wav(&child.wait_with_output().ok()?.stdout))))
}

/// Starts the program that plays the words itself; `None` if it is not installed.
fn play(words: &str, language: Language) -> Option<Progress> {
    let mut command = Command::new(SPEAKER);
    command.args(["-w", "-l", voice(language), "--", words]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok().map(Progress::OtherProgram)
}

/// Returns the words in a WAV file with one channel of 16-bit samples; `None` if it is none.
fn read_wav(bytes: &[u8]) -> Option<SpokenWords> {
    let mut wav = hound::WavReader::new(bytes).ok()?;
    let rate_hz = wav.spec().sample_rate;
    // In a pipe, the length in the file's head is unknown, so the samples end where the bytes end.
    let samples: Vec<f32> =
        wav.samples::<i16>().map_while(Result::ok).map(|sample| f32::from(sample) / -f32::from(i16::MIN)).collect();
    (wav.spec().channels == 1 && !samples.is_empty()).then(|| SpokenWords::new(samples, rate_hz))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a WAV file of unknown length, as a synthesizer writes it to a pipe.
    fn piped_wav(samples: &[i16]) -> Vec<u8> {
        let spec =
            hound::WavSpec { channels: 1, sample_rate: 22_050, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
        let mut file = std::io::Cursor::new(Vec::new());
        let mut writer = hound::WavWriter::new(&mut file, spec).unwrap();
        samples.iter().for_each(|sample| writer.write_sample(*sample).unwrap());
        writer.finalize().unwrap();
        let mut bytes = file.into_inner();
        bytes[40..44].copy_from_slice(&0x7fff_f000_u32.to_le_bytes());
        bytes
    }

    #[test]
    fn exact_words_of_unknown_length_end_with_their_bytes() {
        let words = read_wav(&piped_wav(&[0, i16::MIN, 16_384])).unwrap();
        assert_eq!(words, SpokenWords::new(vec![0.0, -1.0, 0.5], 22_050));
        assert_eq!(read_wav(b"no sound"), None);
        assert_eq!(read_wav(&piped_wav(&[])), None);
    }
}
