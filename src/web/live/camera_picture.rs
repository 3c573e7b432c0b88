//! The camera's view as a picture for browsers.

use super::picture::version;
use super::vehicle::LiveVehicle;
use super::vehicle_choice::select_vehicle;
use crate::web::request::WebRequest;
use crate::web::response::{HandlerResult, WebError, WebResponse};
use crate::web::state::ServerState;

/// First bytes of every JPEG file (ITU-T T.81, B.1.1.3: SOI, then a marker).
const JPEG_SIGNATURE: [u8; 3] = [0xff, 0xd8, 0xff];

/// Responds to an instructor with a vehicle's image.
pub fn show(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (_, live) = select_vehicle(state, request.visitor.language, request.query_param("vehicle"))?;
    respond_with_picture(live)
}

/// Responds with a vehicle's image.
///
/// # Errors
/// Returns an error if there is no current image.
pub fn respond_with_picture(live: &LiveVehicle) -> HandlerResult {
    let path = live.picture.as_deref().filter(|path| version(path).is_some()).ok_or(WebError::NotFound)?;
    let bytes = std::fs::read(path).map_err(|_| WebError::NotFound)?;
    // Serve only JPEG images, because the file could contain anything.
    if !bytes.starts_with(&JPEG_SIGNATURE) {
        return Err(WebError::NotFound);
    }
    Ok(WebResponse::picture(bytes))
}
