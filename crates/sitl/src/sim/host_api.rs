//! Services that the host provides: signing keys, files, logs and parameters. The core sends requests and the host responds.

use super::{Sim, file_jobs};
use crate::backend::Backend;
use crate::endpoint::files::job::{FileError, FileJob, FileJobResult};
use crate::endpoint::params::text::ParamFileProblem;
use crate::endpoint::{LinkKind, Payload, StorageRequest};
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
        &self.endpoint.payload.equipment
    }

    /// Whether the motors are armed.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.backend.builtin().is_some_and(|autopilot| autopilot.status().armed)
    }

    /// Number of contacts so far, excluding the landing pad.
    #[must_use]
    pub fn hits(&self) -> i32 {
        self.scoring.hits
    }

    /// Stops the camera component's heartbeats.
    pub fn mute_camera_heartbeat(&mut self) {
        self.endpoint.payload.equipment.camera.announced.disabled_at_start = true;
    }

    /// Signs all outgoing frames and ignores incoming frames that are not signed with this key, except unsigned frames on trusted
    /// link kinds. `stamp` is the current signing timestamp.
    pub fn require_signatures(&mut self, key: SigningKey, stamp: u64, trusted: &[LinkKind]) {
        self.endpoint.links.require_signatures(key, stamp, trusted);
    }

    /// Returns the signing state to restore at the next start with the same key, which prevents replays. `None` without a key.
    #[must_use]
    pub fn signing_state(&self) -> Option<String> {
        self.endpoint.links.signing_state()
    }

    /// Restores the signing state of an earlier run.
    ///
    /// # Errors
    /// Returns the one-based number of the first invalid line.
    pub fn restore_signing(&mut self, memory: &str) -> Result<(), usize> {
        self.endpoint.links.restore_signing(memory)
    }

    /// Sets the current signing timestamp.
    pub fn set_signing_time(&mut self, stamp: u64) {
        self.endpoint.links.set_signing_time(stamp);
    }

    /// Number of frames ignored because of a missing or invalid signature.
    #[must_use]
    pub fn rejected_frames(&self) -> u64 {
        self.endpoint.links.rejected_frames()
    }

    /// Number of parameter changes so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.endpoint.vehicle.parameter_changes()
    }

    /// Returns the parameters as a text file in QGroundControl's format.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        self.endpoint.vehicle.parameter_text()
    }

    /// Sets parameters from a parameter file.
    ///
    /// # Errors
    /// Returns all invalid lines. In that case, no parameter is changed.
    pub fn load_parameters(&mut self, text: &str) -> Result<(), Vec<ParamFileProblem>> {
        let Backend::Builtin(autopilot) = &mut self.backend;
        self.endpoint.load_parameters(text, autopilot)
    }

    /// Enables parameter storage by the host ([`Sim::take_storage_request`]).
    pub fn enable_param_storage(&mut self) {
        self.endpoint.vehicle.enable_parameter_storage();
    }

    /// Returns the next storage request from a client.
    pub fn take_storage_request(&mut self) -> Option<StorageRequest> {
        self.endpoint.vehicle.take_storage_request()
    }

    /// Enables file jobs by the host ([`Sim::poll_file_job`]).
    pub fn enable_file_jobs(&mut self) {
        self.endpoint.vehicle.files.stored();
        self.endpoint.vehicle.logs.stored = true;
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
        self.file_jobs.poll(&mut self.endpoint.vehicle, self.now)
    }

    /// Returns true if a file job is waiting and within the limit.
    #[must_use]
    pub fn has_file_job(&self) -> bool {
        self.file_jobs.has_job(&self.endpoint.vehicle, self.now)
    }

    /// Reports the result of a file job.
    pub fn finish_file_job(&mut self, ticket: u64, outcome: Result<FileJobResult, FileError>) {
        file_jobs::finish(&mut self.endpoint.vehicle, ticket, outcome, self.now);
    }
}
