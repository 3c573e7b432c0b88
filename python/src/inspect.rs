//! Inspect task: fly the job's reference paths and photograph its defects, evaluated with the monitor's measures.

use crate::environment::{self, MOTION_LEN, Outcome};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::CameraPose;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle as Aircraft;
use spandrel_monitor::measures::attention::SiteSurvey;
use spandrel_monitor::measures::coverage::FlownPath;
use spandrel_monitor::measures::on_path::ReferencePaths;
use spandrel_sitl::sim::Sim;
use std::collections::BTreeSet;

/// Maximum clearance measured, m (the vehicle's own limit for the clearance used in scoring).
const MAX_CLEARANCE_M: f64 = 30.0;

/// Progress of an inspection.
#[derive(Debug, Clone)]
pub struct Inspect {
    paths: ReferencePaths,
    viewing_directions: Vec<Vec<Vec3<Enu>>>,
    flown: Vec<FlownPath>,
    on: Option<usize>,
    /// Time of the last evaluation.
    evaluated_at: Option<SimTime>,
    found: BTreeSet<u32>,
    before: f64,
}

impl Inspect {
    /// Height above the pad at the start, m (estimate: out of ground effect).
    pub const START_HEIGHT_M: f64 = 5.0;
    /// Length of an observation: vector to the next point (3, m) and the camera's target direction from there (3), both in
    /// heading axes; the motion; gimbal pitch, rad; lamp; clearance, m; fraction of the paths' length flown; fraction of the
    /// defects found.
    pub const OBSERVATION_LEN: usize = 6 + MOTION_LEN + 5;

    /// Creates an inspection without any progress.
    pub fn new(job: &Scenario) -> Self {
        let paths = ReferencePaths::new(job);
        let flown = (0..paths.len()).map(|task| FlownPath::new(paths.path(task), paths.threshold_m(task))).collect();
        let viewing_directions = job.tasks.iter().map(|task| task.viewing_directions.clone()).collect();
        Self { paths, viewing_directions, flown, on: None, evaluated_at: None, found: BTreeSet::new(), before: 0.0 }
    }

    /// Returns the fraction of the total path length that has been flown.
    fn flown_fraction(&self) -> f64 {
        let all = self.flown.iter().map(FlownPath::coverage);
        let (flown_m, length_m) = all.fold((0.0, 0.0), |(f, l), one| (f + one.share * one.length_m, l + one.length_m));
        if length_m > 0.0 { flown_m / length_m } else { 0.0 }
    }

    fn found_fraction(&self, sim: &Sim) -> f64 {
        let placed = sim.site().defects().len();
        if placed > 0 { self.found.len() as f64 / placed as f64 } else { 0.0 }
    }

    /// Returns the nearest path point that has not been flown, in meters, and the camera's target direction there.
    fn next(&self, position_m: Vec3<Enu>) -> Option<(Vec3<Enu>, Vec3<Enu>)> {
        let mut best: Option<(f64, usize, usize)> = None;
        for (task, flown) in self.flown.iter().enumerate() {
            if flown.coverage().share >= 1.0 {
                continue;
            }
            let points = self.paths.path(task).points_m();
            for (point, _) in flown.points().iter().enumerate().filter(|(_, covered)| !**covered) {
                let squared = (points[point] - position_m).norm_squared();
                if best.is_none_or(|(least, _, _)| squared < least) {
                    best = Some((squared, task, point));
                }
            }
        }
        let (_, task, point) = best?;
        let look = self.viewing_directions[task].get(point).copied().unwrap_or(Vec3::zero());
        Some((self.paths.path(task).points_m()[point] - position_m, look))
    }

    /// Appends the observation.
    pub fn observe(&self, sim: &Sim, out: &mut Vec<f32>) {
        let rigid = &sim.truth().rigid;
        let position_m = rigid.position_m.enu();
        let (to_point_m, look) = self.next(position_m).unwrap_or((Vec3::zero(), Vec3::zero()));
        environment::append(out, &environment::to_heading_axes(to_point_m, rigid.attitude));
        environment::append(out, &environment::to_heading_axes(look, rigid.attitude));
        environment::append(out, &environment::motion(sim));
        let payload = sim.payload();
        let lamp = f64::from(u8::from(payload.lamp.on));
        let clearance_m =
            sim.site().nearest(position_m, MAX_CLEARANCE_M, sim.now()).map_or(MAX_CLEARANCE_M, |nearest| nearest.distance_m);
        environment::append(out, &[payload.gimbal.pitch_rad, lamp, clearance_m, self.flown_fraction(), self.found_fraction(sim)]);
    }

    /// Evaluates a photo from the vehicle's current pose; the defects that it shows count as found.
    pub fn evaluate_photo(&mut self, sim: &Sim, aircraft: &Aircraft) {
        let rigid = &sim.truth().rigid;
        let payload = sim.payload();
        let here = Pose { position_m: rigid.position_m.enu(), ned_from_frd: rigid.attitude };
        let pose = CameraPose::on_aircraft(&aircraft.camera, here, payload.gimbal.pitch_rad, payload.lamp.on);
        let shown = SiteSurvey::view_defects(sim.site(), &pose, &aircraft.camera, &aircraft.lamp, sim.now());
        self.found.extend(shown.iter().filter(|view| view.hit).map(|view| view.defect_id));
    }

    /// Evaluates a step. The reward is the increase in two fractions: paths flown and defects found. A complete episode
    /// earns 2, or 1 in a job without defects. Measures: the two fractions.
    pub fn evaluate(&mut self, sim: &Sim, over: bool) -> Outcome {
        let on = self.paths.task_on_path(sim.truth().rigid.position_m.enu(), self.on);
        if let Some((task, _)) = on {
            self.on = Some(task);
        }
        let elapsed = self.evaluated_at.replace(sim.now()).map_or(SimTime::ZERO, |before| sim.now() - before);
        for (task, flown) in self.flown.iter_mut().enumerate() {
            flown.add_frame(on.and_then(|(t, nearest)| (t == task).then_some(nearest.point)), elapsed);
        }
        let measures = [self.flown_fraction(), self.found_fraction(sim)];
        let sum = measures[0] + measures[1];
        let reward = sum - self.before;
        self.before = sum;
        let found_all = self.found.len() == sim.site().defects().len();
        Outcome { reward, terminated: over || (measures[0] >= 1.0 && found_all), measures }
    }
}
