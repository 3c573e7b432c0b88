//! Code shared by Spandrel's tests and benchmarks. It is not part of the product.
//!
//! | module | feature | contents |
//! |---|---|---|
//! | [`shipped`] | | the shipped scenarios and vehicles by name |
//! | [`aircraft`] | | a quadrotor with round numbers, for closed-form tests |
//! | `station` | `vehicle` | a ground station for an in-process vehicle |
//! | `plans` | `vehicle` | plans for the drill site, and their upload |
//! | `bench` | `vehicle` | an autopilot and its aircraft in flight, without MAVLink |
//! | `estimator_run` | `vehicle` | the estimator and its sensors on a given motion, without physics or autopilot |
//! | `job` | `telemetry` | a small job, and a recorder of the datagrams of a flight |
//! | `inspection` | `telemetry` | a long recorded inspection of the TASBID job |
//! | `studio` | `view` | a site prepared for software rendering, and cameras in it |
#![allow(clippy::unwrap_used, reason = "a test")]
#![allow(missing_docs, reason = "test support")]

pub mod aircraft;
#[cfg(feature = "vehicle")]
pub mod bench;
#[cfg(feature = "vehicle")]
pub mod estimator_run;
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
