//! Reads the terrain of a scenario: its extent, its heights and the photograph on it.

use super::job::{TerrainSource, TerrainSpec};
use super::siblings::{SiblingLoader, sibling_text};
use crate::geodesy::LocalPlane;
use crate::raster::elevation::{Elevation, SiteGrid};
use crate::raster::ground_photo::GroundPhoto;
use crate::toml::{Reader, Section};

/// Maximum number of height grid cells per side. Building 4 million cells takes about one second and 32 MB.
const MAX_CELLS_PER_SIDE: f64 = 2_000.0;
/// Maximum width of the terrain, m.
pub const MAX_TERRAIN_M: f64 = 4_000.0;
/// Maximum height above or below the origin, m.
const MAX_HEIGHT_M: f64 = 1_000.0;
/// Heights up to this much above the water level are water, m (estimate: elevation models show lakes and rivers as level surfaces, at the
/// water level of the day of the survey).
const FLAT_WATER_M: f64 = 0.2;
/// Name of the table, and keys that the checksum of a job refers to or that name files.
pub(super) const TABLE: &str = "terrain";
pub(super) const SOURCE: &str = "source";
pub(super) const FILE: &str = "file";
const PHOTO: &str = "photo";
/// Value of the source for an elevation model.
pub(super) const GEOTIFF: &str = "geotiff";

#[derive(Clone, Copy)]
enum TerrainSourceKind {
    Flat,
    Valley,
    File,
    GeoTiff,
}

/// Reads the terrain. `plane` is at the origin of the site.
pub(super) fn read(r: &mut Reader, root: &mut Section, plane: &LocalPlane, siblings: SiblingLoader) -> TerrainSpec {
    let mut s = r.section(root, TABLE);
    let before = r.problems.len();
    let size_m = r.number(&mut s, "size_m", (50.0, MAX_TERRAIN_M), Some(800.0));
    let spacing_m = r.number(&mut s, "spacing_m", (1.0, 50.0), Some(4.0));
    if size_m / spacing_m > MAX_CELLS_PER_SIDE {
        let allowed = format!("at least {} for this size_m", size_m / MAX_CELLS_PER_SIDE);
        r.add_problem(&s, "spacing_m", &spacing_m.to_string(), &allowed, "more than 2000 cells per side");
    }
    let water_level_m = r.number(&mut s, "water_level_m", (-500.0, 500.0), Some(-100.0));
    let source = r.keyword(
        &mut s,
        SOURCE,
        &[
            ("flat", TerrainSourceKind::Flat),
            ("valley", TerrainSourceKind::Valley),
            ("file", TerrainSourceKind::File),
            (GEOTIFF, TerrainSourceKind::GeoTiff),
        ],
        Some(0),
    );
    let source = match source {
        TerrainSourceKind::Flat => TerrainSource::Flat { height_m: r.number(&mut s, "height_m", (-500.0, 500.0), Some(0.0)) },
        TerrainSourceKind::Valley => TerrainSource::Valley {
            seed: r.integer(&mut s, "seed", (0, i64::from(i32::MAX)), Some(1)) as u64,
            lake_width_m: r.number(&mut s, "lake_width_m", (20.0, 2_000.0), Some(180.0)),
            axis_deg: r.number(&mut s, "axis_deg", (0.0, 360.0), Some(0.0)),
            mountain_height_m: r.number(&mut s, "relief_m", (0.0, 1_000.0), Some(120.0)),
            lake_depth_m: r.number(&mut s, "lake_depth_m", (0.5, 100.0), Some(8.0)),
        },
        TerrainSourceKind::File => read_height_file(r, &mut s, siblings),
        TerrainSourceKind::GeoTiff => {
            let grid = SiteGrid { side: (size_m / spacing_m).round().max(1.0) as usize + 1, spacing_m };
            read_elevation(r, &mut s, (plane, grid, water_level_m), (siblings, before))
        }
    };
    let photo = read_photo(r, &mut s, plane, siblings);
    r.finish(&s);
    TerrainSpec { size_m, spacing_m, water_level_m, source, photo }
}

fn read_height_file(r: &mut Reader, s: &mut Section, siblings: SiblingLoader) -> TerrainSource {
    let before = r.problems.len();
    let file = r.text(s, FILE, None);
    if r.problems.len() > before {
        return TerrainSource::Flat { height_m: 0.0 };
    }
    let rows = sibling_text(siblings, &file).and_then(|text| parse_heights(&text));
    let heights_m = rows.unwrap_or_else(|problem| {
        r.add_problem(s, FILE, &file, "rows of comma-separated heights in meters", &problem);
        vec![vec![0.0]]
    });
    TerrainSource::File { heights_m }
}

/// Reads the heights of a real site at the places of the terrain's grid. `before` is the number of problems before the terrain.
fn read_elevation(
    r: &mut Reader,
    s: &mut Section,
    (plane, grid, water_level_m): (&LocalPlane, SiteGrid, f64),
    (siblings, before): (SiblingLoader, usize),
) -> TerrainSource {
    let file = r.text(s, FILE, None);
    let offset_m = r.number(s, "offset_m", (-200.0, 200.0), Some(0.0));
    let water_depth_m = r.number(s, "water_depth_m", (0.0, 100.0), Some(5.0));
    if r.problems.len() > before {
        return TerrainSource::Flat { height_m: 0.0 };
    }
    let elevation = siblings(&file).and_then(|bytes| Elevation::read(&bytes));
    let heights_m = elevation.and_then(|elevation| elevation.heights_on_grid(plane, grid)).and_then(|mut rows| {
        for height_m in rows.iter_mut().flatten() {
            *height_m += offset_m;
            if *height_m <= water_level_m + FLAT_WATER_M {
                *height_m = water_level_m - water_depth_m;
            }
        }
        check_heights(&rows)?;
        Ok(rows)
    });
    let heights_m = heights_m.unwrap_or_else(|problem| {
        r.add_problem(s, FILE, &file, "a GeoTIFF file with heights for the whole terrain", &problem);
        vec![vec![0.0]]
    });
    TerrainSource::File { heights_m }
}

/// Reads the aerial photograph on the ground.
fn read_photo(r: &mut Reader, s: &mut Section, plane: &LocalPlane, siblings: SiblingLoader) -> Option<GroundPhoto> {
    let file = r.text(s, PHOTO, Some(""));
    if file.is_empty() {
        return None;
    }
    match siblings(&file).and_then(|bytes| GroundPhoto::new(file.clone(), bytes, plane)) {
        Ok(photo) => Some(photo),
        Err(problem) => {
            r.add_problem(s, PHOTO, &file, "a GeoTIFF file with colors", &problem);
            None
        }
    }
}

/// Checks that the heights are near the origin, like all places of a site.
fn check_heights(rows: &[Vec<f64>]) -> Result<(), String> {
    let far = rows.iter().flatten().find(|height| !height.is_finite() || height.abs() > MAX_HEIGHT_M);
    far.map_or(Ok(()), |height| Err(format!("a height of {height:.0} m above the origin (allowed: within {MAX_HEIGHT_M:.0} m)")))
}

fn parse_heights(text: &str) -> Result<Vec<Vec<f64>>, String> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (k, line) in text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty()) {
        let row: Result<Vec<f64>, _> = line.split(',').map(|cell| cell.trim().parse::<f64>()).collect();
        let row = row.map_err(|e| format!("row {}: {e}", k + 1))?;
        if row.iter().any(|h| !h.is_finite() || h.abs() > MAX_HEIGHT_M) {
            return Err(format!("row {}: heights must be within 1000 m of the origin", k + 1));
        }
        if rows.first().is_some_and(|first| first.len() != row.len()) {
            return Err(format!("row {} has {} columns, but the first row has {}", k + 1, row.len(), rows[0].len()));
        }
        rows.push(row);
    }
    if rows.len() < 2 || rows[0].len() < 2 { Err("fewer than two rows or columns".into()) } else { Ok(rows) }
}
