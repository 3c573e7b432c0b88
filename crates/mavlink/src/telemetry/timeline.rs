//! Collects samples in order of arrival, sorts them by time into a [`Flight`], and counts link errors.
//!
//! Truth time is the reference clock. A message's own timestamp is used if it is close to truth time. Otherwise, the message gets
//! the time of the truth message that precedes it in its sender's sequence, so that reordered or duplicate datagrams have no
//! effect. If the clock runs backward, the simulator was restarted: a new epoch starts, and the previous one is kept.

use super::block_list::BlockList;
use super::log_stream::TelemetryLog;
use super::sample::{self, FrameHeader, Sample, SampleContent, SampleValue};
use super::signal::Signal;
use crate::contract::contact::ContactKind;
use crate::contract::continuity::{RESTART_CONFIRM_COUNT, RESTART_THRESHOLD};
use crate::contract::modes::ControlSource;
use crate::contract::truth::Truth;
use serde::Serialize;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::time::SimTime;
use std::ops::ControlFlow;

/// Maximum difference from truth time at which a message's own timestamp is used.
const MAX_CLOCK_DIFFERENCE: SimTime = SimTime::from_ms(2_000);
/// Maximum difference between the time found by sequence number and the arrival time.
const MAX_SEQUENCE_TIME_DIFFERENCE: SimTime = SimTime::from_ms(500);
/// Maximum lag of a late frame, in sequence numbers. Larger differences indicate a large loss, because the numbers wrap
/// at 256.
const MAX_LATE_FRAMES: i64 = 64;
/// Component ID of the monitor, whose own messages are ignored.
const MONITOR_COMPONENT_ID: u8 = 191;
/// Period after which a 32-bit millisecond counter wraps: 49.7 days.
const CLOCK_PERIOD_MS: i64 = 1 << 32;

/// Unwraps a 32-bit timestamp in milliseconds: returns the nonnegative value that is closest to `near`.
fn unwrap_timestamp(own: SimTime, near: SimTime) -> SimTime {
    let rounds = (near.ms() - own.ms() + CLOCK_PERIOD_MS / 2).div_euclid(CLOCK_PERIOD_MS);
    // Saturates at the end of the clock's range.
    SimTime::from_ms((own.ms() + CLOCK_PERIOD_MS * rounds.max(0)).min(i64::MAX / 1_000_000))
}

/// Telemetry link statistics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct LinkCounts {
    /// Number of frames received from the vehicle's system.
    pub frames: u64,
    /// Number of frames lost, determined from sequence numbers.
    pub lost: u64,
    /// Number of duplicate frames.
    pub duplicated: u64,
    /// Number of frames that arrived after a later one.
    pub reordered: u64,
    /// Number of simulator restarts.
    pub restarts: u32,
}

/// Converts the wrapping sequence numbers of one sender to increasing numbers.
#[derive(Debug, Clone, PartialEq)]
struct SequenceUnwrapper {
    sender: (u8, u8),
    newest: i64,
    newest_truth_order: i64,
    epochs: Vec<(i64, u16)>,
}

enum FrameOrder {
    New { order: i64, late: bool, skipped: i64 },
    Duplicate,
}

impl SequenceUnwrapper {
    fn new(sender: (u8, u8), sequence: u8) -> Self {
        // High enough that late frames before the first one still get positive numbers.
        let newest = 256 * 1_000 + i64::from(sequence) - 1;
        Self { sender, newest, newest_truth_order: -1, epochs: vec![(-1, 0); 256] }
    }

    /// Returns a frame's increasing number. `ahead` means that the frame is the latest truth message so far, so its
    /// number cannot be lower than that of the previous truth message.
    fn place(&mut self, sequence: u8, checksum: u16, ahead: bool) -> FrameOrder {
        let difference = i64::from((i64::from(sequence) - self.newest).rem_euclid(256) as u8 as i8);
        let mut order = self.newest + difference;
        let slot = usize::from(sequence);
        if self.epochs[slot] == (order, checksum) {
            return FrameOrder::Duplicate;
        }
        let taken = self.epochs[slot].0 == order;
        if taken || difference < -MAX_LATE_FRAMES || (ahead && order < self.newest_truth_order) {
            order += 256;
        }
        let late = order < self.newest;
        let skipped = if late { -1 } else { order - self.newest - 1 };
        self.newest = self.newest.max(order);
        if ahead {
            self.newest_truth_order = order;
        }
        self.epochs[slot] = (order, checksum);
        FrameOrder::New { order, late, skipped }
    }
}

/// A sample with the data needed to determine its time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimedSample {
    value: SampleValue,
    order: i64,
    /// Latest truth time when the sample arrived.
    arrival: OptionalTime,
    message_time: OptionalTime,
    epoch: u32,
    sender: (u8, u8),
}

/// An optional time that needs only 8 bytes instead of the 16 of an `Option`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OptionalTime(i64);

impl OptionalTime {
    /// Represents a missing time. No MAVLink timestamp has this value, because timestamps are not negative.
    const MISSING: i64 = i64::MIN;

    fn of(time: Option<SimTime>) -> Self {
        Self(time.map_or(Self::MISSING, SimTime::ns))
    }

    fn get(self) -> Option<SimTime> {
        (self.0 != Self::MISSING).then_some(SimTime::from_ns(self.0))
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct TruthEntry {
    truth: Truth,
    order: i64,
    epoch: u32,
    sender: (u8, u8),
}

/// Collects frames in order of arrival.
#[derive(Debug, Clone)]
pub struct Timeline {
    plane: LocalPlane,
    sequencers: Vec<SequenceUnwrapper>,
    truths: BlockList<TruthEntry>,
    entries: BlockList<TimedSample>,
    restart_candidates: Vec<TruthEntry>,
    newest: Option<SimTime>,
    /// Last truth time of each completed epoch.
    epoch_ends: Vec<SimTime>,
    /// System that sends the truth messages, once known.
    system: Option<u8>,
    counts: LinkCounts,
}

/// Result of adding a frame to a timeline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameDisposition {
    /// The frame was not stored: its message is not needed, or it is a duplicate.
    Ignored,
    /// The frame was stored as a sample of the current epoch.
    Stored(Sample),
    /// The simulator was restarted. Contains the truth message that confirmed the restart.
    Restarted(Sample),
}

impl Timeline {
    /// Creates an empty timeline that converts positions with `plane`.
    #[must_use]
    pub fn new(plane: LocalPlane) -> Self {
        Self {
            plane,
            sequencers: Vec::new(),
            truths: BlockList::default(),
            entries: BlockList::default(),
            restart_candidates: Vec::new(),
            newest: None,
            epoch_ends: Vec::new(),
            system: None,
            counts: LinkCounts::default(),
        }
    }

    /// Returns the latest truth time of the current epoch, if any.
    #[must_use]
    pub fn newest(&self) -> Option<SimTime> {
        self.newest
    }

    /// Returns the vehicle's system ID, which is known after the first truth message. Messages from other systems are
    /// not part of the flight.
    #[must_use]
    pub fn system(&self) -> Option<u8> {
        self.system
    }

    /// Returns the link statistics.
    #[must_use]
    pub fn counts(&self) -> LinkCounts {
        self.counts
    }

    /// Returns the number of epochs, which is one more than the number of restarts.
    #[must_use]
    pub fn epoch_count(&self) -> usize {
        self.epoch_ends.len() + 1
    }

    /// Returns the total duration of the epochs before `epoch`. Each epoch lasts from time zero to its last truth message.
    #[must_use]
    pub fn elapsed_before_epoch(&self, epoch: usize) -> SimTime {
        self.epoch_ends.iter().take(epoch).fold(SimTime::ZERO, |sum, last| sum + *last)
    }

    /// Adds all complete records of a log.
    ///
    /// # Errors
    /// Fails if the log cannot be read.
    pub fn push_log(&mut self, log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<()> {
        log.for_each_record(&mut |record| {
            self.push(record.frame);
            ControlFlow::Continue(())
        })
    }

    /// Adds one complete frame.
    pub fn push(&mut self, frame: &[u8]) -> FrameDisposition {
        let Some(header) = FrameHeader::peek(frame) else { return FrameDisposition::Ignored };
        if header.sender.1 == MONITOR_COMPONENT_ID || frame.len() < header.payload_end + 2 {
            return FrameDisposition::Ignored;
        }
        // Messages from other systems may also be routed here. They are ignored once the vehicle's system is known.
        let sample = sample::read(frame, &self.plane).filter(|s| self.system.is_none_or(|system| system == s.sender.0));
        let checksum = u16::from_le_bytes([frame[header.payload_end], frame[header.payload_end + 1]]);
        let ahead = matches!(sample.map(|s| s.content), Some(SampleContent::Truth(truth)) if self.newest.is_none_or(|newest| truth.time > newest));
        if ahead {
            self.system = self.system.or(Some(header.sender.0));
        }
        let Some(order) = self.place(&header, checksum, ahead) else { return FrameDisposition::Ignored };
        match sample {
            None => FrameDisposition::Ignored,
            Some(sample) => self.store_sample(sample, order),
        }
    }

    fn place(&mut self, header: &FrameHeader, checksum: u16, ahead: bool) -> Option<i64> {
        let index = self.sequencers.iter().position(|s| s.sender == header.sender).unwrap_or_else(|| {
            self.sequencers.push(SequenceUnwrapper::new(header.sender, header.sequence));
            self.sequencers.len() - 1
        });
        // Only some ground station frames are routed to the monitor, so gaps in their sequence numbers are not losses.
        let counted = self.system == Some(header.sender.0);
        match self.sequencers[index].place(header.sequence, checksum, ahead) {
            FrameOrder::Duplicate => {
                self.counts.duplicated += u64::from(counted);
                None
            }
            FrameOrder::New { order, late, skipped } => {
                if counted {
                    self.counts.frames += 1;
                    self.counts.reordered += u64::from(late);
                    // A late frame was counted as lost when a later one arrived.
                    self.counts.lost = self.counts.lost.saturating_add_signed(skipped);
                }
                Some(order)
            }
        }
    }

    fn store_sample(&mut self, sample: Sample, order: i64) -> FrameDisposition {
        let (epoch, sender) = (self.epoch(), sample.sender);
        let truth = match sample.content {
            SampleContent::Truth(truth) => truth,
            SampleContent::Value(value) => {
                let own_time = sample.message_time.map(|own| self.newest.map_or(own, |newest| unwrap_timestamp(own, newest)));
                let (arrival, stamp) = (OptionalTime::of(self.newest), OptionalTime::of(own_time));
                self.entries.push(TimedSample { value, order, arrival, message_time: stamp, epoch, sender });
                return FrameDisposition::Stored(Sample { message_time: own_time, ..sample });
            }
        };
        let entry = TruthEntry { truth, order, epoch, sender };
        if self.newest.is_some_and(|newest| truth.time + RESTART_THRESHOLD < newest) {
            self.restart_candidates.push(entry);
            return if self.restart_candidates.len() < RESTART_CONFIRM_COUNT {
                FrameDisposition::Stored(sample)
            } else {
                self.restart(sample)
            };
        }
        // These were late frames, not a restart. They are sorted by their timestamps later.
        self.truths.extend(self.restart_candidates.drain(..));
        self.truths.push(entry);
        self.newest = Some(self.newest.map_or(truth.time, |newest| newest.max(truth.time)));
        FrameDisposition::Stored(sample)
    }

    fn epoch(&self) -> u32 {
        // The count cannot saturate in practice, because every restart takes several frames.
        u32::try_from(self.epoch_ends.len()).unwrap_or(u32::MAX)
    }

    fn restart(&mut self, sample: Sample) -> FrameDisposition {
        self.epoch_ends.extend(self.newest);
        self.counts.restarts += 1;
        self.newest = self.restart_candidates.iter().map(|entry| entry.truth.time).max();
        let epoch = self.epoch();
        self.truths.extend(self.restart_candidates.drain(..).map(|entry| TruthEntry { epoch, ..entry }));
        FrameDisposition::Restarted(sample)
    }

    /// Returns the flight data for one epoch, sorted by time.
    #[must_use]
    pub fn flight(&self, epoch: usize) -> Flight {
        let mut flight = Flight { ended_by_restart: epoch < self.epoch_ends.len(), ..Flight::default() };
        let counts = |sender: (u8, u8), of: u32| usize::try_from(of) == Ok(epoch) && Some(sender.0) == self.system;
        let mut kept: Vec<&TruthEntry> = self.truths.iter().filter(|t| counts(t.sender, t.epoch)).collect();
        kept.sort_by_key(|entry| (entry.truth.time, entry.order));
        kept.dedup_by_key(|entry| entry.truth.time);
        flight.truths = kept.iter().map(|entry| entry.truth).collect();
        kept.sort_unstable_by_key(|entry| sequence_key(entry));
        for entry in self.entries.iter().filter(|e| counts(e.sender, e.epoch)) {
            flight.take(entry, time_of(entry, &kept));
        }
        flight.sort();
        flight
    }
}

/// Returns the sort key for finding a sender's truth messages by sequence number.
fn sequence_key(entry: &TruthEntry) -> ((u8, u8), i64, SimTime) {
    (entry.sender, entry.order, entry.truth.time)
}

/// Returns the time of a sample. `numbered` contains the flight's truth messages, sorted by [`sequence_key`].
fn time_of(entry: &TimedSample, numbered: &[&TruthEntry]) -> SimTime {
    let near = |a: SimTime, b: SimTime, within: SimTime| a.saturating_sub(b) <= within && b.saturating_sub(a) <= within;
    let arrival = entry.arrival.get();
    if let Some(own) = entry.message_time.get() {
        // A lost photo message is resent much later, with its original timestamp.
        let late = matches!(entry.value, SampleValue::Snapshot(_)) && arrival.is_some_and(|arrival| own <= arrival);
        if late || arrival.is_none_or(|arrival| near(own, arrival, MAX_CLOCK_DIFFERENCE)) {
            return own;
        }
    }
    let arrival = arrival.unwrap_or(SimTime::ZERO);
    let before = numbered.partition_point(|truth| (truth.sender, truth.order) < (entry.sender, entry.order));
    match before.checked_sub(1).map(|k| numbered[k]) {
        Some(last) if last.sender == entry.sender && near(last.truth.time, arrival, MAX_SEQUENCE_TIME_DIFFERENCE) => {
            last.truth.time
        }
        Some(_) | None => arrival,
    }
}

/// Data of one flight, sorted by time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flight {
    /// Truth messages with strictly increasing times.
    pub truths: Vec<Truth>,
    /// Stick positions: forward, right, up, clockwise, each in [-1, 1].
    pub sticks: Signal<[f64; 4]>,
    /// Lamp state: true if the lamp is on.
    pub light: Signal<bool>,
    /// Remaining battery charge, 0 to 100%.
    pub battery: Signal<f64>,
    /// Kind of the current contact.
    pub contact: Signal<ContactKind>,
    /// Number of contacts since simulation start.
    pub hits: Signal<i32>,
    /// Number of respawns since simulation start.
    pub respawns: Signal<i32>,
    /// Number of freezes since simulation start, without those after a rewind.
    pub freezes: Signal<i32>,
    /// Number of rewinds since simulation start.
    pub rewinds: Signal<i32>,
    /// Times at which the bridges were closed to traffic (negative) or reopened, ms since simulation start.
    pub traffic: Signal<i32>,
    /// Codes of the inspector's walks.
    pub walks: Signal<i32>,
    /// Distance to the nearest surface, m.
    pub clearance: Signal<f64>,
    /// Gimbal pitch relative to the horizon, rad, up positive.
    pub gimbal: Signal<f64>,
    /// The camera's horizontal field of view, rad.
    pub field_of_view: Signal<f64>,
    /// Whether the motors are armed.
    pub armed: Signal<bool>,
    /// Source of the commands that fly the aircraft; one value per heartbeat (1 s).
    pub flown_by: Signal<ControlSource>,
    /// Whether the autopilot reports that the aircraft is on the ground.
    pub on_ground: Signal<bool>,
    /// Index and camera timestamp of each photo; repeated messages are merged.
    pub snapshots: Signal<(i32, Option<SimTime>)>,
    /// Session seeds that the simulator published.
    pub seeds: Signal<u64>,
    /// Scenario CRCs that the simulator published.
    pub scenario_crcs: Signal<u32>,
    /// Whether the simulator was restarted after this flight.
    pub ended_by_restart: bool,
}

impl Flight {
    fn take(&mut self, entry: &TimedSample, time: SimTime) {
        let order = entry.order;
        match entry.value {
            SampleValue::Sticks(v) => self.sticks.push(time, order, v.axes()),
            SampleValue::Light(v) => self.light.push(time, order, v),
            SampleValue::Battery(v) => self.battery.push(time, order, v),
            SampleValue::Contact(v) => self.contact.push(time, order, v),
            SampleValue::Hits(v) => self.hits.push(time, order, v),
            SampleValue::Respawns(v) => self.respawns.push(time, order, v),
            SampleValue::Freezes(v) => self.freezes.push(time, order, v),
            SampleValue::Rewinds(v) => self.rewinds.push(time, order, v),
            // While the flight is frozen, no time passes that a flight could contain.
            SampleValue::Frozen(_) => {}
            SampleValue::Traffic(v) => self.traffic.push(time, order, v),
            SampleValue::Walk(v) => self.walks.push(time, order, v),
            SampleValue::Seed(v) => self.seeds.push(time, order, v),
            SampleValue::ScenarioCrc(v) => self.scenario_crcs.push(time, order, v),
            SampleValue::Clearance(v) => self.clearance.push(time, order, v),
            SampleValue::GimbalPitch(v) => self.gimbal.push(time, order, v),
            SampleValue::FieldOfView(v) => self.field_of_view.push(time, order, v),
            SampleValue::Heartbeat { armed, by, .. } => {
                self.armed.push(time, order, armed);
                self.flown_by.push(time, order, by);
            }
            SampleValue::OnGround(v) => self.on_ground.push(time, order, v),
            SampleValue::Snapshot(v) => {
                // A repeated message has the same index and timestamp; the time of the first report is kept. The timestamp is
                // needed because formatting the card resets the index.
                let picture = (v, entry.message_time.get());
                match self.snapshots.all_mut().iter_mut().find(|known| known.2 == picture) {
                    Some(known) => known.0 = known.0.min(time),
                    None => self.snapshots.push(time, order, picture),
                }
            }
        }
    }

    fn sort(&mut self) {
        self.sticks.sort();
        self.light.sort();
        self.battery.sort();
        self.contact.sort();
        self.hits.sort();
        self.respawns.sort();
        self.freezes.sort();
        self.rewinds.sort();
        self.traffic.sort();
        self.walks.sort();
        self.clearance.sort();
        self.gimbal.sort();
        self.field_of_view.sort();
        self.armed.sort();
        self.flown_by.sort();
        self.on_ground.sort();
        self.snapshots.sort();
        self.seeds.sort();
        self.scenario_crcs.sort();
    }
}
