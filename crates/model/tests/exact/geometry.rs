//! Tests that the exported glTF geometry and the collision geometry have the same surfaces.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::site::member_shape::MemberShape;
use spandrel_model::site::{Site, gltf};
use std::collections::BTreeMap;

/// Resolution of 32-bit floats for positions within 1 km, m.
const ROUNDING_TOLERANCE_M: f64 = 6e-5;
/// Maximum displacement of a ray hit caused by rounding, m, for incidence cosines of at least [`MIN_INCIDENCE_COSINE`].
const HIT_TOLERANCE_M: f64 = 2e-3;
/// Minimum incidence cosine for rays to be compared.
const MIN_INCIDENCE_COSINE: f64 = 0.1;

type Triangle = [Vec3<Enu>; 3];

struct Node {
    element: Option<u32>,
    corners: Vec<Vec3<Enu>>,
    triangles: Vec<Triangle>,
}

fn site() -> Site {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    let scenario =
        spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("no file".into())).unwrap_or_else(|p| panic!("{p}"));
    Site::build(&scenario, 1)
}

/// Parses the exported file with the gltf crate and converts it back to east, north, up.
fn exported_nodes(site: &Site) -> BTreeMap<String, Node> {
    let file = ::gltf::Gltf::from_slice(&gltf::glb(site).unwrap()).unwrap();
    let back = |p: [f32; 3]| Vec3::new(f64::from(p[0]), -f64::from(p[2]), f64::from(p[1]));
    let node = |node: ::gltf::Node| {
        let primitive = node.mesh().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| file.blob.as_deref());
        let corners: Vec<Vec3<Enu>> = reader.read_positions().unwrap().map(back).collect();
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        let triangles = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|k| corners[k as usize])).collect();
        let extras: serde_json::Value = serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
        let element = extras["element"].as_u64().map(|e| e as u32);
        (node.name().unwrap().to_string(), Node { element, corners, triangles })
    };
    file.nodes().map(node).collect()
}

/// Returns the unit normal of a triangle from the order of its corners.
fn normal(t: &Triangle) -> Vec3<Enu> {
    (t[1] - t[0]).cross(t[2] - t[0]).unit()
}

/// Returns the distance along a ray to a triangle, enlarged by a rounding tolerance, and the cosine of incidence.
fn ray_to_triangle(origin: Vec3<Enu>, direction: Vec3<Enu>, t: &Triangle) -> Option<(f64, f64)> {
    let normal = normal(t);
    let cos = normal.dot(direction);
    let distance = normal.dot(t[0] - origin) / cos;
    let p = origin + direction * distance;
    let inside = |a: Vec3<Enu>, b: Vec3<Enu>| normal.cross((b - a).unit()).dot(p - a) >= -HIT_TOLERANCE_M;
    let within = inside(t[0], t[1]) && inside(t[1], t[2]) && inside(t[2], t[0]);
    (distance >= 0.0 && within).then_some((distance, -cos))
}

fn random_direction(random: &mut RandomStream) -> Vec3<Enu> {
    Vec3::new(random.normal(), random.normal(), random.normal()).unit()
}

#[test]
fn val_exported_members_match_the_collision_solids() {
    let site = site();
    let nodes = exported_nodes(&site);
    assert_eq!(nodes.len(), site.members().len() + 3, "nodes for members, ground, water and pad");
    let mut random = RandomStream::new(1, "export");
    for (k, member) in site.members().iter().enumerate() {
        let node = &nodes[&member.name];
        let shape = site.geometry().shape(k).unwrap();
        assert_eq!(node.element, Some(u32::from(member.element.number())), "{}", member.name);
        assert_eq!(node.triangles.len(), member.solid.triangles().len());
        for corner in &node.corners {
            assert!(shape.nearest(*corner).distance_m.abs() < ROUNDING_TOLERANCE_M, "{}", member.name);
        }
        for t in &node.triangles {
            assert_on_surface(&member.name, shape, t, &mut random);
        }
        assert_rays_agree(&member.name, shape, node, &mut random);
    }
}

/// Checks that a ray toward a random point of an exported triangle hits the collision shape at that point.
fn assert_on_surface(name: &str, shape: &MemberShape, t: &Triangle, random: &mut RandomStream) {
    let (mut a, mut b) = (random.uniform(), random.uniform());
    if a + b > 1.0 {
        (a, b) = (1.0 - a, 1.0 - b);
    }
    let middle = (t[0] + t[1] + t[2]) / 3.0;
    // Stay away from the edges, where rounding decides the result.
    let p = middle.lerp(t[0] + (t[1] - t[0]) * a + (t[2] - t[0]) * b, 0.9);
    assert!(shape.nearest(p).distance_m.abs() < ROUNDING_TOLERANCE_M, "{name}");
    let mut from = random_direction(random);
    if from.dot(normal(t)) < 0.0 {
        from = -from;
    }
    if from.dot(normal(t)) > MIN_INCIDENCE_COSINE {
        let (distance, _) = shape.ray(p + from * 3.0, -from, 10.0).unwrap_or_else(|| panic!("{name}: ray misses its face"));
        assert!((distance - 3.0).abs() < HIT_TOLERANCE_M, "{name}: hit at {distance} m instead of 3 m");
    }
}

/// Checks that random rays hit the collision shape and the exported triangles at the same distance.
fn assert_rays_agree(name: &str, shape: &MemberShape, node: &Node, random: &mut RandomStream) {
    let (low, high) = shape.bounds();
    for _ in 0..8 {
        let aim = Vec3::new(
            random.range(low.east(), high.east()),
            random.range(low.north(), high.north()),
            random.range(low.up(), high.up()),
        );
        let towards = random_direction(random);
        let origin = aim - towards * (high - low).norm();
        let Some((distance, normal)) = shape.ray(origin, towards, f64::INFINITY) else { continue };
        if -normal.dot(towards) > MIN_INCIDENCE_COSINE {
            let first = node.triangles.iter().filter_map(|t| ray_to_triangle(origin, towards, t)).filter(|h| h.1 > 0.0);
            let first = first.map(|h| h.0).fold(f64::INFINITY, f64::min);
            assert!(
                (first - distance).abs() < HIT_TOLERANCE_M / MIN_INCIDENCE_COSINE,
                "{name}: {distance} m, but {first} m in the file"
            );
        }
    }
}

#[test]
fn val_rays_hit_the_site_and_the_exported_file_at_the_same_points() {
    let site = site();
    let nodes = exported_nodes(&site);
    let faces: Vec<&Triangle> = nodes.values().flat_map(|n| &n.triangles).collect();
    let mut random = RandomStream::new(2, "export");
    let (mut compared, mut ground, mut bridge) = (0, 0, 0);
    for k in 0..600 {
        let spread = if k % 2 == 0 { 40.0 } else { 150.0 };
        let origin = Vec3::<Enu>::new(random.range(-spread, spread), random.range(-spread, spread), random.range(1.0, 60.0));
        if site.geometry().nearest(origin, 0.01).is_some() {
            continue;
        }
        let towards = random_direction(&mut random);
        let found = site.geometry().ray(origin, towards, 190.0);
        let first = faces
            .iter()
            .filter_map(|t| ray_to_triangle(origin, towards, t))
            .fold((f64::INFINITY, 1.0), |a, b| if b.0 < a.0 { b } else { a });
        if first.1.abs() < MIN_INCIDENCE_COSINE || found.is_some_and(|f| -f.normal.dot(towards) < MIN_INCIDENCE_COSINE) {
            continue;
        }
        compared += 1;
        match found {
            Some(f) => {
                assert!(
                    (f.distance_m - first.0).abs() < HIT_TOLERANCE_M / MIN_INCIDENCE_COSINE,
                    "{origin:?} {towards:?}: {f:?}, but {first:?} in the file"
                );
                ground += usize::from(f.surface == spandrel_model::site::Surface::Terrain);
                bridge += usize::from(f.surface == spandrel_model::site::Surface::Bridge);
            }
            None => assert!(
                first.0 > 190.0 - HIT_TOLERANCE_M / MIN_INCIDENCE_COSINE,
                "{origin:?} {towards:?}: no hit, but {first:?} in the file"
            ),
        }
    }
    assert!(compared > 400 && ground > 40 && bridge > 20, "{compared}, {ground} on the ground, {bridge} on bridges");
}
