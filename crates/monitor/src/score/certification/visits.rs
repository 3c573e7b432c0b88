//! Visits to the tasks, and conformity: the on-path share weighted by the part of the path that was flown.

use super::inputs::CertificationInputs;
use crate::measures::on_path::OnPath;
use spandrel_mavlink::telemetry::Frame;
use std::ops::RangeInclusive;

/// On-path intervals closer together than this count as one visit, s (estimate: longer than a turn, shorter than a
/// transit to another task).
const VISIT_MERGE_GAP_S: f64 = 10.0;

/// Frame indices of the visits to one task, from 0, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VisitRanges(pub Vec<RangeInclusive<usize>>);

impl VisitRanges {
    /// Returns the visits to a task: on-path intervals, merged if they are less than 10 s apart.
    #[must_use]
    pub fn of_task(on_path: &OnPath, task: usize, frame_rate_hz: f64) -> Self {
        let apart_frames = VISIT_MERGE_GAP_S * frame_rate_hz;
        let mut ranges: Vec<RangeInclusive<usize>> = Vec::new();
        for (i, _) in on_path.task.iter().enumerate().filter(|(_, on)| on.is_some_and(|(t, _)| t == task)) {
            match ranges.last_mut() {
                Some(last) if ((i - last.end()) as f64) < apart_frames => *last = *last.start()..=i,
                Some(_) | None => ranges.push(i..=i),
            }
        }
        Self(ranges)
    }

    /// Returns the indices of all frames in the visits.
    pub fn frames(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().flat_map(Clone::clone)
    }
}

/// One task's share of the conformity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskConformity {
    /// Number of frames in the visits.
    pub frames: usize,
    /// Fraction of the visits' frames that are on the path, 0 to 1.
    pub on_path: f64,
    /// Speeding loss, computed over the frames in the visits.
    pub speeding: f64,
    /// Whether enough of the path was flown to count as inspected.
    pub inspected: bool,
}

impl TaskConformity {
    /// Computes one task's share.
    #[must_use]
    pub fn measure(inputs: &CertificationInputs<'_>, task: usize, visits: &VisitRanges) -> Self {
        let limit = inputs.scenario.scoring.speed_limit_m_s;
        let frames = visits.frames().count();
        let on = inputs.on_path.task.iter().filter(|on| on.is_some_and(|(t, _)| t == task)).count();
        let speeds = visits.frames().map(|i| &inputs.session.frames[i]).map(Frame::speed_m_s);
        let loss: f64 = speeds.filter(|v| *v > limit).map(|v| v / limit).sum();
        // Summing an empty list of floats gives -0.0. Adding 0.0 turns it into +0.0.
        let per_frame = |sum: f64| if frames == 0 { 0.0 } else { (sum + 0.0) / frames as f64 };
        Self {
            frames,
            on_path: per_frame(on as f64),
            speeding: per_frame(loss),
            inspected: frames > 0 && inputs.covered[task].share >= inputs.scenario.certification.min_inspected_fraction,
        }
    }
}

/// Computes the conformity, 0 to 100: 100 times the mean of coverage times on-path share over all tasks, minus the
/// speeding loss with the weight of the TASBID paper. A task that was not inspected contributes 0. `None` if no path was
/// entered.
#[must_use]
pub fn conformity(inputs: &CertificationInputs<'_>, tasks: &[TaskConformity]) -> Option<f64> {
    if tasks.iter().all(|task| task.frames == 0) {
        return None;
    }
    let scoring = &inputs.scenario.scoring;
    let count = tasks.len() as f64;
    let shares = tasks.iter().zip(inputs.covered).filter(|(task, _)| task.inspected);
    let on_path: f64 = shares.fold(0.0, |sum, (task, covered)| sum + covered.share * task.on_path);
    let speeding: f64 = tasks.iter().fold(0.0, |sum, task| sum + task.speeding);
    let speed_weight = scoring.speed_limit_m_s / scoring.max_speed_m_s;
    Some((100.0 * (on_path - speed_weight * speeding) / count).clamp(0.0, 100.0))
}
