//! The first section: the personal best, the things to do better, and the next flight.

use super::{gallery, moment};
use crate::advice::{AdvicePoint, SessionAdvice};
use crate::report::Review;
use crate::report::pictures::ReviewedPicture;
use crate::terms::job_title;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Maximum time between a moment and the picture that shows it, s (estimate: at inspection speed, the drone still faces the
/// same surface).
const MAX_PICTURE_AGE_S: f64 = 5.0;

/// Renders the "Do better" section of a session report.
pub fn section(review: &Review) -> Markup {
    let advice = &review.advice.in_language(review.metadata.language);
    html! {
        @if let Some(standing) = &review.metadata.standing { p.standing { (standing.words(review.metadata.language)) } }
        @if advice.points.is_empty() {
            p { (advice.note.as_deref().unwrap_or_default()) }
        } @else {
            ol.advice { @for point in &advice.points { (item(review, point)) } }
        }
        (next(advice, review.metadata.language))
    }
}

fn item(review: &Review, point: &AdvicePoint) -> Markup {
    let language = review.metadata.language;
    html! {
        li {
            b { (point.words) }
            p { (moment::shown(point.t_s, language))
                @if let Some(picture) = picture_near(review, point.t_s) { " · " a href={ "#" (gallery::anchor(picture)) } { (text!(language, "report-better-picture", picture = picture.number)) } }
                " · " (text!(language, "report-better-practice")) " " b.drill { (job_title(&point.drill, language)) } }
        }
    }
}

/// Returns the picture taken nearest to a moment, if any was taken close to it.
fn picture_near(review: &Review, t_s: f64) -> Option<&ReviewedPicture> {
    let age_s = |picture: &&ReviewedPicture| (picture.t_s - t_s).abs();
    let near = review.pictures.iter().filter(|picture| age_s(picture) <= MAX_PICTURE_AGE_S);
    near.min_by(|a, b| age_s(a).total_cmp(&age_s(b)))
}

fn next(advice: &SessionAdvice, language: Language) -> Markup {
    html! {
        @if let Some(next) = &advice.next {
            p.next-flight { (text!(language, "report-better-next")) " " b { (job_title(&next.scenario, language)) } br; (text!(language, "job-how-to-fly")) }
        }
    }
}
