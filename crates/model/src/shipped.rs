//! The scenarios and vehicles that ship with Spandrel, as text. A new file in `scenarios/` or `vehicle-params/` is found by itself.

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));
