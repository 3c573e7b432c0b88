//! Contrast of a crack as a function of the ground sampling distance (docs/src/reference/domain.md, "Resolution":
//! detection from half a pixel's width, identification from one pixel). The contrast must not jump.

use spandrel_model::defect_codes;
use spandrel_model::math;
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, sunny_job};
use spandrel_view::picture::Picture;
use spandrel_view::scene::DefectPatch;
use spandrel_view::scene::defects::patch;

/// Size of the crops from the camera's picture at full resolution, px.
const CROP_PX: (u32, u32) = (160, 200);
const CRACK_WIDTH_M: f64 = 0.0025;
/// Random numbers that make defect.wgsl draw a crack without lime deposits, and one with them.
const SEED_WITHOUT_LIME: f32 = 0.05;
const SEED_WITH_LIME: f32 = 0.12;

/// A wall with a long vertical crack, the same wall without it, and a camera in front of it.
struct Wall {
    studio: Studio,
    crack: PlacedDefect,
    patches: Vec<DefectPatch>,
}

impl Wall {
    fn new() -> Self {
        Self::of(defect_codes::CRACK, SEED_WITHOUT_LIME)
    }

    /// Creates a wall; `own` decides whether the crack has lime deposits.
    fn of(kind: u32, own: f32) -> Self {
        let studio = Studio::new(sunny_job(), 7, "low", SimTime::ZERO);
        let (from, towards) = (at(-55.0, -15.0, 24.0), at(0.0, 1.0, 0.0));
        let hit = studio.site.ray(from, towards, 200.0, SimTime::ZERO).unwrap();
        let crack = PlacedDefect {
            id: 1,
            element: spandrel_model::elements::Element::RcAbutment,
            member: "wall".into(),
            kind,
            condition_state: 3,
            position_m: from + towards * hit.distance_m,
            normal: hit.normal,
            along: at(0.0, 0.0, -1.0),
            length_m: 8.0,
            width_m: CRACK_WIDTH_M,
            line: true,
            cause: None,
            stain: None,
        };
        let mut bare = patch(&crack, [0.6, 0.1]);
        bare.normal[3] = own;
        let patches = vec![bare];
        Self { studio, crack, patches }
    }

    /// Returns the size of a pixel on the wall, in meters, at the given distance.
    fn gsd_m(&self, distance_m: f64) -> f64 {
        distance_m / self.studio.vehicle.camera.focal_px()
    }

    /// Returns pictures of the wall with and without the crack at the given ground sampling distance (in meters).
    fn pair(&mut self, gsd_m: f64) -> [Picture; 2] {
        let focal_px = self.studio.vehicle.camera.focal_px();
        let hfov_deg = (2.0 * math::atan(0.5 * f64::from(CROP_PX.0) / focal_px)).to_degrees();
        let from = self.crack.position_m + self.crack.normal * (gsd_m * focal_px);
        let shot = self.studio.seen(from, self.crack.position_m, hfov_deg, false, CROP_PX);
        [self.patches.clone(), Vec::new()].map(|patches| {
            let (gpu, renderer) = self.studio.renderer();
            renderer.set_patches(gpu, &patches);
            self.studio.draw(&shot)
        })
    }
}

/// Returns the luma values of a row.
fn row(picture: &Picture, y: u32) -> Vec<f64> {
    (0..picture.width).map(|x| picture.luma((x, y), (x + 1, y + 1))).collect()
}

/// Returns the contrast between the crack's darkest point in a row and the bare wall, as a fraction, averaged over the
/// rows.
fn contrast(pair: &[Picture; 2]) -> f64 {
    peak_difference(pair, |with, without| without - with)
}

/// Returns the largest difference from the bare wall in a row, as a fraction of the wall's brightness there, averaged
/// over the rows.
fn peak_difference([with, without]: &[Picture; 2], by: impl Fn(f64, f64) -> f64) -> f64 {
    let of = |y: u32| {
        let pairs = row(with, y).into_iter().zip(row(without, y));
        pairs.map(|(with, without)| by(with, without) / without.max(1.0)).fold(0.0, f64::max)
    };
    (0..with.height).map(of).sum::<f64>() / f64::from(with.height)
}

/// Returns the bare wall's variation between pixels two apart, as a fraction of its brightness (grain, sand, streaks).
fn wall_variation(without: &Picture) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for y in 0..without.height {
        let luma = row(without, y);
        for w in luma.windows(3) {
            let step = (w[0] - w[2]) / luma[luma.len() / 2].max(1.0);
            (squares, count) = (squares + step * step, count + 1.0);
        }
    }
    (squares / count / 2.0_f64).sqrt()
}

#[test]
fn val_crack_visibility_depends_on_its_width_in_pixels() {
    // As multiples of the bare wall's variation. The value 5 is Rose's limit of visibility (1948). Distinguishing a
    // crack from a stain or a formwork line requires more (estimate: four times that).
    const DETECTION_THRESHOLD: f64 = 5.0;
    const IDENTIFICATION_THRESHOLD: f64 = 20.0;
    const NON_DETECTION_THRESHOLD: f64 = 2.0;
    // A line narrower than a pixel covers a fraction of it, so a line of half the width has half the contrast. The tone
    // curve causes a small deviation.
    const HALF_CONTRAST: f64 = 0.5;
    const HALF_TOLERANCE: f64 = 0.12;
    let mut wall = Wall::new();
    let mut found = Vec::new();
    for share in [2.0, 1.0, 0.5, 0.1] {
        let gsd_m = CRACK_WIDTH_M / share;
        let pair = wall.pair(gsd_m);
        let (seen, bare) = (contrast(&pair), wall_variation(&pair[1]));
        println!("{share} px ({:.1} m): contrast {seen:.3}, bare wall {bare:.3}", gsd_m / wall.gsd_m(1.0));
        found.push((seen, seen / bare));
    }
    assert!(found[1].1 >= IDENTIFICATION_THRESHOLD && found[0].1 >= IDENTIFICATION_THRESHOLD, "one and two pixels: {found:?}");
    assert!(found[2].1 >= DETECTION_THRESHOLD, "half a pixel: {found:?}");
    assert!(found[3].1 <= NON_DETECTION_THRESHOLD, "a tenth of a pixel: {found:?}");
    assert!(
        (found[2].0 / found[1].0 - HALF_CONTRAST).abs() <= HALF_TOLERANCE,
        "contrast at half a pixel relative to one: {found:?}"
    );
}

/// As the camera moves away from a crack in steps of 6%, the contrast must decrease without jumps.
#[test]
fn prop_contrast_decreases_smoothly() {
    const STEP: f64 = 0.94;
    // Allows for rounding to 8 bits and for different rows of the wall in the picture.
    const MAX_RISE: f64 = 0.01;
    // The contrast is inversely proportional to the distance, so a step changes it by 6%, or by up to twice that where
    // the edge of the line leaves the adjacent pixel.
    const MAX_FALL: f64 = 0.08;
    let mut wall = Wall::new();
    let mut before: Option<f64> = None;
    let mut share = 4.0;
    while share > 0.1 {
        let seen = contrast(&wall.pair(CRACK_WIDTH_M / share));
        if let Some(before) = before {
            let change = seen - before;
            assert!((-MAX_FALL..=MAX_RISE).contains(&change), "{share:.3} px: {before:.3}, then {seen:.3}");
        }
        before = Some(seen);
        share *= STEP;
    }
    assert!(before.is_some_and(|last| last < 0.1), "at a tenth of a pixel: {before:?}");
}

/// Leakage from a line (lime on concrete, rust on steel) must fade just as evenly.
#[test]
fn prop_leakage_contrast_decreases_smoothly() {
    const STEP: f64 = 0.94;
    // Allows for rounding to 8 bits, different rows of the wall, and ends of the leakage that enter the picture.
    const MAX_RISE: f64 = 0.03;
    const MAX_FALL: f64 = 0.08;
    for (kind, own) in [(defect_codes::CRACK, SEED_WITH_LIME), (defect_codes::FATIGUE, SEED_WITHOUT_LIME)] {
        let mut wall = Wall::of(kind, own);
        let mut before: Option<f64> = None;
        let mut share = 4.0;
        while share > 0.1 {
            let seen = peak_difference(&wall.pair(CRACK_WIDTH_M / share), |with, without| (with - without).abs());
            if let Some(before) = before {
                let change = seen - before;
                assert!((-MAX_FALL..=MAX_RISE).contains(&change), "{kind}: {share:.3} px: {before:.3}, then {seen:.3}");
            }
            before = Some(seen);
            share *= STEP;
        }
    }
}
