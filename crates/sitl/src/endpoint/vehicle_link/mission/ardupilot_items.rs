//! ArduPilot's extra mission item rules: item 0 is home, and single items outside a plan are fly-now commands.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::positions::{flyable_position, place};
use crate::autopilot::{AutopilotRequest, RequestOutcome};
use crate::endpoint::vehicle_link::VehicleLink;
use crate::endpoint::vehicle_link::inbound::InboundMessage;
use spandrel_mavlink::dialect::{
    MISSION_ITEM_DATA, MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMessage, MavMissionResult, MavMissionType,
};
use spandrel_mavlink::units::deg_e7;
use spandrel_model::frames::Vec3;

/// Values of MISSION_ITEM.current: fly to the position, or change only the altitude.
const GO_TO: u8 = 2;
const CHANGE_HEIGHT: u8 = 3;

/// Returns home as mission item 0. All coordinates are 0 while home is not set.
pub(crate) fn home_item(a: &InboundMessage) -> MavMessage {
    let (target_system, target_component) = a.from;
    let home = a.autopilot.status().home_m.map(|home: Vec3<_>| a.aircraft.plane.geo_from_enu(home.enu()));
    MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA {
        x: home.map_or(0, |geo| deg_e7(geo.latitude_deg)),
        y: home.map_or(0, |geo| deg_e7(geo.longitude_deg)),
        z: home.map_or(0.0, |geo| geo.altitude_m as f32),
        seq: 0,
        command: MavCmd::MAV_CMD_NAV_WAYPOINT,
        target_system,
        target_component,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        autocontinue: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
        ..Default::default()
    })
}

/// Converts a MISSION_ITEM_INT to the older MISSION_ITEM, with coordinates in degrees.
pub(crate) fn in_degrees(item: &MISSION_ITEM_INT_DATA) -> MISSION_ITEM_DATA {
    let degrees = |scaled: i32| if scaled == i32::MAX { f32::NAN } else { (f64::from(scaled) * 1e-7) as f32 };
    MISSION_ITEM_DATA {
        param1: item.param1,
        param2: item.param2,
        param3: item.param3,
        param4: item.param4,
        x: degrees(item.x),
        y: degrees(item.y),
        z: item.z,
        seq: item.seq,
        command: item.command,
        target_system: item.target_system,
        target_component: item.target_component,
        frame: item.frame,
        current: item.current,
        autocontinue: item.autocontinue,
        mission_type: item.mission_type,
    }
}

/// Checks whether an item is outside any plan and must be flown immediately.
pub(crate) fn is_fly_now_item(item: &MISSION_ITEM_INT_DATA) -> bool {
    let mission = item.mission_type == MavMissionType::MAV_MISSION_TYPE_MISSION;
    mission && matches!(item.current, GO_TO | CHANGE_HEIGHT) && item.command == MavCmd::MAV_CMD_NAV_WAYPOINT
}

/// Flies to the item's position. Denied unless the vehicle is in the mode that accepts go-to commands (GUIDED).
pub(crate) fn fly_now(v: &mut VehicleLink, item: &MISSION_ITEM_INT_DATA, a: &mut InboundMessage) -> MavMissionResult {
    if !v.is_guided(a.autopilot) {
        return MavMissionResult::MAV_MISSION_DENIED;
    }
    if let Err(result) = flyable_position(item, a.aircraft.plane) {
        return result;
    }
    let home_up = a.home_height_m();
    let Some(target) = place(item, a.aircraft.plane, home_up) else { return MavMissionResult::MAV_MISSION_INVALID_PARAM5_X };
    let north_east_m = (item.current == GO_TO).then_some((target.north(), target.east()));
    let request = AutopilotRequest::GoTo { north_east_m, up_m: Some(-target.down()), yaw_rad: None, speed_m_s: None };
    match a.autopilot.request(request, a.now()) {
        RequestOutcome::Accepted => MavMissionResult::MAV_MISSION_ACCEPTED,
        RequestOutcome::TemporarilyRejected(_)
        | RequestOutcome::Denied(_)
        | RequestOutcome::Failed(_)
        | RequestOutcome::Unsupported => MavMissionResult::MAV_MISSION_DENIED,
    }
}
