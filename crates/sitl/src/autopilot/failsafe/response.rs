//! Requests from the failsafes to the autopilot.

use super::input::FailsafeInput;
use super::operator_rules::FailsafeResponse;
use crate::autopilot::events::{EventQueue, Severity};
use crate::autopilot::flight_state::FlightMode;

/// A request to the autopilot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FailsafeRequest {
    /// Fly a mode other than the requested one until the failure ends.
    Override(FlightMode),
    /// Fly the requested mode again.
    EndOverride,
    /// Change the requested mode. The pilot can change it again.
    SetMode {
        /// The mode to switch to.
        mode: FlightMode,
        /// Whether this ends an override.
        ends_override: bool,
    },
    /// Continue to the last external setpoint, and hold there.
    EndOffboard,
    /// Stop the motors, with the reason.
    Disarm(String),
}

impl FailsafeRequest {
    /// Returns the request to stop the motors for a failure.
    #[must_use]
    pub fn terminate(why: &str) -> Self {
        Self::Disarm(format!("Disarmed: {why}"))
    }
}

/// Returns the request for a lasting failsafe action, and reports it. The pilot can override the action.
pub fn respond(
    response: FailsafeResponse,
    why: &str,
    severity: Severity,
    input: &FailsafeInput,
    events: &mut EventQueue,
) -> Option<FailsafeRequest> {
    let located = input.estimate.position_valid;
    let (mode, action) = match response {
        FailsafeResponse::Warn => return None,
        FailsafeResponse::Hold if located => (FlightMode::Hold, "holding"),
        FailsafeResponse::Return if located => (FlightMode::Return, "returning"),
        FailsafeResponse::Hold | FailsafeResponse::Return | FailsafeResponse::Land => (FlightMode::Land, "landing"),
        FailsafeResponse::Terminate => return Some(FailsafeRequest::terminate(why)),
    };
    events.push(severity, format!("Failsafe: {why}, {action}"));
    Some(FailsafeRequest::SetMode { mode, ends_override: false })
}
