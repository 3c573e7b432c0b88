//! Tests of properties that hold for any input.

mod endpoint;
mod files;
mod mistakes;
