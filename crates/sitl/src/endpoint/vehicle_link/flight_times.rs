//! Times of the current or last flight.

use crate::autopilot::{AutopilotStatus, LandedState};
use spandrel_model::time::SimTime;

/// Start and end of a flight in simulation time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlightTimes {
    /// Flight number since startup, counting from 1; 0 before the first flight.
    pub number: u64,
    /// Time of arming.
    pub armed: Option<SimTime>,
    /// Time of takeoff.
    pub took_off_at: Option<SimTime>,
    /// Time of landing.
    pub landed: Option<SimTime>,
}

impl FlightTimes {
    /// Updates the times from the autopilot's status; `was_armed` is the previous armed state.
    pub fn update(&mut self, was_armed: bool, status: &AutopilotStatus, now: SimTime) {
        if status.armed && !was_armed {
            *self = Self { number: self.number + 1, armed: Some(now), ..Self::default() };
        }
        let grounded = status.landed == LandedState::OnGround;
        if status.armed && !grounded {
            self.took_off_at.get_or_insert(now);
            self.landed = None;
        } else if grounded && self.took_off_at.is_some() {
            self.landed.get_or_insert(now);
        }
    }
}
