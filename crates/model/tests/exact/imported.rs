//! Tests that the geometry that Spandrel exports is the same after it was imported.

use spandrel_model::elements::ElementUnit;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::mesh::part_shapes::{ConcaveShape, ShapeLimits};
use spandrel_model::mesh::reader::ModelFormat;
use spandrel_model::mesh::voxel_surface::CloudLimits;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;
use spandrel_model::scenario::{Bridge, BridgeKind, Scenario, read};
use spandrel_model::site::Site;
use spandrel_model::site::bridge_import::{ImportOptions, ImportSource, ImportedBridge, ModelOrigin, UpAxis, import};
use spandrel_model::site::gltf::glb;

/// Tolerance for positions, m: the export rounds them to 32-bit floats, which are 3e-5 m apart at 500 m.
const POSITION_TOLERANCE_M: f64 = 1e-4;
/// Tolerance for the distance at which a ray enters a member, m: rounded corners tilt narrow faces, and rays meet them at small angles.
const RAY_TOLERANCE_M: f64 = 2e-3;

/// Largest deviation of an estimated quantity from that of the bridge, as a share: parts overlap by the thickness of plates.
const QUANTITY_TOLERANCE: f64 = 0.03;

/// Exports a site, and imports the file again.
fn imported_again(site: &Site) -> ImportedBridge {
    let file = glb(site).unwrap();
    let options = ImportOptions {
        name: "copy".into(),
        scale: 1.0,
        up: UpAxis::Y,
        origin: ModelOrigin::Point([0.0; 3]),
        turn_deg: 0.0,
        default_element: None,
        limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
        cloud: CloudLimits::default(),
    };
    let none = |_: &str| Err("no file".to_owned());
    let source =
        ImportSource { file: "site.glb", format: ModelFormat::Gltf, bytes: &file, load: &none, elements: ElementMap::default() };
    import(&source, &options).unwrap()
}

fn reimported(scenario: &Scenario, site: &Site) -> Site {
    let imported = imported_again(site);
    assert_eq!(imported.report.skipped, ["ground", "water", "pad"]);
    assert!(imported.report.parts.iter().all(|part| part.open_edges == 0 && part.shapes == 1 && part.dropped_triangles == 0));
    let model = Model::read("bridge.glb", &imported.model, &ElementMap::default()).unwrap();
    let bridge = Bridge { name: "copy".into(), center_m: Vec3::zero(), heading_deg: 90.0, kind: BridgeKind::Model(model) };
    Site::without_defects(&Scenario { bridges: vec![bridge], ..scenario.clone() })
}

#[test]
fn regress_quantities_of_a_reimported_export_are_those_of_the_bridge() {
    for name in ["girder", "box-girder", "truss"] {
        let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scenario = read(name, &std::fs::read_to_string(path).unwrap(), &|_| Err("no file".into())).unwrap();
        let estimated = imported_again(&Site::without_defects(&scenario)).elements;
        let estimated = ElementMap::read("elements.toml", &estimated).unwrap().quantities();
        let expected = scenario.bridges[0].quantities();
        let mut compared = 0;
        for quantity in expected.iter().filter(|quantity| quantity.element.unit() != Some(ElementUnit::Each)) {
            let found = estimated.iter().find(|other| other.element == quantity.element).unwrap();
            let deviation = found.amount / quantity.amount - 1.0;
            assert!(
                deviation.abs() < QUANTITY_TOLERANCE,
                "{name}: {}: {} of {}",
                quantity.element.name(),
                found.amount,
                quantity.amount
            );
            compared += 1;
        }
        assert!(compared >= 8, "{name}: {compared} lengths and areas");
    }
}

#[test]
fn exact_reimported_export_has_the_same_members_and_ray_hits() {
    for name in ["two-bridges", "girder"] {
        let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scenario = read(name, &std::fs::read_to_string(path).unwrap(), &|_| Err("no file".into())).unwrap();
        let original = Site::without_defects(&scenario);
        let copy = reimported(&scenario, &original);
        assert_eq!(copy.members().len(), original.members().len());
        for (one, other) in original.members().iter().zip(copy.members()) {
            assert_eq!((format!("copy/{}", one.name), one.element), (other.name.clone(), other.element));
            assert_eq!(one.solid.vertices_m.len(), other.solid.vertices_m.len(), "{}", one.name);
            assert_eq!(one.solid.faces.len(), other.solid.faces.len(), "{}", one.name);
            for vertex in &one.solid.vertices_m {
                let near = |v: &Vec3<Enu>| (*v - *vertex).norm() < POSITION_TOLERANCE_M;
                assert!(other.solid.vertices_m.iter().any(near), "{}", one.name);
            }
        }
        compare_rays(&original, &copy);
    }
}

/// Compares where random rays through the members enter them.
fn compare_rays(original: &Site, copy: &Site) {
    const LENGTH_M: f64 = 300.0;
    let mut random = RandomStream::new(3, "rays");
    let mut compared = 0;
    for _ in 0..3000 {
        let member = &original.members()[random.below(original.members().len())];
        let target = member.solid.vertices_m.iter().fold(Vec3::zero(), |sum, v| sum + *v) / member.solid.vertices_m.len() as f64;
        let direction = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
        let origin = target - direction * (0.5 * LENGTH_M);
        // Grazing rays may miss one of the two.
        let solid = |site: &Site| {
            let mut passages = site.geometry().passages(origin, direction, LENGTH_M);
            passages.retain(|passage| passage.leave_m - passage.enter_m > 0.01);
            passages.sort_by_key(|passage| passage.member);
            passages
        };
        let (ours, theirs) = (solid(original), solid(copy));
        for one in &ours {
            let Some(other) = theirs.iter().find(|other| other.member == one.member) else {
                assert!(one.leave_m - one.enter_m < 0.01 + 2.0 * RAY_TOLERANCE_M, "{}", original.members()[one.member].name);
                continue;
            };
            let name = &original.members()[one.member].name;
            assert!((one.enter_m - other.enter_m).abs() < RAY_TOLERANCE_M, "{name}: {} {}", one.enter_m, other.enter_m);
            compared += 1;
        }
    }
    assert!(compared > 3000, "{compared} hits");
}
