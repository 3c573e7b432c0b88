//! Tests of cable-stayed bridges: their geometry and quantities against values computed by hand, and their task paths against the geometry.

use crate::beams::{ROUNDING_TOLERANCE_M, extent, is_close, named, seen, shapes};
use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::scenario::bridges::cable_stayed::CableStayed;
use spandrel_model::scenario::bridges::path::PathPlace;
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

fn bridge(kind: CableStayed) -> Bridge {
    let kind = BridgeKind::CableStayed(kind);
    assert_eq!(kind.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind }
}

#[test]
fn exact_stays_run_from_the_floorbeams_to_the_towers() {
    // By hand: the towers are 80 m from midspan, the stays 160/15 m apart in the main span and 66/7 m in the side spans. At the towers, they are
    // 36 m above the road and every 1.6 m below.
    let stays = CableStayed::default().stays();
    assert_eq!(stays.len(), 28);
    for (k, stay) in stays.iter().enumerate() {
        let (group, number) = (k / 7, (k % 7 + 1) as f64);
        let tower = if group < 2 { -80.0 } else { 80.0 };
        let offset = [-66.0 / 7.0, 160.0 / 15.0, 66.0 / 7.0, -160.0 / 15.0][group] * number;
        assert!(is_close(stay.deck_m[0], tower + offset) && is_close(stay.deck_m[1], -0.25), "{k}: {stay:?}");
        assert!(is_close(stay.tower_m[0], tower) && is_close(stay.tower_m[1], 36.0 - 1.6 * (7.0 - number)), "{k}: {stay:?}");
    }
    let bridge = bridge(CableStayed::default());
    let members = bridge.members();
    // Two planes, each stay with its guide pipe.
    assert_eq!(named(&members, "stay-").len(), 2 * 2 * 28);
    let [x, _, z] = extent(&bridge, named(&members, "stay-left/1-side-07")[0]);
    // The backstay ends above the bearings on the abutment, 146 m from midspan.
    assert!((x.0 + 146.0).abs() < 0.1 && (z.1 - 36.0).abs() < 0.1, "{x:?} {z:?}");
}

#[test]
fn exact_towers_stand_on_their_piers_beside_the_girders() {
    let bridge = bridge(CableStayed::default());
    let members = bridge.members();
    for (name, x) in [("start", -80.0), ("end", 80.0)] {
        let [along, across, z] = extent(&bridge, named(&members, &format!("tower-{name}/left"))[0]);
        assert!(is_close(along.0, x - 1.5) && is_close(along.1, x + 1.5), "{along:?}");
        // 0.05 m beside the girder, whose outer face is 5.75 m from the centerline; from the pier to 2 m above the stays.
        assert!(
            is_close(across.0, 5.8) && is_close(across.1, 7.8) && is_close(z.0, -10.0) && is_close(z.1, 38.0),
            "{across:?} {z:?}"
        );
        let [_, _, z] = extent(&bridge, named(&members, &format!("pier-{name}"))[0]);
        assert!(is_close(z.1, -10.0) && is_close(z.0, -22.0), "{z:?}");
        // The bearings are on the cross beam, 0.25 m below the girders.
        let [_, _, z] = extent(&bridge, named(&members, &format!("cap-{name}"))[0]);
        assert!(is_close(z.1, -2.1), "{z:?}");
    }
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // 160 + 2 x 66 m between the outer bearings, 293.6 m of deck; the backwalls' backs are 146 + 0.8 + 0.12 + 0.5 m from midspan. The stays along the
    // road: 1 + 2 + ... + 7 = 28 times their distance, in four groups and two planes. The abutments are 11.5 m wide.
    const TOLERANCE: f64 = 1e-9;
    let stays_m = 2.0 * 28.0 * 2.0 * (160.0 / 15.0 + 66.0 / 7.0);
    // Floorbeams: 28 with stays, 2 x 7.1 m long, two at the towers; every distance of 9.43 or 10.67 m has one or two more between.
    let plain = 2.0 + 2.0 * 7.0 + 2.0 * 15.0;
    let expected = [
        (12, 293.6 * 11.0),
        (107, 2.0 * 293.6),
        (147, stays_m),
        (152, 28.0 * 14.2 + plain * 11.0),
        (205, 4.0),
        (210, 40.0),
        (215, 4.0 * (5.75 + 8.0)),
        (234, 2.0 * 11.6),
        (300, 22.0),
        (311, 6.0),
        (313, 2.0),
        (321, 16.0 * 11.0),
        (330, 4.0 * (147.42 + 8.0)),
    ];
    let quantities = bridge(CableStayed::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
}

#[test]
fn exact_stay_path_climbs_beside_the_longest_stay() {
    const STAND_OFF_M: f64 = 4.0;
    let bridge = bridge(CableStayed::default());
    let shapes = shapes(&bridge);
    let path = bridge.task_path(TaskKind::StayCable, STAND_OFF_M).unwrap();
    let longest = CableStayed::default().stays()[13];
    let slope = (longest.tower_m[1] - longest.deck_m[1]) / (longest.tower_m[0] - longest.deck_m[0]);
    let mut in_view = 0;
    for (k, point) in path.path_m.iter().enumerate() {
        let [x, y, z] = bridge.placement().local(*point);
        assert!(is_close(z, longest.deck_m[1] + slope * (x - longest.deck_m[0])), "{x} {z}");
        assert!(is_close(y, -6.8 - 0.3 - STAND_OFF_M), "{y}");
        in_view += usize::from(seen(&shapes, &path, k).is_some_and(|name| name.starts_with("b/stay-right/1-main-07")));
    }
    assert!(in_view as f64 > 0.95 * path.path_m.len() as f64, "{in_view} of {}", path.path_m.len());
    let gap_m = path
        .path_m
        .iter()
        .flat_map(|p| shapes.iter().map(|(_, shape)| shape.nearest(*p).distance_m))
        .fold(f64::INFINITY, f64::min);
    assert!(gap_m >= STAND_OFF_M - ROUNDING_TOLERANCE_M, "{gap_m}");
    let (first, last) = (path.path_m[0], path.path_m[path.path_m.len() - 1]);
    assert!(last.up() - first.up() > 30.0, "it climbs nearly to the top of the tower");
}

#[test]
fn exact_floor_path_is_level_below_a_span() {
    let bridge = bridge(CableStayed::default());
    for (number, center) in [(1, -114.0), (2, 0.0), (3, 114.0)] {
        let path = bridge.task_path_at(TaskKind::FloorSystem, 4.0, &PathPlace { span: Some(number), support: None }).unwrap();
        let local: Vec<[f64; 3]> = path.path_m.iter().map(|p| bridge.placement().local(*p)).collect();
        // The girders' undersides are 1.85 m below the road.
        assert!(local.iter().all(|p| is_close(p[2], -5.85)));
        let (low, high) = math::range(local.iter().map(|p| p[0]));
        assert!((0.5 * (low + high) - center).abs() < 2.0, "{low} {high}");
    }
    let error = bridge.task_path_at(TaskKind::FloorSystem, 4.0, &PathPlace { span: Some(4), support: None }).unwrap_err();
    assert_eq!(error, "span_number = 1 to 3");
}

#[test]
fn exact_rules_name_the_keys_that_do_not_fit() {
    let of = |kind: CableStayed| {
        let list = BridgeKind::CableStayed(kind).inconsistencies();
        list.into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>()
    };
    let keys = |kind: CableStayed| of(kind).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
    assert_eq!(
        of(CableStayed { side_span_m: 38.0, ..CableStayed::default() })[0],
        ("side_span_m", "0.25 main_span_m (estimate): at least 40.00".to_owned())
    );
    assert_eq!(keys(CableStayed { side_span_m: 85.0, ..CableStayed::default() }), ["side_span_m"]);
    // The longest stay covers 7 x 160/15 = 74.67 m: at least 21.41 m high.
    let low = of(CableStayed { tower_height_m: 21.0, anchor_spacing_m: 1.0, ..CableStayed::default() });
    assert!(low.len() == 1 && low[0].0 == "tower_height_m" && low[0].1.ends_with("at least 21.41"), "{low:?}");
    assert_eq!(keys(CableStayed { anchor_spacing_m: 5.0, tower_height_m: 30.0, ..CableStayed::default() }), ["anchor_spacing_m"]);
    assert_eq!(keys(CableStayed { pier_y_m: 15.0, ..CableStayed::default() }), ["pier_y_m"]);
    assert_eq!(keys(CableStayed { leg_x_m: 7.0, ..CableStayed::default() }), ["leg_x_m"]);
    assert_eq!(keys(CableStayed { floorbeam_depth_m: 1.8, ..CableStayed::default() }), ["girder_depth_m"]);
    assert_eq!(keys(CableStayed { pier_top_m: 4.0, girder_depth_m: 2.5, ..CableStayed::default() }), ["pier_top_m"]);
}
