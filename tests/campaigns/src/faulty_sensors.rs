//! Every shipped aircraft flies a square with every fault of the barometer, compass and GNSS receiver that the vehicle must
//! detect.

use spandrel_model::frames::Vec3;
use spandrel_sitl::autopilot::{AutopilotRequest, LandedState};
use spandrel_sitl::faults::{FailureType, FailureUnit};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Height tolerance, m: without its barometer, the vehicle holds its height with GNSS alone, which drifts by 0.64 m (1
/// sigma).
const HEIGHT_TOLERANCE_M: f64 = 2.5;
/// Horizontal tolerance, m, with the receiver (0.4 m, 1 sigma) or optical flow.
const POSITION_TOLERANCE_M: f64 = 2.5;

/// Flies a square with the fault present from the first leg on, then lands. Returns the largest horizontal and vertical
/// deviations, in meters, and the texts.
fn square(name: &str, unit: FailureUnit, kind: FailureType) -> (f64, f64, Vec<String>) {
    let mut bench = Bench::airborne(&vehicle(name), 21, 5.0);
    bench.take_texts();
    let (mut flat, mut up): (f64, f64) = (0.0, 0.0);
    for (k, (n, e, height)) in [(12.0, 0.0, 9.0), (12.0, 12.0, 9.0), (0.0, 12.0, 6.0), (0.0, 0.0, 6.0)].into_iter().enumerate() {
        bench.go_to(n, e, height);
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
    let texts = bench.take_texts();
    (flat, up, texts)
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
