//! Adds and removes marks on the timeline of a session.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::rubric::instructor;
use super::sessions::{folder, record};
use super::state::ServerState;
use crate::io::clock;
use crate::io::marks::{marks, save_marks};
use spandrel_text::text;
use spandrel_training::marks::{MAX_MARKS, MAX_TEXT_LEN, TimelineMark};
use spandrel_training::report::formatting::{self, parse_clock};

/// Adds a mark.
pub fn add(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let record = record(state, request, id)?;
    let folder = folder(state, request, id)?;
    let given = request.line_field("time", (1, 10))?;
    let t_s = parse_clock(given).filter(|t_s| (0.0..=record.seconds).contains(t_s)).ok_or_else(|| {
        let end = formatting::clock(record.seconds.floor());
        WebError::BadRequest(text!(request.visitor.language, "sessions-mark-time-invalid", value = given, end = end))
    })?;
    let (text, by) = (request.line_field("text", (1, MAX_TEXT_LEN))?.to_owned(), instructor(request)?.to_owned());
    {
        let _others_wait = lock(&state.marks);
        let mut all = marks(&folder)?;
        if all.len() >= MAX_MARKS {
            return Err(WebError::BadRequest(text!(request.visitor.language, "sessions-too-many-marks", most = MAX_MARKS)));
        }
        // The time identifies the mark, so it must be unique.
        let last = all.iter().map(|mark| mark.added_unix_us).max().unwrap_or_default();
        all.push(TimelineMark { t_s, text, by, added_unix_us: clock::unix_us().max(last + 1) });
        save_marks(&folder, all)?;
    }
    Ok(marks_section(id))
}

/// Removes a mark.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let folder = folder(state, request, id)?;
    let added: u64 = request.required_field("mark")?.parse().map_err(|_| WebError::NotFound)?;
    {
        let _others_wait = lock(&state.marks);
        let mut all = marks(&folder)?;
        let before = all.len();
        all.retain(|mark| mark.added_unix_us != added);
        if all.len() == before {
            return Err(WebError::NotFound);
        }
        save_marks(&folder, all)?;
    }
    Ok(marks_section(id))
}

fn marks_section(id: &str) -> WebResponse {
    WebResponse::redirect(&format!("/sessions/{id}#marks"))
}
