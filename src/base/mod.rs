//! What every room stands on and what knows nobody: integer time, dates, typed frames, geodesy, named random streams, and the one
//! door to transcendental functions.

pub mod calendar;
pub mod foxglove;
pub mod frames;
pub mod geodesy;
pub mod math;
pub mod numbers;
pub mod random;
pub mod time;
pub mod toml;
