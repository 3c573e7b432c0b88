//! Calibration texts, which ground stations parse.

/// The sensor or reference that is being calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CalibratedSensor {
    Gyro,
    Barometer,
    Level,
    Accelerometer,
}

impl CalibratedSensor {
    /// Returns the keyword that QGroundControl expects in the texts.
    fn keyword(self) -> &'static str {
        match self {
            Self::Gyro => "gyro",
            Self::Barometer => "baro",
            Self::Level => "level",
            Self::Accelerometer => "accel",
        }
    }
}

/// Calibration text format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationTexts {
    /// PX4's texts, which begin with `[cal]` (QGroundControl: SensorsComponentController).
    Px4,
    /// ArduPilot's texts, as recorded.
    ArduPilot,
}

impl CalibrationTexts {
    pub(super) fn start(self, sensor: CalibratedSensor) -> Option<String> {
        match (self, sensor) {
            (Self::Px4, _) => Some(format!("[cal] calibration started: 2 {}", sensor.keyword())),
            (Self::ArduPilot, CalibratedSensor::Barometer) => Some("Updating barometer calibration".into()),
            (Self::ArduPilot, CalibratedSensor::Gyro) => Some("Initialising ArduPilot".into()),
            (Self::ArduPilot, CalibratedSensor::Level | CalibratedSensor::Accelerometer) => None,
        }
    }

    pub(super) fn progress(self, percent: u32) -> Option<String> {
        (self == Self::Px4).then(|| format!("[cal] progress <{percent}>"))
    }

    pub(super) fn done(self, sensor: CalibratedSensor) -> Option<String> {
        match (self, sensor) {
            (Self::Px4, _) => Some(format!("[cal] calibration done: {}", sensor.keyword())),
            (Self::ArduPilot, CalibratedSensor::Barometer) => Some("Barometer calibration complete".into()),
            (Self::ArduPilot, _) => None,
        }
    }

    pub(super) fn failed(self, why: &str) -> String {
        match self {
            Self::Px4 => format!("[cal] calibration failed: {why}"),
            Self::ArduPilot => format!("Calibration FAILED: {why}"),
        }
    }
}
