//! Messages of the autopilot.

pub(crate) mod ardupilot;
pub(crate) mod attitude;
pub(crate) mod channels;
pub(crate) mod position;
pub(crate) mod sensors;
pub(crate) mod system;
