//! The nose stops turning when the yaw stick is released, for every shipped aircraft, in every manual mode.

use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, Sticks};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Releases a fully deflected yaw stick. Returns the angle by which the nose swings back and the angle by which it
/// first keeps turning, in rad.
fn release_yaw(bench: &mut Bench, yaw: f64) -> (f64, f64) {
    const HELD_S: f64 = 3.0;
    const SETTLED_S: f64 = 5.0;
    bench.sticks = Some(Sticks { yaw, ..Sticks::default() });
    bench.run(HELD_S, |_| ());
    bench.end_turn(yaw, SETTLED_S)
}

#[test]
fn regress_nose_does_not_swing_back_after_yaw_release() {
    // Limit from issue 16, rad (1 deg); a real PX4 swings back by 0.4 deg.
    const MAX_SWING_BACK_RAD: f64 = 0.017_453;
    // Stopping from 100 deg/s in 0.3 s takes 15 deg; the limit adds half as much again for lag, rad.
    const MAX_YAW_OVERSHOOT_RAD: f64 = 0.393;
    // Starting height, m; in Stabilized mode, the vehicle sinks with the throttle stick centered.
    const START_HEIGHT_M: f64 = 40.0;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        for mode in [FlightMode::Position, FlightMode::Altitude, FlightMode::Stabilized] {
            for yaw in [1.0, -1.0, 0.4] {
                let mut bench = Bench::in_position_mode(&aircraft, 6, START_HEIGHT_M);
                bench.ask(AutopilotRequest::SetMode(mode));
                let (swing, on) = release_yaw(&mut bench, yaw);
                assert!(bench.position().down() < -1.0, "{name}, {mode:?}: on the ground");
                assert!(swing < MAX_SWING_BACK_RAD, "{name}, {mode:?}, stick {yaw}: swings back {} deg", swing.to_degrees());
                assert!(on < MAX_YAW_OVERSHOOT_RAD, "{name}, {mode:?}, stick {yaw}: keeps turning for {} deg", on.to_degrees());
            }
        }
    }
}
