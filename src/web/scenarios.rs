//! Pages for the shipped and uploaded scenarios.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::safe_names::is_safe_file_name;
use super::scenario_library::{all, find, read, upload_path, uploaded};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::files;
use crate::io::replace::replace;
use axum::http::StatusCode;
use spandrel_model::site::Site;
use spandrel_training::briefing::Briefing;
use spandrel_training::web::scenarios::{self as pages, ScenarioEntry};

/// Maximum number of uploaded scenarios.
const MAX_UPLOADS: usize = 200;
/// Aircraft of the briefing, as in the other commands.
const DEFAULT_VEHICLE: &str = "phantom2";

/// Responds with the list of scenarios.
pub fn scenario_list(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_list(state, request, None)
}

fn render_list(state: &ServerState, request: &WebRequest, told: Option<(&str, &str)>) -> HandlerResult {
    let named: Vec<ScenarioEntry> = all(&state.scenarios).into_iter().map(|job| job.named).collect();
    Ok(WebResponse::page(pages::list(&request.visitor, &named, told)))
}

/// Responds with a scenario's page, including drawings of its site.
pub fn scenario_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).ok_or(WebError::NotFound)?;
    let site = Site::without_defects(&job.scenario);
    Ok(WebResponse::page(pages::scenario_page(&request.visitor, &job.named, &job.scenario, &site, &job.text)))
}

/// Responds with the briefing for a scenario.
pub fn briefing_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).ok_or(WebError::NotFound)?;
    let site = Site::without_defects(&job.scenario);
    let vehicle = files::vehicle(DEFAULT_VEHICLE)?.vehicle;
    let briefing = Briefing::new(&job.scenario, &vehicle, &site);
    Ok(WebResponse::page(pages::briefing_page(&request.visitor, &briefing, &job.scenario, &site)))
}

/// Validates and saves an uploaded scenario.
pub fn upload(state: &ServerState, request: &WebRequest) -> HandlerResult {
    match save_upload(state, request) {
        Ok(name) => render_list(state, request, Some(("good", &format!("{name} was saved.")))),
        Err(AppError::Wrong(words)) => {
            Ok(render_list(state, request, Some(("bad", &words)))?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(error @ (AppError::Failed(_) | AppError::Autopilot(..))) => Err(error.into()),
    }
}

fn save_upload(state: &ServerState, request: &WebRequest) -> Result<String, AppError> {
    let upload = request.upload.as_ref().ok_or_else(|| AppError::invalid("file: missing"))?;
    let shown: String = upload.name.chars().filter(|c| !c.is_control()).take(60).collect();
    let bytes = upload.file.bytes()?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|error| AppError::invalid(format!("{shown}: not UTF-8 text (byte {})", error.valid_up_to())))?;
    let scenario = read(&shown, text)?;
    // The name becomes part of folder names; the scenario parser allows only [a-z0-9-].
    if !is_safe_file_name(&scenario.name) || scenario.name.len() > 60 {
        return Err(AppError::invalid(format!("{shown}: the name is too long (allowed: 60 characters)")));
    }
    if files::scenario_names().contains(&scenario.name.as_str()) {
        return Err(AppError::invalid(format!("{shown}: '{}' is the name of a shipped scenario; choose another", scenario.name)));
    }
    let target = upload_path(&state.scenarios, &scenario.name);
    if !target.is_file() && uploaded(&state.scenarios).len() >= MAX_UPLOADS {
        return Err(AppError::invalid(format!("there are already {MAX_UPLOADS} uploaded scenarios: remove one first")));
    }
    std::fs::create_dir_all(&state.scenarios)
        .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", state.scenarios.display())))?;
    replace(&target, text.as_bytes())?;
    Ok(scenario.name)
}

/// Removes an uploaded scenario.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).filter(|job| job.named.uploaded).ok_or(WebError::NotFound)?;
    let path = upload_path(&state.scenarios, &job.named.name);
    std::fs::remove_file(&path).map_err(|error| WebError::Failed(format!("{}: cannot remove: {error}", path.display())))?;
    Ok(WebResponse::redirect("/scenarios"))
}
