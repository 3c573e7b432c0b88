//! Map tiles of the scenarios' sites, for ground stations.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::find;
use super::state::ServerState;
use crate::io::files;
use crate::io::map_tiles::{LatestMap, MapTiles, address};
use spandrel_model::scenario::Scenario;
use std::sync::{Arc, TryLockError};

/// Time after which a client may ask again for a tile that could not be drawn at once, s.
const RETRY_AFTER_S: u64 = 1;

/// Returns the job with a name: a shipped or uploaded one, or the server's own.
fn job(state: &ServerState, name: &str) -> Option<Scenario> {
    let own = || files::scenario(state.own_job.as_ref()?.to_str()?).ok().map(|file| file.scenario);
    find(&state.scenarios, name).map(|job| job.scenario).or_else(|| own().filter(|job| job.name == name))
}

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
    let job = job(state, name).ok_or(WebError::NotFound)?;
    let tiles = known.filter(|tiles| tiles.scenario_crc() == job.crc).unwrap_or_else(|| {
        let tiles = Arc::new(MapTiles::new(job));
        *lock(&state.map_tiles) = Some(LatestMap { name: name.to_owned(), tiles: tiles.clone() });
        tiles
    });
    Ok(WebResponse::map_tile(tiles.draw(place)?))
}

#[cfg(test)]
mod tests {
    use crate::records::RecordsLocation;
    use crate::web::{ListenConfig, ServerSetup, WebServer};

    /// First bytes of a PNG file.
    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

    #[test]
    fn wire_jobs_of_ones_own_have_tiles_and_unknown_tiles_are_not_found() {
        let folder = tempfile::tempdir().unwrap();
        let (sessions, own) = (folder.path().join("sessions"), folder.path().join("job.toml"));
        let named =
            |name: &str| spandrel_model::shipped::DRILL_HOVER.replace("name = \"drill-hover\"", &format!("name = \"{name}\""));
        std::fs::write(&own, named("own-job")).unwrap();
        let uploads = sessions.join(crate::web::scenario_library::UPLOAD_FOLDER);
        std::fs::create_dir_all(&uploads).unwrap();
        std::fs::write(uploads.join("uploaded-job.toml"), named("uploaded-job")).unwrap();
        let setup = ServerSetup {
            records_location: RecordsLocation::beside(&sessions),
            scenarios: None,
            own_job: Some(own),
            watched: Vec::new(),
            wordings: Vec::new(),
            station_key: None,
        };
        let server = WebServer::start(&ListenConfig::local(0), setup).unwrap();
        let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
        let ask = |path: &str| {
            let mut answer = agent.get(format!("{}/tiles/{path}", server.address())).call().unwrap();
            (answer.status().as_u16(), answer.body_mut().read_to_vec().unwrap())
        };
        for name in ["drill-hover", "uploaded-job", "own-job"] {
            let (status, body) = ask(&format!("{name}/14/8573/5793.png"));
            assert!(status == 200 && body.starts_with(PNG), "{name}: {status}");
        }
        for path in ["other-job/14/8573/5793.png", "job/14/8573/5793.png", "own-job/14/99999/5793.png", "own-job/14/8573/x.png"] {
            let (status, body) = ask(path);
            assert_eq!(status, 404, "{path}");
            assert!(String::from_utf8_lossy(&body).contains("Not found"), "{path}: the page must say so");
        }
    }
}
