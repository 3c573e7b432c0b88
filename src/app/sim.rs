//! `spandrel sim`: sockets and pace around the sans-IO vehicle.

use super::args::{self, JobArgs};
use super::clock::{self, Stopwatch};
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::key;
use super::pace::{PATIENCE, Pace, Patience, Speed};
use super::ports::{Change, Face, Links, PortArgs};
use super::progress::Progress;
use super::stop::Stop;
use super::store::Store;
use crate::base::time::SimTime;
use crate::mav::signing::stamp;
use crate::site::Site;
use crate::sitl::endpoint::files::job::FileError;
use crate::sitl::endpoint::{LinkId, LinkKind};
use crate::sitl::sim::{Sim, SimConfig, SimEvent};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Longest wait, so that requests to stop and silent peers are noticed.
const LOOK: Duration = Duration::from_millis(100);
/// Shortest sleep: ticks every millisecond would only keep the machine awake, and an arrival ends the sleep anyway.
const REST: Duration = Duration::from_millis(2);

/// Simulate the vehicle
///
/// A quadrotor with its autopilot at the job's site, as a PX4-compatible MAVLink vehicle (it is not PX4). It calls ground station and SDK
/// unasked, serves those who dial in, feeds the monitor, and forgets peers that fall silent. It runs until it is interrupted.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel sim                                      two bridges, real time, fixed ports
  spandrel sim --instance 1 --speed 4               a second vehicle beside it, four times real time
  spandrel sim --ports ephemeral --announce         free ports, told as one JSON line
  spandrel sim --speed max --gcs 127.0.0.1:9000 --lockstep 127.0.0.1:9000
                                                    flat out, in step with a client that answers TIMESYNC

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    /// So many times real time (0.1 to 100), or max for as fast as the machine can
    #[arg(long, value_name = "X|max", default_value = "1")]
    speed: Speed,
    /// Keep in step with this peer, which must be one of those called: every 20 ms of simulation time it gets TIMESYNC and is waited for;
    /// may be repeated
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address)]
    lockstep: Vec<SocketAddr>,
    #[command(flatten)]
    ports: PortArgs,
    /// Folder that is served over MAVLink FTP; the flights' logs (ULog) are written to its folder log [default: none is served or written]
    #[arg(long, value_name = "DIR")]
    files: Option<PathBuf>,
    /// File with the MAVLink signing key, readable by its owner alone: 64 hexadecimal digits, or a passphrase as MAVProxy takes it. What
    /// is not signed with it does nothing [default: no signatures]
    #[arg(long, value_name = "FILE")]
    signing_key: Option<PathBuf>,
    /// End after this much simulation time, s
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    end_after: Option<SimTime>,
    /// Print the digest of every tick's state at the end: the same scenario, seed and inputs give the same digest
    #[arg(long)]
    digest: bool,
    /// Print one JSON line {"gcs_port", "payload_port", "tcp_port", "seed"} on standard output first
    #[arg(long)]
    announce: bool,
    /// Finish when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

fn seconds(text: &str) -> Result<SimTime, String> {
    let s: f64 = text.parse().map_err(|_| format!("'{text}' is no number of seconds"))?;
    if (0.0..=1e6).contains(&s) {
        Ok(SimTime::from_s(s))
    } else {
        Err(format!("'{text}' is out of range (allowed: 0 to 1000000 s)"))
    }
}

/// Runs the subcommand.
///
/// # Errors
/// When files or ports are wrong, or a lockstep peer vanishes.
pub fn run(args: &Args) -> Result<(), AppError> {
    let stop = Stop::install(args.leash)?;
    let scenario = files::scenario(&args.job.scenario)?.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let seed = args.job.seed.or(scenario.seed).unwrap_or_else(args::fresh_seed);
    let key = args.signing_key.as_deref().map(key::read).transpose()?;
    if key.is_none() && !args.ports.listen.is_loopback() {
        tracing::warn!("--listen {} without --signing-key: whoever reaches this machine can fly the vehicle", args.ports.listen);
    }
    let store = args.files.as_deref().map(Store::open).transpose()?;
    let mut links = Links::open(&args.ports, &args.lockstep)?;
    let mut progress = Progress::start("building the site");
    let site = Arc::new(Site::build(&scenario, seed));
    links.bound["seed"] = seed.into();
    if args.announce {
        println!("{}", links.bound);
    }
    tracing::info!("{} with {}, seed {seed}, ports {}", scenario.name, vehicle.name, links.bound);
    let config = SimConfig { scenario: Arc::new(scenario), vehicle: Arc::new(vehicle), seed, instance: args.ports.instance };
    let watch = Stopwatch::start();
    let pace = Pace::new(args.speed, watch.elapsed());
    let mut core = Sim::new(config, site);
    core.set_pace(args.speed.client_pace());
    let mut shell = Shell { core, links, pace, watch, patience: Patience::default(), store, signs: false };
    if shell.store.is_some() {
        shell.core.serve_files();
        shell.core.record();
    }
    if let Some(key) = key {
        shell.signs = true;
        shell.core.demand_signatures(key, stamp(clock::unix_us()));
    }
    let end = args.end_after.unwrap_or(SimTime::NEVER);
    while !stop.asked() && shell.core.now() < end {
        shell.turn(end)?;
        progress.tell(|| format!("simulation time {}", shell.core.now()));
    }
    progress.end();
    shell.farewell();
    if args.digest {
        let digest = shell.core.digest();
        println!("{}", digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>());
    }
    Ok(())
}

struct Shell {
    core: Sim,
    links: Links,
    pace: Pace,
    watch: Stopwatch,
    patience: Patience,
    store: Option<Store>,
    signs: bool,
}

impl Shell {
    /// Takes in what has come, lets time pass, sends what is due, rests.
    fn turn(&mut self, end: SimTime) -> Result<(), AppError> {
        while let Some(change) = self.links.poll() {
            self.apply(change);
        }
        self.links.forget_silent();
        if self.signs {
            self.core.tell_stamp(stamp(clock::unix_us()));
        }
        let wall = self.watch.elapsed();
        if !self.core.waiting() {
            let target = self.pace.target(wall, self.core.now()).min(end);
            self.core.handle_timeout(target);
        }
        self.keep_files();
        while let Some(datagram) = self.core.poll_transmit() {
            self.links.send(datagram.link.0, datagram.bytes);
        }
        while let Some(event) = self.core.poll_event() {
            self.tell(&event);
        }
        self.rest()
    }

    /// Does what clients ask of files, and writes the log.
    fn keep_files(&mut self) {
        while let Some(job) = self.core.poll_file_job() {
            let outcome = self.store.as_ref().map_or(Err(FileError::NotFound), |store| store.work(&job.action));
            self.core.file_job_done(job.ticket, outcome);
        }
        while let Some(piece) = self.core.poll_log() {
            if let Some(Err(error)) = self.store.as_mut().map(|store| store.log(&piece)) {
                tracing::warn!("the flight's log is not written: {error}");
            }
        }
    }

    fn apply(&mut self, change: Change) {
        match change {
            Change::Opened { link, face, lockstep } => self.core.open_link(LinkId(link), kind(face), lockstep),
            Change::Bytes { link, bytes } => self.core.handle_datagram(LinkId(link), &bytes),
            Change::Closed { link } => self.core.close_link(LinkId(link)),
        }
    }

    /// Waits for the next tick, or for the peers that time waits for.
    fn rest(&mut self) -> Result<(), AppError> {
        let wall = self.watch.elapsed();
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

    fn farewell(&mut self) {
        self.core.stop_recording();
        self.keep_files();
        let slipped = self.pace.slipped();
        if slipped >= Duration::from_secs(1) {
            tracing::warn!("the machine could not keep up: {:.1} s of wall time were lost", slipped.as_secs_f64());
        }
        if self.core.bad_bytes() > 0 {
            tracing::warn!("{} bytes from clients belonged to no MAVLink frame", self.core.bad_bytes());
        }
        let bad = self.core.bad_bytes() + self.links.bad_bytes();
        if bad > 0 {
            tracing::warn!("{bad} bytes belonged to no MAVLink frame and were skipped");
        }
        if self.core.refused() > 0 {
            tracing::warn!("{} frames without a good signature did nothing", self.core.refused());
        }
        if self.links.dropped() > 0 {
            tracing::warn!("{} datagrams found a queue full", self.links.dropped());
        }
    }
}

fn kind(face: Face) -> LinkKind {
    match face {
        Face::GroundStation => LinkKind::GroundStation,
        Face::Tcp => LinkKind::Tcp,
        Face::Sdk => LinkKind::Sdk,
        Face::Payload => LinkKind::Payload,
    }
}
