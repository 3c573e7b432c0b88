//! The interface between a vehicle and the clients that score, display and control it: messages published in addition to standard
//! telemetry, and their interpretation. Version [`VERSION`]; specified in `docs/src/reference/contract.md`, so that third-party
//! vehicles can be scored.
//!
//! Both sides use the same code: the vehicle to encode, the monitor to decode.
//!
//! | module | contents |
//! |---|---|
//! | [`truth`] | ground truth: HIL_STATE_QUATERNION, its timestamps and units |
//! | [`named`] | NAMED_VALUE_INT and NAMED_VALUE_FLOAT: names, types, meaning |
//! | [`contact`] | contact codes and their order of severity |
//! | [`cue`] | bit flags of the monitor's cues in flight |
//! | [`modes`] | flight modes of PX4 and ArduCopter: name and control source |
//! | [`sticks`] | scaling of stick positions |
//! | [`continuity`] | detection of restarts and respawns between two samples |

pub mod contact;
pub mod continuity;
pub mod cue;
pub mod modes;
pub mod named;
pub mod sticks;
pub mod truth;

/// Contract version. Incremented for each change that an older vehicle or monitor would misinterpret.
pub const VERSION: u32 = 1;
