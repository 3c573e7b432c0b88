//! `spandrel train`: simulator and monitor for a person's ground station.

use super::args::{self, JobArgs, TraineeId};
use super::children::Child;
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::pace::Speed;
use super::ports::PortArgs;
use super::records::Place;
use super::stop::Stop;
use super::table;
use super::web::{ListenArgs, Server, Setup, Watched};
use std::io::IsTerminal;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Between two looks at the children.
const LOOK: Duration = Duration::from_millis(50);

/// Fly a session yourself
///
/// Starts simulator and monitor, says how to connect a ground station or a script, waits for the flight, and prints the scores and the
/// session folder. Where there is a display, a window shows the inspector's view and the camera's (`spandrel view`) and flies with its keys
/// or with a calibrated controller; without, fly by your ground station's map and instruments, or by a script.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel train                                  the paper's job; QGroundControl on this machine connects by itself
  spandrel train --trainee anna --scenario drill-hover
  spandrel train --no-view                        without the window
  spandrel train --listen 0.0.0.0 --gcs 192.168.1.20:14550     a ground station on another machine

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    /// Who flies: letters, digits, '-' and '_', at most 32
    #[arg(long, value_name = "ID", default_value = "anonymous")]
    trainee: TraineeId,
    /// Folder that session folders are made in
    #[arg(long, value_name = "DIR", default_value = "sessions")]
    sessions: PathBuf,
    /// So many times real time (0.1 to 100), or max; a person flies at 1
    #[arg(long, value_name = "X|max", default_value = "1")]
    speed: Speed,
    /// Whose interface the vehicle speaks; it flies the same in all of them
    #[arg(long, value_name = "NAME", default_value = "px4")]
    flavour: args::Flavour,
    /// Web pages of this machine's sessions and of the live flight: a port of this machine, 0 for any free one, or none
    #[arg(long, value_name = "PORT|none", default_value = "0")]
    web: args::Port,
    /// Without the window
    #[arg(long)]
    no_view: bool,
    /// How much a picture in the window may cost: low, medium, high, ultra, or auto
    #[arg(long, value_name = "PRESET", default_value = "auto")]
    quality: String,
    /// Which key does what in the window (as `spandrel view --keys`)
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    #[command(flatten)]
    ports: PortArgs,
}

/// Runs the subcommand.
///
/// # Errors
/// When files or ports are wrong, a process fails, or the flight cannot be scored.
pub fn run(args: &Args, log: tracing::Level) -> Result<(), AppError> {
    // What is wrong with the files is told before anything starts.
    let scenario = files::scenario(&args.job.scenario)?.scenario;
    files::vehicle(&args.job.vehicle)?;
    let stop = Stop::install(false)?;
    let common = common(&args.job, log);
    let mut monitor = Child::start("monitor", &[common.clone(), monitor_args(args)].concat())?;
    let announced = monitor.announced()?;
    let session = PathBuf::from(announced["session"].as_str().unwrap_or_default());
    let monitor_port = announced["port"].as_u64().unwrap_or_default().to_string();
    let sim_args = [
        common,
        args.ports.to_args(),
        args.flavour.to_args(),
        vec!["--speed".into(), args.speed.to_string(), "--monitor-port".into(), monitor_port],
    ];
    let mut sim = Child::start("sim", &sim_args.concat())?;
    let ports = sim.announced()?;
    let web = pages(args, &ports);
    let mut view = view_args(args, log, &ports).and_then(|args| Window::open(&args));
    print!("{}", how_to_connect(&scenario.title, &args.ports, &ports, &session, (web.as_ref(), view.is_some())));
    let lost = wait(&mut monitor, &mut sim, view.as_mut(), &stop);
    drop(view);
    monitor.finish();
    sim.finish();
    let told = tell(&session);
    if told.is_ok() {
        println!("questions     spandrel questionnaire {}", session.display());
        linger(web.as_ref(), &session, &stop);
    }
    match lost {
        Some(error) => Err(error),
        None => told,
    }
}

/// Serves the pages of the sessions and of this flight. Without them one flies all the same.
fn pages(args: &Args, ports: &serde_json::Value) -> Option<Server> {
    let args::Port::Number(port) = args.web else { return None };
    let payload = ports["payload_port"].as_u64().and_then(|port| u16::try_from(port).ok());
    let here = if args.ports.listen.is_unspecified() { Ipv4Addr::LOCALHOST.into() } else { args.ports.listen };
    let watched = payload.map(|port| Watched { vehicle: SocketAddr::new(here, port), picture: Some(camera(args)) });
    let place = Place { sessions: vec![args.sessions.clone()], database: None };
    let setup = Setup { place, scenarios: None, watched: watched.into_iter().collect(), wordings: Vec::new() };
    match Server::start(&ListenArgs::local(port), setup) {
        Ok(server) => Some(server),
        Err(error) => {
            tracing::warn!("no web pages: {error}");
            None
        }
    }
}

/// Where the window keeps the camera's view for the live page: a place that nobody else can write to, one for each process.
fn camera(args: &Args) -> PathBuf {
    args.sessions.join(format!(".camera-{}.jpg", std::process::id()))
}

/// Keeps the pages for whoever sits at the terminal: the questionnaire comes after the flight.
fn linger(web: Option<&Server>, session: &Path, stop: &Stop) {
    let (Some(web), true, false) = (web, std::io::stdin().is_terminal(), stop.asked()) else { return };
    let id = session.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    println!("in a browser  {}/sessions/{id}/questions   (the pages stay until you press Enter)", web.address());
    let pressed = stop.clone();
    std::thread::spawn(move || {
        let mut line = String::new();
        // The end of the input ends it, too.
        let _ = std::io::stdin().read_line(&mut line);
        pressed.ask();
    });
    web.until(stop);
}

/// Arguments that all children share.
pub fn common(job: &JobArgs, log: tracing::Level) -> Vec<String> {
    let mut args = vec!["--log".to_owned(), log.to_string().to_lowercase()];
    args.extend(["--scenario", &job.scenario, "--vehicle", &job.vehicle].map(str::to_owned));
    if let Some(seed) = job.seed {
        args.extend(["--seed".to_owned(), seed.to_string()]);
    }
    args
}

/// Prints the scores of a session folder and its place.
///
/// # Errors
/// When it holds no assessment.
pub fn tell(session: &Path) -> Result<(), AppError> {
    let path = session.join(crate::monitor::folder::ASSESSMENT);
    let text = std::fs::read_to_string(&path)
        .map_err(|_| AppError::failed(format!("the session was not scored; what was recorded is in {}", session.display())))?;
    let assessment = serde_json::from_str(&text).map_err(|error| AppError::failed(format!("{}: {error}", path.display())))?;
    print!("{}", table::scores(&assessment));
    table::places(session);
    Ok(())
}

fn monitor_args(args: &Args) -> Vec<String> {
    let port = args.ports.monitor_port();
    [
        "--sessions",
        &args.sessions.display().to_string(),
        "--trainee",
        args.trainee.as_str(),
        "--port",
        &port.to_string(),
        "--instance",
        &args.ports.instance.to_string(),
    ]
    .map(str::to_owned)
    .to_vec()
}

/// Waits until the session is over, somebody interrupts, or a process ends too early.
fn wait(monitor: &mut Child, sim: &mut Child, mut view: Option<&mut Window>, stop: &Stop) -> Option<AppError> {
    loop {
        if let Some(view) = &mut view {
            view.look();
        }
        if monitor.ended().is_some() || stop.asked() {
            return None;
        }
        if let Some(status) = sim.ended() {
            return Some(AppError::failed(format!("the simulator ended early ({status})")));
        }
        std::thread::sleep(LOOK);
    }
}

/// Arguments of the window; `None` when there is to be none, or nothing that it could listen to.
fn view_args(args: &Args, log: tracing::Level, ports: &serde_json::Value) -> Option<Vec<String>> {
    if args.no_view || !cfg!(feature = "view") {
        return None;
    }
    let local = |key: &str| ports[key].as_u64().map(|port| format!("127.0.0.1:{port}"));
    let Some(payload) = local("payload_port") else {
        tracing::warn!("no window: it listens at the payload port, and --payload-port is none");
        return None;
    };
    let seed = ports["seed"].as_u64();
    let mut out = common(&JobArgs { seed, ..args.job.clone() }, log);
    out.extend(["--connect".to_owned(), payload, "--quality".to_owned(), args.quality.clone()]);
    if let Some(gcs) = local("gcs_port") {
        out.extend(["--fly".to_owned(), gcs]);
    }
    out.extend(["--picture".to_owned(), camera(args).display().to_string()]);
    if let Some(keys) = &args.keys {
        out.extend(["--keys".to_owned(), keys.display().to_string()]);
    }
    Some(out)
}

/// The window's process. The session does not depend on it.
struct Window {
    child: Child,
    over: bool,
}

impl Window {
    fn open(args: &[String]) -> Option<Self> {
        let opened = Child::start_beside("view", args, &spare_threads());
        opened.inspect_err(|error| tracing::warn!("no window: {error}")).ok().map(|child| Self { child, over: false })
    }

    /// Tells once how it ended.
    fn look(&mut self) {
        if let Some(status) = self.child.ended().filter(|_| !self.over) {
            self.over = true;
            let how = if status.success() { "the window is closed" } else { "there is no window (its message stands above)" };
            tracing::info!("{how}: the session goes on without");
        }
    }
}

/// Mesa's software driver takes every processor unless it is told otherwise; half of them are the simulator's and the monitor's.
fn spare_threads() -> [(&'static str, String); 1] {
    let all = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    [("LP_NUM_THREADS", (all / 2).max(1).to_string())]
}

fn how_to_connect(
    title: &str,
    args: &PortArgs,
    ports: &serde_json::Value,
    session: &Path,
    (web, window): (Option<&Server>, bool),
) -> String {
    let port = |key: &str| ports[key].as_u64().map_or("not opened".to_owned(), |port| port.to_string());
    let targets: Vec<String> = args.ground_stations().iter().map(ToString::to_string).collect();
    let (auto, targets) = if targets.is_empty() { ("no", "nobody".to_owned()) } else { ("yes", targets.join(", ")) };
    format!(
        "\
{title}
  QGroundControl   connects by itself: {auto} (the vehicle calls {targets})
  dial in          UDP {} or TCP {} at {}
  MAVSDK           {}
  pymavlink        udpout:127.0.0.1:{}
  session folder   {}
  web pages        {}
{}
Take off, do the tasks, land on the pad; the scores follow. Ctrl-C ends the session early.
",
        port("gcs_port"),
        port("tcp_port"),
        args.listen,
        args.sdk().map_or("nobody is called".to_owned(), |sdk| format!("udpin://0.0.0.0:{}", sdk.port())),
        port("gcs_port"),
        session.display(),
        web.map_or("none".to_owned(), |web| web.address().to_owned()),
        if window {
            "A window shows both views, says which key does what, and flies with them; a ground station or a script may fly as well."
        } else {
            "No window: fly by the ground station's map and instruments, or by a script."
        },
    )
}
