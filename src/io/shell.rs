//! Connects one vehicle's sans-IO core to its sockets, its files and the wall clock.

use super::autopilot::flight_controller::FrameUse;
use super::autopilot::host::AutopilotHost;
use super::clock::{self, Stopwatch};
use super::link_event::LinkEvent;
use super::links::Links;
use super::pacing::{
    FirstResponseAction, FirstResponseWait, LOCKSTEP_PEER_TIMEOUT, Lateness, LockstepTimeout, SimulationSpeed, WallPacer,
};
use super::params::ParamFile;
use super::pause::PauseSwitch;
use super::signing_store::SigningStore;
use super::store::FileStore;
use crate::errors::AppError;
use spandrel_mavlink::signing::{SigningKey, stamp};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::FileError;
use spandrel_sitl::endpoint::{LinkId, LinkKind, StorageRequest};
use spandrel_sitl::sim::shared_site::exchange;
use spandrel_sitl::sim::{AutopilotState, STEP, Sim, SimEvent};
use std::time::Duration;

/// Maximum time to wait for socket data, so that the loop notices stop requests and silent peers.
const MAX_SOCKET_WAIT: Duration = Duration::from_millis(100);
/// Minimum sleep time. Waking every millisecond would only load the CPU, and incoming data ends the sleep anyway.
const MIN_SLEEP: Duration = Duration::from_millis(2);
/// Maximum time until a new connection of an external autopilot is noticed.
const CONNECTION_CHECK_INTERVAL: Duration = Duration::from_millis(10);
/// Wall time between readings before an external autopilot's first answer: PX4's own simulators send at this rate.
const START_STEP: Duration = Duration::from_millis(4);
/// Delay beyond which an external autopilot that starts in real time does not catch up.
const MAX_START_DELAY: Duration = Duration::from_millis(20);
/// Wall-clock interval between heartbeats while the simulation is paused or frozen. Clients consider a vehicle lost after about 3
/// to 5 s without one.
const HEARTBEAT_INTERVAL: Duration = Duration::from_secs(1);

/// Files that belong to one vehicle.
#[derive(Debug)]
pub struct VehicleFiles {
    /// Files that clients can access, and flight logs.
    pub store: Option<FileStore>,
    /// File that stores the parameters, if any.
    pub params: Option<ParamFile>,
    /// Saved MAVLink signing state.
    pub signing_store: Option<SigningStore>,
}

/// MAVLink signing key, and the links that need no signature.
#[derive(Debug, Clone)]
pub struct SigningConfig {
    /// Key that must sign the messages on all other links.
    pub key: SigningKey,
    /// Link types on which unsigned frames are accepted.
    pub unsigned: Vec<LinkKind>,
}

/// One vehicle with its sockets, its files and its pacing.
pub struct VehicleShell {
    /// Vehicle core (simulation and MAVLink endpoint).
    pub core: Sim,
    links: Links,
    pacer: WallPacer,
    stopwatch: Stopwatch,
    lockstep_timeout: LockstepTimeout,
    first_response: FirstResponseWait,
    speed: SimulationSpeed,
    store: Option<FileStore>,
    params: Option<ParamFile>,
    signing_store: Option<SigningStore>,
    pause: PauseSwitch,
    /// Wall time of the latest heartbeats in the current pause.
    paused_for: Option<Duration>,
    /// Wall time of the latest heartbeats in the current freeze.
    frozen_for: Option<Duration>,
    /// The external autopilot, if one flies.
    autopilot: Option<AutopilotShell>,
}

/// An external autopilot, and the wall time of the last readings sent during its start.
struct AutopilotShell {
    host: AutopilotHost,
    last_step: Duration,
    connection_closed: bool,
    pause_reported: bool,
}

impl VehicleShell {
    /// Loads the vehicle's saved files and starts its clock.
    ///
    /// # Errors
    /// Returns an error if a saved file is invalid.
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
                core.load_parameters(&text).map_err(|problems| file.parse_error(&problems))?;
            }
            file.saved_changes = core.parameter_changes();
        }
        if let Some(SigningConfig { key, unsigned }) = signing {
            core.require_signatures(key, stamp(clock::unix_us()), &unsigned);
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
            first_response: FirstResponseWait::default(),
            speed,
            store,
            params,
            signing_store: heard,
            pause: PauseSwitch::default(),
            paused_for: None,
            frozen_for: None,
            autopilot: None,
        })
    }

    /// Starts the external autopilot that flies the vehicle.
    ///
    /// # Errors
    /// Returns an error if its process cannot be started.
    pub fn start_autopilot(&mut self, mut host: AutopilotHost) -> Result<(), AppError> {
        let wall = self.stopwatch.elapsed();
        host.start(wall)?;
        if host.is_flight_controller() {
            self.pacer.limit_bursts();
        }
        self.autopilot = Some(AutopilotShell { host, last_step: wall, connection_closed: false, pause_reported: false });
        Ok(())
    }

    /// Pauses the simulation whenever this flag is set.
    pub fn set_pause_switch(&mut self, still: PauseSwitch) {
        self.pause = still;
    }

    /// Returns whether the simulation can pause. A flight controller's clock cannot be stopped: without readings, its estimator
    /// would fail.
    fn can_pause(&mut self) -> bool {
        let Some(autopilot) = self.autopilot.as_mut().filter(|autopilot| autopilot.host.is_flight_controller()) else {
            return true;
        };
        if !std::mem::replace(&mut autopilot.pause_reported, true) {
            tracing::warn!("the simulation does not pause: a flight controller runs in real time");
        }
        false
    }

    /// Sends heartbeats and discards incoming data while the simulation is paused.
    fn run_paused(&mut self) {
        self.hold_paused();
        self.links.wait(MAX_SOCKET_WAIT);
    }

    /// Does the same without waiting for incoming data.
    fn hold_paused(&mut self) {
        while let Some(change) = self.links.poll() {
            if !matches!(change, LinkEvent::Bytes { .. }) {
                self.apply(change);
            }
        }
        self.links.drop_silent_peers();
        let wall = self.stopwatch.elapsed();
        if self.paused_for.is_none_or(|last| wall.saturating_sub(last) >= HEARTBEAT_INTERVAL) {
            self.core.pause(self.paused_for.is_none());
            self.paused_for = Some(wall);
        }
        self.hold_time(wall);
    }

    /// Sends heartbeats while the flight is frozen. Incoming data has been handled before.
    fn run_frozen(&mut self, wall: Duration) {
        let last = *self.frozen_for.get_or_insert(wall);
        if wall.saturating_sub(last) >= HEARTBEAT_INTERVAL {
            self.core.pause(false);
            self.frozen_for = Some(wall);
        }
        self.hold_time(wall);
        self.links.wait(MAX_SOCKET_WAIT);
    }

    /// Sends outgoing data while simulation time is stopped.
    fn hold_time(&mut self, wall: Duration) {
        self.send_outgoing();
        self.pacer.resync(wall, self.core.now());
        if let Some(autopilot) = &mut self.autopilot {
            // A pause is no silence of the autopilot.
            autopilot.host.note_progress(wall);
        }
    }

    /// Handles incoming data, advances the simulation toward `end` as far as the wall clock allows, sends outgoing
    /// data, and waits for the next tick.
    ///
    /// # Errors
    /// Returns an error if a lockstep peer has disappeared.
    pub fn run_until(&mut self, end: SimTime) -> Result<(), AppError> {
        if self.pause.is_paused() && self.can_pause() {
            self.run_paused();
            return Ok(());
        }
        self.receive();
        let wall = self.stopwatch.elapsed();
        if self.run_autopilot(wall)? {
            return Ok(());
        }
        if !self.core.waiting() {
            let speed = if self.core.runs_in_real_time() { SimulationSpeed::Factor(1.0) } else { self.speed };
            self.pacer.set_speed(speed, wall, self.core.now());
            let target = self.pacer.target(wall, self.core.now()).min(end);
            self.advance_to(target);
        }
        self.serve_clients()?;
        if self.core.is_frozen() {
            self.run_frozen(wall);
            return Ok(());
        }
        self.frozen_for = None;
        self.wait_for_next_tick()
    }

    /// Handles incoming data, after a pause if there was one.
    fn receive(&mut self) {
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
    }

    /// Serves file requests, saves what has changed, sends outgoing data and logs events.
    fn serve_clients(&mut self) -> Result<(), AppError> {
        self.run_file_jobs();
        self.save_parameters();
        self.save_signing_state(false);
        self.send_outgoing();
        self.handle_events()
    }

    /// Does what [`Self::run_until`] does for several vehicles that share a site and one clock: after each tick of all vehicles, they
    /// see and touch each other. The vehicles must have no lockstep peers, external autopilots or practice controls, so that none of
    /// them stops the time of the others.
    ///
    /// # Errors
    /// Returns an error if a vehicle fails.
    pub fn run_together(shells: &mut [Self], end: SimTime) -> Result<(), AppError> {
        let Some(lead) = shells.first() else { return Ok(()) };
        if lead.pause.is_paused() {
            shells.iter_mut().for_each(Self::hold_paused);
            if let Some(lead) = shells.first_mut() {
                lead.links.wait(MAX_SOCKET_WAIT);
            }
            return Ok(());
        }
        shells.iter_mut().for_each(Self::receive);
        let Some(lead) = shells.first_mut() else { return Ok(()) };
        let mut now = lead.core.now();
        let target = lead.pacer.target(lead.stopwatch.elapsed(), now).min(end);
        while now + STEP <= target {
            now += STEP;
            shells.iter_mut().for_each(|shell| shell.advance_to(now));
            exchange(&mut shells.iter_mut().map(|shell| &mut shell.core).collect::<Vec<_>>());
        }
        shells.iter_mut().try_for_each(Self::serve_clients)?;
        shells.first_mut().map_or(Ok(()), Self::wait_for_next_tick)
    }

    /// Sends all outgoing data.
    fn send_outgoing(&mut self) {
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        while let Some(bytes) = self.core.poll_autopilot_transmit() {
            self.links.send_to_autopilot(bytes);
        }
        self.links.flush_autopilot();
    }

    /// Logs the simulation's events and restarts an external autopilot on request.
    fn handle_events(&mut self) -> Result<(), AppError> {
        while let Some(event) = self.core.poll_event() {
            self.log_event(&event);
            if let (SimEvent::AutopilotRestart { reason }, Some(autopilot)) = (&event, &mut self.autopilot) {
                self.links.disconnect_autopilot();
                autopilot.host.restart(reason, self.stopwatch.elapsed())?;
            }
            if let (SimEvent::AutopilotStarted { .. }, Some(autopilot)) = (&event, &mut self.autopilot) {
                autopilot.host.log_version(&self.core);
                autopilot.host.record(&self.core);
            }
        }
        Ok(())
    }

    /// Watches the external autopilot and, while it starts, runs its clock. Returns true if simulation time is stopped.
    fn run_autopilot(&mut self, wall: Duration) -> Result<bool, AppError> {
        let Some(autopilot) = &mut self.autopilot else { return Ok(false) };
        autopilot.host.check(&self.core, wall)?;
        if std::mem::take(&mut autopilot.connection_closed)
            && !matches!(self.core.autopilot_state(), Some(AutopilotState::Disconnected))
        {
            return Err(autopilot.host.disconnected());
        }
        for message in autopilot.host.messages(wall) {
            self.core.send_to_autopilot(&message);
        }
        let mut next_step = wall;
        let state = self.core.autopilot_state();
        let pause = match state {
            None | Some(AutopilotState::Running { .. }) => return Ok(false),
            Some(AutopilotState::Disconnected) => CONNECTION_CHECK_INTERVAL,
            Some(AutopilotState::Starting { has_answered: true, in_real_time: false, is_waiting }) => {
                if is_waiting {
                    MAX_SOCKET_WAIT
                } else {
                    Duration::ZERO
                }
            }
            // Before its first answer, the autopilot starts in real time. A flight controller always does.
            Some(AutopilotState::Starting { in_real_time, is_waiting, .. }) => {
                let period = self.core.autopilot_period().filter(|_| in_real_time);
                let step = period.map_or(START_STEP, |period| Duration::from_nanos(period.ns().unsigned_abs()));
                autopilot.last_step = autopilot.last_step.max(wall.saturating_sub(MAX_START_DELAY));
                next_step = autopilot.last_step + step;
                if is_waiting { MAX_SOCKET_WAIT } else { next_step.saturating_sub(wall) }
            }
        };
        self.pacer.resync(wall, self.core.now());
        if pause.is_zero() {
            autopilot.last_step = next_step;
            self.core.handle_timeout(self.core.now());
        }
        self.send_outgoing();
        self.handle_events()?;
        if matches!(state, Some(AutopilotState::Starting { is_waiting: true, .. })) {
            self.links.wait_for_answer(pause);
        } else if !pause.is_zero() {
            self.links.wait(pause);
        }
        Ok(true)
    }

    /// Runs the ticks up to `target` and serves the clients' file requests between ticks.
    fn advance_to(&mut self, target: SimTime) {
        loop {
            self.core.handle_timeout(target);
            if !self.core.has_file_job() {
                return;
            }
            self.run_file_jobs();
        }
    }

    /// Carries out the clients' file requests and appends to the flight log.
    fn run_file_jobs(&mut self) {
        while let Some(job) = self.core.poll_file_job() {
            let outcome = self.store.as_mut().map_or(Err(FileError::NotFound), |store| store.run_action(&job.action));
            self.core.finish_file_job(job.ticket, outcome);
        }
        while let Some(piece) = self.core.poll_log() {
            if let Some(Err(error)) = self.store.as_mut().map(|store| store.log(&piece)) {
                tracing::warn!("flight log: {error}");
            }
        }
    }

    /// Saves changed parameters. Rereads the file if a client requests it.
    fn save_parameters(&mut self) {
        let Some(file) = &mut self.params else { return };
        let wish = self.core.take_storage_request();
        let told = match wish {
            Some(StorageRequest::Load) => file.text().and_then(|text| {
                self.core.load_parameters(&text.unwrap_or_default()).map_err(|problems| file.parse_error(&problems))
            }),
            _ if wish == Some(StorageRequest::Save) || self.core.parameter_changes() != file.saved_changes => {
                file.write(&self.core.parameter_text())
            }
            _ => return,
        };
        file.saved_changes = self.core.parameter_changes();
        if let Err(error) = told {
            tracing::warn!("cannot save the parameters: {error}");
        }
    }

    /// Saves the signing state if a save is due or `at_once` is true.
    fn save_signing_state(&mut self, at_once: bool) {
        let wall = self.stopwatch.elapsed();
        if let Some(file) = self.signing_store.as_mut().filter(|file| at_once || file.is_due(wall))
            && let Some(memory) = self.core.signing_state()
        {
            file.save(memory, wall);
        }
    }

    fn apply(&mut self, change: LinkEvent) {
        match change {
            LinkEvent::Opened { link, kind, lockstep, learned, limit } => {
                self.core.open_link(LinkId(link), kind, lockstep);
                if learned {
                    self.core.await_heartbeat(LinkId(link));
                }
                if let Some(bytes_s) = limit {
                    self.core.limit_link_rate(LinkId(link), bytes_s);
                }
            }
            LinkEvent::Bytes { link, bytes } => self.core.handle_datagram(LinkId(link), &bytes),
            LinkEvent::Closed { link } => self.core.close_link(LinkId(link)),
            LinkEvent::FlightControllerFrame { link, frame } => {
                let wall = self.stopwatch.elapsed();
                let frame_use = self.autopilot.as_mut().map(|autopilot| autopilot.host.handle_frame(&frame, wall));
                match frame_use {
                    Some(FrameUse::Consumed) => {}
                    Some(FrameUse::Rebooted) => self.connect_autopilot(),
                    Some(FrameUse::Forward) | None => self.core.handle_datagram(LinkId(link), &frame.bytes),
                }
            }
            LinkEvent::AutopilotConnected => self.connect_autopilot(),
            LinkEvent::AutopilotBytes(bytes) => {
                let before = self.core.autopilot_state();
                self.core.handle_autopilot_bytes(&bytes);
                if let Some(autopilot) = &mut self.autopilot {
                    autopilot.host.note_bytes(before, self.core.autopilot_state(), self.stopwatch.elapsed());
                }
            }
            LinkEvent::AutopilotClosed => {
                if let Some(autopilot) = &mut self.autopilot {
                    autopilot.connection_closed = true;
                }
            }
        }
    }

    /// Starts the exchange with an autopilot that has connected or rebooted.
    fn connect_autopilot(&mut self) {
        tracing::info!("the autopilot has connected");
        if let Some(autopilot) = &mut self.autopilot {
            autopilot.host.finish_reboot();
        }
        self.core.connect_autopilot();
    }

    /// Waits for the next tick or for the lockstep peers.
    fn wait_for_next_tick(&mut self) -> Result<(), AppError> {
        let wall = self.stopwatch.elapsed();
        if let Some(heard) = self.core.awaits_first_response() {
            self.wait_for_first_response(heard, wall);
            return Ok(());
        }
        if self.core.waiting() {
            if self.lockstep_timeout.is_over(self.core.now(), wall) {
                return Err(AppError::failed(format!(
                    "a lockstep peer has not answered TIMESYNC for {} s (simulation time {}); it may have exited",
                    LOCKSTEP_PEER_TIMEOUT.as_secs(),
                    self.core.now()
                )));
            }
            if self.lockstep_timeout.take_repeat(wall) {
                self.core.repeat_lockstep_requests();
                self.send_outgoing();
            }
            self.links.wait(MAX_SOCKET_WAIT);
            return Ok(());
        }
        if self.core.autopilot_state() == Some(AutopilotState::Running { is_waiting: true }) {
            self.links.wait_for_answer(MAX_SOCKET_WAIT);
            return Ok(());
        }
        let sleep = self.pacer.sleep(wall, self.core.poll_timeout());
        if !sleep.is_zero() {
            self.links.wait(sleep.clamp(MIN_SLEEP, MAX_SOCKET_WAIT));
        }
        Ok(())
    }

    /// Waits for a peer's first TIMESYNC response. Meanwhile, the vehicle announces itself, because a peer must find it
    /// before responding.
    fn wait_for_first_response(&mut self, heard: bool, wall: Duration) {
        self.pacer.resync(wall, self.core.now());
        match self.first_response.next_action(heard, wall, HEARTBEAT_INTERVAL) {
            FirstResponseAction::Wait => {}
            FirstResponseAction::Announce => self.core.send_first_heartbeats(),
            FirstResponseAction::Proceed => {
                tracing::info!("a lockstep peer has not answered TIMESYNC yet: serving it in real time until it does");
                self.core.stop_awaiting_first_responses();
                return;
            }
        }
        self.send_outgoing();
        self.links.wait(MAX_SOCKET_WAIT);
    }

    fn log_event(&self, event: &SimEvent) {
        let now = self.core.now();
        match event {
            SimEvent::LiftOff => tracing::info!("{now}: lift-off"),
            SimEvent::Crash { what, impact_m_s } => tracing::info!("{now}: hit {what} at {impact_m_s:.1} m/s"),
            SimEvent::Respawn if self.autopilot.is_some() => tracing::info!("{now}: placed on the landing pad"),
            SimEvent::Respawn => tracing::info!("{now}: respawned at the last safe hover"),
            SimEvent::AutopilotRestart { reason } => tracing::debug!("{now}: autopilot restart: {reason}"),
            SimEvent::AutopilotStarted { took, is_ready: true } => {
                tracing::info!("{now}: the autopilot is ready after {:.1} s on its clock", took.s());
            }
            SimEvent::AutopilotStarted { took, is_ready: false } => tracing::warn!(
                "{now}: the autopilot is not ready to arm after {:.0} s on its clock; see its messages in a ground station",
                took.s()
            ),
            SimEvent::AutopilotProblem { problem } => tracing::warn!("{now}: autopilot: {problem}"),
            SimEvent::Freeze => tracing::info!("{now}: frozen"),
            SimEvent::Rewind { undone } => tracing::info!("{now}: rewound by {:.0} s", undone.s()),
            SimEvent::MoveToTask { task } => tracing::info!("{now}: moved to the start of task {task}"),
            SimEvent::Walk { place } => tracing::info!("{now}: the inspector walks to place {place}"),
            SimEvent::BatteryEmpty => tracing::info!("{now}: battery empty"),
            SimEvent::Ended { reason } => tracing::info!("{now}: flight ended: {reason}"),
        }
    }

    /// Returns the simulation's delay relative to the wall clock.
    pub fn lateness(&self) -> Lateness {
        self.pacer.lateness()
    }

    /// Records the external autopilot, closes the flight log, saves the signing state and logs the amount of lost data.
    pub fn finish(&mut self) {
        if let Some(autopilot) = &mut self.autopilot {
            autopilot.host.record(&self.core);
        }
        self.core.close_flight_log();
        self.run_file_jobs();
        self.save_signing_state(true);
        let slipped = self.lateness().slipped_time;
        if slipped >= Duration::from_secs(1) {
            tracing::warn!("the computer could not keep up: lost {:.1} s of wall time", slipped.as_secs_f64());
        }
        let bad = self.core.bad_bytes() + self.links.bad_bytes();
        if bad > 0 {
            tracing::warn!("skipped {bad} bytes that are not part of a MAVLink frame");
        }
        if self.core.rejected_frames() > 0 {
            tracing::warn!("ignored {} frames without a valid signature", self.core.rejected_frames());
        }
        let dropped = self.core.dropped() + self.links.take_dropped();
        if dropped > 0 {
            tracing::warn!("dropped {dropped} datagrams that exceeded the rate limit or their link's capacity");
        }
    }
}
