//! Exports the collision geometry as binary glTF 2.0: one named node per bridge member with its element number in `extras`, plus
//! ground, water and landing pad. Positions are 32-bit floats (3e-5 m at 500 m). The axes follow the glTF convention: x east, y
//! up, z south.

use super::Site;
use crate::frames::{Enu, Vec3};
use serde_json::{Value, json};

const POSITIONS: usize = 0;
const INDICES: usize = 1;
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Material names and colors (red, green, blue).
const MATERIALS: [(&str, f64, f64, f64); 4] =
    [("structure", 0.62, 0.60, 0.57), ("ground", 0.33, 0.40, 0.25), ("water", 0.16, 0.30, 0.38), ("pad", 0.85, 0.55, 0.10)];

/// Buffers of a binary glTF file under construction.
#[derive(Default)]
struct GlbWriter {
    positions: Vec<u8>,
    indices: Vec<u8>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

/// Returns the entire site as a binary glTF file.
#[must_use]
pub fn glb(site: &Site) -> Vec<u8> {
    let mut parts = GlbWriter::default();
    for member in site.members() {
        parts.add(&member.name, &member.solid.vertices_m, &member.solid.triangles(), 0, &json!({ "element": member.element }));
    }
    let geometry = site.geometry();
    let (corners, triangles) = geometry.terrain.ground.triangles();
    parts.add("ground", &corners, &triangles, 1, &json!({ "surface": "terrain" }));
    if let (Some(first), Some(last)) = (corners.first(), corners.last()) {
        let up = geometry.terrain.water_m;
        let water = square([first.east(), first.north()], [last.east(), last.north()], up);
        parts.add("water", &water, &SQUARE_TRIANGLES, 2, &json!({ "surface": "water" }));
    }
    let pad = &geometry.pad().solid;
    parts.add("pad", &pad.vertices_m, &pad.triangles(), 3, &json!({ "surface": "pad" }));
    parts.finish()
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
    fn add(&mut self, name: &str, corners: &[Vec3<Enu>], triangles: &[[u32; 3]], material: usize, extras: &Value) {
        let points: Vec<[f32; 3]> = corners.iter().map(to_gltf_axes).collect();
        let bound = |start: f32, pick: fn(f32, f32) -> f32| {
            points.iter().fold([start; 3], |so_far, p| [pick(so_far[0], p[0]), pick(so_far[1], p[1]), pick(so_far[2], p[2])])
        };
        let accessor = self.accessors.len();
        self.accessors.push(json!({
            "bufferView": POSITIONS, "byteOffset": self.positions.len(), "componentType": FLOAT, "count": points.len(),
            "type": "VEC3", "min": bound(f32::INFINITY, f32::min), "max": bound(f32::NEG_INFINITY, f32::max)
        }));
        self.accessors.push(json!({
            "bufferView": INDICES, "byteOffset": self.indices.len(), "componentType": UNSIGNED_INT, "count": 3 * triangles.len(),
            "type": "SCALAR"
        }));
        self.positions.extend(points.iter().flatten().flat_map(|value| value.to_le_bytes()));
        self.indices.extend(triangles.iter().flatten().flat_map(|index| index.to_le_bytes()));
        let primitive = json!({ "attributes": { "POSITION": accessor }, "indices": accessor + 1, "material": material });
        self.nodes.push(json!({ "name": name, "mesh": self.meshes.len(), "extras": extras }));
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
    }

    fn finish(self) -> Vec<u8> {
        let material = |(name, r, g, b): &(&str, f64, f64, f64)| {
            json!({ "name": name, "pbrMetallicRoughness":
                { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 } })
        };
        let (positions, indices) = (self.positions.len(), self.indices.len());
        let document = json!({
            "asset": { "version": "2.0", "generator": concat!("spandrel ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": "site", "nodes": (0..self.nodes.len()).collect::<Vec<_>>() }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": MATERIALS.iter().map(material).collect::<Vec<_>>(),
            "accessors": self.accessors,
            "bufferViews": [
                { "buffer": 0, "byteOffset": 0, "byteLength": positions, "byteStride": 12, "target": ARRAY_BUFFER },
                { "buffer": 0, "byteOffset": positions, "byteLength": indices, "target": ELEMENT_ARRAY_BUFFER }
            ],
            "buffers": [{ "byteLength": positions + indices }]
        });
        let binary = [self.positions, self.indices].concat();
        glb_container(document.to_string().into_bytes(), binary)
    }
}

/// Builds the GLB container: header, JSON chunk padded with spaces, binary chunk padded with zeros (glTF 2.0 specification,
/// section 4.4).
fn glb_container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = |bytes: usize| u32::try_from(bytes).unwrap_or(u32::MAX).to_le_bytes();
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(length(total));
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        file.extend(length(chunk.len()));
        file.extend(kind);
        file.extend(chunk);
    }
    file
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
        let (document, buffers, _) = gltf::import_slice(glb(&site)).unwrap();
        let nodes: Vec<_> = document.nodes().collect();
        assert_eq!(nodes.len(), site.members().len() + 3);
        for (node, member) in nodes.iter().zip(site.members()) {
            assert_eq!(node.name(), Some(member.name.as_str()));
            let extras: Value = serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
            assert_eq!(extras["element"], member.element.number());
            let primitive = node.mesh().unwrap().primitives().next().unwrap();
            let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()].0));
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
