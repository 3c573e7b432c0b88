//! The session's pictures with their verdicts, based on the same geometry and lighting as the score.

use super::context::ReviewContext;
use super::task_proximity::TaskProximityStep;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::visibility::{lamp_lux, required_illuminance_lux};
use spandrel_model::site::{CameraPose, DefectView, ObjectId, Surface};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use spandrel_monitor::assessment::Assessment;
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::image_quality::exposure_s;

/// Maximum distance of the object in a picture's center, m; anything farther counts as sky.
const MAX_TARGET_DISTANCE_M: f64 = 120.0;

/// The verdict on a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PictureVerdict {
    /// The first picture to show a defect.
    Hit,
    /// Shows only defects that earlier pictures already captured.
    Repeat,
    /// A defect is in view, but it receives too little light.
    TooDark,
    /// A defect is in view, but it covers too few pixels.
    TooFar,
    /// A defect is in view, but the angle from its surface normal is too large.
    TooOblique,
    /// No defect is in view.
    NoDefect,
}

impl PictureVerdict {
    /// All verdicts, in legend order.
    pub const ALL: [Self; 6] = [Self::Hit, Self::Repeat, Self::TooDark, Self::TooFar, Self::TooOblique, Self::NoDefect];

    /// Returns the name shown in the report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Repeat => "repeat",
            Self::TooDark => "too dark",
            Self::TooFar => "too far",
            Self::TooOblique => "too oblique",
            Self::NoDefect => "false",
        }
    }

    /// Returns the CSS class that colors the verdict in the report.
    #[must_use]
    pub fn class(self) -> &'static str {
        match self {
            Self::Hit => "v-hit",
            Self::Repeat => "v-repeat",
            Self::TooDark | Self::TooFar | Self::TooOblique => "v-near",
            Self::NoDefect => "v-false",
        }
    }
}

/// The object in the center of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureSubject {
    /// Name of the bridge member or other object.
    pub name: String,
    /// Distance from the camera, m.
    pub distance_m: f64,
    /// Incidence angle from the surface normal, rad.
    pub incidence_rad: f64,
    /// Ground sampling distance: size of a pixel at normal incidence, m.
    pub gsd_m: f64,
    /// Illuminance including lamp light, lx.
    pub lux: f64,
    /// Illuminance that the camera needs for a usable exposure, lx.
    pub required_illuminance_lux: f64,
    /// Motion blur caused by the drone's speed across the line of sight at the shortest exposure possible in this
    /// light, px.
    pub blur_px: f64,
}

/// A picture and its evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct ReviewedPicture {
    /// Sequence number in this report, from 1.
    pub number: u32,
    /// Image index reported by the camera.
    pub index: i32,
    /// Frame in which the picture was taken, from 1.
    pub frame: u32,
    /// Time since lift-off, s.
    pub t_s: f64,
    /// Simulation time.
    pub time: SimTime,
    /// Camera position, orientation and lamp state.
    pub pose: CameraPose,
    /// Camera with the zoom setting of this picture.
    pub camera: Camera,
    /// Whether the picture counts as a hit and, if not, why.
    pub verdict: PictureVerdict,
    /// Reason for the verdict, as a phrase.
    pub reason: String,
    /// IDs of the defects first shown in this picture.
    pub found: Vec<u32>,
    /// Defects in the central part of the image, including those that do not count.
    pub views: Vec<DefectView>,
    /// Object in the center of the image; `None` for sky.
    pub target: Option<PictureSubject>,
    /// Index of the task being flown, if any.
    pub task: Option<usize>,
}

/// Evaluates all pictures of a session.
#[must_use]
pub fn evaluate_pictures(
    scene: &ReviewContext<'_>,
    assessment: &Assessment,
    track: &[TaskProximityStep],
) -> Vec<ReviewedPicture> {
    let each = assessment.snapshots.each.iter().enumerate();
    each.filter_map(|(k, snapshot)| {
        let at = usize::try_from(snapshot.frame).ok()?.checked_sub(1)?;
        let frame = scene.frames.get(at)?;
        let since = at.checked_sub(1).map_or(SimTime::from_ns(frame.time.ns() - 1), |k| scene.frames[k].time);
        let (time, _, (index, _)) = *scene.flight.snapshots.between(since, frame.time).first()?;
        let pose = attention::pose(scene.flight, time, scene.vehicle)?;
        let camera = attention::camera(scene.flight, time, &scene.vehicle.camera);
        let looks = scene.site.view_defects(&pose, &camera, &scene.vehicle.lamp, time);
        let views: Vec<DefectView> = looks.into_iter().filter(|view| view.in_frame || view.hit).collect();
        let (verdict, reason) = verdict(&snapshot.found, &views);
        Some(ReviewedPicture {
            number: u32::try_from(k + 1).unwrap_or(u32::MAX),
            index,
            frame: snapshot.frame,
            t_s: snapshot.t_s,
            time,
            target: target(scene, &pose, &camera, (time, frame.velocity_m_s)),
            pose,
            camera,
            verdict,
            reason,
            found: snapshot.found.clone(),
            views,
            task: track.get(at).filter(|step| step.inside).and_then(|step| step.task),
        })
    })
    .collect()
}

/// Returns the verdict on a picture and the reason, given the defects that it is the first to show (`found`) and those in view.
#[must_use]
pub fn verdict(found: &[u32], views: &[DefectView]) -> (PictureVerdict, String) {
    let list = |ids: &[u32]| ids.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    if !found.is_empty() {
        return (PictureVerdict::Hit, format!("shows defect {} for the first time", list(found)));
    }
    let again: Vec<u32> = views.iter().filter(|view| view.hit).map(|view| view.defect_id).collect();
    if !again.is_empty() {
        return (PictureVerdict::Repeat, format!("defect {} was already photographed", list(&again)));
    }
    let failing = |view: &&DefectView| view.conditions().iter().filter(|holds| !**holds).count();
    let nearest = views.iter().filter(|view| view.unoccluded).min_by_key(failing);
    let Some(view) = nearest else {
        let behind = views.first().map(|view| format!(" (defect {} is occluded)", view.defect_id));
        return (PictureVerdict::NoDefect, format!("no defect visible{}", behind.unwrap_or_default()));
    };
    let [_, _, square, large, wide, lit] = view.conditions();
    let verdict = if !square {
        PictureVerdict::TooOblique
    } else if !large || !wide {
        PictureVerdict::TooFar
    } else if !lit {
        PictureVerdict::TooDark
    } else {
        PictureVerdict::NoDefect
    };
    (verdict, format!("defect {} is {}", view.defect_id, view.reasons().join("; ")))
}

fn target(
    scene: &ReviewContext<'_>,
    pose: &CameraPose,
    camera: &Camera,
    (time, velocity_m_s): (SimTime, Vec3<Enu>),
) -> Option<PictureSubject> {
    let hit = scene.site.ray(pose.position_m, pose.forward, MAX_TARGET_DISTANCE_M, time)?;
    let point_m = pose.position_m + pose.forward * hit.distance_m;
    let ambient = scene.site.ambient_lux(point_m, Some(hit.normal), time);
    let lux = ambient + lamp_lux(&scene.vehicle.lamp, pose, point_m, hit.normal);
    let gsd_m = hit.distance_m / camera.focal_px();
    let across = velocity_m_s - pose.forward * velocity_m_s.dot(pose.forward);
    Some(PictureSubject {
        name: if hit.surface == Surface::Bridge { member(scene, hit.object) } else { scene.site.object_name(hit.object) },
        distance_m: hit.distance_m,
        incidence_rad: spandrel_model::math::acos((-pose.forward.dot(hit.normal)).clamp(-1.0, 1.0)),
        gsd_m,
        lux,
        required_illuminance_lux: required_illuminance_lux(camera),
        blur_px: across.norm() * exposure_s(camera, lux) / gsd_m,
    })
}

fn member(scene: &ReviewContext<'_>, object: ObjectId) -> String {
    scene.site.members().get(object.0 as usize).map_or_else(|| scene.site.object_name(object), |member| member.name.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> DefectView {
        DefectView {
            defect_id: 4,
            in_frame: true,
            unoccluded: true,
            incidence_rad: 0.0,
            extent_px: 100.0,
            width_px: 50.0,
            illuminance_lux: 1000.0,
            required_illuminance_lux: 100.0,
            distance_m: 2.0,
            line: false,
            lamp_on: false,
            hit: false,
        }
    }

    #[test]
    fn exact_verdicts_match_failed_conditions() {
        let hit = DefectView { hit: true, ..view() };
        assert_eq!(verdict(&[4], &[hit]).0, PictureVerdict::Hit);
        assert_eq!(verdict(&[], &[hit]).0, PictureVerdict::Repeat);
        let cases = [
            (DefectView { illuminance_lux: 10.0, ..view() }, PictureVerdict::TooDark, "too dark: lamp off"),
            (DefectView { extent_px: 3.0, ..view() }, PictureVerdict::TooFar, "too small"),
            (DefectView { line: true, width_px: 0.2, ..view() }, PictureVerdict::TooFar, "line too thin"),
            (DefectView { incidence_rad: 1.2, ..view() }, PictureVerdict::TooOblique, "69 deg"),
            (DefectView { unoccluded: false, ..view() }, PictureVerdict::NoDefect, "is occluded"),
        ];
        for (case, expected, word) in cases {
            let (got, reason) = verdict(&[], &[case]);
            assert_eq!(got, expected, "{reason}");
            assert!(reason.contains(word), "{reason}");
        }
        assert_eq!(verdict(&[], &[]), (PictureVerdict::NoDefect, "no defect visible".into()));
    }

    #[test]
    fn exact_defect_closest_to_a_hit_determines_verdict() {
        let worse = DefectView { defect_id: 1, incidence_rad: 1.2, illuminance_lux: 1.0, ..view() };
        let better = DefectView { illuminance_lux: 10.0, ..view() };
        assert_eq!(verdict(&[], &[worse, better]).0, PictureVerdict::TooDark);
    }
}
