//! Score changes between repetitions: box plots and statistical tests.

use super::super::figure::figure;
use super::super::within_error;
use crate::cohort::{Cohort, Comparison};
use crate::report::plots::boxes::{NamedBox, boxes};
use crate::report::table::{Table, TableCell, shown};
use crate::terms::score_title;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Scores in display order, with their maximum.
const SCORES: [(&str, f64); 5] =
    [("conformity", 100.0), ("efficiency", 100.0), ("safety", 100.0), ("accuracy", 100.0), ("overall", 400.0)];

/// Renders box plots and tests, by repetition.
pub fn repetitions(cohort: &Cohort, language: Language) -> Markup {
    html! {
        div.trio {
            @for (score, max_value) in SCORES {
                @let named: Vec<NamedBox<'_>> = cohort.boxes.iter().filter(|one| one.score == score).map(|one| NamedBox { name: one.repetition.to_string(), plot: &one.plot }).collect();
                @let score = score_title(score, language);
                @let title = text!(language, "cohort-boxes", score = score.as_str());
                @if !named.is_empty() { (figure(&score, &boxes(&named, max_value, &title, language))) }
            }
        }
        p.note { (text!(language, "cohort-boxes-note")) }
        @if !cohort.tests.is_empty() { (shown(language, |language| t_tests(&cohort.tests, language))) }
        @if !cohort.homogeneity.is_empty() { (shown(language, |language| homogeneity(cohort, language))) }
    }
}

fn t_tests(tests: &[Comparison], language: Language) -> Table {
    let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 3));
    let row = |one: &Comparison| {
        let (t, p) = (&one.test, one.test.p);
        vec![
            score_title(&one.score, language).into(),
            text!(language, "cohort-versus", earlier = one.earlier, later = one.later).into(),
            t.n.into(),
            TableCell::Number(t.mean_difference, 2),
            TableCell::Number(t.interval_95[0], 2),
            TableCell::Number(t.interval_95[1], 2),
            maybe(t.t),
            maybe(p.map(|p| p.upper)),
            maybe(p.map(|p| p.lower)),
            maybe(p.map(|p| p.two)),
            maybe(one.p_holm.map(|p| p.two)),
            maybe(t.effect_size_dz),
            within_error::label(one.within_error, language),
            one.trainees_beyond_error.map_or(TableCell::Empty, TableCell::from),
        ]
    };
    let columns = vec![
        text!(language, "report-column-score"),
        text!(language, "report-column-repetitions"),
        text!(language, "cohort-column-pairs"),
        text!(language, "report-column-change"),
        text!(language, "cohort-column-ci-lower"),
        text!(language, "cohort-column-ci-upper"),
        "t".to_owned(),
        text!(language, "cohort-column-p-upper"),
        text!(language, "cohort-column-p-lower"),
        text!(language, "cohort-column-p-two"),
        text!(language, "cohort-column-p-holm"),
        "d_z".to_owned(),
        text!(language, "report-column-measurement-error"),
        text!(language, "cohort-column-beyond-error"),
    ];
    Table { name: "t_tests", caption: text!(language, "cohort-tests-caption"), columns, rows: tests.iter().map(row).collect() }
}

fn homogeneity(cohort: &Cohort, language: Language) -> Table {
    let counted = |counts: &[usize]| counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" / ");
    let rows = cohort.homogeneity.iter().map(|one| {
        vec![
            score_title(&one.score, language).into(),
            counted(&one.group).into(),
            counted(&one.others).into(),
            TableCell::Number(one.test.chi_squared, 2),
            one.test.df.into(),
            TableCell::Number(one.test.p, 3),
        ]
    });
    Table {
        name: "homogeneity",
        caption: text!(language, "cohort-homogeneity-caption"),
        columns: vec![
            text!(language, "report-column-score"),
            text!(language, "cohort-column-with-repetitions"),
            text!(language, "cohort-column-others"),
            text!(language, "cohort-column-chi-squared"),
            "df".to_owned(),
            "p".to_owned(),
        ],
        rows: rows.collect(),
    }
}
