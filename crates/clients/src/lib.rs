//! Who flies: [`pilot`] is the synthetic trainee, who sees what a person sees through telemetry and moves sticks; [`rc`] turns what a controller
//! or a keyboard gives into sticks, by a calibrated profile.
//!
//! Both are MAVLink clients like any ground station and know nothing of the simulator.
//!
//! ```
//! use spandrel_clients::rc::keyboard::Keys;
//!
//! // A file of keys that names an unknown action is refused with its place.
//! let problems = Keys::read("keys.toml", "[sticks]\nclimb = \"w\"\n").expect_err("no such action");
//! assert!(problems.to_string().contains("keys.toml"));
//! ```

pub mod pilot;
pub mod rc;
