//! A bounded queue for password hashing. Each hash costs 19 MiB and some 50 ms of one core, and anyone who reaches the server can ask for one:
//! without a bound a flood of logins takes all memory and every thread that pages need.

use super::answer::Refusal;
use super::passwords::{self, Memory};
use super::state::lock;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Requests that hash or wait for their turn at once; each holds one of the server's threads (`server::WAITING_THREADS`), so this stays well
/// below their number.
const MOST_WAITING: usize = 6;
/// A refused client may try again after this, s.
const RETRY_AFTER_S: u64 = 2;

/// The queue and its working memory.
#[derive(Debug)]
pub struct Hashing {
    lanes: Vec<Mutex<Memory>>,
    next: AtomicUsize,
    waiting: AtomicUsize,
}

/// A place in the queue; leaving it is dropping it.
#[derive(Debug)]
pub struct Turn<'a>(&'a Hashing);

impl Default for Hashing {
    fn default() -> Self {
        // One core stays free for pages.
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let lanes = (cores / 2).clamp(1, 2);
        Self { lanes: (0..lanes).map(|_| Mutex::default()).collect(), next: AtomicUsize::new(0), waiting: AtomicUsize::new(0) }
    }
}

impl Hashing {
    /// Enters the queue.
    ///
    /// # Errors
    /// [`Refusal::Busy`] when the queue is full.
    pub fn enter(&self) -> Result<Turn<'_>, Refusal> {
        let enter = |waiting| (waiting < MOST_WAITING).then_some(waiting + 1);
        let entered = self.waiting.fetch_update(Ordering::AcqRel, Ordering::Acquire, enter);
        entered.map(|_| Turn(self)).map_err(|_| Refusal::Busy(RETRY_AFTER_S))
    }
}

impl Turn<'_> {
    fn with_memory<T>(&self, work: impl FnOnce(&mut Memory) -> T) -> T {
        let lane = self.0.next.fetch_add(1, Ordering::Relaxed) % self.0.lanes.len();
        work(&mut lock(&self.0.lanes[lane]))
    }

    /// Returns whether the password has this hash.
    pub fn fits(&self, password: &str, hash: Option<&str>) -> bool {
        self.with_memory(|memory| passwords::fits(password, hash, memory))
    }

    /// Returns the password's hash.
    ///
    /// # Errors
    /// When the system has no randomness.
    pub fn hash(&self, password: &str) -> Result<String, Refusal> {
        Ok(self.with_memory(|memory| passwords::hash(password, memory))?)
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.0.waiting.fetch_sub(1, Ordering::AcqRel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_a_full_queue_refuses_and_a_turn_that_ends_makes_room() {
        let hashing = Hashing::default();
        let mut turns: Vec<_> = (0..MOST_WAITING).map(|_| hashing.enter().unwrap()).collect();
        assert_eq!(hashing.enter().err(), Some(Refusal::Busy(RETRY_AFTER_S)));
        turns.pop();
        assert!(hashing.enter().is_ok());
    }
}
