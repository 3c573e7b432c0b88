//! Imports of point clouds in all formats, and of damaged ones.

use las::point::{Classification, Format};
use las::{Builder, Color, Point as LasPoint, Transform, Vector, Writer};
use spandrel_model::elements::Element;
use spandrel_model::mesh::part_shapes::{ConcaveShape, Method, PartShape, ShapeLimits};
use spandrel_model::mesh::reader::{self, ModelFormat};
use spandrel_model::mesh::vectors::Point;
use spandrel_model::mesh::voxel_surface::CloudLimits;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;
use spandrel_model::site::bridge_import::{
    ImportError, ImportOptions, ImportSource, ImportedBridge, ModelOrigin, UpAxis, import,
};
use std::io::{Cursor, Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex};

const MUTANTS: usize = 200;
/// Place of the cloud in the coordinates of a map, m.
const EASTING_NORTHING_M: [f64; 2] = [504_000.0, 4_475_000.0];

/// Returns the points of a deck of 20 x 4 m on a wall of 0.6 m, 0.1 m apart, with x along the deck.
fn points() -> Vec<Point> {
    let plane = |count: [u32; 2], place: fn(f64, f64) -> Point| {
        (0..=count[0]).flat_map(move |i| (0..=count[1]).map(move |k| place(0.1 * f64::from(i), 0.1 * f64::from(k))))
    };
    let deck = plane([200, 40], |x, y| [x, y, 6.0]);
    let soffit = plane([200, 40], |x, y| [x, y, 5.5]);
    let sides = plane([40, 60], |y, z| [10.0, y, z]).chain(plane([40, 60], |y, z| [10.6, y, z]));
    deck.chain(soffit).chain(sides).map(|[x, y, z]| [x + EASTING_NORTHING_M[0], y + EASTING_NORTHING_M[1], z + 180.0]).collect()
}

/// Returns a LAS or LAZ file; each point has a class and a color of 16 bits.
fn las_file(points: &[(Point, Classification, [u16; 3])], is_compressed: bool) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(7).unwrap();
    builder.point_format.is_compressed = is_compressed;
    let axis = |offset: f64| Transform { scale: 0.001, offset };
    builder.transforms = Vector { x: axis(EASTING_NORTHING_M[0]), y: axis(EASTING_NORTHING_M[1]), z: axis(0.0) };
    let file = Shared::default();
    let mut writer = Writer::new(file.clone(), builder.into_header().unwrap()).unwrap();
    for ([x, y, z], classification, [red, green, blue]) in points.iter().copied() {
        let color = Some(Color { red, green, blue });
        writer.write_point(LasPoint { x, y, z, classification, color, gps_time: Some(0.0), ..LasPoint::default() }).unwrap();
    }
    writer.close().unwrap();
    file.0.lock().unwrap().get_ref().clone()
}

/// A file in memory that can be read after the writer has closed it.
#[derive(Debug, Clone, Default)]
struct Shared(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Shared {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        self.0.lock().unwrap().seek(place)
    }
}

/// Returns a file of red points, of which all but every nth are left out.
fn red_las(is_compressed: bool, every: usize) -> Vec<u8> {
    let red = |p: Point| (p, Classification::BridgeDeck, [u16::MAX, 0, 0]);
    las_file(&points().into_iter().step_by(every).map(red).collect::<Vec<_>>(), is_compressed)
}

fn options() -> ImportOptions {
    ImportOptions {
        name: "scan".into(),
        scale: 1.0,
        up: UpAxis::Z,
        origin: ModelOrigin::Center,
        turn_deg: 0.0,
        default_element: Some(Element::RcDeck),
        limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
        cloud: CloudLimits { voxel_m: 0.2, min_points: 20 },
    }
}

fn imported(format: ModelFormat, bytes: &[u8], elements: &str) -> Result<ImportedBridge, ImportError> {
    let none = |file: &str| Err(format!("no file {file}"));
    let elements = ElementMap::read_for_import("elements.toml", elements).unwrap();
    import(&ImportSource { file: "scan", format, bytes, load: &none, elements }, &options())
}

const NO_ELEMENTS: &str = "format = 1\n";

#[test]
fn exact_all_formats_give_the_same_colored_solid_of_voxels() {
    let text: String = points().iter().map(|[x, y, z]| format!("{x:.3} {y:.3} {z:.3} 255 0 0\n")).collect();
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\nend_header\n{text}",
        points().len()
    );
    let las = imported(ModelFormat::Las, &red_las(false, 1), NO_ELEMENTS).unwrap();
    assert_eq!(las, imported(ModelFormat::Las, &red_las(true, 1), NO_ELEMENTS).unwrap());
    assert_eq!(las, imported(ModelFormat::PointText, text.as_bytes(), NO_ELEMENTS).unwrap());
    assert_eq!(las, imported(ModelFormat::Ply, ply.as_bytes(), NO_ELEMENTS).unwrap());
    let row = &las.report.parts[0];
    assert_eq!((row.name.as_str(), row.method, row.holes, row.shapes), ("cloud", Some(Method::Points), 0, 1));
    assert!((row.deviation_m - 0.2 * 3.0_f64.sqrt()).abs() < 1e-12);
    let model = Model::read("bridge.glb", &las.model, &ElementMap::default()).unwrap();
    let PartShape::Mesh(surface) = &model.parts()[0].shape else { panic!("not a mesh") };
    assert!(surface.is_closed() && surface.colors().iter().all(|color| *color == [255, 0, 0]));
    // The deck is two layers of points, 0.5 m apart and open at its ends: up to three voxels thick.
    let (low, high) = model.extent().whole;
    assert!(
        (high[0] - low[0] - 20.0).abs() <= 0.4 && (high[1] - low[1] - 4.0).abs() <= 0.4 && (high[2] - low[2] - 6.0).abs() <= 0.4
    );
    assert!(low[0].abs() > 9.9 && high[2].abs() < 1e-6, "the origin is in the middle of the upper side: {low:?} {high:?}");
}

#[test]
fn exact_points_of_other_classes_are_left_out() {
    let mut all: Vec<_> = points().into_iter().map(|p| (p, Classification::Unclassified, [9, 9, 9])).collect();
    let count = all.len();
    let below = |k: u32| [EASTING_NORTHING_M[0] + 0.1 * f64::from(k), EASTING_NORTHING_M[1], 150.0];
    for class in [Classification::Ground, Classification::Water, Classification::LowPoint, Classification::HighNoise] {
        all.extend((0..30).map(|k| (below(k), class, [9, 9, 9])));
    }
    // A bird.
    all.extend((0..5).map(|k| (below(k), Classification::Unclassified, [9, 9, 9])));
    let bridge = imported(ModelFormat::Las, &las_file(&all, true), NO_ELEMENTS).unwrap();
    let report = bridge.report.cloud.unwrap();
    assert_eq!((report.points, report.left_out, report.outliers), (count + 5, 120, 5));
    assert!(bridge.report.extent.whole.0[2] > -6.5, "{:?}", bridge.report.extent);
}

#[test]
fn exact_boxes_divide_a_cloud() {
    let elements = "format = 1\n[[elements]]\nelement = 210\nbox_m = [[-1.5, -3, -7], [2, 3, -1]]\nname = \"wall\"\n";
    let bridge = imported(ModelFormat::Las, &red_las(true, 1), elements).unwrap();
    let rows: Vec<(&str, u16)> = bridge.report.parts.iter().map(|part| (part.name.as_str(), part.element.number())).collect();
    assert_eq!(rows, [("wall", 210), ("cloud", 12)]);
    let model = Model::read("bridge.glb", &bridge.model, &ElementMap::default()).unwrap();
    let wall = &model.parts()[0].shape;
    assert!(wall.corners_m().iter().all(|p| p[2] <= -0.9 && p[0].abs() < 1.5), "{:?}", wall.corners_m()[0]);
}

#[test]
fn regress_a_cloud_with_more_chunks_than_it_has_room_for_names_both_numbers() {
    let mut file = red_las(true, 20);
    // The header has the position of the points, which begin with that of the table, in which the number follows the version.
    let points = u32::from_le_bytes(*file[96..].first_chunk().unwrap()) as usize;
    let table = i64::from_le_bytes(*file[points..].first_chunk().unwrap()) as usize;
    file[table + 4..table + 8].copy_from_slice(&u32::MAX.to_le_bytes());
    let error = reader::read(ModelFormat::Las, "scan.laz", &file, &|_| Err(String::new())).unwrap_err();
    let most = file.len() / 20;
    assert!(error.contains(&format!("4294967295 chunks (allowed: at most {most}, ")), "{error}");
}

#[test]
fn regress_truncated_and_damaged_clouds_never_cause_a_panic() {
    let mut random = RandomStream::new(6, "clouds");
    for is_compressed in [false, true] {
        let file = red_las(is_compressed, 20);
        for length in (0..600).step_by(7).chain((600..file.len()).step_by(97)) {
            let error = reader::read(ModelFormat::Las, "scan.laz", &file[..length], &|_| Err(String::new())).unwrap_err();
            assert!(error.starts_with("scan.laz: "), "{length}: {error}");
        }
        for mutant in 0..MUTANTS {
            let mut damaged = file.clone();
            // Most of them in the header and the first points.
            let end = if mutant % 4 == 0 { file.len() } else { 700 };
            for _ in 0..=random.below(3) {
                let at = random.below(end);
                damaged[at] = random.below(256) as u8;
            }
            if let Err(error) = reader::read(ModelFormat::Las, "scan.laz", &damaged, &|_| Err(String::new())) {
                assert!(error.starts_with("scan.laz: "), "{error}");
            }
        }
    }
}
