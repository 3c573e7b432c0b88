//! Tests of girder bridges: their geometry and quantities against values computed by hand and published ones, and their task paths
//! against the geometry.

use crate::beams::{FOOT_M, ROUNDING_TOLERANCE_M, extent, hit, is_close, named, seen, shapes};
use spandrel_model::elements::Element;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::bridges::beam_bridge::BeamBridge;
use spandrel_model::scenario::bridges::girder::Girder;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::bridges::{BridgeShape, Member};
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

fn bridge(girder: Girder) -> Bridge {
    assert_eq!(girder.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind: BridgeKind::Girder(girder) }
}

/// A bridge with a joint above each pier.
fn simple() -> Girder {
    Girder { simple_spans: 1.0, cap_width_m: 2.2, ..Girder::default() }
}

#[test]
fn val_default_bridge_is_the_published_design_example() {
    // FHWA, Steel Bridge Design Handbook, design example 1 (FHWA-IF-12-052, volume 20): spans of 140, 175 and 140 ft; four girders at
    // 12 ft; overhangs of 3 ft 6 in; a deck 43 ft wide and 9.5 in thick; webs of 69 by 0.5 in. The table in scenarios/README.md rounds
    // to centimeters and millimeters.
    const ROUNDING_M: f64 = 0.01;
    let girder = Girder::default();
    for (got_m, published_ft) in girder.layout().span_lengths_m().into_iter().zip([140.0, 175.0, 140.0]) {
        assert!((got_m - published_ft * FOOT_M).abs() < ROUNDING_M, "{got_m}");
    }
    let lines = girder.layout().beam_lines();
    assert!(lines.len() == 4 && (lines[0] - lines[1] - 12.0 * FOOT_M).abs() < ROUNDING_M, "{lines:?}");
    assert!((girder.deck_width_m() - 43.0 * FOOT_M).abs() < 2.0 * ROUNDING_M, "{}", girder.deck_width_m());
    for (got_m, published_in) in [(girder.slab_m, 9.5), (girder.web_depth_m, 69.0), (girder.web_m, 0.5)] {
        assert!((got_m - published_in * FOOT_M / 12.0).abs() < 0.001, "{got_m}");
    }
    // AASHTO LRFD table 2.5.2.6.3-1, continuous composite I-beams: at least 0.032 L overall and 0.027 L for the steel.
    let steel_m = girder.layout().lines.top_z_m - girder.layout().lines.bottom_z_m;
    assert!(steel_m >= 0.027 * girder.span_m && -girder.layout().lines.bottom_z_m >= 0.032 * girder.span_m, "{steel_m}");
}

#[test]
fn exact_girders_are_at_their_spacing_without_gaps_between_plates_and_panels() {
    for girder in [Girder::default(), simple()] {
        let bridge = bridge(girder.clone());
        let members = bridge.members();
        for line in 1..=4 {
            // Girder 1 is on the left. By hand: 4 girders at 3.66 m are at 5.49, 1.83, -1.83 and -5.49 m.
            let y = 5.49 - 3.66 * f64::from(line - 1);
            let plates = named(&members, &format!("girder-{line}/"));
            let extents: Vec<_> = plates.iter().map(|member| extent(&bridge, member)).collect();
            let mut last_x = None;
            for plate in extents.chunks(3) {
                let [top, web, bottom] = plate else { panic!("two flanges and a web") };
                assert!(is_close(top[2].0, web[2].1) && is_close(web[2].0, bottom[2].1), "gap between web and flange");
                assert!(is_close(web[2].1 - web[2].0, girder.web_depth_m) && is_close(web[1].1 - web[1].0, girder.web_m));
                assert!(
                    is_close(bottom[2].0, girder.layout().lines.bottom_z_m)
                        && is_close(top[2].1, -girder.slab_m - girder.haunch_m)
                );
                assert!([top, web, bottom].iter().all(|part| is_close(part[1].0 + part[1].1, 2.0 * y)));
                let same_x = |part: &[(f64, f64); 3]| is_close(part[0].0, web[0].0) && is_close(part[0].1, web[0].1);
                assert!(same_x(top) && same_x(bottom));
                assert!([top, bottom].iter().all(|part| is_close(part[1].1 - part[1].0, girder.flange_width_m)));
                let gap_m = last_x.map_or(0.0, |x: f64| web[0].0 - x);
                let is_joint = girder.simple_spans > 0.0 && is_close(gap_m, girder.joint_gap_m);
                assert!(is_close(gap_m, 0.0) || is_joint, "gap of {gap_m} m between panels");
                last_x = Some(web[0].1);
            }
            let ends = (extents[0][0].0, extents[extents.len() - 1][0].1);
            // Half of 2 x 42.67 + 53.34 m, and 0.4 m beyond the bearings.
            assert!(is_close(ends.0, -69.74) && is_close(ends.1, 69.74), "{ends:?}");
        }
    }
}

#[test]
fn exact_cross_frames_are_at_most_their_spacing_apart_and_at_all_bearings() {
    for girder in [Girder::default(), simple()] {
        let bridge = bridge(girder.clone());
        let members = bridge.members();
        let middle = |member: &&Member| {
            let [(low, high), _, _] = extent(&bridge, member);
            0.5 * (low + high)
        };
        let plates: Vec<f64> = named(&members, "stiffener-2/").iter().filter(|m| m.name.ends_with("left")).map(middle).collect();
        let bearings: Vec<f64> = named(&members, "bearing-").iter().filter(|m| m.name.ends_with("/2")).map(middle).collect();
        assert_eq!(bearings.len(), if girder.simple_spans > 0.0 { 6 } else { 4 });
        assert!(bearings.iter().all(|x| plates.iter().any(|plate| is_close(*x, *plate))), "{bearings:?} {plates:?}");
        assert!(plates.windows(2).all(|pair| pair[1] - pair[0] <= girder.cross_frame_spacing_m + ROUNDING_TOLERANCE_M));
        // Two chords and two diagonals in each of three bays.
        assert_eq!(named(&members, "cross-frame-").len(), 4 * 3 * plates.len());
    }
    // By hand: ceil(42.67 / 7) = 7 and ceil(53.34 / 7) = 8 panels, so 7 + 8 + 7 + 1 cross-sections.
    assert_eq!(named(&bridge(Girder::default()).members(), "cross-frame-1/").len(), 4 * 23);
}

#[test]
fn exact_bearings_fill_the_space_between_girders_and_pedestals() {
    for girder in [Girder::default(), simple()] {
        let bridge = bridge(girder.clone());
        let members = bridge.members();
        let (bearings, pedestals) = (named(&members, "bearing-"), named(&members, "pedestal-"));
        assert_eq!(bearings.len(), pedestals.len());
        for (bearing, pedestal) in bearings.iter().zip(&pedestals) {
            let (upper, lower) = (extent(&bridge, bearing), extent(&bridge, pedestal));
            assert!(is_close(upper[2].1, girder.layout().lines.bottom_z_m) && is_close(upper[2].0, lower[2].1));
            assert!(is_close(lower[2].0, girder.layout().seat_z_m(1)), "{lower:?}");
            assert!(lower[0].0 < upper[0].0 && lower[1].0 < upper[1].0, "the pedestal is wider");
        }
        let fixed = members.iter().filter(|member| member.element == Element::FixedBearing).count();
        // One fixed row per line of girders without a joint: one line, or one per span.
        assert_eq!(fixed, if girder.simple_spans > 0.0 { 12 } else { 4 });
    }
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // Length 138.68 m between bearings, 139.48 m of deck, 13.12 m wide. Abutments: the backwalls' backs are 69.34 + 0.4 + 0.06 + 0.5 m
    // from the middle, the approach slabs are 6 m long. Caps: 10.98 + 1.2 m. Footings: 2/3 of the cap plus 1.1 + 1.6 m.
    const TOLERANCE: f64 = 1e-9;
    let expected = [
        (12, 139.48 * 13.12),
        (107, 4.0 * 139.48),
        (205, 6.0),
        (215, 2.0 * (13.12 + 12.0)),
        (220, 2.0 * (8.12 + 2.7)),
        (234, 2.0 * 12.18),
        (300, 2.0 * 13.12),
        (310, 12.0),
        (313, 4.0),
        (321, 2.0 * 6.0 * 13.12),
        (331, 4.0 * 76.3),
    ];
    let quantities = bridge(Girder::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
    // 4 girders of 457.6 ft: 1830 ft.
    assert_eq!(quantities[1].text(), "1830 ft (557.9 m)");
    assert_eq!(quantities[2].text(), "6 each");
}

#[test]
fn exact_bearings_are_in_view_from_the_bearing_line() {
    for (girder, supports) in
        [(Girder::default(), 0..=3), (simple(), 0..=3), (Girder { girders: 5.0, ..Girder::default() }, 1..=2)]
    {
        let bridge = bridge(girder.clone());
        let shapes = shapes(&bridge);
        for support in supports {
            for stand_off_m in [2.0, 4.0] {
                let place = PathPlace { support: Some(support), span: None };
                let path = bridge.task_path_at(TaskKind::BearingLine, stand_off_m, &place).unwrap();
                let [x, _, z] = bridge.placement().local(path.path_m[0]);
                for (line, y) in girder.layout().beam_lines().into_iter().enumerate() {
                    let from = bridge.placement().point([x, y, z]);
                    let name = hit(&shapes, from, path.viewing_directions[0]).unwrap();
                    let bearing = format!("b/bearing-{support}");
                    assert!(name.starts_with(&bearing) && name.ends_with(&format!("/{}", line + 1)), "{name}");
                }
            }
        }
    }
}

#[test]
fn exact_girder_soffit_path_is_below_both_halves_of_its_span() {
    let girder = Girder::default();
    let bridge = bridge(girder.clone());
    let shapes = shapes(&bridge);
    for (span, (low, high)) in [(None, (-26.67, 26.67)), (Some(1), (-69.34, -26.67)), (Some(3), (26.67, 69.34))] {
        let path = bridge.task_path_at(TaskKind::GirderSoffit, 4.0, &PathPlace { span, support: None }).unwrap();
        let local: Vec<[f64; 3]> = path.path_m.iter().map(|p| bridge.placement().local(*p)).collect();
        assert!(local.iter().all(|p| p[0] > low + 4.0 && p[0] < high - 4.0), "{span:?}");
        assert!(local.iter().all(|p| is_close(p[2], girder.layout().lines.bottom_z_m - 4.0)));
        // A quarter of the 10.98 m between the outer girders, to the left and to the right.
        let (first, last) = (local[0], local[local.len() - 1]);
        assert!(is_close(first[1], 2.745) && is_close(last[1], -2.745) && is_close(first[0], last[0]), "{first:?} {last:?}");
        let steel_or_deck = ["b/girder-", "b/slab", "b/haunch", "b/stiffener", "b/cross-frame"];
        for k in 0..path.path_m.len() {
            let name = seen(&shapes, &path, k).unwrap();
            assert!(steel_or_deck.iter().any(|start| name.starts_with(start)), "{name}");
        }
    }
}

#[test]
fn exact_narrow_bridges_have_one_pass_below_the_bay_beside_the_middle() {
    let girder = Girder { girders: 3.0, girder_spacing_m: 2.5, ..Girder::default() };
    let bridge = bridge(girder.clone());
    let path = bridge.task_path(TaskKind::GirderSoffit, 4.0).unwrap();
    let y: Vec<f64> = path.path_m.iter().map(|p| bridge.placement().local(*p)[1]).collect();
    assert!(y.iter().all(|y| is_close(*y, -1.25)), "{y:?}");
}

#[test]
fn exact_pier_cap_path_surrounds_its_pier_and_views_the_cap() {
    let bridge = bridge(Girder::default());
    let shapes = shapes(&bridge);
    for (support, x) in [(None, -26.67), (Some(2), 26.67)] {
        let path = bridge.task_path_at(TaskKind::PierCap, 4.5, &PathPlace { span: None, support }).unwrap();
        assert!(path.closed);
        let sum = path.path_m.iter().fold(Vec3::zero(), |sum, p| sum + *p);
        let center = bridge.placement().local(sum / path.path_m.len() as f64);
        assert!((center[0] - x).abs() < 0.01 && center[1].abs() < 0.01, "{center:?}");
        let caps = (0..path.path_m.len()).filter(|k| seen(&shapes, &path, *k).is_some_and(|name| name.starts_with("b/cap-")));
        assert!(caps.count() as f64 > 0.95 * path.path_m.len() as f64, "the camera points at the cap");
    }
}

#[test]
fn exact_paths_that_do_not_fit_are_rejected_with_a_reason() {
    let error =
        |girder: Girder, kind, span, support| bridge(girder).task_path_at(kind, 4.0, &PathPlace { span, support }).unwrap_err();
    let supported = "for a girder bridge: slab_side, girder_soffit, bearing_line, pier_cap";
    assert_eq!(error(Girder::default(), TaskKind::PierCircle, None, None), supported);
    assert_eq!(error(Girder::default(), TaskKind::GirderSoffit, Some(4), None), "span_number = 1 to 3");
    assert_eq!(error(Girder::default(), TaskKind::BearingLine, None, Some(4)), "support_number = 0 to 3");
    assert_eq!(error(Girder::default(), TaskKind::PierCap, None, Some(3)), "support_number = 1 to 2 (a pier)");
    let one = || Girder { spans: 1.0, ..Girder::default() };
    assert_eq!(error(one(), TaskKind::PierCap, None, None), "a bridge with piers");
    let low = Girder { column_height_m: 3.0, ..Girder::default() };
    assert_eq!(error(low, TaskKind::PierCap, None, None), "columns that extend to stand_off_m below the path");
    let flat = Girder { pedestal_m: 0.1, bearing_m: 0.05, cap_width_m: 4.0, ..Girder::default() };
    assert!(error(flat, TaskKind::BearingLine, None, None).contains("higher bearings"));
    assert!(bridge(one()).task_path(TaskKind::BearingLine, 4.0).is_ok(), "the first abutment of a bridge without piers");
}

#[test]
fn exact_inconsistent_dimensions_name_their_key_and_limit() {
    let of = |girder: Girder| girder.inconsistencies().into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>();
    // 1.753 m / 150.
    assert_eq!(
        of(Girder { web_m: 0.011, ..Girder::default() }),
        [("web_m", "web_depth_m / 150 (AASHTO LRFD 6.10.2.1): at least 0.01".into())]
    );
    assert_eq!(of(Girder { spans: 2.5, ..Girder::default() })[0].0, "spans");
    assert_eq!(of(Girder { simple_spans: 1.0, ..Girder::default() })[0].0, "cap_width_m");
    assert_eq!(of(Girder { column_m: 1.5, ..Girder::default() })[0].0, "column_m");
    assert_eq!(of(Girder { web_depth_m: 0.9, ..Girder::default() })[0].0, "web_depth_m");
}

#[test]
fn exact_quantities_list_the_elements_of_the_members() {
    use spandrel_model::scenario::bridges::{
        arch::Arch, box_girder::BoxGirder, cable_stayed::CableStayed, masonry_arch::MasonryArch, prestressed::Prestressed,
        suspension::Suspension, truss::Truss,
    };
    let of = |kind: BridgeKind| Bridge { name: "b".into(), center_m: Vec3::zero(), heading_deg: 0.0, kind };
    let kinds = [
        BridgeKind::Arch(Arch::default()),
        BridgeKind::Suspension(Suspension::default()),
        BridgeKind::Girder(Girder::default()),
        BridgeKind::Girder(Girder { spans: 1.0, ..Girder::default() }),
        BridgeKind::Girder(simple()),
        BridgeKind::Prestressed(Prestressed::default()),
        BridgeKind::Prestressed(Prestressed { spans: 1.0, ..Prestressed::default() }),
        BridgeKind::Truss(Truss::default()),
        BridgeKind::Truss(Truss { spans: 1.0, ..Truss::default() }),
        BridgeKind::BoxGirder(BoxGirder::default()),
        BridgeKind::MasonryArch(MasonryArch::default()),
        BridgeKind::CableStayed(CableStayed::default()),
        BridgeKind::MasonryArch(MasonryArch { spans: 1.0, ..MasonryArch::default() }),
    ];
    for bridge in kinds.map(of) {
        let mut built: Vec<u16> =
            bridge.members().iter().map(|m| m.element).filter(|e| e.unit().is_some()).map(|e| e.number()).collect();
        built.sort_unstable();
        built.dedup();
        let listed: Vec<u16> = bridge.quantities().iter().map(|quantity| quantity.element.number()).collect();
        assert_eq!(listed, built, "{:?}", bridge.kind);
        // Elements that are counted one by one, except the pieces of cables and the hangers' and columns' struts, are single members.
        for quantity in bridge.quantities() {
            let members = bridge.members().iter().filter(|m| m.element == quantity.element).count() as f64;
            let counted = matches!(
                quantity.element,
                Element::Hanger
                    | Element::ElastomericBearing
                    | Element::PotBearing
                    | Element::FixedBearing
                    | Element::MovableBearing
            );
            assert!(!counted || members == quantity.amount, "{quantity:?}: {members} members");
        }
    }
    // The suspension bridge by hand: two cables of 140 + 2 x 45 m, two towers, two piers of 13 m, 2 x 19 hangers.
    let suspension = of(BridgeKind::Suspension(Suspension::default())).quantities();
    let amount = |number: u16| suspension.iter().find(|quantity| quantity.element.number() == number).unwrap().amount;
    assert_eq!((amount(147), amount(148), amount(210)), (460.0, 38.0, 26.0));
    // The arch by hand: two ribs of 98 m, 15 floorbeams of 8.8 m, 2 x 13 columns.
    let arch = of(BridgeKind::Arch(Arch::default())).quantities();
    let amount = |number: u16| arch.iter().find(|quantity| quantity.element.number() == number).unwrap().amount;
    assert!(amount(144) == 196.0 && is_close(amount(155), 15.0 * 8.8) && amount(205) == 26.0);
}
