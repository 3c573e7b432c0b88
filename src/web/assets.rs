//! Serves the style sheet and the scripts.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use spandrel_training::web::assets;

/// Responds with an asset of the pages.
pub fn file(_: &ServerState, request: &WebRequest) -> HandlerResult {
    let (text, kind) = assets::file(request.path_param("name")).ok_or(WebError::NotFound)?;
    Ok(WebResponse::asset(kind, text))
}
