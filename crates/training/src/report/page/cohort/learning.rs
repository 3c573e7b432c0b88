//! Practice effects: the group's learning curves and the trainees with repeat sessions.

use super::super::figure::{figure, legend};
use super::super::progress::{max_value, progress_figures, too_few_repetitions};
use super::super::within_error;
use crate::cohort::{Cohort, GroupCurve, TraineeProgress};
use crate::report::plots::learning_curve::{PracticeChart, practice};
use crate::report::table::{Table, TableCell, shown};
use crate::statistics::LearningCurve;
use crate::terms::{score_title, task_titles};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Maximum number of individual curves drawn behind the group's curve; readers could not tell more of them apart.
const MAX_INDIVIDUAL_CURVES: usize = 40;
/// Maximum number of trainees shown individually.
const MAX_INDIVIDUAL_TRAINEES: usize = 24;

/// Renders the group's curves, or the reason why there are none.
pub fn curves(cohort: &Cohort, language: Language) -> Markup {
    let key = [
        ("dot-1", text!(language, "cohort-learning-mean")),
        ("fitted-key", text!(language, "cohort-learning-fitted")),
        ("one-of-many-key", text!(language, "cohort-learning-one")),
    ];
    html! {
        @if cohort.learning.is_empty() {
            p.calm { (too_few_repetitions(language)) " " (text!(language, "cohort-learning-none")) }
        } @else {
            (legend(&key))
            div.trio {
                @for one in &cohort.learning {
                    @let others = individual_curves(cohort, &one.score);
                    @let chart = PracticeChart { values: &one.means, curve: &one.curve, others: &others, max_value: max_value(&one.score) };
                    @let score = score_title(&one.score, language);
                    @let caption = text!(language, "cohort-learning-figure", score = score.as_str(), count = one.people);
                    (figure(&caption, &practice(&chart, &text!(language, "report-progress-curve", score = score.as_str()), language)))
                }
            }
            p.note { (text!(language, "cohort-learning-note")) }
            (shown(language, |language| numbers(&cohort.learning, language)))
        }
    }
}

fn individual_curves(cohort: &Cohort, score: &str) -> Vec<LearningCurve> {
    let all: Vec<LearningCurve> = cohort
        .progress
        .iter()
        .flat_map(|one| &one.curves)
        .filter(|curve| curve.score == score)
        .map(|curve| curve.curve)
        .collect();
    if all.len() > MAX_INDIVIDUAL_CURVES { Vec::new() } else { all }
}

fn numbers(curves: &[GroupCurve], language: Language) -> Table {
    let row = |one: &GroupCurve| {
        let c = &one.curve;
        vec![
            score_title(&one.score, language).into(),
            one.people.into(),
            c.n.into(),
            TableCell::Number(one.means.first().copied().unwrap_or_default(), 1),
            TableCell::Number(one.means.last().copied().unwrap_or_default(), 1),
            TableCell::Number(c.exponent, 3),
            c.r_squared.map_or(TableCell::Empty, |value| TableCell::Number(value, 2)),
            TableCell::Number(c.next.min(max_value(&one.score)), 1),
            within_error::label(one.within_error, language),
        ]
    };
    Table {
        name: "learning_of_the_group",
        caption: text!(language, "cohort-learning-caption"),
        columns: vec![
            text!(language, "report-column-score"),
            text!(language, "cohort-column-trainees"),
            text!(language, "report-column-repetitions"),
            text!(language, "cohort-column-first-mean"),
            text!(language, "cohort-column-last-mean"),
            text!(language, "report-column-exponent"),
            "R²".to_owned(),
            text!(language, "report-column-next"),
            text!(language, "report-column-measurement-error"),
        ],
        rows: curves.iter().map(row).collect(),
    }
}

/// Renders each trainee with more than one session.
pub fn individual_results(cohort: &Cohort, language: Language) -> Markup {
    let repeated: Vec<&TraineeProgress> = repeat_trainees(cohort).collect();
    html! {
        @if repeated.len() > MAX_INDIVIDUAL_TRAINEES {
            p.calm { (text!(language, "cohort-individual-too-many", count = repeated.len(), limit = MAX_INDIVIDUAL_TRAINEES)) }
        } @else {
            @for one in repeated {
                details.numbers {
                    summary { (text!(language, "cohort-individual", trainee = one.trainee.as_str(), count = one.repetitions.len())) }
                    (progress_figures(one, &tasks(cohort, one, language), language))
                }
            }
        }
    }
}

/// Returns the trainees with more than one session.
pub fn repeat_trainees(cohort: &Cohort) -> impl Iterator<Item = &TraineeProgress> {
    cohort.progress.iter().filter(|one| one.repetitions.len() > 1)
}

/// Returns the task numbers and titles from the trainee's first session.
fn tasks(cohort: &Cohort, one: &TraineeProgress, language: Language) -> Vec<(u32, String)> {
    let first = cohort.individuals.iter().find(|first| first.trainee == one.trainee);
    let tasks: Vec<(u32, String)> =
        first.into_iter().flat_map(|first| &first.tasks).map(|task| (task.id, task.name.clone())).collect();
    cohort.scenarios.first().map_or_else(Vec::new, |job| task_titles(job, &tasks, language))
}
