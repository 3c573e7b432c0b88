//! The contract between a vehicle and those who score, show and fly it: what is published beside standard telemetry, and how it is read.
//! Version [`VERSION`]; the same in words stands in `docs/src/reference/contract.md`, so that somebody else's vehicle can be scored.
//!
//! Everything here is used by both sides: the vehicle encodes with what the monitor decodes with.
//!
//! | module | what it fixes |
//! |---|---|
//! | [`truth`] | the truth feed: HIL_STATE_QUATERNION, its clock and its units |
//! | [`named`] | NAMED_VALUE_INT and NAMED_VALUE_FLOAT: names, types, meaning |
//! | [`contact`] | codes of what the aircraft touches, and which of several counts |
//! | [`cue`] | bits of the feedback that the monitor gives in flight |
//! | [`modes`] | flight modes of PX4 and ArduCopter: names, and what controls the aircraft in them |
//! | [`sticks`] | scaling of stick positions |
//! | [`continuity`] | when two samples do not belong to one flight: a jump in time or in place |

pub mod contact;
pub mod continuity;
pub mod cue;
pub mod modes;
pub mod named;
pub mod sticks;
pub mod truth;

/// Grows with every change that a vehicle or a monitor of an older version would read wrongly.
pub const VERSION: u32 = 1;
