//! Terrain heights for ground stations that check the vehicle's terrain data.

use super::VehicleLink;
use super::inbound::InboundMessage;
use spandrel_mavlink::dialect::{MavMessage, TERRAIN_CHECK_DATA, TERRAIN_REPORT_DATA};
use spandrel_mavlink::units;

/// Answers a terrain check with the height of the site's ground, for flavors with a terrain database. Outside of the site, the
/// height is unavailable, which the report expresses as a spacing of 0.
pub(super) fn check(v: &mut VehicleLink, request: &TERRAIN_CHECK_DATA, a: &mut InboundMessage) {
    if !v.flavor.terrain {
        return;
    }
    let mut report = TERRAIN_REPORT_DATA { lat: request.lat, lon: request.lon, ..Default::default() };
    let origin = a.aircraft.plane.origin();
    let place = units::geo(request.lat, request.lon, origin.altitude_m).map(|geo| a.aircraft.plane.enu_from_geo(geo));
    let ground = place.and_then(|place| a.aircraft.site.terrain_up_m(place.east(), place.north()));
    if let Some(up_m) = ground {
        report.spacing = a.aircraft.site.terrain_spacing_m().round().clamp(1.0, f64::from(u16::MAX)) as u16;
        report.terrain_height = (origin.altitude_m + up_m) as f32;
        let estimate = a.autopilot.estimate();
        report.current_height = if estimate.attitude_valid { (-estimate.position_m.down() - up_m) as f32 } else { 0.0 };
        report.loaded = 1;
    }
    a.answer(&MavMessage::TERRAIN_REPORT(report));
}
