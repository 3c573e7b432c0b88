//! The common language, sans-IO: framing and codec, unit doors, router, signing. Knows base only.

pub mod ardupilotmega;
pub mod codec;
pub mod ftp;
pub mod note;
pub mod router;
pub mod signing;
pub mod station;
pub mod units;

pub use mavlink::dialects::common as dialect;
