//! How each flavour shows the parameters: under which names, and how their values travel.

use super::table::{self, Row};
use super::{Value, copter};

/// One flavour's view of the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// The flavour's number, in SPAN_FLAVOUR.
    pub number: i32,
    /// Values are cast to float as C does; otherwise their bytes travel.
    pub cast: bool,
    /// The list begins with PX4's checksum over all of them.
    pub hash: bool,
    /// They can be had as ArduPilot's packed file.
    pub packed: bool,
    /// Defaults that differ from the usual ones.
    pub defaults: &'static [(&'static str, Value)],
}

impl Face {
    /// What clients see, in the order of the names.
    #[must_use]
    pub(super) fn rows(&self) -> &'static [Row] {
        if self.cast { copter::rows() } else { table::rows() }
    }
}

/// PX4's names, byte-wise.
pub const PX4: Face = Face { number: 0, cast: false, hash: true, packed: false, defaults: &[] };
/// Copter's names, cast.
pub const COPTER: Face = Face { number: 1, cast: true, hash: false, packed: true, defaults: copter::DEFAULTS };
/// The same names as PX4's, for there are no standard ones.
pub const GENERIC: Face = Face { number: 2, hash: false, ..PX4 };
