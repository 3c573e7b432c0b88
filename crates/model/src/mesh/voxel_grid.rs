//! Cubic cells of one size in a box, each of them solid or empty.

/// Bits of a block of 2 x 2 x 2 cells: x counts once, y twice, z four times.
type Block = u8;

/// Cells of one size. The outermost layer is always empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct VoxelGrid {
    /// Number of cells along x, y and z, with the outermost layer.
    size: [usize; 3],
    bits: Vec<u64>,
}

impl VoxelGrid {
    /// Creates a grid of empty cells; `size` is without the outermost layer.
    pub(super) fn new(size: [usize; 3]) -> Self {
        let size = size.map(|count| count + 2);
        let count: usize = size.iter().product();
        Self { size, bits: vec![0; count.div_ceil(64)] }
    }

    /// Returns the index of a cell; the first one inside of the outermost layer is 1, 1, 1.
    pub(super) const fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Returns the cell with an index.
    pub(super) const fn cell(&self, index: usize) -> [usize; 3] {
        [index % self.size[0], index / self.size[0] % self.size[1], index / self.size[0] / self.size[1]]
    }

    /// Returns the distance of the indices of neighbors along x, y and z.
    pub(super) const fn steps(&self) -> [usize; 3] {
        [1, self.size[0], self.size[0] * self.size[1]]
    }

    /// Returns whether a cell is solid.
    pub(super) fn is_solid(&self, index: usize) -> bool {
        self.bits[index / 64] >> (index % 64) & 1 == 1
    }

    /// Makes a cell solid.
    pub(super) fn fill(&mut self, index: usize) {
        self.bits[index / 64] |= 1 << (index % 64);
    }

    /// Returns the indices of all solid cells in ascending order.
    pub(super) fn solid(&self) -> impl Iterator<Item = usize> {
        self.bits.iter().enumerate().filter(|(_, word)| **word != 0).flat_map(|(k, word)| {
            let word = *word;
            (0..64).filter(move |bit| word >> bit & 1 == 1).map(move |bit| 64 * k + bit)
        })
    }

    /// Makes further cells solid until solid cells never touch in an edge or a corner only, and neither do empty ones, so that the surface
    /// has two sides at each of its edges. Returns their number.
    pub(super) fn fill_contacts(&mut self) -> usize {
        let is_bad: Vec<bool> = (0..=Block::MAX).map(|block| bad_contact(block).is_some()).collect();
        let steps = self.steps();
        let mut waiting: Vec<usize> = self.solid().collect();
        let mut filled = 0;
        while let Some(index) = waiting.pop() {
            for corner in 0..8 {
                let offset = |bits: usize| (0..3).filter(|axis| bits >> axis & 1 == 1).map(|axis| steps[axis]).sum::<usize>();
                let first = index - offset(corner);
                let block = (0..8).fold(0, |block, k| block | Block::from(self.is_solid(first + offset(k))) << k);
                if let Some(cell) = is_bad[usize::from(block)].then(|| bad_contact(block)).flatten() {
                    let added = first + offset(cell);
                    self.fill(added);
                    waiting.extend([added, index]);
                    filled += 1;
                }
            }
        }
        filled
    }

    /// Makes all empty cells solid that nothing connects with the outside. Returns their number.
    pub(super) fn fill_voids(&mut self) -> usize {
        let count: usize = self.size.iter().product();
        let steps = self.steps();
        let mut outside = Self { size: self.size, bits: vec![0; self.bits.len()] };
        outside.fill(0);
        let mut waiting: Vec<u32> = vec![0];
        while let Some(index) = waiting.pop().map(|index| index as usize) {
            let cell = self.cell(index);
            for axis in 0..3 {
                let below = (cell[axis] > 0).then(|| index - steps[axis]);
                let above = (cell[axis] + 1 < self.size[axis]).then(|| index + steps[axis]);
                for next in below.into_iter().chain(above) {
                    if !self.is_solid(next) && !outside.is_solid(next) {
                        outside.fill(next);
                        waiting.push(next as u32);
                    }
                }
            }
        }
        let mut filled = 0;
        for index in 0..count {
            if !self.is_solid(index) && !outside.is_solid(index) {
                self.fill(index);
                filled += 1;
            }
        }
        filled
    }
}

/// Returns an empty cell of a block to make solid if solid or empty cells touch in an edge or a corner only; `None` if none do.
fn bad_contact(block: Block) -> Option<usize> {
    let is_solid = |k: usize| block >> k & 1 == 1;
    for axis in 0..3 {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        for side in [0, 1 << axis] {
            match [side, side + u, side + v, side + u + v].map(is_solid) {
                [true, false, false, true] => return Some(side + u),
                [false, true, true, false] => return Some(side),
                _ => {}
            }
        }
    }
    // Two opposite corners, which no face of the block contains both.
    (0..4).find_map(|corner| {
        let pair = 1 << corner | 1 << (7 - corner);
        if block == pair {
            Some(corner ^ 1)
        } else if block == !pair {
            Some(corner)
        } else {
            None
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(size: [usize; 3], cells: &[[usize; 3]]) -> VoxelGrid {
        let mut grid = VoxelGrid::new(size);
        for cell in cells {
            grid.fill(grid.index(*cell));
        }
        grid
    }

    #[test]
    fn exact_a_void_is_filled_and_an_opening_is_not() {
        let shell = |is_open: bool| {
            let cells = (0..125).map(|k| [k % 5 + 1, k / 5 % 5 + 1, k / 25 + 1]);
            let is_wall = |cell: &[usize; 3]| cell.iter().any(|k| [1, 5].contains(k)) && !(is_open && *cell == [3, 3, 5]);
            grid([5, 5, 5], &cells.filter(is_wall).collect::<Vec<_>>())
        };
        assert_eq!(shell(false).fill_voids(), 27);
        assert_eq!(shell(true).fill_voids(), 0);
    }

    #[test]
    fn exact_contacts_in_an_edge_or_a_corner_are_filled() {
        for (cells, added) in [
            (vec![[1, 1, 1], [2, 2, 1]], 1),
            (vec![[1, 1, 1], [2, 2, 2]], 2),
            (vec![[1, 1, 1], [2, 1, 1]], 0),
            (vec![[1, 1, 1], [3, 1, 1]], 0),
        ] {
            assert_eq!(grid([4, 4, 4], &cells).fill_contacts(), added, "{cells:?}");
        }
    }

    #[test]
    fn exact_no_block_has_a_bad_contact_after_the_repair() {
        for block in 0..=Block::MAX {
            let cells = (0..8).filter(|k| block >> k & 1 == 1).map(|k| [2 + (k & 1), 2 + (k >> 1 & 1), 2 + (k >> 2)]);
            let mut own = grid([5, 5, 5], &cells.collect::<Vec<_>>());
            own.fill_contacts();
            let steps = own.steps();
            for first in 0..own.size.iter().product::<usize>() - steps.iter().sum::<usize>() {
                let at = |k: usize| first + (0..3).filter(|axis| k >> axis & 1 == 1).map(|axis| steps[axis]).sum::<usize>();
                let found = (0..8).fold(0, |bits, k| bits | Block::from(own.is_solid(at(k))) << k);
                assert_eq!(bad_contact(found), None, "{block:#b} at {first}");
            }
        }
    }
}
