//! Conversions between SI units and MAVLink units. Values out of range saturate; NaN becomes 0.

use spandrel_model::geodesy::Geo;

/// Converts degrees to 1e-7 degrees.
#[must_use]
pub fn deg_e7(deg: f64) -> i32 {
    (deg * 1e7).round() as i32
}

/// Converts meters to millimeters.
#[must_use]
pub fn mm(meters: f64) -> i32 {
    (meters * 1000.0).round() as i32
}

/// Converts meters to centimeters, or meters per second to centimeters per second.
#[must_use]
pub fn cm(meters: f64) -> i16 {
    (meters * 100.0).round() as i16
}

/// Converts meters to unsigned centimeters. Infinity becomes the maximum.
#[must_use]
pub fn cm_u16(meters: f64) -> u16 {
    (meters * 100.0).round() as u16
}

/// Converts a heading in radians to centidegrees, 0 to 35999.
#[must_use]
pub fn heading_cdeg(rad: f64) -> u16 {
    ((rad.to_degrees().rem_euclid(360.0) * 100.0).round() as u32 % 36_000) as u16
}

/// Converts m/s² to milli-g.
#[must_use]
pub fn milli_g(m_s2: f64) -> i16 {
    (m_s2 / spandrel_model::math::GRAVITY_M_S2 * 1000.0).round() as i16
}

/// Converts latitude and longitude in 1e-7 degrees and an altitude in meters to a geographic position; `None` if they are out of
/// range.
#[must_use]
pub fn geo(lat_e7: i32, lon_e7: i32, altitude_m: f64) -> Option<Geo> {
    let (latitude_deg, longitude_deg) = (f64::from(lat_e7) * 1e-7, f64::from(lon_e7) * 1e-7);
    let legal = latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0 && altitude_m.abs() < 1e5;
    legal.then_some(Geo { latitude_deg, longitude_deg, altitude_m })
}
