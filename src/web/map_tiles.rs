//! Map tiles of the scenarios' sites, for ground stations.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::find;
use super::state::ServerState;
use crate::io::map_tiles::{LatestMap, MapTiles, address};
use std::sync::{Arc, TryLockError};

/// Time after which a client may ask again for a tile that could not be drawn at once, s.
const RETRY_AFTER_S: u64 = 1;

/// Responds with a tile. Everybody who reaches the server may see it, because ground stations cannot log in; it shows no
/// defects. Only one tile is drawn at a time, so that anonymous requests cannot keep the server from its other work.
pub fn tile(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let [zoom, column, row] = ["z", "x", "y"].map(|key| request.path_param(key));
    let place = address(zoom, column, row).ok_or(WebError::NotFound)?;
    let name = request.path_param("name");
    let known = lock(&state.map_tiles).as_ref().filter(|latest| latest.name == name).map(|latest| latest.tiles.clone());
    if let Some(bytes) = known.as_ref().and_then(|tiles| tiles.drawn(place)) {
        return Ok(WebResponse::map_tile(bytes));
    }
    let _one_at_a_time = match state.tile_drawing.try_lock() {
        Ok(guard) => guard,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        Err(TryLockError::WouldBlock) => return Err(WebError::Busy(RETRY_AFTER_S)),
    };
    let job = find(&state.scenarios, name).ok_or(WebError::NotFound)?;
    let tiles = known.filter(|tiles| tiles.scenario_crc() == job.scenario.crc).unwrap_or_else(|| {
        let tiles = Arc::new(MapTiles::new(job.scenario));
        *lock(&state.map_tiles) = Some(LatestMap { name: name.to_owned(), tiles: tiles.clone() });
        tiles
    });
    Ok(WebResponse::map_tile(tiles.draw(place)?))
}
