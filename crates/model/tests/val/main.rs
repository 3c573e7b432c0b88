//! Tests of the shipped scenario and vehicle files and their documentation, and of the standard atmosphere.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod air;
mod documentation;
mod forms;
mod levels;
mod shipped_files;
mod site_data;
