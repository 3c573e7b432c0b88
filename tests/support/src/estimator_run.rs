//! A run of the estimator alone: the sensors of an aircraft that follows a given motion, without physics or autopilot.

use crate::shipped::vehicle;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::autopilot::estimator::align::ROCKING_BIAS_FRACTION;
use spandrel_sitl::autopilot::estimator::covariance::P;
use spandrel_sitl::autopilot::estimator::{Estimator, SimulatedTruth};
use spandrel_sitl::physics::{MAX_ROTORS, RigidState};
use spandrel_sitl::sensors::{self, FlatGround, Readings, SensorSite, Sensors, Surroundings};

const ORIGIN: Geo = Geo { latitude_deg: 46.5, longitude_deg: 8.25, altitude_m: 430.0 };
const TICK: SimTime = SimTime::from_us(2500);
const SUBSTEPS: i64 = 2;

/// Returns the velocity of the test motion: at rest for a second, then a meandering figure eight that climbs and
/// descends.
fn velocity(t: f64) -> Vec3<Ned> {
    let t = (t - 1.0).max(0.0);
    let (a, b, c) = (math::sin(0.5 * t), math::sin(0.9 * t), math::sin(0.3 * t));
    Vec3::new(4.0 * a, 3.0 * b, -1.5 * c)
}

/// Returns the turn rates; on the ground, the body rocks as much as alignment tolerates.
fn rates(t: f64, rocking_rate_rad_s: Vec3<Frd>) -> Vec3<Frd> {
    if t < 1.0 {
        return rocking_rate_rad_s;
    }
    Vec3::new(0.35 * math::cos(0.7 * t), 0.25 * math::cos(0.9 * t), 0.3 * math::sin(0.2 * t))
}

/// A plain whose sky is covered between two times, and whose ground may move.
pub struct ShadowedPlain {
    pub from: SimTime,
    pub until: SimTime,
    pub ground_up_m: fn(SimTime) -> f64,
}

/// Ground height for ground that does not move.
pub fn flat(_: SimTime) -> f64 {
    0.0
}

impl Surroundings for ShadowedPlain {
    fn ray_m(&self, origin: Vec3<Enu>, d: Vec3<Enu>, max: f64, at: SimTime) -> Option<f64> {
        if d.up() > 0.0 && at >= self.from && at < self.until {
            Some(3.0)
        } else {
            FlatGround { up_m: (self.ground_up_m)(at) }.ray_m(origin, d, max, at)
        }
    }
    fn lux(&self, _: Vec3<Enu>, _: SimTime) -> f64 {
        1e4
    }
}

/// The motion, the sensors and the estimator.
pub struct EstimatorRun {
    rigid: RigidState,
    sensors: Sensors,
    pub filter: Estimator,
    site: ShadowedPlain,
    rocking_rate_rad_s: Vec3<Frd>,
    pub now: SimTime,
}

impl EstimatorRun {
    /// Creates a run under an open sky, without optical flow, with the ground always in range of the range finder.
    pub fn under_open_sky(seed: u64, ground_up_m: fn(SimTime) -> f64) -> Self {
        let mut vehicle = vehicle("phantom2");
        vehicle.sensors.flow_velocity_m_s = 0.0;
        vehicle.sensors.range_max_m = 30.0;
        Self::with_vehicle(seed, ShadowedPlain { from: SimTime::NEVER, until: SimTime::NEVER, ground_up_m }, &vehicle)
    }

    /// Returns the error of the estimated height in meters.
    pub fn height_error_m(&self) -> f64 {
        self.error()[P + 2]
    }

    /// Creates a run of the default aircraft, without optical flow.
    pub fn new(seed: u64, site: ShadowedPlain) -> Self {
        let mut vehicle = vehicle("phantom2");
        // Optical flow would compensate for the loss of GNSS.
        vehicle.sensors.flow_velocity_m_s = 0.0;
        Self::with_vehicle(seed, site, &vehicle)
    }

    /// The rotors are stopped, so nothing vibrates. Airflow does not affect the barometer, because the filter has no model of that error.
    pub fn with_vehicle(seed: u64, site: ShadowedPlain, vehicle: &Vehicle) -> Self {
        let mut vehicle = vehicle.clone();
        (vehicle.sensors.accel_vibration_m_s2, vehicle.sensors.gyro_vibration_rad_s) = (0.0, 0.0);
        vehicle.sensors.baro_airflow = 0.0;
        let rigid = RigidState {
            position_m: Vec3::new(3.0, -2.0, -1.0),
            velocity_m_s: Vec3::zero(),
            attitude: Rotation::from_euler(0.02, -0.03, 0.8),
            rates_rad_s: Vec3::zero(),
            rotor_rad_s: [0.0; MAX_ROTORS],
        };
        let [x, y, z] = RandomStream::new(seed, "rocking").normal3();
        Self {
            rigid,
            rocking_rate_rad_s: Vec3::new(x, y, z) * (ROCKING_BIAS_FRACTION * vehicle.sensors.gyro_bias_rad_s),
            sensors: Sensors::new(&vehicle, SensorSite { gnss_shadow: true, ..SensorSite::open(ORIGIN) }, seed),
            filter: Estimator::new(&vehicle.sensors, ORIGIN),
            site,
            now: SimTime::ZERO,
        }
    }

    fn tick(&mut self) {
        self.tick_with(|_, _| ());
    }

    /// Advances by one tick with readings modified by a test.
    pub fn tick_with(&mut self, change: impl Fn(&mut Readings, SimTime)) {
        let dt = SimTime::from_ns(TICK.ns() / SUBSTEPS);
        for _ in 0..SUBSTEPS {
            let (a, b) = (velocity(self.now.s()), velocity((self.now + dt).s()));
            let mid = self.rigid.attitude.rotated_by(rates(self.now.s(), self.rocking_rate_rad_s) * (0.5 * dt.s()));
            let felt = mid.inverse() * ((b - a) / dt.s() - Vec3::new(0.0, 0.0, math::GRAVITY_M_S2));
            self.rigid.position_m += (a + b) * (0.5 * dt.s());
            self.rigid.velocity_m_s = b;
            self.rigid.rates_rad_s = rates(self.now.s(), self.rocking_rate_rad_s);
            self.rigid.attitude = self.rigid.attitude.rotated_by(self.rigid.rates_rad_s * dt.s());
            let felt = sensors::FeltMotion {
                specific_force_m_s2: felt,
                rates_rad_s: self.rigid.rates_rad_s,
                rotor_rad_s: self.rigid.rotor_rad_s,
            };
            self.sensors.integrate_imu(&felt, dt);
            self.now += dt;
        }
        let battery = sensors::BatteryReading { voltage_v: 12.0, current_a: 0.0, remaining_pct: 100.0 };
        let air_velocity_m_s = self.rigid.velocity_m_s;
        let truth = sensors::SensorInputs { rigid: &self.rigid, air_velocity_m_s, battery, lamp_on: false };
        let mut readings = self.sensors.sample(&truth, &self.site, self.now);
        change(&mut readings, self.now);
        self.filter.step(&readings, self.now);
    }

    /// Returns the estimator's error for each of its states.
    pub fn error(&self) -> [f64; 15] {
        let (accel, gyro) = self.sensors.imu().biases();
        self.filter.error(&SimulatedTruth {
            position_m: self.rigid.position_m,
            velocity_m_s: self.rigid.velocity_m_s,
            attitude: self.rigid.attitude,
            gyro_bias_rad_s: gyro,
            accel_bias_m_s2: accel,
        })
    }

    /// Advances to a time with unchanged readings.
    pub fn run_until(&mut self, until: SimTime) {
        while self.now < until {
            self.tick();
        }
    }
}
