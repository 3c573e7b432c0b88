//! Divides parts of a model by the boxes of an elements file, so that a scan in one piece gets several elements.

use crate::elements::Element;
use crate::mesh::Mesh;
use crate::mesh::mesh_file::MeshNode;
use crate::mesh::surface_mesh::SurfaceMesh;
use crate::mesh::topology::{Component, components};
use crate::mesh::vectors::{Point, middle, sub};
use crate::mesh::vertex_colors::ColorsByPlace;
use crate::mesh::weld::weld;
use crate::scenario::bridges::element_map::{ElementMap, ElementRow};
use std::collections::BTreeMap;

/// A part before its conversion to shapes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ImportPart {
    /// Name, and the triangles that are converted to shapes.
    pub node: MeshNode,
    /// Its element, if it is known.
    pub element: Option<Element>,
    /// Triangles that collide as they are.
    pub kept: Vec<SurfaceMesh>,
    /// Number of degenerate or repeated triangles that were removed while the part was divided.
    pub dropped_triangles: usize,
}

/// Parts after their division.
pub(super) struct Painted {
    /// The parts.
    pub parts: Vec<ImportPart>,
    /// Boxes without a triangle: number of the row in the file, and the box.
    pub empty_boxes: Vec<(usize, String)>,
}

impl ImportPart {
    /// Creates a part from a whole node.
    pub(super) fn new(node: MeshNode, element: Option<Element>) -> Self {
        if !node.is_surface {
            return Self { node, element, kept: Vec::new(), dropped_triangles: 0 };
        }
        let kept = SurfaceMesh::with_colors(&node.mesh, &node.colors);
        let dropped_triangles = node.mesh.triangles.len() - kept.as_ref().map_or(0, |kept| kept.mesh().triangles.len());
        let node = MeshNode { mesh: Mesh::default(), colors: Vec::new(), ..node };
        Self { node, element, kept: kept.into_iter().collect(), dropped_triangles }
    }

    /// Returns all vertices in lists.
    pub(super) fn vertices_m(&self) -> impl Iterator<Item = &[Point]> + Clone {
        let kept = self.kept.iter().map(|surface| &surface.mesh().vertices_m[..]);
        std::iter::once(&self.node.mesh.vertices_m[..]).chain(kept)
    }
}

/// Divides nodes in bridge axes by the boxes of a map: each triangle belongs to the first row that matches the node's name and, if the row
/// has a box, contains the triangle's middle. A piece of the mesh that is in one row as a whole is converted like any other; the parts of
/// a divided piece keep their triangles. `elements` are the elements of the nodes without boxes, which the rest keeps; `origin` is the
/// origin of the boxes.
pub(super) fn paint(nodes: Vec<MeshNode>, elements: &[Option<Element>], map: &ElementMap, origin: Point) -> Painted {
    let mut counts = vec![0_usize; map.rows().len()];
    let mut parts = Vec::new();
    for (node, element) in nodes.into_iter().zip(elements) {
        let rows = map.rows_of(&node.name);
        if rows.iter().all(|k| map.rows()[*k].paint_box().is_none()) {
            parts.push(ImportPart::new(node, *element));
            continue;
        }
        let row_of = |triangle: [Point; 3]| {
            let at = sub(middle(&triangle), origin);
            let holds = |k: &usize| map.rows()[*k].paint_box().is_none_or(|own| own.contains(at));
            rows.iter().copied().find(holds)
        };
        let division = Division::of(&node, row_of);
        division
            .groups
            .iter()
            .filter_map(|(row, group)| Some((*row)?).zip(Some(group.triangles())))
            .for_each(|(row, count)| counts[row] += count);
        parts.extend(division.parts(&node, *element, map.rows()));
    }
    let is_empty = |(k, row): (usize, &ElementRow)| row.paint_box().filter(|_| counts[k] == 0).map(|own| (k + 1, own.words()));
    Painted { parts, empty_boxes: map.rows().iter().enumerate().filter_map(is_empty).collect() }
}

/// The triangles of a node that one row holds.
#[derive(Default)]
struct Group {
    /// Whole pieces.
    whole: Mesh,
    /// Parts of divided pieces.
    kept: Vec<Mesh>,
}

impl Group {
    fn triangles(&self) -> usize {
        self.whole.triangles.len() + self.kept.iter().map(|mesh| mesh.triangles.len()).sum::<usize>()
    }
}

/// The division of a node: its triangles by rows of the map; `None` for the rest, which comes last.
struct Division {
    groups: Vec<(Option<usize>, Group)>,
    dropped_triangles: usize,
}

impl Division {
    fn of(node: &MeshNode, row_of: impl Fn([Point; 3]) -> Option<usize>) -> Self {
        let welded = weld(&node.mesh);
        let mut groups: BTreeMap<usize, Group> = BTreeMap::new();
        let rest = usize::MAX;
        for Component { mesh, .. } in components(&welded.mesh) {
            let owners: Vec<usize> =
                mesh.triangles.iter().map(|triangle| row_of(mesh.corners(*triangle)).unwrap_or(rest)).collect();
            let first = owners[0];
            if owners.iter().all(|owner| *owner == first) && !node.is_surface {
                groups.entry(first).or_default().whole.append(&mesh);
                continue;
            }
            let mut triangles: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
            for (triangle, owner) in mesh.triangles.iter().zip(owners) {
                triangles.entry(owner).or_default().push(*triangle);
            }
            for (owner, triangles) in triangles {
                groups.entry(owner).or_default().kept.push(mesh.part(&triangles));
            }
        }
        let groups = groups.into_iter().map(|(owner, group)| (Some(owner).filter(|owner| *owner != rest), group)).collect();
        Self { groups, dropped_triangles: welded.dropped_triangles }
    }

    /// Returns the parts. A node that is in one row as a whole keeps its name, as does the rest of a node.
    fn parts(self, node: &MeshNode, rest: Option<Element>, rows: &[ElementRow]) -> Vec<ImportPart> {
        let is_whole = self.groups.len() == 1;
        let colors = (!node.colors.is_empty()).then(|| ColorsByPlace::new(&node.mesh.vertices_m, &node.colors));
        let colors_of = |mesh: &Mesh| colors.as_ref().map(|table| table.colors(&mesh.vertices_m)).unwrap_or_default();
        let part = |(k, (row, group)): (usize, (Option<usize>, Group))| {
            let boxed = row.filter(|row| rows[*row].paint_box().is_some() && !is_whole);
            let name = match boxed {
                Some(row) => rows[row].name().map_or_else(|| format!("{}-{}", node.name, row + 1), str::to_owned),
                None => node.name.clone(),
            };
            let element = row.map_or(rest, |row| Some(rows[row].element()));
            let kept = group.kept.iter().filter_map(|mesh| SurfaceMesh::with_colors(mesh, &colors_of(mesh))).collect();
            let colors = colors_of(&group.whole);
            let is_first = k == 0;
            ImportPart {
                node: MeshNode {
                    name,
                    element: None,
                    is_surface: false,
                    mesh: group.whole,
                    colors,
                    ignored_primitives: if is_first { node.ignored_primitives } else { 0 },
                },
                element,
                kept,
                dropped_triangles: if is_first { self.dropped_triangles } else { 0 },
            }
        };
        self.groups.into_iter().enumerate().map(part).collect()
    }
}
