//! Parameters that are stored, checked and described, and act on nothing: hardware that this vehicle does not have, and gains that follow from the
//! airframe. The tables are the files in `stored/`; a row of the code with the same name replaces theirs.

use super::ParamValue::{Int, Real};
use super::table::{Row, row};
use spandrel_mavlink::dialect::MavParamType;

const INT8: MavParamType = MavParamType::MAV_PARAM_TYPE_INT8;
const INT16: MavParamType = MavParamType::MAV_PARAM_TYPE_INT16;
const INT32: MavParamType = MavParamType::MAV_PARAM_TYPE_INT32;
const REAL32: MavParamType = MavParamType::MAV_PARAM_TYPE_REAL32;

/// The tables as the build reads them.
#[expect(clippy::approx_constant, reason = "bounds are the upstream tables' own numbers")]
mod tables {
    use super::{INT8, INT16, INT32, Int, REAL32, Real, Row, row};

    include!(concat!(env!("OUT_DIR"), "/stored_params.rs"));
}
pub(super) use tables::{COPTER, PX4};

/// Adds the stored rows whose names are not there yet, in the order of the names.
pub(super) fn fill_missing(mut rows: Vec<Row>, stored: &[Row]) -> Vec<Row> {
    // A stable sort keeps the acting row before the stored one of the same name.
    rows.extend(stored.iter().copied());
    rows.sort_by_key(|row| row.name);
    rows.dedup_by_key(|row| row.name);
    rows
}
