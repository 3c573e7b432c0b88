//! What the presets `high` and `ultra` add to the light: darker corners and gaps, and shadows with penumbras.

use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, girder_job};
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;

const SIZE_PX: (u32, u32) = (480, 270);

/// Returns two pictures of one view: with a preset, and with the preset that a change makes of it.
fn pictures(preset: &str, changed: impl FnOnce(Quality) -> Quality, from: [f64; 3], look: [f64; 3]) -> [Picture; 2] {
    let mut studio = Studio::new(girder_job(), 7, preset, SimTime::from_ms(95_000));
    studio.without_defects();
    let [from, look] = [from, look].map(|[east, north, up]| at(east, north, up));
    let shot = studio.seen(from, look, 70.0, false, SIZE_PX);
    let with_preset = studio.draw(&shot);
    studio.set_quality(changed(Quality::by_name(preset).unwrap()));
    studio.without_defects();
    [with_preset, studio.draw(&shot)]
}

/// Returns the changes of the lumas of all pixels from the second picture to the first.
fn changes([one, other]: &[Picture; 2]) -> Vec<f64> {
    let pixels = (0..SIZE_PX.0 * SIZE_PX.1).map(|k| (k % SIZE_PX.0, k / SIZE_PX.0));
    pixels.map(|(x, y)| one.luma((x, y), (x + 1, y + 1)) - other.luma((x, y), (x + 1, y + 1))).collect()
}

fn share(changes: &[f64], is_counted: impl Fn(f64) -> bool) -> f64 {
    changes.iter().filter(|change| is_counted(**change)).count() as f64 / changes.len() as f64
}

#[test]
fn prop_ambient_occlusion_darkens_corners_and_nothing_else() {
    // Local adaptation passes some of the change on to the neighborhood, of 255.
    const MAX_BRIGHTENING: f64 = 4.0;
    const VISIBLE: f64 = 8.0;
    // Rounding of the occlusion and of a gray level.
    const FLAT: f64 = 2.0;
    // Height above the girder bridge's deck of a picture that is narrower than its roadway, m.
    const ABOVE_DECK_M: f64 = 21.0;
    // The bays between the girders, with cross-frames and flanges, and the sky behind them.
    let bays = pictures("high", |high| Quality { occlusion_directions: 0, ..high }, [38.0, 2.7, 11.9], [50.0, 4.6, 18.0]);
    let changes = changes(&bays);
    let (darker, brighter) = (share(&changes, |change| change <= -VISIBLE), share(&changes, |change| change > MAX_BRIGHTENING));
    println!("visibly darker {:.1}%, brighter {:.2}%", 100.0 * darker, 100.0 * brighter);
    assert!((0.03..0.5).contains(&darker) && brighter < 0.005, "{darker} {brighter}");
    // A place on the road, seen from above, where nothing stands within a meter.
    let road = pictures("high", |high| Quality { occlusion_directions: 0, ..high }, [8.0, 0.0, ABOVE_DECK_M], [8.0, 0.05, 0.0]);
    let [most, least] = [f64::max, f64::min].map(|pick| self::changes(&road).into_iter().fold(0.0, pick));
    println!("on the road {least:.1} to {most:.1}");
    assert!(-FLAT <= least && most <= FLAT, "{least} to {most}");
}

#[test]
fn prop_penumbras_change_only_the_edges_of_shadows() {
    const VISIBLE: f64 = 8.0;
    // The fascia girder in the sun, with the shadow of the deck's edge and railing.
    let fascia = pictures("ultra", |ultra| Quality { penumbra: false, ..ultra }, [-30.0, -24.0, 9.0], [-14.0, -4.0, 15.0]);
    let changes = changes(&fascia);
    let (mean, changed) = (changes.iter().sum::<f64>() / changes.len() as f64, share(&changes, |change| change.abs() >= VISIBLE));
    println!("mean change {mean:.2}, visibly changed {:.2}%", 100.0 * changed);
    // A penumbra takes as much light on one side of an edge as it gives on the other.
    assert!(mean.abs() < 1.0 && (0.001..0.1).contains(&changed), "{mean} {changed}");
}
