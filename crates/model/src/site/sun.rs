//! Sun position according to the low-accuracy method of Meeus, Astronomical Algorithms (2nd ed.), chapter 25 (0.01 deg
//! in longitude), with the sidereal time of chapter 12. The direction is accurate to 0.1 deg between 1950 and 2050.
//! Refraction is ignored.

use crate::frames::{Enu, Vec3};
use crate::geodesy::Geo;
use crate::math;

/// Seconds from the Unix epoch to J2000.0 (2000-01-01 12:00 UTC). The difference of one minute between UTC and TT causes an error
/// of only 0.0007 deg.
const J2000_UNIX_S: f64 = 946_728_000.0;
const DAY_S: f64 = 86_400.0;

/// Apparent right ascension and declination of the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunCoordinates {
    /// Right ascension, rad in (-π, π].
    pub right_ascension_rad: f64,
    /// Declination, rad.
    pub declination_rad: f64,
}

/// Returns the equatorial coordinates of the sun at a UTC time, given in seconds since the Unix epoch.
#[must_use]
pub fn equatorial(unix_s: f64) -> SunCoordinates {
    let t = (unix_s - J2000_UNIX_S) / DAY_S / 36_525.0;
    let mean_longitude = 280.466_46 + t * (36_000.769_83 + t * 0.000_303_2);
    let anomaly = (357.529_11 + t * (35_999.050_29 - t * 0.000_153_7)).to_radians();
    let center = (1.914_602 - t * (0.004_817 + t * 0.000_014)) * math::sin(anomaly)
        + (0.019_993 - t * 0.000_101) * math::sin(2.0 * anomaly)
        + 0.000_289 * math::sin(3.0 * anomaly);
    let node = (125.04 - 1_934.136 * t).to_radians();
    let longitude = (mean_longitude + center - 0.005_69 - 0.004_78 * math::sin(node)).to_radians();
    let obliquity = (23.439_291 - t * 0.013_004_2 + 0.002_56 * math::cos(node)).to_radians();
    let (s, c) = math::sin_cos(longitude);
    SunCoordinates {
        right_ascension_rad: math::atan2(math::cos(obliquity) * s, c),
        declination_rad: math::asin(math::sin(obliquity) * s),
    }
}

/// Returns the unit vector from a position toward the center of the sun at a UTC time, given in seconds since the Unix epoch.
#[must_use]
pub fn direction(unix_s: f64, location: Geo) -> Vec3<Enu> {
    let sun = equatorial(unix_s);
    let days = (unix_s - J2000_UNIX_S) / DAY_S;
    let t = days / 36_525.0;
    let sidereal_deg = 280.460_618_37 + 360.985_647_366_29 * days + 0.000_387_933 * t * t;
    let hour_angle = math::wrap_pi((sidereal_deg + location.longitude_deg).to_radians() - sun.right_ascension_rad);
    let (sl, cl) = math::sin_cos(location.latitude_deg.to_radians());
    let (sd, cd) = math::sin_cos(sun.declination_rad);
    let (sh, ch) = math::sin_cos(hour_angle);
    Vec3::new(-cd * sh, sd * cl - cd * ch * sl, sd * sl + cd * ch * cl).unit()
}

/// Returns the elevation of a direction above the horizon in radians.
#[must_use]
pub fn elevation_rad(direction: Vec3<Enu>) -> f64 {
    math::asin(direction.up())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The method's stated accuracy plus the rounding of the published values, deg.
    const TOLERANCE_DEG: f64 = 0.1;

    fn azimuth_deg(d: Vec3<Enu>) -> f64 {
        math::bearing_deg(d.east(), d.north())
    }

    #[test]
    fn val_sun_position_matches_the_nrel_spa_example() {
        // Reda and Andreas, NREL/TP-560-34302, Table A5.1: 2003-10-17 19:30:30 UTC, 39.742476 N 105.1786 W: zenith 50.11162
        // (with 0.0159 deg of refraction, removed here), azimuth 194.34024.
        let golden = Geo { latitude_deg: 39.742_476, longitude_deg: -105.1786, altitude_m: 1830.14 };
        let d = direction(1_066_419_030.0, golden);
        assert!((elevation_rad(d).to_degrees() - (90.0 - 50.11162 - 0.0159)).abs() < TOLERANCE_DEG);
        assert!((azimuth_deg(d) - 194.34024).abs() < TOLERANCE_DEG, "{}", azimuth_deg(d));
    }

    #[test]
    fn val_sun_coordinates_match_meeus_example_25a() {
        // 1992 October 13, 0 h TD: right ascension 198.38083 deg, declination -7.78507 deg.
        let sun = equatorial(718_934_400.0);
        assert!((sun.right_ascension_rad.to_degrees().rem_euclid(360.0) - 198.38083).abs() < TOLERANCE_DEG);
        assert!((sun.declination_rad.to_degrees() + 7.78507).abs() < TOLERANCE_DEG);
    }

    #[test]
    fn val_sun_declination_matches_the_2024_equinox_and_solstice() {
        // Published times: equinox 2024-03-20 03:06 UTC, solstice 2024-06-20 20:51 UTC (obliquity 23.436 deg).
        assert!(equatorial(1_710_903_960.0).declination_rad.to_degrees().abs() < TOLERANCE_DEG);
        assert!((equatorial(1_718_916_660.0).declination_rad.to_degrees() - 23.436).abs() < TOLERANCE_DEG);
    }

    #[test]
    fn prop_sun_rises_in_the_east_and_culminates_in_the_south() {
        let location = Geo { latitude_deg: 46.5, longitude_deg: 0.0, altitude_m: 0.0 };
        let morning = direction(1_718_863_200.0, location);
        let noon = direction(1_718_884_800.0, location);
        assert!(morning.east() > 0.7 && morning.up() > 0.0, "{morning:?}");
        assert!(noon.north() < -0.3 && noon.east().abs() < 0.05, "{noon:?}");
    }
}
