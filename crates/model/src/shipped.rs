//! The scenarios and vehicles that ship with Spandrel, as text. New files in `scenarios/` or `vehicle-params/` are included
//! automatically.

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));
