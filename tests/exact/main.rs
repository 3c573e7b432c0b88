//! Tests whose authority is a closed form.

mod aircraft;
mod bridges;
mod contact;
mod export;
mod free_flight;
mod ground;
mod movers;
mod on_bridges;
mod score;
mod site;
