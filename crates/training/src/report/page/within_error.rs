//! Labels for changes: within the error of the measure, or beyond it.

use crate::report::table::TableCell;
use crate::terms::{error_label, measure_title};
use spandrel_text::{Language, text};

/// Returns a table cell with the label of a change; empty if the measure's error is unknown.
pub fn label(within_error: Option<bool>, language: Language) -> TableCell {
    within_error.map_or(TableCell::Empty, |within| error_label(within, language).into())
}

/// Returns a measure's name with its unit, as in "flight time (s)".
#[must_use]
pub fn measure_name(measure: &str, unit: &str, language: Language) -> String {
    let measure = measure_title(measure, language);
    let unit = if unit == "points" { text!(language, "report-unit-points") } else { unit.to_owned() };
    if unit.is_empty() { measure } else { text!(language, "report-measure-with-unit", measure = measure, unit = unit) }
}
