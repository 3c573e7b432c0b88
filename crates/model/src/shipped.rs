//! Text of the scenario and vehicle files that ship with Spandrel. New files in `scenarios/` or `vehicle-params/` are included
//! automatically.

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// Text of `scenarios/README.md`, with the table of all keys.
pub const SCENARIO_README: &str = include_str!("../../../scenarios/README.md");
