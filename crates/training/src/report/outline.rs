//! The site as drawn lines: parallel views of it, the silhouettes of its members in a view, and its triangles for the model that can be
//! turned. All from the geometry that collides; what is too small to be seen is left out.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Bridge;
use spandrel_model::scenario::bridges::Member;

/// A parallel view: what is to the right of the sheet, and what is up on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParallelView {
    /// Unit vector to the right.
    pub right: Vec3<Enu>,
    /// Unit vector up the sheet.
    pub up: Vec3<Enu>,
}

/// The silhouette of one member.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberOutline {
    /// AASHTO MBEI number.
    pub element: u32,
    /// Corners on the sheet, counter-clockwise, m right and up.
    pub corners: Vec<(f64, f64)>,
    /// How near it is to who looks, m.
    pub near_m: f64,
}

impl ParallelView {
    /// From above, north up.
    #[must_use]
    pub fn plan() -> Self {
        Self { right: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 1.0, 0.0) }
    }

    /// A bridge from its right side: along the deck to the right, up is up.
    #[must_use]
    pub fn side(bridge: &Bridge) -> Self {
        let (s, c) = math::sin_cos(bridge.heading_deg.to_radians());
        Self { right: Vec3::new(s, c, 0.0), up: Vec3::new(0.0, 0.0, 1.0) }
    }

    /// From the south.
    #[must_use]
    pub fn from_south() -> Self {
        Self { right: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 0.0, 1.0) }
    }

    /// From above and aside: looking towards `azimuth_deg` (clockwise from north), down by `down_deg`.
    #[must_use]
    pub fn oblique(azimuth_deg: f64, down_deg: f64) -> Self {
        let (s, c) = math::sin_cos(azimuth_deg.to_radians());
        let (sd, cd) = math::sin_cos(down_deg.to_radians());
        Self { right: Vec3::new(c, -s, 0.0), up: Vec3::new(s * sd, c * sd, cd) }
    }

    /// A point on the sheet, m right and up.
    #[must_use]
    pub fn at(&self, point_m: Vec3<Enu>) -> (f64, f64) {
        (point_m.dot(self.right), point_m.dot(self.up))
    }

    /// Towards who looks.
    #[must_use]
    pub fn towards(&self) -> Vec3<Enu> {
        self.right.cross(self.up)
    }
}

/// Convex hull, counter-clockwise, without points on its edges (Andrew's monotone chain).
#[must_use]
pub fn hull(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let turn = |a: (f64, f64), b: (f64, f64), c: (f64, f64)| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let chain = |points: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut chain: Vec<(f64, f64)> = Vec::new();
        for point in points {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) <= 0.0 {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut lower = chain(&mut sorted.iter().copied());
    lower.extend(chain(&mut sorted.iter().rev().copied()));
    lower
}

/// Silhouettes of the members, the farthest first; those smaller than `least_m` either way are left out.
#[must_use]
pub fn outlines<'a>(members: impl Iterator<Item = &'a Member>, view: &ParallelView, least_m: f64) -> Vec<MemberOutline> {
    let towards = view.towards();
    let one = |member: &Member| {
        let corners = hull(&member.solid.vertices_m.iter().map(|v| view.at(*v)).collect::<Vec<_>>());
        let near_m = member.solid.vertices_m.iter().map(|v| v.dot(towards)).fold(f64::NEG_INFINITY, f64::max);
        MemberOutline { element: member.element, corners, near_m }
    };
    let mut found: Vec<MemberOutline> = members.map(one).filter(|outline| extent(&outline.corners) >= least_m).collect();
    found.sort_by(|a, b| a.near_m.total_cmp(&b.near_m));
    found
}

/// The larger side of the box around some corners, m.
fn extent(corners: &[(f64, f64)]) -> f64 {
    let span = |f: fn(&(f64, f64)) -> f64| {
        let (low, high) = corners.iter().map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    };
    span(|c| c.0).max(span(|c| c.1))
}

/// Triangles in whole centimetres about a corner of the site, for 16-bit numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuantizedMesh {
    /// What zero means, m east, north, up.
    pub origin_m: [f64; 3],
    /// What one means, m.
    pub step_m: f64,
    /// Corners.
    pub corners: Vec<[u16; 3]>,
    /// Triangles.
    pub triangles: Vec<[u16; 3]>,
}

/// The members as triangles; those that would not fit 65,536 corners are left out, the smallest first.
#[must_use]
pub fn mesh(members: &[Member]) -> QuantizedMesh {
    let size = |member: &Member| {
        let v = &member.solid.vertices_m;
        v.iter().map(|a| (*a - v[0]).norm()).fold(0.0, f64::max)
    };
    let mut order: Vec<&Member> = members.iter().filter(|member| !member.solid.vertices_m.is_empty()).collect();
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let all = || order.iter().flat_map(|member| member.solid.vertices_m.iter());
    let low = all().fold([f64::INFINITY; 3], |low, v| std::array::from_fn(|k| low[k].min(v.array()[k])));
    let high = all().fold([f64::NEG_INFINITY; 3], |high, v| std::array::from_fn(|k| high[k].max(v.array()[k])));
    let widest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let mut mesh = QuantizedMesh { origin_m: low, step_m: (widest / f64::from(u16::MAX)).max(0.01), ..QuantizedMesh::default() };
    for member in order {
        let solid = &member.solid;
        if mesh.corners.len() + solid.vertices_m.len() > usize::from(u16::MAX) {
            break;
        }
        let first = mesh.corners.len();
        let step = mesh.step_m;
        let corner = |v: &Vec3<Enu>| std::array::from_fn(|k| ((v.array()[k] - low[k]) / step).round() as u16);
        mesh.corners.extend(solid.vertices_m.iter().map(corner));
        let index = |k: u32| u16::try_from(first + k as usize).unwrap_or(u16::MAX);
        mesh.triangles.extend(solid.triangles().into_iter().map(|triangle| triangle.map(index)));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_hull_of_a_square_with_points_inside_and_on_its_edges() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0), (1.0, 0.0), (2.0, 1.0), (0.0, 0.0)];
        assert_eq!(hull(&points), [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
    }

    #[test]
    fn exact_views_are_right_handed_and_square() {
        for view in [ParallelView::plan(), ParallelView::from_south(), ParallelView::oblique(30.0, 25.0)] {
            assert!(view.right.dot(view.up).abs() < 1e-12);
            assert!((view.right.norm() - 1.0).abs() < 1e-12 && (view.up.norm() - 1.0).abs() < 1e-12);
        }
        assert!((ParallelView::plan().towards() - Vec3::new(0.0, 0.0, 1.0)).norm() < 1e-12, "seen from above");
        assert!((ParallelView::from_south().towards() - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        // Looking north and down: who looks stands south and above.
        let towards = ParallelView::oblique(0.0, 30.0).towards();
        assert!((towards - Vec3::new(0.0, -math::cos(30f64.to_radians()), 0.5)).norm() < 1e-12, "{towards:?}");
    }
}
