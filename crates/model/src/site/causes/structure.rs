//! Structure of the site as far as causes need it: runs of members, their supports, joints, drains and bearings. It is derived from the
//! members' elements, contacts and shapes, so that it works for every bridge type and for imported bridges.

use super::beam::{ContinuousBeam, Peaks};
use super::frame::{Extent, Frame, overlap_m};
use crate::elements::{Element, ElementGroup, ElementMaterial};
use crate::frames::{Enu, Vec3};
use crate::scenario::Task;
use crate::scenario::bridges::Member;
use crate::site::defect_checks::EDGE_MARGIN_M;
use crate::site::faces::{MemberFace, faces};

/// Maximum gap between members of the same run, m (estimate: joints are wider).
const CONTACT_GAP_M: f64 = 0.02;
/// Maximum gap between a beam's underside and the top of its support, m (estimate).
const SUPPORT_GAP_M: f64 = 0.06;
/// Minimum distance between two supports of a beam, m; nearer ones count as one.
const MIN_SUPPORT_DISTANCE_M: f64 = 1.5;
/// Maximum length of a support as a share of its beam's length. A longer one carries a wall.
const MAX_SUPPORT_SHARE: f64 = 0.35;
/// Maximum distance between a defect and the path from which it is photographed, m (estimate: farther away, few defects fill 10 px).
pub(super) const REACH_M: f64 = 11.0;

/// Members of one element that continue each other, such as the panels of a girder.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub(super) frame: Frame,
    pub(super) extent: Extent,
    /// Spans of a beam on supports; `None` if the run is not a beam.
    pub(super) beam: Option<(ContinuousBeam, Peaks)>,
    members: Vec<usize>,
}

/// A joint or a drain, in its own axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct WaterSource {
    frame: Frame,
    extent: Extent,
}

/// A face of a member within reach of a path.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    /// Index of the member.
    pub(super) member: usize,
    pub(super) face: MemberFace,
}

/// Structure of a site.
pub(super) struct Structure<'a> {
    pub(super) members: &'a [Member],
    pub(super) surfaces: Vec<Surface>,
    pub(super) joints: Vec<WaterSource>,
    pub(super) drains: Vec<WaterSource>,
    pub(super) water_up_m: f64,
    runs: Vec<Run>,
    run_of: Vec<usize>,
}

impl<'a> Structure<'a> {
    /// Derives the structure. Only surfaces within reach of a task's path are listed.
    pub(super) fn new(members: &'a [Member], tasks: &[&Task], water_up_m: f64) -> Self {
        let east = Frame::along(Vec3::new(1.0, 0.0, 0.0));
        let extents: Vec<Extent> = members.iter().map(|member| east.extent(&member.solid)).collect();
        let groups = group(members, &extents);
        let mut run_of = vec![0; members.len()];
        for (number, group) in groups.iter().enumerate() {
            for member in group {
                run_of[*member] = number;
            }
        }
        let mut runs: Vec<Run> = groups.into_iter().map(|group| run(members, group)).collect();
        for run in &mut runs {
            run.beam = beam(members, run, &extents);
        }
        let sources = |is: &dyn Fn(Element) -> bool| {
            let source = |member: &Member| {
                let frame = Frame::along(longest_edge(member));
                WaterSource { frame, extent: frame.extent(&member.solid) }
            };
            members.iter().filter(|member| is(member.element)).map(source).collect()
        };
        Self {
            members,
            surfaces: reachable_surfaces(members, tasks),
            joints: sources(&|element| element.group() == ElementGroup::Joint),
            drains: sources(&|element| element == Element::DECK_DRAIN),
            water_up_m,
            runs,
            run_of,
        }
    }

    /// Returns the run of a member.
    pub(super) fn run(&self, member: usize) -> &Run {
        &self.runs[self.run_of[member]]
    }

    /// Returns the element of a surface.
    pub(super) fn element(&self, surface: &Surface) -> Element {
        self.members[surface.member].element
    }

    /// Returns whether a joint or a drain wets a point: it is above the point and at most `level_m` beside it.
    pub(super) fn is_wet(&self, point_m: Vec3<Enu>, level_m: f64) -> bool {
        self.joints.iter().chain(&self.drains).any(|source| source.is_above(point_m, level_m))
    }
}

impl WaterSource {
    /// Returns whether the source is above a point and at most `level_m` beside it.
    pub(super) fn is_above(&self, point_m: Vec3<Enu>, level_m: f64) -> bool {
        self.extent.up_m.1 >= point_m.up() && self.level_distance_m(point_m) <= level_m
    }

    /// Returns the horizontal distance from a point, m.
    pub(super) fn level_distance_m(&self, point_m: Vec3<Enu>) -> f64 {
        self.extent.level_distance_m(point_m.dot(self.frame.along), point_m.dot(self.frame.across))
    }
}

impl Surface {
    /// Returns whether the face looks down.
    pub(super) fn is_underside(&self) -> bool {
        self.face.normal.up() < -0.8
    }

    /// Returns whether the face is steep.
    pub(super) fn is_side(&self) -> bool {
        self.face.normal.up().abs() < 0.3
    }
}

/// Returns whether an element is of reinforced or prestressed concrete.
pub(super) fn is_concrete(element: Element) -> bool {
    matches!(element.material(), ElementMaterial::ReinforcedConcrete | ElementMaterial::PrestressedConcrete)
}

/// Returns whether an element is of masonry.
pub(super) fn is_masonry(element: Element) -> bool {
    element.material() == ElementMaterial::Masonry
}

/// Returns a member's name up to its first numbered part, such as `bridge/girder-1` for `bridge/girder-1/03/web`.
fn series(member: &Member) -> String {
    let numbered = |part: &str| part.starts_with(|c: char| c.is_ascii_digit());
    member.name.split('/').take_while(|part| !numbered(part)).collect::<Vec<_>>().join("/")
}

/// Returns the members of each run: same series, same element, each in contact with another one.
fn group(members: &[Member], extents: &[Extent]) -> Vec<Vec<usize>> {
    let mut by_series: std::collections::BTreeMap<(String, u16), Vec<usize>> = std::collections::BTreeMap::new();
    for (k, member) in members.iter().enumerate() {
        by_series.entry((series(member), member.element.number())).or_default().push(k);
    }
    by_series.into_values().flat_map(|all| connected(all, extents)).collect()
}

/// Splits members into groups whose members are in contact.
fn connected(mut waiting: Vec<usize>, extents: &[Extent]) -> Vec<Vec<usize>> {
    let mut out = Vec::new();
    while let Some(seed) = waiting.pop() {
        let mut chain = vec![seed];
        let mut next = 0;
        while next < chain.len() {
            let from = extents[chain[next]];
            let (near, apart) = waiting.into_iter().partition(|k: &usize| extents[*k].touches(&from, CONTACT_GAP_M));
            waiting = apart;
            chain.extend::<Vec<usize>>(near);
            next += 1;
        }
        chain.sort_unstable();
        out.push(chain);
    }
    out
}

fn longest_edge(member: &Member) -> Vec3<Enu> {
    let edges = faces(&member.solid).map(|face| face.long_axis() * edge_length(&face));
    edges.fold(Vec3::zero(), |best, edge| if edge.norm() > best.norm() { edge } else { best })
}

fn edge_length(face: &MemberFace) -> f64 {
    let (low, high) = face.extent_m(face.long_axis());
    high - low
}

fn run(members: &[Member], chain: Vec<usize>) -> Run {
    let center = |k: &usize| {
        let vertices = &members[*k].solid.vertices_m;
        vertices.iter().fold(Vec3::zero(), |sum, vertex| sum + *vertex) / vertices.len().max(1) as f64
    };
    let first = center(&chain[0]);
    let farthest =
        chain.iter().map(|k| center(k) - first).fold(Vec3::zero(), |best, d| if d.norm() > best.norm() { d } else { best });
    let own = longest_edge(&members[chain[0]]);
    // A chain runs from its first to its last member; its members may be wider than long.
    let frame = Frame::along(if chain.len() > 2 && farthest.horizontal_norm() > own.norm() { farthest } else { own });
    let parts = chain.iter().map(|k| frame.extent(&members[*k].solid));
    let extent =
        parts.reduce(|a, b| a.with(&b)).unwrap_or(Extent { along_m: (0.0, 0.0), across_m: (0.0, 0.0), up_m: (0.0, 0.0) });
    Run { frame, extent, beam: None, members: chain }
}

/// Returns whether an element acts as a beam on separate supports.
fn is_beam(element: Element) -> bool {
    match element.group() {
        ElementGroup::Superstructure => true,
        ElementGroup::Deck => matches!(element, Element::RcSlab | Element::PscSlab),
        ElementGroup::Substructure => matches!(element, Element::SteelPierCap | Element::PscPierCap | Element::RcPierCap),
        ElementGroup::Cable
        | ElementGroup::Joint
        | ElementGroup::Bearing
        | ElementGroup::ApproachSlab
        | ElementGroup::Railing
        | ElementGroup::Protection
        | ElementGroup::Unlisted => false,
    }
}

fn can_support(element: Element) -> bool {
    matches!(element.group(), ElementGroup::Bearing | ElementGroup::Substructure | ElementGroup::Superstructure)
}

/// Returns the beam of a run: its supports are the short members directly below it.
fn beam(members: &[Member], run: &Run, extents: &[Extent]) -> Option<(ContinuousBeam, Peaks)> {
    if !is_beam(members[run.members[0]].element) {
        return None;
    }
    let own: Vec<Extent> = run.members.iter().map(|k| run.frame.extent(&members[*k].solid)).collect();
    let near = |k: usize| run.members.iter().any(|own| extents[k].touches(&extents[*own], SUPPORT_GAP_M));
    let others = (0..members.len()).filter(|k| can_support(members[*k].element) && near(*k) && !run.members.contains(k));
    let mut supports: Vec<f64> = others.filter_map(|k| support(run, &own, &run.frame.extent(&members[k].solid))).collect();
    supports.sort_by(f64::total_cmp);
    supports.dedup_by(|later, earlier| *later - *earlier < MIN_SUPPORT_DISTANCE_M);
    let beam = ContinuousBeam::new(run.extent.along_m, supports)?;
    let peaks = beam.peaks();
    Some((beam, peaks))
}

/// Returns the position along the run at which a member supports it from below; `None` if it does not.
fn support(run: &Run, own: &[Extent], below: &Extent) -> Option<f64> {
    let above =
        own.iter().filter(|one| overlap_m(one.along_m, below.along_m) > 0.0 && overlap_m(one.across_m, below.across_m) > 0.0);
    let underside_m = above.map(|one| one.up_m.0).fold(f64::INFINITY, f64::min);
    let is_below = (below.up_m.1 - underside_m).abs() <= SUPPORT_GAP_M && below.up_m.0 < underside_m;
    let is_short = below.along_m.1 - below.along_m.0 <= MAX_SUPPORT_SHARE * (run.extent.along_m.1 - run.extent.along_m.0);
    (is_below && is_short).then_some(0.5 * (below.along_m.0 + below.along_m.1))
}

/// Returns the faces that are within reach of a path and look toward it.
fn reachable_surfaces(members: &[Member], tasks: &[&Task]) -> Vec<Surface> {
    let paths: Vec<Vec3<Enu>> = tasks.iter().flat_map(|task| task.path_m.iter().copied()).collect();
    let mut out = Vec::new();
    for (k, member) in members.iter().enumerate() {
        let vertices = &member.solid.vertices_m;
        let Some(first) = vertices.first() else { continue };
        let radius_m = vertices.iter().map(|vertex| (*vertex - *first).norm()).fold(0.0, f64::max);
        let near: Vec<Vec3<Enu>> = paths.iter().filter(|p| (**p - *first).norm() <= REACH_M + radius_m).copied().collect();
        if near.is_empty() {
            continue;
        }
        let faces_path = |face: &MemberFace| near.iter().any(|p| (*p - face.point_m).dot(face.normal) > 0.0);
        // A scan has a million triangles that are too small for a defect.
        let is_large = |face: &MemberFace| member.solid.is_convex() || face.edge_distance_m(face.point_m) > EDGE_MARGIN_M;
        out.extend(
            faces(&member.solid).filter(|face| is_large(face) && faces_path(face)).map(|face| Surface { member: k, face }),
        );
    }
    out
}
