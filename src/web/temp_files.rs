//! Removes temporary files (`NAME.PID-N.new`) of processes that were killed while writing.

use crate::errors::AppError;
use crate::records::session_folders;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Folder for sessions that are being imported; no session can have this name.
pub const IMPORT_FOLDER: &str = ".taking-in";
/// Age beyond which a temporary file counts as abandoned. A process on another computer that shares the disk may have
/// any process ID, so this age must exceed the duration of any write.
const STALE_AGE: Duration = Duration::from_secs(600);

/// Removes stale temporary files from the sessions folders, from the session folders inside them, from the scenario folder, and
/// from the folders inside it. Leaves files in place that it cannot check or remove; they are harmless.
pub fn remove_stale(sessions: &[PathBuf], scenarios: &Path) {
    let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
    let inside = session_folders(&here).unwrap_or_default();
    let entries = std::fs::read_dir(scenarios).into_iter().flatten().flatten();
    let below: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
    for folder in here.iter().chain(&inside).chain(&below).map(PathBuf::as_path).chain([scenarios]) {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for path in entries.map(|entry| entry.path()).filter(|path| is_stale(path)) {
            match std::fs::remove_file(&path) {
                Ok(()) => tracing::info!("{}: removed a temporary file left by a killed process", path.display()),
                Err(error) => tracing::warn!("{}: cannot remove: {error}", path.display()),
            }
        }
    }
}

/// Removes incomplete imports left by a killed server.
///
/// # Errors
/// Returns an error if the disk cannot be written.
pub fn remove_partial_imports(sessions: &Path) -> Result<(), AppError> {
    let aside = sessions.join(IMPORT_FOLDER);
    match std::fs::remove_dir_all(&aside) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(AppError::failed(format!("{}: cannot remove: {error}", aside.display())))
        }
        _ => Ok(()),
    }
}

/// Returns true if `io::replace` generated the file name, the process is no longer running, and the file is old.
fn is_stale(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let Some(writer) = writer_pid(name) else { return false };
    let old = path.metadata().and_then(|about| about.modified()).is_ok_and(|at| at.elapsed().is_ok_and(|age| age > STALE_AGE));
    old && path.is_file() && !is_process_running(writer)
}

/// Returns the process ID from a `NAME.PID-N.new` file name.
fn writer_pid(name: &str) -> Option<u32> {
    let (rest, number) = name.strip_suffix(".new")?.rsplit_once('-')?;
    let (original, process) = rest.rsplit_once('.')?;
    number.parse::<u64>().ok().filter(|_| !original.is_empty())?;
    process.parse().ok()
}

/// Returns true if the process is running, or if the system has no /proc to check.
fn is_process_running(process: u32) -> bool {
    let all = Path::new("/proc");
    !all.join("self").exists() || all.join(process.to_string()).exists()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn write_file_with_age(path: &Path, age: Duration) {
        fs::write(path, "half").unwrap();
        let file = fs::File::options().write(true).open(path).unwrap();
        let now = file.metadata().unwrap().modified().unwrap();
        file.set_modified(now - age).unwrap();
    }

    #[test]
    fn exact_only_old_files_of_dead_processes_are_removed() {
        let (sessions, scenarios) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let session = sessions.path().join("a-session");
        fs::create_dir(&session).unwrap();
        fs::write(session.join("telemetry.tlog"), "x").unwrap();
        // Linux process IDs do not exceed 2^22.
        let (dead, alive) = (4_194_305, std::process::id());
        let pictures = scenarios.path().join("job");
        fs::create_dir(&pictures).unwrap();
        let gone = [
            pictures.join(format!("gate.png.{dead}-2.new")),
            session.join(format!("answers.json.{dead}-7.new")),
            sessions.path().join(format!("x.{dead}-0.new")),
            scenarios.path().join(format!("job.toml.{dead}-1.new")),
        ];
        let kept = [
            session.join(format!("report.html.{alive}-7.new")),
            session.join("notes.new"),
            session.join(format!("{dead}-7.new")),
            session.join(format!("answers.json.{dead}-seven.new")),
            session.join("answers.json"),
        ];
        gone.iter().chain(&kept).for_each(|path| write_file_with_age(path, 2 * STALE_AGE));
        let young = session.join(format!("answers.json.{dead}-8.new"));
        write_file_with_age(&young, Duration::ZERO);
        remove_stale(&[sessions.path().to_path_buf(), PathBuf::from("/none")], scenarios.path());
        assert!(gone.iter().all(|path| !path.exists()));
        assert!(kept.iter().chain([&young]).all(|path| path.exists()));
    }
}
