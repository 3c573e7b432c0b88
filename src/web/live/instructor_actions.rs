//! Converts the instructor's form fields to commands.

use super::command_queue::InstructorCommand;
use super::vehicle_choice::select_vehicle;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;
use serde_json::json;
use spandrel_mavlink::contract::practice::{DEFAULT_REWIND, MAX_TASK, PracticeRequest};
use spandrel_training::web::live::{self as pages, INJECTABLE_FAILURES};

/// Starts an instructor's action. The result appears later in the stream.
pub fn run_action(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (number, live) = select_vehicle(state, request.form_field("vehicle"))?;
    let command = parse_command(request)?;
    live.commands.send(command).map_err(|_| WebError::Failed("the live listener has stopped: restart the server".into()))?;
    let back = format!("/live?vehicle={number}");
    Ok(if request.expects_json { WebResponse::json(&json!({ "under_way": true })) } else { WebResponse::redirect(&back) })
}

fn task_number(request: &WebRequest) -> Result<u32, WebError> {
    let number = request.required_field("task")?.parse().ok();
    let allowed = || WebError::BadRequest(format!("task: invalid number (allowed: 1 to {MAX_TASK})"));
    number.filter(|number| (1..=MAX_TASK).contains(number)).ok_or_else(allowed)
}

fn parse_command(request: &WebRequest) -> Result<InstructorCommand, WebError> {
    match request.required_field("act")? {
        "note" => {
            let text = request.line_field("text", (1, pages::MAX_NOTE_LEN))?;
            Ok(InstructorCommand::Note(text.to_owned()))
        }
        "wind" => {
            let number = |name: &str, most: f64| {
                let value: Option<f64> = request.required_field(name)?.parse().ok();
                let allowed = || WebError::BadRequest(format!("{name}: invalid number (allowed: 0 to {most})"));
                value.filter(|value| (0.0..=most).contains(value)).ok_or_else(allowed)
            };
            Ok(InstructorCommand::Wind { speed_m_s: number("speed", pages::MAX_WIND_M_S)?, from_deg: number("from", 360.0)? })
        }
        "traffic" => Ok(InstructorCommand::Traffic { open: request.required_field("open")? == "yes" }),
        "practice" => Ok(InstructorCommand::Practice(match request.required_field("do")? {
            "freeze" => PracticeRequest::Freeze,
            "resume" => PracticeRequest::Resume,
            "rewind" => PracticeRequest::Rewind { by: DEFAULT_REWIND },
            "move" => PracticeRequest::MoveToTask { task: task_number(request)? },
            _ => return Err(WebError::BadRequest("do: unknown (allowed: freeze, resume, rewind, move)".into())),
        })),
        "failure" => {
            let key = request.required_field("unit")?;
            let unit = INJECTABLE_FAILURES.iter().find(|(name, ..)| *name == key);
            let (_, words, unit) = unit.ok_or_else(|| WebError::BadRequest("unit: unknown".into()))?;
            Ok(InstructorCommand::Failure { unit: *unit, words, fails: request.required_field("fails")? == "yes" })
        }
        _ => Err(WebError::BadRequest("act: unknown (allowed: note, wind, traffic, practice, failure)".into())),
    }
}
