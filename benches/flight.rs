//! Measures the CPU time per simulated second of flight: separately for the sensors, the estimator, and the autopilot,
//! and then for the complete simulation including the physics. Also prints the speed as a multiple of real time on one
//! core. (The `vehicle` benchmark adds the telemetry.)

#[path = "support/best.rs"]
mod best;

use best::best;
use spandrel_model::time::SimTime;
use spandrel_sitl::sensors::{BatteryReading, FeltMotion, Readings, SensorInputs};
use spandrel_testkit::bench::Bench;
use spandrel_testkit::shipped::vehicle;
use std::hint::black_box;
use std::time::Duration;

const SIMULATED_SECONDS: f64 = 60.0;
const TICK_DURATION: SimTime = SimTime::from_us(2500);
const ROUNDS: usize = 5;

fn print_cost(what: &str, taken: Duration) {
    let per_second_us = taken.as_secs_f64() * 1e6 / SIMULATED_SECONDS;
    println!("{what:<40} {per_second_us:>9.1} us per simulated second {:>9.0} x real time", 1e6 / per_second_us);
}

/// Returns sensor readings recorded while hovering. They are used to time the autopilot without the physics or the
/// sensors.
fn recorded_readings(start: &Bench) -> Vec<(SimTime, Readings)> {
    let mut sensors = start.sensors.clone();
    let battery = BatteryReading { voltage_v: 11.5, current_a: 12.0, remaining_pct: 80.0 };
    let rigid = &start.state.rigid;
    let truth = SensorInputs { rigid, air_velocity_m_s: rigid.velocity_m_s, battery, lamp_on: false };
    let mut now = start.now;
    (0..(SIMULATED_SECONDS * 400.0) as usize)
        .map(|_| {
            sensors.integrate_imu(&FeltMotion::of(&start.state), TICK_DURATION);
            now += TICK_DURATION;
            (now, sensors.sample(&truth, &start.site, now))
        })
        .collect()
}

fn main() {
    let start = Bench::airborne(&vehicle("phantom2"), 1, 6.0);
    print_cost(
        "sensors",
        best(ROUNDS, || {
            black_box(recorded_readings(&start));
        }),
    );
    let readings = recorded_readings(&start);
    print_cost(
        "estimator",
        best(ROUNDS, || {
            let mut estimator = start.autopilot.estimator().clone();
            for (now, one) in &readings {
                estimator.step(one, *now);
            }
            black_box(estimator.estimate());
        }),
    );
    print_cost(
        "autopilot with estimator",
        best(ROUNDS, || {
            let mut autopilot = start.autopilot.clone();
            for (now, one) in &readings {
                black_box(autopilot.step(one, *now));
            }
        }),
    );
    let mut whole = Bench::airborne(&vehicle("phantom2"), 1, 6.0);
    print_cost("complete simulation", best(ROUNDS, || whole.run(SIMULATED_SECONDS, |_| ())));
}
