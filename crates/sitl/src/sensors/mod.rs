//! Sensor models, one per file, each with its own noise, bias and rate. The autopilot gets no other information about
//! the vehicle.

pub mod baro;
mod dilution;
pub mod flow;
pub mod gnss;
pub mod imu;
pub mod magnetometer;
pub mod rangefinder;
mod readings;
pub mod sky;
mod surroundings;
pub mod vibration;
pub mod water;

pub use readings::{BatteryReading, FlowReading, GnssReading, ImuReading, Readings};
pub use surroundings::{FlatGround, Surroundings};

use crate::physics::{MAX_ROTORS, PhysicsState, RigidState};
use rangefinder::RangeReadings;
use spandrel_mavlink::contract::hazards::WaterSensors;
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::scenario::bridges::Member;
use spandrel_model::site::steel::SteelField;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::{Lamp, Vehicle};
use std::sync::Arc;

/// True state that the sensors measure in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorInputs<'a> {
    /// Motion state.
    pub rigid: &'a RigidState,
    /// Velocity relative to the air, m/s.
    pub air_velocity_m_s: Vec3<Ned>,
    /// Battery terminal values.
    pub battery: BatteryReading,
    /// Whether the lamp is on.
    pub lamp_on: bool,
}

/// Motion that the inertial sensors feel in one physics step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeltMotion {
    /// Specific force, m/s².
    pub specific_force_m_s2: Vec3<Frd>,
    /// Angular rates, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Rotor speeds, rad/s.
    pub rotor_rad_s: [f64; MAX_ROTORS],
}

impl FeltMotion {
    /// Returns the motion of an aircraft's last physics step.
    #[must_use]
    pub fn of(state: &PhysicsState) -> Self {
        let rigid = &state.rigid;
        Self { specific_force_m_s2: state.specific_force_m_s2, rates_rad_s: rigid.rates_rad_s, rotor_rad_s: rigid.rotor_rad_s }
    }
}

/// All sensors of one aircraft, as plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensors {
    imu_due: Schedule,
    power_due: Schedule,
    light_due: Schedule,
    imu: imu::Imu,
    vibration: Option<vibration::RotorVibration>,
    gnss: gnss::GnssReceiver,
    baro: baro::Barometer,
    magnetometer: magnetometer::Magnetometer,
    ranges: rangefinder::RangeFinders,
    flow: flow::OpticalFlow,
    water: Option<water::WaterSurface>,
    below: water::Below,
    over_water: WaterSensors,
    lamp: Lamp,
    nearest_m: f64,
    ambient_lux: f64,
}

/// Rate of the power module, Hz (estimate).
const POWER_MODULE_RATE_HZ: f64 = 10.0;
/// Update rate of ambient light for the flow sensor, Hz.
const AMBIENT_LIGHT_RATE_HZ: f64 = 2.0;

/// Properties of a site that affect the sensors.
#[derive(Debug, Clone)]
pub struct SensorSite {
    /// Origin of the site.
    pub origin: Geo,
    /// True if structures hide satellites.
    pub gnss_shadow: bool,
    /// Steel that distorts the magnetic field; `None` if none does.
    pub steel: Option<Arc<SteelField>>,
    /// True if water disturbs the optical flow and the range finder that looks down.
    pub water: bool,
    /// Real sky above the site; `None` for the fixed constellation.
    pub sky: Option<Arc<sky::Sky>>,
}

impl SensorSite {
    /// Returns a site whose structures don't affect the sensors.
    #[must_use]
    pub fn open(origin: Geo) -> Self {
        Self { origin, gnss_shadow: false, steel: None, water: false, sky: None }
    }

    /// Returns the effects that a job has switched on.
    #[must_use]
    pub fn of(scenario: &Scenario, members: &[Member]) -> Self {
        let steel = scenario.hazards.compass.then(|| Arc::new(SteelField::new(members, scenario.hazards.severity)));
        let sky = scenario.hazards.sky.then(|| Arc::new(sky::Sky::new(scenario, members)));
        let (gnss_shadow, water) = (scenario.rules.gnss_shadow, scenario.hazards.water);
        Self { origin: scenario.origin, gnss_shadow, steel, water, sky }
    }
}

impl Sensors {
    /// Creates the sensors of an aircraft.
    #[must_use]
    pub fn new(vehicle: &Vehicle, site: SensorSite, seed: u64) -> Self {
        let SensorSite { origin, gnss_shadow, steel, water, sky } = site;
        let spec = &vehicle.sensors;
        let real_sky = sky.map(|sky| Box::new(sky::SkyReceiver::new(spec, sky, seed)));
        let fitted = spec.flow_velocity_m_s > 0.0;
        Self {
            imu_due: Schedule::new(SimTime::ZERO, spec.imu_rate_hz),
            power_due: Schedule::new(SimTime::ZERO, POWER_MODULE_RATE_HZ),
            light_due: Schedule::new(SimTime::ZERO, if fitted { AMBIENT_LIGHT_RATE_HZ } else { 0.0 }),
            imu: imu::Imu::new(spec, seed),
            vibration: vibration::RotorVibration::of(vehicle, seed),
            gnss: gnss::GnssReceiver::new(spec, gnss_shadow, real_sky, seed),
            baro: baro::Barometer::new(spec, origin.altitude_m, seed),
            magnetometer: magnetometer::Magnetometer::new(spec, origin, steel, seed),
            ranges: rangefinder::RangeFinders::new(spec, seed),
            flow: flow::OpticalFlow::new(spec, seed),
            water: water.then(|| water::WaterSurface::new(seed)),
            below: water::Below::Solid,
            over_water: WaterSensors::default(),
            lamp: vehicle.lamp,
            nearest_m: f64::INFINITY,
            ambient_lux: 0.0,
        }
    }

    /// Returns by how much steel turns the direction of a compass at a position, rad, clockwise positive.
    #[must_use]
    pub fn compass_error_rad(&self, position_m: Vec3<Ned>) -> f64 {
        self.magnetometer.direction_error_rad(position_m)
    }

    /// Returns what water does to the optical flow and the range finder that looks down; `None` if the job does not simulate it.
    #[must_use]
    pub fn over_water(&self) -> Option<WaterSensors> {
        self.water.as_ref().map(|_| self.over_water)
    }

    /// Integrates the inertial sensors. Call it after every physics step, so that they capture all motion between two
    /// samples.
    pub fn integrate_imu(&mut self, motion: &FeltMotion, dt: SimTime) {
        self.imu.integrate(motion.specific_force_m_s2, motion.rates_rad_s, dt);
        if let Some(vibration) = &mut self.vibration {
            vibration.advance(&motion.rotor_rad_s, dt);
        }
    }

    /// Returns all readings that are due at `now`.
    pub fn sample<S: Surroundings>(&mut self, truth: &SensorInputs<'_>, site: &S, now: SimTime) -> Readings {
        let rigid = truth.rigid;
        let position_m = rigid.position_m.enu();
        let mut out = Readings::default();
        if self.imu_due.fire(now) {
            out.imu = self.imu.read();
            if let (Some(vibration), Some(reading)) = (&mut self.vibration, &mut out.imu) {
                vibration.add_to(reading);
            }
        }
        out.gnss = self.gnss.read(rigid, site, now);
        if let Some((up_m, pressure_pa)) = self.baro.read(position_m.up(), truth.air_velocity_m_s, now) {
            out.baro_up_m = Some(up_m);
            out.pressure_pa = Some(pressure_pa);
        }
        out.mag_gauss = self.magnetometer.read(rigid, now);
        if let Some(mut ranges) = self.ranges.read(rigid, site, now) {
            if let Some(water) = &mut self.water {
                self.below = water.look_down(position_m, &mut ranges.down_m, site);
                self.over_water.ranges += u32::from(self.below != water::Below::Solid);
                self.over_water.lost_ranges += u32::from(self.below != water::Below::Solid && ranges.down_m.is_infinite());
            }
            out.range_down_m = Some(ranges.down_m);
            out.range_up_m = Some(ranges.up_m);
            out.range_around_m = Some(ranges.around_m);
            self.nearest_m = match self.below {
                water::Below::Solid | water::Below::NearWater => ranges.min_range_m(),
                water::Below::FarWater => RangeReadings { down_m: f64::INFINITY, ..ranges }.min_range_m(),
            };
        }
        if self.light_due.fire(now) {
            self.ambient_lux = site.lux(position_m, now);
        }
        if self.flow.due(now) {
            let lux = self.ambient_lux + self.lamp_lux(truth.lamp_on);
            let surface_m_s = self.surface_velocity_m_s(rigid.velocity_m_s - truth.air_velocity_m_s);
            out.flow = self.flow.read(rigid.velocity_m_s - surface_m_s, rigid.attitude.yaw_rad(), self.nearest_m, lux);
            let is_light = lux >= flow::MIN_ILLUMINANCE_LUX;
            self.over_water.flow_lost = self.below == water::Below::FarWater && out.flow.is_none() && is_light;
        }
        if self.power_due.fire(now) {
            out.battery = Some(truth.battery);
        }
        out
    }

    /// Returns the velocity of the surface that the flow camera tracks, in a wind, m/s.
    fn surface_velocity_m_s(&mut self, wind_m_s: Vec3<Ned>) -> Vec3<Ned> {
        match (&mut self.water, self.below) {
            (Some(water), water::Below::NearWater) => water.velocity_m_s(wind_m_s, 1.0 / flow::SAMPLE_RATE_HZ),
            (Some(_) | None, water::Below::Solid | water::Below::NearWater | water::Below::FarWater) => Vec3::zero(),
        }
    }

    /// Returns the illuminance, in lx, that the lamp would produce on the nearest surface if it pointed there.
    fn lamp_lux(&self, on: bool) -> f64 {
        if !on || self.lamp.luminous_flux_lm <= 0.0 {
            return 0.0;
        }
        let solid_angle = math::TAU * (1.0 - math::cos(0.5 * self.lamp.beam_angle_rad));
        self.lamp.luminous_flux_lm / solid_angle.max(1e-3) / self.nearest_m.max(0.5) / self.nearest_m.max(0.5)
    }

    /// Returns the vibration in the latest reading of the inertial sensors.
    #[must_use]
    pub fn vibration(&self) -> ImuReading {
        self.vibration.as_ref().map_or(ImuReading::ZERO, vibration::RotorVibration::latest)
    }

    /// Returns the inertial sensors, for estimator tests.
    #[must_use]
    pub fn imu(&self) -> &imu::Imu {
        &self.imu
    }

    /// Discards what the sensors have measured but not sent, because the aircraft is now at another place.
    pub fn discard_pending(&mut self) {
        self.gnss.discard_pending();
    }

    /// Returns the GNSS receiver, for estimator tests.
    #[must_use]
    pub fn gnss(&self) -> &gnss::GnssReceiver {
        &self.gnss
    }

    /// Returns the barometer, for estimator tests.
    #[must_use]
    pub fn baro(&self) -> &baro::Barometer {
        &self.baro
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use spandrel_model::frames::Rotation;
    use spandrel_model::vehicle;

    /// Returns sensors without errors, for tests of individual mechanisms.
    pub(crate) fn error_free_sensors() -> vehicle::SensorSpec {
        vehicle::SensorSpec {
            imu_rate_hz: 400.0,
            accel_noise_density: 0.0,
            accel_bias_m_s2: 0.0,
            gyro_noise_density: 0.0,
            gyro_bias_rad_s: 0.0,
            accel_vibration_m_s2: 0.0,
            gyro_vibration_rad_s: 0.0,
            gnss_rate_hz: 5.0,
            gnss_horizontal_noise_m: 0.0,
            gnss_vertical_noise_m: 0.0,
            gnss_velocity_noise_m_s: 0.0,
            gnss_delay_s: 0.0,
            baro_rate_hz: 50.0,
            baro_noise_m: 0.0,
            baro_drift_m_sqrt_s: 0.0,
            baro_airflow: 0.0,
            mag_rate_hz: 50.0,
            mag_noise_gauss: 0.0,
            mag_bias_gauss: 0.0,
            range_rate_hz: 10.0,
            range_noise_m: 0.0,
            range_bias_m: 0.0,
            range_max_m: 40.0,
            flow_velocity_m_s: 0.05,
        }
    }

    /// Returns a state at rest, ten meters above the origin.
    pub(crate) fn still() -> RigidState {
        RigidState {
            position_m: Vec3::new(0.0, 0.0, -10.0),
            velocity_m_s: Vec3::zero(),
            attitude: Rotation::identity(),
            rates_rad_s: Vec3::zero(),
            rotor_rad_s: [0.0; MAX_ROTORS],
        }
    }

    #[test]
    fn exact_range_finders_measure_ground_distance() {
        let mut finders = rangefinder::RangeFinders::new(&error_free_sensors(), 1);
        let ranges = finders.read(&still(), &FlatGround { up_m: 2.0 }, SimTime::ZERO);
        assert!(ranges.is_some_and(|r| (r.down_m - 8.0).abs() < 1e-12 && r.up_m.is_infinite()), "{ranges:?}");
    }

    #[test]
    fn exact_range_finder_biases_are_constant_and_differ_between_sessions() {
        let biased = vehicle::SensorSpec { range_bias_m: 0.05, ..error_free_sensors() };
        let mut finders = rangefinder::RangeFinders::new(&biased, 1);
        let mut off = |ms| finders.read(&still(), &FlatGround { up_m: 2.0 }, SimTime::from_ms(ms)).expect("due").down_m - 8.0;
        let (first, later) = (off(0), off(100));
        assert!(first != 0.0 && first.abs() < 0.25 && first == later, "{first} {later}");
        let mut all: Vec<f64> = (0..40)
            .map(|seed| {
                rangefinder::RangeFinders::new(&biased, seed)
                    .read(&still(), &FlatGround { up_m: 2.0 }, SimTime::ZERO)
                    .expect("due")
                    .down_m
            })
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        assert_eq!(all.len(), 40, "each session must have a different bias");
    }

    #[test]
    fn exact_flow_requires_light_and_surface_in_range() {
        let mut flow = flow::OpticalFlow::new(&error_free_sensors(), 1);
        assert!(flow.read(Vec3::zero(), 0.0, 5.0, 100.0).is_some());
        assert!(flow.read(Vec3::zero(), 0.0, 5.0, 14.0).is_none());
        assert!(flow.read(Vec3::zero(), 0.0, 41.0, 100.0).is_none());
    }
}
