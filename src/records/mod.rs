//! `spandrel records`: database of sessions, trainees and answers. The session folders are the source of truth; the database can be rebuilt from them
//! at any time, except for the details that trainees entered.

mod accounts;
mod address;
mod database;
mod erasure;
mod erasure_marks;
mod import;
mod migrate;
mod people;
mod push;
mod sessions;
#[cfg(test)]
mod tests;
mod trainees;

pub use accounts::Account;
pub use database::Database;
pub use import::{id as session_id, is_erased, read as read_session, session_folders};
pub use people::{erase_older, erase_person, kept};

use super::args::TraineeId;
use super::clock;
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::progress::ProgressLog;
use erasure_marks::ErasureMarks;
use people::PersonArgs;
use spandrel_training::record::{SessionOutcome, SessionRecord};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Microseconds in one day.
const DAY_US: u64 = 86_400_000_000;
/// Maximum retention time, days (100 years).
const RETENTION_MAX_DAYS: i64 = 36_525;
/// Maximum number of records per database transaction, so that an interrupted import loses little work.
const PARCEL: usize = 64;

/// Keep sessions, trainees and answers in a database
///
/// Uses an SQLite file next to the sessions, or PostgreSQL by URL for a training center where many stations write at the same time. The PostgreSQL
/// password comes from PGPASSWORD or ~/.pgpass, so process lists do not show it. The session folders remain the source of truth: `rebuild` recreates
/// the database from them.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel records import                                   import all new or changed sessions of ./sessions
  spandrel records import --database postgres://spandrel@db/training
  spandrel records import --database 'postgres://spandrel@db/training?sslmode=verify-full&sslrootcert=centre.pem'
  spandrel records list
  spandrel records trainee anna --age-band 25-34 --drone-experience none --gaming-experience some
  spandrel records export --trainee anna --out anna.json    write all stored data of this trainee
  spandrel records export --out all.jsonl                   write all records, one per line, for spandrel cohort --records
  spandrel records push https://lrs.example/xapi            send xAPI statements to a learning record store
  spandrel records erase --trainee anna                     list what would be erased; --yes erases it, including folders
  spandrel records retention --days 730                     the same for everything older than two years
  spandrel records rebuild                                  rebuild the database from the folders

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    place: RecordsLocation,
    #[command(subcommand)]
    what: RecordsCommand,
}

/// Locations of the database and the session folders.
#[derive(Debug, Clone, clap::Args)]
pub struct RecordsLocation {
    /// Folder that contains session folders; may be repeated
    #[arg(long, global = true, value_name = "DIR", default_value = "sessions")]
    pub sessions: Vec<PathBuf>,
    /// Database: a file, or postgres://USER@HOST/NAME [default: records.sqlite in the first folder of sessions]
    ///
    /// For PostgreSQL, sslmode in the URL's query selects the encryption: disable; prefer (the default: TLS if the server
    /// supports it, without verifying its certificate); require (TLS, without verifying the certificate); or verify-full (a
    /// certificate for this host name from a trusted authority; recommended on a network). Trusted authorities are those of this
    /// machine and those in sslrootcert=FILE; sslcert=FILE and sslkey=FILE set a client certificate. All files are PEM.
    #[arg(long, global = true, value_name = "FILE|URL")]
    pub database: Option<String>,
}

#[derive(Debug, clap::Subcommand)]
enum RecordsCommand {
    /// Import new and changed sessions (reads all folders; faster if you name the sessions)
    Import {
        /// Session folders [default: all of --sessions]
        #[arg(value_name = "SESSION")]
        folders: Vec<PathBuf>,
    },
    /// Rebuild the sessions whose folders are on this machine; trainee details are kept, and erased sessions stay erased
    Rebuild {
        /// Also delete sessions whose folders are not on this machine (they may be on other stations)
        #[arg(long)]
        yes: bool,
    },
    /// List sessions
    List {
        /// Only this trainee's sessions
        #[arg(long, value_name = "ID")]
        trainee: Option<TraineeId>,
        /// Maximum number of sessions, newest first
        #[arg(long, value_name = "N", default_value_t = 50, conflicts_with = "json")]
        last: u32,
        /// Write all sessions as JSON, oldest first, with every stored field
        #[arg(long)]
        json: bool,
    },
    /// Write one trainee's data, or all records
    Export {
        /// All stored data of this trainee as one JSON document [default: all records, one JSON object per line]
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
    /// Erase everything older than this many days from the database and the session folders
    Retention {
        /// Age, days (1 to 36525)
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(i64).range(1..=RETENTION_MAX_DAYS))]
        days: i64,
        /// Erase; without this option, only list what would be erased
        #[arg(long)]
        yes: bool,
    },
    /// Send sessions as xAPI statements to a learning record store; statements already there are not sent twice
    Push(push::PushArgs),
    /// Show or set a trainee's details
    Trainee(PersonArgs),
}

/// Runs the subcommand.
///
/// # Errors
/// If arguments, folders or the database are invalid.
pub fn run(args: &Args) -> Result<(), AppError> {
    let place = &args.place;
    match &args.what {
        RecordsCommand::Import { folders } => import_folders(place, folders),
        RecordsCommand::Rebuild { yes } => rebuild(place, *yes),
        RecordsCommand::List { trainee, json: true, .. } => {
            let records = place.open()?.records(trainee.as_ref().map(TraineeId::as_str))?;
            files::write("-", spandrel_monitor::export::json_text(&records).as_bytes())
        }
        RecordsCommand::List { trainee, last, .. } => list(&place.open()?, trainee.as_ref().map(TraineeId::as_str), *last),
        RecordsCommand::Export { trainee, out } => match trainee {
            Some(trainee) => people::export(place, trainee.as_str(), out),
            None => files::write(out, lines(&place.open()?.records(None)?)?.as_bytes()),
        },
        RecordsCommand::Erase { trainee, yes } => people::erase(place, trainee.as_str(), *yes),
        RecordsCommand::Retention { days, yes } => retention(place, days.unsigned_abs(), *yes),
        RecordsCommand::Push(args) => push::push(place, &place.open()?, args),
        RecordsCommand::Trainee(person) => people::set(&place.open()?, person),
    }
}

impl RecordsLocation {
    /// Opens the database and completes interrupted erasures.
    ///
    /// # Errors
    /// If the database cannot be opened.
    pub fn open(&self) -> Result<Database, AppError> {
        let database = match &self.database {
            Some(target) => Database::open(target),
            None => {
                let folder = self.sessions.first().cloned().unwrap_or_else(|| PathBuf::from("sessions"));
                Database::open(&folder.join("records.sqlite").display().to_string())
            }
        }?;
        if let Err(error) = erasure::finish(&database, &self.sessions) {
            tracing::warn!("cannot finish an interrupted erasure: {error}");
        }
        Ok(database)
    }
}

/// Returns the records as JSON lines.
///
/// # Errors
/// If a record cannot be serialized as JSON (not expected in practice).
pub fn lines(records: &[SessionRecord]) -> Result<String, AppError> {
    let line = |record: &SessionRecord| serde_json::to_string(record).map(|text| text + "\n");
    records.iter().map(line).collect::<Result<String, _>>().map_err(|error| AppError::failed(error.to_string()))
}

/// Imports new and changed sessions. Logs and skips sessions that cannot be scored.
fn import_folders(place: &RecordsLocation, named: &[PathBuf]) -> Result<(), AppError> {
    let folders = if named.is_empty() { import::session_folders(&place.sessions)? } else { named.to_vec() };
    let database = place.open()?;
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
    format!(", {erased} not imported because they or their trainees were erased (records erase also removes the folders)")
}

/// Number of session folders by import result.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct ImportCounts {
    /// New or changed folders.
    changed: usize,
    /// Folders that could not be read.
    left_out: usize,
    /// Folders of erased sessions.
    erased: usize,
}

impl ImportCounts {
    /// Returns the record of a folder, or `None` if the session was erased, is unchanged in `known`, or cannot be read.
    /// `otherwise` is logged as the consequence in the last case.
    fn read(
        &mut self,
        folder: &Path,
        (known, erased): (&BTreeMap<String, String>, &ErasureMarks),
        otherwise: &str,
    ) -> Option<SessionRecord> {
        if import::is_erased(folder, erased) {
            self.erased += 1;
            return None;
        }
        import::read(folder, known).unwrap_or_else(|error| {
            self.left_out += 1;
            tracing::warn!("{otherwise}: {error}");
            None
        })
    }
}

fn import_into(database: &Database, folders: &[PathBuf]) -> Result<ImportCounts, AppError> {
    let (known, erased) = (database.fingerprints()?, database.erased()?);
    let mut taken = ImportCounts::default();
    let mut progress = ProgressLog::start("reading sessions");
    for (parcel, part) in folders.chunks(PARCEL).enumerate() {
        let mut records = Vec::new();
        for (k, folder) in part.iter().enumerate() {
            progress.report(|| format!("session {} of {}", parcel * PARCEL + k + 1, folders.len()));
            records.extend(taken.read(folder, (&known, &erased), "skipped"));
        }
        taken.changed += database.put(&records)?;
    }
    progress.end();
    Ok(taken)
}

fn rebuild(place: &RecordsLocation, yes: bool) -> Result<(), AppError> {
    let folders = import::session_folders(&place.sessions)?;
    let here = folders.iter().map(|folder| import::id(folder)).collect::<Result<BTreeSet<String>, _>>()?;
    let database = place.open()?;
    // Sessions that other stations add from now on are not affected.
    let gone: Vec<String> = database.fingerprints()?.into_keys().filter(|id| !here.contains(id)).collect();
    if !gone.is_empty() && !yes {
        return Err(AppError::wrong(format!(
            "{}: {} sessions have no folder on this machine and would be lost (for example {}); specify all folders with --sessions, or use --yes to delete them",
            database.name(),
            gone.len(),
            gone[0]
        )));
    }
    // Without known fingerprints, all folders are read.
    let (none, erased) = (BTreeMap::new(), database.erased()?);
    let mut progress = ProgressLog::start("reading sessions");
    let mut records = Vec::new();
    let mut taken = ImportCounts::default();
    for (k, folder) in folders.iter().enumerate() {
        progress.report(|| format!("session {} of {}", k + 1, folders.len()));
        records.extend(taken.read(folder, (&none, &erased), "kept unchanged"));
    }
    progress.end();
    let made = database.rebuild(&records, &gone)?;
    let deleted = if gone.is_empty() { String::new() } else { format!(", {} without a folder on this machine deleted", gone.len()) };
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
        let result = format!("{}. {}", one.completion_summary(), one.verdict());
        table.push_str(&format!("{started:<22}{who:<16}{job:<22}{overall:>8}{most:>6}  {end:<12}{id}  {result}\n"));
    }
    files::write("-", table.as_bytes())
}

fn retention(place: &RecordsLocation, days: u64, yes: bool) -> Result<(), AppError> {
    let limit_us = clock::unix_us().saturating_sub(days.saturating_mul(DAY_US));
    let database = place.open()?;
    let before = clock::utc(limit_us).0;
    if !yes {
        let (old, folders) = (database.older_than(limit_us)?, people::folders_older(place, limit_us)?);
        println!("{} sessions and {} folders are from before {before}; --yes erases them", old.len(), folders.len());
        return Ok(());
    }
    let (deleted, folders) = people::erase_older(&database, place, limit_us)?;
    println!("erased {deleted} sessions and {folders} folders from before {before}");
    Ok(())
}

/// Reads records from a JSON lines file, as written by `records export`.
///
/// # Errors
/// If the file cannot be read or a line is not a valid record.
pub fn from_lines(path: &Path) -> Result<Vec<SessionRecord>, AppError> {
    let text = files::read(path)?;
    let numbered = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let read = |(k, line): (usize, &str)| {
        let wrong = |message: String| AppError::wrong(format!("{}:{}: {message}", path.display(), k + 1));
        let record: SessionRecord = serde_json::from_str(line).map_err(|error| wrong(format!("not a valid record: {error}")))?;
        record.check().map_err(wrong)?;
        Ok(record)
    };
    numbered.map(read).collect()
}
