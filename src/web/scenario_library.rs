//! The server's scenarios, shipped and uploaded.

use super::response::WebError;
use super::safe_names::is_safe_file_name;
use crate::errors::AppError;
use crate::io::files;
use spandrel_model::scenario::{self, Scenario};
use spandrel_text::{Language, text};
use spandrel_training::web::scenario_check_result::no_siblings;
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
}

impl StoredScenario {
    /// Returns the form or difficulty level of this scenario with this CRC; `None` if it has none.
    #[must_use]
    pub fn variant_with_crc(&self, crc: u32) -> Option<Scenario> {
        read(&self.named.name, &scenario::variant_with_crc(&self.text, crc)?).ok()
    }
}

/// Returns all shipped scenarios, then the uploaded ones.
pub fn all(folder: &Path) -> Vec<StoredScenario> {
    let shipped = files::scenario_names().into_iter().filter_map(|name| {
        let file = files::scenario(name).ok()?;
        Some(StoredScenario { named: named(&file.scenario, false), scenario: file.scenario, text: file.text })
    });
    let uploaded = uploaded(folder).into_iter().filter_map(|path| {
        let text = files::read(&path).ok()?;
        let scenario = read(&path.display().to_string(), &text).ok()?;
        Some(StoredScenario { named: named(&scenario, true), scenario, text })
    });
    shipped.chain(uploaded).collect()
}

/// Finds a scenario by name.
pub fn find(folder: &Path, name: &str) -> Option<StoredScenario> {
    if !is_safe_file_name(name) {
        return None;
    }
    all(folder).into_iter().find(|job| job.named.name == name)
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

/// Parses an uploaded scenario. It cannot refer to other files.
pub fn read(file: &str, text: &str) -> Result<Scenario, AppError> {
    Ok(scenario::read(file, text, &no_siblings)?)
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
