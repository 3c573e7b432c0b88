//! The camera's picture over a weak video link.

use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, sunny_job};
use spandrel_view::picture::Picture;

/// Size of the picture, and side of its blocks, px.
const VIEW_PX: (u32, u32) = (480, 352);
const BLOCK_PX: u32 = 16;

/// Returns whether a block is the same in both pictures.
fn is_same(a: &Picture, b: &Picture, block: u32) -> bool {
    let per_row = VIEW_PX.0 / BLOCK_PX;
    let (left, top) = (block % per_row * BLOCK_PX, block / per_row * BLOCK_PX);
    (0..BLOCK_PX * BLOCK_PX).all(|k| {
        let (x, y) = (left + k % BLOCK_PX, top + k / BLOCK_PX);
        a.at(x, y) == b.at(x, y)
    })
}

#[test]
fn exact_lost_blocks_change_and_all_others_stay() {
    let mut studio = Studio::new(sunny_job(), 7, "low", SimTime::from_ms(95_000));
    let moment = studio.moment(at(-30.0, -9.0, 33.0), at(-30.0, 0.0, 32.5), false, Vec3::new(0.5, 0.0, 0.0));
    let shot = studio.stage().camera(&moment, VIEW_PX);
    let whole = studio.draw(&shot);
    assert!(whole == studio.draw(&shot.clone().with_lost_blocks(0.0)), "a good link changes nothing");
    let count = VIEW_PX.0 / BLOCK_PX * (VIEW_PX.1 / BLOCK_PX);
    let mut changed = Vec::new();
    for share in [0.1, 0.4] {
        let lossy = studio.draw(&shot.clone().with_lost_blocks(share));
        let lost = (0..count).filter(|block| !is_same(&whole, &lossy, *block)).count() as f64 / f64::from(count);
        changed.push(lost);
        // Standard deviation of the share of 660 blocks: 0.02. Blocks of one color may stay the same.
        assert!((share - 0.25 * share - 0.04..share + 0.06).contains(&lost), "{share}: {lost}");
    }
    assert!(changed[0] < changed[1], "{changed:?}");
}
