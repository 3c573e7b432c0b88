//! File jobs for the host, alternating between the file server and log transfers.

use crate::endpoint::VehicleLink;
use crate::endpoint::files::job::{FileError, FileJob, FileJobResult};
use crate::endpoint::files::job_allowance::JobAllowance;
use crate::endpoint::logs::LogTransfers;
use spandrel_model::time::SimTime;

/// The per-tick limit, and the service whose job runs next.
#[derive(Debug, Clone, Default)]
pub(super) struct FileJobScheduler {
    allowance: JobAllowance,
    logs_next: bool,
}

impl FileJobScheduler {
    /// Returns the next job within the limit.
    pub(super) fn poll(&mut self, vehicle: &mut VehicleLink, now: SimTime) -> Option<FileJob> {
        let is_log = self.next_is_log(vehicle, now)?;
        let job = if is_log { vehicle.logs.poll_job() } else { vehicle.files.poll_job() }?;
        self.allowance.spend(&job.action, now);
        self.logs_next = !is_log;
        Some(job)
    }

    /// Returns true if a job is waiting and within the limit.
    pub(super) fn has_job(&self, vehicle: &VehicleLink, now: SimTime) -> bool {
        self.next_is_log(vehicle, now).is_some()
    }

    /// Returns true if the next allowed job is a log transfer.
    fn next_is_log(&self, vehicle: &VehicleLink, now: SimTime) -> Option<bool> {
        let (files, logs) = (vehicle.files.next_action(), vehicle.logs.next_action());
        let is_log = logs.is_some() && (self.logs_next || files.is_none());
        let action = if is_log { logs } else { files }?;
        self.allowance.covers(action, now).then_some(is_log)
    }
}

/// Passes the result of a job to the service that requested it.
pub(super) fn finish(vehicle: &mut VehicleLink, ticket: u64, outcome: Result<FileJobResult, FileError>, now: SimTime) {
    if LogTransfers::owns(ticket) {
        vehicle.logs.done(ticket, outcome);
    } else {
        vehicle.files.done(ticket, outcome, now);
    }
}
