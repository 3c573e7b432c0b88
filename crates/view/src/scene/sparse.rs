//! Adaptive triangulation of a square grid: larger squares where the ground is nearly flat, single cells elsewhere,
//! without gaps.

/// A square of cells, given by the column and row of its southwest corner and the cells per side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GridSquare {
    /// Column of the southwest corner.
    pub column: usize,
    /// Row of the southwest corner.
    pub row: usize,
    /// Cells per side.
    pub size: usize,
}

impl GridSquare {
    /// Returns the indices of the corners in a grid with `side` vertices per row: southwest, southeast, northeast,
    /// northwest.
    #[must_use]
    pub const fn corners(&self, side: usize) -> [usize; 4] {
        let (low, high) = (self.row * side + self.column, (self.row + self.size) * side + self.column);
        [low, low + self.size, high + self.size, high]
    }

    fn quarters(&self) -> [Self; 4] {
        let half = self.size / 2;
        [(0, 0), (half, 0), (0, half), (half, half)].map(|(x, y)| Self { column: self.column + x, row: self.row + y, size: half })
    }

    /// Returns the grid vertices on the boundary, counterclockwise from the southwest.
    fn boundary(&self, side: usize) -> impl Iterator<Item = usize> {
        let [sw, se, ne, nw] = self.corners(side);
        let along = move |k: usize| [sw + k, se + k * side, ne - k, nw - k * side];
        let size = self.size;
        (0..4).flat_map(move |edge| (0..size).map(move |k| along(k)[edge]))
    }
}

/// Returns the triangles of a grid with `side` vertices per row. The triangles are lists of vertex indices,
/// counterclockwise as seen from above. Squares of up to `largest` cells (a power of two) stay whole where `whole`
/// returns true. The diagonal runs from southwest to northeast, as in single cells.
#[must_use]
pub fn triangles(side: usize, largest: usize, whole: &dyn Fn(&GridSquare) -> bool) -> Vec<[u32; 3]> {
    let cells = side.saturating_sub(1);
    let largest = (0..).map(|k| largest >> k).find(|size| *size <= 1 || cells.is_multiple_of(*size)).unwrap_or(1).max(1);
    let starts = (0..cells).step_by(largest);
    let mut open: Vec<GridSquare> =
        starts.clone().flat_map(|row| starts.clone().map(move |column| GridSquare { column, row, size: largest })).collect();
    let mut squares = Vec::new();
    while let Some(square) = open.pop() {
        if square.size == 1 || whole(&square) { squares.push(square) } else { open.extend(square.quarters()) }
    }
    let mut used = vec![false; side * side];
    for corner in squares.iter().flat_map(|square| square.corners(side)) {
        used[corner] = true;
    }
    squares.iter().flat_map(|square| square_triangles(square, side, &used)).collect()
}

/// Returns the triangles of a square: two, or a fan around its center if smaller neighbors have vertices on its
/// boundary.
fn square_triangles(square: &GridSquare, side: usize, used: &[bool]) -> Vec<[u32; 3]> {
    let boundary: Vec<u32> = square.boundary(side).filter(|corner| used[*corner]).map(|corner| corner as u32).collect();
    if let [sw, se, ne, nw] = *boundary {
        return vec![[sw, se, ne], [sw, ne, nw]];
    }
    let middle = ((square.row + square.size / 2) * side + square.column + square.size / 2) as u32;
    (0..boundary.len()).map(|k| [middle, boundary[k], boundary[(k + 1) % boundary.len()]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Returns a grid that is subdivided only around one corner.
    fn locally_refined_grid(side: usize) -> Vec<[u32; 3]> {
        triangles(side, 8, &|square| square.column + square.row > 6 + 2 * square.size)
    }

    #[test]
    fn exact_triangles_cover_the_grid_once() {
        const SIDE: usize = 41;
        let twice_area = |[a, b, c]: [u32; 3]| {
            let at = |k: u32| (f64::from(k % SIDE as u32), f64::from(k / SIDE as u32));
            let ((ax, ay), (bx, by), (cx, cy)) = (at(a), at(b), at(c));
            (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        };
        let all = locally_refined_grid(SIDE);
        assert!(all.len() < 2 * 40 * 40 / 8, "{} triangles", all.len());
        assert!(all.iter().all(|t| twice_area(*t) > 0.0), "all triangles must face up");
        assert_eq!(all.iter().map(|t| twice_area(*t)).sum::<f64>(), 2.0 * 40.0 * 40.0);
    }

    #[test]
    fn exact_edges_have_no_gaps() {
        const SIDE: usize = 41;
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for [a, b, c] in locally_refined_grid(SIDE) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        // Inside the grid, every edge is used in both directions; only boundary edges are used once.
        let boundary = |k: u32| [0, 40].contains(&(k % SIDE as u32)) || [0, 40].contains(&(k / SIDE as u32));
        for ((a, b), sum) in edges {
            assert!(sum == 0 || (boundary(a) && boundary(b)), "edge {a} {b}: {sum}");
        }
    }

    #[test]
    fn exact_odd_grid_uses_smaller_squares() {
        let flat = |side: usize| triangles(side, 8, &|_| true).len();
        assert_eq!((flat(9), flat(13), flat(8), flat(2)), (2, 2 * 9, 2 * 49, 2));
    }
}
