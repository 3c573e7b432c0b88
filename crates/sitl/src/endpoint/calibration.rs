//! MAV_CMD_PREFLIGHT_CALIBRATION: calibrates the sensors that need no rotation, and reports progress in the texts that ground
//! stations parse.

use super::Endpoint;
use super::commands::VehicleCommand;
use super::context::CommandContext;
use super::params::ParamValue;
use super::snapshot::VehicleSnapshot;
use spandrel_mavlink::dialect::{MavResult, MavSeverity};
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::time::SimTime;

/// Averaging time, s (PX4's gyro calibration takes about as long).
const MEASURE_S: f64 = 4.0;
/// Number of progress reports.
const STEPS: u32 = 5;
/// Maximum rate difference between the two halves of the measurement at rest, rad/s (PX4: gyro calibration, 0.01 rad/s).
const STILL_RAD_S: f64 = 0.01;
/// Maximum specific force difference between the halves, m/s² (estimate: ten times the noise of the mean).
const STILL_M_S2: f64 = 0.05;
/// Maximum deviation from 1 g at rest, m/s².
const REST_M_S2: f64 = 1.0;
/// Maximum horizontal component of gravity for a level vehicle, m/s² (30 degrees; PX4: level calibration).
const LEVEL_M_S2: f64 = 0.5 * GRAVITY_M_S2;

/// The sensor or reference being calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CalibratedSensor {
    Gyro,
    Barometer,
    Level,
    Accelerometer,
}

impl CalibratedSensor {
    /// Returns the keyword that QGroundControl expects in the texts.
    fn word(self) -> &'static str {
        match self {
            Self::Gyro => "gyro",
            Self::Barometer => "baro",
            Self::Level => "level",
            Self::Accelerometer => "accel",
        }
    }
}

/// Format of the calibration texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationTexts {
    /// PX4's texts, which begin with `[cal]` (QGroundControl: SensorsComponentController).
    Px4,
    /// ArduPilot's texts, as recorded.
    ArduPilot,
}

impl CalibrationTexts {
    fn start(self, sensor: CalibratedSensor) -> Option<String> {
        match (self, sensor) {
            (Self::Px4, _) => Some(format!("[cal] calibration started: 2 {}", sensor.word())),
            (Self::ArduPilot, CalibratedSensor::Barometer) => Some("Updating barometer calibration".into()),
            (Self::ArduPilot, CalibratedSensor::Gyro) => Some("Initialising ArduPilot".into()),
            (Self::ArduPilot, CalibratedSensor::Level | CalibratedSensor::Accelerometer) => None,
        }
    }

    fn progress(self, percent: u32) -> Option<String> {
        (self == Self::Px4).then(|| format!("[cal] progress <{percent}>"))
    }

    fn done(self, sensor: CalibratedSensor) -> Option<String> {
        match (self, sensor) {
            (Self::Px4, _) => Some(format!("[cal] calibration done: {}", sensor.word())),
            (Self::ArduPilot, CalibratedSensor::Barometer) => Some("Barometer calibration complete".into()),
            (Self::ArduPilot, _) => None,
        }
    }

    fn failed(self, why: &str) -> String {
        match self {
            Self::Px4 => format!("[cal] calibration failed: {why}"),
            Self::ArduPilot => format!("Calibration FAILED: {why}"),
        }
    }
}

/// Sums over one half of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct HalfSums {
    rates: Vec3<Frd>,
    force: Vec3<Frd>,
    samples: u32,
}

impl HalfSums {
    fn means(&self) -> (Vec3<Frd>, Vec3<Frd>) {
        let share = 1.0 / f64::from(self.samples.max(1));
        (self.rates * share, self.force * share)
    }
}

/// A calibration in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    sensor: CalibratedSensor,
    since: SimTime,
    halves: [HalfSums; 2],
    steps: u32,
}

/// Handles the command: parameters 1 gyro, 2 compass, 3 barometer, 4 radio, 5 accelerometer, 6 airspeed, 7 ESC. All zero cancels
/// the calibration.
pub(super) fn command(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    use MavResult as R;
    let words = x.view.flavour.calibration;
    let asked = |k: usize| c.finite_param(k).unwrap_or(0.0);
    if (0..7).all(|k| asked(k) == 0.0) {
        if x.calibration.take().is_some() && words == CalibrationTexts::Px4 {
            x.inform_all("[cal] calibration cancelled");
        }
        return R::MAV_RESULT_ACCEPTED;
    }
    if x.view.status.armed || x.calibration.is_some() {
        return x.view.flavour.refusals.for_now;
    }
    // The radio is calibrated by the ground station; the vehicle only reads its channels.
    if asked(3) != 0.0 {
        return R::MAV_RESULT_ACCEPTED;
    }
    let rotated = if asked(1) == 1.0 { Some("mag") } else { (asked(4) == 1.0).then_some("accel") };
    if let Some(what) = rotated {
        if words == CalibrationTexts::Px4 {
            x.inform_all(&format!("[cal] calibration started: 2 {what}"));
        }
        x.warn_all(&words.failed("this vehicle cannot be rotated by hand"));
        return if words == CalibrationTexts::Px4 { R::MAV_RESULT_ACCEPTED } else { R::MAV_RESULT_FAILED };
    }
    let sensor = match (asked(0), asked(2), asked(4)) {
        (1.0, ..) => CalibratedSensor::Gyro,
        (_, 1.0, _) => CalibratedSensor::Barometer,
        (.., 2.0) => CalibratedSensor::Level,
        (.., 4.0) => CalibratedSensor::Accelerometer,
        _ => return R::MAV_RESULT_UNSUPPORTED,
    };
    *x.calibration = Some(Calibration { sensor, since: x.view.now, halves: [HalfSums::default(); 2], steps: 0 });
    if let Some(text) = words.start(sensor) {
        x.inform_all(&text);
    }
    R::MAV_RESULT_ACCEPTED
}

impl Calibration {
    /// Adds the latest reading. Returns true once the measuring time has passed.
    fn measure(&mut self, view: &VehicleSnapshot) -> bool {
        let age_s = (view.now - self.since).s();
        let half = &mut self.halves[usize::from(age_s > 0.5 * MEASURE_S)];
        if let Some(imu) = view.readings.imu {
            half.rates += imu.rates_rad_s;
            half.force += imu.specific_force_m_s2;
            half.samples += 1;
        }
        age_s >= MEASURE_S
    }

    /// Returns the gyroscope bias, rad/s, or the reason for the failure.
    fn outcome(&self) -> Result<Vec3<Frd>, &'static str> {
        let [(rates_0, force_0), (rates_1, force_1)] = self.halves.map(|half| half.means());
        let force = (force_0 + force_1) * 0.5;
        if self.halves.iter().any(|half| half.samples == 0) {
            return Err("reading sensor");
        }
        let turned = (rates_1 - rates_0).array().iter().any(|rate| rate.abs() > STILL_RAD_S);
        if turned || (force_1 - force_0).norm() > STILL_M_S2 || (force.norm() - GRAVITY_M_S2).abs() > REST_M_S2 {
            return Err("vehicle moved");
        }
        if self.sensor == CalibratedSensor::Level && force.forward().abs().max(force.right().abs()) > LEVEL_M_S2 {
            return Err("excess roll or pitch angle");
        }
        Ok((rates_0 + rates_1) * 0.5)
    }
}

impl Endpoint {
    /// Updates the running calibration and finishes it when it is complete.
    pub(super) fn calibrate(&mut self, view: &VehicleSnapshot) {
        let Some(mut running) = self.calibration.take() else { return };
        let words = self.flavour.calibration;
        let done = running.measure(view);
        let steps = ((view.now - running.since).s() / MEASURE_S * f64::from(STEPS)) as u32;
        if steps > running.steps && steps <= STEPS {
            running.steps = steps;
            words
                .progress(100 / STEPS * steps)
                .into_iter()
                .for_each(|text| self.push_text(MavSeverity::MAV_SEVERITY_INFO, &text));
        }
        if view.status.armed {
            self.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &words.failed("armed"));
        } else if !done {
            self.calibration = Some(running);
        } else {
            self.end_calibration(&running, words);
        }
    }

    fn end_calibration(&mut self, ended: &Calibration, words: CalibrationTexts) {
        match ended.outcome() {
            Ok(offset) => {
                if ended.sensor == CalibratedSensor::Gyro {
                    for (name, value) in GYRO_OFFSETS.iter().zip(offset.array()) {
                        // Only PX4 has parameters for the offsets.
                        let _ = self.params.set_value(name, ParamValue::Real(value as f32));
                    }
                }
                words.done(ended.sensor).into_iter().for_each(|text| self.push_text(MavSeverity::MAV_SEVERITY_INFO, &text));
            }
            Err(why) => self.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &words.failed(why)),
        }
    }
}

/// PX4's gyroscope offset parameters, rad/s.
const GYRO_OFFSETS: [&str; 3] = ["CAL_GYRO0_XOFF", "CAL_GYRO0_YOFF", "CAL_GYRO0_ZOFF"];
