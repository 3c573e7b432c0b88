//! The scenario editor: opens, checks, saves and downloads the text of a scenario.

use super::editor_edits;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::safe_names::is_safe_file_name;
use super::scenario_library::{DEFAULT_VEHICLE, MAX_SCENARIO_BYTES, all, find, upload_path};
use super::scenario_store::{self, Expected, SaveError, version};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::files::{self, read_from_folder};
use axum::http::StatusCode;
use spandrel_model::scenario::edit;
use spandrel_model::scenario::values::ScenarioValues;
use spandrel_text::{Language, text};
use spandrel_training::scenario_check::CheckOptions;
use spandrel_training::web::layout::Notice;
use spandrel_training::web::placed_defects::{self, DefectOrder};
use spandrel_training::web::scenario_check_result::{CheckedScenario, check_text};
use spandrel_training::web::scenario_editor::{self as pages, EditorPage};
use spandrel_training::web::scenarios::ScenarioEntry;
use std::time::Duration;

/// Time after which a check begins no further step. Estimate: several times the time for the largest shipped scenario.
const CHECK_TIME: Duration = Duration::from_secs(10);
/// Scenario from which a new one starts if no other is chosen.
const DEFAULT_BASE: &str = "practice";

/// Responds with the editor for a copy of a scenario, or with the page that asks for the scenario to copy.
pub fn new(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (from, name) = (request.query_param("from"), request.query_param("name").unwrap_or_default());
    let Some(from) = from else {
        let named: Vec<ScenarioEntry> = all(&state.scenarios).into_iter().map(|job| job.named).collect();
        let base = request.query_param("base").unwrap_or(DEFAULT_BASE);
        return Ok(WebResponse::page(pages::new_page(&request.visitor, &named, (base, name))));
    };
    let base = find(&state.scenarios, from).ok_or(WebError::NotFound)?;
    let text = edit::copy(&base.text, name);
    let about = EditorPage { text: &text, opened: "", version: "", unsaved: true, notice: None, conflict: false, checked: None };
    Ok(WebResponse::page(pages::editor_page(&request.visitor, &about)))
}

/// Responds with the editor for an uploaded scenario. A shipped one can only be copied.
pub fn edit(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = request.path_param("name");
    if !is_safe_file_name(name) {
        return Err(WebError::NotFound);
    }
    if files::scenario_names().contains(&name) {
        return Ok(WebResponse::redirect(&format!("/scenarios/new?base={name}")));
    }
    let path = upload_path(&state.scenarios, name);
    if !path.is_file() {
        return Err(WebError::NotFound);
    }
    let text = files::read(&path)?;
    let saved = text!(request.visitor.language, "editor-saved");
    let notice = request.query_param("saved").map(|_| Notice::good(&saved));
    let about = EditorPage {
        text: &text,
        opened: name,
        version: &version(&text),
        unsaved: false,
        notice,
        conflict: false,
        checked: None,
    };
    Ok(WebResponse::page(pages::editor_page(&request.visitor, &about)))
}

/// Returns the text of a form's field. Browsers send line breaks as CR LF.
fn text_field(request: &WebRequest) -> Result<String, WebError> {
    let text = request.form_field("text").unwrap_or_default().replace("\r\n", "\n");
    if text.len() > MAX_SCENARIO_BYTES { Err(WebError::TooLarge(MAX_SCENARIO_BYTES)) } else { Ok(text) }
}

/// Applies edits to a text and checks it. Responds to the page's script with JSON, and to the button with the page.
pub fn check(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (begun, language) = (Stopwatch::start(), request.visitor.language);
    let text = text_field(request)?;
    let edits = editor_edits::parse(request.form_field("edits").unwrap_or("[]")).map_err(WebError::BadRequest)?;
    let (text, rejected) = match edit::apply(&text, &edits) {
        Ok(edited) if edited.len() > MAX_SCENARIO_BYTES => (text, Some(text!(language, "editor-too-large"))),
        Ok(edited) => (edited, None),
        Err(words) => (text, Some(text!(language, "editor-not-changed", reason = words))),
    };
    let (text, placement) = match request.form_field("defect") {
        Some(json) if rejected.is_none() => place_defect(state, text, json, language)?,
        Some(_) | None => (text, None),
    };
    let checked = CheckedScenario { rejected, placement, ..checked(state, text, begun, language)? };
    if request.expects_json {
        return Ok(WebResponse::json(&checked.json(language, request.form_field("shape").unwrap_or_default())));
    }
    respond_with_editor(request, &checked.text, (None, false), Some(&checked))
}

/// Places a defect. Returns the text, which is unchanged if the defect can't be there, and the words for the page.
fn place_defect(
    state: &ServerState,
    text: String,
    json: &str,
    language: Language,
) -> Result<(String, Option<Result<String, String>>), WebError> {
    let order = DefectOrder::parse(json).map_err(WebError::BadRequest)?;
    let siblings = |name: &str| read_from_folder(&state.scenarios, name);
    Ok(match placed_defects::place(&text, &siblings, &order, language) {
        Ok((edited, _)) if edited.len() > MAX_SCENARIO_BYTES => (text, Some(Err(text!(language, "editor-too-large")))),
        Ok((edited, words)) => (edited, Some(Ok(words))),
        Err(reason) => (text, Some(Err(reason))),
    })
}

fn checked(state: &ServerState, text: String, begun: Stopwatch, language: Language) -> Result<CheckedScenario, WebError> {
    let aircraft = files::vehicle(DEFAULT_VEHICLE)?.vehicle;
    let options = CheckOptions { aircraft: &aircraft, may_continue: &|| begun.elapsed() < CHECK_TIME, language };
    let siblings = |name: &str| read_from_folder(&state.scenarios, name);
    Ok(check_text(&file_name(&text), (text, &siblings), &options))
}

/// Returns the file name for messages and downloads.
fn file_name(text: &str) -> String {
    let values = ScenarioValues::read(text).unwrap_or_default();
    let name = values.get("name").filter(|name| is_safe_file_name(name)).unwrap_or("scenario");
    format!("{name}.toml")
}

fn respond_with_editor(
    request: &WebRequest,
    text: &str,
    (notice, conflict): (Option<Notice<'_>>, bool),
    checked: Option<&CheckedScenario>,
) -> HandlerResult {
    let field = |name: &str| request.form_field(name).unwrap_or_default();
    let opened = Some(field("opened")).filter(|name| is_safe_file_name(name)).unwrap_or_default();
    let about = EditorPage { text, opened, version: field("version"), unsaved: true, notice, conflict, checked };
    Ok(WebResponse::page(pages::editor_page(&request.visitor, &about)))
}

/// Validates and saves the text, under another name if the user asked for it.
pub fn save(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let mut text = text_field(request)?;
    let field = |name: &str| request.form_field(name).unwrap_or_default();
    if request.form_field("save_as").is_some() {
        text = edit::with_name(&text, field("new_name"));
    }
    let file = file_name(&text);
    let is_opened = file.strip_suffix(".toml") == Some(field("opened"));
    let expected = match (is_opened, field("overwrite")) {
        (true, "yes") => Expected::Anything,
        (true, _) => Expected::Version(field("version")),
        (false, _) => Expected::Absent,
    };
    let language = request.visitor.language;
    match scenario_store::save(state, language, (&file, &text), expected) {
        Ok(name) => Ok(WebResponse::redirect(&format!("/scenarios/{name}/edit?saved=yes"))),
        Err(SaveError::Conflict(words)) => {
            let words = text!(language, "editor-not-saved-because", reason = words);
            let told = (Some(Notice::bad(&words)), is_opened);
            Ok(respond_with_editor(request, &text, told, None)?.with_status(StatusCode::CONFLICT))
        }
        Err(SaveError::Refused(words)) => {
            let words = format!("{}\n{words}", text!(language, "web-not-saved"));
            let told = (Some(Notice::bad(&words)), false);
            Ok(respond_with_editor(request, &text, told, None)?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(SaveError::App(AppError::Wrong(details))) => {
            let words = text!(language, "web-not-saved");
            let told = (Some(Notice { kind: "bad", text: &words, details: &details }), false);
            Ok(respond_with_editor(request, &text, told, None)?.with_status(StatusCode::UNPROCESSABLE_ENTITY))
        }
        Err(SaveError::App(error @ (AppError::Failed(_) | AppError::Autopilot(..)))) => Err(error.into()),
    }
}

/// Responds with the text as a file.
pub fn download(_: &ServerState, request: &WebRequest) -> HandlerResult {
    let text = text_field(request)?;
    Ok(WebResponse::download(&file_name(&text), "application/toml", text.into_bytes()))
}
