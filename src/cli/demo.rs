//! `spandrel demo`: runs the simulator, the monitor and a synthetic trainee as three processes in lockstep, over UDP on
//! free ports.

use super::args::{self, JobArgs};
use super::autopilot_args::{AUTOPILOT_FOLDER, AutopilotArgs};
use super::pilot::SkillArgs;
use super::table;
use crate::errors::{AUTOPILOT_EXIT_CODES, AppError};
use crate::io::addresses;
use crate::io::children::{Child, early_exit};
use crate::io::clock::Stopwatch;
use crate::io::files;
use crate::io::pacing::SimulationSpeed;
use crate::io::stop::StopRequest;
use crate::io::trainee_id::TraineeId;
use std::path::PathBuf;
use std::time::Duration;

/// Interval at which the child processes are checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);
/// Wall time within which the monitor must detect the end of the session after the pilot has finished. Detection takes
/// 3 s of simulation time with the aircraft at rest.
const MONITOR_GRACE_PERIOD: Duration = Duration::from_secs(15);

/// Fly a complete session automatically
///
/// Runs the simulator, the monitor and a synthetic trainee as three processes that communicate over UDP on free ports.
/// They run in lockstep: no data is lost at any speed, and the same seed produces the same frames. At the end, prints
/// the four scores, their sum, crashes, snapshots and the session folder. Several demos can run at the same time. With
/// --autopilot, the trainee flies the same job through a real PX4 or ArduPilot; frames then differ between runs.
#[derive(Debug, clap::Args)]
#[command(after_help = AUTOPILOT_EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel demo                                         at 30 times real time
  spandrel demo --skill novice --seed 7 --speed max     as fast as possible
  spandrel demo --autopilot px4 --px4 ~/PX4-Autopilot   fly through a real PX4
  spandrel demo --view --skill expert                   watch an expert in a window
  spandrel demo --speed 1 --gcs 127.0.0.1:14550         watch it in QGroundControl

{AUTOPILOT_EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    #[command(flatten)]
    skill: SkillArgs,
    /// Trainee ID for the session: letters, digits, '-' and '_', at most 32 characters [default:
    /// synthetic-SKILL]
    #[arg(long, value_name = "ID")]
    trainee: Option<TraineeId>,
    /// Simulation speed: a multiple of real time (0.1 to 100), or max [default: 30; with --view, 1]
    #[arg(long, value_name = "X|max")]
    speed: Option<SimulationSpeed>,
    /// Watch the flight in a window
    #[arg(long)]
    view: bool,
    /// Protocol of the built-in autopilot; does not affect the flight dynamics
    #[arg(long, alias = "flavour", value_name = "NAME", default_value = "px4")]
    flavor: args::Flavor,
    #[command(flatten)]
    autopilot: AutopilotArgs,
    /// Vehicle instance (0 to 200): sets the system ID to 1 + N. Two instances of PX4 on a machine need different numbers
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=200))]
    instance: u8,
    /// Folder where the session folder is created
    #[arg(long, value_name = "DIR", default_value = "sessions")]
    sessions: PathBuf,
    /// Ground station to send telemetry to, or none; may be repeated
    #[arg(long, value_name = "HOST:PORT|none", default_value = "none")]
    gcs: Vec<addresses::Destination>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, a process fails, or the flight cannot be scored.
pub fn run(args: &Args, log: tracing::Level) -> Result<(), AppError> {
    let scenario = args.job.load_scenario()?.scenario;
    files::vehicle(&args.job.vehicle)?;
    let stop = StopRequest::install(false)?;
    let seed = args.job.seed_for(&scenario);
    let job = JobArgs { seed: Some(seed), ..args.job.clone() };
    let quiet = if log == tracing::Level::INFO { tracing::Level::WARN } else { log };
    let mut monitor = Child::start("monitor", &[args::common_args(&job, log), monitor_args(args)].concat())?;
    let announced = monitor.read_announcement()?;
    let session = PathBuf::from(announced["session"].as_str().unwrap_or_default());
    let pilot_args = [args::common_args(&job, quiet), args.skill.to_args(), vec!["--port".to_owned(), "0".to_owned()]];
    let mut pilot = Child::start("pilot", &pilot_args.concat())?;
    let pilot_port = pilot.read_announcement()?["port"].as_u64().unwrap_or_default();
    let monitor_port = announced["port"].as_u64().unwrap_or_default();
    let autopilot_folder = session.join(AUTOPILOT_FOLDER);
    let autopilot_args = args.autopilot.to_args(&autopilot_folder);
    let sim_args =
        [args::common_args(&job, quiet), args.flavor.to_args(), autopilot_args, sim_args(args, monitor_port, pilot_port)];
    let mut sim = Child::start("sim", &sim_args.concat())?;
    let ports = sim.read_announcement()?;
    let mut window = if args.view { open_window(&job, &ports, log) } else { None };
    tracing::info!("seed {seed}, {} pilot, speed {}", args.skill.name(), args.chosen_speed());
    let lost = wait_for_end(&mut monitor, &mut pilot, &mut sim, &stop);
    monitor.finish();
    sim.finish();
    pilot.finish();
    if let Some(window) = &mut window {
        window.finish();
    }
    let told = table::report_outcome(&session);
    match lost {
        Some(error) => Err(error),
        None => told,
    }
}

/// Speed without a window, as a multiple of real time: the paper's job then takes half a minute.
const FAST_SPEED: f64 = 30.0;

impl Args {
    fn chosen_speed(&self) -> SimulationSpeed {
        self.speed.unwrap_or(SimulationSpeed::Factor(if self.view { 1.0 } else { FAST_SPEED }))
    }
}

/// Opens a window that shows the flight. Without one, the flight goes on.
fn open_window(job: &JobArgs, ports: &serde_json::Value, log: tracing::Level) -> Option<Child> {
    if !cfg!(feature = "view") {
        tracing::warn!("no window: this build has no windows; use tools/run view, or build with --features view");
        return None;
    }
    let payload = format!("127.0.0.1:{}", ports["payload_port"].as_u64()?);
    let view_args = [args::common_args(job, log), vec!["--connect".to_owned(), payload]].concat();
    let opened = Child::start("view", &view_args);
    opened.inspect_err(|error| tracing::warn!("no window: {error}")).ok()
}

fn monitor_args(args: &Args) -> Vec<String> {
    let trainee = args.trainee.as_ref().map_or_else(|| format!("synthetic-{}", args.skill.name()), |id| id.as_str().to_owned());
    ["--sessions", &args.sessions.display().to_string(), "--trainee", &trainee, "--port", "0"].map(str::to_owned).to_vec()
}

fn sim_args(args: &Args, monitor_port: u64, pilot_port: u64) -> Vec<String> {
    let (monitor, pilot) = (monitor_port.to_string(), format!("127.0.0.1:{pilot_port}"));
    let speed = args.chosen_speed().to_string();
    let mut out =
        ["--ports", "ephemeral", "--speed", &speed, "--monitor-port", &monitor, "--gcs", &pilot].map(str::to_owned).to_vec();
    out.extend(["--after-crash", "scenario", "--instance"].map(str::to_owned));
    out.push(args.instance.to_string());
    out.extend(["--lockstep".to_owned(), pilot, "--lockstep".to_owned(), format!("127.0.0.1:{monitor}")]);
    for target in &args.gcs {
        if let addresses::Destination::Address(address) = target {
            out.extend(["--gcs".to_owned(), address.to_string()]);
        }
    }
    out
}

/// Waits for the end of the session. Stops waiting if the monitor does not detect the end after the pilot has finished.
/// Returns an error if a process exits too soon.
fn wait_for_end(monitor: &mut Child, pilot: &mut Child, sim: &mut Child, stop: &StopRequest) -> Option<AppError> {
    let mut pilot_done: Option<Stopwatch> = None;
    loop {
        if monitor.exit_status().is_some() || stop.is_requested() {
            return None;
        }
        if let Some(report) = pilot.try_read_line() {
            tracing::info!("pilot finished: {report}");
            pilot_done = Some(Stopwatch::start());
        }
        if pilot_done.is_some_and(|since| since.elapsed() > MONITOR_GRACE_PERIOD) {
            return None;
        }
        for (name, child) in [("simulator", &mut *sim), ("pilot", &mut *pilot)] {
            let Some(status) = child.exit_status() else { continue };
            if name == "pilot" && status.success() {
                // On a busy computer, a pilot that has finished can exit before its report arrives, and before the monitor.
                pilot_done.get_or_insert_with(Stopwatch::start);
            } else if monitor.exit_status().is_none() {
                // The monitor exits slightly before the other processes.
                return Some(early_exit(name, status));
            }
        }
        std::thread::sleep(CHECK_INTERVAL);
    }
}
