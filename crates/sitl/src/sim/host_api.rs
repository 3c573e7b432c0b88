//! Services that the host provides: signing keys, files, logs and parameters. The core sends requests and the host responds.

use super::controller::Controller;
use super::{Sim, file_jobs};
use crate::endpoint::files::job::{FileError, FileJob, FileJobResult};
use crate::endpoint::params::text::ParamFileProblem;
use crate::endpoint::{LinkKind, Payload, StorageRequest, VehicleLink};
use crate::log;
use spandrel_mavlink::signing::SigningKey;
use spandrel_model::site::Site;

impl Sim {
    /// The site around the vehicle.
    #[must_use]
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// Camera, gimbal and lamp.
    #[must_use]
    pub fn payload(&self) -> &Payload {
        &self.controller.payload().equipment
    }

    /// Whether the motors are armed.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.controller.armed()
    }

    /// Number of contacts so far, excluding the landing pad.
    #[must_use]
    pub fn hits(&self) -> i32 {
        self.scoring.hits
    }

    /// Stops the camera component's heartbeats.
    pub fn mute_camera_heartbeat(&mut self) {
        self.controller.payload_mut().equipment.camera.announced.disabled_at_start = true;
    }

    /// Signs all outgoing frames and ignores incoming frames that are not signed with this key, except unsigned frames on trusted
    /// link kinds. `stamp` is the current signing timestamp.
    pub fn require_signatures(&mut self, key: SigningKey, stamp: u64, trusted: &[LinkKind]) {
        self.controller.links_mut().require_signatures(key, stamp, trusted);
    }

    /// Returns the signing state to restore at the next start with the same key, which prevents replays. `None` without a key.
    #[must_use]
    pub fn signing_state(&self) -> Option<String> {
        self.controller.links().signing_state()
    }

    /// Restores the signing state of an earlier run.
    ///
    /// # Errors
    /// Returns the one-based number of the first invalid line.
    pub fn restore_signing(&mut self, memory: &str) -> Result<(), usize> {
        self.controller.links_mut().restore_signing(memory)
    }

    /// Sets the current signing timestamp.
    pub fn set_signing_time(&mut self, stamp: u64) {
        self.controller.links_mut().set_signing_time(stamp);
    }

    /// Number of frames ignored because of a missing or invalid signature.
    #[must_use]
    pub fn rejected_frames(&self) -> u64 {
        self.controller.links().rejected_frames()
    }

    /// Number of parameter changes so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.controller.parameter_changes()
    }

    /// Returns the parameters as a text file in QGroundControl's format. Empty with an external autopilot, which stores its own.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        self.controller.vehicle().map(VehicleLink::parameter_text).unwrap_or_default()
    }

    /// Sets parameters from a parameter file. Has no effect with an external autopilot.
    ///
    /// # Errors
    /// Returns all invalid lines. In that case, no parameter is changed.
    pub fn load_parameters(&mut self, text: &str) -> Result<(), Vec<ParamFileProblem>> {
        match &mut self.controller {
            Controller::Builtin(own) => own.endpoint.load_parameters(text, &mut own.autopilot),
            Controller::External(_) => Ok(()),
        }
    }

    /// Enables parameter storage by the host ([`Sim::take_storage_request`]).
    pub fn enable_param_storage(&mut self) {
        if let Some(vehicle) = self.controller.vehicle_mut() {
            vehicle.enable_parameter_storage();
        }
    }

    /// Returns the next storage request from a client.
    pub fn take_storage_request(&mut self) -> Option<StorageRequest> {
        self.controller.vehicle_mut()?.take_storage_request()
    }

    /// Enables file jobs by the host ([`Sim::poll_file_job`]).
    pub fn enable_file_jobs(&mut self) {
        if let Some(vehicle) = self.controller.vehicle_mut() {
            vehicle.files.stored();
            vehicle.logs.stored = true;
        }
    }

    /// Enables logging of all flights.
    pub fn enable_flight_log(&mut self) {
        self.recorder.enable();
    }

    /// Closes the current log. Call at program exit.
    pub fn close_flight_log(&mut self) {
        self.recorder.stop();
    }

    /// Returns the next output of the flight log.
    pub fn poll_log(&mut self) -> Option<log::LogOutput> {
        self.recorder.poll()
    }

    /// Returns the next file job from a client, within the per-tick limit of [`crate::endpoint::files::job_allowance`].
    pub fn poll_file_job(&mut self) -> Option<FileJob> {
        self.file_jobs.poll(self.controller.vehicle_mut()?, self.now)
    }

    /// Returns true if a file job is waiting and within the limit.
    #[must_use]
    pub fn has_file_job(&self) -> bool {
        self.controller.vehicle().is_some_and(|vehicle| self.file_jobs.has_job(vehicle, self.now))
    }

    /// Reports the result of a file job.
    pub fn finish_file_job(&mut self, ticket: u64, outcome: Result<FileJobResult, FileError>) {
        if let Some(vehicle) = self.controller.vehicle_mut() {
            file_jobs::finish(vehicle, ticket, outcome, self.now);
        }
    }
}
