//! Orbits of navigation satellites: almanacs in the YUMA format, and where their satellites are in the sky.

mod orbit;
mod yuma;

pub use orbit::{GpsTime, SatelliteOrbit};
pub use yuma::read;

use crate::frames::{Enu, Vec3};
use crate::geodesy::LocalPlane;

/// Text of the almanac that jobs use by default: nominal orbits of GPS, Galileo and BeiDou.
const NOMINAL: &str = include_str!("nominal.alm");

/// The satellites of an almanac that are healthy.
#[derive(Debug, Clone, PartialEq)]
pub struct Almanac {
    /// Orbits, in the order of the file.
    pub orbits: Vec<SatelliteOrbit>,
}

impl Almanac {
    /// Returns the nominal orbits of GPS, Galileo and BeiDou in medium orbits, 24 slots each. The planes and the spacing are those of
    /// the published reference constellations; the real satellites are elsewhere.
    #[must_use]
    pub fn nominal() -> Self {
        read("nominal.alm", NOMINAL).unwrap_or(Self { orbits: Vec::new() })
    }

    /// Returns the unit vector from the plane's origin to each satellite at a time, in the order of the orbits. The vectors of
    /// satellites below the horizon point down.
    #[must_use]
    pub fn directions(&self, plane: &LocalPlane, time: GpsTime) -> Vec<Vec3<Enu>> {
        self.orbits.iter().map(|orbit| plane.enu_from_ecef(orbit.position_ecef_m(time)).unit()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::{Geo, SEMI_MAJOR_AXIS_M};
    use crate::math;

    #[test]
    fn val_nominal_almanac_has_the_published_slots() {
        // GPS SPS Performance Standard, October 2001, Table 3-1; Galileo reference constellation (Walker 24/3/1, 56 degrees);
        // BeiDou in medium orbits (Walker 24/3/1, 55 degrees, 21,528 km).
        let almanac = Almanac::nominal();
        assert_eq!(almanac.orbits.len(), 72);
        let (gps, others) = almanac.orbits.split_at(24);
        let (galileo, beidou) = others.split_at(24);
        let degrees = |a: f64| a.to_degrees().rem_euclid(360.0);
        let slot = |orbit: &SatelliteOrbit| degrees(orbit.argument_of_perigee_rad + orbit.mean_anomaly_rad);
        for (index, argument_deg) in [(0, 268.126), (5, 173.336), (10, 339.666), (15, 167.356), (16, 197.046), (23, 135.346)] {
            assert!((slot(&gps[index]) - argument_deg).abs() < 1e-6, "{index}: {}", slot(&gps[index]));
        }
        for (plane, slots) in galileo.chunks(8).enumerate() {
            for (k, orbit) in slots.iter().enumerate() {
                let expected = degrees((180.153 + 45.0 * k as f64 + 15.0 * plane as f64).to_radians());
                assert!((slot(orbit) - expected).abs() < 1e-6, "{plane} {k}");
            }
        }
        for (k, orbit) in beidou.iter().enumerate() {
            let height_km = (orbit.root_of_axis * orbit.root_of_axis - SEMI_MAJOR_AXIS_M) / 1e3;
            assert!((height_km - 21_528.0).abs() < 0.01, "{k}: {height_km}");
            let expected = degrees((45.0 * (k % 8) as f64 + 15.0 * (k / 8) as f64).to_radians());
            assert!((slot(orbit) - expected).abs() < 1e-6, "{k}");
        }
    }

    #[test]
    fn val_nominal_satellites_are_where_gnss_lib_py_sees_them() {
        // find_sv_states and ecef_to_el_az of the Python package gnss_lib_py 1.1.0 with the file nominal.alm, at the place of the job
        // two-bridges on 2018-11-20 at 15:08:00 UTC: elevation and azimuth of some satellites, deg. (The package takes all week
        // numbers modulo 1024, so that dates after the rollover of 2019 would be wrong for the orbits of 2016.)
        const TOLERANCE_DEG: f64 = 1e-4;
        const EXPECTED: [(u16, f64, f64); 6] = [
            (5, 28.532_327, 175.854_063),
            (11, 54.173_984, 301.554_976),
            (307, 55.100_982, 138.256_125),
            (324, 80.936_592, 344.635_366),
            (412, 37.421_661, 305.028_829),
            (420, 31.214_466, 49.845_053),
        ];
        let place = Geo { latitude_deg: 46.7052, longitude_deg: 8.3814, altitude_m: 430.0 };
        let almanac = Almanac::nominal();
        let sky = almanac.directions(&LocalPlane::new(place), GpsTime::from_unix_s(1_542_726_480.0));
        for (id, elevation_deg, azimuth_deg) in EXPECTED {
            let index = almanac.orbits.iter().position(|orbit| orbit.id == id).expect("in the almanac");
            let direction = sky[index];
            let found = (math::asin(direction.up()).to_degrees(), math::atan2(direction.east(), direction.north()).to_degrees());
            assert!((found.0 - elevation_deg).abs() < TOLERANCE_DEG, "{id}: {found:?}");
            assert!((found.1.rem_euclid(360.0) - azimuth_deg).abs() < TOLERANCE_DEG, "{id}: {found:?}");
        }
        assert_eq!(sky.iter().filter(|direction| direction.up() > math::sin(10f64.to_radians())).count(), 20);
    }

    #[test]
    fn prop_a_third_of_the_satellites_is_above_ten_degrees_everywhere() {
        // From a satellite's height of 20,200 to 23,200 km, a mask of 10 degrees leaves 0.31 to 0.34 of the sphere of orbits.
        // Constellations are denser at some latitudes.
        let almanac = Almanac::nominal();
        let mut sums = Vec::new();
        for latitude_deg in [-33.0, 0.0, 46.7, 60.0] {
            let plane = LocalPlane::new(Geo { latitude_deg, longitude_deg: 8.4, altitude_m: 0.0 });
            let visible = |hour: u32| {
                let sky = almanac.directions(&plane, GpsTime::from_unix_s(1_795_000_000.0 + 3_600.0 * f64::from(hour)));
                sky.iter().filter(|direction| direction.up() > math::sin(10f64.to_radians())).count()
            };
            let counts: Vec<usize> = (0..240).map(visible).collect();
            assert!(counts.iter().all(|count| (15..=36).contains(count)), "{latitude_deg}: {counts:?}");
            sums.push(counts.iter().sum::<usize>() as f64 / 240.0 / 72.0);
        }
        assert!(sums.iter().all(|share| (0.28..0.42).contains(share)), "{sums:?}");
    }
}
