//! Photographing a noticed defect as a person does: fly there, release the sticks, frame, wait until the image is steady,
//! press, look at the result, and repeat if in doubt.

use super::Pilot;
use super::goals::FlightGoal;
use super::guidance_state::{PhotoPhase, PhotoTarget};
use super::perception::MotionState;
use super::photo_spot::{self, SpotWishes};
use super::stick_command::aim_error_rad;
use super::track::TrackCommand;
use super::visual_search::{Glimpse, MAX_SEARCH_DISTANCE_M, camera_pose};
use spandrel_mavlink::dialect::MavCmd;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::DefectView;
use spandrel_model::site::visibility::is_framed;
use spandrel_model::time::SimTime;

/// Standard deviation of a trained pilot's visual estimate of the incidence angle, rad (4 degrees; estimate).
const ANGLE_JUDGMENT_SIGMA_RAD: f64 = 0.07;
/// Relative standard deviation of a trained pilot's estimates of size and brightness on a screen (estimate).
const SIZE_JUDGMENT_SIGMA: f64 = 0.15;
/// Distance to the spot at which the pilot stops, m (estimate).
const ARRIVAL_DISTANCE_M: f64 = 0.5;
/// Distance from the spot at which the pilot flies back to it, m (estimate).
const DRIFTED_DISTANCE_M: f64 = 1.3;
/// Distance to the spot at which the pilot leaves the path, m (estimate: within the picture).
const LEAVING_DISTANCE_M: f64 = 3.5;
/// Time to look at a picture that was taken, s (estimate: three fixations).
const REVIEW_TIME_S: f64 = 0.9;
/// Approach speed near the surface, m/s (estimate).
const APPROACH_SPEED_M_S: f64 = 1.0;
/// Maximum number of pictures of one defect.
const MAX_SHOTS: u32 = 3;
/// Time to ignore a defect that can't be photographed from here, s; it may be easier from farther along the path (estimate).
const IGNORE_DEFECT_DURATION_S: f64 = 6.0;
/// Time to ignore a defect that is nearer to the path of a later task, s (estimate: about the duration of a task).
const POSTPONED_DURATION_S: f64 = 40.0;
/// Number of spots that a pilot tries if the picture on the screen does not seem good.
const MAX_POOR_SPOTS: u32 = 2;
/// Distance by which the next spot differs from a poor one, m (estimate).
const NEXT_SPOT_DISTANCE_M: f64 = 1.0;

impl Pilot {
    /// Searches the picture, and photographs a noticed defect.
    pub(super) fn search_picture(&mut self, belief: &MotionState, wish: &mut TrackCommand) {
        self.fixate(wish.task, belief);
        let Some(target) = self.guidance.target else { return };
        if (self.now - target.since).s() > self.config.skill.patience_s {
            self.drop_target(&target);
            return;
        }
        match target.phase {
            PhotoPhase::Noticed => self.await_spot(target, belief),
            PhotoPhase::Approach => self.approach_spot(target, belief, wish),
            PhotoPhase::Settle { steady_since } => self.settle(target, steady_since, belief, wish),
            PhotoPhase::Review { pressed, view } => self.review(target, pressed, view, belief, wish),
        }
    }

    fn drop_target(&mut self, target: &PhotoTarget) {
        if target.shots == 0 {
            self.visual_search.ignore_until(target.defect, self.now + SimTime::from_s(IGNORE_DEFECT_DURATION_S));
        }
        self.guidance.target = None;
    }

    /// Examines the picture with one fixation, if it is due.
    fn fixate(&mut self, task: Option<usize>, belief: &MotionState) {
        let skill = self.config.skill;
        let busy = self.guidance.target.is_some() || self.hand_motion.is_lapsed(self.now);
        let (Some(task), false, true) = (task, busy, self.visual_search.is_due(self.now)) else { return };
        let (Some(picture), Some(site)) = (self.perception.delayed_view(skill.delay_s), &self.site) else { return };
        let vehicle = &self.config.vehicle;
        let pose = camera_pose(&picture, self.link.status.gimbal_pitch_rad, self.lamp, vehicle);
        let is_near = |defect: &PlacedDefect| (defect.position_m - pose.position_m).norm() <= MAX_SEARCH_DISTANCE_M;
        // The light on a defect takes many rays, so it is computed only where the pilot could recognize something.
        let candidates: Vec<_> = site
            .defects()
            .iter()
            .filter(|defect| is_near(defect) && self.visual_search.is_open(defect.id, self.now))
            .filter(|defect| is_framed(defect, &pose, &vehicle.camera))
            .collect();
        let optics = (&vehicle.camera, &vehicle.lamp);
        let views = candidates.into_iter().filter_map(|defect| site.view_defect(defect, &pose, optics, picture.time));
        match self.visual_search.fixate(views, site, &skill, self.now) {
            Glimpse::Defect { id, judgment_error } => self.take_up(task, id, judgment_error, belief),
            Glimpse::Distractor => self.guidance.distractor_trigger = Some(self.now + SimTime::from_s(skill.delay_s)),
            Glimpse::Nothing => {}
        }
    }

    /// Chooses where to photograph a noticed defect from.
    fn take_up(&mut self, task: usize, id: u32, judgment_error: f64, belief: &MotionState) {
        let (scenario, wishes) = (&self.config.scenario, self.spot_wishes());
        let Some(site) = &self.site else { return };
        let Some(defect) = site.defects().iter().find(|defect| defect.id == id) else { return };
        let is_nearer_later = |goal: &FlightGoal| match goal {
            FlightGoal::Task(later) => photo_spot::distance_to_path_m(&scenario.tasks[*later], defect) < wishes.distance_m,
            FlightGoal::Home => false,
        };
        let too_far_now = photo_spot::distance_to_path_m(&scenario.tasks[task], defect) > wishes.distance_m;
        if too_far_now && self.goals.iter().any(is_nearer_later) {
            self.visual_search.ignore_until(id, self.now + SimTime::from_s(POSTPONED_DURATION_S));
            return;
        }
        let position_m = defect.position_m;
        let Some(spot_m) = self.find_spot(id, belief, None) else {
            self.visual_search.ignore_until(id, self.now + SimTime::from_s(IGNORE_DEFECT_DURATION_S));
            return;
        };
        self.guidance.target = Some(PhotoTarget {
            defect: id,
            position_m,
            spot_m,
            nearest_m: f64::INFINITY,
            since: self.now,
            phase: PhotoPhase::Noticed,
            shots: 0,
            poor_spots: 0,
            judgment_error,
        });
    }

    fn spot_wishes(&self) -> SpotWishes {
        let (skill, camera) = (&self.config.skill, &self.config.vehicle.camera);
        SpotWishes {
            distance_m: skill.photo_distance_ratio * photo_spot::job_distance_m(&self.config.scenario, camera),
            incidence_rad: skill.photo_incidence_deg.to_radians(),
        }
    }

    /// Chooses a spot for a defect, away from one that turned out to be poor.
    fn find_spot(&self, id: u32, belief: &MotionState, poor_m: Option<Vec3<Enu>>) -> Option<Vec3<Enu>> {
        let (site, task) = (self.site.as_ref()?, self.guidance.task()?);
        let defect = site.defects().iter().find(|defect| defect.id == id)?;
        let job = (&**site, &self.config.scenario.tasks[task], &*self.config.vehicle);
        let avoid = poor_m.map(|poor| (poor, NEXT_SPOT_DISTANCE_M));
        photo_spot::choose_spot(job, defect, self.spot_wishes(), (belief.position_m, avoid), self.now)
    }

    /// Follows the path until the spot is near, or no longer gets nearer.
    fn await_spot(&mut self, mut target: PhotoTarget, belief: &MotionState) {
        let distance_m = (target.spot_m - belief.position_m).norm();
        let receding = distance_m > target.nearest_m + 0.5;
        target.nearest_m = target.nearest_m.min(distance_m);
        if distance_m < LEAVING_DISTANCE_M || receding {
            let way = (belief.position_m, target.spot_m);
            let clear =
                self.site.as_ref().is_some_and(|site| photo_spot::is_way_clear(site, &self.config.vehicle, way, self.now));
            if clear {
                target.phase = PhotoPhase::Approach;
                target.since = self.now;
            } else if receding {
                self.drop_target(&target);
                return;
            }
        }
        self.guidance.target = Some(target);
    }

    fn approach_spot(&mut self, mut target: PhotoTarget, belief: &MotionState, wish: &mut TrackCommand) {
        let way = target.spot_m - belief.position_m;
        wish.line_of_sight = Some((target.position_m - belief.position_m).unit());
        wish.velocity_m_s = (way * (0.7 * self.config.skill.gain)).limited(APPROACH_SPEED_M_S);
        if way.norm() < ARRIVAL_DISTANCE_M {
            target.phase = PhotoPhase::Settle { steady_since: None };
        }
        self.guidance.target = Some(target);
    }

    /// Releases the sticks, turns toward the defect, and presses the shutter once the image is steady.
    fn settle(&mut self, mut target: PhotoTarget, steady_since: Option<SimTime>, belief: &MotionState, wish: &mut TrackCommand) {
        let skill = self.config.skill;
        let aimed = self.aim(&target, belief, wish);
        let turn_deg_s = self.perception.turn_rate_rad_s(skill.delay_s).abs().to_degrees();
        let steady = aimed && belief.velocity_m_s.norm() < skill.photo_speed_m_s && turn_deg_s < skill.photo_turn_deg_s;
        let since = if steady { Some(steady_since.unwrap_or(self.now)) } else { None };
        target.phase = PhotoPhase::Settle { steady_since: since };
        if (target.spot_m - belief.position_m).norm() > DRIFTED_DISTANCE_M {
            target.phase = PhotoPhase::Approach;
        } else if since.is_some_and(|since| (self.now - since).s() > skill.steady_s) {
            let view = self.view_of(target.defect);
            if !view.is_some_and(|view| self.seems_good(&view, target.judgment_error)) && target.poor_spots < MAX_POOR_SPOTS {
                self.try_another_spot(target, belief);
                return;
            }
            target.shots += 1;
            target.phase = PhotoPhase::Review { pressed: self.now, view };
            self.trigger_camera();
        }
        self.guidance.target = Some(target);
    }

    /// Chooses another spot, or gives the defect up, because it does not look good on the screen.
    fn try_another_spot(&mut self, mut target: PhotoTarget, belief: &MotionState) {
        target.poor_spots += 1;
        let spot = self.find_spot(target.defect, belief, Some(target.spot_m));
        let Some(spot_m) = spot.filter(|_| target.poor_spots < MAX_POOR_SPOTS) else {
            self.drop_target(&target);
            return;
        };
        target.spot_m = spot_m;
        target.phase = PhotoPhase::Approach;
        self.guidance.target = Some(target);
    }

    /// Stops, and points the camera at the defect. Returns whether it is framed.
    fn aim(&self, target: &PhotoTarget, belief: &MotionState, wish: &mut TrackCommand) -> bool {
        let line = (target.position_m - belief.position_m).unit();
        let error_rad = aim_error_rad(line, belief.yaw_rad, self.link.status.gimbal_pitch_rad);
        let aimed = error_rad < self.config.skill.framing_deg.to_radians();
        wish.velocity_m_s = Vec3::zero();
        wish.hands_off = true;
        wish.line_of_sight = Some(line);
        wish.turns = !aimed;
        aimed
    }

    fn review(
        &mut self,
        mut target: PhotoTarget,
        pressed: SimTime,
        view: Option<DefectView>,
        belief: &MotionState,
        wish: &mut TrackCommand,
    ) {
        self.aim(&target, belief, wish);
        wish.turns = false;
        let skill = self.config.skill;
        if (self.now - pressed).s() < REVIEW_TIME_S + skill.delay_s {
            return;
        }
        let good = view.is_some_and(|view| self.seems_good(&view, target.judgment_error));
        let again = !good || self.visual_search.doubts(&skill);
        if !again || target.shots >= MAX_SHOTS {
            self.guidance.target = None;
            return;
        }
        target.phase = PhotoPhase::Settle { steady_since: None };
        self.guidance.target = Some(target);
    }

    /// Returns how a defect looks in the present picture.
    fn view_of(&self, defect: u32) -> Option<DefectView> {
        let vehicle = &self.config.vehicle;
        let (site, picture) = (self.site.as_ref()?, self.perception.delayed_view(0.0)?);
        let pose = camera_pose(&picture, self.link.status.gimbal_pitch_rad, self.lamp, vehicle);
        let defect = site.defects().iter().find(|one| one.id == defect)?;
        site.view_defect(defect, &pose, (&vehicle.camera, &vehicle.lamp), picture.time)
    }

    /// Checks whether this pilot considers a picture good.
    fn seems_good(&self, view: &DefectView, judgment_error: f64) -> bool {
        let error = self.config.skill.noise * judgment_error;
        let flattered = math::exp(SIZE_JUDGMENT_SIGMA * error);
        let seen = DefectView {
            incidence_rad: view.incidence_rad - ANGLE_JUDGMENT_SIGMA_RAD * error,
            extent_px: view.extent_px * flattered,
            width_px: view.width_px * flattered,
            illuminance_lux: view.illuminance_lux * flattered,
            ..*view
        };
        seen.conditions().iter().all(|condition| *condition)
    }

    pub(super) fn trigger_camera(&mut self) {
        self.pictures += 1;
        let mut params = [0.0; 7];
        params[2] = 1.0;
        self.link.send_command_to(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, params);
    }
}
