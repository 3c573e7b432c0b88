//! Pausing without leaving the mode (ArduCopter: DO_PAUSE_CONTINUE in AUTO and GUIDED).

use super::core::{Autopilot, Severity};
use super::modes::Setpoint;
use super::shaper::stopping_point;
use super::{FlightMode, LandedState, RequestOutcome};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Position and start time of a pause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PausedAt {
    /// Hold position, m.
    pub place_m: Vec3<Ned>,
    /// Start of the pause.
    pub since: SimTime,
}

impl Autopilot {
    pub(super) fn pause(&mut self, pause: bool, now: SimTime) -> RequestOutcome {
        if !pause {
            return self.resume(now);
        }
        let flying = self.status.armed && self.status.landed == LandedState::InAir && self.estimate.position_valid;
        let pausable =
            matches!(self.status.mode, FlightMode::Mission | FlightMode::Hold | FlightMode::Takeoff | FlightMode::Offboard);
        if !flying || !pausable {
            return RequestOutcome::Failed("Failed to pause".into());
        }
        let place_m = stopping_point(&self.gains, self.estimate.position_m, self.estimate.velocity_m_s);
        self.navigator.paused.get_or_insert(PausedAt { place_m, since: now });
        self.status.mission_paused |= self.status.mode == FlightMode::Mission;
        RequestOutcome::Accepted
    }

    /// Continues after a pause. Keeps the remaining wait of a mission item.
    pub(super) fn resume(&mut self, now: SimTime) -> RequestOutcome {
        let Some(pause) = self.navigator.paused.take() else { return RequestOutcome::Accepted };
        if self.status.mode == FlightMode::Mission {
            self.status.mission_paused = false;
            self.mission.wait_until = self.mission.wait_until.map(|until| until + (now - pause.since));
            self.replan_trajectory();
            self.push_event(Severity::Info, "Mission resumed");
        }
        RequestOutcome::Accepted
    }

    /// Holds the position of the pause. Keeps the navigator's target.
    pub(super) fn hold_paused(&mut self, pause: PausedAt, dt_s: f64) -> Setpoint {
        let target_m = std::mem::replace(&mut self.navigator.target_m, pause.place_m);
        let yaw_rad = self.navigator.target_yaw_rad.take();
        let wanted = self.go(None, dt_s);
        (self.navigator.target_m, self.navigator.target_yaw_rad) = (target_m, yaw_rad);
        wanted
    }
}
