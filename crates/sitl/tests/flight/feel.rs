//! How the aircraft responds to the sticks in position, sport and tripod mode.

use spandrel_model::stick_response::StickResponse;
use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, Sticks};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Interval over which acceleration and jerk are means, s: shorter than their ramps, longer than the noise of the attitude loop.
const MEAN_S: f64 = 0.1;

/// A full forward stick and its release.
struct Step {
    /// Speed at the end, m/s.
    speed_m_s: f64,
    /// Time from 10% to 90% of that speed, s.
    rise_s: f64,
    /// Largest tilt, rad.
    tilt_rad: f64,
    /// Largest acceleration and jerk, m/s² and m/s³.
    acceleration_m_s2: f64,
    jerk_m_s3: f64,
    /// Way and time from the release to 5% of the speed, m and s.
    stop_m: f64,
    stop_s: f64,
}

fn hovering(name: &str, response: StickResponse) -> Bench {
    let mut bench = Bench::in_position_mode(&vehicle(name), 2, 30.0);
    bench.autopilot.tuning.stick_response = response;
    bench
}

fn forward_step(name: &str, response: StickResponse, forward: f64) -> Step {
    let mut bench = hovering(name, response);
    let (mut speeds, mut tilt_rad): (Vec<f64>, f64) = (Vec::new(), 0.0);
    let mut record = |bench: &mut Bench, forward: f64| {
        bench.sticks = Some(Sticks { forward, ..Sticks::default() });
        for _ in 0..100 {
            bench.run(MEAN_S, |_| ());
            speeds.push(bench.state.rigid.velocity_m_s.north());
            let (roll, pitch, _) = bench.state.rigid.attitude.euler();
            tilt_rad = tilt_rad.max(roll.abs()).max(pitch.abs());
        }
    };
    record(&mut bench, forward);
    record(&mut bench, 0.0);
    let (full, stopping) = (speeds[99], &speeds[100..]);
    let first = |share: f64| speeds.iter().position(|speed| *speed >= share * full).unwrap_or_default() as f64 * MEAN_S;
    let accelerations: Vec<f64> = speeds.windows(2).map(|pair| (pair[1] - pair[0]) / MEAN_S).collect();
    let jerks = accelerations.windows(2).map(|pair| (pair[1] - pair[0]) / MEAN_S);
    let stopped = stopping.iter().position(|speed| *speed < 0.05 * full).unwrap_or(stopping.len());
    Step {
        speed_m_s: full,
        rise_s: first(0.9) - first(0.1),
        tilt_rad,
        acceleration_m_s2: accelerations.iter().fold(0.0, |most: f64, a| most.max(a.abs())),
        jerk_m_s3: jerks.fold(0.0, |most: f64, jerk| most.max(jerk.abs())),
        stop_m: stopping[..stopped].iter().sum::<f64>() * MEAN_S,
        stop_s: stopped as f64 * MEAN_S,
    }
}

/// Prints the table in docs/src/measured/autopilots.md.
#[test]
fn flight_responses_keep_their_limits() {
    // Largest excess of acceleration and jerk over the plan, as fractions: the attitude loop overshoots a little, and the plan's jerk
    // changes its sign within one interval.
    const ACCELERATION_EXCESS: f64 = 0.15;
    const JERK_EXCESS: f64 = 0.5;
    // Speed tolerance as a fraction: the velocity estimate.
    const SPEED_TOLERANCE: f64 = 0.06;
    for name in VEHICLES {
        let full_m_s = vehicle(name).limits.forward_m_s;
        for (text, response) in StickResponse::ALL {
            let limits = response.limits();
            for stick in [0.3, 1.0] {
                let step = forward_step(name, response, stick);
                println!(
                    "{name} {text} {stick}: {:.1} m/s, {:.1} s, {:.0} deg, {:.1} m/s2, {:.0} m/s3, stops in {:.1} m and {:.1} s",
                    step.speed_m_s,
                    step.rise_s,
                    step.tilt_rad.to_degrees(),
                    step.acceleration_m_s2,
                    step.jerk_m_s3,
                    step.stop_m,
                    step.stop_s
                );
                // The dead band moves the stick's zero.
                let deflection = (stick - 0.03) / 0.97;
                let wanted = response.speed_fraction(deflection) * full_m_s.min(limits.horizontal_m_s);
                let error_m_s = (step.speed_m_s - wanted).abs();
                assert!(error_m_s < SPEED_TOLERANCE * wanted + 0.1, "{name} {text}: {} m/s", step.speed_m_s);
                // Sport has no limits of its own.
                assert!(step.acceleration_m_s2 < limits.deceleration_m_s2 * (1.0 + ACCELERATION_EXCESS), "{name} {text} {stick}");
                assert!(step.jerk_m_s3 < limits.jerk_m_s3 * (1.0 + JERK_EXCESS), "{name} {text} {stick}: {}", step.jerk_m_s3);
                assert!(step.stop_s < 10.0 && step.stop_m > 0.0, "{name} {text}: the aircraft must stop");
            }
        }
    }
}

#[test]
fn regress_turn_begun_in_acro_ends_where_the_nose_stops() {
    // Largest swing back, rad: as after a release of the stick in position mode (1 deg).
    const MAX_SWING_BACK_RAD: f64 = 0.017_453;
    let mut bench = hovering("phantom2", StickResponse::Sport);
    bench.ask(AutopilotRequest::SetMode(FlightMode::Acro));
    // Above hover thrust, so that the aircraft does not sink. A third of the yaw rate.
    bench.sticks = Some(Sticks { yaw: 0.36, up: 0.05, ..Sticks::default() });
    bench.run(2.0, |_| ());
    bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
    let (back, on) = bench.end_turn(1.0, 4.0);
    assert!(back < MAX_SWING_BACK_RAD, "{back} of {on} rad back");
}
