//! Triangle meshes as collision shapes, compared with the convex solids that fill the same space and with closed-form results.

use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::mesh::Mesh;
use spandrel_model::mesh::surface_mesh::SurfaceMesh;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::Solid;
use spandrel_model::scenario::bridges::solid::{MemberBuilder, Placement};
use spandrel_model::site::HullProbe;
use spandrel_model::site::convex::{Convex, SurfacePoint};
use spandrel_model::site::member_shape::MemberShape;

/// Tolerance for rounding errors at the scale of the test shapes, m.
const ROUNDING_TOLERANCE_M: f64 = 1e-9;
/// Tolerance for the distance of a capsule from its nearest sampled point, m: the samples are 5 mm apart, and a distance near its minimum
/// changes with the square of the position.
const SAMPLING_TOLERANCE_M: f64 = 5e-3;
const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);

/// Cells of a grid that are filled, to make concave solids of boxes.
struct Blocks {
    edges: [Vec<f64>; 3],
    filled: Vec<[usize; 3]>,
}

impl Blocks {
    /// Returns a channel of 10 m along x: a base of 4 m and two walls, 0.5 m thick and 2 m high, open upward.
    fn channel() -> Self {
        let edges = [vec![0.0, 5.0, 10.0], vec![-2.0, -1.5, 1.5, 2.0], vec![0.0, 0.5, 2.0]];
        let filled = (0..2).flat_map(|x| [[x, 0, 0], [x, 1, 0], [x, 2, 0], [x, 0, 1], [x, 2, 1]]).collect();
        Self { edges, filled }
    }

    /// Returns a wall of 6 m x 1 m x 5 m with an opening of 2 m x 2 m through its middle.
    fn wall_with_opening() -> Self {
        let edges = [vec![-3.0, -1.0, 1.0, 3.0], vec![-0.5, 0.5], vec![0.0, 1.5, 3.5, 5.0]];
        let filled = (0..3).flat_map(|x| (0..3).map(move |z| [x, 0, z])).filter(|cell| *cell != [1, 0, 1]).collect();
        Self { edges, filled }
    }

    fn bounds(&self, cell: [usize; 3]) -> [[f64; 3]; 2] {
        [0, 1].map(|end| std::array::from_fn(|axis| self.edges[axis][cell[axis] + end]))
    }

    /// Returns the outer triangles.
    fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        for cell in &self.filled {
            let [low, high] = self.bounds(*cell);
            let block = Mesh::of_box(low, high);
            for triangle in &block.triangles {
                let corners = block.corners(*triangle);
                let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
                let axis = (0..3).find(|k| corners.iter().all(|corner| corner[*k] == corners[0][*k])).unwrap();
                let step = if corners[0][axis] > middle[axis] { 1 } else { -1 };
                let beside = cell[axis].checked_add_signed(step).map(|next| {
                    let mut other = *cell;
                    other[axis] = next;
                    other
                });
                if !beside.is_some_and(|other| self.filled.contains(&other)) {
                    let first = mesh.vertices_m.len() as u32;
                    mesh.vertices_m.extend(corners);
                    mesh.triangles.push([first, first + 1, first + 2]);
                }
            }
        }
        mesh
    }

    fn boxes(&self) -> Vec<Convex> {
        let mut builder = builder();
        for cell in &self.filled {
            let [low, high] = self.bounds(*cell);
            builder.add_box("box", Element::RcDeck, low, high);
        }
        builder.finish().iter().map(|member| Convex::new(&member.solid)).collect()
    }

    fn solid(&self) -> Solid {
        solid(&self.mesh())
    }

    fn shape(&self) -> MemberShape {
        MemberShape::new(&self.solid())
    }
}

fn builder() -> MemberBuilder {
    MemberBuilder::new("t", Placement::new(Vec3::zero(), 90.0))
}

fn solid(mesh: &Mesh) -> Solid {
    let mut builder = builder();
    builder.add_surface("mesh", Element::RcDeck, &SurfaceMesh::new(mesh).unwrap());
    builder.finish().swap_remove(0).solid
}

fn contacts(shape: &MemberShape, probe: HullProbe, margin_m: f64) -> Vec<SurfacePoint> {
    let mut found = Vec::new();
    shape.contacts(&probe, margin_m, |near, _| found.push(near));
    found
}

fn ball(center_m: Vec3<Enu>, radius_m: f64) -> HullProbe {
    HullProbe::Ball { center_m, radius_m }
}

fn random_point(random: &mut RandomStream) -> Vec3<Enu> {
    Vec3::new(random.range(-4.0, 11.0), random.range(-3.5, 3.5), random.range(-1.5, 5.5))
}

#[test]
fn exact_distances_to_a_channel_are_those_to_its_boxes() {
    for blocks in [Blocks::channel(), Blocks::wall_with_opening()] {
        let (shape, boxes) = (blocks.shape(), blocks.boxes());
        let mut random = RandomStream::new(1, "points");
        let mut inside = 0;
        for _ in 0..5000 {
            let p = random_point(&mut random);
            let (near, expected) =
                (shape.nearest(p), boxes.iter().map(|b| b.nearest(p).distance_m).fold(f64::INFINITY, f64::min));
            assert_eq!(near.distance_m < 0.0, expected < 0.0, "{p:?}: {near:?}, {expected}");
            if expected >= 0.0 {
                assert!((near.distance_m - expected).abs() < ROUNDING_TOLERANCE_M, "{p:?}: {near:?}, {expected}");
            } else {
                // The sides between the boxes are no surface, so the surface is at least as far as that of the box.
                assert!(near.distance_m <= expected + ROUNDING_TOLERANCE_M, "{p:?}: {near:?}, {expected}");
                inside += 1;
            }
            assert!((near.point_m + near.normal * near.distance_m - p).norm() < ROUNDING_TOLERANCE_M, "{p:?}: {near:?}");
        }
        assert!(inside > 100, "{inside}");
    }
    let channel = Blocks::channel().shape();
    let near = channel.nearest(Vec3::new(5.0, 0.0, 1.5));
    assert!((near.distance_m - 1.0).abs() < ROUNDING_TOLERANCE_M && (near.normal - UP).norm() < ROUNDING_TOLERANCE_M, "{near:?}");
    assert!((channel.nearest(Vec3::new(5.0, 0.0, 0.2)).distance_m + 0.2).abs() < ROUNDING_TOLERANCE_M);
}

#[test]
fn exact_rays_meet_a_concave_mesh_where_they_meet_its_boxes() {
    const LENGTH_M: f64 = 25.0;
    for blocks in [Blocks::channel(), Blocks::wall_with_opening()] {
        let (shape, boxes) = (blocks.shape(), blocks.boxes());
        let mut random = RandomStream::new(2, "rays");
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..5000 {
            let (origin, target) = (random_point(&mut random), random_point(&mut random));
            let direction = (target - origin).unit();
            let all = boxes.iter().filter_map(|b| b.ray(origin, direction, LENGTH_M));
            let expected = all.min_by(|a, b| a.0.total_cmp(&b.0));
            let found = shape.ray(origin, direction, LENGTH_M);
            assert_eq!(found.is_some(), expected.is_some(), "{origin:?} {direction:?}: {found:?}, {expected:?}");
            if let Some(((at_m, normal), (expected_m, expected_normal))) = found.zip(expected) {
                assert!((at_m - expected_m).abs() < ROUNDING_TOLERANCE_M, "{at_m} {expected_m}");
                assert!((normal - expected_normal).norm() < ROUNDING_TOLERANCE_M, "{normal:?} {expected_normal:?}");
                hits += 1;
            } else {
                misses += 1;
            }
            let length_m: f64 =
                shape.passages(origin, direction, LENGTH_M).iter().map(|(enter_m, leave_m)| leave_m - enter_m).sum();
            let of_box = |shape: &Convex| MemberShape::Convex(shape.clone()).passages(origin, direction, LENGTH_M);
            let boxed_m: f64 = boxes.iter().flat_map(of_box).map(|(enter_m, leave_m)| leave_m - enter_m).sum();
            assert!((length_m - boxed_m).abs() < 1e-7, "{origin:?} {direction:?}: {length_m} {boxed_m}");
        }
        assert!(hits > 1000 && misses > 1000, "{hits} {misses}");
    }
}

#[test]
fn exact_a_ray_inside_starts_at_a_hit_however_far_the_surface_is() {
    let channel = Blocks::channel().shape();
    let along = Vec3::new(1.0, 0.0, 0.0);
    assert_eq!(channel.ray(Vec3::new(1.0, 0.0, 0.25), along, 0.5), Some((0.0, -along)));
    assert_eq!(channel.ray(Vec3::new(1.0, 0.0, 1.0), along, 0.5), None, "in the open part of the bounding box");
}

#[test]
fn exact_a_ray_through_the_edge_of_two_inner_sides_stays_inside() {
    // From the base into a wall, through the edge where the base's upper side meets the wall's inner one.
    let (origin, direction) = (Vec3::new(5.0, 0.5, 0.2), Vec3::new(0.0, 1.0, 0.3).unit());
    let [(enter_m, leave_m)] = Blocks::channel().shape().passages(origin, direction, 10.0)[..] else { panic!("not one passage") };
    assert!(enter_m == 0.0 && (leave_m * direction.north() - 1.5).abs() < ROUNDING_TOLERANCE_M, "{enter_m} to {leave_m}");
}

#[test]
fn exact_a_ball_touches_each_side_of_a_corner_once() {
    let channel = Blocks::channel().shape();
    // Above the middle of the base, where two triangles meet, it has one contact.
    for x in [1.0, 2.5, 5.0] {
        let found = contacts(&channel, ball(Vec3::new(x, 0.0, 0.7), 0.25), 0.01);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].normal - UP).norm() < ROUNDING_TOLERANCE_M && (found[0].distance_m - 0.2).abs() < ROUNDING_TOLERANCE_M);
    }
    // In the corner between the base and a wall.
    let found = contacts(&channel, ball(Vec3::new(3.3, -1.3, 0.7), 0.25), 0.01);
    assert_eq!(found.len(), 2, "{found:?}");
    for (near, normal) in found.iter().zip([UP, Vec3::new(0.0, 1.0, 0.0)]) {
        let is_normal = |normal: Vec3<Enu>| (near.normal - normal).norm() < ROUNDING_TOLERANCE_M;
        assert!(is_normal(normal) || is_normal(UP) || is_normal(Vec3::new(0.0, 1.0, 0.0)), "{near:?}");
        assert!((near.distance_m - 0.2).abs() < ROUNDING_TOLERANCE_M);
    }
    assert!((found[0].normal - found[1].normal).norm() > 1.0);
    // Outside the edge of the base, it touches the edge, and not the two sides behind it.
    let found = contacts(&channel, ball(Vec3::new(3.3, -2.1, -0.1), 0.25), 0.01);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].distance_m - 0.1 * 2f64.sqrt()).abs() < ROUNDING_TOLERANCE_M);
    // Deep inside, the nearest side pushes it out.
    let found = contacts(&channel, ball(Vec3::new(3.3, 0.0, 0.4), 0.25), 0.01);
    assert_eq!(found.len(), 1);
    assert!((found[0].distance_m + 0.1).abs() < ROUNDING_TOLERANCE_M && (found[0].normal - UP).norm() < ROUNDING_TOLERANCE_M);
}

#[test]
fn exact_a_ball_passes_an_opening_that_a_hull_closes() {
    let blocks = Blocks::wall_with_opening();
    let shape = blocks.shape();
    let middle = |y: f64| Vec3::new(0.0, y, 2.5);
    for k in 0..=60 {
        let y = -3.0 + 0.1 * f64::from(k);
        assert!(contacts(&shape, ball(middle(y), 0.9), 0.05).is_empty(), "{y}");
    }
    assert_eq!(contacts(&shape, ball(middle(0.1), 1.0), 0.01).len(), 4, "the four sides of the opening");
    assert_eq!(shape.ray(middle(-5.0), Vec3::new(0.0, 1.0, 0.0), 10.0), None);
    let points: Vec<[f64; 3]> = blocks.mesh().vertices_m;
    let hull = spandrel_model::mesh::hull::hull(&points).unwrap();
    let mut builder = builder();
    builder.add_solid("hull", Element::RcDeck, &hull.corners_m, hull.faces);
    let closed = MemberShape::new(&builder.finish()[0].solid);
    assert!(closed.nearest(middle(0.0)).distance_m < -0.4);
}

#[test]
fn exact_a_capsule_across_the_walls_rests_on_their_edges() {
    let channel = Blocks::channel().shape();
    let level = HullProbe::Capsule { a_m: Vec3::new(4.0, -3.0, 2.1), b_m: Vec3::new(4.0, 3.0, 2.1), radius_m: 0.1 };
    let found = contacts(&channel, level, 0.01);
    let mut edges: Vec<f64> = found.iter().map(|near| near.point_m.north()).collect();
    edges.sort_by(f64::total_cmp);
    assert_eq!(edges.len(), 4, "{found:?}");
    for (edge, expected) in edges.iter().zip([-2.0, -1.5, 1.5, 2.0]) {
        assert!((edge - expected).abs() < ROUNDING_TOLERANCE_M, "{edges:?}");
    }
    for near in &found {
        assert!((near.distance_m - 0.1).abs() < ROUNDING_TOLERANCE_M && (near.normal - UP).norm() < ROUNDING_TOLERANCE_M);
    }
    // Along the base, it touches with both ends only.
    let along = HullProbe::Capsule { a_m: Vec3::new(2.0, 0.3, 0.6), b_m: Vec3::new(8.0, 0.3, 0.6), radius_m: 0.1 };
    assert_eq!(contacts(&channel, along, 0.01).len(), 2);
    // A wall that runs through a capsule pushes it to the nearest side of the wall.
    let pierced = HullProbe::Capsule { a_m: Vec3::new(4.0, -2.4, 1.9), b_m: Vec3::new(4.0, -1.2, 1.9), radius_m: 0.02 };
    let found = contacts(&channel, pierced, 0.01);
    assert!(
        found.iter().any(|near| (near.distance_m + 0.1).abs() < ROUNDING_TOLERANCE_M && near.normal.up() > 0.99),
        "{found:?}"
    );
}

#[test]
fn prop_contacts_of_capsules_contain_the_nearest_point() {
    const MARGIN_M: f64 = 0.3;
    const RADIUS_M: f64 = 0.1;
    for blocks in [Blocks::channel(), Blocks::wall_with_opening()] {
        let shape = blocks.shape();
        let mut random = RandomStream::new(3, "capsules");
        let mut touching = 0;
        for _ in 0..3000 {
            let a_m = random_point(&mut random);
            let b_m = a_m + Vec3::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0), random.range(-1.0, 1.0));
            let samples = (0..=400).map(|k| shape.nearest(a_m.lerp(b_m, f64::from(k) / 400.0)).distance_m);
            let least_m = samples.fold(f64::INFINITY, f64::min);
            let found = contacts(&shape, HullProbe::Capsule { a_m, b_m, radius_m: RADIUS_M }, MARGIN_M);
            let nearest_m = found.iter().map(|near| near.distance_m).fold(f64::INFINITY, f64::min);
            if least_m > RADIUS_M + MARGIN_M {
                assert!(found.is_empty(), "{a_m:?} {b_m:?}: {found:?}");
            } else if least_m > 0.0 {
                assert!(nearest_m <= least_m + ROUNDING_TOLERANCE_M, "{a_m:?} {b_m:?}: {nearest_m} {least_m}");
                assert!(nearest_m >= least_m - SAMPLING_TOLERANCE_M, "{a_m:?} {b_m:?}: {nearest_m} {least_m}");
                touching += 1;
            } else {
                assert!(nearest_m <= 0.0 || least_m > -SAMPLING_TOLERANCE_M, "{a_m:?} {b_m:?}: {nearest_m} {least_m}");
            }
        }
        assert!(touching > 100, "{touching}");
    }
}

#[test]
fn exact_an_open_surface_has_two_sides() {
    // The channel without its underside.
    let mut mesh = Blocks::channel().mesh();
    let corners = mesh.vertices_m.clone();
    mesh.triangles.retain(|triangle| triangle.iter().any(|k| corners[*k as usize][2] > 0.0));
    let solid = solid(&mesh);
    assert!(!solid.surface.as_ref().unwrap().is_closed);
    let shape = MemberShape::new(&solid);
    for (up_m, normal) in [(0.7, UP), (0.3, -UP)] {
        let p = Vec3::new(4.2, 0.1, up_m);
        let near = shape.nearest(p);
        assert!((near.distance_m - 0.2).abs() < ROUNDING_TOLERANCE_M && (near.normal - normal).norm() < ROUNDING_TOLERANCE_M);
        let found = contacts(&shape, ball(p, 0.25), 0.01);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].normal - normal).norm() < ROUNDING_TOLERANCE_M);
        let (at_m, facing) = shape.ray(p, -normal, 3.0).unwrap();
        assert!((at_m - 0.2).abs() < ROUNDING_TOLERANCE_M && (facing - normal).norm() < ROUNDING_TOLERANCE_M);
    }
}

#[test]
fn exact_results_have_the_same_bits_every_time() {
    let bits = |v: Vec3<Enu>| v.array().map(f64::to_bits);
    let run = || {
        let shape = Blocks::wall_with_opening().shape();
        let mut random = RandomStream::new(4, "bits");
        let mut all = Vec::new();
        for _ in 0..500 {
            let (a_m, b_m) = (random_point(&mut random), random_point(&mut random));
            let near = shape.nearest(a_m);
            all.push((near.distance_m.to_bits(), bits(near.point_m)));
            all.extend(shape.ray(a_m, (b_m - a_m).unit(), 30.0).map(|(at_m, normal)| (at_m.to_bits(), bits(normal))));
            let probe = HullProbe::Capsule { a_m, b_m: a_m.lerp(b_m, 0.1), radius_m: 0.1 };
            all.extend(contacts(&shape, probe, 0.5).iter().map(|near| (near.distance_m.to_bits(), bits(near.point_m))));
        }
        all
    };
    assert_eq!(run(), run());
}
