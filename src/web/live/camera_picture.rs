//! The camera's view as a picture for browsers.

use super::picture::version;
use super::vehicle::LiveVehicle;
use super::vehicle_choice::chosen;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;

/// How every JPEG begins (ITU-T T.81, B.1.1.3: SOI, then a marker).
const JPEG: [u8; 3] = [0xff, 0xd8, 0xff];

/// The picture, for those who may watch the flight.
pub fn show(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let (_, live) = chosen(state, asked.query_value("vehicle"))?;
    of(live)
}

/// The picture of a flight.
///
/// # Errors
/// When there is none of now.
pub fn of(live: &LiveVehicle) -> HandlerResult {
    let path = live.picture.as_deref().filter(|path| version(path).is_some()).ok_or(WebError::NotFound)?;
    let bytes = std::fs::read(path).map_err(|_| WebError::NotFound)?;
    // Whatever else the file may hold, a browser gets pictures from here alone.
    if !bytes.starts_with(&JPEG) {
        return Err(WebError::NotFound);
    }
    Ok(WebResponse::picture(bytes))
}
