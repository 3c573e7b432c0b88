//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.
#![allow(clippy::unwrap_used, reason = "a test")]

mod automatic;
mod emergencies;
mod heights;
mod maneuvers;
mod missions;
mod rules;
mod stuck;
