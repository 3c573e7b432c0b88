//! `spandrel serve`: shows records, reports, questionnaires and live flights in a browser.

use super::records::RecordsArgs;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::addresses::Destination;
use crate::io::files;
use crate::io::station_key::StationKey;
use crate::io::stop::StopRequest;
use crate::io::trainee_id::TraineeId;
use crate::records::RecordsLocation;
use crate::web::passwords::{self, HashingMemory};
use crate::web::{ListenConfig, ServerSetup, WatchedVehicle, WebServer, is_host_name};
use ipnet::IpNet;
use spandrel_text::Language;
use spandrel_training::trainee::Role;
use spandrel_training::web::login;
use std::io::{BufRead, IsTerminal};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

/// Show sessions, trainees, cohorts and live flights in a browser
///
/// Serves everything from this machine: no page loads anything from other sites. By default, only this machine can
/// connect, without a login and with full access. Once the first password is set, everyone must log in. Trainees see
/// only their own data, instructors see all data and can intervene in flights, and administrators manage people. To
/// accept connections from other machines, the server needs a password and TLS, either with its own certificate or
/// through a proxy.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel serve                                             http://127.0.0.1:8080, reachable only from this machine
  spandrel serve --set-password maria --role administrator   prompt for the password, store its argon2 hash, and exit
  spandrel serve --vehicle 127.0.0.1:14280 --vehicle 127.0.0.1:14281   two flights at once (instances 0 and 1)
  spandrel serve --listen 0.0.0.0:8443 --tls-cert cert.pem --tls-key key.pem --host trainer.example
  spandrel serve --listen 127.0.0.1:8080 --behind-proxy --host trainer.example    a proxy on this machine terminates TLS
  spandrel serve --listen 10.0.0.7:8080 --behind-proxy --trusted-proxy 10.0.0.2 --host trainer.example
  spandrel serve --database 'postgres://spandrel@db/training?sslmode=verify-full&sslrootcert=center.pem' --sessions /srv/sessions

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    records_location: RecordsArgs,
    #[command(flatten)]
    listen: ListenArgs,
    /// Folder for uploaded scenarios [default: scenarios in the first sessions folder]
    #[arg(long, value_name = "DIR")]
    scenarios: Option<PathBuf>,
    /// Questionnaire wording file for another language, or to replace a shipped wording; may be repeated
    ///
    /// Copy a shipped wording and change its texts. English, German and Spanish are shipped. The browser's language is
    /// the default, and users can change it. If no wording matches that language, the first specified file is used.
    #[arg(long, value_name = "FILE")]
    wording: Vec<PathBuf>,
    /// Address of a vehicle's payload port, for the live page, or none; may be repeated
    #[arg(long, value_name = "HOST:PORT|none", default_value = "127.0.0.1:14280")]
    vehicle: Vec<Destination>,
    /// File that `spandrel view --picture FILE` writes, for the live page; may be repeated, in the same order as
    /// --vehicle
    #[arg(long, value_name = "FILE")]
    picture: Vec<PathBuf>,
    /// File with the key of the training stations, so that instructors can start flights there (`spandrel train --server`)
    #[arg(long, value_name = "FILE")]
    station_key: Option<PathBuf>,
    /// Set this user's password (prompt for it or read it from standard input) and exit
    #[arg(long, value_name = "USER", requires = "role")]
    set_password: Option<TraineeId>,
    /// Role of the --set-password user
    #[arg(long, value_name = "ROLE", value_parser = Role::ALL.map(Role::word), requires = "set_password")]
    role: Option<String>,
    /// Print one line of JSON {"address"} on standard output at startup
    #[arg(long)]
    announce: bool,
    /// Exit when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

/// Listening address, TLS files, and proxy settings.
#[derive(Debug, Clone, clap::Args)]
struct ListenArgs {
    /// Address and port to listen on; use port 0 for any free port
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:8080", value_parser = listen)]
    listen: SocketAddr,
    /// TLS certificate chain, PEM
    #[arg(long, value_name = "FILE", requires = "tls_key")]
    tls_cert: Option<PathBuf>,
    /// The certificate's private key, PEM
    #[arg(long, value_name = "FILE", requires = "tls_cert")]
    tls_key: Option<PathBuf>,
    /// A reverse proxy terminates TLS, sets X-Forwarded-For and forwards the Host header; the server must be reachable
    /// only through the proxy
    #[arg(long, conflicts_with = "tls_cert")]
    behind_proxy: bool,
    /// The proxy's address or network, such as 10.0.0.2 or 10.0.0.0/24; may be repeated [default: this machine]
    #[arg(long, value_name = "ADDR[/BITS]", requires = "behind_proxy", value_parser = proxy)]
    trusted_proxy: Vec<IpNet>,
    /// Host name that browsers may use for the server; may be repeated. localhost and IP addresses are always accepted
    #[arg(long, value_name = "NAME", value_parser = host_name)]
    host: Vec<String>,
}

impl ListenArgs {
    fn config(&self) -> ListenConfig {
        ListenConfig {
            listen: self.listen,
            tls_cert: self.tls_cert.clone(),
            tls_key: self.tls_key.clone(),
            behind_proxy: self.behind_proxy,
            trusted_proxy: self.trusted_proxy.clone(),
            host: self.host.clone(),
        }
    }
}

fn proxy(text: &str) -> Result<IpNet, String> {
    let network = text.parse().or_else(|_| text.parse().map(|address: IpAddr| IpNet::from(address)));
    network.map_err(|_| format!("'{text}' is not an address or network (examples: 10.0.0.2, 10.0.0.0/24, fd00::/8)"))
}

fn host_name(text: &str) -> Result<String, String> {
    let wrong = || format!("'{text}' is not a host name (allowed: letters, digits, hyphens and dots, without a port)");
    is_host_name(text).then(|| text.to_owned()).ok_or_else(wrong)
}

fn listen(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_| format!("'{text}' is not ADDR:PORT (examples: 127.0.0.1:8080, 0.0.0.0:8443)"))
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if arguments, files, the port or the database are invalid.
pub fn run(args: &Args) -> Result<(), AppError> {
    if let (Some(name), Some(role)) = (&args.set_password, args.role.as_deref().and_then(Role::from_word)) {
        return set_password(&args.records_location.location(), name.as_str(), role);
    }
    let stop = StopRequest::install(args.leash)?;
    let watched = pair_vehicles_with_pictures(&args.vehicle, &args.picture)?;
    let scenarios = args.scenarios.clone();
    let (records_location, wordings) = (args.records_location.location(), args.wording.clone());
    let station_key = args.station_key.as_deref().map(StationKey::read).transpose()?;
    let setup = ServerSetup { records_location, scenarios, own_job: None, watched, wordings, station_key };
    let server = WebServer::start(&args.listen.config(), setup)?;
    if args.announce {
        files::write("-", format!("{}\n", serde_json::json!({ "address": server.address() })).as_bytes())?;
    } else {
        files::write("-", format!("web           {}\n", server.address()).as_bytes())?;
    }
    server.serve_until(&stop);
    Ok(())
}

/// Pairs each vehicle with its picture file.
fn pair_vehicles_with_pictures(vehicles: &[Destination], pictures: &[PathBuf]) -> Result<Vec<WatchedVehicle>, AppError> {
    let addresses = vehicles.iter().filter_map(|target| match target {
        Destination::None => None,
        Destination::Address(address) => Some(*address),
    });
    let addresses: Vec<SocketAddr> = addresses.collect();
    if pictures.len() > addresses.len() {
        let (many, few) = (pictures.len(), addresses.len());
        return Err(AppError::invalid(format!(
            "--picture: {many} files for {few} vehicles (allowed: at most one file for each vehicle)"
        )));
    }
    let mut pictures = pictures.iter().cloned();
    Ok(addresses.into_iter().map(|vehicle| WatchedVehicle { vehicle, picture: pictures.next() }).collect())
}

/// Prompts for a password and stores its hash.
///
/// # Errors
/// Returns an error if the password is not acceptable, or the database fails.
fn set_password(records_location: &RecordsLocation, name: &str, role: Role) -> Result<(), AppError> {
    let password = prompt_password(name)?;
    login::check(&password, name, Language::English)
        .map_err(|wrong| AppError::invalid(format!("--set-password {name}: {wrong}")))?;
    let database = records_location.open()?;
    database.set_login(name, role, &passwords::hash(&password, &mut HashingMemory::default())?)?;
    println!("{}: '{name}' can now log in as {}", database.name(), role.word());
    Ok(())
}

fn prompt_password(name: &str) -> Result<String, AppError> {
    let failed = |error: std::io::Error| AppError::failed(format!("cannot read the password: {error}"));
    if std::io::stdin().is_terminal() {
        let first = rpassword::prompt_password(format!("Password for {name}: ")).map_err(failed)?;
        let again = rpassword::prompt_password("Repeat password: ").map_err(failed)?;
        return if first == again { Ok(first) } else { Err(AppError::invalid("the passwords do not match")) };
    }
    let mut line = String::new();
    std::io::stdin().lock().read_line(&mut line).map_err(failed)?;
    Ok(line.trim_end_matches(['\r', '\n']).to_owned())
}
