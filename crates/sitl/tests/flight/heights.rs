//! The sensors that the estimated height follows, depending on EKF2_HGT_REF.

use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::autopilot::operator_rules::HeightReference;
use spandrel_sitl::sensors::Readings;
use spandrel_testkit::estimator_run::{EstimatorRun, flat};

/// Final value of a sensor's slowly growing error, m, and the times at which the growth starts and ends, s.
const FINAL_ERROR_M: f64 = 6.0;
const GROWTH_INTERVAL_S: (f64, f64) = (20.0, 80.0);
/// The height counts as following a sensor if it is within this distance of the sensor's height, m, and as not
/// following it if it includes less than this much of the sensor's error, m (the receiver alone: 0.64 m, 1 sigma).
const FOLLOW_TOLERANCE_M: f64 = 1.5;

fn error_at_m(now: SimTime) -> f64 {
    FINAL_ERROR_M * ((now.s() - GROWTH_INTERVAL_S.0) / (GROWTH_INTERVAL_S.1 - GROWTH_INTERVAL_S.0)).clamp(0.0, 1.0)
}

/// A test case with a slow change in either the readings or the ground.
struct Case {
    reference: HeightReference,
    change: fn(&mut Readings, SimTime),
    ground_up_m: fn(SimTime) -> f64,
    /// Expected final error of the estimated height, m.
    expected_error_m: f64,
}

impl Case {
    /// Returns the error of the estimated height, m, and whether all sensors were used until the end.
    fn height_error_and_sensor_use(&self) -> (f64, bool) {
        let mut run = EstimatorRun::under_open_sky(3, self.ground_up_m);
        run.filter.configured_reference = self.reference;
        let mut used = true;
        while run.now < SimTime::from_s(100.0) {
            run.tick_with(self.change);
            let dropped = run.filter.dropped();
            used &= !dropped.barometer && !dropped.gnss;
        }
        (run.height_error_m(), used)
    }
}

fn no_change(_: &mut Readings, _: SimTime) {}

fn lower_ground(now: SimTime) -> f64 {
    -error_at_m(now)
}

fn raise_barometer(readings: &mut Readings, now: SimTime) {
    readings.baro_up_m = readings.baro_up_m.map(|up| up + error_at_m(now));
}

fn raise_receiver(readings: &mut Readings, now: SimTime) {
    if let Some(fix) = &mut readings.gnss {
        fix.position_m += Vec3::new(0.0, 0.0, -error_at_m(now));
    }
}

#[test]
fn regress_height_estimate_follows_its_reference_sensor() {
    use HeightReference::{Barometer, Gnss, RangeFinder};
    let case = |reference, change, ground_up_m, wanted_m| Case { reference, change, ground_up_m, expected_error_m: wanted_m };
    let cases = [
        case(Barometer, raise_barometer, flat, FINAL_ERROR_M),
        case(Gnss, raise_barometer, flat, 0.0),
        case(Barometer, raise_receiver, flat, 0.0),
        case(RangeFinder, no_change, lower_ground, FINAL_ERROR_M),
        case(RangeFinder, raise_barometer, flat, 0.0),
        case(Gnss, no_change, lower_ground, 0.0),
    ];
    for (k, case) in cases.iter().enumerate() {
        let (off, used) = case.height_error_and_sensor_use();
        assert!(
            (off - case.expected_error_m).abs() < FOLLOW_TOLERANCE_M,
            "case {k}, {:?}: {off} m, not {}",
            case.reference,
            case.expected_error_m
        );
        assert!(used || case.reference == Gnss, "case {k}, {:?}: a sensor was dropped", case.reference);
    }
}

#[test]
fn regress_gnss_replaces_a_lost_height_reference() {
    let silent = |readings: &mut Readings, now: SimTime| {
        raise_barometer(readings, now);
        if now > SimTime::from_s(90.0) {
            readings.baro_up_m = None;
        }
    };
    let mut run = EstimatorRun::under_open_sky(4, flat);
    run.filter.configured_reference = HeightReference::Barometer;
    let mut largest_step: f64 = 0.0;
    let mut before = run.filter.estimate().position_m.down();
    while run.now < SimTime::from_s(400.0) {
        run.tick_with(silent);
        let down = run.filter.estimate().position_m.down();
        if run.now > SimTime::from_s(5.0) {
            largest_step = largest_step.max((down - before).abs());
        }
        before = down;
    }
    assert!(run.height_error_m().abs() < 2.0 * FOLLOW_TOLERANCE_M, "{} m", run.height_error_m());
    assert!(largest_step < 0.5, "{largest_step} m in a tick");
}
