//! One vehicle's shell: sockets, files and pace around the sans-IO core.

use super::clock::{self, Stopwatch};
use super::errors::AppError;
use super::heard::HeardFile;
use super::links::{Change, Links};
use super::pace::{FirstAnswer, Lateness, Owed, PATIENCE, Pace, Patience, Speed};
use super::params::ParamFile;
use super::standstill::Standstill;
use super::store::Store;
use spandrel_mavlink::signing::{Key, stamp};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::FileError;
use spandrel_sitl::endpoint::{LinkId, LinkKind, Wish};
use spandrel_sitl::sim::{Sim, SimEvent};
use std::time::Duration;

/// Longest wait, so that requests to stop and silent peers are noticed.
const LOOK: Duration = Duration::from_millis(100);
/// Shortest sleep: ticks every millisecond would only keep the machine awake, and an arrival ends the sleep anyway.
const REST: Duration = Duration::from_millis(2);
/// Heartbeats while time stands still, of wall time: clients take a vehicle for lost after some 3 to 5 s.
const BEAT: Duration = Duration::from_secs(1);

/// What a vehicle keeps on disk.
#[derive(Debug)]
pub struct Kept {
    /// Files for clients, and flight logs.
    pub store: Option<Store>,
    /// Parameters.
    pub params: Option<ParamFile>,
    /// What was heard with the signing key.
    pub heard: Option<HeardFile>,
}

/// Signatures that are demanded.
#[derive(Debug, Clone)]
pub struct Signing {
    /// The key.
    pub key: Key,
    /// Kinds of links whose frames act without one.
    pub unsigned: Vec<LinkKind>,
}

/// One vehicle between its sockets, its files and the clock.
pub struct Shell {
    /// The vehicle.
    pub core: Sim,
    links: Links,
    pace: Pace,
    watch: Stopwatch,
    patience: Patience,
    first_answer: FirstAnswer,
    speed: Speed,
    store: Option<Store>,
    params: Option<ParamFile>,
    heard: Option<HeardFile>,
    still: Standstill,
    stands: Option<Duration>,
}

impl Shell {
    /// Time begins now.
    ///
    /// # Errors
    /// When a file that is kept is wrong.
    pub fn new(mut core: Sim, links: Links, speed: Speed, kept: Kept, signing: Option<Signing>) -> Result<Self, AppError> {
        let Kept { store, mut params, heard } = kept;
        let watch = Stopwatch::start();
        core.set_pace(speed.client_pace());
        if store.is_some() {
            core.serve_files();
            core.record();
        }
        if let Some(file) = &mut params {
            core.keep_parameters();
            if let Some(text) = file.text()? {
                core.read_parameters(&text).map_err(|problems| file.wrong(&problems))?;
            }
            file.holds = core.parameter_changes();
        }
        if let Some(Signing { key, unsigned }) = signing {
            core.demand_signatures(key, stamp(clock::unix_us()), &unsigned);
        }
        if let Some(file) = &heard
            && let Some(memory) = file.text()?
        {
            core.recall_signing(&memory).map_err(|line| file.wrong(line))?;
        }
        let pace = Pace::new(speed, watch.elapsed());
        Ok(Self {
            core,
            links,
            pace,
            watch,
            patience: Patience::default(),
            first_answer: FirstAnswer::default(),
            speed,
            store,
            params,
            heard,
            still: Standstill::default(),
            stands: None,
        })
    }

    /// Time stands still whenever this says so.
    pub fn obey(&mut self, still: Standstill) {
        self.still = still;
    }

    /// Time stands still: heartbeats go out, and what comes in does nothing.
    fn stand(&mut self) {
        while let Some(change) = self.links.poll() {
            if !matches!(change, Change::Bytes { .. }) {
                self.apply(change);
            }
        }
        self.links.forget_silent();
        let wall = self.watch.elapsed();
        if self.stands.is_none_or(|last| wall.saturating_sub(last) >= BEAT) {
            self.core.stand_still(self.stands.is_none());
            self.stands = Some(wall);
        }
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        self.pace.hold(wall, self.core.now());
        self.links.wait(LOOK);
    }

    /// Takes in what has come, lets time pass, sends what is due, rests.
    ///
    /// # Errors
    /// When a peer in step is gone.
    pub fn turn(&mut self, end: SimTime) -> Result<(), AppError> {
        if self.still.is_on() {
            self.stand();
            return Ok(());
        }
        if self.stands.take().is_some() {
            self.core.run_again();
        }
        while let Some(change) = self.links.poll() {
            self.apply(change);
        }
        self.links.forget_silent();
        if self.heard.is_some() {
            self.core.tell_stamp(stamp(clock::unix_us()));
        }
        let wall = self.watch.elapsed();
        if !self.core.waiting() {
            let speed = if self.core.serves_in_real_time() { Speed::Times(1.0) } else { self.speed };
            self.pace.run_at(speed, wall, self.core.now());
            let target = self.pace.target(wall, self.core.now()).min(end);
            self.pass_time(target);
        }
        self.keep_files();
        self.keep_parameters();
        self.keep_heard(false);
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        while let Some(event) = self.core.poll_event() {
            self.tell(&event);
        }
        self.rest()
    }

    /// Runs the ticks up to a time, and what clients ask of files between them.
    fn pass_time(&mut self, target: SimTime) {
        loop {
            self.core.handle_timeout(target);
            if !self.core.has_file_job() {
                return;
            }
            self.keep_files();
        }
    }

    /// Does what clients ask of files, and writes the log.
    fn keep_files(&mut self) {
        while let Some(job) = self.core.poll_file_job() {
            let outcome = self.store.as_mut().map_or(Err(FileError::NotFound), |store| store.work(&job.action));
            self.core.file_job_done(job.ticket, outcome);
        }
        while let Some(piece) = self.core.poll_log() {
            if let Some(Err(error)) = self.store.as_mut().map(|store| store.log(&piece)) {
                tracing::warn!("the flight's log is not written: {error}");
            }
        }
    }

    /// Writes parameters that have changed, and reads the file again when a client asks for it.
    fn keep_parameters(&mut self) {
        let Some(file) = &mut self.params else { return };
        let wish = self.core.poll_storage();
        let told = match wish {
            Some(Wish::Load) => file
                .text()
                .and_then(|text| self.core.read_parameters(&text.unwrap_or_default()).map_err(|problems| file.wrong(&problems))),
            _ if wish == Some(Wish::Save) || self.core.parameter_changes() != file.holds => {
                file.write(&self.core.parameter_text())
            }
            _ => return,
        };
        file.holds = self.core.parameter_changes();
        if let Err(error) = told {
            tracing::warn!("the parameters are not kept: {error}");
        }
    }

    /// Writes what was heard with the signing key, now and then or at the end.
    fn keep_heard(&mut self, at_once: bool) {
        let wall = self.watch.elapsed();
        if let Some(file) = self.heard.as_mut().filter(|file| at_once || file.is_due(wall))
            && let Some(memory) = self.core.signing_memory()
        {
            file.keep(memory, wall);
        }
    }

    fn apply(&mut self, change: Change) {
        match change {
            Change::Opened { link, kind, lockstep, learned, limit } => {
                self.core.open_link(LinkId(link), kind, lockstep);
                if learned {
                    self.core.await_heartbeat(LinkId(link));
                }
                if let Some(bytes_s) = limit {
                    self.core.limit_link(LinkId(link), bytes_s);
                }
            }
            Change::Bytes { link, bytes } => self.core.handle_datagram(LinkId(link), &bytes),
            Change::Closed { link } => self.core.close_link(LinkId(link)),
        }
    }

    /// Waits for the next tick, or for the peers that time waits for.
    fn rest(&mut self) -> Result<(), AppError> {
        let wall = self.watch.elapsed();
        if let Some(heard) = self.core.first_answer() {
            self.await_first_answer(heard, wall);
            return Ok(());
        }
        if self.core.waiting() {
            if self.patience.is_over(self.core.now(), wall) {
                return Err(AppError::failed(format!(
                    "a peer in lockstep has not answered TIMESYNC for {} s at {} and seems to be gone",
                    PATIENCE.as_secs(),
                    self.core.now()
                )));
            }
            self.links.wait(LOOK);
            return Ok(());
        }
        let sleep = self.pace.sleep(wall, self.core.poll_timeout());
        if !sleep.is_zero() {
            self.links.wait(sleep.clamp(REST, LOOK));
        }
        Ok(())
    }

    /// Lockstep begins with a peer's first answer: it must find the vehicle to give one.
    fn await_first_answer(&mut self, heard: bool, wall: Duration) {
        self.pace.hold(wall, self.core.now());
        match self.first_answer.owed(heard, wall, BEAT) {
            Owed::Wait => {}
            Owed::Knock => self.core.knock(),
            Owed::GoOn => {
                tracing::info!("a peer in lockstep has not answered TIMESYNC yet: it is served in real time until it does");
                self.core.go_without_first_answers();
                return;
            }
        }
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        self.links.wait(LOOK);
    }

    fn tell(&self, event: &SimEvent) {
        let now = self.core.now();
        match event {
            SimEvent::LiftOff => tracing::info!("{now}: lift-off"),
            SimEvent::Crash { what, impact_m_s } => tracing::info!("{now}: touched {what} at {impact_m_s:.1} m/s"),
            SimEvent::Respawn => tracing::info!("{now}: put back at the last safe hover"),
            SimEvent::BatteryEmpty => tracing::info!("{now}: the battery is empty"),
            SimEvent::Ended { reason } => tracing::info!("{now}: the flight is over: {reason}"),
        }
    }

    /// How late the machine has been.
    pub fn late(&self) -> Lateness {
        self.pace.late()
    }

    /// Finishes the log and tells what was lost.
    pub fn farewell(&mut self) {
        self.core.stop_recording();
        self.keep_files();
        self.keep_heard(true);
        let slipped = self.late().slipped;
        if slipped >= Duration::from_secs(1) {
            tracing::warn!("the machine could not keep up: {:.1} s of wall time were lost", slipped.as_secs_f64());
        }
        let bad = self.core.bad_bytes() + self.links.bad_bytes();
        if bad > 0 {
            tracing::warn!("{bad} bytes belonged to no MAVLink frame and were skipped");
        }
        if self.core.refused() > 0 {
            tracing::warn!("{} frames without a good signature did nothing", self.core.refused());
        }
        let dropped = self.core.dropped() + self.links.dropped();
        if dropped > 0 {
            tracing::warn!("{dropped} datagrams came faster than they may, or were more than a link carries, and were dropped");
        }
    }
}
