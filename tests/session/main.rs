//! Both wings on one flight: what the vehicle sends and what the monitor makes of it.
#![allow(clippy::unwrap_used, reason = "a test")]

mod exported_plan;
mod zoom;
