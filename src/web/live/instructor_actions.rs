//! Converts the instructor's form fields to commands.

use super::instructor_command::InstructorCommand;
use super::vehicle_choice::select_vehicle;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;
use serde_json::json;
use spandrel_mavlink::contract::practice::{DEFAULT_REWIND, MAX_TASK, PracticeRequest};
use spandrel_mavlink::contract::walk::{MAX_PLACE, WalkRequest};
use spandrel_text::text;
use spandrel_training::web::live::{self as pages, FailingUnit};
use std::str::FromStr;

/// Starts an instructor's action. The result appears later in the stream.
pub fn run_action(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (number, live) = select_vehicle(state, request.visitor.language, request.form_field("vehicle"))?;
    let command = parse_command(request)?;
    live.commands.send(command).map_err(|_| WebError::Failed("the live listener has stopped: restart the server".into()))?;
    let back = format!("/live?vehicle={number}");
    Ok(if request.expects_json { WebResponse::json(&json!({ "under_way": true })) } else { WebResponse::redirect(&back) })
}

/// Returns the whole number in a field, from 1 to `most`.
fn number<N: FromStr + Into<u32> + PartialOrd + From<u8>>(request: &WebRequest, field: &str, most: N) -> Result<N, WebError> {
    let number: Option<N> = request.required_field(field)?.parse().ok();
    let number = number.filter(|number| (&N::from(1)..=&most).contains(&number));
    number.ok_or_else(|| WebError::not_in_range(request.visitor.language, field, 1, most.into()))
}

fn parse_command(request: &WebRequest) -> Result<InstructorCommand, WebError> {
    let language = request.visitor.language;
    match request.required_field("act")? {
        "note" => {
            let text = request.line_field("text", (1, pages::MAX_NOTE_LEN))?;
            Ok(InstructorCommand::Note(text.to_owned()))
        }
        "wind" => {
            let number = |name: &str, most: u32| {
                let value: Option<f64> = request.required_field(name)?.parse().ok();
                let allowed = || WebError::not_in_range(language, name, 0, most);
                value.filter(|value| (0.0..=f64::from(most)).contains(value)).ok_or_else(allowed)
            };
            Ok(InstructorCommand::Wind { speed_m_s: number("speed", pages::MAX_WIND_M_S)?, from_deg: number("from", 360)? })
        }
        "traffic" => Ok(InstructorCommand::Traffic { open: request.required_field("open")? == "yes" }),
        "practice" => Ok(InstructorCommand::Practice(match request.required_field("do")? {
            "freeze" => PracticeRequest::Freeze,
            "resume" => PracticeRequest::Resume,
            "rewind" => PracticeRequest::Rewind { by: DEFAULT_REWIND },
            "move" => PracticeRequest::MoveToTask { task: number(request, "task", MAX_TASK)? },
            _ => return Err(WebError::unknown(language, "do", "freeze, resume, rewind, move")),
        })),
        "walk" => Ok(InstructorCommand::Walk(WalkRequest { place: number(request, "place", MAX_PLACE)? })),
        "failure" => {
            let unit = FailingUnit::from_key(request.required_field("unit")?);
            let unit = unit.ok_or_else(|| WebError::BadRequest(text!(language, "web-error-unknown", field = "unit")))?;
            let fails = request.required_field("fails")? == "yes";
            Ok(InstructorCommand::Failure { unit, fails })
        }
        _ => Err(WebError::unknown(language, "act", "note, wind, traffic, practice, walk, failure")),
    }
}
