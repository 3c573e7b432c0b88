//! A small least-recently-used cache for resources that are expensive to recreate.

use std::collections::VecDeque;

/// Maximum number of cached values: enough for both views, before and after a layout change or window resize.
const CAPACITY: usize = 4;

/// The most recently used values, by key.
#[derive(Debug)]
pub struct LruCache<K, V> {
    /// Least recently used first.
    entries: VecDeque<(K, V)>,
}

impl<K: PartialEq, V> LruCache<K, V> {
    /// Creates an empty cache.
    pub fn new() -> Self {
        Self { entries: VecDeque::with_capacity(CAPACITY + 1) }
    }

    /// Removes and returns the value for a key.
    pub fn take(&mut self, key: &K) -> Option<V> {
        let at = self.entries.iter().position(|(known, _)| known == key)?;
        self.entries.remove(at).map(|(_, value)| value)
    }

    /// Inserts a value as the most recently used one and evicts the least recently used one if the cache is full.
    pub fn put(&mut self, key: K, value: V) {
        self.entries.retain(|(known, _)| *known != key);
        self.entries.push_back((key, value));
        if self.entries.len() > CAPACITY {
            self.entries.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_least_recently_used_entry_is_evicted_first() {
        let mut recent = LruCache::new();
        for size in 0..CAPACITY {
            recent.put(size, 'a');
        }
        // Uses the oldest entry again, so that the second-oldest entry is evicted next.
        let again = recent.take(&0).unwrap();
        recent.put(0, again);
        recent.put(CAPACITY, 'b');
        assert_eq!((recent.take(&1), recent.take(&0), recent.take(&CAPACITY)), (None, Some('a'), Some('b')));
        assert_eq!(recent.take(&0), None, "take must remove the entry");
    }

    #[test]
    fn exact_cache_size_is_bounded() {
        let mut recent = LruCache::new();
        for width in 0..1_000 {
            let made = recent.take(&width).unwrap_or(width);
            recent.put(width, made);
        }
        assert_eq!(recent.entries.len(), CAPACITY);
        recent.put(999, 0);
        assert_eq!((recent.entries.len(), recent.take(&999)), (CAPACITY, Some(0)), "a key must have one entry");
    }
}
