//! Detects loss of attitude control and crashes.

use super::input::FailsafeInput;
use super::response::{FailsafeRequest, respond};
use crate::autopilot::events::{EventQueue, Severity};
use crate::autopilot::flight_state::LandedState;
use spandrel_model::time::SimTime;

/// Crash detection: attitude error (40 degrees, as a cosine) and its minimum duration at low speed, s.
const UPSET_ERROR_COSINE: f64 = 0.766;
const UPSET_DURATION_S: f64 = 2.5;
/// Speed above which crash detection waits for a possible recovery, m/s.
const MAX_CRASH_SPEED_M_S: f64 = 1.5;
/// Duration of the same attitude error after which control counts as lost, s (PX4: FD_FAIL_R_TTRI).
const CONTROL_LOSS_DURATION_S: f64 = 0.3;

/// State of the attitude monitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttitudeMonitor {
    /// Whether the vehicle tracks its attitude setpoint.
    pub tracks_attitude: bool,
    /// Time at which the attitude error began.
    error_since: Option<SimTime>,
    /// Time at which the upset began.
    upset_since: Option<SimTime>,
}

impl Default for AttitudeMonitor {
    fn default() -> Self {
        Self { tracks_attitude: true, error_since: None, upset_since: None }
    }
}

impl AttitudeMonitor {
    /// Resets the monitor at the start of a flight.
    pub fn begin_flight(&mut self) {
        (self.tracks_attitude, self.upset_since) = (true, None);
    }

    /// Resets the monitor at the end of a flight.
    pub fn end_flight(&mut self) {
        self.upset_since = None;
    }

    /// Reports a flying vehicle that does not follow its attitude setpoint, for example because of a failed motor or
    /// propeller, or an obstruction. Acts once per flight.
    pub fn check_tracking(&mut self, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        let flight = &input.flight;
        if flight.attitude_error_cosine > UPSET_ERROR_COSINE || flight.landed == LandedState::OnGround {
            self.error_since = None;
            return None;
        }
        let since = *self.error_since.get_or_insert(input.now);
        if !self.tracks_attitude || (input.now - since).s() <= CONTROL_LOSS_DURATION_S {
            return None;
        }
        self.tracks_attitude = false;
        events.push(Severity::Critical, "Attitude control lost: motor/propeller failure?");
        respond(input.tuning.rules.responses.motor_failure, "motor failure", Severity::Critical, input, events)
    }

    /// Requests to stop the motors if the vehicle is stuck in an attitude from which it cannot recover.
    pub fn check_crash(&mut self, input: &FailsafeInput, events: &mut EventQueue) -> Option<FailsafeRequest> {
        let flight = &input.flight;
        let moving = input.estimate.velocity_m_s.norm() > MAX_CRASH_SPEED_M_S;
        let upright = flight.attitude_error_cosine > UPSET_ERROR_COSINE;
        let checked = input.tuning.rules.responses.crash_check;
        if !checked || upright || moving || flight.landed == LandedState::OnGround {
            self.upset_since = None;
            return None;
        }
        let since = *self.upset_since.get_or_insert(input.now);
        ((input.now - since).s() > UPSET_DURATION_S).then(|| {
            events.push(Severity::Critical, "Crash detected");
            FailsafeRequest::terminate("crash")
        })
    }
}
