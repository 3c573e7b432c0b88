//! Physics compared with closed-form solutions.
#![allow(clippy::unwrap_used, reason = "a test")]

mod contact;
mod drones;
mod free_flight;
mod movers;
mod on_bridges;
mod pair_contact;
mod ropes;
mod rotor_flow;
mod walls;
