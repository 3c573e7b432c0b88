//! Sorts samples from arrival order into a [`Flight`] in time order and counts link errors.
//!
//! Truth time is the reference clock. A message keeps its own timestamp if it is close to truth time; any other message gets the
//! time of the preceding truth sample in its sender's sequence, so that reordered or duplicate datagrams change nothing. A clock
//! that runs backward means that the simulator was restarted: a new epoch starts, and the previous one is kept.

use super::log_stream::TelemetryLog;
use super::rows::Rows;
use super::sample::{self, FrameHeader, Sample, SampleContent, SampleValue};
use super::signal::Signal;
use crate::contract::contact::ContactKind;
use crate::contract::continuity::{RESTART_AFTER, RESTART_CONFIRM};
use crate::contract::modes::ControlSource;
use crate::contract::truth::Truth;
use serde::Serialize;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::time::SimTime;
use std::ops::ControlFlow;

/// Maximum difference from truth time at which a message's own timestamp is used.
const OWN_CLOCK_WITHIN: SimTime = SimTime::from_ms(2_000);
/// Maximum difference between the truth sample found by sequence number and the one found by arrival.
const NUMBER_WITHIN: SimTime = SimTime::from_ms(500);
/// A sequence number at most this far back is a late frame; further back it indicates a large loss (numbers wrap at 256).
const LATE_WITHIN: i64 = 64;
/// Component ID of the monitor itself.
const MONITOR_COMPONENT: u8 = 191;
/// Period after which a clock of 32-bit milliseconds wraps: 49.7 days.
const CLOCK_MS: i64 = 1 << 32;

/// Unwraps a timestamp of 32-bit milliseconds to the value nearest to `near` that is not negative.
fn unwrapped(own: SimTime, near: SimTime) -> SimTime {
    let rounds = (near.ms() - own.ms() + CLOCK_MS / 2).div_euclid(CLOCK_MS);
    // A clock at the end of its range saturates.
    SimTime::from_ms((own.ms() + CLOCK_MS * rounds.max(0)).min(i64::MAX / 1_000_000))
}

/// Link statistics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct LinkCounts {
    /// Frames received from the vehicle's system.
    pub frames: u64,
    /// Frames lost, by sequence number.
    pub lost: u64,
    /// Duplicate frames.
    pub duplicated: u64,
    /// Frames that arrived after a later one.
    pub reordered: u64,
    /// Simulator restarts.
    pub restarts: u32,
}

/// Unwrapped sequence numbers of one sender.
#[derive(Debug, Clone, PartialEq)]
struct SequenceUnwrapper {
    sender: (u8, u8),
    newest: i64,
    newest_truth: i64,
    epochs: Vec<(i64, u16)>,
}

enum FrameOrder {
    New { order: i64, late: bool, skipped: i64 },
    Duplicate,
}

impl SequenceUnwrapper {
    fn new(sender: (u8, u8), sequence: u8) -> Self {
        // High enough that late frames before the first one get positive numbers.
        let newest = 256 * 1_000 + i64::from(sequence) - 1;
        Self { sender, newest, newest_truth: -1, epochs: vec![(-1, 0); 256] }
    }

    /// `ahead`: the frame is a truth sample later than all previous ones, so its number cannot be below that of the latest truth
    /// sample.
    fn place(&mut self, sequence: u8, checksum: u16, ahead: bool) -> FrameOrder {
        let difference = i64::from((i64::from(sequence) - self.newest).rem_euclid(256) as u8 as i8);
        let mut order = self.newest + difference;
        let slot = usize::from(sequence);
        if self.epochs[slot] == (order, checksum) {
            return FrameOrder::Duplicate;
        }
        let taken = self.epochs[slot].0 == order;
        if taken || difference < -LATE_WITHIN || (ahead && order < self.newest_truth) {
            order += 256;
        }
        let late = order < self.newest;
        let skipped = if late { -1 } else { order - self.newest - 1 };
        self.newest = self.newest.max(order);
        if ahead {
            self.newest_truth = order;
        }
        self.epochs[slot] = (order, checksum);
        FrameOrder::New { order, late, skipped }
    }
}

/// One sample with the data that determines its time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimedSample {
    value: SampleValue,
    order: i64,
    /// Latest truth time on arrival.
    arrival: OptionalTime,
    own_time: OptionalTime,
    epoch: u32,
    sender: (u8, u8),
}

/// An optional time in 8 bytes instead of the 16 of an `Option`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OptionalTime(i64);

impl OptionalTime {
    /// No wire timestamp has this value: times start at zero.
    const UNKNOWN: i64 = i64::MIN;

    fn of(time: Option<SimTime>) -> Self {
        Self(time.map_or(Self::UNKNOWN, SimTime::ns))
    }

    fn get(self) -> Option<SimTime> {
        (self.0 != Self::UNKNOWN).then_some(SimTime::from_ns(self.0))
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct TruthEntry {
    truth: Truth,
    order: i64,
    epoch: u32,
    sender: (u8, u8),
}

/// Collects frames in arrival order.
#[derive(Debug, Clone)]
pub struct Timeline {
    plane: LocalPlane,
    sequencers: Vec<SequenceUnwrapper>,
    truths: Rows<TruthEntry>,
    entries: Rows<TimedSample>,
    suspects: Vec<TruthEntry>,
    newest: Option<SimTime>,
    /// Last truth times of the completed epochs.
    ended: Vec<SimTime>,
    /// System that sends the truth samples.
    system: Option<u8>,
    counts: LinkCounts,
}

/// Result of processing a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameDisposition {
    /// The frame is not kept, or is a duplicate.
    Nothing,
    /// The frame is a sample of the current epoch.
    Kept(Sample),
    /// The simulator was restarted; this is the truth sample that confirms it.
    Restarted(Sample),
}

impl Timeline {
    /// Creates an empty timeline that converts positions by `plane`.
    #[must_use]
    pub fn new(plane: LocalPlane) -> Self {
        Self {
            plane,
            sequencers: Vec::new(),
            truths: Rows::default(),
            entries: Rows::default(),
            suspects: Vec::new(),
            newest: None,
            ended: Vec::new(),
            system: None,
            counts: LinkCounts::default(),
        }
    }

    /// Returns the latest truth time of the current epoch.
    #[must_use]
    pub fn newest(&self) -> Option<SimTime> {
        self.newest
    }

    /// Returns the system whose flight this is, known from the first truth sample. Messages from other systems are not part of
    /// the flight.
    #[must_use]
    pub fn system(&self) -> Option<u8> {
        self.system
    }

    /// Returns the link statistics so far.
    #[must_use]
    pub fn counts(&self) -> LinkCounts {
        self.counts
    }

    /// Returns the number of epochs so far: one more than the number of restarts.
    #[must_use]
    pub fn simulator_runs(&self) -> usize {
        self.ended.len() + 1
    }

    /// Returns the total duration of the epochs before `epoch`, each from time zero to its last truth sample.
    #[must_use]
    pub fn apply_pushed(&self, epoch: usize) -> SimTime {
        self.ended.iter().take(epoch).fold(SimTime::ZERO, |sum, last| sum + *last)
    }

    /// Processes all complete records of a log.
    ///
    /// # Errors
    /// If the log cannot be read.
    pub fn push_log(&mut self, log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<()> {
        log.for_each_record(&mut |record| {
            self.push(record.frame);
            ControlFlow::Continue(())
        })
    }

    /// Processes one complete frame.
    pub fn push(&mut self, frame: &[u8]) -> FrameDisposition {
        let Some(header) = FrameHeader::peek(frame) else { return FrameDisposition::Nothing };
        if header.sender.1 == MONITOR_COMPONENT || frame.len() < header.payload_end + 2 {
            return FrameDisposition::Nothing;
        }
        // Messages from other systems are routed here too. They are ignored once the vehicle is known.
        let sample = sample::read(frame, &self.plane).filter(|s| self.system.is_none_or(|system| system == s.sender.0));
        let checksum = u16::from_le_bytes([frame[header.payload_end], frame[header.payload_end + 1]]);
        let ahead = matches!(sample.map(|s| s.content), Some(SampleContent::Truth(truth)) if self.newest.is_none_or(|newest| truth.time > newest));
        if ahead {
            self.system = self.system.or(Some(header.sender.0));
        }
        let Some(order) = self.place(&header, checksum, ahead) else { return FrameDisposition::Nothing };
        match sample {
            None => FrameDisposition::Nothing,
            Some(sample) => self.keep(sample, order),
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
                    // A late frame was counted as lost when the later one arrived.
                    self.counts.lost = self.counts.lost.saturating_add_signed(skipped);
                }
                Some(order)
            }
        }
    }

    fn keep(&mut self, sample: Sample, order: i64) -> FrameDisposition {
        let (epoch, sender) = (self.epoch(), sample.sender);
        let truth = match sample.content {
            SampleContent::Truth(truth) => truth,
            SampleContent::Value(value) => {
                let own_time = sample.own_time.map(|own| self.newest.map_or(own, |newest| unwrapped(own, newest)));
                let (arrival, stamp) = (OptionalTime::of(self.newest), OptionalTime::of(own_time));
                self.entries.push(TimedSample { value, order, arrival, own_time: stamp, epoch, sender });
                return FrameDisposition::Kept(Sample { own_time, ..sample });
            }
        };
        let entry = TruthEntry { truth, order, epoch, sender };
        if self.newest.is_some_and(|newest| truth.time + RESTART_AFTER < newest) {
            self.suspects.push(entry);
            return if self.suspects.len() < RESTART_CONFIRM { FrameDisposition::Kept(sample) } else { self.restart(sample) };
        }
        // These were late frames rather than a restart; they are sorted by their timestamps.
        self.truths.extend(self.suspects.drain(..));
        self.truths.push(entry);
        self.newest = Some(self.newest.map_or(truth.time, |newest| newest.max(truth.time)));
        FrameDisposition::Kept(sample)
    }

    fn epoch(&self) -> u32 {
        // A restart takes several frames, so no log is long enough for the count to saturate.
        u32::try_from(self.ended.len()).unwrap_or(u32::MAX)
    }

    fn restart(&mut self, sample: Sample) -> FrameDisposition {
        self.ended.extend(self.newest);
        self.counts.restarts += 1;
        self.newest = self.suspects.iter().map(|entry| entry.truth.time).max();
        let epoch = self.epoch();
        self.truths.extend(self.suspects.drain(..).map(|entry| TruthEntry { epoch, ..entry }));
        FrameDisposition::Restarted(sample)
    }

    /// Returns the flight of one epoch, sorted by time.
    #[must_use]
    pub fn flight(&self, epoch: usize) -> Flight {
        let mut flight = Flight { ended_by_restart: epoch < self.ended.len(), ..Flight::default() };
        let counts = |sender: (u8, u8), of: u32| usize::try_from(of) == Ok(epoch) && Some(sender.0) == self.system;
        let mut kept: Vec<&TruthEntry> = self.truths.iter().filter(|t| counts(t.sender, t.epoch)).collect();
        kept.sort_by_key(|entry| (entry.truth.time, entry.order));
        kept.dedup_by_key(|entry| entry.truth.time);
        flight.truths = kept.iter().map(|entry| entry.truth).collect();
        kept.sort_unstable_by_key(|entry| numbering(entry));
        for entry in self.entries.iter().filter(|e| counts(e.sender, e.epoch)) {
            flight.take(entry, time_of(entry, &kept));
        }
        flight.sort();
        flight
    }
}

/// Sort key to look up the truth samples of a sender by sequence number.
fn numbering(entry: &TruthEntry) -> ((u8, u8), i64, SimTime) {
    (entry.sender, entry.order, entry.truth.time)
}

/// Returns the time of a sample; `numbered` contains the truth samples of the flight, sorted by [`numbering`].
fn time_of(entry: &TimedSample, numbered: &[&TruthEntry]) -> SimTime {
    let near = |a: SimTime, b: SimTime, within: SimTime| a.saturating_sub(b) <= within && b.saturating_sub(a) <= within;
    let arrival = entry.arrival.get();
    if let Some(own) = entry.own_time.get() {
        // A lost photo message is sent again much later with its original timestamp.
        let late = matches!(entry.value, SampleValue::Snapshot(_)) && arrival.is_some_and(|arrival| own <= arrival);
        if late || arrival.is_none_or(|arrival| near(own, arrival, OWN_CLOCK_WITHIN)) {
            return own;
        }
    }
    let arrival = arrival.unwrap_or(SimTime::ZERO);
    let before = numbered.partition_point(|truth| (truth.sender, truth.order) < (entry.sender, entry.order));
    match before.checked_sub(1).map(|k| numbered[k]) {
        Some(last) if last.sender == entry.sender && near(last.truth.time, arrival, NUMBER_WITHIN) => last.truth.time,
        Some(_) | None => arrival,
    }
}

/// One flight, sorted by time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flight {
    /// Truth samples with strictly increasing times.
    pub truths: Vec<Truth>,
    /// Stick positions: forward, right, up, clockwise, each in [-1, 1].
    pub sticks: Signal<[f64; 4]>,
    /// The lamp is on.
    pub light: Signal<bool>,
    /// Battery level, %.
    pub battery: Signal<f64>,
    /// Contact type.
    pub contact: Signal<ContactKind>,
    /// Number of contact onsets.
    pub hits: Signal<i32>,
    /// Number of respawns.
    pub respawns: Signal<i32>,
    /// Times when the bridges were closed to traffic and opened, as on the wire.
    pub traffic: Signal<i32>,
    /// Distance to the nearest surface, m.
    pub clearance: Signal<f64>,
    /// Gimbal pitch, rad.
    pub gimbal: Signal<f64>,
    /// Horizontal field of view of the camera, rad.
    pub field_of_view: Signal<f64>,
    /// The motors are armed.
    pub armed: Signal<bool>,
    /// Control source, at the rate of the heartbeat (1 s).
    pub flown_by: Signal<ControlSource>,
    /// The autopilot reports that the aircraft is on the ground.
    pub on_ground: Signal<bool>,
    /// Photos, once each: index, and time by the camera's own clock.
    pub snapshots: Signal<(i32, Option<SimTime>)>,
    /// Published session seeds.
    pub seeds: Signal<u64>,
    /// Published scenario CRCs.
    pub scenario_crcs: Signal<u32>,
    /// The simulator was restarted after this flight.
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
            SampleValue::Traffic(v) => self.traffic.push(time, order, v),
            SampleValue::Seed(v) => self.seeds.push(time, order, v),
            SampleValue::ScenarioCrc(v) => self.scenario_crcs.push(time, order, v),
            SampleValue::Clearance(v) => self.clearance.push(time, order, v),
            SampleValue::GimbalPitch(v) => self.gimbal.push(time, order, v),
            SampleValue::FieldOfView(v) => self.field_of_view.push(time, order, v),
            SampleValue::Beat { armed, by } => {
                self.armed.push(time, order, armed);
                self.flown_by.push(time, order, by);
            }
            SampleValue::OnGround(v) => self.on_ground.push(time, order, v),
            SampleValue::Snapshot(v) => {
                // A repeated photo message has the same index and time; the first report is kept. Formatting the card resets the
                // index.
                let picture = (v, entry.own_time.get());
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
        self.traffic.sort();
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
