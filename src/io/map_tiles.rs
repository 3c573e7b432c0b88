//! Map tiles of a job's site as PNG files, drawn when they are first requested.

use super::png::png;
use crate::errors::AppError;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_view::ground_photo::GroundColors;
use spandrel_view::site_map::{SiteMap, TileAddress};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Maximum number of tiles to keep (estimate: a ground station shows fewer than 100). A tile has at most 200 kB.
const MAX_TILES: usize = 300;

/// The tiles of one job.
#[derive(Debug)]
pub struct MapTiles {
    scenario: Scenario,
    site: Site,
    ground: Option<GroundColors>,
    /// The tiles that were drawn, oldest first.
    drawn: Mutex<VecDeque<(TileAddress, Vec<u8>)>>,
}

/// The job whose tiles were requested last.
#[derive(Debug)]
pub struct LatestMap {
    /// Name of the job.
    pub name: String,
    /// Its tiles.
    pub tiles: Arc<MapTiles>,
}

impl MapTiles {
    /// Builds the job's site.
    #[must_use]
    pub fn new(scenario: Scenario) -> Self {
        let site = Site::without_defects(&scenario);
        Self { ground: GroundColors::new(&scenario, &site), site, scenario, drawn: Mutex::default() }
    }

    /// Returns the CRC of the scenario.
    #[must_use]
    pub fn scenario_crc(&self) -> u32 {
        self.scenario.crc
    }

    /// Returns a tile that was drawn before.
    pub fn drawn(&self, address: TileAddress) -> Option<Vec<u8>> {
        let drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        drawn.iter().find(|(known, _)| *known == address).map(|(_, bytes)| bytes.clone())
    }

    /// Draws a tile and returns it as a PNG file.
    ///
    /// # Errors
    /// Returns an error if it cannot be encoded.
    pub fn draw(&self, address: TileAddress) -> Result<Vec<u8>, AppError> {
        let bytes = png(&SiteMap::new(&self.scenario, &self.site, self.ground.as_ref()).tile(address))?;
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        if drawn.len() >= MAX_TILES {
            drawn.pop_front();
        }
        drawn.push_back((address, bytes.clone()));
        Ok(bytes)
    }
}

/// Reads the address of a tile; `None` if it is invalid. `row` may end with ".png".
#[must_use]
pub fn address(zoom: &str, column: &str, row: &str) -> Option<TileAddress> {
    let row = row.strip_suffix(".png").unwrap_or(row);
    TileAddress::new(zoom.parse().ok()?, column.parse().ok()?, row.parse().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;

    #[test]
    fn exact_tiles_are_png_files_and_wrong_addresses_have_none() {
        let tiles = MapTiles::new(files::scenario("drill-hover").unwrap().scenario);
        let place = address("14", "8573", "5793.png").unwrap();
        assert_eq!(tiles.drawn(place), None);
        let first = tiles.draw(place).unwrap();
        assert_eq!(&first[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!((address("14", "8573", "5793"), tiles.drawn(place)), (Some(place), Some(first)));
        for (zoom, column, row) in [("x", "0", "0"), ("3", "8", "0"), ("3", "0", "-1"), ("23", "0", "0"), ("3", "0", "1.jpg")] {
            assert_eq!(address(zoom, column, row), None, "{zoom}/{column}/{row}");
        }
    }
}
