//! Parameter storage across runs: the host owns the file, and clients access it with PREFLIGHT_STORAGE.

use super::host_requests::StorageRequest;
use super::params::Params;

/// Parameter storage state, and the default values.
#[derive(Debug, Clone, PartialEq)]
pub struct ParamStorage {
    /// Whether the host has a parameter file.
    pub has_file: bool,
    /// The client request that the host has not handled yet.
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
        Self { has_file: false, request: None, defaults }
    }
}
