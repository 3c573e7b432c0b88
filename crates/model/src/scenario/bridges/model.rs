//! A bridge whose members come from a file written by `spandrel import`: binary glTF with one node per part, convex or in triangles.

use super::dimensions::Inconsistency;
use super::element_map::ElementMap;
use super::path::{LocalPath, PathPlace, TaskKind};
use super::quantity::ElementQuantity;
use super::shape::BridgeShape;
use super::solid::{Footing, LocalPoint, MemberBuilder};
use crate::elements::{Element, ElementGroup};
use crate::mesh::Mesh;
use crate::mesh::gltf_reader;
use crate::mesh::hull::read_solid;
use crate::mesh::mesh_file::MeshNode;
use crate::mesh::part_shapes::PartShape;
use crate::mesh::surface_mesh::SurfaceMesh;
use crate::mesh::vectors::bounds;
use crate::mesh::vertex_colors::Color;
use std::sync::Arc;

/// Maximum size of the file, bytes (estimate: the five million triangles that an import reads, with shared vertices).
pub const MAX_MODEL_BYTES: usize = 128 * 1024 * 1024;
/// Maximum number of parts (estimate: the pictures of more members take minutes to prepare).
pub const MAX_PARTS: usize = 20_000;
/// Maximum distance of a part from the origin of the bridge axes, m.
pub const MAX_REACH_M: f64 = 5_000.0;

/// A bridge made of the parts of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Model {
    parts: Arc<Vec<ModelPart>>,
    quantities: Vec<ElementQuantity>,
    extent: ModelExtent,
}

/// A part in bridge axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelPart {
    /// Name, unique in the file.
    pub name: String,
    /// Bridge element.
    pub element: Element,
    /// Shape in bridge axes.
    pub shape: PartShape,
}

/// Bounding boxes in bridge axes: lowest and highest corners, m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ModelExtent {
    /// All parts.
    pub whole: (LocalPoint, LocalPoint),
    /// The deck; all parts if no part is one.
    pub deck: (LocalPoint, LocalPoint),
    /// The deck and the members below it that carry it; all parts if there are none.
    pub superstructure: (LocalPoint, LocalPoint),
}

impl ModelExtent {
    /// Returns the extent of parts.
    #[must_use]
    pub fn of(parts: &[ModelPart]) -> Self {
        Self::around(parts.iter().map(|part| (part.element, part.shape.corners_m())))
    }

    /// Returns the extent of points, with the element to which they belong.
    pub fn around<'a>(parts: impl Iterator<Item = (Element, &'a [LocalPoint])> + Clone) -> Self {
        let among = |is_wanted: fn(ElementGroup) -> bool| {
            let wanted = parts.clone().filter(|(element, _)| is_wanted(element.group()));
            bounds(wanted.flat_map(|(_, points)| points.iter().copied()))
        };
        let whole = among(|_| true).unwrap_or_default();
        let deck = among(|group| group == ElementGroup::Deck).unwrap_or(whole);
        let carrying = |group| matches!(group, ElementGroup::Deck | ElementGroup::Superstructure);
        Self { whole, deck, superstructure: among(carrying).unwrap_or(whole) }
    }
}

impl Model {
    /// Value of `type` in scenario files, and name of the table.
    pub const TYPE: &'static str = "model";

    /// Reads the parts from a binary glTF file. A part that matches a pattern of `map` has its element; others have the element number in
    /// their `extras`. `file` is the file's name in messages.
    ///
    /// # Errors
    /// Returns what is wrong, with the node, the value and what is allowed.
    pub fn read(file: &str, bytes: &[u8], map: &ElementMap) -> Result<Self, String> {
        if bytes.len() > MAX_MODEL_BYTES {
            return Err(format!("{file}: {} bytes (allowed: at most {MAX_MODEL_BYTES})", bytes.len()));
        }
        let other_files = |_: &str| Err("the buffer must be in the file".to_owned());
        let content = gltf_reader::read(file, bytes, &other_files)?;
        if content.nodes.len() > MAX_PARTS {
            return Err(format!("{file}: {} parts (allowed: at most {MAX_PARTS})", content.nodes.len()));
        }
        let part = |node: &MeshNode| model_part(node, map).map_err(|words| format!("{file}: node {}: {words}", node.name));
        let parts = content.nodes.iter().map(part).collect::<Result<Vec<_>, _>>()?;
        let mut names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(format!("{file}: node {}: the name occurs twice (allowed: unique names)", pair[0]));
        }
        let extent = ModelExtent::of(&parts);
        Ok(Self { parts: Arc::new(parts), quantities: map.quantities(), extent })
    }

    /// Returns the parts.
    #[must_use]
    pub fn parts(&self) -> &[ModelPart] {
        &self.parts
    }

    /// Returns the bounding boxes of the parts.
    #[must_use]
    pub const fn extent(&self) -> &ModelExtent {
        &self.extent
    }

    fn about_origin_m(&self, axis: usize) -> f64 {
        let (low, high) = self.extent.deck;
        2.0 * low[axis].abs().max(high[axis].abs())
    }
}

impl BridgeShape for Model {
    fn type_in_words(&self) -> &'static str {
        "an imported bridge"
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        &[TaskKind::Free]
    }

    fn inconsistencies(&self) -> Vec<Inconsistency> {
        Vec::new()
    }

    fn build(&self, b: &mut MemberBuilder) {
        for ModelPart { name, element, shape } in self.parts.iter() {
            match shape {
                PartShape::Convex(solid) => b.add_solid(name, *element, &solid.corners_m, solid.faces.clone()),
                PartShape::Mesh(surface) => b.add_surface(name, *element, surface),
            }
        }
    }

    /// Returns the length of a deck about the origin that contains the model's own deck, m.
    fn deck_length_m(&self) -> f64 {
        self.about_origin_m(0)
    }

    /// Returns the width of a deck about the origin that contains the model's own deck, m.
    fn deck_width_m(&self) -> f64 {
        self.about_origin_m(1)
    }

    /// Returns `None`, because the road of an imported bridge is unknown.
    fn walkway_y_m(&self) -> Option<f64> {
        None
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        (self.extent.superstructure.0[2].min(self.extent.deck.0[2]), self.extent.deck.1[2])
    }

    fn opening_half_length_m(&self) -> f64 {
        0.5 * self.deck_length_m()
    }

    fn underside_depth_m(&self) -> Option<f64> {
        None
    }

    fn footings(&self) -> Vec<Footing> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        self.quantities.clone()
    }

    fn task_path(&self, _: TaskKind, _: f64, _: &PathPlace) -> Result<LocalPath, String> {
        Err(self.supported_kinds())
    }
}

/// Converts a node to a part: welded, closed and convex, or its triangles as they are.
fn model_part(node: &MeshNode, map: &ElementMap) -> Result<ModelPart, String> {
    let element = map.element_of(&node.name).or_else(|| node.element.map(Element::from_number));
    let element = element.ok_or("no element number (allowed: extras.element, or a pattern in the elements file)")?;
    let mut mesh = node.mesh.clone();
    for vertex in &mut mesh.vertices_m {
        *vertex = from_gltf_axes(*vertex);
        if !vertex.iter().all(|value| (-MAX_REACH_M..=MAX_REACH_M).contains(value)) {
            return Err(format!("corner {vertex:?} m (allowed: within {MAX_REACH_M} m of the origin)"));
        }
    }
    let shape = if node.is_surface { surface(&mesh, &node.colors)? } else { convex(&mesh)? };
    Ok(ModelPart { name: node.name.clone(), element, shape })
}

fn surface(mesh: &Mesh, colors: &[Color]) -> Result<PartShape, String> {
    let surface = SurfaceMesh::with_colors(mesh, colors).ok_or("no triangle has an area (allowed: at least one)")?;
    Ok(PartShape::Mesh(surface))
}

fn convex(mesh: &Mesh) -> Result<PartShape, String> {
    let solid = read_solid(mesh).map_err(|found| {
        let (pieces, open) = (found.len(), found.iter().map(|piece| piece.open_edges).sum::<usize>());
        let allowed = "one closed convex solid, or extras.shape = \"mesh\"; `spandrel import` makes them";
        format!("{pieces} pieces, {open} open edges (allowed: {allowed})")
    })?;
    Ok(PartShape::Convex(solid))
}

/// Converts a point from glTF's axes (y up) to bridge axes: x stays, y is -z, and z is y.
#[must_use]
pub const fn from_gltf_axes([x, y, z]: LocalPoint) -> LocalPoint {
    [x, -z, y]
}
