//! In-flight feedback and the trainee's reaction times.

use super::figure::{figure, scrolling};
use crate::report::Review;
use crate::report::feedback::{CueEpisode, KINDS, median};
use crate::report::formatting;
use crate::report::plots::{coord, line, svg_figure, ticks};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

const WIDTH: f64 = 620.0;
const LEFT_X: f64 = 96.0;
const RIGHT_X: f64 = 600.0;
const ROW_HEIGHT: f64 = 34.0;
/// End of the time axis, s. Later stick movements do not count as a reaction.
const MAX_REACTION_S: f64 = 5.0;

/// Renders the "Feedback" section of a session report.
pub fn section(review: &Review) -> Markup {
    let present: Vec<usize> = (0..KINDS.len()).filter(|kind| of(review, *kind).next().is_some()).collect();
    html! {
        @if present.is_empty() { p.calm { "No feedback was given." } } @else {
            div.scroll tabindex="0" role="region" aria-label="Feedback summary" {
                table {
                    thead { tr { th scope="col" { "feedback" } th scope="col" { "count" } th scope="col" { "total duration (s)" } th scope="col" { "stick reactions" } th scope="col" { "median reaction time (s)" } } }
                    tbody { @for kind in &present { (row(review, *kind)) } }
                }
            }
            @if reactions_by_kind(review).next().is_some() {
                (figure("Time from the cue to the first stick movement; each dot is one cue; the bar marks the median", &scrolling("Reaction times", &reactions(review))))
            }
            p.note { "A reaction is a stick movement of at least 10% of full travel within 5 s of the cue. If a stick was already moving, it may count as a reaction by coincidence." }
        }
        @if !review.feedback.notes.is_empty() { (notes(review).shown()) }
        (episodes(review).folded())
        (texts(review).folded())
    }
}

fn of(review: &Review, kind: usize) -> impl Iterator<Item = &CueEpisode> {
    review.feedback.episodes.iter().filter(move |episode| episode.kind == kind)
}

fn reactions_by_kind(review: &Review) -> impl Iterator<Item = (usize, f64)> + '_ {
    review.feedback.episodes.iter().filter_map(|episode| episode.reaction_s.map(|reaction_s| (episode.kind, reaction_s)))
}

fn times(review: &Review, kind: usize) -> Vec<f64> {
    of(review, kind).filter_map(|episode| episode.reaction_s).collect()
}

fn row(review: &Review, kind: usize) -> Markup {
    let count = of(review, kind).count();
    let on: f64 = of(review, kind).map(|episode| episode.to_s - episode.from_s).sum();
    let answers = times(review, kind);
    html! {
        tr {
            th scope="row" { (KINDS[kind].name) }
            td.number { (count) }
            td.number { (formatting::number(on, 1)) }
            @if KINDS[kind].expects_reaction {
                td.number { (answers.len()) " of " (count) }
                td.number { (median(answers).map_or("–".into(), |s| formatting::number(s, 2))) }
            } @else { td.number { "–" } td.number { "–" } }
        }
    }
}

/// Returns the horizontal position of a reaction time in the drawing.
fn x_of_reaction(reaction_s: f64) -> f64 {
    LEFT_X + (RIGHT_X - LEFT_X) * (reaction_s / MAX_REACTION_S).clamp(0.0, 1.0)
}

fn reactions(review: &Review) -> Markup {
    let kinds: Vec<usize> = (0..KINDS.len()).filter(|kind| !times(review, *kind).is_empty()).collect();
    let bottom = ROW_HEIGHT * kinds.len() as f64 + 4.0;
    svg_figure(
        (WIDTH, bottom + 24.0),
        "Reaction times by cue",
        "reactions",
        &html! {
            @for tick in ticks(MAX_REACTION_S, 5) {
                path.grid d=(line(&[(x_of_reaction(tick), 0.0), (x_of_reaction(tick), bottom)], false)) {}
                text.tick x=(coord(x_of_reaction(tick))) y=(coord(bottom + 16.0)) text-anchor="middle" { (formatting::number(tick, 0)) " s" }
            }
            @for (k, kind) in kinds.iter().enumerate() {
                @let y = ROW_HEIGHT * k as f64 + 0.5 * ROW_HEIGHT;
                text.label x=(coord(LEFT_X - 10.0)) y=(coord(y + 5.0)) text-anchor="end" { (KINDS[*kind].name) }
                @for reaction_s in times(review, *kind) { circle.reaction cx=(coord(x_of_reaction(reaction_s))) cy=(coord(y)) r="5" {} }
                @if let Some(middle) = median(times(review, *kind)) { path.median d=(line(&[(x_of_reaction(middle), y - 11.0), (x_of_reaction(middle), y + 11.0)], false)) {} }
            }
        },
    )
}

fn episodes(review: &Review) -> Table {
    let row = |episode: &CueEpisode| {
        vec![
            TableCell::Clock(episode.from_s),
            KINDS[episode.kind].name.into(),
            TableCell::Number(episode.to_s - episode.from_s, 2),
            episode.reaction_s.map_or(TableCell::Empty, |reaction_s| TableCell::Number(reaction_s, 2)),
            episode.task.map_or("between tasks".into(), |task| format!("task {}", review.scenario.tasks[task].id)).into(),
        ]
    };
    Table {
        name: "feedback",
        caption: "feedback shown",
        columns: vec!["time", "feedback", "duration (s)", "reaction time (s)", "task"],
        rows: review.feedback.episodes.iter().map(row).collect(),
    }
}

fn texts(review: &Review) -> Table {
    let row = |(t_s, text): &(f64, String)| vec![TableCell::Clock(*t_s), text.clone().into()];
    Table {
        name: "texts",
        caption: "messages sent",
        columns: vec!["time", "text"],
        rows: review.feedback.texts.iter().map(row).collect(),
    }
}

/// Returns the instructor's notes as a table. The trainee did not see these notes during the flight.
fn notes(review: &Review) -> Table {
    let row = |(t_s, text): &(f64, String)| {
        let when = if *t_s < 0.0 { "before lift-off".into() } else { TableCell::Clock(*t_s) };
        vec![when, text.clone().into()]
    };
    Table {
        name: "notes",
        caption: "instructor's notes",
        columns: vec!["time", "note"],
        rows: review.feedback.notes.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reaction_times_map_to_axis() {
        assert_eq!((x_of_reaction(0.0), x_of_reaction(2.5), x_of_reaction(5.0), x_of_reaction(9.0)), (96.0, 348.0, 600.0, 600.0));
    }
}
