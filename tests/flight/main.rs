//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.

mod bench;
mod consistency;
mod manoeuvres;
