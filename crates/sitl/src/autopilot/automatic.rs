//! Hold, go-to, take-off, landing, return and external setpoints.

use super::core::{Autopilot, Severity};
use super::manual::LOCK_SPEED_M_S;
use super::modes::{ReturnPhase, Setpoint};
use super::operator_rules::HeadingRule;
use super::shaper::{CALM_JERK_S, JERK_S, MotionLimits, heading_of, towards};
use super::velocity::{AttitudeThrustSetpoint, VelocitySetpoint};
use super::{FlightMode, LandedState, MissionStep, OffboardSetpoint, TurnCommand};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Fraction of the full yaw rate used in automatic modes, and the gain on heading errors, 1/s.
const AUTO_YAW_SHARE: f64 = 0.7;
const AUTO_YAW_GAIN: f64 = 1.5;
/// Tolerance for reaching a height, m.
pub(super) const HEIGHT_REACHED_M: f64 = 0.4;
/// Height above ground up to which a take-off uses its own climb rate, m (PX4: MPC_LAND_ALT1).
const TAKEOFF_SLOW_BELOW_M: f64 = 10.0;
/// Minimum climb of a take-off from the ground, m (ArduCopter's AUTO).
const TAKEOFF_LEAST_M: f64 = 1.0;
/// Remaining turn that always takes the shorter direction, rad (5 degrees, estimate: more than the heading overshoots).
const NEARLY_TURNED_RAD: f64 = 0.087;
/// Distance to the target above which the nose turns toward it, m.
pub(super) const TURN_BEYOND_M: f64 = 2.0;
/// Speed above which the nose turns along the path, m/s (estimate: well above the estimator's noise).
const TURN_ABOVE_M_S: f64 = 1.0;

impl Autopilot {
    /// Applies the yaw stick in GUIDED (ArduCopter, unless `GUID_OPTIONS` disables it). Returns false if the stick does not
    /// control the heading.
    fn pilot_turns(&mut self, dt_s: f64) -> bool {
        let guided =
            self.links.guided && matches!(self.status.mode, FlightMode::Hold | FlightMode::Takeoff | FlightMode::Offboard);
        let fresh = self.links.sticks_fresh(self.tuning.manual_timeout_s(), self.last_step);
        if guided && self.tuning.rules.guided.pilot_yaw && fresh && self.links.sticks.yaw != 0.0 {
            (self.navigator.target_yaw_rad, self.navigator.turn, self.navigator.turned_by_pilot) = (None, None, true);
            self.stick_yaw(dt_s);
        } else if self.navigator.turned_by_pilot {
            self.turn_at(0.0, dt_s);
        }
        self.navigator.turned_by_pilot
    }

    pub(super) fn turn_to(&mut self, yaw: Option<f64>, dt_s: f64) {
        if self.pilot_turns(dt_s) {
            return;
        }
        let own = AUTO_YAW_SHARE * self.airframe.limits.yaw_rate_rad_s;
        let turn = self.navigator.turn.filter(|turn| yaw == Some(turn.yaw_rad));
        let Some(yaw) = yaw else {
            self.turn_at(0.0, dt_s);
            return;
        };
        let limit = turn.and_then(|turn| turn.rate_rad_s).map_or(own, |rate| rate.min(self.airframe.limits.yaw_rate_rad_s));
        let left = math::wrap_pi(yaw - self.navigator.yaw_rad);
        let left = turn.map_or(left, |turn| self.detour(turn, left));
        self.navigator.heading_free = false;
        self.advance_heading((AUTO_YAW_GAIN * left).clamp(-limit, limit), dt_s);
    }

    /// Remaining turn in the commanded direction, rad. Close to the target heading, the shorter direction applies.
    fn detour(&mut self, turn: TurnCommand, left: f64) -> f64 {
        let long_way = turn.clockwise.is_some_and(|clockwise| clockwise != (left > 0.0));
        if left.abs() < NEARLY_TURNED_RAD {
            self.navigator.turn = Some(TurnCommand { clockwise: None, ..turn });
            return left;
        }
        if long_way { left - 2.0 * math::PI * left.signum() } else { left }
    }

    pub(super) fn motion(&self, velocity_m_s: Vec3<Ned>) -> VelocitySetpoint {
        VelocitySetpoint { velocity_m_s, acceleration_m_s2: self.shaper.acceleration_m_s2, yaw_rad: self.navigator.yaw_rad }
    }

    pub(super) fn auto_limits(&self) -> MotionLimits {
        let (own, set) = (self.airframe_auto_limits(), &self.tuning.rules.envelope);
        MotionLimits {
            horizontal_m_s2: own.horizontal_m_s2.min(set.acceleration_m_s2),
            vertical_m_s2: own.vertical_m_s2.min(set.climb_acceleration_m_s2),
            ..own
        }
    }

    pub(super) fn airframe_auto_limits(&self) -> MotionLimits {
        let (horizontal_m_s2, vertical_m_s2) = (0.7 * self.gains.acceleration_m_s2, 0.7 * self.gains.climb_acceleration_m_s2);
        MotionLimits { horizontal_m_s2, vertical_m_s2, build_up_s: JERK_S }
    }

    /// Motion limits on the way to a target. Missions and returns build up acceleration gently. A pause brakes as
    /// `stopping_point` assumes.
    fn travel_limits(&self) -> MotionLimits {
        let calm = matches!(self.status.mode, FlightMode::Mission | FlightMode::Return) && self.navigator.paused.is_none();
        MotionLimits { build_up_s: if calm { CALM_JERK_S } else { JERK_S }, ..self.auto_limits() }
    }

    /// Flies to the navigator's target and holds there.
    pub(super) fn go(&mut self, speed: Option<f64>, dt_s: f64) -> Setpoint {
        let (up, down) = (self.tuning.climb_m_s, self.tuning.descend_m_s);
        self.fly_within_limits(speed, up, down, dt_s)
    }

    pub(super) fn fly_within_limits(&mut self, speed: Option<f64>, up: f64, down: f64, dt_s: f64) -> Setpoint {
        let l = &self.airframe.limits;
        let cruise = speed.unwrap_or(self.cruise_m_s()).min(self.tuning.horizontal_speed_max_m_s).min(l.forward_m_s).max(0.1);
        let (up, down) = (up.min(l.climb_m_s), down.min(l.descend_m_s));
        let target = self.navigator.target_m;
        let here = self.estimate.position_m;
        self.status.target_m = Some(target);
        let way = self.heading_by_rule(target);
        let turns = speed.is_some() || self.status.mode != FlightMode::Hold;
        let yaw = self.look_rad().or(self.navigator.target_yaw_rad).or(way.filter(|_| turns));
        self.turn_to(yaw, dt_s);
        let wish = towards(&self.gains, here, target, cruise, up, down);
        self.shaper.advance(wish, &self.travel_limits(), dt_s);
        Setpoint::Velocity(self.motion(self.shaper.velocity_m_s))
    }

    /// Heading from the configured heading rule, rad, if the rule gives one.
    fn heading_by_rule(&self, target_m: Vec3<Ned>) -> Option<f64> {
        let here = self.estimate.position_m;
        let home = self.status.home_m.unwrap_or(here);
        let returning = self.status.mode == FlightMode::Return
            || self.status.mode == FlightMode::Mission && self.mission.step() == Some(MissionStep::Return);
        match self.tuning.rules.heading {
            HeadingRule::TargetExceptReturn if returning => None,
            HeadingRule::Target | HeadingRule::TargetExceptReturn => heading_of(target_m - here, TURN_BEYOND_M),
            HeadingRule::Home => heading_of(home - here, TURN_BEYOND_M),
            HeadingRule::AwayFromHome => heading_of(here - home, TURN_BEYOND_M),
            HeadingRule::Path => heading_of(self.estimate.velocity_m_s, TURN_ABOVE_M_S),
            HeadingRule::Fixed => None,
        }
    }

    pub(super) fn take_off(&mut self, now: SimTime, dt_s: f64) -> Setpoint {
        let left = self.estimate.position_m.down() - self.navigator.target_m.down();
        if left < HEIGHT_REACHED_M && self.status.landed == LandedState::InAir {
            let target = self.navigator.target_m;
            self.failsafe.intended = FlightMode::Hold;
            self.enter(FlightMode::Hold, now);
            self.navigator.target_m = target;
            self.navigator.takeoff_up_m = None;
        }
        let wanted = self.climb_away(None, dt_s);
        self.status.climbing_out = self.status.mode == FlightMode::Takeoff;
        wanted
    }

    /// Climbs to the take-off height at the take-off rate.
    pub(super) fn climb_away(&mut self, speed: Option<f64>, dt_s: f64) -> Setpoint {
        self.status.climbing_out = true;
        let up = self.navigator.ground_down_m - self.estimate.position_m.down();
        let slow = !self.tuning.takeoff_at_climb_speed && up < TAKEOFF_SLOW_BELOW_M;
        let rate = if slow { self.tuning.takeoff_speed_m_s.min(self.tuning.climb_m_s) } else { self.tuning.climb_m_s };
        self.fly_within_limits(speed, rate, self.tuning.descend_m_s, dt_s)
    }

    /// Returns the take-off height, m above the origin. From the ground it is at least high enough to lift off.
    pub(super) fn above_ground(&self, up_m: f64) -> f64 {
        let standing = matches!(self.status.landed, LandedState::OnGround | LandedState::TakingOff);
        if standing { up_m.max(TAKEOFF_LEAST_M - self.estimate.position_m.down()) } else { up_m }
    }

    pub(super) fn land(&mut self, dt_s: f64) -> Setpoint {
        if self.status.landed == LandedState::InAir {
            self.status.landed = LandedState::Landing;
        }
        if !self.estimate.position_valid {
            return self.descend_without_position(dt_s);
        }
        let here = self.estimate.position_m;
        let speed = self.landing_speed();
        self.turn_to(self.navigator.target_yaw_rad, dt_s);
        let over = Vec3::new(self.navigator.target_m.north(), self.navigator.target_m.east(), here.down());
        let flat = towards(&self.gains, here, over, LOCK_SPEED_M_S, 0.0, 0.0);
        let wish = Vec3::new(flat.north(), flat.east(), speed);
        self.shaper.advance(wish, &self.travel_limits(), dt_s);
        self.status.target_m = Some(over);
        Setpoint::Velocity(self.motion(self.shaper.velocity_m_s))
    }

    pub(super) fn landing_speed(&self) -> f64 {
        let home = self.status.home_m.map_or(0.0, |h| h.down());
        let over_home = home - self.estimate.position_m.down();
        let below = self.unfused.range_down_m.unwrap_or(over_home) - self.airframe.standing_m;
        let slow = below < self.tuning.land_slow_below_m;
        if slow {
            return self.tuning.land_speed_m_s;
        }
        let set = self.tuning.rules.envelope.landing_m_s;
        let wanted = if set.is_finite() { set } else { self.tuning.descend_m_s };
        wanted.min(self.airframe.limits.descend_m_s)
    }

    /// Descends level without horizontal position control, for flight without a position estimate.
    pub(super) fn descend_without_position(&mut self, dt_s: f64) -> Setpoint {
        if self.status.landed == LandedState::InAir {
            self.status.landed = LandedState::Landing;
        }
        self.turn_to(None, dt_s);
        let wish = Vec3::new(0.0, 0.0, self.landing_speed());
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        let motion = self.motion(self.shaper.velocity_m_s);
        Setpoint::Level { motion, tilt: (0.0, 0.0) }
    }

    pub(super) fn go_home(&mut self, dt_s: f64) -> Setpoint {
        let here = self.estimate.position_m;
        let home = self.navigator.return_target_m.or(self.status.home_m).unwrap_or(here);
        match self.navigator.phase {
            ReturnPhase::Climb => {
                if (self.navigator.target_m.down() - here.down()).abs() < HEIGHT_REACHED_M {
                    self.navigator.phase = ReturnPhase::Cruise;
                }
            }
            ReturnPhase::Cruise => {
                self.navigator.target_m = Vec3::new(home.north(), home.east(), self.navigator.target_m.down());
                let speed = self.estimate.velocity_m_s.horizontal_norm();
                if (here - home).horizontal_norm() < 0.5 && speed < 0.5 {
                    self.arrive_home(home);
                }
            }
            ReturnPhase::Wait => self.wait_over_home(home),
            ReturnPhase::Stay => {}
            ReturnPhase::Land => {
                self.navigator.target_m = home;
                return self.land(dt_s);
            }
        }
        self.go(self.tuning.rules.homeward.speed_m_s.or(Some(self.cruise_m_s())), dt_s)
    }

    /// Handles arrival over the return target: waits there or lands.
    fn arrive_home(&mut self, home: Vec3<Ned>) {
        let rules = self.tuning.rules.homeward;
        let waits = rules.wait_s != 0.0 || rules.final_height_m > 0.0;
        let place = if self.status.home_m == Some(home) { "Home" } else { "Rally point" };
        self.push_event(Severity::Info, format!("{place} reached, {}", if waits { "waiting" } else { "landing" }));
        self.navigator.phase = if waits { ReturnPhase::Wait } else { ReturnPhase::Land };
        self.navigator.wait_until = None;
        if let Some(height_m) = rules.wait_height_m.filter(|_| waits) {
            let down = self.estimate.position_m.down().max(home.down() - height_m);
            self.navigator.target_m = Vec3::new(home.north(), home.east(), down);
        }
    }

    fn wait_over_home(&mut self, home: Vec3<Ned>) {
        let rules = self.tuning.rules.homeward;
        if rules.turns_back {
            self.navigator.target_yaw_rad = self.failsafe.armed_yaw_rad;
        }
        if (self.navigator.target_m.down() - self.estimate.position_m.down()).abs() > HEIGHT_REACHED_M || rules.wait_s < 0.0 {
            return;
        }
        let until = *self.navigator.wait_until.get_or_insert(self.last_step + SimTime::from_s(rules.wait_s));
        if self.last_step < until {
            return;
        }
        if rules.final_height_m > 0.0 {
            self.navigator.phase = ReturnPhase::Stay;
            let down = self.estimate.position_m.down().max(home.down() - rules.final_height_m);
            self.navigator.target_m = Vec3::new(home.north(), home.east(), down);
            self.push_event(Severity::Info, "Holding at final height");
        } else {
            self.navigator.phase = ReturnPhase::Land;
            self.push_event(Severity::Info, "Landing");
        }
    }

    /// The external setpoint, if the mode uses it and it has not timed out.
    pub(super) fn setpoint_flown(&self, now: SimTime) -> Option<OffboardSetpoint> {
        let fresh = self.status.mode == FlightMode::Offboard && self.links.offboard_fresh(self.tuning.offboard_timeout_s(), now);
        self.links.offboard.filter(|_| fresh).map(|(setpoint, _)| setpoint)
    }

    pub(super) fn fly_setpoint(&mut self, now: SimTime, dt_s: f64) -> Setpoint {
        let Some(setpoint) = self.setpoint_flown(now) else {
            return if self.estimate.position_valid { self.go(None, dt_s) } else { self.descend_without_position(dt_s) };
        };
        match setpoint.yaw_rate_rad_s {
            Some(rate) if setpoint.yaw_rad.is_none() => {
                if !self.pilot_turns(dt_s) {
                    self.turn_at(rate, dt_s);
                }
            }
            // If a setpoint has no heading, a command can supply it, as in ArduPilot's GUIDED.
            _ => {
                let wanted = setpoint.yaw_rad.or(self.navigator.target_yaw_rad).or_else(|| self.heading_towards(&setpoint));
                self.turn_to(wanted, dt_s);
            }
        }
        if let Some(up_m_s) = setpoint.climb_m_s {
            return self.climb_at(&setpoint, up_m_s, dt_s);
        }
        if let Some((attitude, thrust)) = setpoint.attitude {
            let thrust_n = self.direct_thrust_n(thrust);
            self.navigator.yaw_rate_rad_s = 0.0;
            return Setpoint::AttitudeThrust(AttitudeThrustSetpoint { attitude, thrust_n });
        }
        if let Some((rates_rad_s, thrust)) = setpoint.rates {
            return self.spin(rates_rad_s, thrust);
        }
        if !self.estimate.position_valid {
            return self.descend_without_position(dt_s);
        }
        let wish = self.offboard_velocity(&setpoint);
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        let mut motion = self.motion(self.shaper.velocity_m_s);
        self.accelerate(&setpoint, &mut motion);
        Setpoint::Velocity(motion)
    }

    /// Heading on the way to a position target without a heading, rad.
    fn heading_towards(&self, setpoint: &OffboardSetpoint) -> Option<f64> {
        let [Some(n), Some(e), Some(d)] = setpoint.position_m else { return None };
        let errand = self.tuning.setpoints_end && setpoint.velocity_m_s == [None; 3];
        errand.then(|| self.heading_by_rule(Vec3::new(n, e, d))).flatten()
    }

    /// Tracks an attitude or body rates with a climb rate instead of thrust (ArduCopter).
    fn climb_at(&mut self, setpoint: &OffboardSetpoint, up_m_s: f64, dt_s: f64) -> Setpoint {
        let wish = Vec3::new(0.0, 0.0, -up_m_s);
        self.shaper.advance(wish, &self.auto_limits(), dt_s);
        let motion = self.motion(self.shaper.velocity_m_s);
        if let Some((attitude, _)) = setpoint.attitude {
            let (roll, pitch, yaw) = attitude.euler();
            self.navigator.yaw_rad = yaw;
            let motion = VelocitySetpoint { yaw_rad: yaw, ..motion };
            return Setpoint::Level { motion, tilt: (roll, pitch) };
        }
        let (mass_kg, rates) = (self.airframe.mass_kg, setpoint.rates.map_or(Vec3::zero(), |(rates, _)| rates));
        let level = self.velocity_loop.fly_level(&self.gains, mass_kg, &self.estimate, &motion, (0.0, 0.0), dt_s);
        self.landing_detector.wanted_down_m_s = -up_m_s;
        self.navigator.yaw_rad = self.estimate.attitude.yaw_rad();
        Setpoint::Spin { rates_rad_s: rates, thrust_n: level.thrust_n }
    }

    /// Thrust of a setpoint given as a fraction of the maximum, N. Near-zero thrust counts as an intended descent.
    fn direct_thrust_n(&mut self, share: f64) -> f64 {
        self.landing_detector.wanted_down_m_s = if share < 0.1 { self.airframe.limits.descend_m_s } else { 0.0 };
        (share.clamp(0.0, 1.0) * self.gains.thrust_max_n).max(self.gains.thrust_min_n)
    }

    fn spin(&mut self, rates_rad_s: Vec3<Frd>, thrust: f64) -> Setpoint {
        let thrust_n = self.direct_thrust_n(thrust);
        // The next mode continues from the current heading.
        self.navigator.yaw_rad = self.estimate.attitude.yaw_rad();
        Setpoint::Spin { rates_rad_s, thrust_n }
    }

    /// Applies acceleration setpoints: flown directly on axes without position or velocity, otherwise fed forward.
    fn accelerate(&mut self, s: &OffboardSetpoint, motion: &mut VelocitySetpoint) {
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
                // Leaves no velocity error: the velocity loop compares with the plan one lag earlier.
                velocity[i] = now[i] + if i < 2 { wish[i] * self.gains.attitude_lag_s } else { 0.0 };
                planned[i] = now[i];
            }
        }
        let vector = |a: [f64; 3]| Vec3::new(a[0], a[1], a[2]);
        (motion.velocity_m_s, motion.acceleration_m_s2) = (vector(velocity), vector(acceleration));
        self.shaper.velocity_m_s = vector(planned);
    }

    /// Velocity for an external setpoint. Axes with a position approach it, axes with only a velocity use it directly, and axes
    /// with both use the velocity as the approach speed.
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
