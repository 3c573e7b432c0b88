//! MAV_CMD_PREFLIGHT_CALIBRATION: calibrates the sensors that need no rotation, and reports progress in the texts that
//! ground stations parse.

mod measurement;
mod texts;

use super::VehicleLink;
use super::inbound::InboundMessage;
use super::params::ParamValue;
use super::snapshot::VehicleSnapshot;
use crate::endpoint::vehicle_command::VehicleCommand;
pub use measurement::Calibration;
use measurement::MEASUREMENT_S;
use spandrel_mavlink::dialect::MavResult;
use texts::CalibratedSensor;
pub use texts::CalibrationTexts;

/// Number of progress reports.
const PROGRESS_STEPS: u32 = 5;

/// Handles the command. Its parameters are 1 gyro, 2 compass, 3 barometer, 4 radio, 5 accelerometer, 6 airspeed, and 7
/// ESC. All zeros cancel the calibration.
pub(super) fn command(c: &VehicleCommand, v: &mut VehicleLink, a: &InboundMessage) -> MavResult {
    use MavResult as R;
    let texts = v.flavor.calibration;
    let param = |k: usize| c.finite_param(k).unwrap_or(0.0);
    if (0..7).all(|k| param(k) == 0.0) {
        if v.calibration.take().is_some() && texts == CalibrationTexts::Px4 {
            v.inform("[cal] calibration cancelled");
        }
        return R::MAV_RESULT_ACCEPTED;
    }
    if a.autopilot.status().armed || v.calibration.is_some() {
        return v.flavor.refusals.temporary_rejection;
    }
    // The ground station calibrates the radio; the vehicle only reads its channels.
    if param(3) != 0.0 {
        return R::MAV_RESULT_ACCEPTED;
    }
    let rotated = if param(1) == 1.0 { Some("mag") } else { (param(4) == 1.0).then_some("accel") };
    if let Some(what) = rotated {
        if texts == CalibrationTexts::Px4 {
            v.inform(&format!("[cal] calibration started: 2 {what}"));
        }
        v.warn(&texts.failed("this vehicle cannot be rotated by hand"));
        return if texts == CalibrationTexts::Px4 { R::MAV_RESULT_ACCEPTED } else { R::MAV_RESULT_FAILED };
    }
    let sensor = match (param(0), param(2), param(4)) {
        (1.0, ..) => CalibratedSensor::Gyro,
        (_, 1.0, _) => CalibratedSensor::Barometer,
        (.., 2.0) => CalibratedSensor::Level,
        (.., 4.0) => CalibratedSensor::Accelerometer,
        _ => return R::MAV_RESULT_UNSUPPORTED,
    };
    v.calibration = Some(Calibration::start(sensor, a.now()));
    if let Some(text) = texts.start(sensor) {
        v.inform(&text);
    }
    R::MAV_RESULT_ACCEPTED
}

impl VehicleLink {
    /// Updates the running calibration and finishes it when it is complete.
    pub(super) fn step_calibration(&mut self, view: &VehicleSnapshot) {
        let Some(mut running) = self.calibration.take() else { return };
        let texts = self.flavor.calibration;
        let done = running.measure(view.readings, view.clock.now);
        let steps = ((view.clock.now - running.since).s() / MEASUREMENT_S * f64::from(PROGRESS_STEPS)) as u32;
        if steps > running.steps && steps <= PROGRESS_STEPS {
            running.steps = steps;
            texts.progress(100 / PROGRESS_STEPS * steps).into_iter().for_each(|text| self.inform(&text));
        }
        if view.status.armed {
            self.warn(&texts.failed("armed"));
        } else if !done {
            self.calibration = Some(running);
        } else {
            self.end_calibration(&running, texts);
        }
    }

    fn end_calibration(&mut self, ended: &Calibration, texts: CalibrationTexts) {
        match ended.outcome() {
            Ok(offset) => {
                if ended.sensor == CalibratedSensor::Gyro {
                    for (name, value) in GYRO_OFFSETS.iter().zip(offset.array()) {
                        // Only PX4 has parameters for the offsets.
                        let _ = self.params.set_value(name, ParamValue::Real(value as f32));
                    }
                }
                texts.done(ended.sensor).into_iter().for_each(|text| self.inform(&text));
            }
            Err(why) => self.warn(&texts.failed(why)),
        }
    }
}

/// PX4's gyroscope offset parameters, rad/s.
const GYRO_OFFSETS: [&str; 3] = ["CAL_GYRO0_XOFF", "CAL_GYRO0_YOFF", "CAL_GYRO0_ZOFF"];
