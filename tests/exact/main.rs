//! Tests whose authority is a closed form.

mod aircraft;
mod contact;
mod free_flight;
mod score;
