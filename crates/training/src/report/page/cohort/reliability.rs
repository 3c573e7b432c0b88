//! Reliability of the measures: how well they distinguish trainees, and their error.

use super::super::within_error::measure_name;
use crate::cohort::{Cohort, MeasureReliability};
use crate::report::table::{Table, TableCell, shown};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Renders the table, with an explanation of its columns.
pub fn reliability(cohort: &Cohort, language: Language) -> Markup {
    let known = cohort.reliability.iter().any(|one| one.reliability.is_some());
    html! {
        (shown(language, |language| table(&cohort.reliability, language)))
        p.note {
            @if known { (text!(language, "cohort-reliability-known", repetitions = cohort.repetitions)) }
            @else { (text!(language, "cohort-reliability-unknown")) }
        }
    }
}

fn table(all: &[MeasureReliability], language: Language) -> Table {
    let maybe = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |one: &MeasureReliability| {
        let known = one.reliability;
        vec![
            measure_name(&one.measure, one.unit, language).into(),
            one.sessions.into(),
            maybe(one.at_ceiling.map(|share| 100.0 * share), 0),
            known.map_or(TableCell::Empty, |one| one.n.into()),
            maybe(known.map(|one| one.icc_2_1), 2),
            maybe(known.map(|one| one.icc_3_1), 2),
            maybe(known.map(|one| one.sem), 2),
            maybe(known.map(|one| one.minimal_detectable_change), 2),
        ]
    };
    let columns = vec![
        text!(language, "cohort-column-measure"),
        text!(language, "cohort-column-sessions"),
        text!(language, "cohort-column-ceiling"),
        text!(language, "cohort-column-trainees-repeating"),
        "ICC(2,1)".to_owned(),
        "ICC(3,1)".to_owned(),
        text!(language, "cohort-column-standard-error"),
        text!(language, "report-column-minimal-change"),
    ];
    let caption = text!(language, "cohort-reliability-caption");
    Table { name: "reliability", caption, columns, rows: all.iter().map(row).collect() }
}
