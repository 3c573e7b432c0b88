//! Reads PLY files, text and binary, as written by photogrammetry programs. A file with faces has one part, which is named `mesh`; one without
//! them is a point cloud.

use super::mesh_file::{MAX_TRIANGLES, MeshFile, MeshNode, check_file_size, check_vertex};
use super::point_cloud::PointCloud;
use super::vertex_colors::of_srgb;
use super::{Mesh, vectors::Point};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType, ScalarType};

/// Name of the only part.
const NAME: &str = "mesh";
/// Names of the list with the corners of a face.
const INDEX_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Names of the colors of a vertex. Those that begin with `diffuse_` are the same.
const COLORS: [&str; 3] = ["red", "green", "blue"];

/// A vertex while it is read.
#[derive(Debug, Default)]
struct Vertex {
    place: Point,
    /// Red, green and blue from 0 to 1, as on a screen.
    color: [f64; 3],
}

/// A face while it is read.
#[derive(Debug, Default)]
struct Polygon(Vec<i64>);

/// An element of another kind, which is skipped.
#[derive(Debug)]
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

impl Vertex {
    fn set(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
        let Some(axis) = axis else { return PropertyAccessResult::Ignored };
        self.place[axis] = value;
        PropertyAccessResult::Set
    }

    fn set_color(&mut self, name: &str, share: f64) -> PropertyAccessResult {
        let Some(k) = color_index(name) else { return PropertyAccessResult::Ignored };
        self.color[k] = share;
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_uchar(&mut self, name: &str, value: u8) -> PropertyAccessResult {
        self.set_color(name, f64::from(value) / 255.0)
    }

    fn set_ushort(&mut self, name: &str, value: u16) -> PropertyAccessResult {
        self.set_color(name, f64::from(value) / 65535.0)
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        self.set_double(name, f64::from(value))
    }

    fn set_double(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        if color_index(name).is_some() { self.set_color(name, value) } else { self.set(name, value) }
    }
}

impl Polygon {
    fn set(&mut self, name: &str, corners: impl Iterator<Item = i64>) -> PropertyAccessResult {
        if !INDEX_LISTS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = corners.collect();
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Polygon {
    fn new() -> Self {
        Self::default()
    }

    fn set_list_uchar(&mut self, name: &str, value: Vec<u8>) -> PropertyAccessResult {
        self.set(name, value.into_iter().map(i64::from))
    }

    fn set_list_ushort(&mut self, name: &str, value: Vec<u16>) -> PropertyAccessResult {
        self.set(name, value.into_iter().map(i64::from))
    }

    fn set_list_int(&mut self, name: &str, value: Vec<i32>) -> PropertyAccessResult {
        self.set(name, value.into_iter().map(i64::from))
    }

    fn set_list_uint(&mut self, name: &str, value: Vec<u32>) -> PropertyAccessResult {
        self.set(name, value.into_iter().map(i64::from))
    }
}

/// Reads a PLY file. `file` is its name in messages.
///
/// # Errors
/// Returns what is wrong, with the file, the value and what is allowed.
pub fn read(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    let problem = |words: &str| format!("{file}: {words}");
    check_file_size(bytes).map_err(|words| problem(&words))?;
    let Elements { vertices, polygons, are_colored } = read_elements(bytes).map_err(|words| problem(&words))?;
    let mesh = mesh(&vertices, &polygons).map_err(|words| problem(&words))?;
    if mesh.triangles.is_empty() {
        return cloud(&vertices, are_colored).map_err(|words| problem(&words));
    }
    let colors = if are_colored { vertices.iter().map(|vertex| of_srgb(vertex.color)).collect() } else { Vec::new() };
    let node = MeshNode { name: NAME.to_owned(), element: None, is_surface: false, mesh, colors, ignored_primitives: 0 };
    Ok(MeshFile { nodes: vec![node], ..MeshFile::default() })
}

/// Returns the vertices of a file without faces.
fn cloud(vertices: &[Vertex], are_colored: bool) -> Result<MeshFile, String> {
    let mut cloud = PointCloud::default();
    for vertex in vertices {
        cloud.push(vertex.place, are_colored.then(|| of_srgb(vertex.color)))?;
    }
    if cloud.is_empty() {
        return Err("no vertices (allowed: at least one)".to_owned());
    }
    Ok(MeshFile { cloud: Some(cloud), ..MeshFile::default() })
}

/// Returns the position of a color in [`COLORS`]; `None` for other properties.
fn color_index(name: &str) -> Option<usize> {
    let short = name.strip_prefix("diffuse_").unwrap_or(name);
    COLORS.iter().position(|color| *color == short)
}

/// Returns whether colors of this type are read.
fn is_color_type(kind: &PropertyType) -> bool {
    let read = [ScalarType::UChar, ScalarType::UShort, ScalarType::Float, ScalarType::Double];
    matches!(kind, PropertyType::Scalar(scalar) if read.contains(scalar))
}

#[derive(Default)]
struct Elements {
    vertices: Vec<Vertex>,
    polygons: Vec<Polygon>,
    are_colored: bool,
}

fn read_elements(bytes: &[u8]) -> Result<Elements, String> {
    let invalid = |error: &dyn std::fmt::Display| format!("not a PLY file: {error}");
    let mut reader = Reader::new(bytes);
    let header = Parser::<Vertex>::new().read_header(&mut reader).map_err(|error| invalid(&error))?;
    let mut found = Elements::default();
    for (name, element) in &header.elements {
        // Elements without properties take no bytes in a binary file, so its size would not limit their number.
        if element.properties.is_empty() {
            return Err(format!("element {name} has no properties (allowed: at least one)"));
        }
        if element.count as u64 > MAX_TRIANGLES as u64 {
            return Err(format!("{} elements {name} (allowed: at most {MAX_TRIANGLES})", element.count));
        }
        match name.as_str() {
            "vertex" => {
                let vertices = Parser::<Vertex>::new().read_payload_for_element(&mut reader, element, &header);
                found.vertices = vertices.map_err(|error| invalid(&error))?;
                let is_color =
                    |property: &PropertyDef, k| color_index(&property.name) == Some(k) && is_color_type(&property.data_type);
                let named = |k: usize| element.properties.values().any(|property| is_color(property, k));
                found.are_colored = (0..COLORS.len()).all(named);
            }
            "face" => {
                let polygons = Parser::<Polygon>::new().read_payload_for_element(&mut reader, element, &header);
                found.polygons = polygons.map_err(|error| invalid(&error))?;
            }
            _ => {
                let skipped = Parser::<Skipped>::new().read_payload_for_element(&mut reader, element, &header);
                skipped.map_err(|error| invalid(&error))?;
            }
        }
    }
    Ok(found)
}

fn mesh(vertices: &[Vertex], polygons: &[Polygon]) -> Result<Mesh, String> {
    vertices.iter().enumerate().try_for_each(|(k, vertex)| check_vertex(k, vertex.place))?;
    let mut triangles = Vec::with_capacity(polygons.len());
    for (number, Polygon(corners)) in polygons.iter().enumerate() {
        if let Some(index) = corners.iter().find(|k| !(0..vertices.len() as i64).contains(k)) {
            return Err(format!("face {number}: index {index} (allowed: 0 to {})", vertices.len() as i64 - 1));
        }
        if triangles.len() + corners.len().saturating_sub(2) > MAX_TRIANGLES {
            return Err(format!("face {number}: more than {MAX_TRIANGLES} triangles in the file"));
        }
        let corner = |k: usize| corners[k] as u32;
        triangles.extend((2..corners.len()).map(|k| [corner(0), corner(k - 1), corner(k)]));
    }
    Ok(Mesh { vertices_m: vertices.iter().map(|vertex| vertex.place).collect(), triangles })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat ascii 1.0\ncomment scan\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n\
         property uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    const DATA: &str = "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

    #[test]
    fn exact_faces_become_one_part() {
        let content = read("scan.ply", format!("{HEADER}{DATA}").as_bytes()).unwrap();
        assert_eq!((content.nodes.len(), content.nodes[0].name.as_str()), (1, "mesh"));
        assert!((content.nodes[0].mesh.volume_m3() - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn exact_colors_of_vertices_are_decoded_from_the_usual_types() {
        let plain = read("scan.ply", format!("{HEADER}{DATA}").as_bytes()).unwrap();
        assert!(plain.nodes[0].colors.is_empty(), "red alone is no color");
        for (kind, full, half) in
            [("uchar", "255", "188"), ("float", "1", "0.7373"), ("double", "1", "0.7373"), ("int", "255", "188")]
        {
            for prefix in ["", "diffuse_"] {
                let names = ["red", "green", "blue"].map(|name| format!("property {kind} {prefix}{name}\n")).concat();
                let header = HEADER.replace("property uchar red\n", &names);
                let data = DATA.replace(" 9\n", &format!(" {full} {half} 0\n"));
                let content = read("scan.ply", format!("{header}{data}").as_bytes()).unwrap();
                let expected = if kind == "int" { Vec::new() } else { vec![[255, 128, 0]; 4] };
                assert_eq!(content.nodes[0].colors, expected, "{kind}");
            }
        }
    }

    #[test]
    fn regress_bad_files_name_the_file_and_the_cause() {
        let error = |text: &str| read("scan.ply", text.as_bytes()).unwrap_err();
        assert!(error("ply\n").starts_with("scan.ply: not a PLY file"));
        assert_eq!(
            error(&format!("{HEADER}{DATA}").replace("3 1 2 3", "3 1 2 4")),
            "scan.ply: face 2: index 4 (allowed: 0 to 3)"
        );
        assert!(error(&format!("{HEADER}{DATA}").replace("1 0 0 9", "1e30 0 0 9")).contains("scan.ply: position 1 = ["));
        assert!(error(&format!("{HEADER}{DATA}").replace("1 0 0 9", "nan 0 0 9")).starts_with("scan.ply: "));
        let huge = HEADER.replace("vertex 4", "vertex 4000000000");
        assert!(error(&format!("{huge}{DATA}")).contains("4000000000 elements vertex (allowed: at most 5000000)"));
        let other = HEADER.replace("end_header", "element foo 5000001\nproperty uchar a\nend_header");
        assert!(error(&format!("{other}{DATA}")).contains("5000001 elements foo (allowed: at most 5000000)"));
        let cloud = HEADER.replace("face 4", "face 0");
        let content = read("scan.ply", format!("{cloud}{}", &DATA[..32]).as_bytes()).unwrap();
        assert_eq!((content.nodes.len(), content.cloud.map(|cloud| cloud.len())), (0, Some(4)));
        assert_eq!(error(&cloud.replace("vertex 4", "vertex 0")), "scan.ply: no vertices (allowed: at least one)");
        for length in 0..DATA.len() {
            let _ = read("scan.ply", format!("{HEADER}{}", &DATA[..length]).as_bytes());
        }
    }
    #[test]
    fn regress_elements_without_properties_are_refused() {
        for (format, count) in [("binary_little_endian", "18446744073709551615"), ("ascii", "3")] {
            let file = format!("ply\nformat {format} 1.0\nelement foo {count}\nend_header\n");
            let error = read("scan.ply", file.as_bytes()).unwrap_err();
            assert_eq!(error, "scan.ply: element foo has no properties (allowed: at least one)");
        }
    }

    #[test]
    fn regress_triangles_of_large_faces_are_limited() {
        let corners = MAX_TRIANGLES as u32 / 2 + 3;
        let mut file =
            b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty float y\nelement face 2\n\
            property list uint uchar vertex_indices\nend_header\n"
                .to_vec();
        file.extend([0; 5]);
        for _ in 0..2 {
            file.extend(corners.to_le_bytes());
            file.resize(file.len() + corners as usize, 0);
        }
        assert_eq!(read("scan.ply", &file).unwrap_err(), "scan.ply: face 1: more than 5000000 triangles in the file");
    }
}
