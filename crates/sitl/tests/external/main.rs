//! The vehicle flown by an external autopilot: a small program that obeys the rules of PX4's simulator interface.
#![allow(clippy::unwrap_used, reason = "a test")]

mod fake_px4;
mod hostile;
mod relay;
mod rig;
mod starts;
