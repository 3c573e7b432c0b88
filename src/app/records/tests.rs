//! The same tests on SQLite and on a real PostgreSQL, which is started here as an unprivileged user in a folder of its own and listens
//! on a socket in it, so that no port is taken.

use super::database::Database;
use crate::training::questionnaire::Tlx;
use crate::training::record::Record;
use crate::training::testing::faultless;
use crate::training::trainee::{Role, Trainee};
use std::os::unix::fs::{PermissionsExt, chown};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Stations that write at once.
const STATIONS: usize = 20;
/// Sessions of each.
const EACH: usize = 8;
/// Debian's `nobody` and `nogroup`: PostgreSQL refuses to run as root.
const NOBODY: u32 = 65_534;

/// A made-up session.
fn record(trainee: &str, number: usize) -> Record {
    let mut record = faultless(trainee, number);
    record.started_unix_us = 1_700_000_000_000_000 + 1_000_000 * number as u64;
    record.scores.conformity = Some(81.25 + (number % 7) as f64 / 3.0);
    record.scores.accuracy = None;
    record.tasks[0].name = "Slab; DROP TABLE sessions --'".into();
    if let Some(answers) = &mut record.answers {
        answers.tlx.insert(Tlx::Effort, 45);
    }
    record
}

fn every_behaviour(target: &str) {
    takes_in_once_and_gives_back_the_same(target);
    keeps_people_and_erases_them(target);
    replaces_all_or_nothing(target);
    loses_nothing_when_stations_write_at_once(target);
}

fn takes_in_once_and_gives_back_the_same(target: &str) {
    let database = Database::open(target).unwrap();
    let mut bare = record("anna", 2);
    bare.scores.conformity = None;
    bare.answers = None;
    let records = [record("anna", 1), bare, record("o'brien", 1)];
    assert_eq!(database.put(&records), Ok(3));
    assert_eq!(database.put(&records), Ok(0), "taking in again changes nothing");
    assert_eq!(database.records(Some("anna")).unwrap(), records[..2]);
    assert_eq!(database.records(None).unwrap().len(), 3);
    let ids = |trainee, most, skip| -> Vec<String> {
        database.list(trainee, most, skip).unwrap().into_iter().map(|one| one.id).collect()
    };
    assert_eq!(ids(None, 10, 0), ["session-anna-002", "session-anna-001", "session-o'brien-001"], "the newest first");
    assert_eq!(ids(None, 1, 1), ["session-anna-001"]);
    assert_eq!(ids(Some("o'brien"), 10, 0), ["session-o'brien-001"]);
    assert_eq!(database.list(Some("anna"), 1, 0).unwrap()[0].overall, records[1].scores.overall);
    let mut changed = records[0].clone();
    changed.fingerprint = "other".into();
    changed.scores.safety = 94.0;
    changed.answers = None;
    assert_eq!(database.put(&[changed.clone(), records[1].clone()]), Ok(1));
    // What another process sees.
    let again = Database::open(target).unwrap();
    assert_eq!(again.records(Some("anna")).unwrap()[0], changed);
    assert_eq!(again.fingerprints().unwrap()["session-anna-001"], "other");
    let limit = 1_700_000_000_000_000 + 1_000_001;
    let old = again.older_than(limit).unwrap();
    assert_eq!(old.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>(), ["session-anna-001", "session-o'brien-001"]);
    assert_eq!(again.delete_sessions(&["session-anna-002".into(), "nobody-has-this".into()]), Ok(1));
    assert_eq!(database.records(Some("anna")).unwrap().len(), 1);
}

fn keeps_people_and_erases_them(target: &str) {
    let database = Database::open(target).unwrap();
    let someone = Trainee { age_band: Some("25-34".into()), role: Role::Instructor, ..Trainee::new("anna") };
    database.set_trainee(&someone).unwrap();
    database.put(&[record("anna", 9)]).unwrap();
    assert_eq!(database.trainees().unwrap(), [someone, Trainee::new("o'brien")], "a new session changes no details");
    assert_eq!(database.erase("anna"), Ok((true, 2)));
    assert_eq!(database.erase("anna"), Ok((false, 0)));
    assert_eq!(database.trainees().unwrap(), [Trainee::new("o'brien")]);
    assert_eq!(database.records(None).unwrap().len(), 1);
}

fn replaces_all_or_nothing(target: &str) {
    let database = Database::open(target).unwrap();
    let records = [record("ben", 1), record("ben", 2)];
    assert_eq!(database.replace_all(&records), Ok(2));
    assert_eq!(database.records(None).unwrap(), records);
    // One bad record makes the whole change fail; what was there stays.
    let mut broken = record("ben", 3);
    broken.seconds = f64::NAN;
    assert!(database.replace_all(&[record("ben", 4), broken.clone()]).unwrap_err().to_string().contains("seconds = NaN"));
    assert!(database.put(&[record("ben", 4), broken]).is_err());
    assert_eq!(database.records(None).unwrap(), records);
    assert_eq!(database.replace_all(&[]), Ok(0));
}

fn loses_nothing_when_stations_write_at_once(target: &str) {
    let stations: Vec<_> = (0..STATIONS)
        .map(|station| {
            let target = target.to_owned();
            std::thread::spawn(move || {
                let database = Database::open(&target).unwrap();
                // Two stations each know the same trainee and take in the same shared session.
                let trainee = format!("t{}", station / 2);
                for number in 0..EACH {
                    database.put(&[record(&trainee, station * EACH + number), record("shared", 0)]).unwrap();
                }
            })
        })
        .collect();
    for station in stations {
        station.join().unwrap();
    }
    let database = Database::open(target).unwrap();
    assert_eq!(database.records(None).unwrap().len(), STATIONS * EACH + 1);
    assert_eq!(database.trainees().unwrap().iter().filter(|person| person.pseudonym.starts_with('t')).count(), STATIONS / 2);
}

#[test]
fn exact_records_live_in_sqlite() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a place with 100 % odd #names?").join("records.sqlite");
    every_behaviour(&file.display().to_string());
    assert!(file.is_file());
}

#[test]
fn exact_twenty_stations_may_make_the_same_new_file_at_once() {
    let folder = tempfile::tempdir().unwrap();
    loses_nothing_when_stations_write_at_once(&folder.path().join("new.sqlite").display().to_string());
}

#[test]
fn exact_readers_do_not_wait_for_a_writer() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("records.sqlite").display().to_string();
    let writer = Database::open(&file).unwrap();
    writer.put(&[record("anna", 1)]).unwrap();
    writer.keep_writing().unwrap();
    let reader = Database::open(&file).unwrap();
    assert_eq!(reader.records(None).unwrap().len(), 1);
    assert_eq!(reader.list(None, 10, 0).unwrap().len(), 1);
}

#[test]
fn exact_what_is_erased_is_gone_from_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("records.sqlite");
    let database = Database::open(&file.display().to_string()).unwrap();
    database.put(&[record("somebody-special", 1), record("other", 1)]).unwrap();
    database.erase("somebody-special").unwrap();
    let traces = |path: PathBuf| std::fs::read(path).unwrap().windows(16).any(|bytes| bytes == b"somebody-special");
    let found: Vec<PathBuf> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!found.into_iter().any(traces));
}

#[test]
fn exact_a_database_of_a_newer_version_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("records.sqlite").display().to_string();
    Database::open(&file).unwrap().pretend_version(99).unwrap();
    let error = Database::open(&file).unwrap_err().to_string();
    assert!(error.contains("version 99") && error.contains("newer"), "{error}");
}

#[test]
fn exact_no_message_shows_a_password() {
    let error = Database::open("postgres://spandrel:secret@127.0.0.1:1/none?password=secret").unwrap_err().to_string();
    assert!(error.contains("postgres://spandrel@127.0.0.1:1/none") && !error.contains("secret"), "{error}");
}

/// A PostgreSQL of our own.
struct Server {
    process: Child,
    folder: tempfile::TempDir,
}

impl Server {
    fn start() -> Self {
        let programs = programs();
        let folder = tempfile::tempdir().unwrap();
        std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).unwrap();
        let (home, data) = (folder.path().join("run"), folder.path().join("run/data"));
        std::fs::create_dir(&home).unwrap();
        if is_root() {
            chown(&home, Some(NOBODY), Some(NOBODY)).unwrap();
        }
        let at = |path: &Path| path.display().to_string();
        let made = unprivileged(&programs.join("initdb"))
            .args(["-D", &at(&data), "-U", "spandrel", "-A", "trust", "-E", "UTF8", "--no-locale", "--no-sync"])
            .current_dir(&home)
            .output()
            .unwrap();
        assert!(made.status.success(), "initdb: {}", String::from_utf8_lossy(&made.stderr));
        let log = std::fs::File::create(folder.path().join("log.txt")).unwrap();
        let process = unprivileged(&programs.join("postgres"))
            .args(["-D", &at(&data), "-k", &at(&home), "-c", "listen_addresses=", "-c", "fsync=off", "-c", "max_connections=60"])
            .current_dir(&home)
            .stdout(Stdio::null())
            .stderr(log)
            .spawn()
            .unwrap();
        let server = Self { process, folder };
        // pg_isready asks the server itself and waits for its answer.
        let ready = || Command::new(programs.join("pg_isready")).args(["-h", &at(&home), "-t", "1"]).output().unwrap().status;
        while !ready().success() {
            std::thread::yield_now();
        }
        server
    }

    fn url(&self) -> String {
        format!("postgres://spandrel@localhost/postgres?host={}", self.folder.path().join("run").display())
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // PostgreSQL ends its children before itself when its own program asks; killed, it would leave them.
        let data = self.folder.path().join("run/data").display().to_string();
        let stopped =
            unprivileged(&programs().join("pg_ctl")).args(["stop", "-D", &data, "-m", "fast", "-s"]).current_dir("/").status();
        if !stopped.is_ok_and(|status| status.success()) {
            let _ = self.process.kill();
        }
        let _ = self.process.wait();
    }
}

/// Where Debian, or the path, has PostgreSQL's programs.
fn programs() -> PathBuf {
    let versions = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> =
        versions.map(|entry| entry.path().join("bin")).filter(|bin| bin.join("postgres").is_file()).collect();
    found.sort();
    let path = std::env::var_os("PATH").unwrap_or_default();
    found.extend(std::env::split_paths(&path).filter(|bin| bin.join("initdb").is_file()));
    found.into_iter().next().expect("PostgreSQL is not installed; tools/test installs it (Debian: apt-get install postgresql)")
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|told| told.stdout == b"0\n")
}

fn unprivileged(program: &Path) -> Command {
    if !is_root() {
        return Command::new(program);
    }
    let mut command = Command::new("setpriv");
    command.args(["--reuid", &NOBODY.to_string(), "--regid", &NOBODY.to_string(), "--clear-groups", "--"]).arg(program);
    command
}

#[test]
fn val_records_live_in_postgresql() {
    let server = Server::start();
    every_behaviour(&server.url());
}
