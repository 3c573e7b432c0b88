//! What the filter assumes about its sensors: the data-sheet numbers of the aircraft file, and defaults of PX4's EKF2 or estimates where data
//! sheets say nothing. How the simulated sensors make their errors is not known here.

use super::covariance::ProcessNoise;
use spandrel_model::vehicle::SensorSpec;

/// Noise of the accelerometer with running rotors, m/s², and of the gyroscope, rad/s, at [`PREDICTION_RATE_HZ`] (PX4's EKF2_ACC_NOISE and
/// EKF2_GYR_NOISE).
const ACCEL_NOISE_M_S2: f64 = 0.35;
const GYRO_NOISE_RAD_S: f64 = 0.015;
/// Change of the accelerometer bias, m/s³, and of the gyroscope bias, rad/s², at [`PREDICTION_RATE_HZ`] (PX4's EKF2_ACC_B_NOISE and
/// EKF2_GYR_B_NOISE).
const ACCEL_BIAS_NOISE_M_S3: f64 = 0.003;
const GYRO_BIAS_NOISE_RAD_S2: f64 = 0.001;
/// Rate for which these four values hold, Hz (PX4's EKF2_PREDICT_US).
const PREDICTION_RATE_HZ: f64 = 100.0;
/// Time constant of the offset of the GNSS height, s (estimate).
const GNSS_HEIGHT_TIME_S: f64 = 60.0;
/// Part of the receiver's accuracy that changes from fix to fix (estimate).
const GNSS_WHITE_FRACTION: f64 = 0.3;
/// Offset of the barometer when it is switched on, m (estimate).
pub(super) const BARO_START_OFFSET_M: f64 = 0.3;
/// Error of optical flow as a fraction of the speed (estimate).
const FLOW_SPEED_ERROR: f64 = 0.03;

/// Measurement noise, one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeasurementNoise {
    pub(super) gnss_velocity_m_s: f64,
    /// Accuracy of a fix under an open sky, horizontal and vertical, m.
    pub(super) gnss_m: [f64; 2],
    /// Part of the vertical accuracy that changes from fix to fix, m.
    pub(super) gnss_height_white_m: f64,
    pub(super) baro_m: f64,
    pub(super) mag_gauss: f64,
    pub(super) mag_bias_gauss: f64,
    pub(super) flow_m_s: f64,
    pub(super) accel_bias_m_s2: f64,
    pub(super) gyro_bias_rad_s: f64,
    /// Accelerometer at rest, in one sample, m/s².
    pub(super) accel_sample_m_s2: f64,
    /// Gyroscope at rest, in one sample, rad/s.
    pub(super) gyro_sample_rad_s: f64,
    /// Drift of the barometer, m²/s.
    pub(super) baro_walk: f64,
    pub(super) range_m: f64,
}

impl MeasurementNoise {
    pub(super) fn of(sensors: &SensorSpec) -> Self {
        let rate = sensors.imu_rate_hz.sqrt();
        Self {
            gnss_velocity_m_s: sensors.gnss_velocity_noise_m_s,
            gnss_m: [sensors.gnss_horizontal_noise_m, sensors.gnss_vertical_noise_m],
            gnss_height_white_m: GNSS_WHITE_FRACTION * sensors.gnss_vertical_noise_m,
            baro_m: sensors.baro_noise_m,
            mag_gauss: sensors.mag_noise_gauss,
            mag_bias_gauss: sensors.mag_bias_gauss,
            flow_m_s: sensors.flow_velocity_m_s,
            accel_bias_m_s2: sensors.accel_bias_m_s2,
            gyro_bias_rad_s: sensors.gyro_bias_rad_s,
            accel_sample_m_s2: sensors.accel_noise_density * rate,
            gyro_sample_rad_s: sensors.gyro_noise_density * rate,
            baro_walk: sensors.baro_drift_m_sqrt_s * sensors.baro_drift_m_sqrt_s,
            range_m: sensors.range_noise_m,
        }
    }

    /// Returns the variance of a velocity from optical flow at a speed, (m/s)².
    pub(super) fn flow_variance(&self, speed_m_s: f64) -> f64 {
        let scale = FLOW_SPEED_ERROR * speed_m_s;
        self.flow_m_s * self.flow_m_s + scale * scale
    }
}

/// Returns the process noise.
pub(super) fn process_noise(noise: &MeasurementNoise) -> ProcessNoise {
    let density = |at_prediction_rate: f64| at_prediction_rate * at_prediction_rate / PREDICTION_RATE_HZ;
    ProcessNoise {
        accel: density(ACCEL_NOISE_M_S2),
        gyro: density(GYRO_NOISE_RAD_S),
        accel_walk: density(ACCEL_BIAS_NOISE_M_S3),
        gyro_walk: density(GYRO_BIAS_NOISE_RAD_S2),
        gnss_height: noise.gnss_m[1] * noise.gnss_m[1],
        gnss_height_time_s: GNSS_HEIGHT_TIME_S,
        baro_walk: noise.baro_walk,
    }
}
