//! `spandrel train`: starts a simulator and a monitor for a trainee, and a window to choose, fly and review flights.

mod flight_processes;
mod offers;
mod photographs;
mod prompt;
mod questionnaire_state;
mod train_run;
mod window;

use super::args::{self, JobArgs, TraineeId};
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::pacing::SimulationSpeed;
use super::ports::PortArgs;
use super::stop::StopRequest;
use super::table;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use train_run::TrainRun;

/// Default scenario: the one of the TASBID paper.
const USUAL: &str = "two-bridges";

/// Fly a session yourself
///
/// Starts simulator and monitor, prints how to connect a ground station or a script, waits for the flight, and prints the scores and the
/// session folder. With a display it opens a window: choose trainee and job (unless a scenario is given), check the controller, take a
/// tutorial on the first flight, fly with the keyboard or a calibrated controller in the inspector's and the camera's view, and see the
/// scores. You can pause or restart a practice. Without a display, fly with your ground station or a script.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel train                                  choose in the window (without a display: two-bridges)
  spandrel train --trainee anna --scenario drill-hover          start this flight; QGroundControl on this machine connects automatically
  spandrel train --scenario my-job.toml --choose  choose in the window, with this scenario in the list
  spandrel train --no-view                        don't open the window
  spandrel train --listen 0.0.0.0 --gcs 192.168.1.20:14550     a ground station on another machine

{EXIT_CODES}"))]
pub struct Args {
    /// Scenario: a file, or the name of a shipped one [default: chosen in the window; without a window, two-bridges]
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// Aircraft: a file, or the name of a shipped one
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    vehicle: String,
    /// Seed for everything random (defects, traffic, gusts, sensor noise), 0 to 2147483647 [default: the scenario's, else a new one]
    #[arg(long, value_name = "N", value_parser = args::seed, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Trainee: letters, digits, '-' and '_', at most 32 characters
    #[arg(long, value_name = "ID", default_value = "anonymous")]
    trainee: TraineeId,
    /// Purpose of the flight
    #[arg(long, value_name = "PURPOSE", default_value = "practice")]
    purpose: args::Purpose,
    /// Choose in the window even though a scenario is given
    #[arg(long, conflicts_with = "no_view")]
    choose: bool,
    /// Folder for session folders
    #[arg(long, value_name = "DIR", default_value = "sessions")]
    sessions: PathBuf,
    /// Simulation speed: a multiple of real time (0.1 to 100), or max; use 1 to fly by hand
    #[arg(long, value_name = "X|max", default_value = "1")]
    speed: SimulationSpeed,
    /// Autopilot protocol; the flight dynamics are the same in all of them
    #[arg(long, value_name = "NAME", default_value = "px4")]
    flavour: args::Flavour,
    /// Local port for web pages of the sessions and the live flight, 0 for any free one, or none
    #[arg(long, value_name = "PORT|none", default_value = "0")]
    web: args::PortChoice,
    /// Don't open the window
    #[arg(long)]
    no_view: bool,
    /// Quit when the session is scored instead of keeping the vehicle connected
    #[arg(long, conflicts_with = "choose")]
    once: bool,
    /// No sound in the window
    #[arg(long)]
    no_sound: bool,
    /// Graphics quality of the window: low, medium, high, ultra, or auto
    #[arg(long, value_name = "PRESET", default_value = "auto")]
    quality: String,
    /// Key bindings of the window (as `spandrel view --keys`)
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    /// Controller to fly with from the window, by part of its name or ID [default: the only one connected]
    #[arg(long, value_name = "NAME", conflicts_with = "no_view")]
    device: Option<String>,
    /// Folder of calibration profiles [default: spandrel/controllers in the user's configuration folder]
    #[arg(long, value_name = "DIR", conflicts_with = "no_view")]
    profiles: Option<PathBuf>,
    /// Stream the camera view to this address during the flight, as H.264 over RTP (as `spandrel view --stream`; QGroundControl listens on
    /// UDP 5600)
    #[arg(long, value_name = "HOST:PORT", value_parser = args::address, conflicts_with = "no_view")]
    stream: Option<SocketAddr>,
    #[command(flatten)]
    ports: PortArgs,
}

/// Runs the subcommand.
///
/// # Errors
/// If files or ports are invalid, a process fails, or the flight cannot be scored.
pub fn run(args: &Args, log: tracing::Level) -> Result<(), AppError> {
    // Errors in the files are reported before any process starts.
    files::scenario(args.scenario.as_deref().unwrap_or(USUAL))?;
    files::vehicle(&args.vehicle)?;
    super::controller::keys(args.keys.as_deref())?;
    check_quality(&args.quality)?;
    TrainRun::new(args, log, StopRequest::install(false)?).run()
}

/// Checks the name of a quality preset. Without the `view` feature, every name is accepted.
fn check_quality(name: &str) -> Result<(), AppError> {
    #[cfg(feature = "view")]
    super::view::check_quality(name)?;
    let _ = name;
    Ok(())
}

/// Returns the file to which the window saves the camera's view for the live page: in the folder of sessions, one per process, so that no one else
/// can write to it.
fn camera(args: &Args) -> PathBuf {
    args.sessions.join(format!(".camera-{}.jpg", std::process::id()))
}

/// Returns the arguments that all child processes share.
pub fn common_args(job: &JobArgs, log: tracing::Level) -> Vec<String> {
    let mut args = vec!["--log".to_owned(), log.to_string().to_lowercase()];
    args.extend(["--scenario", &job.scenario, "--vehicle", &job.vehicle].map(str::to_owned));
    if let Some(seed) = job.seed {
        args.extend(["--seed".to_owned(), seed.to_string()]);
    }
    args
}

/// Prints the scores of a session and the location of its files.
///
/// # Errors
/// If the session has no assessment.
pub fn report_outcome(session: &Path) -> Result<(), AppError> {
    let path = session.join(spandrel_monitor::folder::ASSESSMENT);
    let text = std::fs::read_to_string(&path)
        .map_err(|_| AppError::failed(format!("the session was not scored; the recorded data is in {}", session.display())))?;
    let assessment = serde_json::from_str(&text).map_err(|error| AppError::failed(format!("{}: {error}", path.display())))?;
    print!("{}", table::scores(&assessment));
    table::places(session);
    Ok(())
}

fn how_to_connect(
    title: &str,
    args: &PortArgs,
    ports: &serde_json::Value,
    session: &Path,
    (web, window): (Option<&str>, bool),
) -> String {
    let port = |key: &str| ports[key].as_u64().map_or("not opened".to_owned(), |port| port.to_string());
    let targets: Vec<String> = args.ground_stations().iter().map(ToString::to_string).collect();
    let (auto, targets) = if targets.is_empty() { ("no", "none".to_owned()) } else { ("yes", targets.join(", ")) };
    format!(
        "\
{title}
  QGroundControl   connects automatically: {auto} (the vehicle sends to {targets})
  connect to       UDP {} or TCP {} at {}
  MAVSDK           {}
  pymavlink        udpout:127.0.0.1:{}
  session folder   {}
  web pages        {}
{}
Take off, fly the tasks and land on the pad. The scores follow, and the vehicle stays connected. Ctrl-C ends the session early.
",
        port("gcs_port"),
        port("tcp_port"),
        args.listen,
        args.sdk().map_or("none".to_owned(), |sdk| format!("udpin://0.0.0.0:{}", sdk.port())),
        port("gcs_port"),
        session.display(),
        web.unwrap_or("none"),
        if window {
            "A window shows both views and the keys to fly with; you can also fly with a ground station or a script."
        } else {
            "No window: fly with the ground station's map and instruments, or with a script."
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    /// Parses arguments as on a command line.
    pub fn parsed(words: &[&str]) -> Args {
        Line::parse_from(["train"].iter().chain(words)).args
    }

    #[test]
    fn exact_a_window_is_reported_only_where_there_is_one() {
        let ports = parsed(&[]).ports;
        let told = |window| how_to_connect("Drill", &ports, &serde_json::Value::Null, Path::new("s"), (None, window));
        assert!(told(true).contains("A window shows") && !told(true).contains("No window"), "{}", told(true));
        assert!(told(false).contains("No window: fly with") && !told(false).contains("A window shows"), "{}", told(false));
    }
}
