//! Side-by-side comparison of two sessions.

mod charts;

use super::figure::{figure, legend};
use super::{PageScripts, document, series, summary};
use crate::report::Review;
use crate::report::coverage::SurfaceOutcome;
use crate::report::plots::bars::{ShareRow, shares};
use crate::report::plots::radar::{RadarAxis, radar};
use crate::report::table::{Table, TableCell};
use maud::html;
use spandrel_monitor::score::completion::verdict;

/// Renders the session comparison page.
#[must_use]
pub fn comparison(first: &Review, second: &Review) -> String {
    let both = [first, second];
    let named = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    let spokes: Vec<RadarAxis> = (0..4)
        .map(|k| RadarAxis {
            name: named[0][k].0,
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
                    @for (k, review) in both.iter().enumerate() { p { (k + 1) ": " b { (review.metadata.trainee) } " · " (review.metadata.started_utc) " · " (review.vehicle.name) " · " (review.assessment.completion.headline()) ". " (verdict(review.assessment.certification.passed, &review.assessment.certification.unmet)) } }
                }
            }
            main {
                @if !same { p.note { "These sessions are from different jobs, so their scores are only roughly comparable." } }
                section aria-labelledby="scores-head" {
                    h2 id="scores-head" { "Scores" }
                    div.split {
                        (figure("The four scores, first vs. second session", &html! { (legend(&key)) (radar(&spokes, "Radar chart of both sessions")) }))
                        (table(first, second).shown())
                    }
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

fn table(first: &Review, second: &Review) -> Table {
    let mut rows = Vec::new();
    let mut put = |name: &str, digits: usize, values: [Option<f64>; 2]| {
        let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        let change = match values {
            [Some(a), Some(b)] => Some(b - a),
            _ => None,
        };
        rows.push(vec![name.into(), number(values[0]), number(values[1]), number(change)]);
    };
    let both = [first, second];
    let [ours, theirs] = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    for ((name, a), (_, b)) in ours.into_iter().zip(theirs) {
        put(name, 1, [a, b].map(|score| score.map(|score| score.pct)));
    }
    put("Overall", 1, both.map(|review| review.assessment.completion.complete.then_some(review.assessment.scores.overall)));
    put("Certification sum", 1, both.map(|review| Some(review.assessment.certification.scores.sum)));
    put("Path flown (%)", 0, both.map(|review| Some(100.0 * review.assessment.completion.path_share)));
    put("Flight time (s)", 0, both.map(|review| Some(review.assessment.end.seconds)));
    put("Contacts", 0, both.map(|review| Some(review.crashes.len() as f64)));
    put("Pictures", 0, both.map(|review| Some(review.pictures.len() as f64)));
    put("Defects found", 0, both.map(|review| Some(review.assessment.snapshots.defects_found as f64)));
    put("Cues", 0, both.map(|review| Some(review.feedback.episodes.len() as f64)));
    put("Time too close or off path (s)", 1, both.map(|review| Some(warning_duration_s(review))));
    put("Surface captured well (m²)", 0, both.map(|review| Some(review.coverage.total().area_m2(SurfaceOutcome::Shown))));
    Table { name: "comparison", caption: "results of both sessions", columns: vec!["measure", "first", "second", "change"], rows }
}

/// Returns the total duration of the "too close" and "off path" cues in seconds.
fn warning_duration_s(review: &Review) -> f64 {
    let wanted = |kind: usize| matches!(crate::report::feedback::KINDS[kind].name, "too close" | "off path");
    review.feedback.episodes.iter().filter(|e| wanted(e.kind)).map(|e| e.to_s - e.from_s).sum()
}
