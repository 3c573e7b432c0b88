//! The built-in autopilot: estimator, navigator, failsafes and control. Its inputs are sensor readings, sticks and requests, never
//! the true state.
//!
//! The four modules do not call each other. [`Autopilot`] passes inputs, requests and events between them.

mod control;
mod core;
pub mod estimator;
mod events;
mod external_input;
mod failsafe;
mod flight_state;
mod navigator;
mod request;
mod status;
#[cfg(test)]
pub(crate) mod testing;
mod tuning;

pub use self::core::{Autopilot, CONTROL_HZ};
pub use self::estimator::Pose;
pub use self::estimator::estimate::Estimate;
pub use self::events::{AutopilotEvent, Severity};
pub use self::external_input::{OffboardSetpoint, Sticks};
pub use self::failsafe::operator_rules::{FenceAction, OperatorRules};
pub use self::failsafe::{fence, operator_rules, sensor_health};
pub use self::flight_state::{FlightMode, LandedState};
pub use self::navigator::mission_step::{MissionStep, TimeOfDay};
pub use self::navigator::{follow, home, mission, orbit, trajectory};
pub use self::request::{AutopilotRequest, RequestOutcome, TurnCommand};
pub use self::status::AutopilotStatus;
pub use self::tuning::{LinkLossAction, Tuning};
