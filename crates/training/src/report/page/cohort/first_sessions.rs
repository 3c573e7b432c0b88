//! Scores of the first sessions: distributions, trainees and tasks, crashes.

use super::super::crash_kinds::{KINDS, crash_counts, segments};
use super::super::figure::{figure, legend};
use super::lists_individuals::lists_individuals;
use super::pooled;
use crate::cohort::Cohort;
use crate::report::plots::bars::{CountRow, ShareRow, counts, shares};
use crate::report::plots::histogram::histogram;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Renders the score distributions.
pub fn distributions(cohort: &Cohort) -> Markup {
    let rows = cohort.distributions.iter().map(|one| {
        let s = &one.summary;
        let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 2));
        let numbers = [s.min, s.q1, s.median, s.q3, s.max].map(|value| TableCell::Number(value, 1));
        let mut row = vec![one.score.clone().into(), s.n.into(), TableCell::Number(s.mean, 2), maybe(s.sd)];
        row.extend(numbers);
        row.push(maybe(s.skewness));
        row
    });
    let columns = vec!["score", "n", "mean", "sd", "min", "q1", "median", "q3", "max", "skewness"];
    let table = Table { name: "distributions", caption: "first sessions", columns, rows: rows.collect() };
    html! {
        div.trio {
            @for one in &cohort.distributions {
                (figure(&one.score, &histogram(&one.histogram, one.summary.mean, &format!("Histogram of {}; the line marks the mean", one.score))))
            }
        }
        (table.shown())
    }
}

/// Renders each trainee's scores and tasks, or distributions if there are too many trainees to list.
pub fn people(cohort: &Cohort) -> Markup {
    if lists_individuals(cohort) { individual_results(cohort) } else { pooled::tasks(cohort) }
}

fn individual_results(cohort: &Cohort) -> Markup {
    let rows: Vec<ShareRow> = cohort
        .individuals
        .iter()
        .map(|one| ShareRow {
            name: one.trainee.clone(),
            bars: one
                .tasks
                .iter()
                .zip(["dot-1", "dot-2", "dot-3", "dot-4"].iter().cycle())
                .map(|(task, class)| (*class, task.on_path))
                .collect(),
            placeholder: one.tasks.is_empty().then(|| "no tasks".to_owned()),
        })
        .collect();
    let key: Vec<(&str, String)> = cohort
        .individuals
        .first()
        .map(|one| {
            one.tasks
                .iter()
                .zip(["dot-1", "dot-2", "dot-3", "dot-4"].iter().cycle())
                .map(|(task, class)| (*class, format!("{} · {}", task.id, task.name)))
                .collect()
        })
        .unwrap_or_default();
    let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 1));
    let table = cohort.individuals.iter().map(|one| {
        vec![
            one.trainee.clone().into(),
            maybe(one.conformity),
            TableCell::Number(one.efficiency, 1),
            TableCell::Number(one.safety, 1),
            maybe(one.accuracy),
            TableCell::Number(one.overall, 1),
            TableCell::Clock(one.seconds),
        ]
    });
    let columns = vec!["trainee", "conformity", "efficiency", "safety", "accuracy", "overall", "flight time"];
    let table = Table { name: "individuals", caption: "first session of each trainee", columns, rows: table.collect() };
    html! {
        (table.shown())
        details.numbers { summary { "On-path share by trainee and task" }
            (figure("Share of time on the path", &html! { (legend(&key)) (shares(&rows, "On-path share by trainee and task")) }))
        }
    }
}

/// Renders crashes by kind, task and trainee.
pub fn crashes(cohort: &Cohort) -> Markup {
    let table = &cohort.crashes;
    let key: Vec<(&str, String)> = KINDS
        .iter()
        .zip(crash_counts(&table.by_kind))
        .map(|((class, name), count)| (*class, format!("{name}: {count}")))
        .collect();
    let names = table.tasks.iter().map(|id| format!("task {id}")).chain(["outside".to_owned()]);
    let by_task: Vec<CountRow> =
        names.zip(&table.by_task).map(|(name, count)| CountRow { name, kinds: vec![("k-bridge", *count)] }).collect();
    let all = CountRow { name: "all".into(), kinds: segments(&table.by_kind) };
    html! {
        p { (table.total) " crashes in the first sessions." }
        div.split {
            (figure("By object", &html! { (legend(&key)) (counts(&[all], "Crashes by kind")) }))
            (figure("By task", &counts(&by_task, "Crashes by task")))
        }
        @if lists_individuals(cohort) {
            details.numbers { summary { "By trainee" } (figure("Crashes by trainee", &counts(&counts_by_trainee(cohort), "Crashes by trainee"))) }
        } @else { (pooled::crashes(cohort)) }
    }
}

fn counts_by_trainee(cohort: &Cohort) -> Vec<CountRow> {
    cohort.crashes.rows.iter().map(|row| CountRow { name: row.trainee.clone(), kinds: vec![("k-bridge", row.total)] }).collect()
}
