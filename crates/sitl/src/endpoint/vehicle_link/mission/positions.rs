//! Positions of plan items: frames, altitudes, validity.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavFrame, MavMissionResult};
use spandrel_mavlink::units;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// Maximum altitude, m.
pub(super) const MAX_ALTITUDE_M: f32 = 10_000.0;

/// Checks whether a frame's altitude is relative to home. Returns `None` for frames without a global position and for
/// terrain-relative altitudes, because the vehicle has no terrain map, and bridge decks and water are not terrain.
pub(super) fn relative(frame: MavFrame) -> Option<bool> {
    match frame {
        MavFrame::MAV_FRAME_GLOBAL | MavFrame::MAV_FRAME_GLOBAL_INT => Some(false),
        MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT | MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT => Some(true),
        _ => None,
    }
}

/// Returns an item's position in meters; `None` if it is not usable.
pub(super) fn place(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, home_up_m: f64) -> Option<Vec3<Ned>> {
    let relative = relative(item.frame)?;
    let altitude = f64::from(item.z);
    let origin = plane.origin();
    let amsl = if relative { origin.altitude_m + home_up_m + altitude } else { altitude };
    let enu = plane.enu_from_geo(units::geo(item.x, item.y, amsl)?);
    (enu.is_finite() && enu.norm() < 50_000.0).then(|| enu.ned())
}

/// Checks whether an item has no position, which means the vehicle's position at that time.
pub(super) fn has_no_position(item: &MISSION_ITEM_INT_DATA) -> bool {
    (item.x, item.y) == (0, 0) || item.x == i32::MAX || item.y == i32::MAX
}

/// Checks for a supported frame, a valid altitude and a position within range.
pub(super) fn flyable_position(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> Result<(), MavMissionResult> {
    if relative(item.frame).is_none() {
        return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME);
    }
    if !(-MAX_ALTITUDE_M..=MAX_ALTITUDE_M).contains(&item.z) {
        return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM7);
    }
    let (lat, lon) = (f64::from(item.x) * 1e-7, f64::from(item.y) * 1e-7);
    if lat.abs() > 90.0 {
        return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM5_X);
    }
    if lon.abs() > 180.0 || place(item, plane, 0.0).is_none() {
        return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM6_Y);
    }
    Ok(())
}
