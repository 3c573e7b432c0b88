//! Aircraft parameters: one TOML file per aircraft in `vehicle-params/`, parsed into validated types. Each key includes its unit;
//! each number has a source or is marked as an estimate (vehicle-params/README.md, which a test compares with this code).

mod aerodynamics;
mod cold_battery;
mod control_authority;
mod read;

pub use aerodynamics::{
    Aerodynamics, AirDensity, MAX_TRANSLATIONAL_LIFT, SEA_LEVEL_AIR_DENSITY_KG_M3, SurfaceEffects, standard_density_kg_m3,
    standard_temperature_ratio,
};
pub use cold_battery::BATTERY_REFERENCE_C;
pub use read::{FORMAT, read, read_with_keys};

use crate::frames::{Frd, Vec3};
use crate::math;

/// Validated aircraft parameters. Body frame: forward, right, down from the center of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    /// Aircraft ID: the stem of the file name, such as `phantom2`.
    pub id: String,
    /// Display name.
    pub name: String,
    /// Takeoff mass, kg.
    pub mass_kg: f64,
    /// Principal moments of inertia about forward, right, down, kg m².
    pub inertia_kg_m2: [f64; 3],
    /// Rotors in motor order (PX4 quad-x: front right, rear left, front left, rear right).
    pub rotors: Vec<Rotor>,
    /// Rotor parameters shared by all rotors.
    pub rotor: RotorModel,
    /// Aerodynamic body drag.
    pub drag: Drag,
    /// Effects of the air on the rotors.
    pub aerodynamics: Aerodynamics,
    /// Collision hull and contact behavior.
    pub hull: Hull,
    /// Battery parameters.
    pub battery: BatterySpec,
    /// Flight controller limits.
    pub limits: FlightLimits,
    /// Sensor error models and rates.
    pub sensors: SensorSpec,
    /// Camera and gimbal parameters.
    pub camera: Camera,
    /// Lamp aligned with the camera.
    pub lamp: Lamp,
}

impl Vehicle {
    /// Returns the aircraft with the rotor coefficients and drag areas that act in the air at an altitude above mean sea level. If
    /// its file assumes sea-level density everywhere, they don't change.
    #[must_use]
    pub fn at_altitude(&self, altitude_m: f64) -> Self {
        let ratio = self.aerodynamics.air_density.kg_m3(altitude_m) / SEA_LEVEL_AIR_DENSITY_KG_M3;
        let mut out = self.clone();
        out.rotor.thrust_coefficient_n_s2 *= ratio;
        out.rotor.torque_coefficient_n_m_s2 *= ratio;
        out.rotor.drag_coefficient_n_s2_m *= ratio;
        out.aerodynamics.inflow_coefficient_n_s2_m *= ratio;
        out.aerodynamics.translational_lift_n_s2_m2 *= ratio;
        out.drag.area_m2 = out.drag.area_m2.map(|area_m2| area_m2 * ratio);
        out
    }

    /// Returns the vertical damping in hover through the rotors' inflow, divided by the mass, 1/s (the magnitude of Z_w).
    #[must_use]
    pub fn heave_damping_1_s(&self) -> f64 {
        let inflow_n_s2_m = self.aerodynamics.inflow_coefficient_n_s2_m;
        self.rotors.len() as f64 * inflow_n_s2_m * self.hover_rotor_rad_s() / self.mass_kg
    }

    /// Returns the rotor speed in a hover, in rad/s.
    #[must_use]
    pub fn hover_rotor_rad_s(&self) -> f64 {
        self.rotor.hover_speed_rad_s(self.mass_kg, self.rotors.len())
    }
}

/// Position and rotation direction of one rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotor {
    /// Hub position, m.
    pub position_m: Vec3<Frd>,
    /// +1 for counterclockwise rotation seen from above (its reaction torque turns the body clockwise, positive yaw), otherwise
    /// -1.
    pub spin: f64,
}

/// Rotor parameters shared by all rotors. Thrust T = k_T w² and torque Q = k_Q w² at rotor speed w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorModel {
    /// Rotor disk radius, m.
    pub radius_m: f64,
    /// Thrust coefficient k_T, N/(rad/s)².
    pub thrust_coefficient_n_s2: f64,
    /// Torque coefficient k_Q, N m/(rad/s)².
    pub torque_coefficient_n_m_s2: f64,
    /// First-order motor lag, s.
    pub time_constant_s: f64,
    /// Speed at full command, rad/s.
    pub max_speed_rad_s: f64,
    /// Speed at zero command while armed, rad/s.
    pub idle_speed_rad_s: f64,
    /// Standard deviation of the rotors' speeds at equal commands, relative to the speed: motors and speed controllers differ.
    pub speed_spread: f64,
    /// Rotor moment of inertia about its axis, kg m².
    pub inertia_kg_m2: f64,
    /// In-plane rotor drag (H-force) per rotor: N per (rad/s) per (m/s) of in-plane airspeed.
    pub drag_coefficient_n_s2_m: f64,
    /// Fraction of electrical power that becomes induced power in hover, 0 to 1.
    pub efficiency: f64,
}

impl RotorModel {
    /// Returns the speed at which so many rotors carry a mass at rest, in rad/s.
    #[must_use]
    pub fn hover_speed_rad_s(&self, mass_kg: f64, rotors: usize) -> f64 {
        let per_rotor_n = mass_kg * math::GRAVITY_M_S2 / rotors as f64;
        (per_rotor_n / self.thrust_coefficient_n_s2).sqrt()
    }
}

/// Quadratic body drag, F = -½ rho CdA |v_air| v_air per axis, and linear angular damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// Drag area CdA along forward, right, down, m².
    pub area_m2: [f64; 3],
    /// Angular damping about forward, right, down, N m/(rad/s).
    pub angular_damping_n_m_s: [f64; 3],
}

/// Collision hull: the union of convex parts built from these dimensions (arms, rotor disks or cage, feet, body).
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Distance between opposite rotor tips (or the cage's diameter), m.
    pub tip_to_tip_m: f64,
    /// True if a cage or bumpers protect the rotors from contact on all sides.
    pub has_propeller_guard: bool,
    /// Half dimensions of the body box: forward, right, down, m.
    pub body_half_extent_m: [f64; 3],
    /// Landing-gear contact points, m.
    pub feet_m: Vec<Vec3<Frd>>,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Coulomb friction coefficient.
    pub friction: f64,
}

/// Parameters of a lithium-polymer battery.
#[derive(Debug, Clone, PartialEq)]
pub struct BatterySpec {
    /// Cells in series.
    pub cells: u32,
    /// Capacity, A h.
    pub capacity_ah: f64,
    /// Internal resistance of the pack, ohm.
    pub internal_resistance_ohm: f64,
    /// Open-circuit voltage per cell at state of charge 0, 0.1, … 1.0, V (11 increasing values).
    pub ocv_cell_v: [f64; 11],
    /// Avionics load, W.
    pub avionics_power_w: f64,
    /// Lamp load when on, W.
    pub lamp_power_w: f64,
    /// Endurance of the `paper` battery model, which discharges linearly from 100% to 0%, s.
    pub paper_endurance_s: f64,
}

/// Maximum speeds, rates and tilt that a pilot can command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Forward and backward speed at full stick in position mode, m/s.
    pub forward_m_s: f64,
    /// Sideways speed at full stick, m/s.
    pub sideways_speed_m_s: f64,
    /// Climb speed at full stick, m/s.
    pub climb_m_s: f64,
    /// Descent speed at full stick, m/s.
    pub descend_m_s: f64,
    /// Yaw rate at full stick, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Maximum tilt, rad.
    pub tilt_rad: f64,
    /// Maximum roll and pitch rate, rad/s.
    pub rate_rad_s: f64,
    /// Time from full speed to standstill after the stick is released, s (the slow-down time of the TASBID paper).
    pub slow_down_time_s: f64,
}

/// Sensor rates and errors. White noise is given as the standard deviation per sample or as a density, bias as the standard
/// deviation at startup.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorSpec {
    /// Accelerometer and gyroscope rate, Hz.
    pub imu_rate_hz: f64,
    /// Accelerometer noise density, m/s²/sqrt(Hz).
    pub accel_noise_density: f64,
    /// Accelerometer bias at startup, m/s².
    pub accel_bias_m_s2: f64,
    /// Gyroscope noise density, rad/s/sqrt(Hz).
    pub gyro_noise_density: f64,
    /// Gyroscope bias at startup, rad/s.
    pub gyro_bias_rad_s: f64,
    /// Vibration at the accelerometer in a hover, m/s² (standard deviation per axis).
    pub accel_vibration_m_s2: f64,
    /// Vibration at the gyroscope in a hover, rad/s (standard deviation per axis).
    pub gyro_vibration_rad_s: f64,
    /// GNSS rate, Hz.
    pub gnss_rate_hz: f64,
    /// GNSS horizontal position noise under an open sky, m.
    pub gnss_horizontal_noise_m: f64,
    /// GNSS vertical position noise under an open sky, m.
    pub gnss_vertical_noise_m: f64,
    /// GNSS velocity noise, m/s.
    pub gnss_velocity_noise_m_s: f64,
    /// Time from the instant that a GNSS reading describes until the autopilot gets it, s.
    pub gnss_delay_s: f64,
    /// Barometer rate, Hz.
    pub baro_rate_hz: f64,
    /// Barometer noise, m.
    pub baro_noise_m: f64,
    /// Barometer drift (random walk), m/sqrt(s).
    pub baro_drift_m_sqrt_s: f64,
    /// Static pressure error of the barometer, as a fraction of the dynamic pressure of the horizontal airflow. With a positive
    /// value, the pressure is too low and the height too large.
    pub baro_airflow: f64,
    /// Magnetometer rate, Hz.
    pub mag_rate_hz: f64,
    /// Magnetometer noise, gauss.
    pub mag_noise_gauss: f64,
    /// Magnetometer bias per body axis after calibration, gauss.
    pub mag_bias_gauss: f64,
    /// Range finder rate, Hz.
    pub range_rate_hz: f64,
    /// Range finder noise, m.
    pub range_noise_m: f64,
    /// Bias of each range finder, m.
    pub range_bias_m: f64,
    /// Maximum measurable distance of the range finders, m.
    pub range_max_m: f64,
    /// Optical-flow horizontal velocity noise with sufficient light and texture, m/s; 0 if there is no optical-flow sensor.
    pub flow_velocity_m_s: f64,
}

/// Parameters of a camera on a pitch gimbal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Lens position, m.
    pub position_m: Vec3<Frd>,
    /// Image width, px.
    pub width_px: u32,
    /// Image height, px.
    pub height_px: u32,
    /// Horizontal field of view, rad; for a zoom lens, at the wide end.
    pub hfov_rad: f64,
    /// Zoom ratio: longest focal length over shortest; 1 for a fixed lens.
    pub zoom_max: f64,
    /// Aperture as an f-number.
    pub f_number: f64,
    /// Maximum ISO sensitivity.
    pub iso_max: f64,
    /// Maximum exposure time for a sharp image, s.
    pub max_exposure_time_s: f64,
    /// Minimum gimbal pitch, rad; negative looks down.
    pub gimbal_pitch_min_rad: f64,
    /// Maximum gimbal pitch, rad.
    pub gimbal_pitch_max_rad: f64,
    /// Gimbal rate, rad/s.
    pub gimbal_rate_rad_s: f64,
}

/// Sensor width, mm (1/2.3 inch; estimate), used to derive focal lengths in mm from the field of view.
pub const SENSOR_WIDTH_MM: f64 = 6.17;

impl Camera {
    /// Returns the focal length in mm for a sensor of width [`SENSOR_WIDTH_MM`].
    #[must_use]
    pub fn focal_mm(&self) -> f64 {
        0.5 * SENSOR_WIDTH_MM / math::tan(0.5 * self.hfov_rad)
    }

    /// Returns the aspect ratio, width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.width_px) / f64::from(self.height_px)
    }

    /// Returns the focal length of the ideal pinhole in pixels.
    #[must_use]
    pub fn focal_px(&self) -> f64 {
        0.5 * f64::from(self.width_px) / math::tan(0.5 * self.hfov_rad)
    }

    /// Returns the vertical field of view in radians.
    #[must_use]
    pub fn vfov_rad(&self) -> f64 {
        2.0 * math::atan2(0.5 * f64::from(self.height_px), self.focal_px())
    }

    /// Returns the camera zoomed in to `ratio` times its shortest focal length; a ratio of 1 or less returns it unchanged.
    #[must_use]
    pub fn zoomed(&self, ratio: f64) -> Self {
        if ratio <= 1.0 {
            return *self;
        }
        Self { hfov_rad: 2.0 * math::atan2(math::tan(0.5 * self.hfov_rad), ratio), ..*self }
    }
}

/// Parameters of a lamp aligned with the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Luminous flux, lm; 0 if there is no lamp.
    pub luminous_flux_lm: f64,
    /// Full beam angle, rad.
    pub beam_angle_rad: f64,
}
