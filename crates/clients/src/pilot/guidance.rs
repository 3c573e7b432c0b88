//! In-flight guidance: follows the leg, avoids obstacles, searches for defects, takes pictures, and recovers from
//! upsets.

use super::config::PilotConfig;
use super::goals::{FlightGoal, PlanningContext};
use super::guidance_state::PhotoTarget;
use super::perception::MotionState;
use super::stick_command::{heading_and_elevation, sticks};
use super::stick_response::StickAxes;
use super::track::TrackCommand;
use super::visual_search::{Glimpse, camera_pose};
use super::{Pilot, PilotPhase};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::dialect::MavCmd;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::DefectView;
use spandrel_model::time::SimTime;

/// Minimum time without progress before the aircraft counts as stuck, s.
const STUCK_TIMEOUT_S: f64 = 6.0;
/// Duration of the back-off maneuver after getting stuck, s.
const BACK_OFF_DURATION_S: f64 = 2.0;
/// Maximum duration of an approach to a noticed defect, s.
const MAX_INSPECTION_DURATION_S: f64 = 7.0;
/// Minimum battery level for continuing the job, %.
const MIN_BATTERY_PCT: f64 = 12.0;
/// Maximum aiming error for taking a picture, rad.
const MAX_AIM_ERROR_RAD: f64 = 0.12;
/// Maximum number of picture attempts per defect.
const MAX_PICTURE_ATTEMPTS: u32 = 2;
/// Time to ignore a poorly visible defect, s; it may be easier to see from farther along the path (estimate).
const IGNORE_DEFECT_DURATION_S: f64 = 15.0;
/// Standard deviation of a trained pilot's visual estimate of the incidence angle, rad (4 degrees; estimate).
const ANGLE_JUDGMENT_SIGMA_RAD: f64 = 0.07;
/// Relative standard deviation of a trained pilot's estimates of size and brightness on a screen (estimate).
const SIZE_JUDGMENT_SIGMA: f64 = 0.15;

impl Pilot {
    /// Runs one control step in the flight phase and returns the stick axes.
    pub(super) fn fly(&mut self, belief: &MotionState) -> StickAxes {
        if !self.link.status.armed && self.phase_time_s() > 1.0 {
            return self.recover_from_disarm();
        }
        self.plan_next_leg(belief);
        let Some(mut wish) = self.follow(belief) else { return [0.0; 4] };
        self.search_picture(belief, &mut wish);
        self.control_payload(&wish, belief);
        wish.velocity_m_s += self.avoid_obstacles(belief);
        // The pilot misjudges speed, so the actual velocity differs from the intended one.
        wish.velocity_m_s = wish.velocity_m_s / self.perception.perceived_speed_ratio();
        sticks(wish.velocity_m_s, belief, wish.line_of_sight, &self.config)
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
        if self.link.status.battery_pct.is_some_and(|pct| pct < MIN_BATTERY_PCT)
            && !matches!(self.guidance.leg, Some((FlightGoal::Home, _)))
        {
            self.goals = [FlightGoal::Home].into();
            self.guidance.leg = None;
        }
        match (&self.guidance.leg, self.guidance.needs_plan) {
            (Some((job, leg)), true) => {
                let (job, fresh) = (*job, map.resume(leg, self.guidance.progress.next, belief.position_m));
                self.guidance.begin_leg(fresh, job, self.now);
            }
            (None, _) => {
                let Some(job) = self.goals.pop_front() else { return };
                let leg = map.leg(job, belief.position_m);
                self.guidance.begin_leg(leg, job, self.now);
            }
            (Some(_), false) => {}
        }
    }

    /// Returns the leg's command, or `None` if the leg has just ended.
    fn follow(&mut self, belief: &MotionState) -> Option<TrackCommand> {
        let flight = &mut self.guidance;
        let (job, leg) = flight.leg.as_ref()?;
        let wish = leg.command(&mut flight.progress, belief, &self.config.skill);
        if flight.progress.along_m > flight.best_along_m + 0.3 || flight.target.is_some() {
            flight.best_along_m = flight.best_along_m.max(flight.progress.along_m);
            flight.best_since = self.now;
        }
        if wish.done && flight.target.is_none() {
            let job = *job;
            flight.leg = None;
            match job {
                FlightGoal::Task(_) => self.tasks_flown += 1,
                FlightGoal::Home => self.enter(PilotPhase::Descend),
            }
            return None;
        }
        Some(wish)
    }

    /// Returns a velocity correction away from visible obstacles; backs off if the aircraft is stuck.
    fn avoid_obstacles(&mut self, belief: &MotionState) -> Vec3<Enu> {
        let Some(site) = &self.site else { return Vec3::zero() };
        let safe_m = 0.5 * self.config.vehicle.hull.tip_to_tip_m + 0.7;
        let Some(near) = site.nearest(belief.position_m, safe_m + 1.0, self.now) else { return Vec3::zero() };
        if (self.now - self.guidance.best_since).s() > STUCK_TIMEOUT_S {
            self.guidance.best_since = self.now;
            self.guidance.back_off_until = self.now + SimTime::from_s(BACK_OFF_DURATION_S);
            self.guidance.needs_plan = true;
        }
        let push = if self.now < self.guidance.back_off_until { 1.5 } else { 0.0 };
        let gap = (safe_m - near.distance_m).max(0.0);
        near.normal * (push + 1.5 * self.config.skill.gain * gap)
    }

    /// Searches the picture and points the camera at a noticed defect.
    fn search_picture(&mut self, belief: &MotionState, wish: &mut TrackCommand) {
        self.glimpse(wish.task.is_some());
        let Some(target) = self.guidance.target else { return };
        if (self.now - target.since).s() > MAX_INSPECTION_DURATION_S || target.attempts >= MAX_PICTURE_ATTEMPTS {
            if target.attempts == 0 {
                self.visual_search.ignore_until(target.defect, self.now + SimTime::from_s(IGNORE_DEFECT_DURATION_S));
            }
            self.guidance.target = None;
            return;
        }
        let line = target.position_m - belief.position_m;
        wish.line_of_sight = Some(line.unit());
        // Slowly approaches a point along the defect's normal, no farther out than the corridor allows.
        let threshold_m = wish.task.map_or(2.0, |t| self.config.scenario.tasks[t].threshold_m);
        let stand_m = target.normal * line.norm().clamp(2.0, 6.0);
        let shift = (target.position_m + stand_m - belief.position_m).limited(0.5 * threshold_m);
        let pull_back = wish.velocity_m_s - wish.velocity_m_s.unit() * wish.velocity_m_s.norm().min(3.0);
        wish.velocity_m_s = pull_back + shift * 0.25;
        self.photograph(target, line, belief);
    }

    fn glimpse(&mut self, working: bool) {
        let skill = self.config.skill;
        let Some(picture) = self.perception.delayed_view(skill.delay_s) else { return };
        let Some(site) = &self.site else { return };
        let vehicle = &self.config.vehicle;
        let pose = camera_pose(&picture, self.link.status.gimbal_pitch_rad, self.lamp, vehicle);
        let views = || site.view_defects(&pose, &vehicle.camera, &vehicle.lamp, picture.time);
        if self.guidance.target.is_some() || !working || self.stick_response.is_lapsed(self.now) {
            return;
        }
        match self.visual_search.glimpse(views, site, &skill, self.now, true) {
            Glimpse::Defect { id, judgment_error } => {
                self.guidance.target = site.defects().iter().find(|d| d.id == id).map(|d| PhotoTarget {
                    defect: id,
                    position_m: d.position_m,
                    normal: d.normal,
                    since: self.now,
                    triggered: None,
                    attempts: 0,
                    judgment_error,
                });
            }
            Glimpse::Distractor => self.guidance.distractor_trigger = Some(self.now + SimTime::from_s(skill.delay_s)),
            Glimpse::Nothing => {}
        }
    }

    /// Takes a picture when the camera is aimed and the defect seems well framed; retries if the result looks poor.
    fn photograph(&mut self, mut target: PhotoTarget, line: Vec3<Enu>, belief: &MotionState) {
        if let Some(pressed) = target.triggered {
            if (self.now - pressed).s() < 0.6 + self.config.skill.delay_s {
                return;
            }
            if self.is_well_framed(&target) {
                self.guidance.target = None;
                return;
            }
            target.triggered = None;
        }
        let (yaw, pitch) = heading_and_elevation(line.unit());
        let off = math::wrap_pi(yaw - belief.yaw_rad).abs().max((pitch - self.link.status.gimbal_pitch_rad).abs());
        if off < MAX_AIM_ERROR_RAD && belief.velocity_m_s.norm() < 0.8 && self.is_well_framed(&target) {
            target.triggered = Some(self.now);
            target.attempts += 1;
            self.trigger_camera();
        }
        self.guidance.target = Some(target);
    }

    /// Checks whether this pilot considers the defect well framed on the screen.
    fn is_well_framed(&self, target: &PhotoTarget) -> bool {
        let (vehicle, skill) = (&self.config.vehicle, self.config.skill);
        let (Some(site), Some(picture)) = (&self.site, self.perception.delayed_view(skill.delay_s)) else { return true };
        let pose = camera_pose(&picture, self.link.status.gimbal_pitch_rad, self.lamp, vehicle);
        let views = site.view_defects(&pose, &vehicle.camera, &vehicle.lamp, picture.time);
        let error = skill.noise * target.judgment_error;
        let flattered = math::exp(SIZE_JUDGMENT_SIGMA * error);
        views.iter().find(|view| view.defect_id == target.defect).is_some_and(|view| {
            let seen = DefectView {
                incidence_rad: view.incidence_rad - ANGLE_JUDGMENT_SIGMA_RAD * error,
                extent_px: view.extent_px * flattered,
                width_px: view.width_px * flattered,
                illuminance_lux: view.illuminance_lux * flattered,
                ..*view
            };
            seen.conditions().iter().all(|condition| *condition)
        })
    }

    fn trigger_camera(&mut self) {
        self.pictures += 1;
        let mut params = [0.0; 7];
        params[2] = 1.0;
        self.link.send_command_to(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, params);
    }

    /// Controls the lamp and gimbal, and takes a picture if a distractor triggered one.
    fn control_payload(&mut self, wish: &TrackCommand, _belief: &MotionState) {
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
