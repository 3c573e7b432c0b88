//! The state of the aircraft as the line of JSON that ArduPilot reads.
//!
//! ArduPilot finds each value by searching for the text of its key, so the order of the keys and the format of the values matter:
//!
//! - The line stands between two newlines.
//! - A vector follows its key directly, without a space.
//! - `velocity` comes before `velocity_wind`, which contains its name.
//! - Some versions assign range finders by the bits of `attitude` and `quaternion`, so both and all six ranges are present.
//! - There is no `latitude`: versions that know this key round the position to centimeters if it is present.
//! - There is no `no_time_sync`: with this key, ArduPilot would fly by the true state instead of its estimate.

use crate::backend::interface::StepInput;
use crate::sensors::Readings;
use spandrel_model::frames::Vec3;
use spandrel_model::math::GRAVITY_M_S2;
use std::fmt::Write;

/// Maximum specific force, m/s²: the range of a usual accelerometer, ±16 g.
pub const MAX_SPECIFIC_FORCE_M_S2: f64 = 16.0 * GRAVITY_M_S2;
/// Maximum angular rate, rad/s: the range of a usual gyroscope, ±2,000 degrees per second.
pub const MAX_RATE_RAD_S: f64 = 34.9;
/// Range that a range finder reports if nothing is in range, m.
pub const OUT_OF_RANGE_M: f64 = 1000.0;
/// Stick positions of the receiver on which MANUAL_CONTROL and RC_CHANNELS_OVERRIDE are superimposed, us: all centered, so that
/// an aircraft whose clients are gone hovers instead of descending.
const CENTERED_STICK_US: u32 = 1500;
const STICK_CHANNELS: usize = 8;
/// ArduPilot truncates the difference of two timestamps to whole microseconds. One part per million more than the true time keeps
/// rounding errors from costing a microsecond in each frame.
const STRETCH_DIVISOR: i64 = 1_000_000;

/// Encodes the state at the end of a control period. `elapsed_ns` is the time since ArduPilot started.
pub fn encode(step: &StepInput<'_>, elapsed_ns: i64) -> Vec<u8> {
    let mut line = Line(String::with_capacity(900));
    let imu = &step.imus[0];
    let truth = step.truth;
    line.timestamp(elapsed_ns + elapsed_ns / STRETCH_DIVISOR);
    line.text(",\"imu\":{");
    line.vector("gyro", &clipped(imu.rates_rad_s, MAX_RATE_RAD_S));
    line.vector(",accel_body", &clipped(imu.specific_force_m_s2, MAX_SPECIFIC_FORCE_M_S2));
    line.text("}");
    let (roll, pitch, yaw) = truth.attitude.euler();
    line.vector(",position", &(truth.position_m - step.pad_m).array());
    line.vector(",attitude", &[roll, pitch, yaw]);
    line.vector(",quaternion", &truth.attitude.wxyz());
    line.vector(",velocity", &truth.velocity_m_s.array());
    for (index, range_m) in ranges(step.latest).into_iter().enumerate() {
        line.number(&format!(",rng_{}", index + 1), range_m);
    }
    line.vector(",velocity_wind", &step.wind_m_s.array());
    line.text(",\"battery\":{");
    line.number("voltage", step.battery.voltage_v);
    line.number(",current", step.battery.current_a);
    line.sticks();
    line.0.into_bytes()
}

/// Limits each component.
fn clipped<F>(vector: Vec3<F>, limit: f64) -> [f64; 3] {
    vector.array().map(|v| v.clamp(-limit, limit))
}

/// Returns the ranges down, up, forward, right, backward and left, m.
fn ranges(latest: &Readings) -> [f64; 6] {
    let around = latest.range_around_m.unwrap_or([f64::INFINITY; 8]);
    let down = latest.range_down_m.unwrap_or(f64::INFINITY);
    let up = latest.range_up_m.unwrap_or(f64::INFINITY);
    [down, up, around[0], around[2], around[4], around[6]].map(|range| range.min(OUT_OF_RANGE_M))
}

/// A line of JSON under construction. The caller writes a comma before a key where one is necessary.
struct Line(String);

impl Line {
    fn text(&mut self, text: &str) {
        self.0.push_str(text);
    }

    fn key(&mut self, key: &str) {
        let name = key.trim_start_matches(',');
        self.text(if name.len() < key.len() { ",\"" } else { "\"" });
        self.text(name);
        self.text("\":");
    }

    /// Writes a plain decimal number without an exponent; 0 for a value that is not a number.
    fn value(&mut self, value: f64) {
        let finite = if value.is_finite() { value } else { 0.0 };
        // Writing to a string cannot fail.
        let _ = write!(self.0, "{finite:.9}");
    }

    fn number(&mut self, key: &str, value: f64) {
        self.key(key);
        self.value(value);
    }

    fn vector(&mut self, key: &str, values: &[f64]) {
        self.key(key);
        for (index, value) in values.iter().enumerate() {
            self.text(if index == 0 { "[" } else { "," });
            self.value(*value);
        }
        self.text("]");
    }

    /// Starts the line. The newline before it separates it from a previous line that was lost in part.
    fn timestamp(&mut self, ns: i64) {
        let _ = write!(self.0, "\n{{\"timestamp\":{}.{:09}", ns / 1_000_000_000, ns % 1_000_000_000);
    }

    /// Writes the stick positions and ends the line.
    fn sticks(&mut self) {
        self.text("},\"rc\":{");
        for channel in 1..=STICK_CHANNELS {
            let comma = if channel == 1 { "" } else { "," };
            let _ = write!(self.0, "{comma}\"rc_{channel}\":{CENTERED_STICK_US}");
        }
        self.text("}}\n");
    }
}
