//! Pages for the shipped and uploaded scenarios.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::{DEFAULT_VEHICLE, all, find, upload_path};
use super::scenario_store::{Expected, SaveError, save};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::files;
use axum::http::StatusCode;
use spandrel_model::site::Site;
use spandrel_text::Language;
use spandrel_training::briefing::Briefing;
use spandrel_training::web::scenarios::{self as pages, ScenarioEntry};

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
    let briefing = Briefing::new(&job.scenario, &vehicle, &site, Language::English);
    Ok(WebResponse::page(pages::briefing_page(&request.visitor, &briefing, &job.scenario, &site)))
}

/// Validates and saves an uploaded scenario.
pub fn upload(state: &ServerState, request: &WebRequest) -> HandlerResult {
    match save_upload(state, request) {
        Ok(name) => render_list(state, request, Some(("good", &format!("{name} was saved.")))),
        Err(SaveError::Conflict(words) | SaveError::App(AppError::Wrong(words))) => {
            Ok(render_list(state, request, Some(("bad", &words)))?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(SaveError::App(error @ (AppError::Failed(_) | AppError::Autopilot(..)))) => Err(error.into()),
    }
}

fn save_upload(state: &ServerState, request: &WebRequest) -> Result<String, SaveError> {
    let upload = request.upload.as_ref().ok_or_else(|| AppError::invalid("file: missing"))?;
    let shown: String = upload.name.chars().filter(|c| !c.is_control()).take(60).collect();
    let bytes = upload.file.bytes()?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|error| AppError::invalid(format!("{shown}: not UTF-8 text (byte {})", error.valid_up_to())))?;
    save(state, &shown, text, Expected::Anything)
}

/// Removes an uploaded scenario.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).filter(|job| job.named.uploaded).ok_or(WebError::NotFound)?;
    let path = upload_path(&state.scenarios, &job.named.name);
    std::fs::remove_file(&path).map_err(|error| WebError::Failed(format!("{}: cannot remove: {error}", path.display())))?;
    Ok(WebResponse::redirect("/scenarios"))
}
