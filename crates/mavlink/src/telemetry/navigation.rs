//! The autopilot's wind and position estimates, which are only exported, never used for scoring.

use super::frame::MAX_INTERPOLATED_GAP;
use super::sample::FrameHeader;
use super::signal::Signal;
use super::{Flight, Timeline};
use crate::dialect::{GLOBAL_POSITION_INT_DATA, WIND_COV_DATA};
use mavlink::{MavlinkVersion, MessageData};
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::time::SimTime;

/// Component ID of the autopilot. Other components' positions are ignored.
const AUTOPILOT_COMPONENT_ID: u8 = 1;
/// Maximum difference from truth time at which a message's own timestamp is used. Otherwise, the message gets the time
/// of the preceding truth message.
const MAX_CLOCK_DIFFERENCE: SimTime = SimTime::from_ms(2_000);
/// Maximum age of a wind report (estimate: reports are sent once per second, and one may be lost).
const MAX_WIND_AGE: SimTime = SimTime::from_ms(2_500);

/// Wind and estimated position during one flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Navigation {
    estimate_m: Signal<Vec3<Enu>>,
    wind_m_s: Signal<Vec3<Enu>>,
}

impl Navigation {
    /// Returns the estimated position at `time`, m, interpolated between two reports at most 1 s apart. `None` if there are no
    /// such reports or if the aircraft was respawned or the flight was rewound between them.
    #[must_use]
    pub fn estimate_m(&self, flight: &Flight, time: SimTime) -> Option<Vec3<Enu>> {
        let reports = self.estimate_m.all();
        let after = reports.partition_point(|report| report.0 <= time);
        let (from, _, before_m) = reports[..after].last()?;
        if *from == time {
            return Some(*before_m);
        }
        let (to, _, after_m) = reports.get(after)?;
        let span = *to - *from;
        let is_moved = flight.respawns.at(*from) != flight.respawns.at(*to) || flight.was_rewound_between(*from, *to);
        if span > MAX_INTERPOLATED_GAP || is_moved {
            return None;
        }
        Some(before_m.lerp(*after_m, (time - *from).ns() as f64 / span.ns() as f64))
    }

    /// Returns the last reported wind velocity in m/s; `None` if the last report is older than 2.5 s.
    #[must_use]
    pub fn wind_m_s(&self, time: SimTime) -> Option<Vec3<Enu>> {
        self.wind_m_s.between(time - MAX_WIND_AGE, time).last().map(|report| report.2)
    }
}

/// Collects wind and estimated positions while a timeline reads a log.
#[derive(Debug)]
pub struct NavigationReader {
    plane: LocalPlane,
    epochs: Vec<Navigation>,
    count: i64,
}

impl NavigationReader {
    /// Creates a reader that converts positions with `plane`.
    #[must_use]
    pub fn new(plane: LocalPlane) -> Self {
        Self { plane, epochs: Vec::new(), count: 0 }
    }

    /// Processes a frame after `timeline` has processed it. Ignores all messages except GLOBAL_POSITION_INT and WIND_COV from the
    /// vehicle's autopilot.
    pub fn take(&mut self, frame: &[u8], timeline: &Timeline) {
        let Some(header) = FrameHeader::peek(frame) else { return };
        let wanted = matches!(header.message_id, GLOBAL_POSITION_INT_DATA::ID | WIND_COV_DATA::ID);
        let ours = header.sender.1 == AUTOPILOT_COMPONENT_ID && timeline.system() == Some(header.sender.0);
        let Some(newest) = timeline.newest().filter(|_| wanted && ours && FrameHeader::has_valid_checksum(frame)) else { return };
        let Some(payload) = frame.get(header.payload_at..header.payload_end) else { return };
        self.count += 1;
        let order = self.count;
        self.epochs.resize_with(timeline.epoch_count().max(self.epochs.len()), Navigation::default);
        let Some(epoch) = self.epochs.get_mut(timeline.epoch_count() - 1) else { return };
        if let Some((own, position_m)) = position(&header, payload, &self.plane) {
            epoch.estimate_m.push(time(own, newest), order, position_m);
        } else if let Some((own, wind_m_s)) = wind(&header, payload) {
            epoch.wind_m_s.push(time(own, newest), order, wind_m_s);
        }
    }

    /// Returns the data for one timeline epoch, sorted by time.
    #[must_use]
    pub fn of(mut self, epoch: usize) -> Navigation {
        let mut navigation = if epoch < self.epochs.len() { self.epochs.swap_remove(epoch) } else { Navigation::default() };
        navigation.estimate_m.sort();
        navigation.wind_m_s.sort();
        navigation
    }
}

fn time(own: SimTime, newest: SimTime) -> SimTime {
    let apart = own.saturating_sub(newest).max(newest.saturating_sub(own));
    if apart <= MAX_CLOCK_DIFFERENCE { own } else { newest }
}

fn position(header: &FrameHeader, payload: &[u8], plane: &LocalPlane) -> Option<(SimTime, Vec3<Enu>)> {
    if header.message_id != GLOBAL_POSITION_INT_DATA::ID {
        return None;
    }
    let wire = GLOBAL_POSITION_INT_DATA::deser(MavlinkVersion::V2, payload).ok()?;
    let geo = Geo {
        latitude_deg: f64::from(wire.lat) * 1e-7,
        longitude_deg: f64::from(wire.lon) * 1e-7,
        altitude_m: f64::from(wire.alt) * 1e-3,
    };
    Some((SimTime::from_ms(i64::from(wire.time_boot_ms)), plane.enu_from_geo(geo)))
}

fn wind(header: &FrameHeader, payload: &[u8]) -> Option<(SimTime, Vec3<Enu>)> {
    if header.message_id != WIND_COV_DATA::ID {
        return None;
    }
    let wire = WIND_COV_DATA::deser(MavlinkVersion::V2, payload).ok()?;
    let wind_m_s: Vec3<Ned> = Vec3::new(f64::from(wire.wind_x), f64::from(wire.wind_y), f64::from(wire.wind_z));
    let us = i64::try_from(wire.time_usec).unwrap_or(i64::MAX).min(i64::MAX / 1_000);
    wind_m_s.is_finite().then(|| (SimTime::from_us(us), wind_m_s.enu()))
}
