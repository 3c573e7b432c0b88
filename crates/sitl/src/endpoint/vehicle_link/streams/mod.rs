//! Builders for the autopilot's messages.

pub(crate) mod ardupilot;
pub(crate) mod attitude;
pub(crate) mod channels;
pub(crate) mod position;
pub(crate) mod sensors;
pub(crate) mod system;
