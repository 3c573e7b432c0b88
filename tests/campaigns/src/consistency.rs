//! Filter consistency: fifty seeds of one motion, judged by the normalized estimation error squared.

use nalgebra::{DMatrix, DVector};
use spandrel_model::time::SimTime;
use spandrel_sitl::autopilot::estimator::covariance::{P, THETA, V};
use spandrel_testkit::bench::VEHICLES;
use spandrel_testkit::estimator_run::{EstimatorRun, ShadowedPlain, flat};
use spandrel_testkit::shipped::vehicle;

const SEEDS: u64 = 50;

/// Returns the normalized error squared for the states in `from..from + count`.
fn normalized_error(run: &EstimatorRun, from: usize, count: usize) -> f64 {
    let e = run.error();
    let e = DVector::from_fn(count, |i, _| e[from + i]);
    let p = DMatrix::from_fn(count, count, |i, j| run.filter.covariance().at(from + i, from + j));
    p.cholesky().map_or(f64::INFINITY, |c| e.dot(&c.solve(&e)))
}

/// Returns the 95% band for the mean, over `SEEDS` seeds, of a chi-squared variable with `n` degrees of freedom
/// (Wilson-Hilferty).
fn band(n: usize) -> (f64, f64) {
    let k = n as f64 * SEEDS as f64;
    let point = |z: f64| {
        let x = 1.0 - 2.0 / (9.0 * k) + z * (2.0 / (9.0 * k)).sqrt();
        k * x * x * x / SEEDS as f64
    };
    (point(-1.96), point(1.96))
}

/// Checks that the means over all seeds are within their bands at four times, both for all states together and for
/// position, velocity and attitude separately.
fn assert_consistent(what: &str, new: impl Fn(u64, ShadowedPlain) -> EstimatorRun) {
    let times = [5, 20, 40, 60];
    let mut sums = [[0.0; 4]; 4];
    let blocks = [(0, 15), (P, 3), (V, 3), (THETA, 3)];
    for seed in 0..SEEDS {
        let mut run = new(seed, ShadowedPlain { from: SimTime::NEVER, until: SimTime::NEVER, ground_up_m: flat });
        for (row, t) in sums.iter_mut().zip(times) {
            run.run_until(SimTime::from_ms(t * 1000));
            for (sum, (from, count)) in row.iter_mut().zip(blocks) {
                *sum += normalized_error(&run, from, count) / SEEDS as f64;
            }
        }
    }
    let (low, high) = band(15);
    let inside = sums.iter().filter(|row| row[0] > low && row[0] < high).count();
    assert!(inside == times.len(), "{what}, all states: {sums:?}, band {low:.2}..{high:.2}");
    // One block in twelve may be outside its band by chance (probability 0.88 of at most one).
    let (low, high) = band(3);
    let outside = sums.iter().flat_map(|row| &row[1..]).filter(|v| **v < low || **v > high).count();
    assert!(outside <= 1, "{what}, position, velocity, attitude: {sums:?}, band {low:.2}..{high:.2}");
}

#[test]
fn prop_normalized_error_stays_within_its_95_percent_band() {
    assert_consistent("without flow", EstimatorRun::new);
}

#[test]
fn prop_normalized_error_is_within_its_band_for_every_shipped_aircraft() {
    for name in VEHICLES {
        let vehicle = vehicle(name);
        assert!(vehicle.sensors.flow_velocity_m_s > 0.0, "{name} has no optical flow, so the test is pointless");
        assert_consistent(name, |seed, site| EstimatorRun::with_vehicle(seed, site, &vehicle));
    }
}

#[test]
fn prop_error_and_covariance_grow_together_without_gnss_and_then_recover() {
    let (from, until) = (SimTime::from_ms(20_000), SimTime::from_ms(30_000));
    let (mut before, mut blind, mut after) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let mut nees = 0.0;
    for seed in 0..SEEDS {
        let mut run = EstimatorRun::new(seed, ShadowedPlain { from, until, ground_up_m: flat });
        for (t, sums) in [(20_000, &mut before), (29_900, &mut blind), (60_000, &mut after)] {
            run.run_until(SimTime::from_ms(t));
            let e = run.error();
            sums[0] += (e[0] * e[0] + e[1] * e[1]) / SEEDS as f64;
            sums[1] += (run.filter.covariance().variance(P) + run.filter.covariance().variance(P + 1)) / SEEDS as f64;
            nees += if t == 29_900 { normalized_error(&run, 0, 15) / SEEDS as f64 } else { 0.0 };
        }
    }
    let (low, high) = band(15);
    assert!(nees > low && nees < high, "without GNSS: {nees:.2}, band {low:.2}..{high:.2}");
    // The growth must be clearly visible; half a minute after recovery, the covariance must be back within a fifth (as
    // fractions of the variance).
    assert!(blind[0] > 1.5 * before[0] && blind[1] > 1.5 * before[1], "{before:?} {blind:?}");
    assert!(after[0] < blind[0] && after[1] < 1.2 * before[1], "{blind:?} {after:?}");
}
