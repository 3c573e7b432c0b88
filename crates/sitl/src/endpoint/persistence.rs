//! Parameters as a whole: told to links, kept in a file by the shell, taken over by the autopilot.

use super::streams::AUTOPILOT;
use super::{Endpoint, StorageRequest, param_and_mission_services, params};
use crate::autopilot::{Autopilot, AutopilotRequest};

/// Parameters sent to a link in one tick of the list.
const PARAMS_A_TICK: usize = 2;

impl Endpoint {
    /// Changes of parameters so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.params.changes()
    }

    /// The parameters as a text file.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        params::text::write(&self.params, self.system_id)
    }

    /// Sets what a parameter file says, and tells everybody.
    ///
    /// # Errors
    /// Every line that is wrong; then nothing is set.
    pub fn read_parameters(&mut self, text: &str, autopilot: &mut Autopilot) -> Result<(), Vec<params::text::ParamFileProblem>> {
        params::text::read(&mut self.params, text)?;
        self.parameters_changed(autopilot);
        Ok(())
    }

    /// Somebody keeps the parameters from now on.
    pub fn keep_parameters(&mut self) {
        self.storage.kept = true;
    }

    /// What a client wants of whoever keeps the parameters.
    pub fn poll_storage(&mut self) -> Option<StorageRequest> {
        self.storage.request.take()
    }

    /// The geofence was switched by a command or a mission: the parameter for it follows, and everybody is told.
    pub(super) fn note_fence_switch(&mut self, enabled: bool) {
        if self.params.fence_enabled().is_some_and(|shown| shown != enabled)
            && self.params.set_value(params::FENCE_SWITCH, params::ParamValue::Int(i32::from(enabled))).is_ok()
            && let Some(message) = param_and_mission_services::param_named(self, params::FENCE_SWITCH)
        {
            self.broadcast(AUTOPILOT, &message);
        }
    }

    /// The parameters act.
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

    /// Many parameters may have changed: they act, and every link gets the whole list.
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
