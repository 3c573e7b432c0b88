//! Closed-loop flights: physics, sensors, estimator and autopilot together, without a network.
#![allow(clippy::unwrap_used, reason = "a test")]

mod automatic;
mod concave;
mod emergencies;
mod feel;
mod heights;
mod imperfect;
mod maneuvers;
mod missions;
mod radio_shadow;
mod real_sky;
mod rules;
mod scatter;
mod stuck;
mod wind_hold;
