//! Sensors that repeat their last value or contradict other sensors, with the fault injected in flight.

use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, LandedState};
use spandrel_sitl::faults::{FailureType, FailureUnit};
use spandrel_sitl::sensors::Readings;
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Height tolerance, m: without its barometer, the vehicle holds its height with GNSS alone, which drifts by 0.64 m (1
/// sigma).
const HEIGHT_TOLERANCE_M: f64 = 2.5;
/// Horizontal tolerance, m, with the receiver (0.4 m, 1 sigma) or optical flow.
const POSITION_TOLERANCE_M: f64 = 2.5;

fn go(bench: &mut Bench, north: f64, east: f64, up: f64) {
    bench.ask(AutopilotRequest::GoTo { north_east_m: Some((north, east)), up_m: Some(up), yaw_rad: None, speed_m_s: None });
}

fn take_texts(bench: &mut Bench) -> Vec<String> {
    bench.autopilot.drain_events().into_iter().map(|event| event.text).collect()
}

/// Flies a square with the fault present from the first leg on, then lands. Returns the largest horizontal and vertical
/// deviations, in meters, and the texts.
fn square(name: &str, unit: FailureUnit, kind: FailureType) -> (f64, f64, Vec<String>) {
    let mut bench = Bench::airborne(&vehicle(name), 21, 5.0);
    take_texts(&mut bench);
    let (mut flat, mut up): (f64, f64) = (0.0, 0.0);
    for (k, (n, e, height)) in [(12.0, 0.0, 9.0), (12.0, 12.0, 9.0), (0.0, 12.0, 6.0), (0.0, 0.0, 6.0)].into_iter().enumerate() {
        go(&mut bench, n, e, height);
        bench.run(1.5, |_| ());
        if k == 0 {
            assert!(bench.faults.inject(unit, Some(kind), 0, 4));
        }
        bench.run(10.5, |_| ());
        let off = bench.position() - Vec3::new(n, e, -height);
        (flat, up) = (flat.max(off.horizontal_norm()), up.max(off.down().abs()));
    }
    bench.ask(AutopilotRequest::Land);
    bench.run(30.0, |_| ());
    let status = bench.autopilot.status();
    assert!(
        !status.armed && status.landed == LandedState::OnGround,
        "{name}, {unit:?} {kind:?}: {status:?} {:?}",
        bench.position()
    );
    let texts = take_texts(&mut bench);
    (flat, up, texts)
}

#[test]
fn regress_stuck_barometer_is_announced_and_the_climb_is_correct() {
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 20, 4.0);
        take_texts(&mut bench);
        go(&mut bench, 0.0, 0.0, 12.0);
        bench.run(1.5, |_| ());
        assert!(bench.faults.inject(FailureUnit::Barometer, Some(FailureType::Stuck), 0, 4));
        let mut highest: f64 = 0.0;
        bench.run(60.0, |b| highest = highest.max(-b.position().down()));
        let texts = take_texts(&mut bench);
        assert!(
            (highest - 12.0).abs() < HEIGHT_TOLERANCE_M && (bench.position().down() + 12.0).abs() < HEIGHT_TOLERANCE_M,
            "{name}: {highest} m"
        );
        assert!(texts.iter().any(|text| text.contains("Barometer stuck")), "{name}: {texts:?}");
        assert_eq!(bench.autopilot.status().mode, FlightMode::Hold, "{name}");
        assert!(bench.faults.inject(FailureUnit::Barometer, None, 0, 4));
        bench.run(10.0, |_| ());
        let texts = take_texts(&mut bench);
        assert!(texts.iter().any(|text| text.contains("Barometer recovered")), "{name}: {texts:?}");
        assert!((bench.position().down() + 12.0).abs() < HEIGHT_TOLERANCE_M, "{name}: {:?}", bench.position());
    }
}

#[test]
fn regress_stuck_sensor_is_announced_and_excluded() {
    for name in VEHICLES {
        for (unit, text) in
            [(FailureUnit::Barometer, "Barometer"), (FailureUnit::Magnetometer, "Compass"), (FailureUnit::Gnss, "GNSS")]
        {
            let (flat, up, texts) = square(name, unit, FailureType::Stuck);
            assert!(flat < POSITION_TOLERANCE_M && up < HEIGHT_TOLERANCE_M, "{name}, {unit:?}: {flat} m off, {up} m in height");
            assert!(texts.iter().any(|t| t.contains(&format!("{text} stuck"))), "{name}, {unit:?}: {texts:?}");
        }
    }
}

#[test]
fn regress_inconsistent_sensor_is_announced_and_excluded() {
    for name in VEHICLES {
        for (unit, kind, text) in [
            (FailureUnit::Barometer, FailureType::Wrong, "Barometer"),
            (FailureUnit::Barometer, FailureType::Garbage, "Barometer"),
            (FailureUnit::Magnetometer, FailureType::Wrong, "Compass"),
            (FailureUnit::Magnetometer, FailureType::Garbage, "Compass"),
            (FailureUnit::Gnss, FailureType::Garbage, "GNSS"),
        ] {
            let (flat, up, texts) = square(name, unit, kind);
            assert!(
                flat < POSITION_TOLERANCE_M && up < HEIGHT_TOLERANCE_M,
                "{name}, {unit:?} {kind:?}: {flat} m off, {up} m in height"
            );
            assert!(texts.iter().any(|t| t.contains(&format!("{text} inconsistent"))), "{name}, {unit:?}: {texts:?}");
        }
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
            let texts = take_texts(&mut bench);
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
            take_texts(&mut bench);
            let before = bench.position();
            assert!(bench.faults.inject(FailureUnit::Gnss, Some(FailureType::Wrong), 0, 4));
            bench.run(2.0, |_| ());
            assert_eq!(bench.autopilot.status().position_resets, 0, "{name}: single fixes must be rejected");
            let mut farthest: f64 = 0.0;
            bench.run(28.0, |b| farthest = farthest.max((b.position() - before).horizontal_norm()));
            let texts = take_texts(&mut bench);
            let announced =
                texts.iter().any(|text| text.starts_with("GNSS position jumped 3") && text.ends_with(" m: position reset"));
            assert_eq!((announced, bench.autopilot.status().position_resets), (dark, u32::from(dark)), "{name}: {texts:?}");
            assert!(farthest < MAX_DRIFT_M, "{name}, dark {dark}: drifted {farthest} m");
        }
    }
}
