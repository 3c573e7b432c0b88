//! The program as a process of its own, and what it draws beside.

mod flights;
mod help;
mod noise;
mod program;
#[cfg(feature = "view")]
mod secondary_renderer;
