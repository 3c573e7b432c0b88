//! Parameter storage across runs: the host owns the file, and clients access it with PREFLIGHT_STORAGE.

use super::CommandContext;
use super::commands::VehicleCommand;
use super::params::Params;
use spandrel_mavlink::dialect::MavResult;

/// A client's request for the parameter file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRequest {
    /// Load the file.
    Load,
    /// Save the file.
    Save,
}

/// State of parameter storage, and the default values.
#[derive(Debug, Clone, PartialEq)]
pub struct ParamStorage {
    /// Whether the host has a parameter file.
    pub kept: bool,
    /// The pending request.
    pub request: Option<StorageRequest>,
    defaults: Params,
}

impl ParamStorage {
    /// Returns the default values.
    #[must_use]
    pub fn defaults(&self) -> &Params {
        &self.defaults
    }

    /// Creates the state without a parameter file.
    #[must_use]
    pub fn new(defaults: Params) -> Self {
        Self { kept: false, request: None, defaults }
    }
}

/// Handles PREFLIGHT_STORAGE: parameter 1 is 0 to load the file, 1 to save it, 2 to restore the defaults (MAVLink common).
pub(super) fn preflight(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    let wish = match c.p[0] {
        0.0 => StorageRequest::Load,
        1.0 => StorageRequest::Save,
        2.0 => {
            x.params.reset(&x.storage.defaults);
            return MavResult::MAV_RESULT_ACCEPTED;
        }
        // -1 does nothing.
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
