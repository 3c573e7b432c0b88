//! Sensors: one file each, with noise, bias and a rate of its own. What they return is all that the autopilot ever sees.

use crate::base::frames::{Frd, Ned, Vec3};

/// One reading of accelerometer and gyroscope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuReading {
    /// Specific force, m/s² (at rest and level: down = -9.81).
    pub specific_force_m_s2: Vec3<Frd>,
    /// Angular rate, rad/s.
    pub rates_rad_s: Vec3<Frd>,
}

/// One GNSS fix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GnssReading {
    /// 0 none, 2 two-dimensional, 3 three-dimensional.
    pub fix: u8,
    /// Satellites used.
    pub satellites: u8,
    /// Position about the origin, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Horizontal dilution of precision.
    pub hdop: f64,
    /// Vertical dilution of precision.
    pub vdop: f64,
    /// Horizontal accuracy that the receiver claims, m (1 sigma).
    pub eph_m: f64,
    /// Vertical accuracy that the receiver claims, m (1 sigma).
    pub epv_m: f64,
}

/// Readings that became available in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// Accelerometer and gyroscope.
    pub imu: Option<ImuReading>,
    /// GNSS.
    pub gnss: Option<GnssReading>,
    /// Barometric height over the origin, m up.
    pub baro_up_m: Option<f64>,
    /// Static pressure, Pa (for SCALED_PRESSURE and HIGHRES_IMU).
    pub pressure_pa: Option<f64>,
    /// Magnetic field, gauss.
    pub mag_gauss: Option<Vec3<Frd>>,
    /// Range finder downwards, m; `Some(f64::INFINITY)` when nothing is within reach.
    pub range_down_m: Option<f64>,
    /// Range finder upwards, m.
    pub range_up_m: Option<f64>,
    /// Horizontal ranges in eight sectors clockwise from the nose, m.
    pub range_around_m: Option<[f64; 8]>,
    /// Optical flow: velocity over ground in the body's heading frame (forward, right), m/s, with its quality 0..1.
    pub flow: Option<FlowReading>,
    /// Battery as measured.
    pub battery: Option<BatteryReading>,
}

/// Optical-flow velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowReading {
    /// Forward velocity over the surface below, m/s.
    pub forward_m_s: f64,
    /// Velocity to the right, m/s.
    pub right_m_s: f64,
    /// 0 useless, 1 best.
    pub quality: f64,
}

/// Battery as the power module measures it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryReading {
    /// Terminal voltage, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Remaining, %.
    pub remaining_pct: f64,
}
