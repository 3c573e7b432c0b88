//! `spandrel sim`: runs one or more vehicles at a site: each in its own thread, or together in one thread if they share the site.

use super::args::{self, JobArgs};
use super::autopilot_args::AutopilotArgs;
use super::ports::PortArgs;
use crate::errors::{AUTOPILOT_EXIT_CODES, AppError};
use crate::io::addresses;
use crate::io::autopilot::config::{AutopilotConfig, AutopilotKind};
use crate::io::autopilot::setup::{AutopilotSetup, SiteFacts};
use crate::io::files;
use crate::io::key;
use crate::io::links::Links;
use crate::io::pacing::{Lateness, SimulationSpeed};
use crate::io::params::ParamFile;
use crate::io::pause::PauseSwitch;
use crate::io::progress::ProgressLog;
use crate::io::serial::SerialDevice;
use crate::io::shell::{SigningConfig, VehicleFiles, VehicleShell};
use crate::io::signing_store::SigningStore;
use crate::io::stop::StopRequest;
use crate::io::store::FileStore;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::endpoint::LinkKind;
use spandrel_sitl::sim::shared_site::start_places;
use spandrel_sitl::sim::{STEP, Sim, SimConfig};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Simulate the vehicle
///
/// Runs a quadrotor at the scenario's site as a MAVLink vehicle. By default, the built-in autopilot flies it, with the
/// interface of PX4 or ArduPilot; with --autopilot, a real PX4 or ArduPilot flies the same aircraft. The vehicle sends
/// telemetry to a ground station, an SDK and the monitor, accepts other connections, and drops silent peers. It runs
/// until interrupted.
#[derive(Debug, clap::Args)]
#[command(after_help = AUTOPILOT_EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel sim                                      two bridges, real time, fixed ports
  spandrel sim --instance 1 --speed 4               a second vehicle, four times real time
  spandrel sim --instances 3                        three vehicles in one process: system IDs 1 to 3, consecutive ports
  spandrel sim --drones 2                           two drones that see and hit each other, side by side at the landing pad
  spandrel sim --serial /dev/ttyUSB0:57600          also send telemetry over a radio, limited to its data rate
  spandrel sim --flavor ardupilot                  for Mission Planner, MAVProxy and scripts written for ArduCopter
  spandrel sim --autopilot px4 --px4 ~/PX4-Autopilot     a real PX4 flies the aircraft
  spandrel sim --autopilot ardupilot --wait         print the command that starts ArduPilot, and wait for it
  spandrel sim --autopilot px4 --serial /dev/ttyACM0:921600
                                                    a flight controller with PX4 flies the aircraft (hardware in the loop)
  spandrel sim --ports ephemeral --announce         free ports, printed as one line of JSON
  spandrel sim --speed max --gcs 127.0.0.1:9000 --lockstep 127.0.0.1:9000
                                                    as fast as possible, in lockstep with a client that answers TIMESYNC

{AUTOPILOT_EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    /// Simulation speed: a multiple of real time (0.1 to 100), or max for as fast as possible
    #[arg(long, value_name = "X|max", default_value = "1")]
    speed: SimulationSpeed,
    /// Run in lockstep with this peer (one that the vehicle sends to, such as --gcs): every 20 ms of simulation time,
    /// the simulator sends TIMESYNC and waits for the reply. At startup, the simulation waits up to 10 s for the first
    /// reply and sends only heartbeats; after that, it runs unsynchronized until the peer replies. May be repeated
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address)]
    lockstep: Vec<SocketAddr>,
    /// Protocol of the built-in autopilot; does not affect the flight dynamics
    #[arg(long, alias = "flavour", value_name = "NAME", default_value = "px4")]
    flavor: args::Flavor,
    #[command(flatten)]
    autopilot: AutopilotArgs,
    /// Heartbeats from the camera component (100). Turn them off for simple clients that attribute every heartbeat to
    /// the vehicle (DroneKit, mavpilot); the camera still takes pictures. The SPAN_CAMERA parameter changes this
    /// setting in flight
    #[arg(long, value_name = "on|off", default_value = "on")]
    camera: AnnouncedComponents,
    /// Requests by MAVLink command to freeze, resume and rewind the flight, and to move the aircraft to a task
    /// (docs/src/reference/contract.md). Turn them off for an assessment, as train does
    #[arg(long, value_name = "on|off", default_value = "on")]
    practice_controls: PracticeControls,
    /// Action after a crash. Use `scenario` when a monitor scores the flight, as train and demo do
    #[arg(long, value_name = "RULE", default_value = "continue")]
    after_crash: AfterCrashArg,
    #[command(flatten)]
    ports: PortArgs,
    /// Number of vehicles in this process (1 to 50), side by side at the same site; they do not collide with each
    /// other. System IDs and ports increase by one per vehicle, starting at --instance and at each port that you
    /// specify
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=50), conflicts_with = "lockstep")]
    instances: u8,
    /// Number of drones that share the site (1 to 8): they start side by side at the landing pad, 1 m apart, see each other
    /// with their range finders, and collide. They have one clock, and each has its own sensor errors, failures and
    /// battery. System IDs and ports increase as with --instances. They have the built-in autopilot, and no practice
    /// controls
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=8), conflicts_with_all = ["lockstep", "instances"])]
    drones: u8,
    /// Folder to serve over MAVLink FTP. Flight logs (ULog, and MCAP for Foxglove) go to its `log` subfolder, where
    /// clients can only read and delete; files that clients upload may take up to 256 MiB. With several vehicles, each
    /// has a subfolder named by its system ID [default: no files served, no logs written]
    #[arg(long, value_name = "DIR")]
    files: Option<PathBuf>,
    /// Space for flight logs in the --files folder, in MB; the oldest logs are deleted before a flight to stay within
    /// this limit
    #[arg(long, value_name = "MB", default_value_t = 1024, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    log_space: u64,
    /// File that stores parameters between runs in QGroundControl's .params format: read at startup if it exists, and
    /// written after every change. With several vehicles, each has its own file, with the system ID appended [default:
    /// parameters are not saved]
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// File with the MAVLink signing key, readable only by its owner: 64 hexadecimal digits, or a passphrase as in
    /// MAVProxy. Messages not signed with it are ignored. Signature timestamps are stored in FILE.heard.N for system N,
    /// so old messages cannot be replayed even after a restart [default: no signing]
    #[arg(long, value_name = "FILE")]
    signing_key: Option<PathBuf>,
    /// Link type that needs no signature; may be repeated. Use it only for links that nobody else can reach
    #[arg(long, value_name = "KIND", requires = "signing_key")]
    unsigned: Vec<TrustedLink>,
    /// Stop after this simulation time in s
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    end_after: Option<SimTime>,
    /// At the end, print a digest of the state at every tick: the same scenario, seed and inputs produce the same
    /// digest
    #[arg(long)]
    digest: bool,
    /// At the end, print one line of JSON {"latest_ms", "slips", "slipped_ms"} for each vehicle: the longest tick
    /// delay, the number of delays over 250 ms (which the simulation clock skips), and the total time skipped, all in
    /// wall time
    #[arg(long)]
    lateness: bool,
    /// Print one line of JSON {"gcs_port", "payload_port", "tcp_port", "seed"} on standard output at startup
    #[arg(long)]
    announce: bool,
    /// Stop when standard input closes (for a parent process). Until then, the lines `pause` and `resume` on standard
    /// input pause and resume the simulation
    #[arg(long)]
    leash: bool,
}

impl Args {
    /// Returns the number of vehicles in this process.
    fn vehicle_count(&self) -> u8 {
        self.instances.max(self.drones)
    }
}

fn seconds(text: &str) -> Result<SimTime, String> {
    let s: f64 = text.parse().map_err(|_| format!("'{text}' is not a time in seconds"))?;
    if (0.0..=1e6).contains(&s) {
        // Simulation time advances in steps of 1 ms.
        Ok(SimTime::from_s((s / STEP.s()).round() * STEP.s()))
    } else {
        Err(format!("'{text}' is out of range (allowed: 0 to 1000000 s)"))
    }
}

/// Heartbeat setting of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum AnnouncedComponents {
    /// Send heartbeats
    On,
    /// Send no heartbeats
    Off,
}

/// Whether the flight can be frozen and rewound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum PracticeControls {
    /// Accept the requests
    On,
    /// Refuse the requests
    Off,
}

/// Action after a crash, with the names used on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum AfterCrashArg {
    /// The flight continues; the vehicle stays where it crashed
    Continue,
    /// The vehicle respawns at its last safe hover; with a real autopilot, on the landing pad
    Respawn,
    /// The flight ends
    End,
    /// Use the scenario file's rule
    Scenario,
}

impl AfterCrashArg {
    /// Returns the rule; `None` to use the scenario's rule.
    fn rule(self) -> Option<AfterCrash> {
        match self {
            Self::Continue => Some(AfterCrash::Continue),
            Self::Respawn => Some(AfterCrash::Respawn),
            Self::End => Some(AfterCrash::End),
            Self::Scenario => None,
        }
    }
}

/// Link type, with the names used on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum TrustedLink {
    /// Ground stations over UDP
    Gcs,
    /// The --sdk address
    Sdk,
    /// The monitor and other payload clients
    Payload,
    /// Ground stations over TCP
    Tcp,
    /// Serial ports
    Serial,
}

impl TrustedLink {
    fn kind(self) -> LinkKind {
        match self {
            Self::Gcs => LinkKind::GroundStation,
            Self::Sdk => LinkKind::Sdk,
            Self::Payload => LinkKind::Payload,
            Self::Tcp => LinkKind::Tcp,
            Self::Serial => LinkKind::Serial,
        }
    }
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or ports are invalid, or a lockstep peer disappears.
pub fn run(args: &Args) -> Result<(), AppError> {
    let stop = StopRequest::install(false)?;
    let still = if args.leash { PauseSwitch::listen(&stop) } else { PauseSwitch::default() };
    let scenario = Arc::new(args.job.load_scenario()?.scenario);
    let vehicle = Arc::new(files::vehicle(&args.job.vehicle)?.vehicle);
    let seed = args.job.seed_for(&scenario);
    let signing = signing(args)?;
    let temporary = args.autopilot.kind().map(|_| tempfile::tempdir()).transpose();
    let temporary = temporary.map_err(|error| AppError::failed(format!("cannot create a temporary folder: {error}")))?;
    let autopilot = autopilot_config(args, temporary.as_ref().map(tempfile::TempDir::path))?;
    let mut doors = VehicleIo::open_all(args, autopilot.as_ref())?;
    let progress = ProgressLog::start("building the site");
    let site = Arc::new(Site::build(&scenario, seed));
    let glb = args.files.is_some().then(|| files::site_model(&site)).transpose()?;
    for door in &mut doors {
        if let (Some(store), Some(glb)) = (&mut door.files.store, &glb) {
            store.set_site(glb);
        }
        door.links.bound["seed"] = seed.into();
        if args.announce {
            println!("{}", door.links.bound);
        }
        tracing::info!("{} with {}, seed {seed}, ports {}", scenario.name, vehicle.name, door.links.bound);
    }
    let places = start_places_of(args, &scenario, &site, &vehicle)?;
    let parts =
        FlightParts { args, scenario: &scenario, vehicle: &vehicle, site: &site, seed, autopilot: autopilot.as_ref(), places };
    let shell = |io: VehicleIo| {
        let mut shell = parts.shell(io, signing.clone())?;
        shell.set_pause_switch(still.clone());
        Ok(shell)
    };
    let shells = doors.into_iter().map(shell).collect::<Result<Vec<_>, AppError>>()?;
    let end = args.end_after.unwrap_or(SimTime::NEVER);
    let flown = if args.drones > 1 { fly_together(shells, end, &stop, progress)? } else { fly(shells, end, &stop, progress)? };
    print_results(args, flown);
    Ok(())
}

/// Prints the results that were asked for.
fn print_results(args: &Args, flown: Vec<VehicleResult>) {
    if args.digest && args.autopilot.kind().is_some() {
        tracing::warn!("--digest: an external autopilot is not reproducible, so the digest differs in every run");
    }
    for VehicleResult { digest, late } in flown {
        if args.digest {
            println!("{}", digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>());
        }
        if args.lateness {
            println!("{}", lateness_json(late));
        }
    }
}

/// Parts shared by all vehicles of a run.
struct FlightParts<'a> {
    args: &'a Args,
    scenario: &'a Arc<Scenario>,
    vehicle: &'a Arc<Vehicle>,
    site: &'a Arc<Site>,
    seed: u64,
    autopilot: Option<&'a AutopilotConfig>,
    /// Start places of drones that share the site, in the order of their numbers.
    places: Vec<Vec3<Enu>>,
}

impl FlightParts<'_> {
    /// Creates a vehicle, and starts its external autopilot if it has one.
    fn shell(&self, io: VehicleIo, signing: Option<SigningConfig>) -> Result<VehicleShell, AppError> {
        let VehicleIo { links, files: kept, instance, autopilot_ports } = io;
        let args = self.args;
        let config = SimConfig {
            scenario: self.scenario.clone(),
            vehicle: self.vehicle.clone(),
            seed: self.seed,
            instance,
            flavor: args.flavor.display_name(),
            after_crash: args.after_crash.rule(),
        };
        let facts = SiteFacts { scenario: self.scenario, vehicle: self.vehicle, site: self.site };
        let speed_factor = args.speed.client_speed_factor();
        let setup = self.autopilot.zip(autopilot_ports).map(|(autopilot, ports)| {
            AutopilotSetup::new(autopilot, &facts, instance, ports, speed_factor, args.vehicle_count() > 1)
        });
        let setup = setup.transpose()?;
        let site = self.site.clone();
        let mut sim = match &setup {
            Some(setup) => Sim::with_external_autopilot(config, site, setup.interface(self.vehicle)?, setup.relay_rules()),
            None => Sim::new(config, site),
        };
        if let Some(place_m) = self.places.get(usize::from(instance - args.ports.instance)) {
            sim.share_site(*place_m);
        }
        let mut shell = VehicleShell::new(sim, links, args.speed, kept, signing)?;
        if let Some(setup) = setup {
            shell.start_autopilot(setup.host()?)?;
        }
        if args.camera == AnnouncedComponents::Off {
            shell.core.mute_camera_heartbeat();
        }
        if args.practice_controls == PracticeControls::Off || args.drones > 1 {
            shell.core.forbid_freeze_and_rewind();
        }
        Ok(shell)
    }
}

/// Returns where the drones start that share the site; empty for other vehicles.
fn start_places_of(args: &Args, scenario: &Scenario, site: &Site, vehicle: &Vehicle) -> Result<Vec<Vec3<Enu>>, AppError> {
    let drones = args.drones;
    if drones == 1 {
        return Ok(Vec::new());
    }
    start_places(scenario, site, vehicle, usize::from(drones)).ok_or_else(|| {
        let (job, aircraft) = (&scenario.name, &vehicle.id);
        AppError::invalid(format!("--drones {drones}: no level ground for {drones} {aircraft} around the landing pad of {job}"))
    })
}

/// Returns the configuration of an external autopilot, whose files go to `temporary` by default.
fn autopilot_config(args: &Args, temporary: Option<&Path>) -> Result<Option<AutopilotConfig>, AppError> {
    let folder = args.autopilot.autopilot_dir.as_deref().or(temporary).unwrap_or(Path::new("."));
    let config = args.autopilot.config(folder, &args.ports)?;
    if config.is_some() && args.drones > 1 {
        return Err(AppError::invalid("--drones: the drones have the built-in autopilot (without --autopilot)"));
    }
    if config.as_ref().is_some_and(|config| config.flight_controller.is_some()) {
        check_real_time(args)?;
    }
    let conflicts = [(args.signing_key.is_some(), "--signing-key"), (args.params.is_some(), "--params")];
    if let (Some(config), Some((_, option))) = (&config, conflicts.iter().find(|(given, _)| *given)) {
        let why = format!("{option} configures the built-in autopilot; {} has its own settings", config.kind.name());
        return Err(AppError::invalid(why));
    }
    Ok(config)
}

/// Checks that nothing can stop or stretch simulation time, because a flight controller runs in real time.
fn check_real_time(args: &Args) -> Result<(), AppError> {
    let conflicts = [
        (args.speed != SimulationSpeed::Factor(1.0), format!("--speed {}: a flight controller runs in real time", args.speed)),
        (!args.lockstep.is_empty(), "--lockstep: a flight controller runs in real time".to_owned()),
        (args.instances > 1, format!("--instances {}: one flight controller flies one vehicle", args.instances)),
    ];
    match conflicts.into_iter().find(|(given, _)| *given) {
        Some((_, problem)) => Err(AppError::invalid(format!("{problem} (--autopilot px4 with --serial)"))),
        None => Ok(()),
    }
}

fn lateness_json(late: Lateness) -> serde_json::Value {
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    serde_json::json!({ "latest_ms": ms(late.longest_delay), "slips": late.slip_count, "slipped_ms": ms(late.slipped_time) })
}

/// A vehicle's final results.
struct VehicleResult {
    digest: [u8; 32],
    late: Lateness,
}

fn signing(args: &Args) -> Result<Option<SigningConfig>, AppError> {
    let listen = args.ports.listen;
    let key = args.signing_key.as_deref().map(key::read).transpose()?;
    if key.is_none() && !listen.is_loopback() {
        tracing::warn!("--listen {listen} without --signing-key: anyone who can reach this machine can fly the vehicle");
    }
    let unsigned: Vec<LinkKind> = args.unsigned.iter().map(|trusted| trusted.kind()).collect();
    if !unsigned.is_empty() && !listen.is_loopback() {
        tracing::warn!("--listen {listen} with --unsigned: anyone who can reach these ports can fly the vehicle");
    }
    Ok(key.map(|key| SigningConfig { key, unsigned }))
}

/// Network ports of a flight controller on a serial port.
const NO_PORTS: (u16, u16) = (0, 0);

/// One vehicle's links and files.
struct VehicleIo {
    links: Links,
    files: VehicleFiles,
    instance: u8,
    /// Ports of an external autopilot: its simulator interface, and the one for its MAVLink messages.
    autopilot_ports: Option<(u16, u16)>,
}

impl VehicleIo {
    fn open_all(args: &Args, autopilot: Option<&AutopilotConfig>) -> Result<Vec<Self>, AppError> {
        let flight_controller = autopilot.and_then(|config| config.flight_controller.as_ref());
        (0..args.vehicle_count()).map(|more| Self::open(args, more, flight_controller)).collect()
    }

    fn open(args: &Args, more: u8, flight_controller: Option<&SerialDevice>) -> Result<Self, AppError> {
        let mut ports = args.ports.for_vehicle(more);
        if flight_controller.is_some() {
            // Its port is not a telemetry radio.
            ports.serial.clear();
        }
        let instance = ports.instance;
        let folder =
            |root: &PathBuf| if args.vehicle_count() == 1 { root.clone() } else { root.join((instance + 1).to_string()) };
        let store =
            args.files.as_ref().map(folder).map(|folder| FileStore::open(&folder, args.log_space * 1_000_000)).transpose()?;
        let params = args
            .params
            .as_ref()
            .map(|path| if args.vehicle_count() == 1 { path.clone() } else { with_system_id(path, instance + 1) });
        let heard = args.signing_key.as_ref().map(|key| SigningStore::for_vehicle(key, instance + 1));
        let kept = VehicleFiles { store, params: params.map(ParamFile::new), signing_store: heard };
        let mut links = Links::open(&ports.resolve(), &args.lockstep)?;
        let mut open = |kind: AutopilotKind| {
            let Some(device) = flight_controller else {
                let port = args.autopilot.port(kind, instance, more, args.ports.ephemeral());
                let ports = links.serve_autopilot(kind.protocol(), port)?;
                links.bound["autopilot_port"] = ports.0.into();
                return Ok(ports);
            };
            links.serve_flight_controller(device)?;
            Ok::<_, AppError>(NO_PORTS)
        };
        let autopilot_ports = args.autopilot.kind().map(&mut open).transpose()?;
        Ok(Self { links, files: kept, instance, autopilot_ports })
    }
}

fn with_system_id(path: &Path, system_id: u8) -> PathBuf {
    let mut name = path.as_os_str().to_os_string();
    name.push(format!(".{system_id}"));
    PathBuf::from(name)
}

/// Runs every vehicle in its own thread until the end. If one vehicle fails, all vehicles stop.
fn fly(
    shells: Vec<VehicleShell>,
    end: SimTime,
    stop: &StopRequest,
    progress: ProgressLog,
) -> Result<Vec<VehicleResult>, AppError> {
    let mut progress = Some(progress);
    std::thread::scope(|scope| {
        let threads: Vec<_> = shells
            .into_iter()
            .map(|shell| {
                let progress = progress.take();
                scope.spawn(move || run_vehicle(shell, end, stop, progress))
            })
            .collect();
        let ended = threads.into_iter().map(|thread| {
            thread.join().unwrap_or_else(|_| Err(AppError::failed("a vehicle thread panicked: please report this bug")))
        });
        ended.collect::<Vec<_>>().into_iter().collect()
    })
}

/// Runs all vehicles in this thread, tick by tick, until the end.
fn fly_together(
    mut shells: Vec<VehicleShell>,
    end: SimTime,
    stop: &StopRequest,
    mut progress: ProgressLog,
) -> Result<Vec<VehicleResult>, AppError> {
    let now = |shells: &[VehicleShell]| shells.first().map_or(end, |shell| shell.core.now());
    let mut flown = Ok(());
    while flown.is_ok() && !stop.is_requested() && now(&shells) < end {
        flown = VehicleShell::run_together(&mut shells, end);
        progress.report(|| format!("simulation time {}", now(&shells)));
    }
    progress.finish();
    shells.iter_mut().for_each(VehicleShell::finish);
    flown.map(|()| shells.iter().map(|shell| VehicleResult { digest: shell.core.digest(), late: shell.lateness() }).collect())
}

fn run_vehicle(
    mut shell: VehicleShell,
    end: SimTime,
    stop: &StopRequest,
    mut progress: Option<ProgressLog>,
) -> Result<VehicleResult, AppError> {
    while !stop.is_requested() && shell.core.now() < end {
        if let Err(error) = shell.run_until(end) {
            stop.request();
            shell.finish();
            return Err(error);
        }
        if let Some(progress) = &mut progress {
            progress.report(|| format!("simulation time {}", shell.core.now()));
        }
    }
    if let Some(progress) = progress {
        progress.finish();
    }
    shell.finish();
    Ok(VehicleResult { digest: shell.core.digest(), late: shell.lateness() })
}
