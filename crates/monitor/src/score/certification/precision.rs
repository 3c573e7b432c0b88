//! Precision: how closely the drone followed the path, kept the speed limit and the clearance, and kept the camera on
//! the surface under inspection. All four are measured over the visits' frames.

use super::inputs::CertificationInputs;
use super::visits::VisitRanges;
use crate::measures::attention;
use crate::measures::image_quality::angle_rad;
use serde::{Deserialize, Serialize};

/// Angle between the optical axis and the viewing direction up to which the framing error is 0, degrees (estimate: the
/// point of the surface straight across from the drone leaves the picture of the shipped cameras at 42 degrees; paths
/// under the arch and in the interlayer have surfaces on several sides).
pub const FRAMING_TOLERANCE_DEG: f64 = 45.0;
/// RMS framing error at which the precision is 0, degrees: that of a random heading toward a vertical surface, whose angle
/// is uniformly distributed from 0 to 180 degrees.
const MAX_FRAMING_ERROR_DEG: f64 = 67.5;

/// Precision measures of one task or of the whole session. Frames in telemetry gaps are left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PrecisionMeasures {
    /// Number of frames measured.
    pub frames: usize,
    /// RMS distance to the path, as a multiple of the task's threshold.
    pub rms_distance_ratio: f64,
    /// RMS speed above the limit, as a multiple of the limit.
    pub rms_speeding_ratio: f64,
    /// RMS framing error, degrees: the angle between the optical axis and the direction to the surface under inspection,
    /// beyond the first 45 degrees; absent if no task inspects a surface.
    pub rms_framing_deg: Option<f64>,
    /// Fraction of the frames that are closer to a surface than the clearance limit, 0 to 1.
    pub low_clearance_share: f64,
}

/// Sums over frames from which the measures are computed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PrecisionSums {
    frames: usize,
    distance_ratio_squared: f64,
    speeding_ratio_squared: f64,
    framing_deg_squared: f64,
    framed_frames: usize,
    low_clearance_frames: usize,
}

impl PrecisionSums {
    /// Sums over the visits to one task.
    #[must_use]
    pub fn of_task(inputs: &CertificationInputs<'_>, task: usize, visits: &VisitRanges) -> Self {
        let spec = &inputs.scenario.tasks[task];
        let speed_limit_m_s = inputs.scenario.scoring.speed_limit_m_s;
        let clearance_m = inputs.clearance_limit_m(Some(spec));
        let mut sums = Self::default();
        for frame in visits.frames().map(|i| &inputs.session.frames[i]).filter(|frame| !frame.missing) {
            let Some(nearest) = inputs.paths.nearest(task, frame.position_m) else { continue };
            let distance_ratio = nearest.distance_m / spec.threshold_m;
            let speeding_ratio = (frame.speed_m_s() / speed_limit_m_s - 1.0).max(0.0);
            sums.frames += 1;
            sums.distance_ratio_squared += distance_ratio * distance_ratio;
            sums.speeding_ratio_squared += speeding_ratio * speeding_ratio;
            sums.low_clearance_frames += usize::from(inputs.is_too_close(frame, clearance_m));
            let pose = attention::pose(inputs.flight, frame.time, inputs.vehicle);
            let surface = spec.viewing_directions.get(nearest.point).filter(|_| spec.inspects_surface);
            if let Some((pose, surface)) = pose.zip(surface) {
                let framing_deg = (angle_rad(pose.forward, *surface).to_degrees() - FRAMING_TOLERANCE_DEG).max(0.0);
                sums.framing_deg_squared += framing_deg * framing_deg;
                sums.framed_frames += 1;
            }
        }
        sums
    }

    /// Returns the sums over the frames of both.
    #[must_use]
    pub fn combined_with(self, more: Self) -> Self {
        Self {
            frames: self.frames + more.frames,
            distance_ratio_squared: self.distance_ratio_squared + more.distance_ratio_squared,
            speeding_ratio_squared: self.speeding_ratio_squared + more.speeding_ratio_squared,
            framing_deg_squared: self.framing_deg_squared + more.framing_deg_squared,
            framed_frames: self.framed_frames + more.framed_frames,
            low_clearance_frames: self.low_clearance_frames + more.low_clearance_frames,
        }
    }

    /// Returns the measures; `None` if there are no frames.
    #[must_use]
    pub fn measures(self) -> Option<PrecisionMeasures> {
        let rms = |sum: f64, frames: usize| (sum / frames as f64).sqrt();
        (self.frames > 0).then(|| PrecisionMeasures {
            frames: self.frames,
            rms_distance_ratio: rms(self.distance_ratio_squared, self.frames),
            rms_speeding_ratio: rms(self.speeding_ratio_squared, self.frames),
            rms_framing_deg: (self.framed_frames > 0).then(|| rms(self.framing_deg_squared, self.framed_frames)),
            low_clearance_share: self.low_clearance_frames as f64 / self.frames as f64,
        })
    }
}

impl PrecisionMeasures {
    /// Returns the precision, 0 to 100: the product of one factor per measure, each falling linearly from 1 for a
    /// perfect flight to 0. A product, so that a good path can't make up for a camera that looks away.
    #[must_use]
    pub fn score(&self) -> f64 {
        let framing = self.rms_framing_deg.map_or(0.0, |deg| deg / MAX_FRAMING_ERROR_DEG);
        let factors = [self.rms_distance_ratio, self.rms_speeding_ratio, framing, self.low_clearance_share];
        100.0 * factors.iter().map(|error| (1.0 - error).max(0.0)).product::<f64>()
    }
}
