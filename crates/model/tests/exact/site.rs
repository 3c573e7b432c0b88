//! Tests of the site's geometry queries against brute-force searches over all faces.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{Scenario, TaskKind};
use spandrel_model::site::geometry::Geometry;
use spandrel_model::site::{Contact, HullProbe, Surface};

/// Tolerance for rounding errors in positions a few hundred meters from the origin, m.
const ROUNDING_TOLERANCE_M: f64 = 1e-9;

fn scenario(text: &str) -> Scenario {
    spandrel_model::scenario::read("shipped.toml", text, &|_| Err("no file".into())).unwrap_or_else(|p| panic!("{p}"))
}

fn two_bridges() -> Scenario {
    scenario(spandrel_model::shipped::TWO_BRIDGES)
}

pub type Triangle = [Vec3<Enu>; 3];

fn triangles(geometry: &Geometry) -> Vec<Triangle> {
    let of = |solid: &spandrel_model::scenario::bridges::Solid| {
        solid.triangles().into_iter().map(|t| t.map(|k| solid.vertices_m[k as usize])).collect::<Vec<_>>()
    };
    geometry.members().iter().flat_map(|m| of(&m.solid)).collect()
}

/// Returns the distance from a point to a triangle: to its plane if the projection is inside, otherwise to the nearest side.
pub fn distance_to_triangle(p: Vec3<Enu>, t: &Triangle) -> f64 {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).unit();
    let sides = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    if sides.iter().all(|(a, b)| normal.cross(*b - *a).dot(p - *a) >= 0.0) {
        return normal.dot(p - t[0]).abs();
    }
    let to_side = |(a, b): &(Vec3<Enu>, Vec3<Enu>)| {
        let along = *b - *a;
        (p - (*a + along * ((p - *a).dot(along) / along.norm_squared()).clamp(0.0, 1.0))).norm()
    };
    sides.iter().map(to_side).fold(f64::INFINITY, f64::min)
}

/// Returns the distance along a ray to its intersection with a triangle.
fn ray_to_triangle(origin: Vec3<Enu>, direction: Vec3<Enu>, t: &Triangle) -> Option<f64> {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).unit();
    let distance = normal.dot(t[0] - origin) / normal.dot(direction);
    let p = origin + direction * distance;
    let within = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]
        .iter()
        .all(|(a, b)| normal.cross((*b - *a).unit()).dot(p - *a) >= -ROUNDING_TOLERANCE_M);
    (distance >= 0.0 && within).then_some(distance)
}

/// Returns random points near the members.
fn random_points(geometry: &Geometry, count: usize) -> Vec<Vec3<Enu>> {
    let mut random = RandomStream::new(6, "points");
    let members = geometry.members();
    let one = |_| {
        let member = &members[(random.uniform() * members.len() as f64) as usize % members.len()];
        let vertex = member.solid.vertices_m[0];
        vertex + Vec3::new(random.normal(), random.normal(), random.normal()) * random.range(0.05, 4.0)
    };
    (0..count).map(one).collect()
}

#[test]
fn prop_nearest_member_matches_brute_force() {
    let geometry = Geometry::new(&two_bridges());
    let faces = triangles(&geometry);
    let mut outside = 0;
    for p in random_points(&geometry, 250) {
        let near = geometry.nearest_member(p, f64::INFINITY).unwrap();
        assert!((near.point_m + near.normal * near.distance_m - p).norm() < ROUNDING_TOLERANCE_M);
        assert!((near.normal.norm() - 1.0).abs() < ROUNDING_TOLERANCE_M);
        let within = (0..geometry.members().len()).any(|k| geometry.shape(k).unwrap().nearest(p).distance_m < 0.0);
        assert_eq!(near.distance_m < 0.0, within);
        if !within {
            outside += 1;
            let brute = faces.iter().map(|t| distance_to_triangle(p, t)).fold(f64::INFINITY, f64::min);
            assert!(
                (near.distance_m - brute).abs() < ROUNDING_TOLERANCE_M,
                "{p:?}: {} m, but {brute} m by brute force",
                near.distance_m
            );
            let capped = geometry.nearest_member(p, 1.5).map(|n| n.distance_m);
            assert_eq!(capped, (brute <= 1.5).then_some(near.distance_m));
        }
    }
    assert!(outside > 150, "{outside}");
}

#[test]
fn prop_first_ray_hit_matches_brute_force() {
    let geometry = Geometry::new(&two_bridges());
    let faces = triangles(&geometry);
    let mut random = RandomStream::new(7, "directions");
    let mut hits = 0;
    for p in random_points(&geometry, 400) {
        if geometry.nearest(p, 0.0).is_some() {
            continue;
        }
        let axis = Vec3::new(0.0, 0.0, if random.uniform() < 0.5 { 1.0 } else { -1.0 });
        let any = Vec3::new(random.normal(), random.normal(), random.normal()).unit();
        let direction = if random.uniform() < 0.2 { axis } else { any };
        let hit = geometry.ray(p, direction, 60.0);
        let brute = faces.iter().filter_map(|t| ray_to_triangle(p, direction, t)).fold(f64::INFINITY, f64::min);
        match hit {
            Some(hit) if hit.surface == Surface::Bridge => {
                hits += 1;
                assert!((hit.distance_m - brute).abs() < 1e-7, "{p:?} {direction:?}: {} m, expected {brute} m", hit.distance_m);
                assert!(hit.normal.dot(direction) <= 0.0);
            }
            Some(other) => assert!(other.distance_m <= brute, "{other:?} behind a member at {brute} m"),
            None => assert!(brute > 60.0, "{p:?} {direction:?}: no hit, but {brute} m by brute force"),
        }
    }
    assert!(hits > 80, "{hits}");
}

fn random_capsule(p: Vec3<Enu>, random: &mut RandomStream) -> (Vec3<Enu>, Vec3<Enu>, f64) {
    let half = Vec3::new(random.normal(), random.normal(), random.normal()).unit() * random.range(0.02, 0.4);
    (p - half, p + half, random.range(0.005, 0.1))
}

#[test]
fn prop_capsule_contacts_include_the_deepest_point() {
    // Half the spacing of the sample points along the longest capsule, m. Over one meter, the distance changes by at
    // most one meter.
    const SAMPLING_TOLERANCE_M: f64 = 0.5 * 0.8 / 400.0;
    // Tolerance within which distances count as equal, m.
    const DISTANCE_TOLERANCE_M: f64 = 2e-7;
    const SAMPLING_MARGIN_M: f64 = 0.3;
    let geometry = Geometry::new(&two_bridges());
    let mut random = RandomStream::new(8, "capsules");
    let mut found = 0;
    for p in random_points(&geometry, 1500) {
        let (a_m, b_m, radius_m) = random_capsule(p, &mut random);
        let mut contacts: Vec<Contact> = Vec::new();
        geometry.contacts(&HullProbe::Capsule { a_m, b_m, radius_m }, SAMPLING_MARGIN_M, &mut contacts);
        contacts.retain(|c| c.surface == Surface::Bridge);
        let member = |k: usize| {
            let shape = geometry.shape(k).unwrap();
            (0..=400).map(|i| shape.nearest(a_m.lerp(b_m, f64::from(i) / 400.0)).distance_m).fold(f64::INFINITY, f64::min)
                - radius_m
        };
        let mut objects: Vec<u32> = contacts.iter().map(|c| c.object.0).collect();
        assert!(objects.is_sorted(), "contacts are not in member order");
        objects.dedup();
        for k in objects {
            let deepest = contacts.iter().filter(|c| c.object.0 == k).map(|c| c.gap_m).fold(f64::INFINITY, f64::min);
            let tried = member(k as usize);
            assert!(
                deepest < tried + DISTANCE_TOLERANCE_M && deepest > tried - SAMPLING_TOLERANCE_M,
                "{deepest} m, but {tried} m by sampling"
            );
            found += 1;
        }
        // Members without a contact must be out of reach.
        let near = geometry.nearest_member(p, SAMPLING_MARGIN_M + radius_m);
        assert!(near.is_none_or(|n| contacts.iter().any(|c| c.object == n.object)));
    }
    assert!(found > 800, "{found}");
}

#[test]
fn exact_capsule_on_the_deck_has_contacts_at_both_ends() {
    let scenario = two_bridges();
    let geometry = Geometry::new(&scenario);
    // The center of a deck panel on the arch bridge, at a height of 34 m.
    let (a_m, b_m) = (Vec3::new(3.2, 0.3, 34.05), Vec3::new(3.5, 0.5, 34.05));
    let mut contacts = Vec::new();
    geometry.contacts(&HullProbe::Capsule { a_m, b_m, radius_m: 0.05 }, 0.01, &mut contacts);
    assert_eq!(contacts.len(), 2, "{contacts:?}");
    for (contact, end) in contacts.iter().zip([a_m, b_m]) {
        assert!(
            contact.gap_m.abs() < ROUNDING_TOLERANCE_M
                && (contact.normal - Vec3::new(0.0, 0.0, 1.0)).norm() < ROUNDING_TOLERANCE_M
        );
        assert!((contact.point_m - (end - Vec3::new(0.0, 0.0, 0.05))).norm() < ROUNDING_TOLERANCE_M);
    }
}

#[test]
fn prop_no_contacts_within_the_free_radius() {
    let scenario = two_bridges();
    let geometry = Geometry::new(&scenario);
    let mut random = RandomStream::new(9, "balls");
    let pad = scenario.ground_team.pad_m;
    let mut places = random_points(&geometry, 150);
    places
        .extend((0..150).map(|_| pad + Vec3::new(random.range(-60.0, 60.0), random.range(-60.0, 60.0), random.range(0.0, 8.0))));
    for p in places {
        let free = geometry.free_radius(p, 4.0).unwrap_or(4.0);
        for _ in 0..60 {
            let q = p + Vec3::new(random.normal(), random.normal(), random.normal()).unit() * free * random.range(0.0, 0.999);
            let mut contacts = Vec::new();
            if free > 0.0 {
                geometry.contacts(&HullProbe::Ball { center_m: q, radius_m: 0.0 }, 0.0, &mut contacts);
            }
            assert_eq!(contacts, [], "{p:?} has a free radius of {free} m, but there is contact at {q:?}");
        }
    }
}

#[test]
fn exact_crew_truck_and_pad_are_on_the_ground() {
    // Maximum height above the ground, m. The pad is 0.05 m above it; feet and wheels touch it.
    const MAX_HEIGHT_M: f64 = 0.06;
    for text in [spandrel_model::shipped::TWO_BRIDGES, spandrel_model::shipped::PRACTICE] {
        let scenario = scenario(text);
        let geometry = Geometry::new(&scenario);
        let team = &scenario.ground_team;
        for p in [team.inspector_m, team.truck_m] {
            let over = p.up() - geometry.ground_up_m(p.east(), p.north());
            assert!(over.abs() < MAX_HEIGHT_M, "{over} m over the ground");
        }
        for (e, n) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0), (0.0, 0.0)] {
            let p = team.pad_m + Vec3::new(e, n, 0.0) * team.pad_half_m;
            let over = p.up() - geometry.terrain.ground.ground(p.east(), p.north()).0;
            assert!(over > 0.0 && over < MAX_HEIGHT_M, "{over} m over the ground");
            assert_eq!(geometry.ground_up_m(p.east(), p.north()), p.up());
        }
    }
}

#[test]
fn exact_ground_meets_the_decks_and_clears_the_spans() {
    // Maximum step from the deck to the road, m. The road is 0.15 m below the deck, and the 4 m grid rounds its edge.
    const MAX_STEP_M: f64 = 0.5;
    let scenario = two_bridges();
    let geometry = Geometry::new(&scenario);
    for bridge in &scenario.bridges {
        let deck = bridge.center_m.up();
        let at = |x: f64| bridge.placement().point([x, 0.0, 0.0]);
        for side in [-1.0, 1.0] {
            let p = at(side * (0.5 * bridge.deck_length_m() + 5.0));
            let step = deck - geometry.ground_up_m(p.east(), p.north());
            assert!(step.abs() < MAX_STEP_M, "{}: the road is {step} m below the deck", bridge.name);
        }
        for k in -8..=8 {
            let p = at(f64::from(k) / 8.0 * bridge.opening_half_length_m());
            assert!(deck - geometry.ground_up_m(p.east(), p.north()) > 1.5, "{}: the ground reaches the deck", bridge.name);
        }
    }
    let foot = |name: &str| {
        let member = geometry.members().iter().find(|m| m.name == name).unwrap();
        let low = member.solid.vertices_m.iter().fold(f64::INFINITY, |low, v| low.min(v.up()));
        (member.solid.vertices_m[0], low)
    };
    for name in [
        "arch/skewback-start",
        "arch/skewback-end",
        "arch/abutment-start",
        "arch/abutment-end",
        "suspension/pier-start",
        "suspension/pier-end",
        "suspension/anchorage-start",
        "suspension/anchorage-end",
    ] {
        let (p, low) = foot(name);
        assert!(low < geometry.ground_up_m(p.east(), p.north()), "{name} does not reach the ground");
    }
}

#[test]
fn exact_ground_of_the_girder_bridge_holds_its_footings_and_leaves_its_bearings_free() {
    // Minimum height of the bearings above the ground beside the abutments, m.
    const MIN_OPEN_M: f64 = 1.0;
    let scenario = scenario(spandrel_model::shipped::GIRDER);
    let geometry = Geometry::new(&scenario);
    let low = |name: &str| {
        let members = geometry.members().iter().filter(|m| m.name.starts_with(name));
        let corners = members.flat_map(|m| m.solid.vertices_m.iter().copied());
        corners.min_by(|a, b| a.up().total_cmp(&b.up())).unwrap()
    };
    for name in ["footing-1", "footing-2", "abutment-start/stem", "abutment-end/stem", "abutment-end/wing-left"] {
        let p = low(&format!("girder/{name}"));
        assert!(p.up() < geometry.ground_up_m(p.east(), p.north()), "{name} does not reach the ground");
    }
    for member in geometry.members().iter().filter(|m| m.name.contains("/bearing-")) {
        let clear = |p: &Vec3<Enu>| p.up() - geometry.ground_up_m(p.east(), p.north());
        assert!(member.solid.vertices_m.iter().all(|p| clear(p) > MIN_OPEN_M), "{} is in the ground", member.name);
    }
    let bridge = &scenario.bridges[0];
    for side in [-1.0, 1.0] {
        let p = bridge.placement().point([side * (0.5 * bridge.deck_length_m() + 5.0), 0.0, 0.0]);
        let step = bridge.center_m.up() - geometry.ground_up_m(p.east(), p.north());
        assert!(step.abs() < 0.5, "the road is {step} m below the deck");
    }
}

#[test]
fn exact_pier_path_is_two_to_four_meters_above_the_water() {
    let scenario = two_bridges();
    let task = scenario.tasks.iter().find(|t| t.kind == TaskKind::PierCircle).unwrap();
    for p in &task.path_m {
        let over = p.up() - scenario.terrain.water_level_m;
        assert!((2.0..=4.0).contains(&over), "{over} m");
    }
}

#[test]
fn regress_two_builds_of_a_site_are_bit_identical() {
    let (one, other) = (Geometry::new(&two_bridges()), Geometry::new(&two_bridges()));
    for p in random_points(&one, 300) {
        assert_eq!(one.nearest(p, 50.0), other.nearest(p, 50.0));
        assert_eq!(one.ray(p, Vec3::new(0.6, 0.0, 0.8), 50.0), other.ray(p, Vec3::new(0.6, 0.0, 0.8), 50.0));
    }
}

#[test]
fn prop_min_clearance_of_a_segment_matches_sampling() {
    // Half the sample point spacing plus the search accuracy of 1 mm.
    const SAMPLING_TOLERANCE_M: f64 = 0.5 * 6.0 / 600.0 + 1e-3;
    let geometry = Geometry::new(&two_bridges());
    let mut random = RandomStream::new(11, "pieces");
    let mut tight = 0;
    for from in random_points(&geometry, 150) {
        let to = from + Vec3::new(random.normal(), random.normal(), random.normal()).unit() * random.range(0.0, 6.0);
        let tried = (0..=600)
            .filter_map(|k| geometry.nearest(from.lerp(to, f64::from(k) / 600.0), 5.0))
            .map(|n| n.distance_m)
            .fold(f64::INFINITY, f64::min);
        let needed_m = random.range(0.2, 2.0);
        match geometry.min_clearance(from, to, needed_m) {
            Some((at, near)) => {
                tight += 1;
                assert!(
                    (near.distance_m - tried).abs() < SAMPLING_TOLERANCE_M && near.distance_m < needed_m,
                    "{near:?}, expected {tried} m"
                );
                assert_eq!(geometry.nearest(at, 5.0).map(|n| n.distance_m), Some(near.distance_m));
            }
            None => {
                assert!(tried > needed_m - SAMPLING_TOLERANCE_M, "{tried} m by sampling, but no point below {needed_m} m found")
            }
        }
    }
    assert!(tight > 50, "{tight}");
}

#[test]
fn prop_free_radius_near_steep_ground_matches_brute_force() {
    let scenario = two_bridges();
    let geometry = Geometry::new(&scenario);
    let (corners, triangles) = geometry.terrain.ground.triangles();
    let ground: Vec<Triangle> = triangles.iter().map(|t| t.map(|k| corners[k as usize])).collect();
    let mut faces = triangles_near(&ground, Vec3::zero(), 250.0);
    faces.extend(self::triangles(&geometry));
    let pad = geometry.pad();
    faces.extend(pad.solid.triangles().iter().map(|t| t.map(|k| pad.solid.vertices_m[k as usize])));
    let mut random = RandomStream::new(12, "slopes");
    let mut steep = 0;
    for _ in 0..400 {
        let (e, n) = (random.range(-140.0, 140.0), random.range(-60.0, 90.0));
        let (height, normal) = geometry.terrain.ground.ground(e, n);
        let p = Vec3::new(e, n, height.max(scenario.terrain.water_level_m) + random.range(0.05, 4.0));
        let near = triangles_near(&faces, p, 5.0);
        let brute = near.iter().map(|t| distance_to_triangle(p, t)).fold(p.up() - scenario.terrain.water_level_m, f64::min);
        if geometry.nearest_member(p, 0.0).is_some() {
            continue;
        }
        let free = geometry.free_radius(p, 5.0).unwrap_or(5.0);
        assert!((free - brute.min(5.0)).abs() < ROUNDING_TOLERANCE_M, "{p:?}: {free} m, but {brute} m by brute force");
        steep += usize::from(normal.up() < 0.85 && free < 4.0);
    }
    assert!(steep > 30, "{steep}");
}

/// Returns the triangles whose bounding box, extended by `reach_m`, contains a point.
fn triangles_near(all: &[Triangle], p: Vec3<Enu>, reach_m: f64) -> Vec<Triangle> {
    let near = |t: &&Triangle| {
        (0..3).all(|k| {
            let at = t.map(|c| c.array()[k]);
            let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
            low - reach_m <= p.array()[k] && p.array()[k] <= high + reach_m
        })
    };
    all.iter().filter(near).copied().collect()
}

#[test]
fn exact_shipped_tasks_1_2_and_4_keep_4_m_from_all_members() {
    // Stand-off distance of tasks 1, 2 and 4 by design, m.
    const STAND_OFF_M: f64 = 4.0;
    let mut seen = 0;
    for text in [
        spandrel_model::shipped::TWO_BRIDGES,
        spandrel_model::shipped::PRACTICE,
        spandrel_model::shipped::DRILL_CURVE_UNDER_ARCH,
        spandrel_model::shipped::DRILL_ORBIT,
    ] {
        let scenario = scenario(text);
        let geometry = Geometry::new(&scenario);
        for task in &scenario.tasks {
            if !matches!(task.kind, TaskKind::SlabSide | TaskKind::ArchBottom | TaskKind::PierCircle) {
                continue;
            }
            seen += 1;
            let points = &task.path_m;
            for k in 0..points.len() - usize::from(!task.closed) {
                for share in [0.0, 0.25, 0.5, 0.75] {
                    let p = points[k].lerp(points[(k + 1) % points.len()], share);
                    let near = geometry.nearest_member(p, STAND_OFF_M);
                    assert_eq!(near, None, "{}: point {k} of {}", scenario.name, task.name);
                }
            }
        }
    }
    assert_eq!(seen, 8);
}

#[test]
fn prop_capsule_contacts_with_the_ground_match_sampling() {
    // Half the spacing of the sample points, and the tolerance within which distances count as equal, m.
    const SAMPLING_TOLERANCE_M: f64 = 0.5 * 6.0 / 400.0;
    const DISTANCE_TOLERANCE_M: f64 = 2e-7;
    let geometry = Geometry::new(&two_bridges());
    let ground = &geometry.terrain.ground;
    let mut random = RandomStream::new(13, "ridges");
    let (mut touching, mut across) = (0, 0);
    for _ in 0..3000 {
        // Long, nearly horizontal capsules above the road crests next to the ends of the arch bridge.
        let (e, n) = (random.range(62.0, 90.0), random.range(-9.0, 9.0));
        let half = Vec3::new(random.normal(), random.normal(), 0.1 * random.normal()).unit() * random.range(0.3, 3.0);
        let middle = Vec3::new(e, n, ground.ground(e, n).0 + random.range(0.0, 0.6));
        let (a_m, b_m, radius_m) = (middle - half, middle + half, random.range(0.005, 0.1));
        let signed = |t: f64| ground.nearest(a_m.lerp(b_m, t), 5.0).map_or(5.0, |n| n.distance_m);
        let tried = (0..=400).map(|k| signed(f64::from(k) / 400.0)).fold(f64::INFINITY, f64::min) - radius_m;
        if tried < -radius_m {
            continue;
        }
        let mut contacts: Vec<Contact> = Vec::new();
        geometry.contacts(&HullProbe::Capsule { a_m, b_m, radius_m }, 0.2, &mut contacts);
        let gaps = contacts.iter().filter(|c| c.surface == Surface::Terrain).map(|c| c.gap_m);
        let deepest = gaps.fold(f64::INFINITY, f64::min);
        if tried < 0.2 - SAMPLING_TOLERANCE_M {
            touching += 1;
            assert!(
                deepest > tried - SAMPLING_TOLERANCE_M && deepest < tried + DISTANCE_TOLERANCE_M,
                "{deepest} m, but {tried} m by sampling"
            );
            across += usize::from(tried < signed(0.0).min(signed(1.0)) - radius_m - 0.01);
        }
    }
    assert!(touching > 200 && across > 50, "{touching}, {across} of them between the ends");
}
