//! Flying the steps of a mission.

use super::automatic::HEIGHT_REACHED_M;
use super::core::{Autopilot, Severity};
use super::mission::LeftCourse;
use super::modes::{ReturnPhase, Wanted};
use super::{Landed, MissionStep, Mode};
use crate::base::frames::{Ned, Vec3};
use crate::base::math;
use crate::base::time::SimTime;

/// A mission goes on once this near to where it was left, m (estimate: less than the narrowest task's threshold).
const BACK_WITHIN_M: f64 = 0.8;
/// A turn is done within this much of its heading, rad (3 degrees, estimate).
const TURNED_RAD: f64 = 0.052;
/// A landing step descends once this near over its place, m.
const OVER_PLACE_M: f64 = 0.7;

impl Autopilot {
    pub(super) fn fly_mission(&mut self, now: SimTime, dt_s: f64) -> Wanted {
        let going = self.mission.skip(now);
        self.carry_out_orders();
        let Some(step) = self.mission.step().filter(|_| going) else {
            self.end_mission(now);
            return self.go(None, dt_s);
        };
        self.status.mission_current = self.mission.current;
        if let Some(place) = self.mission.left_at {
            return self.go_back_to(place, dt_s);
        }
        if !self.mission.begun {
            self.begin_step(&step);
            if let Some(left) = self.mission.left_wait.take() {
                self.mission.wait_until = Some(now + left);
            }
        }
        if let MissionStep::Land { .. } | MissionStep::Return = step {
            return self.fly_down(&step, dt_s);
        }
        let circle = matches!(step, MissionStep::Circle { .. }).then(|| self.circle(dt_s)).flatten();
        if self.step_done(&step, now) {
            self.status.mission_reached = Some(self.mission.current);
            if !self.mission.advance(now) {
                self.end_mission(now);
            }
        }
        let speed = self.mission.speed_m_s.or(Some(self.cruise_m_s()));
        circle.unwrap_or_else(|| self.go(speed, dt_s))
    }

    /// What passed steps order of the autopilot.
    fn carry_out_orders(&mut self) {
        for order in std::mem::take(&mut self.mission.orders) {
            match order {
                MissionStep::LookAt(place) => self.look_at_m = place,
                MissionStep::Home(place) => self.move_home(place.unwrap_or(self.estimate.position_m)),
                MissionStep::Fence(on) => {
                    self.enable_fence(on);
                }
                _ => {}
            }
        }
    }

    /// On the ground a mission waits, and passes over what needs no flight.
    pub(super) fn wait_on_ground(&mut self, now: SimTime) {
        let going = self.mission.skip(now);
        self.carry_out_orders();
        if !going {
            return;
        }
        self.status.mission_current = self.mission.current;
        match self.mission.step() {
            Some(MissionStep::Delay(_)) => {
                // Waiting is no forgotten take-off.
                self.watch.standing_since = now;
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

    /// To where the mission was left, then on.
    fn go_back_to(&mut self, place_m: Vec3<Ned>, dt_s: f64) -> Wanted {
        self.course.target_m = place_m;
        if (place_m - self.estimate.position_m).norm() < BACK_WITHIN_M {
            self.mission.left_at = None;
            self.say(Severity::Info, "Mission goes on where it was left");
        }
        self.go(self.mission.speed_m_s.or(Some(self.cruise_m_s())), dt_s)
    }

    pub(super) fn begin_step(&mut self, step: &MissionStep) {
        self.mission.begun = true;
        (self.orbit, self.status.orbit) = (None, None);
        let here = self.estimate.position_m;
        match *step {
            MissionStep::Waypoint { position_m, yaw_rad, .. } => {
                self.course.target_m = position_m;
                self.course.target_yaw_rad = yaw_rad;
            }
            MissionStep::Takeoff { up_m } => {
                let up_m = up_m.unwrap_or_else(|| self.usual_takeoff_up_m());
                self.course.target_m = Vec3::new(here.north(), here.east(), -up_m);
                self.course.target_yaw_rad = None;
            }
            MissionStep::Land { position_m } => {
                let over = position_m.unwrap_or(here);
                self.course.target_m = Vec3::new(over.north(), over.east(), here.down());
                self.course.phase = ReturnPhase::Cruise;
            }
            MissionStep::Return => self.begin_return(),
            MissionStep::Circle { centre_m, radius_m, turns } => self.begin_circle(centre_m, radius_m, turns),
            MissionStep::Turn { yaw_rad, relative } => {
                let from = if relative { self.estimate.attitude.yaw_rad() } else { 0.0 };
                self.look_at_m = None;
                self.course.target_yaw_rad = Some(math::wrap_pi(from + yaw_rad));
            }
            MissionStep::Near(_) => {
                self.course.target_m = self.mission.next_place().unwrap_or(self.course.target_m);
                self.course.target_yaw_rad = None;
            }
            _ => {}
        }
        if let Some(left) = self.mission.left_course.take() {
            self.take_up(step, left);
        }
    }

    /// A step that was left goes on with its course: up over the same place, down where it was sinking, home from where it had come to.
    fn take_up(&mut self, step: &MissionStep, left: LeftCourse) {
        let course = &mut self.course;
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
            // To another place than then it begins anew.
            MissionStep::Return if course.refuge_m == left.refuge_m => {
                course.target_m = before;
                course.phase = left.phase;
            }
            _ => {}
        }
    }

    /// Lands where the step says, once over the place.
    pub(super) fn fly_down(&mut self, step: &MissionStep, dt_s: f64) -> Wanted {
        if *step == MissionStep::Return {
            return self.go_home(dt_s);
        }
        let away = (self.course.target_m - self.estimate.position_m).horizontal_norm();
        if away < OVER_PLACE_M {
            self.course.phase = ReturnPhase::Land;
        }
        if self.course.phase == ReturnPhase::Land { self.land(dt_s) } else { self.go(self.mission.speed_m_s, dt_s) }
    }

    pub(super) fn step_done(&mut self, step: &MissionStep, now: SimTime) -> bool {
        let left = self.course.target_m - self.estimate.position_m;
        match *step {
            MissionStep::Waypoint { accept_m, hold_s, .. } => {
                let accept = if accept_m > 0.0 { accept_m } else { self.tuning.accept_radius_m };
                if self.mission.wait_until.is_none() && left.norm() < accept {
                    self.mission.wait_until = Some(now + SimTime::from_s(hold_s.clamp(0.0, 86_400.0)));
                }
                self.mission.wait_until.is_some_and(|until| now >= until)
            }
            MissionStep::Takeoff { .. } => self.status.landed == Landed::InAir && left.down() > -HEIGHT_REACHED_M,
            MissionStep::Delay(_) => self.mission.wait_until.is_some_and(|until| now >= until),
            MissionStep::Circle { .. } => self.orbit.is_none_or(|orbit| orbit.left_rad <= 0.0),
            MissionStep::Near(within_m) => left.norm() < within_m || self.mission.next_place().is_none(),
            MissionStep::Turn { .. } => {
                let yaw = self.estimate.attitude.yaw_rad();
                self.course.target_yaw_rad.is_none_or(|wanted| math::wrap_pi(wanted - yaw).abs() < TURNED_RAD)
            }
            _ => false,
        }
    }

    pub(super) fn end_mission(&mut self, now: SimTime) {
        if !self.status.mission_finished {
            self.status.mission_finished = true;
            self.say(Severity::Info, "Mission finished");
        }
        self.watch.intended = Mode::Hold;
        self.enter(Mode::Hold, now);
    }

    /// A landing that a mission or a return asked for is complete.
    pub(super) fn mission_landed(&mut self, now: SimTime) {
        let landing = matches!(self.mission.step(), Some(MissionStep::Land { .. } | MissionStep::Return));
        if self.status.mode == Mode::Mission && landing {
            self.status.mission_reached = Some(self.mission.current);
            if !self.mission.advance(now) {
                self.end_mission(now);
            }
        }
    }
}
