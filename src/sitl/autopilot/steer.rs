//! What each mode wants: attitude and thrust for this step.

use super::control::AttitudeTarget;
use super::guidance::{DEAD_BAND, Guidance};
use super::mission::Wanted;
use super::pilot::Autopilot;
use super::{Estimate, Landed, Mode, Ned, OffboardSetpoint, Sticks, Vec3};
use crate::base::math;
use crate::base::time::SimTime;

/// Height over home from which a landing slows down, m (PX4: MPC_LAND_ALT2).
const SLOW_BELOW_M: f64 = 5.0;
/// A return lands when it is this near to home, m.
const HOME_M: f64 = 1.0;

impl Autopilot {
    pub(super) fn steer(&mut self, e: &Estimate, now: SimTime, dt_s: f64) -> AttitudeTarget {
        // Without a position, what needs one falls back to holding the height by tilt.
        match self.mode {
            Mode::Stabilized => self.by_tilt(now, dt_s, None),
            Mode::Altitude => self.by_tilt(now, dt_s, Some(e)),
            Mode::Position if e.position_valid => self.by_position(e, now, dt_s),
            Mode::Position => self.by_tilt(now, dt_s, Some(e)),
            Mode::Land => self.land(e, dt_s),
            _ if !e.position_valid => self.by_tilt(now, dt_s, Some(e)),
            Mode::Hold => self.hold(e, dt_s),
            Mode::Takeoff => self.climb(e, dt_s),
            Mode::Return => self.go_home(e, dt_s),
            Mode::Mission => self.fly_mission(e, now, dt_s),
            Mode::Offboard => self.fly_offboard(e, now, dt_s),
        }
    }

    fn turn_by_stick(&mut self, sticks: &Sticks, dt_s: f64) -> f64 {
        if sticks.yaw.abs() < DEAD_BAND {
            return 0.0;
        }
        let rate = sticks.yaw * self.vehicle.limits.yaw_rate_rad_s;
        self.yaw_rad = math::wrap_pi(self.yaw_rad + rate * dt_s);
        // The set-point never runs far ahead of the nose.
        let nose = self.estimate().attitude.yaw_rad();
        self.yaw_rad = math::wrap_pi(nose + math::wrap_pi(self.yaw_rad - nose).clamp(-0.6, 0.6));
        rate
    }

    /// Sticks as roll and pitch angles; with an estimate the height is held, without it the stick is thrust.
    fn by_tilt(&mut self, now: SimTime, dt_s: f64, hold: Option<&Estimate>) -> AttitudeTarget {
        let sticks = self.fresh_sticks(now).unwrap_or_default();
        let rate = self.turn_by_stick(&sticks, dt_s);
        let limit = self.vehicle.limits.tilt_rad;
        let (roll, pitch) = (sticks.right * limit, -sticks.forward * limit);
        let thrust_n = match hold {
            None => self.control.hover_n() * (1.0 + 0.8 * sticks.up),
            Some(e) => {
                let reach = self.reach();
                let limits = self.vehicle.limits;
                let down = self.guidance.climb_by_stick(&sticks, e, &limits, &reach);
                let level = Vec3::new(e.velocity_m_s.north(), e.velocity_m_s.east(), 0.0);
                let (velocity, ahead) = self.guidance.slew(level + Vec3::new(0.0, 0.0, down), &reach, dt_s);
                let ahead = Vec3::new(0.0, 0.0, ahead.down());
                let lift = self.control.velocity(e, level + Vec3::new(0.0, 0.0, velocity.down()), ahead, self.yaw_rad, 0.0, dt_s);
                lift.thrust_n
            }
        };
        self.control.tilted(roll, pitch, self.yaw_rad, rate, thrust_n)
    }

    fn by_position(&mut self, e: &Estimate, now: SimTime, dt_s: f64) -> AttitudeTarget {
        let sticks = self.fresh_sticks(now).unwrap_or_default();
        let rate = self.turn_by_stick(&sticks, dt_s);
        let (limits, reach) = (self.vehicle.limits, self.reach());
        let nose = e.attitude.yaw_rad();
        let wanted = self.guidance.by_sticks(&sticks, e, nose, &limits, &reach);
        self.follow(e, wanted, rate, dt_s)
    }

    fn follow(&mut self, e: &Estimate, wanted_m_s: Vec3<Ned>, yaw_rate: f64, dt_s: f64) -> AttitudeTarget {
        let reach = self.reach();
        let (velocity, ahead) = self.guidance.slew(wanted_m_s, &reach, dt_s);
        self.control.velocity(e, velocity, ahead, self.yaw_rad, yaw_rate, dt_s)
    }

    fn towards(&mut self, e: &Estimate, target_m: Vec3<Ned>, dt_s: f64) -> AttitudeTarget {
        let wanted = Guidance::towards(target_m, e, self.speed_m_s, &self.vehicle.limits, &self.reach());
        self.follow(e, wanted, 0.0, dt_s)
    }

    fn hold(&mut self, e: &Estimate, dt_s: f64) -> AttitudeTarget {
        let target = *self.target_m.get_or_insert(e.position_m);
        self.towards(e, target, dt_s)
    }

    fn climb(&mut self, e: &Estimate, dt_s: f64) -> AttitudeTarget {
        let target = self.target_m.unwrap_or(e.position_m);
        let wanted = Guidance::towards(target, e, 1.0, &self.vehicle.limits, &self.reach());
        let up = wanted.down().max(-self.tuning.takeoff_speed_m_s);
        self.follow(e, Vec3::new(wanted.north(), wanted.east(), up), 0.0, dt_s)
    }

    fn land(&mut self, e: &Estimate, dt_s: f64) -> AttitudeTarget {
        if self.landed != Landed::OnGround {
            self.landed = Landed::Landing;
        }
        let target = *self.target_m.get_or_insert(e.position_m);
        let home = self.home_m.unwrap_or(e.position_m);
        let over = home.down() - e.position_m.down();
        let fast = (self.vehicle.limits.descend_m_s * 0.75).max(self.tuning.land_speed_m_s);
        let sink = if over > SLOW_BELOW_M { fast } else { self.tuning.land_speed_m_s };
        let level = if e.position_valid {
            Guidance::towards(target, e, 2.0, &self.vehicle.limits, &self.reach())
        } else {
            e.velocity_m_s
        };
        self.follow(e, Vec3::new(level.north(), level.east(), sink), 0.0, dt_s)
    }

    /// First up, then over, then down.
    fn go_home(&mut self, e: &Estimate, dt_s: f64) -> AttitudeTarget {
        let target = self.target_m.unwrap_or(e.position_m);
        let low = e.position_m.down() - target.down() > 1.0;
        let aim = if low { Vec3::new(e.position_m.north(), e.position_m.east(), target.down()) } else { target };
        let level = Vec3::<Ned>::new(target.north() - e.position_m.north(), target.east() - e.position_m.east(), 0.0);
        if !low && level.norm() < HOME_M {
            self.target_m = Some(target);
            self.mode = Mode::Land;
        }
        self.towards(e, aim, dt_s)
    }

    fn fly_mission(&mut self, e: &Estimate, now: SimTime, dt_s: f64) -> AttitudeTarget {
        match self.mission.step(e, now) {
            Wanted::Point { position_m, yaw_rad } => {
                self.target_m = Some(position_m);
                let ahead = position_m - e.position_m;
                match yaw_rad {
                    Some(yaw) => self.yaw_rad = yaw,
                    None if ahead.horizontal_norm() > 2.0 => self.yaw_rad = math::atan2(ahead.east(), ahead.north()),
                    None => {}
                }
                self.towards(e, position_m, dt_s)
            }
            Wanted::Climb { up_m } => {
                let here = self.target_m.filter(|t| (t.down() + up_m).abs() < 1e-6).unwrap_or(e.position_m);
                self.target_m = Some(Vec3::new(here.north(), here.east(), -up_m));
                self.climb(e, dt_s)
            }
            Wanted::Speed(speed) => {
                self.speed_m_s = speed.clamp(0.1, self.vehicle.limits.forward_m_s);
                self.hold(e, dt_s)
            }
            Wanted::Land => {
                self.target_m = None;
                self.enter(Mode::Land);
                self.land(e, dt_s)
            }
            Wanted::Return => {
                self.enter(Mode::Return);
                self.go_home(e, dt_s)
            }
            Wanted::Stay => self.hold(e, dt_s),
            Wanted::Done => {
                self.enter(Mode::Hold);
                self.hold(e, dt_s)
            }
        }
    }

    fn fly_offboard(&mut self, e: &Estimate, now: SimTime, dt_s: f64) -> AttitudeTarget {
        let Some(setpoint) = self.fresh_offboard(now) else {
            self.enter(Mode::Hold);
            return self.hold(e, dt_s);
        };
        if let Some((attitude, thrust)) = setpoint.attitude {
            let thrust_n = thrust.clamp(0.0, 1.0) * self.control.hover_n() * 2.0;
            return AttitudeTarget { attitude, yaw_rate_rad_s: setpoint.yaw_rate_rad_s.unwrap_or(0.0), thrust_n };
        }
        let rate = setpoint.yaw_rate_rad_s.unwrap_or(0.0);
        self.yaw_rad = setpoint.yaw_rad.unwrap_or_else(|| math::wrap_pi(self.yaw_rad + rate * dt_s));
        let wanted = offboard_velocity(&setpoint, e, &self.reach(), self.speed_m_s, &self.vehicle.limits);
        self.follow(e, wanted, rate, dt_s)
    }
}

/// Position set-points as velocity towards them, plus velocity set-points as they are.
fn offboard_velocity(
    setpoint: &OffboardSetpoint,
    e: &Estimate,
    reach: &super::guidance::Reach,
    speed_m_s: f64,
    limits: &crate::vehicle::FlightLimits,
) -> Vec3<Ned> {
    let here = e.position_m.array();
    let at = |k: usize| setpoint.position_m[k].unwrap_or(here[k]);
    let towards = Guidance::towards(Vec3::new(at(0), at(1), at(2)), e, speed_m_s, limits, reach).array();
    let axis = |k: usize| match (setpoint.position_m[k], setpoint.velocity_m_s[k]) {
        (Some(_), extra) => towards[k] + extra.unwrap_or(0.0),
        (None, Some(velocity)) => velocity,
        (None, None) => 0.0,
    };
    let level = Vec3::<Ned>::new(axis(0), axis(1), 0.0).limited(limits.forward_m_s);
    level + Vec3::new(0.0, 0.0, axis(2).clamp(-limits.climb_m_s, limits.descend_m_s))
}
