//! Flight to a target, takeoff and landing.

use super::Navigator;
use super::input::NavigatorInput;
use super::mission_step::MissionStep;
use crate::autopilot::control::landed::FlightPhase;
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::{
    ACCELERATION_RAMP_S, AUTO_ACCELERATION_RAMP_S, MotionLimits, heading_of, velocity_toward,
};
use crate::autopilot::control::velocity::VelocitySetpoint;
use crate::autopilot::failsafe::operator_rules::HeadingRule;
use crate::autopilot::flight_state::{FlightMode, LandedState};
use spandrel_model::frames::{Ned, Vec3};

/// Height error within which a height counts as reached, m.
pub(super) const HEIGHT_TOLERANCE_M: f64 = 0.4;
/// Height above ground below which a takeoff uses the takeoff climb rate, m (PX4: MPC_LAND_ALT1).
const SLOW_TAKEOFF_HEIGHT_M: f64 = 10.0;
/// Minimum climb for a takeoff from the ground, m (ArduCopter's AUTO).
const MIN_TAKEOFF_CLIMB_M: f64 = 1.0;
/// Distance to the target above which the nose turns toward it, m.
pub(super) const TURN_MIN_DISTANCE_M: f64 = 2.0;
/// Speed above which the nose turns along the path, m/s (estimate: well above the estimator's noise).
const TURN_MIN_SPEED_M_S: f64 = 1.0;
/// Distance below which the heading to a region of interest is not updated, m.
const HEADING_MIN_DISTANCE_M: f64 = 0.5;
/// Maximum correction speed toward the landing position, m/s.
const LANDING_CORRECTION_SPEED_M_S: f64 = 2.0;

impl Navigator {
    /// Returns the motion limits in automatic modes.
    pub(super) fn auto_limits(&self, input: &NavigatorInput) -> MotionLimits {
        let (airframe, operator) = (MotionLimits::automatic(input.gains), &input.tuning.rules.envelope);
        MotionLimits {
            horizontal_acceleration_m_s2: airframe.horizontal_acceleration_m_s2.min(operator.acceleration_m_s2),
            vertical_acceleration_m_s2: airframe.vertical_acceleration_m_s2.min(operator.climb_acceleration_m_s2),
            ..airframe
        }
    }

    /// Motion limits en route to a target. Missions and returns build up acceleration gently. A pause brakes at the
    /// rate that `stopping_point` assumes.
    fn travel_limits(&self, input: &NavigatorInput) -> MotionLimits {
        let calm = matches!(self.modes.active, FlightMode::Mission | FlightMode::Return) && self.paused.is_none();
        MotionLimits {
            acceleration_ramp_s: if calm { AUTO_ACCELERATION_RAMP_S } else { ACCELERATION_RAMP_S },
            ..self.auto_limits(input)
        }
    }

    /// Flies to the navigator's target and holds there.
    pub(super) fn fly_to_target(&mut self, speed: Option<f64>, input: &NavigatorInput) -> Setpoint {
        let (up, down) = (input.tuning.climb_m_s, input.tuning.descend_m_s);
        self.fly_within_limits(speed, up, down, input)
    }

    /// Flies to the target within the given speed limits (m/s).
    fn fly_within_limits(&mut self, speed: Option<f64>, up: f64, down: f64, input: &NavigatorInput) -> Setpoint {
        let l = &input.airframe.limits;
        let cruise =
            speed.unwrap_or(self.cruise_m_s(input)).min(input.tuning.horizontal_speed_max_m_s).min(l.forward_m_s).max(0.1);
        let (up, down) = (up.min(l.climb_m_s), down.min(l.descend_m_s));
        let target = self.target_m;
        let here = input.here();
        self.report.target_m = Some(target);
        let heading = self.heading_by_rule(target, input);
        let turns = speed.is_some() || self.modes.active != FlightMode::Hold;
        let yaw = self.region_of_interest_heading_rad(input).or(self.heading.target_rad).or(heading.filter(|_| turns));
        self.heading.turn_to(yaw, self.modes.active, input);
        let velocity_m_s = velocity_toward(input.gains, here, target, cruise, up, down);
        self.shaper.advance(velocity_m_s, &self.travel_limits(input), input.dt_s);
        Setpoint::Velocity(self.motion(self.shaper.velocity_m_s))
    }

    /// Heading from the configured heading rule, rad, if the rule specifies one.
    pub(super) fn heading_by_rule(&self, target_m: Vec3<Ned>, input: &NavigatorInput) -> Option<f64> {
        let here = input.here();
        let home = self.home.position_m.unwrap_or(here);
        let returning = self.modes.active == FlightMode::Return
            || self.modes.active == FlightMode::Mission && self.mission.step() == Some(MissionStep::Return);
        match input.tuning.rules.heading {
            HeadingRule::TargetExceptReturn if returning => None,
            HeadingRule::Target | HeadingRule::TargetExceptReturn => heading_of(target_m - here, TURN_MIN_DISTANCE_M),
            HeadingRule::Home => heading_of(home - here, TURN_MIN_DISTANCE_M),
            HeadingRule::AwayFromHome => heading_of(here - home, TURN_MIN_DISTANCE_M),
            HeadingRule::Path => heading_of(input.estimate.velocity_m_s, TURN_MIN_SPEED_M_S),
            HeadingRule::Fixed => None,
        }
    }

    /// Climbs to the takeoff height, then holds.
    pub(super) fn take_off(&mut self, input: &NavigatorInput) -> Setpoint {
        let left = input.here().down() - self.target_m.down();
        if left < HEIGHT_TOLERANCE_M && self.landed(input) == LandedState::InAir {
            let target = self.target_m;
            self.modes.intended = FlightMode::Hold;
            self.enter(FlightMode::Hold, input);
            self.target_m = target;
            self.commanded.takeoff_target_height_m = None;
        }
        let setpoint = self.climb_to_target(None, input);
        self.report.climbing_out = self.modes.active == FlightMode::Takeoff;
        setpoint
    }

    /// Climbs to the takeoff height at the takeoff rate.
    pub(super) fn climb_to_target(&mut self, speed: Option<f64>, input: &NavigatorInput) -> Setpoint {
        self.report.climbing_out = true;
        let up = input.ground_down_m - input.here().down();
        let slow = !input.tuning.takeoff_at_climb_speed && up < SLOW_TAKEOFF_HEIGHT_M;
        let rate = if slow { input.tuning.takeoff_speed_m_s.min(input.tuning.climb_m_s) } else { input.tuning.climb_m_s };
        self.fly_within_limits(speed, rate, input.tuning.descend_m_s, input)
    }

    /// Returns the takeoff height, m above the origin. From the ground, it is at least high enough for a liftoff.
    pub(super) fn raise_to_min_takeoff_height(&self, up_m: f64, input: &NavigatorInput) -> f64 {
        let standing = input.phase != FlightPhase::InAir;
        if standing { up_m.max(MIN_TAKEOFF_CLIMB_M - input.here().down()) } else { up_m }
    }

    /// Default takeoff height, m above the origin.
    pub(super) fn default_takeoff_height_m(&self, input: &NavigatorInput) -> f64 {
        self.home.up_m() + input.tuning.takeoff_height_m
    }

    /// Starts the descent for a landing.
    fn begin_descent(&mut self, input: &NavigatorInput) {
        self.descends_to_land |= input.phase == FlightPhase::InAir;
    }

    /// Descends and lands at the target.
    pub(super) fn land(&mut self, input: &NavigatorInput) -> Setpoint {
        self.begin_descent(input);
        if !input.estimate.position_valid {
            return self.descend_without_position(input);
        }
        let here = input.here();
        let speed = self.landing_descent_rate(input);
        self.heading.turn_to(self.heading.target_rad, self.modes.active, input);
        let over = Vec3::new(self.target_m.north(), self.target_m.east(), here.down());
        let flat = velocity_toward(input.gains, here, over, LANDING_CORRECTION_SPEED_M_S, 0.0, 0.0);
        let velocity_m_s = Vec3::new(flat.north(), flat.east(), speed);
        self.shaper.advance(velocity_m_s, &self.travel_limits(input), input.dt_s);
        self.report.target_m = Some(over);
        Setpoint::Velocity(self.motion(self.shaper.velocity_m_s))
    }

    /// Descent rate during a landing, m/s; lower near the ground.
    fn landing_descent_rate(&self, input: &NavigatorInput) -> f64 {
        let home = self.home.position_m.map_or(0.0, |h| h.down());
        let over_home = home - input.here().down();
        let below = input.range_down_m.unwrap_or(over_home) - input.airframe.resting_height_m;
        let slow = below < input.tuning.slow_landing_height_m;
        if slow {
            return input.tuning.land_speed_m_s;
        }
        let configured = input.tuning.rules.envelope.landing_descent_rate_m_s;
        let wanted = if configured.is_finite() { configured } else { input.tuning.descend_m_s };
        wanted.min(input.airframe.limits.descend_m_s)
    }

    /// Descends level, without horizontal position control, for flight without a position estimate.
    pub(super) fn descend_without_position(&mut self, input: &NavigatorInput) -> Setpoint {
        self.begin_descent(input);
        self.heading.turn_to(None, self.modes.active, input);
        let velocity_m_s = Vec3::new(0.0, 0.0, self.landing_descent_rate(input));
        self.shaper.advance(velocity_m_s, &self.auto_limits(input), input.dt_s);
        let motion = self.motion(self.shaper.velocity_m_s);
        Setpoint::Level { motion, tilt: (0.0, 0.0) }
    }

    /// Returns the setpoint for a velocity, with the planned acceleration and heading.
    pub(super) fn motion(&self, velocity_m_s: Vec3<Ned>) -> VelocitySetpoint {
        VelocitySetpoint { velocity_m_s, acceleration_m_s2: self.shaper.acceleration_m_s2, yaw_rad: self.heading.yaw_rad }
    }

    /// Cruise speed of missions, returns and go-to, m/s: the commanded speed, or the parameter if there is none.
    pub(super) fn cruise_m_s(&self, input: &NavigatorInput) -> f64 {
        self.commanded.speed_m_s.unwrap_or(input.tuning.cruise_speed_m_s).min(input.tuning.horizontal_speed_max_m_s)
    }

    /// Heading toward the region of interest, rad. `None` if there is none or the vehicle is directly above it.
    pub(super) fn region_of_interest_heading_rad(&self, input: &NavigatorInput) -> Option<f64> {
        let to = self.commanded.look_at_m? - input.here();
        heading_of(to, HEADING_MIN_DISTANCE_M)
    }
}
