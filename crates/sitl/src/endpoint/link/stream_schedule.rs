//! A link's streams: their intervals and when each one is due.

use spandrel_model::time::SimTime;

/// Maximum stream rate that clients can request, Hz: the control loop rate.
const MAX_RATE_HZ: f64 = 400.0;
/// Message ID of the heartbeat, which is never slowed down because clients use it to detect the vehicle.
const HEARTBEAT_ID: u32 = 0;

/// One of a link's streams, in the order of the stream table.
#[derive(Debug, Clone, PartialEq)]
pub struct ScheduledStream {
    message: u32,
    component: u8,
    default_interval: Option<SimTime>,
    interval: Option<SimTime>,
    next: SimTime,
}

impl ScheduledStream {
    /// Creates a stream that sends a component's message at a default rate in Hz (0: off). The stream is due
    /// immediately.
    #[must_use]
    pub fn new(message: u32, component: u8, rate_hz: f64, now: SimTime) -> Self {
        let interval = period(rate_hz);
        Self { message, component, default_interval: interval, interval, next: now }
    }

    /// Turns the stream off by default, unless it is a heartbeat: for clients that must request their streams.
    #[must_use]
    pub fn only_on_request(mut self) -> Self {
        if self.message != HEARTBEAT_ID {
            (self.default_interval, self.interval) = (None, None);
        }
        self
    }
}

/// A link's streams.
#[derive(Debug, Clone, PartialEq)]
pub struct StreamSchedule {
    streams: Vec<ScheduledStream>,
    next_due: SimTime,
}

impl StreamSchedule {
    /// Creates a schedule with every stream due immediately.
    #[must_use]
    pub fn new(streams: Vec<ScheduledStream>, now: SimTime) -> Self {
        Self { streams, next_due: now }
    }

    /// Returns the sum of all rates in Hz.
    #[must_use]
    pub fn total_hz(&self) -> f64 {
        self.streams.iter().filter_map(|stream| stream.interval).map(|interval| 1.0 / interval.s()).sum()
    }

    /// Returns true if any message is ready to be sent.
    #[must_use]
    pub fn is_due(&self, now: SimTime) -> bool {
        now >= self.next_due
    }

    /// Adds each due row to `out` once and schedules it again. `stretch` lengthens the intervals; on a saturated link,
    /// only heartbeats are added.
    pub fn take_due(&mut self, now: SimTime, stretch: f64, is_saturated: bool, out: &mut Vec<usize>) {
        let mut soonest = SimTime::NEVER;
        for (row, stream) in self.streams.iter_mut().enumerate() {
            let Some(interval) = stream.interval else { continue };
            let steady = stream.message == HEARTBEAT_ID;
            if stream.next <= now {
                if steady || !is_saturated {
                    out.push(row);
                }
                let interval = if steady || stretch <= 1.0 { interval } else { SimTime::from_s(interval.s() * stretch) };
                stream.next += interval;
                if stream.next <= now {
                    stream.next = now + interval;
                }
            }
            soonest = soonest.min(stream.next);
        }
        self.next_due = soonest;
    }

    /// Makes a message due now on which a client waits that requested it at `MAX_RATE_HZ`. With ticks of 1 ms, every second interval
    /// of such a stream is 3 ms, longer than a control tick. Slower streams keep their times.
    pub fn hasten(&mut self, message: u32, now: SimTime) {
        let fastest = period(MAX_RATE_HZ);
        for stream in self.streams.iter_mut().filter(|stream| stream.message == message && stream.interval == fastest) {
            stream.next = stream.next.min(now);
            self.next_due = self.next_due.min(now);
        }
    }

    /// Returns a row's interval in microseconds, or -1 if the row is off.
    #[must_use]
    pub fn interval_us(&self, row: usize) -> i32 {
        let interval = self.streams.get(row).and_then(|stream| stream.interval);
        interval.map_or(-1, |interval| i32::try_from(interval.us()).unwrap_or(i32::MAX))
    }

    /// Sets a row's interval in microseconds: 0 restores the default, and negative values turn the row off. Returns
    /// false if the value is invalid.
    pub fn set_interval(&mut self, row: usize, us: f64, now: SimTime) -> bool {
        let Some(stream) = self.streams.get_mut(row).filter(|_| us.is_finite()) else { return false };
        stream.interval = match us {
            us if us < 0.0 => None,
            0.0 => stream.default_interval,
            us => period((1e6 / us).min(MAX_RATE_HZ)),
        };
        stream.next = now;
        self.next_due = now;
        true
    }

    /// Sets the interval for all rows of a message; see [`StreamSchedule::set_interval`].
    pub fn set_message_interval(&mut self, message: u32, us: f64, now: SimTime) {
        for row in 0..self.streams.len() {
            if self.streams[row].message == message {
                self.set_interval(row, us, now);
            }
        }
    }

    /// Checks whether a message is streamed.
    #[must_use]
    pub fn is_on(&self, message: u32) -> bool {
        self.streams.iter().any(|stream| stream.message == message && stream.interval.is_some())
    }

    /// Restores the default rates.
    pub fn reset(&mut self, now: SimTime) {
        self.streams.iter_mut().for_each(|stream| stream.interval = stream.default_interval);
        self.restart(now);
    }

    /// Marks every stream as due.
    pub fn restart(&mut self, now: SimTime) {
        self.streams.iter_mut().for_each(|stream| stream.next = now);
        self.next_due = now;
    }

    /// Shortens a component's heartbeat interval to `interval` if it is longer, and aligns it with another component's
    /// heartbeats.
    pub fn align_heartbeat(&mut self, component: u8, with: u8, interval: SimTime) {
        let row_of =
            |component| self.streams.iter().position(|stream| stream.message == HEARTBEAT_ID && stream.component == component);
        let (Some(row), Some(with)) = (row_of(component), row_of(with)) else { return };
        let next = self.streams[with].next;
        let stream = &mut self.streams[row];
        if stream.interval.is_some_and(|current| current > interval) {
            (stream.interval, stream.next) = (Some(interval), next);
            self.next_due = self.next_due.min(next);
        }
    }
}

fn period(rate_hz: f64) -> Option<SimTime> {
    (rate_hz > 0.0).then(|| SimTime::period(rate_hz))
}
