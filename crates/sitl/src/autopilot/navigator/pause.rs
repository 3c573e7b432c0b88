//! Pauses and resumes without a mode change (ArduCopter: DO_PAUSE_CONTINUE in AUTO and GUIDED).

use super::input::NavigatorInput;
use super::{Navigator, PausedAt};
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::stopping_point;
use crate::autopilot::events::Severity;
use crate::autopilot::flight_state::{FlightMode, LandedState};
use crate::autopilot::request::RequestOutcome;

impl Navigator {
    /// Pauses or resumes.
    pub(super) fn pause(&mut self, pause: bool, input: &NavigatorInput) -> RequestOutcome {
        if !pause {
            return self.resume(input);
        }
        let flying = input.armed && self.landed(input) == LandedState::InAir && input.estimate.position_valid;
        let pausable =
            matches!(self.modes.active, FlightMode::Mission | FlightMode::Hold | FlightMode::Takeoff | FlightMode::Offboard);
        if !flying || !pausable {
            return RequestOutcome::Failed("Failed to pause".into());
        }
        let place_m = stopping_point(input.gains, input.here(), input.estimate.velocity_m_s);
        self.paused.get_or_insert(PausedAt { position_m: place_m, since: input.now });
        self.mission_status.paused |= self.modes.active == FlightMode::Mission;
        RequestOutcome::Accepted
    }

    /// Continues after a pause. Preserves the remaining wait of a mission item.
    pub(super) fn resume(&mut self, input: &NavigatorInput) -> RequestOutcome {
        let Some(pause) = self.paused.take() else { return RequestOutcome::Accepted };
        if self.modes.active == FlightMode::Mission {
            self.mission_status.paused = false;
            self.mission.wait_until = self.mission.wait_until.map(|until| until + (input.now - pause.since));
            self.replan_trajectory(input);
            self.events.push(Severity::Info, "Mission resumed");
        }
        RequestOutcome::Accepted
    }

    /// Holds the pause position. Does not change the navigator's target.
    pub(super) fn hold_paused(&mut self, pause: PausedAt, input: &NavigatorInput) -> Setpoint {
        let target_m = std::mem::replace(&mut self.target_m, pause.position_m);
        let yaw_rad = self.heading.target_rad.take();
        let wanted = self.fly_to_target(None, input);
        (self.target_m, self.heading.target_rad) = (target_m, yaw_rad);
        wanted
    }
}
