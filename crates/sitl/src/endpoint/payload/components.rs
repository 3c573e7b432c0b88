//! Component IDs with which the equipment and the scoring feed appear.

use super::gimbal::BUILTIN_GIMBAL_DEVICE_ID;
use crate::endpoint::component_ids::{AUTOPILOT, GIMBAL, LAMP, SIMULATOR};

/// Component IDs of the equipment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PayloadComponents {
    /// Component that owns the gimbal.
    pub gimbal: u8,
    /// Component that owns the lamp.
    pub lamp: u8,
    /// Component that sends the ground truth and the scoring data.
    pub scoring: u8,
}

impl PayloadComponents {
    /// Equipment of the built-in autopilot, whose component owns everything but the camera.
    pub const BUILTIN: Self = Self { gimbal: AUTOPILOT, lamp: AUTOPILOT, scoring: AUTOPILOT };
    /// Equipment beside an external autopilot: each device is a component of its own.
    pub const SEPARATE: Self = Self { gimbal: GIMBAL, lamp: LAMP, scoring: SIMULATOR };

    /// Returns the device ID in the gimbal's own messages: 0 if the gimbal is a MAVLink component itself.
    #[must_use]
    pub fn own_gimbal_id(self) -> u8 {
        if self.gimbal == AUTOPILOT { BUILTIN_GIMBAL_DEVICE_ID } else { 0 }
    }

    /// Returns the device ID under which other components refer to the gimbal.
    #[must_use]
    pub fn gimbal_id(self) -> u8 {
        if self.gimbal == AUTOPILOT { BUILTIN_GIMBAL_DEVICE_ID } else { self.gimbal }
    }
}
