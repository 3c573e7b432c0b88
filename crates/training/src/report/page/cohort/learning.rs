//! Practice effects: the group's learning curves and the trainees with repeat sessions.

use super::super::figure::{figure, legend};
use super::super::progress::{max_value, progress_figures, too_few_repetitions};
use super::super::within_error;
use crate::cohort::{Cohort, GroupCurve, TraineeProgress};
use crate::report::plots::learning_curve::{PracticeChart, practice};
use crate::report::table::{Table, TableCell};
use crate::statistics::LearningCurve;
use maud::{Markup, html};

/// Maximum number of individual curves drawn behind the group's curve; readers could not tell more of them apart.
const MAX_INDIVIDUAL_CURVES: usize = 40;
/// Maximum number of trainees shown individually.
const MAX_INDIVIDUAL_TRAINEES: usize = 24;

/// Renders the group's curves, or the reason why there are none.
pub fn curves(cohort: &Cohort) -> Markup {
    let key = [
        ("dot-1", "mean".to_owned()),
        ("fitted-key", "curve fitted to the means".into()),
        ("one-of-many-key", "one trainee".into()),
    ];
    html! {
        @if cohort.learning.is_empty() {
            p.calm { (too_few_repetitions()) " No trainee has flown that many yet." }
        } @else {
            (legend(&key))
            div.trio {
                @for one in &cohort.learning {
                    @let others = individual_curves(cohort, &one.score);
                    @let chart = PracticeChart { values: &one.means, curve: &one.curve, others: &others, max_value: max_value(&one.score) };
                    (figure(&format!("{}, {}", one.score, people(one.people)), &practice(&chart, &format!("Learning curve of {}", one.score))))
                }
            }
            p.note { "Each curve is a fit of the power law of practice. The ring marks the prediction for the next repetition. The group curve is flatter than the individual trainees' curves." }
            (numbers(&cohort.learning).shown())
        }
    }
}

fn people(count: usize) -> String {
    if count == 1 { "one trainee".to_owned() } else { format!("{count} trainees") }
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

fn numbers(curves: &[GroupCurve]) -> Table {
    let row = |one: &GroupCurve| {
        let c = &one.curve;
        vec![
            one.score.clone().into(),
            one.people.into(),
            c.n.into(),
            TableCell::Number(one.means.first().copied().unwrap_or_default(), 1),
            TableCell::Number(one.means.last().copied().unwrap_or_default(), 1),
            TableCell::Number(c.exponent, 3),
            c.r_squared.map_or(TableCell::Empty, |value| TableCell::Number(value, 2)),
            TableCell::Number(c.next.min(max_value(&one.score)), 1),
            within_error::label(one.within_error),
        ]
    };
    Table {
        name: "learning_of_the_group",
        caption: "group learning curves, fitted to the means",
        columns: vec![
            "score",
            "trainees",
            "repetitions",
            "first mean",
            "last mean",
            "exponent",
            "R²",
            "next",
            "measurement error",
        ],
        rows: curves.iter().map(row).collect(),
    }
}

/// Renders each trainee with more than one session.
pub fn individual_results(cohort: &Cohort) -> Markup {
    let repeated: Vec<&TraineeProgress> = repeat_trainees(cohort).collect();
    html! {
        @if repeated.len() > MAX_INDIVIDUAL_TRAINEES {
            p.calm { (repeated.len()) " trainees flew more than once. Above " (MAX_INDIVIDUAL_TRAINEES) ", trainees are not shown individually; see progress.csv." }
        } @else {
            @for one in repeated {
                details.numbers { summary { (one.trainee) ", " (one.repetitions.len()) " times" } (progress_figures(one, &tasks(cohort, one))) }
            }
        }
    }
}

/// Returns the trainees with more than one session.
pub fn repeat_trainees(cohort: &Cohort) -> impl Iterator<Item = &TraineeProgress> {
    cohort.progress.iter().filter(|one| one.repetitions.len() > 1)
}

/// Returns the task numbers and names from the trainee's first session.
fn tasks(cohort: &Cohort, one: &TraineeProgress) -> Vec<(u32, String)> {
    let first = cohort.individuals.iter().find(|first| first.trainee == one.trainee);
    first.map(|first| first.tasks.iter().map(|task| (task.id, task.name.clone())).collect()).unwrap_or_default()
}
