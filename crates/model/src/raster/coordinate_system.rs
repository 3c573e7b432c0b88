//! Coordinate systems of maps: converts geographic positions to the coordinates of a raster's system.

use crate::geodesy::Geo;
use proj4rs::Proj;
use proj4rs::transform::transform;

/// WGS84 latitudes and longitudes, in the notation of PROJ.
const GEOGRAPHIC: &str = "+proj=longlat +datum=WGS84 +no_defs";

/// A coordinate system with an EPSG code.
pub(super) struct CoordinateSystem {
    code: u16,
    geographic: Proj,
    system: Proj,
}

impl CoordinateSystem {
    /// Finds the coordinate system with a code.
    ///
    /// # Errors
    /// Returns a message if the code is unknown, or if positions cannot be converted to this system.
    pub(super) fn from_epsg(code: u16) -> Result<Self, String> {
        let unknown = |error: &dyn std::fmt::Display| format!("coordinate system EPSG:{code}: {error}");
        let system = Proj::from_epsg_code(code).map_err(|error| unknown(&error))?;
        if !(system.is_latlong() || system.has_forward()) {
            return Err(unknown(&"positions cannot be converted to it"));
        }
        let geographic = Proj::from_proj_string(GEOGRAPHIC).map_err(|error| unknown(&error))?;
        Ok(Self { code, geographic, system })
    }

    /// Returns the coordinates of a position: east and north in the units of the system, or longitude and latitude in degrees.
    ///
    /// # Errors
    /// Returns a message if the system does not contain the position.
    pub(super) fn coordinates(&self, geo: Geo) -> Result<[f64; 2], String> {
        let mut place = (geo.longitude_deg.to_radians(), geo.latitude_deg.to_radians(), 0.0);
        transform(&self.geographic, &self.system, &mut place).map_err(|error| {
            let Geo { latitude_deg, longitude_deg, .. } = geo;
            format!("{latitude_deg:.5}, {longitude_deg:.5} in EPSG:{}: {error}", self.code)
        })?;
        let (x, y, _) = place;
        Ok(if self.system.is_latlong() { [x.to_degrees(), y.to_degrees()] } else { [x, y] })
    }
}
