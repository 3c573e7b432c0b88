//! One vehicle's shell: sockets, files and pace around the sans-IO core.

use super::clock::{self, Stopwatch};
use super::links::{LinkChange, Links};
use super::pacing::{FirstAnswerAction, FirstAnswerWait, Lateness, LockstepTimeout, PATIENCE, SimulationSpeed, WallPacer};
use super::params::ParamFile;
use super::pause::PauseSwitch;
use super::signing_store::SigningStore;
use super::store::FileStore;
use crate::errors::AppError;
use spandrel_mavlink::signing::{SigningKey, stamp};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::FileError;
use spandrel_sitl::endpoint::{LinkId, LinkKind, StorageRequest};
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
pub struct VehicleFiles {
    /// Files for clients, and flight logs.
    pub store: Option<FileStore>,
    /// Parameters.
    pub params: Option<ParamFile>,
    /// What was heard with the signing key.
    pub signing_store: Option<SigningStore>,
}

/// Signatures that are demanded.
#[derive(Debug, Clone)]
pub struct SigningConfig {
    /// The key.
    pub key: SigningKey,
    /// Kinds of links whose frames act without one.
    pub unsigned: Vec<LinkKind>,
}

/// One vehicle between its sockets, its files and the clock.
pub struct VehicleShell {
    /// The vehicle.
    pub core: Sim,
    links: Links,
    pacer: WallPacer,
    stopwatch: Stopwatch,
    lockstep_timeout: LockstepTimeout,
    first_answer: FirstAnswerWait,
    speed: SimulationSpeed,
    store: Option<FileStore>,
    params: Option<ParamFile>,
    signing_store: Option<SigningStore>,
    pause: PauseSwitch,
    paused_for: Option<Duration>,
}

impl VehicleShell {
    /// Time begins now.
    ///
    /// # Errors
    /// When a file that is kept is wrong.
    pub fn new(
        mut core: Sim,
        links: Links,
        speed: SimulationSpeed,
        kept: VehicleFiles,
        signing: Option<SigningConfig>,
    ) -> Result<Self, AppError> {
        let VehicleFiles { store, mut params, signing_store: heard } = kept;
        let watch = Stopwatch::start();
        core.set_speed_factor(speed.client_speed_factor());
        if store.is_some() {
            core.enable_file_jobs();
            core.enable_flight_log();
        }
        if let Some(file) = &mut params {
            core.enable_param_storage();
            if let Some(text) = file.text()? {
                core.read_parameters(&text).map_err(|problems| file.wrong(&problems))?;
            }
            file.saved_changes = core.parameter_changes();
        }
        if let Some(SigningConfig { key, unsigned }) = signing {
            core.demand_signatures(key, stamp(clock::unix_us()), &unsigned);
        }
        if let Some(file) = &heard
            && let Some(memory) = file.text()?
        {
            core.restore_signing(&memory).map_err(|line| file.parse_error(line))?;
        }
        let pace = WallPacer::new(speed, watch.elapsed());
        Ok(Self {
            core,
            links,
            pacer: pace,
            stopwatch: watch,
            lockstep_timeout: LockstepTimeout::default(),
            first_answer: FirstAnswerWait::default(),
            speed,
            store,
            params,
            signing_store: heard,
            pause: PauseSwitch::default(),
            paused_for: None,
        })
    }

    /// Time stands still whenever this says so.
    pub fn set_pause_switch(&mut self, still: PauseSwitch) {
        self.pause = still;
    }

    /// Time stands still: heartbeats go out, and what comes in does nothing.
    fn run_paused(&mut self) {
        while let Some(change) = self.links.poll() {
            if !matches!(change, LinkChange::Bytes { .. }) {
                self.apply(change);
            }
        }
        self.links.drop_silent_peers();
        let wall = self.stopwatch.elapsed();
        if self.paused_for.is_none_or(|last| wall.saturating_sub(last) >= BEAT) {
            self.core.pause(self.paused_for.is_none());
            self.paused_for = Some(wall);
        }
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        self.pacer.hold(wall, self.core.now());
        self.links.wait(LOOK);
    }

    /// Takes in what has come, lets time pass, sends what is due, rests.
    ///
    /// # Errors
    /// When a peer in step is gone.
    pub fn run_until(&mut self, end: SimTime) -> Result<(), AppError> {
        if self.pause.is_paused() {
            self.run_paused();
            return Ok(());
        }
        if self.paused_for.take().is_some() {
            self.core.resume();
        }
        while let Some(change) = self.links.poll() {
            self.apply(change);
        }
        self.links.drop_silent_peers();
        if self.signing_store.is_some() {
            self.core.set_signing_time(stamp(clock::unix_us()));
        }
        let wall = self.stopwatch.elapsed();
        if !self.core.waiting() {
            let speed = if self.core.runs_in_real_time() { SimulationSpeed::Times(1.0) } else { self.speed };
            self.pacer.set_speed(speed, wall, self.core.now());
            let target = self.pacer.target(wall, self.core.now()).min(end);
            self.advance_to(target);
        }
        self.serve_file_jobs();
        self.save_parameters();
        self.save_signing_state(false);
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        while let Some(event) = self.core.poll_event() {
            self.log_event(&event);
        }
        self.wait_for_next_tick()
    }

    /// Runs the ticks up to a time, and what clients ask of files between them.
    fn advance_to(&mut self, target: SimTime) {
        loop {
            self.core.handle_timeout(target);
            if !self.core.has_file_job() {
                return;
            }
            self.serve_file_jobs();
        }
    }

    /// Does what clients ask of files, and writes the log.
    fn serve_file_jobs(&mut self) {
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
    fn save_parameters(&mut self) {
        let Some(file) = &mut self.params else { return };
        let wish = self.core.poll_storage();
        let told = match wish {
            Some(StorageRequest::Load) => file
                .text()
                .and_then(|text| self.core.read_parameters(&text.unwrap_or_default()).map_err(|problems| file.wrong(&problems))),
            _ if wish == Some(StorageRequest::Save) || self.core.parameter_changes() != file.saved_changes => {
                file.write(&self.core.parameter_text())
            }
            _ => return,
        };
        file.saved_changes = self.core.parameter_changes();
        if let Err(error) = told {
            tracing::warn!("the parameters are not kept: {error}");
        }
    }

    /// Writes what was heard with the signing key, now and then or at the end.
    fn save_signing_state(&mut self, at_once: bool) {
        let wall = self.stopwatch.elapsed();
        if let Some(file) = self.signing_store.as_mut().filter(|file| at_once || file.is_due(wall))
            && let Some(memory) = self.core.signing_memory()
        {
            file.save(memory, wall);
        }
    }

    fn apply(&mut self, change: LinkChange) {
        match change {
            LinkChange::Opened { link, kind, lockstep, learned, limit } => {
                self.core.open_link(LinkId(link), kind, lockstep);
                if learned {
                    self.core.await_heartbeat(LinkId(link));
                }
                if let Some(bytes_s) = limit {
                    self.core.limit_link(LinkId(link), bytes_s);
                }
            }
            LinkChange::Bytes { link, bytes } => self.core.handle_datagram(LinkId(link), &bytes),
            LinkChange::Closed { link } => self.core.close_link(LinkId(link)),
        }
    }

    /// Waits for the next tick, or for the peers that time waits for.
    fn wait_for_next_tick(&mut self) -> Result<(), AppError> {
        let wall = self.stopwatch.elapsed();
        if let Some(heard) = self.core.awaits_first_answer() {
            self.await_first_answer(heard, wall);
            return Ok(());
        }
        if self.core.waiting() {
            if self.lockstep_timeout.is_over(self.core.now(), wall) {
                return Err(AppError::failed(format!(
                    "a peer in lockstep has not answered TIMESYNC for {} s at {} and seems to be gone",
                    PATIENCE.as_secs(),
                    self.core.now()
                )));
            }
            self.links.wait(LOOK);
            return Ok(());
        }
        let sleep = self.pacer.sleep(wall, self.core.poll_timeout());
        if !sleep.is_zero() {
            self.links.wait(sleep.clamp(REST, LOOK));
        }
        Ok(())
    }

    /// Lockstep begins with a peer's first answer: it must find the vehicle to give one.
    fn await_first_answer(&mut self, heard: bool, wall: Duration) {
        self.pacer.hold(wall, self.core.now());
        match self.first_answer.action_due(heard, wall, BEAT) {
            FirstAnswerAction::Wait => {}
            FirstAnswerAction::Announce => self.core.send_first_contact(),
            FirstAnswerAction::Proceed => {
                tracing::info!("a peer in lockstep has not answered TIMESYNC yet: it is served in real time until it does");
                self.core.skip_first_answers();
                return;
            }
        }
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        self.links.wait(LOOK);
    }

    fn log_event(&self, event: &SimEvent) {
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
    pub fn lateness(&self) -> Lateness {
        self.pacer.lateness()
    }

    /// Finishes the log and tells what was lost.
    pub fn finish(&mut self) {
        self.core.close_flight_log();
        self.serve_file_jobs();
        self.save_signing_state(true);
        let slipped = self.lateness().slipped;
        if slipped >= Duration::from_secs(1) {
            tracing::warn!("the machine could not keep up: {:.1} s of wall time were lost", slipped.as_secs_f64());
        }
        let bad = self.core.bad_bytes() + self.links.bad_bytes();
        if bad > 0 {
            tracing::warn!("{bad} bytes belonged to no MAVLink frame and were skipped");
        }
        if self.core.rejected_frames() > 0 {
            tracing::warn!("{} frames without a good signature did nothing", self.core.rejected_frames());
        }
        let dropped = self.core.dropped() + self.links.take_dropped();
        if dropped > 0 {
            tracing::warn!("{dropped} datagrams came faster than they may, or were more than a link carries, and were dropped");
        }
    }
}
