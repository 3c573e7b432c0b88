//! Line drawings of the site, derived from the collision geometry: parallel projections, silhouettes of bridge members, the
//! water and the ground. Details too small to see are skipped.

use super::Site;
use super::plan_hull::hull;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Member;
use crate::scenario::{Bridge, Scenario};

/// Distance between samples of water and ground, m.
pub const GROUND_SAMPLE_SPACING_M: f64 = 5.0;

/// A parallel projection, defined by the right and up directions of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParallelView {
    /// Unit vector that points right in the drawing.
    pub right: Vec3<Enu>,
    /// Unit vector that points up in the drawing.
    pub up: Vec3<Enu>,
}

/// Silhouette of one bridge member.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberOutline {
    /// The member's element.
    pub element: Element,
    /// Vertices in the drawing, counterclockwise; m right and up.
    pub corners: Vec<(f64, f64)>,
    /// Depth of the nearest point, m; larger is closer to the viewer.
    pub near_m: f64,
}

impl ParallelView {
    /// Returns the plan view with north up.
    #[must_use]
    pub fn plan() -> Self {
        Self { right: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 1.0, 0.0) }
    }

    /// Returns the side view of a bridge from its right side. The deck's heading points right in the drawing.
    #[must_use]
    pub fn side(bridge: &Bridge) -> Self {
        let (s, c) = math::sin_cos(bridge.heading_deg.to_radians());
        Self { right: Vec3::new(s, c, 0.0), up: Vec3::new(0.0, 0.0, 1.0) }
    }

    /// Returns the view from the south.
    #[must_use]
    pub fn from_south() -> Self {
        Self { right: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 0.0, 1.0) }
    }

    /// Returns an oblique view in the direction `azimuth_deg` (clockwise from north), tilted down by `down_deg`.
    #[must_use]
    pub fn oblique(azimuth_deg: f64, down_deg: f64) -> Self {
        let (s, c) = math::sin_cos(azimuth_deg.to_radians());
        let (sd, cd) = math::sin_cos(down_deg.to_radians());
        Self { right: Vec3::new(c, -s, 0.0), up: Vec3::new(s * sd, c * sd, cd) }
    }

    /// Projects a point onto the drawing; m right and up.
    #[must_use]
    pub fn at(&self, point_m: Vec3<Enu>) -> (f64, f64) {
        (point_m.dot(self.right), point_m.dot(self.up))
    }

    /// Returns the unit vector toward the viewer.
    #[must_use]
    pub fn toward_viewer(&self) -> Vec3<Enu> {
        self.right.cross(self.up)
    }
}

/// Returns the member silhouettes, farthest first. Members with silhouettes smaller than `least_m` in both directions
/// are skipped.
#[must_use]
pub fn outlines<'a>(members: impl Iterator<Item = &'a Member>, view: &ParallelView, least_m: f64) -> Vec<MemberOutline> {
    let towards = view.toward_viewer();
    let one = |member: &Member| {
        let corners = hull(&member.solid.vertices_m.iter().map(|v| view.at(*v)).collect::<Vec<_>>());
        let near_m = member.solid.vertices_m.iter().map(|v| v.dot(towards)).fold(f64::NEG_INFINITY, f64::max);
        MemberOutline { element: member.element, corners, near_m }
    };
    let mut found: Vec<MemberOutline> = members.map(one).filter(|outline| extent(&outline.corners) >= least_m).collect();
    found.sort_by(|a, b| a.near_m.total_cmp(&b.near_m));
    found
}

/// Returns the longer side of the vertices' bounding box in meters.
fn extent(corners: &[(f64, f64)]) -> f64 {
    let span = |f: fn(&(f64, f64)) -> f64| {
        let (low, high) = math::range(corners.iter().map(f));
        high - low
    };
    span(|c| c.0).max(span(|c| c.1))
}

/// A strip of water in plan view, from west to east, [`GROUND_SAMPLE_SPACING_M`] wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterStrip {
    /// West end, m east of the origin.
    pub west_m: f64,
    /// East end, m east of the origin.
    pub east_m: f64,
    /// Center line, m north of the origin.
    pub north_m: f64,
}

/// Returns the water in plan view as strips between the shores.
#[must_use]
pub fn water_strips(scenario: &Scenario, site: &Site) -> Vec<WaterStrip> {
    let terrain = &scenario.terrain;
    let half = 0.5 * terrain.size_m;
    let count = (terrain.size_m / GROUND_SAMPLE_SPACING_M).floor().clamp(1.0, 400.0) as usize;
    let coordinate = |k: usize| -half + (k as f64 + 0.5) * 2.0 * half / count as f64;
    let mut strips = Vec::new();
    for row in 0..count {
        let north_m = coordinate(row);
        let depth = |column: usize| terrain.water_level_m - site.ground_up_m(coordinate(column), north_m);
        let mut wet: Option<f64> = None;
        for column in 0..count {
            let (now, e) = (depth(column), coordinate(column));
            let shore = if column == 0 { e } else { crossing((coordinate(column - 1), depth(column - 1)), (e, now)) };
            match wet {
                None if now > 0.0 => wet = Some(shore),
                Some(west_m) if now <= 0.0 => {
                    strips.push(WaterStrip { west_m, east_m: shore, north_m });
                    wet = None;
                }
                None | Some(_) => {}
            }
        }
        strips.extend(wet.map(|west_m| WaterStrip { west_m, east_m: half, north_m }));
    }
    strips
}

/// Returns the zero crossing between two samples.
fn crossing(a: (f64, f64), b: (f64, f64)) -> f64 {
    if (a.1 > 0.0) == (b.1 > 0.0) { b.0 } else { a.0 + (b.0 - a.0) * a.1 / (a.1 - b.1) }
}

/// Returns the ground below a horizontal line as a drawing of a side view: m right and up, from `from` to `to` to the right.
/// `through_m` is a point of the line.
#[must_use]
pub fn ground_profile(
    scenario: &Scenario,
    site: &Site,
    view: &ParallelView,
    through_m: Vec3<Enu>,
    (from, to): (f64, f64),
) -> Vec<(f64, f64)> {
    let middle = view.at(through_m).0;
    let count = ((to - from) / GROUND_SAMPLE_SPACING_M).ceil().clamp(1.0, 400.0) as usize;
    let half = 0.5 * scenario.terrain.size_m;
    let sample = |k: usize| {
        let along = from + (to - from) * k as f64 / count as f64;
        let at = through_m + view.right * (along - middle);
        (along, site.ground_up_m(at.east().clamp(-half, half), at.north().clamp(-half, half)))
    };
    (0..=count).map(sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_hull_omits_inner_and_edge_points() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0), (1.0, 0.0), (2.0, 1.0), (0.0, 0.0)];
        assert_eq!(hull(&points), [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
    }

    #[test]
    fn exact_shore_is_at_zero_depth() {
        assert_eq!(crossing((0.0, 1.0), (10.0, -4.0)), 2.0);
    }

    #[test]
    fn exact_views_are_orthonormal_and_face_the_viewer() {
        for view in [ParallelView::plan(), ParallelView::from_south(), ParallelView::oblique(30.0, 25.0)] {
            assert!(view.right.dot(view.up).abs() < 1e-12);
            assert!((view.right.norm() - 1.0).abs() < 1e-12 && (view.up.norm() - 1.0).abs() < 1e-12);
        }
        assert!((ParallelView::plan().toward_viewer() - Vec3::new(0.0, 0.0, 1.0)).norm() < 1e-12, "the plan view looks down");
        assert!((ParallelView::from_south().toward_viewer() - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        // The view looks north and down, so the viewer is to the south and above.
        let towards = ParallelView::oblique(0.0, 30.0).toward_viewer();
        assert!((towards - Vec3::new(0.0, -math::cos(30f64.to_radians()), 0.5)).norm() < 1e-12, "{towards:?}");
    }
}
