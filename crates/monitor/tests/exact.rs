//! Checks the score formulas against reference values: the assessment's definitions and results from the pilot study.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_monitor::score::accuracy::MatchCounts;
use spandrel_monitor::score::conformity::{self, TaskShares};
use spandrel_monitor::score::{efficiency, safety};

const LIMIT_M_S: f64 = 4.4704;
const MAX_M_S: f64 = 13.4112;
/// Tolerance for the rounding error of a few operations on numbers up to 100, points.
const ROUNDING: f64 = 1e-12;

fn check(got: f64, wanted: f64) {
    assert!((got - wanted).abs() < ROUNDING, "got {got}, wanted {wanted}");
}

fn conformity_pct(tasks: &[(f64, f64)]) -> f64 {
    let tasks: Vec<TaskShares> =
        tasks.iter().map(|(on_path, speeding)| TaskShares { on_path: *on_path, speeding: *speeding }).collect();
    conformity::score(&tasks, LIMIT_M_S, MAX_M_S).unwrap().pct
}

#[test]
fn exact_other_crashes_cost_three_points_each() {
    check(safety::score(false, false, 24).pct, 28.0);
    check(safety::score(false, false, 1).pct, 97.0);
    check(safety::score(false, false, 34).pct, 0.0);
}

#[test]
fn exact_eight_other_crashes_and_a_vehicle_leave_nothing() {
    check(safety::score(false, true, 8).pct, 0.0);
    check(safety::score(true, true, 0).raw, -100.0);
}

#[test]
fn exact_efficiency_follows_the_clock() {
    for (minutes, wanted) in [(13.75, 100.0), (15.0, 100.0), (22.5, 62.5), (24.0, 55.0), (25.0, 50.0)] {
        check(efficiency::score(minutes * 60.0, false, 900.0, 1500.0).pct, wanted);
    }
    check(efficiency::score(600.0, true, 900.0, 1500.0).pct, 0.0);
}

#[test]
fn exact_conformity_of_whole_tasks() {
    let perfect = (1.0, 0.0);
    check(conformity_pct(&[perfect; 4]), 100.0);
    check(conformity_pct(&[perfect, perfect, perfect, (0.0, 0.0)]), 87.5);
    check(conformity_pct(&[(0.0, 0.0); 4]), 50.0);
    assert!(conformity::score(&[], LIMIT_M_S, MAX_M_S).is_none());
}

#[test]
fn exact_conformity_is_least_at_full_speed_off_every_path() {
    check(conformity_pct(&[(0.0, MAX_M_S / LIMIT_M_S); 4]), 0.0);
}

#[test]
fn exact_the_weights_are_25_and_minus_25_thirds_in_the_papers_job() {
    let one = |on_path, speeding| {
        let mut tasks = [TaskShares { on_path: 0.0, speeding: 0.0 }; 4];
        tasks[0] = TaskShares { on_path, speeding };
        conformity::score(&tasks, LIMIT_M_S, MAX_M_S).unwrap().raw
    };
    check(one(1.0, 0.0), 25.0);
    check(one(0.0, 1.0), -25.0 / 3.0);
}

fn accuracy(found: usize, taken: usize, beta: f64) -> f64 {
    MatchCounts { taken, hits: found, found, placed: 10 }.score(beta).unwrap().pct
}

#[test]
fn exact_accuracy_of_the_pilot_study() {
    check(accuracy(3, 5, 1.0), 40.0);
    check(accuracy(7, 10, 1.0), 70.0);
    check(accuracy(6, 10, 1.0), 60.0);
}

#[test]
fn exact_the_f_measure_at_its_ends() {
    check(accuracy(3, 5, 0.0), 60.0);
    check(accuracy(3, 5, f64::INFINITY), 30.0);
    check(accuracy(0, 5, 1.0), 0.0);
    check(accuracy(0, 0, 1.0), 0.0);
    check(accuracy(0, 0, 0.0), 0.0);
    assert!(MatchCounts { taken: 3, hits: 0, found: 0, placed: 0 }.score(1.0).is_none());
}

#[test]
fn exact_one_picture_of_two_defects_is_one_hit_and_two_finds() {
    let counts = MatchCounts { taken: 2, hits: 1, found: 2, placed: 4 };
    check(counts.precision(), 0.5);
    check(counts.recall().unwrap(), 0.5);
    check(counts.f_beta(1.0).unwrap(), 0.5);
}
