//! Predicted detection of defects: the probability that a trained inspector notices a defect in the camera picture, from
//! its size and its contrast in a picture taken on a task's path. It does not depend on the pilot, and with the reference
//! camera not on the aircraft either, so that sets of defects can be compared (docs/src/explanation/forms.md).

use super::light::RayCast;
use super::reference_camera::{CAMERA_DISTANCE_FRACTIONS, REFERENCE_LAMP, candidate_poses};
use super::visibility::{self, MAX_INCIDENCE_RAD};
use crate::math;
use crate::scenario::{PlacedDefect, Task};
use crate::vehicle::Camera;

/// Length of a defect that half of the inspectors detect, mm (Campbell et al. 2020: 50% at 26 mm, 90% at 113 mm).
pub const MEDIAN_LENGTH_MM: f64 = 26.0;
/// Spread of the lognormal detection curve, which follows from the same two values: ln(113/26)/1.2816.
pub const LENGTH_SIGMA_LN: f64 = 1.147;
/// Extent in the picture from which the curve applies without a reduction, px (estimate: four times the smallest extent
/// that the scorer accepts).
pub const CLEAR_EXTENT_PX: f64 = 40.0;
/// Millimeters in a meter.
const MM_PER_M: f64 = 1000.0;
/// Steps of the search for a length: each halves the interval, so the result is exact to the last bit of the ratio.
const BISECTION_STEPS: usize = 60;

/// Returns the probability that a trained inspector detects a defect of this length, in mm, that is clearly visible.
#[must_use]
pub fn probability_of_detection(length_mm: f64) -> f64 {
    probability_with_median(length_mm, MEDIAN_LENGTH_MM)
}

/// Returns the probability that a person who detects half of all defects of length `median_mm` detects one of this length,
/// in mm, that is clearly visible.
#[must_use]
pub fn probability_with_median(length_mm: f64, median_mm: f64) -> f64 {
    let z = (math::ln(length_mm.max(1e-9)) - math::ln(median_mm)) / LENGTH_SIGMA_LN;
    0.5 * math::erfc(-z / std::f64::consts::SQRT_2)
}

/// Scale of the picture in which a defect is predicted to be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewScale {
    /// Pixels per meter along the defect.
    along_px_per_m: f64,
    /// Pixels per meter across the defect.
    across_px_per_m: f64,
}

impl ViewScale {
    /// Returns the predicted detection, 0 to 1, of a defect with this length and width, m. A defect that is small in the
    /// picture counts as a shorter one, and so does a line that is thinner than a pixel, because its contrast is lower.
    #[must_use]
    pub fn probability(&self, length_m: f64, width_m: f64, line: bool) -> f64 {
        let (along_px, across_px) = (self.along_px_per_m * length_m, self.across_px_per_m * width_m);
        let extent_px = if line { along_px } else { along_px.max(across_px) };
        let contrast = if line { across_px.min(1.0) } else { 1.0 };
        probability_of_detection(MM_PER_M * length_m * contrast * (extent_px / CLEAR_EXTENT_PX).min(1.0))
    }

    /// Returns the length, m, whose predicted detection is `target`. `width_m` is the width for each length. `None` if no
    /// length in the range has it.
    pub(super) fn length_for(&self, target: f64, range_m: (f64, f64), width_m: &dyn Fn(f64) -> f64, line: bool) -> Option<f64> {
        let at = |length_m: f64| self.probability(length_m, width_m(length_m), line);
        let (mut low, mut high) = range_m;
        if at(low) > target || at(high) < target {
            return None;
        }
        for _ in 0..BISECTION_STEPS {
            let middle = (low * high).sqrt();
            if at(middle) < target {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }
}

/// Returns the scale of the best picture of a defect that a camera takes on or near the tasks' paths, aimed at
/// the defect. Among the points of a path, the nearest with a clear and sufficiently frontal line of sight counts; it moves
/// from the path toward the defect only if necessary. `None` if the defect is hidden from all paths. The defect's size does
/// not matter.
pub(super) fn view_scale(defect: &PlacedDefect, tasks: &[Task], camera: &Camera, cast: RayCast) -> Option<ViewScale> {
    let point = PlacedDefect { length_m: 0.0, width_m: 0.0, ..defect.clone() };
    let clear = |task: &Task, share: f64| {
        candidate_poses(defect.position_m, task, share).find_map(|pose| {
            let view = visibility::evaluate_defect(&point, &pose, (camera, &REFERENCE_LAMP), cast, &|_, _| f64::INFINITY)?;
            let seen = view.unoccluded && view.incidence_rad <= MAX_INCIDENCE_RAD;
            seen.then(|| {
                let scale = |direction| visibility::length_px(&pose, camera, defect, direction, 1.0);
                let (along_px_per_m, across_px_per_m) = (scale(defect.along), scale(defect.normal.cross(defect.along)));
                ViewScale { along_px_per_m, across_px_per_m }
            })
        })
    };
    CAMERA_DISTANCE_FRACTIONS.iter().find_map(|share| {
        let views = tasks.iter().filter_map(|task| clear(task, *share));
        views.max_by(|a, b| a.along_px_per_m.total_cmp(&b.along_px_per_m))
    })
}

/// Returns the predicted detection of a placed defect in a camera's pictures, 0 to 1; 0 if it is hidden from all paths.
#[must_use]
pub fn predicted_detection(defect: &PlacedDefect, tasks: &[Task], camera: &Camera, cast: RayCast) -> f64 {
    view_scale(defect, tasks, camera, cast).map_or(0.0, |view| view.probability(defect.length_m, defect.width_m, defect.line))
}

/// Returns the predicted detection of each of `count` defects, in ascending order, so that their mean is `mean`: evenly
/// spaced over a range whose half width is at most `max_spread` and leaves a tenth of the distance to 0 and 1.
#[must_use]
pub fn spread_targets(count: usize, mean: f64, max_spread: f64) -> Vec<f64> {
    let half = (0.9 * mean).min(0.9 * (1.0 - mean)).min(max_spread);
    let n = count as f64;
    (0..count).map(|k| mean + half * ((2.0 * k as f64 + 1.0) / n - 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a percentage point: the published values are rounded to whole millimeters and percent.
    const PUBLISHED_TOLERANCE: f64 = 0.005;
    /// Rounding of a sum of a few numbers near 1.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn val_curve_passes_through_the_published_values() {
        // Campbell, Connor, Whitehead and Washer 2020: 50% at 26 mm, 90% at 113 mm.
        for (length_mm, detected) in [(26.0, 0.5), (113.0, 0.9)] {
            let found = probability_of_detection(length_mm);
            assert!((found - detected).abs() < PUBLISHED_TOLERANCE, "{length_mm} mm: {found}");
        }
    }

    #[test]
    fn exact_targets_have_the_requested_mean() {
        for (count, mean) in [(1, 0.75), (10, 0.75), (7, 0.55), (10, 0.97), (3, 0.05)] {
            let targets = spread_targets(count, mean, 0.25);
            assert_eq!(targets.len(), count);
            assert!((targets.iter().sum::<f64>() / count as f64 - mean).abs() < ROUNDING, "{targets:?}");
            assert!(targets.iter().all(|p| *p > 0.0 && *p < 1.0) && targets.is_sorted(), "{targets:?}");
        }
    }

    #[test]
    fn exact_length_has_the_target_probability() {
        let view = ViewScale { along_px_per_m: 280.0, across_px_per_m: 250.0 };
        for (target, line) in [(0.3, false), (0.75, false), (0.97, false), (0.6, true)] {
            let width = |length: f64| if line { 0.001 } else { 0.5 * length };
            let length = view.length_for(target, (0.02, 2.0), &width, line).unwrap();
            assert!((view.probability(length, width(length), line) - target).abs() < ROUNDING, "{target}: {length} m");
        }
        assert_eq!(view.length_for(0.01, (0.1, 2.0), &|l| l, false), None, "even the shortest is easier to find");
        assert_eq!(view.length_for(0.99, (0.02, 0.05), &|l| l, false), None, "even the longest is harder to find");
    }

    #[test]
    fn exact_small_and_thin_defects_are_harder_to_find() {
        let view = ViewScale { along_px_per_m: 400.0, across_px_per_m: 400.0 };
        // 200 mm are 80 px, so only the length counts; 50 mm are 20 px, which halves the length that counts.
        assert_eq!(view.probability(0.2, 0.1, false), probability_of_detection(200.0));
        assert_eq!(view.probability(0.05, 0.01, false), probability_of_detection(25.0));
        // A line of 1 mm is 0.4 px wide.
        assert_eq!(view.probability(0.5, 0.001, true), probability_of_detection(200.0));
    }
}
