//! Campaigns: tests that repeat a flight for every aircraft with many seeds, faults or settings. They take most of the
//! time of all flight tests.
#![allow(clippy::unwrap_used, reason = "a test")]

mod consistency;
mod faulty_sensors;
mod winds;
mod yaw_release;
