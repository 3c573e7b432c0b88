//! Tests of masonry arch bridges: their geometry and quantities against values computed by hand, and their task paths against the geometry.

use crate::beams::{ROUNDING_TOLERANCE_M, extent, is_close, named, seen, shapes};
use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::scenario::bridges::masonry_arch::MasonryArch;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

fn bridge(kind: MasonryArch) -> Bridge {
    let kind = BridgeKind::MasonryArch(kind);
    assert_eq!(kind.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind }
}

#[test]
fn exact_keystone_follows_trautwines_rule() {
    // By hand: span 40 ft, rise 10 ft, so that the radius is 25 ft and radius plus half the span 45 ft: 0.25 x 6.7082 + 0.2 = 1.877 ft.
    let arch = MasonryArch { clear_span_m: 40.0 * 0.3048, rise_m: 10.0 * 0.3048, ..MasonryArch::default() };
    assert!(is_close(arch.radius_m(), 25.0 * 0.3048));
    let expected_ft = 0.25 * 45f64.sqrt() + 0.2;
    assert!((expected_ft - 1.877).abs() < 1e-3 && is_close(arch.keystone_m(), expected_ft * 0.3048));
}

#[test]
fn exact_voussoirs_lie_between_two_circles() {
    // By hand: radius (7.62² + 5²) / 10 = 8.30644 m; the crown's intrados is 1.25 m below the road.
    const RADIUS_M: f64 = 8.306_44;
    let arch = MasonryArch::default();
    assert!(is_close(arch.radius_m(), RADIUS_M));
    let bridge = bridge(arch.clone());
    let members = bridge.members();
    for (span, center) in [(1, -18.04), (2, 0.0), (3, 18.04)] {
        let voussoirs = named(&members, &format!("arch-{span}/"));
        assert_eq!(voussoirs.len(), arch.voussoirs() as usize);
        assert_eq!(voussoirs.len() % 2, 1, "there is a keystone");
        for voussoir in voussoirs {
            for vertex in &voussoir.solid.vertices_m {
                let [x, y, z] = bridge.placement().local(*vertex);
                let from_center_m = math::hypot(x - center, z + 1.25 + RADIUS_M);
                let is_on = is_close(from_center_m, RADIUS_M) || is_close(from_center_m, RADIUS_M + 0.65);
                assert!(is_on && is_close(y.abs(), 4.0), "{x} {z}: {from_center_m}");
            }
        }
    }
}

#[test]
fn exact_piers_cutwaters_and_walls_are_in_their_places() {
    let bridge = bridge(MasonryArch::default());
    let members = bridge.members();
    // Springings 0.6 + 0.65 + 5 m below the road, 6 m above the undersides of the piers.
    for (pier, x) in [(1, -9.02), (2, 9.02)] {
        let [along, across, z] = extent(&bridge, named(&members, &format!("pier-{pier}/shaft"))[0]);
        assert!(is_close(along.0, x - 1.4) && is_close(along.1, x + 1.4) && is_close(across.1, 4.0), "{along:?}");
        assert!(is_close(z.0, -12.25) && is_close(z.1, -6.25), "{z:?}");
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            let [along, across, z] = extent(&bridge, named(&members, &format!("pier-{pier}/{side}/cutwater"))[0]);
            let tip = if sign > 0.0 { across.1 } else { across.0 };
            assert!(is_close(tip, sign * 5.6) && is_close(along.1 - along.0, 2.8) && is_close(z.1, -6.25), "{across:?}");
            // The cap rises by 0.6 of the length of the cutwater.
            let [_, _, z] = extent(&bridge, named(&members, &format!("pier-{pier}/{side}/cap"))[0]);
            assert!(is_close(z.0, -6.25) && is_close(z.1, -6.25 + 0.96), "{z:?}");
        }
    }
    for wall in named(&members, "spandrel-left/") {
        let [_, across, z] = extent(&bridge, wall);
        assert!(is_close(across.0, 3.4) && is_close(across.1, 4.0) && is_close(z.1, 0.0), "{across:?}");
    }
    for fill in named(&members, "fill/") {
        let [_, across, z] = extent(&bridge, fill);
        assert!(is_close(across.1, 3.4) && is_close(z.1, -0.15), "{across:?} {z:?}");
    }
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // Three clear spans of 15.24 m and two piers of 2.8 m: 51.32 m between the abutments, 71.32 m of road with abutments of 4 m and wing walls of
    // 6 m, 8 - 0.8 m wide. The piers are 8 + 2 x 1.6 m long across the bridge.
    const TOLERANCE: f64 = 1e-9;
    let expected = [(145, 3.0 * 15.24), (213, 2.0 * 11.2), (217, 2.0 * (8.0 + 12.0)), (334, 2.0 * 71.32), (510, 71.32 * 7.2)];
    let quantities = bridge(MasonryArch::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
    assert_eq!(quantities[0].text(), "150 ft (45.7 m)");
}

#[test]
fn exact_barrel_path_is_at_the_stand_off_from_the_voussoirs() {
    const STAND_OFF_M: f64 = 3.5;
    let bridge = bridge(MasonryArch::default());
    let shapes = shapes(&bridge);
    for span in 1..=3 {
        let place = PathPlace { span: Some(span), support: None };
        let path = bridge.task_path_at(TaskKind::BarrelSoffit, STAND_OFF_M, &place).unwrap();
        for (k, point) in path.path_m.iter().enumerate() {
            let gap_m = shapes.iter().map(|(_, shape)| shape.nearest(*point).distance_m).fold(f64::INFINITY, f64::min);
            // Between the middles of the voussoirs, the intrados is up to 15 mm farther away.
            assert!(gap_m > STAND_OFF_M - ROUNDING_TOLERANCE_M && gap_m < STAND_OFF_M + 0.015, "{gap_m}");
            let name = seen(&shapes, &path, k).unwrap();
            assert!(name.starts_with(&format!("b/arch-{span}/")), "{name}");
        }
    }
    let error =
        bridge.task_path_at(TaskKind::BarrelSoffit, STAND_OFF_M, &PathPlace { span: Some(4), support: None }).unwrap_err();
    assert_eq!(error, "span_number = 1 to 3");
}

#[test]
fn exact_ring_path_faces_the_ring() {
    let bridge = bridge(MasonryArch::default());
    let shapes = shapes(&bridge);
    let path = bridge.task_path(TaskKind::ArchRing, 4.0).unwrap();
    for (k, point) in path.path_m.iter().enumerate() {
        let [x, y, z] = bridge.placement().local(*point);
        // 4 m beside the wall, along the middle of the ring of the middle span.
        assert!(is_close(y, -8.0) && is_close(math::hypot(x, z + 1.25 + 8.306_44), 8.306_44 + 0.325), "{x} {z}");
        let name = seen(&shapes, &path, k).unwrap();
        assert!(name.starts_with("b/arch-2/"), "{name}");
    }
    let height = |k: usize| bridge.placement().local(path.path_m[k])[2];
    assert!(is_close(height(0), height(path.path_m.len() - 1)), "the path is symmetric");
    assert!(height(0) < height(path.path_m.len() / 2) - 2.0, "it follows the ring down");
}

#[test]
fn exact_pier_path_goes_around_the_cutwaters_below_the_barrels() {
    const STAND_OFF_M: f64 = 4.0;
    let bridge = bridge(MasonryArch::default());
    let shapes = shapes(&bridge);
    let path = bridge.task_path(TaskKind::PierCircle, STAND_OFF_M).unwrap();
    assert!(path.closed);
    let mut reach_m = 0.0_f64;
    for (k, point) in path.path_m.iter().enumerate() {
        let pier = shapes.iter().filter(|(name, _)| name.starts_with("b/pier-1/"));
        let gap_m = pier.map(|(_, shape)| shape.nearest(*point).distance_m).fold(f64::INFINITY, f64::min);
        assert!((gap_m - STAND_OFF_M).abs() < ROUNDING_TOLERANCE_M, "{k}: {gap_m}");
        reach_m = reach_m.max(bridge.placement().local(*point)[1]);
    }
    // The tips are 5.6 m from the centerline.
    assert!(is_close(reach_m, 9.6) || (reach_m > 9.5 && reach_m < 9.6), "{reach_m}");
    let single = MasonryArch { spans: 1.0, ..MasonryArch::default() };
    assert_eq!(self::bridge(single).task_path(TaskKind::PierCircle, 4.0).unwrap_err(), "a bridge with piers");
}

#[test]
fn exact_rules_name_the_keys_that_do_not_fit() {
    let of = |kind: MasonryArch| {
        let list = BridgeKind::MasonryArch(kind).inconsistencies();
        list.into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>()
    };
    let keys = |kind: MasonryArch| of(kind).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
    assert_eq!(of(MasonryArch { spans: 2.5, ..MasonryArch::default() }), [("spans", "a whole number".to_owned())]);
    let flat = of(MasonryArch { rise_m: 2.0, ..MasonryArch::default() });
    assert_eq!(flat, [("rise_m", "0.15 clear_span_m (estimate): at least 2.29".to_owned())]);
    let steep = of(MasonryArch { rise_m: 7.5, ..MasonryArch::default() });
    assert!(steep[0].0 == "rise_m" && steep[0].1.ends_with("at most 7.32"), "{steep:?}");
    // The default arch needs 0.61 m by Trautwine's rule.
    let thin = of(MasonryArch { ring_m: 0.6, ..MasonryArch::default() });
    assert!(thin.len() == 1 && thin[0].0 == "ring_m" && thin[0].1.ends_with("at least 0.61"), "{thin:?}");
    assert_eq!(keys(MasonryArch { wall_m: 1.5, width_m: 3.9, ..MasonryArch::default() }), ["wall_m"]);
    assert_eq!(keys(MasonryArch { pier_m: 1.35, cutwater_m: 1.2, ..MasonryArch::default() }), ["pier_m", "pier_m"]);
    assert_eq!(keys(MasonryArch { cutwater_m: 3.0, ..MasonryArch::default() }), ["cutwater_m"]);
    assert_eq!(keys(MasonryArch { ring_m: 1.6, ..MasonryArch::default() }), ["pier_m"]);
}
