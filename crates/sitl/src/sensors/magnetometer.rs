//! Magnetometer in the Earth's dipole field, with the bias that remains after calibration. Steel members near it distort the
//! field if the job says so.

use crate::physics::RigidState;
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::geodesy::Geo;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::site::steel::SteelField;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle;
use std::sync::Arc;

/// First-degree IGRF-13 coefficients g10, g11, h11 for 2020, gauss.
const DIPOLE_COEFFICIENTS_GAUSS: [f64; 3] = [-0.294_048, -0.014_509, 0.046_525];

/// Returns the Earth's magnetic field, in gauss, modeled as a tilted centered dipole. Its direction is accurate to a
/// few degrees.
#[must_use]
pub fn earth_field_gauss(place: Geo) -> Vec3<Ned> {
    let [g10, g11, h11] = DIPOLE_COEFFICIENTS_GAUSS;
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
    bias_gauss: Vec3<Frd>,
    field_gauss: Vec3<Ned>,
    steel: Option<Arc<SteelField>>,
}

impl Magnetometer {
    /// Creates the sensor for a site with this origin, and with steel that distorts the field, if there is any.
    #[must_use]
    pub fn new(sensors: &vehicle::SensorSpec, origin: Geo, steel: Option<Arc<SteelField>>, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "magnetometer");
        let [x, y, z] = stream.normal3();
        Self {
            stream,
            due: Schedule::new(SimTime::ZERO, sensors.mag_rate_hz),
            noise_gauss: sensors.mag_noise_gauss,
            bias_gauss: Vec3::new(x, y, z) * sensors.mag_bias_gauss,
            field_gauss: earth_field_gauss(origin),
            steel,
        }
    }

    /// Returns the true field at a position, in gauss.
    #[must_use]
    pub fn field_gauss(&self, position_m: Vec3<Ned>) -> Vec3<Ned> {
        let field = self.field_gauss;
        self.steel.as_ref().map_or(field, |steel| field + steel.distortion(position_m.enu(), field.enu()).ned())
    }

    /// Returns by how much the field's horizontal direction at a position differs from the undisturbed one, rad, clockwise positive.
    #[must_use]
    pub fn direction_error_rad(&self, position_m: Vec3<Ned>) -> f64 {
        let direction_rad = |field: Vec3<Ned>| math::atan2(field.east(), field.north());
        math::wrap_pi(direction_rad(self.field_gauss(position_m)) - direction_rad(self.field_gauss))
    }

    /// Returns the field in body axes, in gauss, if a sample is due.
    pub fn read(&mut self, rigid: &RigidState, now: SimTime) -> Option<Vec3<Frd>> {
        if !self.due.fire(now) {
            return None;
        }
        let [x, y, z] = self.stream.normal3();
        let field = self.field_gauss(rigid.position_m);
        Some(rigid.attitude.inverse() * field + self.bias_gauss + Vec3::new(x, y, z) * self.noise_gauss)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::tests::{error_free_sensors, still};
    use spandrel_model::shipped;

    #[test]
    fn exact_bias_rotates_with_body_and_has_specified_spread() {
        let spec = vehicle::SensorSpec { mag_bias_gauss: 0.01, ..error_free_sensors() };
        let place = Geo { latitude_deg: 46.5, longitude_deg: 8.0, altitude_m: 0.0 };
        let mut squares = 0.0;
        for seed in 0..400 {
            let mut sensor = Magnetometer::new(&spec, place, None, seed);
            let mut rigid = still();
            let field = earth_field_gauss(place);
            let first = sensor.read(&rigid, SimTime::ZERO).expect("due") - rigid.attitude.inverse() * field;
            rigid.attitude = spandrel_model::frames::Rotation::from_euler(0.3, -0.2, 2.0);
            let later = sensor.read(&rigid, SimTime::from_ms(20)).expect("due") - rigid.attitude.inverse() * field;
            assert!((first - later).norm() < 1e-12, "{first:?} {later:?}");
            squares += first.norm_squared() / 1200.0;
        }
        // With 1,200 samples, three standard errors of the standard deviation are 6%.
        assert!((squares.sqrt() / 0.01 - 1.0).abs() < 0.06, "{}", squares.sqrt());
    }

    #[test]
    fn prop_steel_turns_the_compass_only_near_it_and_only_if_the_job_says_so() {
        // A trainee 1 m beside a steel member must see the compass turn, and at 30 m not.
        const NEAR_DEG: f64 = 2.0;
        const FAR_DEG: f64 = 0.2;
        let text = shipped::without_hazards(shipped::TWO_BRIDGES);
        let turn_deg = |hazards: &str, clearance_m: f64| {
            let text = format!("{text}\n[hazards]\n{hazards}\n");
            let job = spandrel_model::scenario::read("job.toml", &text, &|file| Err(format!("no {file}"))).unwrap();
            let members: Vec<_> = job.bridges.iter().flat_map(spandrel_model::scenario::Bridge::members).collect();
            let steel = crate::sensors::SensorSite::of(&job, &members).steel;
            let sensor = Magnetometer::new(&error_free_sensors(), job.origin, steel, 1);
            let suspension = &job.bridges[1];
            let side_m = 0.5 * suspension.deck_width_m() + clearance_m;
            let position = suspension.placement().point([10.0, side_m, -0.5]);
            let field = sensor.field_gauss(position.ned());
            let undisturbed = earth_field_gauss(job.origin);
            let heading = |field: Vec3<Ned>| math::atan2(field.east(), field.north());
            math::wrap_pi(heading(field) - heading(undisturbed)).abs().to_degrees()
        };
        assert!(turn_deg("compass = true", 1.0) > NEAR_DEG, "{}", turn_deg("compass = true", 1.0));
        assert!(turn_deg("compass = true", 30.0) < FAR_DEG, "{}", turn_deg("compass = true", 30.0));
        assert_eq!(turn_deg("compass = false", 1.0), 0.0);
        assert_eq!(turn_deg("", 1.0), 0.0);
    }

    #[test]
    fn val_field_inclination_matches_magnetic_model() {
        let alps = earth_field_gauss(Geo { latitude_deg: 46.5, longitude_deg: 8.0, altitude_m: 0.0 });
        // World Magnetic Model 2020 at this location: 0.47 G total, dip 62 degrees. The dipole is within 0.06 G and 6
        // degrees of that.
        let dip = math::atan2(alps.down(), alps.horizontal_norm()).to_degrees();
        assert!((alps.norm() - 0.47).abs() < 0.06 && (dip - 62.0).abs() < 6.0, "{alps:?} {dip}");
    }
}
