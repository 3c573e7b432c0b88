//! Reads the faces of Wavefront OBJ files: one part per object or group.

use super::mesh_file::{MAX_NODES, MAX_TRIANGLES, MeshFile, MeshNode, check_file_size, check_vertex, clean_name};
use super::{Mesh, vectors::Point};
use tobj::LoadOptions;

/// Reads an OBJ file. `file` is its name in messages. Materials have no effect on the geometry and are not read.
///
/// # Errors
/// Returns what is wrong, with the file, the part, the value and what is allowed.
pub fn read(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    let problem = |words: &str| format!("{file}: {words}");
    check_file_size(bytes).map_err(|words| problem(&words))?;
    let options = LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &options, |_| Ok(Default::default()))
        .map_err(|error| problem(&format!("not an OBJ file: {error}")))?;
    let mut content = MeshFile::default();
    for (k, model) in models.iter().enumerate() {
        let name = clean_name(&model.name, k);
        let mesh = mesh(&model.mesh).map_err(|words| problem(&format!("object {name}: {words}")))?;
        // A change of the material within an object begins another model with the same name.
        match content.nodes.last_mut().filter(|node| node.name == name) {
            Some(node) => node.mesh.append(&mesh),
            None if mesh.triangles.is_empty() => {}
            None => content.nodes.push(MeshNode { name, element: None, mesh, ignored_primitives: 0 }),
        }
    }
    let triangles: usize = content.nodes.iter().map(|node| node.mesh.triangles.len().max(node.mesh.vertices_m.len())).sum();
    if triangles > MAX_TRIANGLES || content.nodes.len() > MAX_NODES {
        let (nodes, limit) = (content.nodes.len(), format!("{MAX_TRIANGLES} triangles or vertices, and {MAX_NODES} objects"));
        return Err(problem(&format!("{triangles} triangles or vertices in {nodes} objects (allowed: {limit})")));
    }
    if content.nodes.is_empty() { Err(problem("no triangles (allowed: at least one face)")) } else { Ok(content) }
}

fn mesh(model: &tobj::Mesh) -> Result<Mesh, String> {
    let vertices_m: Vec<Point> = model.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    vertices_m.iter().enumerate().try_for_each(|(k, vertex)| check_vertex(k, *vertex))?;
    if let Some(index) = model.indices.iter().find(|k| **k as usize >= vertices_m.len()) {
        return Err(format!("index {index} (allowed: 0 to {})", vertices_m.len() as i64 - 1));
    }
    let triangles = model.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok(Mesh { vertices_m, triangles })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRA: &str = "mtllib away.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no pier 1\nusemtl a\nf 1 3 2\nf 1 2 4\nusemtl b\nf 2 3 4\nf 1 4 3\n\
         o deck\nf 1 3 2\nf 1/1 2/1 4/1\nf 2 3 4 1\nl 1 2\n";

    #[test]
    fn exact_objects_are_parts_and_materials_do_not_divide_them() {
        let content = read("a.obj", TETRAHEDRA.replace("1/1 2/1 4/1", "1 2 4").as_bytes()).unwrap();
        let found: Vec<(&str, usize)> =
            content.nodes.iter().map(|node| (node.name.as_str(), node.mesh.triangles.len())).collect();
        assert_eq!(found, [("pier 1", 4), ("deck", 4)]);
        assert!((content.nodes[0].mesh.volume_m3() - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn regress_bad_files_name_the_file_and_the_cause() {
        let error = |text: &str| read("a.obj", text.as_bytes()).unwrap_err();
        assert_eq!(error("v 0 0 0\n"), "a.obj: no triangles (allowed: at least one face)");
        assert!(error("v 0 0 0\nf 1 2 3\n").contains("a.obj: not an OBJ file: face vertex index out of bounds"));
        assert!(error("v nan 0 0\nv 1 0 0\nv 0 1 0\no part\nf 1 2 3\n").contains("a.obj: object part: position 0 = [NaN"));
        assert!(error("v 0 x 0\n").starts_with("a.obj: not an OBJ file"));
        for length in 0..TETRAHEDRA.len() {
            let _ = read("a.obj", &TETRAHEDRA.as_bytes()[..length]);
        }
    }
}
