//! Tests of through truss bridges: their geometry and quantities against values computed by hand, and their task paths against the
//! geometry.

use crate::beams::{ROUNDING_TOLERANCE_M, assert_bearings_are_in_view, extent, is_close, named, seen, shapes};
use spandrel_model::elements::Element;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::bridges::beam_bridge::BeamBridge;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::bridges::truss::Truss;
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

/// Height of the lower chords' axes of the default bridge, m: the slab of 0.2 m and the floorbeams of 0.92 m are above them.
const LOWER_Z_M: f64 = -1.12;

fn bridge(kind: Truss) -> Bridge {
    let kind = BridgeKind::Truss(kind);
    assert_eq!(kind.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind }
}

/// Returns the middle of a member along the bridge and in height.
fn middle(bridge: &Bridge, name: &str) -> [f64; 2] {
    let members = bridge.members();
    let found = members.iter().find(|member| member.name == format!("b/{name}")).unwrap_or_else(|| panic!("no {name}"));
    let [x, _, z] = extent(bridge, found);
    [0.5 * (x.0 + x.1), 0.5 * (z.0 + z.1)]
}

#[test]
fn exact_members_join_the_panel_points_of_a_parabolic_top_chord() {
    // One span of 80 m in eight panels of 10 m; chords 9 m apart at the hips and 12 m at midspan. By hand: the first points of the top
    // chord are 30 m from midspan, so 20 m from it the depth is 12 - 3 x 4/9 m, and 10 m from it 12 - 3/9 m.
    let kind = Truss { spans: 1.0, span_m: 80.0, depth_m: 12.0, hip_depth_m: 9.0, ..Truss::default() };
    let bridge = bridge(kind);
    let depths_m = [9.0, 12.0 - 3.0 * 4.0 / 9.0, 12.0 - 3.0 / 9.0, 12.0];
    for (k, (depth_m, x)) in depths_m.into_iter().zip([-30.0, -20.0, -10.0, 0.0]).enumerate() {
        let [post_x, post_z] = middle(&bridge, &format!("truss-1-left/post/{:02}", k + 1));
        assert!(is_close(post_x, x) && is_close(post_z, LOWER_Z_M + 0.5 * depth_m), "{post_x} {post_z}");
    }
    // The diagonals fall toward midspan on both sides, as in a Pratt truss: tension under the weight of the deck.
    for (name, from, to) in [
        ("truss-1-right/diagonal/01", [-30.0, LOWER_Z_M + 9.0], [-20.0, LOWER_Z_M]),
        ("truss-1-right/diagonal/03", [-10.0, LOWER_Z_M + depths_m[2]], [0.0, LOWER_Z_M]),
        ("truss-1-right/diagonal/04", [0.0, LOWER_Z_M], [10.0, LOWER_Z_M + depths_m[2]]),
        ("truss-1-right/diagonal/06", [20.0, LOWER_Z_M], [30.0, LOWER_Z_M + 9.0]),
        ("truss-1-left/end-post/start", [-40.0, LOWER_Z_M], [-30.0, LOWER_Z_M + 9.0]),
        ("truss-1-left/end-post/end", [30.0, LOWER_Z_M + 9.0], [40.0, LOWER_Z_M]),
    ] {
        let [x, z] = middle(&bridge, name);
        assert!(is_close(x, 0.5 * (from[0] + to[0])) && is_close(z, 0.5 * (from[1] + to[1])), "{name}: {x} {z}");
    }
}

#[test]
fn exact_member_counts_match_the_formulas() {
    for kind in [Truss::default(), Truss { panels: 10.0, spans: 1.0, span_m: 70.0, ..Truss::default() }] {
        let (spans, panels) = (kind.spans as usize, kind.panels as usize);
        let members = bridge(kind).members();
        let count = |part: &str| members.iter().filter(|member| member.name.contains(part)).count();
        // A truss with n panels has n pieces of the bottom chord, n - 2 of the top chord, n - 1 posts and n - 2 diagonals.
        assert_eq!(count("/bottom-chord/"), 2 * spans * panels);
        assert_eq!(count("/top-chord/"), 2 * spans * (panels - 2));
        assert_eq!((count("/post/"), count("/diagonal/")), (2 * spans * (panels - 1), 2 * spans * (panels - 2)));
        assert_eq!((count("/end-post/"), count("/pin-")), (4 * spans, 4 * spans));
        // Two plates at each of the 2 n panel points of a truss.
        assert_eq!(count("/gusset-"), 2 * spans * 2 * 2 * panels);
        assert_eq!(count("/floorbeam-"), 3 * spans * (panels + 1));
        // Sway frames at all posts except those at the hips, where the portals are.
        assert_eq!((count("/sway-"), count("/portal-")), (3 * spans * (panels - 3), 6 * spans));
    }
}

#[test]
fn exact_bracing_leaves_the_clearance_of_aashto_above_the_road() {
    for kind in [Truss::default(), Truss { hip_depth_m: 8.1, ..Truss::default() }] {
        let bridge = bridge(kind);
        let members = bridge.members();
        let above = ["/bracing-1/top", "/bracing-1/portal-", "/bracing-1/sway-"];
        let bracing = members.iter().filter(|member| above.iter().any(|part| member.name.contains(part)));
        let lowest = bracing.map(|member| extent(&bridge, member)[2].0).fold(f64::INFINITY, f64::min);
        // AASHTO LRFD 2.3.3.2: 17.5 ft.
        assert!((17.5 * 0.3048 - 0.005..6.0).contains(&lowest), "{lowest}");
    }
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // Two spans of 54.86 m: 111.32 m of deck with a joint of 0.08 m, 7.92 m wide. The trusses end 0.84 m beside the pier's axis.
    // Floorbeams: 8.8 - 0.4 - 2 x 0.0127 m. Abutments: 8.8 + 1.2 m and two wing walls of 6 m. Cap: 8.8 + 1.2 m on two columns.
    const TOLERANCE: f64 = 1e-9;
    let deck_m = 111.32 - 0.08;
    let end_m = 54.86 + 0.8 + 0.08 + 0.5 + 6.0;
    let expected = [
        (12, deck_m * 7.92),
        (113, 5.0 * deck_m),
        (120, 2.0 * (109.72 - 1.68)),
        (152, 2.0 * 9.0 * 8.3746),
        (161, 8.0),
        (162, 4.0 * 16.0),
        (205, 2.0),
        (215, 2.0 * (10.0 + 12.0)),
        (220, 5.0 + 1.8 + 1.6),
        (234, 10.0),
        (300, 3.0 * 7.92),
        (311, 4.0),
        (313, 4.0),
        (321, 2.0 * 6.0 * 7.92),
        (330, 4.0 * end_m),
    ];
    let quantities = bridge(Truss::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
}

#[test]
fn exact_pins_pass_through_the_gusset_plates_above_the_bearings() {
    let bridge = bridge(Truss::default());
    let members = bridge.members();
    let of = |element: Element| {
        let found = members.iter().filter(move |member| member.element == element);
        found.map(|member| extent(&bridge, member)).collect::<Vec<_>>()
    };
    let (pins, plates) = (of(Element::Pin), of(Element::GussetPlate));
    let bearings = [of(Element::FixedBearing), of(Element::MovableBearing)].concat();
    assert_eq!((pins.len(), bearings.len()), (8, 8));
    let center = |[x, y, _]: &[(f64, f64); 3]| (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
    for pin in &pins {
        let (x, y) = center(pin);
        assert!(bearings.iter().any(|bearing| is_close(center(bearing).0, x) && is_close(center(bearing).1, y)), "{x} {y}");
        let inside = |plate: &&[(f64, f64); 3]| {
            let holds = |axis: usize| plate[axis].0 < pin[axis].0 && pin[axis].1 < plate[axis].1;
            holds(0) && holds(2) && pin[1].0 < plate[1].0 && plate[1].1 < pin[1].1
        };
        assert_eq!(plates.iter().filter(inside).count(), 2, "{x} {y}");
    }
}

#[test]
fn exact_truss_path_runs_out_and_back_beside_the_right_truss() {
    let kind = Truss::default();
    let (layout, bridge) = (kind.layout(), bridge(kind));
    let shapes = shapes(&bridge);
    for (span, x_m) in [(1, (-54.86, 0.0)), (2, (0.0, 54.86))] {
        let place = PathPlace { span: Some(span), support: None };
        let path = bridge.task_path_at(TaskKind::TrussPanel, 4.5, &place).unwrap();
        let local: Vec<[f64; 3]> = path.path_m.iter().map(|p| bridge.placement().local(*p)).collect();
        // The pins end 0.08 m beyond the gusset plates on the chords, which are 0.4 m wide, 4.4 m from the middle.
        let y = -(4.4 + 0.2 + 0.0127 + 0.08) - 4.5;
        assert!(local.iter().all(|p| is_close(p[1], y) && p[0] > x_m.0 && p[0] < x_m.1), "{local:?}");
        // A quarter and three quarters of 8.2 m above the lower chord.
        let (first, last) = (local[0], local[local.len() - 1]);
        assert!(is_close(first[2], LOWER_Z_M + 2.05) && is_close(last[2], LOWER_Z_M + 6.15), "{first:?} {last:?}");
        assert!((first[0] - last[0]).abs() < ROUNDING_TOLERANCE_M);
        let trusses = (0..local.len()).filter_map(|k| seen(&shapes, &path, k)).filter(|name| name.contains("-right"));
        assert!(trusses.count() as f64 > 0.9 * local.len() as f64, "the camera points at the truss");
    }
    assert_eq!(layout.piers().len(), 1);
    let too_far = bridge.task_path(TaskKind::TrussPanel, 30.0).unwrap_err();
    assert!(too_far.contains("span"), "{too_far}");
}

#[test]
fn exact_floor_path_views_the_floor_and_the_bearing_line_views_the_bearings() {
    let kind = Truss::default();
    let (layout, bridge) = (kind.layout(), bridge(kind));
    let shapes = shapes(&bridge);
    let path = bridge.task_path(TaskKind::FloorSystem, 4.0).unwrap();
    let floor = ["b/floorbeam", "b/stringer", "b/slab", "b/truss", "b/gusset", "b/bracing"];
    let views = (0..path.path_m.len()).filter_map(|k| seen(&shapes, &path, k));
    let count = views.filter(|name| floor.iter().any(|part| name.starts_with(part))).count();
    // Some views pass through the gap between the deck and a truss.
    assert!(count as f64 > 0.9 * path.path_m.len() as f64, "{count} of {}", path.path_m.len());
    for k in 0..path.path_m.len() {
        assert!(is_close(bridge.placement().local(path.path_m[k])[2], layout.lines.bottom_z_m - 4.0));
    }
    assert_bearings_are_in_view(&bridge, &layout, 0..=2);
}

#[test]
fn exact_drains_are_between_the_floorbeams_and_beside_the_stringers() {
    let bridge = bridge(Truss::default());
    let members = bridge.members();
    let drains = named(&members, "drain-left/");
    assert_eq!(drains.len(), 6);
    let apart = |a: (f64, f64), b: (f64, f64)| a.1 < b.0 || b.1 < a.0;
    for drain in drains {
        let [x, y, _] = extent(&bridge, drain);
        assert!(named(&members, "floorbeam-").iter().all(|beam| apart(extent(&bridge, beam)[0], x)), "{}", drain.name);
        assert!(named(&members, "stringer-").iter().all(|beam| apart(extent(&bridge, beam)[1], y)), "{}", drain.name);
    }
}

#[test]
fn exact_inconsistent_dimensions_name_their_key_and_limit() {
    let of = |kind: Truss| {
        let list = BridgeKind::Truss(kind).inconsistencies();
        list.into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>()
    };
    assert_eq!(of(Truss { panels: 7.0, ..Truss::default() }), [("panels", "an even number".to_owned())]);
    let flat = of(Truss { span_m: 110.0, panels: 14.0, ..Truss::default() });
    assert_eq!(flat, [("depth_m", "span_m / 10 (AASHTO LRFD table 2.5.2.6.3-1): at least 11.00".to_owned())]);
    // 5.33 m + half a strut of 0.25 m + 1.5 m of bracing + 1.12 m of slab and floorbeam.
    let low = of(Truss { hip_depth_m: 7.5, ..Truss::default() });
    let why = "5.33 m below the bracing (bracing_depth_m, floorbeam_depth_m): at least 8.07".to_owned();
    assert_eq!(low, [("hip_depth_m", why)]);
    assert_eq!(of(Truss { deck_width_m: 8.2, ..Truss::default() })[0].0, "deck_width_m");
    assert_eq!(of(Truss { cap_width_m: 2.0, column_m: 1.5, ..Truss::default() })[0].0, "cap_width_m");
}
