//! Keeping parameters beyond a run: the shell holds the file, clients ask for it by PREFLIGHT_STORAGE.

use super::CommandContext;
use super::commands::VehicleCommand;
use super::params::Params;
use spandrel_mavlink::dialect::MavResult;

/// What a client wants of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRequest {
    /// Read it again.
    Load,
    /// Write it.
    Save,
}

/// Who keeps the parameters, and what they were at first.
#[derive(Debug, Clone, PartialEq)]
pub struct ParamStorage {
    /// The shell has a file.
    pub kept: bool,
    /// What is to be done with it.
    pub request: Option<StorageRequest>,
    defaults: Params,
}

impl ParamStorage {
    /// What they were at first.
    #[must_use]
    pub fn defaults(&self) -> &Params {
        &self.defaults
    }

    /// Nobody keeps them.
    #[must_use]
    pub fn new(defaults: Params) -> Self {
        Self { kept: false, request: None, defaults }
    }
}

/// PREFLIGHT_STORAGE: parameter 1 is 0 to read the file, 1 to write it, 2 for the defaults (MAVLink common).
pub(super) fn preflight(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    let wish = match c.p[0] {
        0.0 => StorageRequest::Load,
        1.0 => StorageRequest::Save,
        2.0 => {
            x.params.reset(&x.storage.defaults);
            return MavResult::MAV_RESULT_ACCEPTED;
        }
        // -1 leaves the parameters alone.
        -1.0 => return MavResult::MAV_RESULT_ACCEPTED,
        _ => return MavResult::MAV_RESULT_DENIED,
    };
    if !x.storage.kept {
        x.warn_all("No parameter file: start with --params FILE");
        return MavResult::MAV_RESULT_DENIED;
    }
    x.storage.request = Some(wish);
    MavResult::MAV_RESULT_ACCEPTED
}
