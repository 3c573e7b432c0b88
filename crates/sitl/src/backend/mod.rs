//! External autopilots: PX4 and ArduPilot as processes of their own, connected through their simulator interfaces. They replace the
//! built-in autopilot; physics, sensors, equipment and scoring stay the same.

pub mod ardupilot;
mod external;
pub mod interface;
pub mod launch;
pub mod px4;

pub use external::{ExternalAutopilot, Phase};
