//! Scores of the first sessions: distributions, trainees and tasks, crashes.

use super::super::crash_kinds::{crash_counts, kinds, segments};
use super::super::figure::{figure, legend};
use super::lists_individuals::lists_individuals;
use super::pooled;
use crate::cohort::Cohort;
use crate::record::SessionOutcome;
use crate::report::plots::bars::{CountRow, ShareRow, counts, shares};
use crate::report::plots::histogram::histogram;
use crate::report::table::{Table, TableCell, shown};
use crate::terms::{score_title, task_title};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders the score distributions.
pub fn distributions(cohort: &Cohort, language: Language) -> Markup {
    html! {
        div.trio {
            @for one in &cohort.distributions {
                @let score = score_title(&one.score, language);
                @let title = text!(language, "cohort-histogram", score = score.as_str());
                (figure(&score, &histogram(&one.histogram, one.summary.mean, &title, language)))
            }
        }
        (shown(language, |language| distribution_table(cohort, language)))
    }
}

fn distribution_table(cohort: &Cohort, language: Language) -> Table {
    let rows = cohort.distributions.iter().map(|one| {
        let s = &one.summary;
        let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 2));
        let numbers = [s.min, s.q1, s.median, s.q3, s.max].map(|value| TableCell::Number(value, 1));
        let score = score_title(&one.score, language);
        let mut row = vec![score.into(), s.n.into(), TableCell::Number(s.mean, 2), maybe(s.sd)];
        row.extend(numbers);
        row.push(maybe(s.skewness));
        row
    });
    let columns = vec![
        text!(language, "report-column-score"),
        "n".to_owned(),
        text!(language, "cohort-column-mean"),
        text!(language, "cohort-column-sd"),
        text!(language, "cohort-column-min"),
        "q1".to_owned(),
        text!(language, "cohort-column-median"),
        "q3".to_owned(),
        text!(language, "cohort-column-max"),
        text!(language, "cohort-column-skewness"),
    ];
    Table { name: "distributions", caption: text!(language, "cohort-first-caption"), columns, rows: rows.collect() }
}

/// Renders each trainee's scores and tasks, or distributions if there are too many trainees to list.
pub fn people(cohort: &Cohort, language: Language) -> Markup {
    if lists_individuals(cohort) { individual_results(cohort, language) } else { pooled::tasks(cohort, language) }
}

fn individual_results(cohort: &Cohort, language: Language) -> Markup {
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
            placeholder: one.tasks.is_empty().then(|| text!(language, "cohort-no-tasks")),
        })
        .collect();
    let job = cohort.scenarios.first().map_or("", String::as_str);
    let key: Vec<(&str, String)> = cohort
        .individuals
        .first()
        .map(|one| {
            one.tasks
                .iter()
                .zip(["dot-1", "dot-2", "dot-3", "dot-4"].iter().cycle())
                .map(|(task, class)| (*class, format!("{} · {}", task.id, task_title(job, &task.name, language))))
                .collect()
        })
        .unwrap_or_default();
    let title = text!(language, "cohort-shares");
    html! {
        (shown(language, |language| individual_table(cohort, language)))
        details.numbers { summary { (title) }
            (figure(&text!(language, "cohort-shares-figure"), &html! { (legend(&key)) (shares(&rows, &title)) }))
        }
    }
}

fn individual_table(cohort: &Cohort, language: Language) -> Table {
    let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 1));
    let rows = cohort.individuals.iter().map(|one| {
        vec![
            one.trainee.clone().into(),
            maybe(one.conformity),
            TableCell::Number(one.efficiency, 1),
            TableCell::Number(one.safety, 1),
            maybe(one.accuracy),
            TableCell::Number(one.overall, 1),
            TableCell::Clock(one.seconds),
            one.completion_summary(language).into(),
            one.verdict(language).into(),
        ]
    });
    let mut columns = vec![text!(language, "cohort-column-trainee")];
    columns.extend(["conformity", "efficiency", "safety", "accuracy", "overall"].map(|score| score_title(score, language)));
    columns.push(text!(language, "report-column-flight-time"));
    columns.push(text!(language, "cohort-column-completion"));
    columns.push(text!(language, "cohort-column-certification"));
    Table { name: "individuals", caption: text!(language, "cohort-individuals-caption"), columns, rows: rows.collect() }
}

/// Renders crashes by kind, task and trainee.
pub fn crashes(cohort: &Cohort, language: Language) -> Markup {
    let table = &cohort.crashes;
    let key: Vec<(&str, String)> = kinds(language)
        .into_iter()
        .zip(crash_counts(&table.by_kind))
        .map(|((class, name), count)| (class, format!("{name}: {count}")))
        .collect();
    let outside = text!(language, "cohort-crashes-outside");
    let names = table.tasks.iter().map(|id| text!(language, "report-task", task = *id)).chain([outside]);
    let by_task: Vec<CountRow> =
        names.zip(&table.by_task).map(|(name, count)| CountRow { name, kinds: vec![("k-bridge", *count)] }).collect();
    let all = CountRow { name: text!(language, "cohort-crashes-all"), kinds: segments(&table.by_kind) };
    let by_trainee = text!(language, "cohort-crashes-by-trainee-title");
    html! {
        p { (text!(language, "cohort-crashes-count", count = table.total)) }
        div.split {
            (figure(&text!(language, "cohort-crashes-by-object"), &html! { (legend(&key)) (counts(&[all], &text!(language, "cohort-crashes-by-kind-title"))) }))
            (figure(&text!(language, "cohort-crashes-by-task"), &counts(&by_task, &text!(language, "cohort-crashes-by-task-title"))))
        }
        @if lists_individuals(cohort) {
            details.numbers { summary { (text!(language, "cohort-crashes-by-trainee")) } (figure(&by_trainee, &counts(&counts_by_trainee(cohort), &by_trainee))) }
        } @else { (pooled::crashes(cohort, language)) }
    }
}

fn counts_by_trainee(cohort: &Cohort) -> Vec<CountRow> {
    cohort.crashes.rows.iter().map(|row| CountRow { name: row.trainee.clone(), kinds: vec![("k-bridge", row.total)] }).collect()
}
