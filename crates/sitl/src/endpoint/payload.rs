//! Camera, gimbal and lamp together, and what they have to tell.

use super::camera::CameraState;
use super::gimbal::GimbalState;
use super::lamp::LampState;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use std::collections::BTreeSet;

/// What the payload does: it belongs to the endpoint, the simulation reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct Payload {
    /// Camera.
    pub camera: CameraState,
    /// Gimbal.
    pub gimbal: GimbalState,
    /// Lamp.
    pub lamp: LampState,
    /// What is to be told.
    pub changes: PayloadChange,
}

impl Payload {
    /// Camera in photo mode, gimbal level, lamp dark.
    #[must_use]
    pub fn new() -> Self {
        Self {
            camera: CameraState::default(),
            gimbal: GimbalState::new(),
            lamp: LampState::OFF,
            changes: PayloadChange::default(),
        }
    }

    /// Time passes: what moves moves, what is due is done.
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

/// Messages to be said once to everybody, and warnings.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PayloadChange {
    messages: BTreeSet<u32>,
    warnings: BTreeSet<&'static str>,
}

impl PayloadChange {
    /// The message with this number, as it is at the end of the tick.
    pub fn add_message(&mut self, message: u32) {
        self.messages.insert(message);
    }

    /// A text.
    pub fn add_warning(&mut self, text: &'static str) {
        self.warnings.insert(text);
    }

    /// All of it.
    pub fn take(&mut self) -> (BTreeSet<u32>, BTreeSet<&'static str>) {
        (std::mem::take(&mut self.messages), std::mem::take(&mut self.warnings))
    }
}
