//! In-flight feedback and the trainee's reaction times.

use super::figure::{figure, scrolling};
use super::tasks::task_label;
use crate::report::Review;
use crate::report::feedback::{CueEpisode, KINDS, median};
use crate::report::formatting;
use crate::report::plots::{coord, line, svg_figure, ticks};
use crate::report::table::{Table, TableCell, folded, shown};
use maud::{Markup, html};
use spandrel_text::monitor_texts::message_words;
use spandrel_text::{Language, text};

const WIDTH: f64 = 620.0;
const LEFT_X: f64 = 96.0;
const RIGHT_X: f64 = 600.0;
const ROW_HEIGHT: f64 = 34.0;
/// End of the time axis, s. Later stick movements do not count as a reaction.
const MAX_REACTION_S: f64 = 5.0;

/// Renders the "Feedback" section of a session report.
pub fn section(review: &Review) -> Markup {
    let present: Vec<usize> = (0..KINDS.len()).filter(|kind| of(review, *kind).next().is_some()).collect();
    let language = review.metadata.language;
    html! {
        @if present.is_empty() { p.calm { (text!(language, "report-feedback-none")) } } @else {
            div.scroll tabindex="0" role="region" aria-label=(text!(language, "report-feedback-region")) {
                table {
                    thead { tr { @for column in summary_columns(language) { th scope="col" { (column) } } } }
                    tbody { @for kind in &present { (row(review, *kind)) } }
                }
            }
            @if reactions_by_kind(review).next().is_some() {
                (figure(&text!(language, "report-feedback-figure"), &scrolling(&text!(language, "report-feedback-reactions-region"), &reactions(review))))
            }
            p.note { (text!(language, "report-feedback-note")) }
        }
        @if !review.feedback.notes.is_empty() { (shown(language, |language| notes(review, language))) }
        (folded(language, |language| episodes(review, language)))
        (folded(language, |language| texts(review, language)))
    }
}

fn summary_columns(language: Language) -> [String; 5] {
    [
        text!(language, "report-column-feedback"),
        text!(language, "report-column-count"),
        text!(language, "report-column-total-duration"),
        text!(language, "report-column-stick-reactions"),
        text!(language, "report-column-median-reaction"),
    ]
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
    let language = review.metadata.language;
    html! {
        tr {
            th scope="row" { (KINDS[kind].label(language)) }
            td.number { (count) }
            td.number { (formatting::number(on, 1)) }
            @if KINDS[kind].expects_reaction {
                td.number { (text!(language, "report-feedback-answers", answers = answers.len(), count = count)) }
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
        &text!(review.metadata.language, "report-feedback-reactions"),
        "reactions",
        &html! {
            @for tick in ticks(MAX_REACTION_S, 5) {
                path.grid d=(line(&[(x_of_reaction(tick), 0.0), (x_of_reaction(tick), bottom)], false)) {}
                text.tick x=(coord(x_of_reaction(tick))) y=(coord(bottom + 16.0)) text-anchor="middle" { (formatting::number(tick, 0)) " s" }
            }
            @for (k, kind) in kinds.iter().enumerate() {
                @let y = ROW_HEIGHT * k as f64 + 0.5 * ROW_HEIGHT;
                text.label x=(coord(LEFT_X - 10.0)) y=(coord(y + 5.0)) text-anchor="end" { (KINDS[*kind].label(review.metadata.language)) }
                @for reaction_s in times(review, *kind) { circle.reaction cx=(coord(x_of_reaction(reaction_s))) cy=(coord(y)) r="5" {} }
                @if let Some(middle) = median(times(review, *kind)) { path.median d=(line(&[(x_of_reaction(middle), y - 11.0), (x_of_reaction(middle), y + 11.0)], false)) {} }
            }
        },
    )
}

fn episodes(review: &Review, language: Language) -> Table {
    let row = |episode: &CueEpisode| {
        vec![
            TableCell::Clock(episode.from_s),
            KINDS[episode.kind].label(language).into(),
            TableCell::Number(episode.to_s - episode.from_s, 2),
            episode.reaction_s.map_or(TableCell::Empty, |reaction_s| TableCell::Number(reaction_s, 2)),
            task_label(episode.task, review, language).into(),
        ]
    };
    Table {
        name: "feedback",
        caption: text!(language, "report-feedback-caption"),
        columns: vec![
            text!(language, "report-column-time"),
            text!(language, "report-column-feedback"),
            text!(language, "report-column-duration"),
            text!(language, "report-column-reaction-time"),
            text!(language, "report-column-task"),
        ],
        rows: review.feedback.episodes.iter().map(row).collect(),
    }
}

fn texts(review: &Review, language: Language) -> Table {
    let row = |(t_s, sent): &(f64, String)| {
        let words = message_words(sent, language).unwrap_or_else(|| sent.clone());
        vec![TableCell::Clock(*t_s), words.into()]
    };
    Table {
        name: "texts",
        caption: text!(language, "report-feedback-texts-caption"),
        columns: vec![text!(language, "report-column-time"), text!(language, "report-column-text")],
        rows: review.feedback.texts.iter().map(row).collect(),
    }
}

/// Returns the instructor's notes as a table. The trainee did not see these notes during the flight.
fn notes(review: &Review, language: Language) -> Table {
    let row = |(t_s, text): &(f64, String)| {
        let when = if *t_s < 0.0 { text!(language, "report-feedback-before").into() } else { TableCell::Clock(*t_s) };
        vec![when, text.clone().into()]
    };
    Table {
        name: "notes",
        caption: text!(language, "report-feedback-notes-caption"),
        columns: vec![text!(language, "report-column-time"), text!(language, "report-column-note")],
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
