//! GNSS receiver with a fixed satellite constellation. Structures hide satellites, and the dilution of precision
//! follows from the visible ones. Position errors combine slow drift, white noise, and multipath that grows with the
//! hidden fraction of the sky.

use super::readings::GnssReading;
use super::surroundings::Surroundings;
use crate::physics::RigidState;
use nalgebra::{Matrix4, Vector4};
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;

/// Satellites above the elevation mask (estimate: four constellations, one frequency).
pub const SATELLITE_COUNT: usize = 22;
/// Elevation mask, rad (10 degrees, common in receivers).
const ELEVATION_MASK_RAD: f64 = 0.174_533;
/// Minimum number of satellites for a fix (four for the four unknowns, and one for a consistency check).
const MIN_SATELLITES: usize = 5;
/// Maximum horizontal dilution of precision for a fix (estimate: receivers flag larger values as unusable).
const MAX_HDOP: f64 = 8.0;
/// Range within which structures hide satellites, m (larger than any site).
const BLOCKING_RANGE_M: f64 = 400.0;
/// Slowly drifting fraction of the position noise; the white-noise fraction accounts for the remaining variance.
pub const DRIFT_FRACTION: f64 = 0.8;
/// White-noise fraction of the position noise: `DRIFT_FRACTION`² + `WHITE_NOISE_FRACTION`² = 1.
pub const WHITE_NOISE_FRACTION: f64 = 0.6;
/// Time constant of the drift, s (estimate: ionosphere and orbit errors at one receiver change over minutes).
pub const DRIFT_TIME_CONSTANT_S: f64 = 120.0;
/// Multipath error with nearly all satellites hidden, m (estimate), and its time constant, s.
const MAX_MULTIPATH_ERROR_M: f64 = 3.0;
const MULTIPATH_TIME_CONSTANT_S: f64 = 8.0;

/// State of the receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct GnssReceiver {
    stream: RandomStream,
    due: Schedule,
    period_s: f64,
    shadow: bool,
    horizontal_m: f64,
    vertical_m: f64,
    velocity_m_s: f64,
    sky: Vec<Vec3<Enu>>,
    open: (f64, f64),
    drift: Vec3<Ned>,
    multipath: Vec3<Ned>,
    multipath_variance_m2: f64,
}

impl GnssReceiver {
    /// Creates the receiver. With `shadow`, structures hide satellites.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, shadow: bool, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "gnss");
        let sky = sky();
        let open = dilution(sky.iter().copied()).unwrap_or((1.0, 1.0));
        let mut gnss = Self {
            due: Schedule::new(SimTime::ZERO, sensors.gnss_rate_hz),
            period_s: 1.0 / sensors.gnss_rate_hz,
            shadow,
            horizontal_m: sensors.gnss_horizontal_noise_m,
            vertical_m: sensors.gnss_vertical_noise_m,
            velocity_m_s: sensors.gnss_velocity_noise_m_s,
            sky,
            open,
            drift: Vec3::zero(),
            multipath: Vec3::zero(),
            multipath_variance_m2: 0.0,
            stream: stream.clone(),
        };
        gnss.drift = gnss.random_error(&mut stream, DRIFT_FRACTION);
        gnss.stream = stream;
        gnss
    }

    /// Returns a reading if one is due.
    pub fn read<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> Option<GnssReading> {
        if !self.due.fire(now) {
            return None;
        }
        let position_m = rigid.position_m.enu();
        let visible: Vec<Vec3<Enu>> = self.sky.iter().copied().filter(|d| self.is_visible(position_m, *d, site, now)).collect();
        let hidden = 1.0 - visible.len() as f64 / self.sky.len() as f64;
        self.advance_errors(hidden);
        Some(self.fix(rigid, &visible))
    }

    fn is_visible<S: Surroundings>(&self, position_m: Vec3<Enu>, direction: Vec3<Enu>, site: &S, now: SimTime) -> bool {
        !self.shadow || site.ray_m(position_m, direction, BLOCKING_RANGE_M, now).is_none()
    }

    fn advance_errors(&mut self, hidden: f64) {
        let mut stream = self.stream.clone();
        let keep = math::exp(-self.period_s / DRIFT_TIME_CONSTANT_S);
        self.drift = self.drift * keep + self.random_error(&mut stream, DRIFT_FRACTION * (1.0 - keep * keep).sqrt());
        let keep = math::exp(-self.period_s / MULTIPATH_TIME_CONSTANT_S);
        let push = MAX_MULTIPATH_ERROR_M * hidden * (1.0 - keep * keep).sqrt();
        self.multipath = self.multipath * keep + normal3(&mut stream) * push;
        self.multipath_variance_m2 = self.multipath_variance_m2 * keep * keep + push * push;
        self.stream = stream;
    }

    /// Returns a random error with the receiver's horizontal and vertical noise multiplied by `share`.
    fn random_error(&self, stream: &mut RandomStream, share: f64) -> Vec3<Ned> {
        let [n, e, d] = stream.normal3();
        Vec3::new(n * self.horizontal_m, e * self.horizontal_m, d * self.vertical_m) * share
    }

    fn fix(&mut self, rigid: &RigidState, visible: &[Vec3<Enu>]) -> GnssReading {
        let mut stream = self.stream.clone();
        let white = self.random_error(&mut stream, WHITE_NOISE_FRACTION);
        let speed = normal3(&mut stream) * self.velocity_m_s;
        self.stream = stream;
        let satellites = u8::try_from(visible.len()).unwrap_or(u8::MAX);
        let dop = dilution(visible.iter().copied()).filter(|(h, _)| *h < MAX_HDOP && visible.len() >= MIN_SATELLITES);
        let Some((hdop, vdop)) = dop else {
            return GnssReading { fix: 0, satellites, ..no_fix() };
        };
        let (sh, sv) = (hdop / self.open.0, vdop / self.open.1);
        let stretch = |v: Vec3<Ned>| Vec3::<Ned>::new(v.north() * sh, v.east() * sh, v.down() * sv);
        let multipath_m = self.multipath_variance_m2.sqrt();
        GnssReading {
            fix: 3,
            satellites,
            position_m: rigid.position_m + self.drift + stretch(white) + self.multipath,
            velocity_m_s: rigid.velocity_m_s + stretch(speed),
            hdop,
            vdop,
            eph_m: math::hypot(self.horizontal_m * sh, multipath_m),
            epv_m: math::hypot(self.vertical_m * sv, multipath_m),
        }
    }

    /// Returns the current drift in meters, for estimator tests.
    #[must_use]
    pub fn drift_m(&self) -> Vec3<Ned> {
        self.drift
    }
}

fn normal3(stream: &mut RandomStream) -> Vec3<Ned> {
    let [n, e, d] = stream.normal3();
    Vec3::new(n, e, d)
}

fn no_fix() -> GnssReading {
    GnssReading {
        fix: 0,
        satellites: 0,
        position_m: Vec3::zero(),
        velocity_m_s: Vec3::zero(),
        hdop: 99.99,
        vdop: 99.99,
        eph_m: f64::INFINITY,
        epv_m: f64::INFINITY,
    }
}

/// Returns unit vectors to the satellites, spread evenly above the mask with the golden angle.
fn sky() -> Vec<Vec3<Enu>> {
    let golden = math::PI * (3.0 - 5.0_f64.sqrt());
    let low = math::sin(ELEVATION_MASK_RAD);
    (0..SATELLITE_COUNT)
        .map(|i| {
            let up = low + (1.0 - low) * (i as f64 + 0.5) / SATELLITE_COUNT as f64;
            let (s, c) = math::sin_cos(golden * i as f64);
            let flat = (1.0 - up * up).sqrt();
            Vec3::new(flat * s, flat * c, up)
        })
        .collect()
}

/// Returns the horizontal and vertical dilution of precision, or `None` with too few satellites or a degenerate
/// geometry.
fn dilution(sky: impl Iterator<Item = Vec3<Enu>>) -> Option<(f64, f64)> {
    let normal: Matrix4<f64> = sky.fold(Matrix4::zeros(), |sum, d| {
        let row = Vector4::new(-d.east(), -d.north(), -d.up(), 1.0);
        sum + row * row.transpose()
    });
    let inverse = normal.try_inverse()?;
    let (h2, v2) = (inverse[(0, 0)] + inverse[(1, 1)], inverse[(2, 2)]);
    (h2.is_finite() && h2 > 0.0 && v2 > 0.0).then(|| (h2.sqrt(), v2.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_four_satellites_have_textbook_dilution() {
        // One at the zenith and three at 120 degrees on the horizon: HDOP² = 4/3 and VDOP² = 4/3.
        let third = math::TAU / 3.0;
        let low = (0..3).map(|i| Vec3::new(math::sin(third * f64::from(i)), math::cos(third * f64::from(i)), 0.0));
        let all = low.chain(std::iter::once(Vec3::new(0.0, 0.0, 1.0)));
        let expected = (4.0_f64 / 3.0).sqrt();
        let (h, v) = dilution(all).unwrap_or((0.0, 0.0));
        assert!((h - expected).abs() < 1e-12 && (v - expected).abs() < 1e-12, "{h} {v}");
    }

    struct CoveredSky;
    impl Surroundings for CoveredSky {
        fn ray_m(&self, _: Vec3<Enu>, d: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
            (d.up() > 0.3).then_some(5.0)
        }
        fn lux(&self, _: Vec3<Enu>, _: SimTime) -> f64 {
            1e4
        }
    }

    #[test]
    fn prop_covered_sky_prevents_fix_only_with_shadowing() {
        let sensors = crate::sensors::tests::error_free_sensors();
        let rigid = crate::sensors::tests::still();
        let fix = |shadow| GnssReceiver::new(&sensors, shadow, 1).read(&rigid, &CoveredSky, SimTime::ZERO).map(|r| r.fix);
        assert_eq!(fix(false), Some(3));
        assert_eq!(fix(true), Some(0));
    }
}
