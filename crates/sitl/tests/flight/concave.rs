//! Flights at an imported part that is not convex: a wall with a round opening, whose hull would be closed.

use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::mesh::part_shapes::{ConcaveShape, Method, ShapeLimits};
use spandrel_model::mesh::reader::ModelFormat;
use spandrel_model::mesh::voxel_surface::CloudLimits;
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;
use spandrel_model::scenario::{Bridge, BridgeKind, Scenario};
use spandrel_model::site::bridge_import::{ImportOptions, ImportSource, ModelOrigin, UpAxis, import};
use spandrel_model::site::{Site, Surface};
use spandrel_testkit::bench::Bench;
use spandrel_testkit::shipped::{scenario, vehicle};
use std::fmt::Write;

/// Half the side of the square wall, and its height, m.
const HALF_SIDE_M: f64 = 7.0;
/// Radius of the opening, m.
const OPENING_RADIUS_M: f64 = 3.5;
const THICKNESS_M: f64 = 1.0;
/// Number of sides of the opening: too many to cut the wall into convex parts along them.
const SIDES: usize = 800;
/// Position of the wall's middle, m north of the pad.
const WALL_NORTH_M: f64 = 10.0;
/// Position tolerance, m: receiver and control errors.
const POSITION_TOLERANCE_M: f64 = 1.5;

/// Returns the wall as an OBJ file: x to the right, y through the wall, z up.
fn wall_obj() -> String {
    let mut text = String::from("o wall\n");
    for y in [-0.5 * THICKNESS_M, 0.5 * THICKNESS_M] {
        for k in 0..SIDES {
            let (s, c) = math::sin_cos(math::TAU * k as f64 / SIDES as f64);
            let to_square = HALF_SIDE_M / s.abs().max(c.abs());
            for radius in [OPENING_RADIUS_M, to_square] {
                let _ = writeln!(text, "v {:.9} {y:.9} {:.9}", radius * c, HALF_SIDE_M + radius * s);
            }
        }
    }
    // Vertices count from 1: inner and outer ones by turns, first of the side at -y.
    let number = |side: usize, k: usize, outer: usize| 1 + 2 * (side * SIDES + k % SIDES) + outer;
    for k in 0..SIDES {
        let [near, far] = [0, 1].map(|side| [(k, 0), (k, 1), (k + 1, 1), (k + 1, 0)].map(|(k, outer)| number(side, k, outer)));
        for [a, b, c, d] in
            [near, [far[3], far[2], far[1], far[0]], [near[0], near[3], far[3], far[0]], [near[1], far[1], far[2], near[2]]]
        {
            let _ = writeln!(text, "f {a} {b} {c} {d}");
        }
    }
    text
}

fn site(text: &str) -> Site {
    let options = ImportOptions {
        name: "wall".into(),
        scale: 1.0,
        up: UpAxis::Z,
        origin: ModelOrigin::Center,
        turn_deg: 0.0,
        default_element: Some(Element::RcPierWall),
        limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
        cloud: CloudLimits::default(),
    };
    let none = |_: &str| Err("no file".to_owned());
    let elements = ElementMap::default();
    let source = ImportSource { file: "wall.obj", format: ModelFormat::Obj, bytes: text.as_bytes(), load: &none, elements };
    let imported = import(&source, &options).unwrap();
    let part = &imported.report.parts[0];
    assert_eq!((part.method, part.shapes, part.open_edges), (Some(Method::Mesh), 1, 0));
    let model = Model::read("bridge.glb", &imported.model, &ElementMap::default()).unwrap();
    let center_m = Vec3::new(0.0, WALL_NORTH_M, 2.0 * HALF_SIDE_M);
    let bridge = Bridge { name: "wall".into(), center_m, heading_deg: 90.0, kind: BridgeKind::Model(model) };
    Site::without_defects(&Scenario { bridges: vec![bridge], ..scenario("drill-hover") })
}

#[test]
fn flight_through_an_opening_that_a_hull_would_close_and_against_the_wall_above_it() {
    let text = wall_obj();
    let mut bench = Bench::new(&vehicle("m30"), 4);
    bench.site = site(&text);
    let middle = Vec3::<Enu>::new(0.0, WALL_NORTH_M, HALF_SIDE_M);
    let free_m = bench.site.geometry().nearest_member(middle, 10.0).unwrap().distance_m;
    assert!((free_m - OPENING_RADIUS_M).abs() < 1e-3, "{free_m}");
    bench.take_off(HALF_SIDE_M);
    bench.go_to(20.0, 0.0, HALF_SIDE_M);
    let (mut touched, mut nearest_m) = (None, f64::INFINITY);
    bench.run(30.0, |b| {
        touched = touched.or(b.state.contact.surface);
        let clearance = b.site.geometry().nearest_member(b.position().enu(), 10.0).map_or(10.0, |near| near.distance_m);
        nearest_m = nearest_m.min(clearance);
    });
    assert_eq!(touched, None);
    assert!((bench.position().north() - 20.0).abs() < POSITION_TOLERANCE_M, "{:?}", bench.position());
    assert!((OPENING_RADIUS_M - POSITION_TOLERANCE_M..OPENING_RADIUS_M).contains(&nearest_m), "{nearest_m} m from the opening");
    // Back above the opening, the wall is in the way: the drone slides down along it, at most as far as the opening.
    let above_m = HALF_SIDE_M + 0.5 * (HALF_SIDE_M + OPENING_RADIUS_M);
    bench.go_to(20.0, 0.0, above_m);
    bench.run(15.0, |_| ());
    bench.go_to(0.0, 0.0, above_m);
    let (mut hit, mut through_m) = (None, None);
    bench.run(15.0, |b| {
        hit = hit.or(b.state.contact.surface);
        let at = b.position().enu();
        if at.north() < WALL_NORTH_M {
            through_m.get_or_insert(math::hypot(at.east(), at.up() - HALF_SIDE_M));
        }
    });
    assert_eq!(hit.map(|(surface, _)| surface), Some(Surface::Bridge));
    assert!(through_m.is_none_or(|radius_m| radius_m < OPENING_RADIUS_M), "{through_m:?} m from the middle of the opening");
}
