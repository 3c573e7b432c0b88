//! How each flavour shows the parameters: under which names, and how their values travel.

use super::table::{self, Row};
use super::{ParamValue, copter};

/// One flavour's view of the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamView {
    /// The flavour's number, in SPAN_FLAVOUR.
    pub number: i32,
    /// Values are cast to float as C does; otherwise their bytes travel.
    pub cast: bool,
    /// The list begins with PX4's checksum over all of them.
    pub hash: bool,
    /// They can be had as ArduPilot's packed file.
    pub packed: bool,
    /// Defaults that differ from the usual ones.
    pub defaults: &'static [(&'static str, ParamValue)],
}

impl ParamView {
    /// What clients see, in the order of the names.
    #[must_use]
    pub(super) fn rows(&self) -> &'static [Row] {
        if self.cast { copter::rows() } else { table::rows() }
    }
}

/// PX4's names, byte-wise.
pub const PX4: ParamView = ParamView { number: 0, cast: false, hash: true, packed: false, defaults: &[] };
/// Copter's names, cast.
pub const COPTER: ParamView = ParamView { number: 1, cast: true, hash: false, packed: true, defaults: copter::DEFAULTS };
/// The same names as PX4's, for there are no standard ones.
pub const GENERIC: ParamView = ParamView { number: 2, hash: false, ..PX4 };
