//! How the triangles of a welded mesh meet: neighbors, connected parts, holes and a common orientation.

use super::Mesh;
use super::vectors::{Point, across, add_scaled, dot, sub, unit};
use crate::math;
use std::collections::BTreeMap;

/// Angle below which two triangles at an edge coincide, rad (estimate: rounding errors of 32-bit floats).
const COINCIDENT_ANGLE_RAD: f64 = 1e-6;

/// The three neighbors of a triangle, at the edges from its first, second and third vertex; `None` at an open edge.
pub type Neighbors = [Option<u32>; 3];

/// A connected part of a mesh, with all triangles facing outward if it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Triangles and vertices of the part only.
    pub mesh: Mesh,
    /// Neighbors of each triangle.
    pub neighbors: Vec<Neighbors>,
    /// Number of edges with a single triangle.
    pub open_edges: usize,
    /// Number of separate holes that the open edges surround.
    pub holes: usize,
}

/// A side of a triangle.
#[derive(Debug, Clone, Copy)]
struct HalfEdge {
    triangle: u32,
    side: u8,
    /// Whether the triangle runs through the edge from the lower to the higher vertex index.
    is_forward: bool,
}

/// A connection of two triangle sides.
#[derive(Debug, Clone, Copy)]
struct Link {
    ends: [HalfEdge; 2],
}

/// Divides a welded mesh into its connected parts, in the order of their first triangles. Where more than two triangles meet at an edge,
/// the two sides of a solid belong together.
#[must_use]
pub fn components(mesh: &Mesh) -> Vec<Component> {
    let links = links(mesh);
    let mut adjacent: Vec<Vec<(u32, bool)>> = vec![Vec::new(); mesh.triangles.len()];
    for Link { ends: [a, b] } in &links {
        let is_same_orientation = a.is_forward != b.is_forward;
        adjacent[a.triangle as usize].push((b.triangle, is_same_orientation));
        adjacent[b.triangle as usize].push((a.triangle, is_same_orientation));
    }
    let mut flipped: Vec<Option<bool>> = vec![None; mesh.triangles.len()];
    let mut parts = Vec::new();
    for first in 0..mesh.triangles.len() as u32 {
        if flipped[first as usize].is_some() {
            continue;
        }
        flipped[first as usize] = Some(false);
        let mut members = vec![first];
        let mut next = 0;
        while let Some(triangle) = members.get(next).copied() {
            next += 1;
            let own = flipped[triangle as usize].unwrap_or_default();
            for (other, is_same) in &adjacent[triangle as usize] {
                let state = &mut flipped[*other as usize];
                if state.is_none() {
                    *state = Some(own == *is_same);
                    members.push(*other);
                }
            }
        }
        members.sort_unstable();
        parts.push(component(mesh, &members, &flipped));
    }
    parts
}

/// Extracts a part. `flipped` states which triangles must change their direction to face the same side.
fn component(mesh: &Mesh, members: &[u32], flipped: &[Option<bool>]) -> Component {
    let turned = members.iter().map(|k| {
        let [a, b, c] = mesh.triangles[*k as usize];
        if flipped[*k as usize] == Some(true) { [a, c, b] } else { [a, b, c] }
    });
    let mut part = mesh.part(&turned.collect::<Vec<_>>());
    if part.volume_m3() < 0.0 {
        part.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let neighbors = neighbors(&part);
    let (open_edges, holes) = holes(&part, &neighbors);
    Component { mesh: part, neighbors, open_edges, holes }
}

/// Returns the neighbors of all triangles.
fn neighbors(mesh: &Mesh) -> Vec<Neighbors> {
    let mut neighbors = vec![[None; 3]; mesh.triangles.len()];
    for Link { ends: [a, b] } in links(mesh) {
        neighbors[a.triangle as usize][usize::from(a.side)] = Some(b.triangle);
        neighbors[b.triangle as usize][usize::from(b.side)] = Some(a.triangle);
    }
    neighbors
}

/// Returns the connections between the sides of triangles.
fn links(mesh: &Mesh) -> Vec<Link> {
    let mut edges: Vec<((u32, u32), HalfEdge)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (k, triangle) in mesh.triangles.iter().enumerate() {
        for side in 0..3u8 {
            let (from, to) = (triangle[usize::from(side)], triangle[(usize::from(side) + 1) % 3]);
            let half = HalfEdge { triangle: k as u32, side, is_forward: from < to };
            edges.push(((from.min(to), from.max(to)), half));
        }
    }
    edges.sort_unstable_by_key(|(edge, half)| (*edge, half.triangle));
    let mut links = Vec::with_capacity(edges.len() / 2);
    for group in edges.chunk_by(|a, b| a.0 == b.0) {
        match group {
            [_] => {}
            [a, b] => links.push(Link { ends: [a.1, b.1] }),
            _ => links.extend(links_of_crowded_edge(mesh, group)),
        }
    }
    links
}

/// Connects the sides of more than two triangles at an edge in pairs, each with the smallest angle of solid between them.
fn links_of_crowded_edge(mesh: &Mesh, group: &[((u32, u32), HalfEdge)]) -> Vec<Link> {
    let ((from, to), _) = group[0];
    let (start, end) = (mesh.vertices_m[from as usize], mesh.vertices_m[to as usize]);
    let along = unit(sub(end, start)).unwrap_or([0.0, 0.0, 1.0]);
    let [u, v] = across(along);
    let angle_rad = |half: &HalfEdge| {
        let opposite: Point = mesh.corners(mesh.triangles[half.triangle as usize])[(usize::from(half.side) + 2) % 3];
        let away = sub(opposite, start);
        let away = add_scaled(away, along, -dot(away, along));
        math::atan2(dot(away, v), dot(away, u))
    };
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, (_, a)) in group.iter().enumerate().filter(|(_, (_, half))| half.is_forward) {
        for (j, (_, b)) in group.iter().enumerate().filter(|(_, (_, half))| !half.is_forward) {
            // The solid is behind both triangles: it extends from the backward one to the forward one around the edge.
            let solid_rad = (angle_rad(a) - angle_rad(b)).rem_euclid(math::TAU);
            let solid_rad = if solid_rad < COINCIDENT_ANGLE_RAD { solid_rad + math::TAU } else { solid_rad };
            pairs.push((solid_rad, i, j));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut is_used = vec![false; group.len()];
    let mut links = Vec::new();
    for (_, i, j) in pairs {
        if !is_used[i] && !is_used[j] {
            (is_used[i], is_used[j]) = (true, true);
            links.push(Link { ends: [group[i].1, group[j].1] });
        }
    }
    links
}

/// Returns the lowest vertex of the hole that a vertex belongs to.
fn root(group: &mut BTreeMap<u32, u32>, vertex: u32) -> u32 {
    let mut at = vertex;
    while let Some(next) = group.get(&at).copied().filter(|next| *next != at) {
        at = next;
    }
    group.insert(vertex, at);
    at
}

/// Returns the number of open edges and the number of separate holes.
fn holes(mesh: &Mesh, neighbors: &[Neighbors]) -> (usize, usize) {
    let mut group: BTreeMap<u32, u32> = BTreeMap::new();
    let mut open_edges = 0;
    for (triangle, sides) in mesh.triangles.iter().zip(neighbors) {
        for side in (0..3).filter(|side| sides[*side].is_none()) {
            open_edges += 1;
            let (a, b) = (root(&mut group, triangle[side]), root(&mut group, triangle[(side + 1) % 3]));
            group.insert(a.max(b), a.min(b));
        }
    }
    let holes = group.iter().filter(|(vertex, parent)| vertex == parent).count();
    (open_edges, holes)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::weld::weld;
    use super::*;

    /// Returns a mesh with all triangles of the given ones.
    pub(in super::super) fn joined(meshes: &[Mesh]) -> Mesh {
        let mut all = Mesh::default();
        meshes.iter().for_each(|mesh| all.append(mesh));
        all
    }

    /// Tolerance for rounding errors of volumes, m³.
    const VOLUME_TOLERANCE_M3: f64 = 1e-12;

    #[test]
    fn exact_solids_that_touch_in_a_face_or_an_edge_stay_separate() {
        let touching = joined(&[
            Mesh::of_box([0.0; 3], [1.0; 3]),
            Mesh::of_box([1.0, 0.0, 0.0], [3.0, 1.0, 1.0]),
            Mesh::of_box([0.0, 1.0, 1.0], [1.0, 2.0, 2.0]),
        ]);
        let parts = components(&weld(&touching).mesh);
        let volumes: Vec<f64> = parts.iter().map(|part| part.mesh.volume_m3()).collect();
        assert_eq!(parts.iter().map(|part| (part.mesh.triangles.len(), part.open_edges)).collect::<Vec<_>>(), [(12, 0); 3]);
        for (volume, expected) in volumes.iter().zip([1.0, 2.0, 1.0]) {
            assert!((volume - expected).abs() < VOLUME_TOLERANCE_M3, "{volumes:?}");
        }
    }

    #[test]
    fn exact_holes_are_counted_and_directions_become_the_same() {
        let mut mesh = Mesh::of_box([0.0; 3], [2.0, 1.0, 1.0]);
        // Two opposite sides are missing one triangle each, and some triangles face inward.
        mesh.triangles.remove(11);
        mesh.triangles.remove(9);
        mesh.triangles[3].swap(0, 1);
        mesh.triangles[5].swap(0, 1);
        let parts = components(&mesh);
        assert_eq!((parts.len(), parts[0].open_edges, parts[0].holes), (1, 6, 2));
        let mut inward = Mesh::of_box([0.0; 3], [2.0, 1.0, 1.0]);
        inward.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        let turned = &components(&inward)[0];
        assert!((turned.mesh.volume_m3() - 2.0).abs() < VOLUME_TOLERANCE_M3);
    }
}
