//! Inputs of the sound thread.

use spandrel_view::sound::{SoundInputs, SoundSettings};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Flight data that determines the sound, and the sound settings.
pub type Inputs = (SoundInputs, SoundSettings);

/// Locks the inputs, which are valid even if a thread has panicked while holding the lock.
pub fn lock_inputs(heard: &Mutex<Inputs>) -> MutexGuard<'_, Inputs> {
    heard.lock().unwrap_or_else(PoisonError::into_inner)
}
