//! Tests of the program as a separate process, and of its secondary renderer.
#![allow(clippy::unwrap_used, reason = "a test")]

mod briefing;
mod flights;
mod foreign_logs;
mod help;
mod noise;
mod program;
#[cfg(feature = "view")]
mod secondary_renderer;
