//! The aircraft's equipment and the scoring feed: camera (component 100), gimbal, lamp, ground truth. This module does
//! not depend on the autopilot, so it also works with another one.

pub mod camera;
mod camera_params;
mod changes;
pub mod commands;
mod components;
mod equipment;
pub mod gimbal;
mod gimbal_messages;
mod hazard_truth;
mod inbound;
mod input;
pub mod lamp;
mod publish;
mod receive;
mod scoring_feed;
mod scoring_truth;
mod snapshot;
pub mod streams;
mod video_reports;

use super::files::FileServer;
use super::link::LinkId;
use camera::settings;
pub use components::PayloadComponents;
pub use equipment::Payload;
pub use hazard_truth::{HazardTruth, RadioTruth};
pub(super) use inbound::PayloadMessage;
pub use input::PayloadInput;
pub(super) use receive::HANDLED;
use scoring_feed::ScoringFeed;
pub use scoring_truth::ScoringTruth;
pub use snapshot::PayloadSnapshot;
use spandrel_model::time::{Schedule, SimTime};
use std::collections::BTreeMap;
use std::ops::Range;

/// Rate of the messages about hazards, Hz.
const HAZARD_RATE_HZ: f64 = 2.0;
/// Rate of the message about other vehicles at the site, Hz (estimate: enough for displays that interpolate).
const OTHER_DRONES_RATE_HZ: f64 = 20.0;

/// State of the equipment interface.
#[derive(Debug, Clone)]
pub struct PayloadLink {
    /// The camera, gimbal and lamp.
    pub equipment: Payload,
    /// Seconds of simulation time per second of client time.
    pub speed_factor: f64,
    /// Component IDs of the equipment.
    pub components: PayloadComponents,
    files: FileServer,
    scoring: ScoringFeed,
    hazards_due: Schedule,
    other_drones_due: Schedule,
    /// For each link, indices of the image records that remain to be resent.
    image_requests: BTreeMap<LinkId, Range<usize>>,
}

impl PayloadLink {
    /// Creates the equipment interface with the camera definition file.
    #[must_use]
    pub fn new(components: PayloadComponents) -> Self {
        let mut files = FileServer::default();
        files.generate(settings::DEFINITION_PATH, settings::definition().into_bytes());
        Self {
            equipment: Payload::new(),
            speed_factor: 1.0,
            components,
            files,
            scoring: ScoringFeed::new(),
            hazards_due: Schedule::new(SimTime::ZERO, HAZARD_RATE_HZ),
            other_drones_due: Schedule::new(SimTime::ZERO, OTHER_DRONES_RATE_HZ),
            image_requests: BTreeMap::new(),
        }
    }

    /// Releases all state for a closed link.
    pub fn forget(&mut self, link: LinkId) {
        self.files.forget(link);
        self.image_requests.remove(&link);
    }
}
