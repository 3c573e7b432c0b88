//! File that stores a vehicle's parameters.

use crate::errors::AppError;
use spandrel_sitl::endpoint::params::text::ParamFileProblem;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file with a vehicle's parameters, in QGroundControl's .params format.
#[derive(Debug)]
pub struct ParamFile {
    path: PathBuf,
    /// Value of the parameter change counter at the last save.
    pub saved_changes: u64,
}

impl ParamFile {
    /// Creates a handle for a file that may not exist yet.
    pub fn new(path: PathBuf) -> Self {
        Self { path, saved_changes: 0 }
    }

    /// Returns the contents; `None` if the file does not exist.
    ///
    /// # Errors
    /// Returns an error if the file exists and cannot be read.
    pub fn text(&self) -> Result<Option<String>, AppError> {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(AppError::invalid(format!("--params {}: {error}", self.path.display()))),
        }
    }

    /// Combine all problems in the file into one error.
    pub fn parse_error(&self, problems: &[ParamFileProblem]) -> AppError {
        let lines: Vec<String> =
            problems.iter().map(|problem| format!("{}:{}: {}", self.path.display(), problem.line, problem.what)).collect();
        AppError::invalid(lines.join("\n"))
    }

    /// Replaces the whole file atomically: concurrent readers, and readers after a crash, see either the old or the new
    /// version.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written; the old version remains.
    pub fn write(&self, text: &str) -> Result<(), AppError> {
        let failed = |error: std::io::Error| AppError::failed(format!("--params {}: {error}", self.path.display()));
        let temp_path = temp_path(&self.path);
        let mut file = std::fs::File::create(&temp_path).map_err(failed)?;
        file.write_all(text.as_bytes()).and_then(|()| file.sync_all()).map_err(failed)?;
        std::fs::rename(&temp_path, &self.path).map_err(failed)
    }
}

fn temp_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".new");
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_parameter_files_round_trip_without_leftovers() {
        let folder = tempfile::tempdir().unwrap();
        let file = ParamFile::new(folder.path().join("drone.params"));
        assert_eq!(file.text(), Ok(None));
        file.write("first").unwrap();
        file.write("second").unwrap();
        assert_eq!(file.text(), Ok(Some("second".to_owned())));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = ParamFile::new(folder.path().join("none").join("drone.params"));
        assert!(nowhere.write("x").unwrap_err().to_string().contains("drone.params"));
    }
}
