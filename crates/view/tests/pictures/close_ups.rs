//! Close-ups of random defects. With `SPANDREL_CLOSE_UPS=DIR`, they are saved with a key, so that people who do not know it can name kind and
//! condition state (docs/src/measured/pictures.md).

use super::compare::save_in;
use super::condition_states::{STATES, Series, all_series, defect, draw, masonry_series, patches};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, masonry_job, sunny_job};
use spandrel_view::picture::Picture;
use std::fmt::Write as _;
use std::path::Path;

/// Numbers of close-ups at the bridges of steel and concrete, and at the masonry arch bridge.
const COUNTS: [usize; 2] = [34, 6];
/// Sizes and presets of the compared and of the saved pictures.
const COMPARED: ((u32, u32), &str) = ((300, 225), "medium");
const SAVED: ((u32, u32), &str) = ((800, 600), "high");

/// Smallest difference of a channel that a person sees in a pixel beside its neighbors, of 255 (estimate), and smallest number of such pixels of
/// a visible defect: a hairline across a fifth of the compared picture.
const MIN_CONTRAST: u8 = 6;
const MIN_CHANGED_PX: usize = 60;

/// Returns the number of pixels that differ visibly between two pictures of one size.
fn changed_px(one: &Picture, other: &Picture) -> usize {
    let differs = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) >= MIN_CONTRAST);
    one.rgba.chunks_exact(4).zip(other.rgba.chunks_exact(4)).filter(|pair| differs(*pair)).count()
}

/// Returns the numbers from 1 to `count` in a random order.
fn shuffled(count: usize, random: &mut RandomStream) -> Vec<usize> {
    let mut keyed: Vec<(f64, usize)> = (1..=count).map(|number| (random.uniform(), number)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    keyed.into_iter().map(|(_, number)| number).collect()
}

/// A defect changes the picture of its place visibly.
#[test]
fn prop_random_close_ups_show_their_defects() {
    let folder = std::env::var_os("SPANDREL_CLOSE_UPS");
    let seed = std::env::var("SPANDREL_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(1);
    let mut random = RandomStream::new(seed, "close-ups");
    let (size_px, quality) = if folder.is_some() { SAVED } else { COMPARED };
    let mut numbers = shuffled(COUNTS.iter().sum(), &mut random);
    let (mut key, mut hidden) = (String::from("number,name,kind,condition_state,width_m\n"), Vec::new());
    let jobs: [(Scenario, Vec<Series>); 2] = [(sunny_job(), all_series()), (masonry_job(), masonry_series())];
    for ((job, rows), count) in jobs.into_iter().zip(COUNTS) {
        let mut studio = Studio::new(job, 7, quality, SimTime::from_ms(95_000));
        for series in (0..count).map(|k| &rows[k % rows.len()]) {
            let state = STATES[(random.uniform() * STATES.len() as f64) as usize];
            let defect = defect(&studio, series, state, random.uniform());
            let drawings = patches(&studio, &defect);
            let picture = draw(&mut studio, series, (&defect, &drawings), size_px);
            let number = numbers.pop().unwrap();
            if let Some(folder) = &folder {
                save_in(Path::new(folder), &format!("{number:02}.png"), &picture);
                writeln!(key, "{number},{},{},{state},{}", series.name, series.kind, series.width_m).unwrap();
                continue;
            }
            let bare = draw(&mut studio, series, (&defect, &[]), size_px);
            if changed_px(&picture, &bare) < MIN_CHANGED_PX {
                hidden.push(format!("{} in state {state}", series.name));
            }
        }
    }
    if let Some(folder) = &folder {
        std::fs::write(Path::new(folder).join("key.csv"), key).unwrap();
    }
    assert!(hidden.is_empty(), "not visible: {}", hidden.join(", "));
}
