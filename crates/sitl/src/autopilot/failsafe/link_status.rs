//! Time of the last input from sticks, ground stations and external setpoints.

use crate::autopilot::external_input::{OffboardSetpoint, Sticks};
use spandrel_model::time::SimTime;

/// Latest inputs with their timestamps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkStatus {
    /// Stick input with the deadband removed.
    pub sticks: Sticks,
    /// Time of the last stick input.
    pub sticks_at: Option<SimTime>,
    /// Whether stick input arrives in guided mode (ArduCopter: GUIDED).
    pub guided: bool,
    /// Time of the last ground station heartbeat.
    pub ground_station: Option<SimTime>,
    /// Last external setpoint and its time.
    pub offboard: Option<(OffboardSetpoint, SimTime)>,
}

impl LinkStatus {
    /// Processes stick input.
    pub fn update_sticks(&mut self, s: Sticks, deadband: f64, now: SimTime) {
        let shaped = |v: f64| stick(v, deadband);
        self.sticks = Sticks { forward: shaped(s.forward), right: shaped(s.right), up: shaped(s.up), yaw: shaped(s.yaw) };
        self.sticks_at = Some(now);
    }

    /// Returns true if stick input arrived within `loss_s`.
    #[must_use]
    pub fn has_recent_sticks(&self, loss_s: f64, now: SimTime) -> bool {
        self.sticks_at.is_some_and(|at| (now - at).s() <= loss_s)
    }

    /// Returns true if an external setpoint arrived within `loss_s`.
    #[must_use]
    pub fn has_recent_offboard(&self, loss_s: f64, now: SimTime) -> bool {
        self.offboard.is_some_and(|(_, at)| (now - at).s() <= loss_s)
    }

    /// Returns true if a stick is deflected by at least `least` and has moved by at least that much from an earlier
    /// input. The yaw stick is ignored in GUIDED, where it only controls heading.
    #[must_use]
    pub fn moved_from(&self, earlier: &Sticks, least: f64) -> bool {
        let (s, t) = (&self.sticks, earlier);
        let yaw = if self.guided { (0.0, 0.0) } else { (s.yaw, t.yaw) };
        let pairs = [(s.forward, t.forward), (s.right, t.right), (s.up, t.up), yaw];
        pairs.iter().any(|(now, then)| now.abs() > least && (now - then).abs() > least)
    }

    /// Returns the largest stick deflection.
    #[must_use]
    pub fn deflection(&self) -> f64 {
        self.deflection_without_throttle().max(self.sticks.up.abs())
    }

    /// Returns the largest stick deflection, excluding the throttle.
    #[must_use]
    pub fn deflection_without_throttle(&self) -> f64 {
        let s = &self.sticks;
        s.forward.abs().max(s.right.abs()).max(s.yaw.abs())
    }
}

/// Stick value with the deadband removed, rescaled to reach full deflection.
fn stick(value: f64, deadband: f64) -> f64 {
    let v = value.clamp(-1.0, 1.0);
    if v.abs() <= deadband || !v.is_finite() { 0.0 } else { (v.abs() - deadband) / (1.0 - deadband) * v.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_stick_deadband_preserves_full_deflection() {
        assert_eq!(stick(0.05, 0.05), 0.0);
        assert_eq!(stick(-1.0, 0.05), -1.0);
        assert_eq!(stick(f64::NAN, 0.05), 0.0);
    }
}
