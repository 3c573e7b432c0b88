//! The program as a process of its own, and what it draws beside.

#[cfg(feature = "view")]
mod aside;
mod flights;
mod help;
mod noise;
mod program;
