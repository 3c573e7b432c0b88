//! An append-only list that never moves its rows. A growing vector would briefly need memory for two copies of a flight whenever
//! it reallocates.

/// Number of rows per block.
const BLOCK: usize = 1_024;

/// Rows in the order in which they were added.
#[derive(Debug, Clone)]
pub struct Rows<T> {
    /// Blocks of rows. All except the last one are full.
    blocks: Vec<Vec<T>>,
}

impl<T> Default for Rows<T> {
    fn default() -> Self {
        Self { blocks: Vec::new() }
    }
}

impl<T> Rows<T> {
    /// Appends a row without moving the others.
    pub fn push(&mut self, row: T) {
        match self.blocks.last_mut() {
            Some(block) if block.len() < BLOCK => block.push(row),
            _ => {
                let mut block = Vec::with_capacity(BLOCK);
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

impl<T> Extend<T> for Rows<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, rows: I) {
        rows.into_iter().for_each(|row| self.push(row));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_rows_keep_their_order_and_never_move() {
        let mut rows = Rows::default();
        rows.push(0);
        let first: *const usize = rows.iter().next().unwrap();
        rows.extend(1..3 * BLOCK + 1);
        assert!(rows.iter().copied().eq(0..3 * BLOCK + 1));
        assert_eq!(rows.iter().next().unwrap() as *const usize, first);
    }
}
