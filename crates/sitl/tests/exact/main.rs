//! Physics compared with closed-form solutions.
#![allow(clippy::unwrap_used, reason = "a test")]

mod contact;
mod free_flight;
mod movers;
mod on_bridges;
mod rotor_flow;
mod walls;
