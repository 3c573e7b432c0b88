//! Clients that fly the vehicle: [`pilot`] is a synthetic trainee that relies on telemetry only; [`rc`] maps a
//! controller or keyboard to stick inputs through a calibrated profile.
//!
//! Both are ordinary MAVLink clients, like any ground station. They have no access to the simulator.
//!
//! ```
//! use spandrel_clients::rc::keyboard::KeyBindings;
//!
//! // Binding an unknown action is an error; the message gives its location.
//! let problems = KeyBindings::read("keys.toml", "[sticks]\nclimb = \"w\"\n").expect_err("no such action");
//! assert!(problems.to_string().contains("keys.toml"));
//! ```

pub mod pilot;
pub mod rc;
