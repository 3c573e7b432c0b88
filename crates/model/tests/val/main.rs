//! Tests of the shipped scenario and vehicle files and their documentation.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod documentation;
mod forms;
mod levels;
mod shipped_files;
