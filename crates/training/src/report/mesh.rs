//! Triangle mesh of the bridges for the 3D view, derived from the collision geometry.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::bridges::Member;

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

/// Maximum number of vertices of a member (estimate: more than any of a parametric bridge, and few enough for several scanned ones).
const MAX_MEMBER_VERTICES: usize = 10_000;

/// Converts the members to a triangle mesh. Members with more than 10,000 vertices are shown coarser. If the mesh exceeds 65,535 vertices,
/// the smallest members are skipped.
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
        let solid = member.solid.coarse(MAX_MEMBER_VERTICES);
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
