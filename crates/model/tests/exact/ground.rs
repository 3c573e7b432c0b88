//! Tests of ground queries (nearest points, rays, contacts) against brute-force searches over all triangles.

use super::site::distance_to_triangle;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::site::heights::HeightGrid;

/// Tolerance for rounding errors at the scale of the test grid, m.
const ROUNDING_TOLERANCE_M: f64 = 1e-9;

/// Returns a rough height grid of 20 x 20 cells, each 5 m wide.
fn rough_grid() -> HeightGrid {
    let mut random = RandomStream::new(9, "rough");
    HeightGrid::new((0..21 * 21).map(|_| random.range(-6.0, 6.0)).collect(), 5.0)
}

#[test]
fn prop_nearest_ground_point_matches_brute_force() {
    let grid = rough_grid();
    let (corners, triangles) = grid.triangles();
    let mut random = RandomStream::new(3, "points");
    for _ in 0..1500 {
        let p = Vec3::new(random.range(-40.0, 40.0), random.range(-40.0, 40.0), random.range(-12.0, 12.0));
        let brute =
            triangles.iter().map(|t| distance_to_triangle(p, &t.map(|k| corners[k as usize]))).fold(f64::INFINITY, f64::min);
        let near = grid.nearest(p, f64::INFINITY).unwrap();
        assert!((near.distance_m.abs() - brute).abs() < ROUNDING_TOLERANCE_M, "{p:?}: {} against {brute}", near.distance_m);
        assert_eq!(near.distance_m < 0.0, p.up() < grid.ground(p.east(), p.north()).0);
        assert!((near.point_m + near.normal * near.distance_m - p).norm() < ROUNDING_TOLERANCE_M);
        let capped = grid.nearest(p, 2.0);
        assert_eq!(capped.is_some(), near.distance_m <= 2.0);
        assert!(capped.is_none_or(|c| (c.distance_m - near.distance_m).abs() < ROUNDING_TOLERANCE_M));
    }
}

#[test]
fn prop_segments_are_nearest_to_the_ground_at_ends_or_creases() {
    // Half the sample point spacing, m.
    const SAMPLING_TOLERANCE_M: f64 = 0.5 * 4.0 / 400.0;
    let grid = rough_grid();
    let mut random = RandomStream::new(6, "segments");
    let mut across = 0;
    for _ in 0..2000 {
        let a = Vec3::new(random.range(-40.0, 40.0), random.range(-40.0, 40.0), random.range(-4.0, 8.0));
        let b = a + Vec3::new(random.normal(), random.normal(), 0.5 * random.normal()).unit() * random.range(0.2, 4.0);
        let signed = |t: f64| grid.nearest(a.lerp(b, t), f64::INFINITY).map_or(f64::INFINITY, |n| n.distance_m);
        let ends = signed(0.0).min(signed(1.0));
        let tried = (0..=400).map(|k| signed(f64::from(k) / 400.0)).fold(f64::INFINITY, f64::min);
        // Segments below the ground are skipped: their result is the depth of the deepest crease, not of the deepest point.
        if ends < 0.0 || tried < 0.0 {
            continue;
        }
        let between = grid.interior_minimum(a, b, ends, 2.0);
        across += usize::from(between.is_some());
        let least = between.map_or(ends, |n| n.distance_m);
        assert!(
            least > tried - SAMPLING_TOLERANCE_M && (least < tried + 1e-6 || tried > 2.0),
            "{least} m, but {tried} m by sampling"
        );
        if let Some(near) = between {
            assert!((near.point_m.up() - grid.ground(near.point_m.east(), near.point_m.north()).0).abs() < ROUNDING_TOLERANCE_M);
            assert!((near.normal.norm() - 1.0).abs() < ROUNDING_TOLERANCE_M && near.normal.up() > 0.0);
        }
    }
    assert!(across > 30, "{across}");
}

#[test]
fn exact_rod_across_a_ridge_touches_the_ridge() {
    // A ridge 1 m high along the middle column of the grid, with slopes of 1 in 4.
    let heights = (0..9).map(|k| if k % 3 == 1 { 1.0 } else { 0.0 }).collect();
    let grid = HeightGrid::new(heights, 4.0);
    let rod = |up: f64| (Vec3::new(-1.0, 0.3, up), Vec3::new(1.0, 0.3, up));
    for (up, gap) in [(1.2, 0.2), (0.9, -0.1)] {
        let (a, b) = rod(up);
        let near = grid.interior_minimum(a, b, f64::INFINITY, 0.5).unwrap();
        assert!(
            (near.distance_m - gap).abs() < ROUNDING_TOLERANCE_M && (near.normal.up() - 1.0).abs() < ROUNDING_TOLERANCE_M,
            "{near:?}"
        );
        assert!((near.point_m - Vec3::new(0.0, 0.3, 1.0)).norm() < ROUNDING_TOLERANCE_M);
    }
}

#[test]
fn prop_ground_reported_below_a_height_is_below_it() {
    let grid = rough_grid();
    let mut random = RandomStream::new(7, "under");
    let mut certain = 0;
    for _ in 0..500 {
        let low = Vec3::new(random.range(-60.0, 60.0), random.range(-60.0, 60.0), 0.0);
        let high = low + Vec3::new(random.range(0.0, 3.0), random.range(0.0, 3.0), 0.0);
        let up = random.range(-4.0, 8.0);
        if grid.is_below(low, high, up) {
            certain += 1;
            let at = |k: u32, l: u32| {
                let share = |n: u32, a: f64, b: f64| a + (b - a) * f64::from(n) / 20.0;
                grid.ground(share(k, low.east(), high.east()), share(l, low.north(), high.north())).0
            };
            assert!((0..=20).all(|k| (0..=20).all(|l| at(k, l) < up)));
        }
    }
    assert!(certain > 100, "{certain}");
}

#[test]
fn prop_rays_never_pass_through_a_thin_ridge() {
    // One row of corners is raised to form a ridge that is one cell wide on each side. Some of the rays pass through its corners.
    let heights = (0..81 * 81).map(|k| if k / 81 == 40 { 3.0 } else { 0.0 }).collect();
    let grid = HeightGrid::new(heights, 1.0);
    let mut random = RandomStream::new(8, "blade");
    for k in 0..4000 {
        let aim = Vec3::<Enu>::new(random.range(-30.0, 30.0), 0.0, random.range(0.01, 2.99));
        let aim = if k % 4 == 0 { Vec3::new(aim.east().round(), 0.0, aim.up()) } else { aim };
        let from = Vec3::new(random.range(-39.0, 39.0), random.range(3.0, 39.0), random.range(0.5, 30.0));
        let direction = (aim - from).unit();
        let far = (aim - from).norm();
        let (t, _) = grid.ray(from, direction, 200.0).unwrap();
        assert!(t <= far, "{from:?} to {aim:?} hit at {t} m, beyond {far} m");
    }
}

#[test]
fn prop_rays_end_at_the_first_ground_hit() {
    let grid = rough_grid();
    let mut random = RandomStream::new(5, "rays");
    let over = |p: Vec3<Enu>| p.up() - grid.ground(p.east(), p.north()).0;
    let mut hits = 0;
    for _ in 0..1500 {
        // Some rays start or end outside the grid.
        let origin = Vec3::new(random.range(-70.0, 70.0), random.range(-70.0, 70.0), random.range(-3.0, 15.0));
        let direction = Vec3::new(random.normal(), random.normal(), 0.4 * random.normal()).unit();
        let hit = grid.ray(origin, direction, 120.0);
        let reach = hit.map_or(120.0, |h| h.0);
        if let Some((t, normal)) = hit.filter(|h| h.0 > 0.0) {
            hits += 1;
            assert!(over(origin + direction * t).abs() < ROUNDING_TOLERANCE_M);
            assert!(normal.dot(direction) < 0.0);
        }
        let clear =
            (0..2000).map(|k| reach * f64::from(k) / 2000.0).all(|t| over(origin + direction * t) > -ROUNDING_TOLERANCE_M);
        assert!(clear || reach == 0.0, "{origin:?} {direction:?}");
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn exact_vertical_and_horizontal_rays_hit_the_ground() {
    let grid = HeightGrid::new(vec![2.0; 9], 10.0);
    let down = grid.ray(Vec3::new(1.0, 2.0, 7.0), Vec3::new(0.0, 0.0, -1.0), 50.0).unwrap();
    assert!((down.0 - 5.0).abs() < ROUNDING_TOLERANCE_M && down.1 == Vec3::new(0.0, 0.0, 1.0));
    assert_eq!(grid.ray(Vec3::new(1.0, 2.0, 7.0), Vec3::new(0.0, 0.0, 1.0), 50.0), None);
    assert_eq!(grid.ray(Vec3::new(1.0, 2.0, 7.0), Vec3::new(1.0, 0.0, 0.0), f64::INFINITY), None);
    assert_eq!(grid.ray(Vec3::new(1.0, 2.0, 7.0), Vec3::new(0.0, 0.0, -1.0), 4.9), None);
    let below = grid.ray(Vec3::new(1.0, 2.0, 1.0), Vec3::new(0.0, 0.0, 1.0), 50.0).unwrap();
    assert_eq!(below.0, 0.0);
}

#[test]
fn exact_nearly_horizontal_rays_high_above_the_ground_miss() {
    let grid = rough_grid();
    // The rays reach the maximum ground height so far away that cell indices would overflow.
    for fall in [1e-12, 1e-19, 1e-300] {
        let sideways = Vec3::new(1.0, 1e-3, -fall);
        assert!(grid.ray(Vec3::new(0.0, 0.0, 40.0), sideways, 10.0).is_none(), "{fall}");
    }
}
