//! The equipment: camera, gimbal and lamp, the changes that they report, and the request for a walk of the inspector.

use super::camera::CameraState;
use super::changes::PayloadChange;
use super::gimbal::GimbalState;
use super::lamp::LampState;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;

/// State of the payload, owned by the endpoint and read by the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Payload {
    /// Camera state.
    pub camera: CameraState,
    /// Gimbal state.
    pub gimbal: GimbalState,
    /// Lamp state.
    pub lamp: LampState,
    /// Changes to report.
    pub changes: PayloadChange,
    /// Number of the place to which a client has sent the inspector.
    walk_request: Option<u8>,
}

impl Payload {
    /// Creates the payload with the camera in photo mode, the gimbal level and the lamp off.
    #[must_use]
    pub fn new() -> Self {
        Self {
            camera: CameraState::default(),
            gimbal: GimbalState::new(),
            lamp: LampState::OFF,
            changes: PayloadChange::default(),
            walk_request: None,
        }
    }

    /// Sends the inspector to a place with the next tick.
    pub fn request_walk(&mut self, place: u8) {
        self.walk_request = Some(place);
    }

    /// Removes and returns the number of the place to which a client has sent the inspector.
    pub fn take_walk_request(&mut self) -> Option<u8> {
        self.walk_request.take()
    }

    /// Advances the gimbal, camera and lamp by `dt_s` seconds.
    pub fn step(&mut self, camera: &Camera, position_m: Vec3<Enu>, now: SimTime, dt_s: f64) {
        self.gimbal.step(camera, position_m, dt_s);
        self.camera.step(now, dt_s, &mut self.changes);
        self.lamp.step(now, &mut self.changes);
    }
}

impl Default for Payload {
    fn default() -> Self {
        Self::new()
    }
}
