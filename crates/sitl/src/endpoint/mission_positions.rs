//! Where items of plans are: frames, heights, and what cannot be a place.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavFrame, MavMissionResult};
use spandrel_mavlink::units;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// Heights beyond this are mistakes, m.
pub(super) const HIGHEST_M: f32 = 10_000.0;

/// Whether a frame counts heights from home; `None` for a frame that is no place over the ground, and for heights over the terrain: the
/// vehicle has no map of it, and deck and water are none.
pub(super) fn relative(frame: MavFrame) -> Option<bool> {
    match frame {
        MavFrame::MAV_FRAME_GLOBAL | MavFrame::MAV_FRAME_GLOBAL_INT => Some(false),
        MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT | MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT => Some(true),
        _ => None,
    }
}

/// Where an item is, m; `None` without a usable place.
pub(super) fn place(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, home_up_m: f64) -> Option<Vec3<Ned>> {
    let relative = relative(item.frame)?;
    let altitude = f64::from(item.z);
    let origin = plane.origin();
    let amsl = if relative { origin.altitude_m + home_up_m + altitude } else { altitude };
    let enu = plane.enu_from_geo(units::geo(item.x, item.y, amsl)?);
    (enu.is_finite() && enu.norm() < 50_000.0).then(|| enu.ned())
}

/// No place given: where the vehicle is then.
pub(super) fn without_position(item: &MISSION_ITEM_INT_DATA) -> bool {
    (item.x, item.y) == (0, 0) || item.x == i32::MAX || item.y == i32::MAX
}

/// A place in a known frame, at a height, not on another continent.
pub(super) fn flyable_position(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> Result<(), MavMissionResult> {
    if relative(item.frame).is_none() {
        return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME);
    }
    if !(-HIGHEST_M..=HIGHEST_M).contains(&item.z) {
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
