//! Labels for changes: within the error of the measure, or beyond it.

use crate::report::table::TableCell;

/// Returns a table cell with the label of a change; empty if the measure's error is unknown.
pub fn label(within_error: Option<bool>) -> TableCell {
    within_error.map_or(TableCell::Empty, |within| words(within).into())
}

/// Returns the label of a change.
#[must_use]
pub fn words(within_error: bool) -> &'static str {
    if within_error { "within error" } else { "beyond error" }
}

/// Returns a measure's name with its unit, as in "flight time (s)".
#[must_use]
pub fn measure_name(measure: &str, unit: &str) -> String {
    let name = measure.replace('_', " ");
    if unit.is_empty() { name } else { format!("{name} ({unit})") }
}
