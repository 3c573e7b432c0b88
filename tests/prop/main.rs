//! Tests of properties that hold for any input.

mod files;
mod mistakes;
