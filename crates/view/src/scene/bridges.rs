//! Meshes of all bridge members, with surface coordinates and indirect light per vertex.

use super::super::mesh::{Material, Mesh, Vertex, single};
use super::super::quality::Quality;
use super::bake::{LightBaker, SAMPLE_INSET_M, fill_gaps};
use super::item::{SceneItem, VisibleRange};
use spandrel_model::elements::{Element, ElementGroup, ElementMaterial};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::bridges::Member;
use spandrel_model::scenario::{Bridge, Scenario};
use std::collections::BTreeMap;

/// Paint of the main steelwork, linear (a weathered green, as on many old suspension bridges; estimate).
pub(super) const STEEL_PAINT: [u8; 3] = [38, 68, 56];
/// Paint of railings.
const RAILING_PAINT: [u8; 3] = [58, 76, 74];
/// Bearings: bare, greased steel.
const BEARING_COLOR: [u8; 3] = [38, 34, 30];
/// Elastomeric joint seals.
const SEAL_COLOR: [u8; 3] = [6, 6, 6];
/// Drain pipes: weathered plastic.
const DRAIN_COLOR: [u8; 3] = [44, 44, 42];
/// Galvanized wire.
const WIRE_COLOR: [u8; 3] = [92, 94, 92];
/// Sandstone.
const STONE_COLOR: [u8; 3] = [122, 108, 86];
/// Largest difference of a voussoir's brightness from the mean, as a share.
const VOUSSOIR_CONTRAST: f64 = 0.16;
/// Material of a mesh with its own colors: it has no pattern.
const COLORED: Material = Material::Cloth;
const WHITE: [u8; 3] = [255, 255, 255];
/// Maximum width of a face with constant light across it, m.
const MAX_NARROW_FACE_WIDTH_M: f64 = 0.8;
/// Position across a narrow face, as a share of its width, of the sample that replaces one whose middle is covered, such as the middle
/// of a flange by its web (estimate).
const BESIDE_MIDDLE_SHARE: f64 = 0.2;
/// Tolerance for the sky and sun light fractions in presets that save triangles (a hundredth of the open-air value is
/// invisible; lean presets have noisier rays).
const LIGHT_TOLERANCE: f32 = 0.03;
/// Tolerance for slender members.
const SLENDER_LIGHT_TOLERANCE: f32 = 0.12;

/// Material and paint of an element.
pub(super) fn material_and_paint(element: Element) -> (Material, [u8; 3]) {
    match (element.group(), element.material()) {
        (ElementGroup::Cable, _) => (Material::Cable, WIRE_COLOR),
        (ElementGroup::Bearing, _) => (Material::Steel, BEARING_COLOR),
        (ElementGroup::Joint, _) => (Material::Rubber, SEAL_COLOR),
        (ElementGroup::Unlisted, _) => (Material::Rubber, DRAIN_COLOR),
        (ElementGroup::Railing, ElementMaterial::Steel) => (Material::Steel, RAILING_PAINT),
        (_, ElementMaterial::Steel) => (Material::Steel, STEEL_PAINT),
        (_, ElementMaterial::Masonry) => (Material::Masonry, STONE_COLOR),
        _ => (Material::Concrete, WHITE),
    }
}

/// A bridge's axes, used to compute surface coordinates.
struct TextureAxes {
    origin_m: Vec3<Enu>,
    along: Vec3<Enu>,
    left: Vec3<Enu>,
    half_deck_m: f64,
}

/// Spacing of the probes that test whether a face is covered, and their distance from the edges, m (estimate: smaller
/// gaps are not visible).
const COVER_PROBE_SPACING_M: (f64, f64) = (0.5, 0.02);
/// Minimum number of probe steps, so that the center is always probed.
const MIN_PROBE_STEPS: f64 = 2.0;
/// Minimum vertical component of an upward face's normal; the lake's reflection never shows such faces.
const MIN_UPWARD_COMPONENT: f64 = 0.999;

/// Hangers and railings, which are not visible in the small reflection of a distant bridge.
const SLENDER_ELEMENTS: [Element; 3] = [Element::Hanger, Element::MetalRailing, Element::RcRailing];

/// Returns the light tolerance between the corners of a face, by element and normal; `None` omits the face.
type LightTolerance<'a> = &'a dyn Fn(Element, Vec3<Enu>) -> Option<f32>;
/// Tolerance that keeps every sample.
const KEEP_ALL_SAMPLES: f32 = f32::NEG_INFINITY;

/// Builds all members. Presets that save triangles use simpler meshes for the lake's reflection.
pub fn parts(scenario: &Scenario, bake: &LightBaker, quality: &Quality) -> Vec<SceneItem> {
    if !quality.sparse {
        let [mesh] = meshes(scenario, bake, quality, [&|_, _| Some(KEEP_ALL_SAMPLES)]);
        return vec![SceneItem::here("bridges", mesh, true)];
    }
    let is_slender = |element: Element| SLENDER_ELEMENTS.contains(&element);
    let straight = |element: Element, _| Some(if is_slender(element) { SLENDER_LIGHT_TOLERANCE } else { LIGHT_TOLERANCE });
    // For the lake's reflection, light is sampled only at the corners of faces.
    let in_lake = |element: Element, normal: Vec3<Enu>| {
        (!is_slender(element) && normal.up() < MIN_UPWARD_COMPONENT).then_some(f32::INFINITY)
    };
    let [straight, in_lake] = meshes(scenario, bake, quality, [&straight, &in_lake]);
    let (straight, in_lake) = (SceneItem::here("bridges", straight, true), SceneItem::here("reflected bridges", in_lake, false));
    vec![
        SceneItem { visible_range: VisibleRange::DIRECT_ONLY, ..straight },
        SceneItem { visible_range: VisibleRange::LAKE_ONLY, ..in_lake },
    ]
}

/// Builds one mesh per tolerance; the light is computed only once.
fn meshes<const N: usize>(scenario: &Scenario, bake: &LightBaker, quality: &Quality, thinned: [LightTolerance; N]) -> [Mesh; N] {
    let mut meshes = [(); N].map(|()| Mesh::default());
    for bridge in &scenario.bridges {
        let axes = axes(bridge);
        for member in bridge.members() {
            add(&mut meshes, &member, &axes, bake, (quality, &thinned));
        }
    }
    meshes
}

fn axes(bridge: &Bridge) -> TextureAxes {
    let placement = bridge.placement();
    TextureAxes {
        origin_m: bridge.center_m,
        along: placement.direction([1.0, 0.0, 0.0]),
        left: placement.direction([0.0, 1.0, 0.0]),
        half_deck_m: 0.5 * bridge.deck_width_m(),
    }
}

fn add(
    meshes: &mut [Mesh],
    member: &Member,
    axes: &TextureAxes,
    bake: &LightBaker,
    (quality, thinned): (&Quality, &[LightTolerance]),
) {
    let light_cell_m = quality.light_cell_m;
    let solid = member.solid.coarse(quality.surface_vertices);
    let (material, paint) = material_and_paint(member.element);
    let voussoir = voussoir_tone(member);
    let tint = voussoir.map_or(paint, |tone| paint.map(|c| (f64::from(c) * tone) as u8));
    let colors = solid.surface.as_ref().map(|surface| &surface.colors).filter(|colors| !colors.is_empty());
    let mut samples: BTreeMap<LightCell, [f32; 2]> = BTreeMap::new();
    for face in &solid.faces {
        let corners: Vec<Vec3<Enu>> = face.iter().map(|k| solid.vertices_m[*k as usize]).collect();
        let normal = normal(&corners);
        let off = |thinned: &LightTolerance| thinned(member.element, normal);
        // The parts of a bridge in triangles are whole members, so hardly any of their faces are covered.
        let may_be_covered = solid.is_convex();
        if thinned.iter().all(|thinned| off(thinned).is_none()) || may_be_covered && is_covered(&corners, normal, bake) {
            continue;
        }
        let carries_road = matches!(member.element.group(), ElementGroup::Deck | ElementGroup::ApproachSlab);
        let road = (carries_road || member.element == Element::WearingSurface) && normal.up() > 0.9;
        let look = FaceAppearance {
            element: member.element,
            normal,
            material: match (colors, road) {
                (Some(_), _) => COLORED,
                (None, true) => Material::Deck,
                (None, false) => material,
            },
            tint,
            smooth: material == Material::Cable && face.len() == 4,
            is_voussoir: voussoir.is_some(),
        };
        let wanted = meshes.iter_mut().zip(thinned).filter_map(|(mesh, thinned)| Some((mesh, off(thinned)?)));
        let quad = <[Vec3<Enu>; 4]>::try_from(corners.as_slice()).ok().map(Quad);
        let is_large = |quad: &Quad| quad.lengths_m().0.max(quad.lengths_m().1) > light_cell_m;
        // Quadrilaterals in cells of light have a single color.
        match quad.filter(|quad| solid.is_convex() || colors.is_none() && is_large(quad)) {
            Some(quad) => quad_face(wanted, member, &quad, &look, axes, bake, light_cell_m),
            None => {
                let center_m = middle(&corners);
                let light = if solid.is_convex() {
                    bake.on_member(center_m, normal).unwrap_or([0.0, 0.0])
                } else {
                    let cell = light_cell(center_m, normal, light_cell_m);
                    *samples.entry(cell).or_insert_with(|| bake.near_surface(center_m, normal, light_cell_m))
                };
                let tints: Vec<[u8; 3]> = face.iter().map(|k| colors.map_or(tint, |colors| colors[*k as usize])).collect();
                fan_face(wanted, &corners, &look, axes, (light, &tints));
            }
        }
    }
}

/// A cube of space and a range of directions, whose small triangles share a light sample: a scan has a million triangles.
type LightCell = ([i32; 3], [i32; 3]);

fn light_cell(middle_m: Vec3<Enu>, normal: Vec3<Enu>, size_m: f64) -> LightCell {
    (middle_m.array().map(|value| (value / size_m).floor() as i32), normal.array().map(|value| (2.0 * value).round() as i32))
}

/// Returns the brightness of a voussoir, which differs from that of its neighbors; `None` for all other members. The pieces of a barrel are
/// named `arch-1/00` and so on.
fn voussoir_tone(member: &Member) -> Option<f64> {
    let mut parts = member.name.split('/').skip(1);
    let is_barrel = parts.next().is_some_and(|part| part.starts_with("arch-")) && member.element == Element::MasonryArch;
    let number: f64 = parts.next().filter(|_| is_barrel)?.parse().ok()?;
    Some(1.0 + VOUSSOIR_CONTRAST * (2.0 * (number * 0.618_034).fract() - 1.0))
}

/// A quadrilateral face.
struct Quad([Vec3<Enu>; 4]);

impl Quad {
    /// Returns the point at the given fractions of the first and second sides.
    fn at(&self, s: f64, t: f64) -> Vec3<Enu> {
        let [a, b, c, d] = self.0;
        a.lerp(b, s).lerp(d.lerp(c, s), t)
    }

    /// Returns the longer of the first and third sides, and the longer of the second and fourth sides, in meters.
    fn lengths_m(&self) -> (f64, f64) {
        let [a, b, c, d] = self.0;
        ((b - a).norm().max((c - d).norm()), (d - a).norm().max((c - b).norm()))
    }
}

fn middle(corners: &[Vec3<Enu>]) -> Vec3<Enu> {
    corners.iter().fold(Vec3::zero(), |sum, c| sum + *c) / corners.len() as f64
}

/// Checks whether other members cover the whole face.
fn is_covered(corners: &[Vec3<Enu>], normal: Vec3<Enu>, bake: &LightBaker) -> bool {
    let Ok(quad) = <[Vec3<Enu>; 4]>::try_from(corners).map(Quad) else {
        let middle = middle(corners);
        let near = |corner: &Vec3<Enu>| corner.lerp(middle, (COVER_PROBE_SPACING_M.1 / (*corner - middle).norm()).min(1.0));
        return bake.is_inside(middle, normal) && corners.iter().all(|corner| bake.is_inside(near(corner), normal));
    };
    let shares = |length: f64| {
        let steps = (length / COVER_PROBE_SPACING_M.0).ceil().max(MIN_PROBE_STEPS);
        let edge = (COVER_PROBE_SPACING_M.1 / length).min(0.5);
        (0..=steps as u32).map(move |k| (f64::from(k) / steps).clamp(edge, 1.0 - edge))
    };
    let (along, across) = quad.lengths_m();
    shares(along).all(|s| shares(across).all(|t| bake.is_inside(quad.at(s, t), normal)))
}

struct FaceAppearance {
    element: Element,
    normal: Vec3<Enu>,
    material: Material,
    tint: [u8; 3],
    smooth: bool,
    is_voussoir: bool,
}

fn normal(corners: &[Vec3<Enu>]) -> Vec3<Enu> {
    let count = corners.len();
    (0..count).fold(Vec3::zero(), |sum, k| sum + corners[k].cross(corners[(k + 1) % count])).unit()
}

/// Returns surface coordinates: along and across the bridge on horizontal faces, horizontal and up on walls.
fn uv(p: Vec3<Enu>, normal: Vec3<Enu>, axes: &TextureAxes) -> [f32; 2] {
    let from = p - axes.origin_m;
    if normal.up().abs() > 0.8 {
        return [from.dot(axes.along) as f32, from.dot(axes.left) as f32];
    }
    let level = Vec3::new(0.0, 0.0, 1.0).cross(normal).unit();
    [from.dot(level) as f32, from.dot(normal.cross(level)) as f32]
}

fn corner(p: Vec3<Enu>, look: &FaceAppearance, axes: &TextureAxes, light: [f32; 2]) -> Vertex {
    let [r, g, b] = look.tint;
    Vertex {
        position: single(p),
        normal: single(look.normal),
        uv: uv(p, look.normal, axes),
        light,
        material: look.material as u32 | (u32::from(look.element.number()) << 8),
        tint: [r, g, b, 255],
        aux: if look.material == Material::Deck { axes.half_deck_m as f32 } else { f32::from(u8::from(look.is_voussoir)) },
    }
}

/// The meshes that contain a face, each with its light tolerance.
trait FaceMeshes<'a>: Iterator<Item = (&'a mut Mesh, f32)> {}
impl<'a, T: Iterator<Item = (&'a mut Mesh, f32)>> FaceMeshes<'a> for T {}

fn fan_face<'a>(
    wanted: impl FaceMeshes<'a>,
    corners: &[Vec3<Enu>],
    look: &FaceAppearance,
    axes: &TextureAxes,
    (light, tints): ([f32; 2], &[[u8; 3]]),
) {
    for (mesh, _) in wanted {
        let first = mesh.vertices.len() as u32;
        let tinted = |(c, [r, g, b]): (&Vec3<Enu>, &[u8; 3])| Vertex { tint: [*r, *g, *b, 255], ..corner(*c, look, axes, light) };
        mesh.vertices.extend(corners.iter().zip(tints).map(tinted));
        for k in 2..corners.len() as u32 {
            mesh.indices.extend([first, first + k - 1, first + k]);
        }
    }
}

fn quad_face<'a>(
    wanted: impl FaceMeshes<'a>,
    member: &Member,
    quad: &Quad,
    look: &FaceAppearance,
    axes: &TextureAxes,
    bake: &LightBaker,
    light_cell_m: f64,
) {
    let lengths = quad.lengths_m();
    let steps = |length: f64| ((length / light_cell_m).ceil() as usize).max(1);
    let (nu, nv) = if look.smooth { (1, 1) } else { (steps(lengths.0), steps(lengths.1)) };
    // Samples are inset from the edges; a narrow face needs only one sample across its width.
    let inside = |k: usize, n: usize, length: f64| {
        let margin = (SAMPLE_INSET_M / length).min(0.25);
        if length < MAX_NARROW_FACE_WIDTH_M { 0.5 } else { (k as f64 / n as f64).clamp(margin, 1.0 - margin) }
    };
    let (columns, rows) = (nu + 1, nv + 1);
    let mut samples: Vec<Option<[f32; 2]>> = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let same = if column > 0 && lengths.0 < MAX_NARROW_FACE_WIDTH_M {
                Some(samples.len() - 1)
            } else if row > 0 && lengths.1 < MAX_NARROW_FACE_WIDTH_M {
                Some(samples.len() - columns)
            } else {
                None
            };
            let sample = match same {
                Some(known) => samples[known],
                None => {
                    let (s, t) = (inside(column, nu, lengths.0), inside(row, nv, lengths.1));
                    let beside =
                        |share: f64, length: f64| if length < MAX_NARROW_FACE_WIDTH_M { BESIDE_MIDDLE_SHARE } else { share };
                    let at = |s: f64, t: f64| bake.on_member(quad.at(s, t), look.normal);
                    at(s, t).or_else(|| at(beside(s, lengths.0), beside(t, lengths.1)))
                }
            };
            samples.push(sample);
        }
    }
    let light = fill_gaps(&samples, columns);
    let light_at = |row: usize, column: usize| light[row * columns + column];
    for (mesh, off) in wanted {
        let kept_rows = kept_lines(rows, off, &|row| (0..columns).map(|column| light_at(row, column)).collect());
        let kept_columns = kept_lines(columns, off, &|column| (0..rows).map(|row| light_at(row, column)).collect());
        let first = mesh.vertices.len() as u32;
        for &row in &kept_rows {
            for &column in &kept_columns {
                let p = quad.at(column as f64 / nu as f64, row as f64 / nv as f64);
                let mut vertex = corner(p, look, axes, light_at(row, column));
                if look.smooth {
                    vertex.normal = single(round_bar_normal(member, p, look.normal));
                }
                mesh.vertices.push(vertex);
            }
        }
        let stride = kept_columns.len() as u32;
        for row in 0..kept_rows.len() as u32 - 1 {
            for column in 0..stride - 1 {
                let i = first + row * stride + column;
                let over = i + stride;
                mesh.indices.extend([i, i + 1, over + 1, i, over + 1, over]);
            }
        }
    }
}

/// Returns the indices of the sample lines to keep: the first, the last, and those needed to stay within the tolerance.
fn kept_lines(lines: usize, off: f32, line: &dyn Fn(usize) -> Vec<[f32; 2]>) -> Vec<usize> {
    let all: Vec<Vec<[f32; 2]>> = (0..lines).map(line).collect();
    let smooth = |from: usize, to: usize| {
        (from + 1..to).all(|k| {
            let t = (k - from) as f32 / (to - from) as f32;
            let near = |a: f32, b: f32, c: f32| (a + (b - a) * t - c).abs() <= off;
            let ends = all[from].iter().zip(&all[to]).zip(&all[k]);
            ends.into_iter().all(|((a, b), c)| near(a[0], b[0], c[0]) && near(a[1], b[1], c[1]))
        })
    };
    let mut kept = vec![0];
    for k in 1..lines {
        let from = kept[kept.len() - 1];
        if k + 1 == lines || !smooth(from, k + 1) {
            kept.push(k);
        }
    }
    kept
}

/// Returns the vertex normal of a round bar: the mean of the adjacent sides.
fn round_bar_normal(member: &Member, p: Vec3<Enu>, own: Vec3<Enu>) -> Vec3<Enu> {
    let solid = &member.solid;
    let meets = |face: &&Vec<u32>| face.len() == 4 && face.iter().any(|k| (solid.vertices_m[*k as usize] - p).norm() < 1e-6);
    let sides = solid.faces.iter().filter(meets);
    let sum = sides
        .fold(Vec3::zero(), |sum, face| sum + normal(&face.iter().map(|k| solid.vertices_m[*k as usize]).collect::<Vec<_>>()));
    if sum.norm() > 1e-6 { sum.unit() } else { own }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_only_covered_faces_are_omitted() {
        let text = include_str!("../../../../scenarios/two-bridges.toml");
        let scenario = spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("none".into())).unwrap();
        let site = spandrel_model::site::Site::build(&scenario, 7);
        let bake = LightBaker::new(&site, Vec3::new(0.0, 0.0, 1.0), 1);
        let (mut bearings, mut stringers, mut slabs) = (0, 0, 0);
        for bridge in &scenario.bridges {
            for member in bridge.members() {
                for face in &member.solid.faces {
                    let corners: Vec<Vec3<Enu>> = face.iter().map(|k| member.solid.vertices_m[*k as usize]).collect();
                    let normal = normal(&corners);
                    let covered = is_covered(&corners, normal, &bake);
                    // All sides of bearings are exposed. Stringers are below the slab, so their webs are exposed.
                    let side = normal.up().abs() < 0.1;
                    assert!(!(covered && side && (311..=316).contains(&member.element.number())), "{}", member.name);
                    bearings += u32::from(side && (311..=316).contains(&member.element.number()));
                    let level = corners.iter().map(|c| (*c - corners[0]).norm()).fold(0.0, f64::max);
                    let long = side && level > 2.0 && member.element == Element::SteelStringer;
                    assert!(!(covered && long), "{}", member.name);
                    stringers += u32::from(long);
                    slabs += u32::from(
                        covered
                            && matches!(member.element, Element::SteelGirder | Element::SteelStringer | Element::RcStringer)
                            && normal.up() > 0.9,
                    );
                }
            }
        }
        assert!(bearings >= 40 && stringers >= 100 && slabs > 0, "{bearings} {stringers} {slabs}");
    }

    #[test]
    fn exact_sample_lines_with_linear_light_are_omitted() {
        let of = |values: &[f32]| kept_lines(values.len(), LIGHT_TOLERANCE, &|k| vec![[values[k], 0.0], [0.5, 1.0 - values[k]]]);
        assert_eq!(of(&[0.1, 0.2, 0.3, 0.4, 0.5]), [0, 4]);
        assert_eq!(of(&[0.1, 0.1, 0.1, 0.9, 0.9, 0.9]), [0, 2, 3, 5]);
        assert_eq!(of(&[0.3, 0.31, 0.3]), [0, 2], "differences below the tolerance are ignored");
        assert_eq!(of(&[0.3, 0.4]), [0, 1]);
    }
}
