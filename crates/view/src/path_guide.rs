//! Path of the next task, drawn into a picture for practice: a ribbon along the path, gates as wide as the path's tolerance, and
//! circles on the inspected surface that match at the recommended stand-off.

use super::camera::PinholeCamera;
use super::hud::{DrawItem, HudColor, ScreenPoint, at};
use super::matrix::Matrix;
use serde::{Deserialize, Serialize};
use spandrel_mavlink::contract::guidance::{Guidance, GuidanceStep};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;

/// Half the width of the ribbon, m.
const RIBBON_HALF_WIDTH_M: f64 = 0.15;
/// Distance between two gates along the path, m.
const GATE_SPACING_M: f64 = 10.0;
/// Length of the path that is drawn ahead of the aircraft and behind it while the pilot follows it, m.
const AHEAD_M: f64 = 60.0;
const BEHIND_M: f64 = 5.0;
/// Distance from the camera at which lines are cut off, m.
const NEAR_M: f64 = 0.3;
/// Points farther outside the picture than this are not drawn; 1 is the edge.
const MAX_CLIP: f64 = 4.0;
/// Stroke widths as fractions of the picture's height.
const GATE_WIDTH: f64 = 0.003;
const NEXT_GATE_WIDTH: f64 = 0.007;
/// Radius of the circle for the recommended stand-off, m, and number of its corners.
const CIRCLE_RADIUS_M: f64 = 0.6;
const CIRCLE_CORNERS: u32 = 32;
/// Largest distance at which the circles are drawn, m.
const MAX_STAND_OFF_M: f64 = 30.0;

/// How much of the path is drawn. Better pilots see less, so that they do not come to depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PathAids {
    /// Nothing.
    None,
    /// The next gate.
    NextGate,
    /// All gates, and the stand-off on the surface.
    Gates,
    /// Ribbon, gates and stand-off.
    #[default]
    Full,
}

/// Mean conformity, %, from which there is less help: gates without the ribbon, the next gate only, nothing (estimates: the
/// paper's trainees have 78 % on average).
const LIMITS_PCT: [f64; 3] = [70.0, 85.0, 95.0];

impl PathAids {
    /// All levels with their names on the command line.
    pub const ALL: [(&'static str, Self); 4] =
        [("none", Self::None), ("next-gate", Self::NextGate), ("gates", Self::Gates), ("full", Self::Full)];

    /// Returns the name on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        Self::ALL.iter().find(|(_, one)| *one == self).map_or("full", |(word, _)| word)
    }

    /// Number of sessions whose mean conformity determines the aids.
    pub const SESSIONS: usize = 3;

    /// Returns the aids for a trainee, from the conformity of the complete sessions so far, in %, the latest last. Up to the
    /// third session, nothing is left out.
    #[must_use]
    pub fn for_conformity(sessions_pct: &[f64]) -> Self {
        let latest = &sessions_pct[sessions_pct.len().saturating_sub(Self::SESSIONS)..];
        if latest.len() < Self::SESSIONS {
            return Self::Full;
        }
        let mean_pct = latest.iter().sum::<f64>() / latest.len() as f64;
        match LIMITS_PCT.iter().filter(|limit| mean_pct >= **limit).count() {
            0 => Self::Full,
            1 => Self::Gates,
            2 => Self::NextGate,
            _ => Self::None,
        }
    }
}

/// A task's path.
#[derive(Debug, Clone)]
struct GuidedTask {
    id: u32,
    closed: bool,
    threshold_m: f64,
    points_m: Vec<Vec3<Enu>>,
    viewing_directions: Vec<Vec3<Enu>>,
    /// Indices of the points with a gate.
    gates: Vec<usize>,
}

/// The paths of a job.
#[derive(Debug, Clone)]
pub struct PathGuide(Vec<GuidedTask>);

/// Returns the position and normal of the surface in a direction from a point.
pub type SurfaceQuery<'a> = &'a dyn Fn(Vec3<Enu>, Vec3<Enu>) -> Option<(Vec3<Enu>, Vec3<Enu>)>;

/// Inputs for drawing the path into a picture.
pub struct GuidedView<'a> {
    /// The picture's camera.
    pub eye: &'a PinholeCamera,
    /// Width of the picture over its height.
    pub aspect: f64,
    /// Position of the aircraft.
    pub drone_m: Vec3<Enu>,
    /// Heading of the aircraft, rad clockwise from north.
    pub heading_rad: f64,
    /// The next step of the job.
    pub guidance: &'a Guidance,
    /// How much is drawn.
    pub aids: PathAids,
    /// Checks whether an object hides a point from the camera.
    pub is_hidden: &'a dyn Fn(Vec3<Enu>) -> bool,
    /// Finds the inspected surface.
    pub surface: SurfaceQuery<'a>,
}

impl PathGuide {
    /// Prepares the paths of a job's tasks.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let tasks = scenario.tasks.iter().filter(|task| !task.path_m.is_empty() && !task.is_hold_position());
        let guided = |task: &spandrel_model::scenario::Task| GuidedTask {
            id: task.id,
            closed: task.closed,
            threshold_m: task.threshold_m,
            gates: gates(&task.path_m, task.closed),
            points_m: task.path_m.clone(),
            viewing_directions: task.viewing_directions.clone(),
        };
        Self(tasks.map(guided).collect())
    }

    /// Returns the items to draw below the rest of the picture's overlay.
    #[must_use]
    pub fn items(&self, view: &GuidedView) -> Vec<DrawItem> {
        let follows = match view.guidance.step {
            GuidanceStep::FollowPath => true,
            GuidanceStep::FlyToTask => false,
            GuidanceStep::TakeOff
            | GuidanceStep::HoldPosition
            | GuidanceStep::FlyHome
            | GuidanceStep::Land
            | GuidanceStep::Over => return Vec::new(),
        };
        let Some(task) = self.0.iter().find(|task| Some(task.id) == view.guidance.task) else { return Vec::new() };
        let target_m = target_m(view);
        let (here, target) = (task.nearest(view.drone_m), task.nearest(target_m));
        let canvas = Canvas { matrix: view.eye.view_projection(view.aspect), view };
        let order = if follows { task.stretch(here, target) } else { task.whole() };
        // On the way to a task, the path leads away from the end at which it is entered.
        let forward = if follows { task.direction(here, target) } else { task.closed || target < task.points_m.len() / 2 };
        let gates = task.gates_from(target, forward);
        let mut items = Vec::new();
        if view.aids == PathAids::Full {
            items.extend(canvas.ribbon(task, &order));
        }
        if view.aids >= PathAids::Gates {
            for gate in gates.iter().skip(1).filter(|gate| order.contains(gate)) {
                items.extend(canvas.gate(task, *gate, false));
            }
            items.extend(canvas.stand_off(task, here));
        }
        if view.aids >= PathAids::NextGate {
            items.extend(gates.first().map(|gate| canvas.gate(task, *gate, true)).into_iter().flatten());
        }
        items
    }

    /// Returns the nearest position on the path of a task, or of any task.
    #[must_use]
    pub fn nearest_m(&self, task: Option<u32>, position_m: Vec3<Enu>) -> Option<Vec3<Enu>> {
        let tasks = self.0.iter().filter(|candidate| task.is_none_or(|id| candidate.id == id));
        let nearest = tasks.map(|task| task.points_m[task.nearest(position_m)]);
        nearest.min_by(|a, b| (*a - position_m).norm().total_cmp(&(*b - position_m).norm()))
    }
}

/// Returns the place that the guidance leads to.
fn target_m(view: &GuidedView) -> Vec3<Enu> {
    view.guidance.way.map_or(view.drone_m, |way| {
        let (sin, cos) = math::sin_cos(view.heading_rad + way.bearing_rad);
        view.drone_m + Vec3::new(way.distance_m * sin, way.distance_m * cos, way.up_m)
    })
}

/// Returns a ring around a place, which faces the camera.
#[must_use]
pub fn ring_items(eye: &PinholeCamera, aspect: f64, middle_m: Vec3<Enu>, radius_m: f64) -> Vec<DrawItem> {
    let to = middle_m - eye.position_m;
    // Inside the ring, there is nothing to see.
    if to.norm() <= radius_m {
        return Vec::new();
    }
    circle(&eye.view_projection(aspect), (middle_m, to.unit()), radius_m, (NEXT_GATE_WIDTH, HudColor::Yellow))
}

/// Returns a circle around a point, across a direction.
pub(super) fn circle(
    matrix: &Matrix,
    (middle_m, normal): (Vec3<Enu>, Vec3<Enu>),
    radius_m: f64,
    (width, color): (f64, HudColor),
) -> Vec<DrawItem> {
    let flat = normal.cross(Vec3::new(0.0, 0.0, 1.0));
    let side = if flat.norm() > 1e-3 { flat.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
    let up = side.cross(normal);
    let corner = |k: u32| {
        let (sin, cos) = math::sin_cos(math::TAU * f64::from(k) / f64::from(CIRCLE_CORNERS));
        middle_m + side * (radius_m * cos) + up * (radius_m * sin)
    };
    (0..CIRCLE_CORNERS).filter_map(|k| segment(matrix, corner(k), corner(k + 1), width, color)).collect()
}

/// Returns a line between two points, if a part of it is in front of the camera and near the picture.
pub(super) fn segment(matrix: &Matrix, a: Vec3<Enu>, b: Vec3<Enu>, width: f64, color: HudColor) -> Option<DrawItem> {
    let (a, b) = cut_segment(matrix.apply(a), matrix.apply(b))?;
    let points = vec![screen_point(a)?, screen_point(b)?];
    Some(DrawItem::Line { points, width, color })
}

/// Returns the points of a path that get a gate: the first, the last, and others at regular distances.
fn gates(points_m: &[Vec3<Enu>], closed: bool) -> Vec<usize> {
    let mut gates = vec![0];
    let mut along_m = 0.0;
    for (k, pair) in points_m.windows(2).enumerate() {
        along_m += (pair[1] - pair[0]).norm();
        if along_m >= GATE_SPACING_M {
            gates.push(k + 1);
            along_m = 0.0;
        }
    }
    let last = points_m.len() - 1;
    if !closed && gates.last() != Some(&last) {
        // A gate just before the last one would look like a double line.
        if along_m < 0.5 * GATE_SPACING_M && gates.len() > 1 {
            gates.pop();
        }
        gates.push(last);
    }
    gates
}

impl GuidedTask {
    fn nearest(&self, position_m: Vec3<Enu>) -> usize {
        let squared = |k: &usize| (self.points_m[*k] - position_m).norm_squared();
        (0..self.points_m.len()).min_by(|a, b| squared(a).total_cmp(&squared(b))).unwrap_or(0)
    }

    /// Returns the index of the next point in a direction, if the path goes on there.
    fn next(&self, k: usize, forward: bool) -> Option<usize> {
        let count = self.points_m.len();
        match (forward, self.closed) {
            (true, true) => Some((k + 1) % count),
            (false, true) => Some((k + count - 1) % count),
            (true, false) => Some(k + 1).filter(|next| *next < count),
            (false, false) => k.checked_sub(1),
        }
    }

    /// Returns whether the shorter way from one point to another leads forward along the path.
    fn direction(&self, from: usize, to: usize) -> bool {
        let count = self.points_m.len();
        if self.closed { (to + count - from) % count <= count / 2 } else { to >= from }
    }

    /// Returns all points in order; a closed path ends at its first point.
    fn whole(&self) -> Vec<usize> {
        (0..self.points_m.len()).chain(self.closed.then_some(0)).collect()
    }

    /// Returns the points near the aircraft, from behind it to ahead of it.
    fn stretch(&self, here: usize, target: usize) -> Vec<usize> {
        let forward = self.direction(here, target);
        let mut order = self.walk(here, !forward, BEHIND_M);
        order.reverse();
        order.pop();
        order.extend(self.walk(here, forward, AHEAD_M));
        order
    }

    fn walk(&self, from: usize, forward: bool, length_m: f64) -> Vec<usize> {
        let (mut order, mut along_m) = (vec![from], 0.0);
        let mut at = from;
        while along_m < length_m && order.len() <= self.points_m.len() {
            let Some(next) = self.next(at, forward) else { break };
            along_m += (self.points_m[next] - self.points_m[at]).norm();
            order.push(next);
            at = next;
        }
        order
    }

    /// Returns the gates from a point in a direction, the nearest first.
    fn gates_from(&self, from: usize, forward: bool) -> Vec<usize> {
        let count = self.points_m.len();
        let distance = |gate: usize| match (forward, self.closed) {
            (true, true) => Some((gate + count - from) % count),
            (false, true) => Some((from + count - gate) % count),
            (true, false) => gate.checked_sub(from),
            (false, false) => from.checked_sub(gate),
        };
        let mut ahead: Vec<(usize, usize)> = self.gates.iter().filter_map(|gate| Some((distance(*gate)?, *gate))).collect();
        ahead.sort_unstable();
        ahead.into_iter().map(|(_, gate)| gate).collect()
    }

    /// Returns the directions across the path at a point: to the side, and up.
    fn across(&self, k: usize) -> (Vec3<Enu>, Vec3<Enu>) {
        let (before, after) = (self.next(k, false).unwrap_or(k), self.next(k, true).unwrap_or(k));
        let along = self.points_m[after] - self.points_m[before];
        let along = if along.norm() > 1e-6 { along.unit() } else { Vec3::new(0.0, 1.0, 0.0) };
        let side = along.cross(Vec3::new(0.0, 0.0, 1.0));
        // On a vertical path, the gates lie flat and face the surface.
        let side = if side.norm() > 0.1 { side } else { along.cross(self.viewing_directions[k]) };
        let side = if side.norm() > 1e-6 { side.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
        (side, side.cross(along))
    }
}

/// Projects lines into the picture.
struct Canvas<'a> {
    matrix: Matrix,
    view: &'a GuidedView<'a>,
}

impl Canvas<'_> {
    fn ribbon(&self, task: &GuidedTask, order: &[usize]) -> Vec<DrawItem> {
        let edges: Vec<(Vec3<Enu>, Vec3<Enu>)> = order
            .iter()
            .map(|k| (task.points_m[*k], task.across(*k).0 * RIBBON_HALF_WIDTH_M))
            .map(|(point_m, side)| (point_m - side, point_m + side))
            .collect();
        let quads = edges.windows(2).zip(order).filter_map(|(pair, k)| {
            // Consecutive points may have opposite sides where a path turns vertical; such a quad would cross itself.
            let crossed = (pair[0].1 - pair[0].0).dot(pair[1].1 - pair[1].0) < 0.0;
            let (far_left, far_right) = if crossed { (pair[1].1, pair[1].0) } else { pair[1] };
            let points = polygon(&self.matrix, &[pair[0].0, far_left, far_right, pair[0].1])?;
            let color = if (self.view.is_hidden)(task.points_m[*k]) { HudColor::RibbonHidden } else { HudColor::Ribbon };
            Some(DrawItem::Fill { points, color })
        });
        // The nearest part is drawn last.
        let mut quads: Vec<DrawItem> = quads.collect();
        quads.reverse();
        quads
    }

    fn gate(&self, task: &GuidedTask, k: usize, next: bool) -> Vec<DrawItem> {
        let (side, up) = task.across(k);
        let (middle_m, half_m) = (task.points_m[k], task.threshold_m);
        let corner = |right: f64, high: f64| middle_m + side * (right * half_m) + up * (high * half_m);
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)];
        let hidden = (self.view.is_hidden)(middle_m);
        let (color, width) = match (next, hidden) {
            (true, false) => (HudColor::Yellow, NEXT_GATE_WIDTH),
            (true, true) => (HudColor::Gray, NEXT_GATE_WIDTH),
            (false, false) => (HudColor::Blue, GATE_WIDTH),
            (false, true) => (HudColor::Gray, GATE_WIDTH),
        };
        corners.windows(2).filter_map(|pair| segment(&self.matrix, pair[0], pair[1], width, color)).collect()
    }

    /// Returns the circles on the surface beside the aircraft: one of fixed size, and one that grows with the distance and
    /// matches it at the recommended stand-off.
    fn stand_off(&self, task: &GuidedTask, here: usize) -> Vec<DrawItem> {
        let Some(reading) = self.view.guidance.stand_off.filter(|reading| reading.actual_m <= MAX_STAND_OFF_M) else {
            return Vec::new();
        };
        let Some((hit_m, normal)) = (self.view.surface)(self.view.drone_m, task.viewing_directions[here]) else {
            return Vec::new();
        };
        let off = (reading.actual_m - reading.recommended_m).abs() > reading.tolerance_m;
        let color = if off { HudColor::Yellow } else { HudColor::White };
        let radius_m = CIRCLE_RADIUS_M * (reading.actual_m / reading.recommended_m).clamp(0.2, 3.0);
        let ring = |radius_m: f64, color: HudColor| circle(&self.matrix, (hit_m, normal), radius_m, (GATE_WIDTH, color));
        let mut items = ring(CIRCLE_RADIUS_M, HudColor::Gray);
        items.extend(ring(radius_m, color));
        items
    }
}

/// Returns a convex polygon, if all of it is in front of the camera and near the picture.
pub(super) fn polygon(matrix: &Matrix, corners: &[Vec3<Enu>]) -> Option<Vec<ScreenPoint>> {
    let clip = |corner: &Vec3<Enu>| Some(matrix.apply(*corner)).filter(|clip| clip[3] >= NEAR_M);
    corners.iter().map(|corner| screen_point(clip(corner)?)).collect()
}

/// Returns the part of a line in clip space that is at least [`NEAR_M`] in front of the camera.
fn cut_segment(a: [f64; 4], b: [f64; 4]) -> Option<([f64; 4], [f64; 4])> {
    let cut = |behind: [f64; 4], front: [f64; 4]| {
        let share = (NEAR_M - behind[3]) / (front[3] - behind[3]);
        std::array::from_fn(|k| behind[k] + share * (front[k] - behind[k]))
    };
    match (a[3] >= NEAR_M, b[3] >= NEAR_M) {
        (true, true) => Some((a, b)),
        (false, true) => Some((cut(a, b), b)),
        (true, false) => Some((a, cut(b, a))),
        (false, false) => None,
    }
}

fn screen_point(clip: [f64; 4]) -> Option<ScreenPoint> {
    let (x, y) = (clip[0] / clip[3], clip[1] / clip[3]);
    (x.abs() <= MAX_CLIP && y.abs() <= MAX_CLIP).then(|| at(0.5 + 0.5 * x, 0.5 - 0.5 * y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::contract::guidance::WayTo;
    use spandrel_model::{scenario, shipped};

    fn job() -> Scenario {
        scenario::read("job.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap()
    }

    fn guidance(step: GuidanceStep, way: WayTo) -> Guidance {
        Guidance {
            step,
            task: Some(1),
            way: Some(way),
            progress: Some(0.0),
            tasks_done: 0,
            tasks: 4,
            deviation: None,
            stand_off: None,
            flown_s: 10.0,
            needed_s: 300.0,
            detour: None,
        }
    }

    /// Draws what a camera at the beginning of the first task sees when it looks along the path.
    fn drawn(step: GuidanceStep, aids: PathAids, hidden: bool) -> Vec<DrawItem> {
        let job = job();
        let path_m = &job.tasks[0].path_m;
        let along = (path_m[1] - path_m[0]).unit();
        let drone_m = path_m[0] - along * 3.0;
        let eye = PinholeCamera::at(drone_m, path_m[20], 1.0, 4.0 / 3.0);
        let way = WayTo { distance_m: (path_m[0] - drone_m).horizontal_norm(), bearing_rad: 0.0, up_m: 0.0 };
        let view = GuidedView {
            eye: &eye,
            aspect: 4.0 / 3.0,
            drone_m,
            heading_rad: math::atan2(along.east(), along.north()),
            guidance: &guidance(step, way),
            aids,
            is_hidden: &|_| hidden,
            surface: &|_, _| None,
        };
        PathGuide::new(&job).items(&view)
    }

    fn count(items: &[DrawItem], color: HudColor) -> usize {
        let is = |item: &&DrawItem| match item {
            DrawItem::Fill { color: own, .. } | DrawItem::Line { color: own, .. } => *own == color,
            DrawItem::Panel { .. } | DrawItem::Text { .. } => false,
        };
        items.iter().filter(is).count()
    }

    #[test]
    fn exact_less_is_drawn_for_better_pilots() {
        for (sessions, aids) in [
            (&[][..], PathAids::Full),
            (&[69.9], PathAids::Full),
            (&[99.0, 99.0], PathAids::Full),
            (&[70.0; 3], PathAids::Gates),
            (&[20.0, 80.0, 90.0, 100.0], PathAids::NextGate),
            (&[94.0, 95.0, 96.0], PathAids::None),
        ] {
            assert_eq!(PathAids::for_conformity(sessions), aids, "{sessions:?}");
        }
        let step = GuidanceStep::FollowPath;
        let [full, gates, next, none] =
            [PathAids::Full, PathAids::Gates, PathAids::NextGate, PathAids::None].map(|aids| drawn(step, aids, false));
        assert!(count(&full, HudColor::Ribbon) > 20 && count(&gates, HudColor::Ribbon) == 0);
        assert_eq!(count(&full, HudColor::Blue), count(&gates, HudColor::Blue));
        assert!(count(&gates, HudColor::Blue) >= 4 && count(&next, HudColor::Blue) == 0);
        assert_eq!((count(&next, HudColor::Yellow), none.len()), (4, 0), "the four edges of the next gate");
    }

    #[test]
    fn exact_the_path_is_drawn_on_the_way_to_the_task_and_along_it_only() {
        assert!(!drawn(GuidanceStep::FlyToTask, PathAids::Full, false).is_empty());
        for step in [GuidanceStep::TakeOff, GuidanceStep::FlyHome, GuidanceStep::Land, GuidanceStep::Over] {
            assert!(drawn(step, PathAids::Full, false).is_empty(), "{step:?}");
        }
        let hidden = drawn(GuidanceStep::FollowPath, PathAids::Full, true);
        assert!(count(&hidden, HudColor::RibbonHidden) > 20 && count(&hidden, HudColor::Ribbon) == 0);
        assert_eq!(count(&hidden, HudColor::Yellow), 0, "a hidden gate is gray");
    }

    #[test]
    fn exact_on_the_way_to_a_task_all_gates_are_drawn_from_beside_the_path() {
        let job = job();
        let path_m = &job.tasks[0].path_m;
        let drone_m = path_m[path_m.len() / 2] + Vec3::new(0.0, -25.0, 10.0);
        let to = path_m[0] - drone_m;
        let way = WayTo { distance_m: to.horizontal_norm(), bearing_rad: math::atan2(to.east(), to.north()), up_m: to.up() };
        let eye = PinholeCamera::at(drone_m, path_m[path_m.len() / 2], 1.0, 4.0);
        let view = GuidedView {
            eye: &eye,
            aspect: 4.0,
            drone_m,
            heading_rad: 0.0,
            guidance: &guidance(GuidanceStep::FlyToTask, way),
            aids: PathAids::Gates,
            is_hidden: &|_| false,
            surface: &|_, _| None,
        };
        let items = PathGuide::new(&job).items(&view);
        let gates = gates(path_m, false).len();
        assert_eq!(count(&items, HudColor::Blue) + count(&items, HudColor::Yellow), 4 * gates, "{gates} gates");
    }

    #[test]
    fn exact_the_next_gate_surrounds_the_path_with_its_tolerance() {
        let items = drawn(GuidanceStep::FollowPath, PathAids::NextGate, false);
        let corners: Vec<ScreenPoint> = items
            .iter()
            .flat_map(|item| match item {
                DrawItem::Line { points, .. } => points.clone(),
                DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Fill { .. } => Vec::new(),
            })
            .collect();
        let middle = |pick: fn(&ScreenPoint) -> f64| corners.iter().map(pick).sum::<f64>() / corners.len() as f64;
        // The camera looks along the path, so the gate is in the middle of the picture.
        assert!((middle(|p| p.x) - 0.5).abs() < 0.05 && (middle(|p| p.y) - 0.5).abs() < 0.1, "{corners:?}");
    }

    #[test]
    fn prop_gates_are_regular_and_include_both_ends() {
        for task in &job().tasks {
            let gates = gates(&task.path_m, task.closed);
            assert_eq!(gates[0], 0);
            if !task.closed {
                assert_eq!(*gates.last().unwrap(), task.path_m.len() - 1);
            }
            assert!(gates.windows(2).all(|pair| pair[0] < pair[1]), "{gates:?}");
        }
    }

    #[test]
    fn exact_segments_behind_the_camera_are_cut_off() {
        let (behind, front) = ([0.0, 0.0, 0.0, -1.0], [2.0, 0.0, 0.0, 1.0]);
        let (a, b) = cut_segment(behind, front).unwrap();
        assert!((a[3] - NEAR_M).abs() < 1e-12 && (a[0] - 1.3).abs() < 1e-12 && b == front, "{a:?}");
        assert!(cut_segment(behind, behind).is_none());
    }
}
