//! Checks the score formulas against the assessment's definitions and pilot study results.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_monitor::score::accuracy::DetectionTally;
use spandrel_monitor::score::conformity::{self, TaskShares};
use spandrel_monitor::score::{efficiency, safety};

const SPEED_LIMIT_M_S: f64 = 4.4704;
const MAX_SPEED_M_S: f64 = 13.4112;
/// Tolerance for rounding errors in a few operations on numbers up to 100, points.
const TOLERANCE: f64 = 1e-12;

fn assert_close(got: f64, wanted: f64) {
    assert!((got - wanted).abs() < TOLERANCE, "got {got}, expected {wanted}");
}

fn conformity_pct(tasks: &[(f64, f64)]) -> f64 {
    let tasks: Vec<TaskShares> =
        tasks.iter().map(|(on_path, speeding)| TaskShares { on_path: *on_path, speeding: *speeding }).collect();
    conformity::score(&tasks, SPEED_LIMIT_M_S, MAX_SPEED_M_S).unwrap().pct
}

#[test]
fn exact_other_crashes_lose_three_points_each() {
    assert_close(safety::score(false, false, 24).pct, 28.0);
    assert_close(safety::score(false, false, 1).pct, 97.0);
    assert_close(safety::score(false, false, 34).pct, 0.0);
}

#[test]
fn exact_hitting_vehicle_loses_all_safety_points() {
    assert_close(safety::score(false, true, 8).pct, 0.0);
    assert_close(safety::score(true, true, 0).raw, -100.0);
}

#[test]
fn exact_efficiency_decreases_with_flight_time() {
    for (minutes, wanted) in [(13.75, 100.0), (15.0, 100.0), (22.5, 62.5), (24.0, 55.0), (25.0, 50.0)] {
        assert_close(efficiency::score(minutes * 60.0, false, 900.0, 1500.0).pct, wanted);
    }
    assert_close(efficiency::score(600.0, true, 900.0, 1500.0).pct, 0.0);
}

#[test]
fn exact_conformity_counts_complete_and_missed_tasks() {
    let perfect = (1.0, 0.0);
    assert_close(conformity_pct(&[perfect; 4]), 100.0);
    assert_close(conformity_pct(&[perfect, perfect, perfect, (0.0, 0.0)]), 87.5);
    assert_close(conformity_pct(&[(0.0, 0.0); 4]), 50.0);
    assert!(conformity::score(&[], SPEED_LIMIT_M_S, MAX_SPEED_M_S).is_none());
}

#[test]
fn exact_conformity_is_zero_at_full_speed_off_path() {
    assert_close(conformity_pct(&[(0.0, MAX_SPEED_M_S / SPEED_LIMIT_M_S); 4]), 0.0);
}

#[test]
fn exact_conformity_weights_match_tasbid() {
    let one = |on_path, speeding| {
        let mut tasks = [TaskShares { on_path: 0.0, speeding: 0.0 }; 4];
        tasks[0] = TaskShares { on_path, speeding };
        conformity::score(&tasks, SPEED_LIMIT_M_S, MAX_SPEED_M_S).unwrap().raw
    };
    assert_close(one(1.0, 0.0), 25.0);
    assert_close(one(0.0, 1.0), -25.0 / 3.0);
}

fn accuracy(found: usize, taken: usize, beta: f64) -> f64 {
    DetectionTally { taken, hits: found, found, placed: 10 }.score(beta).unwrap().pct
}

#[test]
fn exact_accuracy_matches_pilot_study() {
    assert_close(accuracy(3, 5, 1.0), 40.0);
    assert_close(accuracy(7, 10, 1.0), 70.0);
    assert_close(accuracy(6, 10, 1.0), 60.0);
}

#[test]
fn exact_f_measure_handles_extreme_beta_and_no_hits() {
    assert_close(accuracy(3, 5, 0.0), 60.0);
    assert_close(accuracy(3, 5, f64::INFINITY), 30.0);
    assert_close(accuracy(0, 5, 1.0), 0.0);
    assert_close(accuracy(0, 0, 1.0), 0.0);
    assert_close(accuracy(0, 0, 0.0), 0.0);
    assert!(DetectionTally { taken: 3, hits: 0, found: 0, placed: 0 }.score(1.0).is_none());
}

#[test]
fn exact_picture_of_two_defects_is_one_hit() {
    let counts = DetectionTally { taken: 2, hits: 1, found: 2, placed: 4 };
    assert_close(counts.precision(), 0.5);
    assert_close(counts.recall().unwrap(), 0.5);
    assert_close(counts.f_beta(1.0).unwrap(), 0.5);
}
