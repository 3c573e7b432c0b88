//! Line drawings of the site: parallel projections, member silhouettes, and the 3D view's triangle mesh, all derived
//! from the collision geometry. Details too small to see are skipped.

use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Bridge;
use spandrel_model::scenario::bridges::Member;

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

/// Returns the counterclockwise convex hull, without collinear points (Andrew's monotone chain).
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
        let (low, high) = corners.iter().map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    };
    span(|c| c.0).max(span(|c| c.1))
}

/// A triangle mesh with vertices quantized to 16-bit integers, relative to a corner of the site.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuantizedMesh {
    /// Position of the quantized vertex (0, 0, 0), m east, north, up.
    pub origin_m: [f64; 3],
    /// Quantization step, m.
    pub step_m: f64,
    /// Quantized vertices.
    pub corners: Vec<[u16; 3]>,
    /// Triangles as triples of vertex indices.
    pub triangles: Vec<[u16; 3]>,
}

/// Converts the members to a triangle mesh. If it exceeds 65,535 vertices, the smallest members are skipped.
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
    fn exact_hull_omits_inner_and_edge_points() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0), (1.0, 0.0), (2.0, 1.0), (0.0, 0.0)];
        assert_eq!(hull(&points), [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
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
