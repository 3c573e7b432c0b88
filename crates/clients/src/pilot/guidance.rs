//! In-flight guidance: follows the leg at a chosen pace, stops to look, avoids obstacles, and recovers from upsets.

use super::config::PilotConfig;
use super::goals::{FlightGoal, PlanningContext};
use super::guidance_state::LookDirection;
use super::hand_motion::StickAxes;
use super::hold::{Hold, distance_to_path_m};
use super::perception::MotionState;
use super::setbacks::SetbackDecision;
use super::stick_command::{MIN_HORIZONTAL, aim_error_rad, heading_and_elevation, sticks};
use super::track::TrackCommand;
use super::{Pilot, PilotPhase};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::dialect::MavCmd;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Minimum time without progress before the aircraft counts as stuck, s.
const STUCK_TIMEOUT_S: f64 = 6.0;
/// Time without progress away from obstacles after which the pilot goes on behind the next turn of the leg, s (estimate).
const STALL_TIMEOUT_S: f64 = 15.0;
/// Duration of the back-off maneuver after a contact or getting stuck, s (estimate).
const BACK_OFF_DURATION_S: f64 = 2.5;
/// Speed of the back-off maneuver, away from the surface and up, m/s (estimate).
const BACK_OFF_SPEED_M_S: f64 = 1.0;
const BACK_OFF_CLIMB_M_S: f64 = 0.5;
/// Free height above the aircraft needed to climb while backing off, m (estimate).
const CLIMB_ROOM_M: f64 = 4.0;
/// Radius of the part of a leg that the pilot leaves out after repeated setbacks, m (estimate).
const LEFT_OUT_RADIUS_M: f64 = 7.0;
/// Slowest chosen speed along a leg, m/s (estimate).
const MIN_PACE_M_S: f64 = 0.5;
/// Speed along the path while a cue makes the pilot return to it, m/s (estimate).
const RETURN_PACE_M_S: f64 = 0.2;
/// Time for which the pilot remembers a cue about the path, s (estimate).
const CUE_ATTENTION_S: f64 = 2.0;
/// Largest distance at which a surface affects the chosen speed, m (estimate).
const MAX_PACE_CLEARANCE_M: f64 = 15.0;
/// Time between two choices of the speed, s (estimate: about one fixation).
const PACE_INTERVAL_S: f64 = 0.3;
/// Spread of the duration of stops to look (lognormal; estimate).
const LOOK_DURATION_SIGMA_LN: f64 = 0.4;
/// Angle between the camera and the direction of a look below which the pilot looks, rad (estimate: well inside the picture).
const MAX_LOOK_ERROR_RAD: f64 = 0.26;
/// Longest time to turn the camera for a look, s (estimate).
const MAX_TURN_TIME_S: f64 = 2.5;
/// Largest angle between the drone's heading and the direction to the pilot at which the drone faces the pilot, rad.
const FACING_ANGLE_RAD: f64 = math::PI / 3.0;

impl Pilot {
    /// Runs one control step in the flight phase and returns the stick axes.
    pub(super) fn fly(&mut self, belief: &MotionState) -> StickAxes {
        if !self.link.status.armed && self.phase_time_s() > 1.0 {
            return self.recover_from_disarm();
        }
        self.handle_contact(belief);
        self.plan_next_leg(belief);
        self.choose_pace(belief);
        let Some(mut wish) = self.follow(belief) else { return [0.0; 4] };
        self.look_around(belief, &mut wish);
        self.search_picture(belief, &mut wish);
        self.control_payload(&wish);
        let push = self.avoid_obstacles(belief);
        if push.norm() > 0.0 {
            wish.hands_off = false;
            wish.velocity_m_s += push;
        }
        // The pilot misjudges speed, so the actual velocity differs from the intended one.
        wish.velocity_m_s = wish.velocity_m_s / self.perception.perceived_speed_ratio();
        sticks(&wish, belief, &self.config)
    }

    /// Handles a motor stop in flight: continues the job unless the session is over.
    fn recover_from_disarm(&mut self) -> StickAxes {
        if matches!(self.link.status.contact, ContactKind::Person | ContactKind::Vehicle) {
            self.finish("hit a person or a vehicle");
        } else if self.link.status.battery_pct.is_some_and(|pct| pct < 1.0) {
            self.finish("battery empty");
        } else if self.phase_time_s() > 25.0 * 60.0 {
            self.finish("could not continue");
        } else {
            self.arm();
            return [0.0, 0.0, 0.3, 0.0];
        }
        [0.0; 4]
    }

    fn map<'a>(config: &'a PilotConfig, site: &'a spandrel_model::site::Site, at: SimTime) -> PlanningContext<'a> {
        PlanningContext { scenario: &config.scenario, site, vehicle: &config.vehicle, at, transit_clearance_m: None }
    }

    /// Plans the next leg, or a route back to the current one.
    fn plan_next_leg(&mut self, belief: &MotionState) {
        let Some(site) = &self.site else { return };
        let map = Self::map(&self.config, site, self.now);
        if self.link.status.battery_pct.is_some_and(|pct| pct < self.config.skill.return_battery_pct)
            && !matches!(self.guidance.leg, Some((FlightGoal::Home, _)))
        {
            self.goals = [FlightGoal::Home].into();
            self.guidance.leg = None;
            self.guidance.target = None;
        }
        match (&self.guidance.leg, self.guidance.needs_plan && self.now >= self.guidance.back_off_until) {
            (Some((job, leg)), true) => {
                let (job, fresh) = (*job, map.resume(leg, self.guidance.progress.next, belief.position_m));
                self.guidance.begin_leg(fresh, job, self.now);
            }
            (None, _) => {
                let Some(job) = self.goals.pop_front() else { return };
                let leg = map.leg(job, belief.position_m);
                self.guidance.begin_leg(leg, job, self.now);
                self.guidance.setbacks.begin_task();
            }
            (Some(_), false) => {}
        }
    }

    /// Holds position at the end of a leg whose path is very short. Returns whether the pilot goes on.
    pub(super) fn has_held(&mut self, task: usize) -> bool {
        let (task, seen) = (&self.config.scenario.tasks[task], self.perception.delayed_view(self.config.skill.delay_s));
        let Some(seen) = seen.filter(|_| task.is_hold_position()) else { return true };
        let on_path = distance_to_path_m(task, seen.position_m) <= task.threshold_m;
        self.guidance.hold.get_or_insert(Hold::new(self.now)).step(on_path, self.now)
    }

    /// Backs off after a contact, and gives a place up after repeated ones.
    fn handle_contact(&mut self, belief: &MotionState) {
        let touching = self.link.status.contact != ContactKind::None;
        let onset = touching && !self.guidance.touching;
        self.guidance.touching = touching;
        if onset {
            self.suffer_setback(belief);
        }
    }

    fn suffer_setback(&mut self, belief: &MotionState) {
        self.guidance.target = None;
        self.guidance.back_off_until = self.now + SimTime::from_s(BACK_OFF_DURATION_S);
        self.guidance.best_since = self.guidance.back_off_until;
        self.guidance.needs_plan = true;
        let on_task = matches!(self.guidance.leg, Some((FlightGoal::Task(_), _)));
        match self.guidance.setbacks.note(belief.position_m, self.now) {
            Some(SetbackDecision::LeaveOutPlace) => {
                if !self.guidance.leave_out(belief.position_m, LEFT_OUT_RADIUS_M) && on_task {
                    self.guidance.leg = None;
                }
            }
            Some(SetbackDecision::GiveTaskUp) if on_task => self.guidance.leg = None,
            Some(SetbackDecision::GiveTaskUp | SetbackDecision::TryAgain) | None => {}
        }
    }

    /// Chooses a speed for the surroundings: the preferred speed, or less, so that the nearest surface here and one second
    /// ahead stays at least a time gap away.
    fn choose_pace(&mut self, belief: &MotionState) {
        let Some(site) = &self.site else { return };
        if self.now < self.guidance.pace_due {
            return;
        }
        self.guidance.pace_due = self.now + SimTime::from_s(PACE_INTERVAL_S);
        let skill = &self.config.skill;
        let preferred = if self.guidance.task().is_some() { skill.speed_m_s } else { skill.transit_speed_m_s };
        let ahead = belief.position_m + belief.velocity_m_s * skill.preview_s;
        let clearance_m = [belief.position_m, ahead]
            .iter()
            .filter_map(|p| site.nearest(*p, MAX_PACE_CLEARANCE_M, self.now))
            .fold(MAX_PACE_CLEARANCE_M, |least, near| near.distance_m.min(least));
        let free_m = (clearance_m - 0.5 * self.config.vehicle.hull.tip_to_tip_m).max(0.0);
        let cued = self.now < self.guidance.cued_until;
        let preferred = if cued { RETURN_PACE_M_S } else { preferred };
        self.guidance.pace_m_s = preferred.min(free_m / skill.time_gap_s).max(if cued { 0.0 } else { MIN_PACE_M_S });
        self.follow_off_path_cue();
    }

    /// Notices the cue that the aircraft is off the path: the pilot returns before continuing along it.
    fn follow_off_path_cue(&mut self) {
        let (Some(task), Some(seen)) = (self.guidance.task(), self.perception.delayed_view(self.config.skill.delay_s)) else {
            self.guidance.off_path_since = None;
            return;
        };
        let (task, feedback) = (&self.config.scenario.tasks[task], &self.config.scenario.feedback);
        let distance_m = distance_to_path_m(task, seen.position_m);
        if distance_m <= task.threshold_m || distance_m > feedback.off_path_max_m {
            self.guidance.off_path_since = None;
            return;
        }
        let since = *self.guidance.off_path_since.get_or_insert(self.now);
        if self.now - since >= feedback.off_path_delay + SimTime::from_s(self.config.skill.notice_cue_s) {
            self.guidance.cued_until = self.now + SimTime::from_s(CUE_ATTENTION_S);
        }
    }

    /// Returns the leg's command, or `None` if the leg has just ended.
    fn follow(&mut self, belief: &MotionState) -> Option<TrackCommand> {
        let flight = &mut self.guidance;
        let (job, leg) = flight.leg.as_ref()?;
        if (self.now - flight.best_since).s() > STALL_TIMEOUT_S {
            leg.pass_turn(&mut flight.progress);
            flight.best_since = self.now;
        }
        let wish = leg.command(&mut flight.progress, belief, &self.config.skill, flight.pace_m_s);
        let holding = flight.hold.is_some();
        let pausing = holding || flight.target.is_some() || self.now < flight.look_until || self.now < flight.back_off_until;
        if flight.progress.along_m > flight.best_along_m + 0.3 || pausing {
            flight.best_along_m = flight.best_along_m.max(flight.progress.along_m);
            flight.best_since = self.now;
        }
        let (job, arrived) = (*job, (wish.done || holding) && flight.target.is_none());
        let ended = arrived
            && match job {
                FlightGoal::Task(task) => self.has_held(task),
                FlightGoal::Home => true,
            };
        if !ended {
            return Some(wish);
        }
        self.guidance.leg = None;
        match job {
            FlightGoal::Task(_) => self.tasks_flown += 1,
            FlightGoal::Home => self.enter(PilotPhase::Descend),
        }
        None
    }

    /// Stops at intervals along a task to look at the surface, if the job has defects to find.
    fn look_around(&mut self, belief: &MotionState, wish: &mut TrackCommand) {
        let nothing_to_find = self.site.as_ref().is_none_or(|site| site.defects().is_empty());
        let (skill, flight) = (&self.config.skill, &mut self.guidance);
        if flight.target.is_some() || wish.task.is_none() || nothing_to_find {
            return;
        }
        if flight.progress.along_m >= flight.next_look_m {
            flight.next_look_m = flight.progress.along_m + skill.look_spacing_m * self.choices.range(0.7, 1.3);
            flight.looks = LookDirection::ALL.into_iter().rev().collect();
            flight.look_until = self.now;
        }
        if self.now >= flight.look_until && flight.looks.pop().is_some() {
            flight.look_duration_s = skill.look_duration_s * math::exp(LOOK_DURATION_SIGMA_LN * self.choices.normal());
            flight.look_since = self.now;
            flight.look_until = self.now + SimTime::from_s(flight.look_duration_s);
        }
        if self.now < flight.look_until {
            wish.velocity_m_s = Vec3::zero();
            wish.hands_off = true;
            let direction = LookDirection::ALL[(LookDirection::ALL.len() - 1).saturating_sub(flight.looks.len())];
            let (look, sweep_rad) = (wish.line_of_sight, skill.look_sweep_deg.to_radians());
            wish.line_of_sight = look.map(|look| turned(look, direction, sweep_rad, belief.yaw_rad));
            // The look begins once the camera has turned.
            let error_rad =
                wish.line_of_sight.map_or(0.0, |look| aim_error_rad(look, belief.yaw_rad, self.link.status.gimbal_pitch_rad));
            if error_rad > MAX_LOOK_ERROR_RAD && (self.now - flight.look_since).s() < MAX_TURN_TIME_S {
                flight.look_until = self.now + SimTime::from_s(flight.look_duration_s);
            }
        }
    }

    /// Returns a velocity correction away from visible obstacles; backs off after a setback.
    fn avoid_obstacles(&mut self, belief: &MotionState) -> Vec3<Enu> {
        let Some(site) = self.site.clone() else { return Vec3::zero() };
        let safe_m = 0.5 * self.config.vehicle.hull.tip_to_tip_m + 0.7;
        let Some(near) = site.nearest(belief.position_m, safe_m + 1.0, self.now) else { return Vec3::zero() };
        if (self.now - self.guidance.best_since).s() > STUCK_TIMEOUT_S {
            self.suffer_setback(belief);
        }
        let gap = (safe_m - near.distance_m).max(0.0);
        let push = near.normal * (1.5 * self.config.skill.gain * gap);
        if self.now >= self.guidance.back_off_until {
            return push;
        }
        let up = Vec3::new(0.0, 0.0, 1.0);
        let room_above = site.ray(belief.position_m, up, CLIMB_ROOM_M, self.now).is_none();
        let climb_m_s = if room_above { BACK_OFF_CLIMB_M_S } else { 0.0 };
        push + near.normal * BACK_OFF_SPEED_M_S + up * climb_m_s
    }

    /// Checks whether the drone's nose points at the pilot, who stands beside the landing pad.
    pub(super) fn faces_pilot(&self, motion: &MotionState) -> bool {
        let way = self.config.scenario.ground_team.inspector_m - motion.position_m;
        let (bearing_rad, _) = heading_and_elevation(way.unit());
        math::wrap_pi(bearing_rad - motion.yaw_rad).abs() < FACING_ANGLE_RAD
    }

    /// Controls the lamp and gimbal, and takes a picture if a distractor triggered one.
    fn control_payload(&mut self, wish: &TrackCommand) {
        if self.guidance.distractor_trigger.is_some_and(|at| at <= self.now) {
            self.guidance.distractor_trigger = None;
            self.trigger_camera();
        }
        let dark = wish.task.is_some_and(|t| self.config.scenario.tasks[t].dark);
        if dark != self.lamp && self.config.vehicle.lamp.luminous_flux_lm > 0.0 {
            self.lamp = dark;
            self.link.send_command(MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, [f32::from(u8::from(dark)), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
        let pitch = wish.line_of_sight.map_or(0.0, |look| heading_and_elevation(look).1);
        let camera = &self.config.vehicle.camera;
        let pitch = pitch.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad);
        if (pitch - self.gimbal_rad).abs() > 0.04 && (self.now - self.gimbal_sent).s() > 0.2 {
            self.gimbal_rad = pitch;
            self.gimbal_sent = self.now;
            // A yaw of 0 follows the heading. PX4 would ignore the pitch without a yaw.
            let nan = f32::NAN;
            let degrees = pitch.to_degrees() as f32;
            self.link.send_command(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, [degrees, 0.0, nan, nan, 0.0, 0.0, 0.0]);
        }
    }
}

/// Returns a line of sight turned by `sweep_rad` in a direction. A camera that looks straight up or down uses the drone's heading
/// to tell left from right.
fn turned(look: Vec3<Enu>, direction: LookDirection, sweep_rad: f64, yaw_rad: f64) -> Vec3<Enu> {
    let level = look.horizontal_norm();
    let heading_rad = if level > MIN_HORIZONTAL { heading_and_elevation(look).0 } else { yaw_rad };
    let (sh, ch) = math::sin_cos(heading_rad);
    let right = Vec3::new(ch, -sh, 0.0);
    let up = right.cross(look).unit();
    let (to_right, to_up) = direction.components();
    let (sin, cos) = math::sin_cos(sweep_rad);
    (look * cos + (right * to_right + up * to_up) * sin).unit()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-12;

    #[test]
    fn exact_looks_turn_by_the_sweep_in_their_direction() {
        let north = Vec3::new(0.0, 1.0, 0.0);
        let up = Vec3::new(0.0, 0.0, 1.0);
        let quarter = math::FRAC_PI_2;
        let cases = [
            (north, LookDirection::Right, Vec3::new(1.0, 0.0, 0.0)),
            (north, LookDirection::Left, Vec3::new(-1.0, 0.0, 0.0)),
            (north, LookDirection::Up, up),
            (north, LookDirection::Down, -up),
            // Under an arch, with the drone's nose to the east.
            (up, LookDirection::Right, Vec3::new(0.0, -1.0, 0.0)),
            (up, LookDirection::Down, Vec3::new(1.0, 0.0, 0.0)),
        ];
        for (look, direction, expected) in cases {
            let seen = turned(look, direction, quarter, quarter);
            assert!((seen - expected).norm() < TOLERANCE, "{look:?} {direction:?}: {seen:?}");
        }
    }
}
