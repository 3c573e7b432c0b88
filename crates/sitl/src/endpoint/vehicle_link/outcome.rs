//! Results and texts for rejected requests.

use super::VehicleLink;
use crate::autopilot::RequestOutcome;
use spandrel_mavlink::dialect::MavResult;

impl VehicleLink {
    /// Broadcasts the reason and returns DENIED.
    pub(super) fn deny(&mut self, why: &str) -> MavResult {
        self.warn(why);
        MavResult::MAV_RESULT_DENIED
    }

    /// Converts the autopilot's outcome to a result; its reason is sent as a text.
    pub(super) fn result_of(&mut self, outcome: RequestOutcome) -> MavResult {
        let refusals = &self.flavor.refusals;
        let (result, reason) = match outcome {
            RequestOutcome::Accepted => return MavResult::MAV_RESULT_ACCEPTED,
            RequestOutcome::TemporarilyRejected(reason) => (refusals.temporary_rejection, reason),
            RequestOutcome::Denied(reason) => (refusals.denied, reason),
            RequestOutcome::Failed(reason) => (MavResult::MAV_RESULT_FAILED, reason),
            RequestOutcome::Unsupported => return MavResult::MAV_RESULT_UNSUPPORTED,
        };
        self.warn(&reason);
        result
    }
}
