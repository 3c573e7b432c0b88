//! Geometry against closed forms.
#![allow(clippy::unwrap_used, reason = "a test")]

mod bridges;
mod elements;
mod geometry;
mod ground;
mod site;
