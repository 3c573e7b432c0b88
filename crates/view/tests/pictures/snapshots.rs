//! A defect that counts as photographed must be visible in the picture. Renders seeded photos from around the task
//! paths, with and without the defects, at the camera's full resolution around the defect.

use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use spandrel_testkit::studio::{Studio, two_bridges};
use spandrel_view::camera::PinholeCamera;
use spandrel_view::picture::Picture;
use spandrel_view::scene::defects;
use spandrel_view::stage::camera_aimed_at;
use std::collections::BTreeMap;

/// Number of photos that show a defect.
const PHOTO_COUNT: usize = 200;
/// Number of photo attempts per defect.
const TRIES_PER_DEFECT: usize = 4;
/// Size of the rendered area around each defect, in camera pixels.
const CROP_PX: (u32, u32) = (192, 144);
/// Size of the picture for metering the exposure, px; any size works.
const FRAME_PX: (u32, u32) = (400, 300);

/// A photo of one defect.
struct Snapshot {
    pose: CameraPose,
    view: DefectView,
}

/// Returns a photo of a defect from a position that an aircraft can reach, with the defect somewhere within the central
/// 80%.
fn snapshot(site: &Site, vehicle: &Vehicle, defect: &PlacedDefect, stream: &mut RandomStream) -> Option<Snapshot> {
    let level = if defect.normal.up().abs() > 0.9 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 0.0, 1.0) };
    let across = level.cross(defect.normal).unit();
    let up = defect.normal.cross(across);
    let (tilt, turn) = (stream.range(0.0, 1.0), stream.range(0.0, math::TAU));
    let (s, c) = math::sin_cos(turn);
    let out = (defect.normal + (across * c + up * s) * (1.6 * tilt)).unit();
    let from = defect.position_m + out * stream.range(1.0, 9.0);
    if site.nearest(from, 0.6, SimTime::ZERO).is_some() {
        return None;
    }
    let distance = (from - defect.position_m).norm();
    let aside = (across * stream.range(-0.5, 0.5) + up * stream.range(-0.4, 0.4)) * distance;
    let pose = camera_aimed_at(from, defect.position_m + aside, stream.uniform() < 0.5);
    let seen = site.view_defects(&pose, &vehicle.camera, &vehicle.lamp, SimTime::ZERO);
    seen.into_iter().find(|view| view.defect_id == defect.id).map(|view| Snapshot { pose, view })
}

/// Returns the crop around a defect with and without the defects, exposed like the complete photo.
fn render_pair(studio: &mut Studio, snapshot: &Snapshot, defect: &PlacedDefect) -> [Picture; 2] {
    let lens = studio.vehicle.camera;
    let whole = studio.stage().camera_view_from(
        PinholeCamera::of(&snapshot.pose, &lens),
        Some(&snapshot.pose),
        &lens,
        None,
        (SimTime::ZERO, FRAME_PX),
    );
    let hfov_rad = 2.0 * math::atan(0.5 * f64::from(CROP_PX.0) / lens.focal_px());
    let towards = camera_aimed_at(snapshot.pose.position_m, defect.position_m, snapshot.pose.lamp_on);
    let mut shot = whole;
    shot.eye = PinholeCamera::of(&towards, &Camera { hfov_rad, ..lens });
    shot.size_px = CROP_PX;
    shot.finish.vignette = 0.0;
    let sun = studio.site.light().daylight(SimTime::ZERO).sun;
    let patches = defects::patches(&studio.site, sun);
    [patches, Vec::new()].map(|patches| {
        let (gpu, renderer) = studio.renderer();
        renderer.set_patches(gpu, &patches);
        studio.draw(&shot)
    })
}

/// Returns, for each pixel of a crop, whether its position on the defect's plane is within the defect's extent.
fn defect_mask(snapshot: &Snapshot, defect: &PlacedDefect, lens: &Camera) -> Vec<bool> {
    let hfov_rad = 2.0 * math::atan(0.5 * f64::from(CROP_PX.0) / lens.focal_px());
    let towards = camera_aimed_at(snapshot.pose.position_m, defect.position_m, false);
    let eye = PinholeCamera::of(&towards, &Camera { hfov_rad, ..*lens });
    let aspect = f64::from(CROP_PX.0) / f64::from(CROP_PX.1);
    let gsd_m = (defect.position_m - eye.position_m).norm() / lens.focal_px();
    let across = defect.normal.cross(defect.along);
    // Maximum distance of a line from its center line (defect.wgsl).
    let stray_m = if defect.line { 0.025 } else { 0.0 };
    let on = |k: u32| {
        let (x, y) = (f64::from(k % CROP_PX.0) + 0.5, f64::from(k / CROP_PX.0) + 0.5);
        let ray = eye.ray(2.0 * x / f64::from(CROP_PX.0) - 1.0, 1.0 - 2.0 * y / f64::from(CROP_PX.1), aspect);
        let t = (defect.position_m - eye.position_m).dot(defect.normal) / ray.dot(defect.normal);
        let q = eye.position_m + ray * t - defect.position_m;
        t > 0.0
            && q.dot(defect.along).abs() <= 0.5 * defect.length_m + gsd_m
            && q.dot(across).abs() <= 0.5 * defect.width_m + stray_m + gsd_m
    };
    (0..CROP_PX.0 * CROP_PX.1).map(on).collect()
}

/// A defect's visibility within its region of the picture.
#[derive(Debug, Clone, Copy)]
struct DefectVisibility {
    /// Change caused by the defect relative to the variation of the bare surface (grain and texture), summed as for an
    /// observer who knows the pattern.
    signal_to_noise: f64,
}

fn visibility([with, without]: &[Picture; 2], region: &[bool]) -> DefectVisibility {
    let of = |picture: &Picture| -> Vec<[f64; 3]> {
        let pixels = picture.rgba.chunks(4).zip(region).filter(|(_, inside)| **inside);
        pixels.map(|(p, _)| [f64::from(p[0]), f64::from(p[1]), f64::from(p[2])]).collect()
    };
    let (with, without) = (of(with), of(without));
    let count = without.len().max(1) as f64;
    let mean = [0, 1, 2].map(|c| without.iter().map(|p| p[c]).sum::<f64>() / count);
    let square = |p: &[f64; 3], q: &[f64; 3]| [0, 1, 2].map(|c| (p[c] - q[c]) * (p[c] - q[c]) / 3.0).iter().sum::<f64>();
    let variance = without.iter().map(|p| square(p, &mean)).sum::<f64>() / count;
    let changed = with.iter().zip(&without).map(|(p, q)| square(p, q)).sum::<f64>();
    // The noise is at least one gray level, due to rounding.
    DefectVisibility { signal_to_noise: changed.sqrt() / variance.sqrt().max(1.0) }
}

/// Returns a photo of the same point from the other side of the member. The measures must not count the defect as
/// visible, and the picture must not show it.
fn from_behind(site: &Site, vehicle: &Vehicle, defect: &PlacedDefect) -> Option<Snapshot> {
    let from = (3..16).map(|k| defect.position_m - defect.normal * (0.5 * f64::from(k)));
    let free = from.clone().find(|from| site.nearest(*from, 0.6, SimTime::ZERO).is_none())?;
    let pose = camera_aimed_at(free, defect.position_m, true);
    let seen = site.view_defects(&pose, &vehicle.camera, &vehicle.lamp, SimTime::ZERO);
    let view = seen.into_iter().find(|view| view.defect_id == defect.id)?;
    Some(Snapshot { pose, view })
}

#[test]
fn prop_defects_counted_as_visible_are_visible_in_the_picture() {
    // Rose's limit (1948): a signal five times the noise is reliably visible.
    const MIN_VISIBLE_SNR: f64 = 5.0;
    let mut studio = Studio::new(two_bridges(), 1, "low", SimTime::ZERO);
    let mut stream = RandomStream::new(20, "view.snapshots");
    let (mut shown, mut behind, mut kinds): (Vec<DefectVisibility>, Vec<DefectVisibility>, BTreeMap<u32, usize>) =
        Default::default();
    let mut wrong = Vec::new();
    for seed in 1.. {
        if shown.len() >= PHOTO_COUNT {
            break;
        }
        studio.site = Site::build(&studio.scenario, seed);
        for defect in studio.site.defects().to_vec() {
            let tries: Vec<Snapshot> = (0..TRIES_PER_DEFECT)
                .filter_map(|_| snapshot(&studio.site, &studio.vehicle, &defect, &mut stream))
                .filter(|s| s.view.hit)
                .collect();
            for snapshot in tries.into_iter().chain(from_behind(&studio.site, &studio.vehicle, &defect)) {
                let found = visibility(
                    &render_pair(&mut studio, &snapshot, &defect),
                    &defect_mask(&snapshot, &defect, &studio.vehicle.camera),
                );
                let seen = found.signal_to_noise >= MIN_VISIBLE_SNR;
                if seen != snapshot.view.hit {
                    wrong.push(format!("seed {seed}, defect {}, {}: {found:?}, {:?}", defect.id, defect.kind, snapshot.view));
                }
                if snapshot.view.hit {
                    shown.push(found);
                    *kinds.entry(defect.kind).or_default() += 1;
                } else {
                    behind.push(found);
                }
            }
        }
    }
    println!("photos that show a defect, according to the measures: {}; by kind: {kinds:?}", shown.len());
    println!("signal-to-noise ratios: {}; from behind: {}", summary(&shown), summary(&behind));
    assert!(behind.len() >= 30, "too few photos from behind: {}", behind.len());
    assert!(kinds.len() >= 6, "too few kinds of defects: {kinds:?}");
    assert!(
        wrong.is_empty(),
        "{} of {} photos disagree with the measures:\n{}",
        wrong.len(),
        shown.len() + behind.len(),
        wrong.join("\n")
    );
}

/// Returns the minimum, the 10th percentile, the median, and the maximum as text.
fn summary(all: &[DefectVisibility]) -> String {
    let mut values: Vec<f64> = all.iter().map(|shows| shows.signal_to_noise).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get(((values.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
    format!("minimum {:.1}, 10th percentile {:.1}, median {:.1}, maximum {:.1}", at(0.0), at(0.1), at(0.5), at(1.0))
}
