//! Wing 1, the vehicle. Plain-data state, models as functions. The autopilot sees [`sensors`], never [`physics`].

pub mod autopilot;
pub mod backend;
pub mod endpoint;
pub mod faults;
pub mod log;
pub mod physics;
pub mod sensors;
pub mod sim;
