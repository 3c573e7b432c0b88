//! Imports a bridge from a 3D model: cleans its meshes, makes shapes of them, assigns elements, and writes the files of a job at the
//! bridge. All functions work on bytes and text; the program reads and writes the files.

mod element_suggestions;
mod job_text;
mod painting;
mod part_amounts;
mod part_report;

use crate::elements::Element;
use crate::math;
use crate::mesh::mesh_file::{BufferLoader, MeshFile, MeshNode};
use crate::mesh::part_shapes::{Method, PartShape, ShapeLimits, part_shapes};
use crate::mesh::reader::{self, ModelFormat};
use crate::mesh::topology::components;
use crate::mesh::vectors::{Point, add_scaled, bounds, norm, sub};
use crate::mesh::vertex_colors::ColorsByPlace;
use crate::mesh::voxel_surface::{CloudLimits, CloudReport, cloud_surface};
use crate::mesh::weld::weld;
use crate::scenario::bridges::element_map::{ElementMap, lower_case};
use crate::scenario::bridges::model::{MAX_REACH_M, ModelExtent, ModelPart, from_gltf_axes};
use crate::site::gltf::parts_glb;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

pub use job_text::{ELEMENTS_FILE, MODEL_FILE, SCENARIO_FILE};
use painting::ImportPart;
pub use part_report::{ImportReport, PartReport};

/// Minimum length of the longest side of a bridge, m (estimate: shorter ones have another unit).
const MIN_LENGTH_M: f64 = 2.0;
/// Distance from the origin beyond which a model is moved to it, m (estimate: rounding errors of normals shift planes by less than they are
/// thick).
const FAR_M: f64 = 1000.0;
/// Maximum length of a node's name, characters (20 fewer than the readers' limit, for the numbers of its shapes).
const MAX_NAME_CHARS: usize = 80;

/// Stands for an element that is not known yet.
const UNKNOWN: Element = Element::Unlisted(0);

/// Axis of the model that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpAxis {
    /// y, as glTF requires.
    Y,
    /// z, as in files of programs that ignore this rule.
    Z,
}

/// Point of the model that becomes the origin of the bridge axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModelOrigin {
    /// The middle of the deck's upper surface; of all parts if none is a deck.
    Center,
    /// A point in the model, after scaling, with z up and before the turn, m.
    Point(Point),
}

/// How to import a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportOptions {
    /// Name of the bridge and the job: a-z, 0-9 and hyphens.
    pub name: String,
    /// Factor from the model's units to meters.
    pub scale: f64,
    /// Axis of the model that points up.
    pub up: UpAxis,
    /// Origin of the bridge axes.
    pub origin: ModelOrigin,
    /// Counterclockwise turn about the vertical that makes x run along the deck, degrees.
    pub turn_deg: f64,
    /// Element of the parts that have no other.
    pub default_element: Option<Element>,
    /// Limits of the conversion to shapes.
    pub limits: ShapeLimits,
    /// How a point cloud becomes a surface.
    pub cloud: CloudLimits,
}

/// A file to import.
pub struct ImportSource<'a> {
    /// Name of the file in messages.
    pub file: &'a str,
    /// Format of the file.
    pub format: ModelFormat,
    /// Content of the file.
    pub bytes: &'a [u8],
    /// Loads the buffers of a text glTF file.
    pub load: BufferLoader<'a>,
    /// Elements by the names of parts.
    pub elements: ElementMap,
}

/// The files of an imported bridge, and what was found in the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedBridge {
    /// Parts as binary glTF.
    pub model: Vec<u8>,
    /// Elements of the parts, as TOML.
    pub elements: String,
    /// A job at the bridge, as TOML.
    pub scenario: String,
    /// Parts and problems of the model.
    pub report: ImportReport,
}

/// Why a bridge could not be imported.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ImportError {
    /// The file is invalid: what is wrong, where, and what is allowed.
    Invalid(String),
    /// Parts without an element: their names, and an elements file to start from.
    UnknownElements {
        /// Names of the parts.
        parts: Vec<String>,
        /// Text of an elements file for these parts.
        elements: String,
        /// Problems with single parts of the file, one line per problem.
        notes: Vec<String>,
    },
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(words) => f.write_str(words),
            Self::UnknownElements { parts, .. } => write!(f, "{} parts without an element: {}", parts.len(), parts.join(", ")),
        }
    }
}

impl std::error::Error for ImportError {}

/// Imports a bridge.
///
/// # Errors
/// See [`ImportError`].
pub fn import(source: &ImportSource, options: &ImportOptions) -> Result<ImportedBridge, ImportError> {
    let content = reader::read(source.format, source.file, source.bytes, source.load).map_err(ImportError::Invalid)?;
    let (skipped, notes) = (content.skipped.clone(), content.notes.clone());
    let (mut nodes, cloud) = nodes_in_bridge_axes(source.file, content, options)?;
    unique_names(nodes.iter_mut().map(|node| &mut node.name));
    let known = elements(&nodes, source, options);
    if !source.elements.has_boxes() {
        check_known(nodes.iter().zip(&known).map(|(node, element)| (node.name.as_str(), *element)), &notes)?;
    }
    check_size(source.file, nodes.iter().flat_map(|node| node.mesh.vertices_m.iter().copied()))?;
    let moved = move_near_origin(&mut nodes);
    let fixed = fixed_origin(&nodes, &known, moved, source, options);
    let mut painted = painting::paint(nodes, &known, &source.elements, fixed.unwrap_or_default());
    unique_names(painted.parts.iter_mut().map(|part| &mut part.node.name));
    check_known(painted.parts.iter().map(|part| (part.node.name.as_str(), part.element)), &notes)?;
    check_reach(source.file, &painted.parts, fixed)?;
    let mut names: BTreeSet<String> = painted.parts.iter().map(|part| lower_case(&part.node.name).collect()).collect();
    let mut rows = Vec::new();
    let mut parts = Vec::new();
    for part in painted.parts {
        let (mut report, shapes) = convert(&part, options.limits);
        if shapes.len() > 1 {
            report.name = prefix(&part.node.name, &mut names);
        }
        parts.extend(named(&report.name, report.element, shapes));
        if cloud.is_some() {
            (report.method, report.deviation_m) = (Some(Method::Points), options.cloud.deviation_m());
        }
        rows.push(report);
    }
    if parts.is_empty() {
        return Err(ImportError::Invalid(format!("{}: no part has a volume (allowed: at least one solid)", source.file)));
    }
    let origin = fixed.unwrap_or_else(|| center(ModelExtent::of(&parts).deck));
    parts.iter_mut().for_each(|part| part.shape.move_corners(|corner| sub(corner, origin)));
    let made = parts.len();
    let parts: Vec<ModelPart> =
        parts.into_iter().filter_map(|part| Some(ModelPart { shape: part.shape.sound()?, ..part })).collect();
    let extent = ModelExtent::of(&parts);
    let report = ImportReport {
        parts: rows,
        lost_parts: made - parts.len(),
        skipped,
        notes,
        cloud,
        empty_boxes: painted.empty_boxes,
        origin_m: turn(-options.turn_deg)(add_scaled(origin, moved, 1.0)),
        extent,
    };
    let model = parts_glb(parts.iter());
    let model = model.map_err(|error| ImportError::Invalid(format!("{}: {error}", source.file)))?;
    let elements = report.elements_toml(&parts);
    check_elements(source.file, &elements, &parts)?;
    let scenario = job_text::scenario_toml(&options.name, &parts, &extent, fixed.map(|_| report.origin_m));
    Ok(ImportedBridge { model, elements, scenario, report })
}

/// Checks that the elements file assigns its own element to each part.
fn check_elements(file: &str, elements: &str, parts: &[ModelPart]) -> Result<(), ImportError> {
    let map =
        ElementMap::read(ELEMENTS_FILE, elements).map_err(|problems| ImportError::Invalid(format!("{file}: {problems}")))?;
    let Some(part) = parts.iter().find(|part| map.element_of(&part.name) != Some(part.element)) else { return Ok(()) };
    let (found, own) = (map.element_of(&part.name).map_or(0, Element::number), part.element.number());
    let words = format!("part {}: {ELEMENTS_FILE} assigns element {found} (allowed: {own}; rename the part)", part.name);
    Err(ImportError::Invalid(format!("{file}: {words}")))
}

/// Makes each name unique. Upper and lower case are the same, as in patterns of names.
fn unique_names<'a>(names: impl Iterator<Item = &'a mut String>) {
    let lower = |name: &str| lower_case(name).collect::<String>();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    let mut all: Vec<&mut String> = names.collect();
    for name in &mut all {
        let short: String = name.chars().take(MAX_NAME_CHARS).collect();
        short.trim_end().clone_into(name);
        uses.entry(lower(name)).or_insert(0);
    }
    for name in all {
        let first = name.clone();
        loop {
            let count = uses.entry(lower(&first)).or_insert(0);
            *count += 1;
            if *count == 1 {
                break;
            }
            let candidate = format!("{first}-{count}");
            if let Entry::Vacant(free) = uses.entry(lower(&candidate)) {
                free.insert(1);
                *name = candidate;
                break;
            }
        }
    }
}

/// Returns the name that a node with several shapes gets, so that no other part has a name that begins with it and a slash:
/// `girder-2` if there are nodes `girder` and `girder/01`. `names` are the names of all nodes in lower case.
fn prefix(name: &str, names: &mut BTreeSet<String>) -> String {
    let is_free = |candidate: &str| {
        let numbered: String = lower_case(candidate).chain(['/']).collect();
        names.range(numbered.clone()..).next().is_none_or(|next| !next.starts_with(&numbered))
    };
    if is_free(name) {
        return name.to_owned();
    }
    let mut number = 2_usize;
    loop {
        let candidate = format!("{name}-{number}");
        let lower: String = lower_case(&candidate).collect();
        if !names.contains(&lower) && is_free(&candidate) {
            names.insert(lower);
            return candidate;
        }
        number += 1;
    }
}

/// Returns the element of each node without regard to boxes: by the elements file, by the node's tag, or by default.
fn elements(nodes: &[MeshNode], source: &ImportSource, options: &ImportOptions) -> Vec<Option<Element>> {
    let element = |node: &MeshNode| {
        let tagged = || node.element.map(Element::from_number);
        source.elements.element_of(&node.name).or_else(tagged).or(options.default_element)
    };
    nodes.iter().map(element).collect()
}

/// Checks that each part has an element. `notes` are those on the file.
fn check_known<'a>(parts: impl Iterator<Item = (&'a str, Option<Element>)>, notes: &[String]) -> Result<(), ImportError> {
    let parts: Vec<String> = parts.filter(|(_, element)| element.is_none()).map(|(name, _)| name.to_owned()).collect();
    if parts.is_empty() {
        return Ok(());
    }
    let elements = element_suggestions::elements_toml(&parts);
    Err(ImportError::UnknownElements { parts, elements, notes: notes.to_vec() })
}

/// Returns the nodes of a file in meters, with z up and x along the deck. A point cloud becomes a node that is named `cloud`.
fn nodes_in_bridge_axes(
    file: &str,
    content: MeshFile,
    options: &ImportOptions,
) -> Result<(Vec<MeshNode>, Option<CloudReport>), ImportError> {
    let turned = turn(options.turn_deg);
    let place = |p: Point| {
        let upright = match options.up {
            UpAxis::Y => from_gltf_axes(p),
            UpAxis::Z => p,
        };
        turned(upright.map(|value| value * options.scale))
    };
    let Some(cloud) = content.cloud else {
        let mut nodes = content.nodes;
        nodes.iter_mut().flat_map(|node| &mut node.mesh.vertices_m).for_each(|vertex| *vertex = place(*vertex));
        return Ok((nodes, None));
    };
    let points = cloud.points().map(|(p, color)| (place(p), color));
    check_size(file, points.clone().map(|(p, _)| p))?;
    let surface = cloud_surface(points, cloud.is_colored(), options.cloud);
    let surface = surface.map_err(|words| ImportError::Invalid(format!("{file}: {words}")))?;
    let report = CloudReport { left_out: cloud.left_out, ..surface.report };
    let (name, mesh, colors) = ("cloud".to_owned(), surface.mesh, surface.colors);
    let node = MeshNode { name, element: None, is_surface: true, mesh, colors, ignored_primitives: 0 };
    Ok((vec![node], Some(report)))
}

/// Returns the function that turns a point counterclockwise about the vertical.
fn turn(turn_deg: f64) -> impl Fn(Point) -> Point {
    let (s, c) = math::sin_cos(turn_deg.to_radians());
    // Without a turn, the point keeps its bits.
    let is_turned = turn_deg != 0.0;
    move |[x, y, z]| if is_turned { [c * x - s * y, s * x + c * y, z] } else { [x, y, z] }
}

/// Checks the length of the model along x, y and z.
fn check_size(file: &str, vertices_m: impl Iterator<Item = Point>) -> Result<(), ImportError> {
    let length_m = bounds(vertices_m).map_or(0.0, |(low, high)| (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max));
    if (MIN_LENGTH_M..=MAX_REACH_M).contains(&length_m) {
        return Ok(());
    }
    let words = format!("the model is {length_m:.3} m long (allowed: {MIN_LENGTH_M} to {MAX_REACH_M} m; set --scale)");
    Err(ImportError::Invalid(format!("{file}: {words}")))
}

/// Checks that a job at the bridge fits on the terrain, before the parts are converted, which may take long.
fn check_reach(file: &str, parts: &[ImportPart], fixed: Option<Point>) -> Result<(), ImportError> {
    let lists = parts.iter().flat_map(|part| part.vertices_m().map(|list| (part.element.unwrap_or(UNKNOWN), list)));
    let extent = ModelExtent::around(lists);
    let origin = fixed.unwrap_or_else(|| center(extent.deck));
    let [low, high] = [extent.whole.0, extent.whole.1].map(|corner| sub(corner, origin));
    job_text::check_reach(low, high).map_err(|words| ImportError::Invalid(format!("{file}: {words}")))
}

/// Cleans a part's mesh and converts it to shapes.
fn convert(part: &ImportPart, limits: ShapeLimits) -> (PartReport, Vec<PartShape>) {
    let ImportPart { node, kept, .. } = part;
    let welded = weld(&node.mesh);
    let pieces = components(&welded.mesh);
    let mut report = PartReport::new(part, &welded, &pieces);
    let mut shapes = Vec::new();
    let colors = (!node.colors.is_empty()).then(|| ColorsByPlace::new(&node.mesh.vertices_m, &node.colors));
    for piece in &pieces {
        match part_shapes(piece, limits) {
            Some(mut converted) => {
                report.add(converted.method, converted.deviation_m);
                if let Some(colors) = &colors {
                    converted.parts.iter_mut().for_each(|part| part.set_colors(colors));
                }
                shapes.extend(converted.parts);
            }
            None => report.flat_pieces += 1,
        }
    }
    kept.iter().for_each(|_| report.add(Method::Mesh, 0.0));
    shapes.extend(kept.iter().cloned().map(PartShape::Mesh));
    report.shapes = shapes.len();
    (report, shapes)
}

/// Names the shapes of a node: a single one like the node, several with numbers.
fn named(name: &str, element: Element, shapes: Vec<PartShape>) -> Vec<ModelPart> {
    let count = shapes.len();
    let part = |(k, shape): (usize, PartShape)| {
        let name = if count == 1 { name.to_owned() } else { format!("{name}/{:02}", k + 1) };
        ModelPart { name, element, shape }
    };
    shapes.into_iter().enumerate().map(part).collect()
}

/// Moves the nodes of a model in coordinates of a map by whole meters to the origin, because planes are compared by their distance from it.
/// Returns where the origin is in the model then.
fn move_near_origin(nodes: &mut [MeshNode]) -> Point {
    let around = bounds(nodes.iter().flat_map(|node| node.mesh.vertices_m.iter().copied())).unwrap_or_default();
    let middle = center(around).map(f64::round);
    if norm(middle) <= FAR_M {
        return [0.0; 3];
    }
    nodes.iter_mut().flat_map(|node| &mut node.mesh.vertices_m).for_each(|vertex| *vertex = sub(*vertex, middle));
    middle
}

/// Returns the origin of the bridge axes, a point in the model with z up and x along the deck, m, if it doesn't depend on the parts: the
/// requested point or, with boxes, the middle of the deck's upper surface without regard to them, so that boxes can be measured at a
/// bridge that was imported without them. `moved` is where the origin of the nodes is in the model.
fn fixed_origin(
    nodes: &[MeshNode],
    known: &[Option<Element>],
    moved: Point,
    source: &ImportSource,
    options: &ImportOptions,
) -> Option<Point> {
    match options.origin {
        ModelOrigin::Point(point) => Some(sub(turn(options.turn_deg)(point), moved)),
        ModelOrigin::Center if source.elements.has_boxes() => {
            let lists = nodes.iter().zip(known).map(|(node, element)| (element.unwrap_or(UNKNOWN), &node.mesh.vertices_m[..]));
            Some(center(ModelExtent::around(lists).deck))
        }
        ModelOrigin::Center => None,
    }
}

/// Returns the middle of the upper side of a bounding box.
fn center((low, high): (Point, Point)) -> Point {
    [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), high[2]]
}
