//! Locks of shared state.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// A lock whose holder broke off is as good as new: what it guards is whole between two statements.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
