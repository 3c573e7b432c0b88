//! State of the requests with which the simulator sets up its link to the autopilot.

use spandrel_model::time::SimTime;

/// State of the requests to the present autopilot process.
#[derive(Debug, Clone, Default)]
pub(super) struct SetupRequests {
    /// Whether the streams have been requested.
    pub streams: bool,
    /// Whether the parameters have been requested.
    pub parameters: bool,
    /// Number of parameters that were known at the last check.
    pub known_parameters: usize,
    /// Time of the next check.
    pub check_at: SimTime,
}
