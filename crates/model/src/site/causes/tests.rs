//! Tests of the places of each cause on a simply supported concrete beam, whose mechanics are known in closed form.

use super::place::Place;
use super::reinforcement::{BAR_SPACING_M, FIRST_BAR_M};
use super::structure::Structure;
use super::{bending, edge, reinforcement, shear, water_line};
use crate::defect_codes;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Member;
use crate::scenario::bridges::solid::{MemberBuilder, Placement};
use crate::scenario::{Task, TaskKind};

/// Span and depth of the beam, m.
const SPAN_M: f64 = 24.0;
const DEPTH_M: f64 = 1.6;

/// A beam on two bearings on walls, at an angle to the axes of the site, and a task that passes below and beside it.
fn members() -> Vec<Member> {
    let mut b = MemberBuilder::new("b", Placement::new(Vec3::new(3.0, -4.0, 10.0), 65.0));
    let half = 0.5 * SPAN_M;
    for (k, panel) in [(-half - 0.3, 0.0), (0.0, half + 0.3)].into_iter().enumerate() {
        b.add_box(&format!("beam/{k}"), Element::RcGirder, [panel.0, -0.4, 0.0], [panel.1, 0.4, DEPTH_M]);
    }
    for (k, x) in [-half, half].into_iter().enumerate() {
        b.add_box(&format!("bearing/{k}"), Element::ElastomericBearing, [x - 0.2, -0.3, -0.1], [x + 0.2, 0.3, 0.0]);
        b.add_box(&format!("wall-{k}"), Element::RcPierWall, [x - 0.5, -1.0, -11.0], [x + 0.5, 1.0, -0.1]);
    }
    b.finish()
}

fn task() -> Task {
    let placement = Placement::new(Vec3::new(3.0, -4.0, 10.0), 65.0);
    let at = |k: i32, y: f64, z: f64| placement.point([f64::from(k), y, z]);
    let sides = [(4.0, 0.5), (-4.0, 0.5), (0.0, -4.0), (4.0, -9.0)];
    Task {
        id: 1,
        name: "beam".into(),
        bridge: Some(0),
        kind: TaskKind::Free,
        threshold_m: 2.5,
        closed: false,
        path_m: sides.iter().flat_map(|(y, z)| (-15..=15).map(move |k| at(k, *y, *z))).collect(),
        viewing_directions: Vec::new(),
        inspects_surface: true,
        stand_off: None,
        too_close_m: None,
        dark: false,
    }
}

/// Position along the beam from its middle, as a share of the span.
fn share_of_span(point_m: Vec3<Enu>) -> f64 {
    Placement::new(Vec3::new(3.0, -4.0, 10.0), 65.0).local(point_m)[0] / SPAN_M
}

fn with_structure<T>(with: impl FnOnce(&Structure) -> T) -> T {
    let (members, task) = (members(), task());
    with(&Structure::new(&members, &[&task], 0.0))
}

fn weight_where(places: &[Place], is: impl Fn(&Place) -> bool) -> f64 {
    let sum = |of: &dyn Fn(&Place) -> bool| places.iter().filter(|place| of(place)).map(|place| place.weight).sum::<f64>();
    sum(&is) / sum(&|_| true)
}

#[test]
fn exact_bending_cracks_where_the_moment_exceeds_the_cracking_share() {
    // The moment of a simple beam exceeds 0.6 of its peak where |x| < sqrt(0.4)/2 L = 0.316 L.
    let reach = 0.5 * 0.4_f64.sqrt();
    with_structure(|structure| {
        let places = bending::places(structure);
        assert!(places.len() > 100);
        assert!(places.iter().all(|place| share_of_span(place.point_m).abs() < reach + 0.01));
        let middle_third = weight_where(&places, |place| share_of_span(place.point_m).abs() < 1.0 / 6.0);
        // The integral of the moment over the middle third, as a share of that over the cracked length: (1/3 - 4/3/108) / (2 r - 8/3 r³).
        let expected = (1.0 / 3.0 - 8.0 / 3.0 / 216.0) / (2.0 * reach - 8.0 / 3.0 * reach * reach * reach);
        /// Tolerance for places that are 0.25 m apart.
        const GRID: f64 = 0.02;
        assert!((middle_third - expected).abs() < GRID, "{middle_third}, expected {expected}");
    });
}

#[test]
fn exact_bending_cracks_cross_the_axis_from_the_lower_edge() {
    with_structure(|structure| {
        for place in bending::places(structure) {
            let surface = &structure.surfaces[place.surface];
            assert!(place.along.dot(structure.run(surface.member).frame.along).abs() < 1e-9);
            if surface.is_side() {
                assert!((place.along.up() - 1.0).abs() < 1e-9 && (place.point_m.up() - 10.0).abs() < 1e-6, "{place:?}");
            }
        }
    });
}

#[test]
fn exact_shear_cracks_are_near_the_supports_and_rise_toward_the_middle() {
    with_structure(|structure| {
        let places = shear::places(structure);
        assert!(places.len() > 20);
        for place in &places {
            let share = share_of_span(place.point_m);
            assert!(share.abs() > 0.5 - 2.0 * DEPTH_M / SPAN_M - 0.01, "{share}");
            let to_middle = structure.run(structure.surfaces[place.surface].member).frame.along;
            let axis = if share_of_span(place.point_m + to_middle).abs() < share.abs() { to_middle } else { -to_middle };
            let (rise, run) = (place.along.up(), place.along.dot(axis));
            assert!((rise - run).abs() < 1e-9 && rise > 0.0, "45 degrees, rising toward the middle: {place:?}");
        }
    });
}

#[test]
fn exact_damage_by_reinforcement_is_on_the_grid_of_the_bars() {
    with_structure(|structure| {
        let places = reinforcement::places(structure);
        assert!(places.iter().any(|place| place.kind == defect_codes::REBAR));
        for place in &places {
            let face = &structure.surfaces[place.surface].face;
            let across = face.normal.cross(place.along);
            let (low, high) = face.extent_m(across);
            let at = place.point_m.dot(across);
            let on_grid = |from_edge: f64| {
                let bars = (from_edge - FIRST_BAR_M) / BAR_SPACING_M;
                (bars - bars.round()).abs() < 1e-9
            };
            assert!(on_grid(at - low) || on_grid(high - at), "{place:?}");
            // Displacements run along the bar.
            assert!(place.jitter_m.iter().all(|jitter| jitter.dot(across).abs() < 1e-9));
        }
    });
}

#[test]
fn exact_bearing_spalls_are_at_the_top_of_the_walls_and_abrasion_is_at_the_water() {
    with_structure(|structure| {
        let spalls = edge::places(structure);
        assert!(!spalls.is_empty());
        assert!(spalls.iter().all(|place| (place.point_m.up() - 9.9).abs() < 1e-6));
        let worn = water_line::places(structure);
        assert!(!worn.is_empty());
        assert!(worn.iter().all(|place| (0.1..=1.1).contains(&place.point_m.up())), "the water is at 0 m");
    });
}
