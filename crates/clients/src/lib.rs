//! Clients that fly the vehicle. [`pilot`] is a synthetic trainee that works from telemetry and moves the sticks; [`rc`] maps a controller or a
//! keyboard to sticks through a calibrated profile.
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
