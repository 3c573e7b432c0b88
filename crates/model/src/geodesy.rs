//! Conversion between WGS84 and the local tangent plane at the scenario origin. Local coordinates (east, north, up) are
//! exact: they are computed through earth-centered coordinates, without a flat-earth approximation.

use super::frames::{Enu, Vec3};
use super::math;

/// WGS84 semi-major axis, m (NIMA TR8350.2).
pub const SEMI_MAJOR_AXIS_M: f64 = 6_378_137.0;
/// WGS84 flattening (NIMA TR8350.2).
pub const FLATTENING: f64 = 1.0 / 298.257_223_563;
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);

/// A geographic position: degrees, and meters above the ellipsoid. The simulator treats the ellipsoid as mean sea level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geo {
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Longitude, degrees east.
    pub longitude_deg: f64,
    /// Altitude above the ellipsoid, m.
    pub altitude_m: f64,
}

/// The local tangent plane at an origin, with conversions in both directions.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalPlane {
    origin: Geo,
    origin_ecef_m: [f64; 3],
    sin_cos_lat: (f64, f64),
    sin_cos_lon: (f64, f64),
}

impl LocalPlane {
    /// Creates the plane through `origin` that is perpendicular to the ellipsoid's normal there.
    #[must_use]
    pub fn new(origin: Geo) -> Self {
        Self {
            origin,
            origin_ecef_m: ecef_from_geo(origin),
            sin_cos_lat: math::sin_cos(origin.latitude_deg.to_radians()),
            sin_cos_lon: math::sin_cos(origin.longitude_deg.to_radians()),
        }
    }

    /// Returns the origin of the plane.
    #[must_use]
    pub fn origin(&self) -> Geo {
        self.origin
    }

    /// Converts a geographic position to local coordinates in meters.
    #[must_use]
    pub fn enu_from_geo(&self, geo: Geo) -> Vec3<Enu> {
        self.enu_from_ecef(ecef_from_geo(geo))
    }

    /// Converts earth-centered, earth-fixed coordinates in meters to local coordinates in meters.
    #[must_use]
    pub fn enu_from_ecef(&self, p: [f64; 3]) -> Vec3<Enu> {
        let d = [p[0] - self.origin_ecef_m[0], p[1] - self.origin_ecef_m[1], p[2] - self.origin_ecef_m[2]];
        let (sl, cl) = self.sin_cos_lat;
        let (so, co) = self.sin_cos_lon;
        Vec3::new(
            -so * d[0] + co * d[1],
            -sl * co * d[0] - sl * so * d[1] + cl * d[2],
            cl * co * d[0] + cl * so * d[1] + sl * d[2],
        )
    }

    /// Converts local coordinates, m, to a geographic position.
    #[must_use]
    pub fn geo_from_enu(&self, enu_m: Vec3<Enu>) -> Geo {
        let (sl, cl) = self.sin_cos_lat;
        let (so, co) = self.sin_cos_lon;
        let [e, n, u] = enu_m.array();
        geo_from_ecef([
            self.origin_ecef_m[0] - so * e - sl * co * n + cl * co * u,
            self.origin_ecef_m[1] + co * e - sl * so * n + cl * so * u,
            self.origin_ecef_m[2] + cl * n + sl * u,
        ])
    }
}

fn ecef_from_geo(geo: Geo) -> [f64; 3] {
    let (sl, cl) = math::sin_cos(geo.latitude_deg.to_radians());
    let (so, co) = math::sin_cos(geo.longitude_deg.to_radians());
    let n = SEMI_MAJOR_AXIS_M / (1.0 - ECCENTRICITY_SQUARED * sl * sl).sqrt();
    let h = geo.altitude_m;
    [(n + h) * cl * co, (n + h) * cl * so, (n * (1.0 - ECCENTRICITY_SQUARED) + h) * sl]
}

/// Converts earth-centered coordinates with Bowring's iteration. The error is below a nanometer after three iterations
/// for heights within 10 km of the ellipsoid.
fn geo_from_ecef(p: [f64; 3]) -> Geo {
    let r = math::hypot(p[0], p[1]);
    let mut lat = math::atan2(p[2], r * (1.0 - ECCENTRICITY_SQUARED));
    let mut n = SEMI_MAJOR_AXIS_M;
    for _ in 0..4 {
        let s = math::sin(lat);
        n = SEMI_MAJOR_AXIS_M / (1.0 - ECCENTRICITY_SQUARED * s * s).sqrt();
        lat = math::atan2(p[2] + ECCENTRICITY_SQUARED * n * s, r);
    }
    let (s, c) = math::sin_cos(lat);
    // Also valid at the poles, unlike r / cos(lat) - n.
    let altitude_m = r * c + p[2] * s - n * (1.0 - ECCENTRICITY_SQUARED * s * s);
    Geo { latitude_deg: lat.to_degrees(), longitude_deg: math::atan2(p[1], p[0]).to_degrees(), altitude_m }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ORIGIN: Geo = Geo { latitude_deg: 46.5, longitude_deg: 8.25, altitude_m: 430.0 };
    /// Tolerance for rounding errors of earth-centered coordinates in f64, m.
    const ROUND_TRIP_TOLERANCE_M: f64 = 1e-8;

    #[test]
    fn exact_local_positions_round_trip() {
        let plane = LocalPlane::new(ORIGIN);
        let p = Vec3::new(812.5, -433.25, 61.0);
        assert!((plane.enu_from_geo(plane.geo_from_enu(p)) - p).norm() < ROUND_TRIP_TOLERANCE_M);
    }

    #[test]
    fn val_one_minute_of_latitude_at_45_degrees_is_1852_2_m() {
        // 1852.2 m follows from the WGS84 meridian radius at 45 deg (6 367 382 m); the original definition of the
        // nautical mile. Tolerance 0.1 m.
        let plane = LocalPlane::new(Geo { latitude_deg: 45.0, longitude_deg: 0.0, altitude_m: 0.0 });
        let north = plane.enu_from_geo(Geo { latitude_deg: 45.0 + 1.0 / 60.0, longitude_deg: 0.0, altitude_m: 0.0 }).north();
        assert!((north - 1852.2).abs() < 0.1, "{north}");
    }
}
