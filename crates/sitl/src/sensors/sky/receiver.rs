//! A single-frequency receiver under the real sky.

use super::Sky;
use super::antenna::ratio_from_db;
use super::channel::{Channel, Measurement, Receiver};
use super::propagation::Reception;
use super::solution::{Observation, solve};
use crate::physics::RigidState;
use crate::sensors::dilution::{ELEVATION_MASK_RAD, MAX_HDOP, MIN_SATELLITES, dilution};
use crate::sensors::readings::GnssReading;
use crate::sensors::surroundings::Surroundings;
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::SensorSpec;
use std::sync::Arc;

/// Standard deviation per horizontal axis, m: 2.5 m CEP (u-blox M8 data sheet) divided by 1.1774, for a Gaussian error.
const HORIZONTAL_SIGMA_M: f64 = 2.12;
/// Standard deviation of the height, m (estimate: 1.5 times the horizontal one, as the dilutions of precision).
const VERTICAL_SIGMA_M: f64 = 3.2;
/// Drift that all satellites have in common, as standard deviation per axis, m: the above without what the satellites' own errors
/// contribute in the open sky, 0.7 m horizontally and 1.2 m vertically.
const COMMON_DRIFT_M: [f64; 3] = [2.0, 2.0, 2.95];
/// Time constant of the common drift, s (estimate: the ionosphere's delay changes over minutes).
const COMMON_DRIFT_TIME_S: f64 = 300.0;
/// Slow error of a satellite's own pseudorange, m, and its time constant, s (estimates: orbit, clock, slant of the ionosphere).
const SATELLITE_DRIFT_M: f64 = 1.0;
const SATELLITE_DRIFT_TIME_S: f64 = 600.0;
/// White noise of a pseudorange that the carrier has smoothed, at the reference strength, m (estimate).
const RANGE_NOISE_M: f64 = 0.1;
/// Standard deviation that the receiver assumes for a pseudorange at the reference strength, m (estimate). At other strengths, it is
/// in inverse proportion to the signal's amplitude.
const ASSUMED_SIGMA_M: f64 = 1.0;
/// Reference strength, dB Hz.
const REFERENCE_CN0_DB_HZ: f64 = 45.0;
/// Position dilution of precision above which there is no fix (u-blox M8: the default mask is 25).
const MAX_PDOP: f64 = 25.0;
/// Rate at which directions are computed again. Satellites move by 0.01 degrees in a second.
const DIRECTION_RATE_HZ: f64 = 1.0;

/// Returns the sensors of an aircraft with this receiver instead of its own, for everyone who relies on the accuracy in the open sky.
#[must_use]
pub fn receiver_spec(sensors: &SensorSpec) -> SensorSpec {
    SensorSpec { gnss_horizontal_noise_m: HORIZONTAL_SIGMA_M, gnss_vertical_noise_m: VERTICAL_SIGMA_M, ..*sensors }
}

/// State of the receiver. Plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyReceiver {
    sky: Arc<Sky>,
    stream: RandomStream,
    period_s: f64,
    velocity_m_s: f64,
    directions_due: Schedule,
    directions: Vec<Vec3<Enu>>,
    channels: Vec<Channel>,
    satellite_drift_m: Vec<f64>,
    drift_m: Vec3<Ned>,
}

impl SkyReceiver {
    /// Creates the receiver with the rate and the velocity noise of an aircraft's receiver.
    #[must_use]
    pub fn new(sensors: &SensorSpec, sky: Arc<Sky>, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "gnss-sky");
        let directions = sky.directions(SimTime::ZERO);
        let satellite_drift_m = directions.iter().map(|_| stream.normal() * SATELLITE_DRIFT_M).collect();
        let drift_m = common_drift(&mut stream);
        Self {
            sky,
            stream,
            period_s: 1.0 / sensors.gnss_rate_hz,
            velocity_m_s: sensors.gnss_velocity_noise_m_s,
            directions_due: Schedule::new(SimTime::ZERO, DIRECTION_RATE_HZ),
            channels: vec![Channel::new(); directions.len()],
            directions,
            satellite_drift_m,
            drift_m,
        }
    }

    /// Returns the drift that all satellites have in common, m, for estimator tests.
    #[must_use]
    pub fn drift_m(&self) -> Vec3<Ned> {
        self.drift_m
    }

    /// Returns the reading at a time. Call it once per period.
    pub fn read<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> GnssReading {
        if self.directions_due.fire(now) {
            self.directions = self.sky.directions(now);
        }
        self.advance_drift();
        let observations = self.observe(rigid, site, now);
        self.fix(rigid, &observations)
    }

    fn advance_drift(&mut self) {
        let keep = math::exp(-self.period_s / COMMON_DRIFT_TIME_S);
        self.drift_m = self.drift_m * keep + common_drift(&mut self.stream) * (1.0 - keep * keep).sqrt();
        let keep = math::exp(-self.period_s / SATELLITE_DRIFT_TIME_S);
        let push_m = SATELLITE_DRIFT_M * (1.0 - keep * keep).sqrt();
        for drift_m in &mut self.satellite_drift_m {
            *drift_m = *drift_m * keep + self.stream.normal() * push_m;
        }
    }

    /// Tracks all satellites above the mask; returns those that the receiver uses.
    fn observe<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> Vec<Observation> {
        let sky = Arc::clone(&self.sky);
        let position_m = rigid.position_m.enu();
        let reception = Reception { walls: sky.reflectors.walls_near(position_m), sky: &sky, site, position_m, now };
        let lowest_up = math::sin(ELEVATION_MASK_RAD);
        let mut observations = Vec::new();
        for index in 0..self.channels.len() {
            let satellite = self.directions[index];
            if satellite.up() < lowest_up {
                self.channels[index] = Channel::new();
                continue;
            }
            let receiver = Receiver { satellite, velocity_m_s: rigid.velocity_m_s, now };
            let measurement = self.channels[index].track(&reception.signals(satellite), &receiver, self.period_s);
            observations.extend(measurement.map(|measurement| self.observation(index, &measurement)));
        }
        observations
    }

    fn observation(&mut self, index: usize, measurement: &Measurement) -> Observation {
        let weakness = ratio_from_db((REFERENCE_CN0_DB_HZ - measurement.cn0_db_hz).max(0.0));
        let (range, rate) = self.stream.normal_pair();
        Observation {
            satellite: self.directions[index],
            sigma_m: ASSUMED_SIGMA_M * weakness,
            range_error_m: self.satellite_drift_m[index] + measurement.path_error_m + range * RANGE_NOISE_M * weakness,
            rate_error_m_s: measurement.rate_error_m_s + rate * self.velocity_m_s * weakness,
        }
    }

    fn fix(&self, rigid: &RigidState, observations: &[Observation]) -> GnssReading {
        let satellites = u8::try_from(observations.len()).unwrap_or(u8::MAX);
        let geometry = dilution(observations.iter().map(|one| one.satellite));
        let geometry = geometry.filter(|(hdop, vdop)| *hdop < MAX_HDOP && math::hypot(*hdop, *vdop) < MAX_PDOP);
        let enough = observations.len() >= MIN_SATELLITES;
        let (Some((hdop, vdop)), Some(solution), true) = (geometry, solve(observations), enough) else {
            return GnssReading::without_fix(satellites);
        };
        GnssReading {
            fix: 3,
            satellites,
            position_m: rigid.position_m + self.drift_m + solution.position_m,
            velocity_m_s: rigid.velocity_m_s + solution.velocity_m_s,
            hdop,
            vdop,
            eph_m: math::hypot(COMMON_DRIFT_M[0], solution.horizontal_m),
            epv_m: math::hypot(COMMON_DRIFT_M[2], solution.vertical_m),
        }
    }
}

fn common_drift(stream: &mut RandomStream) -> Vec3<Ned> {
    let ([n, e, d], [north, east, down]) = (stream.normal3(), COMMON_DRIFT_M);
    Vec3::new(n * north, e * east, d * down)
}
