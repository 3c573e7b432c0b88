//! Coverage: the fraction of each reference path's length that was flown.

use super::on_path::{OnPath, ReferencePath, ReferencePaths};
use spandrel_model::scenario::HOLD_DURATION;
use spandrel_model::time::SimTime;

/// Maximum path length between the nearest points of two consecutive frames that counts as flown, m (estimate: frames are at most
/// 1.4 m apart at 13.4 m/s and 10 Hz, but the nearest point moves farther if the drone cuts a corner within the threshold).
const MAX_COVERED_STEP_M: f64 = 5.0;

/// Coverage of one path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathCoverage {
    /// Length of the path, m; 0 for a single point.
    pub length_m: f64,
    /// Fraction of the length that was flown, 0 to 1. For a hold position, the longest time on it without leaving it, as a fraction
    /// of [`HOLD_DURATION`], at most 1.
    pub share: f64,
}

/// Computes the coverage of all paths, in task order.
#[must_use]
pub fn coverage(paths: &ReferencePaths, on_path: &OnPath) -> Vec<PathCoverage> {
    (0..paths.len()).map(|task| task_coverage(paths, task, on_path)).collect()
}

fn task_coverage(paths: &ReferencePaths, task: usize, on_path: &OnPath) -> PathCoverage {
    let mut flown = FlownPath::of_task(paths, task);
    for (frame, on) in on_path.task.iter().enumerate() {
        flown.add_frame(on.and_then(|(t, point)| (t == task).then_some(point)), paths.frame_duration(frame));
    }
    flown.coverage()
}

/// The part of a path that was flown, updated frame by frame.
///
/// A point represents half of each adjacent segment. It is covered if it was the nearest point in an on-path frame or
/// lies between the nearest points of two consecutive on-path frames. The time on a hold position is the sum of the frames' durations, so
/// that the monitor, which gets more frames per second in flight, measures the same as the assessment.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    distances_along_path_m: Vec<f64>,
    point_lengths_m: Vec<f64>,
    threshold_m: f64,
    covered: Vec<bool>,
    previous_point: Option<usize>,
    hold: Option<HoldTime>,
}

/// Time on a hold position without leaving it: now, and at most.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct HoldTime {
    current: SimTime,
    longest: SimTime,
}

impl HoldTime {
    fn add(&mut self, on: bool, duration: SimTime) {
        self.current = if on { self.current + duration } else { SimTime::ZERO };
        self.longest = self.longest.max(self.current);
    }

    fn share(self) -> f64 {
        (self.longest.ns() as f64 / HOLD_DURATION.ns() as f64).min(1.0)
    }
}

impl FlownPath {
    /// Creates a tracker for the path of a task. Unlike a path, a hold position is not flown by reaching it.
    #[must_use]
    pub fn of_task(paths: &ReferencePaths, task: usize) -> Self {
        let hold = paths.is_hold_position(task).then(HoldTime::default);
        Self { hold, ..Self::new(paths.path(task), paths.threshold_m(task)) }
    }

    /// Creates a tracker for a path that has not been flown yet.
    #[must_use]
    pub fn new(path: &ReferencePath, threshold_m: f64) -> Self {
        let covered = vec![false; path.points_m().len()];
        Self {
            distances_along_path_m: path.distances_along_path_m(),
            point_lengths_m: path.lengths_by_point_m(),
            threshold_m,
            covered,
            previous_point: None,
            hold: None,
        }
    }

    /// Adds a frame and the time that it stands for. `point` is the index of the nearest path point, or `None` while the drone is off
    /// the path. An out-of-range index counts as `None`.
    pub fn add_frame(&mut self, point: Option<usize>, duration: SimTime) {
        let point = point.filter(|point| *point < self.covered.len());
        if let Some(point) = point {
            let near =
                |b: &usize| (self.distances_along_path_m[*b] - self.distances_along_path_m[point]).abs() <= MAX_COVERED_STEP_M;
            let from = self.previous_point.filter(near).unwrap_or(point);
            self.covered[from.min(point)..=from.max(point)].fill(true);
        }
        self.previous_point = point;
        if let Some(hold) = &mut self.hold {
            hold.add(point.is_some(), duration);
        }
    }

    /// Returns whether each path point was flown.
    #[must_use]
    pub fn points(&self) -> &[bool] {
        &self.covered
    }

    /// Returns whether this is a hold position at which the drone has stayed long enough.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.hold.is_some_and(|hold| hold.longest >= HOLD_DURATION)
    }

    /// Returns the path's length and the fraction that was flown.
    #[must_use]
    pub fn coverage(&self) -> PathCoverage {
        let length_m: f64 = self.point_lengths_m.iter().sum();
        let flown = self.point_lengths_m.iter().zip(&self.covered).filter(|(_, covered)| **covered);
        let covered_m = flown.fold(0.0, |sum, (weight, _)| sum + weight);
        if let Some(hold) = self.hold {
            return PathCoverage { length_m, share: hold.share() };
        }
        let any = f64::from(u8::from(self.covered.iter().any(|covered| *covered)));
        // Reaching a path no longer than the distance covers all of it. If every point is covered, the share is exactly 1 despite
        // rounding.
        let whole = length_m <= self.threshold_m || self.covered.iter().all(|covered| *covered);
        let share = if whole { any } else { covered_m / length_m };
        PathCoverage { length_m, share }
    }
}

/// Fraction of a closed path after which nothing remains to be flown (estimate: cutting a corner skips some points).
const MIN_FINISHED_LOOP_SHARE: f64 = 0.9;

impl FlownPath {
    /// Returns whether nothing remains to be flown: the task is done, and the drone has been at both ends of the path, within
    /// the threshold. A hold position is never finished.
    #[must_use]
    pub fn is_finished(&self, closed: bool, done_share: f64) -> bool {
        let PathCoverage { length_m, share } = self.coverage();
        if share < done_share || self.hold.is_some() || length_m <= self.threshold_m {
            return false;
        }
        if closed {
            return share >= MIN_FINISHED_LOOP_SHARE;
        }
        let mut flown_m =
            self.distances_along_path_m.iter().zip(&self.covered).filter(|(_, covered)| **covered).map(|(at_m, _)| *at_m);
        let (first_m, last_m) = (flown_m.next(), flown_m.next_back());
        first_m.is_some_and(|at_m| at_m <= self.threshold_m) && last_m.is_some_and(|at_m| at_m >= length_m - self.threshold_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;
    use spandrel_model::{scenario, shipped};

    /// Time of a frame at 10 Hz.
    const FRAME: SimTime = SimTime::from_ms(100);

    #[test]
    fn exact_a_hold_counts_its_longest_stay_at_any_rate() {
        let job = scenario::read("job.toml", shipped::DRILL_HOVER, &|file| Err(file.to_owned())).unwrap();
        for rate_hz in [10.0, 29.97, 30.0, 50.0] {
            let mut job = job.clone();
            job.scoring.frame_rate_hz = rate_hz;
            let paths = ReferencePaths::new(&job);
            let mut flown = FlownPath::of_task(&paths, 0);
            let needed = (HOLD_DURATION.s() * rate_hz).ceil() as usize;
            let frames = |from: usize, count: usize| (from..from + count).map(|frame| paths.frame_duration(frame));
            frames(0, needed / 2).for_each(|duration| flown.add_frame(Some(0), duration));
            flown.add_frame(None, paths.frame_duration(needed / 2));
            let half = flown.coverage().share;
            assert!((half - 0.5).abs() <= 1.0 / needed as f64 && !flown.is_held(), "{rate_hz} Hz: {half}");
            frames(needed, needed / 4).for_each(|duration| flown.add_frame(Some(0), duration));
            assert_eq!(flown.coverage().share, half, "a shorter stay does not count");
            flown.add_frame(None, FRAME);
            frames(2 * needed, needed - 1).for_each(|duration| flown.add_frame(Some(0), duration));
            assert!(!flown.is_held(), "{rate_hz} Hz: one frame is missing");
            flown.add_frame(Some(0), paths.frame_duration(3 * needed - 1));
            assert!(flown.is_held() && flown.coverage().share == 1.0, "{rate_hz} Hz: {flown:?}");
        }
    }

    #[test]
    fn exact_path_is_finished_once_both_ends_were_reached() {
        let points: Vec<_> = (0..21).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        let path = ReferencePath::new(&points, false);
        let fly = |closed: bool, threshold_m: f64, flown: std::ops::RangeInclusive<usize>| {
            let mut one = FlownPath::new(&path, threshold_m);
            flown.for_each(|point| one.add_frame(Some(point), FRAME));
            one.is_finished(closed, 0.8)
        };
        assert!(fly(false, 2.0, 0..=20) && fly(false, 2.0, 2..=18));
        assert!(!fly(false, 2.0, 0..=17) && !fly(false, 2.0, 3..=20), "done, but one end is missing");
        assert!(!fly(false, 2.0, 0..=12), "not done");
        assert!(fly(true, 2.0, 0..=18) && !fly(true, 2.0, 0..=17), "90% of a loop");
        assert!(!fly(false, 20.0, 0..=20), "a hold position");
    }

    #[test]
    fn exact_short_gaps_between_frames_are_covered() {
        let points: Vec<_> = (0..11).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        let mut flown = FlownPath::new(&ReferencePath::new(&points, false), 1.0);
        assert_eq!(flown.coverage(), PathCoverage { length_m: 10.0, share: 0.0 });
        flown.add_frame(Some(0), FRAME);
        flown.add_frame(Some(4), FRAME);
        assert_eq!(flown.coverage().share, 0.45, "half a meter for the first point, one meter for each of four points");
        flown.add_frame(Some(10), FRAME);
        assert_eq!(flown.coverage().share, 0.5, "a gap of 6 m is not covered");
        flown.add_frame(None, FRAME);
        flown.add_frame(Some(8), FRAME);
        flown.add_frame(Some(11), FRAME);
        assert_eq!(flown.coverage().share, 0.6, "an index out of range is ignored");
        assert_eq!(flown.points().iter().filter(|flown| **flown).count(), 7);
    }
}
