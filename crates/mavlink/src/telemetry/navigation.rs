//! The autopilot's position and heading estimates, its GNSS fix, the wind, the battery's voltage and current, and the simulator's report on
//! hazards, which are exported and shown, never used for scoring.

use super::frame::MAX_INTERPOLATED_GAP;
use super::log_stream::TelemetryLog;
use super::sample::FrameHeader;
use super::signal::Signal;
use super::{Flight, Timeline};
use crate::contract::SIMULATOR_COMPONENT;
use crate::contract::hazards::HazardReport;
use crate::dialect::{
    BATTERY_STATUS_DATA, DEBUG_FLOAT_ARRAY_DATA, GLOBAL_POSITION_INT_DATA, GPS_RAW_INT_DATA, GpsFixType, MavMessage,
    WIND_COV_DATA,
};
use mavlink::{MavlinkVersion, MessageData};
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::time::SimTime;
use std::ops::ControlFlow;

/// Component ID of the autopilot. Other components' positions are ignored.
const AUTOPILOT_COMPONENT_ID: u8 = 1;
/// Maximum difference from truth time at which a message's own timestamp is used. Otherwise, the message gets the time
/// of the preceding truth message.
const MAX_CLOCK_DIFFERENCE: SimTime = SimTime::from_ms(2_000);
/// Maximum age of a wind report (estimate: reports are sent once per second, and one may be lost).
const MAX_WIND_AGE: SimTime = SimTime::from_ms(2_500);

/// Heading of GLOBAL_POSITION_INT that means that it is unknown.
const UNKNOWN_HEADING: u16 = u16::MAX;
/// Number of satellites of GPS_RAW_INT that means that it is unknown.
const UNKNOWN_SATELLITES: u8 = u8::MAX;

/// A report of the GNSS receiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GnssReport {
    /// Whether the receiver has a position in three dimensions.
    pub has_fix: bool,
    /// Number of visible satellites; `None` if unknown.
    pub satellites: Option<u8>,
}

impl GnssReport {
    /// Reads a message.
    #[must_use]
    pub fn of(wire: &GPS_RAW_INT_DATA) -> Self {
        let satellites = (wire.satellites_visible != UNKNOWN_SATELLITES).then_some(wire.satellites_visible);
        Self { has_fix: wire.fix_type as u8 >= GpsFixType::GPS_FIX_TYPE_3D_FIX as u8, satellites }
    }
}

/// Voltage and current of the battery.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryReport {
    /// Voltage of the pack, V.
    pub voltage_v: f64,
    /// Current drawn, A.
    pub current_a: f64,
}

impl BatteryReport {
    /// Reads a message; `None` if it is about another battery, or if voltage or current are unknown or 0.
    #[must_use]
    pub fn of(wire: &BATTERY_STATUS_DATA) -> Option<Self> {
        let cells_mv = wire.voltages.iter().filter(|cell_mv| **cell_mv != u16::MAX).map(|cell_mv| f64::from(*cell_mv));
        let report = Self { voltage_v: cells_mv.sum::<f64>() * 1e-3, current_a: f64::from(wire.current_battery) * 0.01 };
        (wire.id == 0 && report.voltage_v > 0.0 && report.current_a > 0.0).then_some(report)
    }
}

/// Wind, estimated position and heading, GNSS fix, battery and hazards during one flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Navigation {
    estimate_m: Signal<Vec3<Enu>>,
    heading_rad: Signal<f64>,
    wind_m_s: Signal<Vec3<Enu>>,
    /// True wind, which the simulator reports behind an external autopilot.
    simulator_wind_m_s: Signal<Vec3<Enu>>,
    gnss: Signal<GnssReport>,
    battery: Signal<BatteryReport>,
    hazards: Signal<HazardReport>,
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

    /// Returns the estimated positions, m.
    #[must_use]
    pub fn estimates_m(&self) -> &Signal<Vec3<Enu>> {
        &self.estimate_m
    }

    /// Returns the estimated headings, rad, clockwise from north.
    #[must_use]
    pub fn headings_rad(&self) -> &Signal<f64> {
        &self.heading_rad
    }

    /// Returns the reports of the GNSS receiver.
    #[must_use]
    pub fn gnss(&self) -> &Signal<GnssReport> {
        &self.gnss
    }

    /// Returns the reports of the battery.
    #[must_use]
    pub fn battery(&self) -> &Signal<BatteryReport> {
        &self.battery
    }

    /// Returns the reports on hazards.
    #[must_use]
    pub fn hazards(&self) -> &Signal<HazardReport> {
        &self.hazards
    }

    /// Returns the last reported wind velocity in m/s: the simulator's, or else the autopilot's estimate. `None` if the last report is
    /// older than 2.5 s.
    #[must_use]
    pub fn wind_m_s(&self, time: SimTime) -> Option<Vec3<Enu>> {
        let last = |reports: &Signal<Vec3<Enu>>| reports.between(time - MAX_WIND_AGE, time).last().map(|report| report.2);
        last(&self.simulator_wind_m_s).or_else(|| last(&self.wind_m_s))
    }
}

/// Collects these values while a timeline reads a log.
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

    /// Reads a log: its timeline, and these values.
    ///
    /// # Errors
    /// Fails if the log cannot be read.
    pub fn read_log(log: &(impl TelemetryLog + ?Sized), plane: LocalPlane) -> std::io::Result<(Timeline, Self)> {
        let (mut timeline, mut reader) = (Timeline::new(plane.clone()), Self::new(plane));
        log.for_each_record(&mut |record| {
            timeline.push(record.frame);
            reader.take(record.frame, &timeline);
            ControlFlow::Continue(())
        })?;
        Ok((timeline, reader))
    }

    /// Processes a frame after `timeline` has processed it. Ignores all messages except GLOBAL_POSITION_INT and GPS_RAW_INT from the
    /// vehicle's autopilot, WIND_COV, BATTERY_STATUS, and reports on hazards.
    pub fn take(&mut self, frame: &[u8], timeline: &Timeline) {
        let Some(header) = FrameHeader::peek(frame) else { return };
        let wanted = match header.message_id {
            GLOBAL_POSITION_INT_DATA::ID | GPS_RAW_INT_DATA::ID => header.sender.1 == AUTOPILOT_COMPONENT_ID,
            DEBUG_FLOAT_ARRAY_DATA::ID | WIND_COV_DATA::ID | BATTERY_STATUS_DATA::ID => {
                matches!(header.sender.1, AUTOPILOT_COMPONENT_ID | SIMULATOR_COMPONENT)
            }
            _ => false,
        };
        let ours = timeline.system() == Some(header.sender.0);
        let Some(newest) = timeline.newest().filter(|_| wanted && ours && FrameHeader::has_valid_checksum(frame)) else { return };
        let Some(payload) = frame.get(header.payload_at..header.payload_end) else { return };
        self.count += 1;
        let order = self.count;
        self.epochs.resize_with(timeline.epoch_count().max(self.epochs.len()), Navigation::default);
        let Some(epoch) = self.epochs.get_mut(timeline.epoch_count() - 1) else { return };
        if let Some((own, position_m, heading_rad)) = position(&header, payload, &self.plane) {
            epoch.estimate_m.push(time(own, newest), order, position_m);
            if let Some(heading_rad) = heading_rad {
                epoch.heading_rad.push(time(own, newest), order, heading_rad);
            }
        } else if let Some(report) = gnss(&header, payload) {
            // The clock of GPS_RAW_INT may be that of the receiver.
            epoch.gnss.push(newest, order, report);
        } else if let Some((own, wind_m_s)) = wind(&header, payload) {
            let is_true = header.sender.1 == SIMULATOR_COMPONENT;
            let reports = if is_true { &mut epoch.simulator_wind_m_s } else { &mut epoch.wind_m_s };
            reports.push(time(own, newest), order, wind_m_s);
        } else if let Some(report) = battery(&header, payload) {
            epoch.battery.push(newest, order, report);
        } else if let Some(report) = hazards(&header, payload) {
            epoch.hazards.push(newest, order, report);
        }
    }

    /// Returns the data for one timeline epoch, sorted by time.
    #[must_use]
    pub fn of(mut self, epoch: usize) -> Navigation {
        let mut navigation = if epoch < self.epochs.len() { self.epochs.swap_remove(epoch) } else { Navigation::default() };
        navigation.estimate_m.sort();
        navigation.heading_rad.sort();
        navigation.gnss.sort();
        navigation.wind_m_s.sort();
        navigation.simulator_wind_m_s.sort();
        navigation.battery.sort();
        navigation.hazards.sort();
        navigation
    }
}

fn time(own: SimTime, newest: SimTime) -> SimTime {
    let apart = own.saturating_sub(newest).max(newest.saturating_sub(own));
    if apart <= MAX_CLOCK_DIFFERENCE { own } else { newest }
}

fn position(header: &FrameHeader, payload: &[u8], plane: &LocalPlane) -> Option<(SimTime, Vec3<Enu>, Option<f64>)> {
    if header.message_id != GLOBAL_POSITION_INT_DATA::ID {
        return None;
    }
    let wire = GLOBAL_POSITION_INT_DATA::deser(MavlinkVersion::V2, payload).ok()?;
    let geo = Geo {
        latitude_deg: f64::from(wire.lat) * 1e-7,
        longitude_deg: f64::from(wire.lon) * 1e-7,
        altitude_m: f64::from(wire.alt) * 1e-3,
    };
    let heading_rad = (wire.hdg != UNKNOWN_HEADING).then(|| (f64::from(wire.hdg) * 0.01).to_radians());
    Some((SimTime::from_ms(i64::from(wire.time_boot_ms)), plane.enu_from_geo(geo), heading_rad))
}

fn gnss(header: &FrameHeader, payload: &[u8]) -> Option<GnssReport> {
    if header.message_id != GPS_RAW_INT_DATA::ID {
        return None;
    }
    GPS_RAW_INT_DATA::deser(MavlinkVersion::V2, payload).ok().map(|wire| GnssReport::of(&wire))
}

fn battery(header: &FrameHeader, payload: &[u8]) -> Option<BatteryReport> {
    if header.message_id != BATTERY_STATUS_DATA::ID {
        return None;
    }
    BATTERY_STATUS_DATA::deser(MavlinkVersion::V2, payload).ok().and_then(|wire| BatteryReport::of(&wire))
}

fn hazards(header: &FrameHeader, payload: &[u8]) -> Option<HazardReport> {
    if header.message_id != DEBUG_FLOAT_ARRAY_DATA::ID {
        return None;
    }
    let wire = DEBUG_FLOAT_ARRAY_DATA::deser(MavlinkVersion::V2, payload).ok()?;
    HazardReport::of(&MavMessage::DEBUG_FLOAT_ARRAY(wire))
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
