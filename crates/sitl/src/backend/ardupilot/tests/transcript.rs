//! Replays a recorded exchange with a real ArduPilot.

use super::super::ArduPilotInterface;
use super::parser::{framed, number, read, strict_vector};
use super::{Scene, aircraft, settings};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface};
use crate::backend::launch::LaunchSettings;
use spandrel_model::frames::{Rotation, Vec3};
use spandrel_model::time::SimTime;
use std::collections::BTreeMap;

const TRANSCRIPT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/ardupilot-4.6.3.txt"));

fn bytes(hexadecimal: &str) -> Vec<u8> {
    let digit = |at: usize| u8::from_str_radix(&hexadecimal[at..at + 2], 16).expect("hexadecimal");
    (0..hexadecimal.len()).step_by(2).map(digit).collect()
}

fn vector<F>(values: &BTreeMap<&'static str, Vec<f64>>, name: &str) -> Vec3<F> {
    let [x, y, z] = values[name][..] else { panic!("{name}") };
    Vec3::new(x, y, z)
}

/// Returns the step that gives this line. `start` is the time of timestamp 0.
fn scene(line: &str, start: SimTime) -> Scene {
    let values = read(line, strict_vector);
    let mut scene = Scene::at_rest();
    // The timestamp is one part per million too long.
    scene.now = start + SimTime::from_us((values["timestamp"][0] / 1.000_001 * 1e6).round() as i64);
    scene.pad_m = Vec3::zero();
    scene.truth.position_m = vector(&values, "position");
    scene.truth.velocity_m_s = vector(&values, "velocity");
    let [w, x, y, z] = values["quaternion"][..] else { panic!("quaternion") };
    scene.truth.attitude = Rotation::from_wxyz([w, x, y, z]).expect("unit");
    scene.imus[0].rates_rad_s = vector(&values, "gyro");
    scene.imus[0].specific_force_m_s2 = vector(&values, "accel_body");
    scene.wind_m_s = vector(&values, "velocity_wind");
    scene.latest.range_down_m = Some(values["rng_1"][0]);
    scene.battery.voltage_v = values["voltage"][0];
    scene.battery.current_a = values["current"][0];
    scene
}

/// Outcome of a replay.
#[derive(Debug, Default, PartialEq)]
struct Counts {
    states: u32,
    resent: u32,
    restarts: u32,
    armed: u32,
}

/// Feeds one packet to the interface and counts what it causes.
fn feed(interface: &mut ArduPilotInterface, packet: &str, start: &mut SimTime, counts: &mut Counts) {
    interface.receive(&bytes(packet));
    match interface.poll_event() {
        None => {}
        Some(InterfaceEvent::Restarted) => {
            counts.restarts += 1;
            *start += SimTime::from_ms(200_000);
        }
        Some(event) => panic!("{event:?}"),
    }
    counts.armed += u32::from(interface.actuators().armed);
}

#[test]
fn wire_replay_of_a_real_autopilot_gives_the_recorded_states() {
    let mut interface = ArduPilotInterface::new(&aircraft("phantom2"), &LaunchSettings { rate_hz: 1000.0, ..settings() });
    let mut counts = Counts::default();
    let mut start = SimTime::from_ms(5000);
    for line in TRANSCRIPT.lines() {
        match line.split_at(2) {
            ("< ", packet) => feed(&mut interface, packet, &mut start, &mut counts),
            ("> ", state) if interface.is_waiting() => {
                counts.resent += 1;
                assert_matches(&interface.poll_transmit().expect("same reply again"), state);
            }
            ("> ", state) => {
                counts.states += 1;
                interface.send(&scene(state, start).step());
                assert_matches(&interface.poll_transmit().expect("reply"), state);
            }
            _ => assert!(line.starts_with('#') || line.starts_with('~'), "{line}"),
        }
    }
    assert_eq!(counts, Counts { states: 68, resent: 1, restarts: 1, armed: 25 });
}

/// Compares a reply with a recorded line: the same keys, and the same numbers but for the last digits.
fn assert_matches(reply: &[u8], recorded: &str) {
    let reply = framed(reply);
    let shape = |line: &str| line.chars().filter(|c| !(c.is_ascii_digit() || "-.".contains(*c))).collect::<String>();
    assert_eq!(shape(reply), shape(recorded));
    let numbers = |line: &str| line.split([':', '[', ',', '{']).map(number).collect::<Vec<_>>();
    for (got, expected) in numbers(reply).into_iter().zip(numbers(recorded)) {
        assert!((got - expected).abs() < 1e-7, "{reply}\n{recorded}");
    }
}
