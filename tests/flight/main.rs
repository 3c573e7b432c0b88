//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.

mod automatic;
mod bench;
mod consistency;
mod emergencies;
mod heights;
mod manoeuvres;
mod missions;
mod rules;
#[path = "../wire/station.rs"]
#[expect(dead_code, reason = "only commands and texts are used here")]
mod station;
mod stuck;
mod winds;
