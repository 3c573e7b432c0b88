//! How much of each task's reference path was flown, by length: the one measure of coverage.

use super::on_path::{OnPath, Path, Paths};

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
pub fn coverage(paths: &Paths, on_path: &OnPath) -> Vec<PathCoverage> {
    (0..paths.len()).map(|task| of_task(paths.path(task), paths.threshold_m(task), task, on_path)).collect()
}

/// A point stands for half of each segment that touches it. It is covered when it was the nearest one in an on-path frame, or lies between
/// the nearest points of two on-path frames in a row.
fn of_task(path: &Path, threshold_m: f64, task: usize, on_path: &OnPath) -> PathCoverage {
    let along_m = path.along_m();
    let mut covered = vec![false; path.points_m().len()];
    let mut before: Option<usize> = None;
    for on in &on_path.task {
        let point = on.and_then(|(t, point)| (t == task).then_some(point));
        if let Some(point) = point {
            let near = |b: &usize| (along_m[*b] - along_m[point]).abs() <= JOINED_M;
            let from = before.filter(near).unwrap_or(point);
            covered[from.min(point)..=from.max(point)].fill(true);
        }
        before = point;
    }
    let weights = path.lengths_by_point_m();
    let length_m: f64 = weights.iter().sum();
    let covered_m = weights.iter().zip(&covered).filter(|(_, covered)| **covered).fold(0.0, |sum, (weight, _)| sum + weight);
    let any = f64::from(u8::from(covered.iter().any(|covered| *covered)));
    // A path no longer than its threshold is a place to hold: whoever is there is on all of it. Every point covered is the whole path,
    // whatever the sums round to.
    let whole = length_m <= threshold_m || covered.iter().all(|covered| *covered);
    let share = if whole { any } else { covered_m / length_m };
    PathCoverage { length_m, share }
}
