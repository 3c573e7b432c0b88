//! Parameters that are stored, validated and described but have no effect: parameters for hardware that this vehicle
//! does not have, and gains that depend on the airframe. The tables are in the `stored/` folder; a row in the code with
//! the same name takes precedence.

use super::row::Row;

/// The tables that the build script generates.
#[expect(clippy::approx_constant, reason = "the bounds are copied from the upstream tables")]
mod tables {
    use crate::endpoint::vehicle_link::params::param_value::ParamValue::{Int, Real};
    use crate::endpoint::vehicle_link::params::row::{Row, row};
    use crate::endpoint::vehicle_link::params::wire_types::{INT8, INT16, INT32, REAL32};

    include!(concat!(env!("OUT_DIR"), "/stored_params.rs"));
}
pub(super) use tables::{COPTER, PX4};

/// Adds the stored rows with names not yet present, sorted by name.
pub(super) fn fill_missing(mut rows: Vec<Row>, stored: &[Row]) -> Vec<Row> {
    // The sort is stable, so a row defined in code precedes a stored row of the same name.
    rows.extend(stored.iter().copied());
    rows.sort_by_key(|row| row.name);
    rows.dedup_by_key(|row| row.name);
    rows
}
