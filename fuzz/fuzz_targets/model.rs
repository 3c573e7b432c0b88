//! Feeds arbitrary bytes to the readers of 3D models and of imported bridges, which must return sound triangles or a message and never
//! panic.
#![no_main]

use spandrel_model::mesh::reader::{ModelFormat, read};
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let none = |_: &str| Err("no file".to_owned());
    for format in [ModelFormat::Gltf, ModelFormat::Ifc, ModelFormat::Obj, ModelFormat::Ply] {
        let Ok(content) = read(format, "fuzz", bytes, &none) else { continue };
        for node in content.nodes {
            assert!(node.mesh.vertices_m.iter().flatten().all(|value| value.is_finite()));
            assert!(node.mesh.triangles.iter().flatten().all(|k| (*k as usize) < node.mesh.vertices_m.len()));
        }
    }
    if let Err(message) = Model::read("fuzz.glb", bytes, &ElementMap::default()) {
        assert!(message.starts_with("fuzz.glb: "));
    }
});
