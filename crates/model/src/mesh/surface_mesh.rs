//! The surface of a part that is not convex: its own triangles.

use super::Mesh;
use super::faces::FLAT_TOLERANCE_M;
use super::vectors::{Point, cross, dot, norm, polygon_area_vector, sub, unit};
use super::vertex_colors::{Color, ColorsByPlace};

/// Maximum number of triangles whose planar faces are merged (estimate: 0.5 s of work). A scan with more has hardly any planar faces.
const MAX_MERGED_TRIANGLES: usize = 200_000;
/// Minimum sine of the turn at a corner of a convex face (estimate: rounding errors of corners on a straight edge).
const MIN_TURN_SINE: f64 = -1e-4;

/// Triangles of a part, with the faces that they form.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceMesh {
    mesh: Mesh,
    faces: Vec<Vec<u32>>,
    is_closed: bool,
    colors: Vec<Color>,
}

impl SurfaceMesh {
    /// Creates the surface from triangles. Those without an area are omitted, and vertices with the same coordinates become one. `None`
    /// if no triangle is left.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Option<Self> {
        Self::with_colors(mesh, &[])
    }

    /// Creates the surface with a color for each vertex of the mesh, or with no colors; otherwise like [`Self::new`].
    #[must_use]
    pub fn with_colors(mesh: &Mesh, colors: &[Color]) -> Option<Self> {
        let (mut mesh, origins) = with_shared_vertices(mesh);
        let colors = origins.iter().map(|k| colors.get(*k as usize).copied()).collect::<Option<Vec<Color>>>().unwrap_or_default();
        // Without triangles that have become narrower than the precision of their corners, the surface would seem to have holes.
        let is_closed = is_closed(&mesh.triangles);
        mesh = without_slivers(&mesh);
        if mesh.triangles.is_empty() {
            return None;
        }
        if is_closed && mesh.volume_m3() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let faces = convex_faces(&mesh);
        Some(Self { mesh, faces, is_closed, colors })
    }

    /// Returns the vertices and triangles.
    #[must_use]
    pub const fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns the faces: convex polygons where triangles lie in one plane, and single triangles elsewhere.
    #[must_use]
    pub fn faces(&self) -> &[Vec<u32>] {
        &self.faces
    }

    /// Returns whether the triangles enclose a volume. An open surface has no inside.
    #[must_use]
    pub const fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Returns the color of each vertex; empty if they have none.
    #[must_use]
    pub fn colors(&self) -> &[Color] {
        &self.colors
    }

    /// Sets the colors of all vertices by their places.
    pub fn set_colors(&mut self, table: &ColorsByPlace) {
        self.colors = table.colors(&self.mesh.vertices_m);
    }

    /// Applies a function to each vertex.
    pub fn move_vertices(&mut self, place: impl Fn(Point) -> Point) {
        self.mesh.vertices_m.iter_mut().for_each(|vertex| *vertex = place(*vertex));
    }

    /// Returns the surface after its vertices were rounded to 32-bit floats, as in a file; `None` if nothing is left of it then.
    #[must_use]
    pub fn rounded(&self) -> Option<Self> {
        let mut mesh = self.mesh.clone();
        mesh.vertices_m.iter_mut().flatten().for_each(|value| *value = f64::from(*value as f32));
        Self::with_colors(&mesh, &self.colors)
    }
}

/// Returns the mesh with one vertex per place, without triangles that have fewer than three, and the number that each vertex had.
fn with_shared_vertices(mesh: &Mesh) -> (Mesh, Vec<u32>) {
    // Adding zero turns a negative zero into a positive one.
    let bits = |k: u32| mesh.vertices_m[k as usize].map(|value| (value + 0.0).to_bits());
    let mut used: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    used.sort_by_key(|k| (bits(*k), *k));
    let mut first = vec![0; mesh.vertices_m.len()];
    for group in used.chunk_by(|a, b| bits(*a) == bits(*b)) {
        group.iter().for_each(|k| first[*k as usize] = group[0]);
    }
    let mut number = vec![None; mesh.vertices_m.len()];
    let (mut shared, mut origins) = (Mesh::default(), Vec::new());
    for triangle in &mesh.triangles {
        let renumbered = triangle.map(|k| {
            let kept = first[k as usize];
            *number[kept as usize].get_or_insert_with(|| {
                shared.vertices_m.push(mesh.vertices_m[kept as usize]);
                origins.push(kept);
                shared.vertices_m.len() as u32 - 1
            })
        });
        let [a, b, c] = renumbered;
        if a != b && b != c && c != a {
            shared.triangles.push(renumbered);
        }
    }
    (shared, origins)
}

/// Returns the mesh without triangles that have no area.
fn without_slivers(mesh: &Mesh) -> Mesh {
    let has_area = |triangle: &[u32; 3]| norm(mesh.area_vector(*triangle)) > 0.0;
    Mesh { vertices_m: mesh.vertices_m.clone(), triangles: mesh.triangles.iter().copied().filter(has_area).collect() }
}

/// Returns whether each side of a triangle has another one in the opposite direction.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let key = |from: u32, to: u32| u64::from(from) << 32 | u64::from(to);
    let sides = |is_reversed: bool| {
        let one = move |triangle: &[u32; 3]| {
            let [a, b, c] = *triangle;
            [(a, b), (b, c), (c, a)].map(|(from, to)| if is_reversed { key(to, from) } else { key(from, to) })
        };
        let mut keys: Vec<u64> = triangles.iter().flat_map(one).collect();
        keys.sort_unstable();
        keys
    };
    sides(false) == sides(true)
}

/// An edge between two triangles in one plane, while faces are merged.
struct Inner {
    length_m: f64,
    ends: (u32, u32),
    triangles: [u32; 2],
}

/// Merges triangles in one plane to convex polygons, the longest edges between them first.
fn convex_faces(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut faces: Vec<Vec<u32>> = mesh.triangles.iter().map(|triangle| triangle.to_vec()).collect();
    if mesh.triangles.len() > MAX_MERGED_TRIANGLES {
        return faces;
    }
    // The face that each triangle belongs to: itself, or the triangle whose face has absorbed it.
    let mut owner: Vec<u32> = (0..faces.len() as u32).collect();
    for Inner { ends, triangles, .. } in inner_edges(mesh) {
        let [a, b] = triangles.map(|triangle| root(&mut owner, triangle));
        if a == b {
            continue;
        }
        if let Some(merged) = merged(mesh, (&faces[a as usize], &faces[b as usize]), ends) {
            faces[a as usize] = merged;
            faces[b as usize].clear();
            owner[b as usize] = a;
        }
    }
    faces.retain(|face| !face.is_empty());
    faces
}

fn root(owner: &mut [u32], triangle: u32) -> u32 {
    let mut at = triangle;
    while owner[at as usize] != at {
        owner[at as usize] = owner[owner[at as usize] as usize];
        at = owner[at as usize];
    }
    at
}

/// Returns the edges between two triangles, the longest first.
fn inner_edges(mesh: &Mesh) -> Vec<Inner> {
    let mut sides: Vec<(u32, u32, bool, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (k, [a, b, c]) in (0..).zip(&mesh.triangles) {
        sides.extend([(*a, *b), (*b, *c), (*c, *a)].map(|(from, to)| (from.min(to), from.max(to), from < to, k)));
    }
    sides.sort_unstable();
    let inner = |group: &[(u32, u32, bool, u32)]| match group {
        [(low, high, false, backward), (_, _, true, forward)] => {
            let length_m = norm(sub(mesh.vertices_m[*high as usize], mesh.vertices_m[*low as usize]));
            Some(Inner { length_m, ends: (*low, *high), triangles: [*forward, *backward] })
        }
        _ => None,
    };
    let mut edges: Vec<Inner> = sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter_map(inner).collect();
    edges.sort_by(|a, b| b.length_m.total_cmp(&a.length_m).then(a.ends.cmp(&b.ends)));
    edges
}

/// Returns the polygon of two faces that meet at the edge `from`-`to` of the first one; `None` unless it is planar and convex.
fn merged(mesh: &Mesh, (one, other): (&[u32], &[u32]), (from, to): (u32, u32)) -> Option<Vec<u32>> {
    let rotated = |face: &[u32], first: u32| -> Option<Vec<u32>> {
        let start = face.iter().position(|k| *k == first)?;
        Some(face[start..].iter().chain(&face[..start]).copied().collect())
    };
    // Around the first face from the end of the edge to its start, then around the other one to just before the end.
    let (mut polygon, rest) = (rotated(one, to)?, rotated(other, from)?);
    if polygon.last() != Some(&from) || rest.last() != Some(&to) {
        return None;
    }
    polygon.extend(&rest[1..rest.len() - 1]);
    let mut sorted = polygon.clone();
    sorted.sort_unstable();
    let repeats = sorted.windows(2).any(|pair| pair[0] == pair[1]);
    (!repeats && is_planar_and_convex(mesh, &polygon, one)).then_some(polygon)
}

/// Returns whether a polygon lies in the plane of one of its parts, and turns left at each corner or goes straight on.
fn is_planar_and_convex(mesh: &Mesh, polygon: &[u32], part: &[u32]) -> bool {
    let corners = |face: &[u32]| face.iter().map(|k| mesh.vertices_m[*k as usize]).collect::<Vec<_>>();
    let all = corners(polygon);
    let Some(normal) = unit(polygon_area_vector(&corners(part))) else { return false };
    let count = all.len();
    let is_flat = all.iter().all(|corner| dot(normal, sub(*corner, all[0])).abs() <= FLAT_TOLERANCE_M);
    let turns_left = |k: usize| {
        let (before, at, after) = (all[k], all[(k + 1) % count], all[(k + 2) % count]);
        let (arriving, leaving) = (sub(at, before), sub(after, at));
        dot(normal, cross(arriving, leaving)) >= MIN_TURN_SINE * norm(arriving) * norm(leaving)
            && dot(arriving, leaving) > -norm(arriving) * norm(leaving)
    };
    is_flat && (0..count).all(turns_left)
}

#[cfg(test)]
mod tests {
    use super::super::vectors::middle;
    use super::*;

    /// Returns a channel of 10 m with a base of 4 m and two walls, all 0.5 m thick and 2 m high, open upward. Each side is in triangles.
    pub(in super::super) fn channel() -> Mesh {
        let section = [[-2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.5, 2.0], [1.5, 0.5], [-1.5, 0.5], [-1.5, 2.0], [-2.0, 2.0]];
        let count = section.len() as u32;
        let vertices_m = [0.0, 10.0].into_iter().flat_map(|x| section.map(|[y, z]| [x, y, z])).collect();
        let mut triangles = Vec::new();
        for k in 0..count {
            let next = (k + 1) % count;
            triangles.extend([[k, next, count + next], [k, count + next, count + k]]);
        }
        for [a, b, c] in [[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]] {
            triangles.extend([[a, c, b], [count + a, count + b, count + c]]);
        }
        triangles.iter_mut().for_each(|triangle: &mut [u32; 3]| triangle.swap(1, 2));
        Mesh { vertices_m, triangles }
    }

    #[test]
    fn exact_a_channel_is_closed_and_its_faces_are_convex_polygons_of_the_same_area() {
        let surface = SurfaceMesh::new(&channel()).unwrap();
        assert!(surface.is_closed());
        assert!(
            (surface.mesh().volume_m3() - 10.0 * (4.0 * 0.5 + 2.0 * 1.5 * 0.5)).abs() < 1e-9,
            "{}",
            surface.mesh().volume_m3()
        );
        // Eight sides, and each end in three convex polygons.
        assert_eq!(surface.faces().len(), 14);
        let area_m2 = |face: &Vec<u32>| {
            let corners: Vec<_> = face.iter().map(|k| surface.mesh().vertices_m[*k as usize]).collect();
            assert!(middle(&corners).iter().all(|value| value.is_finite()));
            0.5 * norm(polygon_area_vector(&corners))
        };
        // Outside 4 + 2 + 2, tops 0.5 + 0.5, inside 1.5 + 3 + 1.5 m, each 10 m long; and two ends.
        let expected = 10.0 * 15.0 + 2.0 * 3.5;
        assert!((surface.faces().iter().map(area_m2).sum::<f64>() - expected).abs() < 1e-9);
    }

    #[test]
    fn exact_inward_triangles_are_turned_and_separate_vertices_are_shared() {
        let mut soup = Mesh::default();
        let channel = channel();
        for triangle in &channel.triangles {
            let first = soup.vertices_m.len() as u32;
            soup.vertices_m.extend(channel.corners(*triangle));
            soup.triangles.push([first, first + 2, first + 1]);
        }
        soup.triangles.push([0, 0, 1]);
        let surface = SurfaceMesh::new(&soup).unwrap();
        assert_eq!((surface.mesh().vertices_m.len(), surface.mesh().triangles.len()), (16, channel.triangles.len()));
        assert!(surface.is_closed() && surface.mesh().volume_m3() > 0.0);
        soup.triangles.remove(0);
        assert!(!SurfaceMesh::new(&soup).unwrap().is_closed());
        assert_eq!(SurfaceMesh::new(&Mesh { triangles: vec![[0, 0, 1]], ..soup }), None);
    }
}
