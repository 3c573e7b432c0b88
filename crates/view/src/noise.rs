//! A noise tile with mipmaps for all materials. The shaders sample it at the pixel size, which avoids aliasing at a
//! distance and has the same cost for any number of octaves.

use spandrel_model::random::RandomStream;

/// Texels per side.
pub const SIDE_TEXELS: usize = 512;
/// Lattice cells per side; the tile repeats after this many cells.
pub const CELLS: usize = 16;
/// Octaves of the first channel; the finest has cells of two texels.
const OCTAVES: usize = 5;
/// Maximum distance in the third channel, in cells; the channel stores distances as fractions of it.
pub const MAX_DISTANCE: f64 = 1.28;

/// A mip level: row-major texels with four channels: several octaves of noise, one octave, distance to the nearest
/// scattered point, and a random number for that point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoiseLevel {
    /// Texels per side.
    pub side: usize,
    /// Four bytes per texel.
    pub rgba: Vec<u8>,
}

/// Returns the tile and its mipmaps, finest first.
#[must_use]
pub fn levels() -> Vec<NoiseLevel> {
    let mut values = tile();
    let mut side = SIDE_TEXELS;
    let mut all = Vec::new();
    loop {
        let rgba = values.iter().flatten().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
        all.push(NoiseLevel { side, rgba });
        if side == 1 {
            return all;
        }
        values = downsampled(&values, side);
        side /= 2;
    }
}

fn downsampled(values: &[[f64; 4]], side: usize) -> Vec<[f64; 4]> {
    let half = side / 2;
    let mean = |k: usize| {
        let (x, y) = (2 * (k % half), 2 * (k / half));
        let at = |dx: usize, dy: usize| values[(y + dy) * side + x + dx];
        [0, 1, 2, 3].map(|c| 0.25 * (at(0, 0)[c] + at(1, 0)[c] + at(0, 1)[c] + at(1, 1)[c]))
    };
    (0..half * half).map(mean).collect()
}

fn tile() -> Vec<[f64; 4]> {
    let mut stream = RandomStream::new(0, "view.noise");
    let mut lattice = |cells: usize| -> Vec<f64> { (0..cells * cells).map(|_| stream.uniform()).collect() };
    let octaves: Vec<Vec<f64>> = (0..OCTAVES).map(|k| lattice(CELLS << k)).collect();
    let single = lattice(CELLS);
    let (east, north, own) = (lattice(CELLS), lattice(CELLS), lattice(CELLS));
    let texel = |k: usize| {
        let unit = CELLS as f64 / SIDE_TEXELS as f64;
        let (x, y) = ((k % SIDE_TEXELS) as f64 * unit, (k / SIDE_TEXELS) as f64 * unit);
        let mut sum = 0.5;
        let mut share = 0.5;
        for (k, octave) in octaves.iter().enumerate() {
            let finer = f64::from(1u32 << k);
            sum += share * (interpolate(octave, CELLS << k, x * finer, y * finer) - 0.5);
            share *= 0.5;
        }
        let (distance, number) = nearest(&east, &north, &own, x, y);
        [sum, interpolate(&single, CELLS, x, y), distance / MAX_DISTANCE, number]
    };
    (0..SIDE_TEXELS * SIDE_TEXELS).map(texel).collect()
}

/// Interpolates smoothly between the corners of a periodic lattice.
fn interpolate(lattice: &[f64], cells: usize, x: f64, y: f64) -> f64 {
    let (cx, cy) = (x.floor(), y.floor());
    let fade = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (fade(x - cx), fade(y - cy));
    let at = |i: usize, j: usize| lattice[(cy as usize + j) % cells * cells + (cx as usize + i) % cells];
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    low + (high - low) * fy
}

/// Returns the distance to the nearest scattered point (one per cell) and that point's random number.
fn nearest(east: &[f64], north: &[f64], own: &[f64], x: f64, y: f64) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    let cell = |v: f64, step: i64| (v.floor() as i64 + step).rem_euclid(CELLS as i64) as usize;
    for dy in -1..=1 {
        for dx in -1..=1 {
            let k = cell(y, dy) * CELLS + cell(x, dx);
            let px = x.floor() + dx as f64 + 0.15 + 0.7 * east[k];
            let py = y.floor() + dy as f64 + 0.15 + 0.7 * north[k];
            let distance = ((px - x) * (px - x) + (py - y) * (py - y)).sqrt();
            if distance < best.0 {
                best = (distance, own[k]);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_last_mip_level_is_the_mean() {
        let levels = levels();
        assert_eq!(levels.len(), 10);
        assert!(levels.iter().all(|l| l.rgba.len() == 4 * l.side * l.side));
        let mean = f64::from(levels[9].rgba[0]) / 255.0;
        assert!((mean - 0.5).abs() < 0.05, "{mean}");
    }

    #[test]
    fn prop_tile_repeats_without_a_seam() {
        let fine = &levels()[0];
        let at = |x: usize, y: usize| f64::from(fine.rgba[4 * (y * SIDE_TEXELS + x)]);
        // The step across the seam must not exceed the largest step within the tile.
        let within = (0..SIDE_TEXELS - 1).map(|x| (at(x + 1, 100) - at(x, 100)).abs()).fold(0.0, f64::max);
        assert!((at(0, 100) - at(SIDE_TEXELS - 1, 100)).abs() <= within);
    }
}
