//! The `spandrel` program as a library, for its tests and benchmarks. No other package uses sockets, files, clocks,
//! threads or processes. Results go to standard output, everything else to standard error.

mod cli;
mod errors;
mod io;
mod records;
mod web;
#[cfg(feature = "view")]
mod window;

pub use cli::{Cli, main};
pub use errors::AppError;
#[cfg(feature = "view")]
pub use window::secondary_renderer;
