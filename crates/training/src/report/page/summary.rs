//! Page header and the four scores with explanations.

use super::figure::figure;
use crate::report::Review;
use crate::report::formatting;
use crate::report::line_of_sight::{out_of_sight_sentence, walks_sentence};
use crate::report::plots::radar::{RadarAxis, radar};
use crate::report::table::{Table, TableCell, folded};
use crate::terms;
use maud::{Markup, html};
use spandrel_monitor::assessment::Scores;
use spandrel_monitor::score::Score;
use spandrel_monitor::score::completion::verdict;
use spandrel_text::terms::capitalized;
use spandrel_text::{Language, text};

/// Renders the trainee, job, date and overall score.
pub fn header(review: &Review) -> Markup {
    let scores = &review.assessment.scores;
    let end = &review.assessment.end;
    let certification = &review.assessment.certification;
    let telemetry = &review.assessment.telemetry;
    let language = review.metadata.language;
    let (duration, reason) = (formatting::duration(end.seconds), terms::end_reason_title(end.reason.label(), language));
    html! {
        a.skip href="#better" { (text!(language, "report-skip")) }
        header {
            div {
                p.kicker { (text!(language, "report-kicker")) }
                h1 { (review.title(language)) }
                p {
                    b { (review.metadata.trainee) } " · " (utc(&review.metadata.started_utc)) " · " (review.vehicle.name)
                    @if let Some(purpose) = &review.metadata.purpose { " · " (terms::purpose_title(purpose, language)) }
                    @if let Some(difficulty) = &review.scenario.difficulty {
                        " · " (text!(language, "report-level", level = difficulty.level, levels = difficulty.levels()))
                    }
                }
                p { (text!(language, "report-flight-time", duration = duration, end = reason)) @if telemetry.missing_frames > 0 { " " (telemetry_summary(review)) } }
                @if let Some(aids) = review.assessment.practice_aids.words(language) { p { (text!(language, "report-practice-aids", aids = aids)) } }
                @for words in review.hazard_sentences(language) { p { (words) } }
                @if let Some(words) = out_of_sight_sentence(review.out_of_sight, language) { p { (words) } }
                @if let Some(words) = walks_sentence(&review.site, &review.frames, language) { p { (words) } }
            }
            div.overall {
                @if review.assessment.completion.complete {
                    p.figure { (formatting::number(scores.overall, 0)) span.of { " " (text!(language, "report-of-max", max = formatting::number(scores.overall_max, 0))) } }
                    p { (terms::score_title("overall", language)) }
                    p { (review.assessment.completion.headline(language)) }
                } @else {
                    p.headline { (review.assessment.completion.headline(language)) }
                }
                p { a href="#certification" { (verdict(certification.passed, &certification.unmet, language)) } }
            }
        }
    }
}

/// Formats an RFC 3339 timestamp for display.
pub(super) fn utc(text: &str) -> String {
    text.replace('T', " ").trim_end_matches('Z').to_owned() + " UTC"
}

fn telemetry_summary(review: &Review) -> String {
    let share = formatting::number(100.0 * review.assessment.telemetry.covered, 1);
    text!(review.metadata.language, "report-telemetry-covers", share = share)
}

/// Renders the radar chart, the score cards and their table.
pub fn scores(review: &Review) -> Markup {
    let scores = &review.assessment.scores;
    let language = review.metadata.language;
    let spokes: Vec<RadarAxis> = scores_by_name(scores)
        .iter()
        .map(|(name, score)| RadarAxis { name: score_title(name, language), values: vec![score.map(|score| score.pct)] })
        .collect();
    let chart = radar(&spokes, &text!(language, "report-scores-radar"), language);
    html! {
        p { (review.assessment.completion.headline(language)) "." @if !review.assessment.completion.complete { " " (text!(language, "report-scores-part")) } }
        div.split {
            (figure(&text!(language, "report-scores-figure"), &chart))
            div.cards {
                @for (name, score) in scores_by_name(scores) {
                    div.card {
                        h3 { (score_title(name, language)) }
                        p.figure { @if let Some(score) = score { (formatting::number(score.pct, 0)) } @else { (text!(language, "plot-not-applicable")) } }
                        p { (score_explanation(review, name)) }
                    }
                }
            }
        }
        (folded(language, |language| table(review, language)))
    }
}

/// Returns the names and values of the four scores, in chart order.
pub fn scores_by_name(scores: &Scores) -> [(&'static str, Option<Score>); 4] {
    [
        ("conformity", scores.conformity),
        ("efficiency", Some(scores.efficiency)),
        ("safety", Some(scores.safety)),
        ("accuracy", scores.accuracy),
    ]
}

/// Returns the display name of a score for headings.
pub fn score_title(score: &str, language: Language) -> String {
    capitalized(&terms::score_title(score, language))
}

fn score_explanation(review: &Review, name: &str) -> String {
    match name {
        "conformity" => conformity(review),
        "efficiency" => efficiency(review),
        "safety" => safety(review),
        _ => accuracy(review),
    }
}

fn conformity(review: &Review) -> String {
    let (tasks, language) = (&review.assessment.tasks, review.metadata.language);
    let Some(worst) = tasks.iter().min_by(|a, b| a.on_path.total_cmp(&b.on_path)) else {
        return text!(language, "report-explain-no-tasks");
    };
    let skipped = tasks.iter().filter(|task| !task.attempted).count();
    if skipped == tasks.len() {
        return text!(language, "report-explain-none-attempted");
    }
    if skipped > 0 {
        return text!(language, "report-explain-skipped", skipped = skipped, tasks = tasks.len());
    }
    let speeding_s: f64 = review.tasks.iter().map(|task| task.speeding_s).sum();
    let share = formatting::number(100.0 * worst.on_path, 0);
    let speeding = formatting::number(speeding_s, 0);
    text!(language, "report-explain-lowest", share = share, task = worst.id, speeding = speeding)
}

fn efficiency(review: &Review) -> String {
    let (end, language) = (&review.assessment.end, review.metadata.language);
    if end.battery_failed {
        return text!(language, "report-explain-battery-failed");
    }
    let best = formatting::duration(review.scenario.scoring.time_best_s);
    text!(language, "report-explain-time", time = formatting::duration(end.seconds), best = best)
}

fn safety(review: &Review) -> String {
    let (crashes, language) = (&review.assessment.crashes, review.metadata.language);
    match (crashes.person + crashes.vehicle, crashes.other) {
        (0, 0) => text!(language, "report-explain-no-contacts"),
        (0, other) => text!(language, "report-explain-contacts", count = other),
        _ => text!(language, "report-explain-grave"),
    }
}

fn accuracy(review: &Review) -> String {
    let (pictures, language) = (&review.assessment.snapshots, review.metadata.language);
    if review.assessment.scores.accuracy.is_none() {
        return text!(language, "report-explain-no-defects");
    }
    let (found, placed) = (pictures.defects_found, pictures.defects_placed);
    text!(language, "report-explain-defects", found = found, placed = placed, hits = pictures.hits, taken = pictures.taken)
}

fn table(review: &Review, language: Language) -> Table {
    let scores = &review.assessment.scores;
    let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 2));
    let mut rows: Vec<Vec<TableCell>> = scores_by_name(scores)
        .iter()
        .map(|(name, score)| vec![score_title(name, language).into(), number(score.map(|s| s.raw)), number(score.map(|s| s.pct))])
        .collect();
    if review.assessment.completion.complete {
        rows.push(vec![score_title("overall", language).into(), TableCell::Empty, TableCell::Number(scores.overall, 2)]);
    }
    Table {
        name: "scores",
        caption: text!(language, "report-scores-caption"),
        columns: vec![
            text!(language, "report-column-score"),
            text!(language, "report-column-raw"),
            text!(language, "report-column-score-of-100"),
        ],
        rows,
    }
}
