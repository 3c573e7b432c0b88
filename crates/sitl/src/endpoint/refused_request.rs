//! Refusal of a request that the simulation would carry out.

use spandrel_mavlink::dialect::MavResult;

/// Reason why a request to the simulation is refused.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedRequest {
    /// Result for the acknowledgment.
    pub result: MavResult,
    /// Text for the operator, if the result alone does not explain the reason.
    pub text: Option<String>,
}
