//! Distances from polygons and edges, and level loops around polygons.

use super::path::{SPACING_M, equal_steps};
use crate::math;

/// A point in plan, in bridge axes: along the bridge and to the left, m.
pub(super) type PlanPoint = [f64; 2];

/// Returns the distance from a point outside a polygon to its outline in meters.
pub(super) fn distance_m(polygon: &[PlanPoint], point: PlanPoint) -> f64 {
    let edges = (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]));
    edges.map(|(a, b)| edge_distance_m(a, b, point)).fold(f64::INFINITY, f64::min)
}

fn edge_distance_m(a: PlanPoint, b: PlanPoint, point: PlanPoint) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 { (((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    math::hypot(point[0] - a[0] - share * dx, point[1] - a[1] - share * dy)
}

/// Returns the points of a loop around a convex polygon (counterclockwise), at a distance in meters from its edges and rounded at its
/// corners, and the unit vectors that point away from it.
pub(super) fn loop_around(polygon: &[PlanPoint], off_m: f64) -> (Vec<PlanPoint>, Vec<[f64; 2]>) {
    let count = polygon.len();
    let outward = |k: usize| {
        let (a, b) = (polygon[k % count], polygon[(k + 1) % count]);
        let length = math::hypot(b[0] - a[0], b[1] - a[1]);
        [(b[1] - a[1]) / length, (a[0] - b[0]) / length]
    };
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    let mut add = |[x, y]: PlanPoint, [nx, ny]: [f64; 2]| {
        points.push([x + off_m * nx, y + off_m * ny]);
        normals.push([nx, ny]);
    };
    for k in 0..count {
        let (corner, next) = (polygon[k], polygon[(k + 1) % count]);
        let (before, after) = (outward(k + count - 1), outward(k));
        let start = math::atan2(before[1], before[0]);
        let turn = math::atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
        let steps = (turn * off_m / SPACING_M).ceil().max(1.0);
        for step in 0..=steps as i32 {
            let (s, c) = math::sin_cos(start + turn * f64::from(step) / steps);
            add(corner, [c, s]);
        }
        // The line along the edge, without its ends, which are parts of the corners.
        let along = equal_steps(0.0, math::hypot(next[0] - corner[0], next[1] - corner[1]));
        let last = along.len() - 1;
        for share in along.iter().take(last).skip(1).map(|d| d / along[last]) {
            add([math::lerp(corner[0], next[0], share), math::lerp(corner[1], next[1], share)], after);
        }
    }
    (points, normals)
}

/// Returns the height at x below all circles with a radius around the points of an edge above it, in meters: a path there keeps this
/// distance from the edge. Infinite if the edge is farther away. Both ends are positions along the bridge and heights, with increasing positions.
pub(super) fn height_below_edge_m((from, to): ([f64; 2], [f64; 2]), x: f64, radius_m: f64) -> f64 {
    let (start, end) = ((from[0] - x).max(-radius_m), (to[0] - x).min(radius_m));
    if start > end {
        return f64::INFINITY;
    }
    let slope = (to[1] - from[1]) / (to[0] - from[0]);
    // The circle around this point touches the edge; near its ends, those around the ends are lower.
    let aside_m = (-slope * radius_m / (1.0 + slope * slope).sqrt()).clamp(start, end);
    from[1] + slope * (x + aside_m - from[0]) - (radius_m * radius_m - aside_m * aside_m).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rounding errors, m.
    const ROUNDING_M: f64 = 1e-9;

    #[test]
    fn exact_loop_keeps_its_distance_and_closes() {
        let hexagon = [[-1.0, -4.0], [0.0, -5.5], [1.0, -4.0], [1.0, 4.0], [0.0, 5.5], [-1.0, 4.0]];
        let (points, normals) = loop_around(&hexagon, 3.0);
        for (point, normal) in points.iter().zip(&normals) {
            assert!((distance_m(&hexagon, *point) - 3.0).abs() < ROUNDING_M, "{point:?}");
            assert!((math::hypot(normal[0], normal[1]) - 1.0).abs() < ROUNDING_M);
        }
        for (k, point) in points.iter().enumerate() {
            let next = points[(k + 1) % points.len()];
            let step_m = math::hypot(next[0] - point[0], next[1] - point[1]);
            assert!((0.1..=SPACING_M + ROUNDING_M).contains(&step_m), "{k}: {step_m}");
        }
    }

    #[test]
    fn exact_height_below_an_edge_touches_its_circle() {
        let edge = ([0.0, 10.0], [4.0, 13.0]);
        // The slope is 3/4: at the distance of 2 m, the line is 2.5 m lower.
        assert!((height_below_edge_m(edge, 3.2, 2.0) - (10.0 + 0.75 * 3.2 - 2.5)).abs() < ROUNDING_M);
        // Beside the lower end, the circle around it is nearest.
        assert!((height_below_edge_m(edge, -1.0, 2.0) - (10.0 - 3.0_f64.sqrt())).abs() < ROUNDING_M);
        assert_eq!(height_below_edge_m(edge, -2.5, 2.0), f64::INFINITY);
    }
}
