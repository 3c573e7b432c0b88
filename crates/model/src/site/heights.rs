//! Ground surface, triangulated over a square grid, with exact queries: height at a point, nearest point, first hit of
//! a ray. Outside the grid, the ground continues horizontally at the border heights.

use super::convex::SurfacePoint;
use super::nearest_points::{nearest_on_crease, nearest_on_triangle};
use crate::frames::{Enu, Vec3};
use crate::math;

/// Number of cells along each side of a block. Queries use the minimum and maximum heights of blocks to skip cells.
const BLOCK_CELLS: i64 = 8;
/// Number of blocks whose heights are compared with a ray before the ray is walked cell by cell.
const MAX_BLOCKS_TESTED: i64 = 36;
/// Maximum distance from the surface at which a point gets the triangle's normal, m.
const CONTACT_TOLERANCE_M: f64 = 1e-9;
/// Tolerance within which two distances count as equal, m.
const DISTANCE_TOLERANCE_M: f64 = 1e-7;
/// Maximum length of a ray, m; scenario files allow terrain up to 4 km wide.
const MAX_RAY_LENGTH_M: f64 = 20_000.0;

/// Heights at the corners of square grid cells, each split into two triangles from its southwest to its northeast corner.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightGrid {
    heights_m: Vec<f64>,
    side: usize,
    spacing_m: f64,
    origin_m: f64,
    blocks: Vec<(f64, f64)>,
    blocks_per_side: usize,
    highest_m: f64,
}

/// A grid cell: column and row of its southwest corner, and the heights of its four corners.
struct TerrainCell {
    column: i64,
    row: i64,
    sw: f64,
    se: f64,
    nw: f64,
    ne: f64,
}

impl TerrainCell {
    fn lowest(&self) -> f64 {
        self.sw.min(self.se).min(self.nw.min(self.ne))
    }

    fn highest(&self) -> f64 {
        self.sw.max(self.se).max(self.nw.max(self.ne))
    }

    /// Returns the slope per cell to the east and to the north of the triangle on the given side of the diagonal.
    fn slope(&self, south_east: bool) -> (f64, f64) {
        if south_east { (self.se - self.sw, self.ne - self.se) } else { (self.ne - self.nw, self.nw - self.sw) }
    }
}

/// Cell and distance where a ray continues after a skipped block.
struct RayPosition {
    column: i64,
    row: i64,
    t: f64,
}

/// Returns the distance along a ray to the point where it leaves a column or row of cells; infinity if the ray is
/// parallel to it.
fn exit_distance(cell: i64, from: f64, rate: f64) -> f64 {
    if rate == 0.0 { f64::INFINITY } else { ((cell + i64::from(rate > 0.0)) as f64 - from) / rate }
}

/// Returns the row or column of a ray after it has crossed all cell sides whose distance satisfies `before`.
fn advance_cell(mut cell: i64, from: f64, rate: f64, before: impl Fn(f64) -> bool) -> i64 {
    let forward = if rate > 0.0 { 1 } else { -1 };
    while before(exit_distance(cell, from, rate)) {
        cell += forward;
    }
    cell
}

impl HeightGrid {
    /// Creates the grid from heights in rows from south to north, each from west to east. The grid is centered on the scenario
    /// origin.
    ///
    /// # Panics
    /// Panics if there are fewer than four heights or if their number is not a square.
    #[must_use]
    pub fn new(heights_m: Vec<f64>, spacing_m: f64) -> Self {
        let side = heights_m.len().isqrt();
        assert!(side >= 2 && side * side == heights_m.len(), "{} heights do not form a square grid", heights_m.len());
        let highest_m = heights_m.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let origin_m = -0.5 * spacing_m * (side - 1) as f64;
        let blocks_per_side = (side - 1).div_ceil(BLOCK_CELLS as usize);
        let mut grid = Self { heights_m, side, spacing_m, origin_m, blocks: Vec::new(), blocks_per_side, highest_m };
        grid.blocks =
            (0..blocks_per_side * blocks_per_side).map(|k| grid.block_bounds(k / blocks_per_side, k % blocks_per_side)).collect();
        grid
    }

    fn block_bounds(&self, block_row: usize, block_column: usize) -> (f64, f64) {
        let span = |block: usize| block * BLOCK_CELLS as usize..=((block + 1) * BLOCK_CELLS as usize).min(self.side - 1);
        let heights =
            span(block_row).flat_map(|row| span(block_column).map(move |column| self.heights_m[row * self.side + column]));
        math::range(heights)
    }

    /// Returns the minimum and maximum heights of a block. Blocks outside the grid have the same heights as the nearest
    /// block inside.
    fn block_height_range(&self, row: i64, column: i64) -> (f64, f64) {
        let last = self.blocks_per_side as i64 - 1;
        self.blocks[row.clamp(0, last) as usize * self.blocks_per_side + column.clamp(0, last) as usize]
    }

    fn cell(&self, column: i64, row: i64) -> TerrainCell {
        let last = self.side as i64 - 1;
        let (west, east) = (column.clamp(0, last) as usize, (column + 1).clamp(0, last) as usize);
        let south = row.clamp(0, last) as usize * self.side;
        let north = (row + 1).clamp(0, last) as usize * self.side;
        let h = &self.heights_m;
        TerrainCell { column, row, sw: h[south + west], se: h[south + east], nw: h[north + west], ne: h[north + east] }
    }

    /// Converts a point to grid steps from the southwest corner.
    fn grid_position(&self, p: Vec3<Enu>) -> (f64, f64) {
        ((p.east() - self.origin_m) / self.spacing_m, (p.north() - self.origin_m) / self.spacing_m)
    }

    fn normal(&self, (east, north): (f64, f64)) -> Vec3<Enu> {
        Vec3::new(-east, -north, self.spacing_m).unit()
    }

    /// Returns the distance between two heights, m.
    #[must_use]
    pub fn spacing_m(&self) -> f64 {
        self.spacing_m
    }

    /// Checks whether a point is within the grid. Outside of it, the ground continues at the height of the edge.
    #[must_use]
    pub fn contains(&self, east_m: f64, north_m: f64) -> bool {
        let half_m = -self.origin_m;
        east_m.abs() <= half_m && north_m.abs() <= half_m
    }

    /// Returns the height and upward unit normal of the ground at a point.
    #[must_use]
    pub fn ground(&self, east_m: f64, north_m: f64) -> (f64, Vec3<Enu>) {
        let (x, y) = self.grid_position(Vec3::new(east_m, north_m, 0.0));
        let cell = self.cell(x.floor() as i64, y.floor() as i64);
        let (u, v) = (x - x.floor(), y - y.floor());
        let rise = cell.slope(u >= v);
        (cell.sw + u * rise.0 + v * rise.1, self.normal(rise))
    }

    /// Returns the nearest surface point within `max_m`. For a point below the ground, the distance is negative and the depth is
    /// not limited.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>, max_m: f64) -> Option<SurfacePoint> {
        let (height, normal) = self.ground(p.east(), p.north());
        let above = p.up() - height;
        if !above.is_finite() || above * normal.up() > MAX_RAY_LENGTH_M {
            return None;
        }
        let below = above < 0.0;
        // The ground directly above or below the point limits the search, because points farther away cannot be
        // nearest.
        let reach = if below { -above } else { above.min(max_m) };
        let mut best = (reach * reach, Vec3::new(p.east(), p.north(), height));
        let mut found = below || above <= max_m;
        self.search(p, &mut best, &mut found);
        if !found {
            return None;
        }
        let distance = (p - best.1).norm();
        let signed = if below { -distance } else { distance };
        let normal = if distance > CONTACT_TOLERANCE_M { (p - best.1) / signed } else { normal };
        Some(SurfacePoint { distance_m: signed, point_m: best.1, normal })
    }

    /// Returns true only if the ground is below `up_m` everywhere in a rectangle. May return false near the limit.
    #[must_use]
    pub fn is_below(&self, low: Vec3<Enu>, high: Vec3<Enu>, up_m: f64) -> bool {
        let ((west, south), (east, north)) = (self.grid_position(low), self.grid_position(high));
        (south.floor() as i64..=north.floor() as i64)
            .all(|row| (west.floor() as i64..=east.floor() as i64).all(|column| self.cell(column, row).highest() < up_m))
    }

    /// Returns the point on a crease of the ground that is nearest to a segment across a ridge, if it is nearer than `enough_m`
    /// and nearer than both ends of the segment. `ends_m` is the smaller distance of the two ends.
    #[must_use]
    pub fn interior_minimum(&self, a: Vec3<Enu>, b: Vec3<Enu>, ends_m: f64, enough_m: f64) -> Option<SurfacePoint> {
        let ((xa, ya), (xb, yb)) = (self.grid_position(a), self.grid_position(b));
        let reach = enough_m / self.spacing_m;
        let range = |a: f64, b: f64| ((a.min(b) - reach).floor() as i64)..=((a.max(b) + reach).floor() as i64 + 1);
        let mut nearest: Option<(f64, SurfacePoint)> = None;
        for row in range(ya, yb) {
            for column in range(xa, xb) {
                let cell = self.cell(column, row);
                let corner = |k: i64, l: i64, up: f64| {
                    let at = |n: i64| self.origin_m + n as f64 * self.spacing_m;
                    Vec3::new(at(column + k), at(row + l), up)
                };
                let sw = corner(0, 0, cell.sw);
                for to in [corner(1, 0, cell.se), corner(0, 1, cell.nw), corner(1, 1, cell.ne)] {
                    // Creases that the segment penetrates take precedence, the deepest first.
                    let (rank, near) = nearest_on_crease((a, b), (sw, to));
                    if near.distance_m.abs() > CONTACT_TOLERANCE_M && nearest.is_none_or(|n| rank < n.0) {
                        nearest = Some((rank, near));
                    }
                }
            }
        }
        nearest.map(|n| n.1).filter(|n| n.distance_m < enough_m.min(ends_m - DISTANCE_TOLERANCE_M))
    }

    fn search(&self, p: Vec3<Enu>, best: &mut (f64, Vec3<Enu>), found: &mut bool) {
        let (x, y) = self.grid_position(p);
        let reach = best.0.sqrt() / self.spacing_m;
        let range = |at: f64| ((at - reach).floor() as i64, (at + reach).floor() as i64);
        let ((west, east), (south, north)) = (range(x), range(y));
        for block_row in south.div_euclid(BLOCK_CELLS)..=north.div_euclid(BLOCK_CELLS) {
            for block_column in west.div_euclid(BLOCK_CELLS)..=east.div_euclid(BLOCK_CELLS) {
                let whole = (block_column * BLOCK_CELLS, block_row * BLOCK_CELLS, BLOCK_CELLS);
                if self.squared_distance_to_box(p, whole, self.block_height_range(block_row, block_column)) >= best.0 {
                    continue;
                }
                for row in (block_row * BLOCK_CELLS).max(south)..=(block_row * BLOCK_CELLS + BLOCK_CELLS - 1).min(north) {
                    for column in
                        (block_column * BLOCK_CELLS).max(west)..=(block_column * BLOCK_CELLS + BLOCK_CELLS - 1).min(east)
                    {
                        self.search_cell(p, &self.cell(column, row), best, found);
                    }
                }
            }
        }
    }

    /// Returns the squared distance from a point to the box over a square of cells (column, row, cells per side) between two
    /// heights.
    fn squared_distance_to_box(&self, p: Vec3<Enu>, (column, row, cells): (i64, i64, i64), (low, high): (f64, f64)) -> f64 {
        let west = self.origin_m + column as f64 * self.spacing_m;
        let south = self.origin_m + row as f64 * self.spacing_m;
        let side = cells as f64 * self.spacing_m;
        let outside = |at: f64, from: f64, to: f64| (from - at).max(at - to).max(0.0);
        let (e, n, u) =
            (outside(p.east(), west, west + side), outside(p.north(), south, south + side), outside(p.up(), low, high));
        e * e + n * n + u * u
    }

    fn search_cell(&self, p: Vec3<Enu>, cell: &TerrainCell, best: &mut (f64, Vec3<Enu>), found: &mut bool) {
        if self.squared_distance_to_box(p, (cell.column, cell.row, 1), (cell.lowest(), cell.highest())) >= best.0 {
            return;
        }
        let west = self.origin_m + cell.column as f64 * self.spacing_m;
        let south = self.origin_m + cell.row as f64 * self.spacing_m;
        let (east, north) = (west + self.spacing_m, south + self.spacing_m);
        let sw = Vec3::new(west, south, cell.sw);
        let ne = Vec3::new(east, north, cell.ne);
        for other in [Vec3::new(east, south, cell.se), Vec3::new(west, north, cell.nw)] {
            let q = nearest_on_triangle(p, sw, ne, other);
            let d = (p - q).norm_squared();
            if d < best.0 {
                *best = (d, q);
                *found = true;
            }
        }
    }

    /// Returns the distance along a ray to the ground and the normal there. A ray that starts below the ground hits at distance
    /// 0.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<(f64, Vec3<Enu>)> {
        let (height, normal) = self.ground(origin.east(), origin.north());
        if origin.up() <= height {
            return Some((0.0, normal));
        }
        // Only the part of the ray below the highest ground can hit.
        let to_top = (self.highest_m - origin.up()) / direction.up();
        let (start, end) = match (origin.up() > self.highest_m, direction.up() < 0.0) {
            (true, false) => return None,
            (true, true) => (to_top, max_m),
            (false, true) => (0.0, max_m),
            (false, false) => (0.0, if direction.up() > 0.0 { max_m.min(to_top) } else { max_m }),
        };
        let (start, end) = (start.max(0.0), end.min(MAX_RAY_LENGTH_M));
        // A nearly level ray can reach the maximum ground height so far away that cell indices would overflow.
        if start < end && !self.passes_above(origin, direction, start, end) {
            self.walk_cells(origin, direction, start, end)
        } else {
            None
        }
    }

    /// Returns true only if a ray is above all cells that it could test between two distances. May return false although it is.
    fn passes_above(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, start: f64, end: f64) -> bool {
        let up_m = |t: f64| origin.up() + direction.up() * t;
        let low_m = up_m(start).min(up_m(end));
        let (x, y) = self.grid_position(origin);
        let last = self.blocks_per_side as i64 - 1;
        let blocks = |from: f64, rate_m: f64| {
            let rate = rate_m / self.spacing_m;
            let (a, b) = (from + rate * start, from + rate * end);
            // Rounding can place the ray in a neighboring cell.
            let block = |at: f64| (at.floor() as i64).div_euclid(BLOCK_CELLS).clamp(0, last);
            (block(a.min(b) - 1.0), block(a.max(b) + 1.0))
        };
        let ((west, east), (south, north)) = (blocks(x, direction.east()), blocks(y, direction.north()));
        let is_lower = |row: i64| (west..=east).all(|column| self.block_height_range(row, column).1 < low_m);
        (east - west + 1) * (north - south + 1) <= MAX_BLOCKS_TESTED && (south..=north).all(is_lower)
    }

    /// Tests the cells below a ray in order, from distance `start` to `end`.
    fn walk_cells(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, start: f64, end: f64) -> Option<(f64, Vec3<Enu>)> {
        let (x0, y0) = self.grid_position(origin);
        let (dx, dy) = (direction.east() / self.spacing_m, direction.north() / self.spacing_m);
        let mut column = (x0 + dx * start).floor() as i64;
        let mut row = (y0 + dy * start).floor() as i64;
        let (mut next_x, mut next_y) = (exit_distance(column, x0, dx), exit_distance(row, y0, dy));
        let mut t = start;
        // A block that the ray does not pass above. It is not tested again for each of its cells.
        let mut low_block = None;
        while t < end {
            let block = (column.div_euclid(BLOCK_CELLS), row.div_euclid(BLOCK_CELLS));
            if low_block != Some(block) {
                if let Some(over) = self.skip_block((origin, direction), (x0, y0), (dx, dy), (column, row), (t, end)) {
                    if over.t >= end {
                        return None;
                    }
                    (column, row, t) = (over.column, over.row, over.t);
                    (next_x, next_y) = (exit_distance(column, x0, dx), exit_distance(row, y0, dy));
                    continue;
                }
                low_block = Some(block);
            }
            // Rounding can place the side of a cell slightly behind the current distance.
            let leave = next_x.min(next_y).min(end).max(t);
            let cell = self.cell(column, row);
            let low = (origin.up() + direction.up() * t).min(origin.up() + direction.up() * leave);
            if low <= cell.highest()
                && let Some(hit) = self.hit_in_cell(&cell, [x0, y0, origin.up()], [dx, dy, direction.up()], (t, leave))
            {
                return Some(hit);
            }
            if next_x <= next_y {
                column += if dx > 0.0 { 1 } else { -1 };
                next_x = exit_distance(column, x0, dx);
            } else {
                row += if dy > 0.0 { 1 } else { -1 };
                next_y = exit_distance(row, y0, dy);
            }
            t = leave;
        }
        None
    }

    /// Skips the rest of a block if the ray is entirely above its ground. The walk continues at the same cell as if it had tested
    /// every cell.
    fn skip_block(
        &self,
        (origin, direction): (Vec3<Enu>, Vec3<Enu>),
        from: (f64, f64),
        rate: (f64, f64),
        cell: (i64, i64),
        (t, end): (f64, f64),
    ) -> Option<RayPosition> {
        let block = (cell.0.div_euclid(BLOCK_CELLS), cell.1.div_euclid(BLOCK_CELLS));
        // The last cell of the block along one axis.
        let last = |block: i64, rate: f64| block * BLOCK_CELLS + if rate > 0.0 { BLOCK_CELLS - 1 } else { 0 };
        let (last_column, last_row) = (last(block.0, rate.0), last(block.1, rate.1));
        let (out_x, out_y) = (exit_distance(last_column, from.0, rate.0), exit_distance(last_row, from.1, rate.1));
        let leave = out_x.min(out_y).min(end).max(t);
        let low = (origin.up() + direction.up() * t).min(origin.up() + direction.up() * leave);
        if low <= self.block_height_range(block.1, block.0).1 {
            return None;
        }
        let forward = |rate: f64| if rate > 0.0 { 1 } else { -1 };
        let (column, row) = if out_x <= out_y {
            // If the ray passes through a corner, it crosses the eastern or western side first.
            (last_column + forward(rate.0), advance_cell(cell.1, from.1, rate.1, |side| side < out_x))
        } else {
            (advance_cell(cell.0, from.0, rate.0, |side| side <= out_y), last_row + forward(rate.1))
        };
        Some(RayPosition { column, row, t: leave })
    }

    /// Returns distance and normal at the first point between two distances where the ray is not above the cell's two
    /// triangles.
    fn hit_in_cell(
        &self,
        cell: &TerrainCell,
        from: [f64; 3],
        rate: [f64; 3],
        (enter, leave): (f64, f64),
    ) -> Option<(f64, Vec3<Enu>)> {
        let at = |t: f64| (from[0] + rate[0] * t - cell.column as f64, from[1] + rate[1] * t - cell.row as f64);
        let turn = rate[0] - rate[1];
        let (u, v) = at(0.0);
        let cross = if turn == 0.0 { enter } else { ((v - u) / turn).clamp(enter, leave) };
        for (a, b) in [(enter, cross), (cross, leave)] {
            let middle = at(0.5 * (a + b));
            let rise = cell.slope(middle.0 >= middle.1);
            let over = |t: f64| from[2] + rate[2] * t - (cell.sw + at(t).0 * rise.0 + at(t).1 * rise.1);
            let (first, last) = (over(a), over(b));
            if last <= 0.0 {
                let share = if first > 0.0 { first / (first - last) } else { 0.0 };
                return Some((a + (b - a) * share, self.normal(rise)));
            }
        }
        None
    }

    /// Returns the surface for export: vertex positions, row by row, and the vertex indices of each triangle, counterclockwise
    /// seen from above.
    #[must_use]
    pub fn triangles(&self) -> (Vec<Vec3<Enu>>, Vec<[u32; 3]>) {
        let along = |n: usize| self.origin_m + n as f64 * self.spacing_m;
        let corner = |(k, height): (usize, &f64)| Vec3::new(along(k % self.side), along(k / self.side), *height);
        let corners = self.heights_m.iter().enumerate().map(corner).collect();
        let n = self.side as u32;
        let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
        (corners, cells.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomStream;

    #[test]
    fn prop_rays_above_the_blocks_below_them_hit_no_cell() {
        // A valley of 96 x 96 cells with rough sides.
        let mut random = RandomStream::new(5, "valley");
        let height = |k: usize, noise: f64| 0.02 * (k as f64 % 97.0 - 48.0) * (k as f64 % 97.0 - 48.0) + noise;
        let grid = HeightGrid::new((0..97 * 97).map(|k| height(k, random.range(-2.0, 2.0))).collect(), 4.0);
        let mut skipped = 0;
        for _ in 0..20_000 {
            let origin = Vec3::new(random.range(-230.0, 230.0), random.range(-230.0, 230.0), random.range(0.0, 40.0));
            let direction = Vec3::new(random.normal(), random.normal(), 0.4 * random.normal()).unit();
            let end = random.range(1.0, 300.0);
            if grid.passes_above(origin, direction, 0.0, end) {
                skipped += 1;
                assert_eq!(grid.walk_cells(origin, direction, 0.0, end), None, "{origin:?} {direction:?} {end}");
            }
        }
        assert!(skipped > 200, "{skipped}");
    }
}
