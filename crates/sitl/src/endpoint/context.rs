//! What a command works on, and what it may order of the simulation.

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

/// What a command works on.
pub struct CommandContext<'a, 'v> {
    /// The vehicle now.
    pub view: VehicleSnapshot<'v>,
    /// Who flies.
    pub autopilot: &'a mut Autopilot,
    /// Camera, gimbal, lamp.
    pub payload: &'a mut Payload,
    /// The link that asked.
    pub link: &'a mut PeerLink,
    /// Texts for everybody.
    pub texts: &'a mut Vec<(MavSeverity, String)>,
    /// The parameters.
    pub params: &'a mut Params,
    /// Where they are kept.
    pub storage: &'a mut ParamStorage,
    /// The autopilot's software is to start again.
    pub restart: &'a mut bool,
    /// Faults that are put in.
    pub faults: &'a mut VecDeque<FailureInjection>,
    /// The flavour's number of the mode that was asked for last.
    pub requested_mode: &'a mut u32,
    /// Arming checks are to be reported as events.
    pub report: &'a mut bool,
    /// The calibration that runs.
    pub calibration: &'a mut Option<Calibration>,
}

/// A fault to put in, or with no kind to take out; the instance counts from 1, 0 is all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FailureInjection {
    /// What.
    pub unit: FailureUnit,
    /// How.
    pub kind: Option<FailureType>,
    /// Which.
    pub instance: usize,
}

impl CommandContext<'_, '_> {
    /// Says to everybody what is refused and why, as gravely as PX4 does.
    pub fn warn_all(&mut self, text: &str) {
        if self.texts.len() < MOST_TEXTS {
            self.texts.push((MavSeverity::MAV_SEVERITY_CRITICAL, text.to_string()));
        }
    }

    /// Informs everybody.
    pub fn inform_all(&mut self, text: &str) {
        if self.texts.len() < MOST_TEXTS {
            self.texts.push((MavSeverity::MAV_SEVERITY_INFO, text.to_string()));
        }
    }

    /// Refuses, and says why.
    pub fn deny(&mut self, why: &str) -> MavResult {
        self.warn_all(why);
        MavResult::MAV_RESULT_DENIED
    }

    /// Says to everybody who this is.
    pub fn announce_identity(&mut self) {
        let room = MOST_TEXTS.saturating_sub(self.texts.len());
        let lines = self.view.flavour.banner.iter().take(room);
        self.texts.extend(lines.map(|line| (MavSeverity::MAV_SEVERITY_INFO, (*line).to_string())));
    }

    /// Whether the mode is flown that flies errands, where the flavour has one.
    #[must_use]
    pub fn in_guided_mode(&self) -> bool {
        let now = self.view.flavour.row_of(self.autopilot.status().mode, *self.requested_mode);
        self.view.flavour.errands == Some(now.number)
    }

    /// Answers the link that asked.
    pub fn answer(&mut self, component: u8, message: &impl Encodable) -> MavResult {
        self.link.send(component, message);
        MavResult::MAV_RESULT_ACCEPTED
    }
}
