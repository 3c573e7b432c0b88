//! The server's scenarios, shipped and uploaded.

use super::response::WebError;
use super::safe_names::is_safe_file_name;
use crate::errors::AppError;
use crate::io::files::{self, read_from_folder};
use spandrel_model::scenario::{self, Scenario};
use spandrel_text::{Language, text};
use spandrel_training::web::scenarios::ScenarioEntry;
use std::path::{Path, PathBuf};

/// Folder for uploaded scenarios inside the sessions folder, unless another is set.
pub const UPLOAD_FOLDER: &str = "scenarios";
/// Maximum size of an uploaded scenario, bytes; the shipped scenarios are about ten thousand bytes long.
pub const MAX_SCENARIO_BYTES: usize = 256 * 1024;
/// Aircraft of briefings and checks, as in the other commands.
pub const DEFAULT_VEHICLE: &str = "phantom2";

/// A scenario with its source text.
pub struct StoredScenario {
    /// Name, title and origin.
    pub named: ScenarioEntry,
    /// Scenario parsed from the text.
    pub scenario: Scenario,
    /// Scenario source text (TOML).
    pub text: String,
    /// Folder of the uploaded scenarios.
    folder: PathBuf,
}

impl StoredScenario {
    /// Returns the form or difficulty level of this scenario with this CRC; `None` if it has none.
    #[must_use]
    pub fn variant_with_crc(&self, crc: u32) -> Option<Scenario> {
        let referenced = |name: &str| read_from_folder(&self.folder, name);
        read(&self.folder, &self.named.name, &scenario::variant_with_crc(&self.text, &referenced, crc)?).ok()
    }
}

/// Returns all shipped scenarios, then the uploaded ones.
pub fn all(folder: &Path) -> Vec<StoredScenario> {
    let shipped = files::scenario_names().into_iter().filter_map(|name| shipped(folder, name));
    shipped.chain(uploaded(folder).iter().filter_map(|path| stored(folder, path))).collect()
}

/// Finds a scenario by name. Reads no other scenario, because one with a large model takes time.
pub fn find(folder: &Path, name: &str) -> Option<StoredScenario> {
    if !is_safe_file_name(name) {
        return None;
    }
    if files::scenario_names().contains(&name) {
        return shipped(folder, name);
    }
    stored(folder, &upload_path(folder, name)).filter(|job| job.named.name == name)
}

fn shipped(folder: &Path, name: &str) -> Option<StoredScenario> {
    let file = files::scenario(name).ok()?;
    let named = named(&file.scenario, false);
    Some(StoredScenario { named, scenario: file.scenario, text: file.text, folder: folder.to_path_buf() })
}

/// Reads an uploaded scenario; `None` if it is invalid.
fn stored(folder: &Path, path: &Path) -> Option<StoredScenario> {
    let text = files::read(path).ok()?;
    let scenario = read(folder, &path.display().to_string(), &text).ok()?;
    Some(StoredScenario { named: named(&scenario, true), scenario, text, folder: folder.to_path_buf() })
}

fn named(scenario: &Scenario, uploaded: bool) -> ScenarioEntry {
    ScenarioEntry { name: scenario.name.clone(), title: scenario.title.clone(), uploaded }
}

pub fn uploaded(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

/// Parses an uploaded scenario. It can refer to files in the folder of uploaded scenarios or below, where the administrator puts them.
pub fn read(folder: &Path, file: &str, text: &str) -> Result<Scenario, AppError> {
    Ok(scenario::read(file, text, &|name| read_from_folder(folder, name))?)
}

/// Returns the argument that identifies the scenario to other functions: the path of an uploaded scenario, or the name
/// of a shipped scenario.
pub fn argument(folder: &Path, language: Language, name: &str) -> Result<String, WebError> {
    let job =
        find(folder, name).ok_or_else(|| WebError::BadRequest(text!(language, "web-error-unknown-name", field = "scenario")))?;
    Ok(if job.named.uploaded { upload_path(folder, name).display().to_string() } else { job.named.name })
}

pub fn upload_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.toml"))
}
