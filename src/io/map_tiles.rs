//! Map tiles of a job's site as PNG files, drawn when they are first requested.

use super::png::png;
use crate::errors::AppError;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_view::site_map::{SiteMap, TileAddress};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Maximum number of tiles to keep (estimate: about 20 MB; a ground station shows fewer than 100).
const MAX_TILES: usize = 1_000;
/// Seed for building the site; the tiles do not show what depends on it.
const ANY_SEED: u64 = 0;

/// The tiles of one job.
#[derive(Debug)]
pub struct MapTiles {
    scenario: Scenario,
    site: Site,
    drawn: Mutex<BTreeMap<(u8, u32, u32), Vec<u8>>>,
}

impl MapTiles {
    /// Builds the job's site.
    #[must_use]
    pub fn new(scenario: Scenario) -> Self {
        let site = Site::build(&scenario, ANY_SEED);
        Self { scenario, site, drawn: Mutex::default() }
    }

    /// Returns the CRC of the scenario.
    #[must_use]
    pub fn scenario_crc(&self) -> u32 {
        self.scenario.crc
    }

    /// Returns a tile as a PNG file; `None` if the address is invalid. `row` may end with ".png".
    pub fn tile(&self, zoom: &str, column: &str, row: &str) -> Option<Result<Vec<u8>, AppError>> {
        let row = row.strip_suffix(".png").unwrap_or(row);
        let key = (zoom.parse().ok()?, column.parse().ok()?, row.parse().ok()?);
        let address = TileAddress::new(key.0, key.1, key.2)?;
        let known = self.drawn.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        Some(match known {
            Some(bytes) => Ok(bytes),
            None => self.draw(key, address),
        })
    }

    fn draw(&self, key: (u8, u32, u32), address: TileAddress) -> Result<Vec<u8>, AppError> {
        let bytes = png(&SiteMap::new(&self.scenario, &self.site).tile(address))?;
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        if drawn.len() >= MAX_TILES {
            drawn.pop_first();
        }
        drawn.insert(key, bytes.clone());
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;

    #[test]
    fn exact_tiles_are_png_files_and_wrong_addresses_have_none() {
        let tiles = MapTiles::new(files::scenario("drill-hover").unwrap().scenario);
        let first = tiles.tile("14", "8573", "5793.png").unwrap().unwrap();
        assert_eq!(&first[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(tiles.tile("14", "8573", "5793").unwrap(), Ok(first), "the same tile from memory");
        for (zoom, column, row) in [("x", "0", "0"), ("3", "8", "0"), ("3", "0", "-1"), ("23", "0", "0"), ("3", "0", "1.jpg")] {
            assert_eq!(tiles.tile(zoom, column, row), None, "{zoom}/{column}/{row}");
        }
    }
}
