//! Draws camera poses along and around the reference paths of a scenario's tasks, and toward its defects: at varied distances and angles,
//! with a clear line of sight and room for an aircraft.

use crate::camera::PinholeCamera;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{PlacedDefect, Scenario, Task};
use spandrel_model::site::visibility::required_illuminance_lux;
use spandrel_model::site::{CameraPose, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Share of the pictures that aim at a defect, if there are defects. The others aim at the surface beside the path, as found in an
/// inspection, and many of them show no defect (estimate: detectors need both).
const DEFECT_SHARE: f64 = 0.6;
/// Distance from a defect, as a multiple of the nearest task's stand-off.
const DEFECT_DISTANCE_RATIO: (f64, f64) = (0.35, 1.6);
/// Largest angle between the line of sight and a defect's normal, rad: 55 degrees. Pictures beyond 60 degrees don't count in a flight.
const MAX_TILT_RAD: f64 = 55.0 * math::PI / 180.0;
/// Largest distance of a defect from the center, as a fraction of half the picture's size.
const DEFECT_OFFSET: f64 = 0.65;
/// Displacement from a path toward the surface, as a multiple of the stand-off; negative values are farther away.
const PATH_STEP_RATIO: (f64, f64) = (-0.5, 0.6);
/// Largest displacement from a path along each axis, as a fraction of the task's threshold.
const PATH_DRIFT_RATIO: f64 = 0.5;
/// Largest turn away from a path's viewing direction, as a fraction of half the field of view.
const PATH_TURN: f64 = 0.8;
/// Stand-off of a task without a surface at a fixed distance, m: the default of a task's stand-off.
const DEFAULT_STAND_OFF_M: f64 = 4.0;
/// Minimum distance of the camera from any surface, m (half of 0.59 m tip to tip, plus a margin for position errors; estimate).
const MIN_CLEARANCE_M: f64 = 1.0;
/// Largest distance of the surface at the center of the picture, m. Farther away, no defect can be photographed.
const MAX_SURFACE_DISTANCE_M: f64 = spandrel_model::site::visibility::MAX_RANGE_M;
/// Height above a defect at which its line of sight ends, m.
const SURFACE_OFFSET_M: f64 = 0.02;
/// Share of the pictures with the lamp on although there is enough light (estimate: pilots leave it on).
const NEEDLESS_LAMP_SHARE: f64 = 0.2;
/// Times of the pictures after the scene's start, ms. Vehicles and people move; the sun hardly does.
const MAX_TIME_MS: usize = 600_000;
/// Attempts to draw a clear viewpoint.
const MAX_ATTEMPTS: u32 = 2000;

/// Object at which a picture aims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// The surface that a task inspects, with the task's number.
    Task(u32),
    /// A defect, with its number in the scene.
    Defect(u32),
}

/// Camera pose and time of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewpoint {
    /// Camera pose and lamp.
    pub pose: CameraPose,
    /// Object at which the picture aims.
    pub aim: Aim,
    /// Distance of the surface at the center of the picture, m.
    pub distance_m: f64,
    /// Simulation time.
    pub at: SimTime,
}

/// Reasons why no viewpoint can be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoViewpoint {
    /// The scenario has nothing to look at.
    #[error("scenario '{0}' has neither defects nor a task with a surface to inspect: no pictures can be drawn")]
    NothingToInspect(String),
    /// No attempt was clear of the surroundings and had a surface in view.
    #[error(
        "scenario '{0}': none of {MAX_ATTEMPTS} camera positions near the tasks' paths is clear and has a surface in view; `spandrel check` reports obstructed paths"
    )]
    Obstructed(String),
}

/// Draws viewpoints in a scene.
#[derive(Debug)]
pub struct Viewpoints<'a> {
    scenario: &'a Scenario,
    vehicle: &'a Vehicle,
    site: &'a Site,
    aspect: f64,
    stream: RandomStream,
}

impl<'a> Viewpoints<'a> {
    /// Starts the sequence of a scene's seed. `aspect` is the pictures' width over their height.
    #[must_use]
    pub fn new(scenario: &'a Scenario, vehicle: &'a Vehicle, site: &'a Site, aspect: f64, seed: u64) -> Self {
        Self { scenario, vehicle, site, aspect, stream: RandomStream::new(seed, "view.dataset.viewpoints") }
    }

    /// Draws the next viewpoint.
    ///
    /// # Errors
    /// Returns an error if the scenario has nothing to look at, or if no position is clear.
    pub fn draw(&mut self) -> Result<Viewpoint, NoViewpoint> {
        let inspecting = self.scenario.tasks.iter().any(inspects);
        if self.site.defects().is_empty() && !inspecting {
            return Err(NoViewpoint::NothingToInspect(self.scenario.name.clone()));
        }
        for _ in 0..MAX_ATTEMPTS {
            let at = SimTime::from_ms(self.stream.below(MAX_TIME_MS) as i64);
            let aims_at_defect = self.stream.uniform() < DEFECT_SHARE;
            let found = if !self.site.defects().is_empty() && (aims_at_defect || !inspecting) {
                self.toward_defect(at)
            } else {
                self.beside_path(at)
            };
            if let Some((pose, aim)) = found
                && let Some(viewpoint) = self.cleared(pose, aim, at)
            {
                return Ok(viewpoint);
            }
        }
        Err(NoViewpoint::Obstructed(self.scenario.name.clone()))
    }

    /// Draws a pose with a defect in the picture; `None` if something is in front of the defect.
    fn toward_defect(&mut self, at: SimTime) -> Option<(CameraPose, Aim)> {
        let defect = &self.site.defects()[self.stream.below(self.site.defects().len())];
        let (near, far) = DEFECT_DISTANCE_RATIO;
        let ratio = math::exp(self.stream.range(math::ln(near), math::ln(far)));
        let distance_m = ratio * self.stand_off_m(defect);
        let out = self.direction_about(defect);
        let eye_m = defect.position_m + out * distance_m;
        let start_m = defect.position_m + defect.normal * SURFACE_OFFSET_M;
        let line = eye_m - start_m;
        if self.site.ray(start_m, line.unit(), line.norm(), at).is_some() {
            return None;
        }
        Some((self.turned(eye_m, -out, DEFECT_OFFSET), Aim::Defect(defect.id)))
    }

    /// Draws a direction away from a defect's surface, with all solid angles up to the largest tilt equally likely.
    fn direction_about(&mut self, defect: &PlacedDefect) -> Vec3<Enu> {
        let cosine = self.stream.range(math::cos(MAX_TILT_RAD), 1.0);
        let (s, c) = math::sin_cos(self.stream.range(0.0, math::TAU));
        let across = defect.normal.cross(defect.along);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        (defect.normal * cosine + (defect.along * c + across * s) * sine).unit()
    }

    /// Draws a pose beside a task's path; `None` if something is between the path and the pose.
    fn beside_path(&mut self, at: SimTime) -> Option<(CameraPose, Aim)> {
        let all = || self.scenario.tasks.iter().filter(|task| inspects(task));
        let mut index = self.stream.below(all().map(|task| task.path_m.len()).sum());
        let task = all().find(|task| {
            let here = index < task.path_m.len();
            if !here {
                index -= task.path_m.len();
            }
            here
        })?;
        let (start_m, view) = (task.path_m[index], task.viewing_directions[index]);
        let step_m = self.stream.range(PATH_STEP_RATIO.0, PATH_STEP_RATIO.1) * stand_off_m(task);
        let drift_m = [0, 1, 2].map(|_| self.stream.range(-1.0, 1.0) * PATH_DRIFT_RATIO * task.threshold_m);
        let eye_m = start_m + view * step_m + Vec3::new(drift_m[0], drift_m[1], drift_m[2]);
        let line = eye_m - start_m;
        if line.norm() > 0.0 && self.site.ray(start_m, line.unit(), line.norm(), at).is_some() {
            return None;
        }
        Some((self.turned(eye_m, view, PATH_TURN), Aim::Task(task.id)))
    }

    /// Returns a roll-free pose whose axis is turned away from a view by a random part of the picture.
    fn turned(&mut self, eye_m: Vec3<Enu>, view: Vec3<Enu>, fraction: f64) -> CameraPose {
        let lens = &self.vehicle.camera;
        let vfov_rad = 2.0 * math::atan(math::tan(0.5 * lens.hfov_rad) / self.aspect);
        let (x, y) = (self.stream.range(-fraction, fraction), self.stream.range(-fraction, fraction));
        let forward = PinholeCamera::at(eye_m, eye_m + view, vfov_rad, self.aspect).ray(x, y, self.aspect);
        crate::stage::camera_aimed_at(eye_m, eye_m + forward, false)
    }

    /// Returns the viewpoint with the lamp set by the light, if an aircraft has room there and its gimbal reaches the direction.
    fn cleared(&mut self, pose: CameraPose, aim: Aim, at: SimTime) -> Option<Viewpoint> {
        let lens = &self.vehicle.camera;
        let pitch_rad = math::asin(pose.forward.up().clamp(-1.0, 1.0));
        let in_reach = (lens.gimbal_pitch_min_rad..=lens.gimbal_pitch_max_rad).contains(&pitch_rad);
        if !in_reach || !self.has_room(pose.position_m, at) {
            return None;
        }
        let hit = self.site.ray(pose.position_m, pose.forward, MAX_SURFACE_DISTANCE_M, at)?;
        let lux = self.site.ambient_lux(pose.position_m + pose.forward * hit.distance_m, Some(hit.normal), at);
        let needless = self.stream.uniform() < NEEDLESS_LAMP_SHARE;
        let lamp_on =
            self.vehicle.lamp.luminous_flux_lm > 0.0 && (needless || lux < required_illuminance_lux(&self.vehicle.camera));
        Some(Viewpoint { pose: CameraPose { lamp_on, ..pose }, aim, distance_m: hit.distance_m, at })
    }

    fn has_room(&self, position_m: Vec3<Enu>, at: SimTime) -> bool {
        let (east_m, north_m) = (position_m.east(), position_m.north());
        let floor_m = self.site.ground_up_m(east_m, north_m).max(self.site.water_up_m(east_m, north_m).unwrap_or(f64::MIN));
        position_m.up() >= floor_m + MIN_CLEARANCE_M && self.site.nearest(position_m, MIN_CLEARANCE_M, at).is_none()
    }

    /// Returns the stand-off of the task whose path is nearest to a defect, m.
    fn stand_off_m(&self, defect: &PlacedDefect) -> f64 {
        let distance = |task: &Task| {
            task.path_m.iter().map(|point| (*point - defect.position_m).norm_squared()).fold(f64::INFINITY, f64::min)
        };
        let tasks = self.scenario.tasks.iter();
        tasks.min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(DEFAULT_STAND_OFF_M, stand_off_m)
    }
}

fn inspects(task: &Task) -> bool {
    task.inspects_surface && !task.path_m.is_empty()
}

fn stand_off_m(task: &Task) -> f64 {
    task.stand_off.as_ref().map_or(DEFAULT_STAND_OFF_M, |stand_off| stand_off.recommended_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    /// Angle by which rounding may move a direction, rad.
    const ROUNDING_RAD: f64 = 1e-9;
    const ASPECT: f64 = 4.0 / 3.0;

    fn job(text: &str) -> Scenario {
        scenario::read("job.toml", text, &|_| Err("none".into())).unwrap()
    }

    fn phantom() -> Vehicle {
        spandrel_model::vehicle::read("phantom2.toml", shipped::PHANTOM2).unwrap()
    }

    #[test]
    fn prop_viewpoints_are_clear_and_show_what_they_aim_at() {
        let (scenario, vehicle) = (job(shipped::GIRDER), phantom());
        let site = Site::build(&scenario, 7);
        let mut viewpoints = Viewpoints::new(&scenario, &vehicle, &site, ASPECT, 7);
        let (half_w, half_h) = {
            let w = math::tan(0.5 * vehicle.camera.hfov_rad);
            (w, w / ASPECT)
        };
        let mut distances_m = Vec::new();
        for _ in 0..200 {
            let viewpoint = viewpoints.draw().unwrap();
            let pose = &viewpoint.pose;
            assert!(site.nearest(pose.position_m, MIN_CLEARANCE_M, viewpoint.at).is_none(), "{viewpoint:?}");
            assert!(pose.right.up().abs() < ROUNDING_RAD, "a gimbal keeps the camera free of roll: {viewpoint:?}");
            let hit = site.ray(pose.position_m, pose.forward, MAX_SURFACE_DISTANCE_M, viewpoint.at).unwrap();
            assert_eq!(hit.distance_m, viewpoint.distance_m);
            if let Aim::Defect(id) = viewpoint.aim {
                let defect = site.defects().iter().find(|defect| defect.id == id).unwrap();
                let to = defect.position_m - pose.position_m;
                let depth_m = to.dot(pose.forward);
                let (x, y) = (to.dot(pose.right) / depth_m / half_w, to.dot(pose.right.cross(pose.forward)) / depth_m / half_h);
                assert!(depth_m > 0.0 && x.abs() < 1.0 && y.abs() < 1.0, "{viewpoint:?}: {x} {y}");
                assert!(math::acos(-to.unit().dot(defect.normal)) <= MAX_TILT_RAD + ROUNDING_RAD, "{viewpoint:?}");
                distances_m.push(to.norm());
            }
        }
        distances_m.sort_by(f64::total_cmp);
        assert!(distances_m.len() > 80, "most pictures aim at defects: {}", distances_m.len());
        assert!(distances_m[distances_m.len() * 9 / 10] > 2.0 * distances_m[distances_m.len() / 10], "distances must vary");
    }

    #[test]
    fn exact_same_seed_yields_the_same_viewpoints() {
        let (scenario, vehicle) = (job(shipped::GIRDER), phantom());
        let site = Site::build(&scenario, 7);
        let draw = |seed| {
            let mut viewpoints = Viewpoints::new(&scenario, &vehicle, &site, ASPECT, seed);
            (0..20).map(|_| viewpoints.draw().unwrap()).collect::<Vec<_>>()
        };
        assert_eq!(draw(3), draw(3));
        assert_ne!(draw(3), draw(4));
    }

    #[test]
    fn exact_jobs_without_surface_and_defects_are_refused() {
        let text = shipped::SCENARIOS.iter().find(|(name, _)| *name == "drill-landing").unwrap().1;
        let (scenario, vehicle) = (job(text), phantom());
        let site = Site::build(&scenario, 1);
        let refused = Viewpoints::new(&scenario, &vehicle, &site, ASPECT, 1).draw().unwrap_err();
        assert_eq!(refused, NoViewpoint::NothingToInspect("drill-landing".into()));
    }
}
