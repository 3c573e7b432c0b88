//! What a trainee sees of the own flight: the camera's picture. Map, cues and actions are the instructor's, for an assessment has none of them.

use super::vehicle::LiveVehicle;
use super::{camera_picture, picture};
use crate::web::lock::lock;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;
use serde_json::json;
use spandrel_training::web::live as pages;

/// The flight that this visitor flies just now.
fn flight<'a>(state: &'a ServerState, asked: &WebRequest) -> Option<&'a LiveVehicle> {
    let name = asked.visitor.name.as_ref()?;
    state.live.iter().find(|live| lock(&live.known.trainee).as_ref() == Some(name))
}

/// The page; it fills itself as soon as the visitor flies.
pub fn page(_: &ServerState, asked: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(pages::own_flight(&asked.visitor)))
}

/// Whether the visitor flies, and the name of the picture that is there now.
pub fn current(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let flight = flight(state, asked);
    let version = flight.and_then(|live| live.picture.as_deref()).and_then(picture::version);
    Ok(WebResponse::json(&json!({ "flying": flight.is_some(), "picture": version })))
}

/// The picture.
pub fn camera(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    camera_picture::of(flight(state, asked).ok_or(WebError::NotFound)?)
}
