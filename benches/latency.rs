//! Measures the response times of a real-time simulator over loopback: from a command to its acknowledgment, and from a
//! stick movement to the first telemetry that shows it (the echoed stick position and, in flight, the roll rate). Also
//! measures whether the simulator keeps up while a peer floods it with messages. Prints the results in milliseconds and
//! in 2.5 ms control ticks.

#[path = "support/running.rs"]
mod running;

use running::{Client, now, start};
use spandrel_mavlink::dialect::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

const TICK_MS: f64 = 2.5;
/// Target for the 99th percentile: two control ticks (requirement).
const TARGET_LATENCY_MS: f64 = 2.0 * TICK_MS;
const ROUNDS: usize = 1_000;
/// Pause between measurements. It is not a multiple of any period in the vehicle, so the measurements sample every
/// phase of each period.
const MEASUREMENT_PAUSE: Duration = Duration::from_micros(7_310);
/// Message rate and duration of the flood.
const FLOOD_RATE_HZ: u64 = 50_000;
const FLOOD_DURATION: Duration = Duration::from_secs(5);
/// Minimum ratio of simulation time to wall time during the flood.
const MIN_SPEED_FACTOR: f64 = 0.99;

/// Number of stick steps in flight, and the time with a centered stick before each step, which lets the vehicle settle.
const STICK_STEP_COUNT: usize = 150;
const CENTERED_DURATION: Duration = Duration::from_millis(400);
/// Interval between stick samples in flight.
const STICK_INTERVAL: Duration = Duration::from_millis(20);
/// Minimum deviation of the roll rate from its mean at rest that counts as a response, in standard deviations.
const RESPONSE_THRESHOLD_SIGMAS: f64 = 6.0;
/// PX4 mode numbers for automatic takeoff, hold, and altitude mode.
const TAKEOFF_MODE: [f32; 3] = [1.0, 4.0, 2.0];
const HOLD_MODE: u32 = 4 << 16 | 3 << 24;
const ALTITUDE_MODE: [f32; 3] = [1.0, 2.0, 0.0];

fn command_long(command: MavCmd, p: [f32; 3]) -> MavMessage {
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command,
        param1: p[0],
        param2: p[1],
        param3: p[2],
        target_system: 1,
        target_component: 1,
        ..Default::default()
    })
}

/// Returns the median and the 99th percentile in milliseconds.
fn median_and_p99(mut times: Vec<f64>) -> (f64, f64) {
    times.sort_by(f64::total_cmp);
    (times[times.len() / 2], times[times.len() * 99 / 100])
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn command_latency(client: &mut Client) -> (f64, f64) {
    let one = |k: usize| {
        std::thread::sleep(MEASUREMENT_PAUSE);
        let command = MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF;
        let begin = now();
        client.send(&command_long(command, [(k % 2) as f32, 0.0, 0.0]));
        client.wait(|m| if let MavMessage::COMMAND_ACK(ack) = m { (ack.command == command).then_some(()) } else { None });
        ms(begin)
    };
    median_and_p99((0..ROUNDS).map(one).collect())
}

fn stick_latency(client: &mut Client) -> (f64, f64) {
    // Requests RC_CHANNELS at the control loop rate.
    client.send(&command_long(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [65.0, 2_500.0, 0.0]));
    let one = |k: usize| {
        std::thread::sleep(MEASUREMENT_PAUSE);
        let y = if k.is_multiple_of(2) { 400 } else { -400 };
        let begin = now();
        client.send(&stick(y));
        let wanted = (1_500 + y / 2) as u16;
        client.wait(|m| if let MavMessage::RC_CHANNELS(c) = m { (c.chan1_raw == wanted).then_some(()) } else { None });
        ms(begin)
    };
    median_and_p99((0..ROUNDS).map(one).collect())
}

fn stick(y: i16) -> MavMessage {
    MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { y, z: 500, target: 1, ..Default::default() })
}

fn command_and_wait(client: &mut Client, command: MavCmd, p: [f32; 3]) {
    client.send(&command_long(command, p));
    let result =
        client.wait(|m| if let MavMessage::COMMAND_ACK(ack) = m { (ack.command == command).then_some(ack.result) } else { None });
    assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED, "{command:?}");
}

fn roll_rate(client: &mut Client) -> f64 {
    client.wait(|m| if let MavMessage::ATTITUDE(a) = m { Some(f64::from(a.rollspeed)) } else { None })
}

/// Returns the roll rates measured while the stick is centered, in rad/s.
fn rest_roll_rates(client: &mut Client, time: Duration) -> Vec<f64> {
    let (begin, mut sent) = (now(), None::<Instant>);
    let mut rates = Vec::new();
    while begin.elapsed() < time {
        if sent.is_none_or(|sent| sent.elapsed() >= STICK_INTERVAL) {
            client.send(&stick(0));
            sent = Some(now());
        }
        rates.push(roll_rate(client));
    }
    rates
}

/// Measures the time from a stick step in flight to the first roll rate that exceeds the noise. This includes the
/// response of the rotors and the airframe.
fn rates(client: &mut Client) -> (f64, f64) {
    command_and_wait(client, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [30.0, 2_500.0, 0.0]);
    rest_roll_rates(client, CENTERED_DURATION);
    command_and_wait(client, MavCmd::MAV_CMD_DO_SET_MODE, TAKEOFF_MODE);
    command_and_wait(client, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0]);
    client.wait(|m| if let MavMessage::HEARTBEAT(beat) = m { (beat.custom_mode == HOLD_MODE).then_some(()) } else { None });
    rest_roll_rates(client, CENTERED_DURATION);
    command_and_wait(client, MavCmd::MAV_CMD_DO_SET_MODE, ALTITUDE_MODE);
    let calm = rest_roll_rates(client, FLOOD_DURATION);
    let mean = calm.iter().sum::<f64>() / calm.len() as f64;
    let deviation = (calm.iter().map(|rate| (rate - mean) * (rate - mean)).sum::<f64>() / calm.len() as f64).sqrt();
    let one = |k: usize| {
        rest_roll_rates(client, CENTERED_DURATION);
        std::thread::sleep(MEASUREMENT_PAUSE);
        let begin = now();
        client.send(&stick(if k.is_multiple_of(2) { 500 } else { -500 }));
        while (roll_rate(client) - mean).abs() < RESPONSE_THRESHOLD_SIGMAS * deviation {}
        ms(begin)
    };
    let spread = median_and_p99((0..STICK_STEP_COUNT).map(one).collect());
    println!("roll rate noise with a centered stick: {deviation:.4} rad/s (1 sigma)");
    spread
}

/// Returns the ratio of simulation time to wall time that one peer observes while another floods the simulator, and the
/// flood's message rate.
fn speed_factor_under_flood(client: &mut Client, port: u16) -> (f64, f64) {
    let (stop, sent) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
    let flood = {
        let (stop, sent) = (Arc::clone(&stop), Arc::clone(&sent));
        std::thread::spawn(move || {
            let mut rude = Client::new(port, 77);
            let frame =
                rude.encoder.encode(&MavMessage::STATUSTEXT(STATUSTEXT_DATA { text: "flood".into(), ..Default::default() }));
            let begin = now();
            while !stop.load(Ordering::Relaxed) {
                let due = (begin.elapsed().as_secs_f64() * FLOOD_RATE_HZ as f64) as u64;
                let before = sent.load(Ordering::Relaxed);
                for _ in before..due {
                    // A full system buffer drops the message, as a network would.
                    let _ = rude.socket.send(&frame);
                }
                sent.store(due.max(before), Ordering::Relaxed);
                std::thread::sleep(Duration::from_millis(1));
            }
        })
    };
    let (pace, wall_s) = client.speed_factor(FLOOD_DURATION);
    stop.store(true, Ordering::Relaxed);
    flood.join().expect("the flood thread must not panic");
    (pace, sent.load(Ordering::Relaxed) as f64 / wall_s)
}

fn main() {
    let (_running, port) = start();
    let mut client = Client::new(port, 255);
    client.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    client.wait(|m| matches!(m, MavMessage::HEARTBEAT(_)).then_some(()));
    let mut good = true;
    for (what, (median, p99)) in [
        ("command to acknowledgment", command_latency(&mut client)),
        ("stick movement to echo in telemetry", stick_latency(&mut client)),
    ] {
        println!(
            "{what}: median {median:.2} ms ({:.2} ticks), p99 {p99:.2} ms ({:.2} ticks; target 2)",
            median / TICK_MS,
            p99 / TICK_MS
        );
        good &= p99 <= TARGET_LATENCY_MS;
    }
    let (median, p99) = rates(&mut client);
    println!(
        "stick movement to first change in roll rate: median {median:.2} ms ({:.2} ticks), p99 {p99:.2} ms ({:.2} ticks)",
        median / TICK_MS,
        p99 / TICK_MS
    );
    let (pace, rate) = speed_factor_under_flood(&mut client, port);
    println!(
        "with {rate:.0} messages per second from one peer: {pace:.4} simulated seconds per real second (minimum {MIN_SPEED_FACTOR})"
    );
    good &= pace >= MIN_SPEED_FACTOR;
    assert!(good, "target missed");
}
