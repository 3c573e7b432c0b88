//! Side-by-side comparison of two sessions.

mod charts;

use super::figure::{figure, legend};
use super::{PageScripts, document, series, summary, within_error};
use crate::cohort::{MeasureReliability, reliability_of};
use crate::record::FlownForm;
use crate::report::Review;
use crate::report::coverage::SurfaceOutcome;
use crate::report::feedback::KINDS;
use crate::report::plots::bars::{ShareRow, shares};
use crate::report::plots::radar::{RadarAxis, radar};
use crate::report::table::{Table, TableCell, shown};
use maud::{Markup, html};
use spandrel_mavlink::contract::cue;
use spandrel_monitor::score::completion::verdict;
use spandrel_text::{Language, text};

/// Placeholder for values whose reliability is not estimated.
const NO_MEASURE: &str = "";

/// Renders the session comparison page. Changes are labeled with the reliability of the measures on this job, as far as it
/// is known.
#[must_use]
pub fn comparison(first: &Review, second: &Review, reliability: &[MeasureReliability]) -> String {
    let both = [first, second];
    let language = first.metadata.language;
    let named = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    let spokes: Vec<RadarAxis> = (0..4)
        .map(|k| RadarAxis {
            name: summary::score_title(named[0][k].0, language),
            values: named.iter().map(|scores| scores[k].1.map(|score| score.pct)).collect(),
        })
        .collect();
    let same = first.scenario.tasks.len() == second.scenario.tasks.len() && first.scenario.crc == second.scenario.crc;
    let alignment_events = series::alignment_events(both, same);
    let key = [("dot-1", format!("1: {}", session_label(first))), ("dot-2", format!("2: {}", session_label(second)))];
    let chart = radar(&spokes, &text!(language, "compare-scores-radar"), language);
    let forms = both.map(|review| FlownForm::of(&review.scenario));
    let same_job = same || is_same_job(both);
    let comparable = same_job && forms[0].is_equated_with(&forms[1]);
    let labeled = if comparable { reliability } else { &[] };
    let title = text!(language, "compare-title");
    document(
        language,
        &title,
        &PageScripts::Comparison(series::comparison(both, &alignment_events)),
        &html! {
            header {
                div {
                    p.kicker { (title) }
                    h1 { (first.title(language)) }
                    @for (k, review) in both.iter().enumerate() { p { (k + 1) ": " b { (review.metadata.trainee) } " · " (summary::utc(&review.metadata.started_utc)) " · " (review.vehicle.name) " · " (review.assessment.completion.headline(language)) ". " (verdict(review.assessment.certification.passed, &review.assessment.certification.unmet, language)) } }
                }
            }
            main {
                @if !same_job { p.note { (text!(language, "compare-other-jobs")) } }
                @else if let Some(words) = form_words(&forms, language) { p.note { (words) } }
                section aria-labelledby="scores-head" {
                    h2 id="scores-head" { (text!(language, "compare-scores")) }
                    div.split {
                        (figure(&text!(language, "compare-scores-figure"), &html! { (legend(&key)) (chart) }))
                        (shown(language, |language| table(both, labeled, language)))
                    }
                    (error_note(comparable, reliability, language))
                }
                section aria-labelledby="flight-head" {
                    h2 id="flight-head" { (text!(language, "compare-flights")) }
                    (charts::section(both, same, &alignment_events, &key))
                }
                @if same {
                    section aria-labelledby="tasks-head" {
                        h2 id="tasks-head" { (text!(language, "compare-tasks")) }
                        (figure(&text!(language, "compare-tasks-figure"), &html! { (legend(&key)) (shares(&rows(first, second), &text!(language, "compare-tasks-title"))) }))
                    }
                }
            }
        },
    )
}

/// Returns whether both sessions flew the same job at the same level, in any of its forms.
fn is_same_job([first, second]: [&Review; 2]) -> bool {
    let job = |review: &Review| (review.scenario.name.clone(), review.scenario.difficulty.as_ref().map(|one| one.level));
    let has_forms = first.scenario.form.is_some() && second.scenario.form.is_some();
    has_forms && first.scenario.tasks.len() == second.scenario.tasks.len() && job(first) == job(second)
}

/// Names the forms of both sessions, and says whether they are equally difficult; `None` if they are the same.
fn form_words(forms: &[FlownForm; 2], language: Language) -> Option<String> {
    let [first, second] = forms;
    let (first_name, second_name) =
        first.name.as_deref().zip(second.name.as_deref()).filter(|(first, second)| first != second)?;
    Some(if first.is_equated_with(second) {
        text!(language, "compare-forms", first = first_name, second = second_name)
    } else {
        text!(language, "compare-forms-other", first = first_name, second = second_name)
    })
}

/// Explains the labels, or why there are none.
fn error_note(same_job: bool, reliability: &[MeasureReliability], language: Language) -> Markup {
    let known = reliability.iter().any(|one| one.reliability.is_some());
    html! {
        @if same_job && known {
            p.note { (text!(language, "compare-error-known")) }
        } @else if same_job {
            p.note { (text!(language, "compare-error-unknown")) }
        }
    }
}

fn session_label(review: &Review) -> String {
    format!("{}, {}", review.metadata.trainee, summary::utc(&review.metadata.started_utc))
}

fn rows(first: &Review, second: &Review) -> Vec<ShareRow> {
    let tasks = first.scenario.tasks.iter().enumerate();
    tasks
        .map(|(k, task)| ShareRow {
            name: format!("{} · {}", task.id, first.task_name(k, first.metadata.language)),
            bars: vec![("dot-1", first.assessment.tasks[k].on_path), ("dot-2", second.assessment.tasks[k].on_path)],
            placeholder: None,
        })
        .collect()
}

fn table(both: [&Review; 2], reliability: &[MeasureReliability], language: Language) -> Table {
    let mut rows = Vec::new();
    let mut put = |name: String, measure: &str, digits: usize, values: [Option<f64>; 2]| {
        let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
        let change = match values {
            [Some(a), Some(b)] => Some(b - a),
            _ => None,
        };
        let known = change.zip(reliability_of(reliability, measure));
        let label = within_error::label(known.and_then(|(change, known)| known.is_within_error(change)), language);
        rows.push(vec![name.into(), number(values[0]), number(values[1]), number(change), label]);
    };
    let [ours, theirs] = both.map(|review| summary::scores_by_name(&review.assessment.scores));
    for ((name, a), (_, b)) in ours.into_iter().zip(theirs) {
        put(summary::score_title(name, language), name, 1, [a, b].map(|score| score.map(|score| score.pct)));
    }
    let overall = |review: &Review| review.assessment.completion.complete.then_some(review.assessment.scores.overall);
    put(text!(language, "compare-measure-overall"), "overall", 1, both.map(overall));
    let mut put_known = |name: String, measure: &str, digits: usize, value: &dyn Fn(&Review) -> f64| {
        put(name, measure, digits, both.map(|review| Some(value(review))));
    };
    let name = text!(language, "compare-measure-certification");
    put_known(name, "certification_sum", 1, &|review| review.assessment.certification.scores.sum);
    let name = text!(language, "compare-measure-path");
    put_known(name, NO_MEASURE, 0, &|review| 100.0 * review.assessment.completion.path_share);
    put_known(text!(language, "compare-measure-time"), "flight_time", 0, &|review| review.assessment.end.seconds);
    put_known(text!(language, "compare-measure-contacts"), "crashes", 0, &|review| review.crashes.len() as f64);
    put_known(text!(language, "compare-measure-pictures"), NO_MEASURE, 0, &|review| review.pictures.len() as f64);
    let name = text!(language, "compare-measure-defects");
    put_known(name, NO_MEASURE, 0, &|review| review.assessment.snapshots.defects_found as f64);
    put_known(text!(language, "compare-measure-cues"), NO_MEASURE, 0, &|review| review.feedback.episodes.len() as f64);
    put_known(text!(language, "compare-measure-warned"), NO_MEASURE, 1, &warning_duration_s);
    let name = text!(language, "compare-measure-surface");
    put_known(name, NO_MEASURE, 0, &|review| review.coverage.total().area_m2(SurfaceOutcome::Shown));
    Table {
        name: "comparison",
        caption: text!(language, "compare-caption"),
        columns: vec![
            text!(language, "compare-column-measure"),
            text!(language, "compare-column-first"),
            text!(language, "compare-column-second"),
            text!(language, "report-column-change"),
            text!(language, "report-column-measurement-error"),
        ],
        rows,
    }
}

/// Returns the total duration of the "too close" and "off path" cues in seconds.
fn warning_duration_s(review: &Review) -> f64 {
    let wanted = |kind: usize| matches!(KINDS[kind].bit, cue::TOO_CLOSE | cue::OFF_PATH);
    review.feedback.episodes.iter().filter(|e| wanted(e.kind)).map(|e| e.to_s - e.from_s).sum()
}
