//! A long recorded inspection of the TASBID job: each reference path in both directions, with photos at regular
//! intervals.

use crate::job::Tape;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;

/// Returns the TASBID job.
pub fn two_bridges() -> Scenario {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("none".into())).unwrap()
}

/// Returns the aircraft used in the TASBID job.
pub fn phantom() -> spandrel_model::vehicle::Vehicle {
    spandrel_model::vehicle::read("phantom2.toml", spandrel_model::shipped::PHANTOM2).unwrap()
}

/// Flies the tasks in turn, with the camera in the paths' viewing directions, until `seconds` have passed. Then lands
/// on the pad.
pub fn record_inspection(job: &Scenario, seconds: f64, picture_every: usize) -> Tape {
    let mut tape = Tape::of(job);
    let pad = job.ground_team.pad_m;
    tape.fly(tuple(pad + Vec3::new(0.0, 0.0, 15.0)), 2.0);
    let (mut lap, mut points, mut pictures) = (0, 0, 0);
    'laps: loop {
        for task in &job.tasks {
            let mut stations: Vec<(Vec3<Enu>, Vec3<Enu>)> =
                task.path_m.iter().copied().zip(task.viewing_directions.iter().copied()).collect();
            if lap % 2 == 1 {
                stations.reverse();
            }
            tape.lamp(task.dark);
            for (at, look) in stations {
                if f64::from(tape.now_ms) > 1000.0 * (seconds - 90.0) {
                    break 'laps;
                }
                tape.yaw_rad = math::atan2(look.east(), look.north());
                tape.gimbal(math::asin(look.up().clamp(-1.0, 1.0)));
                // Simulated pilot deviations, the same in every run.
                let wander = Vec3::new(0.4 * math::sin(0.7 * f64::from(points)), 0.4 * math::cos(0.9 * f64::from(points)), 0.2);
                tape.fly(tuple(at + wander), 1.5 + 3.5 * f64::from(points % 7) / 6.0);
                tape.clearance(2.0 + (points % 11) as f32 * 0.4);
                if points % picture_every as i32 == 0 {
                    tape.snapshot(pictures);
                    tape.hold(0.1);
                    pictures += 1;
                }
                points += 1;
            }
        }
        lap += 1;
    }
    tape.fly(tuple(pad + Vec3::new(0.0, 0.0, 5.0)), 8.0);
    tape.fly(tuple(pad + Vec3::new(0.0, 0.0, 0.15)), 0.8);
    tape.hold(3.5);
    tape.armed(false);
    tape.hold(1.0);
    tape
}

fn tuple(point: Vec3<Enu>) -> (f64, f64, f64) {
    (point.east(), point.north(), point.up())
}
