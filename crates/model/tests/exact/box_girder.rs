//! Tests of box girder bridges: their geometry and quantities against values computed by hand, and their task paths against the geometry.

use crate::beams::{ROUNDING_TOLERANCE_M, assert_bearings_are_in_view, extent, is_close, named, seen, shapes};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::bridges::beam_bridge::BeamBridge;
use spandrel_model::scenario::bridges::box_girder::BoxGirder;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

fn bridge(kind: BoxGirder) -> Bridge {
    let kind = BridgeKind::BoxGirder(kind);
    assert_eq!(kind.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind }
}

/// A single span with one cell and vertical webs, of constant depth: that of ADOT's first LRFD example.
fn single() -> BoxGirder {
    BoxGirder {
        spans: 1.0,
        span_m: 48.77,
        midspan_depth_m: 2.286,
        cells: 1.0,
        cell_width_m: 4.0,
        web_slope: 0.0,
        ..BoxGirder::default()
    }
}

#[test]
fn exact_soffit_follows_the_parabola_of_the_haunches() {
    let bridge = bridge(BoxGirder::default());
    let members = bridge.members();
    // By hand: the piers are 27.43 m from the middle. The depth is 1.83 m, plus 1.37 m at a pier, falling to none at 22 m from it.
    let depth_m = |x: f64| {
        let share = 1.0 - (x.abs() - 27.43).abs() / 22.0;
        1.83 + 1.37 * share.max(0.0) * share.max(0.0)
    };
    let mut deepest = 0.0_f64;
    let segments = members.iter().filter(|member| member.name.ends_with("/bottom"));
    let mut count = 0;
    for segment in segments {
        for vertex in &segment.solid.vertices_m {
            let [x, y, z] = bridge.placement().local(*vertex);
            let below_m = -z - depth_m(x);
            // The slab is 0.18 m thick. Inside the outer webs, 0.305 m thick, which lean inward by a quarter of the depth.
            assert!(is_close(below_m, 0.0) || is_close(below_m, -0.18), "{x} {z}");
            assert!(is_close(y.abs(), 0.5 * (8.46 + 0.305) - 0.25 * (-z - 0.216) - 0.305), "{y} {z}");
            deepest = deepest.max(-z);
        }
        count += 1;
    }
    // Spans of 42.67 and 54.86 m have segments of at most 3.5 m: 13 and 16; one more beyond the bearings of each abutment.
    assert_eq!(count, 13 + 16 + 13 + 2);
    assert!(is_close(deepest, 3.2), "{deepest}");
}

#[test]
fn exact_webs_and_diaphragms_divide_the_box_into_cells() {
    for (kind, inner) in
        [(BoxGirder::default(), 2), (single(), 0), (BoxGirder { cells: 2.0, cell_width_m: 4.0, ..BoxGirder::default() }, 1)]
    {
        let cells = kind.cells as usize;
        let (depth_m, slab_m, bottom_m) = (kind.midspan_depth_m, kind.slab_m, kind.bottom_slab_m);
        let bridge = bridge(kind);
        let members = bridge.members();
        let at = |part: &str| named(&members, &format!("box/00/{part}")).first().map(|member| extent(&bridge, member));
        for side in ["left", "right"] {
            let [_, _, z] = at(&format!("web-{side}")).unwrap();
            assert!(is_close(z.0, -depth_m) && is_close(z.1, -slab_m), "{z:?}");
        }
        for web in 1..=inner {
            let [_, y, z] = at(&format!("web-{web}")).unwrap();
            assert!(is_close(y.1 - y.0, 0.305) && is_close(z.0, bottom_m - depth_m) && is_close(z.1, -slab_m), "{y:?} {z:?}");
        }
        assert!(at(&format!("web-{}", inner + 1)).is_none());
        // One diaphragm in each cell above each support, as long as the ends of the box beyond the bearings: they close it.
        let supports = bridge.kind.shape().footings().len();
        let diaphragms = named(&members, "box/diaphragm-");
        assert_eq!(diaphragms.len(), cells * supports);
        let ends: Vec<f64> = diaphragms.iter().map(|part| extent(&bridge, part)[0].0).collect();
        let first = ends.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(is_close(first, at("web-left").unwrap()[0].0), "{first}");
    }
}

#[test]
fn exact_bearings_carry_the_box_at_both_depths() {
    let kind = BoxGirder::default();
    let bridge = bridge(kind.clone());
    let members = bridge.members();
    for (support, depth_m) in [(0, 1.83), (1, 3.2), (2, 3.2), (3, 1.83)] {
        let bearings = named(&members, &format!("bearing-{support}"));
        assert_eq!(bearings.len(), 2, "{support}");
        for bearing in bearings {
            let [_, y, z] = extent(&bridge, bearing);
            assert!(is_close(z.1, -depth_m) && is_close(z.0, -depth_m - 0.2), "{support}: {z:?}");
            // 0.7 m inside the edges of the soffit at a pier.
            let axis_m = 0.5 * (8.46 + 0.305) - 0.25 * (3.2 - 0.216) - 0.7;
            assert!(is_close((0.5 * (y.0 + y.1)).abs(), axis_m), "{y:?}");
        }
    }
    assert_bearings_are_in_view(&bridge, &kind.layout(), 0..=3);
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // Length 2 x 42.67 + 54.86 = 140.2 m between bearings, 141.4 m of box; the deck is 3 x 2.82 + 2 x 1.9 = 12.26 m wide. The backwalls'
    // backs are 70.1 + 0.6 + 0.08 + 0.5 m from the middle. Bearings 5.873 m apart: caps of 7.073 m, footings of half a cap plus 1.5 + 1.6 m.
    const TOLERANCE: f64 = 1e-9;
    let expected = [
        (15, 141.4 * 12.26),
        (104, 141.4),
        (205, 4.0),
        (215, 2.0 * (12.26 + 12.0)),
        (220, 2.0 * (0.5 * 7.073 + 3.1)),
        (234, 2.0 * 7.073),
        (300, 2.0 * 12.26),
        (314, 8.0),
        (321, 2.0 * 6.0 * 12.26),
        (331, 4.0 * 77.28),
    ];
    let quantities = bridge(BoxGirder::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
    // 141.4 m are 463.9 ft.
    assert_eq!(quantities[1].text(), "464 ft (141.4 m)");
}

#[test]
fn exact_soffit_path_keeps_the_stand_off_along_the_haunches() {
    const STAND_OFF_M: f64 = 4.0;
    let bridge = bridge(BoxGirder::default());
    let shapes = shapes(&bridge);
    for span in 1..=3 {
        let place = PathPlace { span: Some(span), support: None };
        let path = bridge.task_path_at(TaskKind::GirderSoffit, STAND_OFF_M, &place).unwrap();
        let mut heights: Vec<f64> = Vec::new();
        for (k, point) in path.path_m.iter().enumerate() {
            let soffit = shapes.iter().filter(|(name, _)| name.contains("/box/"));
            let gap_m = soffit.map(|(_, shape)| shape.nearest(*point).distance_m).fold(f64::INFINITY, f64::min);
            assert!((gap_m - STAND_OFF_M).abs() < ROUNDING_TOLERANCE_M, "span {span}, point {k}: {gap_m}");
            heights.push(bridge.placement().local(*point)[2]);
            let name = seen(&shapes, &path, k).unwrap();
            assert!(name.starts_with("b/box/"), "{name}");
        }
        let (low, high) =
            (heights.iter().copied().fold(f64::INFINITY, f64::min), heights.iter().copied().fold(f64::MIN, f64::max));
        // At midspan, the soffit is 1.83 m below the road, or a little lower where the haunches meet the level part.
        assert!(is_close(high, -1.83 - STAND_OFF_M) && low < high - 0.5, "{low} {high}");
    }
}

#[test]
fn exact_other_paths_view_the_box_and_the_caps() {
    let bridge = bridge(BoxGirder::default());
    let shapes = shapes(&bridge);
    for (kind, parts) in [(TaskKind::SlabSide, &["b/box/", "b/slab"][..]), (TaskKind::PierCap, &["b/cap-1"])] {
        let path = bridge.task_path(kind, 4.5).unwrap();
        let views: Vec<String> = (0..path.path_m.len()).filter_map(|k| seen(&shapes, &path, k)).collect();
        let wanted = views.iter().filter(|name| parts.iter().any(|part| name.starts_with(part))).count();
        assert!(wanted as f64 > 0.9 * path.path_m.len() as f64, "{kind:?}: {wanted} of {}", path.path_m.len());
    }
    let error = bridge.task_path(TaskKind::FloorSystem, 4.0).unwrap_err();
    assert_eq!(error, "for a box girder bridge: slab_side, girder_soffit, bearing_line, pier_cap");
}

#[test]
fn exact_rules_name_the_keys_that_do_not_fit() {
    let of = |kind: BoxGirder| {
        let list = BridgeKind::BoxGirder(kind).inconsistencies();
        list.into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>()
    };
    let keys = |kind: BoxGirder| of(kind).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
    assert_eq!(keys(single()), [""; 0]);
    // 0.045 of a single span: at most 2.286 m / 0.045 = 50.8 m.
    let long = of(BoxGirder { span_m: 52.0, ..single() });
    assert_eq!(long.len(), 1);
    assert!(long[0].0 == "span_m" && long[0].1.ends_with("at most 50.80") && long[0].1.contains("midspan_depth_m"), "{long:?}");
    assert_eq!(of(BoxGirder { cells: 2.5, ..BoxGirder::default() })[0], ("cells", "a whole number".to_owned()));
    let shallow =
        of(BoxGirder { pier_depth_m: 1.5, span_m: 41.0, end_span_m: 41.0, haunch_length_m: 20.0, ..BoxGirder::default() });
    assert_eq!(shallow, [("pier_depth_m", "no shallower than midspan_depth_m: at least 1.83".to_owned())]);
    // 2 x 1.37 m / 0.3 = 9.13 m.
    let steep = of(BoxGirder { haunch_length_m: 8.0, ..BoxGirder::default() });
    assert!(steep[0].0 == "haunch_length_m" && steep[0].1.ends_with("at least 9.13"), "{steep:?}");
    assert_eq!(keys(BoxGirder { haunch_length_m: 28.0, end_span_m: 42.0, ..BoxGirder::default() }), ["haunch_length_m"]);
    assert_eq!(keys(BoxGirder { slab_m: 0.18, cell_width_m: 4.2, bottom_slab_m: 0.2, ..BoxGirder::default() }), ["slab_m"]);
    assert_eq!(keys(BoxGirder { web_slope: 0.5, ..BoxGirder::default() }), ["web_slope"]);
    assert_eq!(keys(BoxGirder { overhang_m: 3.0, ..BoxGirder::default() }), ["overhang_m"]);
    assert_eq!(keys(BoxGirder { column_m: 2.5, ..BoxGirder::default() })[0], "column_m");
}
