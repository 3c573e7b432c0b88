//! Losses of optical flow and of the range finder that looks down over water, as the vehicle reported them.

use super::formatting;
use super::interval_total::IntervalTotal;
use super::radio_losses::MAX_REPORT_AGE_S;
use spandrel_mavlink::contract::hazards::{HazardReport, WaterSensors};
use spandrel_mavlink::telemetry::{Frame, Navigation};
use spandrel_text::{Language, text};

/// Losses of a flight. All are 0 if the job does not simulate the water.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WaterLosses {
    /// Time without optical flow.
    pub flow_lost: IntervalTotal,
    /// Number of readings of the range finder over water.
    pub ranges: u32,
    /// Number of those that had no result.
    pub lost_ranges: u32,
}

impl WaterLosses {
    /// Measures a flight.
    #[must_use]
    pub fn measure(frames: &[Frame], navigation: &Navigation) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let reports = navigation.hazards().between(first.time, last.time);
        let counted = |time| navigation.hazards().at(time).and_then(|report| report.water).unwrap_or_default();
        let [before, after]: [WaterSensors; 2] = [first.time, last.time].map(counted);
        let is_lost = |report: &HazardReport| report.water.is_some_and(|water| water.flow_lost);
        Self {
            flow_lost: IntervalTotal::of_reports(reports, (first.time, last.time), MAX_REPORT_AGE_S, is_lost),
            ranges: after.ranges.saturating_sub(before.ranges),
            lost_ranges: after.lost_ranges.saturating_sub(before.lost_ranges),
        }
    }

    /// Returns what is worth mentioning, as sentences.
    #[must_use]
    pub fn sentences(&self, language: Language) -> Vec<String> {
        let IntervalTotal { total_s, longest_s, longest_from_s } = self.flow_lost;
        let [total, longest, from] = [total_s, longest_s, longest_from_s].map(formatting::clock);
        let (lost, ranges) = (self.lost_ranges, self.ranges);
        let lines = [
            (total_s > 0.0).then(|| text!(language, "report-flow-lost", total = total, longest = longest, from = from)),
            (lost > 0).then(|| text!(language, "report-ranges-lost", lost = lost, count = ranges)),
        ];
        lines.into_iter().flatten().collect()
    }
}
