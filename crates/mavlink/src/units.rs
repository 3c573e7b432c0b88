//! The door between SI inside and MAVLink's units outside. Values that do not fit saturate; NaN becomes the field's "unknown".

use spandrel_model::geodesy::Geo;

/// Degrees to 1e-7 degrees.
#[must_use]
pub fn deg_e7(deg: f64) -> i32 {
    (deg * 1e7).round() as i32
}

/// Metres to millimetres.
#[must_use]
pub fn mm(metres: f64) -> i32 {
    (metres * 1000.0).round() as i32
}

/// Metres per second to centimetres per second, also metres to centimetres.
#[must_use]
pub fn cm(metres: f64) -> i16 {
    (metres * 100.0).round() as i16
}

/// Metres to unsigned centimetres; infinite stays at the largest value.
#[must_use]
pub fn cm_u16(metres: f64) -> u16 {
    (metres * 100.0).round() as u16
}

/// Radians to centidegrees in 0..36000.
#[must_use]
pub fn heading_cdeg(rad: f64) -> u16 {
    ((rad.to_degrees().rem_euclid(360.0) * 100.0).round() as u32 % 36_000) as u16
}

/// m/s² to milli-g.
#[must_use]
pub fn milli_g(m_s2: f64) -> i16 {
    (m_s2 / spandrel_model::math::GRAVITY_M_S2 * 1000.0).round() as i16
}

/// 1e-7 degrees and metres to a geographic position; `None` outside the globe.
#[must_use]
pub fn geo(lat_e7: i32, lon_e7: i32, altitude_m: f64) -> Option<Geo> {
    let (latitude_deg, longitude_deg) = (f64::from(lat_e7) * 1e-7, f64::from(lon_e7) * 1e-7);
    let legal = latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0 && altitude_m.abs() < 1e5;
    legal.then_some(Geo { latitude_deg, longitude_deg, altitude_m })
}
