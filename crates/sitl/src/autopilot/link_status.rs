//! Who talks to the autopilot, and when they last did.

use super::shaper::stick;
use super::{OffboardSetpoint, Sticks};
use spandrel_model::time::SimTime;

/// Sticks, ground station and external set-points with their times.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkStatus {
    /// Sticks with the dead band taken out.
    pub sticks: Sticks,
    /// When they last came.
    pub sticks_at: Option<SimTime>,
    /// Sticks when the present automatic mode began: they take over by moving from there.
    pub sticks_then: Sticks,
    /// The sticks came in the mode that flies errands (ArduCopter: GUIDED).
    pub guided: bool,
    /// Last heartbeat of a ground station.
    pub ground_station: Option<SimTime>,
    /// Last external set-point and its time.
    pub offboard: Option<(OffboardSetpoint, SimTime)>,
}

impl LinkStatus {
    /// Takes in the sticks.
    pub fn take_sticks(&mut self, s: Sticks, deadband: f64, now: SimTime) {
        let shaped = |v: f64| stick(v, deadband);
        self.sticks = Sticks { forward: shaped(s.forward), right: shaped(s.right), up: shaped(s.up), yaw: shaped(s.yaw) };
        self.sticks_at = Some(now);
    }

    /// Sticks have come within `loss_s`.
    #[must_use]
    pub fn sticks_fresh(&self, loss_s: f64, now: SimTime) -> bool {
        self.sticks_at.is_some_and(|at| (now - at).s() <= loss_s)
    }

    /// External set-points have come within `loss_s`.
    #[must_use]
    pub fn offboard_fresh(&self, loss_s: f64, now: SimTime) -> bool {
        self.offboard.is_some_and(|(_, at)| (now - at).s() <= loss_s)
    }

    /// A stick is deflected by `least` and has moved that far since the mode began. In GUIDED yaw does not count: it turns the nose, or nothing.
    #[must_use]
    pub fn moved(&self, least: f64) -> bool {
        let (s, t) = (&self.sticks, &self.sticks_then);
        let yaw = if self.guided { (0.0, 0.0) } else { (s.yaw, t.yaw) };
        let pairs = [(s.forward, t.forward), (s.right, t.right), (s.up, t.up), yaw];
        pairs.iter().any(|(now, then)| now.abs() > least && (now - then).abs() > least)
    }

    /// The largest deflection.
    #[must_use]
    pub fn deflection(&self) -> f64 {
        self.lateral_deflection().max(self.sticks.up.abs())
    }

    /// The largest deflection, the throttle left out.
    #[must_use]
    pub fn lateral_deflection(&self) -> f64 {
        let s = &self.sticks;
        s.forward.abs().max(s.right.abs()).max(s.yaw.abs())
    }
}
