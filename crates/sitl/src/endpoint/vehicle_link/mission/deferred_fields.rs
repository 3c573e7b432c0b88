//! Mission items without a position or altitude: ArduPilot encodes these as 0 and uses the vehicle's values when the
//! item starts.

use crate::autopilot::MissionStep;
use crate::autopilot::mission::DeferredFields;
use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavCmd};
use spandrel_mavlink::units::deg_e7;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// Value of NAV_DELAY's first parameter if hour, minute and second are used; ArduPilot sends 0 instead.
const TIME_OF_DAY_DELAY: f32 = -1.0;
const FULL_TURN_DEG: f32 = 360.0;

/// Returns the fields that an item leaves open.
pub(super) fn of(item: &MISSION_ITEM_INT_DATA) -> DeferredFields {
    let flown = matches!(
        item.command,
        MavCmd::MAV_CMD_NAV_WAYPOINT
            | MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT
            | MavCmd::MAV_CMD_NAV_LOITER_TIME
            | MavCmd::MAV_CMD_NAV_LOITER_UNLIM
            | MavCmd::MAV_CMD_NAV_LOITER_TURNS
            | MavCmd::MAV_CMD_NAV_LOITER_TO_ALT
    );
    // For LOITER_TO_ALT the altitude is the target, so it is never open.
    let height = flown && item.z == 0.0 && item.command != MavCmd::MAV_CMD_NAV_LOITER_TO_ALT;
    DeferredFields { place: flown && (item.x, item.y) == (0, 0), height }
}

/// Returns the item with a placeholder for the open position, so that its other fields can be checked.
pub(super) fn with_placeholder(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> MISSION_ITEM_INT_DATA {
    let mut item = item.clone();
    if of(&item).place {
        let origin = plane.origin();
        (item.x, item.y) = (deg_e7(origin.latitude_deg), deg_e7(origin.longitude_deg));
    }
    // Copter ignores the heading of waypoints; Mission Planner writes 0.
    if item.command == MavCmd::MAV_CMD_NAV_WAYPOINT {
        item.param4 = f32::NAN;
    }
    let timed = [item.param2, item.param3, item.param4].iter().any(|part| *part != 0.0);
    if item.command == MavCmd::MAV_CMD_NAV_DELAY && item.param1 == 0.0 && timed {
        item.param1 = TIME_OF_DAY_DELAY;
    }
    // Angles above one turn are reduced to the remainder.
    if item.command == MavCmd::MAV_CMD_CONDITION_YAW && item.param1.is_finite() {
        item.param1 %= FULL_TURN_DEG;
    }
    let nowhere = (item.x, item.y) == (0, 0) && item.z == 0.0;
    if item.command == MavCmd::MAV_CMD_DO_SET_HOME && nowhere {
        item.param1 = 1.0;
    }
    item
}

/// Fills open fields with the previous step's position, which is where the vehicle will be when the step starts.
pub(super) fn fill_from_previous_steps(steps: &mut [MissionStep], open: &[DeferredFields], home_m: Option<Vec3<Ned>>) {
    let mut before = home_m;
    for (step, open) in steps.iter_mut().zip(open) {
        if let (MissionStep::Takeoff { up_m: Some(up_m) }, Some(over)) = (&step, before) {
            before = Some(Vec3::new(over.north(), over.east(), -up_m));
        }
        let Some(place_m) = step.position_mut() else { continue };
        if let Some(before) = before {
            *place_m = open.resolve_deferred(*place_m, before);
        }
        before = Some(*place_m);
    }
}
