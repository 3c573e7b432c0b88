//! Coverage: the fraction of each task's reference path that was flown, by length.

use super::on_path::{OnPath, ReferencePath, ReferencePaths};

/// Maximum path length between the nearest points of two consecutive frames that counts as flown, m (estimate: frames are at most
/// 1.4 m apart at 13.4 m/s and 10 Hz; the nearest point jumps farther where the drone cuts a corner within the threshold).
const JOINED_M: f64 = 5.0;

/// Coverage of one path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathCoverage {
    /// Length of the path, m; 0 for a single point.
    pub length_m: f64,
    /// Fraction of the length that was flown, 0 to 1. For a path no longer than its threshold: 1 once it was reached.
    pub share: f64,
}

/// Computes the coverage of every path, in task order.
#[must_use]
pub fn coverage(paths: &ReferencePaths, on_path: &OnPath) -> Vec<PathCoverage> {
    (0..paths.len()).map(|task| of_task(paths.path(task), paths.threshold_m(task), task, on_path)).collect()
}

fn of_task(path: &ReferencePath, threshold_m: f64, task: usize, on_path: &OnPath) -> PathCoverage {
    let mut flown = FlownPath::new(path, threshold_m);
    for on in &on_path.task {
        flown.note(on.and_then(|(t, point)| (t == task).then_some(point)));
    }
    flown.coverage()
}

/// The part of one path flown so far, updated frame by frame.
///
/// A point represents half of each adjacent segment. It is covered if it was the nearest point in an on-path frame or lies
/// between the nearest points of two consecutive on-path frames.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    along_m: Vec<f64>,
    weights_m: Vec<f64>,
    threshold_m: f64,
    covered: Vec<bool>,
    before: Option<usize>,
}

impl FlownPath {
    /// Creates a tracker with nothing flown.
    #[must_use]
    pub fn new(path: &ReferencePath, threshold_m: f64) -> Self {
        let covered = vec![false; path.points_m().len()];
        Self { along_m: path.along_m(), weights_m: path.lengths_by_point_m(), threshold_m, covered, before: None }
    }

    /// Adds a frame: the index of the nearest path point while the drone is on the path, otherwise `None`. An index out of range
    /// counts as `None`.
    pub fn note(&mut self, point: Option<usize>) {
        let point = point.filter(|point| *point < self.covered.len());
        if let Some(point) = point {
            let near = |b: &usize| (self.along_m[*b] - self.along_m[point]).abs() <= JOINED_M;
            let from = self.before.filter(near).unwrap_or(point);
            self.covered[from.min(point)..=from.max(point)].fill(true);
        }
        self.before = point;
    }

    /// Returns, for each point of the path, whether it was flown.
    #[must_use]
    pub fn points(&self) -> &[bool] {
        &self.covered
    }

    /// Returns the length and the flown fraction of the path.
    #[must_use]
    pub fn coverage(&self) -> PathCoverage {
        let length_m: f64 = self.weights_m.iter().sum();
        let flown = self.weights_m.iter().zip(&self.covered).filter(|(_, covered)| **covered);
        let covered_m = flown.fold(0.0, |sum, (weight, _)| sum + weight);
        let any = f64::from(u8::from(self.covered.iter().any(|covered| *covered)));
        // A path no longer than its threshold is a hold position: reaching it covers all of it. If every point is covered, the
        // share is exactly 1 regardless of rounding.
        let whole = length_m <= self.threshold_m || self.covered.iter().all(|covered| *covered);
        let share = if whole { any } else { covered_m / length_m };
        PathCoverage { length_m, share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;

    #[test]
    fn exact_a_path_is_flown_point_by_point_and_between_near_frames() {
        let points: Vec<_> = (0..11).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        let mut flown = FlownPath::new(&ReferencePath::new(&points, false), 1.0);
        assert_eq!(flown.coverage(), PathCoverage { length_m: 10.0, share: 0.0 });
        flown.note(Some(0));
        flown.note(Some(4));
        assert_eq!(flown.coverage().share, 0.45, "joined: half a metre at the start, one for each of four points");
        flown.note(Some(10));
        assert_eq!(flown.coverage().share, 0.5, "6 m on are not joined");
        flown.note(None);
        flown.note(Some(8));
        flown.note(Some(11));
        assert_eq!(flown.coverage().share, 0.6, "beyond the last point there is none");
        assert_eq!(flown.points().iter().filter(|flown| **flown).count(), 7);
    }
}
