//! Plays sound samples with one system program and speaks warnings with another. Building with a sound library would
//! require system headers.

use super::window_settings::sound_settings;
use crate::io::clock::Stopwatch;
use spandrel_clients::rc::keyboard::SoundPreferences;
use spandrel_text::Language;
use spandrel_view::sound::{FlightSound, SAMPLE_RATE_HZ, SoundInputs, SoundSettings, spoken};
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Programs that play 16-bit samples from standard input, in order of preference: PulseAudio or PipeWire, then ALSA.
const PLAYERS: [(&str, &[&str]); 2] = [
    ("pacat", &["--playback", "--raw", "--format=s16le", "--channels=1", "--rate=24000", "--latency-msec=60"]),
    ("aplay", &["-q", "-t", "raw", "-f", "S16_LE", "-c", "1", "-r", "24000", "--buffer-time=120000"]),
];
/// Programs that speak their last argument, with their options for a language tag.
const SPEECH_PROGRAMS: [(&str, &str); 2] = [("spd-say", "-l"), ("espeak-ng", "-v")];
/// Number of samples per chunk (10 ms).
const SAMPLES_PER_CHUNK: usize = SAMPLE_RATE_HZ as usize / 100;
/// Playback lead time (estimate). A longer time delays the sound; a shorter time causes dropouts on a busy machine.
const PLAYBACK_LEAD_TIME: Duration = Duration::from_millis(80);
/// Interval at which the thread checks whether the player needs another chunk.
const CHUNK_INTERVAL: Duration = Duration::from_millis(5);

/// Inputs of the sound thread.
type Inputs = (SoundInputs, SoundSettings);

/// The window's sound output. Its thread starts with the first sound.
pub struct AudioOutput {
    on: bool,
    started: bool,
    inputs: Arc<Mutex<Inputs>>,
}

impl AudioOutput {
    /// Creates the output.
    pub fn new(sounds: SoundPreferences) -> Self {
        let silent = SoundInputs { silent: true, ..SoundInputs::default() };
        let inputs = Arc::new(Mutex::new((silent, sound_settings(sounds))));
        Self { on: sounds.on, started: false, inputs }
    }

    /// Changes the settings, and turns sound on or off.
    pub fn set_preferences(&mut self, sounds: SoundPreferences) {
        lock_inputs(&self.inputs).1 = sound_settings(sounds);
        self.set_on(sounds.on);
    }

    /// Returns true if sound is on.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Turns sound on or off.
    pub fn set_on(&mut self, on: bool) {
        self.on = on;
        if !on {
            self.silence();
        }
    }

    /// Mutes the output until the inputs are updated again.
    pub fn silence(&self) {
        lock_inputs(&self.inputs).0.silent = true;
    }

    /// Updates the inputs for sound synthesis.
    pub fn set(&mut self, heard: SoundInputs) {
        if !self.on {
            return;
        }
        lock_inputs(&self.inputs).0 = heard;
        if !self.started {
            self.started = true;
            let heard = self.inputs.clone();
            std::thread::spawn(move || play(&heard));
        }
    }
}

fn lock_inputs(heard: &Mutex<Inputs>) -> MutexGuard<'_, Inputs> {
    heard.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Plays sound until the window is closed, using the first player that works.
fn play(heard: &Arc<Mutex<Inputs>>) {
    let mut tried = Vec::new();
    for (name, args) in PLAYERS {
        match play_with(name, args, heard) {
            Ok(()) => return,
            Err(why) => tried.push(format!("{name}: {why}")),
        }
    }
    tracing::warn!(
        "no sound ({}); on Debian and Ubuntu, install pulseaudio-utils or alsa-utils; everything else works",
        tried.join("; ")
    );
    speak(heard);
}

/// Speaks warnings until the window is closed. Speech does not need a player.
fn speak(heard: &Arc<Mutex<Inputs>>) {
    let mut voice = SpeechVoice::default();
    while Arc::strong_count(heard) > 1 {
        voice.update_inputs(&lock_inputs(heard).clone());
        std::thread::sleep(CHUNK_INTERVAL);
    }
}

/// Plays until the window is closed.
///
/// # Errors
/// Returns an error if this player does not work.
fn play_with(name: &str, args: &[&str], heard: &Arc<Mutex<Inputs>>) -> std::io::Result<()> {
    let mut command = Command::new(name);
    let mut player = command.args(args).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let Some(mut stdin) = player.stdin.take() else { return Err(std::io::ErrorKind::BrokenPipe.into()) };
    let (mut sound, mut voice) = (FlightSound::default(), SpeechVoice::default());
    let (watch, mut made) = (Stopwatch::start(), Duration::ZERO);
    while Arc::strong_count(heard) > 1 {
        let now = lock_inputs(heard).clone();
        voice.update_inputs(&now);
        sound.set_settings(now.1);
        sound.set(now.0);
        // If the computer has stalled, skip the missed sound instead of catching up.
        made = made.max(watch.elapsed());
        while made < watch.elapsed() + PLAYBACK_LEAD_TIME {
            if stdin.write_all(&next_chunk(&mut sound)).is_err() {
                return Err(std::io::Error::other(format!("it exited ({})", player.wait()?)));
            }
            made += Duration::from_secs_f64(SAMPLES_PER_CHUNK as f64 / f64::from(SAMPLE_RATE_HZ));
        }
        std::thread::sleep(CHUNK_INTERVAL);
    }
    drop(stdin);
    // The player finishes its buffer and exits.
    player.wait().map(|_| ())
}

fn next_chunk(sound: &mut FlightSound) -> Vec<u8> {
    let mut samples = [0.0_f32; SAMPLES_PER_CHUNK];
    sound.fill(&mut samples);
    samples.iter().flat_map(|sample| ((sample * f32::from(i16::MAX)) as i16).to_le_bytes()).collect()
}

/// Returns the language tag of the voice.
const fn voice(language: Language) -> &'static str {
    match language {
        Language::English | Language::Pseudo => Language::English.tag(),
        Language::German | Language::Spanish => language.tag(),
    }
}

/// Speaks new warnings, one at a time.
#[derive(Default)]
struct SpeechVoice {
    /// True once no program for speech was found.
    is_missing: bool,
    cues: i32,
    speaking: Option<Child>,
}

impl SpeechVoice {
    fn update_inputs(&mut self, (now, settings): &Inputs) {
        let cues = if now.silent { 0 } else { now.cues };
        let words = spoken(std::mem::replace(&mut self.cues, cues), cues, &now.cue_texts, now.style);
        let busy = self.speaking.as_mut().is_some_and(|child| matches!(child.try_wait(), Ok(None)));
        let (Some(words), true, false) = (words, settings.speech && !self.is_missing, busy) else { return };
        let started = SPEECH_PROGRAMS.iter().find_map(|(name, option)| {
            let mut command = Command::new(name);
            command
                .args([option, voice(now.style.language)])
                .arg(&words)
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .ok()
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
