//! The interface between a vehicle and the clients that score, display and control it. It adds messages to standard
//! telemetry and defines their meaning. Its version is [`VERSION`]. `docs/src/reference/contract.md` specifies it, so
//! that vehicles from other vendors can be scored.
//!
//! Both sides use this module: the vehicle encodes, and the monitor decodes.
//!
//! | module | contents |
//! |---|---|
//! | [`truth`] | ground truth: HIL_STATE_QUATERNION, its timestamps and units |
//! | [`named_values`] | NAMED_VALUE_INT and NAMED_VALUE_FLOAT: names, types and meanings |
//! | [`contact`] | contact codes and their order of severity |
//! | [`cue`] | bit flags of the monitor's cues |
//! | [`guidance`] | the next step of the job and the way to it |
//! | [`hazards`] | disturbance of compass and radio at the aircraft |
//! | [`other_drones`] | other vehicles of the simulator at the same site |
//! | [`radio_status`] | RADIO_STATUS in the scale of SiK radios |
//! | [`practice`] | requests that are allowed in practice only: freeze, resume, rewind |
//! | [`walk`] | request that the inspector walks to another place |
//! | [`modes`] | flight modes of PX4 and ArduCopter: name and control source |
//! | [`sticks`] | conversion of stick positions |
//! | [`stick_request`] | request to change the response to the sticks |
//! | [`continuity`] | detection of restarts and respawns |

pub mod contact;
pub mod continuity;
pub mod cue;
mod float_array;
pub mod guidance;
pub mod hazards;
pub mod lesson;
pub mod modes;
pub mod named_values;
pub mod other_drones;
pub mod practice;
pub mod radio_status;
pub mod stick_request;
pub mod sticks;
pub mod truth;
pub mod walk;

/// Component ID of the simulator beside an external autopilot, which then sends what the built-in autopilot sends otherwise.
pub const SIMULATOR_COMPONENT: u8 = 192;

/// Interface version, incremented with every change that an older vehicle or monitor would misinterpret.
pub const VERSION: u32 = 1;
