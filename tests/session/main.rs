//! Tests of vehicle and monitor together: the vehicle's telemetry, and the monitor's results.
#![allow(clippy::unwrap_used, reason = "a test")]

mod exported_plan;
mod zoom;
