//! Reads the faces of Wavefront OBJ files and the colors of their vertices: one part per object or group.

use super::mesh_file::{BufferLoader, MAX_NODES, MAX_TRIANGLES, MeshFile, MeshNode, check_file_size, check_vertex, clean_name};
use super::texture::Pictures;
use super::vertex_colors::{Color, of_srgb};
use super::{Mesh, vectors::Point};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;
use tobj::LoadOptions;

/// Reads an OBJ file. `file` is its name in messages; `load` loads its materials and their textures. Colors come from the vertices, from the
/// texture of the material (`map_Kd`), or from its color (`Kd`). A material file or texture that cannot be read leaves the parts without
/// colors: it has no effect on the geometry.
///
/// # Errors
/// Returns what is wrong, with the file, the part, the value and what is allowed.
pub fn read(file: &str, bytes: &[u8], load: BufferLoader) -> Result<MeshFile, String> {
    let problem = |words: &str| format!("{file}: {words}");
    check_file_size(bytes).map_err(|words| problem(&words))?;
    // With a single index, each vertex has its own place in the texture.
    let single_index = bytes.windows(4).any(|part| part == b"\nvt ");
    let options = LoadOptions { triangulate: true, single_index, ignore_points: true, ignore_lines: true };
    let materials = |path: &Path| match load(&path.to_string_lossy()) {
        Ok(text) => tobj::load_mtl_buf(&mut &text[..]),
        Err(_) => Ok(Default::default()),
    };
    let (models, materials) = tobj::load_obj_buf(&mut &bytes[..], &options, materials)
        .map_err(|error| problem(&format!("not an OBJ file: {error}")))?;
    let used: BTreeSet<usize> = models.iter().filter_map(|model| model.mesh.material_id).collect();
    let materials = materials.unwrap_or_default();
    let palette = Palette::new(&materials, &used, load);
    let mut content = MeshFile::default();
    for (k, model) in models.iter().enumerate() {
        let name = clean_name(&model.name, k);
        let mesh = mesh(&model.mesh).map_err(|words| problem(&format!("object {name}: {words}")))?;
        let colors = palette.colors(&model.mesh);
        // A change of the material within an object begins another model with the same name.
        match content.nodes.last_mut().filter(|node| node.name == name) {
            Some(node) => {
                let is_colored = !node.colors.is_empty() && !colors.is_empty();
                node.mesh.append(&mesh);
                if is_colored { node.colors.extend(colors) } else { node.colors.clear() }
            }
            None if mesh.triangles.is_empty() => {}
            None => {
                content.nodes.push(MeshNode { name, element: None, is_surface: false, mesh, colors, ignored_primitives: 0 });
            }
        }
    }
    let triangles: usize = content.nodes.iter().map(|node| node.mesh.triangles.len().max(node.mesh.vertices_m.len())).sum();
    if triangles > MAX_TRIANGLES || content.nodes.len() > MAX_NODES {
        let (nodes, limit) = (content.nodes.len(), format!("{MAX_TRIANGLES} triangles or vertices, and {MAX_NODES} objects"));
        return Err(problem(&format!("{triangles} triangles or vertices in {nodes} objects (allowed: {limit})")));
    }
    if content.nodes.is_empty() { Err(problem("no triangles (allowed: at least one face)")) } else { Ok(content) }
}

/// The materials of a file and their pictures.
struct Palette<'a> {
    materials: &'a [tobj::Material],
    pictures: Pictures<&'a str>,
}

impl<'a> Palette<'a> {
    fn new(materials: &'a [tobj::Material], used: &BTreeSet<usize>, load: BufferLoader) -> Self {
        let mut pictures = Pictures::new();
        for name in used.iter().filter_map(|id| materials.get(*id)?.diffuse_texture.as_deref()) {
            pictures.read(name, || load(texture_file(name)).ok().map(Cow::Owned));
        }
        Self { materials, pictures }
    }

    /// Returns the colors of an object's vertices; empty if it has none.
    fn colors(&self, mesh: &tobj::Mesh) -> Vec<Color> {
        let count = mesh.positions.len() / 3;
        let of_vertices = mesh.vertex_color.chunks_exact(3).map(|rgb| of_srgb([rgb[0], rgb[1], rgb[2]]));
        if mesh.vertex_color.len() == mesh.positions.len() && count > 0 {
            return of_vertices.collect();
        }
        let Some(material) = mesh.material_id.and_then(|id| self.materials.get(id)) else { return Vec::new() };
        match (material.diffuse_texture.as_deref().and_then(|name| self.pictures.get(&name)), material.diffuse) {
            (Some(picture), _) if mesh.texcoords.len() == 2 * count => {
                // In OBJ files, v counts from the bottom of the picture.
                mesh.texcoords.chunks_exact(2).map(|uv| picture.at([uv[0], 1.0 - uv[1]])).collect()
            }
            (None, Some(color)) => vec![of_srgb(color); count],
            (Some(_), _) | (None, None) => Vec::new(),
        }
    }
}

/// Returns the name of the file in the value of `map_Kd`, which may begin with options.
fn texture_file(value: &str) -> &str {
    if value.starts_with('-') { value.rsplit(' ').next().unwrap_or(value) } else { value }
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

    fn none(_: &str) -> Result<Vec<u8>, String> {
        Err("no file".to_owned())
    }

    /// Returns a picture of two by two pixels: red and green above blue and white.
    fn picture() -> Vec<u8> {
        let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]].concat();
        let mut file = std::io::Cursor::new(Vec::new());
        image::RgbImage::from_raw(2, 2, pixels).unwrap().write_to(&mut file, image::ImageFormat::Png).unwrap();
        file.into_inner()
    }

    #[test]
    fn exact_vertices_have_the_colors_of_their_material_and_its_texture() {
        let text = "mtllib looks.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.25 0.25\nvt 0.75 0.25\nvt 0.25 0.75\nvt 1.75 -0.25\no tiled\n\
             usemtl tiled\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\no plain\nusemtl plain\nf 1/1 2/2 4/4\n";
        let load = |name: &str| match name {
            "looks.mtl" => Ok(b"newmtl tiled\nKd 1 1 1\nmap_Kd -bm 0.2 tiles.png\nnewmtl plain\nKd 0 0.7373 1\n".to_vec()),
            "tiles.png" => Ok(picture()),
            _ => Err("no file".to_owned()),
        };
        let content = read("a.obj", text.as_bytes(), &load).unwrap();
        let color_at = |node: usize, vertex: [f64; 3]| {
            let node = &content.nodes[node];
            node.colors[node.mesh.vertices_m.iter().position(|other| *other == vertex).unwrap()]
        };
        assert_eq!(color_at(0, [0.0, 0.0, 0.0]), [0, 0, 255], "lower left");
        assert_eq!(color_at(0, [1.0, 0.0, 0.0]), [255, 255, 255], "lower right");
        assert_eq!(color_at(0, [0.0, 1.0, 0.0]), [255, 0, 0], "upper left");
        assert_eq!(color_at(0, [1.0, 1.0, 0.0]), [0, 255, 0], "the picture repeats");
        assert_eq!(content.nodes[1].colors, [[0, 128, 255]; 3]);
        let without = read("a.obj", text.as_bytes(), &none).unwrap();
        assert!(without.nodes[0].colors.is_empty());
        assert_eq!(without.nodes[0].mesh.triangles.len(), 2);
    }

    #[test]
    fn exact_objects_are_parts_and_materials_do_not_divide_them() {
        let content = read("a.obj", TETRAHEDRA.replace("1/1 2/1 4/1", "1 2 4").as_bytes(), &none).unwrap();
        let found: Vec<(&str, usize)> =
            content.nodes.iter().map(|node| (node.name.as_str(), node.mesh.triangles.len())).collect();
        assert_eq!(found, [("pier 1", 4), ("deck", 4)]);
        assert!((content.nodes[0].mesh.volume_m3() - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn regress_bad_files_name_the_file_and_the_cause() {
        let error = |text: &str| read("a.obj", text.as_bytes(), &none).unwrap_err();
        assert_eq!(error("v 0 0 0\n"), "a.obj: no triangles (allowed: at least one face)");
        assert!(error("v 0 0 0\nf 1 2 3\n").contains("a.obj: not an OBJ file: face vertex index out of bounds"));
        assert!(error("v nan 0 0\nv 1 0 0\nv 0 1 0\no part\nf 1 2 3\n").contains("a.obj: object part: position 0 = [NaN"));
        assert!(error("v 0 x 0\n").starts_with("a.obj: not an OBJ file"));
        for length in 0..TETRAHEDRA.len() {
            let _ = read("a.obj", &TETRAHEDRA.as_bytes()[..length], &none);
        }
    }
}
