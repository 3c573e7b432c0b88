//! New sessions into the database: a thread that looks for folders that have ended, and takes in again whatever it is told has changed. The
//! folders stay the source: a kill at any moment, or a database that is away, costs nothing but a later look.

use crate::errors::AppError;
use crate::records::{Database, RecordsLocation, is_erased, read_session, session_folders, session_id};
use spandrel_monitor::folder::ASSESSMENT;
use spandrel_training::questionnaire::ANSWERS;
use spandrel_training::record::SessionRecord;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Between two looks at the folders.
const LOOK: Duration = Duration::from_secs(2);

/// The thread's ear.
#[derive(Debug)]
pub struct SessionImporter(Sender<PathBuf>);

impl SessionImporter {
    /// Starts to look. It has a connection of its own, so that pages do not wait for it.
    ///
    /// # Errors
    /// If the database cannot be opened.
    pub fn start(place: &RecordsLocation) -> Result<Self, AppError> {
        let (sender, changed) = channel::<PathBuf>();
        let database = place.open()?;
        let sessions = place.sessions.clone();
        std::thread::spawn(move || {
            let mut looked = ImportProgress::default();
            loop {
                looked.scan(&database, &sessions);
                match changed.recv_timeout(LOOK) {
                    Ok(folder) => {
                        // Answers come in quick succession; the session is read once for all that wait.
                        let mut folders = BTreeSet::from([folder]);
                        folders.extend(changed.try_iter());
                        folders.iter().for_each(|folder| looked.import(&database, folder, &BTreeMap::new()));
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        });
        Ok(Self(sender))
    }

    /// A session has changed.
    pub fn rescan(&self, folder: PathBuf) {
        if self.0.send(folder).is_err() {
            tracing::warn!("sessions are no longer taken in: start the server again");
        }
    }
}

/// What the thread knows of the folders.
#[derive(Debug, Default)]
struct ImportProgress {
    /// The answers that a kill left out were looked for.
    caught_up: bool,
    /// Not to be read; told once.
    unreadable: BTreeSet<PathBuf>,
    /// Read, but refused by the database: tried again at every look.
    refused: BTreeSet<PathBuf>,
    /// Erased, with the folder still here; told once.
    erased: BTreeSet<PathBuf>,
}

impl ImportProgress {
    /// Takes in the folders that have ended and that the database does not know, those that it refused, and the first time those whose
    /// answers have changed.
    fn scan(&mut self, database: &Database, sessions: &[PathBuf]) {
        let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
        let (known, erased, folders) = match (database.fingerprints(), database.erased(), session_folders(&here)) {
            (Ok(known), Ok(erased), Ok(folders)) => (known, erased, folders),
            (Err(error), _, _) | (_, Err(error), _) | (_, _, Err(error)) => {
                tracing::warn!("no sessions are taken in now: {error}");
                return;
            }
        };
        for folder in folders {
            let is_known = session_id(&folder).is_ok_and(|id| known.contains_key(&id));
            let is_new = !is_known && folder.join(ASSESSMENT).is_file() && !self.unreadable.contains(&folder);
            let may_differ = is_known && !self.caught_up && folder.join(ANSWERS).is_file();
            if is_new && (self.erased.contains(&folder) || is_erased(&folder, &erased)) {
                self.skip(folder);
                continue;
            }
            if is_new || may_differ || self.refused.contains(&folder) {
                self.import(database, &folder, &known);
            }
        }
        self.caught_up = true;
    }

    fn skip(&mut self, folder: PathBuf) {
        if !self.erased.contains(&folder) {
            tracing::warn!(
                "{}: not taken in, it or its trainee was erased; spandrel records erase removes the folder, too",
                folder.display()
            );
            self.erased.insert(folder);
        }
    }

    /// Takes in one folder, unless `known` holds it unchanged.
    fn import(&mut self, database: &Database, folder: &Path, known: &BTreeMap<String, String>) {
        match read_session(folder, known) {
            Ok(record) => {
                self.unreadable.remove(folder);
                self.save_record(database, folder, record);
            }
            // Erased meanwhile, or not to be read.
            Err(error) => {
                self.refused.remove(folder);
                if self.unreadable.insert(folder.to_path_buf()) && folder.is_dir() {
                    tracing::warn!("left out: {error}");
                }
            }
        }
    }

    fn save_record(&mut self, database: &Database, folder: &Path, record: Option<SessionRecord>) {
        match database.put(&Vec::from_iter(record)) {
            Ok(_) => {
                self.refused.remove(folder);
            }
            Err(error) => {
                if self.refused.insert(folder.to_path_buf()) {
                    tracing::warn!("not taken in yet: {error}");
                }
            }
        }
    }
}
