//! Surface coverage: which share of what could be inspected from the reference paths the pictures show well enough, and how much of it
//! the camera had in view while flying. Surfaces are sampled by patches of about a square metre.

use super::Scene;
use super::pictures::{Picture, exposure_s};
use crate::base::frames::{Enu, Vec3};
use crate::base::math;
use crate::base::time::SimTime;
use crate::monitor::measures::attention;
use crate::scenario::bridges::Solid;
use crate::site::CameraPose;
use crate::site::look::{INCIDENCE_MAX_RAD, LINE_WIDTH_MIN_PX, lamp_lux, needed_lux};
use crate::vehicle::Camera;
use std::collections::BTreeMap;

/// A crack of this width separates condition states 2 and 3 of reinforced concrete (0.05 in, AASHTO MBEI), m.
const CRACK_M: f64 = 0.001_27;
/// Size of a pixel on the surface at which that crack covers the half pixel that a hit needs, m.
pub const REQUIRED_GSD_M: f64 = CRACK_M / LINE_WIDTH_MIN_PX;
/// Smear beyond this is blurred, px (published practice for detection: one pixel).
pub const BLUR_MAX_PX: f64 = 1.0;
/// Side of a patch, m.
const PATCH_M: f64 = 1.0;
/// Smaller faces are left out: edges of plates and posts, m².
const LEAST_FACE_M2: f64 = 0.1;
/// Start of a sight line over the surface, m.
const LIFT_M: f64 = 0.02;
/// Points of the reference paths that are asked per patch, nearest first.
const TRIES: usize = 8;
/// The camera's view while flying is asked this often.
const VIEW_STEP: SimTime = SimTime::from_ms(2_000);
/// Patches of one orientation within this distance share their ambient light, m.
const LIGHT_CELL_M: f64 = 5.0;

/// What was seen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Coverage {
    /// By element, in the order of their numbers.
    pub elements: Vec<Element>,
}

/// One element's surface, m².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Element {
    /// AASHTO MBEI number.
    pub element: u32,
    /// What could be seen well from the reference paths.
    pub inspectable_m2: f64,
    /// Of it, what the camera had before it while flying, at the required size of a pixel and angle.
    pub in_view_m2: f64,
    /// Of it, what the pictures show at that size and angle.
    pub pictured_m2: f64,
    /// Of that, what was lit well enough.
    pub lit_m2: f64,
    /// Of that, what is not smeared by the drone's motion.
    pub sharp_m2: f64,
}

struct Patch {
    element: u32,
    point_m: Vec3<Enu>,
    normal: Vec3<Enu>,
    area_m2: f64,
    in_view: bool,
    pictured: bool,
    lit: bool,
    sharp: bool,
}

/// Works out the coverage of a session.
#[must_use]
pub fn covered(scene: &Scene<'_>, pictures: &[Picture]) -> Coverage {
    let mut patches = inspectable(scene);
    let mut light = Light { scene, cells: BTreeMap::new() };
    for picture in pictures {
        see_picture(&mut patches, picture, &mut light);
    }
    see_flight(&mut patches, scene);
    let mut elements: BTreeMap<u32, Element> = BTreeMap::new();
    for patch in &patches {
        let sum = elements.entry(patch.element).or_insert(Element { element: patch.element, ..Element::default() });
        let area = |counts: bool| if counts { patch.area_m2 } else { 0.0 };
        sum.inspectable_m2 += patch.area_m2;
        sum.in_view_m2 += area(patch.in_view || patch.pictured);
        sum.pictured_m2 += area(patch.pictured);
        sum.lit_m2 += area(patch.lit);
        sum.sharp_m2 += area(patch.sharp);
    }
    Coverage { elements: elements.into_values().collect() }
}

impl Coverage {
    /// All elements together.
    #[must_use]
    pub fn total(&self) -> Element {
        self.elements.iter().fold(Element::default(), |sum, one| Element {
            element: 0,
            inspectable_m2: sum.inspectable_m2 + one.inspectable_m2,
            in_view_m2: sum.in_view_m2 + one.in_view_m2,
            pictured_m2: sum.pictured_m2 + one.pictured_m2,
            lit_m2: sum.lit_m2 + one.lit_m2,
            sharp_m2: sum.sharp_m2 + one.sharp_m2,
        })
    }
}

/// Distance at which a pixel covers the required size, m.
#[must_use]
pub fn reach_m(camera: &Camera) -> f64 {
    REQUIRED_GSD_M * camera.focal_px()
}

/// Patches that some point of a reference path sees well.
fn inspectable(scene: &Scene<'_>) -> Vec<Patch> {
    let reach = reach_m(&scene.vehicle.camera);
    let stations: Vec<Vec3<Enu>> = scene.scenario.tasks.iter().flat_map(|task| task.path_m.iter().copied()).collect();
    let mut patches = Vec::new();
    for member in scene.site.members() {
        let near: Vec<Vec3<Enu>> = near_to(&member.solid, &stations, reach);
        if near.is_empty() {
            continue;
        }
        for (point_m, normal, area_m2) in sampled(&member.solid) {
            if seen_from(&near, (point_m, normal), reach, scene) {
                let element = member.element;
                patches.push(Patch {
                    element,
                    point_m,
                    normal,
                    area_m2,
                    in_view: false,
                    pictured: false,
                    lit: false,
                    sharp: false,
                });
            }
        }
    }
    patches
}

/// The stations within reach of a solid's bounding box.
fn near_to(solid: &Solid, stations: &[Vec3<Enu>], reach_m: f64) -> Vec<Vec3<Enu>> {
    let empty = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (low, high) =
        solid.vertices_m.iter().map(|v| v.array()).fold(empty, |(low, high), v| {
            (std::array::from_fn(|k| low[k].min(v[k])), std::array::from_fn(|k| high[k].max(v[k])))
        });
    let away_squared = |p: [f64; 3]| -> f64 { (0..3).map(|k| (low[k] - p[k]).max(p[k] - high[k]).max(0.0)).map(|d| d * d).sum() };
    stations.iter().copied().filter(|s| away_squared(s.array()) <= reach_m * reach_m).collect()
}

/// Points, outward normals and areas that stand for a solid's faces.
fn sampled(solid: &Solid) -> Vec<(Vec3<Enu>, Vec3<Enu>, f64)> {
    let mut samples = Vec::new();
    for face in &solid.faces {
        let corners: Vec<Vec3<Enu>> = face.iter().filter_map(|k| solid.vertices_m.get(*k as usize).copied()).collect();
        let count = corners.len();
        let twice = (0..count).fold(Vec3::zero(), |sum, k| sum + corners[k].cross(corners[(k + 1) % count]));
        let (area, normal) = (0.5 * twice.norm(), twice.unit());
        if count < 3 || area < LEAST_FACE_M2 {
            continue;
        }
        let inside = grid(&corners, normal);
        let each = area / inside.len() as f64;
        samples.extend(inside.into_iter().map(|point| (point, normal, each)));
    }
    samples
}

/// Grid points of a convex polygon, [`PATCH_M`] apart; its centre when it is smaller than that.
fn grid(corners: &[Vec3<Enu>], normal: Vec3<Enu>) -> Vec<Vec3<Enu>> {
    let u = (corners[1] - corners[0]).unit();
    let v = normal.cross(u);
    let flat: Vec<(f64, f64)> = corners.iter().map(|c| ((*c - corners[0]).dot(u), (*c - corners[0]).dot(v))).collect();
    let span = |f: fn(&(f64, f64)) -> f64| {
        flat.iter().map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((u_low, u_high), (v_low, v_high)) = (span(|p| p.0), span(|p| p.1));
    let steps = |low: f64, high: f64| ((high - low) / PATCH_M).ceil().max(1.0) as usize;
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

/// Inside a convex polygon whose corners run counter-clockwise.
fn is_inside(flat: &[(f64, f64)], p: (f64, f64)) -> bool {
    (0..flat.len()).all(|k| {
        let (a, b) = (flat[k], flat[(k + 1) % flat.len()]);
        (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0) >= 0.0
    })
}

fn seen_from(stations: &[Vec3<Enu>], (point_m, normal): (Vec3<Enu>, Vec3<Enu>), reach_m: f64, scene: &Scene<'_>) -> bool {
    let steepest = math::cos(INCIDENCE_MAX_RAD);
    let mut near: Vec<(f64, Vec3<Enu>)> = stations
        .iter()
        .map(|station| ((*station - point_m).norm(), *station))
        .filter(|(away, station)| *away <= reach_m && (*station - point_m).dot(normal) >= steepest * *away)
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.iter().take(TRIES).any(|(_, station)| is_clear(*station, point_m + normal * LIFT_M, scene))
}

fn is_clear(from: Vec3<Enu>, to: Vec3<Enu>, scene: &Scene<'_>) -> bool {
    let line = to - from;
    let reach = line.norm() - LIFT_M;
    reach <= 0.0 || scene.site.geometry().ray(from, line.unit(), reach).is_none()
}

/// The patch is in the image, near enough and square enough on; sight lines are not asked.
fn is_framed(patch: &Patch, pose: &CameraPose, camera: &Camera) -> bool {
    let to = patch.point_m - pose.position_m;
    let away = to.norm();
    if away > reach_m(camera) || -to.dot(patch.normal) < math::cos(INCIDENCE_MAX_RAD) * away {
        return false;
    }
    let depth = to.dot(pose.forward);
    let down = pose.forward.cross(pose.right);
    let half = |px: u32| 0.5 * f64::from(px) / camera.focal_px();
    depth > 0.0
        && to.dot(pose.right).abs() <= half(camera.width_px) * depth
        && to.dot(down).abs() <= half(camera.height_px) * depth
}

fn see_picture(patches: &mut [Patch], picture: &Picture, light: &mut Light<'_>) {
    let scene = *light.scene;
    let (pose, camera) = (&picture.pose, &picture.camera);
    let velocity = scene.flight.between(picture.time).map_or(Vec3::zero(), |state| state.velocity_m_s);
    for patch in patches.iter_mut().filter(|patch| is_framed(patch, pose, camera)) {
        if !is_clear(pose.position_m, patch.point_m + patch.normal * LIFT_M, &scene) {
            continue;
        }
        patch.pictured = true;
        let lamp = lamp_lux(&scene.vehicle.lamp, pose, patch.point_m, patch.normal);
        let lux = lamp + light.ambient_lux(patch, picture.time);
        let lit = lux >= needed_lux(camera);
        patch.lit |= lit;
        let to = patch.point_m - pose.position_m;
        let ray = to.unit();
        let across = (velocity - ray * velocity.dot(ray)).norm();
        let blur_px = across * exposure_s(camera, lux) * camera.focal_px() / to.norm();
        patch.sharp |= lit && blur_px <= BLUR_MAX_PX;
    }
}

fn see_flight(patches: &mut [Patch], scene: &Scene<'_>) {
    let stride = (VIEW_STEP.s() * scene.scenario.scoring.frame_rate_hz).round().max(1.0) as usize;
    for frame in scene.frames.iter().step_by(stride) {
        let Some(pose) = attention::pose(scene.flight, frame.time, scene.vehicle) else { continue };
        let camera = attention::camera(scene.flight, frame.time, &scene.vehicle.camera);
        for patch in patches.iter_mut().filter(|patch| !patch.in_view && !patch.pictured) {
            patch.in_view =
                is_framed(patch, &pose, &camera) && is_clear(pose.position_m, patch.point_m + patch.normal * LIFT_M, scene);
        }
    }
}

/// Ambient light, asked for once per neighbourhood and orientation.
struct Light<'a> {
    scene: &'a Scene<'a>,
    cells: BTreeMap<[i64; 6], f64>,
}

impl Light<'_> {
    fn ambient_lux(&mut self, patch: &Patch, time: SimTime) -> f64 {
        let (p, n) = (patch.point_m.array(), patch.normal.array());
        let key =
            std::array::from_fn(|k| if k < 3 { (p[k] / LIGHT_CELL_M).floor() as i64 } else { (2.0 * n[k - 3]).round() as i64 });
        let scene = self.scene;
        *self.cells.entry(key).or_insert_with(|| scene.site.ambient_lux(patch.point_m, Some(patch.normal), time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of 4 by 3 by 2 m.
    fn block() -> Solid {
        let corner = |k: u32| {
            let pick = |bit: u32, length: f64| if k >> bit & 1 == 1 { length } else { 0.0 };
            Vec3::new(pick(0, 4.0), pick(1, 3.0), pick(2, 2.0))
        };
        let faces =
            vec![vec![0, 2, 3, 1], vec![4, 5, 7, 6], vec![0, 1, 5, 4], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]];
        Solid { vertices_m: (0..8).map(corner).collect(), faces }
    }

    #[test]
    fn exact_patches_of_a_box_add_up_to_its_surface_and_lie_on_it() {
        let samples = sampled(&block());
        let area: f64 = samples.iter().map(|sample| sample.2).sum();
        assert!((area - 2.0 * (12.0 + 8.0 + 6.0)).abs() < 1e-9, "{area}");
        assert_eq!(samples.len(), 2 * (12 + 8 + 6), "one per square metre");
        for (point, normal, _) in samples {
            let outside = point + normal * 0.01;
            let [e, n, u] = outside.array();
            assert!(!((0.0..=4.0).contains(&e) && (0.0..=3.0).contains(&n) && (0.0..=2.0).contains(&u)), "normals point out");
        }
    }

    #[test]
    fn exact_a_triangle_keeps_its_area() {
        let corners = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.0)];
        assert_eq!(grid(&corners, Vec3::new(0.0, 0.0, 1.0)).len(), 1, "smaller than a patch: its centre");
    }
}
