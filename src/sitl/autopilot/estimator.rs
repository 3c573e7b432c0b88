//! Error-state Kalman filter: position, velocity, attitude error, gyroscope and accelerometer bias. The state runs at the inertial
//! unit's rate, the covariance at 100 Hz. (Solà, Quaternion kinematics for the error-state Kalman filter, 2017.)

use super::Estimate;
use crate::base::frames::{Frd, Ned, Rotation, Vec3};
use crate::base::geodesy::Geo;
use crate::base::math::{self, GRAVITY_M_S2};
use crate::base::time::SimTime;
use crate::sitl::sensors::{ImuReading, Readings, magnetometer};
use crate::vehicle::Sensors;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

const N: usize = 15;
type Covariance = SMatrix<f64, N, N>;
type Row = SVector<f64, N>;

/// Time between covariance steps, s.
const COVARIANCE_S: f64 = 0.01;
/// At rest for this long before the attitude is taken from accelerometer and magnetometer, s.
const ALIGN_S: f64 = 0.5;
/// Random walk of the gyroscope bias that the filter allows for, rad/s/sqrt(s) (estimate).
const GYRO_WALK: f64 = 1e-5;
/// Random walk of the accelerometer bias that the filter allows for, m/s²/sqrt(s) (estimate).
const ACCEL_WALK: f64 = 1e-4;
/// The barometer's slow drift, taken as noise, m (estimate).
const BARO_DRIFT_M: f64 = 0.15;
/// Innovations beyond this many standard deviations are refused.
const GATE_SIGMA: f64 = 5.0;
/// Horizontal accuracy up to which position control is allowed, m (PX4's default for EPH).
const USABLE_M: f64 = 3.0;

/// The filter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimator {
    settings: Sensors,
    position_m: Vec3<Ned>,
    velocity_m_s: Vec3<Ned>,
    attitude: Rotation<Frd, Ned>,
    gyro_bias: Vec3<Frd>,
    accel_bias: Vec3<Frd>,
    rates_rad_s: Vec3<Frd>,
    p: Covariance,
    since_covariance_s: f64,
    force_sum: Vec3<Frd>,
    rate_sum: Vec3<Frd>,
    samples: u32,
    align: Option<Align>,
    last_imu: Option<SimTime>,
    has_position: bool,
    refused: u32,
    declination_rad: f64,
    level_field_gauss: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct Align {
    force: Vec3<Frd>,
    field: Vec3<Frd>,
    forces: u32,
    fields: u32,
    since: Option<SimTime>,
}

impl Estimator {
    /// Knows nothing yet.
    #[must_use]
    pub fn new(settings: Sensors, origin: Geo) -> Self {
        let field = magnetometer::earth_field_gauss(origin);
        Self {
            declination_rad: math::atan2(field.east(), field.north()),
            level_field_gauss: field.horizontal_norm(),
            settings,
            position_m: Vec3::zero(),
            velocity_m_s: Vec3::zero(),
            attitude: Rotation::identity(),
            gyro_bias: Vec3::zero(),
            accel_bias: Vec3::zero(),
            rates_rad_s: Vec3::zero(),
            p: Covariance::zeros(),
            since_covariance_s: 0.0,
            force_sum: Vec3::zero(),
            rate_sum: Vec3::zero(),
            samples: 0,
            align: Some(Align { force: Vec3::zero(), field: Vec3::zero(), forces: 0, fields: 0, since: None }),
            last_imu: None,
            has_position: false,
            refused: 0,
        }
    }

    /// Takes in what the sensors say.
    pub fn update(&mut self, readings: &Readings, now: SimTime) {
        if self.align.is_some() {
            self.gather(readings, now);
            return;
        }
        if let Some(imu) = &readings.imu {
            self.predict(imu, now);
        }
        if let Some(gnss) = &readings.gnss
            && gnss.fix >= 3
        {
            self.fuse_gnss(gnss);
        }
        if let Some(up_m) = readings.baro_up_m {
            let sigma = math::hypot(self.settings.baro_noise_m, BARO_DRIFT_M);
            self.fuse_axis(2, -up_m - self.position_m.down(), sigma);
        }
        if let Some(field) = readings.mag_gauss {
            self.fuse_heading(field);
        }
        if let Some(flow) = readings.flow {
            self.fuse_flow(flow.forward_m_s, flow.right_m_s);
        }
    }

    /// Sums up accelerometer and magnetometer at rest, then sets the attitude.
    fn gather(&mut self, readings: &Readings, now: SimTime) {
        let Some(align) = &mut self.align else { return };
        let since = *align.since.get_or_insert(now);
        if let Some(imu) = &readings.imu {
            align.force += imu.specific_force_m_s2;
            align.forces += 1;
            self.gyro_bias += imu.rates_rad_s;
            self.last_imu = Some(now);
        }
        if let Some(field) = readings.mag_gauss {
            align.field += field;
            align.fields += 1;
        }
        if (now - since).s() < ALIGN_S || align.forces == 0 || align.fields == 0 {
            return;
        }
        let (force, field) = (align.force / f64::from(align.forces), align.field / f64::from(align.fields));
        let roll = math::atan2(-force.right(), -force.down());
        let pitch = math::atan2(force.forward(), math::hypot(force.right(), force.down()));
        let yaw = math::wrap_pi(heading(field, roll, pitch) + self.declination_rad);
        self.gyro_bias = self.gyro_bias / f64::from(align.forces);
        self.attitude = Rotation::from_euler(roll, pitch, yaw);
        self.align = None;
        self.reset_covariance();
    }

    fn reset_covariance(&mut self) {
        let s = &self.settings;
        // Levelling by the accelerometer is as wrong as its bias; heading as the magnetometer's noise and a degree.
        let tilt = s.accel_bias_m_s2 / GRAVITY_M_S2 + 1e-3;
        let mut sigma = [0.0; N];
        sigma[..3].copy_from_slice(&[s.gnss_horizontal_m * 20.0 + 10.0, s.gnss_horizontal_m * 20.0 + 10.0, 10.0]);
        sigma[3..6].fill(0.1);
        sigma[6..9].copy_from_slice(&[tilt, tilt, 0.03]);
        sigma[9..12].fill(s.gyro_noise_density * (s.imu_rate_hz.sqrt()) * 0.1 + 2e-4);
        sigma[12..15].fill(s.accel_bias_m_s2 + 1e-3);
        self.p = Covariance::from_diagonal(&Row::from_iterator(sigma.into_iter().map(|x| x * x)));
    }

    fn predict(&mut self, imu: &ImuReading, now: SimTime) {
        let dt = self.last_imu.map_or(0.0, |last| (now - last).s()).clamp(0.0, 0.1);
        self.last_imu = Some(now);
        let force = imu.specific_force_m_s2 - self.accel_bias;
        self.rates_rad_s = imu.rates_rad_s - self.gyro_bias;
        let turned = self.attitude.turned_by(self.rates_rad_s * (0.5 * dt));
        let acceleration = turned * force + Vec3::new(0.0, 0.0, GRAVITY_M_S2);
        self.position_m += self.velocity_m_s * dt + acceleration * (0.5 * dt * dt);
        self.velocity_m_s += acceleration * dt;
        self.attitude = self.attitude.turned_by(self.rates_rad_s * dt);
        self.force_sum += force;
        self.rate_sum += self.rates_rad_s;
        self.samples += 1;
        self.since_covariance_s += dt;
        if self.since_covariance_s >= COVARIANCE_S - 1e-9 {
            self.propagate();
        }
    }

    /// P <- F P F' + Q for F = I + A dt, with A's blocks written out.
    fn propagate(&mut self) {
        let dt = self.since_covariance_s;
        let mean = 1.0 / f64::from(self.samples.max(1));
        let (force, rate) = (self.force_sum * mean, self.rate_sum * mean);
        self.since_covariance_s = 0.0;
        (self.force_sum, self.rate_sum, self.samples) = (Vec3::zero(), Vec3::zero(), 0);
        let r = self.attitude.matrix();
        let mut f = Covariance::identity();
        for k in 0..3 {
            f[(k, k + 3)] = dt;
            f[(k + 6, k + 9)] = -dt;
        }
        f.fixed_view_mut::<3, 3>(3, 6).copy_from(&(r * skew(force.raw()) * -dt));
        f.fixed_view_mut::<3, 3>(3, 12).copy_from(&(r * -dt));
        let turn = Matrix3::identity() - skew(rate.raw()) * dt;
        f.fixed_view_mut::<3, 3>(6, 6).copy_from(&turn);
        self.p = f * self.p * f.transpose();
        let s = &self.settings;
        let noise = [s.accel_noise_density, s.gyro_noise_density, GYRO_WALK, ACCEL_WALK];
        for (block, density) in noise.into_iter().enumerate() {
            for k in 0..3 {
                let at = 3 + 3 * block + k;
                self.p[(at, at)] += density * density * dt;
            }
        }
    }

    fn fuse_gnss(&mut self, gnss: &crate::sitl::sensors::GnssReading) {
        if !self.has_position {
            self.has_position = true;
            self.position_m = gnss.position_m;
        }
        let p = gnss.position_m - self.position_m;
        let sigma = [gnss.eph_m, gnss.eph_m, gnss.epv_m];
        for (axis, (innovation, sigma)) in p.array().into_iter().zip(sigma).enumerate() {
            self.fuse_axis(axis, innovation, sigma);
        }
        let scale = gnss.eph_m / self.settings.gnss_horizontal_m.max(1e-3);
        for axis in 0..3 {
            let innovation = gnss.velocity_m_s.array()[axis] - self.velocity_m_s.array()[axis];
            self.fuse_axis(3 + axis, innovation, self.settings.gnss_velocity_m_s * scale);
        }
    }

    fn fuse_axis(&mut self, axis: usize, innovation: f64, sigma: f64) {
        let mut h = Row::zeros();
        h[axis] = 1.0;
        self.fuse(&h, innovation, sigma);
    }

    fn fuse_heading(&mut self, field: Vec3<Frd>) {
        let (roll, pitch, yaw) = self.attitude.euler();
        // Heading has no meaning with the nose straight up.
        if pitch.abs() > 1.3 {
            return;
        }
        let innovation = math::wrap_pi(heading(field, roll, pitch) + self.declination_rad - yaw);
        let r = self.attitude.matrix();
        let mut h = Row::zeros();
        for k in 0..3 {
            h[6 + k] = r[(2, k)];
        }
        let sigma = self.settings.mag_noise_gauss / self.level_field_gauss.max(0.05);
        self.fuse(&h, innovation, sigma + 0.01);
    }

    fn fuse_flow(&mut self, forward_m_s: f64, right_m_s: f64) {
        let (s, c) = math::sin_cos(self.attitude.yaw_rad());
        let v = self.velocity_m_s;
        let sigma = self.settings.flow_velocity_m_s * 1.2;
        let axes = [(c, s, forward_m_s), (-s, c, right_m_s)];
        for (north, east, measured) in axes {
            let mut h = Row::zeros();
            h[3] = north;
            h[4] = east;
            self.fuse(&h, measured - (north * v.north() + east * v.east()), sigma);
        }
    }

    /// One scalar measurement; refused beyond the gate, unless everything has been refused for a while.
    fn fuse(&mut self, h: &Row, innovation: f64, sigma: f64) {
        const STUBBORN: u32 = 50;
        let ph = self.p * h;
        let s = h.dot(&ph) + sigma * sigma;
        if innovation * innovation > GATE_SIGMA * GATE_SIGMA * s && self.refused < STUBBORN {
            self.refused += 1;
            return;
        }
        self.refused = 0;
        let gain = ph / s;
        self.inject(&(gain * innovation));
        self.p -= gain * ph.transpose();
        self.p = (self.p + self.p.transpose()) * 0.5;
    }

    fn inject(&mut self, e: &Row) {
        let part = |k: usize| Vector3::new(e[k], e[k + 1], e[k + 2]);
        // FRAME: the state's blocks are position and velocity in NED, the rest in body axes.
        self.position_m += Vec3::assume(part(0));
        self.velocity_m_s += Vec3::assume(part(3));
        self.attitude = self.attitude.turned_by(Vec3::assume(part(6)));
        self.gyro_bias += Vec3::assume(part(9));
        self.accel_bias += Vec3::assume(part(12));
    }

    /// The aircraft has been put somewhere else: biases stay, the rest starts anew.
    pub fn reinitialise(&mut self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>, attitude: Rotation<Frd, Ned>) {
        self.position_m = position_m;
        self.velocity_m_s = velocity_m_s;
        self.attitude = attitude;
        let biases = self.p.fixed_view::<6, 6>(9, 9).into_owned();
        self.reset_covariance();
        for k in 0..3 {
            self.p[(k, k)] = 1.0;
        }
        self.p.fixed_view_mut::<6, 6>(9, 9).copy_from(&biases);
        self.has_position = true;
    }

    /// What is believed now.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        let aligned = self.align.is_none();
        let horizontal_m = (self.p[(0, 0)] + self.p[(1, 1)]).max(0.0).sqrt();
        Estimate {
            position_m: self.position_m,
            velocity_m_s: self.velocity_m_s,
            attitude: self.attitude,
            rates_rad_s: self.rates_rad_s,
            horizontal_m,
            vertical_m: self.p[(2, 2)].max(0.0).sqrt(),
            position_valid: aligned && self.has_position && horizontal_m < USABLE_M,
            attitude_valid: aligned,
        }
    }

    /// Normalised squared error of position and velocity against a given truth (for tests of consistency).
    #[must_use]
    pub fn normalised_error(&self, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>) -> f64 {
        let p = (position_m - self.position_m).array();
        let v = (velocity_m_s - self.velocity_m_s).array();
        let e = SVector::<f64, 6>::from_column_slice(&[p[0], p[1], p[2], v[0], v[1], v[2]]);
        let block = self.p.fixed_view::<6, 6>(0, 0).into_owned();
        block.try_inverse().map_or(f64::INFINITY, |inverse| e.dot(&(inverse * e)))
    }
}

fn skew(v: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// Heading from a field reading, levelled by roll and pitch.
fn heading(field: Vec3<Frd>, roll: f64, pitch: f64) -> f64 {
    let level = Rotation::from_euler(roll, pitch, 0.0) * field;
    math::atan2(-level.east(), level.north())
}
