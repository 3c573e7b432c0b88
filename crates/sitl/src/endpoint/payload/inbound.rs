//! Context for handling a message to the equipment.

use super::input::PayloadInput;
use crate::endpoint::component_ids::CAMERA;
use crate::endpoint::link::{LinkId, Links};
use spandrel_mavlink::dialect::MavMessage;

/// A message addressed to this vehicle, and the state needed to handle it.
pub(crate) struct PayloadMessage<'a, 'v> {
    /// The link it arrived on.
    pub link: LinkId,
    /// The sender's system and component ID.
    pub from: (u8, u8),
    /// Aircraft state.
    pub input: &'a PayloadInput<'v>,
    /// All links.
    pub links: &'a mut Links,
}

impl PayloadMessage<'_, '_> {
    /// Sends a response from the camera component.
    pub fn answer(&mut self, message: &MavMessage) {
        self.links.answer(CAMERA, self.link, message);
    }
}
