//! Metal and concrete railings with posts and rails.

use super::solid::MemberBuilder;
use crate::elements::Element;

/// Adds railings along both edges of a deck: a post about every 2 m, and three rails.
pub(super) fn add_railing(b: &mut MemberBuilder, length_m: f64, edge_y_m: f64, height_m: f64, element: Element) {
    const POST_WIDTH_M: f64 = 0.15;
    let posts = (length_m / 2.0).floor() as i32;
    for (side, y) in [("left", edge_y_m - POST_WIDTH_M), ("right", -edge_y_m)] {
        for k in 0..=posts {
            let x = (length_m - POST_WIDTH_M) * (f64::from(k) / f64::from(posts) - 0.5) - 0.5 * POST_WIDTH_M;
            b.add_box(&format!("post-{side}/{k:03}"), element, [x, y, 0.0], [x + POST_WIDTH_M, y + POST_WIDTH_M, height_m]);
        }
        for rail in 1..=3 {
            let z = height_m * f64::from(rail) / 3.0;
            let half = 0.5 * length_m;
            b.add_box(&format!("rail-{side}/{rail}"), element, [-half, y + 0.03, z - 0.1], [half, y + 0.12, z]);
        }
    }
}
