//! Pages for the shipped and uploaded scenarios.

use super::lock::lock;
use super::picture_store::{addresses, remove_unlisted};
use super::request::{WebRequest, not_text};
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::{DEFAULT_VEHICLE, all, find, upload_path};
use super::scenario_store::{Expected, SaveError, save, version};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::files;
use axum::http::StatusCode;
use spandrel_model::site::Site;
use spandrel_text::text;
use spandrel_training::briefing::Briefing;
use spandrel_training::web::layout::Notice;
use spandrel_training::web::scenarios::{self as pages, ScenarioEntry, ScenarioPage};

/// Responds with the list of scenarios.
pub fn scenario_list(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_list(state, request, None)
}

fn render_list(state: &ServerState, request: &WebRequest, told: Option<Notice<'_>>) -> HandlerResult {
    let named: Vec<ScenarioEntry> = all(&state.scenarios).into_iter().map(|job| job.named).collect();
    Ok(WebResponse::page(pages::list(&request.visitor, &named, told)))
}

/// Responds with a scenario's page, including drawings of its site.
pub fn scenario_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_scenario(state, request, None)
}

/// Responds with a scenario's page and the result of a change.
pub fn render_scenario(state: &ServerState, request: &WebRequest, notice: Option<Notice<'_>>) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).ok_or(WebError::NotFound)?;
    let site = Site::without_defects(&job.scenario);
    let about = ScenarioPage {
        named: &job.named,
        scenario: &job.scenario,
        site: &site,
        text: &job.text,
        version: &version(&job.text),
        pictures: &addresses(&state.scenarios, &job),
        notice,
    };
    Ok(WebResponse::page(pages::scenario_page(&request.visitor, &about)))
}

/// Responds with the briefing for a scenario.
pub fn briefing_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).ok_or(WebError::NotFound)?;
    let site = Site::without_defects(&job.scenario);
    let vehicle = files::vehicle(DEFAULT_VEHICLE)?.vehicle;
    let briefing = Briefing::new(&job.scenario, &vehicle, &site, request.visitor.language);
    let pictures = addresses(&state.scenarios, &job);
    Ok(WebResponse::page(pages::briefing_page(&request.visitor, &briefing, (&job.scenario, &site), &pictures)))
}

/// Validates and saves an uploaded scenario.
pub fn upload(state: &ServerState, request: &WebRequest) -> HandlerResult {
    match save_upload(state, request) {
        Ok(name) => {
            let words = text!(request.visitor.language, "editor-upload-saved", name = name);
            render_list(state, request, Some(Notice::good(&words)))
        }
        Err(SaveError::Conflict(words) | SaveError::Refused(words)) => {
            Ok(render_list(state, request, Some(Notice::bad(&words)))?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(SaveError::App(AppError::Wrong(details))) => {
            let notice = Notice { kind: "bad", text: "", details: &details };
            Ok(render_list(state, request, Some(notice))?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(SaveError::App(error @ (AppError::Failed(_) | AppError::Autopilot(..)))) => Err(error.into()),
    }
}

fn save_upload(state: &ServerState, request: &WebRequest) -> Result<String, SaveError> {
    let language = request.visitor.language;
    let missing = || SaveError::Refused(text!(language, "web-error-missing", field = "file"));
    let upload = request.upload.as_ref().ok_or_else(missing)?;
    let (shown, bytes) = (upload.shown_name(), upload.file.bytes()?);
    let text = std::str::from_utf8(&bytes);
    let text = text.map_err(|error| SaveError::Refused(not_text(language, &shown, error)))?;
    save(state, language, (&shown, text), Expected::Anything)
}

/// Removes an uploaded scenario and its pictures.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let _writing = lock(&state.scenario_writing);
    let job = find(&state.scenarios, request.path_param("name")).filter(|job| job.named.uploaded).ok_or(WebError::NotFound)?;
    let path = upload_path(&state.scenarios, &job.named.name);
    std::fs::remove_file(&path).map_err(|error| WebError::Failed(format!("{}: cannot remove: {error}", path.display())))?;
    remove_unlisted(&state.scenarios, &job.named.name, &[]);
    Ok(WebResponse::redirect("/scenarios"))
}
