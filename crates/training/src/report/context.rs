//! Inputs shared by the parts of a review.

use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Inputs shared by all parts of a review.
#[derive(Debug, Clone, Copy)]
pub struct ReviewContext<'a> {
    /// The flight's telemetry.
    pub flight: &'a Flight,
    /// The session's frames.
    pub frames: &'a [Frame],
    /// The session's scenario.
    pub scenario: &'a Scenario,
    /// Aircraft flown in the session.
    pub vehicle: &'a Vehicle,
    /// The session's site.
    pub site: &'a Site,
}

impl ReviewContext<'_> {
    /// Converts a simulation time to the time since lift-off in seconds.
    #[must_use]
    pub fn time_since_lift_off_s(&self, time: SimTime) -> f64 {
        self.frames.first().map_or(0.0, |first| (time - first.time).s())
    }
}
