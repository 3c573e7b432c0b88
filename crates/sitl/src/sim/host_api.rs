//! What the shell does for the vehicle: keys, files, logs, parameters. The core asks, the shell answers.

use super::Sim;
use crate::backend::Backend;
use crate::endpoint::files::job::{FileError, FileJob, FileJobResult};
use crate::endpoint::files::job_allowance::JobAllowance;
use crate::endpoint::logs::LogTransfers;
use crate::endpoint::params::text::ParamFileProblem;
use crate::endpoint::{LinkKind, Payload, StorageRequest};
use crate::log;
use spandrel_mavlink::signing::SigningKey;
use spandrel_model::site::Site;

/// How the jobs of clients are given out.
#[derive(Debug, Clone, Default)]
pub(super) struct FileJobScheduler {
    allowance: JobAllowance,
    logs_next: bool,
}

impl Sim {
    /// What stands and moves around the vehicle.
    #[must_use]
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// Camera, gimbal and lamp.
    #[must_use]
    pub fn payload(&self) -> &Payload {
        &self.endpoint.payload
    }

    /// Whether the motors are armed.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.backend.builtin().is_some_and(|autopilot| autopilot.status().armed)
    }

    /// Contacts with anything but the pad so far.
    #[must_use]
    pub fn hits(&self) -> i32 {
        self.scoring.hits
    }

    /// The camera's component says no heartbeats.
    pub fn mute_camera_heartbeat(&mut self) {
        self.endpoint.payload.camera.announced.silenced = true;
    }

    /// Signs everything and lets nothing act that is not signed with this key, but for unsigned frames on kinds of links that are
    /// trusted; `stamp` is the signing timestamp of now.
    pub fn demand_signatures(&mut self, key: SigningKey, stamp: u64, trusted: &[LinkKind]) {
        self.endpoint.demand_signatures(key, stamp, trusted);
    }

    /// What the next start with the same key must know, so that nothing is obeyed twice; `None` without a key.
    #[must_use]
    pub fn signing_memory(&self) -> Option<String> {
        self.endpoint.signing_memory()
    }

    /// Takes up what the last start knew.
    ///
    /// # Errors
    /// The number of the first line that is wrong, from 1.
    pub fn restore_signing(&mut self, memory: &str) -> Result<(), usize> {
        self.endpoint.restore_signing(memory)
    }

    /// The signing timestamp of now.
    pub fn set_signing_time(&mut self, stamp: u64) {
        self.endpoint.set_signing_time(stamp);
    }

    /// Frames that did nothing because they bore no good signature.
    #[must_use]
    pub fn rejected_frames(&self) -> u64 {
        self.endpoint.rejected_frames()
    }

    /// Changes of parameters so far.
    #[must_use]
    pub fn parameter_changes(&self) -> u64 {
        self.endpoint.parameter_changes()
    }

    /// The parameters as a text file, in the format of QGroundControl.
    #[must_use]
    pub fn parameter_text(&self) -> String {
        self.endpoint.parameter_text()
    }

    /// Sets what a parameter file says.
    ///
    /// # Errors
    /// Every line that is wrong; then nothing is set.
    pub fn read_parameters(&mut self, text: &str) -> Result<(), Vec<ParamFileProblem>> {
        let Backend::Builtin(autopilot) = &mut self.backend;
        self.endpoint.read_parameters(text, autopilot)
    }

    /// Somebody keeps the parameters in a file from now on ([`Sim::poll_storage`]).
    pub fn enable_param_storage(&mut self) {
        self.endpoint.keep_parameters();
    }

    /// What a client wants of the parameter file.
    pub fn poll_storage(&mut self) -> Option<StorageRequest> {
        self.endpoint.poll_storage()
    }

    /// Somebody does file jobs from now on ([`Sim::poll_file_job`]).
    pub fn enable_file_jobs(&mut self) {
        self.endpoint.files.stored();
        self.endpoint.logs.stored = true;
    }

    /// Keeps a log of every flight from now on.
    pub fn enable_flight_log(&mut self) {
        self.recorder.enable();
    }

    /// Ends a log that is under way: the program ends.
    pub fn close_flight_log(&mut self) {
        self.recorder.stop();
    }

    /// The next piece of the flight's log.
    pub fn poll_log(&mut self) -> Option<log::LogOutput> {
        self.recorder.poll()
    }

    /// The next thing to do with files for a client; no more in a tick than [`JobAllowance`] covers.
    pub fn poll_file_job(&mut self) -> Option<FileJob> {
        let logs_turn = self.next_file_job()?;
        let job = if logs_turn { self.endpoint.logs.poll_job() } else { self.endpoint.files.poll_job() }?;
        self.file_work.allowance.spend(&job.action, self.now);
        self.file_work.logs_next = !logs_turn;
        Some(job)
    }

    /// Work on files waits that may be done now.
    #[must_use]
    pub fn has_file_job(&self) -> bool {
        self.next_file_job().is_some()
    }

    /// Whether the next job that may be done now is the logs'; they and the file server take turns.
    fn next_file_job(&self) -> Option<bool> {
        let (files, logs) = (self.endpoint.files.next_action(), self.endpoint.logs.next_action());
        let logs_turn = logs.is_some() && (self.file_work.logs_next || files.is_none());
        let action = if logs_turn { logs } else { files }?;
        self.file_work.allowance.covers(action, self.now).then_some(logs_turn)
    }

    /// It is done.
    pub fn file_job_done(&mut self, ticket: u64, outcome: Result<FileJobResult, FileError>) {
        if LogTransfers::owns(ticket) {
            self.endpoint.logs.done(ticket, outcome);
        } else {
            self.endpoint.files.done(ticket, outcome, self.now);
        }
    }
}
