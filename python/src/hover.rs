//! Hover task: hold the first point of the job's first path.

use crate::environment::{self, MOTION_LEN, Outcome};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_sitl::sim::Sim;

/// The hover task.
#[derive(Debug, Clone, Copy)]
pub struct Hover {
    point_m: Vec3<Enu>,
}

impl Hover {
    /// Length of an observation: vector to the point in heading axes (3, m), then the motion.
    pub const OBSERVATION_LEN: usize = 3 + MOTION_LEN;

    /// Uses the first point of the first task, or a point above the pad for a job without tasks.
    pub fn new(job: &Scenario) -> Self {
        let point_m = job.tasks.first().and_then(|task| task.path_m.first()).copied();
        Self { point_m: point_m.unwrap_or(job.ground_team.pad_m + Vec3::new(0.0, 0.0, 5.0)) }
    }

    /// Returns the target point in meters.
    pub fn point_m(&self) -> Vec3<Enu> {
        self.point_m
    }

    fn offset_m(self, sim: &Sim) -> Vec3<Enu> {
        self.point_m - sim.truth().rigid.position_m.enu()
    }

    /// Appends the observation.
    pub fn observe(&self, sim: &Sim, out: &mut Vec<f32>) {
        environment::append(out, &environment::to_heading_axes(self.offset_m(sim), sim.truth().rigid.attitude));
        environment::append(out, &environment::motion(sim));
    }

    /// Evaluates a step. The reward is the negative distance to the point, m. Measures: that distance, m, and the number of
    /// contacts.
    pub fn evaluate(&self, sim: &Sim, over: bool) -> Outcome {
        let distance_m = self.offset_m(sim).norm();
        Outcome { reward: -distance_m, terminated: over, measures: [distance_m, f64::from(sim.hits())] }
    }
}
