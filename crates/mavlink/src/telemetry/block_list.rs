//! An append-only list that never moves its rows. A growing vector would briefly need memory for two copies of a flight
//! during each reallocation.

/// Number of rows per block.
const ROWS_PER_BLOCK: usize = 1_024;

/// Rows in insertion order.
#[derive(Debug, Clone)]
pub struct BlockList<T> {
    /// Blocks of rows. All except the last are full.
    blocks: Vec<Vec<T>>,
}

impl<T> Default for BlockList<T> {
    fn default() -> Self {
        Self { blocks: Vec::new() }
    }
}

impl<T> BlockList<T> {
    /// Appends a row without moving existing rows.
    pub fn push(&mut self, row: T) {
        match self.blocks.last_mut() {
            Some(block) if block.len() < ROWS_PER_BLOCK => block.push(row),
            _ => {
                let mut block = Vec::with_capacity(ROWS_PER_BLOCK);
                block.push(row);
                self.blocks.push(block);
            }
        }
    }

    /// Returns an iterator over all rows in order.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.blocks.iter().flatten()
    }
}

impl<T> Extend<T> for BlockList<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, rows: I) {
        rows.into_iter().for_each(|row| self.push(row));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_rows_keep_their_order_and_address() {
        let mut rows = BlockList::default();
        rows.push(0);
        let first: *const usize = rows.iter().next().unwrap();
        rows.extend(1..3 * ROWS_PER_BLOCK + 1);
        assert!(rows.iter().copied().eq(0..3 * ROWS_PER_BLOCK + 1));
        assert_eq!(rows.iter().next().unwrap() as *const usize, first);
    }
}
