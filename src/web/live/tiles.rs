//! The instructor's page with a tile for each live flight.

use super::vehicle::LiveVehicle;
use crate::web::lock::lock;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;
use serde_json::{Value, json};
use spandrel_text::Language;
use spandrel_training::web::tiles::{VehicleTile, tiles_page};

/// Responds with the page.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let tile = |live: &LiveVehicle| {
        let drawings = live.known.drawings_in(request.visitor.language);
        VehicleTile { address: live.vehicle.to_string(), drawings }
    };
    let tiles: Vec<VehicleTile> = state.live.iter().map(tile).collect();
    Ok(WebResponse::page(tiles_page(&request.visitor, &tiles)))
}

/// Responds with the current values of all flights. Browsers limit the number of open streams, so the tiles poll.
pub fn current(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let vehicles = state.live.iter().map(|live| moment(live, request.visitor.language)).collect::<Result<Vec<_>, _>>()?;
    Ok(WebResponse::json(&json!({ "vehicles": vehicles })))
}

/// Returns a flight's current values, with the trainee and without the message log.
fn moment(live: &LiveVehicle, language: Language) -> Result<Value, WebError> {
    let text = live.moments.borrow().get(language).clone();
    let mut moment: Value = serde_json::from_str(&text).map_err(|error| WebError::Failed(error.to_string()))?;
    if let Some(values) = moment.as_object_mut() {
        values.remove("words");
    }
    moment["trainee"] = lock(&live.known.trainee).clone().into();
    Ok(moment)
}
