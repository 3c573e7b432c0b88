//! Exports the collision geometry as binary glTF 2.0, and the parts of imported bridges in the same form: one named node per bridge
//! member with its element number in `extras`, plus ground, water and landing pad. Meshes keep the colors of their vertices.
//! Positions are 32-bit floats (3e-5 m at 500 m). The axes follow the glTF convention: x east, y up, z south.

use super::Site;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::mesh::gltf_reader::{MESH_SHAPE, SHAPE_KEY};
use crate::mesh::part_shapes::PartShape;
use crate::mesh::vertex_colors::Color;
use crate::scenario::bridges::model::ModelPart;
use gltf::binary::{Glb, Header};
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Buffer, Stride, Target, View};
use gltf::json::material::{Material, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mesh as GltfMesh, Mode, Primitive, Semantic};
use gltf::json::scene::{Node, Scene};
use gltf::json::validation::Checked::Valid;
use gltf::json::{Asset, Index, Root};
use serde_json::{Value, json};
use std::borrow::Cow;

/// Material names and colors (red, green, blue), in the order of [`Surface`].
const MATERIALS: [(&str, f32, f32, f32); 5] = [
    ("structure", 0.62, 0.60, 0.57),
    ("ground", 0.33, 0.40, 0.25),
    ("water", 0.16, 0.30, 0.38),
    ("pad", 0.85, 0.55, 0.10),
    ("colored", 1.0, 1.0, 1.0),
];

/// Materials by their position in the file.
#[derive(Clone, Copy)]
enum Surface {
    Structure = 0,
    Ground = 1,
    Water = 2,
    Pad = 3,
    /// White, because viewers multiply the colors of vertices by that of the material.
    Colored = 4,
}

/// Most bytes of the file besides the JSON text and the buffer: the header, two chunk headers, and their padding.
const FRAMING_BYTES: usize = 12 + 2 * 8 + 2 * 3;
/// Size of a vertex in the buffer: three 32-bit floats.
const VERTEX_BYTES: usize = 12;

/// Size of a color in the buffer: four bytes, as the alignment requires.
const COLOR_BYTES: usize = 4;

/// A binary glTF file under construction. All positions are in the first view of its only buffer, all indices in the second, and all colors
/// in the third, if there are any.
#[derive(Default)]
struct GlbWriter {
    positions: Vec<u8>,
    indices: Vec<u8>,
    colors: Vec<u8>,
    root: Root,
}

/// Returns the entire site as a binary glTF file.
///
/// # Errors
///
/// The file would be longer than 4 GiB, the limit of the format.
pub fn glb(site: &Site) -> Result<Vec<u8>, gltf::Error> {
    let mut parts = GlbWriter::default();
    for member in site.members() {
        let (corners, triangles) = (&member.solid.vertices_m, member.solid.triangles());
        parts.add(&member.name, corners, &triangles, Surface::Structure, &extras(member.element, member.solid.is_convex()));
        if let Some(surface) = &member.solid.surface {
            parts.color(&surface.colors);
        }
    }
    let geometry = site.geometry();
    let (corners, triangles) = geometry.terrain.ground.triangles();
    parts.add("ground", &corners, &triangles, Surface::Ground, &json!({ "surface": "terrain" }));
    if let (Some(first), Some(last)) = (corners.first(), corners.last()) {
        let up = geometry.terrain.water_m;
        let water = square([first.east(), first.north()], [last.east(), last.north()], up);
        parts.add("water", &water, &SQUARE_TRIANGLES, Surface::Water, &json!({ "surface": "water" }));
    }
    let pad = &geometry.pad().solid;
    parts.add("pad", &pad.vertices_m, &pad.triangles(), Surface::Pad, &json!({ "surface": "pad" }));
    parts.finish()
}

/// Returns parts as a binary glTF file, each with its name, its element and its triangles, in axes with z up.
///
/// # Errors
///
/// The file would be longer than 4 GiB, the limit of the format.
pub fn parts_glb<'a>(parts: impl Iterator<Item = &'a ModelPart>) -> Result<Vec<u8>, gltf::Error> {
    let mut file = GlbWriter::default();
    for ModelPart { name, element, shape } in parts {
        let mesh = shape.mesh();
        let corners: Vec<Vec3<Enu>> = mesh.vertices_m.iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
        let is_convex = matches!(shape, PartShape::Convex(_));
        file.add(name, &corners, &mesh.triangles, Surface::Structure, &extras(*element, is_convex));
        match shape {
            PartShape::Convex(_) => {}
            PartShape::Mesh(surface) => file.color(surface.colors()),
        }
    }
    file.finish()
}

/// Returns the extras of a member's node.
fn extras(element: Element, is_convex: bool) -> Value {
    if is_convex { json!({ "element": element }) } else { json!({ "element": element, SHAPE_KEY: MESH_SHAPE }) }
}

/// Vertex indices of the two upward-facing triangles that form a square.
const SQUARE_TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn square([west, south]: [f64; 2], [east, north]: [f64; 2], up: f64) -> [Vec3<Enu>; 4] {
    [Vec3::new(west, south, up), Vec3::new(east, south, up), Vec3::new(east, north, up), Vec3::new(west, north, up)]
}

/// Converts a point from east, north, up to glTF's right-handed axes with y up.
fn to_gltf_axes(point: &Vec3<Enu>) -> [f32; 3] {
    [point.east() as f32, point.up() as f32, -point.north() as f32]
}

impl GlbWriter {
    fn add(&mut self, name: &str, corners: &[Vec3<Enu>], triangles: &[[u32; 3]], surface: Surface, extras: &Value) {
        let points: Vec<[f32; 3]> = corners.iter().map(to_gltf_axes).collect();
        let positions = self.root.push(position_accessor(self.positions.len(), &points));
        let indices = self.root.push(index_accessor(self.indices.len(), 3 * triangles.len()));
        self.positions.extend(points.iter().flatten().flat_map(|value| value.to_le_bytes()));
        self.indices.extend(triangles.iter().flatten().flat_map(|index| index.to_le_bytes()));
        let primitive = Primitive {
            attributes: [(Valid(Semantic::Positions), positions)].into(),
            extensions: None,
            extras: None,
            indices: Some(indices),
            material: Some(Index::new(surface as u32)),
            mode: Valid(Mode::Triangles),
            targets: None,
        };
        let mesh = self.root.push(GltfMesh {
            extensions: None,
            extras: None,
            name: Some(name.to_owned()),
            primitives: vec![primitive],
            weights: None,
        });
        self.root.push(Node {
            extras: serde_json::value::to_raw_value(extras).ok(),
            mesh: Some(mesh),
            name: Some(name.to_owned()),
            ..Node::default()
        });
    }

    /// Gives the vertices of the last mesh their colors, if there are any.
    fn color(&mut self, colors: &[Color]) {
        if colors.is_empty() {
            return;
        }
        let accessor =
            Accessor { normalized: true, ..accessor((2, self.colors.len()), colors.len(), ComponentType::U8, Type::Vec4) };
        let accessor = self.root.push(accessor);
        self.colors.extend(colors.iter().flat_map(|[red, green, blue]| [*red, *green, *blue, u8::MAX]));
        if let Some(primitive) = self.root.meshes.last_mut().and_then(|mesh| mesh.primitives.last_mut()) {
            primitive.attributes.insert(Valid(Semantic::Colors(0)), accessor);
            primitive.material = Some(Index::new(Surface::Colored as u32));
        }
    }

    fn finish(mut self) -> Result<Vec<u8>, gltf::Error> {
        let (positions, indices, colors) = (self.positions.len(), self.indices.len(), self.colors.len());
        self.root.asset =
            Asset { generator: Some(concat!("spandrel ", env!("CARGO_PKG_VERSION")).to_owned()), ..Asset::default() };
        let nodes = (0..self.root.nodes.len() as u32).map(Index::new).collect();
        let scene = Scene { extensions: None, extras: None, name: Some("site".to_owned()), nodes };
        self.root.scene = Some(self.root.push(scene));
        self.root.materials = MATERIALS.iter().map(material).collect();
        let buffer = self.root.push(Buffer {
            byte_length: (positions + indices + colors).into(),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        let view = |target, offset: usize, length: usize, stride| View {
            buffer,
            byte_length: length.into(),
            byte_offset: Some(offset.into()),
            byte_stride: stride,
            name: None,
            target: Some(Valid(target)),
            extensions: None,
            extras: None,
        };
        self.root.buffer_views = vec![
            view(Target::ArrayBuffer, 0, positions, Some(Stride(VERTEX_BYTES))),
            view(Target::ElementArrayBuffer, positions, indices, None),
        ];
        if colors > 0 {
            self.root.buffer_views.push(view(Target::ArrayBuffer, positions + indices, colors, Some(Stride(COLOR_BYTES))));
        }
        let json = self.root.to_vec().map_err(gltf::Error::Deserialize)?;
        let binary = [self.positions, self.indices, self.colors].concat();
        if u32::try_from(FRAMING_BYTES + json.len() + binary.len()).is_err() {
            return Err(gltf::Error::Io(std::io::Error::other("the file would exceed 4 GiB, the limit of binary glTF")));
        }
        // The writer computes the length.
        let header = Header { magic: *b"glTF", version: 2, length: 0 };
        Glb { header, json: Cow::Owned(json), bin: Some(Cow::Owned(binary)) }.to_vec()
    }
}

fn position_accessor(offset: usize, points: &[[f32; 3]]) -> Accessor {
    let bound = |start: f32, pick: fn(f32, f32) -> f32| {
        json!(points.iter().fold([start; 3], |so_far, p| [pick(so_far[0], p[0]), pick(so_far[1], p[1]), pick(so_far[2], p[2])]))
    };
    Accessor {
        min: Some(bound(f32::INFINITY, f32::min)),
        max: Some(bound(f32::NEG_INFINITY, f32::max)),
        ..accessor((0, offset), points.len(), ComponentType::F32, Type::Vec3)
    }
}

fn index_accessor(offset: usize, count: usize) -> Accessor {
    accessor((1, offset), count, ComponentType::U32, Type::Scalar)
}

/// Returns an accessor of `count` elements that start at a view and an offset in it.
fn accessor((view, offset): (u32, usize), count: usize, component: ComponentType, elements: Type) -> Accessor {
    Accessor {
        buffer_view: Some(Index::new(view)),
        byte_offset: Some(offset.into()),
        count: count.into(),
        component_type: Valid(GenericComponentType(component)),
        extensions: None,
        extras: None,
        type_: Valid(elements),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

fn material((name, r, g, b): &(&str, f32, f32, f32)) -> Material {
    Material {
        name: Some((*name).to_owned()),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([*r, *g, *b, 1.0]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(0.9),
            ..PbrMetallicRoughness::default()
        },
        ..Material::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    fn two_bridges() -> Scenario {
        let text = include_str!("../../../../scenarios/two-bridges.toml");
        crate::scenario::read("two-bridges.toml", text, &|_| Err("no file".into())).unwrap()
    }

    #[test]
    fn val_gltf_crate_reads_all_members_with_elements_and_vertices() {
        // 32-bit floats represent positions within 1 km with an accuracy of 6e-5 m.
        const ROUNDING_TOLERANCE_M: f64 = 6e-5;
        let site = Site::build(&two_bridges(), 1);
        let file = gltf::Gltf::from_slice(&glb(&site).unwrap()).unwrap();
        let nodes: Vec<_> = file.nodes().collect();
        assert_eq!(nodes.len(), site.members().len() + 3);
        for (node, member) in nodes.iter().zip(site.members()) {
            assert_eq!(node.name(), Some(member.name.as_str()));
            let extras: Value = serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
            assert_eq!(extras["element"], member.element.number());
            let primitive = node.mesh().unwrap().primitives().next().unwrap();
            let reader = primitive.reader(|_| file.blob.as_deref());
            let corners: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            for (corner, vertex) in corners.iter().zip(&member.solid.vertices_m) {
                let back = Vec3::<Enu>::new(f64::from(corner[0]), -f64::from(corner[2]), f64::from(corner[1]));
                assert!((back - *vertex).norm() < ROUNDING_TOLERANCE_M, "{}", member.name);
            }
            let indices = reader.read_indices().unwrap().into_u32();
            assert!(indices.into_iter().all(|index| (index as usize) < corners.len()));
            assert_eq!(corners.len(), member.solid.vertices_m.len());
        }
    }
}
