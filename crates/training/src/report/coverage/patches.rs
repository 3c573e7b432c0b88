//! Inspectable surface: the part visible from at least one reference path point, sampled in patches of about 1 m².

use super::sight::{is_clear, reach_m};
use crate::report::context::ReviewContext;
use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::bridges::Solid;
use spandrel_model::site::visibility::MAX_INCIDENCE_RAD;

/// Side length of a patch, m.
const PATCH_SIZE_M: f64 = 1.0;
/// Minimum face area, m². Smaller faces, such as the edges of plates and posts, are skipped.
const MIN_FACE_AREA_M2: f64 = 0.1;
/// Distance between the surface and a sight line's start, m.
const SURFACE_OFFSET_M: f64 = 0.02;
/// Maximum number of reference points tested per patch, nearest first.
const MAX_POINTS_TESTED: usize = 8;

/// A patch of a member's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePatch {
    /// The member's element.
    pub element: Element,
    /// End point for lines of sight, slightly in front of the center, m.
    pub sight_line_end_m: Vec3<Enu>,
    /// Center of the patch, m.
    pub point_m: Vec3<Enu>,
    /// Unit normal that points out of the member.
    pub normal: Vec3<Enu>,
    /// Area that the patch represents, m².
    pub area_m2: f64,
}

/// Returns the patches that can be inspected from at least one reference path point.
#[must_use]
pub fn inspectable(scene: &ReviewContext<'_>) -> Vec<SurfacePatch> {
    let reach = reach_m(&scene.vehicle.camera);
    let stations: Vec<Vec3<Enu>> = scene.scenario.tasks.iter().flat_map(|task| task.path_m.iter().copied()).collect();
    let mut patches = Vec::new();
    for member in scene.site.members() {
        let near: Vec<Vec3<Enu>> = reference_points_within_reach(&member.solid, &stations, reach);
        if near.is_empty() {
            continue;
        }
        for (point_m, normal, area_m2) in sample_faces(&member.solid) {
            if is_visible_from(&near, (point_m, normal), reach, scene) {
                let (element, above_m) = (member.element, point_m + normal * SURFACE_OFFSET_M);
                patches.push(SurfacePatch { element, sight_line_end_m: above_m, point_m, normal, area_m2 });
            }
        }
    }
    patches
}

/// Returns the reference points within reach of a solid's bounding box.
fn reference_points_within_reach(solid: &Solid, stations: &[Vec3<Enu>], reach_m: f64) -> Vec<Vec3<Enu>> {
    let empty = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (low, high) =
        solid.vertices_m.iter().map(|v| v.array()).fold(empty, |(low, high), v| {
            (std::array::from_fn(|k| low[k].min(v[k])), std::array::from_fn(|k| high[k].max(v[k])))
        });
    let away_squared = |p: [f64; 3]| -> f64 { (0..3).map(|k| (low[k] - p[k]).max(p[k] - high[k]).max(0.0)).map(|d| d * d).sum() };
    stations.iter().copied().filter(|s| away_squared(s.array()) <= reach_m * reach_m).collect()
}

/// Samples a solid's faces and returns points with outward normals and areas.
fn sample_faces(solid: &Solid) -> Vec<(Vec3<Enu>, Vec3<Enu>, f64)> {
    let mut samples = Vec::new();
    for face in &solid.faces {
        let corners: Vec<Vec3<Enu>> = face.iter().filter_map(|k| solid.vertices_m.get(*k as usize).copied()).collect();
        let count = corners.len();
        let twice = (0..count).fold(Vec3::zero(), |sum, k| sum + corners[k].cross(corners[(k + 1) % count]));
        let (area, normal) = (0.5 * twice.norm(), twice.unit());
        if count < 3 || area < MIN_FACE_AREA_M2 {
            continue;
        }
        let inside = sample_polygon(&corners, normal);
        let each = area / inside.len() as f64;
        samples.extend(inside.into_iter().map(|point| (point, normal, each)));
    }
    samples
}

/// Returns grid points over a convex polygon, [`PATCH_SIZE_M`] apart, or the center of a smaller polygon.
fn sample_polygon(corners: &[Vec3<Enu>], normal: Vec3<Enu>) -> Vec<Vec3<Enu>> {
    let u = (corners[1] - corners[0]).unit();
    let v = normal.cross(u);
    let flat: Vec<(f64, f64)> = corners.iter().map(|c| ((*c - corners[0]).dot(u), (*c - corners[0]).dot(v))).collect();
    let span = |f: fn(&(f64, f64)) -> f64| math::range(flat.iter().map(f));
    let ((u_low, u_high), (v_low, v_high)) = (span(|p| p.0), span(|p| p.1));
    let steps = |low: f64, high: f64| ((high - low) / PATCH_SIZE_M).ceil().max(1.0) as usize;
    let (columns, rows) = (steps(u_low, u_high), steps(v_low, v_high));
    let mut points = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let a = u_low + (u_high - u_low) * (column as f64 + 0.5) / columns as f64;
            let b = v_low + (v_high - v_low) * (row as f64 + 0.5) / rows as f64;
            if is_inside(&flat, (a, b)) {
                points.push(corners[0] + u * a + v * b);
            }
        }
    }
    if points.is_empty() {
        let sum = corners.iter().fold(Vec3::zero(), |sum, corner| sum + *corner);
        points.push(sum / corners.len() as f64);
    }
    points
}

/// Returns whether a point is inside a convex polygon with counterclockwise vertices.
fn is_inside(flat: &[(f64, f64)], p: (f64, f64)) -> bool {
    (0..flat.len()).all(|k| {
        let (a, b) = (flat[k], flat[(k + 1) % flat.len()]);
        (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0) >= 0.0
    })
}

fn is_visible_from(
    stations: &[Vec3<Enu>],
    (point_m, normal): (Vec3<Enu>, Vec3<Enu>),
    reach_m: f64,
    scene: &ReviewContext<'_>,
) -> bool {
    let steepest = math::cos(MAX_INCIDENCE_RAD);
    let mut near: Vec<(f64, Vec3<Enu>)> = stations
        .iter()
        .map(|station| ((*station - point_m).norm(), *station))
        .filter(|(away, station)| *away <= reach_m && (*station - point_m).dot(normal) >= steepest * *away)
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.iter().take(MAX_POINTS_TESTED).any(|(_, station)| is_clear(*station, point_m + normal * SURFACE_OFFSET_M, scene))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a 4 m by 3 m by 2 m box.
    fn box_solid() -> Solid {
        let corner = |k: u32| {
            let pick = |bit: u32, length: f64| if k >> bit & 1 == 1 { length } else { 0.0 };
            Vec3::new(pick(0, 4.0), pick(1, 3.0), pick(2, 2.0))
        };
        let faces =
            vec![vec![0, 2, 3, 1], vec![4, 5, 7, 6], vec![0, 1, 5, 4], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]];
        Solid { vertices_m: (0..8).map(corner).collect(), faces, surface: None }
    }

    #[test]
    fn exact_box_patches_cover_its_surface() {
        let samples = sample_faces(&box_solid());
        let area: f64 = samples.iter().map(|sample| sample.2).sum();
        assert!((area - 2.0 * (12.0 + 8.0 + 6.0)).abs() < 1e-9, "{area}");
        assert_eq!(samples.len(), 2 * (12 + 8 + 6), "one patch per square meter");
        for (point, normal, _) in samples {
            let outside = point + normal * 0.01;
            let [e, n, u] = outside.array();
            assert!(!((0.0..=4.0).contains(&e) && (0.0..=3.0).contains(&n) && (0.0..=2.0).contains(&u)), "normals point outward");
        }
    }

    #[test]
    fn exact_small_triangle_has_one_sample() {
        let corners = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.0)];
        assert_eq!(sample_polygon(&corners, Vec3::new(0.0, 0.0, 1.0)).len(), 1, "a polygon smaller than a patch has one point");
    }
}
