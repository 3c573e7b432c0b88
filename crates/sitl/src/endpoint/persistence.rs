//! Parameter persistence: sending the list to links, saving and loading it, and applying it to the autopilot.

use super::streams::AUTOPILOT;
use super::{Endpoint, StorageRequest, param_and_mission_services, params};
use crate::autopilot::{Autopilot, AutopilotRequest};

/// Number of parameters of a list sent to each link per tick.
const PARAMS_A_TICK: usize = 2;

impl Endpoint {
    /// Returns the number of parameter changes so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.params.changes()
    }

    /// Returns the parameters as a text file.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        params::text::write(&self.params, self.system_id)
    }

    /// Applies a parameter file and broadcasts the parameters.
    ///
    /// # Errors
    /// Returns all invalid lines; no parameter is set in that case.
    pub fn read_parameters(&mut self, text: &str, autopilot: &mut Autopilot) -> Result<(), Vec<params::text::ParamFileProblem>> {
        params::text::read(&mut self.params, text)?;
        self.parameters_changed(autopilot);
        Ok(())
    }

    /// Declares that the host stores the parameters.
    pub fn keep_parameters(&mut self) {
        self.storage.kept = true;
    }

    /// Removes and returns a client's storage request.
    pub fn poll_storage(&mut self) -> Option<StorageRequest> {
        self.storage.request.take()
    }

    /// Updates and broadcasts the geofence parameter after a command or mission switched the geofence.
    pub(super) fn note_fence_switch(&mut self, enabled: bool) {
        if self.params.fence_enabled().is_some_and(|shown| shown != enabled)
            && self.params.set_value(params::FENCE_SWITCH, params::ParamValue::Int(i32::from(enabled))).is_ok()
            && let Some(message) = param_and_mission_services::param_named(self, params::FENCE_SWITCH)
        {
            self.broadcast(AUTOPILOT, &message);
        }
    }

    /// Applies the parameters to the autopilot, manual control and camera.
    pub(super) fn apply_parameters(&mut self, autopilot: &mut Autopilot) {
        let cruise_m_s = autopilot.tuning.cruise_m_s;
        self.params.apply(&mut autopilot.tuning);
        if autopilot.tuning.cruise_m_s != cruise_m_s {
            autopilot.request(AutopilotRequest::SetSpeed(None), autopilot.now());
        }
        (self.flavour.tune)(&mut autopilot.tuning);
        self.manual.release_timeout_s = autopilot.tuning.manual_timeout_s();
        self.manual.policy = self.params.stick_policy();
        self.payload.camera.announced.parameter = self.params.camera_announced();
    }

    /// Applies the parameters after many may have changed, and sends every link the whole list.
    pub(super) fn parameters_changed(&mut self, autopilot: &mut Autopilot) {
        self.apply_parameters(autopilot);
        for id in self.links.keys() {
            self.param_lists.insert(*id, (0..self.params.count()).collect());
        }
    }

    pub(super) fn send_params(&mut self) {
        let count = self.params.count() as u16;
        for (id, list) in &mut self.param_lists {
            let Some(link) = self.links.get_mut(id) else { continue };
            for _ in 0..PARAMS_A_TICK {
                if link.is_busy() {
                    break;
                }
                let Some(index) = list.pop_front() else { break };
                if let Some(told) = self.params.outgoing(index) {
                    link.send(AUTOPILOT, &param_and_mission_services::param_value(told, index, count));
                }
            }
        }
        self.param_lists.retain(|_, list| !list.is_empty());
    }
}
