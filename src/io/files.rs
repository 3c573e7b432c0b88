//! Scenario and vehicle files: from a path, from a session folder, or from what is compiled in.

use crate::errors::AppError;
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped;
use spandrel_model::vehicle::{self, Vehicle};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// A scenario with the text that it came from.
#[derive(Debug, Clone)]
pub struct ScenarioFile {
    /// The text.
    pub text: String,
    /// Files that it names, by the name that it uses (height fields).
    pub siblings: BTreeMap<String, String>,
    /// The job.
    pub scenario: Scenario,
}

/// A vehicle with the text that it came from.
#[derive(Debug, Clone)]
pub struct VehicleFile {
    /// The text.
    pub text: String,
    /// The aircraft.
    pub vehicle: Vehicle,
}

/// A file's text and where it lies.
pub struct SourceFile {
    /// Name for messages.
    pub file: String,
    /// The text.
    pub text: String,
    /// Its folder; `None` for a shipped file.
    folder: Option<PathBuf>,
}

/// Names of the shipped scenarios.
pub fn scenario_names() -> Vec<&'static str> {
    shipped::SCENARIOS.iter().map(|(name, _)| *name).collect()
}

/// Names of the shipped vehicles.
pub fn vehicle_names() -> Vec<&'static str> {
    shipped::VEHICLES.iter().map(|(name, _)| *name).collect()
}

/// Loads and validates a scenario.
///
/// # Errors
/// If it cannot be read or is wrong: everything that is wrong with it.
pub fn scenario(argument: &str) -> Result<ScenarioFile, AppError> {
    scenario_from(source(argument, "scenario", shipped::SCENARIOS)?)
}

/// Loads and validates a vehicle.
///
/// # Errors
/// If it cannot be read or is wrong: everything that is wrong with it.
pub fn vehicle(argument: &str) -> Result<VehicleFile, AppError> {
    let source = source(argument, "vehicle", shipped::VEHICLES)?;
    let vehicle = vehicle::read(&source.file, &source.text)?;
    Ok(VehicleFile { text: source.text, vehicle })
}

/// Loads a vehicle whose id is known apart from its file name (a session's `vehicle.toml`).
///
/// # Errors
/// As [`vehicle`].
pub fn vehicle_named(path: &Path, id: &str) -> Result<VehicleFile, AppError> {
    let text = read(path)?;
    let mut vehicle = vehicle::read(&path.display().to_string(), &text)?;
    vehicle.id = id.to_owned();
    Ok(VehicleFile { text, vehicle })
}

/// Validates a scenario's text; files that it names are looked for beside it.
///
/// # Errors
/// Everything that is wrong with it.
pub fn scenario_from(source: SourceFile) -> Result<ScenarioFile, AppError> {
    let seen = RefCell::new(BTreeMap::new());
    let sibling = |name: &str| {
        let text = source.sibling(name)?;
        seen.borrow_mut().insert(name.to_owned(), text.clone());
        Ok(text)
    };
    let scenario = scenario::read(&source.file, &source.text, &sibling)?;
    Ok(ScenarioFile { text: source.text, siblings: seen.into_inner(), scenario })
}

/// Finds the text behind an argument: a path, or a name among `library`.
///
/// # Errors
/// When there is no such file and no such name.
pub fn source(argument: &str, what: &str, library: &[(&'static str, &'static str)]) -> Result<SourceFile, AppError> {
    let path = Path::new(argument);
    let looks_like_a_path = argument.contains(['/', '\\']) || path.extension().is_some_and(|end| end == "toml");
    if looks_like_a_path || path.is_file() {
        let folder = path.parent().map(Path::to_path_buf);
        return Ok(SourceFile { file: argument.to_owned(), text: read(path)?, folder });
    }
    let names: Vec<&str> = library.iter().map(|(name, _)| *name).collect();
    let (name, text) = library.iter().find(|(name, _)| *name == argument).ok_or_else(|| {
        AppError::wrong(format!("there is no {what} '{argument}': give a file, or one of {}", names.join(", ")))
    })?;
    Ok(SourceFile { file: format!("{name}.toml"), text: (*text).to_owned(), folder: None })
}

/// Any file for `check`: shipped names of both kinds are looked up too.
///
/// # Errors
/// When there is no such file and no such name.
pub fn any_source(argument: &str) -> Result<SourceFile, AppError> {
    let library: Vec<_> = shipped::SCENARIOS.iter().chain(shipped::VEHICLES).copied().collect();
    source(argument, "scenario or vehicle", &library)
}

/// Reads a text file.
///
/// # Errors
/// If it cannot be read.
pub fn read(path: &Path) -> Result<String, AppError> {
    let bytes = std::fs::read(path).map_err(|error| AppError::wrong(format!("{}: cannot be read: {error}", path.display())))?;
    String::from_utf8(bytes).map_err(|error| {
        AppError::wrong(format!("{}: is not UTF-8 text (byte {})", path.display(), error.utf8_error().valid_up_to()))
    })
}

/// Writes a result to a file, or to standard output for `-`. A file is replaced as a whole: a full disk or a kill leaves the old one.
///
/// # Errors
/// If it cannot be written.
pub fn write(target: &str, bytes: &[u8]) -> Result<(), AppError> {
    use std::io::Write;
    let path = Path::new(target);
    // A link is followed; a pipe or a device cannot be replaced.
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let done = match target {
        "-" => std::io::stdout().lock().write_all(bytes),
        _ if real.exists() && !real.is_file() => std::fs::write(&real, bytes),
        _ => return super::replace::replace(&real, bytes),
    };
    done.map_err(|error| AppError::failed(format!("{target}: cannot be written: {error}")))
}

impl SourceFile {
    /// Reads a file that this one names. Only names beside or below it are followed.
    pub fn sibling(&self, name: &str) -> Result<String, String> {
        let Some(folder) = &self.folder else { return Err("a shipped scenario has no files beside it".into()) };
        if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_))) {
            return Err("only files beside or below the scenario can be named".into());
        }
        std::fs::read_to_string(folder.join(name)).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_shipped_file_is_valid() {
        for name in scenario_names() {
            assert_eq!(scenario(name).map(|file| file.scenario.name), Ok(name.to_owned()));
        }
        for name in vehicle_names() {
            assert_eq!(vehicle(name).map(|file| file.vehicle.id), Ok(name.to_owned()));
        }
    }

    #[test]
    fn exact_an_unknown_name_lists_what_there_is() {
        let Err(error) = vehicle("no-such-drone") else { panic!("found it") };
        assert!(matches!(&error, AppError::Wrong(message) if message.contains("no-such-drone")), "{error}");
    }

    #[test]
    fn exact_files_beside_a_scenario_stay_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("heights.csv"), "1,2").unwrap();
        let source = SourceFile { file: "s.toml".into(), text: String::new(), folder: Some(folder.path().into()) };
        assert_eq!(source.sibling("heights.csv"), Ok("1,2".into()));
        for bad in ["../heights.csv", "/etc/hostname"] {
            assert!(source.sibling(bad).is_err(), "{bad}");
        }
    }
}
