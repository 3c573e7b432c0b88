//! Physics against closed forms.
#![allow(clippy::unwrap_used, reason = "a test")]

mod contact;
mod free_flight;
mod movers;
mod on_bridges;
