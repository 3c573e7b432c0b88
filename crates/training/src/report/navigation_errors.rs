//! How wrong the aircraft's own position and heading were, and when GNSS failed: what the hazards of a job did in this flight. The
//! values are those that the autopilot reported; the truth is the simulator's.

use super::formatting;
use super::interval_total::IntervalTotal;
use spandrel_mavlink::telemetry::{Flight, Frame, Navigation};
use spandrel_model::math;
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};

/// Longest time for which a report of the GNSS receiver counts, s (estimate: one per second, of which some may be lost).
const MAX_REPORT_AGE_S: f64 = 3.0;
/// Time after a respawn or rewind in which errors do not count, s: the autopilot's estimate follows the move.
const SETTLING_S: f64 = 3.0;
/// Errors from which the report mentions them: position and height, m, and heading, rad (estimates: clearly more than in the open).
const NOTABLE_POSITION_M: f64 = 1.5;
const NOTABLE_HEIGHT_M: f64 = 1.5;
const NOTABLE_HEADING_RAD: f64 = 0.14;

/// The largest error of a value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LargestError {
    /// Size of the error.
    pub value: f64,
    /// Time since lift-off, s.
    pub at_s: f64,
}

impl LargestError {
    fn include(&mut self, value: f64, at_s: f64) {
        if value > self.value {
            *self = Self { value, at_s };
        }
    }
}

/// Errors of a flight. All are 0 if the telemetry contains no estimates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavigationErrors {
    /// Time without a GNSS position.
    pub gnss_lost: IntervalTotal,
    /// Smallest number of satellites; `None` if unknown.
    pub fewest_satellites: Option<u8>,
    /// Largest horizontal error of the position, m.
    pub position_m: LargestError,
    /// Largest error of the height, m.
    pub height_m: LargestError,
    /// Largest error of the heading, rad.
    pub heading_rad: LargestError,
}

impl NavigationErrors {
    /// Measures a flight.
    #[must_use]
    pub fn measure(flight: &Flight, frames: &[Frame], navigation: &Navigation) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let reports = navigation.gnss().between(first.time, last.time);
        let mut found = Self {
            gnss_lost: IntervalTotal::of_reports(reports, (first.time, last.time), MAX_REPORT_AGE_S, |report| !report.has_fix),
            fewest_satellites: reports.iter().filter_map(|report| report.2.satellites).min(),
            ..Self::default()
        };
        let settled_truth = |time: SimTime| {
            let earlier = time - SimTime::from_s(SETTLING_S);
            let is_moved = flight.respawns.at(earlier) != flight.respawns.at(time) || flight.was_rewound_between(earlier, time);
            flight.between(time).filter(|_| !is_moved)
        };
        for (time, _, estimate_m) in navigation.estimates_m().between(first.time, last.time) {
            let Some(truth) = settled_truth(*time) else { continue };
            let (off_m, at_s) = (*estimate_m - truth.motion.position_m, (*time - first.time).s());
            found.position_m.include(off_m.horizontal_norm(), at_s);
            found.height_m.include(off_m.up().abs(), at_s);
        }
        for (time, _, heading_rad) in navigation.headings_rad().between(first.time, last.time) {
            let Some(truth) = settled_truth(*time) else { continue };
            let off_rad = math::wrap_pi(heading_rad - truth.motion.ned_from_frd.yaw_rad()).abs();
            found.heading_rad.include(off_rad, (*time - first.time).s());
        }
        found
    }

    /// Returns what is worth mentioning, as sentences.
    #[must_use]
    pub fn sentences(&self, language: Language) -> Vec<String> {
        let mut lines = Vec::new();
        if self.gnss_lost.total_s > 0.0 {
            let IntervalTotal { total_s, longest_s, longest_from_s } = self.gnss_lost;
            let [total, longest, from] = [total_s, longest_s, longest_from_s].map(formatting::clock);
            lines.push(text!(language, "report-gnss-lost", total = total, longest = longest, from = from));
        }
        if self.position_m.value >= NOTABLE_POSITION_M || self.height_m.value >= NOTABLE_HEIGHT_M {
            let meters = |error: LargestError| formatting::number(error.value, 1);
            let (position, position_at) = (meters(self.position_m), formatting::clock(self.position_m.at_s));
            let (height, height_at) = (meters(self.height_m), formatting::clock(self.height_m.at_s));
            lines.push(text!(
                language,
                "report-position-error",
                position = position,
                at = position_at,
                height = height,
                height_at = height_at
            ));
        }
        if self.heading_rad.value >= NOTABLE_HEADING_RAD {
            let (degrees, at) =
                (formatting::number(self.heading_rad.value.to_degrees(), 0), formatting::clock(self.heading_rad.at_s));
            lines.push(text!(language, "report-heading-error", degrees = degrees, at = at));
        }
        lines
    }
}
