//! What the tests of beam bridges share.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::bridges::beam_layout::BeamLayout;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::bridges::{Member, TaskPath};
use spandrel_model::scenario::{Bridge, TaskKind};
use spandrel_model::site::convex::Convex;
use std::ops::RangeInclusive;

/// Tolerance for rounding errors in positions, m.
pub const ROUNDING_TOLERANCE_M: f64 = 1e-9;
/// Length of a foot, m.
pub const FOOT_M: f64 = 0.3048;

/// Returns the lowest and highest corner of a member in bridge axes.
pub fn extent(bridge: &Bridge, member: &Member) -> [(f64, f64); 3] {
    let corners: Vec<[f64; 3]> = member.solid.vertices_m.iter().map(|v| bridge.placement().local(*v)).collect();
    [0, 1, 2].map(|axis| {
        let values = corners.iter().map(|corner| corner[axis]);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
    })
}

/// Returns the members whose names begin with a part's name.
pub fn named<'a>(members: &'a [Member], start: &str) -> Vec<&'a Member> {
    let start = format!("b/{start}");
    members.iter().filter(|member| member.name.starts_with(&start)).collect()
}

/// Returns whether two lengths are the same except for rounding.
pub fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() < ROUNDING_TOLERANCE_M
}

/// Returns the members' names and shapes.
pub fn shapes(bridge: &Bridge) -> Vec<(String, Convex)> {
    bridge.members().iter().map(|member| (member.name.clone(), Convex::new(&member.solid))).collect()
}

/// Returns the name of the first member that a line of sight hits.
pub fn hit(shapes: &[(String, Convex)], from: Vec3<Enu>, view: Vec3<Enu>) -> Option<String> {
    let hits = shapes.iter().filter_map(|(name, shape)| Some((shape.ray(from, view, 60.0)?.0, name)));
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name.clone())
}

/// Returns the name of the first member in view from a point of a path.
pub fn seen(shapes: &[(String, Convex)], path: &TaskPath, k: usize) -> Option<String> {
    hit(shapes, path.path_m[k], path.viewing_directions[k])
}

/// Asserts that the bearing lines of these supports view the bearing of each beam.
pub fn assert_bearings_are_in_view(bridge: &Bridge, layout: &BeamLayout, supports: RangeInclusive<usize>) {
    let shapes = shapes(bridge);
    for support in supports {
        let place = PathPlace { support: Some(support), span: None };
        let path = bridge.task_path_at(TaskKind::BearingLine, 2.5, &place).unwrap();
        let [x, _, z] = bridge.placement().local(path.path_m[0]);
        for (line, y) in layout.numbered_lines() {
            let from = bridge.placement().point([x, y, z]);
            let name = hit(&shapes, from, path.viewing_directions[0]).unwrap();
            assert!(name.starts_with(&format!("b/bearing-{support}")) && name.ends_with(&format!("/{line}")), "{name}");
        }
    }
}
