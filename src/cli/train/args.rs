//! Command line of `spandrel train`.

use crate::cli::args::{self, JobArgs};
use crate::cli::autopilot_args::AutopilotArgs;
use crate::cli::ports::PortArgs;
use crate::errors::AUTOPILOT_EXIT_CODES;
use crate::io::addresses;
use crate::io::files;
use crate::io::pacing::SimulationSpeed;
use crate::io::trainee_id::TraineeId;
use spandrel_view::flow::pipe::FlightChoice;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Default scenario, which comes from the TASBID paper.
const DEFAULT_SCENARIO: &str = "two-bridges";

/// Fly a session yourself
///
/// Starts the simulator and the monitor, prints how to connect a ground station or a script, waits for the flight, and
/// prints the scores and the session folder. With a display, it opens a window where you choose the trainee and job,
/// check the controller, take a tutorial on your first flight, read the briefing and confirm its site check, fly with the
/// keyboard or a calibrated controller using the inspector's and the camera's views, and see the scores. If you specify
/// a scenario, the window begins with its briefing. You can pause or restart a practice flight. Without a display, it
/// prints the briefing; at a terminal, the flight starts when you confirm the site check, otherwise at once. Fly with your
/// ground station or a script.
#[derive(Debug, clap::Args)]
#[command(after_help = AUTOPILOT_EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel train                                  choose in the window (without a display: two-bridges)
  spandrel train --trainee anna --scenario drill-hover          brief and start this flight; QGroundControl on this machine connects automatically
  spandrel train --scenario my-job.toml --choose  choose in the window, with this scenario in the list
  spandrel train --autopilot px4 --px4 ~/PX4-Autopilot          fly a real PX4 at the same site
  spandrel train --no-view                        don't open the window
  spandrel train --listen 0.0.0.0 --gcs 192.168.1.20:14550     connect to a ground station on another machine

{AUTOPILOT_EXIT_CODES}"))]
pub struct Args {
    /// Scenario file, or the name of a shipped scenario [default: chosen in the window; without a window, two-bridges]
    #[arg(long, value_name = "FILE|NAME")]
    pub scenario: Option<String>,
    /// Form of the scenario, if it has forms: one of several sets of defects (`spandrel check` lists them) [default: the first]
    #[arg(long, value_name = "NAME", requires = "scenario")]
    pub form: Option<String>,
    /// Difficulty level of the scenario, if it has levels: 1 is the easiest (`spandrel check` lists them) [default: the standard
    /// level]
    #[arg(long, value_name = "N", requires = "scenario", conflicts_with = "form")]
    pub level: Option<u8>,
    /// Aircraft file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    pub vehicle: String,
    /// Random seed (0 to 2147483647) for defects, traffic, gusts and sensor noise [default: the scenario's seed, or a
    /// new one]
    #[arg(long, value_name = "N", value_parser = args::parse_seed, allow_negative_numbers = true)]
    pub seed: Option<u64>,
    /// Trainee ID: letters, digits, '-' and '_', at most 32 characters
    #[arg(long, value_name = "ID", default_value = "anonymous")]
    pub trainee: TraineeId,
    /// Purpose of the flight
    #[arg(long, value_name = "PURPOSE", default_value = "practice")]
    pub purpose: args::Purpose,
    /// Choose in the window even if a scenario is specified
    #[arg(long, conflicts_with = "no_view")]
    pub choose: bool,
    /// Folder where session folders are created
    #[arg(long, value_name = "DIR", default_value = "sessions")]
    pub sessions: PathBuf,
    /// Simulation speed: a multiple of real time (0.1 to 100), or max; use 1 to fly by hand
    #[arg(long, value_name = "X|max", default_value = "1")]
    pub speed: SimulationSpeed,
    /// Protocol of the built-in autopilot; does not affect the flight dynamics
    #[arg(long, alias = "flavour", value_name = "NAME", default_value = "px4")]
    pub flavor: args::Flavor,
    #[command(flatten)]
    pub autopilot: AutopilotArgs,
    /// Local port for the web pages about the sessions and the live flight, 0 for any free port, or none
    #[arg(long, value_name = "PORT|none", default_value = "0")]
    pub web: addresses::PortChoice,
    /// Do not open the window
    #[arg(long)]
    pub no_view: bool,
    /// Quit when the session is scored instead of keeping the vehicle connected
    #[arg(long, conflicts_with = "choose")]
    pub once: bool,
    /// Render a video of the camera's view after each flight, for the report: on, off, or auto (only with a graphics card)
    #[arg(long, value_name = "MODE", default_value = "auto", conflicts_with = "no_view")]
    pub video: VideoMode,
    /// Show the inspector's view in a second window as well, on a second display if there is one
    #[arg(long, conflicts_with = "no_view")]
    pub second_screen: bool,
    /// Disable sound in the window
    #[arg(long)]
    pub no_sound: bool,
    /// Graphics quality of the window: low, medium, high, ultra, or auto [default: as in the window's settings]
    #[arg(long, value_name = "PRESET")]
    pub quality: Option<String>,
    /// Key bindings for the window (same format as `spandrel view --keys`) [default: the keys in the window's settings]
    #[arg(long, value_name = "FILE")]
    pub keys: Option<PathBuf>,
    /// Controller for flying in the window: its ID or part of its name [default: the only connected controller]
    #[arg(long, value_name = "NAME", conflicts_with = "no_view")]
    pub device: Option<String>,
    /// Folder for calibration profiles [default: spandrel/controllers in the user's configuration folder]
    #[arg(long, value_name = "DIR", conflicts_with = "no_view")]
    pub profiles: Option<PathBuf>,
    /// Stream the camera view to this address during the flight, as H.264 over RTP (like `spandrel view --stream`;
    /// QGroundControl listens on UDP 5600)
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address, conflicts_with = "no_view")]
    pub stream: Option<SocketAddr>,
    /// Web server (`spandrel serve`) on which instructors start flights at this station, such as http://10.0.0.5:8080
    #[arg(long, value_name = "URL", value_parser = server_url, requires_all = ["station", "station_key"])]
    pub server: Option<String>,
    /// Certificate of the authority that signed the server's certificate, PEM [default: the public authorities]
    #[arg(long, value_name = "FILE", requires = "server")]
    pub server_ca: Option<PathBuf>,
    /// Name of this station on the server
    #[arg(long, value_name = "NAME", requires = "server")]
    pub station: Option<TraineeId>,
    /// File with the key that the server expects from its stations
    #[arg(long, value_name = "FILE", requires = "server")]
    pub station_key: Option<PathBuf>,
    #[command(flatten)]
    pub ports: PortArgs,
}

fn server_url(text: &str) -> Result<String, String> {
    let rest = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://")).unwrap_or_default();
    let wrong = rest.is_empty() || rest.starts_with('/') || text.contains(['?', '#', ' ', '@']);
    if wrong {
        Err(format!("'{text}' is not the address of a server (example: http://10.0.0.5:8080)"))
    } else {
        Ok(text.to_owned())
    }
}

/// When to render a video after a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum VideoMode {
    /// After every flight. Without a graphics card, rendering takes minutes and runs at low priority.
    On,
    /// Never.
    Off,
    /// Only with a graphics card.
    Auto,
}

impl Args {
    /// Returns the requested scenario with its form or level, as one argument, or the default.
    pub fn scenario_argument(&self) -> String {
        files::with_variant(self.scenario.as_deref().unwrap_or(DEFAULT_SCENARIO), self.form.as_deref(), self.level)
    }

    /// Returns a chosen flight's job with the requested seed. Its scenario includes the form or the level.
    pub fn job(&self, choice: &FlightChoice) -> JobArgs {
        let (scenario, vehicle) = (choice.scenario.clone(), choice.vehicle.clone());
        JobArgs { scenario, form: None, level: None, vehicle, seed: self.seed }
    }
}

/// Returns the file to which the window saves the camera's view for the live page. Each process has its own file in the
/// sessions folder, where other users cannot write.
pub fn camera_file(args: &Args) -> PathBuf {
    args.sessions.join(format!(".camera-{}.jpg", std::process::id()))
}

/// Parses a command line.
#[cfg(test)]
pub fn parse_args(words: &[&str]) -> Args {
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct TestArgs {
        #[command(flatten)]
        args: Args,
    }
    TestArgs::parse_from(["train"].iter().chain(words)).args
}
