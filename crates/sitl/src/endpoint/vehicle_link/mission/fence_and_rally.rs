//! Converts a plan's geofence and rally points for the autopilot.

use super::positions::{flyable_position, place, relative};
use crate::autopilot::fence::{FenceOutline, FenceZone};
use crate::autopilot::home::RallyPoint;
use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavCmd, MavMissionResult, MavMissionType};
use spandrel_model::geodesy::LocalPlane;

/// Allowed number of polygon vertices.
const VERTEX_COUNTS: std::ops::RangeInclusive<f32> = 3.0..=70.0;
/// Allowed circle radii, m.
const CIRCLE_RADII_M: std::ops::RangeInclusive<f32> = 1.0..=100_000.0;

/// Checks a geofence or rally item. Returns an error that names the invalid parameter.
pub(super) fn check_area(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> Result<(), MavMissionResult> {
    let rally = item.mission_type == MavMissionType::MAV_MISSION_TYPE_RALLY;
    let first = match item.command {
        MavCmd::MAV_CMD_NAV_RALLY_POINT if rally => true,
        _ if rally => return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED),
        MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION | MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION => {
            VERTEX_COUNTS.contains(&item.param1) && item.param1.fract() == 0.0
        }
        MavCmd::MAV_CMD_NAV_FENCE_RETURN_POINT => true,
        MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION | MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION => {
            CIRCLE_RADII_M.contains(&item.param1)
        }
        _ => return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED),
    };
    if !first {
        return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM1);
    }
    flyable_position(item, plane)
}

/// Checks that a fence is complete: every polygon has as many consecutive vertices as its items specify.
pub(super) fn is_complete(items: &[MISSION_ITEM_INT_DATA]) -> Result<(), MavMissionResult> {
    let mut at = 0;
    while let Some(item) = items.get(at) {
        let corners = corners(item);
        let run = items.iter().skip(at).take(corners);
        let alike = run.filter(|other| other.command == item.command && other.param1 == item.param1).count();
        // Other items are complete on their own; their first parameter does not have to be finite.
        if corners > 1 && alike < corners {
            return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM1);
        }
        at += corners;
    }
    Ok(())
}

/// Checks for a fence return point. It is stored with the fence but not used: the vehicle returns to home or a rally
/// point.
pub(super) fn is_return(item: &MISSION_ITEM_INT_DATA) -> bool {
    item.command == MavCmd::MAV_CMD_NAV_FENCE_RETURN_POINT
}

/// Returns the number of items in the area that starts with this one.
fn corners(item: &MISSION_ITEM_INT_DATA) -> usize {
    match item.command {
        MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION | MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION => {
            (item.param1 as usize).max(1)
        }
        _ => 1,
    }
}

/// Returns the areas in a valid, complete fence.
pub(super) fn zones(items: &[MISSION_ITEM_INT_DATA], plane: &LocalPlane) -> Vec<FenceZone> {
    let flat = |item: &MISSION_ITEM_INT_DATA| place(item, plane, 0.0).map_or((0.0, 0.0), |p| (p.north(), p.east()));
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(item) = items.get(at) {
        let corners = corners(item);
        if is_return(item) {
            at += corners;
            continue;
        }
        let inclusion = matches!(
            item.command,
            MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION | MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION
        );
        let outline = if corners > 1 {
            FenceOutline::Polygon(items.iter().skip(at).take(corners).map(flat).collect())
        } else {
            FenceOutline::Circle { center_m: flat(item), radius_m: f64::from(item.param1) }
        };
        out.push(FenceZone { outline, inclusion });
        at += corners;
    }
    out
}

/// Returns the rally points.
pub(super) fn rally_points(items: &[MISSION_ITEM_INT_DATA], plane: &LocalPlane, home_up_m: f64) -> Vec<RallyPoint> {
    let refuge = |item: &MISSION_ITEM_INT_DATA| {
        Some(RallyPoint { position_m: place(item, plane, home_up_m)?, home_relative: relative(item.frame) == Some(true) })
    };
    items.iter().filter_map(refuge).collect()
}
