//! Context for handling a received message.

use super::LinkId;
use super::snapshot::VehicleSnapshot;
use crate::autopilot::Autopilot;

/// A message addressed to this vehicle, and the state needed to handle it.
pub(super) struct InboundMessage<'a, 'v> {
    /// The link it arrived on.
    pub link: LinkId,
    /// System and component ID of the sender.
    pub from: (u8, u8),
    /// Snapshot of the vehicle.
    pub view: &'a VehicleSnapshot<'v>,
    /// The autopilot.
    pub autopilot: &'a mut Autopilot,
}
