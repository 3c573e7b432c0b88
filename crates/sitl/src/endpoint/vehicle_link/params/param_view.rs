//! Each flavor's view of the parameters: their names, and the encoding of their values.

use super::copter;
use super::param_value::ParamValue;
use super::row::Row;
use super::table;

/// A flavor's view of the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamView {
    /// The flavor's number in SPAN_FLAVOUR.
    pub number: i32,
    /// Whether values are cast to float; otherwise they are encoded bytewise.
    pub cast: bool,
    /// Whether PX4's checksum of all parameters precedes the list.
    pub hash: bool,
    /// Whether ArduPilot's packed file is available.
    pub packed: bool,
    /// Defaults that override the common ones.
    pub defaults: &'static [(&'static str, ParamValue)],
}

impl ParamView {
    /// Returns the rows shown to clients, sorted by name.
    #[must_use]
    pub(super) fn rows(&self) -> &'static [Row] {
        if self.cast { copter::rows() } else { table::rows() }
    }
}

/// PX4's names, encoded bytewise.
pub const PX4: ParamView = ParamView { number: 0, cast: false, hash: true, packed: false, defaults: &[] };
/// Copter's names, with values cast to float.
pub const COPTER: ParamView = ParamView { number: 1, cast: true, hash: false, packed: true, defaults: copter::DEFAULTS };
/// PX4's names, because there is no standard set.
pub const GENERIC: ParamView = ParamView { number: 2, hash: false, ..PX4 };
