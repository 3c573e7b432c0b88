//! Tests of a secondary view with its own graphics device.

use spandrel::secondary_renderer::SecondaryRenderer;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, two_bridges};
use spandrel_view::quality::Quality;
use std::sync::Arc;

/// Small, because every pixel is compared.
const SIZE: (u32, u32) = (160, 90);

#[test]
fn exact_secondary_renderer_matches_the_primary_device() {
    let mut studio = Studio::new(two_bridges(), 7, "low", SimTime::ZERO);
    let aside = SecondaryRenderer::open(Quality::by_name("low").unwrap(), Arc::clone(&studio.scene)).unwrap();
    let moment = studio.moment(at(0.0, 70.0, 30.0), at(0.0, 150.0, 10.0), false, at(1.0, 0.5, 0.0));
    let wide = studio.stage().camera(&moment, SIZE);
    let narrow = studio.stage().camera(&moment, (SIZE.0 / 2, SIZE.1));
    // Two pending pictures must arrive in order, each with its own size.
    aside.start(wide.clone()).unwrap();
    aside.start(narrow.clone()).unwrap();
    for shot in [wide, narrow] {
        let (picture, counts) = aside.picture().unwrap();
        assert_eq!(picture.difference(&studio.draw(&shot)), Some(0.0));
        assert_eq!(counts, studio.renderer().1.counts());
    }
}
