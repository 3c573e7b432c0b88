//! Scenarios: shipped and uploaded.

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::state::{State, is_plain};
use crate::errors::AppError;
use crate::files;
use crate::session_folder::replace;
use axum::http::StatusCode;
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::site::Site;
use spandrel_training::web::job::{self as pages, Named};
use std::path::{Path, PathBuf};

/// Uploaded scenarios that are kept at once.
const UPLOADS_MOST: usize = 200;
/// No seed moves the geometry.
const ANY_SEED: u64 = 0;

/// A scenario with its text.
pub struct Job {
    /// Name, title, origin.
    pub named: Named,
    /// The job.
    pub scenario: Scenario,
    /// Its file.
    pub text: String,
}

/// All of them: shipped, then uploaded.
pub fn all(folder: &Path) -> Vec<Job> {
    let shipped = files::scenario_names().into_iter().filter_map(|name| {
        let file = files::scenario(name).ok()?;
        Some(Job { named: named(&file.scenario, false), scenario: file.scenario, text: file.text })
    });
    let uploaded = uploaded(folder).into_iter().filter_map(|path| {
        let text = files::read(&path).ok()?;
        let scenario = read(&path.display().to_string(), &text).ok()?;
        Some(Job { named: named(&scenario, true), scenario, text })
    });
    shipped.chain(uploaded).collect()
}

/// One by its name.
fn find(folder: &Path, name: &str) -> Option<Job> {
    if !is_plain(name) {
        return None;
    }
    all(folder).into_iter().find(|job| job.named.name == name)
}

fn named(scenario: &Scenario, uploaded: bool) -> Named {
    Named { name: scenario.name.clone(), title: scenario.title.clone(), uploaded }
}

fn uploaded(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

/// Reads an uploaded text: it stands alone.
fn read(file: &str, text: &str) -> Result<Scenario, AppError> {
    let alone = |_: &str| Err("an uploaded scenario names no other file".to_owned());
    Ok(scenario::read(file, text, &alone)?)
}

/// The argument that names an uploaded scenario for the rest of the program, else the name itself.
pub fn argument(folder: &Path, name: &str) -> Result<String, Refusal> {
    let job = find(folder, name).ok_or_else(|| Refusal::Wrong("scenario: there is none of this name".into()))?;
    Ok(if job.named.uploaded { place(folder, name).display().to_string() } else { job.named.name })
}

fn place(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.toml"))
}

/// The list.
pub fn list(state: &State, asked: &Asked) -> Answered {
    listed(state, asked, None)
}

fn listed(state: &State, asked: &Asked, told: Option<(&str, &str)>) -> Answered {
    let named: Vec<Named> = all(&state.scenarios).into_iter().map(|job| job.named).collect();
    Ok(Answer::page(pages::list(&asked.visitor, &named, told)))
}

/// One.
pub fn one(state: &State, asked: &Asked) -> Answered {
    let job = find(&state.scenarios, asked.part("name")).ok_or(Refusal::NotFound)?;
    let site = Site::build(&job.scenario, ANY_SEED);
    Ok(Answer::page(pages::one(&asked.visitor, &job.named, &job.scenario, &site, &job.text)))
}

/// Takes one in, after all of it was checked.
pub fn upload(state: &State, asked: &Asked) -> Answered {
    match keep(state, asked) {
        Ok(name) => listed(state, asked, Some(("good", &format!("{name} is kept.")))),
        Err(AppError::Wrong(words)) => {
            Ok(listed(state, asked, Some(("bad", &words)))?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(error @ AppError::Failed(_)) => Err(error.into()),
    }
}

fn keep(state: &State, asked: &Asked) -> Result<String, AppError> {
    let upload = asked.upload.as_ref().ok_or_else(|| AppError::wrong("file: missing"))?;
    let shown: String = upload.name.chars().filter(|c| !c.is_control()).take(60).collect();
    let bytes = upload.file.bytes()?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|error| AppError::wrong(format!("{shown}: is not UTF-8 text (byte {})", error.valid_up_to())))?;
    let scenario = read(&shown, text)?;
    // The name goes into folder names; the reader of scenarios allows [a-z0-9-] alone.
    if !is_plain(&scenario.name) || scenario.name.len() > 60 {
        return Err(AppError::wrong(format!("{shown}: the name is too long (allowed: 60 characters)")));
    }
    if files::scenario_names().contains(&scenario.name.as_str()) {
        return Err(AppError::wrong(format!("{shown}: '{}' is the name of a shipped scenario; choose another", scenario.name)));
    }
    let target = place(&state.scenarios, &scenario.name);
    if !target.is_file() && uploaded(&state.scenarios).len() >= UPLOADS_MOST {
        return Err(AppError::wrong(format!("{UPLOADS_MOST} uploaded scenarios are kept already: take one away first")));
    }
    std::fs::create_dir_all(&state.scenarios)
        .map_err(|error| AppError::failed(format!("{}: cannot be made: {error}", state.scenarios.display())))?;
    replace(&target, text.as_bytes())?;
    Ok(scenario.name)
}

/// Takes an upload away.
pub fn remove(state: &State, asked: &Asked) -> Answered {
    let job = find(&state.scenarios, asked.part("name")).filter(|job| job.named.uploaded).ok_or(Refusal::NotFound)?;
    let path = place(&state.scenarios, &job.named.name);
    std::fs::remove_file(&path).map_err(|error| Refusal::Failed(format!("{}: cannot be removed: {error}", path.display())))?;
    Ok(Answer::to("/scenarios"))
}
