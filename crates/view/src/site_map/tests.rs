//! Tests of the map tiles.

use super::*;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::{scenario, shipped};

/// Largest error of the projection and its inverse, deg: about a millimeter.
const PROJECTION_TOLERANCE_DEG: f64 = 1e-8;

fn job() -> (Scenario, Site) {
    let scenario = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
    let site = Site::build(&scenario, 0);
    (scenario, site)
}

#[test]
fn val_tile_addresses_match_published_ones() {
    let at = |latitude_deg, longitude_deg, zoom| {
        let geo = Geo { latitude_deg, longitude_deg, altitude_m: 0.0 };
        TileAddress::containing(geo, zoom).map(|tile| (tile.zoom, tile.column, tile.row))
    };
    // The documentation of the Python package mercantile gives the north-west corner of tile 10/486/332: 9.140625 deg west,
    // 53.33087298301705 deg north.
    assert_eq!((at(53.3308, -9.1406, 10), at(53.3309, -9.1407, 10)), (Some((10, 486, 332)), Some((10, 485, 331))));
    assert_eq!((at(0.1, 0.1, 1), at(-0.1, -0.1, 1)), (Some((1, 1, 0)), Some((1, 0, 1))));
}

#[test]
fn exact_projection_and_its_inverse_agree() {
    for (latitude_deg, longitude_deg) in [(46.7, 8.38), (-33.9, 151.2), (0.0, 0.0), (70.0, -150.0)] {
        let geo = Geo { latitude_deg, longitude_deg, altitude_m: 0.0 };
        for zoom in [0, 10, 18, MAX_ZOOM] {
            let tile = TileAddress::containing(geo, zoom).unwrap();
            let (x, y) = tile.place(tile.geo_at(17, 200));
            // A pixel is 360 deg / (256 * 2^zoom) wide.
            let pixel_deg = 360.0 / world_px(zoom);
            assert!(((x - 17.5).abs() + (y - 200.5).abs()) * pixel_deg < PROJECTION_TOLERANCE_DEG, "{x} {y} at zoom {zoom}");
        }
    }
}

#[test]
fn exact_addresses_out_of_range_are_rejected() {
    assert_eq!(TileAddress::new(3, 8, 0), None);
    assert_eq!(TileAddress::new(3, 0, 8), None);
    assert_eq!(TileAddress::new(MAX_ZOOM + 1, 0, 0), None);
    assert_eq!(TileAddress::new(40, 0, 0), None);
    assert!(TileAddress::new(0, 0, 0).is_some() && TileAddress::new(MAX_ZOOM, (1 << 22) - 1, 0).is_some());
}

#[test]
fn exact_bridge_water_pad_and_paths_are_where_the_site_has_them() {
    let (scenario, site) = job();
    let map = SiteMap::new(&scenario, &site, None);
    let plane = LocalPlane::new(scenario.origin);
    let color = |point_m: Vec3<Enu>| {
        let geo = plane.geo_from_enu(point_m);
        let tile = TileAddress::containing(geo, 19).unwrap();
        let (x, y) = tile.place(geo);
        map.tile(tile).at(x as u32, y as u32)
    };
    let pad_m = scenario.ground_team.pad_m;
    assert_eq!(color(pad_m), WHITE);
    let path_m = scenario.tasks[0].path_m[scenario.tasks[0].path_m.len() / 2];
    assert_eq!(color(path_m), PATH_COLOR);
    let deck_m = scenario.bridges[1].center_m;
    let [red, green, blue] = color(deck_m);
    assert!(red.abs_diff(green) < 8 && green.abs_diff(blue) < 8, "the deck is gray: {red} {green} {blue}");
    let [red, _, blue] = color(deck_m + Vec3::new(0.0, -40.0, 0.0));
    assert!(blue > red + 20, "the water beside the bridge is blue: {red} {blue}");
    let far_m = Vec3::new(0.6 * scenario.terrain.size_m, 0.0, 0.0);
    assert_eq!(color(far_m), OUTSIDE_COLOR);
}

#[test]
fn exact_digits_are_legible_bit_by_bit() {
    let mut canvas = Canvas::new((TILE_PX, TILE_PX));
    canvas.disc((20.0, 20.0), MARK_RADIUS_PX, PATH_COLOR);
    canvas.number((20.0, 20.0), 1);
    let row = |y: u32| (17..23).step_by(2).map(|x| canvas.picture.at(x, y) == WHITE).collect::<Vec<_>>();
    assert_eq!((row(15), row(23)), (vec![false, true, false], vec![true, true, true]));
}
