//! Items of missions that leave their place or height open: ArduPilot writes it as 0 and takes what the vehicle has when the item begins.

use crate::autopilot::MissionStep;
use crate::autopilot::mission::DeferredFields;
use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavCmd};
use spandrel_mavlink::units::deg_e7;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;

/// NAV_DELAY's first parameter where hour, minute and second count: no seconds to ArduPilot.
const BY_TIME_OF_DAY: f32 = -1.0;
const TURN_DEG: f32 = 360.0;

/// What an item leaves open.
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
    // A height to loiter to is what its item is for.
    let height = flown && item.z == 0.0 && item.command != MavCmd::MAV_CMD_NAV_LOITER_TO_ALT;
    DeferredFields { place: flown && (item.x, item.y) == (0, 0), height }
}

/// The item with a place in the open one's stead: what else it says can be judged.
pub(super) fn filled(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> MISSION_ITEM_INT_DATA {
    let mut item = item.clone();
    if of(&item).place {
        let origin = plane.origin();
        (item.x, item.y) = (deg_e7(origin.latitude_deg), deg_e7(origin.longitude_deg));
    }
    // Copter's waypoints have no heading; Mission Planner writes 0.
    if item.command == MavCmd::MAV_CMD_NAV_WAYPOINT {
        item.param4 = f32::NAN;
    }
    let timed = [item.param2, item.param3, item.param4].iter().any(|part| *part != 0.0);
    if item.command == MavCmd::MAV_CMD_NAV_DELAY && item.param1 == 0.0 && timed {
        item.param1 = BY_TIME_OF_DAY;
    }
    // More than a turn ends where the rest of it does.
    if item.command == MavCmd::MAV_CMD_CONDITION_YAW && item.param1.is_finite() {
        item.param1 %= TURN_DEG;
    }
    let nowhere = (item.x, item.y) == (0, 0) && item.z == 0.0;
    if item.command == MavCmd::MAV_CMD_DO_SET_HOME && nowhere {
        item.param1 = 1.0;
    }
    item
}

/// What is open is expected to be as at the step before: the vehicle has got there when the step begins.
pub(super) fn assume_previous_positions(steps: &mut [MissionStep], open: &[DeferredFields], home_m: Option<Vec3<Ned>>) {
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
