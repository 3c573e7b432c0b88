//! Where a person can stand and walk: on the ground, clear of water, bridges, the landing pad and the truck.

use super::Site;
use crate::frames::{Enu, Vec3};
use crate::scenario::places::is_on_pad;

/// Distance between two checked points of a way, m (estimate: less than twice `CLEARANCE_M`, so that no column fits
/// between two points).
const STEP_M: f64 = 0.5;
/// Minimum distance of a person's axis from an obstacle, m (estimate: half the breadth of the shoulders and some room).
const CLEARANCE_M: f64 = 0.4;
/// Heights of the checked points of a person above the feet, m.
const BODY_HEIGHTS_M: [f64; 3] = [0.5, 1.0, 1.5];
/// Maximum height of the feet of a standing person above or below the ground, m (estimate: the error of a height grid).
pub const MAX_HEIGHT_ERROR_M: f64 = 0.5;

/// Reason why a person cannot stand at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WalkObstacle {
    /// The point is beyond the edge of the terrain.
    Edge,
    /// The ground is under water.
    Water,
    /// The point is in a bridge or too close to it.
    Bridge,
    /// The point is on the landing pad or at its edge.
    Pad,
    /// The point is in the crew's truck or too close to it.
    Truck,
}

impl WalkObstacle {
    /// Returns the name of the obstacle, for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Edge => "the edge of the terrain",
            Self::Water => "the water",
            Self::Bridge => "a bridge",
            Self::Pad => "the landing pad",
            Self::Truck => "the truck",
        }
    }
}

impl Site {
    /// Returns what keeps a person from standing on the ground at a point; `None` if nothing does.
    #[must_use]
    pub fn place_obstacle(&self, place_m: Vec3<Enu>) -> Option<WalkObstacle> {
        let Some(ground_m) = self.terrain_up_m(place_m.east(), place_m.north()) else { return Some(WalkObstacle::Edge) };
        if ground_m <= self.geometry().terrain.water_m {
            return Some(WalkObstacle::Water);
        }
        let (pad_m, pad_half_m) = self.geometry().pad_square_m();
        if is_on_pad(place_m, pad_m, pad_half_m) {
            return Some(WalkObstacle::Pad);
        }
        let body = BODY_HEIGHTS_M.map(|height_m| Vec3::new(place_m.east(), place_m.north(), ground_m + height_m));
        if body.iter().any(|point| self.geometry().nearest_member(*point, CLEARANCE_M).is_some()) {
            return Some(WalkObstacle::Bridge);
        }
        body.iter().any(|point| self.traffic().is_truck_near(*point, CLEARANCE_M)).then_some(WalkObstacle::Truck)
    }

    /// Returns the first obstacle on a straight way over the ground, and its position on the way; `None` if the way is free.
    #[must_use]
    pub fn way_obstacle(&self, from_m: Vec3<Enu>, to_m: Vec3<Enu>) -> Option<(WalkObstacle, Vec3<Enu>)> {
        let steps = ((to_m - from_m).horizontal_norm() / STEP_M).ceil().max(1.0);
        (0..=steps as u32).find_map(|k| {
            let place_m = from_m.lerp(to_m, f64::from(k) / steps);
            self.place_obstacle(place_m).map(|obstacle| (obstacle, place_m))
        })
    }
}
