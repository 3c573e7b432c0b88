//! Refusal of a request that the simulation would carry out.

use super::text_queue::TextQueue;
use spandrel_mavlink::dialect::{MavResult, MavSeverity};
use std::collections::VecDeque;

/// Reason why a request to the simulation is refused.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedRequest {
    /// Result for the acknowledgment.
    pub result: MavResult,
    /// Text for the operator, if the result alone does not explain the reason.
    pub text: Option<String>,
}

impl RefusedRequest {
    /// Creates a refusal with the result "denied".
    pub fn denied(text: String) -> Self {
        Self { result: MavResult::MAV_RESULT_DENIED, text: Some(text) }
    }
}

/// Queues a request to the simulation, or reports why it is refused. Returns the result for the acknowledgment.
pub fn queue_or_refuse<T>(request: Result<T, RefusedRequest>, queue: &mut VecDeque<T>, texts: &mut TextQueue) -> MavResult {
    match request {
        Ok(request) => {
            queue.push_back(request);
            MavResult::MAV_RESULT_ACCEPTED
        }
        Err(refusal) => {
            refusal.text.iter().for_each(|text| texts.push(MavSeverity::MAV_SEVERITY_CRITICAL, text));
            refusal.result
        }
    }
}
