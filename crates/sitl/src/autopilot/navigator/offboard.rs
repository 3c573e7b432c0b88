//! External setpoints, and following a moving target.

use super::Navigator;
use super::input::NavigatorInput;
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::{heading_of, velocity_toward};
use crate::autopilot::control::velocity::{AttitudeThrustSetpoint, VelocitySetpoint};
use crate::autopilot::external_input::OffboardSetpoint;
use crate::autopilot::flight_state::FlightMode;
use spandrel_model::frames::{Frd, Ned, Vec3};

/// Distance below which the heading no longer tracks the target, m.
const HEADING_MIN_DISTANCE_M: f64 = 0.5;
/// Thrust, 0 to 1, below which a setpoint counts as an intended descent.
const MAX_DESCENT_THRUST: f64 = 0.1;

impl Navigator {
    /// The external setpoint if the mode uses it and it has not timed out.
    pub(super) fn active_setpoint(&self, input: &NavigatorInput) -> Option<OffboardSetpoint> {
        let fresh = self.modes.active == FlightMode::Offboard && input.has_recent_offboard();
        input.links.offboard.filter(|_| fresh).map(|(setpoint, _)| setpoint)
    }

    /// Continues to the position of the last setpoint if it had one; otherwise stops.
    pub fn end_offboard(&mut self, input: &NavigatorInput) {
        self.modes.intended = FlightMode::Hold;
        let paused = self.paused;
        self.enter(FlightMode::Hold, input);
        // A setpoint can time out during a pause.
        self.paused = paused;
        if let Some((OffboardSetpoint { position_m: [Some(n), Some(e), Some(d)], yaw_rad, .. }, _)) = input.links.offboard {
            self.target_m = Vec3::new(n, e, d);
            self.heading.target_rad = yaw_rad;
        }
    }

    /// Tracks the external setpoint. Without one, stops.
    pub(super) fn fly_setpoint(&mut self, input: &NavigatorInput) -> Setpoint {
        let Some(setpoint) = self.active_setpoint(input) else {
            return if input.estimate.position_valid {
                self.fly_to_target(None, input)
            } else {
                self.descend_without_position(input)
            };
        };
        match setpoint.yaw_rate_rad_s {
            Some(rate) if setpoint.yaw_rad.is_none() => {
                if !self.heading.turn_by_pilot(self.modes.active, input) {
                    self.heading.turn_at(rate, input);
                }
            }
            // If a setpoint has no heading, a command can supply it, as in ArduPilot's GUIDED.
            _ => {
                let wanted = setpoint.yaw_rad.or(self.heading.target_rad).or_else(|| self.heading_toward(&setpoint, input));
                self.heading.turn_to(wanted, self.modes.active, input);
            }
        }
        if let Some(up_m_s) = setpoint.climb_m_s {
            return self.climb_at(&setpoint, up_m_s, input);
        }
        if let Some((attitude, thrust)) = setpoint.attitude {
            let (thrust_n, descent_m_s) = direct_thrust(thrust, input);
            self.heading.stop();
            return Setpoint::AttitudeThrust {
                target: AttitudeThrustSetpoint { attitude, thrust_n },
                descent_rate_m_s: descent_m_s,
            };
        }
        if let Some((rates_rad_s, thrust)) = setpoint.rates {
            return self.fly_rates(rates_rad_s, thrust, input);
        }
        if !input.estimate.position_valid {
            return self.descend_without_position(input);
        }
        let velocity_m_s = self.offboard_velocity(&setpoint, input);
        self.shaper.advance(velocity_m_s, &self.auto_limits(input), input.dt_s);
        let mut motion = self.motion(self.shaper.velocity_m_s);
        self.apply_acceleration_setpoints(&setpoint, &mut motion, input);
        Setpoint::Velocity(motion)
    }

    /// Heading during the approach to a position target without a heading, rad.
    fn heading_toward(&self, setpoint: &OffboardSetpoint, input: &NavigatorInput) -> Option<f64> {
        let [Some(n), Some(e), Some(d)] = setpoint.position_m else { return None };
        let travels = input.tuning.setpoint_end_is_normal && setpoint.velocity_m_s == [None; 3];
        travels.then(|| self.heading_by_rule(Vec3::new(n, e, d), input)).flatten()
    }

    /// Tracks an attitude or body rates with a climb rate instead of thrust (ArduCopter).
    fn climb_at(&mut self, setpoint: &OffboardSetpoint, up_m_s: f64, input: &NavigatorInput) -> Setpoint {
        let velocity_m_s = Vec3::new(0.0, 0.0, -up_m_s);
        self.shaper.advance(velocity_m_s, &self.auto_limits(input), input.dt_s);
        let motion = self.motion(self.shaper.velocity_m_s);
        if let Some((attitude, _)) = setpoint.attitude {
            let (roll, pitch, yaw) = attitude.euler();
            self.heading.yaw_rad = yaw;
            let motion = VelocitySetpoint { yaw_rad: yaw, ..motion };
            return Setpoint::Level { motion, tilt: (roll, pitch) };
        }
        let rates_rad_s = setpoint.rates.map_or(Vec3::zero(), |(rates, _)| rates);
        self.heading.yaw_rad = input.estimate.attitude.yaw_rad();
        Setpoint::RatesAndClimb { rates_rad_s, motion, descent_rate_m_s: -up_m_s }
    }

    /// Tracks body rates and thrust.
    fn fly_rates(&mut self, rates_rad_s: Vec3<Frd>, thrust: f64, input: &NavigatorInput) -> Setpoint {
        let (thrust_n, descent_m_s) = direct_thrust(thrust, input);
        // The next mode continues from the current heading.
        self.heading.yaw_rad = input.estimate.attitude.yaw_rad();
        Setpoint::Rates { rates_rad_s, thrust_n, descent_rate_m_s: descent_m_s }
    }

    /// Applies acceleration setpoints: directly on axes without a position or velocity, and as feedforward on the
    /// others.
    fn apply_acceleration_setpoints(&mut self, s: &OffboardSetpoint, motion: &mut VelocitySetpoint, input: &NavigatorInput) {
        let free = |i: usize| s.position_m[i].is_none() && s.velocity_m_s[i].is_none();
        let flat = |i: usize| s.acceleration_m_s2[i].unwrap_or(0.0);
        let level = Vec3::<Ned>::new(flat(0), flat(1), 0.0).limited(input.gains.acceleration_m_s2);
        let max_m_s2 = input.gains.climb_acceleration_m_s2;
        let wanted = [level.north(), level.east(), flat(2).clamp(-max_m_s2, max_m_s2)];
        let (mut velocity, mut acceleration) = (motion.velocity_m_s.array(), motion.acceleration_m_s2.array());
        let mut planned = self.shaper.velocity_m_s.array();
        let current = input.estimate.velocity_m_s.array();
        for i in (0..3).filter(|i| s.acceleration_m_s2[*i].is_some()) {
            acceleration[i] = wanted[i] + if free(i) { 0.0 } else { acceleration[i] };
            if free(i) {
                // This leaves no velocity error, because the velocity loop compares with the plan as it was one lag
                // earlier.
                velocity[i] = current[i] + if i < 2 { wanted[i] * input.gains.attitude_lag_s } else { 0.0 };
                planned[i] = current[i];
            }
        }
        let vector = |a: [f64; 3]| Vec3::new(a[0], a[1], a[2]);
        (motion.velocity_m_s, motion.acceleration_m_s2) = (vector(velocity), vector(acceleration));
        self.shaper.velocity_m_s = vector(planned);
    }

    /// Velocity for an external setpoint. An axis with a position approaches it, an axis with only a velocity uses it
    /// directly, and an axis with both uses the velocity as the approach speed.
    fn offboard_velocity(&mut self, s: &OffboardSetpoint, input: &NavigatorInput) -> Vec3<Ned> {
        let here = input.here().array();
        let target: [f64; 3] = std::array::from_fn(|i| s.position_m[i].unwrap_or(here[i]));
        let [n, e, d] = target;
        let l = &input.airframe.limits;
        let (top, up, down) = (input.tuning.horizontal_speed_max_m_s.min(l.forward_m_s), l.climb_m_s, l.descend_m_s);
        self.report.target_m = Some(Vec3::new(n, e, d));
        let close = velocity_toward(input.gains, input.here(), Vec3::new(n, e, d), top, up, down).array();
        let mix: [f64; 3] = std::array::from_fn(|i| close[i] + s.velocity_m_s[i].unwrap_or(0.0));
        let flat = Vec3::<Ned>::new(mix[0], mix[1], 0.0).limited(top);
        Vec3::new(flat.north(), flat.east(), mix[2].clamp(-up, down))
    }

    /// Maintains the configured position relative to the target and points the nose at it. Holds position if there is
    /// no target.
    pub(super) fn follow_target(&mut self, input: &NavigatorInput) -> Setpoint {
        let Some(target) = self.follower.target(&input.tuning.follow, input.here(), input.tuning.client_speed_factor, input.now)
        else {
            return self.fly_to_target(None, input);
        };
        let here = input.here();
        let place = self.follower.desired_position(&target, &input.tuning.follow, here, self.home.position_m);
        // If the target is lost, the vehicle holds here.
        self.target_m = here;
        let yaw =
            self.region_of_interest_heading_rad(input).or_else(|| heading_of(target.position_m - here, HEADING_MIN_DISTANCE_M));
        self.heading.turn_to(yaw, self.modes.active, input);
        let setpoint = OffboardSetpoint {
            position_m: place.array().map(Some),
            velocity_m_s: target.velocity_m_s.array().map(Some),
            ..OffboardSetpoint::default()
        };
        let velocity_m_s = self.offboard_velocity(&setpoint, input);
        let flat = Vec3::<Ned>::new(velocity_m_s.north(), velocity_m_s.east(), 0.0).limited(input.tuning.follow.max_speed_m_s);
        self.shaper.advance(Vec3::new(flat.north(), flat.east(), velocity_m_s.down()), &self.auto_limits(input), input.dt_s);
        Setpoint::Velocity(self.motion(self.shaper.velocity_m_s))
    }
}

/// Thrust, N, of a setpoint specified as a fraction of the maximum thrust, and the intended descent rate, m/s.
fn direct_thrust(share: f64, input: &NavigatorInput) -> (f64, f64) {
    let descent_m_s = if share < MAX_DESCENT_THRUST { input.airframe.limits.descend_m_s } else { 0.0 };
    ((share.clamp(0.0, 1.0) * input.gains.thrust_max_n).max(input.gains.thrust_min_n), descent_m_s)
}
