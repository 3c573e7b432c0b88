//! Reliability of the measures: how well they distinguish trainees, and their error.

use super::super::within_error::measure_name;
use crate::cohort::{Cohort, MeasureReliability};
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};

/// Renders the table, with an explanation of its columns.
pub fn reliability(cohort: &Cohort) -> Markup {
    let known = cohort.reliability.iter().any(|one| one.reliability.is_some());
    html! {
        (table(&cohort.reliability).shown())
        @if known {
            p.note { "Estimated from the first " (cohort.repetitions) " sessions of each trainee who flew that often. ICC(2,1) measures agreement between sessions, and ICC(3,1) measures whether the order of the trainees stays the same. A change that is smaller than the minimal detectable change is within the error of the measure. For the mean of n trainees, this limit is smaller by the square root of n." }
        } @else {
            p.note { "The error of a measure can be estimated only if at least two trainees flew the job more than once." }
        }
    }
}

fn table(all: &[MeasureReliability]) -> Table {
    let maybe = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |one: &MeasureReliability| {
        let known = one.reliability;
        vec![
            measure_name(&one.measure, one.unit).into(),
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
        "measure",
        "sessions",
        "at the ceiling (%)",
        "trainees with repetitions",
        "ICC(2,1)",
        "ICC(3,1)",
        "standard error",
        "minimal detectable change",
    ];
    Table { name: "reliability", caption: "reliability of the measures", columns, rows: all.iter().map(row).collect() }
}
