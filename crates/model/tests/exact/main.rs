//! Tests of bridge geometry, terrain and site queries against closed-form and brute-force results.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod almanac;
mod beams;
mod box_girder;
mod bridges;
mod cable_stayed;
mod difficulty;
mod drones;
mod elements;
mod geometry;
mod girder;
mod ground;
mod imported;
mod masonry_arch;
mod mesh_shapes;
mod prestressed;
mod ropes;
mod site;
mod truss;
