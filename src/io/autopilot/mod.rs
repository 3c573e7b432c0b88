//! External autopilots: finding the program, running and watching its process, and recording which one flew.

pub mod config;
pub mod find;
pub mod flight_controller;
pub mod host;
mod process;
mod record;
pub mod setup;
