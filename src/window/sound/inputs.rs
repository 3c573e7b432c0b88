//! Inputs of the sound thread.

use spandrel_view::sound::{SoundInputs, SoundSettings, SpokenWords};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Inputs of the sound.
#[derive(Debug, Clone)]
pub struct Inputs {
    /// Flight data that determines the sound.
    pub flight: SoundInputs,
    /// Sound settings.
    pub settings: SoundSettings,
    /// Words to speak; the output takes them.
    pub words: Option<Arc<SpokenWords>>,
}

/// Locks the inputs, which are valid even if a thread has panicked while holding the lock.
pub fn lock_inputs(heard: &Mutex<Inputs>) -> MutexGuard<'_, Inputs> {
    heard.lock().unwrap_or_else(PoisonError::into_inner)
}
