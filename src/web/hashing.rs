//! Bounded queue for password hashing. Each hash costs 19 MiB and about 50 ms of one core, and anyone who can reach the
//! server can request one: without a limit, a flood of logins would exhaust the memory and the threads that serve
//! pages.

use super::lock::lock;
use super::passwords::{self, HashingMemory};
use super::response::WebError;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Maximum number of requests that are hashing or waiting at the same time. Each request occupies one of the server's
/// threads (`server::BLOCKING_THREADS`), so this maximum is well below the number of threads.
const MAX_QUEUED_REQUESTS: usize = 6;
/// Time after which a rejected client may retry, s.
const RETRY_AFTER_S: u64 = 2;

/// Hashing queue with its working memory.
#[derive(Debug)]
pub struct HashingQueue {
    memory_slots: Vec<Mutex<HashingMemory>>,
    next: AtomicUsize,
    waiting: AtomicUsize,
}

/// A slot in the queue, released when it is dropped.
#[derive(Debug)]
pub struct HashingSlot<'a>(&'a HashingQueue);

impl Default for HashingQueue {
    fn default() -> Self {
        // Leave one core free for serving pages.
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let memory_slots = (cores / 2).clamp(1, 2);
        Self {
            memory_slots: (0..memory_slots).map(|_| Mutex::default()).collect(),
            next: AtomicUsize::new(0),
            waiting: AtomicUsize::new(0),
        }
    }
}

impl HashingQueue {
    /// Reserves a slot in the queue.
    ///
    /// # Errors
    /// Returns [`WebError::Busy`] if the queue is full.
    pub fn acquire(&self) -> Result<HashingSlot<'_>, WebError> {
        let enter = |waiting| (waiting < MAX_QUEUED_REQUESTS).then_some(waiting + 1);
        let entered = self.waiting.fetch_update(Ordering::AcqRel, Ordering::Acquire, enter);
        entered.map(|_| HashingSlot(self)).map_err(|_| WebError::Busy(RETRY_AFTER_S))
    }
}

impl HashingSlot<'_> {
    fn with_memory<T>(&self, work: impl FnOnce(&mut HashingMemory) -> T) -> T {
        let lane = self.0.next.fetch_add(1, Ordering::Relaxed) % self.0.memory_slots.len();
        work(&mut lock(&self.0.memory_slots[lane]))
    }

    /// Returns true if the password matches the hash.
    pub fn verify(&self, password: &str, hash: Option<&str>) -> bool {
        self.with_memory(|memory| passwords::verify(password, hash, memory))
    }

    /// Returns the password's hash.
    ///
    /// # Errors
    /// Returns an error if the system's random number generator fails.
    pub fn hash(&self, password: &str) -> Result<String, WebError> {
        Ok(self.with_memory(|memory| passwords::hash(password, memory))?)
    }
}

impl Drop for HashingSlot<'_> {
    fn drop(&mut self) {
        self.0.waiting.fetch_sub(1, Ordering::AcqRel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_full_queue_rejects_until_a_slot_is_released() {
        let hashing = HashingQueue::default();
        let mut turns: Vec<_> = (0..MAX_QUEUED_REQUESTS).map(|_| hashing.acquire().unwrap()).collect();
        assert_eq!(hashing.acquire().err(), Some(WebError::Busy(RETRY_AFTER_S)));
        turns.pop();
        assert!(hashing.acquire().is_ok());
    }
}
