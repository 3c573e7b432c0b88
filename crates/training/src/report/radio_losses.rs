//! When the radio links of a flight were too weak, as the vehicle reported it.

use super::formatting;
use super::interval_total::IntervalTotal;
use spandrel_mavlink::contract::hazards::HazardReport;
use spandrel_mavlink::telemetry::{Frame, Navigation};
use spandrel_text::{Language, text};

/// Longest time for which a report on hazards counts, s (estimate: two per second, of which some may be lost).
pub(super) const MAX_REPORT_AGE_S: f64 = 1.5;
/// Margin below which the video counts as poor, dB: less than half of its data arrives.
const POOR_VIDEO_DB: f64 = 0.0;

/// Losses of a flight. All are 0 if the job does not simulate the radio.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RadioLosses {
    /// Time with poor video.
    pub video_poor: IntervalTotal,
    /// Number of times that control was lost.
    pub control_losses: u32,
}

impl RadioLosses {
    /// Measures a flight.
    #[must_use]
    pub fn measure(frames: &[Frame], navigation: &Navigation) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let reports = navigation.hazards().between(first.time, last.time);
        let losses = |report: HazardReport| report.radio.map_or(0, |radio| radio.losses);
        let [before, after] = [first.time, last.time].map(|time| navigation.hazards().at(time).map_or(0, losses));
        let is_poor = |report: &HazardReport| report.radio.is_some_and(|radio| radio.video_db < POOR_VIDEO_DB);
        let video_poor = IntervalTotal::of_reports(reports, (first.time, last.time), MAX_REPORT_AGE_S, is_poor);
        Self { video_poor, control_losses: after.saturating_sub(before) }
    }

    /// Returns what is worth mentioning, as sentences.
    #[must_use]
    pub fn sentences(&self, language: Language) -> Vec<String> {
        let IntervalTotal { total_s, longest_s, longest_from_s } = self.video_poor;
        let [total, longest, from] = [total_s, longest_s, longest_from_s].map(formatting::clock);
        let lines = [
            (total_s > 0.0).then(|| text!(language, "report-video-poor", total = total, longest = longest, from = from)),
            (self.control_losses > 0).then(|| text!(language, "report-control-lost", count = self.control_losses)),
        ];
        lines.into_iter().flatten().collect()
    }
}
