//! Concurrent changes by several stations: erased data stays erased, a rebuild does not delete other stations'
//! sessions, and no change to a person is lost.

use super::record;
use crate::records::database::Database;
use spandrel_training::record::SessionRecord;
use spandrel_training::trainee::Role;

/// A time after every erasure in these tests, in the year 2100, µs since the Unix epoch.
const AFTER_ERASURE_US: u64 = 4_102_444_800_000_000;

/// Runs all tests in this file on one database.
pub fn run_all(target: &str) {
    erased_sessions_are_not_imported_again(target);
    rebuild_deletes_only_the_given_sessions(target);
    concurrent_changes_to_person_are_kept(target);
    session_is_found_by_telemetry_hash(target);
    list_pages_are_consecutive(target);
    // Each test leaves an empty database for the next one.
    let database = Database::open(target).unwrap();
    for trainee in database.trainees().unwrap() {
        database.erase(&trainee.pseudonym, &[]).unwrap();
    }
}

fn is_deleted(database: &Database, id: &str) -> bool {
    database.record(id).unwrap().is_none()
}

/// One station erases sessions. Another station, which still has their folders, imports the records that it read
/// earlier.
fn erased_sessions_are_not_imported_again(target: &str) {
    let (here, there) = (Database::open(target).unwrap(), Database::open(target).unwrap());
    let flown = [record("erna", 1), record("erna", 2)];
    assert_eq!(here.put(&flown), Ok(2));
    assert_eq!(here.erase("erna", &[]), Ok((true, 2)));
    assert_eq!(there.put(&flown), Ok(0), "an import");
    assert_eq!(there.rebuild(&flown, &[]), Ok(0), "a rebuild");
    assert!(is_deleted(&there, &flown[0].id) && !there.trainees().unwrap().iter().any(|one| one.pseudonym == "erna"));
    let erased = there.erased().unwrap();
    assert!(erased.contains(&flown[0].id, "erna", flown[0].started_unix_us) && !erased.contains("x", "erna", AFTER_ERASURE_US));
    // A new trainee may reuse the pseudonym.
    let anew = SessionRecord { started_unix_us: AFTER_ERASURE_US, ..record("erna", 3) };
    assert_eq!(there.put(std::slice::from_ref(&anew)), Ok(1));
    assert_eq!(there.erase("erna", &[]), Ok((true, 1)));
    // A session that was deleted because of its age stays deleted; the trainee's other sessions can be imported.
    assert_eq!(there.put(&[record("fritz", 1), record("fritz", 2)]), Ok(2));
    assert_eq!(here.delete_sessions(&["session-fritz-001".into()], &[]), Ok(1));
    assert_eq!(there.put(&[record("fritz", 1), record("fritz", 2), record("fritz", 3)]), Ok(1));
    assert!(is_deleted(&there, "session-fritz-001") && !is_deleted(&there, "session-fritz-003"));
}

fn rebuild_deletes_only_the_given_sessions(target: &str) {
    let (here, there) = (Database::open(target).unwrap(), Database::open(target).unwrap());
    here.put(&[record("gina", 1), record("gina", 2)]).unwrap();
    // While this station reads its folders, another one adds a session.
    there.put(&[record("gina", 3)]).unwrap();
    let mut changed = record("gina", 1);
    changed.scores.safety = 12.0;
    assert_eq!(
        here.rebuild(&[changed.clone()], &["session-gina-002".into()]),
        Ok(1),
        "a session with the same fingerprint is also rebuilt"
    );
    assert_eq!(here.record("session-gina-001").unwrap(), Some(changed));
    assert!(is_deleted(&here, "session-gina-002") && !is_deleted(&here, "session-gina-003"));
    assert_eq!(here.rebuild(&[record("gina", 2)], &[]), Ok(1), "a session deleted by a rebuild can be added again");
}

fn concurrent_changes_to_person_are_kept(target: &str) {
    let (here, there) = (Database::open(target).unwrap(), Database::open(target).unwrap());
    here.set_login("hans", Role::Trainee, "first").unwrap();
    let none = ["", "", ""];
    // Another station changes the role while a user fills in a form; the details also survive a new password.
    there.set_login("hans", Role::Instructor, "first").unwrap();
    assert_eq!(here.set_details("hans", none, ["25-34", "", "some"]), Ok(true));
    there.set_login("hans", Role::Administrator, "second").unwrap();
    let person = here.account("hans").unwrap().unwrap().person;
    assert_eq!((person.role, person.age_band.as_deref()), (Role::Administrator, Some("25-34")));
    assert_eq!((person.drone_experience, person.gaming_experience.as_deref()), (None, Some("some")));
    // If two users fill in the same form, the second submission is rejected.
    assert_eq!(there.set_details("hans", none, ["35-44", "none", ""]), Ok(false));
    assert_eq!(there.set_details("hans", ["25-34", "", "some"], none), Ok(true), "details can be cleared");
    assert_eq!(here.account("hans").unwrap().unwrap().person.age_band, None);
    assert_eq!(here.set_details("nobody-of-this-name", none, none), Ok(false));
    // The command line sets only the specified details.
    here.update_details("hans", None, [None, Some("some"), None]).unwrap();
    here.update_details("hans", Some(Role::Trainee), [Some("45-54"), None, None]).unwrap();
    let person = here.account("hans").unwrap().unwrap().person;
    assert_eq!(
        (person.role, person.age_band.as_deref(), person.drone_experience.as_deref()),
        (Role::Trainee, Some("45-54"), Some("some"))
    );
    // Changing a password requires the current password hash.
    assert_eq!(here.change_password("hans", "first", "third"), Ok(false));
    let before = here.account("hans").unwrap().unwrap().credential();
    assert_eq!(here.change_password("hans", "second", "third"), Ok(true));
    let after = there.account("hans").unwrap().unwrap();
    assert_eq!(after.hash.as_deref(), Some("third"));
    assert!(before.is_some() && after.credential().is_some() && before != after.credential());
    there.update_details("hans", Some(Role::Instructor), [None; 3]).unwrap();
    assert_ne!(
        here.account("hans").unwrap().unwrap().credential(),
        after.credential(),
        "a change of role changes the credential"
    );
    assert_eq!(here.erase("hans", &[]), Ok((true, 0)));
}

fn session_is_found_by_telemetry_hash(target: &str) {
    let database = Database::open(target).unwrap();
    let flown = SessionRecord { telemetry_sha256: "'; --".into(), ..record("ines", 1) };
    database.put(std::slice::from_ref(&flown)).unwrap();
    assert_eq!(database.find_by_telemetry("'; --"), Ok(Some((flown.id, "ines".into()))));
    assert_eq!(database.find_by_telemetry("of nobody"), Ok(None));
}

/// Every session is on exactly one page, newest first, including sessions with the same start time.
fn list_pages_are_consecutive(target: &str) {
    let database = Database::open(target).unwrap();
    let flown: Vec<SessionRecord> =
        (0..7).map(|k| SessionRecord { started_unix_us: AFTER_ERASURE_US + k / 3, ..record("jana", k as usize) }).collect();
    database.put(&flown).unwrap();
    let page =
        |trainee, skip| -> Vec<String> { database.list(trainee, 3, skip).unwrap().into_iter().map(|one| one.id).collect() };
    let mut expected: Vec<&SessionRecord> = flown.iter().collect();
    expected.sort_by(|a, b| b.started_unix_us.cmp(&a.started_unix_us).then(a.id.cmp(&b.id)));
    let expected: Vec<&str> = expected.into_iter().map(|one| one.id.as_str()).collect();
    assert_eq!([page(Some("jana"), 0), page(Some("jana"), 3), page(Some("jana"), 6)].concat(), expected);
    assert_eq!([page(None, 0), page(None, 3)].concat(), expected[..6], "these sessions are the newest of all trainees");
    database.erase("jana", &[]).unwrap();
}
