//! The program as a process of its own, and what it draws beside.
#![allow(clippy::unwrap_used, reason = "a test")]

mod flights;
mod help;
mod noise;
mod program;
#[cfg(feature = "view")]
mod secondary_renderer;
