//! Page header and the four scores with explanations.

use super::figure::figure;
use crate::report::Review;
use crate::report::formatting;
use crate::report::plots::radar::{RadarAxis, radar};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_monitor::assessment::Scores;
use spandrel_monitor::score::Score;
use spandrel_monitor::score::completion::verdict;
use spandrel_text::Language;

/// Renders the trainee, job, date and overall score.
pub fn header(review: &Review) -> Markup {
    let scores = &review.assessment.scores;
    let end = &review.assessment.end;
    let certification = &review.assessment.certification;
    let telemetry = &review.assessment.telemetry;
    html! {
        a.skip href="#better" { "Skip to what to do better" }
        header {
            div {
                p.kicker { "Session report" }
                h1 { (review.scenario.title) }
                p {
                    b { (review.metadata.trainee) } " · " (utc(&review.metadata.started_utc)) " · " (review.vehicle.name)
                    @if let Some(purpose) = &review.metadata.purpose { " · " (purpose) }
                    @if let Some(difficulty) = &review.scenario.difficulty { " · level " (difficulty.level) " of " (difficulty.levels()) }
                }
                p { "Flight time " (formatting::duration(end.seconds)) ", " (formatting::end_reason_label(end.reason)) "." @if telemetry.missing_frames > 0 { " " (telemetry_summary(review)) } }
                @if let Some(words) = review.assessment.practice_aids.words(Language::English) { p { "This session was " (words) ". It counts as practice: it is neither certified nor compared with others." } }
                @if let Some(words) = review.out_of_sight.sentence() { p { (words) } }
            }
            div.overall {
                @if review.assessment.completion.complete {
                    p.figure { (formatting::number(scores.overall, 0)) span.of { " of " (formatting::number(scores.overall_max, 0)) } }
                    p { "overall" }
                    p { (review.assessment.completion.headline(Language::English)) }
                } @else {
                    p.headline { (review.assessment.completion.headline(Language::English)) }
                }
                p { (verdict(certification.passed, &certification.unmet, Language::English)) }
            }
        }
    }
}

/// Formats an RFC 3339 timestamp for display.
fn utc(text: &str) -> String {
    text.replace('T', " ").trim_end_matches('Z').to_owned() + " UTC"
}

fn telemetry_summary(review: &Review) -> String {
    format!("The telemetry covers {}% of the session.", formatting::number(100.0 * review.assessment.telemetry.covered, 1))
}

/// Renders the radar chart, the score cards and their table.
pub fn scores(review: &Review) -> Markup {
    let scores = &review.assessment.scores;
    let spokes: Vec<RadarAxis> = scores_by_name(scores)
        .iter()
        .map(|(name, score)| RadarAxis { name: (*name).to_owned(), values: vec![score.map(|score| score.pct)] })
        .collect();
    html! {
        p { (review.assessment.completion.headline(Language::English)) "." @if !review.assessment.completion.complete { " The scores below cover only the part that was flown." } }
        div.split {
            (figure("The four scores, 0 at the center, 100 at the edge", &radar(&spokes, "Radar chart of the four scores")))
            div.cards {
                @for (name, score) in scores_by_name(scores) {
                    div.card {
                        h3 { (name) }
                        p.figure { @if let Some(score) = score { (formatting::number(score.pct, 0)) } @else { "n/a" } }
                        p { (score_explanation(review, name)) }
                    }
                }
            }
        }
        (table(review).folded())
    }
}

/// Returns the names and values of the four scores, in chart order.
pub fn scores_by_name(scores: &Scores) -> [(&'static str, Option<Score>); 4] {
    [
        ("Conformity", scores.conformity),
        ("Efficiency", Some(scores.efficiency)),
        ("Safety", Some(scores.safety)),
        ("Accuracy", scores.accuracy),
    ]
}

fn score_explanation(review: &Review, name: &str) -> String {
    let assessment = &review.assessment;
    match name {
        "Conformity" => conformity(review),
        "Efficiency" => {
            let best = formatting::duration(review.scenario.scoring.time_best_s);
            if assessment.end.battery_failed {
                "did not land near the ground team before the battery or time ran out".into()
            } else {
                format!("flight time {}; full score up to {best}", formatting::duration(assessment.end.seconds))
            }
        }
        "Safety" => {
            let crashes = &assessment.crashes;
            match (crashes.person + crashes.vehicle, crashes.other) {
                (0, 0) => "no contacts".into(),
                (0, 1) => "1 contact, 3 points lost".into(),
                (0, other) => format!("{other} contacts, 3 points lost each"),
                _ => "a person or vehicle was hit: 0 points".into(),
            }
        }
        _ if assessment.scores.accuracy.is_none() => "no defects in this job".into(),
        _ => {
            let s = &assessment.snapshots;
            format!(
                "{} of {} defects found; {} of {} pictures showed a new defect",
                s.defects_found, s.defects_placed, s.hits, s.taken
            )
        }
    }
}

fn conformity(review: &Review) -> String {
    let tasks = &review.assessment.tasks;
    let Some(worst) = tasks.iter().min_by(|a, b| a.on_path.total_cmp(&b.on_path)) else { return "no tasks in this job".into() };
    let skipped = tasks.iter().filter(|task| !task.attempted).count();
    if skipped == tasks.len() {
        return "no tasks attempted (the TASBID formula gives 50 points)".into();
    }
    if skipped > 0 {
        return format!("{skipped} of {} tasks not attempted", tasks.len());
    }
    let speeding: f64 = review.tasks.iter().map(|task| task.speeding_s).sum();
    let lowest = formatting::number(100.0 * worst.on_path, 0);
    format!("lowest on-path share: {lowest}% (task {}); speeding for {} s", worst.id, formatting::number(speeding, 0))
}

fn table(review: &Review) -> Table {
    let scores = &review.assessment.scores;
    let certification = &review.assessment.certification.scores;
    let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 2));
    let beside = [certification.conformity, Some(certification.efficiency), Some(certification.safety), certification.accuracy];
    let mut rows: Vec<Vec<TableCell>> = scores_by_name(scores)
        .iter()
        .zip(beside)
        .map(|((name, score), beside)| {
            vec![(*name).into(), number(score.map(|s| s.raw)), number(score.map(|s| s.pct)), number(beside)]
        })
        .collect();
    if review.assessment.completion.complete {
        rows.push(vec!["Overall".into(), TableCell::Empty, TableCell::Number(scores.overall, 2), TableCell::Empty]);
    }
    Table {
        name: "scores",
        caption: "scores",
        columns: vec!["score", "raw", "score (of 100)", "certification profile (of 100)"],
        rows,
    }
}
