//! Execution of mission items.

use super::automatic::{HEIGHT_REACHED_M, TURN_BEYOND_M};
use super::core::{Autopilot, Severity};
use super::mission::SuspendedStep;
use super::modes::{ReturnPhase, Setpoint};
use super::shaper::{heading_of, stopping_point};
use super::trajectory::{AccelerationLimits, SpeedLimits, Trajectory, TrajectoryPoint};
use super::{FlightMode, LandedState, MissionStep, TurnCommand};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Distance to the interruption point at which a mission continues, m (estimate: less than the smallest path tolerance of a
/// task).
const BACK_WITHIN_M: f64 = 0.8;
/// Heading tolerance of a turn, rad (3 degrees, estimate).
const TURNED_RAD: f64 = 0.052;
/// Distance to the landing position at which the descent begins, m.
const OVER_PLACE_M: f64 = 0.7;
/// Maximum speed of corrections toward the planned position, horizontal and vertical, m/s (estimate: wind and a late start).
const CATCH_UP_M_S: (f64, f64) = (1.5, 1.0);
/// Maximum tracking error for a passed waypoint to count as reached, m (estimate: the effect of a gust).
const NEAR_PLAN_M: f64 = 1.0;

impl Autopilot {
    pub(super) fn fly_mission(&mut self, now: SimTime, dt_s: f64) -> Setpoint {
        let going = self.mission.skip(now);
        self.run_passed_commands();
        self.mission.begin_at(self.step_start());
        let Some(step) = self.mission.step().filter(|_| going) else {
            self.end_mission(now);
            return self.go(None, dt_s);
        };
        self.status.mission_current = self.mission.current;
        if let Some(place) = self.mission.left_at {
            return self.return_to_route(place, dt_s);
        }
        if let Some(place) = self.mission.lift_to.or_else(|| self.needs_takeoff_first(&step)) {
            return self.climb_before_step(place, dt_s);
        }
        if !self.mission.begun {
            self.begin_step(&step);
            if let Some(left) = self.mission.left_wait.take() {
                self.mission.wait_until = Some(now + left);
            }
        }
        self.wait_for_time_of_day(&step, now);
        if let MissionStep::Land { .. } | MissionStep::Return = step {
            return self.fly_landing_step(&step, dt_s);
        }
        let circle = matches!(step, MissionStep::Circle { .. }).then(|| self.circle(dt_s)).flatten();
        if self.is_step_done(&step, now) {
            self.status.mission_reached = Some(self.mission.current);
            if !self.mission.advance(now) {
                self.end_mission(now);
            }
        }
        circle.unwrap_or_else(|| self.fly_step(&step, dt_s))
    }

    /// Flies the current item: take-off at its own rate, waypoints along the trajectory, everything else straight to its target.
    fn fly_step(&mut self, step: &MissionStep, dt_s: f64) -> Setpoint {
        let speed = self.mission.speed_m_s.or(Some(self.cruise_m_s()));
        match step {
            MissionStep::Takeoff { .. } => self.climb_away(speed, dt_s),
            MissionStep::Waypoint { .. } | MissionStep::Near(_) | MissionStep::Delay(_) | MissionStep::Turn { .. } => {
                self.follow_trajectory(dt_s).unwrap_or_else(|| self.go(speed, dt_s))
            }
            MissionStep::Land { .. }
            | MissionStep::Return
            | MissionStep::Speed(_)
            | MissionStep::DelayUntil(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Circle { .. }
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload => self.go(speed, dt_s),
        }
    }

    /// Extends the trajectory to the waypoints ahead, or joins a new one.
    fn extend_trajectory(&mut self) {
        let ahead = self.mission.ahead(self.tuning.accept_radius_m);
        if self.trajectory.as_mut().is_some_and(|way| way.extend(&ahead)) {
            return;
        }
        let from = self.trajectory.as_ref().map_or_else(|| self.current_motion(), Trajectory::planned);
        let bounds = AccelerationLimits::within(self.gains.acceleration_m_s2, self.gains.climb_acceleration_m_s2);
        self.trajectory = Trajectory::join(from, &ahead, bounds);
    }

    /// Replans from the current motion. After a pause the earlier trajectory no longer applies.
    pub(super) fn replan_trajectory(&mut self) {
        self.trajectory = None;
        if self.mission.begun && matches!(self.mission.step(), Some(MissionStep::Waypoint { .. } | MissionStep::Near(_))) {
            self.extend_trajectory();
        }
    }

    /// Returns a trajectory point that matches the current motion. The plan is ahead by the attitude lag.
    fn current_motion(&self) -> TrajectoryPoint {
        let (e, lag_s) = (&self.estimate, self.gains.attitude_lag_s);
        let flat = Vec3::new(e.velocity_m_s.north(), e.velocity_m_s.east(), 0.0);
        TrajectoryPoint { position_m: e.position_m + flat * lag_s, velocity_m_s: e.velocity_m_s, acceleration_m_s2: Vec3::zero() }
    }

    /// Vector from the vehicle to the planned position at this instant, m.
    fn tracking_error(&self, planned: &TrajectoryPoint) -> Vec3<Ned> {
        let lag_s = self.gains.attitude_lag_s;
        let late = planned.velocity_m_s * lag_s - planned.acceleration_m_s2 * (0.5 * lag_s * lag_s);
        planned.position_m - Vec3::new(late.north(), late.east(), 0.0) - self.estimate.position_m
    }

    /// Follows the trajectory. Returns `None` without one.
    fn follow_trajectory(&mut self, dt_s: f64) -> Option<Setpoint> {
        let behind = self.tracking_error(&self.trajectory.as_ref()?.planned());
        let l = &self.airframe.limits;
        let speeds = SpeedLimits {
            default_m_s: self.cruise_m_s(),
            max_m_s: self.tuning.horizontal_speed_max_m_s.min(l.forward_m_s),
            up_m_s: self.tuning.climb_m_s.min(l.climb_m_s),
            down_m_s: self.tuning.descend_m_s.min(l.descend_m_s),
        };
        let planned = self.trajectory.as_mut()?.advance(&speeds, behind.norm(), dt_s);
        self.status.target_m = Some(self.navigator.target_m);
        let way = heading_of(self.navigator.target_m - self.estimate.position_m, TURN_BEYOND_M);
        self.turn_to(self.look_rad().or(self.navigator.target_yaw_rad).or(way), dt_s);
        // Whatever follows the trajectory continues from the plan.
        self.shaper.velocity_m_s = planned.velocity_m_s;
        self.shaper.acceleration_m_s2 = planned.acceleration_m_s2;
        let behind = self.tracking_error(&planned);
        let flat = Vec3::<Ned>::new(behind.north(), behind.east(), 0.0) * self.gains.position;
        let flat = flat.limited(CATCH_UP_M_S.0);
        let down = (self.gains.height * behind.down()).clamp(-CATCH_UP_M_S.1, CATCH_UP_M_S.1);
        Some(Setpoint::Velocity(self.motion(planned.velocity_m_s + flat + Vec3::new(0.0, 0.0, down))))
    }

    /// Returns true if the plan has passed the current waypoint and the vehicle is close to the plan.
    fn has_passed(&self) -> bool {
        let passed = |way: &Trajectory| {
            way.has_passed(self.navigator.target_m) && self.tracking_error(&way.planned()).norm() < NEAR_PLAN_M
        };
        self.trajectory.as_ref().is_some_and(passed)
    }

    /// Climb target for an item that moves away while the vehicle is still on the ground: straight up to the default take-off
    /// height.
    fn needs_takeoff_first(&self, step: &MissionStep) -> Option<Vec3<Ned>> {
        let away = matches!(step, MissionStep::Waypoint { .. } | MissionStep::Near(_) | MissionStep::Circle { .. });
        let here = self.estimate.position_m;
        let up_m = self.above_ground(self.default_takeoff_up_m());
        (away && self.status.landed == LandedState::TakingOff).then(|| Vec3::new(here.north(), here.east(), -up_m))
    }

    fn climb_before_step(&mut self, place_m: Vec3<Ned>, dt_s: f64) -> Setpoint {
        let left = self.estimate.position_m.down() - place_m.down();
        let there = self.status.landed == LandedState::InAir && left < HEIGHT_REACHED_M;
        self.mission.lift_to = (!there).then_some(place_m);
        self.navigator.target_m = place_m;
        self.climb_away(None, dt_s)
    }

    /// Start position of an item, m: the previous target if it was reached, otherwise the vehicle position.
    fn step_start(&self) -> Vec3<Ned> {
        let (here, target) = (self.estimate.position_m, self.navigator.target_m);
        if (target - here).norm() < self.tuning.accept_radius_m { target } else { here }
    }

    /// Carries out the commands of passed items.
    fn run_passed_commands(&mut self) {
        for order in std::mem::take(&mut self.mission.orders) {
            match order {
                MissionStep::LookAt(place) => self.look_at_m = place,
                MissionStep::Home(place) => self.move_home(place.unwrap_or(self.estimate.position_m)),
                MissionStep::Fence(on) => {
                    self.enable_fence(on);
                }
                MissionStep::Waypoint { .. }
                | MissionStep::Takeoff { .. }
                | MissionStep::Land { .. }
                | MissionStep::Return
                | MissionStep::Speed(_)
                | MissionStep::Delay(_)
                | MissionStep::DelayUntil(_)
                | MissionStep::Jump { .. }
                | MissionStep::Circle { .. }
                | MissionStep::Turn { .. }
                | MissionStep::Near(_)
                | MissionStep::LandingSequence
                | MissionStep::Payload => {}
            }
        }
    }

    /// Waits on the ground. Processes items that need no flight.
    pub(super) fn wait_on_ground(&mut self, now: SimTime) {
        let going = self.mission.skip(now);
        self.run_passed_commands();
        if !going {
            return;
        }
        self.status.mission_current = self.mission.current;
        match self.mission.step() {
            Some(step @ (MissionStep::Delay(_) | MissionStep::DelayUntil(_))) => {
                self.wait_for_time_of_day(&step, now);
                // Waiting does not count toward the pre-flight disarm timeout.
                self.failsafe.standing_since = now;
                if self.mission.wait_until.is_some_and(|until| now >= until) {
                    self.mission.advance(now);
                }
            }
            Some(MissionStep::Turn { .. }) => {
                self.mission.advance(now);
            }
            _ => {}
        }
    }

    /// Sets the waiting time of an item that waits for a time of day.
    fn wait_for_time_of_day(&mut self, step: &MissionStep, now: SimTime) {
        if let MissionStep::DelayUntil(time) = *step
            && self.mission.wait_until.is_none()
        {
            let wait_s = time.wait_s(self.tuning.start_unix_s + now.ms().div_euclid(1_000));
            self.mission.wait_until = Some(now + SimTime::from_ms(1_000 * wait_s));
        }
    }

    /// Flies to the interruption point, then continues.
    fn return_to_route(&mut self, place_m: Vec3<Ned>, dt_s: f64) -> Setpoint {
        self.navigator.target_m = place_m;
        if (place_m - self.estimate.position_m).norm() < BACK_WITHIN_M {
            self.mission.left_at = None;
            self.push_event(Severity::Info, "Mission resumed from interruption point");
        }
        self.go(self.mission.speed_m_s.or(Some(self.cruise_m_s())), dt_s)
    }

    pub(super) fn begin_step(&mut self, step: &MissionStep) {
        self.mission.begun = true;
        (self.orbit, self.status.orbit) = (None, None);
        if !step.stops_before_end() {
            self.trajectory = None;
        }
        let here = self.estimate.position_m;
        match *step {
            MissionStep::Waypoint { position_m, yaw_rad, .. } => {
                self.navigator.target_m = position_m;
                self.navigator.target_yaw_rad = yaw_rad;
                self.extend_trajectory();
            }
            MissionStep::Takeoff { up_m } => {
                let up_m = up_m.unwrap_or_else(|| self.default_takeoff_up_m());
                self.navigator.target_m = Vec3::new(here.north(), here.east(), -self.above_ground(up_m));
                self.navigator.target_yaw_rad = None;
            }
            MissionStep::Land { position_m } => {
                let over = position_m.unwrap_or(here);
                self.navigator.target_m = Vec3::new(over.north(), over.east(), here.down());
                self.navigator.phase = ReturnPhase::Cruise;
            }
            MissionStep::Return => self.begin_return(),
            MissionStep::Circle { centre_m, radius_m, turns } => self.begin_circle(centre_m, radius_m, turns),
            MissionStep::Turn { yaw_rad, relative, rate_rad_s } => {
                let from = if relative { self.estimate.attitude.yaw_rad() } else { 0.0 };
                self.look_at_m = None;
                let turn = TurnCommand { yaw_rad: math::wrap_pi(from + yaw_rad), rate_rad_s, clockwise: None };
                (self.navigator.target_yaw_rad, self.navigator.turn) = (Some(turn.yaw_rad), Some(turn));
            }
            MissionStep::Near(_) => {
                self.navigator.target_m = self.mission.next_position().unwrap_or(self.navigator.target_m);
                self.navigator.target_yaw_rad = None;
                self.extend_trajectory();
            }
            MissionStep::Speed(_)
            | MissionStep::Delay(_)
            | MissionStep::DelayUntil(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload => {}
        }
        if let Some(left) = self.mission.left_course.take() {
            self.resume_step(step, left);
        }
    }

    /// Resumes a suspended item: a take-off above the same position, a landing in progress, a return in its phase.
    fn resume_step(&mut self, step: &MissionStep, left: SuspendedStep) {
        let course = &mut self.navigator;
        let before = left.target_m;
        match *step {
            MissionStep::Takeoff { .. } => {
                course.target_m = Vec3::new(before.north(), before.east(), course.target_m.down());
            }
            MissionStep::Land { position_m } => {
                let over = position_m.unwrap_or(before);
                course.target_m = Vec3::new(over.north(), over.east(), before.down());
                course.phase = left.phase;
            }
            // With a different destination, the item restarts.
            MissionStep::Return if course.return_target_m == left.refuge_m => {
                course.target_m = before;
                course.phase = left.phase;
            }
            MissionStep::Waypoint { .. }
            | MissionStep::Return
            | MissionStep::Speed(_)
            | MissionStep::Delay(_)
            | MissionStep::DelayUntil(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Circle { .. }
            | MissionStep::Turn { .. }
            | MissionStep::Near(_)
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload => {}
        }
    }

    /// Flies to the landing position and lands.
    pub(super) fn fly_landing_step(&mut self, step: &MissionStep, dt_s: f64) -> Setpoint {
        if *step == MissionStep::Return {
            return self.go_home(dt_s);
        }
        let away = (self.navigator.target_m - self.estimate.position_m).horizontal_norm();
        if away < OVER_PLACE_M {
            self.navigator.phase = ReturnPhase::Land;
        }
        if self.navigator.phase == ReturnPhase::Land { self.land(dt_s) } else { self.go(self.mission.speed_m_s, dt_s) }
    }

    pub(super) fn is_step_done(&mut self, step: &MissionStep, now: SimTime) -> bool {
        let left = self.navigator.target_m - self.estimate.position_m;
        match *step {
            MissionStep::Waypoint { accept_m, hold_s, .. } => {
                let accept = if accept_m > 0.0 { accept_m } else { self.tuning.accept_radius_m };
                if self.mission.wait_until.is_none() && (left.norm() < accept || self.has_passed()) {
                    self.mission.wait_until = Some(now + SimTime::from_s(hold_s.clamp(0.0, 86_400.0)));
                }
                self.mission.wait_until.is_some_and(|until| now >= until)
            }
            MissionStep::Takeoff { .. } => self.status.landed == LandedState::InAir && left.down() > -HEIGHT_REACHED_M,
            MissionStep::Delay(_) | MissionStep::DelayUntil(_) => self.mission.wait_until.is_some_and(|until| now >= until),
            MissionStep::Circle { .. } => self.orbit.is_none_or(|orbit| orbit.left_rad <= 0.0),
            MissionStep::Near(within_m) => left.norm() < within_m || self.mission.next_position().is_none(),
            MissionStep::Turn { .. } => {
                let yaw = self.estimate.attitude.yaw_rad();
                self.navigator.target_yaw_rad.is_none_or(|wanted| math::wrap_pi(wanted - yaw).abs() < TURNED_RAD)
            }
            MissionStep::Land { .. }
            | MissionStep::Return
            | MissionStep::Speed(_)
            | MissionStep::Jump { .. }
            | MissionStep::LookAt(_)
            | MissionStep::Home(_)
            | MissionStep::Fence(_)
            | MissionStep::LandingSequence
            | MissionStep::Payload => false,
        }
    }

    pub(super) fn end_mission(&mut self, now: SimTime) {
        if !self.status.mission_finished {
            self.status.mission_finished = true;
            self.push_event(Severity::Info, "Mission finished");
            if self.tuning.mission_mode_stays {
                let e = &self.estimate;
                self.navigator.target_m = stopping_point(&self.gains, e.position_m, e.velocity_m_s);
                self.trajectory = None;
            }
        }
        if self.tuning.mission_mode_stays {
            return;
        }
        self.failsafe.intended = FlightMode::Hold;
        self.enter(FlightMode::Hold, now);
    }

    /// Completes a landing of a mission or return.
    pub(super) fn finish_landing(&mut self, now: SimTime) {
        let landing = matches!(self.mission.step(), Some(MissionStep::Land { .. } | MissionStep::Return));
        if self.status.mode == FlightMode::Mission && landing {
            self.status.mission_reached = Some(self.mission.current);
            if !self.mission.advance(now) {
                self.end_mission(now);
            }
        }
    }
}
