//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.

mod automatic;
mod bench;
mod consistency;
mod emergencies;
mod manoeuvres;
