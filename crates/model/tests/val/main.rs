//! What is shipped, and what the READMEs say of it.
#![allow(clippy::unwrap_used, reason = "a test")]

mod documented;
mod shipped;
