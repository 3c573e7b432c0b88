//! The trainee's pictures and their verdicts. Shows the photograph if the session contains it; otherwise, a drawing of
//! the camera's view.

use super::figure::{SLOT, filled};
use super::moment;
use crate::report::Review;
use crate::report::assets::base64;
use crate::report::defects::DefectOutcome;
use crate::report::formatting;
use crate::report::pictures::{PictureVerdict, ReviewedPicture};
use crate::report::plots::coord;
use crate::report::sketch::{SketchExposure, Sketcher, WIDTH_PX};
use crate::report::table::{Table, TableCell, folded};
use maud::{Markup, html};
use spandrel_model::site::CameraPose;
use spandrel_model::site::visibility::CENTRAL_FRACTION;
use spandrel_model::vehicle::Camera;
use spandrel_text::terms::capitalized;
use spandrel_text::{Language, text};

/// Prepares the site for all drawings, lit by the sun at mid-flight.
pub fn sketcher(review: &Review) -> Sketcher {
    let middle = review.frames.get(review.frames.len() / 2).map_or(spandrel_model::time::SimTime::ZERO, |frame| frame.time);
    Sketcher::new(&review.site, &review.scenario, middle)
}

/// Renders the "Pictures" section of a session report.
pub fn section(review: &Review, sketcher: &Sketcher) -> Markup {
    let language = review.metadata.language;
    html! {
        @if review.pictures.is_empty() { p.calm { (text!(language, "report-pictures-none")) } } @else {
            p { (verdict_counts(review)) }
            @if review.metadata.pictures.is_empty() { p.note { (text!(language, "report-pictures-drawn")) } }
            ul.gallery { @for picture in &review.pictures { (card(review, picture, sketcher)) } }
        }
        (folded(language, |language| table(review, language)))
    }
}

fn verdict_counts(review: &Review) -> String {
    let language = review.metadata.language;
    let count = |verdict: PictureVerdict| review.pictures.iter().filter(|picture| picture.verdict == verdict).count();
    let parts: Vec<String> = PictureVerdict::ALL
        .iter()
        .map(|verdict| (verdict, count(*verdict)))
        .filter(|(_, count)| *count > 0)
        .map(|(verdict, count)| verdict.count_text(count, language))
        .collect();
    text!(language, "report-pictures-count", count = review.pictures.len(), verdicts = parts.join(", "))
}

fn card(review: &Review, picture: &ReviewedPicture, sketcher: &Sketcher) -> Markup {
    let language = review.metadata.language;
    let moment = match picture.task {
        Some(task) => text!(language, "report-picture-at-task", moment = SLOT, task = review.scenario.tasks[task].id),
        None => text!(language, "report-picture-at", moment = SLOT),
    };
    html! {
        li.shot id=(anchor(picture)) {
            (image(review, picture, sketcher))
            p { span class={ "badge " (picture.verdict.class()) } { (picture.verdict.name(language)) } " "
                b { (text!(language, "report-picture-number", picture = picture.number)) } " " (filled(&moment, &moment::link(picture.t_s))) }
            p { (capitalized(&picture.reason.words(language))) "." }
            p.note { (target(picture, language)) }
        }
    }
}

/// Returns the ID of a picture's card.
pub fn anchor(picture: &ReviewedPicture) -> String {
    format!("picture-{}", picture.number)
}

fn target(picture: &ReviewedPicture, language: Language) -> String {
    let lamp =
        if picture.pose.lamp_on { text!(language, "report-picture-lamp-on") } else { text!(language, "report-picture-lamp-off") };
    match &picture.target {
        None => text!(language, "report-picture-sky", lamp = lamp),
        Some(t) => text!(
            language,
            "report-picture-center",
            name = t.name.as_str(),
            distance = formatting::number(t.distance_m, 1),
            angle = formatting::number(t.incidence_rad.to_degrees(), 0),
            pixel = formatting::number(1000.0 * t.gsd_m, 1),
            illuminance = formatting::number(t.lux, 0),
            lamp = lamp,
            blur = formatting::number(t.blur_px, 1)
        ),
    }
}

fn image(review: &Review, picture: &ReviewedPicture, sketcher: &Sketcher) -> Markup {
    let language = review.metadata.language;
    let words = text!(language, "report-picture-alt", picture = picture.number, reason = picture.reason.words(language));
    let index = u32::try_from(picture.index).ok();
    let photograph = review.metadata.pictures.iter().find(|(number, _)| Some(*number) == index);
    let marks = marks(review, picture);
    if let Some((_, jpeg)) = photograph {
        return ringed_photograph(picture, &jpeg.bytes, &marks, &words);
    }
    let exposure = picture.target.as_ref().map_or(SketchExposure { light: 1.0, by_lamp: false }, |t| SketchExposure {
        light: t.lux / t.required_illuminance_lux,
        by_lamp: picture.pose.lamp_on && t.lux < 4.0 * t.required_illuminance_lux,
    });
    frame(sketcher, (&picture.pose, &picture.camera), exposure, &marks, &words)
}

/// Returns the marks of the defects in a picture.
fn marks(review: &Review, picture: &ReviewedPicture) -> Vec<DefectMark> {
    let shown = |id: u32| picture.views.iter().find(|view| view.defect_id == id);
    let mark = |outcome: &DefectOutcome| {
        let (defect, view) = (&outcome.defect, shown(outcome.defect.id)?);
        let class = if view.hit { "found" } else { "missed" };
        Some(DefectMark { id: defect.id, at_m: defect.position_m, length_m: defect.length_m, class, hidden: !view.unoccluded })
    };
    review.defects.iter().filter_map(mark).collect()
}

/// Renders a photograph with marked defects.
fn ringed_photograph(picture: &ReviewedPicture, jpeg: &[u8], marks: &[DefectMark], words: &str) -> Markup {
    let size = drawing_size(&picture.camera);
    html! {
        svg.frame viewBox={ "0 0 " (coord(size.0)) " " (coord(size.1)) } role="img" aria-label=(words) {
            title { (words) }
            image href={ "data:image/jpeg;base64," (base64(jpeg)) } width=(coord(size.0)) height=(coord(size.1)) preserveAspectRatio="none" {}
            (rings((&picture.pose, &picture.camera), marks))
        }
    }
}

/// Returns the width and height of a drawing of the camera's view, px.
fn drawing_size(camera: &Camera) -> (f64, f64) {
    let width = WIDTH_PX as f64;
    (width, width * f64::from(camera.height_px) / f64::from(camera.width_px))
}

/// A defect to mark in a drawing.
pub struct DefectMark {
    /// Defect number, from 1.
    pub id: u32,
    /// Position in the site frame (ENU), m.
    pub at_m: spandrel_model::frames::Vec3<spandrel_model::frames::Enu>,
    /// The defect's largest dimension, m.
    pub length_m: f64,
    /// CSS class of the mark.
    pub class: &'static str,
    /// Whether the structure occludes the defect.
    pub hidden: bool,
}

/// Renders a drawing of the camera's view with marked defects and the frame inside which defects count.
pub fn frame(
    sketcher: &Sketcher,
    (pose, camera): (&CameraPose, &Camera),
    exposure: SketchExposure,
    marks: &[DefectMark],
    words: &str,
) -> Markup {
    let (w, h) = drawing_size(camera);
    let edge = 0.5 * (1.0 - CENTRAL_FRACTION);
    // If the image cannot be encoded, the page shows only its text.
    let drawing = sketcher.png(pose, camera, exposure).map(|png| base64(&png)).unwrap_or_default();
    html! {
        svg.frame viewBox={ "0 0 " (coord(w)) " " (coord(h)) } role="img" aria-label=(words) {
            title { (words) }
            image href={ "data:image/png;base64," (drawing) } width=(coord(w)) height=(coord(h)) {}
            rect.central x=(coord(edge * w)) y=(coord(edge * h)) width=(coord(CENTRAL_FRACTION * w)) height=(coord(CENTRAL_FRACTION * h)) {}
            (rings((pose, camera), marks))
        }
    }
}

/// Renders the rings around defects in a drawing of the camera's view.
fn rings((pose, camera): (&CameraPose, &Camera), marks: &[DefectMark]) -> Markup {
    let (w, h) = drawing_size(camera);
    let focal = camera.focal_px() * w / f64::from(camera.width_px);
    let down = pose.forward.cross(pose.right);
    let place = |mark: &DefectMark| {
        let to = mark.at_m - pose.position_m;
        let depth = to.dot(pose.forward).max(0.01);
        let middle = (0.5 * w + focal * to.dot(pose.right) / depth, 0.5 * h + focal * to.dot(down) / depth);
        (middle, (0.5 * focal * mark.length_m / depth).clamp(7.0, 0.5 * w))
    };
    html! {
        @for mark in marks {
            @let ((x, y), r) = place(mark);
            g class={ "ring " (mark.class) @if mark.hidden { " hidden-behind" } } {
                circle cx=(coord(x)) cy=(coord(y)) r=(coord(r)) {}
                text x=(coord(x + r + 3.0)) y=(coord(y + 5.0)) { (mark.id) }
            }
        }
    }
}

fn table(review: &Review, language: Language) -> Table {
    let lamp = |on: bool| if on { text!(language, "report-pictures-on") } else { text!(language, "report-pictures-off") };
    let number = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |picture: &ReviewedPicture| {
        let t = picture.target.as_ref();
        vec![
            picture.number.into(),
            TableCell::Clock(picture.t_s),
            picture.frame.into(),
            picture.task.map_or(TableCell::Empty, |task| review.scenario.tasks[task].id.into()),
            picture.verdict.name(language).into(),
            picture.reason.words(language).into(),
            t.map_or_else(|| text!(language, "report-pictures-sky"), |t| t.name.clone()).into(),
            number(t.map(|t| t.distance_m), 2),
            number(t.map(|t| t.incidence_rad.to_degrees()), 0),
            number(t.map(|t| 1000.0 * t.gsd_m), 2),
            number(t.map(|t| t.lux), 0),
            number(t.map(|t| t.required_illuminance_lux), 0),
            number(t.map(|t| t.blur_px), 2),
            lamp(picture.pose.lamp_on).into(),
        ]
    };
    Table {
        name: "pictures",
        caption: text!(language, "report-pictures-caption"),
        columns: vec![
            text!(language, "report-column-picture"),
            text!(language, "report-column-time"),
            text!(language, "report-column-frame"),
            text!(language, "report-column-task"),
            text!(language, "report-column-verdict"),
            text!(language, "report-column-reason"),
            text!(language, "report-column-image-center"),
            text!(language, "report-column-distance"),
            text!(language, "report-column-angle"),
            text!(language, "report-column-pixel-size"),
            text!(language, "report-column-illuminance"),
            text!(language, "report-column-required-illuminance"),
            text!(language, "report-column-blur"),
            text!(language, "report-column-lamp"),
        ],
        rows: review.pictures.iter().map(row).collect(),
    }
}
