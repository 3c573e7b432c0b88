//! Pixel labels must match the surface that a ray through the pixel hits in the collision geometry. A defect visible in
//! a picture must have labeled pixels.

use spandrel_model::math;
use spandrel_model::site::Surface;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, two_bridges};

const SIZE_PX: (u32, u32) = (160, 120);
/// Maximum fraction of pixels with a label that differs from the ray's: edges, where rendering and rays round
/// differently, and trees, which hide surfaces but do not collide.
const MAX_MISMATCH: f64 = 0.03;

#[test]
fn val_pixel_labels_match_ray_hits() {
    let mut studio = Studio::new(two_bridges(), 7, "low", SimTime::ZERO);
    for (from, look) in [
        (at(-30.0, -9.0, 33.0), at(-30.0, 0.0, 32.5)),
        (at(14.0, 0.3, 30.8), at(0.0, 0.0, 31.5)),
        (at(-72.0, 139.0, 3.5), at(-72.0, 150.0, 3.0)),
    ] {
        let shot = studio.seen(from, look, 78.8, false, SIZE_PX);
        let aspect = shot.aspect();
        let masks = {
            let (gpu, renderer) = studio.renderer();
            renderer.labels(gpu, &shot).unwrap()
        };
        let hit = |k: u32| {
            let (x, y) = (f64::from(k % SIZE_PX.0) + 0.5, f64::from(k / SIZE_PX.0) + 0.5);
            let ray = shot.eye.ray(2.0 * x / f64::from(SIZE_PX.0) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE_PX.1), aspect);
            let found = studio.site.geometry().ray(from, ray, 2_000.0)?;
            (found.surface == Surface::Bridge).then(|| studio.site.members()[found.object.0 as usize].element.number())
        };
        let apart = (0..SIZE_PX.0 * SIZE_PX.1).filter(|k| hit(*k).unwrap_or(0) != masks.elements[*k as usize]).count();
        let bridge = masks.elements.iter().filter(|element| **element != 0).count();
        let all = f64::from(SIZE_PX.0 * SIZE_PX.1);
        assert!(bridge as f64 > 0.2 * all, "the picture must show a bridge: {bridge} pixels");
        assert!(apart as f64 <= MAX_MISMATCH * all, "{from:?}: {apart} of {all} pixels");
    }
}

#[test]
fn val_visible_defect_is_labeled_at_its_position() {
    let mut studio = Studio::new(two_bridges(), 7, "low", SimTime::ZERO);
    let mut shown = 0;
    for defect in studio.site.defects().to_vec() {
        let from = defect.position_m + defect.normal * 1.5;
        if studio.site.nearest(from, 0.3, SimTime::ZERO).is_some() {
            continue;
        }
        let shot = studio.seen(from, defect.position_m, 60.0, false, (320, 240));
        let masks = {
            let (gpu, renderer) = studio.renderer();
            renderer.labels(gpu, &shot).unwrap()
        };
        let legend = masks.legend(studio.site.defects());
        let entry = legend["defects"].as_array().unwrap().iter().find(|entry| entry["id"] == defect.id);
        // Skips hairline cracks, which may cover too little of a pixel in this picture.
        let pixel_m = 2.0 * 1.5 * math::tan(0.5 * 60.0_f64.to_radians()) / 320.0;
        if defect.line && defect.width_m < 0.6 * pixel_m {
            continue;
        }
        let entry = entry.unwrap_or_else(|| panic!("{} {} of {:.4} m", defect.id, defect.kind, defect.width_m));
        assert_eq!(entry["element"], defect.element.number());
        let [x, y, w, h] = [0, 1, 2, 3].map(|k| entry["box_px"][k].as_f64().unwrap());
        assert!(
            x <= 190.0 && x + w >= 130.0 && y <= 150.0 && y + h >= 90.0,
            "{}: not near the center: {x} {y} {w} {h}",
            defect.id
        );
        shown += 1;
    }
    let all = studio.site.defects().len();
    assert!(2 * shown >= all, "only {shown} of {all} defects were checked");
}
