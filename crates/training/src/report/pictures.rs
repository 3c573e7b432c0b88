//! The session's pictures with their verdicts, based on the same geometry and lighting as the score.

use super::context::ReviewContext;
use super::task_proximity::TaskProximityStep;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_model::site::visibility::{MAX_INCIDENCE_RAD, MIN_EXTENT_PX, MIN_LINE_WIDTH_PX, lamp_lux, required_illuminance_lux};
use spandrel_model::site::{CameraPose, DefectView, ObjectId, Surface};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use spandrel_monitor::assessment::Assessment;
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::image_quality::exposure_s;
use spandrel_text::{Language, text};

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
    pub fn name(self, language: Language) -> String {
        match self {
            Self::Hit => text!(language, "report-verdict-hit"),
            Self::Repeat => text!(language, "report-verdict-repeat"),
            Self::TooDark => text!(language, "report-verdict-too-dark"),
            Self::TooFar => text!(language, "report-verdict-too-far"),
            Self::TooOblique => text!(language, "report-verdict-too-oblique"),
            Self::NoDefect => text!(language, "report-verdict-false"),
        }
    }

    /// Returns the number of pictures with this verdict, as text.
    #[must_use]
    pub fn count_text(self, count: usize, language: Language) -> String {
        match self {
            Self::Hit => text!(language, "report-pictures-count-hit", count = count),
            Self::Repeat => text!(language, "report-pictures-count-repeat", count = count),
            Self::TooDark => text!(language, "report-pictures-count-too-dark", count = count),
            Self::TooFar => text!(language, "report-pictures-count-too-far", count = count),
            Self::TooOblique => text!(language, "report-pictures-count-too-oblique", count = count),
            Self::NoDefect => text!(language, "report-pictures-count-false", count = count),
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

/// Reason for a verdict.
#[derive(Debug, Clone, PartialEq)]
pub enum VerdictReason {
    /// The picture is the first to show these defects.
    First(Vec<u32>),
    /// Earlier pictures show the same defects.
    Again(Vec<u32>),
    /// The view of the defect that is closest to a hit does not meet all conditions.
    Failing(Box<DefectView>),
    /// No defect is visible; contains a defect that is hidden, if there is one.
    NoDefect(Option<u32>),
}

impl VerdictReason {
    /// Returns the reason as a phrase.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let list = |ids: &[u32]| ids.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        match self {
            Self::First(ids) => text!(language, "report-reason-first", defects = list(ids)),
            Self::Again(ids) => text!(language, "report-reason-again", defects = list(ids)),
            Self::Failing(view) => {
                let reason = failed_conditions(view, language).join("; ");
                text!(language, "terms-picture-of-defect", defect = view.defect_id, reason = reason)
            }
            Self::NoDefect(None) => text!(language, "report-reason-none"),
            Self::NoDefect(Some(id)) => text!(language, "report-reason-occluded", defect = *id),
        }
    }
}

/// Returns the conditions of a hit that a view does not meet, each as a phrase.
#[must_use]
pub fn failed_conditions(view: &DefectView, language: Language) -> Vec<String> {
    let words = [
        text!(language, "terms-picture-not-central"),
        text!(language, "terms-picture-hidden"),
        text!(
            language,
            "terms-picture-too-oblique",
            value = format_with_limit(view.incidence_rad.to_degrees(), MAX_INCIDENCE_RAD.to_degrees(), 0),
            limit = format_limit(MAX_INCIDENCE_RAD.to_degrees())
        ),
        text!(
            language,
            "terms-picture-too-small",
            value = format_with_limit(view.extent_px, MIN_EXTENT_PX, 1),
            limit = format_limit(MIN_EXTENT_PX)
        ),
        text!(
            language,
            "terms-picture-line-too-thin",
            value = format_with_limit(view.width_px, MIN_LINE_WIDTH_PX, 2),
            limit = format_limit(MIN_LINE_WIDTH_PX)
        ),
        too_dark(view, language),
    ];
    words.into_iter().zip(view.conditions()).filter_map(|(word, holds)| (!holds).then_some(word)).collect()
}

fn too_dark(view: &DefectView, language: Language) -> String {
    // The required illuminance is displayed as an integer unless the measured value is between the rounded and the exact limit.
    let whole = view.required_illuminance_lux.round();
    let required_lux = if view.illuminance_lux < whole { whole } else { view.required_illuminance_lux };
    let (value, limit) = (format_with_limit(view.illuminance_lux, required_lux, 0), format_limit(required_lux));
    if view.lamp_on {
        text!(language, "terms-picture-dark-lamp-on", value = value, limit = limit)
    } else {
        text!(language, "terms-picture-dark-lamp-off", value = value, limit = limit)
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
    /// Reason for the verdict.
    pub reason: VerdictReason,
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
pub fn verdict(found: &[u32], views: &[DefectView]) -> (PictureVerdict, VerdictReason) {
    if !found.is_empty() {
        return (PictureVerdict::Hit, VerdictReason::First(found.to_vec()));
    }
    let again: Vec<u32> = views.iter().filter(|view| view.hit).map(|view| view.defect_id).collect();
    if !again.is_empty() {
        return (PictureVerdict::Repeat, VerdictReason::Again(again));
    }
    let failing = |view: &&DefectView| view.conditions().iter().filter(|holds| !**holds).count();
    let nearest = views.iter().filter(|view| view.unoccluded).min_by_key(failing);
    let Some(view) = nearest else {
        return (PictureVerdict::NoDefect, VerdictReason::NoDefect(views.first().map(|view| view.defect_id)));
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
    (verdict, VerdictReason::Failing(Box::new(*view)))
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
            let reason = reason.words(Language::English);
            assert_eq!(got, expected, "{reason}");
            assert!(reason.contains(word), "{reason}");
        }
        assert_eq!(verdict(&[], &[]), (PictureVerdict::NoDefect, VerdictReason::NoDefect(None)));
    }

    #[test]
    fn exact_failed_conditions_read_as_in_the_other_outputs() {
        let dark = DefectView { illuminance_lux: 10.0, extent_px: 9.99, line: true, width_px: 0.2, ..view() };
        for view in [dark, DefectView { unoccluded: false, incidence_rad: 1.2, lamp_on: true, ..dark }] {
            assert_eq!(failed_conditions(&view, Language::English), view.reasons());
        }
        assert!(failed_conditions(&dark, Language::German).join(" ").contains("Scheinwerfer aus"));
    }

    #[test]
    fn exact_defect_closest_to_a_hit_determines_verdict() {
        let worse = DefectView { defect_id: 1, incidence_rad: 1.2, illuminance_lux: 1.0, ..view() };
        let better = DefectView { illuminance_lux: 10.0, ..view() };
        assert_eq!(verdict(&[], &[worse, better]).0, PictureVerdict::TooDark);
    }
}
