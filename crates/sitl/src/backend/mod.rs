//! Who flies: the built-in autopilot now; PX4 and ArduPilot over their simulator interfaces later.

use crate::autopilot::Autopilot;
use crate::physics::Actuators;
use crate::sensors::Readings;
use spandrel_model::time::SimTime;

/// The flight controller behind the vehicle: what a tick calls between sensors and physics.
#[derive(Debug, Clone)]
pub enum Backend {
    /// The built-in autopilot.
    Builtin(Box<Autopilot>),
}

impl Backend {
    /// One control step.
    pub fn step(&mut self, readings: &Readings, now: SimTime) -> Actuators {
        match self {
            Self::Builtin(autopilot) => autopilot.step(readings, now),
        }
    }

    /// The built-in autopilot, when it flies.
    #[must_use]
    pub fn builtin(&self) -> Option<&Autopilot> {
        match self {
            Self::Builtin(autopilot) => Some(autopilot),
        }
    }

    /// The built-in autopilot to command, when it flies.
    pub fn builtin_mut(&mut self) -> Option<&mut Autopilot> {
        match self {
            Self::Builtin(autopilot) => Some(autopilot),
        }
    }
}
