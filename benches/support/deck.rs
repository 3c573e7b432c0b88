//! A place on a bridge for aircraft that stand.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;

/// Returns a point on a bridge deck surrounded only by road.
pub fn deck(site: &Site) -> Vec3<Enu> {
    let lane = site.lanes().iter().find(|lane| !lane.walkway).expect("the site must have a road lane");
    // The ends of a lane are on the approach road, so its middle is on the bridge.
    let (first, last) = (lane.points_m[0], lane.points_m[lane.points_m.len() - 1]);
    let above = (first + last) * 0.5 + Vec3::new(0.0, 0.0, 3.0);
    let hit = site.ray(above, Vec3::new(0.0, 0.0, -1.0), 6.0, SimTime::ZERO).expect("the deck must be below its lane");
    assert_eq!(hit.surface, Surface::Bridge);
    above - Vec3::new(0.0, 0.0, hit.distance_m)
}
