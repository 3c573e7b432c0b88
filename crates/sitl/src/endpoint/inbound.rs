//! A message on its way to whoever acts on it.

use super::LinkId;
use super::snapshot::VehicleSnapshot;
use crate::autopilot::Autopilot;

/// A message that is meant for us, and what may be touched to answer it.
pub(super) struct InboundMessage<'a, 'v> {
    /// The link it came on.
    pub link: LinkId,
    /// Its sender.
    pub from: (u8, u8),
    /// The vehicle now.
    pub view: &'a VehicleSnapshot<'v>,
    /// Who flies.
    pub autopilot: &'a mut Autopilot,
}
