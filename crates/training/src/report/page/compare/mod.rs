//! Side-by-side comparison of two sessions.

mod charts;

use super::figure::{figure, legend};
use super::{PageScripts, document, series, summary, within_error};
use crate::cohort::{MeasureReliability, reliability_of};
use crate::report::Review;
use crate::report::coverage::SurfaceOutcome;
use crate::report::plots::bars::{ShareRow, shares};
use crate::report::plots::radar::{RadarAxis, radar};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_monitor::score::completion::verdict;
use spandrel_text::Language;

/// Placeholder for values whose reliability is not estimated.
const NO_MEASURE: &str = "";

/// Renders the session comparison page. Changes are labeled with the reliability of the measures on this job, as far as it
/// is known.
#[must_use]
pub fn comparison(first: &Review, second: &Review, reliability: &[MeasureReliability]) -> String {
    let both = [first, second];
    let named = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    let spokes: Vec<RadarAxis> = (0..4)
        .map(|k| RadarAxis {
            name: named[0][k].0.to_owned(),
            values: named.iter().map(|scores| scores[k].1.map(|score| score.pct)).collect(),
        })
        .collect();
    let same = first.scenario.tasks.len() == second.scenario.tasks.len() && first.scenario.crc == second.scenario.crc;
    let alignment_events = series::alignment_events(both, same);
    let key = [("dot-1", format!("1: {}", session_label(first))), ("dot-2", format!("2: {}", session_label(second)))];
    document(
        "Session comparison",
        &PageScripts::Comparison(series::comparison(both, &alignment_events)),
        &html! {
            header {
                div {
                    p.kicker { "Session comparison" }
                    h1 { (first.scenario.title) }
                    @for (k, review) in both.iter().enumerate() { p { (k + 1) ": " b { (review.metadata.trainee) } " · " (review.metadata.started_utc) " · " (review.vehicle.name) " · " (review.assessment.completion.headline(Language::English)) ". " (verdict(review.assessment.certification.passed, &review.assessment.certification.unmet, Language::English)) } }
                }
            }
            main {
                @if !same { p.note { "These sessions are from different jobs, so their scores are only roughly comparable." } }
                section aria-labelledby="scores-head" {
                    h2 id="scores-head" { "Scores" }
                    div.split {
                        (figure("The four scores, first vs. second session", &html! { (legend(&key)) (radar(&spokes, "Radar chart of both sessions")) }))
                        (table(first, second, if same { reliability } else { &[] }).shown())
                    }
                    (error_note(same, reliability))
                }
                section aria-labelledby="flight-head" {
                    h2 id="flight-head" { "Flights" }
                    (charts::section(both, same, &alignment_events, &key))
                }
                @if same {
                    section aria-labelledby="tasks-head" {
                        h2 id="tasks-head" { "Tasks" }
                        (figure("On-path share by task", &html! { (legend(&key)) (shares(&rows(first, second), "On-path share by task, both sessions")) }))
                    }
                }
            }
        },
    )
}

/// Explains the labels, or why there are none.
fn error_note(same_job: bool, reliability: &[MeasureReliability]) -> Markup {
    let known = reliability.iter().any(|one| one.reliability.is_some());
    html! {
        @if same_job && known {
            p.note { "A change is within error if it is smaller than the minimal detectable change of its measure, estimated from all trainees who flew this job more than once." }
        } @else if same_job {
            p.note { "The changes are not labeled, because the error of the measures is unknown: it is estimated from the records of at least two trainees who flew this job more than once." }
        }
    }
}

fn session_label(review: &Review) -> String {
    format!("{}, {}", review.metadata.trainee, review.metadata.started_utc)
}

fn rows(first: &Review, second: &Review) -> Vec<ShareRow> {
    let tasks = first.scenario.tasks.iter().enumerate();
    tasks
        .map(|(k, task)| ShareRow {
            name: format!("{} · {}", task.id, task.name),
            bars: vec![("dot-1", first.assessment.tasks[k].on_path), ("dot-2", second.assessment.tasks[k].on_path)],
            placeholder: None,
        })
        .collect()
}

fn table(first: &Review, second: &Review, reliability: &[MeasureReliability]) -> Table {
    let mut rows = Vec::new();
    let mut put = |name: &str, measure: &str, digits: usize, values: [Option<f64>; 2]| {
        let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        let change = match values {
            [Some(a), Some(b)] => Some(b - a),
            _ => None,
        };
        let known = change.zip(reliability_of(reliability, measure));
        let label = within_error::label(known.and_then(|(change, known)| known.is_within_error(change)));
        rows.push(vec![name.into(), number(values[0]), number(values[1]), number(change), label]);
    };
    let both = [first, second];
    let [ours, theirs] = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    for ((name, a), (_, b)) in ours.into_iter().zip(theirs) {
        put(name, &name.to_lowercase(), 1, [a, b].map(|score| score.map(|score| score.pct)));
    }
    put(
        "Overall",
        "overall",
        1,
        both.map(|review| review.assessment.completion.complete.then_some(review.assessment.scores.overall)),
    );
    put("Certification sum", "certification_sum", 1, both.map(|review| Some(review.assessment.certification.scores.sum)));
    put("Path flown (%)", NO_MEASURE, 0, both.map(|review| Some(100.0 * review.assessment.completion.path_share)));
    put("Flight time (s)", "flight_time", 0, both.map(|review| Some(review.assessment.end.seconds)));
    put("Contacts", "crashes", 0, both.map(|review| Some(review.crashes.len() as f64)));
    put("Pictures", NO_MEASURE, 0, both.map(|review| Some(review.pictures.len() as f64)));
    put("Defects found", NO_MEASURE, 0, both.map(|review| Some(review.assessment.snapshots.defects_found as f64)));
    put("Cues", NO_MEASURE, 0, both.map(|review| Some(review.feedback.episodes.len() as f64)));
    put("Time too close or off path (s)", NO_MEASURE, 1, both.map(|review| Some(warning_duration_s(review))));
    put(
        "Surface captured well (m²)",
        NO_MEASURE,
        0,
        both.map(|review| Some(review.coverage.total().area_m2(SurfaceOutcome::Shown))),
    );
    Table {
        name: "comparison",
        caption: "results of both sessions",
        columns: vec!["measure", "first", "second", "change", "measurement error"],
        rows,
    }
}

/// Returns the total duration of the "too close" and "off path" cues in seconds.
fn warning_duration_s(review: &Review) -> f64 {
    let wanted = |kind: usize| matches!(crate::report::feedback::KINDS[kind].name, "too close" | "off path");
    review.feedback.episodes.iter().filter(|e| wanted(e.kind)).map(|e| e.to_s - e.from_s).sum()
}
