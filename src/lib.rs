//! Spandrel: the open trainer for bridge inspectors who work with a drone.
//!
//! Two wings that never import each other meet in shared things only: the MAVLink wire, the scenario and vehicle files, and the
//! site built from them. [`sitl`] is the vehicle; [`monitor`] watches and scores. ARCHITECTURE.md is the map.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod app;
pub mod base;
pub mod mav;
pub mod monitor;
pub mod pilot;
pub mod rc;
pub mod report;
pub mod scenario;
pub mod site;
pub mod sitl;
pub mod telemetry;
pub mod training;
pub mod vehicle;
pub mod view;
pub mod web;
