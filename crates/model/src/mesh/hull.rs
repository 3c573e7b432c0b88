//! Convex solids: a closed convex part with its own faces, and the convex hull of points.

use super::Mesh;
use super::faces::{ConvexPart, Face, bulge_m, faces, without_edge_points};
use super::topology::{Component, components};
use super::vectors::Point;
use super::weld::{weld, weld_within};
use rapier3d::parry::math::Vector;
use rapier3d::parry::transformation::try_convex_hull;

/// Maximum height of a vertex above the plane of a face at which a solid counts as convex, m (estimate: rounding errors of 32-bit floats
/// in the corners of long, narrow faces).
pub const CONVEX_TOLERANCE_M: f64 = 5e-4;
/// The same for parts in a file, m (estimate: rounding tilts small faces, and their planes extend over the whole part).
const READ_TOLERANCE_M: f64 = 0.01;
/// Minimum number of faces of a solid.
const MIN_FACES: usize = 4;
/// Minimum mean thickness of a part, m (estimate: thinner parts are surfaces without a volume).
const MIN_THICKNESS_M: f64 = 5e-4;
/// Maximum number of faces of a convex part (estimate: the time of a query grows with the number of faces).
pub const MAX_FACES: usize = 400;

/// Distances within which corners are merged, one after the other, until a hull is sound, m (estimate).
const SPACINGS_M: [f64; 4] = [5e-4, 2e-3, 8e-3, 0.03];

/// Returns a closed convex part with its own faces; `None` if it is not closed, too thin, or a vertex is farther than the tolerance above
/// the plane of a face.
#[must_use]
pub fn own_faces(part: &Component, faces: &[Face], tolerance_m: f64) -> Option<ConvexPart> {
    let is_simple = (MIN_FACES..=MAX_FACES).contains(&faces.len());
    let is_convex = || bulge_m(&part.mesh.vertices_m, faces, tolerance_m) <= tolerance_m;
    (part.open_edges == 0 && is_simple && part.mesh.is_thicker_than(MIN_THICKNESS_M) && is_convex())
        .then(|| without_edge_points(&part.mesh.vertices_m, faces))
}

/// Returns the convex hull of points, with planar faces if they can be merged and otherwise with triangles; `None` if it has no volume.
#[must_use]
pub fn hull(points_m: &[Point]) -> Option<ConvexPart> {
    let surface = hull_surface(points_m)?;
    let faces = faces(&surface);
    let is_convex =
        faces.len() >= MIN_FACES && bulge_m(&surface.mesh.vertices_m, &faces, CONVEX_TOLERANCE_M) <= CONVEX_TOLERANCE_M;
    Some(if is_convex { without_edge_points(&surface.mesh.vertices_m, &faces) } else { triangle_part(&surface) })
}

fn hull_surface(points_m: &[Point]) -> Option<Component> {
    let vectors: Vec<Vector> = points_m.iter().map(|p| Vector::new(p[0], p[1], p[2])).collect();
    let (corners, triangles) = try_convex_hull(&vectors).ok()?;
    let mesh = Mesh { vertices_m: corners.iter().map(|p| [p.x, p.y, p.z]).collect(), triangles };
    let mut parts = components(&weld(&mesh).mesh);
    let surface = if parts.len() == 1 { parts.swap_remove(0) } else { return None };
    (surface.open_edges == 0 && surface.mesh.is_thicker_than(MIN_THICKNESS_M)).then_some(surface)
}

fn triangle_part(surface: &Component) -> ConvexPart {
    ConvexPart {
        corners_m: surface.mesh.vertices_m.clone(),
        faces: surface.mesh.triangles.iter().map(|triangle| triangle.to_vec()).collect(),
    }
}

/// Returns a part that is still closed and convex after its corners were rounded to 32-bit floats, as in a file: the part itself, or the
/// hull of its corners with corners that are near each other merged; `None` if nothing is left of it then.
#[must_use]
pub fn sound(part: ConvexPart) -> Option<ConvexPart> {
    if is_sound(&part) {
        return Some(part);
    }
    let points = Mesh { vertices_m: part.corners_m, triangles: Vec::new() };
    SPACINGS_M.iter().find_map(|spacing_m| {
        let surface = hull_surface(&weld_within(&points, *spacing_m).mesh.vertices_m)?;
        let merged = without_edge_points(&surface.mesh.vertices_m, &faces(&surface));
        [merged, triangle_part(&surface)].into_iter().find(is_sound)
    })
}

fn is_sound(part: &ConvexPart) -> bool {
    let mut mesh = part.mesh();
    mesh.vertices_m.iter_mut().flatten().for_each(|value| *value = f64::from(*value as f32));
    read_solid(&mesh).is_ok()
}

/// Returns the convex solid of a part in a file.
///
/// # Errors
/// Returns the connected pieces of the mesh if they are not one closed convex solid.
pub fn read_solid(mesh: &Mesh) -> Result<ConvexPart, Vec<Component>> {
    let pieces = components(&weld(mesh).mesh);
    let solid = match &pieces[..] {
        [piece] => own_faces(piece, &faces(piece), READ_TOLERANCE_M),
        _ => None,
    };
    solid.ok_or(pieces)
}
