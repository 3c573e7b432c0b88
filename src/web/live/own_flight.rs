//! A trainee's page for their own flight, which shows only the camera's view. The map, cues and actions are for
//! instructors, because trainees do not have them in an assessment.

use super::vehicle::LiveVehicle;
use super::{camera_picture, picture};
use crate::web::lock::lock;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;
use serde_json::json;
use spandrel_training::web::live as pages;

/// Returns the vehicle that this visitor is flying.
fn flight<'a>(state: &'a ServerState, request: &WebRequest) -> Option<&'a LiveVehicle> {
    let name = request.visitor.name.as_ref()?;
    state.live.iter().find(|live| lock(&live.known.trainee).as_ref() == Some(name))
}

/// Responds with the page, which displays the camera's view as soon as the visitor is flying.
pub fn page(_: &ServerState, request: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(pages::own_flight(&request.visitor)))
}

/// Reports whether the visitor is flying, and the version of the current camera image.
pub fn current(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let flight = flight(state, request);
    let version = flight.and_then(|live| live.picture.as_deref()).and_then(picture::version);
    Ok(WebResponse::json(&json!({ "flying": flight.is_some(), "picture": version })))
}

/// Responds with the camera image.
pub fn camera(state: &ServerState, request: &WebRequest) -> HandlerResult {
    camera_picture::respond_with_picture(flight(state, request).ok_or(WebError::NotFound)?)
}
