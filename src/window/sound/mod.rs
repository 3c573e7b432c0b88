//! Plays the sound of a flight, and speaks warnings.

mod inputs;
mod output;
mod speech;

use super::window_settings::sound_settings;
use inputs::{Inputs, lock_inputs};
use output::play;
use spandrel_clients::rc::keyboard::SoundPreferences;
use spandrel_view::sound::SoundInputs;
use std::sync::{Arc, Mutex};

/// The window's sound output. Its thread starts with the first sound.
pub struct AudioOutput {
    on: bool,
    started: bool,
    inputs: Arc<Mutex<Inputs>>,
}

impl AudioOutput {
    /// Creates the output.
    pub fn new(sounds: SoundPreferences) -> Self {
        let flight = SoundInputs { silent: true, ..SoundInputs::default() };
        let inputs = Arc::new(Mutex::new(Inputs { flight, settings: sound_settings(sounds), words: None }));
        Self { on: sounds.on, started: false, inputs }
    }

    /// Changes the settings, and turns sound on or off.
    pub fn set_preferences(&mut self, sounds: SoundPreferences) {
        lock_inputs(&self.inputs).settings = sound_settings(sounds);
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
        lock_inputs(&self.inputs).flight.silent = true;
    }

    /// Updates the inputs for sound synthesis.
    pub fn set(&mut self, heard: SoundInputs) {
        if !self.on {
            return;
        }
        lock_inputs(&self.inputs).flight = heard;
        if !self.started {
            self.started = true;
            let heard = Arc::downgrade(&self.inputs);
            std::thread::spawn(move || play(&heard));
        }
    }
}
