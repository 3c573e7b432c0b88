//! Flight log: a ULog file with PX4's topic names, which PX4's tools (pyulog, Flight Review, PlotJuggler) can open, and
//! a parallel recording for Foxglove.

mod row;
mod scene;
mod topics;
pub mod ulog;

use super::endpoint::params;
use super::endpoint::snapshot::VehicleSnapshot;
use row::LogRow;
use scene::FoxgloveScene;
use spandrel_model::foxglove::ChannelMessage;
use spandrel_model::time::{Schedule, SimTime};
use std::collections::VecDeque;
use topics::TOPICS;
use ulog::{UlogValue, UlogWriter};

/// Encodes vehicle snapshots as ULog bytes.
#[derive(Debug, Clone)]
pub struct FlightLogEncoder {
    writer: UlogWriter,
    due: Vec<Schedule>,
}

impl FlightLogEncoder {
    /// Starts a log: writes header information, parameter values and topic formats.
    pub fn begin<'a>(view: &VehicleSnapshot, version: &str, parameters: impl Iterator<Item = (&'a str, UlogValue<'a>)>) -> Self {
        let mut writer = UlogWriter::default();
        writer.begin(view.clock.sim_time_us());
        let hardware = format!("Spandrel SITL, {}", view.vehicle.name);
        writer.information("sys_name", UlogValue::Text("Spandrel"));
        writer.information("ver_sw", UlogValue::Text(version));
        writer.information("ver_hw", UlogValue::Text(&hardware));
        writer.information("time_ref_utc", UlogValue::Int(0));
        for topic in TOPICS {
            writer.format(topic.name, &format!("uint64_t timestamp;{}", topic.fields));
        }
        for (name, value) in parameters {
            writer.parameter(name, value);
        }
        for (number, topic) in (0u16..).zip(TOPICS) {
            writer.subscribe(number, topic.name);
        }
        let due = TOPICS.iter().map(|topic| Schedule::new(view.clock.now, topic.rate_hz)).collect();
        Self { writer, due }
    }

    /// Writes the rows that are due. If `last` is true, writes every topic regardless of its schedule.
    pub fn observe(&mut self, view: &VehicleSnapshot, last: bool) {
        for ((number, topic), due) in (0u16..).zip(TOPICS).zip(&mut self.due) {
            if !due.fire(view.clock.now) && !last {
                continue;
            }
            let mut row = LogRow::at(view.clock.sim_time_us());
            if (topic.fill)(view, &mut row).is_some() {
                self.writer.row(number, row.bytes());
            }
        }
    }

    /// Writes a text message (severity 0 = emergency to 7 = debug).
    pub fn text(&mut self, severity: u8, now: SimTime, text: &str) {
        self.writer.text(severity, now.us().max(0).cast_unsigned(), text);
    }

    /// Returns the number of buffered bytes.
    #[must_use]
    pub fn buffered_bytes(&self) -> usize {
        self.writer.buffered_bytes()
    }

    /// Returns the bytes since the last call; the caller appends them to the file.
    pub fn take(&mut self) -> Vec<u8> {
        self.writer.take()
    }
}

impl From<params::ParamValue> for UlogValue<'_> {
    fn from(value: params::ParamValue) -> Self {
        match value {
            params::ParamValue::Int(value) => Self::Int(value),
            params::ParamValue::Real(value) => Self::Real(value),
        }
    }
}

/// Output of the flight recorder for the host to store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LogOutput {
    /// Start of a new log, with the UTC timestamp for its file name in microseconds since the Unix epoch.
    Begin(u64),
    /// Bytes to append to the ULog file.
    Bytes(Vec<u8>),
    /// A message of the parallel Foxglove recording.
    Message(ChannelMessage),
    /// The log is complete.
    End,
}

/// Records a log from arming to disarming, while logging is enabled.
#[derive(Debug, Clone, Default)]
pub struct FlightRecorder {
    enabled: bool,
    log: Option<(FlightLogEncoder, FoxgloveScene)>,
    out: VecDeque<LogOutput>,
}

/// Buffered bytes that trigger an output chunk.
const CHUNK_BYTES: usize = 16_384;

impl FlightRecorder {
    /// Enables logging.
    pub fn enable(&mut self) {
        self.enabled = true;
    }

    /// Returns true if logging is enabled.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Records one snapshot of the vehicle and the text messages sent at that instant.
    pub fn observe<'a, P>(&mut self, view: &VehicleSnapshot, texts: &[(u8, &str)], parameters: impl Fn() -> P)
    where
        P: Iterator<Item = (&'a str, UlogValue<'a>)>,
    {
        if !self.enabled {
            return;
        }
        if self.log.is_none() && view.status.armed {
            self.out.push_back(LogOutput::Begin(view.clock.unix_time_us()));
            let log = FlightLogEncoder::begin(view, env!("CARGO_PKG_VERSION"), parameters());
            self.log = Some((log, FoxgloveScene::begin(view)));
        }
        let Some((log, scene)) = &mut self.log else { return };
        for (severity, text) in texts {
            log.text(*severity, view.clock.now, text);
            self.out.push_back(LogOutput::Message(scene.text(*severity, view.clock.now, text)));
        }
        log.observe(view, !view.status.armed);
        self.out.extend(scene.observe(view).into_iter().map(LogOutput::Message));
        if log.buffered_bytes() >= CHUNK_BYTES || !view.status.armed {
            self.out.push_back(LogOutput::Bytes(log.take()));
        }
        if !view.status.armed {
            self.log = None;
            self.out.push_back(LogOutput::End);
        }
    }

    /// Stops logging and completes an open log, even if the motors are running. Call it at program exit.
    pub fn stop(&mut self) {
        self.enabled = false;
        if let Some((mut log, _)) = self.log.take() {
            self.out.extend([LogOutput::Bytes(log.take()), LogOutput::End]);
        }
    }

    /// Returns the next output.
    pub fn poll(&mut self) -> Option<LogOutput> {
        self.out.pop_front()
    }
}

#[cfg(test)]
mod tests;
