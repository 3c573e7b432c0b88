//! Measures the cost of queries to the site's static geometry at different locations: in open air, near the structure,
//! in the interlayer, and above the ground.

#[path = "support/best.rs"]
mod best;

use best::best;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{Scenario, TaskKind};
use spandrel_model::site::HullProbe;
use spandrel_model::site::geometry::Geometry;
use std::hint::black_box;

const POINT_COUNT: usize = 4000;
const ROUNDS: usize = 9;

fn print_cost<T>(what: &str, points: &[Vec3<Enu>], ask: impl Fn(Vec3<Enu>) -> T) {
    let taken = best(ROUNDS, || {
        points.iter().for_each(|p| {
            black_box(ask(*p));
        })
    });
    println!("{what:<44} {:>8.0} ns", taken.as_secs_f64() * 1e9 / points.len() as f64);
}

/// Returns random points around a polyline.
fn around(path: &[Vec3<Enu>], spread_m: f64, seed: u64) -> Vec<Vec3<Enu>> {
    let mut random = RandomStream::new(seed, "bench");
    let mut jitter = || random.range(-spread_m, spread_m);
    (0..POINT_COUNT).map(|k| path[k % path.len()] + Vec3::new(jitter(), jitter(), jitter())).collect()
}

fn main() {
    let text = include_str!("../scenarios/two-bridges.toml");
    let scenario: Scenario = spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("no file".into()))
        .expect("the shipped scenario must be valid");
    let built = best(ROUNDS, || {
        black_box(Geometry::new(&scenario));
    });
    let geometry = Geometry::new(&scenario);
    println!("{:<44} {:>8.1} ms, {} members", "built in", built.as_secs_f64() * 1e3, geometry.members().len());
    let path =
        |kind: TaskKind| &scenario.tasks.iter().find(|t| t.kind == kind).expect("the job must have a task of each kind").path_m;
    let places = [
        ("in open air", around(&[Vec3::new(0.0, 75.0, 60.0)], 20.0, 1)),
        ("along the slab", around(path(TaskKind::SlabSide), 1.0, 2)),
        ("under the arch", around(path(TaskKind::ArchBottom), 1.0, 3)),
        ("in the interlayer", around(path(TaskKind::Interlayer), 0.7, 4)),
        ("around the pier", around(path(TaskKind::PierCircle), 1.0, 5)),
        ("above the ground", around(&[scenario.ground_team.pad_m + Vec3::new(12.0, 0.0, 3.0)], 2.0, 6)),
    ];
    let diagonal = Vec3::<Enu>::new(1.0, 2.0, -0.5).unit();
    for (place, points) in &places {
        print_cost(&format!("nearest object within 3 m, {place}"), points, |p| geometry.nearest(p, 3.0));
        print_cost(&format!("nearest object within 200 m, {place}"), points, |p| geometry.nearest(p, 200.0));
        print_cost(&format!("30 m ray up, {place}"), points, |p| geometry.ray(p, Vec3::new(0.0, 0.0, 1.0), 30.0));
        print_cost(&format!("30 m ray down, {place}"), points, |p| geometry.ray(p, Vec3::new(0.0, 0.0, -1.0), 30.0));
        print_cost(&format!("200 m diagonal ray, {place}"), points, |p| geometry.ray(p, diagonal, 200.0));
        let mut found = Vec::new();
        let taken = best(ROUNDS, || {
            for p in points {
                found.clear();
                let probe = HullProbe::Capsule { a_m: *p, b_m: *p + Vec3::new(0.15, 0.1, 0.02), radius_m: 0.03 };
                geometry.contacts(&probe, 0.05, &mut found);
                black_box(&found);
            }
        });
        println!("{:<44} {:>8.0} ns", format!("capsule contacts, {place}"), taken.as_secs_f64() * 1e9 / points.len() as f64);
    }
    let deck = around(&[Vec3::new(10.0, 1.0, 34.0)], 0.005, 7);
    print_cost("capsule contacts on the deck", &deck, |p| {
        let mut found = Vec::new();
        let probe =
            HullProbe::Capsule { a_m: p + Vec3::new(0.0, 0.0, 0.03), b_m: p + Vec3::new(0.15, 0.1, 0.03), radius_m: 0.03 };
        geometry.contacts(&probe, 0.05, &mut found);
        found
    });
}
