//! Trainees' rubrics, and the page that edits the criteria.

use super::own_file::OwnFile;
use super::person::person;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::clock;
use axum::http::StatusCode;
use spandrel_text::{Language, text};
use spandrel_training::rubric::{DEFAULT_RUBRIC, Rubric, SignOffAction, SignOffEvent, read_rubric};
use spandrel_training::web::layout::Notice;
use spandrel_training::web::rubric::{self as pages, MAX_NAME_LEN, MAX_NOTE_LEN, RubricEditor, RubricPage};

/// The server's own rubric.
const OWN: OwnFile = OwnFile { folder: "rubric", name: "rubric.toml" };

/// Returns the rubric in use, and a note if the server's own rubric can't be used.
///
/// # Errors
/// Returns an error if the shipped rubric is invalid.
pub fn rubric_in_use(state: &ServerState, language: Language) -> Result<(Rubric, Option<String>), AppError> {
    let own = OWN.text(state).map(|text| text.map(|text| read_rubric(OWN.name, &text)));
    if let Ok(Some(Ok(rubric))) = own {
        return Ok((rubric, None));
    }
    let note = (!matches!(own, Ok(None))).then(|| text!(language, "people-rubric-invalid"));
    let shipped = read_rubric(OWN.name, DEFAULT_RUBRIC).map_err(|problems| AppError::failed(problems.to_string()))?;
    Ok((shipped, note))
}

/// Responds with a trainee's rubric.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let person = person(state, request)?;
    let (rubric, problem) = rubric_in_use(state, request.visitor.language)?;
    let events = state.database.sign_offs(&person.pseudonym)?;
    let about = RubricPage { trainee: &person.pseudonym, rubric: &rubric, events: &events, problem: problem.as_deref() };
    Ok(WebResponse::page(pages::rubric_page(&request.visitor, &about)))
}

/// Signs off a criterion, or withdraws a sign-off.
pub fn sign(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (language, person) = (request.visitor.language, person(state, request)?);
    let (rubric, _) = rubric_in_use(state, language)?;
    let criterion = rubric.criterion(request.required_field("criterion")?);
    let unknown = || WebError::BadRequest(text!(language, "web-error-unknown", field = "criterion"));
    let criterion = criterion.ok_or_else(unknown)?;
    let action = SignOffAction::from_word(request.required_field("action")?);
    let action = action.ok_or_else(|| WebError::unknown(language, "action", "signed_off, withdrawn"))?;
    let min = match action {
        SignOffAction::SignedOff => 0,
        SignOffAction::Withdrawn => 1,
    };
    let event = SignOffEvent {
        criterion: criterion.id.clone(),
        title: criterion.title.clone(),
        action,
        unix_us: clock::unix_us(),
        by: instructor(request)?.to_owned(),
        note: request.line_field("note", (min, MAX_NOTE_LEN))?.to_owned(),
    };
    if !state.database.add_sign_off(&person.pseudonym, &event)? {
        let title = criterion.shown_title(language);
        return Err(WebError::BadRequest(match action {
            SignOffAction::SignedOff => text!(language, "people-already-signed", criterion = title),
            SignOffAction::Withdrawn => text!(language, "people-already-withdrawn", criterion = title),
        }));
    }
    Ok(WebResponse::redirect(&format!("/trainees/{}/rubric#criterion-{}", person.pseudonym, criterion.id)))
}

/// Returns the instructor's name: the login, or the name in the form where nobody has to log in.
///
/// # Errors
/// Returns an error if the name in the form is missing or invalid.
pub fn instructor(request: &WebRequest) -> Result<&str, WebError> {
    match &request.visitor.name {
        Some(name) => Ok(name),
        None => request.line_field("by", (1, MAX_NAME_LEN)),
    }
}

/// Responds with the page that edits the criteria.
pub fn editor(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let own = OWN.text(state)?;
    let text = own.as_deref().unwrap_or(DEFAULT_RUBRIC);
    let problems = read_rubric(OWN.name, text).err().map(|problems| problems.to_string());
    let notice = problems.as_deref().map(|details| Notice { kind: "bad", text: "", details });
    let about = RubricEditor { text, own: own.is_some(), notice };
    Ok(WebResponse::page(pages::rubric_editor(&request.visitor, &about)))
}

/// Validates and saves the edited criteria.
pub fn save(state: &ServerState, request: &WebRequest) -> HandlerResult {
    // Browsers send line breaks as CR LF.
    let text = request.required_field("rubric")?.replace("\r\n", "\n");
    if let Err(problems) = read_rubric(OWN.name, &text) {
        let (words, problems) = (text!(request.visitor.language, "web-not-saved"), problems.to_string());
        let notice = Notice { kind: "bad", text: &words, details: &problems };
        let about = RubricEditor { text: &text, own: OWN.exists(state), notice: Some(notice) };
        let page = WebResponse::page(pages::rubric_editor(&request.visitor, &about));
        return Ok(page.with_status(StatusCode::UNPROCESSABLE_ENTITY));
    }
    OWN.save(state, &text)?;
    let words = text!(request.visitor.language, "people-rubric-saved");
    let about = RubricEditor { text: &text, own: true, notice: Some(Notice::good(&words)) };
    Ok(WebResponse::page(pages::rubric_editor(&request.visitor, &about)))
}

/// Deletes the server's own rubric.
pub fn reset(state: &ServerState, _: &WebRequest) -> HandlerResult {
    OWN.delete(state)?;
    Ok(WebResponse::redirect("/rubric"))
}
