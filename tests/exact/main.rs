//! Tests whose authority is a closed form.

mod aircraft;
mod bridges;
mod contact;
mod free_flight;
mod score;
mod site;
