//! What Spandrel's own tests and benches share. Never part of what ships.
//!
//! | module | feature | what it is |
//! |---|---|---|
//! | [`shipped`] | | the shipped scenarios and vehicles by name |
//! | [`aircraft`] | | a quadrotor with round numbers, for closed forms |
//! | `station` | `vehicle` | a ground station on a vehicle in process |
//! | `plans` | `vehicle` | plans for the drill ground, and their upload |
//! | `bench` | `vehicle` | an autopilot and its aircraft in the air, without MAVLink |
//! | `job` | `telemetry` | a small job, and a tape of the datagrams that a flight over it sends |
//! | `inspection` | `telemetry` | a long inspection of the paper's job on such a tape |
//! | `studio` | `view` | a site ready to be drawn by software, and cameras in it |
#![allow(clippy::unwrap_used, reason = "a test")]
#![allow(missing_docs, reason = "test support")]

pub mod aircraft;
#[cfg(feature = "vehicle")]
pub mod bench;
#[cfg(feature = "telemetry")]
pub mod inspection;
#[cfg(feature = "telemetry")]
pub mod job;
#[cfg(feature = "vehicle")]
pub mod plans;
pub mod shipped;
#[cfg(feature = "vehicle")]
pub mod station;
#[cfg(feature = "view")]
pub mod studio;
