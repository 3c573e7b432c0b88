//! The vehicle's own log: as ULog, with PX4's topic names, which PX4's tools open (pyulog, Flight Review, PlotJuggler), and beside it
//! what Foxglove shows.

mod row;
mod scene;
mod topics;
pub mod ulog;

use super::endpoint::params;
use super::endpoint::view::View;
use row::Row;
use scene::Scene;
use spandrel_model::foxglove::Message;
use spandrel_model::time::{Schedule, SimTime};
use std::collections::VecDeque;
use topics::TOPICS;
use ulog::{Value, Writer};

/// Turns instants of the vehicle into bytes of a log.
#[derive(Debug, Clone)]
pub struct Log {
    writer: Writer,
    due: Vec<Schedule>,
}

impl Log {
    /// Begins a log: what it is, the parameters as they are, and what the rows hold.
    pub fn begin<'a>(view: &View, version: &str, parameters: impl Iterator<Item = (&'a str, Value<'a>)>) -> Self {
        let mut writer = Writer::default();
        writer.begin(view.sim_us());
        let hardware = format!("Spandrel SITL, {}", view.vehicle.name);
        writer.information("sys_name", Value::Text("Spandrel"));
        writer.information("ver_sw", Value::Text(version));
        writer.information("ver_hw", Value::Text(&hardware));
        writer.information("time_ref_utc", Value::Int(0));
        for topic in TOPICS {
            writer.format(topic.name, &format!("uint64_t timestamp;{}", topic.fields));
        }
        for (name, value) in parameters {
            writer.parameter(name, value);
        }
        for (number, topic) in (0u16..).zip(TOPICS) {
            writer.subscribe(number, topic.name);
        }
        let due = TOPICS.iter().map(|topic| Schedule::new(view.now, topic.rate_hz)).collect();
        Self { writer, due }
    }

    /// Writes the rows that are due; the last of a log are due whatever the time.
    pub fn observe(&mut self, view: &View, last: bool) {
        for ((number, topic), due) in (0u16..).zip(TOPICS).zip(&mut self.due) {
            if !due.fire(view.now) && !last {
                continue;
            }
            let mut row = Row::at(view.sim_us());
            if (topic.fill)(view, &mut row).is_some() {
                self.writer.row(number, row.bytes());
            }
        }
    }

    /// Writes a text (severity 0 emergency to 7 debug).
    pub fn text(&mut self, severity: u8, now: SimTime, text: &str) {
        self.writer.text(severity, now.us().max(0).cast_unsigned(), text);
    }

    /// Bytes that have gathered.
    #[must_use]
    pub fn gathered(&self) -> usize {
        self.writer.gathered()
    }

    /// The bytes since the last call; they go to the end of the file.
    pub fn take(&mut self) -> Vec<u8> {
        self.writer.take()
    }
}

impl From<params::Value> for Value<'_> {
    fn from(value: params::Value) -> Self {
        match value {
            params::Value::Int(value) => Self::Int(value),
            params::Value::Real(value) => Self::Real(value),
        }
    }
}

/// What a recorder has for whoever keeps files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// A new log begins; it is named after this UTC, microseconds since the Unix epoch.
    Begin(u64),
    /// Bytes for the end of the ULog.
    Bytes(Vec<u8>),
    /// A message of the recording beside it.
    Message(Message),
    /// It is whole.
    End,
}

/// Keeps a log from arming to disarming, once it is asked to.
#[derive(Debug, Clone, Default)]
pub struct Recorder {
    on: bool,
    log: Option<(Log, Scene)>,
    out: VecDeque<Piece>,
}

/// Bytes that gather before they are handed out.
const PIECE: usize = 16_384;

impl Recorder {
    /// Logs are wanted from now on.
    pub fn turn_on(&mut self) {
        self.on = true;
    }

    /// One instant of the vehicle, with what was said in it.
    pub fn observe<'a, P>(&mut self, view: &View, texts: &[(u8, &str)], parameters: impl Fn() -> P)
    where
        P: Iterator<Item = (&'a str, Value<'a>)>,
    {
        if !self.on {
            return;
        }
        if self.log.is_none() && view.status.armed {
            self.out.push_back(Piece::Begin(view.unix_us()));
            let log = Log::begin(view, env!("CARGO_PKG_VERSION"), parameters());
            self.log = Some((log, Scene::begin(view)));
        }
        let Some((log, scene)) = &mut self.log else { return };
        for (severity, text) in texts {
            log.text(*severity, view.now, text);
            self.out.push_back(Piece::Message(scene.text(*severity, view.now, text)));
        }
        log.observe(view, !view.status.armed);
        self.out.extend(scene.observe(view).into_iter().map(Piece::Message));
        if log.gathered() >= PIECE || !view.status.armed {
            self.out.push_back(Piece::Bytes(log.take()));
        }
        if !view.status.armed {
            self.log = None;
            self.out.push_back(Piece::End);
        }
    }

    /// What is left goes out although the motors still turn: the program ends.
    pub fn stop(&mut self) {
        self.on = false;
        if let Some((mut log, _)) = self.log.take() {
            self.out.extend([Piece::Bytes(log.take()), Piece::End]);
        }
    }

    /// The next piece.
    pub fn poll(&mut self) -> Option<Piece> {
        self.out.pop_front()
    }
}

#[cfg(test)]
mod tests;
