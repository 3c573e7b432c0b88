//! Sensor readings as plain data.

use spandrel_model::frames::{Frd, Ned, Vec3};

/// One accelerometer and gyroscope sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuReading {
    /// Specific force, m/s² (at rest and level: down = -9.81).
    pub specific_force_m_s2: Vec3<Frd>,
    /// Angular rate, rad/s.
    pub rates_rad_s: Vec3<Frd>,
}

impl ImuReading {
    /// No force and no rotation.
    pub const ZERO: Self = Self { specific_force_m_s2: Vec3::zero(), rates_rad_s: Vec3::zero() };
}

impl std::ops::Add for ImuReading {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            specific_force_m_s2: self.specific_force_m_s2 + other.specific_force_m_s2,
            rates_rad_s: self.rates_rad_s + other.rates_rad_s,
        }
    }
}

/// One GNSS fix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GnssReading {
    /// Fix type: 0 = no fix, 2 = 2D, 3 = 3D.
    pub fix: u8,
    /// Satellites used.
    pub satellites: u8,
    /// Position relative to the origin, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Horizontal dilution of precision.
    pub hdop: f64,
    /// Vertical dilution of precision.
    pub vdop: f64,
    /// Horizontal accuracy reported by the receiver, m (1 sigma).
    pub eph_m: f64,
    /// Vertical accuracy reported by the receiver, m (1 sigma).
    pub epv_m: f64,
}

impl GnssReading {
    /// Returns the reading of a receiver that tracks this many satellites but has no fix.
    #[must_use]
    pub fn without_fix(satellites: u8) -> Self {
        Self {
            fix: 0,
            satellites,
            position_m: Vec3::zero(),
            velocity_m_s: Vec3::zero(),
            hdop: 99.99,
            vdop: 99.99,
            eph_m: f64::INFINITY,
            epv_m: f64::INFINITY,
        }
    }
}

/// Readings that become available in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// Accelerometer and gyroscope.
    pub imu: Option<ImuReading>,
    /// GNSS fix.
    pub gnss: Option<GnssReading>,
    /// Barometric height above the origin, m.
    pub baro_up_m: Option<f64>,
    /// Static pressure, Pa (for SCALED_PRESSURE and HIGHRES_IMU).
    pub pressure_pa: Option<f64>,
    /// Magnetic field, gauss, in body axes.
    pub mag_gauss: Option<Vec3<Frd>>,
    /// Downward range, m; `Some(f64::INFINITY)` if nothing is in range.
    pub range_down_m: Option<f64>,
    /// Upward range, m; infinite if nothing is in range.
    pub range_up_m: Option<f64>,
    /// Horizontal ranges in eight sectors clockwise from the nose, m; infinite if nothing is in range.
    pub range_around_m: Option<[f64; 8]>,
    /// Optical-flow velocity over ground.
    pub flow: Option<FlowReading>,
    /// Battery measurement.
    pub battery: Option<BatteryReading>,
}

impl Readings {
    /// Updates each reading that is present in `fresh` and keeps the others.
    pub fn update_latest(&mut self, fresh: &Self) {
        self.imu = fresh.imu.or(self.imu);
        self.gnss = fresh.gnss.or(self.gnss);
        self.baro_up_m = fresh.baro_up_m.or(self.baro_up_m);
        self.pressure_pa = fresh.pressure_pa.or(self.pressure_pa);
        self.mag_gauss = fresh.mag_gauss.or(self.mag_gauss);
        self.range_down_m = fresh.range_down_m.or(self.range_down_m);
        self.range_up_m = fresh.range_up_m.or(self.range_up_m);
        self.range_around_m = fresh.range_around_m.or(self.range_around_m);
        self.flow = fresh.flow.or(self.flow);
        self.battery = fresh.battery.or(self.battery);
    }
}

/// Optical-flow velocity in the body's heading frame (forward, right).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowReading {
    /// Forward velocity relative to the surface, m/s.
    pub forward_m_s: f64,
    /// Velocity to the right relative to the surface, m/s.
    pub right_m_s: f64,
    /// Quality from 0 (unusable) to 1 (best).
    pub quality: f64,
}

/// Battery measurement from the power module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryReading {
    /// Terminal voltage, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Remaining charge, %.
    pub remaining_pct: f64,
}
