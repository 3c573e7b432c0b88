//! Compares pictures with the committed reference pictures.

use spandrel_view::picture::Picture;
use std::path::{Path, PathBuf};

/// Side of the squares that are averaged before comparison, px. Averaging reduces grain and JPEG artifacts but keeps
/// shapes.
const BLOCK_PX: u32 = 2;
/// Maximum mean absolute difference per channel over the picture, out of 255. JPEG at quality 90 causes about half of
/// that.
const MAX_MEAN_DIFFERENCE: f64 = 1.5;
/// Maximum for the worst tile. A missing or moved object the size of a tile exceeds it.
const MAX_TILE_DIFFERENCE: f64 = 7.0;
/// Side of a tile, blocks: 24 px.
const TILE_BLOCKS: u32 = 12;
/// JPEG quality of committed pictures, 1 to 100.
const JPEG_QUALITY: u8 = 90;

/// Difference between two pictures, out of 255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Mean over the picture.
    pub mean: f64,
    /// Mean over the worst tile.
    pub tile: f64,
}

impl Difference {
    pub fn is_within_limits(&self) -> bool {
        self.mean <= MAX_MEAN_DIFFERENCE && self.tile <= MAX_TILE_DIFFERENCE
    }
}

/// Returns the differences of all blocks, row by row, and the number of blocks per row.
fn blocks(a: &Picture, b: &Picture) -> (Vec<f64>, u32) {
    let (columns, rows) = (a.width / BLOCK_PX, a.height / BLOCK_PX);
    let mean = |p: &Picture, x: u32, y: u32| {
        let mut sum = [0.0; 3];
        for k in 0..BLOCK_PX * BLOCK_PX {
            let rgb = p.at(x * BLOCK_PX + k % BLOCK_PX, y * BLOCK_PX + k / BLOCK_PX);
            sum = [0, 1, 2].map(|c| sum[c] + f64::from(rgb[c]) / f64::from(BLOCK_PX * BLOCK_PX));
        }
        sum
    };
    let of = |k: u32| {
        let (p, q) = (mean(a, k % columns, k / columns), mean(b, k % columns, k / columns));
        [0, 1, 2].map(|c| (p[c] - q[c]).abs()).iter().sum::<f64>() / 3.0
    };
    ((0..columns * rows).map(of).collect(), columns)
}

/// Compares two pictures; returns `None` if their sizes differ.
pub fn difference(a: &Picture, b: &Picture) -> Option<Difference> {
    if (a.width, a.height) != (b.width, b.height) {
        return None;
    }
    let (all, columns) = blocks(a, b);
    let rows = all.len() as u32 / columns;
    let mean = |from: (u32, u32), to: (u32, u32)| {
        let inside = (from.1..to.1).flat_map(|y| (from.0..to.0).map(move |x| y * columns + x));
        let count = f64::from((to.0 - from.0) * (to.1 - from.1));
        inside.map(|k| all[k as usize]).sum::<f64>() / count
    };
    let tiles = (0..rows / TILE_BLOCKS).flat_map(|y| (0..columns / TILE_BLOCKS).map(move |x| (x * TILE_BLOCKS, y * TILE_BLOCKS)));
    let worst = tiles.map(|(x, y)| mean((x, y), (x + TILE_BLOCKS, y + TILE_BLOCKS))).fold(0.0, f64::max);
    Some(Difference { mean: mean((0, 0), (columns, rows)), tile: worst })
}

/// Compares a picture with the committed picture of the same name. An error message contains the paths of the rendered
/// picture and the difference. If the environment contains `SPANDREL_PICTURES=write`, overwrites the committed picture
/// instead; inspect the new picture before you commit it.
pub fn check_picture(name: &str, drawn: &Picture) -> Result<Difference, String> {
    check_picture_at(&reference_path(name), name, drawn)
}

/// Same as [`check_picture`], and also saves the picture in the folder in `SPANDREL_ALBUM`, if that is set.
pub fn check_album_picture(name: &str, drawn: &Picture) -> Result<Difference, String> {
    if let Some(album) = std::env::var_os("SPANDREL_ALBUM") {
        save_in(Path::new(&album), &format!("{name}.png"), drawn);
    }
    check_picture(name, drawn)
}

/// Returns the path of a committed picture.
pub fn reference_path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .join("crates/view/tests/pictures/committed")
        .join(format!("{name}.jpg"))
}

/// Same as [`check_picture`], but for a committed picture at any path.
pub fn check_picture_at(committed: &Path, name: &str, drawn: &Picture) -> Result<Difference, String> {
    if std::env::var("SPANDREL_PICTURES").is_ok_and(|value| value == "write") {
        std::fs::write(committed, jpeg(drawn)).unwrap();
        save(&format!("{name}.png"), drawn);
    }
    let expected = load(committed).map_err(|error| format!("{name}: {}: {error}", committed.display()))?;
    let found = difference(drawn, &expected).ok_or_else(|| {
        let (width, height) = (expected.width, expected.height);
        format!("{name}: rendered at {} x {}, committed at {width} x {height}", drawn.width, drawn.height)
    })?;
    if found.is_within_limits() {
        return Ok(found);
    }
    let (drawn_at, difference_at) =
        (save(&format!("{name}.png"), drawn), save(&format!("{name}-difference.png"), &difference_picture(drawn, &expected)));
    Err(format!(
        "{name}: mean {:.2} (at most {MAX_MEAN_DIFFERENCE}), worst tile {:.2} (at most {MAX_TILE_DIFFERENCE}); rendered: {}, difference: {}",
        found.mean,
        found.tile,
        drawn_at.display(),
        difference_at.display()
    ))
}

/// Returns the difference, amplified eight times.
fn difference_picture(a: &Picture, b: &Picture) -> Picture {
    let rgba = a.rgba.iter().zip(&b.rgba).enumerate();
    let rgba = rgba.map(|(k, (a, b))| if k % 4 == 3 { 255 } else { a.abs_diff(*b).saturating_mul(8) });
    Picture { width: a.width, height: a.height, rgba: rgba.collect() }
}

fn rgb(picture: &Picture) -> Vec<u8> {
    picture.rgba.chunks(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

/// Writes a PNG to the test output folder and returns its path.
pub fn save(name: &str, picture: &Picture) -> PathBuf {
    save_in(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("view"), name, picture)
}

/// Writes a PNG to a folder and returns its path.
pub fn save_in(folder: &Path, name: &str, picture: &Picture) -> PathBuf {
    std::fs::create_dir_all(folder).unwrap();
    let path = folder.join(name);
    image::save_buffer(&path, &rgb(picture), picture.width, picture.height, image::ExtendedColorType::Rgb8).unwrap();
    path
}

fn jpeg(picture: &Picture) -> Vec<u8> {
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
        .encode(&rgb(picture), picture.width, picture.height, image::ExtendedColorType::Rgb8)
        .unwrap();
    bytes
}

fn load(path: &Path) -> Result<Picture, image::ImageError> {
    let read = image::open(path)?.to_rgba8();
    Ok(Picture { width: read.width(), height: read.height(), rgba: read.into_raw() })
}

/// Joins pictures of the same height side by side.
pub fn side_by_side(pictures: &[Picture]) -> Picture {
    let height = pictures.iter().map(|p| p.height).min().unwrap_or(0);
    let row = |p: &Picture, y: u32| p.rgba[(4 * y * p.width) as usize..(4 * (y + 1) * p.width) as usize].to_vec();
    let rgba = (0..height).flat_map(|y| pictures.iter().flat_map(move |p| row(p, y))).collect();
    Picture { width: pictures.iter().map(|p| p.width).sum(), height, rgba }
}

/// Returns stripes in several shades of gray, with an optional square in another shade.
fn sample(square: Option<(u32, u32)>, shift: u32) -> Picture {
    let mut rgba = Vec::new();
    for y in 0..96 {
        for x in 0..144 {
            let inside = square.is_some_and(|(left, top)| (left..left + 20).contains(&x) && (top..top + 20).contains(&y));
            let grey = if inside { 60 } else { 90 + 12 * ((((x + shift) / 7) + y / 11) % 5) as u8 };
            rgba.extend([grey, grey, grey, 255]);
        }
    }
    Picture { width: 144, height: 96, rgba }
}

#[test]
fn exact_comparison_detects_missing_or_moved_parts_and_tolerates_jpeg() {
    let plain = sample(None, 0);
    assert_eq!(difference(&plain, &plain), Some(Difference { mean: 0.0, tile: 0.0 }));
    let spotted = difference(&plain, &sample(Some((60, 40)), 0)).unwrap();
    assert!(!spotted.is_within_limits(), "a square of 20 px must be detected: {spotted:?}");
    let moved = difference(&plain, &sample(None, 3)).unwrap();
    assert!(!moved.is_within_limits(), "a shift of 3 px must be detected: {moved:?}");
    let read = image::load_from_memory(&jpeg(&plain)).unwrap().to_rgba8();
    let lossy = Picture { width: read.width(), height: read.height(), rgba: read.into_raw() };
    let found = difference(&plain, &lossy).unwrap();
    assert!(found.is_within_limits(), "JPEG losses alone: {found:?}");
    assert_eq!(difference(&plain, &Picture { width: 1, height: 1, rgba: vec![0; 4] }), None);
}
