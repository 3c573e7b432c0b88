//! Imports new sessions into the database. A thread scans the folders for ended sessions, and imports changed sessions
//! again on request. The folders remain the source of truth: if the server is killed or the database fails, a later
//! scan imports everything.

use crate::errors::AppError;
use crate::records::{Database, RecordsLocation, is_erased, read_session, session_folders, session_id};
use spandrel_monitor::folder::ASSESSMENT;
use spandrel_training::questionnaire::ANSWERS;
use spandrel_training::record::SessionRecord;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Interval between folder scans.
const SCAN_INTERVAL: Duration = Duration::from_secs(2);

/// Handle to the importer thread.
#[derive(Debug)]
pub struct SessionImporter(Sender<PathBuf>);

impl SessionImporter {
    /// Starts the thread with a separate database connection so that pages do not have to wait.
    ///
    /// # Errors
    /// Returns an error if the database cannot be opened.
    pub fn start(records_location: &RecordsLocation) -> Result<Self, AppError> {
        let (sender, changed) = channel::<PathBuf>();
        let database = records_location.open()?;
        let sessions = records_location.sessions.clone();
        std::thread::spawn(move || {
            let mut looked = ImportProgress::default();
            loop {
                looked.scan(&database, &sessions);
                match changed.recv_timeout(SCAN_INTERVAL) {
                    Ok(folder) => {
                        // Users save answers in quick succession, so the session is imported once for all pending
                        // requests.
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

    /// Requests another import of a changed session.
    pub fn import_again(&self, folder: PathBuf) {
        if self.0.send(folder).is_err() {
            tracing::warn!("new sessions are no longer imported: restart the server");
        }
    }
}

/// The importer thread's state.
#[derive(Debug, Default)]
struct ImportProgress {
    /// True once the first scan has checked for answers that changed before startup.
    answers_checked: bool,
    /// Unreadable folders, each logged once.
    unreadable: BTreeSet<PathBuf>,
    /// Sessions that the database rejected; every scan retries them.
    rejected: BTreeSet<PathBuf>,
    /// Folders of erased sessions, each logged once.
    erased: BTreeSet<PathBuf>,
}

impl ImportProgress {
    /// Imports ended sessions that are missing from the database and sessions that it rejected before. The first scan
    /// also imports sessions with changed answers.
    fn scan(&mut self, database: &Database, sessions: &[PathBuf]) {
        let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
        let (known, erased, folders) = match (database.fingerprints(), database.erased(), session_folders(&here)) {
            (Ok(known), Ok(erased), Ok(folders)) => (known, erased, folders),
            (Err(error), _, _) | (_, Err(error), _) | (_, _, Err(error)) => {
                tracing::warn!("cannot import sessions now: {error}");
                return;
            }
        };
        for folder in folders {
            let is_known = session_id(&folder).is_ok_and(|id| known.contains_key(&id));
            let is_new = !is_known && folder.join(ASSESSMENT).is_file() && !self.unreadable.contains(&folder);
            let may_differ = is_known && !self.answers_checked && folder.join(ANSWERS).is_file();
            if is_new && (self.erased.contains(&folder) || is_erased(&folder, &erased)) {
                self.skip(folder);
                continue;
            }
            if is_new || may_differ || self.rejected.contains(&folder) {
                self.import(database, &folder, &known);
            }
        }
        self.answers_checked = true;
    }

    fn skip(&mut self, folder: PathBuf) {
        if !self.erased.contains(&folder) {
            tracing::warn!(
                "{}: not imported because it or its trainee was erased; to remove the folder too, use `spandrel records erase`",
                folder.display()
            );
            self.erased.insert(folder);
        }
    }

    /// Imports one folder, unless `known` contains it unchanged.
    fn import(&mut self, database: &Database, folder: &Path, known: &BTreeMap<String, String>) {
        match read_session(folder, known) {
            Ok(record) => {
                self.unreadable.remove(folder);
                self.save_record(database, folder, record);
            }
            // The folder has since been erased, or it is unreadable.
            Err(error) => {
                self.rejected.remove(folder);
                if self.unreadable.insert(folder.to_path_buf()) && folder.is_dir() {
                    tracing::warn!("skipped: {error}");
                }
            }
        }
    }

    fn save_record(&mut self, database: &Database, folder: &Path, record: Option<SessionRecord>) {
        match database.put(&Vec::from_iter(record)) {
            Ok(_) => {
                self.rejected.remove(folder);
            }
            Err(error) => {
                if self.rejected.insert(folder.to_path_buf()) {
                    tracing::warn!("not imported yet: {error}");
                }
            }
        }
    }
}
