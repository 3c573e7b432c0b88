//! Undersides and the sky behind them in one picture, and what local adaptation must not do: lift what is too dark for the scores.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, girder_job, two_bridges};
use spandrel_view::picture::Picture;
use spandrel_view::shot::{SensorResponse, Shot};

const SIZE_PX: (u32, u32) = (640, 360);
/// Luma from which a surface shows its texture on a screen (estimate: a fifth of the range), of 255.
const MIN_READABLE_LUMA: f64 = 45.0;
/// Luma up to which the sky shows its clouds (estimate), of 255.
const MAX_SKY_LUMA: f64 = 235.0;

/// Returns the mean luma of the parts of a picture that show the bridge, and of those that show the sky or distant mountains.
fn lumas(studio: &mut Studio, shot: &Shot, picture: &Picture) -> (f64, f64) {
    let (gpu, renderer) = studio.renderer();
    let masks = renderer.labels(gpu, shot).unwrap();
    let of = |bridge: bool| {
        let pixels =
            (0..SIZE_PX.0 * SIZE_PX.1).filter(|k| (masks.elements[*k as usize] != 0) == bridge && k / SIZE_PX.0 < SIZE_PX.1 / 2);
        let (sum, count) = pixels.fold((0.0, 0.0), |(sum, count), k| {
            let (x, y) = (k % SIZE_PX.0, k / SIZE_PX.0);
            (sum + picture.luma((x, y), (x + 1, y + 1)), count + 1.0)
        });
        sum / count
    };
    (of(true), of(false))
}

/// Viewpoints below a deck that look out from under it: the upper half shows the soffit and the sky.
const UNDER_GIRDERS: ([f64; 3], [f64; 3]) = ([30.0, -9.0, 8.0], [55.0, 3.0, 17.0]);

fn point([east, north, up]: [f64; 3]) -> Vec3<Enu> {
    at(east, north, up)
}

#[test]
fn val_undersides_and_the_sky_are_readable_in_one_picture() {
    for quality in ["low", "medium"] {
        let mut studio = Studio::new(girder_job(), 7, quality, SimTime::from_ms(95_000));
        let hfov_deg = studio.vehicle.camera.hfov_rad.to_degrees();
        let shot = studio.seen(point(UNDER_GIRDERS.0), point(UNDER_GIRDERS.1), hfov_deg, false, SIZE_PX);
        let picture = studio.draw(&shot);
        let (soffit, sky) = lumas(&mut studio, &shot, &picture);
        println!("{quality}: soffit {soffit:.0}, sky {sky:.0}");
        assert!(soffit >= MIN_READABLE_LUMA && sky <= MAX_SKY_LUMA && soffit < sky, "{quality}: {soffit} and {sky}");
    }
}

#[test]
fn prop_what_is_too_dark_for_the_camera_is_not_brightened() {
    // The noise and the rounding of a gray level.
    const MAX_CHANGE: f64 = 1.0;
    let mut studio = Studio::new(two_bridges(), 7, "low", SimTime::ZERO);
    let shot = studio.seen(at(14.0, 0.3, 30.8), at(0.0, 0.0, 31.5), 78.8, false, SIZE_PX);
    let picture = |studio: &mut Studio, white_lux: f64, min_white_lux: f64| {
        let mut exposure = shot.finish.exposure;
        (exposure.white_lux, exposure.min_white_lux) = (white_lux, min_white_lux);
        let shot = Shot { finish: SensorResponse::eyes(exposure), ..shot.clone() };
        studio.draw(&shot).luma((0, 0), SIZE_PX)
    };
    let white_lux = 8.0 * shot.finish.exposure.white_lux;
    let at_the_limit = picture(&mut studio, white_lux, white_lux);
    let [two_stops, free] = [4.0, 1e6].map(|below| picture(&mut studio, white_lux, white_lux / below));
    println!("camera at its limit: {at_the_limit:.0}; two stops above: {two_stops:.0}; far above: {free:.0}");
    assert!(at_the_limit + MAX_CHANGE < two_stops && two_stops < free, "{at_the_limit}, {two_stops}, {free}");
    // Brightening at the limit would show what the scores count as too dark.
    assert!(at_the_limit <= 0.5 * free, "{at_the_limit} against {free}");
}
