//! `spandrel serve`: records, reports, questionnaires and live flights in a browser. A table of routes defines the access rules; the pages are
//! rendered by `spandrel_training::web`, which does no I/O.

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
/// Serves everything from this machine: no page loads anything from other sites. By default only this machine can connect, without a login and with
/// full access; once the first password is set, everybody must log in. Trainees see only their own data, instructors see all data and can act in
/// flights, and administrators manage people. To accept connections from other machines, the server needs a password and TLS, either with its own
/// certificate or through a proxy.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel serve                                             http://127.0.0.1:8080, this machine only
  spandrel serve --set-password maria --role administrator   prompt for the password, store its argon2 hash, and exit
  spandrel serve --vehicle 127.0.0.1:14280 --vehicle 127.0.0.1:14281   two flights at once (instances 0 and 1)
  spandrel serve --listen 0.0.0.0:8443 --tls-cert cert.pem --tls-key key.pem --host trainer.example
  spandrel serve --listen 127.0.0.1:8080 --behind-proxy --host trainer.example    a proxy on this machine terminates TLS
  spandrel serve --listen 10.0.0.7:8080 --behind-proxy --trusted-proxy 10.0.0.2 --host trainer.example
  spandrel serve --database 'postgres://spandrel@db/training?sslmode=verify-full&sslrootcert=centre.pem' --sessions /srv/sessions

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    place: RecordsLocation,
    #[command(flatten)]
    listen: ListenArgs,
    /// Folder for uploaded scenarios [default: scenarios in the first folder of sessions]
    #[arg(long, value_name = "DIR")]
    scenarios: Option<PathBuf>,
    /// Questionnaire wording in another language, or one that replaces a shipped one; may be repeated
    ///
    /// Copy a shipped wording and change its texts. English, German and Spanish are shipped. The browser's language is selected
    /// at first, and people can change it; the first file given is used if there is no wording in their language.
    #[arg(long, value_name = "FILE")]
    wording: Vec<PathBuf>,
    /// Vehicle on the live page: address of its payload port, or none; may be repeated
    #[arg(long, value_name = "HOST:PORT|none", default_value = "127.0.0.1:14280")]
    vehicle: Vec<args::Destination>,
    /// Picture file that `spandrel view --picture FILE` writes, for the live page; may be repeated, in the order of --vehicle
    #[arg(long, value_name = "FILE")]
    picture: Vec<PathBuf>,
    /// Set this user's password (typed, or from standard input) and exit
    #[arg(long, value_name = "USER", requires = "role")]
    set_password: Option<TraineeId>,
    /// Role of the user of --set-password
    #[arg(long, value_name = "ROLE", value_parser = Role::ALL.map(Role::word), requires = "set_password")]
    role: Option<String>,
    /// Print one JSON line {"address"} on standard output at startup
    #[arg(long)]
    announce: bool,
    /// Exit when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

/// Listening address, TLS files, and proxy settings.
#[derive(Debug, Clone, clap::Args)]
pub struct ListenArgs {
    /// Address and port to listen on; port 0 for any free port
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:8080", value_parser = listen)]
    pub listen: SocketAddr,
    /// TLS certificate chain, PEM
    #[arg(long, value_name = "FILE", requires = "tls_key")]
    pub tls_cert: Option<PathBuf>,
    /// Private key of the certificate, PEM
    #[arg(long, value_name = "FILE", requires = "tls_cert")]
    pub tls_key: Option<PathBuf>,
    /// A reverse proxy terminates TLS, sets X-Forwarded-For and passes the Host header on; the server must not be reachable in
    /// any other way
    #[arg(long, conflicts_with = "tls_cert")]
    pub behind_proxy: bool,
    /// Address or network of the proxy, such as 10.0.0.2 or 10.0.0.0/24; may be repeated [default: this machine]
    #[arg(long, value_name = "ADDR[/BITS]", requires = "behind_proxy", value_parser = proxy)]
    pub trusted_proxy: Vec<IpNet>,
    /// Host name that browsers may use for the server; may be repeated. localhost and IP addresses are always accepted
    #[arg(long, value_name = "NAME", value_parser = host_name)]
    pub host: Vec<String>,
}

impl ListenArgs {
    /// Returns the settings for connections from this machine only.
    pub fn local(port: u16) -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let (trusted_proxy, host) = (Vec::new(), Vec::new());
        Self { listen, tls_cert: None, tls_key: None, behind_proxy: false, trusted_proxy, host }
    }
}

fn proxy(text: &str) -> Result<IpNet, String> {
    let network = text.parse().or_else(|_| text.parse().map(|address: IpAddr| IpNet::from(address)));
    network.map_err(|_| format!("'{text}' is not an address or network (examples: 10.0.0.2, 10.0.0.0/24, fd00::/8)"))
}

fn host_name(text: &str) -> Result<String, String> {
    let wrong = || format!("'{text}' is not a host name (allowed: letters, digits, hyphens and dots, without a port)");
    auth::is_host_name(text).then(|| text.to_owned()).ok_or_else(wrong)
}

fn listen(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_| format!("'{text}' is not ADDR:PORT (examples: 127.0.0.1:8080, 0.0.0.0:8443)"))
}

/// Runs the subcommand.
///
/// # Errors
/// If arguments, files, the port or the database are invalid.
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

/// Pairs each vehicle with its picture file.
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
