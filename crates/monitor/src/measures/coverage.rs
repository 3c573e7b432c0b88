//! How much of each task's reference path was flown, by length: the one measure of coverage.

use super::on_path::{OnPath, ReferencePath, ReferencePaths};

/// Between two frames in a row, the path between their nearest points counts as flown up to this length, m (estimate: frames are at most
/// 1.4 m apart at 13.4 m/s and 10 Hz; the nearest point jumps farther where the drone cuts a corner within the threshold).
const JOINED_M: f64 = 5.0;

/// Coverage of one path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathCoverage {
    /// Length of the path, m; 0 for a single point.
    pub length_m: f64,
    /// Share of the length that was flown, 0 to 1; of a path no longer than its threshold 1 once the drone was there.
    pub share: f64,
}

/// Coverage of every path, in the order of the tasks.
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

/// The part of one path that was flown, frame by frame.
///
/// A point stands for half of each segment that touches it. It is covered when it was the nearest one in an on-path frame, or lies between
/// the nearest points of two on-path frames in a row.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    along_m: Vec<f64>,
    weights_m: Vec<f64>,
    threshold_m: f64,
    covered: Vec<bool>,
    before: Option<usize>,
}

impl FlownPath {
    /// Starts with no part of the path flown.
    #[must_use]
    pub fn new(path: &ReferencePath, threshold_m: f64) -> Self {
        let covered = vec![false; path.points_m().len()];
        Self { along_m: path.along_m(), weights_m: path.lengths_by_point_m(), threshold_m, covered, before: None }
    }

    /// Adds a frame: the nearest point of the path while the drone is on it, else `None`. An index outside the path counts as `None`.
    pub fn note(&mut self, point: Option<usize>) {
        let point = point.filter(|point| *point < self.covered.len());
        if let Some(point) = point {
            let near = |b: &usize| (self.along_m[*b] - self.along_m[point]).abs() <= JOINED_M;
            let from = self.before.filter(near).unwrap_or(point);
            self.covered[from.min(point)..=from.max(point)].fill(true);
        }
        self.before = point;
    }

    /// For each point of the path, whether it was flown.
    #[must_use]
    pub fn points(&self) -> &[bool] {
        &self.covered
    }

    /// Length and flown share of the path.
    #[must_use]
    pub fn coverage(&self) -> PathCoverage {
        let length_m: f64 = self.weights_m.iter().sum();
        let flown = self.weights_m.iter().zip(&self.covered).filter(|(_, covered)| **covered);
        let covered_m = flown.fold(0.0, |sum, (weight, _)| sum + weight);
        let any = f64::from(u8::from(self.covered.iter().any(|covered| *covered)));
        // A path no longer than its threshold is a place to hold: whoever is there is on all of it. Every point covered is the whole path,
        // whatever the sums round to.
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
