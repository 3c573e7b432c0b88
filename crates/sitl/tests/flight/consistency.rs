//! Filter consistency: fifty seeds of one motion, judged by the normalized estimation error squared.

use nalgebra::{DMatrix, DVector};
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::autopilot::estimator::align::ROCKING_BIAS_FRACTION;
use spandrel_sitl::autopilot::estimator::covariance::{P, THETA, V};
use spandrel_sitl::autopilot::estimator::{Estimator, SimulatedTruth};
use spandrel_sitl::physics::{MAX_ROTORS, RigidState};
use spandrel_sitl::sensors::{self, FlatGround, Readings, Sensors, Surroundings};
use spandrel_testkit::bench::VEHICLES;
use spandrel_testkit::shipped::vehicle;

const SEEDS: u64 = 50;
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
struct ShadowedPlain {
    from: SimTime,
    until: SimTime,
    ground_up_m: fn(SimTime) -> f64,
}

/// Ground height for ground that does not move.
pub(super) fn flat(_: SimTime) -> f64 {
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

pub(super) struct Run {
    rigid: RigidState,
    sensors: Sensors,
    pub(super) filter: Estimator,
    site: ShadowedPlain,
    rocking_rate_rad_s: Vec3<Frd>,
    pub(super) now: SimTime,
}

impl Run {
    /// Creates a run under an open sky, without optical flow, with the ground always in range of the range finder.
    pub(super) fn under_open_sky(seed: u64, ground_up_m: fn(SimTime) -> f64) -> Self {
        let mut vehicle = vehicle("phantom2");
        vehicle.sensors.flow_velocity_m_s = 0.0;
        vehicle.sensors.range_max_m = 30.0;
        Self::with(seed, ShadowedPlain { from: SimTime::NEVER, until: SimTime::NEVER, ground_up_m }, &vehicle)
    }

    /// Returns the error of the estimated height in meters.
    pub(super) fn height_error_m(&self) -> f64 {
        self.error()[P + 2]
    }

    fn new(seed: u64, site: ShadowedPlain) -> Self {
        let mut vehicle = vehicle("phantom2");
        // Optical flow would compensate for the loss of GNSS.
        vehicle.sensors.flow_velocity_m_s = 0.0;
        Self::with(seed, site, &vehicle)
    }

    fn with(seed: u64, site: ShadowedPlain, vehicle: &Vehicle) -> Self {
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
            sensors: Sensors::new(vehicle, true, ORIGIN, seed),
            filter: Estimator::new(&vehicle.sensors, ORIGIN),
            site,
            now: SimTime::ZERO,
        }
    }

    fn tick(&mut self) {
        self.tick_with(|_, _| ());
    }

    /// Advances by one tick with readings changed by a test.
    pub(super) fn tick_with(&mut self, change: impl Fn(&mut Readings, SimTime)) {
        let dt = SimTime::from_ns(TICK.ns() / SUBSTEPS);
        for _ in 0..SUBSTEPS {
            let (a, b) = (velocity(self.now.s()), velocity((self.now + dt).s()));
            let mid = self.rigid.attitude.rotated_by(rates(self.now.s(), self.rocking_rate_rad_s) * (0.5 * dt.s()));
            let felt = mid.inverse() * ((b - a) / dt.s() - Vec3::new(0.0, 0.0, math::GRAVITY_M_S2));
            self.rigid.position_m += (a + b) * (0.5 * dt.s());
            self.rigid.velocity_m_s = b;
            self.rigid.rates_rad_s = rates(self.now.s(), self.rocking_rate_rad_s);
            self.rigid.attitude = self.rigid.attitude.rotated_by(self.rigid.rates_rad_s * dt.s());
            self.sensors.integrate_imu(felt, self.rigid.rates_rad_s, dt);
            self.now += dt;
        }
        let battery = sensors::BatteryReading { voltage_v: 12.0, current_a: 0.0, remaining_pct: 100.0 };
        let truth = sensors::SensorInputs { rigid: &self.rigid, battery, lamp_on: false };
        let mut readings = self.sensors.sample(&truth, &self.site, self.now);
        change(&mut readings, self.now);
        self.filter.step(&readings, self.now);
    }

    fn error(&self) -> [f64; 15] {
        let (accel, gyro) = self.sensors.imu().biases();
        self.filter.error(&SimulatedTruth {
            position_m: self.rigid.position_m,
            velocity_m_s: self.rigid.velocity_m_s,
            attitude: self.rigid.attitude,
            gyro_bias_rad_s: gyro,
            accel_bias_m_s2: accel,
        })
    }

    /// Returns the normalized error squared for the states in `from..from + count`.
    fn nees(&self, from: usize, count: usize) -> f64 {
        let e = self.error();
        let e = DVector::from_fn(count, |i, _| e[from + i]);
        let p = DMatrix::from_fn(count, count, |i, j| self.filter.covariance().at(from + i, from + j));
        p.cholesky().map_or(f64::INFINITY, |c| e.dot(&c.solve(&e)))
    }

    fn run_until(&mut self, until: SimTime) {
        while self.now < until {
            self.tick();
        }
    }
}

/// Returns the 95% band for the mean, over `SEEDS` seeds, of a chi-squared variable with `n` degrees of freedom
/// (Wilson-Hilferty).
fn band(n: usize) -> (f64, f64) {
    let k = n as f64 * SEEDS as f64;
    let point = |z: f64| {
        let x = 1.0 - 2.0 / (9.0 * k) + z * (2.0 / (9.0 * k)).sqrt();
        k * x * x * x / SEEDS as f64
    };
    (point(-1.96), point(1.96))
}

/// Checks that the means over all seeds are within their bands at four times, both for all states together and for
/// position, velocity and attitude separately.
fn assert_consistent(what: &str, new: impl Fn(u64, ShadowedPlain) -> Run) {
    let times = [5, 20, 40, 60];
    let mut sums = [[0.0; 4]; 4];
    let blocks = [(0, 15), (P, 3), (V, 3), (THETA, 3)];
    for seed in 0..SEEDS {
        let mut run = new(seed, ShadowedPlain { from: SimTime::NEVER, until: SimTime::NEVER, ground_up_m: flat });
        for (row, t) in sums.iter_mut().zip(times) {
            run.run_until(SimTime::from_ms(t * 1000));
            for (sum, (from, count)) in row.iter_mut().zip(blocks) {
                *sum += run.nees(from, count) / SEEDS as f64;
            }
        }
    }
    let (low, high) = band(15);
    let inside = sums.iter().filter(|row| row[0] > low && row[0] < high).count();
    assert!(inside == times.len(), "{what}, all states: {sums:?}, band {low:.2}..{high:.2}");
    // One block in twelve may be outside its band by chance (probability 0.88 of at most one).
    let (low, high) = band(3);
    let outside = sums.iter().flat_map(|row| &row[1..]).filter(|v| **v < low || **v > high).count();
    assert!(outside <= 1, "{what}, position, velocity, attitude: {sums:?}, band {low:.2}..{high:.2}");
}

#[test]
fn prop_normalized_error_stays_within_its_95_percent_band() {
    assert_consistent("without flow", Run::new);
}

#[test]
fn prop_normalized_error_is_within_its_band_for_every_shipped_aircraft() {
    for name in VEHICLES {
        let vehicle = vehicle(name);
        assert!(vehicle.sensors.flow_velocity_m_s > 0.0, "{name} has no optical flow, so the test is pointless");
        assert_consistent(name, |seed, site| Run::with(seed, site, &vehicle));
    }
}

#[test]
fn prop_error_and_covariance_grow_together_without_gnss_and_then_recover() {
    let (from, until) = (SimTime::from_ms(20_000), SimTime::from_ms(30_000));
    let (mut before, mut blind, mut after) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let mut nees = 0.0;
    for seed in 0..SEEDS {
        let mut run = Run::new(seed, ShadowedPlain { from, until, ground_up_m: flat });
        for (t, sums) in [(20_000, &mut before), (29_900, &mut blind), (60_000, &mut after)] {
            run.run_until(SimTime::from_ms(t));
            let e = run.error();
            sums[0] += (e[0] * e[0] + e[1] * e[1]) / SEEDS as f64;
            sums[1] += (run.filter.covariance().variance(P) + run.filter.covariance().variance(P + 1)) / SEEDS as f64;
            nees += if t == 29_900 { run.nees(0, 15) / SEEDS as f64 } else { 0.0 };
        }
    }
    let (low, high) = band(15);
    assert!(nees > low && nees < high, "without GNSS: {nees:.2}, band {low:.2}..{high:.2}");
    // The growth must be clearly visible; half a minute after recovery, the covariance must be back within a fifth (as
    // fractions of the variance).
    assert!(blind[0] > 1.5 * before[0] && blind[1] > 1.5 * before[1], "{before:?} {blind:?}");
    assert!(after[0] < blind[0] && after[1] < 1.2 * before[1], "{blind:?} {after:?}");
}
