//! The scenarios of the server: shipped, then uploaded.

use super::response::WebError;
use super::safe_names::is_plain;
use crate::errors::AppError;
use crate::io::files;
use spandrel_model::scenario::{self, Scenario};
use spandrel_training::web::job::ScenarioEntry;
use std::path::{Path, PathBuf};

/// A scenario with its text.
pub struct StoredScenario {
    /// Name, title, origin.
    pub named: ScenarioEntry,
    /// The job.
    pub scenario: Scenario,
    /// Its file.
    pub text: String,
}

/// All of them: shipped, then uploaded.
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

/// One by its name.
pub fn find(folder: &Path, name: &str) -> Option<StoredScenario> {
    if !is_plain(name) {
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

/// Reads an uploaded text: it stands alone.
pub fn read(file: &str, text: &str) -> Result<Scenario, AppError> {
    let alone = |_: &str| Err("an uploaded scenario names no other file".to_owned());
    Ok(scenario::read(file, text, &alone)?)
}

/// The argument that names an uploaded scenario for the rest of the program, else the name itself.
pub fn argument(folder: &Path, name: &str) -> Result<String, WebError> {
    let job = find(folder, name).ok_or_else(|| WebError::BadRequest("scenario: there is none of this name".into()))?;
    Ok(if job.named.uploaded { place(folder, name).display().to_string() } else { job.named.name })
}

pub fn place(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.toml"))
}
