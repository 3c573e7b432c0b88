//! Offset between a flight controller's clock and the simulator's, measured with TIMESYNC.

use spandrel_mavlink::dialect::{MavMessage, TIMESYNC_DATA};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Interval between requests.
pub const REQUEST_INTERVAL: SimTime = SimTime::from_ms(1_000);
/// Number of round trips in the median. A few delayed frames do not change it.
const SAMPLE_COUNT: usize = 9;
/// Number of round trips after which there is a result.
const MIN_SAMPLE_COUNT: usize = 5;
/// Longest round trip that counts. The offset's error is at most half of it.
const MAX_ROUND_TRIP: SimTime = SimTime::from_ms(200);
/// How far behind a clock must be to have restarted: more than an offset's error (0.1 s) and the drift of a quartz clock in the
/// minutes since the last round trip that counted (estimate).
const RESTART_MARGIN: SimTime = SimTime::from_ms(300);

/// A measured offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeasuredOffset {
    /// The flight controller's clock minus the simulator's, median of the latest round trips.
    pub offset: SimTime,
    /// Time from request to reply, median.
    pub round_trip: SimTime,
}

/// Measures the offset. All times are on the simulator's clock.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClockOffset {
    asked_at: Option<SimTime>,
    samples: VecDeque<MeasuredOffset>,
}

impl ClockOffset {
    /// Returns the next request if one is due.
    pub fn request(&mut self, now: SimTime) -> Option<MavMessage> {
        if self.asked_at.is_some_and(|asked| now.saturating_sub(asked) < REQUEST_INTERVAL) {
            return None;
        }
        self.asked_at = Some(now);
        Some(MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1: now.ns(), target_system: 0, target_component: 0 }))
    }

    /// Takes a message that arrived at `now`. Returns whether it is the reply to the latest request.
    pub fn receive(&mut self, sync: &TIMESYNC_DATA, now: SimTime) -> bool {
        let Some(asked) = self.asked_at.filter(|asked| sync.tc1 != 0 && sync.ts1 == asked.ns()) else { return false };
        let round_trip = now.saturating_sub(asked);
        if round_trip <= MAX_ROUND_TRIP {
            let midpoint_ns = asked.ns() + round_trip.ns() / 2;
            let offset = SimTime::from_ns(sync.tc1.saturating_sub(midpoint_ns));
            self.samples.push_back(MeasuredOffset { offset, round_trip });
            if self.samples.len() > SAMPLE_COUNT {
                self.samples.pop_front();
            }
        }
        true
    }

    /// Returns whether this is the reply to the latest request and shows that the flight controller's clock has restarted: it is
    /// behind the time that it had at the request. A delayed reply is not.
    #[must_use]
    pub fn has_restarted(&self, sync: &TIMESYNC_DATA) -> bool {
        let (Some(asked), Some(latest)) = (self.asked_at, self.samples.back()) else { return false };
        let earliest_ns = asked.ns().saturating_add(latest.offset.ns()).saturating_sub(RESTART_MARGIN.ns());
        sync.tc1 != 0 && sync.ts1 == asked.ns() && sync.tc1 < earliest_ns
    }

    /// Returns the offset once enough round trips have been measured.
    #[must_use]
    pub fn measured(&self) -> Option<MeasuredOffset> {
        let median = |value: fn(&MeasuredOffset) -> i64| {
            let mut values: Vec<i64> = self.samples.iter().map(value).collect();
            values.sort_unstable();
            values.get(values.len() / 2).copied().map(SimTime::from_ns)
        };
        if self.samples.len() < MIN_SAMPLE_COUNT {
            return None;
        }
        Some(MeasuredOffset {
            offset: median(|sample| sample.offset.ns())?,
            round_trip: median(|sample| sample.round_trip.ns())?,
        })
    }
}
