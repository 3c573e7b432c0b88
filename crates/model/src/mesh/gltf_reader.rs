//! Reads the triangles of glTF 2.0 files (text or binary), with all node transforms applied. It reads positions, indices,
//! and the colors of vertices (their own, or those in the base color picture of their material). Skins and animations have no effect.

use super::Mesh;
use super::mesh_file::{
    BufferLoader, MAX_FILE_BYTES, MAX_NODES, MAX_TRIANGLES, MeshFile, MeshNode, check_file_size, check_vertex, clean_name,
};
use super::texture::Pictures;
use super::vectors::Point;
use super::vertex_colors::{Color, of_linear};
use base64::Engine;
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use serde_json::Value;
use std::borrow::Cow;

/// Maximum depth of the tree of nodes (estimate: far more than any modeling program writes).
const MAX_DEPTH: usize = 200;
/// Size of the header of a binary file, and of each of its chunks, bytes.
const GLB_HEADER_BYTES: usize = 12;
/// Key in `extras` with the number of the bridge element.
const ELEMENT_KEY: &str = "element";
/// Key in `extras` with the kind of shape, and its only value: triangles that collide as they are. Other nodes are convex.
pub const SHAPE_KEY: &str = "shape";
/// See [`SHAPE_KEY`].
pub const MESH_SHAPE: &str = "mesh";
/// Key in `extras` of nodes that are no part of a bridge, as in files written by `spandrel export --glb`: ground, water and pad.
const SURFACE_KEY: &str = "surface";

/// Product of the transforms of a node and the nodes above it: three columns and the translation.
#[derive(Debug, Clone, Copy)]
struct Affine([Point; 4]);

/// Properties that a node inherits from its parents.
#[derive(Debug, Clone)]
struct Inherited {
    name: Option<String>,
    element: Option<u16>,
    to_file: Affine,
    depth: usize,
}

struct NodeReader<'a> {
    file: &'a str,
    load: BufferLoader<'a>,
    /// Pictures by their number in the file.
    pictures: Pictures<usize>,
    buffers: Vec<Cow<'a, [u8]>>,
    is_visited: Vec<bool>,
    triangles: usize,
    vertices: usize,
    content: MeshFile,
}

/// Reads a glTF file. `file` is its name in messages; `load` loads the buffers that are files of their own.
///
/// # Errors
/// Returns what is wrong, with the file, the node, the value and what is allowed.
pub fn read(file: &str, bytes: &[u8], load: BufferLoader) -> Result<MeshFile, String> {
    let problem = |words: &str| format!("{file}: {words}");
    check_file_size(bytes).map_err(|words| problem(&words))?;
    check_header(bytes).map_err(|words| problem(&words))?;
    let gltf = Gltf::from_slice_without_validation(bytes).map_err(|error| problem(&format!("not a glTF file: {error}")))?;
    if let Some(extension) = gltf.as_json().extensions_required.first() {
        let words = format!("requires the extension {extension} (allowed: none; export without compression and quantization)");
        return Err(problem(&words));
    }
    check_attributes(gltf.as_json()).map_err(|words| problem(&words))?;
    // Checks that all indices of accessors, views, meshes and nodes exist.
    let gltf =
        Gltf { document: gltf::Document::from_json(gltf.document.into_json()).map_err(|e| problem(&e.to_string()))?, ..gltf };
    let buffers = read_buffers(&gltf, load).map_err(|words| problem(&words))?;
    let is_visited = vec![false; gltf.nodes().len()];
    let (pictures, content) = (Pictures::new(), MeshFile::default());
    let mut reader = NodeReader { file, load, pictures, buffers, is_visited, triangles: 0, vertices: 0, content };
    let root = Inherited { name: None, element: None, to_file: Affine::IDENTITY, depth: 0 };
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let Some(scene) = scene else { return Err(problem("no scene (allowed: at least one)")) };
    for node in scene.nodes() {
        reader.visit(&node, &root)?;
    }
    if reader.content.nodes.is_empty() {
        return Err(problem("no triangles (allowed: at least one node with a mesh)"));
    }
    Ok(reader.content)
}

/// Checks the lengths in the header of a binary file, which the library assumes to be valid.
fn check_header(bytes: &[u8]) -> Result<(), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok(());
    }
    let length = bytes.get(8..GLB_HEADER_BYTES).and_then(|field| field.try_into().ok()).map(u32::from_le_bytes);
    match length {
        Some(length) if (GLB_HEADER_BYTES + 8..=bytes.len()).contains(&(length as usize)) => Ok(()),
        Some(length) => Err(format!("truncated: {} of {length} bytes", bytes.len())),
        None => Err(format!("truncated: {} bytes (allowed: at least {GLB_HEADER_BYTES})", bytes.len())),
    }
}

/// Checks that the accessors of all attributes exist. The library's validation reads the limits of the positions without this check.
fn check_attributes(root: &gltf::json::Root) -> Result<(), String> {
    let accessors = root.accessors.len();
    for (mesh, primitive) in root.meshes.iter().enumerate().flat_map(|(k, mesh)| mesh.primitives.iter().map(move |p| (k, p))) {
        if let Some(missing) = primitive.attributes.values().find(|index| index.value() >= accessors) {
            return Err(format!(
                "mesh {mesh}: accessor {} (allowed: an accessor of the file, which has {accessors})",
                missing.value()
            ));
        }
    }
    Ok(())
}

fn read_buffers<'a>(gltf: &'a Gltf, load: BufferLoader) -> Result<Vec<Cow<'a, [u8]>>, String> {
    let mut total_bytes = 0;
    gltf.buffers()
        .map(|buffer| {
            let name = format!("buffer {}", buffer.index());
            let bytes: Cow<[u8]> = match buffer.source() {
                gltf::buffer::Source::Bin => {
                    gltf.blob.as_deref().ok_or_else(|| format!("{name}: the file has no binary chunk"))?.into()
                }
                gltf::buffer::Source::Uri(uri) => match uri.split_once(";base64,") {
                    Some((kind, text)) if kind.starts_with("data:") => {
                        let decoded = base64::engine::general_purpose::STANDARD.decode(text);
                        decoded.map_err(|error| format!("{name}: {error}"))?.into()
                    }
                    _ => load(&decoded(uri)).map_err(|error| format!("{name}: {uri}: {error}"))?.into(),
                },
            };
            let length = buffer.length();
            if bytes.len() < length || bytes.len() > MAX_FILE_BYTES {
                return Err(format!("{name}: {} bytes (allowed: {length} to {MAX_FILE_BYTES})", bytes.len()));
            }
            total_bytes += bytes.len();
            if total_bytes > MAX_FILE_BYTES {
                return Err(format!("{name}: {total_bytes} bytes in all buffers up to here (allowed: at most {MAX_FILE_BYTES})"));
            }
            Ok(bytes)
        })
        .collect()
}

/// Returns the number of triangles of a primitive with a number of corners.
const fn triangle_count(mode: Mode, corners: usize) -> usize {
    match mode {
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
        _ => corners / 3,
    }
}

/// Replaces the percent codes of a URI.
fn decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| *first == b'%').and_then(|code| std::str::from_utf8(code).ok());
        let byte = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(byte.unwrap_or(*first));
        rest = if byte.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns a color multiplied by the base color of a primitive's material.
fn tinted(primitive: &Primitive, color: Color) -> Color {
    let [red, green, blue, _] = primitive.material().pbr_metallic_roughness().base_color_factor().map(f64::from);
    let shares = color.map(|value| f64::from(value) / 255.0);
    of_linear([red * shares[0], green * shares[1], blue * shares[2]])
}

impl NodeReader<'_> {
    fn visit(&mut self, node: &Node, above: &Inherited) -> Result<(), String> {
        if above.depth > MAX_DEPTH || std::mem::replace(&mut self.is_visited[node.index()], true) {
            return Err(format!("{}: node {}: the nodes are not a tree of at most {MAX_DEPTH} levels", self.file, node.index()));
        }
        let extras: Value = node.extras().as_ref().and_then(|raw| serde_json::from_str(raw.get()).ok()).unwrap_or(Value::Null);
        let mesh_name = node.mesh().and_then(|mesh| mesh.name().map(str::to_owned));
        let name = node.name().map(str::to_owned).or(mesh_name).or_else(|| above.name.clone());
        if extras.get(SURFACE_KEY).is_some() {
            self.content.skipped.extend(name);
            return Ok(());
        }
        let shown = clean_name(name.as_deref().unwrap_or_default(), node.index());
        let element = self.element(&extras, &shown)?.or(above.element);
        let to_file = above.to_file.then(node);
        if node.mesh().is_some() {
            let mut mesh_node = self.read_node(node, &shown, element, to_file).map_err(|words| self.problem(&shown, &words))?;
            mesh_node.is_surface = extras.get(SHAPE_KEY).and_then(Value::as_str) == Some(MESH_SHAPE);
            if !mesh_node.mesh.triangles.is_empty() {
                self.content.nodes.push(mesh_node);
            }
            if self.content.nodes.len() > MAX_NODES {
                return Err(format!("{}: more than {MAX_NODES} nodes with a mesh", self.file));
            }
        }
        let inherited = Inherited { name, element, to_file, depth: above.depth + 1 };
        node.children().try_for_each(|child| self.visit(&child, &inherited))
    }

    fn problem(&self, node: &str, words: &str) -> String {
        format!("{}: node {node}: {words}", self.file)
    }

    fn element(&self, extras: &Value, node: &str) -> Result<Option<u16>, String> {
        let Some(value) = extras.get(ELEMENT_KEY) else { return Ok(None) };
        let number = value.as_u64().or_else(|| value.as_str()?.parse().ok()).and_then(|number| u16::try_from(number).ok());
        match number {
            Some(number @ 1..=999) => Ok(Some(number)),
            _ => Err(self.problem(node, &format!("extras.element = {value} (allowed: 1 to 999)"))),
        }
    }

    fn read_node(&mut self, node: &Node, name: &str, element: Option<u16>, to_file: Affine) -> Result<MeshNode, String> {
        let mut mesh = Mesh::default();
        let mut colors = Vec::new();
        let mut ignored_primitives = 0;
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let is_surface = matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
            if is_surface {
                self.read_primitive(&primitive, to_file, &mut mesh)?;
                // A primitive without colors leaves the whole node without.
                colors.extend(self.colors(&primitive)?);
            } else {
                ignored_primitives += 1;
            }
        }
        self.triangles += mesh.triangles.len();
        self.vertices += mesh.vertices_m.len();
        if colors.len() != mesh.vertices_m.len() {
            colors.clear();
        }
        Ok(MeshNode { name: name.to_owned(), element, is_surface: false, mesh, colors, ignored_primitives })
    }

    fn read_primitive(&self, primitive: &Primitive, to_file: Affine, mesh: &mut Mesh) -> Result<(), String> {
        let positions = primitive.get(&Semantic::Positions).ok_or("no positions")?;
        if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err("positions that are not three 32-bit floats".into());
        }
        let first = mesh.vertices_m.len();
        let stored = self.elements(&positions, "positions")?;
        let corners = match primitive.indices() {
            Some(accessor) => self.elements(&accessor, "indices")?.len(),
            None => stored.len(),
        };
        // Nodes can share a mesh and primitives can share accessors, so the size of the file does not limit their number.
        let all_vertices = self.vertices + first + stored.len();
        let all_triangles = self.triangles + mesh.triangles.len() + triangle_count(primitive.mode(), corners);
        if all_vertices.max(all_triangles) > MAX_TRIANGLES {
            return Err(format!("more than {MAX_TRIANGLES} triangles or vertices in the file"));
        }
        let mut vertices = Vec::with_capacity(stored.len());
        for bytes in stored {
            let own = [0, 4, 8]
                .map(|at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])));
            let vertex = to_file.apply(own);
            check_vertex(vertices.len(), vertex)?;
            vertices.push(vertex);
        }
        let count = vertices.len();
        let indices = match primitive.indices() {
            Some(accessor) => self.indices(&accessor, count)?,
            None => (0..count as u32).collect(),
        };
        mesh.vertices_m.extend(vertices);
        let triangle = |[a, b, c]: [u32; 3]| [a, b, c].map(|k| first as u32 + k);
        match primitive.mode() {
            Mode::TriangleStrip => {
                let alternating = |(k, w): (usize, &[u32])| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
                mesh.triangles.extend(indices.windows(3).enumerate().map(alternating).map(triangle));
            }
            Mode::TriangleFan => {
                mesh.triangles.extend((2..indices.len()).map(|k| triangle([indices[0], indices[k - 1], indices[k]])));
            }
            _ if indices.len() % 3 != 0 => return Err(format!("{} indices (allowed: a multiple of 3)", indices.len())),
            _ => mesh.triangles.extend(indices.chunks_exact(3).map(|c| triangle([c[0], c[1], c[2]]))),
        }
        Ok(())
    }

    /// Returns the colors of a primitive's vertices, its own or those of its material's picture; empty if it has none.
    fn colors(&mut self, primitive: &Primitive) -> Result<Vec<Color>, String> {
        let Some(accessor) = primitive.get(&Semantic::Colors(0)) else { return self.picture_colors(primitive) };
        let vertices = primitive.get(&Semantic::Positions).map_or(0, |positions| positions.count());
        if accessor.count() != vertices {
            return Err(format!("{} colors (allowed: {vertices}, one per position)", accessor.count()));
        }
        if !matches!(accessor.dimensions(), Dimensions::Vec3 | Dimensions::Vec4) {
            return Err("colors that are not three or four numbers".into());
        }
        let read: fn(&[u8]) -> Color = match accessor.data_type() {
            DataType::U8 => |bytes| [bytes[0], bytes[1], bytes[2]],
            DataType::U16 => |bytes| [bytes[1], bytes[3], bytes[5]],
            DataType::F32 => |bytes| {
                let share = |at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
                of_linear([0, 4, 8].map(share))
            },
            DataType::I8 | DataType::I16 | DataType::U32 => {
                return Err("colors that are not bytes, 16-bit numbers or floats".into());
            }
        };
        Ok(self.elements(&accessor, "colors")?.map(|bytes| tinted(primitive, read(bytes))).collect())
    }

    /// Returns the colors of a primitive's vertices in its base color picture; empty if it has none that can be read.
    fn picture_colors(&mut self, primitive: &Primitive) -> Result<Vec<Color>, String> {
        let look = primitive.material().pbr_metallic_roughness();
        let Some(info) = look.base_color_texture() else { return Ok(Vec::new()) };
        let Some(accessor) = primitive.get(&Semantic::TexCoords(info.tex_coord())) else { return Ok(Vec::new()) };
        let vertices = primitive.get(&Semantic::Positions).map_or(0, |positions| positions.count());
        if accessor.count() != vertices {
            return Err(format!("{} texture coordinates (allowed: {vertices}, one per position)", accessor.count()));
        }
        let read: fn(&[u8]) -> [f64; 2] = match (accessor.dimensions(), accessor.data_type()) {
            (Dimensions::Vec2, DataType::F32) => |bytes| {
                [0, 4].map(|at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])))
            },
            (Dimensions::Vec2, DataType::U16) => {
                |bytes| [0, 2].map(|at: usize| f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65535.0)
            }
            (Dimensions::Vec2, DataType::U8) => |bytes| [bytes[0], bytes[1]].map(|value| f64::from(value) / 255.0),
            _ => return Err("texture coordinates that are not two floats, 16-bit numbers or bytes".into()),
        };
        self.read_picture(&info.texture().source());
        let Some(picture) = self.pictures.get(&info.texture().source().index()) else { return Ok(Vec::new()) };
        Ok(self.elements(&accessor, "texture coordinates")?.map(|bytes| tinted(primitive, picture.at(read(bytes)))).collect())
    }

    /// Reads a picture of the file, once. One that cannot be read leaves the vertices without colors.
    fn read_picture(&mut self, image: &gltf::Image) {
        let Self { pictures, buffers, load, .. } = self;
        pictures.read(image.index(), || match image.source() {
            gltf::image::Source::View { view, .. } => {
                let end = view.offset().checked_add(view.length())?;
                buffers.get(view.buffer().index())?.get(view.offset()..end).map(Cow::Borrowed)
            }
            gltf::image::Source::Uri { uri, .. } => match uri.split_once(";base64,") {
                Some((kind, text)) if kind.starts_with("data:") => {
                    base64::engine::general_purpose::STANDARD.decode(text).ok().map(Cow::Owned)
                }
                _ => load(&decoded(uri)).ok().map(Cow::Owned),
            },
        });
    }

    fn indices(&self, accessor: &Accessor, vertices: usize) -> Result<Vec<u32>, String> {
        if accessor.dimensions() != Dimensions::Scalar {
            return Err("indices that are not single numbers".into());
        }
        let read: fn(&[u8]) -> u32 = match accessor.data_type() {
            DataType::U8 => |bytes| u32::from(bytes[0]),
            DataType::U16 => |bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            DataType::U32 => |bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
            DataType::I8 | DataType::I16 | DataType::F32 => return Err("indices that are not unsigned integers".into()),
        };
        let indices: Vec<u32> = self.elements(accessor, "indices")?.map(read).collect();
        match indices.iter().find(|index| **index as usize >= vertices) {
            Some(index) => Err(format!("index {index} (allowed: 0 to {})", vertices as i64 - 1)),
            None => Ok(indices),
        }
    }

    /// Returns the bytes of each element of an accessor.
    fn elements<'b>(
        &'b self,
        accessor: &Accessor,
        what: &str,
    ) -> Result<impl ExactSizeIterator<Item = &'b [u8]> + use<'b>, String> {
        if accessor.sparse().is_some() {
            return Err(format!("{what} in a sparse accessor (allowed: an accessor with all values)"));
        }
        let view = accessor.view().ok_or_else(|| format!("{what} without data"))?;
        let (count, size) = (accessor.count(), accessor.size());
        let stride = view.stride().unwrap_or(size);
        let buffer = &self.buffers[view.buffer().index()];
        let data = view.offset().checked_add(view.length()).and_then(|end| buffer.get(view.offset()..end));
        let end =
            count.saturating_sub(1).checked_mul(stride).and_then(|last| last.checked_add(size)?.checked_add(accessor.offset()));
        let data = data.zip(end).filter(|_| stride >= size).and_then(|(data, end)| data.get(accessor.offset()..end));
        let data = data.ok_or_else(|| format!("{count} {what} at byte {} are outside of their buffer", accessor.offset()))?;
        if count > MAX_TRIANGLES * 3 {
            return Err(format!("{count} {what} (allowed: at most {})", MAX_TRIANGLES * 3));
        }
        Ok((0..count).map(move |k| &data[k * stride..k * stride + size]))
    }
}

impl Affine {
    const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]);

    /// Returns the transform of a node below this one.
    fn then(self, node: &Node) -> Self {
        let columns = node.transform().matrix();
        let column = |k: usize| [0, 1, 2].map(|row: usize| f64::from(columns[k][row]));
        let [x, y, z] = [0, 1, 2].map(|k| self.rotate(column(k)));
        Self([x, y, z, self.apply(column(3))])
    }

    fn rotate(self, v: Point) -> Point {
        let Self([x, y, z, _]) = self;
        [0, 1, 2].map(|k: usize| x[k] * v[0] + y[k] * v[1] + z[k] * v[2])
    }

    fn apply(self, p: Point) -> Point {
        let rotated = self.rotate(p);
        [0, 1, 2].map(|k: usize| rotated[k] + self.0[3][k])
    }
}
