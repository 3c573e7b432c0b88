//! Executes mission items.

use super::Navigator;
use super::automatic::{HEIGHT_TOLERANCE_M, TURN_MIN_DISTANCE_M};
use super::input::NavigatorInput;
use super::mission::SuspendedStep;
use super::mission_step::MissionStep;
use super::return_state::ReturnPhase;
use super::trajectory::{AccelerationLimits, SpeedLimits, Trajectory, TrajectoryPoint};
use crate::autopilot::control::setpoint::Setpoint;
use crate::autopilot::control::shaper::{heading_of, stopping_point};
use crate::autopilot::events::Severity;
use crate::autopilot::flight_state::{FlightMode, LandedState};
use crate::autopilot::request::TurnCommand;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Distance to the interruption point at which a mission continues, m (estimate: less than the smallest path tolerance of a
/// task).
const ROUTE_REJOIN_DISTANCE_M: f64 = 0.8;
/// Heading tolerance of a turn, rad (3 degrees, estimate).
const HEADING_TOLERANCE_RAD: f64 = 0.052;
/// Distance to the landing position at which the descent begins, m.
const LANDING_POSITION_TOLERANCE_M: f64 = 0.7;
/// Maximum correction speed toward the planned position, horizontal and vertical, m/s (estimate: wind and a late
/// start).
const MAX_CORRECTION_SPEED_M_S: (f64, f64) = (1.5, 1.0);
/// Maximum tracking error for a passed waypoint to count as reached, m (estimate: the effect of a gust).
const MAX_TRACKING_ERROR_M: f64 = 1.0;

impl Navigator {
    /// Flies the current mission item.
    pub(super) fn fly_mission(&mut self, input: &NavigatorInput) -> Setpoint {
        let has_next = self.mission.skip(input.now);
        self.run_passed_commands(input);
        self.mission.begin_at(self.step_start(input));
        let Some(step) = self.mission.step().filter(|_| has_next) else {
            self.end_mission(input);
            return self.fly_to_target(None, input);
        };
        self.mission_status.current = self.mission.current;
        if let Some(place) = self.mission.interruption_point_m {
            return self.return_to_route(place, input);
        }
        if let Some(place) = self.mission.initial_climb_target_m.or_else(|| self.needs_takeoff_first(&step, input)) {
            return self.climb_before_step(place, input);
        }
        if !self.mission.item_started {
            self.begin_step(&step, input);
            if let Some(left) = self.mission.suspended_wait.take() {
                self.mission.wait_until = Some(input.now + left);
            }
        }
        self.wait_for_time_of_day(&step, input);
        if let MissionStep::Land { .. } | MissionStep::Return = step {
            return self.fly_landing_step(&step, input);
        }
        let circle = matches!(step, MissionStep::Circle { .. }).then(|| self.circle(input)).flatten();
        if self.is_step_done(&step, input) {
            self.mission_status.reached = Some(self.mission.current);
            if !self.mission.advance(input.now) {
                self.end_mission(input);
            }
        }
        circle.unwrap_or_else(|| self.fly_step(&step, input))
    }

    /// Flies the current item: takeoff at its own rate, waypoints along the trajectory, everything else straight to its
    /// target.
    fn fly_step(&mut self, step: &MissionStep, input: &NavigatorInput) -> Setpoint {
        let speed = self.mission.speed_m_s.or(Some(self.cruise_m_s(input)));
        match step {
            MissionStep::Takeoff { .. } => self.climb_to_target(speed, input),
            MissionStep::Waypoint { .. } | MissionStep::Near(_) | MissionStep::Delay(_) | MissionStep::Turn { .. } => {
                self.follow_trajectory(input).unwrap_or_else(|| self.fly_to_target(speed, input))
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
            | MissionStep::Payload => self.fly_to_target(speed, input),
        }
    }

    /// Extends the trajectory to the waypoints ahead, or joins a new one.
    fn extend_trajectory(&mut self, input: &NavigatorInput) {
        let ahead = self.mission.ahead(input.tuning.default_acceptance_radius_m);
        if self.trajectory.as_mut().is_some_and(|trajectory| trajectory.extend(&ahead)) {
            return;
        }
        let from = self.trajectory.as_ref().map_or_else(|| self.current_motion(input), Trajectory::planned);
        let bounds = AccelerationLimits::within(input.gains.acceleration_m_s2, input.gains.climb_acceleration_m_s2);
        self.trajectory = Trajectory::join(from, &ahead, bounds);
    }

    /// Replans from the current motion. After a pause, the earlier trajectory no longer applies.
    pub(super) fn replan_trajectory(&mut self, input: &NavigatorInput) {
        self.trajectory = None;
        if self.mission.item_started && matches!(self.mission.step(), Some(MissionStep::Waypoint { .. } | MissionStep::Near(_))) {
            self.extend_trajectory(input);
        }
    }

    /// Returns the trajectory point that matches the current motion. The plan leads the vehicle by the attitude lag.
    fn current_motion(&self, input: &NavigatorInput) -> TrajectoryPoint {
        let (e, lag_s) = (input.estimate, input.gains.attitude_lag_s);
        let flat = Vec3::new(e.velocity_m_s.north(), e.velocity_m_s.east(), 0.0);
        TrajectoryPoint { position_m: e.position_m + flat * lag_s, velocity_m_s: e.velocity_m_s, acceleration_m_s2: Vec3::zero() }
    }

    /// Vector from the vehicle to the planned position at this instant, m.
    fn tracking_error(&self, planned: &TrajectoryPoint, input: &NavigatorInput) -> Vec3<Ned> {
        let lag_s = input.gains.attitude_lag_s;
        let late = planned.velocity_m_s * lag_s - planned.acceleration_m_s2 * (0.5 * lag_s * lag_s);
        planned.position_m - Vec3::new(late.north(), late.east(), 0.0) - input.here()
    }

    /// Follows the trajectory. Returns `None` if there is none.
    fn follow_trajectory(&mut self, input: &NavigatorInput) -> Option<Setpoint> {
        let behind = self.tracking_error(&self.trajectory.as_ref()?.planned(), input);
        let l = &input.airframe.limits;
        let speeds = SpeedLimits {
            default_speed_m_s: self.cruise_m_s(input),
            max_m_s: input.tuning.horizontal_speed_max_m_s.min(l.forward_m_s),
            up_m_s: input.tuning.climb_m_s.min(l.climb_m_s),
            down_m_s: input.tuning.descend_m_s.min(l.descend_m_s),
        };
        let planned = self.trajectory.as_mut()?.advance(&speeds, behind.norm(), input.dt_s);
        self.report.target_m = Some(self.target_m);
        let heading = heading_of(self.target_m - input.here(), TURN_MIN_DISTANCE_M);
        self.heading.turn_to(
            self.region_of_interest_heading_rad(input).or(self.heading.target_rad).or(heading),
            self.modes.active,
            input,
        );
        // The next mode or item starts from the planned velocity and acceleration.
        self.shaper.velocity_m_s = planned.velocity_m_s;
        self.shaper.acceleration_m_s2 = planned.acceleration_m_s2;
        let behind = self.tracking_error(&planned, input);
        let flat = Vec3::<Ned>::new(behind.north(), behind.east(), 0.0) * input.gains.position;
        let flat = flat.limited(MAX_CORRECTION_SPEED_M_S.0);
        let down = (input.gains.height * behind.down()).clamp(-MAX_CORRECTION_SPEED_M_S.1, MAX_CORRECTION_SPEED_M_S.1);
        Some(Setpoint::Velocity(self.motion(planned.velocity_m_s + flat + Vec3::new(0.0, 0.0, down))))
    }

    /// Returns true if the plan has passed the current waypoint and the vehicle is close to the plan.
    fn has_passed(&self, input: &NavigatorInput) -> bool {
        let passed = |plan: &Trajectory| {
            plan.has_passed(self.target_m) && self.tracking_error(&plan.planned(), input).norm() < MAX_TRACKING_ERROR_M
        };
        self.trajectory.as_ref().is_some_and(passed)
    }

    /// Climb target, straight up to the default takeoff height, if the item leads elsewhere and the vehicle has not
    /// taken off yet.
    fn needs_takeoff_first(&self, step: &MissionStep, input: &NavigatorInput) -> Option<Vec3<Ned>> {
        let away = matches!(step, MissionStep::Waypoint { .. } | MissionStep::Near(_) | MissionStep::Circle { .. });
        let here = input.here();
        let up_m = self.raise_to_min_takeoff_height(self.default_takeoff_height_m(input), input);
        (away && self.landed(input) == LandedState::TakingOff).then(|| Vec3::new(here.north(), here.east(), -up_m))
    }

    fn climb_before_step(&mut self, position_m: Vec3<Ned>, input: &NavigatorInput) -> Setpoint {
        let left = input.here().down() - position_m.down();
        let there = self.landed(input) == LandedState::InAir && left < HEIGHT_TOLERANCE_M;
        self.mission.initial_climb_target_m = (!there).then_some(position_m);
        self.target_m = position_m;
        self.climb_to_target(None, input)
    }

    /// Start position of an item, m: the previous target if it was reached, otherwise the vehicle position.
    fn step_start(&self, input: &NavigatorInput) -> Vec3<Ned> {
        let (here, target) = (input.here(), self.target_m);
        if (target - here).norm() < input.tuning.default_acceptance_radius_m { target } else { here }
    }

    /// Carries out the commands from passed items.
    fn run_passed_commands(&mut self, input: &NavigatorInput) {
        for command in std::mem::take(&mut self.mission.pending_commands) {
            match command {
                MissionStep::LookAt(place) => self.commanded.look_at_m = place,
                MissionStep::Home(place) => self.move_home(place.unwrap_or(input.here())),
                MissionStep::Fence(enabled) => self.switch_fence(enabled),
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

    /// On the ground, processes items that require no flight. Returns true during a wait, which does not count toward
    /// the pre-flight disarm timeout.
    pub fn wait_on_ground(&mut self, input: &NavigatorInput) -> bool {
        let has_next = self.mission.skip(input.now);
        self.run_passed_commands(input);
        if !has_next {
            return false;
        }
        self.mission_status.current = self.mission.current;
        match self.mission.step() {
            Some(step @ (MissionStep::Delay(_) | MissionStep::DelayUntil(_))) => {
                self.wait_for_time_of_day(&step, input);
                if self.mission.wait_until.is_some_and(|until| input.now >= until) {
                    self.mission.advance(input.now);
                }
                true
            }
            Some(MissionStep::Turn { .. }) => {
                self.mission.advance(input.now);
                false
            }
            _ => false,
        }
    }

    /// Sets the waiting time of an item that waits for a time of day.
    fn wait_for_time_of_day(&mut self, step: &MissionStep, input: &NavigatorInput) {
        if let MissionStep::DelayUntil(time) = *step
            && self.mission.wait_until.is_none()
        {
            let wait_s = time.wait_s(input.tuning.start_unix_s + input.now.ms().div_euclid(1_000));
            self.mission.wait_until = Some(input.now + SimTime::from_ms(1_000 * wait_s));
        }
    }

    /// Flies to the interruption point, then continues.
    fn return_to_route(&mut self, position_m: Vec3<Ned>, input: &NavigatorInput) -> Setpoint {
        self.target_m = position_m;
        if (position_m - input.here()).norm() < ROUTE_REJOIN_DISTANCE_M {
            self.mission.interruption_point_m = None;
            self.events.push(Severity::Info, "Mission resumed from interruption point");
        }
        self.fly_to_target(self.mission.speed_m_s.or(Some(self.cruise_m_s(input))), input)
    }

    /// Starts an item.
    fn begin_step(&mut self, step: &MissionStep, input: &NavigatorInput) {
        self.mission.item_started = true;
        (self.orbit, self.report.orbit) = (None, None);
        if !step.stops_before_end() {
            self.trajectory = None;
        }
        let here = input.here();
        match *step {
            MissionStep::Waypoint { position_m, yaw_rad, .. } => {
                self.target_m = position_m;
                self.heading.target_rad = yaw_rad;
                self.extend_trajectory(input);
            }
            MissionStep::Takeoff { up_m } => {
                let up_m = up_m.unwrap_or_else(|| self.default_takeoff_height_m(input));
                self.target_m = Vec3::new(here.north(), here.east(), -self.raise_to_min_takeoff_height(up_m, input));
                self.heading.target_rad = None;
            }
            MissionStep::Land { position_m } => {
                let over = position_m.unwrap_or(here);
                self.target_m = Vec3::new(over.north(), over.east(), here.down());
                self.returning.phase = ReturnPhase::Cruise;
            }
            MissionStep::Return => self.begin_return(input),
            MissionStep::Circle { center_m, radius_m, turns } => self.begin_circle(center_m, radius_m, turns, input),
            MissionStep::Turn { yaw_rad, relative, rate_rad_s } => {
                let from = if relative { input.estimate.attitude.yaw_rad() } else { 0.0 };
                self.commanded.look_at_m = None;
                let turn = TurnCommand { yaw_rad: math::wrap_pi(from + yaw_rad), rate_rad_s, clockwise: None };
                self.heading.command(turn);
            }
            MissionStep::Near(_) => {
                self.target_m = self.mission.next_position().unwrap_or(self.target_m);
                self.heading.target_rad = None;
                self.extend_trajectory(input);
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
        if let Some(left) = self.mission.suspended_step.take() {
            self.resume_step(step, left);
        }
    }

    /// Resumes a suspended item: a takeoff above the same position, a landing in progress, or a return in its saved
    /// phase.
    fn resume_step(&mut self, step: &MissionStep, left: SuspendedStep) {
        let before = left.target_m;
        match *step {
            MissionStep::Takeoff { .. } => {
                self.target_m = Vec3::new(before.north(), before.east(), self.target_m.down());
            }
            MissionStep::Land { position_m } => {
                let over = position_m.unwrap_or(before);
                self.target_m = Vec3::new(over.north(), over.east(), before.down());
                self.returning.phase = left.phase;
            }
            // With a different destination, the item restarts.
            MissionStep::Return if self.returning.target_m == left.return_target_m => {
                self.target_m = before;
                self.returning.phase = left.phase;
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
    fn fly_landing_step(&mut self, step: &MissionStep, input: &NavigatorInput) -> Setpoint {
        if *step == MissionStep::Return {
            return self.fly_return(input);
        }
        let away = (self.target_m - input.here()).horizontal_norm();
        if away < LANDING_POSITION_TOLERANCE_M {
            self.returning.phase = ReturnPhase::Land;
        }
        if self.returning.phase == ReturnPhase::Land {
            self.land(input)
        } else {
            self.fly_to_target(self.mission.speed_m_s, input)
        }
    }

    /// Returns true if an item is complete.
    fn is_step_done(&mut self, step: &MissionStep, input: &NavigatorInput) -> bool {
        let left = self.target_m - input.here();
        match *step {
            MissionStep::Waypoint { acceptance_radius_m: accept_m, hold_s, .. } => {
                let accept = if accept_m > 0.0 { accept_m } else { input.tuning.default_acceptance_radius_m };
                if self.mission.wait_until.is_none() && (left.norm() < accept || self.has_passed(input)) {
                    self.mission.wait_until = Some(input.now + SimTime::from_s(hold_s.clamp(0.0, 86_400.0)));
                }
                self.mission.wait_until.is_some_and(|until| input.now >= until)
            }
            MissionStep::Takeoff { .. } => self.landed(input) == LandedState::InAir && left.down() > -HEIGHT_TOLERANCE_M,
            MissionStep::Delay(_) | MissionStep::DelayUntil(_) => self.mission.wait_until.is_some_and(|until| input.now >= until),
            MissionStep::Circle { .. } => self.orbit.is_none_or(|orbit| orbit.remaining_arc_rad <= 0.0),
            MissionStep::Near(within_m) => left.norm() < within_m || self.mission.next_position().is_none(),
            MissionStep::Turn { .. } => {
                let yaw = input.estimate.attitude.yaw_rad();
                self.heading.target_rad.is_none_or(|wanted| math::wrap_pi(wanted - yaw).abs() < HEADING_TOLERANCE_RAD)
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

    /// Ends the mission: holds position, or stays in mission mode (ArduPilot).
    pub(super) fn end_mission(&mut self, input: &NavigatorInput) {
        if !self.mission_status.finished {
            self.mission_status.finished = true;
            self.events.push(Severity::Info, "Mission finished");
            if input.tuning.stays_in_mission_mode {
                let e = input.estimate;
                self.target_m = stopping_point(input.gains, e.position_m, e.velocity_m_s);
                self.trajectory = None;
            }
        }
        if input.tuning.stays_in_mission_mode {
            return;
        }
        self.modes.intended = FlightMode::Hold;
        self.enter(FlightMode::Hold, input);
    }

    /// Completes the landing of a mission or return.
    pub(super) fn finish_landing(&mut self, input: &NavigatorInput) {
        let landing = matches!(self.mission.step(), Some(MissionStep::Land { .. } | MissionStep::Return));
        if self.modes.active == FlightMode::Mission && landing {
            self.mission_status.reached = Some(self.mission.current);
            if !self.mission.advance(input.now) {
                self.end_mission(input);
            }
        }
    }
}
