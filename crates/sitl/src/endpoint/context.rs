//! The state that a command can read and change, and its requests to the simulation.

use super::MOST_TEXTS;
use super::calibration::Calibration;
use super::link::PeerLink;
use super::params::Params;
use super::payload::Payload;
use super::snapshot::VehicleSnapshot;
use super::storage::ParamStorage;
use crate::autopilot::Autopilot;
use crate::faults::{FailureType, FailureUnit};
use spandrel_mavlink::codec::Encodable;
use spandrel_mavlink::dialect::{MavResult, MavSeverity};
use std::collections::VecDeque;

/// The state that a command can read and change.
pub struct CommandContext<'a, 'v> {
    /// Snapshot of the vehicle.
    pub view: VehicleSnapshot<'v>,
    /// The autopilot.
    pub autopilot: &'a mut Autopilot,
    /// Camera, gimbal, lamp.
    pub payload: &'a mut Payload,
    /// The link that the command came from.
    pub link: &'a mut PeerLink,
    /// Texts to broadcast.
    pub texts: &'a mut Vec<(MavSeverity, String)>,
    /// The parameters.
    pub params: &'a mut Params,
    /// Parameter storage.
    pub storage: &'a mut ParamStorage,
    /// Set to reboot the autopilot.
    pub restart: &'a mut bool,
    /// Failures to inject.
    pub faults: &'a mut VecDeque<FailureInjection>,
    /// The flavour's number of the last requested mode.
    pub requested_mode: &'a mut u32,
    /// Set to report the arming checks as events.
    pub report: &'a mut bool,
    /// The running calibration.
    pub calibration: &'a mut Option<Calibration>,
}

/// A failure to inject, or to clear if there is no kind. Instances count from 1; 0 means all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FailureInjection {
    /// Affected unit.
    pub unit: FailureUnit,
    /// Failure type; `None` clears the failure.
    pub kind: Option<FailureType>,
    /// Instance, 0 for all.
    pub instance: usize,
}

impl CommandContext<'_, '_> {
    /// Broadcasts a rejection with its reason, at the severity that PX4 uses.
    pub fn warn_all(&mut self, text: &str) {
        if self.texts.len() < MOST_TEXTS {
            self.texts.push((MavSeverity::MAV_SEVERITY_CRITICAL, text.to_string()));
        }
    }

    /// Broadcasts an informational text.
    pub fn inform_all(&mut self, text: &str) {
        if self.texts.len() < MOST_TEXTS {
            self.texts.push((MavSeverity::MAV_SEVERITY_INFO, text.to_string()));
        }
    }

    /// Broadcasts the reason and returns DENIED.
    pub fn deny(&mut self, why: &str) -> MavResult {
        self.warn_all(why);
        MavResult::MAV_RESULT_DENIED
    }

    /// Broadcasts the banner that identifies the autopilot.
    pub fn announce_identity(&mut self) {
        let room = MOST_TEXTS.saturating_sub(self.texts.len());
        let lines = self.view.flavour.banner.iter().take(room);
        self.texts.extend(lines.map(|line| (MavSeverity::MAV_SEVERITY_INFO, (*line).to_string())));
    }

    /// Checks whether the mode that accepts go-to commands (GUIDED) is active, for flavours that have one.
    #[must_use]
    pub fn in_guided_mode(&self) -> bool {
        let now = self.view.flavour.row_of(self.autopilot.status().mode, *self.requested_mode);
        self.view.flavour.errands == Some(now.number)
    }

    /// Sends a message to the link that the command came from.
    pub fn answer(&mut self, component: u8, message: &impl Encodable) -> MavResult {
        self.link.send(component, message);
        MavResult::MAV_RESULT_ACCEPTED
    }
}
