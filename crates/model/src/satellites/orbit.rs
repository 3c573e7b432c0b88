//! Position of a satellite from its almanac, with the user algorithm of IS-GPS-200 (20.3.3.5.2.1 and Table 20-IV, without the
//! harmonic corrections, which almanacs don't contain).

use crate::math;

/// Earth's gravitational constant for GPS, m³/s² (IS-GPS-200). Galileo's differs by 1e-10 of it.
const EARTH_GRAVITY_M3_S2: f64 = 3.986_005e14;
/// Earth's rotation rate, rad/s (IS-GPS-200).
const EARTH_RATE_RAD_S: f64 = 7.292_115_146_7e-5;
/// GPS epoch, 1980-01-06 00:00 UTC, in Unix time, s.
const GPS_EPOCH_UNIX_S: f64 = 315_964_800.0;
/// Seconds by which GPS time is ahead of UTC since 2017 (IERS Bulletin C). An error of 1 s moves a satellite by 4 km, or 0.01
/// degrees in the sky.
const LEAP_SECONDS: f64 = 18.0;
/// Length of a GPS week, s.
const WEEK_S: f64 = 604_800.0;
/// Number of weeks after which the transmitted week number starts again.
const ROLLOVER_WEEKS: f64 = 1_024.0;
/// Iterations of Kepler's equation. With an eccentricity below 0.1, each of Newton's steps squares the error.
const KEPLER_ITERATIONS: u32 = 5;

/// A time since the GPS epoch, s.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct GpsTime(pub f64);

impl GpsTime {
    /// Converts seconds since the Unix epoch.
    #[must_use]
    pub fn from_unix_s(unix_s: f64) -> Self {
        Self(unix_s - GPS_EPOCH_UNIX_S + LEAP_SECONDS)
    }
}

/// A satellite's orbit as in an almanac.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SatelliteOrbit {
    /// Number of the satellite.
    pub id: u16,
    /// Week of the time of applicability. Weeks below 1024 count from the rollover that is nearest to the time of use.
    pub week: u32,
    /// Time of applicability in its week, s.
    pub applicable_s: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Inclination, rad.
    pub inclination_rad: f64,
    /// Rate of the right ascension of the ascending node, rad/s.
    pub node_rate_rad_s: f64,
    /// Square root of the semi-major axis, m^0.5.
    pub root_of_axis: f64,
    /// Longitude of the ascending node at the start of the week, rad.
    pub node_rad: f64,
    /// Argument of perigee, rad.
    pub argument_of_perigee_rad: f64,
    /// Mean anomaly at the time of applicability, rad.
    pub mean_anomaly_rad: f64,
}

impl SatelliteOrbit {
    /// Returns the earth-centered, earth-fixed position in meters.
    #[must_use]
    pub fn position_ecef_m(&self, time: GpsTime) -> [f64; 3] {
        let elapsed_s = self.elapsed_s(time);
        let axis_m = self.root_of_axis * self.root_of_axis;
        let mean_motion_rad_s = (EARTH_GRAVITY_M3_S2 / (axis_m * axis_m * axis_m)).sqrt();
        let e = self.eccentricity;
        let anomaly = eccentric_anomaly(self.mean_anomaly_rad + mean_motion_rad_s * elapsed_s, e);
        let (s, c) = math::sin_cos(anomaly);
        let true_anomaly = math::atan2((1.0 - e * e).sqrt() * s, c - e);
        let radius_m = axis_m * (1.0 - e * c);
        let (su, cu) = math::sin_cos(true_anomaly + self.argument_of_perigee_rad);
        let node = self.node_rad + (self.node_rate_rad_s - EARTH_RATE_RAD_S) * elapsed_s - EARTH_RATE_RAD_S * self.applicable_s;
        let (sn, cn) = math::sin_cos(node);
        let (si, ci) = math::sin_cos(self.inclination_rad);
        let (x, y) = (radius_m * cu, radius_m * su);
        [x * cn - y * ci * sn, x * sn + y * ci * cn, y * si]
    }

    /// Returns the time since the time of applicability, s.
    fn elapsed_s(&self, time: GpsTime) -> f64 {
        let stated_s = f64::from(self.week) * WEEK_S + self.applicable_s;
        if f64::from(self.week) >= ROLLOVER_WEEKS {
            return time.0 - stated_s;
        }
        let period_s = ROLLOVER_WEEKS * WEEK_S;
        let elapsed_s = time.0 - stated_s;
        elapsed_s - period_s * (elapsed_s / period_s).round()
    }
}

/// Solves Kepler's equation with Newton's method.
fn eccentric_anomaly(mean_anomaly_rad: f64, eccentricity: f64) -> f64 {
    let mean = math::wrap_pi(mean_anomaly_rad);
    (0..KEPLER_ITERATIONS).fold(mean, |anomaly, _| {
        let (s, c) = math::sin_cos(anomaly);
        anomaly - (anomaly - eccentricity * s - mean) / (1.0 - eccentricity * c)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of earth-centered coordinates, m: 1e-16 of 2.7e7 m, times the number of operations.
    const ROUNDING_M: f64 = 1e-6;
    /// Rounding of angles after some hours, rad, times the radius of the orbit, m.
    const ANGLE_ROUNDING_M: f64 = 1e-4;

    /// Semi-major axis of GPS, m.
    const AXIS_M: f64 = 26_559_700.0;

    fn circular() -> SatelliteOrbit {
        SatelliteOrbit {
            id: 1,
            week: 2_400,
            applicable_s: 0.0,
            eccentricity: 0.0,
            inclination_rad: 55f64.to_radians(),
            node_rate_rad_s: 0.0,
            root_of_axis: AXIS_M.sqrt(),
            node_rad: 0.4,
            argument_of_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        }
    }

    fn start(orbit: &SatelliteOrbit) -> f64 {
        f64::from(orbit.week) * WEEK_S + orbit.applicable_s
    }

    fn norm([x, y, z]: [f64; 3]) -> f64 {
        (x * x + y * y + z * z).sqrt()
    }

    #[test]
    fn exact_circular_orbit_keeps_its_radius_and_repeats_over_the_turning_earth() {
        let orbit = circular();
        let period_s = math::TAU * (AXIS_M * AXIS_M * AXIS_M / EARTH_GRAVITY_M3_S2).sqrt();
        // Half a sidereal day, 43,082 s.
        assert!((period_s - 43_077.0).abs() < 5.0, "{period_s}");
        let at = |s: f64| orbit.position_ecef_m(GpsTime(start(&orbit) + s));
        for k in 0..20 {
            let radius_m = norm(at(f64::from(k) * 2_777.0));
            assert!((radius_m - AXIS_M).abs() < ROUNDING_M, "{radius_m}");
        }
        let turn = EARTH_RATE_RAD_S * period_s;
        let (first, later) = (at(0.0), at(period_s));
        let (s, c) = math::sin_cos(-turn);
        let turned = [c * first[0] - s * first[1], s * first[0] + c * first[1], first[2]];
        assert!(norm([0, 1, 2].map(|i| turned[i] - later[i])) < ANGLE_ROUNDING_M, "{turned:?} {later:?}");
    }

    #[test]
    fn exact_satellite_stands_over_its_node_then_at_its_highest_latitude() {
        let orbit = circular();
        let quarter_s = 0.25 * math::TAU * (AXIS_M * AXIS_M * AXIS_M / EARTH_GRAVITY_M3_S2).sqrt();
        let [x, y, z] = orbit.position_ecef_m(GpsTime(start(&orbit)));
        assert!((math::atan2(y, x) - 0.4).abs() < 1e-12 && z.abs() < ROUNDING_M, "{x} {y} {z}");
        let [x, y, z] = orbit.position_ecef_m(GpsTime(start(&orbit) + quarter_s));
        let latitude_rad = math::asin(z / norm([x, y, z]));
        assert!((latitude_rad - orbit.inclination_rad).abs() < 1e-9, "{latitude_rad}");
        let longitude_rad = 0.4 + 0.5 * math::PI - EARTH_RATE_RAD_S * quarter_s;
        assert!((math::wrap_pi(math::atan2(y, x) - longitude_rad)).abs() < 1e-9, "{}", math::atan2(y, x));
    }

    #[test]
    fn exact_perigee_and_apogee_are_at_the_axis_times_one_minus_and_plus_the_eccentricity() {
        let at = |mean_anomaly_rad: f64| {
            let orbit = SatelliteOrbit { eccentricity: 0.02, mean_anomaly_rad, ..circular() };
            norm(orbit.position_ecef_m(GpsTime(start(&orbit))))
        };
        assert!((at(0.0) - 0.98 * AXIS_M).abs() < ROUNDING_M, "{}", at(0.0));
        assert!((at(math::PI) - 1.02 * AXIS_M).abs() < ROUNDING_M, "{}", at(math::PI));
    }

    #[test]
    fn exact_short_week_numbers_count_from_the_nearest_rollover() {
        let full = circular();
        let short = SatelliteOrbit { week: full.week % 1_024, ..full };
        for days in [-40.0, 0.0, 300.0] {
            let time = GpsTime(start(&full) + days * 86_400.0);
            assert_eq!(short.position_ecef_m(time), full.position_ecef_m(time), "{days}");
        }
    }
}
