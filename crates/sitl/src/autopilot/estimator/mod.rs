//! Error-state Kalman filter. The state runs at the inertial sample rate, the covariance at 100 Hz. The states are
//! position, velocity, attitude, inertial sensor biases, offsets of the GNSS height and the barometer, and
//! magnetometer bias. It fuses GNSS, barometer, magnetometer and optical flow.
//!
//! The range finder is not fused by default, because the surface below may be a deck, a truck or water. It decides
//! which height to use when GNSS and barometer contradict each other.

pub mod align;
mod assumptions;
mod checks;
pub mod covariance;
pub mod estimate;
mod fuse;
mod ground;
mod height;
pub mod height_reference;
mod recent_motion;

use crate::sensors::{GnssReading, ImuReading, Readings, magnetometer};
use align::{Alignment, AlignmentResult, GyroSpec};
use assumptions::{BARO_START_OFFSET_M, MeasurementNoise, process_noise};
use checks::InnovationChecks;
use covariance::{BA, BARO, BG, Covariance, GNSS_HEIGHT, MAG, P, ProcessNoise, STATE_COUNT, THETA, V};
use estimate::Estimate;
use ground::GroundEstimate;
use height_reference::{HeightReference, HeightReferenceState};
use nalgebra::Vector3;
use recent_motion::RecentMotion;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle;

/// Propagation interval of the covariance, s.
const COVARIANCE_PERIOD_S: f64 = 0.0099;
/// Maximum standard deviations at which horizontal velocity and position are usable for control, m/s and m.
const MAX_USABLE_VELOCITY_SIGMA_M_S: f64 = 0.7;
const MAX_USABLE_POSITION_SIGMA_M: f64 = 12.0;
/// Fraction of these limits below which an estimate becomes valid again.
const REVALIDATION_FRACTION: f64 = 0.5;
/// Specific force above which the sampling blurs the direction of a shock, m/s², and the fraction of it treated as uncertain.
const SHOCK_SPECIFIC_FORCE_M_S2: f64 = 40.0;
const SHOCK_UNCERTAINTY_FRACTION: f64 = 0.1;
/// Largest error of the position that a filter keeps when the aircraft is put somewhere else, in standard deviations of the receiver's height. After a
/// larger one, the filter was lost.
const MAX_KEPT_ERROR_SIGMAS: f64 = 4.0;
/// Time over which fixes are averaged before the local frame's origin is set, s (estimate; PX4 requires 10 s of good
/// fixes, EKF2_REQ_GPS_H).
const LOCAL_ORIGIN_AVERAGING_TIME_S: f64 = 1.5;

/// Default dead-reckoning time limit, s. PX4 allows 5 s. Below a deck over water, an aircraft often has neither GNSS
/// nor optical flow, and this estimator's drift stays within its limits for about this long
/// (`crates/sitl/tests/flight`).
pub const DEAD_RECKONING_LIMIT_S: f64 = 60.0;

/// Time at which each source was last fused.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LastFused {
    velocity: SimTime,
    flow: SimTime,
    height: SimTime,
    heading: SimTime,
}

impl LastFused {
    /// Sets the same time for all sources.
    fn new(now: SimTime) -> Self {
        Self { velocity: now, flow: now, height: now, heading: now }
    }
}

/// Sources that the filter rejects because they contradict the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RejectedSources {
    /// Magnetometer.
    pub compass: bool,
    /// Barometer.
    pub barometer: bool,
    /// GNSS receiver.
    pub gnss: bool,
}

/// The filter. Plain data.
#[derive(Debug, Clone)]
pub struct Estimator {
    process: ProcessNoise,
    noise: MeasurementNoise,
    field_gauss: Vec3<Ned>,
    alignment: Alignment,
    aligned: bool,
    global_position_known: bool,
    local_origin_m: Vec3<Ned>,
    local_origin_set: bool,
    first_fix: Option<SimTime>,
    position_m: Vec3<Ned>,
    velocity_m_s: Vec3<Ned>,
    attitude: Rotation<Frd, Ned>,
    gyro_bias: Vec3<Frd>,
    accel_bias: Vec3<Frd>,
    /// Offset of the GNSS height, m down.
    gnss_height_offset_m: f64,
    baro_offset_m: f64,
    mag_bias: Vec3<Frd>,
    covariance: Covariance,
    unpropagated_velocity_m_s: Vec3<Ned>,
    unpropagated_time_s: f64,
    shock_variance: f64,
    rates_rad_s: Vec3<Frd>,
    acceleration_m_s2: Vec3<Ned>,
    last_imu: Option<SimTime>,
    last_fused: LastFused,
    checks: InnovationChecks,
    ground: GroundEstimate,
    latest_fix: Option<(GnssReading, SimTime)>,
    recent_motion: RecentMotion,
    /// Variance of the GNSS height due to recently reported multipath, m².
    multipath_variance_m2: f64,
    /// Whether the motors are off.
    motors_off: bool,
    /// Time without a fused velocity after which the position becomes invalid, s.
    dead_reckoning_limit_s: f64,
    /// Configured height reference.
    pub configured_reference: HeightReference,
    height_reference: HeightReferenceState,
    /// Accumulated position resets since the last query, m.
    position_reset_m: Option<Vec3<Ned>>,
    /// Number of position resets returned by queries so far.
    position_resets: u32,
    usable: bool,
}

impl Estimator {
    /// Creates an unaligned filter. `origin` is the origin of the local frame, used for the magnetic model.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, origin: Geo) -> Self {
        let noise = MeasurementNoise::of(sensors);
        Self {
            process: process_noise(&noise),
            noise,
            field_gauss: magnetometer::earth_field_gauss(origin),
            alignment: Alignment::new(GyroSpec { bias_rad_s: noise.gyro_bias_rad_s, white_noise_rad_s: noise.gyro_sample_rad_s }),
            aligned: false,
            global_position_known: false,
            local_origin_m: Vec3::zero(),
            local_origin_set: false,
            first_fix: None,
            position_m: Vec3::zero(),
            velocity_m_s: Vec3::zero(),
            attitude: Rotation::identity(),
            gyro_bias: Vec3::zero(),
            accel_bias: Vec3::zero(),
            gnss_height_offset_m: 0.0,
            baro_offset_m: 0.0,
            mag_bias: Vec3::zero(),
            covariance: Covariance::diagonal(&[0.0; STATE_COUNT]),
            unpropagated_velocity_m_s: Vec3::zero(),
            unpropagated_time_s: 0.0,
            shock_variance: 0.0,
            rates_rad_s: Vec3::zero(),
            acceleration_m_s2: Vec3::zero(),
            last_imu: None,
            last_fused: LastFused::new(SimTime::ZERO),
            checks: InnovationChecks::default(),
            ground: GroundEstimate::default(),
            latest_fix: None,
            recent_motion: RecentMotion::new(SimTime::from_s(sensors.gnss_delay_s)),
            multipath_variance_m2: 0.0,
            motors_off: true,
            dead_reckoning_limit_s: DEAD_RECKONING_LIMIT_S,
            configured_reference: HeightReference::default(),
            height_reference: HeightReferenceState::default(),
            position_reset_m: None,
            position_resets: 0,
            usable: false,
        }
    }

    /// Processes the readings of one tick.
    pub fn step(&mut self, readings: &Readings, now: SimTime) {
        if let Some(reading) = &readings.imu {
            let dt_s = self.last_imu.map_or(0.0, |last| (now - last).s());
            self.last_imu = Some(now);
            if self.aligned {
                self.predict(reading, dt_s, now);
            } else {
                self.rates_rad_s = reading.rates_rad_s;
                self.align(reading, readings, dt_s, now);
            }
        }
        if !self.aligned {
            return;
        }
        self.choose_reference(now);
        if let Some(range_m) = readings.range_down_m {
            let below_m = range_m * (self.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
            self.ground.add_measurement(below_m);
            self.correct_height_by_range(below_m, now);
        }
        if let Some(fix) = readings.gnss.as_ref().filter(|g| g.fix >= 3) {
            self.propagate_covariance();
            self.fuse_gnss(&self.moved_to_now(fix, now), now);
            self.set_local_origin(now);
        }
        if let Some(up_m) = readings.baro_up_m {
            self.fuse_baro(up_m, now);
        }
        if let Some(gauss) = readings.mag_gauss {
            self.fuse_mag(gauss, 1.0, now);
        }
        if let Some(flow) = &readings.flow {
            self.fuse_flow(flow, now);
        }
    }

    /// Returns a delayed GNSS reading with the motion since the instant that it describes.
    fn moved_to_now(&self, fix: &GnssReading, now: SimTime) -> GnssReading {
        let (moved_m, gained_m_s) = self.recent_motion.since_delay(now);
        GnssReading { position_m: fix.position_m + moved_m, velocity_m_s: fix.velocity_m_s + gained_m_s, ..*fix }
    }

    /// Sets the origin of the local frame to the vehicle position once the first fixes are averaged, or as soon as the
    /// motors run, because an origin that follows a moving vehicle hides its motion.
    fn set_local_origin(&mut self, now: SimTime) {
        if self.local_origin_set {
            return;
        }
        let averaged_s = self.first_fix.map(|first| (now - first).s());
        if self.motors_off || averaged_s.is_none() {
            self.local_origin_m = self.position_m;
        }
        self.first_fix.get_or_insert(now);
        self.local_origin_set = !self.motors_off || averaged_s.is_some_and(|s| s >= LOCAL_ORIGIN_AVERAGING_TIME_S);
    }

    fn align(&mut self, reading: &ImuReading, readings: &Readings, dt_s: f64, now: SimTime) {
        self.alignment.imu(reading, dt_s);
        if let Some(gauss) = readings.mag_gauss {
            self.alignment.mag(gauss);
        }
        if let Some(up_m) = readings.baro_up_m {
            self.position_m = Vec3::new(0.0, 0.0, -up_m);
        }
        if let Some(aligned) = self.alignment.result(self.field_gauss) {
            self.start(&aligned, now);
        }
    }

    /// Initializes state and covariance from an alignment. The tilt uncertainty equals the accelerometer bias uncertainty, so the
    /// two are correlated.
    fn start(&mut self, aligned: &AlignmentResult, now: SimTime) {
        let n = self.noise;
        let sq = |x: f64| x * x;
        self.attitude = aligned.attitude;
        self.gyro_bias = aligned.gyro_bias_rad_s;
        let bias = sq(n.accel_bias_m_s2);
        let tilt = (bias + sq(n.accel_sample_m_s2) / aligned.samples) / sq(math::GRAVITY_M_S2);
        let gyro = aligned.gyro_variance;
        let (far, yaw, at_rest, bh) = (1e6, 1.0, sq(0.05), bias);
        let height = sq(BARO_START_OFFSET_M);
        self.covariance = Covariance::diagonal(&[
            far,
            far,
            sq(10.0),
            at_rest,
            at_rest,
            at_rest,
            tilt,
            tilt,
            yaw,
            gyro,
            gyro,
            gyro,
            bh,
            bh,
            bh,
            self.process.gnss_height,
            height,
            sq(n.mag_bias_gauss),
            sq(n.mag_bias_gauss),
            sq(n.mag_bias_gauss),
        ]);
        let r = aligned.attitude.matrix();
        for j in 0..3 {
            self.covariance.set(THETA, BA + j, r[(1, j)] * bias / math::GRAVITY_M_S2);
            self.covariance.set(THETA + 1, BA + j, -r[(0, j)] * bias / math::GRAVITY_M_S2);
        }
        self.aligned = true;
        self.local_origin_m = self.position_m;
        self.last_fused = LastFused::new(now);
        // The heading came from this measurement, so fusing it with zero innovation yields the matching covariance.
        let level = aligned.attitude.inverse() * self.field_gauss;
        self.fuse_mag(level, 1.0 / aligned.mag_samples, now);
    }

    fn predict(&mut self, reading: &ImuReading, dt_s: f64, now: SimTime) {
        let rates = reading.rates_rad_s - self.gyro_bias;
        let force = reading.specific_force_m_s2 - self.accel_bias;
        let turn = rates * dt_s;
        // Applying half of the rotation evaluates the force at the middle of the interval.
        let gained = self.attitude * ((force + turn.cross(force) * 0.5) * dt_s);
        let dv = gained + Vec3::new(0.0, 0.0, math::GRAVITY_M_S2 * dt_s);
        let moved_m = (self.velocity_m_s + dv * 0.5) * dt_s;
        self.position_m += moved_m;
        self.velocity_m_s += dv;
        self.recent_motion.add(moved_m, dv, now);
        self.attitude = self.attitude.rotated_by(turn);
        self.rates_rad_s = rates;
        self.acceleration_m_s2 = if dt_s > 0.0 { dv / dt_s } else { Vec3::zero() };
        self.unpropagated_velocity_m_s += gained;
        self.unpropagated_time_s += dt_s;
        let shock = force.norm();
        if shock > SHOCK_SPECIFIC_FORCE_M_S2 {
            self.shock_variance += (SHOCK_UNCERTAINTY_FRACTION * shock * dt_s) * (SHOCK_UNCERTAINTY_FRACTION * shock * dt_s);
        }
        if self.unpropagated_time_s >= COVARIANCE_PERIOD_S {
            self.propagate_covariance();
            self.update_validity(now);
        }
    }

    /// Propagates the covariance to the time of the state.
    fn propagate_covariance(&mut self) {
        if self.unpropagated_time_s <= 0.0 {
            return;
        }
        let r = self.attitude.matrix();
        self.covariance.propagate(
            &r,
            &self.unpropagated_velocity_m_s.raw(),
            self.unpropagated_time_s,
            &self.process,
            self.shock_variance,
        );
        self.gnss_height_offset_m *= 1.0 - self.unpropagated_time_s / self.process.gnss_height_time_s;
        self.unpropagated_velocity_m_s = Vec3::zero();
        self.unpropagated_time_s = 0.0;
        self.shock_variance = 0.0;
    }

    fn update_validity(&mut self, now: SimTime) {
        let share = if self.usable { 1.0 } else { REVALIDATION_FRACTION };
        let (v, p) = (self.velocity_sigma_m_s(), self.horizontal_sigma_m());
        let aided = (now - self.last_fused.velocity).s() < self.dead_reckoning_limit_s;
        self.usable = self.global_position_known
            && aided
            && v < MAX_USABLE_VELOCITY_SIGMA_M_S * share
            && p < MAX_USABLE_POSITION_SIGMA_M * share;
    }

    /// Horizontal velocity accuracy, m/s (1 sigma of the worse axis).
    #[must_use]
    pub fn velocity_sigma_m_s(&self) -> f64 {
        self.covariance.variance(V).max(self.covariance.variance(V + 1)).sqrt()
    }

    /// Whether the position is not accurate enough for control.
    fn has_lost_position(&self) -> bool {
        self.horizontal_sigma_m() > MAX_USABLE_POSITION_SIGMA_M
    }

    fn horizontal_sigma_m(&self) -> f64 {
        self.covariance.variance(P).max(self.covariance.variance(P + 1)).sqrt()
    }

    /// Sets the time without a fused velocity after which the position becomes invalid (s), the height reference, and
    /// whether the motors are off. Only with the motors off can the magnetometer alone reset the heading.
    pub fn configure(&mut self, dead_reckoning_limit_s: f64, reference: HeightReference, motors_off: bool) {
        (self.dead_reckoning_limit_s, self.configured_reference, self.motors_off) =
            (dead_reckoning_limit_s, reference, motors_off);
    }

    /// Sources that are not used because they contradict the others.
    #[must_use]
    pub fn dropped(&self) -> RejectedSources {
        let c = &self.checks;
        RejectedSources {
            compass: c.mag.dropped(),
            barometer: c.baro.dropped(),
            gnss: c.gnss.dropped() || c.gnss_height.dropped(),
        }
    }

    /// Returns the accumulated position reset to GNSS since the last call, in meters.
    pub fn take_position_reset(&mut self) -> Option<Vec3<Ned>> {
        let step_m = self.position_reset_m.take();
        self.position_resets += u32::from(step_m.is_some());
        step_m
    }

    /// Returns the number of position resets to GNSS that [`Self::take_position_reset`] has returned.
    #[must_use]
    pub fn position_resets(&self) -> u32 {
        self.position_resets
    }

    /// Resets the filter to a known pose, for example after a respawn at `from_m`. Keeps the biases and the error of the position: most of it is the
    /// receiver's, to which the position would return within seconds.
    pub fn reset_to_pose(&mut self, from_m: Vec3<Ned>, pose: &Pose, now: SimTime) {
        let error_m = self.position_m - from_m;
        let is_usual = self.global_position_known && error_m.norm() < MAX_KEPT_ERROR_SIGMAS * self.noise.gnss_m[1];
        self.position_m = pose.position_m + if is_usual { error_m } else { Vec3::zero() };
        self.velocity_m_s = pose.velocity_m_s;
        self.attitude = pose.attitude;
        self.unpropagated_velocity_m_s = Vec3::zero();
        self.unpropagated_time_s = 0.0;
        self.shock_variance = 0.0;
        if !self.aligned {
            let n = self.noise;
            let sq = |x: f64| x * x;
            let (g, a) = (sq(n.gyro_bias_rad_s), sq(n.accel_bias_m_s2));
            let mut variances = [0.0; STATE_COUNT];
            for i in 0..3 {
                variances[BG + i] = g;
                variances[BA + i] = a;
                variances[MAG + i] = sq(n.mag_bias_gauss);
            }
            variances[GNSS_HEIGHT] = self.process.gnss_height;
            variances[BARO] = sq(BARO_START_OFFSET_M);
            self.covariance = Covariance::diagonal(&variances);
        }
        self.covariance.reset(P, 3, 0.25);
        self.covariance.reset(V, 3, 0.04);
        self.covariance.reset(THETA, 3, 0.001);
        if !self.local_origin_set {
            self.local_origin_m = self.position_m;
            self.local_origin_set = true;
        }
        self.aligned = true;
        self.global_position_known = true;
        self.usable = true;
        self.checks = InnovationChecks::default();
        self.ground = GroundEstimate::default();
        self.height_reference.clear_ground_level();
        self.last_fused = LastFused::new(now);
    }

    /// Returns the current estimate.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        Estimate {
            position_m: self.position_m,
            velocity_m_s: self.velocity_m_s,
            attitude: self.attitude,
            rates_rad_s: self.rates_rad_s,
            horizontal_m: self.horizontal_sigma_m(),
            vertical_m: self.covariance.variance(P + 2).max(0.0).sqrt(),
            local_origin_m: self.local_origin_m,
            local_origin_set: self.local_origin_set,
            position_valid: self.usable,
            attitude_valid: self.aligned,
        }
    }

    /// Acceleration relative to the ground during the last inertial sampling interval, m/s².
    #[must_use]
    pub fn acceleration_m_s2(&self) -> Vec3<Ned> {
        self.acceleration_m_s2
    }

    /// Returns true if the filter has ever had a global position.
    #[must_use]
    pub fn located(&self) -> bool {
        self.global_position_known
    }

    /// The error covariance, for tests and for covariance messages.
    #[must_use]
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Estimated gyroscope (rad/s) and accelerometer (m/s²) biases.
    #[must_use]
    pub fn biases(&self) -> (Vec3<Frd>, Vec3<Frd>) {
        (self.gyro_bias, self.accel_bias)
    }

    /// Estimation error relative to a known true state, in the order of the first fifteen covariance states, for consistency
    /// tests.
    #[must_use]
    pub fn error(&self, truth: &SimulatedTruth) -> [f64; 15] {
        let turn = self.attitude.inverse().then(truth.attitude).raw();
        // FRAME: the inverse of the estimate followed by the true attitude is the small rotation in NED from the
        // estimated to the true attitude.
        let theta: Vector3<f64> = turn.scaled_axis();
        let parts = [
            (truth.position_m - self.position_m).array(),
            (truth.velocity_m_s - self.velocity_m_s).array(),
            [theta.x, theta.y, theta.z],
            (truth.gyro_bias_rad_s - self.gyro_bias).array(),
            (truth.accel_bias_m_s2 - self.accel_bias).array(),
        ];
        std::array::from_fn(|i| parts[i / 3][i % 3])
    }
}

/// Pose and velocity of the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
}

/// The known true state, for comparison in tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimulatedTruth {
    /// Position, m.
    pub position_m: Vec3<Ned>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
    /// Gyroscope bias, rad/s.
    pub gyro_bias_rad_s: Vec3<Frd>,
    /// Accelerometer bias, m/s².
    pub accel_bias_m_s2: Vec3<Frd>,
}
