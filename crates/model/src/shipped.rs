//! Text of the scenario and vehicle files that ship with Spandrel. New files in `scenarios/` or `vehicle-params/` are included
//! automatically.

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));
