//! Sensors that repeat their last value or drift, with the fault injected in flight. `tests/campaigns` combines every
//! aircraft with every such fault.

use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::autopilot::FlightMode;
use spandrel_sitl::faults::{FailureType, FailureUnit};
use spandrel_sitl::sensors::Readings;
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Height tolerance, m: without its barometer, the vehicle holds its height with GNSS alone, which drifts by 0.64 m (1
/// sigma).
const HEIGHT_TOLERANCE_M: f64 = 2.5;
#[test]
fn regress_stuck_barometer_is_announced_and_the_climb_is_correct() {
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 20, 4.0);
        bench.take_texts();
        bench.go_to(0.0, 0.0, 12.0);
        bench.run(1.5, |_| ());
        assert!(bench.faults.inject(FailureUnit::Barometer, Some(FailureType::Stuck), 0, 4));
        let mut highest: f64 = 0.0;
        bench.run(60.0, |b| highest = highest.max(-b.position().down()));
        let texts = bench.take_texts();
        assert!(
            (highest - 12.0).abs() < HEIGHT_TOLERANCE_M && (bench.position().down() + 12.0).abs() < HEIGHT_TOLERANCE_M,
            "{name}: {highest} m"
        );
        assert!(texts.iter().any(|text| text.contains("Barometer stuck")), "{name}: {texts:?}");
        assert_eq!(bench.autopilot.status().mode, FlightMode::Hold, "{name}");
        assert!(bench.faults.inject(FailureUnit::Barometer, None, 0, 4));
        bench.run(10.0, |_| ());
        let texts = bench.take_texts();
        assert!(texts.iter().any(|text| text.contains("Barometer recovered")), "{name}: {texts:?}");
        assert!((bench.position().down() + 12.0).abs() < HEIGHT_TOLERANCE_M, "{name}: {:?}", bench.position());
    }
}

/// Drift rate of a falsified height, m/s: too slow for any single reading to be an outlier.
const DRIFT_RATE_M_S: f64 = 0.4;
/// Time at which the drift begins, when the vehicle hovers, s.
const DRIFT_START_S: f64 = 30.0;

fn drift_at_m(now: SimTime) -> f64 {
    DRIFT_RATE_M_S * (now.s() - DRIFT_START_S).max(0.0)
}

fn drifting_barometer(readings: &mut Readings, now: SimTime) {
    readings.baro_up_m = readings.baro_up_m.map(|up| up + drift_at_m(now));
}

fn drifting_receiver(readings: &mut Readings, now: SimTime) {
    if let Some(fix) = &mut readings.gnss {
        fix.position_m -= Vec3::new(0.0, 0.0, drift_at_m(now));
    }
}

/// The vehicle must follow the height on which two of receiver, barometer and range finder agree, when one of the first
/// two drifts away.
#[test]
fn regress_estimate_does_not_follow_a_slow_altitude_drift() {
    // The receiver's height counts as contradicted at five times its error of 0.8 m; up to that error, the vehicle
    // follows it, m.
    const MAX_FOLLOWED_ERROR_M: f64 = 4.5;
    for name in VEHICLES {
        for (modify_readings, text) in [
            (drifting_barometer as fn(&mut Readings, SimTime), "Barometer inconsistent"),
            (drifting_receiver, "GNSS inconsistent"),
        ] {
            let mut bench = Bench::airborne(&vehicle(name), 23, 8.0);
            bench.modify_readings = Some(modify_readings);
            let mut worst: f64 = 0.0;
            bench.run(90.0, |b| worst = worst.max((b.position().down() + 8.0).abs()));
            let now = (bench.position().down() + 8.0).abs();
            let texts = bench.take_texts();
            assert!(worst < MAX_FOLLOWED_ERROR_M && now < HEIGHT_TOLERANCE_M, "{name}, {text}: {worst} m, at the end {now} m");
            assert!(texts.iter().any(|t| t.contains(text)), "{name}: {texts:?}");
        }
    }
}

/// When the sensors agree that the receiver has jumped permanently, the position must be reset to it and the reset must
/// be announced. A vehicle that a pilot holds in position must stay there. With optical flow as a reference, no reset
/// may occur.
#[test]
fn regress_permanent_gnss_jump_resets_the_position() {
    // Maximum drift on inertial sensors while the receiver is rejected, m.
    const MAX_DRIFT_M: f64 = 4.0;
    for name in VEHICLES {
        for dark in [true, false] {
            let mut bench = Bench::in_position_mode(&vehicle(name), 24, 6.0);
            bench.flow_lost = dark;
            bench.run(3.0, |_| ());
            bench.take_texts();
            let before = bench.position();
            assert!(bench.faults.inject(FailureUnit::Gnss, Some(FailureType::Wrong), 0, 4));
            bench.run(2.0, |_| ());
            assert_eq!(bench.autopilot.status().position_resets, 0, "{name}: single fixes must be rejected");
            let mut farthest: f64 = 0.0;
            bench.run(28.0, |b| farthest = farthest.max((b.position() - before).horizontal_norm()));
            let texts = bench.take_texts();
            let announced =
                texts.iter().any(|text| text.starts_with("GNSS position jumped 3") && text.ends_with(" m: position reset"));
            assert_eq!((announced, bench.autopilot.status().position_resets), (dark, u32::from(dark)), "{name}: {texts:?}");
            assert!(farthest < MAX_DRIFT_M, "{name}, dark {dark}: drifted {farthest} m");
        }
    }
}
