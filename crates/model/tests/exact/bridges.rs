//! Tests of bridge geometry against independent formulas, and of task paths against the geometry.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::arch::Arch;
use spandrel_model::scenario::bridges::beam_bridge::BeamBridge;
use spandrel_model::scenario::bridges::box_girder::BoxGirder;
use spandrel_model::scenario::bridges::cable_stayed::CableStayed;
use spandrel_model::scenario::bridges::girder::Girder;
use spandrel_model::scenario::bridges::masonry_arch::MasonryArch;
use spandrel_model::scenario::bridges::prestressed::Prestressed;
use spandrel_model::scenario::bridges::suspension::Suspension;
use spandrel_model::scenario::bridges::truss::Truss;
use spandrel_model::scenario::bridges::{BridgeField, BridgeShape, Member, Solid, TaskPath};
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};
use spandrel_model::site::convex::Convex;
use std::collections::{BTreeMap, BTreeSet};

/// Tolerance for rounding errors in positions a few hundred meters from the origin, m.
const ROUNDING_TOLERANCE_M: f64 = 1e-9;
/// Relative tolerance for rounding errors in volumes, which are sums of many products.
const VOLUME_TOLERANCE: f64 = 1e-9;

fn bridge(kind: BridgeKind) -> Bridge {
    Bridge { name: "b".into(), center_m: Vec3::new(12.0, -30.0, 40.0), heading_deg: 37.0, kind }
}

fn arch() -> Bridge {
    bridge(BridgeKind::Arch(Arch::default()))
}

fn suspension() -> Bridge {
    bridge(BridgeKind::Suspension(Suspension::default()))
}

fn girder() -> Bridge {
    bridge(BridgeKind::Girder(Girder::default()))
}

fn truss() -> Bridge {
    bridge(BridgeKind::Truss(Truss::default()))
}

fn prestressed() -> Bridge {
    bridge(BridgeKind::Prestressed(Prestressed::default()))
}

fn box_girder() -> Bridge {
    bridge(BridgeKind::BoxGirder(BoxGirder::default()))
}

fn masonry_arch() -> Bridge {
    bridge(BridgeKind::MasonryArch(MasonryArch::default()))
}

fn cable_stayed() -> Bridge {
    bridge(BridgeKind::CableStayed(CableStayed::default()))
}

/// Returns random values near the defaults, within their ranges.
fn random_values(fields: &[BridgeField], random: &mut RandomStream) -> Vec<f64> {
    let near_default = |f: &BridgeField| (f.default * random.range(0.6, 1.7)).clamp(f.min, f.max);
    fields
        .iter()
        .map(near_default)
        .zip(fields)
        .map(|(v, f)| if f.meaning.ends_with("a whole number.") { v.round() } else { v })
        .collect()
}

/// Returns girder bridges with default and random dimensions, half of them with simple spans. Omits inconsistent bridges.
fn random_girders() -> Vec<Bridge> {
    let mut random = RandomStream::new(5, "girders");
    let mut out = vec![girder()];
    for k in 0..120 {
        let values = random_values(Girder::FIELDS, &mut random);
        let kind = Girder { simple_spans: f64::from(k % 2), round_columns: f64::from(k / 2 % 2), ..Girder::from_values(&values) };
        out.push(bridge(BridgeKind::Girder(kind)));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 10, "{}", out.len());
    out
}

/// Standard sections of prestressed girders for random bridges.
const SECTIONS: [f64; 4] = [3.0, 4.0, 6.0, 72.0];

/// Returns prestressed girder bridges with default and random dimensions. Omits inconsistent bridges.
fn random_prestressed() -> Vec<Bridge> {
    let mut random = RandomStream::new(6, "prestressed");
    let mut out = vec![prestressed()];
    for k in 0..120 {
        let values = Prestressed::from_values(&random_values(Prestressed::FIELDS, &mut random));
        let kind = Prestressed { simple_spans: f64::from(k % 2), section: SECTIONS[k as usize / 2 % SECTIONS.len()], ..values };
        out.push(bridge(BridgeKind::Prestressed(kind)));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 10, "{}", out.len());
    out
}

/// Returns truss bridges of one or two spans with default and random dimensions. Omits inconsistent bridges.
fn random_trusses() -> Vec<Bridge> {
    let mut random = RandomStream::new(7, "trusses");
    let mut out = vec![truss()];
    for k in 0..200 {
        let values = Truss::from_values(&random_values(Truss::FIELDS, &mut random));
        let panels = 2.0 * (0.5 * values.panels).round();
        let kind = Truss { spans: f64::from(1 + k % 2), panels, round_columns: f64::from(k / 2 % 2), ..values };
        out.push(bridge(BridgeKind::Truss(kind)));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 8, "{}", out.len());
    out
}

/// Returns box girder bridges with default and random dimensions, half of them of constant depth. Omits inconsistent bridges.
fn random_box_girders() -> Vec<Bridge> {
    let mut random = RandomStream::new(8, "box girders");
    let mut out = vec![box_girder()];
    for k in 0..400 {
        let values = BoxGirder::from_values(&random_values(BoxGirder::FIELDS, &mut random));
        let pier_depth_m = if k % 2 == 0 { values.midspan_depth_m } else { values.pier_depth_m };
        let kind = BoxGirder { spans: f64::from(1 + k % 4), pier_depth_m, round_columns: f64::from(k / 2 % 2), ..values };
        out.push(bridge(BridgeKind::BoxGirder(kind)));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 10, "{}", out.len());
    out
}

/// Returns masonry arch bridges with default and random dimensions. Omits inconsistent bridges.
fn random_masonry_arches() -> Vec<Bridge> {
    let mut random = RandomStream::new(9, "masonry arches");
    let mut out = vec![masonry_arch()];
    for k in 0..200 {
        let values = MasonryArch::from_values(&random_values(MasonryArch::FIELDS, &mut random));
        out.push(bridge(BridgeKind::MasonryArch(MasonryArch { spans: f64::from(1 + k % 4), ..values })));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 10, "{}", out.len());
    out
}

/// Returns cable-stayed bridges with default and random dimensions. Omits inconsistent bridges.
fn random_cable_stayed() -> Vec<Bridge> {
    let mut random = RandomStream::new(10, "cable-stayed bridges");
    let mut out = vec![cable_stayed()];
    for _ in 0..400 {
        let values = random_values(CableStayed::FIELDS, &mut random);
        out.push(bridge(BridgeKind::CableStayed(CableStayed::from_values(&values))));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    assert!(out.len() >= 8, "{}", out.len());
    out
}

/// Returns bridges of all types, with default and random dimensions. Omits inconsistent bridges.
fn random_bridges() -> Vec<Bridge> {
    let mut random = RandomStream::new(4, "bridges");
    let mut out = vec![arch(), suspension()];
    for _ in 0..60 {
        out.push(bridge(BridgeKind::Arch(Arch::from_values(&random_values(Arch::FIELDS, &mut random)))));
        out.push(bridge(BridgeKind::Suspension(Suspension::from_values(&random_values(Suspension::FIELDS, &mut random)))));
    }
    out.retain(|b| b.kind.inconsistencies().is_empty());
    let arches = out.iter().filter(|b| matches!(b.kind, BridgeKind::Arch(_))).count();
    assert!(arches >= 10 && out.len() - arches >= 10, "{arches} of {}", out.len());
    out.extend(random_girders().into_iter().take(12));
    out.extend(random_prestressed().into_iter().take(10));
    out.extend(random_trusses().into_iter().take(8));
    out.extend(random_box_girders().into_iter().take(10));
    out.extend(random_masonry_arches().into_iter().take(12));
    out.extend(random_cable_stayed().into_iter().take(6));
    out
}

fn volume(solid: &Solid) -> f64 {
    let at = |k: u32| solid.vertices_m[k as usize] - solid.vertices_m[0];
    solid.triangles().iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum()
}

fn element_counts(members: &[Member]) -> BTreeMap<u32, usize> {
    members.iter().fold(BTreeMap::new(), |mut counts, m| {
        *counts.entry(u32::from(m.element.number())).or_default() += 1;
        counts
    })
}

fn members_named<'a>(members: &'a [Member], part: &str) -> impl Iterator<Item = &'a Member> {
    let start = format!("b/{part}");
    members.iter().filter(move |m| m.name.starts_with(&start))
}

#[test]
fn prop_all_solids_are_closed_and_convex_with_outward_faces() {
    for bridge in random_bridges() {
        let members = bridge.members();
        let names: BTreeSet<&str> = members.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names.len(), members.len(), "duplicate member names");
        for Member { name, solid, .. } in &members {
            let mut edges = BTreeSet::new();
            for face in &solid.faces {
                for k in 0..face.len() {
                    assert!(edges.insert((face[k], face[(k + 1) % face.len()])), "{name}: an edge occurs twice in one direction");
                }
            }
            assert!(edges.iter().all(|(a, b)| edges.contains(&(*b, *a))), "{name} is not closed");
            assert_eq!(solid.vertices_m.len() + solid.faces.len(), edges.len() / 2 + 2, "{name} violates Euler's formula");
            assert!(volume(solid) > 0.0, "{name}: {} m3", volume(solid));
            for face in &solid.faces {
                let at = |k: usize| solid.vertices_m[face[k] as usize];
                let normal = (at(1) - at(0)).cross(at(2) - at(0)).unit();
                let height = |v: &Vec3<Enu>| normal.dot(*v - at(0));
                assert!(
                    face.iter().all(|k| height(&solid.vertices_m[*k as usize]).abs() < ROUNDING_TOLERANCE_M),
                    "{name}: nonplanar face"
                );
                assert!(solid.vertices_m.iter().all(|v| height(v) < ROUNDING_TOLERANCE_M), "{name}: not convex");
            }
        }
    }
}

/// Returns sample points on the faces and edges of a solid, for contact tests.
fn sample_points(solid: &Solid) -> Vec<Vec3<Enu>> {
    let corner = |k: u32| solid.vertices_m[k as usize];
    let middle = |ks: &[u32]| ks.iter().fold(Vec3::zero(), |sum, k| sum + corner(*k)) / ks.len() as f64;
    let mut out: Vec<Vec3<Enu>> = solid.faces.iter().map(|f| middle(f)).collect();
    for face in &solid.faces {
        for k in 0..face.len() {
            let (a, b) = (corner(face[k]), corner(face[(k + 1) % face.len()]));
            out.extend((0..40).map(|i| a.lerp(b, f64::from(i) / 40.0)));
        }
    }
    out
}

#[test]
fn exact_all_members_are_connected() {
    for bridge in random_bridges() {
        let members = bridge.members();
        let shapes: Vec<Convex> = members.iter().map(|m| Convex::new(&m.solid)).collect();
        let near_boxes = |i: usize, j: usize| {
            let ((low, high), (other_low, other_high)) = (shapes[i].bounds(), shapes[j].bounds());
            (0..3).all(|k| {
                low.array()[k] <= other_high.array()[k] + ROUNDING_TOLERANCE_M
                    && other_low.array()[k] <= high.array()[k] + ROUNDING_TOLERANCE_M
            })
        };
        let touches = |i: usize, j: usize| {
            near_boxes(i, j)
                && (sample_points(&members[i].solid).iter().any(|p| shapes[j].nearest(*p).distance_m < ROUNDING_TOLERANCE_M)
                    || sample_points(&members[j].solid).iter().any(|p| shapes[i].nearest(*p).distance_m < ROUNDING_TOLERANCE_M))
        };
        let mut joined = vec![false; members.len()];
        let mut open = vec![0];
        joined[0] = true;
        while let Some(i) = open.pop() {
            let more: Vec<usize> = (0..members.len()).filter(|j| !joined[*j] && touches(i, *j)).collect();
            more.iter().for_each(|j| joined[*j] = true);
            open.extend(more);
        }
        let floating: Vec<&str> = members.iter().zip(&joined).filter(|(_, j)| !**j).map(|(m, _)| m.name.as_str()).collect();
        assert_eq!(floating, Vec::<&str>::new(), "{:?}", bridge.kind);
    }
}

#[test]
fn exact_arch_bridge_member_counts_match_the_formulas() {
    for bridge in random_bridges() {
        let BridgeKind::Arch(a) = &bridge.kind else { continue };
        let n = a.panels.round() as usize;
        let lines = a.stringers.round() as usize;
        let clear = |x: f64| {
            a.crown_gap_m - a.floorbeam_depth_m
                + (4.0 * a.rise_m - 2.0 * (a.springing_depth_m - a.crown_depth_m)) * x * x / (a.span_m * a.span_m)
        };
        let points: Vec<f64> = (1..n).map(|k| a.span_m * (k as f64 / n as f64 - 0.5)).collect();
        // A column is slightly longer than the clear height at its center, because the rib slopes under it.
        let (most, least) =
            (points.iter().filter(|x| clear(**x) > 0.25 - 0.6).count(), points.iter().filter(|x| clear(**x) > 0.25).count());
        let members = bridge.members();
        let count = element_counts(&members);
        assert_eq!(count[&12], n + 2);
        assert_eq!(count[&155], n + 1);
        assert_eq!(count[&116], lines * (n + 2));
        assert_eq!(members_named(&members, "rib-").count(), 2 * 2 * n);
        assert_eq!(count[&144], 4 * n + (n - 1) / 2);
        assert!(
            (2 * least..=2 * most)
                .contains(&members_named(&members, "column-left").chain(members_named(&members, "column-right")).count())
        );
        assert_eq!(count[&331], 2 * ((a.deck_length_m() / 2.0).floor() as usize + 1) + 6);
        assert_eq!(count[&215], 4);
    }
    let count = element_counts(&arch().members());
    let columns = members_named(&arch().members(), "column-left").count();
    assert_eq!((columns, count[&144], count[&331]), (13, 62, 130));
}

#[test]
fn exact_suspension_bridge_member_counts_match_the_formulas() {
    for bridge in random_bridges() {
        let BridgeKind::Suspension(s) = &bridge.kind else { continue };
        let main = (s.main_span_m / s.hanger_spacing_m).round() as usize;
        let side = ((s.side_span_m / s.hanger_spacing_m).round() as usize).max(1);
        let beams = main - 1 + 2 * (side - 1);
        let panels = main + 2 * side + 2;
        let count = element_counts(&bridge.members());
        assert_eq!(count[&148], 2 * (main - 1));
        assert_eq!(count[&147], 2 * (main + 2));
        // A steel beam consists of two flanges and a web.
        assert_eq!(count[&152], 3 * beams);
        assert_eq!((count[&12], count[&107], count[&113]), (panels, 3 * 2 * panels, 3 * 2 * panels));
        assert_eq!((count[&207], count[&210], count[&220], count[&311], count[&313]), (12, 2, 6, 10, 2));
        assert_eq!(count[&330], 2 * ((s.deck_length_m() / 2.0).floor() as usize + 1) + 6);
    }
    let count = element_counts(&suspension().members());
    assert_eq!((count[&148], count[&147], count[&152], count[&12], count[&330]), (38, 44, 3 * 29, 34, 254));
}

/// Returns the area of a standard section: 1085 square inches for type VI and 767 for BT-72 are published, the others follow from their
/// dimensions.
fn section_area_m2(section: f64) -> f64 {
    const AREAS_IN2: [(f64, f64); 4] = [(3.0, 559.5), (4.0, 789.0), (6.0, 1085.0), (72.0, 767.0)];
    AREAS_IN2.iter().find(|(known, _)| *known == section).unwrap().1 * 0.0254 * 0.0254
}

fn sum_of_volumes(members: &[Member], part: &str) -> f64 {
    members_named(members, part).map(|m| volume(&m.solid)).sum()
}

fn assert_volume(got: f64, want: f64) {
    assert!((got - want).abs() < VOLUME_TOLERANCE * want, "{got} m3, expected {want} m3");
}

fn require_arch_volumes(a: &Arch, members: &[Member]) {
    assert_volume(sum_of_volumes(members, "slab"), a.deck_length_m() * a.deck_width_m * a.slab_m);
    // The depth is quadratic in u = 2x/L. The trapezoidal rule over N segments yields a mean of u^2 of 1/3 + 2/(3
    // N^2).
    let segments = 2.0 * a.panels.round();
    let mean = 1.0 / 3.0 + 2.0 / (3.0 * segments * segments);
    let area = a.span_m * (a.crown_depth_m + (a.springing_depth_m - a.crown_depth_m) * mean);
    assert_volume(sum_of_volumes(members, "rib-"), 2.0 * a.rib_width_m * area);
}

fn require_suspension_volumes(s: &Suspension, members: &[Member]) {
    assert_volume(sum_of_volumes(members, "slab"), s.deck_length_m() * s.deck_width_m * s.slab_m);
    // The flanges are 400 mm by 40 mm, the webs 16 mm thick.
    let section = 2.0 * 0.4 * 0.04 + (s.girder_depth_m - 2.0 * 0.04) * 0.016;
    assert_volume(sum_of_volumes(members, "girder"), 2.0 * s.deck_length_m() * section);
    let octagon = 2.0 * 2f64.sqrt() * s.cable_radius_m * s.cable_radius_m;
    let hexagon = 1.5 * 3f64.sqrt() * s.hanger_radius_m * s.hanger_radius_m;
    let z = |x: f64| s.cable_clearance_m + 4.0 * s.sag_m * x * x / (s.main_span_m * s.main_span_m);
    let n = (s.main_span_m / s.hanger_spacing_m).round();
    let x = |k: f64| s.main_span_m * (k / n - 0.5);
    let straight =
        |k: f64| ((x(k + 1.0) - x(k)) * (x(k + 1.0) - x(k)) + (z(x(k + 1.0)) - z(x(k))) * (z(x(k + 1.0)) - z(x(k)))).sqrt();
    // The cables of the side spans continue straight for one meter into the anchorages.
    let top = s.cable_clearance_m + s.sag_m;
    let side = (s.side_span_m * s.side_span_m + top * top).sqrt() * (1.0 + 1.0 / s.side_span_m);
    let cable = (0..n as u32).map(|k| straight(f64::from(k))).sum::<f64>() + 2.0 * side;
    assert_volume(sum_of_volumes(members, "cable"), 2.0 * octagon * cable);
    let hangers: f64 = (1..n as u32).map(|k| z(x(f64::from(k))) + s.slab_m).sum();
    assert_volume(sum_of_volumes(members, "hanger"), 2.0 * hexagon * hangers);
}

fn require_girder_volumes(g: &Girder, members: &[Member]) {
    let joints = if g.simple_spans > 0.0 { g.spans - 1.0 } else { 0.0 };
    // The girders and the deck extend 0.4 m beyond the outer bearings.
    let run_m = g.layout().length_m() + 0.8 - joints * g.joint_gap_m;
    let width_m = (g.girders - 1.0) * g.girder_spacing_m + 2.0 * g.overhang_m;
    assert_volume(sum_of_volumes(members, "slab"), run_m * width_m * g.slab_m);
    assert_volume(sum_of_volumes(members, "haunch"), g.girders * run_m * g.flange_width_m * g.haunch_m);
    assert_volume(
        sum_of_volumes(members, "girder"),
        g.girders * run_m * (2.0 * g.flange_width_m * g.flange_m + g.web_depth_m * g.web_m),
    );
    let barrier_m2 = 0.5 * (0.4 + 0.2) * g.barrier_m;
    assert_volume(sum_of_volumes(members, "barrier"), 2.0 * barrier_m2 * (g.deck_length_m() - (2.0 + joints) * g.joint_gap_m));
    // A prism of 16 sides around a circle of the column's diameter.
    let share = if g.round_columns > 0.0 { 2.0 * math::sin(math::TAU / 16.0) } else { 1.0 };
    let columns = (g.spans - 1.0) * g.columns * share * g.column_m * g.column_m * g.column_height_m;
    assert_volume(sum_of_volumes(members, "column").max(1e-9), columns.max(1e-9));
}

fn require_prestressed_volumes(p: &Prestressed, members: &[Member]) {
    let gap_m = if p.simple_spans > 0.0 { p.joint_gap_m } else { 0.3 };
    let deck_m = p.layout().length_m() + 0.5 - if p.simple_spans > 0.0 { (p.spans - 1.0) * p.joint_gap_m } else { 0.0 };
    let girders_m = p.girders * (p.layout().length_m() + 0.5 - (p.spans - 1.0) * gap_m);
    let width_m = (p.girders - 1.0) * p.girder_spacing_m + 2.0 * p.overhang_m;
    assert_volume(sum_of_volumes(members, "slab"), deck_m * width_m * p.slab_m);
    assert_volume(sum_of_volumes(members, "girder"), girders_m * section_area_m2(p.section));
}

fn require_cable_stayed_volumes(c: &CableStayed, members: &[Member]) {
    // The deck extends 0.8 m beyond the outer bearings.
    let floor_m = c.main_span_m + 2.0 * c.side_span_m + 1.6;
    assert_volume(sum_of_volumes(members, "slab"), floor_m * c.deck_width_m * c.slab_m);
    // The flanges are 500 mm by 50 mm, the webs 20 mm thick.
    let section = 2.0 * 0.5 * 0.05 + (c.girder_depth_m - 0.1) * 0.02;
    assert_volume(sum_of_volumes(members, "girder"), 2.0 * floor_m * section);
    // From the slab's underside to the towers: in the main span, the stays end main span / (2 n + 1) apart.
    let n = c.stays;
    let octagon = 2.0 * 2f64.sqrt() * c.stay_radius_m * c.stay_radius_m;
    let length_m =
        |spacing_m: f64, k: f64| math::hypot(spacing_m * k, c.tower_height_m - (n - k) * c.anchor_spacing_m + c.slab_m);
    let spacings = [c.main_span_m / (2.0 * n + 1.0), c.side_span_m / n];
    let stays_m: f64 = spacings.iter().flat_map(|spacing| (1..=n as u32).map(move |k| length_m(*spacing, f64::from(k)))).sum();
    let stays: f64 =
        members.iter().filter(|m| m.name.contains("/stay-") && !m.name.ends_with("/pipe")).map(|m| volume(&m.solid)).sum();
    assert_volume(stays, 4.0 * octagon * stays_m);
    // The guide pipes are 1.5 m long and half as thick again.
    let pipes: f64 = members.iter().filter(|m| m.name.ends_with("/pipe")).map(|m| volume(&m.solid)).sum();
    assert_volume(pipes, 8.0 * n * 1.5 * 2.25 * octagon);
}

fn require_masonry_arch_volumes(m: &MasonryArch, members: &[Member]) {
    // A voussoir is a trapezoid between two chords of the same angle: (R + t)² - R² times half the sine of the angle.
    let (radius_m, count) = (m.radius_m(), f64::from(m.voussoirs()));
    let half = math::atan2(0.5 * m.clear_span_m, radius_m - m.rise_m);
    let outer_m = radius_m + m.ring_m;
    let voussoir_m2 = 0.5 * (outer_m * outer_m - radius_m * radius_m) * math::sin(2.0 * half / count);
    assert_volume(sum_of_volumes(members, "arch-"), m.spans * count * voussoir_m2 * m.width_m);
    assert_volume(sum_of_volumes(members, "parapet"), 2.0 * m.deck_length_m() * 0.4 * m.parapet_m);
    let shafts: f64 = members.iter().filter(|m| m.name.contains("/shaft")).map(|m| volume(&m.solid)).sum();
    assert_volume(shafts.max(1e-9), ((m.spans - 1.0) * m.pier_m * m.width_m * m.pier_height_m).max(1e-9));
    // A cutwater is a triangular prism, and its cap a pyramid.
    let cutwaters: f64 = members.iter().filter(|m| m.name.ends_with("/cutwater")).map(|m| volume(&m.solid)).sum();
    let plan_m2 = (m.spans - 1.0) * m.pier_m * m.cutwater_m;
    assert_volume(cutwaters.max(1e-9), (plan_m2 * m.pier_height_m).max(1e-9));
    let caps: f64 = members.iter().filter(|m| m.name.ends_with("/cap")).map(|m| volume(&m.solid)).sum();
    assert_volume(caps.max(1e-9), (plan_m2 * 0.6 * m.cutwater_m / 3.0).max(1e-9));
    // Barrels, skewbacks, walls, fill and road fill the bridge between the abutments, except for the openings: segments of
    // polygons of chords.
    let inside_m = m.spans * m.clear_span_m + (m.spans - 1.0) * m.pier_m;
    let height_m = m.cover_m + m.ring_m + m.rise_m;
    let segment_m2 = 0.5 * radius_m * radius_m * (count * math::sin(2.0 * half / count) - math::sin(2.0 * half));
    let back_m = m.ring_m * 0.5 * m.clear_span_m / radius_m;
    let up_m = m.ring_m * (radius_m - m.rise_m) / radius_m;
    let between: f64 = ["spandrel", "fill", "road", "arch-"].iter().map(|part| sum_of_volumes(members, part)).sum();
    let piers: f64 =
        members.iter().filter(|m| m.name.contains("pier-") && m.name.ends_with("/skewback")).map(|m| volume(&m.solid)).sum();
    // The outer barrels lean over the abutments, where walls, fill and road are above the skewbacks.
    let over_m = 2.0 * (m.abutment_m * (height_m - up_m) + 0.5 * back_m * up_m);
    let approach_m2 = 2.0 * m.approach_m * 0.15;
    let expected = (inside_m * height_m - m.spans * segment_m2 + over_m) * m.width_m + approach_m2 * (m.width_m - 2.0 * m.wall_m);
    assert_volume(between + piers, expected);
}

fn require_box_girder_volumes(g: &BoxGirder, members: &[Member]) {
    let layout = g.layout();
    let width_m = g.cells * g.cell_width_m + 2.0 * g.overhang_m;
    assert_volume(sum_of_volumes(members, "slab"), (layout.length_m() + 1.2) * width_m * g.slab_m);
    let supports = layout.support_positions();
    let depth_m = |x: f64| {
        let piers = &supports[1..supports.len() - 1];
        let shares = piers.iter().map(|pier| (1.0 - (x - pier).abs() / g.haunch_length_m).max(0.0));
        let share = shares.fold(0.0, f64::max);
        g.midspan_depth_m + (g.pier_depth_m - g.midspan_depth_m) * share * share
    };
    // The area is linear in the depth, so that the trapezoidal rule is exact for straight segments.
    let area_m2 = |depth_m: f64| {
        let below_m = depth_m - g.slab_m;
        let outer_m = 0.5 * (g.cells * g.cell_width_m + g.web_m) - g.web_slope * (below_m - 0.5 * g.bottom_slab_m);
        let webs_m2 = 2.0 * g.web_m * below_m + (g.cells - 1.0) * g.web_m * (below_m - g.bottom_slab_m);
        webs_m2 + 2.0 * (outer_m - g.web_m) * g.bottom_slab_m
    };
    let panels = layout.beam_panels();
    let box_m3 = panels.iter().map(|(a, b)| 0.5 * (b - a) * (area_m2(depth_m(*a)) + area_m2(depth_m(*b)))).sum();
    let diaphragms_m3 = sum_of_volumes(members, "box/diaphragm");
    assert_volume(sum_of_volumes(members, "box/") - diaphragms_m3, box_m3);
}

fn require_truss_volumes(t: &Truss, members: &[Member]) {
    // The deck extends 0.8 m beyond the bearings of each span.
    let deck_m = t.spans * t.span_m + 1.6 - (t.spans - 1.0) * t.joint_gap_m;
    let truss_m = deck_m - 1.6 * t.spans;
    assert_volume(sum_of_volumes(members, "slab"), deck_m * t.deck_width_m * t.slab_m);
    let flanges_m2 = 2.0 * 0.19 * 0.018 + (t.stringer_depth_m - 2.0 * 0.018) * 0.011;
    assert_volume(sum_of_volumes(members, "stringer"), t.stringers * deck_m * flanges_m2);
    let chords = members.iter().filter(|m| m.name.contains("/bottom-chord/")).map(|m| volume(&m.solid)).sum::<f64>();
    assert_volume(chords, 2.0 * truss_m * t.chord_m * t.chord_m);
    let plates = 2.0 * 2.0 * t.spans * 2.0 * t.panels;
    assert_volume(sum_of_volumes(members, "gusset"), plates * 2.6 * 2.2 * t.chord_m * t.chord_m * t.gusset_m);
}

#[test]
fn exact_volumes_of_slab_ribs_cables_and_hangers_match_the_formulas() {
    for bridge in random_bridges() {
        let members = bridge.members();
        match &bridge.kind {
            BridgeKind::Model(_) => panic!("an imported bridge"),
            BridgeKind::Arch(a) => require_arch_volumes(a, &members),
            BridgeKind::Suspension(s) => require_suspension_volumes(s, &members),
            BridgeKind::Girder(g) => require_girder_volumes(g, &members),
            BridgeKind::Prestressed(p) => require_prestressed_volumes(p, &members),
            BridgeKind::CableStayed(c) => require_cable_stayed_volumes(c, &members),
            BridgeKind::MasonryArch(m) => require_masonry_arch_volumes(m, &members),
            BridgeKind::BoxGirder(g) => require_box_girder_volumes(g, &members),
            BridgeKind::Truss(t) => require_truss_volumes(t, &members),
        }
    }
}

#[test]
fn exact_ribs_follow_the_parabola() {
    let bridge = arch();
    let a = Arch::default();
    let crown = a.slab_m + a.crown_gap_m;
    assert!((a.extrados_z_m(0.0) + crown).abs() < ROUNDING_TOLERANCE_M);
    assert!((a.axis_z_m(0.0) - a.axis_z_m(0.5 * a.span_m) - a.rise_m).abs() < ROUNDING_TOLERANCE_M);
    // Calculated by hand for span 98, rise 26, depths 1.6 and 2.7, slab 0.23, gap 3.4: axis -4.43 - 6.5 at a quarter of the span.
    assert!(
        (a.axis_z_m(24.5) + 10.93).abs() < ROUNDING_TOLERANCE_M && (a.rib_depth_m(24.5) - 1.875).abs() < ROUNDING_TOLERANCE_M
    );
    for member in members_named(&bridge.members(), "rib-") {
        for vertex in &member.solid.vertices_m {
            let [x, y, z] = bridge.placement().local(*vertex);
            let off = (z - a.intrados_z_m(x)).abs().min((z - a.extrados_z_m(x)).abs());
            assert!(off < ROUNDING_TOLERANCE_M && ((y.abs() - 2.9).abs() - 0.75).abs() < ROUNDING_TOLERANCE_M, "{}", member.name);
        }
    }
}

#[test]
fn exact_hangers_end_at_the_parabolic_cable() {
    let bridge = suspension();
    let s = Suspension::default();
    let members = bridge.members();
    let middle = |vertices: &[Vec3<Enu>]| {
        let sum = vertices.iter().fold(Vec3::zero(), |sum, v| sum + *v);
        bridge.placement().local(sum / vertices.len() as f64)
    };
    // With a sag of 14 m over 140 m and 2 m above the deck at midspan, the cable is at 16 m at the towers and 5.5 m at the
    // quarter points.
    for (x, z) in [(0.0, 2.0), (35.0, 5.5), (-70.0, 16.0), (115.0, 0.0)] {
        assert!((s.cable_z_m(x) - z).abs() < ROUNDING_TOLERANCE_M);
    }
    for hanger in members_named(&members, "hanger-left") {
        let (top, foot) = (middle(&hanger.solid.vertices_m[..6]), middle(&hanger.solid.vertices_m[6..]));
        let u = top[0] / 70.0;
        assert!(
            (top[2] - (2.0 + 14.0 * u * u)).abs() < ROUNDING_TOLERANCE_M && (foot[2] + s.slab_m).abs() < ROUNDING_TOLERANCE_M
        );
        assert!(
            (top[0] - foot[0]).abs() < ROUNDING_TOLERANCE_M
                && (top[0] / 7.0 - (top[0] / 7.0).round()).abs() < ROUNDING_TOLERANCE_M
        );
    }
    let ends: Vec<_> = members_named(&members, "cable-left").map(|m| middle(&m.solid.vertices_m[..8])).collect();
    assert!(ends.iter().all(|e| (e[2] - s.cable_z_m(e[0])).abs() < ROUNDING_TOLERANCE_M));
    // Consecutive cable segments share their corners, so the cable has no gaps at its bends.
    let pieces: Vec<_> = members_named(&members, "cable-left").map(|m| &m.solid.vertices_m).collect();
    for pair in pieces.windows(2) {
        assert!(pair[0][..8].iter().zip(&pair[1][8..]).all(|(end, start)| (*end - *start).norm() < ROUNDING_TOLERANCE_M));
    }
}

fn solids(members: &[Member]) -> Vec<Convex> {
    members.iter().map(|m| Convex::new(&m.solid)).collect()
}

fn min_clearance_m(shapes: &[Convex], path: &TaskPath) -> f64 {
    let gap = |p: &Vec3<Enu>| shapes.iter().map(|s| s.nearest(*p).distance_m).fold(f64::INFINITY, f64::min);
    path.path_m.iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// Checks that a path has steps of at most 1 m, turns that a slow aircraft can follow, and unit viewing directions.
fn assert_smooth(path: &TaskPath) {
    // Sine of the angle that 0.8 m spans on an arc with a 4 m radius, plus a margin.
    const MAX_TURN_SINE: f64 = 0.25;
    let n = path.path_m.len();
    assert_eq!(path.viewing_directions.len(), n);
    assert!(path.viewing_directions.iter().all(|l| (l.norm() - 1.0).abs() < 1e-12));
    let last = if path.closed { n } else { n - 1 };
    let step = |k: usize| path.path_m[(k + 1) % n] - path.path_m[k % n];
    for k in 0..last {
        assert!(step(k).norm() <= 1.0 && step(k).norm() > 0.1, "step {k}: {}", step(k).norm());
        if path.closed || k + 1 < last {
            assert!(step(k).unit().cross(step(k + 1).unit()).norm() < MAX_TURN_SINE, "turn at {k}");
        }
    }
}

/// Paths at a constant height that keep the stand-off from all members.
const LEVEL_PATHS: [TaskKind; 7] = [
    TaskKind::SlabSide,
    TaskKind::PierCircle,
    TaskKind::GirderSoffit,
    TaskKind::BearingLine,
    TaskKind::PierCap,
    TaskKind::FloorSystem,
    TaskKind::TrussPanel,
];

#[test]
fn prop_paths_keep_the_stand_off_distance() {
    for bridge in random_bridges() {
        let shapes = solids(&bridge.members());
        for stand_off_m in [4.0, 6.5] {
            for kind in LEVEL_PATHS.into_iter().chain([
                TaskKind::ArchBottom,
                TaskKind::BarrelSoffit,
                TaskKind::ArchRing,
                TaskKind::StayCable,
            ]) {
                let Ok(path) = bridge.task_path(kind, stand_off_m) else { continue };
                assert_smooth(&path);
                let gap = min_clearance_m(&shapes, &path);
                assert!(
                    gap > stand_off_m - ROUNDING_TOLERANCE_M,
                    "{kind:?}: {gap} m, expected {stand_off_m} m, {:?}",
                    bridge.kind
                );
                // Below the arch and below the bays, the path is not directly under the nearest member.
                let is_beside = matches!(kind, TaskKind::ArchBottom | TaskKind::GirderSoffit | TaskKind::FloorSystem);
                // In front of the bearings on a pier, a haunched soffit rises above the path.
                let is_below_haunch = kind == TaskKind::BearingLine && matches!(bridge.kind, BridgeKind::BoxGirder(_));
                assert!(is_beside || is_below_haunch || gap < 1.1 * stand_off_m, "{kind:?}: {gap} m");
            }
        }
    }
}

#[test]
fn exact_pier_path_is_closed_at_a_constant_distance() {
    let bridge = suspension();
    let members = bridge.members();
    let pier = Convex::new(&members_named(&members, "pier-start").next().unwrap().solid);
    let path = bridge.task_path(TaskKind::PierCircle, 4.5).unwrap();
    assert!(path.closed);
    assert_smooth(&path);
    for (p, look) in path.path_m.iter().zip(&path.viewing_directions) {
        let near = pier.nearest(*p);
        assert!((near.distance_m - 4.5).abs() < ROUNDING_TOLERANCE_M);
        assert!((near.normal + *look).norm() < ROUNDING_TOLERANCE_M, "viewing direction is not perpendicular to the pier");
    }
    let around: f64 = (0..path.path_m.len()).map(|k| (path.path_m[(k + 1) % path.path_m.len()] - path.path_m[k]).norm()).sum();
    // Length of the offset curve of a 4 m by 13 m rectangle; the polyline is slightly shorter because it cuts the arcs.
    let exact = 2.0 * (4.0 + 13.0) + std::f64::consts::TAU * 4.5;
    assert!(around < exact && around > 0.999 * exact, "{around} m of {exact} m");
}

#[test]
fn exact_interlayer_path_clears_the_largest_shipped_aircraft() {
    // Half of 1.07 m tip to tip (M30 class) plus a margin of 0.5 m.
    const REQUIRED_CLEARANCE_M: f64 = 0.5 * 1.07 + 0.5;
    let bridge = arch();
    let path = bridge.task_path(TaskKind::Interlayer, 4.0).unwrap();
    assert_smooth(&path);
    let gap = min_clearance_m(&solids(&bridge.members()), &path);
    assert!(gap >= REQUIRED_CLEARANCE_M, "{gap} m");
    // The path is between deck and arch: below the floorbeams, between the ribs and above the crown.
    for p in &path.path_m {
        let [x, y, z] = bridge.placement().local(*p);
        let a = Arch::default();
        assert!(y.abs() < 0.5 * a.rib_spacing_m && z < a.floorbeam_bottom_z_m() && z > a.extrados_z_m(0.0), "{x} {z}");
    }
}

#[test]
fn prop_viewing_directions_point_at_the_bridge() {
    // Minimum fraction of viewing directions that hit the bridge. Under the arch, some directions pass between the
    // beams into the sky. At the corners of the pier, they point at an edge, which rounding can miss. Beside a truss and its deck, there are gaps.
    for (bridge, kind, share) in [
        (arch(), TaskKind::SlabSide, 1.0),
        (arch(), TaskKind::ArchBottom, 0.95),
        (arch(), TaskKind::Interlayer, 0.6),
        (suspension(), TaskKind::PierCircle, 0.9),
        (girder(), TaskKind::SlabSide, 1.0),
        (girder(), TaskKind::GirderSoffit, 1.0),
        (girder(), TaskKind::BearingLine, 1.0),
        (girder(), TaskKind::PierCap, 0.9),
        (prestressed(), TaskKind::SlabSide, 1.0),
        (prestressed(), TaskKind::GirderSoffit, 1.0),
        (prestressed(), TaskKind::BearingLine, 1.0),
        (prestressed(), TaskKind::PierCap, 0.9),
        (box_girder(), TaskKind::SlabSide, 1.0),
        (box_girder(), TaskKind::GirderSoffit, 1.0),
        (box_girder(), TaskKind::BearingLine, 1.0),
        (box_girder(), TaskKind::PierCap, 0.9),
        (masonry_arch(), TaskKind::SlabSide, 1.0),
        (masonry_arch(), TaskKind::BarrelSoffit, 1.0),
        (masonry_arch(), TaskKind::ArchRing, 1.0),
        (masonry_arch(), TaskKind::PierCircle, 0.9),
        (cable_stayed(), TaskKind::SlabSide, 0.95),
        (cable_stayed(), TaskKind::FloorSystem, 0.95),
        (cable_stayed(), TaskKind::PierCircle, 0.9),
        (cable_stayed(), TaskKind::StayCable, 0.95),
        (truss(), TaskKind::TrussPanel, 0.9),
        (truss(), TaskKind::FloorSystem, 0.95),
        (truss(), TaskKind::BearingLine, 1.0),
        (truss(), TaskKind::PierCap, 0.9),
    ] {
        let shapes = solids(&bridge.members());
        let path = bridge.task_path(kind, 4.5).unwrap();
        let hits = path
            .path_m
            .iter()
            .zip(&path.viewing_directions)
            .filter(|(p, l)| shapes.iter().any(|s| s.ray(**p, **l, 40.0).is_some()))
            .count();
        assert!(
            hits as f64 >= share * path.viewing_directions.len() as f64,
            "{kind:?}: {hits} of {}",
            path.viewing_directions.len()
        );
    }
}

#[test]
fn exact_inconsistent_dimensions_are_rejected_with_their_line() {
    let text = spandrel_model::shipped::DRILL_GAP;
    let wide = text.replacen("heading_deg = 90.0\n\n", "heading_deg = 90.0\n[bridges.arch]\nrib_width_m = 5.5\n\n", 1);
    assert_ne!(text, wide);
    let problems = spandrel_model::scenario::read("wide.toml", &wide, &|_| Err(String::new())).unwrap_err();
    let message = problems.to_string();
    assert!(message.contains("rib_width_m = 5.5") && message.contains("at most 4.80"), "{message}");
    assert!(message.starts_with("wide.toml:"), "{message}");
}

/// AASHTO MBEI element numbers (2015 interims), with the names of the members that they apply to.
const MEMBER_NAMES: [(u16, &[&str]); 36] = [
    (12, &["slab", "haunch"]),
    (15, &["slab"]),
    (104, &["box"]),
    (107, &["girder", "stiffener", "cross-frame"]),
    (109, &["girder", "diaphragm"]),
    (113, &["stringer"]),
    (116, &["stringer"]),
    (120, &["truss", "bracing"]),
    (144, &["rib", "strut"]),
    (145, &["arch-", "spandrel"]),
    (147, &["cable", "stay"]),
    (148, &["hanger"]),
    (152, &["floorbeam"]),
    (155, &["floorbeam"]),
    (161, &["pin"]),
    (162, &["gusset"]),
    (205, &["column", "tower"]),
    (207, &["tower"]),
    (210, &["pier"]),
    (213, &["pier"]),
    (215, &["abutment", "skewback", "pedestal"]),
    (217, &["abutment"]),
    (220, &["anchorage", "footing"]),
    (234, &["cap", "pedestal"]),
    (300, &["joint"]),
    (310, &["bearing"]),
    (311, &["bearing"]),
    (313, &["bearing"]),
    (314, &["bearing"]),
    (321, &["approach-slab"]),
    (330, &["post", "rail"]),
    (331, &["post", "rail", "barrier"]),
    (334, &["parapet"]),
    (510, &["road"]),
    // Deck drains and fill have no MBEI element.
    (850, &["drain"]),
    (851, &["fill"]),
];

#[test]
fn exact_every_member_has_the_correct_element() {
    let steel = [107, 113, 120, 147, 148, 152, 161, 162, 207, 310, 311, 313, 314, 330];
    for bridge in random_bridges() {
        for member in bridge.members() {
            let part = member.name.split('/').nth(1).unwrap();
            let names = MEMBER_NAMES.iter().find(|(number, _)| *number == member.element.number()).map(|(_, names)| *names);
            let fits = names.is_some_and(|names| names.iter().any(|n| part.starts_with(n)));
            assert!(fits, "{} is element {}", member.name, member.element.number());
            // The entire arch bridge is concrete, and the masonry one stone. On the suspension bridge, only the deck, piers and anchorages are; on the girder bridge,
            // the girders with their stiffeners and cross-frames and the bearings are steel, on the concrete ones only the bearings. On the
            // truss bridge, everything above the piers except the deck is steel.
            let concrete = match bridge.kind {
                BridgeKind::Arch(_) | BridgeKind::MasonryArch(_) => true,
                BridgeKind::Suspension(_) => ["slab", "pier", "anchorage"].iter().any(|n| part.starts_with(n)),
                BridgeKind::CableStayed(_) => {
                    !["girder", "floorbeam", "stay", "bearing", "post", "rail"].iter().any(|n| part.starts_with(n))
                }
                BridgeKind::Model(_) => panic!("an imported bridge"),
                BridgeKind::Prestressed(_) | BridgeKind::BoxGirder(_) => !part.starts_with("bearing"),
                BridgeKind::Truss(_) => {
                    let of_concrete = ["slab", "approach", "pedestal", "cap", "column", "footing", "abutment", "joint", "drain"];
                    of_concrete.iter().any(|n| part.starts_with(n))
                }
                BridgeKind::Girder(_) => !["girder", "stiffener", "cross-frame", "bearing"].iter().any(|n| part.starts_with(n)),
            };
            assert_eq!(
                concrete,
                !steel.contains(&member.element.number()),
                "{} is element {}",
                member.name,
                member.element.number()
            );
        }
    }
}
