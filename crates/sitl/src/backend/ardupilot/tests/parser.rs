//! The rules by which ArduPilot reads a line, in the variants of two versions, and what they make of our lines.

use super::super::state_line::{self, MAX_RATE_RAD_S, MAX_SPECIFIC_FORCE_M_S2, OUT_OF_RANGE_M};
use super::Scene;
use spandrel_model::frames::{Rotation, Vec3};
use std::collections::BTreeMap;

/// Section, key and number of values, in the order in which ArduPilot looks for them.
type Key = (&'static str, &'static str, usize);

const COMMON_KEYS: [Key; 15] = [
    ("", "timestamp", 1),
    ("imu", "gyro", 3),
    ("imu", "accel_body", 3),
    ("", "position", 3),
    ("", "attitude", 3),
    ("", "quaternion", 4),
    ("", "velocity", 3),
    ("", "rng_1", 1),
    ("", "rng_6", 1),
    ("", "velocity_wind", 3),
    ("battery", "voltage", 1),
    ("battery", "current", 1),
    ("rc", "rc_1", 1),
    ("rc", "rc_3", 1),
    ("rc", "rc_8", 1),
];
/// Keys whose presence changes how ArduPilot flies or reads the position.
const FORBIDDEN_KEYS: [&str; 5] = ["no_time_sync", "no_lockstep", "latitude", "longitude", "altitude"];

/// Returns the line that ArduPilot would read from its receive buffer: the bytes between the last two newlines.
pub(super) fn framed(buffer: &[u8]) -> &str {
    let last = buffer.iter().rposition(|b| *b == b'\n').expect("newline at the end");
    let first = buffer[..last].iter().rposition(|b| *b == b'\n').expect("newline before the line");
    std::str::from_utf8(&buffer[first + 1..last]).expect("text")
}

/// Returns the text after a key: the first occurrence of its name after the first occurrence of its section's name. The
/// search starts one character after the section, and the value starts two characters after the name.
fn after_key<'a>(line: &'a str, section: &str, name: &str) -> Option<&'a str> {
    let inside = line.get(line.find(section)? + section.len() + 1..)?;
    inside.get(inside.find(name)? + name.len() + 2..)
}

/// Reads a number like C's `atof`: as many characters as fit, 0 if there are none.
pub(super) fn number(text: &str) -> f64 {
    let text = text.trim_start();
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '-' || c == '+' || c == '.')).unwrap_or(text.len());
    text[..end].parse().unwrap_or(0.0)
}

/// The strict rule: an opening bracket without a space before it, and commas between the values.
pub(super) fn strict_vector(text: &str, count: usize) -> Option<Vec<f64>> {
    let inside = text.strip_prefix('[')?;
    let values: Vec<f64> = inside.split(']').next()?.split(',').map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    (values.len() == count).then_some(values)
}

/// The lenient rule: skips to a digit or minus sign for each value, and a comma between two of them.
fn lenient_vector(text: &str, count: usize) -> Option<Vec<f64>> {
    let mut rest = text;
    let mut values = Vec::new();
    for index in 0..count {
        rest = &rest[rest.find(|c: char| c == '-' || c.is_ascii_digit())?..];
        values.push(number(rest));
        rest = &rest[rest.find([',', ']'])?..];
        if index + 1 < count {
            rest = rest.strip_prefix(',')?;
        }
    }
    Some(values)
}

/// Reads all known keys with one of the two rules for vectors.
pub(super) fn read(line: &str, vector: fn(&str, usize) -> Option<Vec<f64>>) -> BTreeMap<&'static str, Vec<f64>> {
    let keys = COMMON_KEYS.iter().map(|(section, name, count)| {
        let text = after_key(line, section, name).unwrap_or_else(|| panic!("no {section}/{name} in {line}"));
        let values = if *count == 1 { vec![number(text)] } else { vector(text, *count).expect(name) };
        (*name, values)
    });
    keys.collect()
}

fn assert_close(got: &[f64], expected: &[f64], name: &str) {
    for (a, b) in got.iter().zip(expected) {
        assert!((a - b).abs() < 1e-8, "{name}: {got:?} instead of {expected:?}");
    }
}

fn lively_scene() -> Scene {
    let mut scene = Scene::at_rest();
    scene.truth.attitude = Rotation::from_euler(-0.1, 0.2, -2.5);
    scene.truth.velocity_m_s = Vec3::new(-3.25, 0.000_001, 1.5);
    scene.imus[0].rates_rad_s = Vec3::new(0.5, -1.5, 1e-7);
    scene.imus[0].specific_force_m_s2 = Vec3::new(-0.001, 4.0, -9.5);
    scene.latest.range_down_m = Some(f64::INFINITY);
    scene.latest.range_up_m = Some(4.5);
    scene.latest.range_around_m = Some([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    scene
}

#[test]
fn wire_both_parsers_read_all_values() {
    let scene = lively_scene();
    let bytes = state_line::encode(&scene.step(), 1_500_000_000);
    let line = framed(&bytes);
    let (roll, pitch, yaw) = scene.truth.attitude.euler();
    for vector in [strict_vector, lenient_vector] {
        let values = read(line, vector);
        assert_close(&values["timestamp"], &[1.500_001_5], "timestamp");
        assert_close(&values["gyro"], &[0.5, -1.5, 1e-7], "gyro");
        assert_close(&values["accel_body"], &[-0.001, 4.0, -9.5], "accel_body");
        assert_close(&values["position"], &[1.0, -2.0, -0.125], "position");
        assert_close(&values["attitude"], &[roll, pitch, yaw], "attitude");
        assert_close(&values["quaternion"], &scene.truth.attitude.wxyz(), "quaternion");
        assert_close(&values["velocity"], &[-3.25, 1e-6, 1.5], "velocity");
        assert_close(&values["velocity_wind"], &[1.0, -2.0, 0.25], "velocity_wind");
        assert_close(&values["rng_1"], &[OUT_OF_RANGE_M], "rng_1");
        assert_close(&values["rng_6"], &[7.0], "rng_6");
        assert_close(&values["voltage"], &[12.25], "voltage");
        assert_close(&values["current"], &[3.5], "current");
        for stick in ["rc_1", "rc_3", "rc_8"] {
            assert_close(&values[stick], &[1500.0], stick);
        }
    }
}

#[test]
fn wire_line_has_no_key_that_changes_the_mode_of_operation() {
    let bytes = state_line::encode(&lively_scene().step(), 0);
    for key in FORBIDDEN_KEYS {
        assert!(!framed(&bytes).contains(key), "{key}");
    }
}

#[test]
fn wire_line_is_json_and_starts_and_ends_with_a_newline() {
    let bytes = state_line::encode(&lively_scene().step(), 2_000_000);
    let text = String::from_utf8(bytes).expect("text");
    assert!(text.starts_with("\n{") && text.ends_with("}\n"), "{text}");
    assert_eq!(text.matches('\n').count(), 2);
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["imu"]["gyro"].as_array().map(Vec::len), Some(3));
    assert_eq!(json["battery"]["voltage"], 12.25);
}

/// A reader that starts in the middle of a datagram, or gets two at once, reads the last line.
#[test]
fn wire_last_of_several_lines_is_read() {
    let scene = lively_scene();
    let mut buffer = state_line::encode(&scene.step(), 2_000_000)[100..].to_vec();
    buffer.extend(state_line::encode(&scene.step(), 4_000_000));
    assert_close(&read(framed(&buffer), strict_vector)["timestamp"], &[0.004_000_004], "timestamp");
}

#[test]
fn exact_impacts_are_clipped_and_invalid_values_are_zero() {
    let mut scene = Scene::at_rest();
    scene.imus[0].specific_force_m_s2 = Vec3::new(900.0, -900.0, f64::NAN);
    scene.imus[0].rates_rad_s = Vec3::new(f64::INFINITY, -50.0, 0.0);
    scene.battery.current_a = f64::NAN;
    let bytes = state_line::encode(&scene.step(), 2_000_000);
    let line = framed(&bytes);
    assert!(!line.contains("NaN") && !line.contains("inf"), "{line}");
    let values = read(line, strict_vector);
    assert_close(&values["accel_body"], &[MAX_SPECIFIC_FORCE_M_S2, -MAX_SPECIFIC_FORCE_M_S2, 0.0], "accel_body");
    assert_close(&values["gyro"], &[MAX_RATE_RAD_S, -MAX_RATE_RAD_S, 0.0], "gyro");
    assert_close(&values["current"], &[0.0], "current");
}

/// ArduPilot adds the difference of two timestamps, in microseconds, to an integer clock and drops the fraction.
#[test]
fn regress_truncated_clock_keeps_pace_with_simulation() {
    for period_us in [1000_u64, 2000, 4000] {
        let (mut clock_us, mut last_s) = (0_u64, 0.0);
        for frame in 1..=20_000_u64 {
            let bytes = state_line::encode(&Scene::at_rest().step(), (frame * period_us * 1000) as i64);
            let timestamp_s = number(after_key(framed(&bytes), "", "timestamp").expect("timestamp"));
            clock_us = (clock_us as f64 + (timestamp_s - last_s) * 1e6) as u64;
            last_s = timestamp_s;
            assert_eq!(clock_us, frame * period_us);
        }
    }
}
