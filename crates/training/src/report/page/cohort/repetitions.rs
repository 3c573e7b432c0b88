//! Score changes between repetitions: box plots and statistical tests.

use super::super::figure::figure;
use super::super::within_error;
use crate::cohort::{Cohort, Comparison};
use crate::report::plots::boxes::{NamedBox, boxes};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Scores in display order, with their maximum.
const SCORES: [(&str, f64); 5] =
    [("conformity", 100.0), ("efficiency", 100.0), ("safety", 100.0), ("accuracy", 100.0), ("overall", 400.0)];

/// Renders box plots and tests, by repetition.
pub fn repetitions(cohort: &Cohort) -> Markup {
    html! {
        div.trio {
            @for (score, max_value) in SCORES {
                @let named: Vec<NamedBox<'_>> = cohort.boxes.iter().filter(|one| one.score == score).map(|one| NamedBox { name: one.repetition.to_string(), plot: &one.plot }).collect();
                @if !named.is_empty() { (figure(score, &boxes(&named, max_value, &format!("Box plots of {score} by repetition")))) }
            }
        }
        p.note { "Boxes show the quartiles and the median; crosses show the mean. Whiskers extend to the most extreme values within 1.5 interquartile ranges of the box." }
        @if !cohort.tests.is_empty() { (t_tests(&cohort.tests).shown()) }
        @if !cohort.homogeneity.is_empty() { (homogeneity(cohort).shown()) }
    }
}

fn t_tests(tests: &[Comparison]) -> Table {
    let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 3));
    let row = |one: &Comparison| {
        let (t, p) = (&one.test, one.test.p);
        vec![
            one.score.clone().into(),
            format!("{} vs. {}", one.earlier, one.later).into(),
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
            within_error::label(one.within_error),
            one.trainees_beyond_error.map_or(TableCell::Empty, TableCell::from),
        ]
    };
    let columns = vec![
        "score",
        "repetitions",
        "pairs",
        "change",
        "95% CI lower bound",
        "95% CI upper bound",
        "t",
        "p upper",
        "p lower",
        "p two-tailed",
        "p two-tailed, Holm",
        "d_z",
        "measurement error",
        "trainees beyond error",
    ];
    Table {
        name: "t_tests",
        caption: "paired t tests (later minus earlier repetition)",
        columns,
        rows: tests.iter().map(row).collect(),
    }
}

fn homogeneity(cohort: &Cohort) -> Table {
    let counted = |counts: &[usize]| counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" / ");
    let rows = cohort.homogeneity.iter().map(|one| {
        vec![
            one.score.clone().into(),
            counted(&one.group).into(),
            counted(&one.others).into(),
            TableCell::Number(one.test.chi_squared, 2),
            one.test.df.into(),
            TableCell::Number(one.test.p, 3),
        ]
    });
    Table {
        name: "homogeneity",
        caption: "first sessions: trainees with repetitions vs. all others (low / middle / high scores)",
        columns: vec!["score", "with repetitions", "others", "chi-squared", "df", "p"],
        rows: rows.collect(),
    }
}
