//! Flight controller backends. The built-in autopilot is the only one so far; PX4 and ArduPilot could be added through
//! their simulator interfaces.

pub mod ardupilot;
pub mod interface;
pub mod launch;
pub mod px4;

use crate::autopilot::Autopilot;
use crate::physics::Actuators;
use crate::sensors::Readings;
use spandrel_model::time::SimTime;

/// The flight controller. In each tick, it runs after the sensors and before the physics.
#[derive(Debug, Clone)]
pub enum Backend {
    /// The built-in autopilot.
    Builtin(Box<Autopilot>),
}

impl Backend {
    /// Runs one control step.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        match self {
            Self::Builtin(autopilot) => autopilot.step(readings, now),
        }
    }

    /// Returns the built-in autopilot if it is the active backend.
    #[must_use]
    pub fn builtin(&self) -> Option<&Autopilot> {
        match self {
            Self::Builtin(autopilot) => Some(autopilot),
        }
    }

    /// Returns the built-in autopilot, to send commands to it, if it is the active backend.
    pub fn builtin_mut(&mut self) -> Option<&mut Autopilot> {
        match self {
            Self::Builtin(autopilot) => Some(autopilot),
        }
    }
}
