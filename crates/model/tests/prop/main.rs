//! Properties of files: whatever is wrong in one is named.
#![allow(clippy::unwrap_used, reason = "a test")]

mod files;
mod mistakes;
