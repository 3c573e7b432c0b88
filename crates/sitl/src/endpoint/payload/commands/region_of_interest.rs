//! Positions in region-of-interest commands.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::super::input::PayloadInput;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::MavCmd;
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::geodesy::Geo;

/// Returns the position that a command tells the vehicle to face: `None` for other commands or an unusable position,
/// `Some(None)` if the command clears the target.
pub(crate) fn target(c: &VehicleCommand, input: &PayloadInput) -> Option<Option<Vec3<Ned>>> {
    match c.number {
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_NONE as u16 => Some(None),
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_LOCATION as u16 || n == MavCmd::MAV_CMD_DO_SET_ROI as u16 => {
            if c.clears_region_of_interest() { Some(None) } else { Some(Some(position(c, input, c.finite_param(6)?)?.ned())) }
        }
        _ => None,
    }
}

/// Returns the position in parameters 5 and 6. The altitude is in the command's frame, or above mean sea level for
/// flavors that ignore the frame.
pub(super) fn position(c: &VehicleCommand, input: &PayloadInput, altitude_m: f64) -> Option<Vec3<Enu>> {
    let (latitude_deg, longitude_deg) = (c.finite_param(4)?, c.finite_param(5)?);
    if latitude_deg.abs() > 90.0 || longitude_deg.abs() > 180.0 || altitude_m.abs() > 1e5 {
        return None;
    }
    let origin = input.plane.origin();
    let relative = c.is_home_relative() == Some(true) && (c.own || !input.roi_above_sea_level);
    let altitude_m = if relative { origin.altitude_m + input.home_height_m() + altitude_m } else { altitude_m };
    Some(input.plane.enu_from_geo(Geo { latitude_deg, longitude_deg, altitude_m }))
}
