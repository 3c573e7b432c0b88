//! Hold, go-to, take-off, landing, return and external set-points.

use super::core::{Autopilot, Severity};
use super::manual::LOCK_SPEED_M_S;
use super::modes::{ReturnPhase, Wanted};
use super::shaper::{Limits, heading_of, towards};
use super::velocity::{Motion, Pull};
use super::{Landed, Mode, OffboardSetpoint};
use crate::base::frames::{Frd, Ned, Vec3};
use crate::base::math;
use crate::base::time::SimTime;

/// In automatic modes the heading turns with this share of the full rate, and follows errors with this gain, 1/s.
const AUTO_YAW_SHARE: f64 = 0.7;
const AUTO_YAW_GAIN: f64 = 1.5;
/// A height counts as reached within, m.
pub(super) const HEIGHT_REACHED_M: f64 = 0.4;
/// The nose turns to the way when the target is further than this, m.
const TURN_BEYOND_M: f64 = 2.0;

impl Autopilot {
    pub(super) fn turn_to(&mut self, yaw: Option<f64>, dt_s: f64) {
        let limit = AUTO_YAW_SHARE * self.airframe.limits.yaw_rate_rad_s;
        let rate = yaw.map_or(0.0, |y| (AUTO_YAW_GAIN * math::wrap_pi(y - self.course.yaw_rad)).clamp(-limit, limit));
        self.turn_at(rate, dt_s);
    }

    pub(super) fn motion(&self, velocity_m_s: Vec3<Ned>) -> Motion {
        Motion { velocity_m_s, acceleration_m_s2: self.shaper.acceleration_m_s2, yaw_rad: self.course.yaw_rad }
    }

    pub(super) fn auto_limits(&self) -> Limits {
        Limits { horizontal_m_s2: 0.7 * self.gains.acceleration_m_s2, vertical_m_s2: 0.7 * self.gains.climb_acceleration_m_s2 }
    }

    /// Flies to the course's target and stays.
    pub(super) fn go(&mut self, speed: Option<f64>, dt_s: f64) -> Wanted {
        let (up, down) = (self.tuning.climb_m_s, self.tuning.descend_m_s);
        self.go_within(speed, up, down, dt_s)
    }

    pub(super) fn go_within(&mut self, speed: Option<f64>, up: f64, down: f64, dt_s: f64) -> Wanted {
        let l = &self.airframe.limits;
        let cruise = speed.unwrap_or(self.cruise_m_s()).min(self.tuning.horizontal_speed_max_m_s).min(l.forward_m_s).max(0.1);
        let (up, down) = (up.min(l.climb_m_s), down.min(l.descend_m_s));
        let target = self.course.target_m;
        let here = self.estimate.position_m;
        self.status.target_m = Some(target);
        let way = heading_of(target - here, TURN_BEYOND_M);
        let turns = speed.is_some() || self.status.mode != Mode::Hold;
        let yaw = self.look_rad().or(self.course.target_yaw_rad).or(way.filter(|_| turns));
        self.turn_to(yaw, dt_s);
        let wish = towards(&self.gains, here, target, cruise, up, down);
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        Wanted::Fly(self.motion(self.shaper.velocity_m_s))
    }

    pub(super) fn take_off(&mut self, now: SimTime, dt_s: f64) -> Wanted {
        let left = self.estimate.position_m.down() - self.course.target_m.down();
        if left < HEIGHT_REACHED_M && self.status.landed == Landed::InAir {
            let target = self.course.target_m;
            self.watch.intended = Mode::Hold;
            self.enter(Mode::Hold, now);
            self.course.target_m = target;
            self.course.takeoff_up_m = None;
        }
        self.go_within(None, self.tuning.takeoff_speed_m_s, self.tuning.descend_m_s, dt_s)
    }

    pub(super) fn land(&mut self, dt_s: f64) -> Wanted {
        if self.status.landed == Landed::InAir {
            self.status.landed = Landed::Landing;
        }
        if !self.estimate.position_valid {
            return self.sink_blind(dt_s);
        }
        let here = self.estimate.position_m;
        let speed = self.landing_speed();
        self.turn_to(self.course.target_yaw_rad, dt_s);
        let over = Vec3::new(self.course.target_m.north(), self.course.target_m.east(), here.down());
        let flat = towards(&self.gains, here, over, LOCK_SPEED_M_S, 0.0, 0.0);
        let wish = Vec3::new(flat.north(), flat.east(), speed);
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        self.status.target_m = Some(over);
        Wanted::Fly(self.motion(self.shaper.velocity_m_s))
    }

    pub(super) fn landing_speed(&self) -> f64 {
        let home = self.status.home_m.map_or(0.0, |h| h.down());
        let over_home = home - self.estimate.position_m.down();
        let below = self.seen.range_down_m.unwrap_or(over_home) - self.airframe.standing_m;
        let slow = below < self.tuning.land_slow_below_m;
        if slow { self.tuning.land_speed_m_s } else { self.tuning.descend_m_s.min(self.airframe.limits.descend_m_s) }
    }

    /// Level and down: all that is left without position.
    pub(super) fn sink_blind(&mut self, dt_s: f64) -> Wanted {
        if self.status.landed == Landed::InAir {
            self.status.landed = Landed::Landing;
        }
        self.turn_to(None, dt_s);
        let wish = Vec3::new(0.0, 0.0, self.landing_speed());
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        let motion = self.motion(self.shaper.velocity_m_s);
        Wanted::Level { motion, tilt: (0.0, 0.0) }
    }

    pub(super) fn go_home(&mut self, dt_s: f64) -> Wanted {
        let here = self.estimate.position_m;
        let home = self.course.refuge_m.or(self.status.home_m).unwrap_or(here);
        match self.course.phase {
            ReturnPhase::Climb => {
                if (self.course.target_m.down() - here.down()).abs() < HEIGHT_REACHED_M {
                    self.course.phase = ReturnPhase::Cruise;
                }
            }
            ReturnPhase::Cruise => {
                self.course.target_m = Vec3::new(home.north(), home.east(), self.course.target_m.down());
                let speed = self.estimate.velocity_m_s.horizontal_norm();
                if (here - home).horizontal_norm() < 0.5 && speed < 0.5 {
                    self.course.phase = ReturnPhase::Land;
                    let rally = self.status.home_m != Some(home);
                    self.say(Severity::Info, if rally { "Rally point reached, landing" } else { "Home reached, landing" });
                }
            }
            ReturnPhase::Land => {
                self.course.target_m = home;
                return self.land(dt_s);
            }
        }
        self.go(None, dt_s)
    }

    pub(super) fn follow(&mut self, now: SimTime, dt_s: f64) -> Wanted {
        let Some((setpoint, _)) =
            self.links.offboard.filter(|_| self.links.offboard_fresh(self.tuning.offboard_patience_s(), now))
        else {
            return if self.estimate.position_valid { self.go(None, dt_s) } else { self.sink_blind(dt_s) };
        };
        match setpoint.yaw_rate_rad_s {
            Some(rate) if setpoint.yaw_rad.is_none() => self.turn_at(rate, dt_s),
            // Where a set-point leaves the heading open, a command may say it, as in ArduPilot's GUIDED.
            _ => self.turn_to(setpoint.yaw_rad.or(self.course.target_yaw_rad), dt_s),
        }
        if let Some((attitude, thrust)) = setpoint.attitude {
            let thrust_n = (thrust.clamp(0.0, 1.0) * self.gains.thrust_max_n).max(self.gains.thrust_min_n);
            self.contact.wanted_down_m_s = if thrust < 0.1 { self.airframe.limits.descend_m_s } else { 0.0 };
            self.course.yaw_rate_rad_s = 0.0;
            return Wanted::Direct(Pull { attitude, thrust_n });
        }
        if let Some((rates_rad_s, thrust)) = setpoint.rates {
            return self.spin(rates_rad_s, thrust);
        }
        if !self.estimate.position_valid {
            return self.sink_blind(dt_s);
        }
        let wish = self.offboard_velocity(&setpoint);
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        let mut motion = self.motion(self.shaper.velocity_m_s);
        self.accelerate(&setpoint, &mut motion);
        Wanted::Fly(motion)
    }

    fn spin(&mut self, rates_rad_s: Vec3<Frd>, thrust: f64) -> Wanted {
        let thrust_n = (thrust.clamp(0.0, 1.0) * self.gains.thrust_max_n).max(self.gains.thrust_min_n);
        self.contact.wanted_down_m_s = if thrust < 0.1 { self.airframe.limits.descend_m_s } else { 0.0 };
        // Whatever comes after goes on from the nose as it is then.
        self.course.yaw_rad = self.estimate.attitude.yaw_rad();
        Wanted::Spin { rates_rad_s, thrust_n }
    }

    /// Accelerations of a set-point: alone on an axis they are flown, beside a velocity they are fed forward.
    fn accelerate(&mut self, s: &OffboardSetpoint, motion: &mut Motion) {
        let free = |i: usize| s.position_m[i].is_none() && s.velocity_m_s[i].is_none();
        let flat = |i: usize| s.acceleration_m_s2[i].unwrap_or(0.0);
        let level = Vec3::<Ned>::new(flat(0), flat(1), 0.0).limited(self.gains.acceleration_m_s2);
        let most = self.gains.climb_acceleration_m_s2;
        let wish = [level.north(), level.east(), flat(2).clamp(-most, most)];
        let (mut velocity, mut acceleration) = (motion.velocity_m_s.array(), motion.acceleration_m_s2.array());
        let mut planned = self.shaper.velocity_m_s.array();
        let now = self.estimate.velocity_m_s.array();
        for i in (0..3).filter(|i| s.acceleration_m_s2[*i].is_some()) {
            acceleration[i] = wish[i] + if free(i) { 0.0 } else { acceleration[i] };
            if free(i) {
                // No velocity error is left then: the velocity loop compares with where the plan was a lag ago.
                velocity[i] = now[i] + if i < 2 { wish[i] * self.gains.attitude_lag_s } else { 0.0 };
                planned[i] = now[i];
            }
        }
        let vector = |a: [f64; 3]| Vec3::new(a[0], a[1], a[2]);
        (motion.velocity_m_s, motion.acceleration_m_s2) = (vector(velocity), vector(acceleration));
        self.shaper.velocity_m_s = vector(planned);
    }

    /// Position set-points close in, velocity set-points are flown; an axis with both takes the velocity as the speed on the way.
    pub(super) fn offboard_velocity(&mut self, s: &OffboardSetpoint) -> Vec3<Ned> {
        let here = self.estimate.position_m.array();
        let target: [f64; 3] = std::array::from_fn(|i| s.position_m[i].unwrap_or(here[i]));
        let [n, e, d] = target;
        let l = &self.airframe.limits;
        let (top, up, down) = (self.tuning.horizontal_speed_max_m_s.min(l.forward_m_s), l.climb_m_s, l.descend_m_s);
        self.status.target_m = Some(Vec3::new(n, e, d));
        let close = towards(&self.gains, self.estimate.position_m, Vec3::new(n, e, d), top, up, down).array();
        let mix: [f64; 3] = std::array::from_fn(|i| close[i] + s.velocity_m_s[i].unwrap_or(0.0));
        let flat = Vec3::<Ned>::new(mix[0], mix[1], 0.0).limited(top);
        Vec3::new(flat.north(), flat.east(), mix[2].clamp(-up, down))
    }
}
