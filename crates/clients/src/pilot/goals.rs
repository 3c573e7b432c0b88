//! Plans a job as a sequence of legs: transits around obstacles, tasks along their reference paths, and the flight
//! home.

use super::route_search;
use super::track::TrackLeg;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{Scenario, Task, TaskKind};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Transit speed away from obstacles, m/s (estimate: moderate for a camera drone).
const TRANSIT_SPEED_M_S: f64 = 6.0;
/// Transit speed near obstacles, m/s (estimate).
const NEAR_OBSTACLE_SPEED_M_S: f64 = 2.5;
/// Maximum distance to an obstacle that counts as near during transit, m (estimate).
const NEAR_OBSTACLE_DISTANCE_M: f64 = 4.0;
/// Height above the landing pad where takeoff ends and landing begins, m (estimate).
pub const PAD_HOVER_HEIGHT_M: f64 = 6.0;

/// The next goal of the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightGoal {
    /// Fly the task with the given index.
    Task(usize),
    /// Return to the landing pad.
    Home,
}

/// Returns the speed for a task in m/s: below the 10 mph limit by a margin that depends on the path's shape (estimate).
fn task_speed_m_s(task: &Task) -> f64 {
    match task.kind {
        TaskKind::SlabSide => 3.3,
        TaskKind::ArchBottom => 3.0,
        TaskKind::BarrelSoffit => 2.0,
        TaskKind::Interlayer => 1.4,
        TaskKind::PierCircle | TaskKind::PierCap | TaskKind::TrussPanel | TaskKind::ArchRing | TaskKind::StayCable => 2.2,
        TaskKind::GirderSoffit | TaskKind::FloorSystem => 2.5,
        TaskKind::BearingLine => 1.4,
        TaskKind::Free => 2.5,
    }
}

/// Returns the hover point above the landing pad, where flights begin and end, in ENU meters.
#[must_use]
pub fn hover_point_over_pad(scenario: &Scenario) -> Vec3<Enu> {
    scenario.ground_team.pad_m + Vec3::new(0.0, 0.0, PAD_HOVER_HEIGHT_M)
}

/// Planner inputs.
#[derive(Clone, Copy)]
pub struct PlanningContext<'a> {
    /// Scenario of the job.
    pub scenario: &'a Scenario,
    /// Geometry of the site.
    pub site: &'a Site,
    /// Parameters of the aircraft.
    pub vehicle: &'a Vehicle,
    /// Simulation time used for planning.
    pub at: SimTime,
    /// Transit clearance, m, except near an endpoint with less clearance. `None` uses the pilot's default.
    pub transit_clearance_m: Option<f64>,
}

impl PlanningContext<'_> {
    /// Returns the minimum clearance for planning, in meters (the same value that `check` requires for a path).
    fn clearance_m(&self) -> f64 {
        0.5 * self.vehicle.hull.tip_to_tip_m + 0.5
    }

    fn route(&self, from: Vec3<Enu>, to: Vec3<Enu>) -> Vec<Vec3<Enu>> {
        let ceiling = from.up().max(to.up()) + 60.0;
        route_search::route(self.site, (from, to), self.clearance_m(), self.transit_clearance_m, ceiling, self.at)
    }

    /// Appends a transit to a leg: slow near obstacles and fast elsewhere.
    fn append_route(&self, leg: &mut TrackLeg, from: Vec3<Enu>, to: Vec3<Enu>) {
        const ROUTE_STEP_M: f64 = 3.0;
        let mut last = from;
        for point in self.route(from, to) {
            let steps = ((point - last).norm() / ROUTE_STEP_M).ceil().max(1.0) as usize;
            for k in 1..=steps {
                let p = last.lerp(point, k as f64 / steps as f64);
                let near = self.site.nearest(p, NEAR_OBSTACLE_DISTANCE_M, self.at).is_some();
                leg.push(p, if near { NEAR_OBSTACLE_SPEED_M_S } else { TRANSIT_SPEED_M_S }, None, None);
            }
            last = point;
        }
    }

    /// Returns the leg from `from` to the goal.
    #[must_use]
    pub fn leg(&self, job: FlightGoal, from: Vec3<Enu>) -> TrackLeg {
        match job {
            FlightGoal::Home => self.transit(from, hover_point_over_pad(self.scenario)),
            FlightGoal::Task(index) => self.task(index, from),
        }
    }

    fn transit(&self, from: Vec3<Enu>, to: Vec3<Enu>) -> TrackLeg {
        let mut leg = TrackLeg::new();
        self.append_route(&mut leg, from, to);
        ensure_two_points(&mut leg, to);
        leg
    }

    fn task(&self, index: usize, from: Vec3<Enu>) -> TrackLeg {
        let task = &self.scenario.tasks[index];
        let order = flying_order(task, from);
        let mut leg = TrackLeg::new();
        let Some(first) = order.first() else { return self.transit(from, hover_point_over_pad(self.scenario)) };
        self.append_route(&mut leg, from, task.path_m[*first]);
        for k in &order {
            leg.push(task.path_m[*k], task_speed_m_s(task), task.viewing_directions.get(*k).copied(), Some(index));
        }
        ensure_two_points(&mut leg, task.path_m[*first]);
        leg
    }

    /// Returns the rest of an interrupted leg: a route back to the `next` point, then the remaining points.
    #[must_use]
    pub fn resume(&self, leg: &TrackLeg, next: usize, from: Vec3<Enu>) -> TrackLeg {
        let next = next.min(leg.points_m.len() - 1);
        let mut fresh = TrackLeg::new();
        for point in self.route(from, leg.points_m[next]) {
            fresh.push(point, leg.speed_m_s[next].min(2.0), leg.line_of_sight[next], leg.task[next]);
        }
        for k in next..leg.points_m.len() {
            fresh.push(leg.points_m[k], leg.speed_m_s[k], leg.line_of_sight[k], leg.task[k]);
        }
        ensure_two_points(&mut fresh, leg.points_m[next]);
        fresh
    }
}

/// Ensures that a leg has at least two points by adding one a few centimeters away if necessary.
fn ensure_two_points(leg: &mut TrackLeg, at: Vec3<Enu>) {
    if leg.points_m.is_empty() {
        leg.push(at, 1.0, None, None);
    }
    if leg.points_m.len() == 1 {
        let (point, task) = (leg.points_m[0], leg.task[0]);
        leg.push(point + Vec3::new(0.0, 0.0, 0.05), 1.0, None, task);
    }
}

/// Returns the path indices in the order in which they are flown: from the nearer end, or, on a closed path, from the
/// nearest point with a short overlap.
fn flying_order(task: &Task, from: Vec3<Enu>) -> Vec<usize> {
    const OVERLAP_POINTS: usize = 4;
    let n = task.path_m.len();
    if n == 0 {
        return Vec::new();
    }
    let far = |k: usize| (task.path_m[k] - from).norm();
    if task.closed {
        let start = (0..n).min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0);
        return (0..n + OVERLAP_POINTS).map(|k| (start + k) % n).collect();
    }
    if far(n - 1) < far(0) { (0..n).rev().collect() } else { (0..n).collect() }
}
