//! Requirements of each of the defects to place: lines or areas, and their predicted detection.

use super::defect_checks::PlacementContext;
use super::detection;
use super::reference_camera::REFERENCE_CAMERA;
use crate::defect_codes;
use crate::random::RandomStream;
use crate::scenario::{DefectSpec, PlacedDefect};

/// Maximum difference between the predicted detection of a defect and the mean of its set (estimate: the set then contains
/// easy and hard defects, and none that everybody or nobody finds).
const MAX_DETECTION_SPREAD: f64 = 0.25;

/// Requirements of one of the defects to place.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Slot {
    /// True for a line, false for an area, `None` for either.
    pub(super) line: Option<bool>,
    /// Predicted detection, 0 to 1; `None` to draw the size from the catalog.
    pub(super) detection: Option<f64>,
}

/// Returns the requirements of all defects: lines at even intervals, and the difficulties in random order. They use a
/// stream of their own, so that they do not affect the positions of defects without requirements.
pub(super) fn draw_slots(settings: &DefectSpec, seed: u64) -> Vec<Slot> {
    let count = settings.count;
    let mut slots = vec![Slot::default(); count];
    if let Some(lines) = settings.line_count.map(|lines| lines.min(count)) {
        for (k, slot) in slots.iter_mut().enumerate() {
            slot.line = Some((k + 1) * lines / count > k * lines / count);
        }
    }
    if let Some(mean) = settings.mean_detection {
        let mut targets = detection::spread_targets(count, mean, MAX_DETECTION_SPREAD);
        let mut stream = RandomStream::new(seed, "site.defects.difficulty");
        for slot in &mut slots {
            slot.detection = Some(targets.swap_remove(stream.below(targets.len())));
        }
    }
    slots
}

/// Gives a defect the size with the target detection, and the condition state of this size. `None` if no size in the
/// catalog has it.
pub(super) fn resize(
    defect: &mut PlacedDefect,
    target: f64,
    context: &PlacementContext,
    stream: &mut RandomStream,
) -> Option<()> {
    let limits = defect_codes::target_size_ranges(defect.kind);
    let width = stream.range(limits.width.0, limits.width.1);
    let width_m = |length_m: f64| if defect.line { width } else { width * length_m };
    let view = detection::view_scale(defect, context.tasks, &REFERENCE_CAMERA, context.cast)?;
    let length_m = view.length_for(target, limits.length_m, &width_m, defect.line)?;
    (defect.width_m, defect.length_m) = (width_m(length_m), length_m);
    if let Some(state) = defect_codes::condition_state(defect.kind, defect.length_m, defect.width_m) {
        defect.condition_state = state;
    }
    Some(())
}
