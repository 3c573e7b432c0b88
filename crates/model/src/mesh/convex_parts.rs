//! Turns connected parts of a mesh into convex solids.

use super::Mesh;
use super::bsp;
use super::faces::ConvexPart;
use super::faces::faces;
use super::hull::{CONVEX_TOLERANCE_M, MAX_FACES, hull, own_faces};
use super::plane_solid::PlaneSolid;
use super::topology::Component;
use super::vectors::{Point, dot, middle};
use rapier3d::parry::math::Vector;
use rapier3d::parry::transformation::vhacd::{VHACD, VHACDParameters};

/// Number of extreme points of a simplified hull: a hull of n points has at most 2 n triangles.
const EXTREME_POINTS: usize = MAX_FACES / 2;
/// Maximum number of planar faces of a part that is cut exactly; a part with more is approximated by voxels (estimate: 1 s of work).
const MAX_EXACT_FACES: usize = 1_500;
/// Maximum number of convex parts that replace one connected part.
pub const MAX_PARTS: usize = 256;
/// Share of the volume that the approximation by voxels may add to a convex part (estimate: a curved, rough rib of 60 m becomes 19 parts
/// that deviate by 0.11 m; with parry's default of 0.01, 8 parts that deviate by 0.27 m).
const VOXEL_CONCAVITY: f64 = 0.002;
/// Maximum number of points at which the deviation is measured.
const MAX_SAMPLES: usize = 20_000;

/// Angle between two points of a spiral that covers a sphere evenly, rad.
const GOLDEN_ANGLE_RAD: f64 = 2.399_963_229_728_653;

/// How a part became convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The part is convex: its own faces.
    Convex,
    /// The part is nearly convex, or a convex part with holes: its hull.
    Hull,
    /// Cut along its own faces: exact.
    Cut,
    /// Approximated by the hulls of groups of voxels.
    Voxels,
}

impl Method {
    /// Returns the word for tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Convex => "convex",
            Self::Hull => "hull",
            Self::Cut => "cut",
            Self::Voxels => "voxels",
        }
    }
}

/// Convex solids that replace a connected part.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexParts {
    /// The solids.
    pub parts: Vec<ConvexPart>,
    /// How they were made.
    pub method: Method,
    /// Largest distance of the sampled points of the part's surface from the surface of the solids, m.
    pub deviation_m: f64,
}

/// Limits of the conversion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvexLimits {
    /// Maximum deviation at which the hull replaces a part, m.
    pub tolerance_m: f64,
    /// Number of voxels along the longest side of a part that is approximated.
    pub resolution: u32,
}

/// Converts a connected part to convex solids; `None` if it has no volume.
#[must_use]
pub fn convex_parts(part: &Component, limits: ConvexLimits) -> Option<ConvexParts> {
    let own = faces(part);
    if let Some(solid) = own_faces(part, &own, CONVEX_TOLERANCE_M) {
        return Some(ConvexParts { parts: vec![solid], method: Method::Convex, deviation_m: 0.0 });
    }
    let whole = hull(&part.mesh.vertices_m)?;
    let of_hull = deviation_m(&part.mesh, std::slice::from_ref(&whole));
    if of_hull <= limits.tolerance_m {
        let parts = vec![if whole.faces.len() > MAX_FACES { simple_hull(&part.mesh.vertices_m)? } else { whole }];
        return Some(ConvexParts { method: Method::Hull, deviation_m: deviation_m(&part.mesh, &parts), parts });
    }
    let cut =
        (part.open_edges == 0 && own.len() <= MAX_EXACT_FACES).then(|| bsp::convex_cells(&part.mesh, &own, MAX_PARTS)).flatten();
    let (parts, method) = match cut {
        Some(parts) => (parts, Method::Cut),
        None => (voxel_parts(&part.mesh, limits.resolution), Method::Voxels),
    };
    let deviation_m = deviation_m(&part.mesh, &parts);
    (!parts.is_empty()).then_some(ConvexParts { parts, method, deviation_m })
}

/// Returns the hulls of groups of voxels that fill the mesh.
fn voxel_parts(mesh: &Mesh, resolution: u32) -> Vec<ConvexPart> {
    let points: Vec<Vector> = mesh.vertices_m.iter().map(|p| Vector::new(p[0], p[1], p[2])).collect();
    let settings = VHACDParameters {
        resolution,
        concavity: VOXEL_CONCAVITY,
        max_convex_hulls: MAX_PARTS as u32,
        ..VHACDParameters::default()
    };
    let groups = VHACD::decompose(&settings, &points, &mesh.triangles, true);
    let cut = groups.compute_primitive_intersections(&points, &mesh.triangles);
    cut.iter().filter_map(|group| simple_hull(&group.iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>())).collect()
}

/// Returns the hull of points, or of their extreme points in evenly distributed directions if it had too many faces.
fn simple_hull(points_m: &[Point]) -> Option<ConvexPart> {
    let exact = hull(points_m);
    if exact.as_ref().is_some_and(|part| part.faces.len() <= MAX_FACES) {
        return exact;
    }
    let extreme = directions(EXTREME_POINTS)
        .filter_map(|direction| points_m.iter().copied().max_by(|a, b| dot(direction, *a).total_cmp(&dot(direction, *b))));
    hull(&extreme.collect::<Vec<_>>())
}

/// Returns unit vectors on a spiral around a sphere.
fn directions(count: usize) -> impl Iterator<Item = Point> {
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (s, c) = crate::math::sin_cos(GOLDEN_ANGLE_RAD * k as f64);
        let radius = (1.0 - z * z).sqrt();
        [radius * c, radius * s, z]
    })
}

/// Returns the largest distance of points on a mesh from the surface of convex parts: its vertices and the middles of its triangles, or
/// an even selection of them.
#[must_use]
pub fn deviation_m(mesh: &Mesh, parts: &[ConvexPart]) -> f64 {
    let solids: Vec<PlaneSolid> = parts.iter().map(PlaneSolid::new).collect();
    let middles = mesh.triangles.iter().map(|triangle| middle(&mesh.corners(*triangle)));
    let step = ((mesh.vertices_m.len() + mesh.triangles.len()) / MAX_SAMPLES).max(1);
    let samples = mesh.vertices_m.iter().copied().chain(middles).step_by(step);
    let nearest_m = |p: Point| solids.iter().map(|solid| solid.distance_m(p)).fold(f64::INFINITY, f64::min).abs();
    samples.map(nearest_m).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::topology::components;
    use super::super::topology::tests::joined;
    use super::super::weld::weld;
    use super::*;

    const LIMITS: ConvexLimits = ConvexLimits { tolerance_m: 0.01, resolution: 64 };

    fn converted(mesh: &Mesh) -> ConvexParts {
        let part = components(&weld(mesh).mesh).swap_remove(0);
        convex_parts(&part, LIMITS).unwrap()
    }

    #[test]
    fn exact_a_box_keeps_its_faces_and_an_open_one_becomes_its_hull() {
        let closed = converted(&Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]));
        assert_eq!((closed.method, closed.parts[0].faces.len(), closed.deviation_m), (Method::Convex, 6, 0.0));
        let mut open = Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]);
        open.triangles.truncate(10);
        let hull = converted(&open);
        assert_eq!((hull.method, hull.parts[0].faces.len()), (Method::Hull, 6));
        assert!((hull.parts[0].mesh().volume_m3() - 2.0).abs() < 1e-9);
    }

    #[test]
    fn exact_a_flat_part_has_no_volume() {
        let mut flat = Mesh::of_box([0.0; 3], [4.0, 1.0, 0.5]);
        flat.triangles.truncate(2);
        let part = components(&flat).swap_remove(0);
        assert_eq!(convex_parts(&part, LIMITS), None);
    }

    #[test]
    fn exact_voxels_are_the_same_every_time_and_near_the_surface() {
        // A ring of stones: neither convex nor, here, cut exactly.
        let stones: Vec<Mesh> = (0..24)
            .map(|k| {
                let angle = f64::from(k) * crate::math::TAU / 24.0;
                let (s, c) = crate::math::sin_cos(angle);
                Mesh::of_box([5.0 * c - 1.0, 5.0 * s - 1.0, 0.0], [5.0 * c + 1.0, 5.0 * s + 1.0, 2.0])
            })
            .collect();
        let mesh = joined(&stones);
        let parts = voxel_parts(&mesh, 48);
        assert_eq!(parts, voxel_parts(&mesh, 48));
        /// Two voxels of 12 m / 48.
        const TOLERANCE_M: f64 = 0.5;
        let outside = |p: &Point| parts.iter().all(|part| PlaneSolid::new(part).distance_m(*p) > TOLERANCE_M);
        assert!(parts.len() > 2 && !mesh.vertices_m.iter().any(outside), "{}", parts.len());
    }
}
