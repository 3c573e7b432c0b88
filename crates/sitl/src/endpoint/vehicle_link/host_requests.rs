//! Client requests that the simulation or the host executes.

use crate::faults::{FailureType, FailureUnit};

/// A failure to inject, or to clear if `kind` is `None`. Instances count from 1; 0 means all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FailureInjection {
    /// The unit to which the failure applies.
    pub unit: FailureUnit,
    /// Failure type; `None` clears the failure.
    pub kind: Option<FailureType>,
    /// Instance, 0 for all.
    pub instance: usize,
}

/// A client's request for the parameter file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRequest {
    /// Load the parameter file.
    Load,
    /// Save the parameter file.
    Save,
}
