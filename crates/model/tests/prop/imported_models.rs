//! Imports of models with random shapes and transforms, and of damaged files.

use base64::Engine;
use serde_json::{Value, json};
use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::mesh::Mesh;
use spandrel_model::mesh::gltf_reader;
use spandrel_model::mesh::part_shapes::{ConcaveShape, Method, PartShape, ShapeLimits};
use spandrel_model::mesh::reader::ModelFormat;
use spandrel_model::mesh::surface_mesh::SurfaceMesh;
use spandrel_model::mesh::vectors::Point;
use spandrel_model::mesh::voxel_surface::CloudLimits;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::{Model, ModelPart};
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::site::bridge_import::{
    ImportError, ImportOptions, ImportSource, ImportedBridge, ModelOrigin, UpAxis, import,
};
use spandrel_model::site::gltf::parts_glb;

/// Relative tolerance for volumes: 32-bit floats represent positions 100 m from the origin to 4e-6 m, and the shapes are at least 0.3 m
/// thick.
const VOLUME_TOLERANCE: f64 = 1e-4;
const SHAPES: usize = 60;
const MUTANTS: usize = 400;

/// A text glTF file under construction, with its data in an embedded buffer.
#[derive(Default)]
struct ModelText {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

impl ModelText {
    fn accessor(&mut self, bytes: &[u8], accessor: Value) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len() }));
        self.data.extend(bytes);
        let mut accessor = accessor;
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds a mesh and returns its index.
    fn mesh(&mut self, positions: &[[f32; 3]], indices: &[u32]) -> usize {
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let bound = |start: f32, pick: fn(f32, f32) -> f32| {
            positions.iter().fold([start; 3], |a, p| [pick(a[0], p[0]), pick(a[1], p[1]), pick(a[2], p[2])])
        };
        let (min, max) = (bound(f32::MAX, f32::min), bound(f32::MIN, f32::max));
        let shape = json!({ "componentType": 5126, "count": positions.len(), "type": "VEC3", "min": min, "max": max });
        let position = self.accessor(&bytes, shape);
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let index = self.accessor(&bytes, json!({ "componentType": 5125, "count": indices.len(), "type": "SCALAR" }));
        self.meshes.push(json!({ "primitives": [{ "attributes": { "POSITION": position }, "indices": index }] }));
        self.meshes.len() - 1
    }

    fn json(&self) -> Value {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.data);
        let uri = format!("data:application/octet-stream;base64,{data}");
        let children: Vec<usize> =
            self.nodes.iter().filter_map(|node| node["children"][0].as_u64()).map(|k| k as usize).collect();
        let roots: Vec<usize> = (0..self.nodes.len()).filter(|k| !children.contains(k)).collect();
        json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.data.len(), "uri": uri }],
        })
    }
}

fn options() -> ImportOptions {
    ImportOptions {
        name: "model".into(),
        scale: 1.0,
        up: UpAxis::Y,
        origin: ModelOrigin::Center,
        turn_deg: 0.0,
        default_element: Some(Element::RcDeck),
        limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
        cloud: CloudLimits::default(),
    }
}

fn imported(bytes: &[u8], options: &ImportOptions) -> Result<ImportedBridge, ImportError> {
    let none = |file: &str| Err(format!("no file {file}"));
    import(
        &ImportSource { file: "m.gltf", format: ModelFormat::Gltf, bytes, load: &none, elements: ElementMap::default() },
        options,
    )
}

fn model(bridge: &ImportedBridge) -> Model {
    Model::read("bridge.glb", &bridge.model, &ElementMap::read("elements.toml", &bridge.elements).unwrap()).unwrap()
}

/// Returns a prism around the vertical axis with its volume, m³.
fn prism(sides: usize, radius_m: f64, height_m: f64) -> (Vec<[f32; 3]>, Vec<u32>, f64) {
    let corner = |k: usize, y: f64| {
        let (s, c) = math::sin_cos(math::TAU * k as f64 / sides as f64);
        [(radius_m * c) as f32, y as f32, (radius_m * s) as f32]
    };
    let positions = (0..sides).map(|k| corner(k, 0.0)).chain((0..sides).map(|k| corner(k, height_m))).collect();
    let n = sides as u32;
    let mut indices = Vec::new();
    for k in 1..n - 1 {
        indices.extend([0, k, k + 1, n, n + k + 1, n + k]);
    }
    for k in 0..n {
        let next = (k + 1) % n;
        indices.extend([k, n + k, next, next, n + k, n + next]);
    }
    let area_m2 = 0.5 * sides as f64 * radius_m * radius_m * math::sin(math::TAU / sides as f64);
    (positions, indices, area_m2 * height_m)
}

fn random_rotation(random: &mut RandomStream) -> [f64; 4] {
    let q = [random.normal(), random.normal(), random.normal(), random.normal()];
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    q.map(|v| v / length)
}

#[test]
fn prop_random_shapes_and_transforms_have_the_exact_volumes() {
    let mut random = RandomStream::new(1, "models");
    let mut text = ModelText::default();
    let mut volumes = Vec::new();
    for k in 0..SHAPES {
        let (positions, indices, volume_m3) = prism(3 + random.below(9), random.range(0.5, 3.0), random.range(0.5, 20.0));
        let mesh = text.mesh(&positions, &indices);
        let mut scale = || random.range(0.7, 1.5) * if random.uniform() < 0.3 { -1.0 } else { 1.0 };
        let (outer, inner) = ([scale(), scale(), scale()], scale());
        let place = [random.range(-50.0, 50.0), random.range(-50.0, 50.0), random.range(-50.0, 50.0)];
        let child = text.nodes.len() + 1;
        text.nodes
            .push(json!({ "children": [child], "translation": place, "rotation": random_rotation(&mut random), "scale": outer }));
        text.nodes.push(json!({
            "name": format!("part-{k}"), "mesh": mesh, "rotation": random_rotation(&mut random), "scale": [inner, inner, inner]
        }));
        let factor: f64 = outer.iter().product::<f64>() * inner * inner * inner;
        volumes.push(volume_m3 * factor.abs());
    }
    let bridge = imported(text.json().to_string().as_bytes(), &options()).unwrap();
    let model = model(&bridge);
    assert_eq!(model.parts().len(), SHAPES);
    for (part, expected) in model.parts().iter().zip(volumes) {
        let volume = part.shape.mesh().volume_m3();
        assert!((volume / expected - 1.0).abs() < VOLUME_TOLERANCE, "{}: {volume} {expected}", part.name);
    }
    assert!(bridge.report.parts.iter().all(|part| part.open_edges == 0 && part.pieces == 1), "{:?}", bridge.report);
}

#[test]
fn exact_job_of_an_imported_bridge_is_valid_and_free_of_obstacles() {
    let bridge = imported(slab_on_two_piers().to_string().as_bytes(), &options()).unwrap();
    let scenario = job(&bridge);
    let site = spandrel_model::site::Site::without_defects(&scenario);
    assert_eq!((site.members().len(), scenario.tasks.len()), (3, 3));
    assert_eq!(site.members()[0].name, "model/slab");
    // From the pad beyond the start of the slab, in this order, no way crosses a path.
    let names: Vec<&str> = scenario.tasks.iter().map(|task| task.name.as_str()).collect();
    assert_eq!(names, ["Right side of the deck", "Underside of the deck", "Left side of the deck"]);
    assert_eq!(scenario.ground_team.pad_m, Vec3::new(-45.0, 0.0, 0.0));
    let ends = |task: usize| {
        let path = &scenario.tasks[task].path_m;
        (path[0].east(), path[path.len() - 1].east())
    };
    assert!((0..3).map(ends).zip([true, false, true]).all(|((from, to), is_ahead)| (from < to) == is_ahead));
    for task in &scenario.tasks {
        assert_eq!(task.bridge, Some(0));
        // 1 m more than the warning; points of a path are rounded to 1 cm.
        assert_eq!(site.min_path_clearance(task.segments(), 3.49), None, "{}", task.name);
        // Each point of the path looks at the deck beside it, or above and slightly ahead.
        let looks = |view: &Vec3<Enu>| view.up().max(view.north().abs()) > 0.9;
        assert!(task.viewing_directions.iter().all(looks), "{}", task.name);
    }
    let again = imported(&bridge.model, &options()).unwrap();
    assert_eq!(again.model, bridge.model, "an import of the imported parts changes nothing");
}

#[test]
fn exact_units_axes_origin_and_turn_are_applied() {
    // A beam along the file's y axis (z up), in millimeters.
    let mut text = ModelText::default();
    let (positions, indices) = box_corners([1000.0, 2000.0, 500.0], [1400.0, 12_000.0, 700.0]);
    let mesh = text.mesh(&positions, &indices);
    text.nodes.push(json!({ "name": "beam", "mesh": mesh }));
    let file = text.json().to_string();
    let millimeters = ImportOptions { scale: 0.001, up: UpAxis::Z, turn_deg: 90.0, ..options() };
    let extent = |options: &ImportOptions| model(&imported(file.as_bytes(), options).unwrap()).extent().whole;
    let near = |a: Point, b: Point| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-6);
    let (low, high) = extent(&millimeters);
    assert!(near(low, [-5.0, -0.2, -0.2]) && near(high, [5.0, 0.2, 0.0]), "{low:?} {high:?}");
    let (low, high) = extent(&ImportOptions { origin: ModelOrigin::Point([1.0, 2.0, 0.0]), ..millimeters });
    assert!(near(low, [-10.0, 0.0, 0.5]) && near(high, [0.0, 0.4, 0.7]), "{low:?} {high:?}");
    let error = imported(file.as_bytes(), &options()).unwrap_err().to_string();
    assert!(error.contains("10000.000 m long (allowed: 2 to 5000 m; set --scale)"), "{error}");
}

fn box_corners(low: [f32; 3], high: [f32; 3]) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mesh = Mesh::of_box(low.map(f64::from), high.map(f64::from));
    (mesh.vertices_m.iter().map(|p| p.map(|value| value as f32)).collect(), mesh.triangles.concat())
}

/// A slab in millimeters with a round drain, and its placement.
const SLAB_IFC: &str = include_str!("../../../../fuzz/seeds/model/slab.ifc");
const SLAB_PLACE: &str = "#22=IFCAXIS2PLACEMENT3D(#23,$,$);\n#23=IFCCARTESIANPOINT((0.,0.,5000.));";

fn imported_ifc(text: &str, options: &ImportOptions) -> ImportedBridge {
    let none = |file: &str| Err(format!("no file {file}"));
    let source = ImportSource {
        file: "slab.ifc",
        format: ModelFormat::Ifc,
        bytes: text.as_bytes(),
        load: &none,
        elements: ElementMap::default(),
    };
    import(&source, options).unwrap()
}

#[test]
fn exact_a_bridge_in_coordinates_of_a_map_has_the_same_shapes_as_at_the_origin() {
    let options = ImportOptions { up: UpAxis::Z, default_element: None, ..options() };
    let near = imported_ifc(SLAB_IFC, &options);
    assert!(SLAB_IFC.contains(SLAB_PLACE));
    let place = "#22=IFCAXIS2PLACEMENT3D(#23,$,#9);\n#9=IFCDIRECTION((0.8660254037844387,0.5,0.));\n\
                 #23=IFCCARTESIANPOINT((504000000.,4475000000.,185000.));";
    let turned = ImportOptions { turn_deg: -30.0, ..options };
    let far = imported_ifc(&SLAB_IFC.replace(SLAB_PLACE, place), &turned);
    for bridge in [&near, &far] {
        let [row] = &bridge.report.parts[..] else { panic!("{:?}", bridge.report) };
        assert_eq!((row.name.as_str(), row.element, row.method), ("deck", Element::RcDeck, Some(Method::Cut)));
        assert!(row.deviation_m < 1e-4, "{}", row.deviation_m);
        // The drain is a polygon of 36 corners.
        let drain_m2 = 18.0 * 0.0625 * math::sin_cos(math::TAU / 36.0).0;
        let volume: f64 = model(bridge).parts().iter().map(|part| part.shape.mesh().volume_m3()).sum();
        assert!((volume - 0.25 * (40.0 - drain_m2)).abs() < 1e-3, "{volume}");
    }
    let difference = |a: Point, b: Point| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    let [(low, high), (far_low, far_high)] = [&near, &far].map(|bridge| model(bridge).extent().whole);
    assert!(difference(low, far_low).max(difference(high, far_high)) < 1e-4, "{far_low:?} {far_high:?}");
    assert!(difference(far.report.origin_m, [504_000.0, 4_475_000.0, 185.25]) < 1e-4, "{:?}", far.report.origin_m);
    let stated = ImportOptions { origin: ModelOrigin::Point([504_000.0, 4_475_000.0, 185.25]), ..turned };
    let (stated_low, _) = model(&imported_ifc(&SLAB_IFC.replace(SLAB_PLACE, place), &stated)).extent().whole;
    assert!(difference(far_low, stated_low) < 1e-4, "{stated_low:?}");
}

/// Returns a model of three boxes, in glTF's axes.
fn slab_on_two_piers() -> Value {
    let mut text = ModelText::default();
    let boxes = [
        ("slab", [-20.0, 8.0, -4.0], [20.0, 9.0, 4.0]),
        ("pier-1", [-12.0, 0.0, -2.0], [-11.0, 8.0, 2.0]),
        ("pier-2", [11.0, 0.0, -2.0], [12.0, 8.0, 2.0]),
    ];
    for (name, low, high) in boxes {
        let (positions, indices) = box_corners(low, high);
        let mesh = text.mesh(&positions, &indices);
        let element = if name == "slab" { 12 } else { 210 };
        text.nodes.push(json!({ "name": name, "mesh": mesh, "extras": { "element": element } }));
    }
    text.json()
}

fn job(bridge: &ImportedBridge) -> Scenario {
    let load = |name: &str| match name {
        "bridge.glb" => Ok(bridge.model.clone()),
        "elements.toml" => Ok(bridge.elements.clone().into_bytes()),
        _ => Err("no such file".to_owned()),
    };
    scenario::read("scenario.toml", &bridge.scenario, &load).unwrap_or_else(|problems| panic!("{problems}\n{}", bridge.scenario))
}

#[test]
fn exact_parts_without_an_element_are_listed_with_a_file_to_start_from() {
    let mut text = slab_on_two_piers();
    for node in text["nodes"].as_array_mut().unwrap() {
        node.as_object_mut().unwrap().remove("extras");
    }
    let nothing = ImportOptions { default_element: None, ..options() };
    let Err(ImportError::UnknownElements { parts, elements, .. }) = imported(text.to_string().as_bytes(), &nothing) else {
        panic!("it was imported")
    };
    assert_eq!(parts, ["slab", "pier-1", "pier-2"]);
    let none = |_: &str| Err(String::new());
    let elements = ElementMap::read("elements.toml", &elements).unwrap();
    let bytes = text.to_string();
    let source = ImportSource { file: "m.gltf", format: ModelFormat::Gltf, bytes: bytes.as_bytes(), load: &none, elements };
    let found: Vec<u16> = import(&source, &nothing).unwrap().report.parts.iter().map(|part| part.element.number()).collect();
    assert_eq!(found, [12, 210, 210]);
}

#[test]
fn regress_problems_of_an_imported_job_name_line_key_value_and_allowed() {
    let bridge = imported(slab_on_two_piers().to_string().as_bytes(), &options()).unwrap();
    let problem = |from: &str, to: &str, elements: &str| {
        assert!(bridge.scenario.contains(from), "{from}");
        let text = bridge.scenario.replacen(from, to, 1);
        let load = |name: &str| match name {
            "bridge.glb" => Ok(bridge.model.clone()),
            "elements.toml" => Ok(elements.as_bytes().to_vec()),
            "notes.txt" => Ok(b"no model".to_vec()),
            _ => Err("no such file".to_owned()),
        };
        scenario::read("job.toml", &text, &load).unwrap_err().0[0].to_string()
    };
    let fine = bridge.elements.as_str();
    let found = problem("file = \"bridge.glb\"", "file = \"away.glb\"", fine);
    assert!(
        found.contains("bridges[].model.file = away.glb: no such file (allowed: a file written by `spandrel import`"),
        "{found}"
    );
    let found = problem("file = \"bridge.glb\"", "file = \"notes.txt\"", fine);
    assert!(found.contains("bridges[].model.file = notes.txt: notes.txt: not a glTF file"), "{found}");
    let found = problem("file = \"bridge.glb\"", "size_m = 3", fine);
    assert!(found.contains("bridges[].model.file") && found.contains("missing"), "{found}");
    let found = problem("title", "title", &fine.replace("element = 12", "element = 1200"));
    assert!(found.starts_with("elements.toml:") && found.contains("elements[].element = 1200"), "{found}");
    let found = problem("title", "title", "");
    assert!(found.starts_with("elements.toml:") && found.contains("format") && found.contains("missing"), "{found}");
    let found = problem("points_relative_to = \"model\"", "points_relative_to = \"other\"", fine);
    assert!(
        found.contains("tasks[].points_relative_to = other: unknown bridge (allowed: a bridge in this file: model)"),
        "{found}"
    );
    let found = problem("kind = \"free\"\npoints_relative_to", "kind = \"slab_side\"\nbridge", fine);
    assert!(found.contains("not available for this bridge (allowed: for an imported bridge: free)"), "{found}");
}

/// Returns the message for a model after a change.
fn message(change: impl Fn(&mut Value)) -> String {
    let mut text = slab_on_two_piers();
    change(&mut text);
    imported(text.to_string().as_bytes(), &options()).unwrap_err().to_string()
}

#[track_caller]
fn assert_message(change: impl Fn(&mut Value), expected: &[&str]) {
    let message = message(change);
    assert!(message.starts_with("m.gltf: "), "{message}");
    for words in expected {
        assert!(message.contains(words), "{message}");
    }
}

/// Overwrites bytes of the embedded buffer.
fn overwrite(text: &mut Value, view: usize, at: usize, bytes: &[u8]) {
    let uri = text["buffers"][0]["uri"].as_str().unwrap();
    let (kind, data) = uri.split_once(',').unwrap();
    let mut data = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let start = text["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize + at;
    data[start..start + bytes.len()].copy_from_slice(bytes);
    text["buffers"][0]["uri"] = json!(format!("{kind},{}", base64::engine::general_purpose::STANDARD.encode(data)));
}

#[test]
fn regress_invalid_geometry_names_the_node_the_value_and_what_is_allowed() {
    assert_message(
        |t| overwrite(t, 2, 12, &f32::NAN.to_le_bytes()),
        &["node pier-1: position 1", "NaN", "allowed: numbers of at most"],
    );
    assert_message(|t| overwrite(t, 2, 12, &f32::INFINITY.to_le_bytes()), &["node pier-1: position 1", "inf"]);
    assert_message(|t| overwrite(t, 5, 4, &4_000_000_000u32.to_le_bytes()), &["node pier-2: index 4000000000 (allowed: 0 to 7)"]);
    assert_message(|t| t["accessors"][1]["count"] = json!(35), &["node slab: 35 indices (allowed: a multiple of 3)"]);
    assert_message(
        |t| t["accessors"][1]["count"] = json!(u32::MAX),
        &["node slab: 4294967295 indices", "outside of their buffer"],
    );
    assert_message(|t| t["bufferViews"][4]["byteOffset"] = json!(1u64 << 62), &["node pier-2", "outside of their buffer"]);
    assert_message(
        |t| t["accessors"][3]["componentType"] = json!(5126),
        &["node pier-1: indices that are not unsigned integers"],
    );
    assert_message(
        |t| t["nodes"][1]["extras"]["element"] = json!(5000),
        &["node pier-1: extras.element = 5000 (allowed: 1 to 999)"],
    );
    assert_message(|t| t["nodes"][2]["scale"] = json!([1e30, 1.0, 1.0]), &["node pier-2: position 0"]);
    let sparse = json!({ "count": 1, "indices": { "bufferView": 1, "componentType": 5125 }, "values": { "bufferView": 0 } });
    assert_message(|t| t["accessors"][2]["sparse"] = sparse.clone(), &["node pier-1: positions in a sparse accessor"]);
}

#[test]
fn regress_invalid_files_name_the_file_and_the_cause() {
    assert_message(|t| t["buffers"][0]["uri"] = json!("away.bin"), &["buffer 0: away.bin: no file away.bin"]);
    assert_message(|t| t["buffers"][0]["byteLength"] = json!(1_000_000), &["buffer 0", "allowed: 1000000 to"]);
    assert_message(|t| t["buffers"][0]["uri"] = json!("data:a;base64,!"), &["buffer 0"]);
    assert_message(
        |t| t["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]),
        &["requires the extension KHR_draco_mesh_compression"],
    );
    assert_message(|t| t["nodes"][0]["children"] = json!([1]), &["node 1: the nodes are not a tree"]);
    assert_message(|t| t["nodes"][0]["children"] = json!([0]), &["node 0: the nodes are not a tree"]);
    assert_message(|t| t["nodes"][0]["mesh"] = json!(77), &["mesh"]);
    assert_message(|t| t["scenes"] = json!([]), &["m.gltf"]);
    assert_message(
        |t| {
            for mesh in t["meshes"].as_array_mut().unwrap() {
                mesh["primitives"][0]["mode"] = json!(1);
            }
        },
        &["no triangles (allowed: at least one node with a mesh)"],
    );
    let error = imported(b"not a model", &options()).unwrap_err().to_string();
    assert!(error.starts_with("m.gltf: not a glTF file"), "{error}");
}

/// Returns the model as a binary file.
fn binary() -> Vec<u8> {
    imported(slab_on_two_piers().to_string().as_bytes(), &options()).unwrap().model
}

#[test]
fn regress_truncated_binary_files_are_refused() {
    let file = binary();
    for length in 0..file.len() {
        let error = imported(&file[..length], &options()).unwrap_err().to_string();
        assert!(error.starts_with("m.gltf: "), "{length}: {error}");
    }
}

#[test]
fn prop_damaged_binary_files_never_cause_a_panic() {
    let file = binary();
    let mut random = RandomStream::new(5, "damage");
    for _ in 0..MUTANTS {
        let mut damaged = file.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(damaged.len());
            damaged[at] = random.below(256) as u8;
        }
        let none = |_: &str| Err("no file".to_owned());
        let read = gltf_reader::read("m.glb", &damaged, &none);
        if let Ok(content) = read {
            assert!(content.nodes.iter().all(|node| is_sound(&node.mesh)));
        }
        if let Err(error) = Model::read("m.glb", &damaged, &ElementMap::default()) {
            assert!(error.starts_with("m.glb: "), "{error}");
        }
        if let Err(error) = imported(&damaged, &options()) {
            assert!(error.to_string().starts_with("m.gltf: "), "{error}");
        }
    }
}

/// Returns the JSON pointers of all values below a value.
fn pointers(value: &Value, at: &str) -> Vec<String> {
    let below: Vec<(String, &Value)> = match value {
        Value::Object(map) => map.iter().map(|(key, value)| (format!("{at}/{key}"), value)).collect(),
        Value::Array(list) => list.iter().enumerate().map(|(k, value)| (format!("{at}/{k}"), value)).collect(),
        _ => Vec::new(),
    };
    below.into_iter().flat_map(|(at, value)| [pointers(value, &at), vec![at]].concat()).collect()
}

#[test]
fn prop_wrong_values_in_a_text_file_never_cause_a_panic() {
    let file = slab_on_two_piers();
    let wrong = [json!(0), json!(1), json!(7), json!(u32::MAX), json!(u64::MAX), json!(-1.5), json!("x"), json!([]), json!(null)];
    let mut refused = 0;
    for (pointer, value) in pointers(&file, "").iter().flat_map(|pointer| wrong.iter().map(move |value| (pointer, value))) {
        let mut changed = file.clone();
        *changed.pointer_mut(pointer).unwrap() = value.clone();
        if let Err(error) = imported(changed.to_string().as_bytes(), &options()) {
            assert!(error.to_string().starts_with("m.gltf: "), "{pointer} = {value}: {error}");
            refused += 1;
        }
    }
    assert!(refused > 100, "{refused} refused");
}

fn is_sound(mesh: &Mesh) -> bool {
    mesh.vertices_m.iter().flatten().all(|value| value.is_finite())
        && mesh.triangles.iter().flatten().all(|k| (*k as usize) < mesh.vertices_m.len())
}

/// Returns a binary file of a description and a binary chunk, both padded to a multiple of four bytes.
fn binary_file(json: &Value, data: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + text.len() as u32 + data.len() as u32).to_le_bytes());
    for (kind, content) in [(b"JSON", &text[..]), (b"BIN\0", data)] {
        file.extend((content.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(content);
    }
    file
}

#[test]
fn regress_buffers_without_a_uri_share_the_binary_chunk_and_are_limited_together() {
    let read = |count: usize| {
        let mut text = slab_on_two_piers();
        let buffers = text["buffers"].as_array_mut().unwrap();
        buffers.resize(count, json!({ "byteLength": 4 }));
        let data = vec![0; 1024 * 1024];
        gltf_reader::read("m.glb", &binary_file(&text, &data), &|_| Err("no file".to_owned()))
    };
    assert_eq!(read(500).map(|content| content.nodes.len()), Ok(3));
    let error = read(600).unwrap_err();
    assert!(error.contains("bytes in all buffers up to here (allowed: at most 536870912)"), "{error}");
}

#[test]
fn regress_triangles_are_counted_before_each_primitive_is_read() {
    const CORNERS: usize = 100_002;
    let mut text = ModelText::default();
    let mesh = text.mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[0, 1, 2]);
    let strip = text.accessor(&[0; CORNERS], json!({ "componentType": 5121, "count": CORNERS, "type": "SCALAR" }));
    text.nodes.push(json!({ "name": "strips", "mesh": mesh }));
    let read = |count: usize| {
        let mut file = text.json();
        let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": strip, "mode": 5 });
        file["meshes"][mesh]["primitives"] = json!(vec![primitive; count]);
        let content = gltf_reader::read("m.gltf", file.to_string().as_bytes(), &|_| Err("no file".to_owned()));
        content.map(|content| content.nodes[0].mesh.triangles.len())
    };
    assert_eq!(read(50), Ok(5_000_000));
    let message = "m.gltf: node strips: more than 5000000 triangles or vertices in the file".to_owned();
    assert_eq!(read(51), Err(message.clone()));
    // Reading all of these before counting would take more than 1 GB.
    assert_eq!(read(1_000), Err(message));
}

#[test]
fn regress_a_long_bridge_gets_the_largest_terrain_or_a_message_before_it_is_converted() {
    let mut text = ModelText::default();
    let (positions, indices) = box_corners([0.0, 9.0, -5.0], [3900.0, 10.0, 5.0]);
    let mesh = text.mesh(&positions, &indices);
    text.nodes.push(json!({ "name": "deck", "mesh": mesh }));
    let file = text.json().to_string();
    let bridge = imported(file.as_bytes(), &options()).unwrap();
    assert!(bridge.scenario.contains("size_m = 4000.0"), "{}", bridge.scenario);
    assert_eq!(job(&bridge).bridges.len(), 1);
    let off_center = ImportOptions { origin: ModelOrigin::Point([100.0, 0.0, 10.0]), ..options() };
    let error = imported(file.as_bytes(), &off_center).unwrap_err().to_string();
    let expected = "m.gltf: the bridge and the landing pad reach 3829.0 m from the origin (allowed: at most 2000.0 m; set --origin center, \
                    or divide the model into several)";
    assert_eq!(error, expected);
}

/// Imports a model of named parts: each has an element and a number of separate boxes.
fn imported_boxes(parts: &[(&str, u16, usize)]) -> ImportedBridge {
    let mut text = ModelText::default();
    for (k, (name, element, count)) in parts.iter().enumerate() {
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        for number in 0..*count {
            let (x, z) = (3.0 * number as f32, 3.0 * k as f32);
            let (corners, faces) = box_corners([x, 0.0, z], [x + 2.0, 1.0, z + 2.0]);
            indices.extend(faces.iter().map(|index| index + positions.len() as u32));
            positions.extend(corners);
        }
        let mesh = text.mesh(&positions, &indices);
        text.nodes.push(json!({ "name": name, "mesh": mesh, "extras": { "element": element } }));
    }
    imported(text.json().to_string().as_bytes(), &options()).unwrap()
}

/// Imports the slab on two piers with an elements file.
fn painted(elements: &str, options: &ImportOptions) -> Result<ImportedBridge, ImportError> {
    let bytes = slab_on_two_piers().to_string();
    let none = |_: &str| Err("no file".to_owned());
    let elements = ElementMap::read_for_import("elements.toml", elements).unwrap();
    import(&ImportSource { file: "m.gltf", format: ModelFormat::Gltf, bytes: bytes.as_bytes(), load: &none, elements }, options)
}

/// Returns an elements file of rows of an element, a box and further keys.
fn boxes(rows: &[(u16, [Point; 2], &str)]) -> String {
    let row = |(element, corners, keys): &(u16, [Point; 2], &str)| {
        format!("[[elements]]\nelement = {element}\nbox_m = {corners:?}\n{keys}\n")
    };
    format!("format = 1\n{}", rows.iter().map(row).collect::<String>())
}

#[test]
fn exact_a_box_assigns_its_element_to_whole_parts() {
    let around = |x: f64| [[x - 1.0, -3.0, -9.5], [x + 1.0, 3.0, -0.5]];
    // The first row is the one that counts. Both piers keep their names and their shapes.
    let rows = [(205, around(-11.5), ""), (215, around(-11.5), ""), (210, around(50.0), "name = \"away\"")];
    let bridge = painted(&boxes(&rows), &options()).unwrap();
    assert_eq!(names_and_elements(&bridge), [("slab", 12), ("pier-1", 205), ("pier-2", 210)].map(|(a, b)| (a.to_owned(), b)));
    let empty: Vec<usize> = bridge.report.empty_boxes.iter().map(|(row, _)| *row).collect();
    assert_eq!(empty, [2, 3], "{:?}", bridge.report.empty_boxes);
    assert_eq!(bridge.report.empty_boxes[1].1, "[[49.0, -3.0, -9.5], [51.0, 3.0, -0.5]]");
    let plain = imported(slab_on_two_piers().to_string().as_bytes(), &options()).unwrap();
    let shapes = |bridge: &ImportedBridge| model(bridge).parts().iter().map(|part| part.shape.clone()).collect::<Vec<_>>();
    assert_eq!(shapes(&bridge), shapes(&plain));
}

/// Returns a plate of 20 x 4 cells of 1 m, 1 m thick, around the origin, as a binary PLY file with z up.
fn plate_ply(is_colored: bool) -> Vec<u8> {
    let mut mesh = Mesh::default();
    for (x, y) in (0..20).flat_map(|x| (0..4).map(move |y| (f64::from(x) - 10.0, f64::from(y) - 2.0))) {
        mesh.append(&Mesh::of_box([x, y, -1.0], [x + 1.0, y + 1.0, 0.0]));
    }
    // Without the walls between the cells.
    let is_wall = |triangle: &&[u32; 3]| {
        let normal = mesh.area_vector(**triangle);
        let at = mesh.vertices_m[triangle[0] as usize];
        (normal[0] != 0.0 && at[0].abs() != 10.0) || (normal[1] != 0.0 && at[1].abs() != 2.0)
    };
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(|triangle| !is_wall(triangle)).copied().collect();
    let colors = if is_colored { "property uchar red\nproperty uchar green\nproperty uchar blue\n" } else { "" };
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{colors}\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices_m.len(),
        triangles.len()
    )
    .into_bytes();
    for vertex in &mesh.vertices_m {
        file.extend(vertex.iter().flat_map(|value| (*value as f32).to_le_bytes()));
        if is_colored {
            file.extend([255, 0, (vertex[0] + 10.0) as u8]);
        }
    }
    for triangle in triangles {
        file.push(3);
        file.extend(triangle.iter().flat_map(|k| (*k as i32).to_le_bytes()));
    }
    file
}

fn import_plate(is_colored: bool, elements: &str, options: &ImportOptions) -> Result<ImportedBridge, ImportError> {
    let bytes = plate_ply(is_colored);
    let none = |_: &str| Err("no file".to_owned());
    let elements = ElementMap::read_for_import("elements.toml", elements).unwrap();
    let options = ImportOptions { up: UpAxis::Z, ..options.clone() };
    import(&ImportSource { file: "m.ply", format: ModelFormat::Ply, bytes: &bytes, load: &none, elements }, &options)
}

#[test]
fn exact_boxes_divide_a_single_mesh_and_lose_nothing_of_it() {
    let whole = import_plate(true, "format = 1\n", &options()).unwrap();
    assert_eq!(whole.report.parts[0].holes, 0);
    let rows = [
        (205, [[-20.0, -3.0, -3.0], [-6.0, 3.0, 3.0]], "name = \"pier\""),
        // It overlaps the first one, which counts.
        (210, [[-20.0, -3.0, -3.0], [-4.0, 3.0, 3.0]], ""),
    ];
    let bridge = import_plate(true, &boxes(&rows), &options()).unwrap();
    let expected = [("pier", 205), ("mesh-2", 210), ("mesh", 12)];
    assert_eq!(names_and_elements(&bridge), expected.map(|(name, element)| (name.to_owned(), element)));
    let parts = model(&bridge);
    let spans: Vec<[f64; 2]> = parts
        .parts()
        .iter()
        .map(|part| {
            [f64::min as fn(f64, f64) -> f64, f64::max]
                .map(|pick| part.shape.corners_m().iter().map(|p| p[0]).reduce(pick).unwrap())
        })
        .collect();
    assert_eq!(spans, [[-10.0, -6.0], [-6.0, -4.0], [-4.0, 10.0]], "the origin is the one without boxes");
    // The surfaces together are the surface of the whole, and nothing closes the cuts.
    let triangles = |bridge: &ImportedBridge| -> Vec<[[i64; 3]; 3]> {
        let model = model(bridge);
        let corners = |part: &ModelPart| {
            let mesh = part.shape.mesh().into_owned();
            mesh.triangles
                .iter()
                .map(|triangle| mesh.corners(*triangle).map(|p| p.map(|value| (value * 8.0) as i64)))
                .collect::<Vec<_>>()
        };
        let mut all: Vec<_> = model
            .parts()
            .iter()
            .flat_map(corners)
            .map(|mut corners| {
                corners.sort_unstable();
                corners
            })
            .collect();
        all.sort_unstable();
        all
    };
    let all = triangles(&bridge);
    assert_eq!(all.len(), 2 * (2 * 80 + 2 * 20 + 2 * 4));
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
    for (part, holes) in parts.parts().iter().zip([1, 2, 1]) {
        let PartShape::Mesh(surface) = &part.shape else { panic!("{}: not a mesh", part.name) };
        assert!(!surface.is_closed() && surface.colors().len() == surface.mesh().vertices_m.len());
        assert_eq!(bridge.report.parts.iter().find(|row| row.name == part.name).unwrap().holes, holes);
        let is_own = |(vertex, color): (&Point, &[u8; 3])| color[0] == 255 && (vertex[0] < -9.0 || color[2] < 10);
        assert!(surface.mesh().vertices_m.iter().zip(surface.colors()).all(is_own));
    }
    assert_eq!(bridge, import_plate(true, &boxes(&rows), &options()).unwrap(), "the same every time");
    let none = |_: &str| Err("no file".to_owned());
    let elements = ElementMap::read("elements.toml", &bridge.elements).unwrap();
    let again = ImportSource { file: "bridge.glb", format: ModelFormat::Gltf, bytes: &bridge.model, load: &none, elements };
    let fixed = ImportOptions { origin: ModelOrigin::Point([0.0; 3]), ..options() };
    let again = import(&again, &fixed).unwrap();
    let content = |bridge: &ImportedBridge| {
        let part = |part: &ModelPart| {
            let mut corners = part.shape.corners_m().to_vec();
            corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
            (part.name.clone(), part.element, corners)
        };
        model(bridge).parts().iter().map(part).collect::<Vec<_>>()
    };
    assert_eq!(content(&again), content(&bridge), "an import of the divided parts loses none of their surface");
    assert_eq!(job(&bridge).bridges.len(), 1);
}

#[test]
fn exact_boxes_are_in_the_axes_of_a_bridge_imported_without_them() {
    // The requested origin is 5 m along x; the first turn makes x run along the file's y.
    let options = ImportOptions { origin: ModelOrigin::Point([5.0, 0.0, 0.0]), turn_deg: 90.0, ..options() };
    let rows = [(205, [[-3.0, -15.5, -2.0], [3.0, -9.0, 1.0]], "name = \"end\"")];
    let whole = import_plate(false, "format = 1\n", &options).unwrap();
    let (low, high) = model(&whole).extent().whole;
    assert!((low[1] + 15.0).abs() < 1e-5 && (high[1] - 5.0).abs() < 1e-5, "{low:?} {high:?}");
    let bridge = import_plate(false, &boxes(&rows), &options).unwrap();
    let model = model(&bridge);
    let end = model.parts().iter().find(|part| part.name == "end").unwrap();
    assert!(end.shape.corners_m().iter().all(|p| p[1] < -9.0 + 1e-5));
    assert!(bridge.scenario.contains("is the point 5.000, 0.000, 0.000 of the model"), "{}", bridge.scenario);
    // A box of 6 x 40 m about the middle, turned across the bridge, is the same as one of 40 x 6 m.
    let along = painted_spans("box_m = [[-20, -3, -9], [20, 3, 9]]\nbox_turn_deg = 90");
    let across = painted_spans("box_m = [[-3, -20, -9], [3, 20, 9]]");
    assert_eq!(along, across);
    assert_eq!(along[0], ("mesh-1".to_owned(), -3.0, 3.0));
}

/// Returns the name, and the extent along x, of the parts of the plate that a row divides.
fn painted_spans(row: &str) -> Vec<(String, f64, f64)> {
    let elements = format!("format = 1\n[[elements]]\nelement = 205\n{row}\n");
    let bridge = import_plate(false, &elements, &options()).unwrap();
    let span = |part: &ModelPart| {
        let x = |pick: fn(f64, f64) -> f64| part.shape.corners_m().iter().map(|p| p[0]).reduce(pick).unwrap();
        (part.name.clone(), x(f64::min), x(f64::max))
    };
    model(&bridge).parts().iter().map(span).collect()
}

#[test]
fn regress_the_rest_of_a_divided_part_without_an_element_is_listed() {
    let nothing = ImportOptions { default_element: None, ..options() };
    let rows = [(205, [[-20.0, -3.0, -3.0], [0.0, 3.0, 3.0]], "name = \"pier\"")];
    let Err(ImportError::UnknownElements { parts, elements, .. }) = import_plate(false, &boxes(&rows), &nothing) else {
        panic!("it was imported")
    };
    assert_eq!(parts, ["mesh"]);
    let row = elements.split("[[elements]]").nth(1).unwrap().replace("element = 0", "element = 12");
    let both = format!("{}[[elements]]{row}", boxes(&rows));
    let bridge = import_plate(false, &both, &nothing).unwrap();
    assert_eq!(names_and_elements(&bridge), [("pier", 205), ("mesh", 12)].map(|(name, element)| (name.to_owned(), element)));
}

/// Returns name and element number of each part, by the elements file alone.
fn names_and_elements(bridge: &ImportedBridge) -> Vec<(String, u16)> {
    let map = ElementMap::read("elements.toml", &bridge.elements).unwrap();
    let row = |name: &str| (name.to_owned(), map.element_of(name).map_or(0, Element::number));
    model(bridge).parts().iter().map(|part| row(&part.name)).collect()
}

#[test]
fn regress_numbered_parts_do_not_get_the_name_of_another_node() {
    let bridge = imported_boxes(&[("girder", 107, 2), ("girder/01", 109, 1), ("Girder", 12, 1), ("girder-2", 210, 1)]);
    let expected = [("girder-4/01", 107), ("girder-4/02", 107), ("girder/01", 109), ("Girder-3", 12), ("girder-2", 210)];
    assert_eq!(names_and_elements(&bridge), expected.map(|(name, element)| (name.to_owned(), element)));
    assert_eq!(bridge.report.parts[0].name, "girder-4");
    let long = ["a".repeat(120), "a".repeat(110)];
    let bridge = imported_boxes(&[(&long[0], 107, 3), (&long[1], 109, 3)]);
    assert_eq!(
        names_and_elements(&bridge).iter().map(|(_, element)| *element).collect::<Vec<_>>(),
        [107, 107, 107, 109, 109, 109]
    );
}

#[test]
fn regress_patterns_of_the_elements_file_match_only_parts_of_their_element() {
    let bridge =
        imported_boxes(&[("Girder-1", 107, 1), ("girder-x", 109, 1), ("girder-2", 107, 2), ("a*b", 12, 1), ("axb", 210, 1)]);
    let expected = [("Girder-1", 107), ("girder-x", 109), ("girder-2/01", 107), ("girder-2/02", 107), ("a-b", 12), ("axb", 210)];
    assert_eq!(names_and_elements(&bridge), expected.map(|(name, element)| (name.to_owned(), element)));
    let similar = imported_boxes(&[("Girder-1", 107, 1), ("girder-2", 107, 2), ("deck", 12, 1)]);
    assert!(similar.elements.contains("parts = \"girder-*\"") || similar.elements.contains("parts = \"Girder-*\""));
}

#[test]
fn regress_checksum_covers_the_files_of_an_imported_bridge() {
    let bridge = imported_boxes(&[("deck", 12, 1), ("pier", 210, 1)]);
    let other = imported_boxes(&[("deck", 12, 2), ("pier", 210, 1)]);
    let crc = |model: &[u8], elements: &str, text: &str| {
        let load = |name: &str| match name {
            "bridge.glb" => Ok(model.to_vec()),
            "elements.toml" => Ok(elements.as_bytes().to_vec()),
            _ => Err("no such file".to_owned()),
        };
        let crc = scenario::read("job.toml", text, &load).unwrap().crc;
        assert_eq!(scenario::variant_with_crc(text, &load, crc).as_deref(), Some(text));
        assert_eq!(scenario::variant_with_crc(text, &load, crc ^ 1), None);
        crc
    };
    let (model, elements, text) = (&bridge.model[..], bridge.elements.as_str(), bridge.scenario.as_str());
    let original = crc(model, elements, text);
    assert_eq!(original, crc(model, elements, &format!("# A comment\n{text}")));
    assert_eq!(original, crc(model, elements, &scenario::resolve(text, 7, &[])));
    let others = [
        original,
        crc(&other.model, elements, text),
        crc(model, &format!("{elements}\n"), text),
        crc(model, elements, &text.replace("level = \"light\"", "level = \"calm\"")),
    ];
    assert!((0..others.len()).all(|k| !others[..k].contains(&others[k])), "{others:?}");
}

/// Returns a picture of two by one pixels: red, and half of the light.
fn picture() -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    let pixels = vec![255, 0, 0, 188, 188, 188];
    image::RgbImage::from_raw(2, 1, pixels).unwrap().write_to(&mut file, image::ImageFormat::Png).unwrap();
    file.into_inner()
}

#[test]
fn exact_vertices_have_the_colors_of_their_own_or_of_the_picture() {
    let mut text = ModelText::default();
    let mesh = text.mesh(&[[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], &[0, 1, 2]);
    let bytes = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let places = bytes(&[0.25, 0.5, 0.75, 0.5, 1.25, 7.5]);
    let places = text.accessor(&places, json!({ "componentType": 5126, "count": 3, "type": "VEC2" }));
    let own = bytes(&[1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 2.0]);
    let own = text.accessor(&own, json!({ "componentType": 5126, "count": 3, "type": "VEC3" }));
    text.nodes.push(json!({ "name": "part", "mesh": mesh }));
    let mut file = text.json();
    let uri = format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(picture()));
    file["images"] = json!([{ "uri": uri }]);
    file["textures"] = json!([{ "source": 0 }]);
    let look = json!({ "baseColorTexture": { "index": 0 }, "baseColorFactor": [0.5, 1.0, 1.0, 1.0] });
    file["materials"] = json!([{ "pbrMetallicRoughness": look }]);
    let primitive = &mut file["meshes"][mesh]["primitives"][0];
    primitive["material"] = json!(0);
    primitive["attributes"]["TEXCOORD_0"] = json!(places);
    let read = |file: &Value| gltf_reader::read("m.gltf", file.to_string().as_bytes(), &|_| Err("no file".to_owned()));
    let colors = |file: &Value| read(file).unwrap().nodes.swap_remove(0).colors;
    assert_eq!(colors(&file), [[128, 0, 0], [64, 128, 128], [128, 0, 0]], "the picture repeats");
    let mut unreadable = file.clone();
    unreadable["images"][0]["uri"] = json!("away.png");
    assert!(colors(&unreadable).is_empty());
    file["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(own);
    assert_eq!(colors(&file), [[128, 0, 0], [0, 128, 0], [0, 0, 255]]);
    file["accessors"][own]["count"] = json!(2);
    assert_eq!(read(&file).unwrap_err(), "m.gltf: node part: 2 colors (allowed: 3, one per position)");
}

#[test]
fn exact_a_mesh_keeps_its_colors_in_the_file() {
    let surface = |colors: &[[u8; 3]]| {
        // A tent without a floor.
        let vertices_m = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [2.0, 2.0, 3.0]];
        let mesh = Mesh { vertices_m, triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] };
        let shape = PartShape::Mesh(SurfaceMesh::with_colors(&mesh, colors).unwrap());
        ModelPart { name: "tent".into(), element: Element::RcDeck, shape }
    };
    for colors in [&[[9, 8, 7], [6, 5, 4], [3, 2, 1], [0, 255, 128], [1, 1, 1]][..], &[]] {
        let part = surface(colors);
        let file = parts_glb(std::iter::once(&part)).unwrap();
        assert_eq!(Model::read("bridge.glb", &file, &ElementMap::default()).unwrap().parts(), [part]);
    }
}
