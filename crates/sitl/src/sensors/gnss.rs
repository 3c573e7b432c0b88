//! GNSS receiver with a fixed satellite constellation, or, in jobs with `hazards.sky`, with the real sky ([`super::sky`]). In the fixed
//! constellation, structures hide satellites, and the dilution of precision
//! follows from the visible ones. Position errors combine slow drift, white noise, and multipath that grows with the
//! hidden fraction of the sky. Receivers of both kinds need a while for a solution: a reading describes an earlier instant.

use super::dilution::{BLOCKING_RANGE_M, ELEVATION_MASK_RAD, MAX_HDOP, MIN_SATELLITES, dilution};
use super::readings::GnssReading;
use super::sky::SkyReceiver;
use super::surroundings::Surroundings;
use crate::physics::RigidState;
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;
use std::collections::VecDeque;

/// Satellites above the elevation mask (estimate: four constellations, one frequency).
pub const SATELLITE_COUNT: usize = 22;
/// Slowly drifting fraction of the position noise; the white-noise fraction accounts for the remaining variance.
const DRIFT_FRACTION: f64 = 0.995;
/// White-noise fraction of the position noise: `DRIFT_FRACTION`² + `WHITE_NOISE_FRACTION`² = 1 (estimate: receivers smooth the
/// ranges with the carrier phase, so that successive fixes differ by centimeters).
const WHITE_NOISE_FRACTION: f64 = 0.1;
/// Time constant of the drift, s (estimate: ionosphere and orbit errors at one receiver change over minutes).
const DRIFT_TIME_CONSTANT_S: f64 = 120.0;
/// Multipath error with nearly all satellites hidden, m (estimate), and its time constant, s.
const MAX_MULTIPATH_ERROR_M: f64 = 3.0;
const MULTIPATH_TIME_CONSTANT_S: f64 = 8.0;

/// State of the receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct GnssReceiver {
    stream: RandomStream,
    due: Schedule,
    period_s: f64,
    delay: SimTime,
    /// Readings that the autopilot has not got yet, with the time at which it gets them.
    pending: VecDeque<(SimTime, GnssReading)>,
    shadow: bool,
    horizontal_m: f64,
    vertical_m: f64,
    velocity_m_s: f64,
    sky: Vec<Vec3<Enu>>,
    open: (f64, f64),
    drift: Vec3<Ned>,
    multipath: Vec3<Ned>,
    multipath_variance_m2: f64,
    real_sky: Option<Box<SkyReceiver>>,
}

impl GnssReceiver {
    /// Creates the receiver. With `shadow`, structures hide satellites. With `real_sky`, all readings come from it.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, shadow: bool, real_sky: Option<Box<SkyReceiver>>, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "gnss");
        let sky = sky();
        let open = dilution(sky.iter().copied()).unwrap_or((1.0, 1.0));
        let mut gnss = Self {
            due: Schedule::new(SimTime::ZERO, sensors.gnss_rate_hz),
            period_s: 1.0 / sensors.gnss_rate_hz,
            delay: SimTime::from_s(sensors.gnss_delay_s),
            pending: VecDeque::new(),
            shadow,
            horizontal_m: sensors.gnss_horizontal_noise_m,
            vertical_m: sensors.gnss_vertical_noise_m,
            velocity_m_s: sensors.gnss_velocity_noise_m_s,
            sky,
            open,
            drift: Vec3::zero(),
            multipath: Vec3::zero(),
            multipath_variance_m2: 0.0,
            real_sky,
            stream: stream.clone(),
        };
        gnss.drift = gnss.random_error(&mut stream, DRIFT_FRACTION);
        gnss.stream = stream;
        gnss
    }

    /// Returns a reading if one is due: that of the instant one delay ago.
    pub fn read<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> Option<GnssReading> {
        if let Some(reading) = self.measure(rigid, site, now) {
            self.pending.push_back((now + self.delay, reading));
        }
        self.pending.pop_front_if(|(due, _)| *due <= now).map(|(_, reading)| reading)
    }

    /// Discards what the receiver has measured but not sent, because the aircraft is now at another place.
    pub fn discard_pending(&mut self) {
        self.pending.clear();
    }

    /// Returns a reading of this instant if a measurement is due.
    fn measure<S: Surroundings>(&mut self, rigid: &RigidState, site: &S, now: SimTime) -> Option<GnssReading> {
        if !self.due.fire(now) {
            return None;
        }
        if let Some(sky) = &mut self.real_sky {
            return Some(sky.read(rigid, site, now));
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
            return GnssReading::without_fix(satellites);
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
        self.real_sky.as_ref().map_or(self.drift, |sky| sky.drift_m())
    }
}

fn normal3(stream: &mut RandomStream) -> Vec3<Ned> {
    let [n, e, d] = stream.normal3();
    Vec3::new(n, e, d)
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn exact_reading_describes_the_instant_one_delay_ago() {
        let delay = SimTime::from_ms(110);
        let sensors =
            vehicle::SensorSpec { gnss_delay_s: delay.s(), gnss_rate_hz: 10.0, ..crate::sensors::tests::error_free_sensors() };
        let mut receiver = GnssReceiver::new(&sensors, false, None, 1);
        let mut received = Vec::new();
        for ms in 0..1000 {
            let now = SimTime::from_ms(ms);
            let mut rigid = crate::sensors::tests::still();
            rigid.position_m = Vec3::new(now.s(), 0.0, 0.0);
            if let Some(reading) = receiver.read(&rigid, &CoveredSky, now) {
                received.push((now, reading.position_m.north()));
            }
        }
        assert_eq!(received.len(), 9);
        for (now, north_m) in received {
            assert!((north_m - (now - delay).s()).abs() < 1e-12, "{now:?}: {north_m}");
        }
        receiver.discard_pending();
        assert_eq!(receiver.read(&crate::sensors::tests::still(), &CoveredSky, SimTime::from_ms(1010)), None);
    }

    #[test]
    fn prop_covered_sky_prevents_fix_only_with_shadowing() {
        let sensors = crate::sensors::tests::error_free_sensors();
        let rigid = crate::sensors::tests::still();
        let fix = |shadow| GnssReceiver::new(&sensors, shadow, None, 1).read(&rigid, &CoveredSky, SimTime::ZERO).map(|r| r.fix);
        assert_eq!(fix(false), Some(3));
        assert_eq!(fix(true), Some(0));
    }
}
