//! Physics against closed forms.

mod contact;
mod free_flight;
mod movers;
mod on_bridges;
