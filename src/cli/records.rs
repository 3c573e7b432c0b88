//! `spandrel records`: manages the database of sessions, trainees and answers.

use crate::cli::invocation::typed;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::progress::ProgressLog;
use crate::io::trainee_id::TraineeId;
use crate::io::{clock, files};
use crate::records::{
    Database, ImportCounts, RecordsLocation, erase_older_than, erase_trainee, find, folders_of_trainee, folders_older_than,
    import_into, lines, push, session_folders, session_id, trainee_data,
};
use spandrel_monitor::export::json_text;
use spandrel_text::Language;
use spandrel_training::record::SessionOutcome;
use spandrel_training::trainee::{AGE_BANDS, EXPERIENCE_LEVELS, Role};
use spandrel_training::xapi::DEFAULT_ACCOUNT_HOME_PAGE;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Microseconds per day.
const US_PER_DAY: u64 = 86_400_000_000;
/// Maximum retention time, days (about 100 years).
const MAX_RETENTION_DAYS: i64 = 36_525;

/// Keep sessions, trainees and answers in a database
///
/// Uses an SQLite file next to the sessions, or a PostgreSQL server (specified by URL) for a training center where many
/// stations write at the same time. The PostgreSQL password comes from PGPASSWORD or ~/.pgpass, so it does not appear
/// in process lists. The session folders remain the source of truth: `rebuild` recreates the database from them.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel records import                                   import all new or changed sessions from ./sessions
  spandrel records import --database postgres://spandrel@db/training
  spandrel records import --database 'postgres://spandrel@db/training?sslmode=verify-full&sslrootcert=center.pem'
  spandrel records list
  spandrel records trainee anna --age-band 25-34 --drone-experience none --gaming-experience some
  spandrel records export --trainee anna --out anna.json    write all of this trainee's data
  spandrel records export --out all.jsonl                   write all records, one per line, for spandrel cohort --records
  spandrel records push https://lrs.example/xapi            send xAPI statements to a learning record store
  spandrel records erase --trainee anna                     list what would be erased; add --yes to erase it, including folders
  spandrel records retention --days 730                     the same for all sessions older than two years
  spandrel records rebuild                                  rebuild the database from the folders

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    records_location: RecordsArgs,
    #[command(subcommand)]
    what: RecordsCommand,
}

/// Where the database and the session folders are.
#[derive(Debug, Clone, clap::Args)]
pub struct RecordsArgs {
    /// Folder that contains session folders; may be repeated
    #[arg(long, global = true, value_name = "DIR", default_value = "sessions")]
    pub sessions: Vec<PathBuf>,
    /// Database: a file, or postgres://USER@HOST/NAME [default: records.sqlite in the first sessions folder]
    ///
    /// For PostgreSQL, sslmode in the URL's query selects the encryption: disable; prefer (the default: TLS if the
    /// server supports it, without verifying its certificate); require (TLS, without verifying the certificate); or
    /// verify-full (a certificate for this host name from a trusted authority; recommended on a network). This
    /// machine's certificate authorities and those in sslrootcert=FILE are trusted; sslcert=FILE and sslkey=FILE set a
    /// client certificate. All files are PEM.
    #[arg(long, global = true, value_name = "FILE|URL")]
    pub database: Option<String>,
}

impl RecordsArgs {
    /// Returns the locations that the options specify.
    pub fn location(&self) -> RecordsLocation {
        RecordsLocation { sessions: self.sessions.clone(), database: self.database.clone() }
    }
}

#[derive(Debug, clap::Subcommand)]
enum RecordsCommand {
    /// Import new and changed sessions (reads all folders; specifying sessions is faster)
    Import {
        /// Session folders to import [default: all folders in --sessions]
        #[arg(value_name = "SESSION")]
        folders: Vec<PathBuf>,
    },
    /// Rebuild the database records of all sessions with folders on this machine; trainee details are kept, and erased
    /// sessions stay erased
    Rebuild {
        /// Also delete sessions without a folder on this machine (their folders may be on other stations)
        #[arg(long)]
        yes: bool,
    },
    /// List sessions
    List {
        /// List only this trainee's sessions
        #[arg(long, value_name = "ID")]
        trainee: Option<TraineeId>,
        /// Maximum number of sessions to list, newest first
        #[arg(long, value_name = "N", default_value_t = 50, conflicts_with = "json")]
        last: u32,
        /// Print all sessions as JSON, oldest first, with every stored field
        #[arg(long)]
        json: bool,
    },
    /// Write one trainee's data, or all records
    Export {
        /// Write all of this trainee's data as one JSON document [default: all records, one JSON object per line]
        #[arg(long, value_name = "ID")]
        trainee: Option<TraineeId>,
        /// Output file; '-' for standard output
        #[arg(long, value_name = "FILE", default_value = "-")]
        out: String,
    },
    /// Erase a trainee from the database and the session folders
    Erase {
        /// Trainee to erase
        #[arg(long, value_name = "ID")]
        trainee: TraineeId,
        /// Erase; without this option, only list what would be erased
        #[arg(long)]
        yes: bool,
    },
    /// Erase all sessions older than this many days from the database and the session folders
    Retention {
        /// Age in days (1 to 36525)
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(i64).range(1..=MAX_RETENTION_DAYS))]
        days: i64,
        /// Erase; without this option, only list what would be erased
        #[arg(long)]
        yes: bool,
    },
    /// Send sessions as xAPI statements to a learning record store; statements already stored are not sent again
    Push(PushArgs),
    /// Show or set a trainee's details
    Trainee(PersonArgs),
}

/// A person's details to set.
#[derive(Debug, clap::Args)]
pub struct PersonArgs {
    /// Pseudonym
    #[arg(value_name = "ID")]
    id: TraineeId,
    /// Role, which determines the person's permissions
    #[arg(long, value_name = "ROLE", value_parser = Role::ALL.map(Role::word))]
    role: Option<String>,
    /// Age range in years
    #[arg(long, value_name = "BAND", value_parser = AGE_BANDS.to_vec())]
    age_band: Option<String>,
    /// Experience with drones
    #[arg(long, value_name = "HOW", value_parser = EXPERIENCE_LEVELS.to_vec())]
    drone_experience: Option<String>,
    /// Experience with video games
    #[arg(long, value_name = "HOW", value_parser = EXPERIENCE_LEVELS.to_vec())]
    gaming_experience: Option<String>,
}

/// Destination for the xAPI statements.
#[derive(Debug, clap::Args)]
pub struct PushArgs {
    /// URL of the store's xAPI endpoint, such as https://lrs.example/xapi; the user name and password come from the
    /// environment variables SPANDREL_LRS_USER and SPANDREL_LRS_PASSWORD
    #[arg(value_name = "URL", value_parser = push::endpoint)]
    url: String,
    /// Send only this trainee's sessions
    #[arg(long, value_name = "ID")]
    trainee: Option<TraineeId>,
    /// Account home page (xAPI homePage) for the pseudonyms in the statements
    #[arg(long, value_name = "URL", default_value = DEFAULT_ACCOUNT_HOME_PAGE)]
    home: String,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if arguments, folders or the database are invalid.
pub fn run(args: &Args) -> Result<(), AppError> {
    let records_location = &args.records_location.location();
    match &args.what {
        RecordsCommand::Import { folders } => import_folders(records_location, folders),
        RecordsCommand::Rebuild { yes } => rebuild(records_location, *yes),
        RecordsCommand::List { trainee, json: true, .. } => {
            let records = records_location.open()?.records(trainee.as_ref().map(TraineeId::as_str))?;
            files::write("-", spandrel_monitor::export::json_text(&records).as_bytes())
        }
        RecordsCommand::List { trainee, last, .. } => {
            list(&records_location.open()?, trainee.as_ref().map(TraineeId::as_str), *last)
        }
        RecordsCommand::Export { trainee, out } => match trainee {
            Some(trainee) => export(records_location, trainee.as_str(), out),
            None => files::write(out, lines(&records_location.open()?.records(None)?)?.as_bytes()),
        },
        RecordsCommand::Erase { trainee, yes } => erase(records_location, trainee.as_str(), *yes),
        RecordsCommand::Retention { days, yes } => retention(records_location, days.unsigned_abs(), *yes),
        RecordsCommand::Push(args) => push_sessions(records_location, args),
        RecordsCommand::Trainee(person) => set_details(&records_location.open()?, person),
    }
}

/// Imports new and changed sessions. Logs and skips sessions that cannot be scored.
fn import_folders(records_location: &RecordsLocation, named: &[PathBuf]) -> Result<(), AppError> {
    let folders = if named.is_empty() { session_folders(&records_location.sessions)? } else { named.to_vec() };
    let database = records_location.open()?;
    let ImportCounts { changed, left_out, erased } = import_into(&database, &folders)?;
    let unchanged = folders.len() - changed - left_out - erased;
    let note = erasure_note(erased);
    println!("{}: {changed} new or changed, {unchanged} unchanged, {left_out} skipped{note}", database.name());
    if left_out + erased > 0 && !named.is_empty() {
        return Err(AppError::failed(format!("{} of the specified sessions were skipped", left_out + erased)));
    }
    Ok(())
}

fn erasure_note(erased: usize) -> String {
    if erased == 0 {
        return String::new();
    }
    format!(
        ", {erased} not imported because they or their trainees were erased (to remove their folders too, use `{}`)",
        typed("spandrel records erase")
    )
}

fn rebuild(records_location: &RecordsLocation, yes: bool) -> Result<(), AppError> {
    let folders = session_folders(&records_location.sessions)?;
    let here = folders.iter().map(|folder| session_id(folder)).collect::<Result<BTreeSet<String>, _>>()?;
    let database = records_location.open()?;
    // Sessions that other stations add after this point are not affected.
    let gone: Vec<String> = database.fingerprints()?.into_keys().filter(|id| !here.contains(id)).collect();
    if !gone.is_empty() && !yes {
        return Err(AppError::invalid(format!(
            "{}: {} sessions have no folder on this machine and would be lost (for example {}); specify all folders with --sessions, or use --yes to delete these sessions",
            database.name(),
            gone.len(),
            gone[0]
        )));
    }
    // All folders are read because no fingerprints are passed.
    let (none, erased) = (BTreeMap::new(), database.erased()?);
    let mut progress = ProgressLog::start("reading sessions");
    let mut records = Vec::new();
    let mut taken = ImportCounts::default();
    for (k, folder) in folders.iter().enumerate() {
        progress.report(|| format!("session {} of {}", k + 1, folders.len()));
        records.extend(taken.read(folder, (&none, &erased), "kept unchanged"));
    }
    progress.finish();
    let made = database.rebuild(&records, &gone)?;
    let deleted =
        if gone.is_empty() { String::new() } else { format!(", {} without a folder on this machine deleted", gone.len()) };
    println!("{}: {made} sessions, {} skipped{deleted}{}", database.name(), taken.left_out, erasure_note(taken.erased));
    Ok(())
}

fn list(database: &Database, trainee: Option<&str>, last: u32) -> Result<(), AppError> {
    let mut table = format!(
        "{:<22}{:<16}{:<22}{:>8}{:>6}  {:<12}{}\n",
        "started", "trainee", "scenario", "overall", "of", "end", "session, result"
    );
    for one in database.list(trainee, last, 0)? {
        let started = clock::utc(one.started_unix_us).0;
        let (who, job, end, id) = (&one.trainee, &one.scenario, &one.end_reason, &one.id);
        let (overall, most) = match one.is_complete() {
            true => (format!("{:.1}", one.overall), format!("{:.0}", one.overall_max)),
            false => ("-".to_owned(), "-".to_owned()),
        };
        let result = one.headlines(Language::English);
        table.push_str(&format!("{started:<22}{who:<16}{job:<22}{overall:>8}{most:>6}  {end:<12}{id}  {result}\n"));
    }
    files::write("-", table.as_bytes())
}

fn retention(records_location: &RecordsLocation, days: u64, yes: bool) -> Result<(), AppError> {
    let limit_us = clock::unix_us().saturating_sub(days.saturating_mul(US_PER_DAY));
    let database = records_location.open()?;
    let before = clock::utc(limit_us).0;
    if !yes {
        let (old, folders) = (database.older_than(limit_us)?, folders_older_than(records_location, limit_us)?);
        println!("{} sessions and {} folders are older than {before}; use --yes to erase them", old.len(), folders.len());
        return Ok(());
    }
    let (deleted, folders) = erase_older_than(&database, records_location, limit_us)?;
    println!("erased {deleted} sessions and {folders} folders older than {before}");
    Ok(())
}

/// Sets the specified details of a person, then prints all details.
///
/// # Errors
/// Returns an error if the database fails, or the person does not exist and no details were specified.
fn set_details(database: &Database, args: &PersonArgs) -> Result<(), AppError> {
    let name = args.id.as_str();
    let details = [&args.age_band, &args.drone_experience, &args.gaming_experience].map(|value| value.as_deref());
    if args.role.is_some() || details.iter().any(Option::is_some) {
        database.update_details(name, args.role.as_deref().and_then(Role::from_word), details)?;
    }
    let person = find(database, name)?;
    let person = person.ok_or_else(|| AppError::invalid(format!("{}: unknown person '{name}'", database.name())))?;
    files::write("-", json_text(&person).as_bytes())
}

/// Writes all of a trainee's data.
///
/// # Errors
/// Returns an error if there is no data, or the database or the output fails.
fn export(records_location: &RecordsLocation, trainee: &str, out: &str) -> Result<(), AppError> {
    let database = records_location.open()?;
    let kept = trainee_data(&database, records_location, trainee)?;
    let kept = kept.ok_or_else(|| AppError::invalid(format!("{}: no data about '{trainee}'", database.name())))?;
    files::write(out, json_text(&kept).as_bytes())
}

/// Erases a trainee, or lists what would be erased.
///
/// # Errors
/// Returns an error if a folder or the database cannot be changed.
fn erase(records_location: &RecordsLocation, trainee: &str, yes: bool) -> Result<(), AppError> {
    let database = records_location.open()?;
    let folders = folders_of_trainee(records_location, trainee)?;
    if !yes {
        let sessions = database.records(Some(trainee))?.len();
        let known = if find(&database, trainee)?.is_some() { "in the database" } else { "not in the database" };
        println!(
            "'{trainee}' is {known}: {sessions} sessions in {} and {} folders; use --yes to erase them",
            database.name(),
            folders.len()
        );
        return Ok(());
    }
    let (known, sessions) = erase_trainee(&database, records_location, trainee)?;
    if !known {
        return Err(AppError::invalid(format!("{}: no data about '{trainee}'", database.name())));
    }
    println!("erased '{trainee}': {sessions} sessions in {}, {} folders", database.name(), folders.len());
    Ok(())
}

fn push_sessions(records_location: &RecordsLocation, args: &PushArgs) -> Result<(), AppError> {
    let records = records_location.open()?.records(args.trainee.as_ref().map(TraineeId::as_str))?;
    let all = push::push(records_location, &records, &args.url, &args.home)?;
    println!(
        "{}: {} sessions, {} statements sent, {} already stored",
        args.url,
        records.len(),
        all.sent,
        all.already_stored_count
    );
    Ok(())
}
