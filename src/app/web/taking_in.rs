//! New sessions into the database: a thread that looks for folders that have ended, and takes in again whatever it is told has changed. The
//! folders stay the source: a kill at any moment costs nothing but a later look.

use crate::app::errors::AppError;
use crate::app::records::{Database, Place, read_session, session_folders, session_id};
use crate::monitor::folder::ASSESSMENT;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Between two looks at the folders.
const LOOK: Duration = Duration::from_secs(2);

/// The thread's ear.
#[derive(Debug)]
pub struct TakingIn(Sender<PathBuf>);

impl TakingIn {
    /// Starts to look. It has a connection of its own, so that pages do not wait for it.
    ///
    /// # Errors
    /// When the database cannot be opened.
    pub fn start(place: &Place) -> Result<Self, AppError> {
        let (sender, changed) = channel::<PathBuf>();
        let database = place.open()?;
        let sessions = place.sessions.clone();
        std::thread::spawn(move || {
            let mut failed = BTreeSet::new();
            loop {
                look(&database, &sessions, &mut failed);
                match changed.recv_timeout(LOOK) {
                    Ok(folder) => {
                        // Answers come in quick succession; the session is read once for all that wait.
                        let mut folders = BTreeSet::from([folder]);
                        folders.extend(changed.try_iter());
                        folders.iter().for_each(|folder| {
                            take(&database, folder, &mut failed);
                        });
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        });
        Ok(Self(sender))
    }

    /// A session has changed.
    pub fn again(&self, folder: PathBuf) {
        if self.0.send(folder).is_err() {
            tracing::warn!("sessions are no longer taken in: start the server again");
        }
    }
}

/// Takes in the folders that have ended and that the database does not know.
fn look(database: &Database, sessions: &[PathBuf], failed: &mut BTreeSet<PathBuf>) {
    let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    let (known, folders) = match (database.fingerprints(), session_folders(&here)) {
        (Ok(known), Ok(folders)) => (known, folders),
        (Err(error), _) | (_, Err(error)) => {
            tracing::warn!("no sessions are taken in now: {error}");
            return;
        }
    };
    for folder in folders {
        let is_new = session_id(&folder).is_ok_and(|id| !known.contains_key(&id));
        if is_new && folder.join(ASSESSMENT).is_file() && !failed.contains(&folder) {
            take(database, &folder, failed);
        }
    }
}

fn take(database: &Database, folder: &Path, failed: &mut BTreeSet<PathBuf>) {
    let taken = read_session(folder, &BTreeMap::new()).and_then(|record| database.put(&Vec::from_iter(record)));
    match taken {
        Ok(_) => {
            failed.remove(folder);
        }
        // Erased meanwhile, or not to be read: told once.
        Err(error) => {
            if failed.insert(folder.to_path_buf()) && folder.is_dir() {
                tracing::warn!("left out: {error}");
            }
        }
    }
}
