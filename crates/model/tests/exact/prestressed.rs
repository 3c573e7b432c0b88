//! Tests of prestressed girder bridges: sections and quantities against published values and values computed by hand, and task paths
//! against the geometry.

use crate::beams::{FOOT_M, ROUNDING_TOLERANCE_M, assert_bearings_are_in_view, extent, is_close, named, seen, shapes};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::bridges::beam_bridge::BeamBridge;
use spandrel_model::scenario::bridges::prestressed::Prestressed;
use spandrel_model::scenario::{Bridge, BridgeKind, TaskKind};

/// Length of an inch, m.
const INCH_M: f64 = FOOT_M / 12.0;

fn bridge(kind: Prestressed) -> Bridge {
    let kind = BridgeKind::Prestressed(kind);
    assert_eq!(kind.inconsistencies(), []);
    Bridge { name: "b".into(), center_m: Vec3::new(3.0, -8.0, 20.0), heading_deg: 65.0, kind }
}

/// A bridge with a joint above each pier.
fn simple() -> Prestressed {
    Prestressed { simple_spans: 1.0, ..Prestressed::default() }
}

/// A short bridge with a section.
fn with_section(section: f64) -> Prestressed {
    Prestressed { section, span_m: 15.0, end_span_m: 12.0, ..Prestressed::default() }
}

/// Returns the area, the centroid's height and the moment of inertia about the horizontal axis through it, of a polygon.
fn moments(profile: &[[f64; 2]]) -> (f64, f64, f64) {
    let (mut area, mut first, mut second) = (0.0, 0.0, 0.0);
    for (k, [y, z]) in profile.iter().enumerate() {
        let [next_y, next_z] = profile[(k + 1) % profile.len()];
        let cross = y * next_z - next_y * z;
        area += 0.5 * cross;
        first += cross * (z + next_z) / 6.0;
        second += cross * (z * z + z * next_z + next_z * next_z) / 12.0;
    }
    (area, first / area, second)
}

#[test]
fn exact_sections_have_the_published_areas_centroids_and_moments_of_inertia() {
    // PCI, Bridge Design Manual, appendix B: area in in², height of the centroid in in, moment of inertia in in⁴.
    const PUBLISHED: [(f64, f64, f64, f64); 9] = [
        (1.0, 276.0, 12.59, 22_750.0),
        (2.0, 369.0, 15.83, 50_980.0),
        (3.0, 560.0, 20.27, 125_390.0),
        (4.0, 789.0, 24.73, 260_730.0),
        (5.0, 1_013.0, 31.96, 521_180.0),
        (6.0, 1_085.0, 36.38, 733_320.0),
        (54.0, 659.0, 27.63, 268_077.0),
        (63.0, 713.0, 32.12, 392_638.0),
        (72.0, 767.0, 36.60, 545_894.0),
    ];
    // Areas are rounded to square inches, centroids to hundredths of an inch; moments of inertia have at least four digits.
    const AREA_IN2: f64 = 0.51;
    const CENTROID_IN: f64 = 0.011;
    const INERTIA_SHARE: f64 = 5e-4;
    for (number, area_in2, centroid_in, inertia_in4) in PUBLISHED {
        let bridge = bridge(with_section(number));
        let bottom_m = with_section(number).layout().lines.bottom_z_m;
        let members = bridge.members();
        let (mut area, mut first, mut about_bottom) = (0.0, 0.0, 0.0);
        for part in named(&members, "girder-1/01/") {
            // The first corners of a solid are those of its profile.
            let profile: Vec<[f64; 2]> = part.solid.vertices_m[..4]
                .iter()
                .map(|corner| bridge.placement().local(*corner))
                .map(|[_, y, z]| [y / INCH_M, (z - bottom_m) / INCH_M])
                .collect();
            let (part_area, height, second) = moments(&profile);
            area += part_area;
            first += part_area * height;
            about_bottom += second;
        }
        let centroid = first / area;
        let inertia = about_bottom - area * centroid * centroid;
        assert!((area - area_in2).abs() < AREA_IN2, "section {number}: {area} in2");
        assert!((centroid - centroid_in).abs() < CENTROID_IN, "section {number}: {centroid} in");
        assert!((inertia / inertia_in4 - 1.0).abs() < INERTIA_SHARE, "section {number}: {inertia} in4");
    }
}

#[test]
fn exact_parts_of_a_section_lie_on_each_other_from_the_haunch_to_the_bearings() {
    for number in [1.0, 4.0, 6.0, 54.0] {
        let (kind, bridge) = (with_section(number), bridge(with_section(number)));
        let members = bridge.members();
        let parts: Vec<_> = named(&members, "girder-3/01/").iter().map(|part| extent(&bridge, part)).collect();
        assert!(parts.len() >= 5, "section {number}");
        assert!(parts.windows(2).all(|pair| is_close(pair[0][2].0, pair[1][2].1)), "section {number}: {parts:?}");
        let layout = kind.layout();
        assert!(is_close(parts[0][2].1, -kind.slab_m - kind.haunch_m));
        assert!(is_close(parts[parts.len() - 1][2].0, layout.lines.bottom_z_m));
        // By hand: the third of six girders at 2.74 m is half a spacing to the left of the middle.
        assert!(parts.iter().all(|part| is_close(part[1].0 + part[1].1, 2.74)));
    }
    // The published depths: AASHTO type IV 54 in, BT-72 72 in.
    for (number, depth_in) in [(4.0, 54.0), (72.0, 72.0)] {
        let lines = with_section(number).layout().lines;
        assert!(is_close(lines.top_z_m - lines.bottom_z_m, depth_in * INCH_M), "{number}");
    }
}

#[test]
fn exact_girders_end_beside_the_joints_or_in_the_diaphragms_above_the_piers() {
    for (kind, gap_m) in [(simple(), 0.06), (Prestressed::default(), 0.3)] {
        let bridge = bridge(kind.clone());
        let members = bridge.members();
        let webs: Vec<(f64, f64)> = named(&members, "girder-1/")
            .iter()
            .filter(|part| part.name.ends_with("/web"))
            .map(|part| extent(&bridge, part)[0])
            .collect();
        let gaps: Vec<(f64, f64)> =
            webs.windows(2).map(|pair| (pair[0].1, pair[1].0)).filter(|(from, to)| to - from > ROUNDING_TOLERANCE_M).collect();
        // The piers are half of the middle span of 36.58 m from the middle.
        assert_eq!(gaps.len(), 2, "{gaps:?}");
        for ((from, to), pier) in gaps.into_iter().zip([-18.29, 18.29]) {
            assert!(is_close(to - from, gap_m) && is_close(0.5 * (from + to), pier), "{from} {to}");
        }
        let joints = named(&members, "joint-").len();
        let diaphragms: Vec<_> = named(&members, "diaphragm-pier/").iter().map(|part| extent(&bridge, part)).collect();
        assert_eq!((joints, diaphragms.len()), if gap_m < 0.1 { (4, 0) } else { (2, 2) });
        for [x, y, z] in diaphragms {
            assert!(is_close(x.1 - x.0, 0.3) && is_close(z.1, -kind.slab_m), "{x:?} {z:?}");
            assert!(y.1 > 2.5 * 2.74 && is_close(y.0, -y.1), "{y:?}");
        }
    }
}

#[test]
fn exact_diaphragms_join_the_webs_at_most_their_spacing_apart() {
    let kind = Prestressed::default();
    let bridge = bridge(kind.clone());
    let members = bridge.members();
    let middle = |extent: (f64, f64)| 0.5 * (extent.0 + extent.1);
    let rows: Vec<_> = named(&members, "diaphragm-2/")
        .iter()
        .filter(|part| part.name.ends_with("/web"))
        .map(|part| extent(&bridge, part))
        .collect();
    // By hand: spans between bearings of 33.53 - 0.4, 36.58 - 0.8 and 33.53 - 0.4 m have three panels each, so two diaphragms inside
    // each span and one at each abutment.
    assert_eq!(rows.len(), 2 + 2 + 2 + 2);
    assert!(rows.windows(2).all(|pair| middle(pair[1][0]) - middle(pair[0][0]) < 2.0 * kind.diaphragm_spacing_m));
    for [_, y, z] in &rows {
        // Between the second and the third of six girders with webs of 6 in; the web of a BT-72 is 54 in high.
        assert!(is_close(y.1, 1.5 * 2.74 - 3.0 * INCH_M) && is_close(y.0, 0.5 * 2.74 + 3.0 * INCH_M), "{y:?}");
        assert!(is_close(z.1 - z.0, 54.0 * INCH_M));
    }
    let at_ends = named(&members, "diaphragm-2/").iter().filter(|part| part.name.ends_with("/top")).count();
    assert_eq!(at_ends, 2);
}

#[test]
fn exact_quantities_of_the_default_bridge_match_values_computed_by_hand() {
    // Length 2 x 33.53 + 36.58 = 103.64 m between bearings, 104.14 m of deck, 5 x 2.74 + 2 x 1.22 = 16.14 m wide. The girders have two
    // gaps of 0.3 m. Abutments: the backwalls' backs are 51.82 + 0.25 + 0.06 + 0.5 m from the middle, the approach slabs are 6 m long.
    // Caps: 13.7 + 1.2 m. Footings: 2/3 of the cap plus 1.22 + 1.6 m. Bearings: two rows of six for each span.
    const TOLERANCE: f64 = 1e-9;
    let expected = [
        (12, 104.14 * 16.14),
        (109, 6.0 * (104.14 - 0.6)),
        (205, 6.0),
        (215, 2.0 * (16.14 + 12.0)),
        (220, 2.0 * (14.9 * 2.0 / 3.0 + 2.82)),
        (234, 2.0 * 14.9),
        (300, 2.0 * 16.14),
        (310, 36.0),
        (321, 2.0 * 6.0 * 16.14),
        (331, 4.0 * 58.63),
    ];
    let quantities = bridge(Prestressed::default()).quantities();
    assert_eq!(quantities.len(), expected.len());
    for (quantity, (number, amount)) in quantities.iter().zip(expected) {
        assert_eq!(quantity.element.number(), number);
        assert!((quantity.amount - amount).abs() < TOLERANCE * amount, "{quantity:?}, expected {amount}");
    }
    // 6 x 103.54 m of girders are 2038 ft.
    assert_eq!(quantities[1].text(), "2038 ft (621.2 m)");
}

#[test]
fn exact_bearings_are_in_view_from_the_bearing_line() {
    for kind in [Prestressed::default(), simple(), Prestressed { columns: 1.0, column_m: 1.5, ..simple() }] {
        let (layout, bridge) = (kind.layout(), bridge(kind));
        assert_bearings_are_in_view(&bridge, &layout, 0..=3);
    }
}

#[test]
fn exact_paths_below_and_beside_the_girders_view_them() {
    let bridge = bridge(Prestressed::default());
    let shapes = shapes(&bridge);
    for (kind, parts) in [
        (TaskKind::SlabSide, &["b/girder-6", "b/slab"][..]),
        (TaskKind::GirderSoffit, &["b/girder-", "b/slab", "b/haunch", "b/diaphragm"]),
        (TaskKind::PierCap, &["b/cap-1"]),
    ] {
        let path = bridge.task_path(kind, 4.5).unwrap();
        let views = (0..path.path_m.len()).filter_map(|k| seen(&shapes, &path, k));
        let count = views.filter(|name| parts.iter().any(|part| name.starts_with(part))).count();
        // At the corners of the loop around the cap, the view passes the cap's tapered ends.
        assert!(count as f64 > 0.9 * path.path_m.len() as f64, "{kind:?}: {count} of {}", path.path_m.len());
    }
}

#[test]
fn exact_inconsistent_dimensions_name_their_key_and_limit() {
    let of = |kind: Prestressed| {
        let list = BridgeKind::Prestressed(kind).inconsistencies();
        list.into_iter().map(|one| (one.key, one.allowed)).collect::<Vec<_>>()
    };
    let sections = "a standard section: 1, 2, 3, 4, 5, 6, 54, 63, 72".to_owned();
    assert_eq!(of(Prestressed { section: 60.0, ..Prestressed::default() }), [("section", sections)]);
    // 28 times 54 in.
    let too_long = of(Prestressed { section: 4.0, span_m: 40.0, ..Prestressed::default() });
    assert_eq!(too_long, [("span_m", "28 times the depth of the girders (section; estimate): at most 38.40".to_owned())]);
    // The bearings need 2 x (0.25 + 0.15 + 0.125 + 0.2) m.
    let narrow = of(Prestressed { cap_width_m: 1.4, ..Prestressed::default() });
    assert_eq!(narrow, [("cap_width_m", "room for the bearings (simple_spans, joint_gap_m): at least 1.45".to_owned())]);
    assert_eq!(of(Prestressed { overhang_m: 1.0, ..Prestressed::default() })[0].0, "overhang_m");
    assert_eq!(of(Prestressed { girder_spacing_m: 1.5, girders: 8.0, ..with_section(2.0) }), []);
}
