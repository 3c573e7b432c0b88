//! The instructor's page for a live flight.

use super::vehicle_choice::select_vehicle;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebResponse};
use crate::web::state::ServerState;
use spandrel_training::web::live as pages;

/// Responds with the instructor's live page. With several vehicles, the request must name one; otherwise, redirects to the
/// page with all of them.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    if state.live.is_empty() {
        return Ok(WebResponse::page(pages::live(&request.visitor, None, &pages::VehicleSelection::default())));
    }
    if state.live.len() > 1 && request.query_param("vehicle").is_none() {
        return Ok(WebResponse::redirect("/live/all"));
    }
    let (number, live) = select_vehicle(state, request.visitor.language, request.query_param("vehicle"))?;
    let drawings = live.known.drawings_in(request.visitor.language);
    let vehicles = state.live.iter().map(|live| live.vehicle.to_string()).collect();
    Ok(WebResponse::page(pages::live(&request.visitor, drawings.as_ref(), &pages::VehicleSelection { vehicles, number })))
}
