//! Landing detection from the estimate and the range finder: a commanded descent without movement, with a surface directly below.

use super::core::{Autopilot, Severity};
use super::operator_rules::FenceSwitching;
use super::{FlightMode, LandedState};
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::time::SimTime;

/// Vertical speed that counts as stopped during a commanded descent, m/s, and its minimum duration, s.
const STOPPED_M_S: f64 = 0.2;
const STOPPED_S: f64 = 0.3;
/// Minimum commanded descent rate, m/s.
const ASKED_M_S: f64 = 0.25;
/// Time over which the thrust fades out after ground contact, s. The landing is then complete.
const FADE_S: f64 = 0.5;
/// Tolerance of the range finder over the standing height, m.
const RANGE_MARGIN_M: f64 = 0.35;
/// Minimum cosine of the tilt on the ground (40 degrees).
const UPRIGHT: f64 = 0.766;
/// Height, m, or climb rate, m/s, at which the vehicle counts as off the ground.
const OFF_GROUND_M: f64 = 0.35;
const OFF_GROUND_M_S: f64 = 0.4;
/// Time after which an abandoned take-off ends, s.
const GIVEN_UP_S: f64 = 1.0;

/// State of landing detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LandingDetector {
    /// Commanded descent rate, m/s.
    pub wanted_down_m_s: f64,
    stopped_s: f64,
    fade_s: f64,
    given_up_s: f64,
}

impl LandingDetector {
    /// Remaining thrust fraction while the ground takes the weight, 0 to 1.
    #[must_use]
    pub fn thrust_share(&self) -> f64 {
        1.0 - self.fade_s / FADE_S
    }
}

impl Autopilot {
    /// Updates the landed state for one tick while armed.
    pub(super) fn update_landed_state(&mut self, now: SimTime, dt_s: f64) {
        match self.status.landed {
            LandedState::OnGround => self.settle_on_ground(now),
            LandedState::TakingOff if !self.has_left_ground() => self.wait_for_lift(now, dt_s),
            LandedState::TakingOff => {
                self.status.landed = LandedState::InAir;
                self.tuning.fence_enabled |= self.tuning.rules.fence.auto == FenceSwitching::InTheAir;
                self.push_event(Severity::Info, "Takeoff detected");
            }
            LandedState::InAir | LandedState::Landing => self.detect_landing(now, dt_s),
        }
    }

    fn has_left_ground(&self) -> bool {
        let up = self.navigator.ground_down_m - self.estimate.position_m.down();
        up > OFF_GROUND_M || (up > 0.5 * OFF_GROUND_M && self.estimate.velocity_m_s.down() < -OFF_GROUND_M_S)
    }

    fn settle_on_ground(&mut self, now: SimTime) {
        if self.status.mode == FlightMode::Mission {
            self.wait_on_ground(now);
        }
        if self.wants_to_fly(now) {
            self.leave_ground(now);
            return;
        }
        let t = &self.tuning;
        let (since, flown) = (self.failsafe.standing_since, self.failsafe.flown);
        let limit_s = if flown { t.disarm_after_landing_s } else { t.disarm_before_flight_s };
        if limit_s > 0.0 && (now - since).s() > limit_s {
            self.disarm(if flown { "Disarmed by landing" } else { "Disarmed: no take-off" });
        }
    }

    fn leave_ground(&mut self, now: SimTime) {
        self.reset_loops();
        self.status.landed = LandedState::TakingOff;
        self.navigator.left_ground = now;
        self.navigator.ground_down_m = self.estimate.position_m.down();
        self.landing_detector = LandingDetector::default();
        self.failsafe.flown = true;
        self.flown_path.begin(self.estimate.position_m);
        self.begin_mode(now);
    }

    fn wait_for_lift(&mut self, now: SimTime, dt_s: f64) {
        if self.wants_to_fly(now) {
            self.landing_detector.given_up_s = 0.0;
            return;
        }
        self.landing_detector.given_up_s += dt_s;
        if self.landing_detector.given_up_s > GIVEN_UP_S {
            self.touch_down(now);
        }
    }

    fn detect_landing(&mut self, now: SimTime, dt_s: f64) {
        let upright = (self.estimate.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
        let near = self.unfused.range_down_m.is_none_or(|r| r * upright < self.airframe.standing_m + RANGE_MARGIN_M);
        let still = self.estimate.velocity_m_s.down().abs() < STOPPED_M_S;
        let asked = self.landing_detector.wanted_down_m_s > ASKED_M_S;
        if !(near && still && asked && upright > UPRIGHT) {
            self.landing_detector.stopped_s = 0.0;
            self.landing_detector.fade_s = (self.landing_detector.fade_s - dt_s).max(0.0);
            return;
        }
        self.landing_detector.stopped_s += dt_s;
        if self.landing_detector.stopped_s > STOPPED_S {
            self.landing_detector.fade_s = (self.landing_detector.fade_s + dt_s).min(FADE_S);
        }
        if self.landing_detector.fade_s >= FADE_S {
            self.push_event(Severity::Info, "Landing detected");
            self.touch_down(now);
        }
    }

    fn touch_down(&mut self, now: SimTime) {
        self.status.landed = LandedState::OnGround;
        self.failsafe.standing_since = now;
        self.landing_detector = LandingDetector::default();
        self.reset_loops();
        if matches!(self.status.mode, FlightMode::Return | FlightMode::Mission) {
            self.finish_landing(now);
        }
    }

    pub(super) fn disarm(&mut self, why: &str) {
        self.status.armed = false;
        self.status.landed = LandedState::OnGround;
        self.landing_detector = LandingDetector::default();
        self.failsafe.flown = false;
        self.failsafe.upset_since = None;
        // Requests made during a flight end with it.
        self.look_at_m = None;
        self.commanded_m_s = None;
        self.navigator.takeoff_up_m = None;
        self.tuning.fence_enabled |= !self.tuning.fence_switch_stays;
        self.tuning.fence_enabled &= self.tuning.rules.fence.auto == FenceSwitching::Never;
        self.push_event(Severity::Info, why);
        let stays = self.failsafe.intended == FlightMode::Mission && self.tuning.mission_mode_stays;
        if !self.failsafe.intended.is_manual() && !stays {
            self.failsafe.intended = FlightMode::Hold;
            self.status.mode = FlightMode::Hold;
        }
    }
}
