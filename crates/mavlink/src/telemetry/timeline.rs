//! Samples in the order of arrival -> a [`Flight`] in the order of time, with what the link did to them counted.
//!
//! The truth's clock is the one clock. A message with a time of its own keeps it when it is near the truth's; any other takes the
//! time of the truth sample before it in its sender's numbering, so that shuffled or doubled datagrams change nothing. A clock that
//! goes back is a restarted simulator: a new epoch begins, and the old one stays.

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

/// A message's own clock is believed within this span of the truth's.
const OWN_CLOCK_WITHIN: SimTime = SimTime::from_ms(2_000);
/// The truth sample found by number is believed within this span of the one found by arrival.
const NUMBER_WITHIN: SimTime = SimTime::from_ms(500);
/// A sequence number that seems this far back, or less, is a late frame; further back it is a big loss (numbers wrap at 256).
const LATE_WITHIN: i64 = 64;
/// Component id of the monitor itself.
const MONITOR_COMPONENT: u8 = 191;
/// Clocks of 32-bit milliseconds start again after so long: 49.7 days.
const CLOCK_MS: i64 = 1 << 32;

/// A time of 32-bit milliseconds as the clock of `near` has it: the one of its repetitions that lies nearest, none before zero.
fn unwrapped(own: SimTime, near: SimTime) -> SimTime {
    let rounds = (near.ms() - own.ms() + CLOCK_MS / 2).div_euclid(CLOCK_MS);
    // A clock at the end of its range saturates.
    SimTime::from_ms((own.ms() + CLOCK_MS * rounds.max(0)).min(i64::MAX / 1_000_000))
}

/// What the link did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct LinkCounts {
    /// Frames of the vehicle's system taken in.
    pub frames: u64,
    /// Sequence numbers never seen.
    pub lost: u64,
    /// Frames that came again.
    pub duplicated: u64,
    /// Frames that came after a later one.
    pub reordered: u64,
    /// Times that the simulator's clock went back for good.
    pub restarts: u32,
}

/// One sender's numbering, unrolled.
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
        // High enough that late frames before the first keep positive numbers.
        let newest = 256 * 1_000 + i64::from(sequence) - 1;
        Self { sender, newest, newest_truth: -1, epochs: vec![(-1, 0); 256] }
    }

    /// `ahead`: the frame is a truth later than all before; a number before the newest truth's cannot be its own.
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

/// One sample with what is known of its place.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimedSample {
    value: SampleValue,
    order: i64,
    /// Newest truth when it arrived.
    arrival: OptionalTime,
    own_time: OptionalTime,
    epoch: u32,
    sender: (u8, u8),
}

/// A time that may be unknown, in 8 bytes instead of the 16 of an `Option`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OptionalTime(i64);

impl OptionalTime {
    /// No clock on the wire reaches this: times begin at zero.
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

/// Takes frames as they come.
#[derive(Debug, Clone)]
pub struct Timeline {
    plane: LocalPlane,
    sequencers: Vec<SequenceUnwrapper>,
    truths: Rows<TruthEntry>,
    entries: Rows<TimedSample>,
    suspects: Vec<TruthEntry>,
    newest: Option<SimTime>,
    /// Last truth times of the epochs before.
    ended: Vec<SimTime>,
    /// System that sends the truth.
    system: Option<u8>,
    counts: LinkCounts,
}

/// What a pushed frame turned out to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameDisposition {
    /// Nothing that is kept, or a duplicate.
    Nothing,
    /// A sample of the running epoch.
    Kept(Sample),
    /// The simulator has started again; this is the first truth that proves it.
    Restarted(Sample),
}

impl Timeline {
    /// An empty timeline; positions are taken in `plane`.
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

    /// Newest truth time of the running epoch.
    #[must_use]
    pub fn newest(&self) -> Option<SimTime> {
        self.newest
    }

    /// The system whose flight this is, once a truth has come: nothing that others send belongs to it.
    #[must_use]
    pub fn system(&self) -> Option<u8> {
        self.system
    }

    /// Counts of the link so far.
    #[must_use]
    pub fn counts(&self) -> LinkCounts {
        self.counts
    }

    /// Epochs so far: one more than the simulator's restarts.
    #[must_use]
    pub fn simulator_runs(&self) -> usize {
        self.ended.len() + 1
    }

    /// How long the epochs before this one took together, each from its clock's zero to its last truth.
    #[must_use]
    pub fn apply_pushed(&self, epoch: usize) -> SimTime {
        self.ended.iter().take(epoch).fold(SimTime::ZERO, |sum, last| sum + *last)
    }

    /// Reads all whole records of a log.
    ///
    /// # Errors
    /// When the log cannot be read.
    pub fn push_log(&mut self, log: &(impl TelemetryLog + ?Sized)) -> std::io::Result<()> {
        log.for_each_record(&mut |record| {
            self.push(record.frame);
            ControlFlow::Continue(())
        })
    }

    /// Takes one whole frame.
    pub fn push(&mut self, frame: &[u8]) -> FrameDisposition {
        let Some(header) = FrameHeader::peek(frame) else { return FrameDisposition::Nothing };
        if header.sender.1 == MONITOR_COMPONENT || frame.len() < header.payload_end + 2 {
            return FrameDisposition::Nothing;
        }
        // Other systems' words are routed here too; once the vehicle is known they are nothing to the flight.
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
        // Ground stations reach the monitor in part only; their numbers have gaps that are no loss.
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
                    // A late frame was counted as lost when the later one came.
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
        // Stragglers after all: they belong where their time says.
        self.truths.extend(self.suspects.drain(..));
        self.truths.push(entry);
        self.newest = Some(self.newest.map_or(truth.time, |newest| newest.max(truth.time)));
        FrameDisposition::Kept(sample)
    }

    fn epoch(&self) -> u32 {
        // Each restart takes several frames: no log is long enough for the count to saturate.
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

    /// The flight of one epoch, in the order of time.
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

/// Key by which truths are found for other messages of the same sender.
fn numbering(entry: &TruthEntry) -> ((u8, u8), i64, SimTime) {
    (entry.sender, entry.order, entry.truth.time)
}

/// Returns the time of a sample; `numbered` are the flight's truths by [`numbering`].
fn time_of(entry: &TimedSample, numbered: &[&TruthEntry]) -> SimTime {
    let near = |a: SimTime, b: SimTime, within: SimTime| a.saturating_sub(b) <= within && b.saturating_sub(a) <= within;
    let arrival = entry.arrival.get();
    if let Some(own) = entry.own_time.get() {
        // A picture that was missed is sent again much later and still says when it was taken.
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

/// One flight, in the order of time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flight {
    /// Truth samples, strictly rising in time.
    pub truths: Vec<Truth>,
    /// Forward, right, up, clockwise.
    pub sticks: Signal<[f64; 4]>,
    /// Lamp.
    pub light: Signal<bool>,
    /// Battery, %.
    pub battery: Signal<f64>,
    /// Contact.
    pub contact: Signal<ContactKind>,
    /// Cumulative onsets.
    pub hits: Signal<i32>,
    /// Cumulative respawns.
    pub respawns: Signal<i32>,
    /// When traffic was stopped and let go, as the wire says it.
    pub traffic: Signal<i32>,
    /// Nearest surface, m.
    pub clearance: Signal<f64>,
    /// Gimbal pitch, rad.
    pub gimbal: Signal<f64>,
    /// The camera's horizontal field of view, rad.
    pub field_of_view: Signal<f64>,
    /// Armed.
    pub armed: Signal<bool>,
    /// Who flies, to the second of the heartbeat.
    pub flown_by: Signal<ControlSource>,
    /// Autopilot says on the ground.
    pub on_ground: Signal<bool>,
    /// Pictures taken, once each: number, and when by the camera's own clock.
    pub snapshots: Signal<(i32, Option<SimTime>)>,
    /// Seeds announced.
    pub seeds: Signal<u64>,
    /// Scenario CRCs announced.
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
                // A picture sent again keeps its number and its time; the earliest report of it stands. On a formatted card numbers begin again.
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
