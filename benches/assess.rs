//! Measures how long it takes to score a recorded 25-minute flight. The log covers four tasks and ten photographs; it
//! contains position and stick samples at about 50 Hz among half a million other frames. Prints the scoring speed as a
//! multiple of real time. Also prints the ratio of the scoring time to the time needed to hash the log once; this ratio
//! does not depend on the machine. Checks the scoring time against its limit.

#[path = "support/best.rs"]
mod best;

use best::best;
use spandrel_mavlink::dialect::{ATTITUDE_DATA, LOCAL_POSITION_NED_DATA, MavMessage, VFR_HUD_DATA};
use spandrel_model::scenario::Scenario;
use spandrel_monitor::{Monitor, MonitorConfig, assess_log};
use spandrel_testkit::job::{self, Tape, line, scenario, task, test_survey, vehicle};
use std::process::ExitCode;
use std::time::Duration;

/// Maximum scoring time (requirement).
const MAX_SCORING_TIME: Duration = Duration::from_millis(500);
/// Maximum time from a telemetry sample to the cue that it changes (requirement).
const MAX_CUE_LATENCY: Duration = Duration::from_millis(100);
const FLIGHT_DURATION_S: f64 = 1500.0;
const ROUNDS: usize = 7;

/// Generates a long flight with typical message rates of a busy link: 340 frames per second, including `clearance` at
/// 30 Hz.
fn long_flight() -> Vec<Vec<u8>> {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    let mut legs = 0;
    while f64::from(tape.now_ms) < (FLIGHT_DURATION_S - 60.0) * 1000.0 {
        let north = f64::from(legs % 4) * 20.0;
        tape.fly((200.0, north, 10.0), 4.0);
        tape.snapshot(legs);
        tape.contact(legs % 2);
        tape.hold(0.2);
        tape.contact(0);
        tape.fly((10.0, north, 10.0), 5.0);
        tape.battery((100 - legs / 2) as i8);
        legs += 1;
    }
    tape.land();
    let quiet = std::mem::take(&mut tape.datagrams);
    let mut busy = Vec::new();
    for (k, datagram) in quiet.into_iter().enumerate() {
        busy.push(datagram);
        if k % 2 == 0 {
            for _ in 0..2 {
                tape.send(&MavMessage::ATTITUDE(ATTITUDE_DATA { roll: k as f32, ..ATTITUDE_DATA::default() }));
                tape.send(&MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
                    x: k as f32,
                    ..LOCAL_POSITION_NED_DATA::default()
                }));
            }
            tape.send(&MavMessage::VFR_HUD(VFR_HUD_DATA { alt: k as f32, ..VFR_HUD_DATA::default() }));
        }
        busy.append(&mut tape.datagrams);
    }
    busy
}

/// Returns a flight's maximum cue latency, from receiving a datagram to sending the cue: for all datagrams, and for
/// those that changed a cue.
#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
fn cue_latency(scenario: &Scenario, datagrams: &[Vec<u8>]) -> (Duration, Duration) {
    let mut monitor = Monitor::new(MonitorConfig {
        scenario: scenario.clone(),
        vehicle: vehicle(),
        trainee: "bench".to_owned(),
        purpose: None,
        started_unix_us: 0,
        system_id: 1,
        seed: None,
        survey_builder: test_survey,
    });
    let (mut slowest, mut slowest_change) = (Duration::ZERO, Duration::ZERO);
    for datagram in datagrams {
        let (before, start) = (monitor.cues(), std::time::Instant::now());
        monitor.handle_datagram(datagram);
        while monitor.poll_transmit().is_some() {}
        let took = start.elapsed();
        while monitor.poll_record().is_some() {}
        if monitor.finished().is_some() {
            break;
        }
        slowest = slowest.max(took);
        if monitor.cues() != before {
            slowest_change = slowest_change.max(took);
        }
    }
    (slowest, slowest_change)
}

fn main() -> ExitCode {
    let tasks = (0u32..4).map(|k| {
        let north = f64::from(k) * 20.0;
        task(k + 1, line((10.0, north, 10.0), (200.0, north, 10.0)), 3.0)
    });
    let scenario = scenario(tasks.collect());
    let datagrams = long_flight();
    let log = job::log_of(&datagrams, 0);
    let grade = || assess_log(&log, &scenario, &vehicle(), test_survey).map(|assessed_session| assessed_session.frames.len());
    let frames = grade();
    let assess = best(ROUNDS, grade);
    let read = best(ROUNDS, || log.iter().fold(0u64, |sum, byte| sum.wrapping_mul(31).wrapping_add(u64::from(*byte))));
    let megabytes = log.len() as f64 / 1e6;
    println!("log: {} MAVLink frames, {megabytes:.1} MB; session: {frames:?} frames", datagrams.len());
    println!(
        "scoring: {:.3} s ({:.0} x real time, {:.1} x the time to hash the log once); limit {:.1} s: {}",
        assess.as_secs_f64(),
        FLIGHT_DURATION_S / assess.as_secs_f64(),
        assess.as_secs_f64() / read.as_secs_f64(),
        MAX_SCORING_TIME.as_secs_f64(),
        if assess <= MAX_SCORING_TIME { "ok" } else { "EXCEEDED" },
    );
    let (slowest, change) = cue_latency(&scenario, &datagrams);
    println!(
        "maximum cue latency: {:.3} ms for datagrams that change a cue, {:.3} ms for all datagrams; limit {} ms: {}",
        change.as_secs_f64() * 1e3,
        slowest.as_secs_f64() * 1e3,
        MAX_CUE_LATENCY.as_millis(),
        if slowest <= MAX_CUE_LATENCY { "ok" } else { "EXCEEDED" },
    );
    ExitCode::from(u8::from(frames.is_err() || assess > MAX_SCORING_TIME || slowest > MAX_CUE_LATENCY))
}
