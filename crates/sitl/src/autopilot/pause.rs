//! Pausing what is flown without leaving the mode (ArduCopter: DO_PAUSE_CONTINUE in AUTO and GUIDED).

use super::core::{Autopilot, Severity};
use super::modes::Wanted;
use super::shaper::stopping_point;
use super::{Landed, Mode, Outcome};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// A pause: where it holds, and since when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pause {
    /// Hold position, m.
    pub place_m: Vec3<Ned>,
    /// Start of the pause.
    pub since: SimTime,
}

impl Autopilot {
    pub(super) fn pause(&mut self, pause: bool, now: SimTime) -> Outcome {
        if !pause {
            return self.resume(now);
        }
        let flying = self.status.armed && self.status.landed == Landed::InAir && self.estimate.position_valid;
        let pausable = matches!(self.status.mode, Mode::Mission | Mode::Hold | Mode::Takeoff | Mode::Offboard);
        if !flying || !pausable {
            return Outcome::Failed("Failed to pause".into());
        }
        let place_m = stopping_point(&self.gains, self.estimate.position_m, self.estimate.velocity_m_s);
        self.course.paused.get_or_insert(Pause { place_m, since: now });
        self.status.mission_paused |= self.status.mode == Mode::Mission;
        Outcome::Accepted
    }

    /// Continues after a pause; the rest of a mission item's waiting time is kept.
    pub(super) fn resume(&mut self, now: SimTime) -> Outcome {
        let Some(pause) = self.course.paused.take() else { return Outcome::Accepted };
        if self.status.mode == Mode::Mission {
            self.status.mission_paused = false;
            self.mission.wait_until = self.mission.wait_until.map(|until| until + (now - pause.since));
            self.plan_way_again();
            self.say(Severity::Info, "Mission resumed");
        }
        Outcome::Accepted
    }

    /// Holds where the pause began; the course stays as it was.
    pub(super) fn hold_paused(&mut self, pause: Pause, dt_s: f64) -> Wanted {
        let target_m = std::mem::replace(&mut self.course.target_m, pause.place_m);
        let yaw_rad = self.course.target_yaw_rad.take();
        let wanted = self.go(None, dt_s);
        (self.course.target_m, self.course.target_yaw_rad) = (target_m, yaw_rad);
        wanted
    }
}
