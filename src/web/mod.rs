//! `spandrel serve`: records, reports, questionnaires and live flights in a browser. One table of routes says who may do what; pages are
//! made by `spandrel_training::web`, which knows no socket.

mod assets;
mod auth;
mod body;
mod figures;
mod hashing;
mod live;
mod passwords;
mod questions;
mod request;
mod request_pipeline;
mod response;
mod routes;
mod scenarios;
mod server;
mod session_importer;
mod sessions;
mod settings;
mod spool;
mod state;
mod temp_files;
mod tls;
mod trainees;
mod uploads;

pub use live::WatchedVehicle;
pub use server::WebServer;
pub use state::ServerSetup;

use super::args::{self, TraineeId};
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::records::RecordsLocation;
use super::stop::StopRequest;
use ipnet::IpNet;
use spandrel_training::trainee::Role;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
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
  spandrel serve --vehicle 127.0.0.1:14280 --vehicle 127.0.0.1:14281   two flights at once (instances 0 and 1)
  spandrel serve --listen 0.0.0.0:8443 --tls-cert cert.pem --tls-key key.pem --host trainer.example
  spandrel serve --listen 127.0.0.1:8080 --behind-proxy --host trainer.example    a proxy on this machine speaks TLS
  spandrel serve --listen 10.0.0.7:8080 --behind-proxy --trusted-proxy 10.0.0.2 --host trainer.example
  spandrel serve --database 'postgres://spandrel@db/training?sslmode=verify-full&sslrootcert=centre.pem' --sessions /srv/sessions

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    place: RecordsLocation,
    #[command(flatten)]
    listen: ListenArgs,
    /// Folder of uploaded scenarios [default: scenarios in the first folder of sessions]
    #[arg(long, value_name = "DIR")]
    scenarios: Option<PathBuf>,
    /// Wording of the questionnaire in a language of your own, or instead of a shipped one; may be repeated
    ///
    /// A copy of a shipped wording with other texts. English, German and Spanish are shipped; people choose, at first their browser does;
    /// the first file named is what those get whose language is not there.
    #[arg(long, value_name = "FILE")]
    wording: Vec<PathBuf>,
    /// Vehicle that the live page watches: its payload port; or none; may be repeated
    #[arg(long, value_name = "HOST:PORT|none", default_value = "127.0.0.1:14280")]
    vehicle: Vec<args::Destination>,
    /// Where `spandrel view --picture FILE` keeps the camera's view, for the live page; may be repeated in the order of --vehicle
    #[arg(long, value_name = "FILE")]
    picture: Vec<PathBuf>,
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
    /// A proxy in front speaks TLS, sets X-Forwarded-For and passes the Host header on; nobody else reaches the server
    #[arg(long, conflicts_with = "tls_cert")]
    pub behind_proxy: bool,
    /// Address or network of that proxy, such as 10.0.0.2 or 10.0.0.0/24; may be repeated [default: this machine]
    #[arg(long, value_name = "ADDR[/BITS]", requires = "behind_proxy", value_parser = proxy)]
    pub trusted_proxy: Vec<IpNet>,
    /// Name by which browsers reach the server; may be repeated. localhost and addresses always work
    #[arg(long, value_name = "NAME", value_parser = host_name)]
    pub host: Vec<String>,
}

impl ListenArgs {
    /// This machine alone.
    pub fn local(port: u16) -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let (trusted_proxy, host) = (Vec::new(), Vec::new());
        Self { listen, tls_cert: None, tls_key: None, behind_proxy: false, trusted_proxy, host }
    }
}

fn proxy(text: &str) -> Result<IpNet, String> {
    let network = text.parse().or_else(|_| text.parse().map(|address: IpAddr| IpNet::from(address)));
    network.map_err(|_| format!("'{text}' is no address or network (allowed: such as 10.0.0.2, 10.0.0.0/24 or fd00::/8)"))
}

fn host_name(text: &str) -> Result<String, String> {
    let wrong = || format!("'{text}' is no host name (allowed: letters, digits, hyphens and dots, without a port)");
    auth::is_host_name(text).then(|| text.to_owned()).ok_or_else(wrong)
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
    let stop = StopRequest::install(args.leash)?;
    let watched = watched(&args.vehicle, &args.picture)?;
    let scenarios = args.scenarios.clone();
    let (place, wordings) = (args.place.clone(), args.wording.clone());
    let server = WebServer::start(&args.listen, state::ServerSetup { place, scenarios, watched, wordings })?;
    if args.announce {
        files::write("-", format!("{}\n", serde_json::json!({ "address": server.address() })).as_bytes())?;
    } else {
        files::write("-", format!("web           {}\n", server.address()).as_bytes())?;
    }
    server.serve_until(&stop);
    Ok(())
}

/// Each vehicle with its picture.
fn watched(vehicles: &[args::Destination], pictures: &[PathBuf]) -> Result<Vec<WatchedVehicle>, AppError> {
    let addresses = vehicles.iter().filter_map(|target| match target {
        args::Destination::None => None,
        args::Destination::Address(address) => Some(*address),
    });
    let addresses: Vec<SocketAddr> = addresses.collect();
    if pictures.len() > addresses.len() {
        let (many, few) = (pictures.len(), addresses.len());
        return Err(AppError::wrong(format!(
            "--picture: {many} files for {few} vehicles (allowed: at most one for each --vehicle)"
        )));
    }
    let mut pictures = pictures.iter().cloned();
    Ok(addresses.into_iter().map(|vehicle| WatchedVehicle { vehicle, picture: pictures.next() }).collect())
}
