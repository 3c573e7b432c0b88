//! Boxes around the steel of a member: one for a prism. A surface of another shape may fill only a small part of its box, such as a whole
//! truss in one mesh, so it is halved until its pieces fill theirs.

use super::boxes::OrientedBox;
use super::plan_hull::hull;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Solid;
use nalgebra::Matrix3;

/// Length of a piece that is not halved any more, m (estimate: with bars of 0.3 m, the field near the nodes of a truss is at most twice that of
/// its separate bars; with pieces of 2 m, it is ten times as large).
const PIECE_M: f64 = 0.6;
/// Minimum area of the triangles in a piece that fills its box, as a share of the area of the box's sides (estimate: the sides of a bar
/// without its ends have more, the members of a truss less).
const FILLED_SHARE: f64 = 0.8;
/// Minimum thickness of a piece, m (estimate: thin sheet).
const MIN_THICKNESS_M: f64 = 0.002;
/// Length of the edges above which triangles are divided, m: pieces overlap by less.
const MAX_EDGE_M: f64 = 0.25;
/// Number of triangles from which a surface is sampled (estimate: 1 s of work).
const MAX_TRIANGLES: usize = 100_000;
/// Number of triangles from which the remaining ones of a surface stay whole (estimate: a few seconds of work).
const MAX_PARTS: usize = 10 * MAX_TRIANGLES;

type Triangle = [Vec3<Enu>; 3];

/// Returns the box around a prism, whose longest edge is its first axis; `None` without a volume.
pub(super) fn prism(solid: &Solid) -> Option<OrientedBox> {
    let edges: Vec<Vec3<Enu>> = solid.faces.iter().flat_map(|face| face_edges(solid, face)).collect();
    let axis = longest(edges.iter().copied())?.unit();
    let side = longest(edges.iter().map(|edge| *edge - axis * edge.dot(axis)))?.unit();
    let around = box_around([axis, side, axis.cross(side)], || solid.vertices_m.iter().copied());
    around.half_m.into_iter().all(|half| half > 0.0).then_some(around)
}

fn face_edges(solid: &Solid, face: &[u32]) -> Vec<Vec3<Enu>> {
    let next = face.iter().skip(1).chain(face.first());
    face.iter().zip(next).map(|(a, b)| solid.vertices_m[*b as usize] - solid.vertices_m[*a as usize]).collect()
}

fn longest(edges: impl Iterator<Item = Vec3<Enu>>) -> Option<Vec3<Enu>> {
    edges.max_by(|a, b| a.norm().total_cmp(&b.norm())).filter(|edge| edge.norm() > 0.0)
}

fn box_around<I: Iterator<Item = Vec3<Enu>>>(axes: [Vec3<Enu>; 3], points_m: impl Fn() -> I) -> OrientedBox {
    let ranges = axes.map(|axis| math::range(points_m().map(|point| point.dot(axis))));
    let half_m = ranges.map(|(low, high)| 0.5 * (high - low));
    let middle = |sum: Vec3<Enu>, (axis, (low, high)): (Vec3<Enu>, (f64, f64))| sum + axis * (0.5 * (low + high));
    OrientedBox { center_m: axes.into_iter().zip(ranges).fold(Vec3::zero(), middle), axes, half_m }
}

/// Returns the boxes around the pieces of a surface. The first axis of each is its longest.
pub(super) fn surface_pieces(solid: &Solid) -> Vec<OrientedBox> {
    let all = solid.triangles();
    let step = all.len().div_ceil(MAX_TRIANGLES).max(1);
    let sample: Vec<Triangle> = all.iter().step_by(step).map(|triangle| triangle.map(|k| solid.vertices_m[k as usize])).collect();
    let area_m2: f64 = sample.iter().map(area_m2).sum();
    let edge_m = MAX_EDGE_M.max((area_m2 / MAX_TRIANGLES as f64).sqrt());
    let mut triangles = Vec::new();
    for triangle in sample {
        // Long slivers would divide into many more than their area says.
        if triangles.len() < MAX_PARTS { divide(triangle, edge_m, &mut triangles) } else { triangles.push(triangle) }
    }
    let mut pieces = Vec::new();
    halve(triangles, step as f64, &mut pieces);
    pieces
}

fn area_m2([a, b, c]: &Triangle) -> f64 {
    0.5 * (*b - *a).cross(*c - *a).norm()
}

fn center_m([a, b, c]: &Triangle) -> Vec3<Enu> {
    (*a + *b + *c) / 3.0
}

/// Divides a triangle across its longest edge until no edge is longer than `edge_m`.
fn divide([a, b, c]: Triangle, edge_m: f64, out: &mut Vec<Triangle>) {
    let turned = [[a, b, c], [b, c, a], [c, a, b]];
    let length_m = |[from, to, _]: &Triangle| (*to - *from).norm();
    let [from, to, apex] = turned.into_iter().max_by(|x, y| length_m(x).total_cmp(&length_m(y))).unwrap_or(turned[0]);
    if length_m(&[from, to, apex]) <= edge_m {
        return out.push([a, b, c]);
    }
    let middle = from.lerp(to, 0.5);
    divide([from, middle, apex], edge_m, out);
    divide([middle, to, apex], edge_m, out);
}

/// Appends the box around the triangles, or the boxes around their halves if they don't fill it. Each triangle stands for `weight` of them.
fn halve(triangles: Vec<Triangle>, weight: f64, out: &mut Vec<OrientedBox>) {
    let Some(mut around) = smallest_box(&triangles) else { return };
    around.half_m = around.half_m.map(|half| half.max(0.5 * MIN_THICKNESS_M));
    let [a, b, c] = around.half_m;
    let filled_m2 = weight * triangles.iter().map(area_m2).sum::<f64>();
    if 2.0 * a > PIECE_M && filled_m2 < FILLED_SHARE * 8.0 * (a * b + b * c + c * a) {
        let is_behind = |triangle: &Triangle| (center_m(triangle) - around.center_m).dot(around.axes[0]) < 0.0;
        let (behind, ahead): (Vec<Triangle>, Vec<Triangle>) = triangles.into_iter().partition(is_behind);
        if !behind.is_empty() && !ahead.is_empty() {
            halve(behind, weight, out);
            return halve(ahead, weight, out);
        }
    }
    out.push(around);
}

/// Returns the box with the smallest sides among those along one of the principal axes, longest axis first; `None` without an area.
fn smallest_box(triangles: &[Triangle]) -> Option<OrientedBox> {
    let total_m2: f64 = triangles.iter().map(area_m2).sum();
    if total_m2 <= 0.0 {
        return None;
    }
    let middle = triangles.iter().fold(Vec3::zero(), |sum, triangle| sum + center_m(triangle) * (area_m2(triangle) / total_m2));
    let column = |p: Vec3<Enu>| nalgebra::Vector3::from(p.array());
    let moments = triangles.iter().fold(Matrix3::zeros(), |sum, triangle| {
        // Twelve times the mean square over a triangle.
        let outer = |p: Vec3<Enu>| column(p) * column(p).transpose();
        let corners = triangle.map(|corner| corner - middle);
        let squares = corners.iter().fold(outer(center_m(&corners) * 3.0), |sum, corner| sum + outer(*corner));
        sum + squares * area_m2(triangle)
    });
    let principal = moments.symmetric_eigen().eigenvectors;
    let boxes = (0..3).map(|k| {
        let axis = Vec3::new(principal[(0, k)], principal[(1, k)], principal[(2, k)]).unit();
        longest_first(&box_along(axis, triangles))
    });
    let sides = |one: &OrientedBox| one.half_m[0] * (one.half_m[1] + one.half_m[2]) + one.half_m[1] * one.half_m[2];
    boxes.min_by(|a, b| sides(a).total_cmp(&sides(b)))
}

/// Returns the box along an axis with the smallest section: one of its sides lies along a side of the outline.
fn box_along(axis: Vec3<Enu>, triangles: &[Triangle]) -> OrientedBox {
    let [u, v] = crate::mesh::vectors::across(axis.array()).map(|[x, y, z]| Vec3::<Enu>::new(x, y, z));
    let points_m = || triangles.iter().flatten().copied();
    let outline = hull(&points_m().map(|p| (p.dot(u), p.dot(v))).collect::<Vec<_>>());
    let next = outline.iter().skip(1).chain(outline.first());
    let directions = outline.iter().zip(next).map(|(from, to)| u * (to.0 - from.0) + v * (to.1 - from.1));
    let corners_m = || outline.iter().map(|(x, y)| u * *x + v * *y);
    let section = |direction: Vec3<Enu>| {
        let side = direction.unit();
        let [_, b, c] = box_around([axis, side, axis.cross(side)], corners_m).half_m;
        (b * c, side)
    };
    let smallest = directions.filter(|d| d.norm() > 0.0).map(section).min_by(|a, b| a.0.total_cmp(&b.0));
    let side = smallest.map_or(u, |(_, side)| side);
    box_around([axis, side, axis.cross(side)], points_m)
}

fn longest_first(around: &OrientedBox) -> OrientedBox {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| around.half_m[*b].total_cmp(&around.half_m[*a]));
    OrientedBox { axes: order.map(|k| around.axes[k]), half_m: order.map(|k| around.half_m[k]), ..*around }
}
