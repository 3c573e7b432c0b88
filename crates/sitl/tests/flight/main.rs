//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.

mod automatic;
mod consistency;
mod emergencies;
mod heights;
mod maneuvers;
mod missions;
mod rules;
mod stuck;
mod winds;
