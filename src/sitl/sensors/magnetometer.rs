//! Magnetometer in the earth's dipole field. No iron of the structure or the aircraft bends it.

use crate::base::frames::{Frd, Ned, Vec3};
use crate::base::geodesy::Geo;
use crate::base::math;
use crate::base::random::RandomStream;
use crate::base::time::{Schedule, SimTime};
use crate::sitl::physics::RigidState;
use crate::vehicle;

/// First-degree coefficients g10, g11, h11 of IGRF-13 for 2020, gauss.
const DIPOLE_GAUSS: [f64; 3] = [-0.294_048, -0.014_509, 0.046_525];

/// The earth's magnetic field at a place: the tilted centred dipole, gauss. Good to some degrees of direction.
#[must_use]
pub fn earth_field_gauss(place: Geo) -> Vec3<Ned> {
    let [g10, g11, h11] = DIPOLE_GAUSS;
    let (sin_lat, cos_lat) = math::sin_cos(place.latitude_deg.to_radians());
    let (sin_lon, cos_lon) = math::sin_cos(place.longitude_deg.to_radians());
    let equatorial = g11 * cos_lon + h11 * sin_lon;
    let north = -(g10 * cos_lat - equatorial * sin_lat);
    let east = g11 * sin_lon - h11 * cos_lon;
    let down = -2.0 * (g10 * sin_lat + equatorial * cos_lat);
    Vec3::new(north, east, down)
}

/// State of the magnetometer.
#[derive(Debug, Clone, PartialEq)]
pub struct Magnetometer {
    stream: RandomStream,
    due: Schedule,
    noise_gauss: f64,
    field_gauss: Vec3<Ned>,
}

impl Magnetometer {
    /// At a site whose origin lies at `origin`.
    #[must_use]
    pub fn new(sensors: &vehicle::Sensors, origin: Geo, seed: u64) -> Self {
        Self {
            stream: RandomStream::new(seed, "magnetometer"),
            due: Schedule::new(SimTime::ZERO, sensors.mag_rate_hz),
            noise_gauss: sensors.mag_noise_gauss,
            field_gauss: earth_field_gauss(origin),
        }
    }

    /// The field in the body's axes, gauss, when due.
    pub fn read(&mut self, rigid: &RigidState, now: SimTime) -> Option<Vec3<Frd>> {
        if !self.due.fire(now) {
            return None;
        }
        let [x, y, z] = self.stream.normal3();
        Some(rigid.attitude.inverse() * self.field_gauss + Vec3::new(x, y, z) * self.noise_gauss)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_the_field_dips_downward_in_the_north_and_is_horizontal_near_the_magnetic_equator() {
        let alps = earth_field_gauss(Geo { latitude_deg: 46.5, longitude_deg: 8.0, altitude_m: 0.0 });
        // World Magnetic Model 2020 there: 0.47 G in all, dip 62 degrees; the dipole alone is within 0.06 G and 6 degrees.
        let dip = math::atan2(alps.down(), alps.horizontal_norm()).to_degrees();
        assert!((alps.norm() - 0.47).abs() < 0.06 && (dip - 62.0).abs() < 6.0, "{alps:?} {dip}");
    }
}
