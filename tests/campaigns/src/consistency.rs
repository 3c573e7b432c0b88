//! Accuracy of the filter and of what it claims about it: fifty seeds of one motion.

use nalgebra::{DMatrix, DVector};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::autopilot::estimator::covariance::{P, THETA, V};
use spandrel_testkit::bench::VEHICLES;
use spandrel_testkit::estimator_run::{EstimatorRun, ShadowedPlain, flat};
use spandrel_testkit::shipped::vehicle;

const SEEDS: u64 = 50;
/// Largest root mean square of the position error, relative to the receiver's accuracy: a third more than the receiver's own for chance (50
/// seeds: one standard error is 10%).
const MAX_ERROR: f64 = 1.33;

/// Returns the normalized error squared for the states in `from..from + count`.
fn normalized_error(run: &EstimatorRun, from: usize, count: usize) -> f64 {
    let e = run.error();
    let e = DVector::from_fn(count, |i, _| e[from + i]);
    let p = DMatrix::from_fn(count, count, |i, j| run.filter.covariance().at(from + i, from + j));
    p.cholesky().map_or(f64::INFINITY, |c| e.dot(&c.solve(&e)))
}

/// Returns the upper end of the 95% band for the mean, over `SEEDS` seeds, of a chi-squared variable with `n` degrees of freedom
/// (Wilson-Hilferty).
fn upper_end(n: usize) -> f64 {
    let k = n as f64 * SEEDS as f64;
    let x = 1.0 - 2.0 / (9.0 * k) + 1.96 * (2.0 / (9.0 * k)).sqrt();
    k * x * x * x / SEEDS as f64
}

/// Checks at four times that the filter is not overconfident about velocity and attitude, and that its position is as accurate as the receiver's
/// data sheet says. It does not model the slow errors of the receiver, so its own claim about the position is smaller.
fn assert_trustworthy(what: &str, aircraft: &Vehicle, new: impl Fn(u64, ShadowedPlain) -> EstimatorRun) {
    let accuracies_m = [aircraft.sensors.gnss_horizontal_noise_m, aircraft.sensors.gnss_vertical_noise_m];
    let times = [5, 20, 40, 60];
    let mut squares = [[0.0; 2]; 4];
    let mut normalized = [[0.0; 2]; 4];
    for seed in 0..SEEDS {
        let mut run = new(seed, ShadowedPlain { from: SimTime::NEVER, until: SimTime::NEVER, ground_up_m: flat });
        for (k, t) in times.into_iter().enumerate() {
            run.run_until(SimTime::from_ms(t * 1000));
            let e = run.error();
            squares[k][0] += (e[P] * e[P] + e[P + 1] * e[P + 1]) / (2.0 * SEEDS as f64);
            squares[k][1] += e[P + 2] * e[P + 2] / SEEDS as f64;
            normalized[k][0] += normalized_error(&run, V, 3) / SEEDS as f64;
            normalized[k][1] += normalized_error(&run, THETA, 3) / SEEDS as f64;
        }
    }
    let high = upper_end(3);
    assert!(
        normalized.iter().flatten().all(|mean| *mean < high),
        "{what}, velocity and attitude: {normalized:?}, at most {high:.2}"
    );
    let worse = |(square, accuracy_m): (&f64, &f64)| square.sqrt() > MAX_ERROR * accuracy_m;
    assert!(!squares.iter().any(|row| row.iter().zip(&accuracies_m).any(worse)), "{what}: {squares:?} m², {accuracies_m:?} m");
}

#[test]
fn prop_errors_stay_within_the_filters_claims_and_the_receivers_accuracy() {
    assert_trustworthy("without flow", &vehicle("phantom2"), EstimatorRun::new);
}

#[test]
fn prop_errors_stay_within_the_claims_for_every_shipped_aircraft() {
    for name in VEHICLES {
        let vehicle = vehicle(name);
        assert!(vehicle.sensors.flow_velocity_m_s > 0.0, "{name} has no optical flow, so the test is pointless");
        assert_trustworthy(name, &vehicle, |seed, site| EstimatorRun::with_vehicle(seed, site, &vehicle));
    }
}

#[test]
fn prop_error_and_covariance_grow_together_without_gnss_and_then_recover() {
    let (from, until) = (SimTime::from_ms(20_000), SimTime::from_ms(30_000));
    let (mut before, mut blind, mut after) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for seed in 0..SEEDS {
        let mut run = EstimatorRun::new(seed, ShadowedPlain { from, until, ground_up_m: flat });
        for (t, sums) in [(20_000, &mut before), (29_900, &mut blind), (60_000, &mut after)] {
            run.run_until(SimTime::from_ms(t));
            let e = run.error();
            sums[0] += (e[0] * e[0] + e[1] * e[1]) / SEEDS as f64;
            sums[1] += (run.filter.covariance().variance(P) + run.filter.covariance().variance(P + 1)) / SEEDS as f64;
        }
    }
    // The growth must be clearly visible; half a minute after recovery, at most a twentieth of the variance may be left.
    assert!(blind[0] > 1.5 * before[0] && blind[1] > 1.5 * before[1], "{before:?} {blind:?}");
    assert!(after[0] < blind[0] && after[1] < 0.05 * blind[1], "{blind:?} {after:?}");
}
