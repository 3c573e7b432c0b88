//! What an import found in a model: one row per part.

use super::painting::ImportPart;
use super::part_amounts::{self, PartBox};
use crate::elements::{Element, ElementUnit};
use crate::mesh::part_shapes::Method;
use crate::mesh::topology::{Component, components};
use crate::mesh::vectors::{Point, bounds};
use crate::mesh::voxel_surface::CloudReport;
use crate::mesh::weld::Welded;
use crate::scenario::bridges::element_map::{matches, total_key};
use crate::scenario::bridges::model::{ModelExtent, ModelPart};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A part of the model: a node with a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct PartReport {
    /// Name of the part.
    pub name: String,
    /// Its element.
    pub element: Element,
    /// Number of triangles in the file.
    pub triangles: usize,
    /// Number of degenerate or repeated triangles, which were removed.
    pub dropped_triangles: usize,
    /// Number of points and lines in the file, which were ignored.
    pub ignored_primitives: usize,
    /// Number of connected pieces.
    pub pieces: usize,
    /// Number of pieces without a volume, which were left out.
    pub flat_pieces: usize,
    /// Number of edges with a triangle on one side only.
    pub open_edges: usize,
    /// Number of holes that these edges surround.
    pub holes: usize,
    /// Number of shapes.
    pub shapes: usize,
    /// How the piece with the largest deviation, or else the first one, became shapes; `None` if no piece has a volume.
    pub method: Option<Method>,
    /// Largest distance between the surfaces of the model and of the shapes, m.
    pub deviation_m: f64,
    /// Length along x, y and z, m.
    pub size_m: [f64; 3],
    /// Lowest corner of the bounding box before the move to the origin, m.
    pub low_m: [f64; 3],
}

/// The result of an import.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportReport {
    /// The parts, in file order.
    pub parts: Vec<PartReport>,
    /// Number of shapes that are too small for the precision of the file, and were left out.
    pub lost_parts: usize,
    /// Names of nodes that are no part of a bridge.
    pub skipped: Vec<String>,
    /// Problems with single parts of the file, one line per problem.
    pub notes: Vec<String>,
    /// Counts of a converted point cloud; `None` for meshes.
    pub cloud: Option<CloudReport>,
    /// Boxes of the elements file without a triangle: number of the row, and the box.
    pub empty_boxes: Vec<(usize, String)>,
    /// Origin of the bridge axes in the model after scaling, with z up and before the turn, m.
    pub origin_m: Point,
    /// Bounding boxes in bridge axes.
    pub extent: ModelExtent,
}

impl PartReport {
    pub(super) fn new(part: &ImportPart, welded: &Welded, pieces: &[Component]) -> Self {
        let ImportPart { node, kept, .. } = part;
        let (low, high) = bounds(part.vertices_m().flatten().copied()).unwrap_or_default();
        let kept_triangles: usize = kept.iter().map(|surface| surface.mesh().triangles.len()).sum();
        let open = kept.iter().filter(|surface| !surface.is_closed()).flat_map(|surface| components(surface.mesh()));
        let (open_edges, holes) =
            open.map(|piece| (piece.open_edges, piece.holes)).fold((0, 0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        Self {
            name: node.name.clone(),
            element: part.element.unwrap_or(Element::Unlisted(0)),
            triangles: node.mesh.triangles.len() + kept_triangles + part.dropped_triangles,
            dropped_triangles: welded.dropped_triangles + part.dropped_triangles,
            ignored_primitives: node.ignored_primitives,
            pieces: pieces.len() + kept.len(),
            flat_pieces: 0,
            open_edges: open_edges + pieces.iter().map(|piece| piece.open_edges).sum::<usize>(),
            holes: holes + pieces.iter().map(|piece| piece.holes).sum::<usize>(),
            shapes: 0,
            method: None,
            deviation_m: 0.0,
            size_m: [0, 1, 2].map(|k: usize| high[k] - low[k]),
            low_m: low,
        }
    }

    /// Adds a piece that became shapes.
    pub(super) fn add(&mut self, method: Method, deviation_m: f64) {
        if self.method.is_none() || deviation_m > self.deviation_m {
            (self.method, self.deviation_m) = (Some(method), deviation_m);
        }
    }
}

impl ImportReport {
    /// Returns the text of the elements file: each part's own row if its name is unlike the others, or one row for all parts whose names
    /// differ in numbers only. `shapes` are the shapes of all parts.
    pub(super) fn elements_toml(&self, shapes: &[ModelPart]) -> String {
        let mut patterns = Patterns { shapes, is_right: BTreeMap::new() };
        let boxes = self.parts.iter().map(|part| PartBox { element: part.element, low_m: part.low_m, size_m: part.size_m });
        let amounts = part_amounts::amounts(&boxes.collect::<Vec<_>>());
        let mut groups: BTreeMap<(u16, String), f64> = BTreeMap::new();
        for (part, amount) in self.parts.iter().zip(amounts) {
            let pattern = patterns.pattern(part);
            *groups.entry((part.element.number(), pattern)).or_default() += amount;
        }
        let mut text = String::from(HEADER);
        for ((number, pattern), amount) in groups {
            let element = Element::from_number(number);
            let _ = write!(text, "\n[[elements]]\nparts = {}\nelement = {number} # {}\n", quoted(&pattern), element.name());
            let rounded = (amount * 100.0).round() / 100.0;
            let _ = writeln!(text, "{} = {rounded} # {}", total_key(element), rule(element));
        }
        text
    }
}

/// Finds patterns for the names of shapes.
struct Patterns<'a> {
    shapes: &'a [ModelPart],
    /// Whether all shapes that a pattern matches have the element with this number.
    is_right: BTreeMap<(u16, String), bool>,
}

impl Patterns<'_> {
    /// Returns a pattern that matches a part and, if possible, similar parts; the name itself if a pattern would match other elements.
    fn pattern(&mut self, part: &PartReport) -> String {
        let stem = name_stem(&part.name);
        let similar = format!("{stem}*");
        if !stem.is_empty() && self.is_right(part.element, &similar) {
            return similar;
        }
        // A part with several shapes has numbers after its name. No other part has a name that begins so.
        if part.shapes > 1 { format!("{}/*", part.name) } else { part.name.clone() }
    }

    fn is_right(&mut self, element: Element, pattern: &str) -> bool {
        let shapes = self.shapes;
        let is_own = |part: &ModelPart| part.element == element || !matches(pattern, &part.name);
        *self.is_right.entry((element.number(), pattern.to_owned())).or_insert_with(|| shapes.iter().all(is_own))
    }
}

const HEADER: &str = "\
# Elements of the imported bridge. The first pattern that matches a part's name determines its element (AASHTO MBEI number):
# * stands for any characters, ? for one. The totals are printed by `spandrel check` and do not affect a flight; those below are
# estimates from the sizes of the parts, so correct them.
format = 1
";

/// Returns the part of a name before the first number, as in `girder-` of `girder-12/top`.
pub(super) fn name_stem(name: &str) -> String {
    name.chars().take_while(|c| !c.is_ascii_digit() && !matches!(c, '*' | '?')).collect()
}

/// Returns a TOML string.
pub(super) fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// Returns the rule by which the total quantity of an element is estimated.
fn rule(element: Element) -> &'static str {
    match element.unit() {
        Some(ElementUnit::SquareFeet) => "area in plan; parts above each other count once",
        Some(ElementUnit::Feet) => "length; parts that lie along each other count once",
        Some(ElementUnit::Each) | None => "number of parts",
    }
}
