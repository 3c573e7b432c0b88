//! Precomputed tiles for the cheaper presets. One texture contains several slow patterns of ground or concrete, so one
//! lookup replaces four or five noise lookups. The tiles repeat after [`GROUND_TILE_SIZE_M`] and [`CONCRETE_TILE_SIZE_M`]; the
//! `lean` shader reads them.

use spandrel_model::random::RandomStream;

/// Texels per side.
pub const SIDE_TEXELS: usize = 1024;
/// Side of the ground tile, m.
pub const GROUND_TILE_SIZE_M: f64 = 32.0;
/// Side of the concrete tile, m: an integer multiple of the board width and length.
pub const CONCRETE_TILE_SIZE_M: f64 = 38.4;
/// Width and length of formwork boards, m (as in the `surface` shader).
const BOARD_SIZE_M: (f64, f64) = (0.16, 2.4);
/// Side of a cell that may contain bird droppings, m. The shader uses 1.7; here the cells must divide the tile evenly.
const DROPPINGS_CELL_SIZE_M: f64 = 1.6;
/// Fraction of cells with droppings, and radius of the droppings, m.
const DROPPINGS: (f64, f64) = (0.07, 0.045);

/// A tile and its mipmaps, finest first: side and four bytes per texel.
pub type MipLevels = Vec<(usize, Vec<u8>)>;

/// One pattern of the tile in row-major order.
type TilePattern = Vec<f32>;

/// Returns noise with the given numbers of cells across and down in the first octave; each subsequent octave has twice
/// the frequency and half the amplitude. The mean is about 0.5.
fn noise(stream: &mut RandomStream, (columns, rows): (usize, usize), octaves: u32) -> TilePattern {
    let mut field = vec![0.5; SIDE_TEXELS * SIDE_TEXELS];
    for octave in 0..octaves {
        let (columns, rows) = (columns << octave, rows << octave);
        let lattice: Vec<f32> = (0..columns * rows).map(|_| stream.uniform() as f32 - 0.5).collect();
        add(&mut field, &lattice, (columns, rows), 0.5 / f32::from(1u16 << octave));
    }
    field
}

/// Returns the interpolation positions of the texels between lattice corners: previous corner, next corner, smoothed
/// fraction.
fn interpolation_corners(cells: usize) -> Vec<(usize, usize, f32)> {
    let of = |k: usize| {
        let at = k as f32 * cells as f32 / SIDE_TEXELS as f32;
        let t = at - at.floor();
        let cell = at as usize % cells;
        (cell, (cell + 1) % cells, t * t * (3.0 - 2.0 * t))
    };
    (0..SIDE_TEXELS).map(of).collect()
}

fn add(field: &mut TilePattern, lattice: &[f32], (columns, rows): (usize, usize), share: f32) {
    let across = interpolation_corners(columns);
    for ((above, below, t), line) in interpolation_corners(rows).into_iter().zip(field.chunks_exact_mut(SIDE_TEXELS)) {
        let (above, below) = (&lattice[above * columns..][..columns], &lattice[below * columns..][..columns]);
        let row: Vec<f32> = above.iter().zip(below).map(|(a, b)| share * (a + (b - a) * t)).collect();
        for (texel, (left, right, t)) in line.iter_mut().zip(&across) {
            *texel += row[*left] + (row[*right] - row[*left]) * t;
        }
    }
}

fn step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the ground tile: patches two meters wide, blocks of rock, rock strata, fine detail.
#[must_use]
pub fn ground() -> MipLevels {
    let mut stream = RandomStream::new(0, "view.tiles.ground");
    let (near, block) = (noise(&mut stream, (16, 16), 5), noise(&mut stream, (26, 26), 5));
    let (straight, fine) = (noise(&mut stream, (4, 22), 4), noise(&mut stream, (128, 128), 3));
    // The rock strata waver by about a meter.
    let bed = |k: usize| {
        let shift = (30.0 * (near[k] - 0.5)) as i64;
        let row = ((k / SIDE_TEXELS) as i64 + shift).rem_euclid(SIDE_TEXELS as i64) as usize;
        straight[row * SIDE_TEXELS + k % SIDE_TEXELS]
    };
    levels(SIDE_TEXELS, (0..SIDE_TEXELS * SIDE_TEXELS).map(|k| [near[k], block[k], bed(k), fine[k]].map(byte)).collect())
}

/// Returns the concrete tile: tone around 0.5 (blotches and boards), and fractions of rain streaks, soot, and bird
/// droppings.
#[must_use]
pub fn concrete() -> MipLevels {
    let mut stream = RandomStream::new(0, "view.tiles.concrete");
    let (blotch, streak) = (noise(&mut stream, (17, 17), 5), noise(&mut stream, (119, 9), 3));
    let soot = noise(&mut stream, (7, 7), 5);
    let (lengths, boards) = (whole(CONCRETE_TILE_SIZE_M / BOARD_SIZE_M.1), whole(CONCRETE_TILE_SIZE_M / BOARD_SIZE_M.0));
    let board: Vec<f32> = (0..lengths * boards).map(|_| stream.uniform() as f32 - 0.5).collect();
    let bird_droppings = bird_droppings(&mut stream);
    let texel = |k: usize| {
        let (x, row) = ((k % SIDE_TEXELS) as f64 / SIDE_TEXELS as f64, (k / SIDE_TEXELS) * boards / SIDE_TEXELS);
        // Joints are offset in every other row of boards.
        let shift = if row % 2 == 1 { 0.37 } else { 0.0 };
        let length = (x * lengths as f64 + shift) as usize % lengths;
        let tone = 0.5 + 0.55 * (blotch[k] - 0.5) + 0.07 * board[row * lengths + length];
        [tone, step(0.52, 0.78, streak[k]), step(0.6, 0.8, soot[k]), bird_droppings[k]].map(byte)
    };
    levels(SIDE_TEXELS, (0..SIDE_TEXELS * SIDE_TEXELS).map(texel).collect())
}

fn whole(x: f64) -> usize {
    x.round() as usize
}

/// Returns white droppings, elongated downward.
fn bird_droppings(stream: &mut RandomStream) -> TilePattern {
    let mut field = vec![0.0; SIDE_TEXELS * SIDE_TEXELS];
    let (cells, texel_m) = (whole(CONCRETE_TILE_SIZE_M / DROPPINGS_CELL_SIZE_M), CONCRETE_TILE_SIZE_M / SIDE_TEXELS as f64);
    for cell in 0..cells * cells {
        let (lucky, at) = (stream.uniform() < DROPPINGS.0, (0.3 + 0.4 * stream.uniform(), 0.3 + 0.4 * stream.uniform()));
        let center_m =
            (((cell % cells) as f64 + at.0) * DROPPINGS_CELL_SIZE_M, ((cell / cells) as f64 + at.1) * DROPPINGS_CELL_SIZE_M);
        if !lucky {
            continue;
        }
        let middle = (whole(center_m.0 / texel_m), whole(center_m.1 / texel_m));
        for k in 0..16 * 16 {
            let (x, y) = (middle.0 + k % 16 - 8, middle.1 + k / 16 - 8);
            let (dx, dy) = (x as f64 * texel_m - center_m.0, 0.45 * (y as f64 * texel_m - center_m.1));
            let d_m = (dx * dx + dy * dy).sqrt();
            field[y % SIDE_TEXELS * SIDE_TEXELS + x % SIDE_TEXELS] = 1.0 - step(0.6, 1.4, (d_m / DROPPINGS.1) as f32);
        }
    }
    field
}

fn byte(x: f32) -> u8 {
    (255.0 * x.clamp(0.0, 1.0)).round() as u8
}

/// Returns a square picture and its mipmaps. Its side is a power of two.
pub fn levels(side: usize, finest: Vec<[u8; 4]>) -> MipLevels {
    let (mut side, mut texels, mut all) = (side, finest, Vec::new());
    loop {
        all.push((side, texels.iter().flatten().copied().collect()));
        if side == 1 {
            return all;
        }
        let half = side / 2;
        let mean = |k: usize| {
            let corner = 2 * (k / half) * side + 2 * (k % half);
            let four = [corner, corner + 1, corner + side, corner + side + 1];
            [0, 1, 2, 3].map(|c| (four.iter().map(|k| u32::from(texels[*k][c])).sum::<u32>().div_ceil(4)) as u8)
        };
        texels = (0..half * half).map(mean).collect();
        side = half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the value of a channel at a texel on the finest level.
    fn at(levels: &MipLevels, x: usize, y: usize, channel: usize) -> f64 {
        f64::from(levels[0].1[4 * (y * SIDE_TEXELS + x) + channel]) / 255.0
    }

    #[test]
    fn prop_tiles_repeat_without_a_seam_and_have_the_expected_mean() {
        for (tile, patterns) in [(ground(), 4), (concrete(), 1)] {
            assert_eq!(tile.iter().map(|level| level.0).collect::<Vec<_>>(), [1024, 512, 256, 128, 64, 32, 16, 8, 4, 2, 1]);
            assert!(tile.iter().all(|(side, rgba)| rgba.len() == 4 * side * side));
            for channel in 0..patterns {
                let steps = |y: usize| (0..SIDE_TEXELS - 1).map(move |x| (x, y));
                let step = |(x, y): (usize, usize)| (at(&tile, x + 1, y, channel) - at(&tile, x, y, channel)).abs();
                let within = (0..SIDE_TEXELS).step_by(37).flat_map(steps).map(step).fold(0.0, f64::max);
                for y in (0..SIDE_TEXELS).step_by(37) {
                    let seam = (at(&tile, 0, y, channel) - at(&tile, SIDE_TEXELS - 1, y, channel)).abs();
                    assert!(seam <= within, "channel {channel}, row {y}: {seam} over {within}");
                }
                let mean = f64::from(tile[10].1[channel]) / 255.0;
                assert!((mean - 0.5).abs() < 0.06, "channel {channel}: {mean}");
            }
        }
    }

    #[test]
    fn exact_bird_droppings_are_few_and_small() {
        let tile = concrete();
        let cells = whole(CONCRETE_TILE_SIZE_M / DROPPINGS_CELL_SIZE_M);
        let white = tile[0].1.chunks(4).filter(|texel| texel[3] > 127).count() as f64 / (SIDE_TEXELS * SIDE_TEXELS) as f64;
        // Each dropping is an ellipse of 45 x 100 mm; the total varies randomly by up to a third.
        let expected = DROPPINGS.0 * core::f64::consts::PI * DROPPINGS.1 * DROPPINGS.1
            / 0.45
            / (DROPPINGS_CELL_SIZE_M * DROPPINGS_CELL_SIZE_M);
        assert!((white / expected - 1.0).abs() < 0.34, "{white} of the tile, {expected} expected from {} squares", cells * cells);
    }
}
