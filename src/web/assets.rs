//! Serves the style sheet and the scripts.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use spandrel_training::web::assets;

/// Responds with a style sheet or a script.
pub fn file(_: &ServerState, request: &WebRequest) -> HandlerResult {
    let (text, kind) = assets::file(request.path_param("name")).ok_or(WebError::NotFound)?;
    Ok(WebResponse::asset(kind, text))
}
