//! Database tests, which run on SQLite and on a real PostgreSQL server.

mod changes;
mod classes;
mod server;
mod sign_offs;
mod tls;

use super::database::Database;
use server::PostgresServer;
use spandrel_training::questionnaire::TlxScale;
use spandrel_training::record::SessionRecord;
use spandrel_training::testing::perfect_record;
use spandrel_training::trainee::{Role, Trainee};
use std::path::PathBuf;

/// Number of stations that write at the same time.
const STATION_COUNT: usize = 20;
/// Number of sessions that each station writes.
const SESSIONS_PER_STATION: usize = 8;

/// Returns a made-up session record.
fn record(trainee: &str, number: usize) -> SessionRecord {
    let mut record = perfect_record(trainee, number);
    record.started_unix_us = 1_700_000_000_000_000 + 1_000_000 * number as u64;
    record.scores.conformity = Some(81.25 + (number % 7) as f64 / 3.0);
    record.scores.accuracy = None;
    record.tasks[0].name = "Slab; DROP TABLE sessions --'".into();
    if let Some(answers) = &mut record.answers {
        answers.tlx.insert(TlxScale::Effort, 45);
    }
    record
}

fn run_all_tests(target: &str) {
    import_is_idempotent_and_round_trips(target);
    people_are_stored_and_erased(target);
    logins_are_stored_and_erased(target);
    sessions_are_counted_and_found(target);
    rebuild_is_atomic(target);
    changes::run_all(target);
    classes::run_all(target);
    sign_offs::run_all(target);
    opposite_import_orders_do_not_deadlock(target);
    concurrent_imports_lose_nothing(target);
}

fn import_is_idempotent_and_round_trips(target: &str) {
    let database = Database::open(target).unwrap();
    let mut bare = record("anna", 2);
    bare.scores.conformity = None;
    bare.answers = None;
    let records = [record("anna", 1), bare, record("o'brien", 1)];
    assert_eq!(database.put(&records), Ok(3));
    assert_eq!(database.put(&records), Ok(0), "a second import changes nothing");
    assert_eq!(database.records(Some("anna")).unwrap(), records[..2]);
    assert_eq!(database.records(None).unwrap().len(), 3);
    let ids = |trainee, most, skip| -> Vec<String> {
        database.list(trainee, most, skip).unwrap().into_iter().map(|one| one.id).collect()
    };
    assert_eq!(ids(None, 10, 0), ["session-anna-002", "session-anna-001", "session-o'brien-001"], "newest first");
    assert_eq!(ids(None, 1, 1), ["session-anna-001"]);
    assert_eq!(ids(Some("o'brien"), 10, 0), ["session-o'brien-001"]);
    assert_eq!(database.list(Some("anna"), 1, 0).unwrap()[0].overall, records[1].scores.overall);
    let mut changed = records[0].clone();
    changed.fingerprint = "other".into();
    changed.scores.safety = 94.0;
    changed.answers = None;
    assert_eq!(database.put(&[changed.clone(), records[1].clone()]), Ok(1));
    // Another process sees the same data.
    let again = Database::open(target).unwrap();
    assert_eq!(again.records(Some("anna")).unwrap()[0], changed);
    assert_eq!(again.fingerprints().unwrap()["session-anna-001"], "other");
    let limit = 1_700_000_000_000_000 + 1_000_001;
    let old = again.older_than(limit).unwrap();
    assert_eq!(old.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>(), ["session-anna-001", "session-o'brien-001"]);
    assert_eq!(again.delete_sessions(&["session-anna-002".into(), "nobody-has-this".into()], &[]), Ok(1));
    assert_eq!(database.records(Some("anna")).unwrap().len(), 1);
}

fn people_are_stored_and_erased(target: &str) {
    let database = Database::open(target).unwrap();
    let someone = Trainee { age_band: Some("25-34".into()), role: Role::Instructor, ..Trainee::new("anna") };
    database.update_details("anna", Some(Role::Instructor), [Some("25-34"), None, None]).unwrap();
    database.put(&[record("anna", 9)]).unwrap();
    assert_eq!(database.trainees().unwrap(), [someone, Trainee::new("o'brien")], "a new session changes no details");
    assert_eq!(database.erase("anna", &[]), Ok((true, 2)));
    assert_eq!(database.erase("anna", &[]), Ok((false, 0)));
    assert_eq!(database.trainees().unwrap(), [Trainee::new("o'brien")]);
    assert_eq!(database.records(None).unwrap().len(), 1);
}

fn logins_are_stored_and_erased(target: &str) {
    let database = Database::open(target).unwrap();
    assert_eq!(database.account("nobody").unwrap(), None);
    let ada = Trainee { role: Role::Administrator, ..Trainee::new("ada") };
    database.set_login("ada", Role::Instructor, "first").unwrap();
    database.set_login("ada", Role::Administrator, "second").unwrap();
    database.set_login("o'brien", Role::Trainee, "'; DELETE FROM passwords; --").unwrap();
    // Another process sees the same data.
    let again = Database::open(target).unwrap();
    assert_eq!(again.names_with_password().unwrap(), ["ada", "o'brien"]);
    let account = again.account("ada").unwrap().unwrap();
    assert_eq!((account.person, account.hash.as_deref()), (ada, Some("second")));
    assert_eq!(again.remove_password("ada"), Ok(true));
    assert_eq!(again.remove_password("ada"), Ok(false));
    assert_eq!(database.account("ada").unwrap().unwrap().hash, None, "the person still exists but can no longer log in");
    // An erased person can no longer log in, even if someone adds the same name again.
    assert_eq!(database.erase("o'brien", &[]), Ok((true, 1)));
    assert_eq!((database.names_with_password().unwrap(), database.account("o'brien").unwrap()), (vec![], None));
    database.update_details("o'brien", None, [None; 3]).unwrap();
    assert_eq!(database.account("o'brien").unwrap().unwrap().hash, None);
    assert_eq!((database.erase("o'brien", &[]), database.erase("ada", &[])), (Ok((true, 0)), Ok((true, 0))));
}

fn sessions_are_counted_and_found(target: &str) {
    let database = Database::open(target).unwrap();
    let assessed = SessionRecord { purpose: Some("assessment".into()), ..record("dan", 3) };
    database.put(&[record("cleo", 1), record("cleo", 2), assessed.clone()]).unwrap();
    let listed = database.list(None, 10, 0).unwrap();
    assert_eq!(listed.iter().map(|one| one.purpose.as_deref()).collect::<Vec<_>>(), [Some("assessment"), None, None]);
    assert_eq!(database.record("session-dan-003").unwrap(), Some(assessed));
    let counts = [None, Some("cleo"), Some("dan"), Some("nobody"), Some("' OR 1 = 1 --")].map(|who| database.count(who).unwrap());
    assert_eq!(counts, [3, 2, 1, 0, 0]);
    assert_eq!(database.record("session-cleo-002").unwrap(), Some(record("cleo", 2)));
    assert_eq!(database.record("session-cleo-003").unwrap(), None);
    assert_eq!(database.erase("cleo", &[]), Ok((true, 2)));
    assert_eq!((database.count(None), database.record("session-cleo-002")), (Ok(1), Ok(None)));
}

/// Two stations that add the same new trainees in opposite orders do not deadlock.
fn opposite_import_orders_do_not_deadlock(target: &str) {
    let people: Vec<SessionRecord> = (0..STATION_COUNT).map(|k| record(&format!("new{k}"), k)).collect();
    let backwards: Vec<SessionRecord> = people.iter().rev().cloned().collect();
    std::thread::scope(|scope| {
        for order in [&people, &backwards] {
            scope.spawn(|| {
                let database = Database::open(target).unwrap();
                for _ in 0..SESSIONS_PER_STATION {
                    database.put(order).unwrap();
                }
            });
        }
    });
    let database = Database::open(target).unwrap();
    assert_eq!(
        people.iter().map(|one| database.erase(&one.trainee, &[]).unwrap()).filter(|gone| *gone == (true, 1)).count(),
        STATION_COUNT
    );
}

fn rebuild_is_atomic(target: &str) {
    let database = Database::open(target).unwrap();
    let there: Vec<String> = database.fingerprints().unwrap().into_keys().collect();
    let records = [record("ben", 1), record("ben", 2)];
    assert_eq!(database.rebuild(&records, &there), Ok(2));
    assert_eq!(database.records(None).unwrap(), records);
    // If one record is invalid, the whole change fails, and the existing records remain.
    let mut broken = record("ben", 3);
    broken.seconds = f64::NAN;
    let gone: Vec<String> = records.iter().map(|record| record.id.clone()).collect();
    let wrong = database.rebuild(&[record("ben", 4), broken.clone()], &gone).unwrap_err().to_string();
    assert!(wrong.contains("seconds = NaN"), "{wrong}");
    assert!(database.put(&[record("ben", 4), broken]).is_err());
    assert_eq!(database.records(None).unwrap(), records);
    assert_eq!(database.rebuild(&[], &gone), Ok(0));
    assert_eq!(database.records(None).unwrap(), []);
}

fn concurrent_imports_lose_nothing(target: &str) {
    let stations: Vec<_> = (0..STATION_COUNT)
        .map(|station| {
            let target = target.to_owned();
            std::thread::spawn(move || {
                let database = Database::open(&target).unwrap();
                // Each trainee exists on two stations, and all stations import the same session.
                let trainee = format!("t{}", station / 2);
                for number in 0..SESSIONS_PER_STATION {
                    database.put(&[record(&trainee, station * SESSIONS_PER_STATION + number), record("shared", 0)]).unwrap();
                }
            })
        })
        .collect();
    for station in stations {
        station.join().unwrap();
    }
    let database = Database::open(target).unwrap();
    assert_eq!(database.records(None).unwrap().len(), STATION_COUNT * SESSIONS_PER_STATION + 1);
    assert_eq!(database.trainees().unwrap().iter().filter(|person| person.pseudonym.starts_with('t')).count(), STATION_COUNT / 2);
}

#[test]
fn exact_sqlite_database() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a place with 100% odd #names?").join("records.sqlite");
    run_all_tests(&file.display().to_string());
    assert!(file.is_file());
}

#[test]
fn exact_twenty_stations_can_create_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    concurrent_imports_lose_nothing(&folder.path().join("new.sqlite").display().to_string());
}

fn readers_do_not_wait_for_a_writer(target: &str) {
    let writer = Database::open(target).unwrap();
    let there: Vec<String> = writer.fingerprints().unwrap().into_keys().collect();
    writer.rebuild(&[record("rita", 1)], &there).unwrap();
    writer.begin_uncommitted_write().unwrap();
    let reader = Database::open(target).unwrap();
    assert_eq!(reader.records(None).unwrap().len(), 1);
    assert_eq!(reader.list(None, 10, 0).unwrap().len(), 1);
}

fn newer_version_is_rejected(target: &str) {
    Database::open(target).unwrap().set_schema_version(99).unwrap();
    let error = Database::open(target).unwrap_err().to_string();
    assert!(error.contains("version 99") && error.contains("newer"), "{error}");
}

#[test]
fn exact_readers_do_not_wait_for_a_writer() {
    let folder = tempfile::tempdir().unwrap();
    readers_do_not_wait_for_a_writer(&folder.path().join("records.sqlite").display().to_string());
}

#[test]
fn exact_erased_names_are_removed_from_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("records.sqlite");
    let database = Database::open(&file.display().to_string()).unwrap();
    database.put(&[record("somebody-special", 1), record("other", 1)]).unwrap();
    database.add_class("spring").unwrap();
    database.add_members("spring", &["somebody-special".to_owned()]).unwrap();
    database.erase("somebody-special", &[]).unwrap();
    let traces = |path: PathBuf| std::fs::read(path).unwrap().windows(16).any(|bytes| bytes == b"somebody-special");
    let found: Vec<PathBuf> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!found.into_iter().any(traces));
}

/// The web server's last task drops the database in a context that must not block.
#[test]
fn exact_dropping_the_database_does_not_block() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("records.sqlite").display().to_string();
    let database = Database::open(&file).unwrap();
    database.put(&[record("anna", 1)]).unwrap();
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    runtime.block_on(async move { drop(database) });
    assert_eq!(Database::open(&file).unwrap().records(None).unwrap().len(), 1);
}

#[test]
fn exact_newer_database_version_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    newer_version_is_rejected(&folder.path().join("records.sqlite").display().to_string());
}

#[test]
fn exact_messages_do_not_show_passwords() {
    let error = Database::open("postgres://spandrel:secret@127.0.0.1:1/none?password=secret").unwrap_err().to_string();
    assert!(error.contains("postgres://spandrel@127.0.0.1:1/none") && !error.contains("secret"), "{error}");
}

#[test]
fn val_postgresql_database() {
    let server = PostgresServer::start();
    let url = server.url();
    run_all_tests(&url);
    readers_do_not_wait_for_a_writer(&url);
    newer_version_is_rejected(&url);
}
