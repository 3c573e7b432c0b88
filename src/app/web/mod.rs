//! `spandrel serve`: records, reports, questionnaires and live flights in a browser. One table of routes says who may do what; pages are
//! made by `crate::web`, which knows no socket.

mod answer;
mod asked;
mod assets;
mod door;
mod guard;
mod live;
mod passwords;
mod people;
mod questions;
mod routes;
mod scenarios;
mod sessions;
mod settings;
mod state;
mod taking_in;
mod tls;
mod uploads;

pub use door::Server;
pub use state::Setup;

use super::args::{self, TraineeId};
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::records::Place;
use super::stop::Stop;
use crate::training::trainee::Role;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;

/// Show sessions, trainees, cohorts and live flights in a browser
///
/// Everything is served from this machine: no page makes a request elsewhere. By default only this machine reaches the server, and whoever
/// sits at it may do everything; with the first password everybody has to log in. Trainees see only what is theirs, instructors see all and
/// act in flights, administrators manage people. Beyond this machine the server wants a password and TLS, by its own files or by a proxy.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel serve                                             http://127.0.0.1:8080, this machine only
  spandrel serve --set-password maria --role administrator   asks for the password, keeps its argon2 hash, and ends
  spandrel serve --listen 0.0.0.0:8443 --tls-cert cert.pem --tls-key key.pem
  spandrel serve --listen 127.0.0.1:8080 --behind-proxy      TLS is the proxy's business
  spandrel serve --database postgres://spandrel@db/training --sessions /srv/sessions

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    place: Place,
    #[command(flatten)]
    listen: ListenArgs,
    /// Folder of uploaded scenarios [default: scenarios in the first folder of sessions]
    #[arg(long, value_name = "DIR")]
    scenarios: Option<PathBuf>,
    /// Vehicle that the live page watches: its payload port; or none
    #[arg(long, value_name = "HOST:PORT|none", default_value = "127.0.0.1:14280")]
    vehicle: args::Target,
    /// Set this person's password (typed, or from standard input) and end
    #[arg(long, value_name = "USER", requires = "role")]
    set_password: Option<TraineeId>,
    /// What the person of --set-password may do
    #[arg(long, value_name = "ROLE", value_parser = Role::ALL.map(Role::word), requires = "set_password")]
    role: Option<String>,
    /// Print one JSON line {"address"} on standard output first
    #[arg(long)]
    announce: bool,
    /// Finish when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

/// Where the server listens, and who may reach it.
#[derive(Debug, Clone, clap::Args)]
pub struct ListenArgs {
    /// Address and port; port 0 for any free one
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:8080", value_parser = listen)]
    pub listen: SocketAddr,
    /// Certificate chain, PEM
    #[arg(long, value_name = "FILE", requires = "tls_key")]
    pub tls_cert: Option<PathBuf>,
    /// Its private key, PEM
    #[arg(long, value_name = "FILE", requires = "tls_cert")]
    pub tls_key: Option<PathBuf>,
    /// A proxy in front speaks TLS, sets X-Forwarded-For and passes the Host header on
    #[arg(long, conflicts_with = "tls_cert")]
    pub behind_proxy: bool,
}

impl ListenArgs {
    /// This machine alone.
    pub fn local(port: u16) -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        Self { listen, tls_cert: None, tls_key: None, behind_proxy: false }
    }
}

fn listen(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_| format!("'{text}' is no ADDR:PORT such as 127.0.0.1:8080 or 0.0.0.0:8443"))
}

/// Runs the subcommand.
///
/// # Errors
/// When arguments, files, the port or the database are wrong.
pub fn run(args: &Args) -> Result<(), AppError> {
    if let (Some(name), Some(role)) = (&args.set_password, args.role.as_deref().and_then(Role::from_word)) {
        return passwords::set(&args.place, name.as_str(), role);
    }
    let stop = Stop::install(args.leash)?;
    let vehicle = match args.vehicle {
        args::Target::None => None,
        args::Target::Address(address) => Some(address),
    };
    let scenarios = args.scenarios.clone();
    let server = Server::start(&args.listen, state::Setup { place: args.place.clone(), scenarios, vehicle })?;
    if args.announce {
        files::write("-", format!("{}\n", serde_json::json!({ "address": server.address() })).as_bytes())?;
    } else {
        files::write("-", format!("web           {}\n", server.address()).as_bytes())?;
    }
    server.until(&stop);
    Ok(())
}
