//! Rows that show another parameter's value in their own unit or numbering.

use super::param_value::ParamValue::{Int, Real};
use super::row::{ParamSource, Row, row};
use super::table::{self, ROWS};
use super::wire_types::{INT8, REAL32};
use spandrel_mavlink::dialect::MavParamType;

/// Returns the row with PX4's name.
pub(super) fn px4_row(name: &str) -> &'static Row {
    // All names used below are in the table; a test checks this.
    table::rows().iter().find(|row| row.name == name).unwrap_or(&ROWS[0])
}

/// Creates a row that shows another parameter multiplied by a factor.
pub(super) fn scaled(
    name: &'static str,
    other: &'static str,
    factor: f64,
    wire: MavParamType,
    unit: &'static str,
    group: &'static str,
) -> Row {
    let behind = px4_row(other);
    let default = if wire == REAL32 { Real(0.0) } else { Int(0) };
    let range = (behind.low * factor, behind.high * factor);
    let mut out = row(name, default.with_number(behind.default.number() * factor), range, unit, group, behind.short);
    (out.wire, out.source, out.read_only) = (wire, ParamSource::Scaled(other, factor), behind.read_only);
    out
}

/// Creates a row with its own numbering of another parameter's values.
pub(super) fn mapped(
    name: &'static str,
    other: &'static str,
    pairs: &'static [(i32, i32)],
    values: &'static [(i32, &'static str)],
    group: &'static str,
) -> Row {
    let (low, high) = (pairs[0].0, pairs[pairs.len() - 1].0);
    let behind = px4_row(other);
    let default = pairs.iter().find(|(_, theirs)| Int(*theirs) == behind.default).map_or(low, |(own, _)| *own);
    let mut out = row(name, Int(default), (f64::from(low), f64::from(high)), "", group, behind.short).values(values);
    (out.wire, out.source) = (INT8, ParamSource::Mapped(other, pairs));
    out
}
