//! Map tiles of the scenarios' sites, for ground stations.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::find;
use super::state::ServerState;
use crate::io::map_tiles::MapTiles;
use std::sync::Arc;

/// Responds with a tile. Everybody who reaches the server may see it, because ground stations cannot log in; it shows no
/// defects.
pub fn tile(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let job = find(&state.scenarios, request.path_param("name")).ok_or(WebError::NotFound)?;
    let latest = lock(&state.map_tiles).clone();
    let tiles = match latest.filter(|tiles| tiles.scenario_crc() == job.scenario.crc) {
        Some(tiles) => tiles,
        None => {
            let tiles = Arc::new(MapTiles::new(job.scenario));
            *lock(&state.map_tiles) = Some(tiles.clone());
            tiles
        }
    };
    let address = ["z", "x", "y"].map(|key| request.path_param(key));
    let png = tiles.tile(address[0], address[1], address[2]).ok_or(WebError::NotFound)?;
    Ok(WebResponse::map_tile(png?))
}
