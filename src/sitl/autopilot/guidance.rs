//! Wanted velocity in every mode: from sticks, towards a point, up, down.

use super::{Estimate, Ned, Sticks, Vec3};
use crate::base::math;
use crate::vehicle::FlightLimits;

/// A stick nearer to its centre than this counts as let go.
pub const DEAD_BAND: f64 = 0.03;
/// Slower than this, a let-go aircraft holds where it is, m/s.
const HOLD_BELOW_M_S: f64 = 0.4;

/// Velocity set-point that moves no faster than the aircraft can follow, and the point held when the sticks are let go.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Guidance {
    /// Present set-point, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Held place, m: north and east, and down on its own.
    pub held_level_m: Option<(f64, f64)>,
    /// Held height, m down.
    pub held_down_m: Option<f64>,
}

/// Limits of one aircraft for guidance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Horizontal acceleration, m/s².
    pub level_m_s2: f64,
    /// Vertical acceleration, m/s² (estimate: a third of gravity).
    pub vertical_m_s2: f64,
    /// Position gain, 1/s.
    pub position_gain: f64,
}

impl Guidance {
    /// From the present motion.
    #[must_use]
    pub fn starting(e: &Estimate) -> Self {
        Self { velocity_m_s: e.velocity_m_s, held_level_m: None, held_down_m: None }
    }

    /// Moves the set-point towards `wanted`; returns it and its acceleration.
    pub fn slew(&mut self, wanted_m_s: Vec3<Ned>, reach: &Reach, dt_s: f64) -> (Vec3<Ned>, Vec3<Ned>) {
        let change = wanted_m_s - self.velocity_m_s;
        let level = Vec3::<Ned>::new(change.north(), change.east(), 0.0).limited(reach.level_m_s2 * dt_s);
        let vertical = change.down().clamp(-reach.vertical_m_s2 * dt_s, reach.vertical_m_s2 * dt_s);
        let step = level + Vec3::new(0.0, 0.0, vertical);
        self.velocity_m_s += step;
        (self.velocity_m_s, step / dt_s)
    }

    /// Sticks as velocity in the heading's frame; where they are let go, the place is held.
    pub fn by_sticks(&mut self, sticks: &Sticks, e: &Estimate, yaw_rad: f64, limits: &FlightLimits, reach: &Reach) -> Vec3<Ned> {
        let forward = shaped(sticks.forward) * limits.forward_m_s;
        let right = shaped(sticks.right) * limits.sideward_m_s;
        let (s, c) = math::sin_cos(yaw_rad);
        let mut wanted = Vec3::new(forward * c - right * s, forward * s + right * c, 0.0);
        if wanted.norm() == 0.0 {
            let slow = e.velocity_m_s.horizontal_norm() < HOLD_BELOW_M_S && self.velocity_m_s.horizontal_norm() < HOLD_BELOW_M_S;
            if self.held_level_m.is_none() && slow {
                self.held_level_m = Some((e.position_m.north(), e.position_m.east()));
            }
            if let Some((north, east)) = self.held_level_m {
                wanted += Vec3::new(north - e.position_m.north(), east - e.position_m.east(), 0.0) * reach.position_gain;
            }
        } else {
            self.held_level_m = None;
        }
        wanted + Vec3::new(0.0, 0.0, self.climb_by_stick(sticks, e, limits, reach))
    }

    /// Vertical velocity (down) from the stick; let go, the height is held.
    pub fn climb_by_stick(&mut self, sticks: &Sticks, e: &Estimate, limits: &FlightLimits, reach: &Reach) -> f64 {
        let up = shaped(sticks.up);
        if up != 0.0 {
            self.held_down_m = None;
            return if up > 0.0 { -up * limits.climb_m_s } else { -up * limits.descend_m_s };
        }
        if self.held_down_m.is_none() && e.velocity_m_s.down().abs() < HOLD_BELOW_M_S {
            self.held_down_m = Some(e.position_m.down());
        }
        self.held_down_m.map_or(0.0, |down| (down - e.position_m.down()) * reach.position_gain)
    }

    /// Towards a point at no more than `speed_m_s`, slowing down in time.
    #[must_use]
    pub fn towards(target_m: Vec3<Ned>, e: &Estimate, speed_m_s: f64, limits: &FlightLimits, reach: &Reach) -> Vec3<Ned> {
        let d = target_m - e.position_m;
        let level = Vec3::<Ned>::new(d.north(), d.east(), 0.0);
        let far = level.norm();
        // Linear near the target, then as the root of the distance: constant deceleration at half of what the aircraft can do.
        let brake = (far * reach.level_m_s2).sqrt();
        let speed = (far * reach.position_gain).min(brake).min(speed_m_s);
        let down = (d.down() * reach.position_gain).clamp(-limits.climb_m_s, limits.descend_m_s);
        level.unit() * speed + Vec3::new(0.0, 0.0, down)
    }
}

/// Stick with its dead band taken out.
fn shaped(stick: f64) -> f64 {
    let size = (stick.abs() - DEAD_BAND).max(0.0) / (1.0 - DEAD_BAND);
    size.min(1.0) * if stick < 0.0 { -1.0 } else { 1.0 }
}
