//! Sends the parameters to links, saves and loads them, and applies them to the autopilot.

use super::VehicleLink;
use super::host_requests::StorageRequest;
use super::inbound::InboundMessage;
use super::param_messages::{param_named, param_value};
use super::params::text::{self, ParamFileProblem};
use super::params::{FENCE_ENABLE_NAME, ParamValue};
use crate::autopilot::{Autopilot, AutopilotRequest};
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::Links;
use crate::endpoint::payload::Payload;

/// Number of parameters sent per tick on each link that receives the list.
const PARAMS_PER_TICK: usize = 2;

impl VehicleLink {
    /// Returns the number of parameter changes so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.params.changes()
    }

    /// Returns the parameters as a text file.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        text::write(&self.params, self.system_id)
    }

    /// Applies a parameter file and broadcasts the parameters.
    ///
    /// # Errors
    /// Returns all invalid lines. No parameter is set in that case.
    pub fn load_parameters(
        &mut self,
        text: &str,
        autopilot: &mut Autopilot,
        payload: &mut Payload,
        links: &Links,
    ) -> Result<(), Vec<ParamFileProblem>> {
        text::read(&mut self.params, text)?;
        self.parameters_changed(autopilot, payload, links);
        Ok(())
    }

    /// Enables parameter storage by the host.
    pub fn enable_parameter_storage(&mut self) {
        self.storage.has_file = true;
    }

    /// Removes and returns a client's storage request.
    pub fn take_storage_request(&mut self) -> Option<StorageRequest> {
        self.storage.request.take()
    }

    /// Updates and broadcasts the geofence parameter after a command or mission has turned the geofence on or off.
    pub(super) fn sync_fence_parameter(&mut self, enabled: bool, links: &mut Links) {
        if self.params.fence_enabled().is_some_and(|shown| shown != enabled)
            && self.params.set_value(FENCE_ENABLE_NAME, ParamValue::Int(i32::from(enabled))).is_ok()
            && let Some(message) = param_named(self, FENCE_ENABLE_NAME)
        {
            links.broadcast(AUTOPILOT, &message);
        }
    }

    /// Applies the parameters to the autopilot, manual control and camera.
    pub(super) fn apply_parameters(&mut self, autopilot: &mut Autopilot, payload: &mut Payload) {
        let cruise_m_s = autopilot.tuning.cruise_speed_m_s;
        self.params.apply(&mut autopilot.tuning);
        if autopilot.tuning.cruise_speed_m_s != cruise_m_s {
            autopilot.request(AutopilotRequest::SetSpeed(None), autopilot.now());
        }
        (self.flavor.tune)(&mut autopilot.tuning);
        self.manual.release_timeout_s = autopilot.tuning.manual_timeout_s();
        self.manual.policy = self.params.stick_policy();
        payload.camera.announced.parameter = self.params.camera_announced();
    }

    /// Applies the parameters after a change of one of them, and broadcasts its value.
    pub(super) fn parameter_changed(&mut self, name: &str, a: &mut InboundMessage) {
        self.apply_parameters(a.autopilot, a.payload);
        if let Some(message) = param_named(self, name) {
            a.broadcast(&message);
        }
    }

    /// Applies the parameters after a change that may affect many of them, and sends the whole list on every link.
    pub(super) fn parameters_changed(&mut self, autopilot: &mut Autopilot, payload: &mut Payload, links: &Links) {
        self.apply_parameters(autopilot, payload);
        for id in links.ids() {
            self.param_lists.insert(id, (0..self.params.count()).collect());
        }
    }

    pub(super) fn send_params(&mut self, links: &mut Links) {
        let count = self.params.count() as u16;
        for (id, list) in &mut self.param_lists {
            let Some(link) = links.get_mut(*id) else { continue };
            for _ in 0..PARAMS_PER_TICK {
                if link.is_busy() {
                    break;
                }
                let Some(index) = list.pop_front() else { break };
                if let Some(param) = self.params.outgoing(index) {
                    link.send(AUTOPILOT, &param_value(param, index, count));
                }
            }
        }
        self.param_lists.retain(|_, list| !list.is_empty());
    }
}
