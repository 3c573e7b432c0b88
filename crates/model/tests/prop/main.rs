//! Property tests of scenario and vehicle files: all problems are reported.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod causes;
mod error_messages;
mod imported_clouds;
mod imported_models;
mod mutated_files;
