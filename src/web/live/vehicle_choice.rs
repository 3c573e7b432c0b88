//! Selects a vehicle by its number in a request.

use super::vehicle::LiveVehicle;
use crate::web::response::WebError;
use crate::web::state::ServerState;
use spandrel_text::{Language, text};

/// Returns the vehicle with this number (starting at 1), and the number. Without a number, returns the first vehicle.
///
/// # Errors
/// Returns an error if no vehicle is configured, or the number is too large.
pub fn select_vehicle<'a>(
    state: &'a ServerState,
    language: Language,
    word: Option<&str>,
) -> Result<(usize, &'a LiveVehicle), WebError> {
    if state.live.is_empty() {
        return Err(WebError::BadRequest(text!(language, "live-error-no-vehicle")));
    }
    let number = word.map_or(Some(1), |word| word.parse().ok());
    let found = number.and_then(|number: usize| Some((number, state.live.get(number.checked_sub(1)?)?)));
    found.ok_or_else(|| {
        let most = state.live.len();
        WebError::BadRequest(text!(language, "web-error-number", field = "vehicle", least = 1, most = most))
    })
}
