//! Pictures of the briefings of uploaded scenarios: shows, adds and removes them.

use super::lock::lock;
use super::picture_store::{picture_path, remove_unlisted, save_picture};
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::{MAX_SCENARIO_BYTES, StoredScenario, find};
use super::scenario_store::{Expected, SaveError, save_locked, version};
use super::scenarios::render_scenario;
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::picture_file::{PictureError, PictureFile};
use axum::http::StatusCode;
use spandrel_model::scenario::edit::{Edit, apply, with_briefing_picture};
use spandrel_model::scenario::{BriefingPicture, MAX_BRIEFING_PICTURES, MAX_CAPTION_CHARS};
use spandrel_text::{Language, text};
use spandrel_training::web::layout::Notice;
use std::sync::MutexGuard;

/// Returns the uploaded scenario of a request.
fn uploaded(state: &ServerState, request: &WebRequest) -> Result<StoredScenario, WebError> {
    find(&state.scenarios, request.path_param("name")).filter(|job| job.named.uploaded).ok_or(WebError::NotFound)
}

/// Responds with a picture of a scenario's briefing.
pub fn show(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = uploaded(state, request)?;
    let name = &job.named.name;
    let file = format!("{name}/{}", request.path_param("file"));
    let is_listed = job.scenario.briefing_pictures.iter().any(|picture| picture.file == file);
    let path = picture_path(&state.scenarios, name, &file).filter(|_| is_listed).ok_or(WebError::NotFound)?;
    let picture = PictureFile::read(&path).map_err(|_| WebError::NotFound)?;
    Ok(WebResponse::image(picture.info.format.media_type(), picture.bytes))
}

/// Adds an uploaded picture to a scenario's briefing.
pub fn add(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let writing = lock(&state.scenario_writing);
    let job = uploaded(state, request)?;
    let added = add_picture(state, &writing, request, &job);
    drop(writing);
    respond(state, request, added)
}

fn add_picture(
    state: &ServerState,
    writing: &MutexGuard<'_, ()>,
    request: &WebRequest,
    job: &StoredScenario,
) -> Result<(), SaveError> {
    let (language, name) = (request.visitor.language, &job.named.name);
    check_version(request, job)?;
    let caption = request.line_field("caption", (1, MAX_CAPTION_CHARS)).map_err(|error| refused(language, &error))?;
    let picture = uploaded_picture(request)?;
    if job.scenario.briefing_pictures.len() >= MAX_BRIEFING_PICTURES {
        return Err(SaveError::Refused(text!(language, "editor-briefing-picture-too-many", most = MAX_BRIEFING_PICTURES)));
    }
    let sent = request.upload.as_ref().map_or("", |upload| upload.name.as_str());
    let file = save_picture(&state.scenarios, &job.scenario, (sent, &picture))?;
    let entry = BriefingPicture { file, caption: caption.to_owned() };
    let text = with_briefing_picture(&job.text, &entry).map_err(AppError::failed)?;
    let saved = save_text(state, writing, request, (job, &text));
    if saved.is_err() {
        remove_unlisted(&state.scenarios, name, &job.scenario.briefing_pictures);
    }
    saved
}

/// Returns the uploaded picture.
fn uploaded_picture(request: &WebRequest) -> Result<PictureFile, SaveError> {
    let language = request.visitor.language;
    let upload = request.required_upload().map_err(|error| refused(language, &error))?;
    let picture = PictureFile::new(upload.file.bytes()?.into_owned());
    picture.map_err(|error| SaveError::Refused(unusable(language, &upload.shown_name(), &error)))
}

/// Returns the message about a file that is not a usable picture.
fn unusable(language: Language, file: &str, error: &PictureError) -> String {
    let (problem, width, height) = match *error {
        PictureError::WrongType => ("type", 0, 0),
        PictureError::Damaged | PictureError::Unreadable(_) | PictureError::TooLarge => ("damaged", 0, 0),
        PictureError::WrongSize(width, height) => ("size", width, height),
    };
    let (width, height) = (width.to_string(), height.to_string());
    text!(language, "editor-briefing-picture-unusable", file = file, problem = problem, width = width, height = height)
}

/// Converts an error about a form to one that is shown on the scenario's page.
fn refused(language: Language, error: &WebError) -> SaveError {
    SaveError::Refused(error.status_and_text(language).2)
}

/// Removes a picture from a scenario's briefing, and its file.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let writing = lock(&state.scenario_writing);
    let job = uploaded(state, request)?;
    let file = request.required_field("file")?;
    let index = job.scenario.briefing_pictures.iter().position(|picture| picture.file == file).ok_or(WebError::NotFound)?;
    let removed = check_version(request, &job).and_then(|()| {
        let edit = Edit::Remove { location: format!("briefing_pictures[{index}]") };
        let text = apply(&job.text, &[edit]).map_err(AppError::failed)?;
        save_text(state, &writing, request, (&job, &text))
    });
    drop(writing);
    respond(state, request, removed)
}

/// Checks that nobody has changed the scenario since the visitor opened its page.
fn check_version(request: &WebRequest, job: &StoredScenario) -> Result<(), SaveError> {
    if request.form_field("version") == Some(version(&job.text).as_str()) {
        return Ok(());
    }
    let name = job.named.name.as_str();
    Err(SaveError::Conflict(text!(request.visitor.language, "editor-briefing-picture-conflict", name = name)))
}

fn save_text(
    state: &ServerState,
    writing: &MutexGuard<'_, ()>,
    request: &WebRequest,
    (job, text): (&StoredScenario, &str),
) -> Result<(), SaveError> {
    let language = request.visitor.language;
    if text.len() > MAX_SCENARIO_BYTES {
        return Err(SaveError::Refused(text!(language, "editor-too-large")));
    }
    let shown = format!("{}.toml", job.named.name);
    save_locked((state, writing), language, (&shown, text), Expected::Anything).map(drop)
}

/// Responds with the scenario's page: again after a change, or with the reason why there was none.
fn respond(state: &ServerState, request: &WebRequest, changed: Result<(), SaveError>) -> HandlerResult {
    let show = |notice: Notice<'_>, status: StatusCode| -> HandlerResult {
        Ok(render_scenario(state, request, Some(notice))?.with_status(status))
    };
    match changed {
        Ok(()) => Ok(WebResponse::redirect(&format!("/scenarios/{}", request.path_param("name")))),
        Err(SaveError::Conflict(words)) => show(Notice::bad(&words), StatusCode::CONFLICT),
        Err(SaveError::Refused(words)) => show(Notice::bad(&words), StatusCode::UNPROCESSABLE_ENTITY),
        Err(SaveError::App(AppError::Wrong(details))) => {
            show(Notice { kind: "bad", text: "", details: &details }, StatusCode::UNPROCESSABLE_ENTITY)
        }
        Err(SaveError::App(error @ (AppError::Failed(_) | AppError::Autopilot(..)))) => Err(error.into()),
    }
}
