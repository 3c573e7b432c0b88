//! Feeds arbitrary bytes to the readers of 3D models and of imported bridges, which must return sound triangles or a message and never
//! panic. The IFC library panics on some damaged files; the reader turns that into a message.
#![no_main]

use spandrel_model::mesh::reader::{ModelFormat, read};
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;
use std::panic::{set_hook, take_hook};

/// Part of the source paths of the IFC libraries, whose panics the reader catches.
const CAUGHT: &str = "/ifc-lite-";

/// Lets libFuzzer continue after panics in the IFC libraries. An uncaught panic still stops it.
fn tolerate_caught_panics() {
    let stop = take_hook();
    set_hook(Box::new(move |panic| {
        if !panic.location().is_some_and(|place| place.file().contains(CAUGHT)) {
            stop(panic);
        }
    }));
}

libfuzzer_sys::fuzz_target!(init: tolerate_caught_panics(), |bytes: &[u8]| {
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
