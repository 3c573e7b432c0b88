//! Finds out who is flying a vehicle, based on the session that a monitor is recording with the same scenario and seed.

use crate::io::session_folder::ongoing_session;
use crate::records::session_folders;
use spandrel_training::web::live_state::JobIdentity;
use std::path::PathBuf;
use std::time::Duration;

/// Time after which a session whose telemetry has stopped growing is no longer the current flight.
const MAX_TELEMETRY_AGE: Duration = Duration::from_secs(10);

/// Returns the trainee of the only matching ongoing session. Returns `None` if there is no such session or more than
/// one, so that no trainee sees another trainee's camera view.
pub fn current_trainee(sessions: &[PathBuf], key: JobIdentity) -> Option<String> {
    let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    let folders = session_folders(&here).ok()?;
    let mut found = folders
        .iter()
        .filter_map(|folder| ongoing_session(folder, MAX_TELEMETRY_AGE))
        .filter(|one| (one.crc, one.seed) == (key.crc, key.seed));
    let one = found.next()?;
    found.next().is_none().then_some(one.trainee)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_monitor::folder::{ASSESSMENT, SESSION, TELEMETRY};
    use std::fs;

    const JOB: JobIdentity = JobIdentity { crc: 0x00ab_cdef, seed: 7 };

    fn session(sessions: &tempfile::TempDir, name: &str, trainee: &str, seed: u64) -> PathBuf {
        let folder = sessions.path().join(name);
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join(TELEMETRY), b"x").unwrap();
        let about = serde_json::json!({ "trainee": trainee, "scenario_crc": format!("{:08x}", JOB.crc), "seed": seed });
        fs::write(folder.join(SESSION), about.to_string()).unwrap();
        folder
    }

    #[test]
    fn exact_owner_is_the_trainee_of_the_only_ongoing_session() {
        let sessions = tempfile::tempdir().unwrap();
        let places = [sessions.path().to_path_buf(), PathBuf::from("/none")];
        assert_eq!(current_trainee(&places, JOB), None);
        let anna = session(&sessions, "1-anna", "anna", JOB.seed);
        session(&sessions, "2-ben", "ben", JOB.seed + 1);
        assert_eq!(current_trainee(&places, JOB).as_deref(), Some("anna"));
        let cleo = session(&sessions, "3-cleo", "cleo", JOB.seed);
        assert_eq!(current_trainee(&places, JOB), None, "two sessions match");
        fs::write(cleo.join(ASSESSMENT), b"{}").unwrap();
        assert_eq!(current_trainee(&places, JOB).as_deref(), Some("anna"), "the other has ended");
        let file = fs::File::options().write(true).open(anna.join(TELEMETRY)).unwrap();
        let modified = file.metadata().unwrap().modified().unwrap();
        file.set_modified(modified - 2 * MAX_TELEMETRY_AGE).unwrap();
        assert_eq!(current_trainee(&places, JOB), None, "no longer being written");
    }
}
