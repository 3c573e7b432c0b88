//! Inputs to the failsafes: a read-only view of the rest of the autopilot.

use crate::autopilot::estimator::estimate::Estimate;
use crate::autopilot::external_input::Sticks;
use crate::autopilot::flight_state::{FlightMode, LandedState};
use crate::autopilot::tuning::Tuning;
use crate::sensors::BatteryReading;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Inputs to a check.
#[derive(Debug, Clone, Copy)]
pub struct FailsafeInput<'a> {
    /// Operator settings.
    pub tuning: &'a Tuning,
    /// Estimated state.
    pub estimate: &'a Estimate,
    /// Flight state.
    pub flight: FlightSummary,
    /// Time of the check.
    pub now: SimTime,
}

/// Flight state.
#[derive(Debug, Clone, Copy)]
pub struct FlightSummary {
    /// Whether the motors are armed.
    pub armed: bool,
    /// Landed state.
    pub landed: LandedState,
    /// The active mode.
    pub mode: FlightMode,
    /// The requested mode. A failsafe can override it.
    pub intended: FlightMode,
    /// Whether a failsafe overrides the requested mode.
    pub overridden: bool,
    /// Stick input at the start of the active mode.
    pub sticks_at_mode_start: Sticks,
    /// Home, m.
    pub home_m: Option<Vec3<Ned>>,
    /// Whether the mission is empty.
    pub mission_is_empty: bool,
    /// Whether the estimator has ever had a global position.
    pub global_position_known: bool,
    /// Cosine of the angle between desired and estimated thrust directions.
    pub attitude_error_cosine: f64,
    /// Latest battery reading.
    pub battery: Option<BatteryReading>,
    /// Latest upward range finder reading, m.
    pub range_up_m: Option<f64>,
}

impl FlightSummary {
    /// Returns true if the vehicle is armed and off the ground.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.armed && self.landed != LandedState::OnGround
    }
}
