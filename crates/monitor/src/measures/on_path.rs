//! On-path analysis (algorithm 1 of the TASBID paper) and task windows.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;

/// Number of points per search block. The search skips blocks whose bounding box is farther away than the best point so
/// far; the result stays exact.
const BLOCK_POINTS: usize = 16;
/// Margin for rounding errors when testing whether a box can be skipped.
const BOX_TOLERANCE: f64 = 1.0 + 1e-9;

/// A reference path indexed for nearest-point queries.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferencePath {
    points_m: Vec<Vec3<Enu>>,
    closed: bool,
    blocks: Vec<BoundingBox>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct BoundingBox {
    low: [f64; 3],
    high: [f64; 3],
}

impl BoundingBox {
    fn around<'a>(points: impl Iterator<Item = &'a Vec3<Enu>>) -> Self {
        let empty = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        points.map(|point| point.array()).fold(empty, |mut sum, point| {
            for (k, x) in point.into_iter().enumerate() {
                sum.low[k] = sum.low[k].min(x);
                sum.high[k] = sum.high[k].max(x);
            }
            sum
        })
    }

    fn distance_squared(&self, point: [f64; 3]) -> f64 {
        (0..3).map(|k| (self.low[k] - point[k]).max(point[k] - self.high[k]).max(0.0)).map(|d| d * d).sum()
    }
}

/// Nearest point on a reference path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestOnPath {
    /// Index of the nearest reference point (n*); in `nearest_exact` mode, the first point of the nearest segment.
    pub point: usize,
    /// Distance to the path (l*), m.
    pub distance_m: f64,
}

impl ReferencePath {
    /// Creates a path from at least one point. If `closed`, the last point is connected to the first.
    #[must_use]
    pub fn new(points_m: &[Vec3<Enu>], closed: bool) -> Self {
        let count = points_m.len();
        // Each block includes the end of its last segment, so the same boxes serve points and segments.
        let block = |start: usize| BoundingBox::around((start..=(start + BLOCK_POINTS).min(count)).map(|k| &points_m[k % count]));
        Self { points_m: points_m.to_vec(), closed, blocks: (0..count).step_by(BLOCK_POINTS).map(block).collect() }
    }

    /// Returns the reference points in meters.
    #[must_use]
    pub fn points_m(&self) -> &[Vec3<Enu>] {
        &self.points_m
    }

    /// Applies the TASBID rule: finds the nearest reference point (lowest index in a tie), then measures the distance
    /// to the adjacent segments.
    #[must_use]
    pub fn nearest_by_tasbid_rule(&self, position_m: Vec3<Enu>) -> Option<NearestOnPath> {
        let point = self.search(position_m, |k| (position_m - self.points_m[k]).norm_squared())?;
        let count = self.points_m.len();
        let before = if point > 0 { Some(point - 1) } else { self.closed.then_some(count - 1) };
        let segments = [before, Some(point)].into_iter().flatten().filter_map(|k| self.segment(k));
        let own = (position_m - self.points_m[point]).norm_squared();
        let squared = segments.map(|(a, b)| distance_to_segment_squared(position_m, a, b)).fold(own, f64::min);
        Some(NearestOnPath { point, distance_m: squared.sqrt() })
    }

    /// Returns the exact distance to the polyline in meters.
    #[must_use]
    pub fn nearest_exact(&self, position_m: Vec3<Enu>) -> Option<NearestOnPath> {
        let to_segment = |k: usize| {
            let (a, b) = self.segment(k).unwrap_or((self.points_m[k], self.points_m[k]));
            distance_to_segment_squared(position_m, a, b)
        };
        let point = self.search(position_m, to_segment)?;
        Some(NearestOnPath { point, distance_m: to_segment(point).sqrt() })
    }

    /// Returns the nearest position anywhere on the polyline in meters.
    #[must_use]
    pub fn closest_position(&self, position_m: Vec3<Enu>) -> Option<Vec3<Enu>> {
        let point = self.nearest_exact(position_m)?.point;
        let (a, b) = self.segment(point).unwrap_or((self.points_m[point], self.points_m[point]));
        Some(a.lerp(b, segment_fraction(position_m, a, b)))
    }

    /// Returns whether the entire path is farther away than `distance_m`.
    #[must_use]
    pub fn is_beyond(&self, position_m: Vec3<Enu>, distance_m: f64) -> bool {
        let limit = distance_m * distance_m * BOX_TOLERANCE;
        self.blocks.iter().all(|block| block.distance_squared(position_m.array()) > limit)
    }

    /// Returns each point's distance in meters from the first point, measured along the path.
    #[must_use]
    pub fn distances_along_path_m(&self) -> Vec<f64> {
        let steps = self.points_m.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        let mut sum_m = 0.0;
        let later = steps.map(|step_m| {
            sum_m += step_m;
            sum_m
        });
        self.points_m.first().map(|_| 0.0).into_iter().chain(later).collect()
    }

    /// Returns the length in meters that each point represents: half of each adjacent segment.
    #[must_use]
    pub fn lengths_by_point_m(&self) -> Vec<f64> {
        let mut lengths_m = vec![0.0; self.points_m.len()];
        for k in 0..self.points_m.len() {
            let Some((a, b)) = self.segment(k) else { continue };
            let half_m = 0.5 * (b - a).norm();
            lengths_m[k] += half_m;
            lengths_m[(k + 1) % self.points_m.len()] += half_m;
        }
        lengths_m
    }

    /// Returns the segment that starts at point `k`.
    fn segment(&self, k: usize) -> Option<(Vec3<Enu>, Vec3<Enu>)> {
        let next = if k + 1 < self.points_m.len() { Some(k + 1) } else { self.closed.then_some(0) }?;
        Some((self.points_m[k], self.points_m[next]))
    }

    /// Returns the index with the lowest cost; in a tie, the lowest such index. A point's cost must be at least the
    /// squared distance to its block's box.
    fn search(&self, position_m: Vec3<Enu>, cost: impl Fn(usize) -> f64) -> Option<usize> {
        let point = position_m.array();
        let mut best: Option<(f64, usize)> = None;
        for (b, block) in self.blocks.iter().enumerate() {
            if best.is_some_and(|(least, _)| block.distance_squared(point) > least * BOX_TOLERANCE) {
                continue;
            }
            for k in b * BLOCK_POINTS..((b + 1) * BLOCK_POINTS).min(self.points_m.len()) {
                let cost = cost(k);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, k));
                }
            }
        }
        best.map(|(_, k)| k)
    }
}

fn distance_to_segment_squared(p: Vec3<Enu>, a: Vec3<Enu>, b: Vec3<Enu>) -> f64 {
    (p - (a + (b - a) * segment_fraction(p, a, b))).norm_squared()
}

/// Returns the position on the segment from `a` (0) to `b` (1) that is nearest to `p`.
fn segment_fraction(p: Vec3<Enu>, a: Vec3<Enu>, b: Vec3<Enu>) -> f64 {
    let way = b - a;
    let length_squared = way.norm_squared();
    if length_squared > 0.0 { ((p - a).dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// Reference paths of all tasks.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferencePaths {
    paths: Vec<ReferencePath>,
    thresholds_m: Vec<f64>,
    hold_positions: Vec<bool>,
    frame_rate_hz: f64,
    exact: bool,
}

impl ReferencePaths {
    /// Creates the paths of a scenario's tasks.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            paths: scenario.tasks.iter().map(|task| ReferencePath::new(&task.path_m, task.closed)).collect(),
            thresholds_m: scenario.tasks.iter().map(|task| task.threshold_m).collect(),
            hold_positions: scenario.tasks.iter().map(|task| task.is_hold_position()).collect(),
            frame_rate_hz: scenario.scoring.frame_rate_hz,
            exact: scenario.scoring.exact_path,
        }
    }

    /// Returns the number of tasks.
    #[must_use]
    pub fn len(&self) -> usize {
        self.paths.len()
    }

    /// Returns whether there are no tasks.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.paths.is_empty()
    }

    /// Returns the path of a task.
    #[must_use]
    pub fn path(&self, task: usize) -> &ReferencePath {
        &self.paths[task]
    }

    /// Returns a task's on-path threshold in meters.
    #[must_use]
    pub fn threshold_m(&self, task: usize) -> f64 {
        self.thresholds_m[task]
    }

    /// Returns whether a task is a position to hold instead of a path to fly along.
    #[must_use]
    pub fn is_hold_position(&self, task: usize) -> bool {
        self.hold_positions[task]
    }

    /// Returns the time from frame number `frame` of the assessment to the next one. The times of all frames of a second add up to
    /// exactly 1 s, whatever the rate.
    #[must_use]
    pub fn frame_duration(&self, frame: usize) -> SimTime {
        let starts_at = |frame: usize| SimTime::from_s(frame as f64 / self.frame_rate_hz);
        starts_at(frame + 1) - starts_at(frame)
    }

    /// Returns the nearest point on a task's path and its distance (n* and l*).
    #[must_use]
    pub fn nearest(&self, task: usize, position_m: Vec3<Enu>) -> Option<NearestOnPath> {
        if self.exact { self.paths[task].nearest_exact(position_m) } else { self.paths[task].nearest_by_tasbid_rule(position_m) }
    }

    /// Returns the task whose path the drone is on: of the tasks within their threshold, the one with the smallest
    /// l*/threshold. Ties go to `current`, then to the lowest index.
    #[must_use]
    pub fn task_on_path(&self, position_m: Vec3<Enu>, current: Option<usize>) -> Option<(usize, NearestOnPath)> {
        let mut best: Option<(f64, usize, NearestOnPath)> = None;
        for task in 0..self.len() {
            let threshold = self.thresholds_m[task];
            if self.paths[task].is_beyond(position_m, threshold) {
                continue;
            }
            let Some(nearest) = self.nearest(task, position_m).filter(|nearest| nearest.distance_m <= threshold) else {
                continue;
            };
            let share = nearest.distance_m / threshold;
            let better = match best {
                None => true,
                Some((least, _, _)) => share < least || (share == least && current == Some(task)),
            };
            if better {
                best = Some((share, task, nearest));
            }
        }
        best.map(|(_, task, nearest)| (task, nearest))
    }
}

/// A task's first and last on-path frames, as indices from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TaskWindow {
    /// Index of the first frame.
    pub first: usize,
    /// Index of the last frame, inclusive.
    pub last: usize,
}

impl TaskWindow {
    /// Returns the number of frames in the window.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.last - self.first + 1
    }

    /// Returns whether the window contains frame `i`.
    #[must_use]
    pub fn contains(&self, i: usize) -> bool {
        (self.first..=self.last).contains(&i)
    }
}

/// On-path state of all frames (X_t,i). A frame is on at most one task's path.
#[derive(Debug, Clone, PartialEq)]
pub struct OnPath {
    /// For each frame, the task whose path the drone is on and the index of the nearest path point.
    pub task: Vec<Option<(usize, usize)>>,
    /// Each task's window; `None` if its path was never entered.
    pub windows: Vec<Option<TaskWindow>>,
}

impl OnPath {
    /// Determines the on-path state from positions in frame order.
    pub fn measure(paths: &ReferencePaths, positions_m: impl Iterator<Item = Vec3<Enu>>) -> Self {
        let mut windows: Vec<Option<TaskWindow>> = vec![None; paths.len()];
        let mut current = None;
        let mut task = Vec::new();
        for (i, position_m) in positions_m.enumerate() {
            let on = paths.task_on_path(position_m, current);
            if let Some((t, _)) = on {
                current = Some(t);
                let first = windows[t].map_or(i, |window| window.first);
                windows[t] = Some(TaskWindow { first, last: i });
            }
            task.push(on.map(|(t, nearest)| (t, nearest.point)));
        }
        Self { task, windows }
    }

    /// Returns the fraction of a task window's frames that are on the path (P_p,t); 0 if the path was never entered.
    #[must_use]
    pub fn share(&self, task: usize) -> f64 {
        let Some(window) = self.windows[task] else { return 0.0 };
        let on = self.task[window.first..=window.last].iter().filter(|on| on.is_some_and(|(t, _)| t == task)).count();
        on as f64 / window.frames() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::random::RandomStream;

    #[test]
    fn exact_tasbid_rule_and_exact_distance_differ_on_folded_path() {
        let points = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (20.0, 10.0)].map(|(e, n)| Vec3::new(e, n, 0.0));
        let path = ReferencePath::new(&points, false);
        let drone = Vec3::new(20.0, 3.0, 0.0);
        assert_eq!(path.nearest_by_tasbid_rule(drone).unwrap().distance_m, 7.0);
        assert_eq!(path.nearest_exact(drone).unwrap().distance_m, 3.0);
    }

    #[test]
    fn exact_only_closed_paths_wrap() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(e, n)| Vec3::new(e, n, 0.0));
        let drone = Vec3::new(0.0, 4.0, 0.0);
        assert_eq!(ReferencePath::new(&square, true).nearest_by_tasbid_rule(drone).unwrap().distance_m, 0.0);
        assert_eq!(ReferencePath::new(&square, true).nearest_exact(drone).unwrap().distance_m, 0.0);
        assert_eq!(ReferencePath::new(&square, false).nearest_by_tasbid_rule(drone).unwrap().distance_m, 4.0);
        assert_eq!(ReferencePath::new(&square, true).nearest_by_tasbid_rule(Vec3::new(-1.0, 6.0, 0.0)).unwrap().point, 3);
    }

    #[test]
    fn exact_nearest_point_ties_go_to_lowest_index() {
        let line: Vec<Vec3<Enu>> = (0..40).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        assert_eq!(ReferencePath::new(&line, false).nearest_by_tasbid_rule(Vec3::new(20.5, 1.0, 0.0)).unwrap().point, 20);
    }

    #[test]
    fn prop_block_search_matches_brute_force() {
        let mut stream = RandomStream::new(5, "paths");
        for _ in 0..200 {
            let count = 1 + stream.below(70);
            let points: Vec<Vec3<Enu>> = (0..count)
                .map(|_| {
                    Vec3::new(stream.range(-9.0, 9.0).round(), stream.range(-9.0, 9.0).round(), stream.range(0.0, 3.0).round())
                })
                .collect();
            let path = ReferencePath::new(&points, stream.below(2) == 0);
            for _ in 0..20 {
                let p = Vec3::new(stream.range(-12.0, 12.0).round(), stream.range(-12.0, 12.0).round(), stream.range(0.0, 3.0));
                let least = points.iter().map(|q| (p - *q).norm_squared()).fold(f64::INFINITY, f64::min);
                let first = points.iter().position(|q| (p - *q).norm_squared() == least).unwrap();
                assert_eq!(path.nearest_by_tasbid_rule(p).unwrap().point, first);
                let exact = (0..count).filter_map(|k| path.segment(k)).map(|(a, b)| distance_to_segment_squared(p, a, b));
                let exact = exact.fold(least, f64::min).sqrt();
                assert_eq!(path.nearest_exact(p).unwrap().distance_m, exact);
                assert!(((p - path.closest_position(p).unwrap()).norm() - exact).abs() < 1e-12);
            }
        }
    }
}
