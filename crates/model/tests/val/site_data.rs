//! Elevation models and aerial photographs: positions agree with those of PROJ 9 (pyproj 3), and heights and colors arrive where they belong.

use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::raster::elevation::{Elevation, SiteGrid};
use spandrel_model::raster::ground_photo::GroundPhoto;
use spandrel_model::scenario::{Scenario, TerrainSource, read, variant_with_crc};
use std::io::Cursor;
use tiff::encoder::colortype::{ColorType, Gray32Float, GrayI16, RGBA8};
use tiff::encoder::{TiffEncoder, TiffValue};
use tiff::tags::Tag;

const ORIGIN: Geo = Geo { latitude_deg: 46.7052, longitude_deg: 8.3814, altitude_m: 430.0 };
/// The origin in three coordinate systems, from pyproj 3: UTM zone 32 north, the Swiss grid (another datum), Web Mercator. Meters.
const ORIGIN_ON_MAPS: [(u16, [f64; 2]); 3] = [
    (32632, [452_712.582_500_78, 5_172_590.702_069_66]),
    (2056, [2_672_095.717_815_69, 1_173_098.132_006_93]),
    (3857, [933_013.180_134_74, 5_894_087.261_882_73]),
];
/// Tolerance for positions, m: the rounding of heights, 1 mm, on a slope of 1 in 10, and 32-bit floats.
const POSITION_TOLERANCE_M: f64 = 0.01;
const UTM: (u16, [f64; 2]) = ORIGIN_ON_MAPS[0];
/// Rise of the ground to the north in the tests.
const SLOPE: f64 = 0.1;
const STEP_M: f64 = 10.0;
/// Pixels per side.
const SIDE: u32 = 31;

/// Place and form of a raster.
#[derive(Clone)]
struct Form {
    code: u16,
    model: u16,
    pixel_is_point: bool,
    /// Coordinates of the north-western corner, or of the first pixel's center if pixels are points.
    corner: [f64; 2],
    step: [f64; 2],
    vertical_unit: Option<u16>,
    no_data: Option<&'static str>,
}

impl Form {
    /// Returns a raster of 31 x 31 pixels of 10 m, whose middle pixel is at the origin.
    fn around((code, [x, y]): (u16, [f64; 2])) -> Self {
        let half = 0.5 * f64::from(SIDE) * STEP_M;
        let step = [STEP_M; 2];
        Self { code, model: 1, pixel_is_point: false, corner: [x - half, y + half], step, vertical_unit: None, no_data: None }
    }

    fn file<C: ColorType>(&self, side: u32, pixels: &[C::Inner]) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        let mut image = encoder.new_image::<C>(side, side).unwrap();
        let system = if self.model == 1 { 3072 } else { 2048 };
        let mut keys =
            vec![[1024, 0, 1, self.model], [1025, 0, 1, if self.pixel_is_point { 2 } else { 1 }], [system, 0, 1, self.code]];
        keys.extend(self.vertical_unit.map(|unit| [4099, 0, 1, unit]));
        let directory: Vec<u16> = [vec![[1, 1, 0, keys.len() as u16]], keys].concat().concat();
        let tags = image.encoder();
        tags.write_tag(Tag::GeoKeyDirectoryTag, &directory[..]).unwrap();
        tags.write_tag(Tag::ModelPixelScaleTag, &[self.step[0], self.step[1], 0.0][..]).unwrap();
        tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, self.corner[0], self.corner[1], 0.0][..]).unwrap();
        if let Some(text) = self.no_data {
            tags.write_tag(Tag::GdalNodata, text).unwrap();
        }
        image.write_data(pixels).unwrap();
        file.into_inner()
    }

    /// Returns the file of ground that is 430 m high in the middle and rises to the north.
    fn slope(&self) -> Vec<u8> {
        self.file::<Gray32Float>(SIDE, &slope())
    }
}

fn slope() -> Vec<f32> {
    let height = |k: u32| 430.0 + SLOPE * STEP_M * (f64::from(SIDE / 2) - f64::from(k / SIDE));
    (0..SIDE * SIDE).map(|k| height(k) as f32).collect()
}

fn plane() -> LocalPlane {
    LocalPlane::new(ORIGIN)
}

fn height_at_origin(bytes: &[u8]) -> f64 {
    Elevation::read(bytes).unwrap().height_m(ORIGIN).unwrap().unwrap()
}

#[test]
fn val_positions_agree_with_proj() {
    for place in ORIGIN_ON_MAPS {
        let height_m = height_at_origin(&Form::around(place).slope());
        assert!((height_m - 430.0).abs() < SLOPE * POSITION_TOLERANCE_M, "EPSG:{}: {height_m}", place.0);
    }
}

#[test]
fn exact_pixels_that_are_points_lie_half_a_pixel_to_the_north_west() {
    let form = Form { pixel_is_point: true, ..Form::around(UTM) };
    let height_m = height_at_origin(&form.slope());
    // The middle row is 5 m further north than with areas, so the origin is 5 m south of it.
    assert!((height_m - (430.0 - 0.5 * STEP_M * SLOPE)).abs() < SLOPE * POSITION_TOLERANCE_M, "{height_m}");
}

#[test]
fn exact_geographic_rasters_are_in_degrees() {
    let (step, half) = (1e-4, 0.5e-4 * f64::from(SIDE));
    let corner = [ORIGIN.longitude_deg - half, ORIGIN.latitude_deg + half];
    let form = Form { code: 4326, model: 2, corner, step: [step; 2], ..Form::around(UTM) };
    let elevation = Elevation::read(&form.slope()).unwrap();
    // Between the middle row and the one to the north.
    let geo = Geo { latitude_deg: ORIGIN.latitude_deg + 0.25 * step, ..ORIGIN };
    let height_m = elevation.height_m(geo).unwrap().unwrap();
    assert!((height_m - (430.0 + 0.25 * SLOPE * STEP_M)).abs() < 1e-4, "{height_m}");
}

#[test]
fn exact_heights_in_feet_become_meters() {
    for (unit, size_m) in [(9001, 1.0), (9002, 0.3048), (9003, 1_200.0 / 3_937.0)] {
        let form = Form { vertical_unit: Some(unit), ..Form::around(UTM) };
        let height_m = height_at_origin(&form.file::<GrayI16>(SIDE, &[500; 961]));
        assert!((height_m - 500.0 * size_m).abs() < 1e-4, "{unit}: {height_m}");
    }
}

#[test]
fn exact_grid_has_the_heights_above_the_origin() {
    let elevation = Elevation::read(&Form::around(UTM).slope()).unwrap();
    let rows = elevation.heights_on_grid(&plane(), SiteGrid { side: 11, spacing_m: 20.0 }).unwrap();
    for (k, row) in rows.iter().enumerate() {
        let north_m = 20.0 * (k as f64 - 5.0);
        for (column, up_m) in row.iter().enumerate() {
            let east_m = 20.0 * (column as f64 - 5.0);
            // UTM north differs from true north by the meridian convergence, -0.45 degrees here, and the scale of the map is 0.99963.
            let expected_m = SLOPE * (0.99963 * north_m - 0.00786 * east_m);
            assert!((up_m - expected_m).abs() < 0.01, "{east_m}, {north_m}: {up_m} instead of {expected_m}");
        }
    }
}

#[test]
fn regress_missing_heights_name_the_place() {
    let mut pixels = slope();
    pixels[0] = -9999.0;
    let form = Form { no_data: Some("-9999"), ..Form::around(UTM) };
    let elevation = Elevation::read(&form.file::<Gray32Float>(SIDE, &pixels)).unwrap();
    let grid = |side| elevation.heights_on_grid(&plane(), SiteGrid { side, spacing_m: 21.0 });
    assert!(grid(11).is_ok());
    // The grid reaches 147 m to the north-west, where the height is missing.
    let message = grid(15).unwrap_err();
    assert!(message.starts_with("no height -147 m east and 147 m north of the origin (46.706"), "{message}");
    // Beyond the file.
    let message = grid(21).unwrap_err();
    assert!(message.starts_with("no height -210 m east and -210 m north"), "{message}");
}

#[test]
fn regress_invalid_files_name_the_cause() {
    let read = |bytes: &[u8]| Elevation::read(bytes).err().unwrap();
    let form = Form::around(UTM);
    assert!(read(b"no picture").starts_with("not a TIFF file: "));
    assert!(read(&form.file::<RGBA8>(SIDE, &[0; 4 * 961])).ends_with("(allowed: one height per pixel)"));
    let unknown = Form { code: 1, ..form.clone() };
    assert!(read(&unknown.slope()).starts_with("coordinate system EPSG:1: "), "{}", read(&unknown.slope()));
    let own = Form { code: 32767, ..form.clone() };
    assert!(read(&own.slope()).starts_with("a coordinate system without an EPSG code"));
    let geocentric = Form { model: 3, ..form.clone() };
    assert!(read(&geocentric.slope()).starts_with("kind of coordinate system Some(3)"));
    let flat = Form { step: [0.0, 10.0], ..form.clone() };
    assert!(read(&flat.slope()).starts_with("a place without an area"));
    let unit = Form { vertical_unit: Some(9003 + 1), ..form };
    assert!(read(&unit.slope()).starts_with("heights in the unit 9004"));
}

#[test]
fn prop_damaged_files_never_cause_a_panic() {
    let file = Form::around(UTM).slope();
    let mut refused = 0;
    // The head and the tags. The encoder writes the tags behind the pixels.
    let places = (0..8).chain(file.len() - 700..file.len());
    for (at, value) in places.flat_map(|at| [0, 1, 127, 255].map(|value| (at, value))) {
        let mut damaged = file.clone();
        damaged[at] = value;
        refused += usize::from(Elevation::read(&damaged).is_err());
    }
    for length in (0..file.len()).step_by(37) {
        refused += usize::from(Elevation::read(&file[..length]).is_err());
    }
    assert!(refused > 200, "{refused}");
}

/// Returns a photograph of 300 m with a red, green, blue and invisible quarter: north-west, north-east, south-west, south-east.
fn quarters() -> Vec<u8> {
    let half = f64::from(SIDE - 1) * STEP_M * 0.5;
    let (_, [x, y]) = UTM;
    let form = Form { corner: [x - half, y + half], ..Form::around(UTM) };
    let side = SIDE - 1;
    let color = |k: u32| match (k / side < side / 2, k % side < side / 2) {
        (true, true) => [250, 0, 0, 255],
        (true, false) => [0, 250, 0, 255],
        (false, true) => [0, 0, 250, 255],
        (false, false) => [9, 9, 9, 0],
    };
    let pixels: Vec<u8> = (0..side * side).flat_map(color).collect();
    form.file::<RGBA8>(side, &pixels)
}

#[test]
fn exact_photograph_is_turned_to_the_site_and_invisible_outside() {
    let photo = GroundPhoto::new("photo.tif".into(), quarters(), &plane()).unwrap();
    let side = 64;
    let picture = photo.picture(&plane(), 600.0, side).unwrap();
    let at = |east_m: f64, north_m: f64| {
        let (column, row) = ((east_m / 600.0 + 0.5) * side as f64, (0.5 - north_m / 600.0) * side as f64);
        picture.pixels[row as usize * side + column as usize]
    };
    assert_eq!(at(-75.0, 75.0), [250, 0, 0, 255]);
    assert_eq!(at(75.0, 75.0), [0, 250, 0, 255]);
    assert_eq!(at(-75.0, -75.0), [0, 0, 250, 255]);
    assert_eq!(at(75.0, -75.0), [0; 4]);
    assert_eq!(at(-200.0, 0.0), [0; 4]);
}

#[test]
fn exact_colors_beside_missing_pixels_are_those_of_the_photograph() {
    let photo = GroundPhoto::new("photo.tif".into(), quarters(), &plane()).unwrap();
    let picture = photo.picture(&plane(), 300.0, 256).unwrap();
    let colors = [[250, 0, 0], [0, 250, 0], [0, 0, 250]];
    // In a mixture of two quarters, the parts add up to the brightness of one. A missing pixel would make it darker.
    let sum = |color: &[u8; 4]| color[..3].iter().map(|part| u32::from(*part)).sum::<u32>();
    let seen = picture.pixels.iter().filter(|color| color[3] > 0);
    assert!(seen.clone().all(|color| sum(color).abs_diff(250) <= 2), "a color is darker than {colors:?}");
    assert!(seen.count() > 256 * 256 / 2);
}

const JOB: &str = include_str!("../../../../scenarios/drill-hover.toml");

fn job(terrain: &str) -> String {
    let start = JOB.find("[terrain]").unwrap();
    let end = start + JOB[start..].find("\n[ground_team]").unwrap();
    format!("{}[terrain]\nsize_m = 200\nspacing_m = 10\n{terrain}\n{}", &JOB[..start], &JOB[end..])
}

fn files(name: &str) -> Result<Vec<u8>, String> {
    let (_, [x, y]) = UTM;
    match name {
        "slope.tif" => Ok(Form::around(UTM).slope()),
        "other.tif" => Ok(Form::around((32632, [x, y + 10.0])).slope()),
        "photo.tif" => Ok(quarters()),
        "far.tif" => Ok(Form::around((32633, [x, y])).file::<RGBA8>(SIDE, &[0; 4 * 961])),
        _ => Err("not found".into()),
    }
}

fn scenario(terrain: &str) -> Scenario {
    let scenario = read("job.toml", &job(terrain), &files);
    scenario.unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn exact_job_has_the_heights_of_the_file_and_water() {
    let job = scenario("source = \"geotiff\"\nfile = \"slope.tif\"\noffset_m = 0.5\nwater_level_m = -5.0\nwater_depth_m = 3.0");
    let TerrainSource::File { heights_m } = &job.terrain.source else { panic!("{:?}", job.terrain.source) };
    assert_eq!(heights_m.len(), 21);
    assert!((heights_m[10][10] - 0.5).abs() < 0.002 && (heights_m[20][10] - 10.5).abs() < 0.02, "{heights_m:?}");
    // At most 0.2 m above the water level is water.
    assert_eq!(heights_m[0][10], -8.0);
}

#[test]
fn exact_checksum_covers_the_heights_but_not_the_photograph() {
    let one = scenario("source = \"geotiff\"\nfile = \"slope.tif\"");
    let photo = scenario("source = \"flat\"\nphoto = \"photo.tif\"");
    assert_eq!(photo.terrain.photo.as_ref().map(|photo| photo.file.as_str()), Some("photo.tif"));
    let text = job("source = \"geotiff\"\nfile = \"slope.tif\"");
    assert!(variant_with_crc(&text, &files, one.crc).is_some());
    // The same text with another file.
    let swapped = |name: &str| files(if name == "slope.tif" { "other.tif" } else { name });
    assert!(variant_with_crc(&text, &swapped, one.crc).is_none());
    let other = |name: &str| files(if name == "photo.tif" { "far.tif" } else { name });
    assert!(variant_with_crc(&job("source = \"flat\"\nphoto = \"photo.tif\""), &other, photo.crc).is_some());
}

#[test]
fn regress_problems_of_site_files_name_line_key_value_and_allowed() {
    let message = |terrain: &str| read("job.toml", &job(terrain), &files).unwrap_err().to_string();
    let text = message("source = \"geotiff\"\nfile = \"none.tif\"");
    assert!(text.contains("file") && text.contains("none.tif") && text.contains("not found"), "{text}");
    assert!(text.contains("a GeoTIFF file with heights for the whole terrain"), "{text}");
    let text = message("source = \"flat\"\nphoto = \"far.tif\"");
    assert!(text.contains("far.tif") && text.contains("the origin is at pixel"), "{text}");
}
