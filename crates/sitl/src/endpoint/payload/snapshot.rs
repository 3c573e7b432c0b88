//! Snapshot of the equipment and its aircraft at one instant, used to build messages.

use super::camera::CameraSummary;
use super::equipment::Payload;
use super::gimbal::GimbalState;
use super::input::PayloadInput;
use super::lamp::LampState;
use crate::endpoint::clock::VehicleClock;
use crate::endpoint::link::LinkKind;
use spandrel_model::frames::{Frd, Ned, Rotation};
use spandrel_model::vehicle::Camera;

/// State of the equipment and its aircraft.
#[derive(Debug, Clone, Copy)]
pub struct PayloadSnapshot<'a> {
    /// The time on the clocks of the receiving link.
    pub clock: VehicleClock,
    /// Aircraft state.
    pub input: &'a PayloadInput<'a>,
    /// Gimbal state.
    pub gimbal: GimbalState,
    /// Lamp state.
    pub lamp: LampState,
    /// Camera state.
    pub camera: CameraSummary,
}

impl<'a> PayloadSnapshot<'a> {
    /// Creates a snapshot for ground stations.
    #[must_use]
    pub fn new(input: &'a PayloadInput<'a>, payload: &Payload) -> Self {
        let clock = input.clock;
        Self { clock, input, gimbal: payload.gimbal, lamp: payload.lamp, camera: payload.camera.summary(clock.now) }
    }

    /// Returns a copy for another kind of link.
    #[must_use]
    pub fn for_link(&self, kind: LinkKind) -> Self {
        Self { clock: self.clock.for_link(kind), ..*self }
    }

    /// Returns the camera at its current focal length.
    #[must_use]
    pub fn camera_now(&self) -> Camera {
        self.camera.lens(&self.input.vehicle.camera)
    }

    /// Returns the camera's attitude as a quaternion from body to north-east-down, w first. The gimbal stabilizes roll
    /// and follows the heading.
    #[must_use]
    pub fn camera_attitude(&self) -> [f64; 4] {
        let looking: Rotation<Frd, Ned> = Rotation::from_euler(0.0, self.gimbal.pitch_rad, self.input.heading_rad());
        looking.wxyz()
    }
}
