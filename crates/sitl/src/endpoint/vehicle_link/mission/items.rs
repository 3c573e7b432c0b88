//! Mission items: validation, and conversion to the autopilot's steps.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::fence_and_rally;
use super::positions::{MAX_ALTITUDE_M, flyable_position, has_no_position, place, relative};
use crate::autopilot::{MissionStep, TimeOfDay};
use crate::endpoint::payload::commands as payload;
use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionResult, MavMissionType};
use spandrel_model::geodesy::LocalPlane;

/// Maximum hold time for an item, s.
const MAX_HOLD_S: f32 = 86_400.0;
/// Allowed circle radii, m.
const CIRCLE_RADII_M: std::ops::RangeInclusive<f32> = 1.0..=1_000.0;
/// Default circle radius, m.
const DEFAULT_RADIUS_M: f64 = 5.0;
/// Allowed speeds, m/s; -1 means no change, and -2 restores the parameter's value (MAVLink common).
const ALLOWED_SPEEDS_M_S: (f32, f32) = (0.1, 100.0);
/// Minimum number of repetitions at which a jump counts as endless.
const ENDLESS_REPETITIONS: f32 = 64.0;

type ItemResult = Result<(), MavMissionResult>;

fn check_range(value: f32, (low, high): (f32, f32), wrong: MavMissionResult) -> ItemResult {
    if value.is_nan() || (low..=high).contains(&value) { Ok(()) } else { Err(wrong) }
}

/// Validates an item and returns an error that names the invalid parameter. `flown` is the range of sequence numbers
/// that the plan executes.
pub(super) fn check_item(item: &MISSION_ITEM_INT_DATA, flown: std::ops::Range<u16>, plane: &LocalPlane) -> ItemResult {
    use MavMissionResult as R;
    if item.mission_type != MavMissionType::MAV_MISSION_TYPE_MISSION {
        return fence_and_rally::check_area(item, plane);
    }
    match item.command {
        MavCmd::MAV_CMD_NAV_WAYPOINT | MavCmd::MAV_CMD_NAV_LOITER_TIME | MavCmd::MAV_CMD_NAV_LOITER_UNLIM => {
            check_range(item.param1, (0.0, MAX_HOLD_S), R::MAV_MISSION_INVALID_PARAM1)?;
            flyable_position(item, plane)
        }
        MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT => {
            check_range(item.param1, (0.0, MAX_HOLD_S), R::MAV_MISSION_INVALID_PARAM1)?;
            flyable_position(item, plane)
        }
        MavCmd::MAV_CMD_NAV_LOITER_TO_ALT | MavCmd::MAV_CMD_CONDITION_GATE => flyable_position(item, plane),
        MavCmd::MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET => check_no_offsets(item),
        MavCmd::MAV_CMD_NAV_LOITER_TURNS => circle(item).and_then(|()| flyable_position(item, plane)),
        MavCmd::MAV_CMD_NAV_TAKEOFF | MavCmd::MAV_CMD_NAV_LAND if has_no_position(item) => {
            if relative(item.frame).is_none() && item.frame != MavFrame::MAV_FRAME_MISSION {
                return Err(R::MAV_MISSION_UNSUPPORTED_FRAME);
            }
            check_range(item.z, (-MAX_ALTITUDE_M, MAX_ALTITUDE_M), R::MAV_MISSION_INVALID_PARAM7)
        }
        MavCmd::MAV_CMD_NAV_TAKEOFF | MavCmd::MAV_CMD_NAV_LAND => flyable_position(item, plane),
        MavCmd::MAV_CMD_NAV_DELAY if item.param1 == -1.0 => time_of_day(item).map(|_| ()),
        MavCmd::MAV_CMD_NAV_DELAY | MavCmd::MAV_CMD_CONDITION_DELAY | MavCmd::MAV_CMD_CONDITION_DISTANCE => {
            check_range(item.param1, (0.0, MAX_HOLD_S), R::MAV_MISSION_INVALID_PARAM1)
        }
        MavCmd::MAV_CMD_CONDITION_YAW => turn(item),
        MavCmd::MAV_CMD_DO_JUMP => {
            let inside = (f32::from(flown.start)..f32::from(flown.end)).contains(&item.param1);
            if inside {
                check_range(item.param2, (-1.0, 1e6), R::MAV_MISSION_INVALID_PARAM2)
            } else {
                Err(R::MAV_MISSION_INVALID_PARAM1)
            }
        }
        MavCmd::MAV_CMD_DO_CHANGE_SPEED => speed(item),
        MavCmd::MAV_CMD_DO_SET_HOME if item.param1 == 1.0 => Ok(()),
        MavCmd::MAV_CMD_DO_SET_HOME => flyable_position(item, plane),
        MavCmd::MAV_CMD_DO_FENCE_ENABLE => {
            if [0.0, 1.0].contains(&item.param1) {
                Ok(())
            } else {
                Err(R::MAV_MISSION_INVALID_PARAM1)
            }
        }
        MavCmd::MAV_CMD_DO_SET_ROI_LOCATION => flyable_position(item, plane),
        MavCmd::MAV_CMD_DO_SET_ROI if !has_no_position(item) => flyable_position(item, plane),
        MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH | MavCmd::MAV_CMD_DO_LAND_START => Ok(()),
        command if payload::is_supported(command) => Ok(()),
        _ => Err(R::MAV_MISSION_UNSUPPORTED),
    }
}

/// Parameters 2 to 4 are hour, minute and second in UTC; -1 matches any value.
fn time_of_day(item: &MISSION_ITEM_INT_DATA) -> Result<TimeOfDay, MavMissionResult> {
    use MavMissionResult as R;
    let part = |value: f32, most: f32, wrong: R| match value {
        -1.0 => Ok(None),
        value if (0.0..=most).contains(&value) && value.fract() == 0.0 => Ok(Some(value as u8)),
        _ => Err(wrong),
    };
    Ok(TimeOfDay {
        hour: part(item.param2, 23.0, R::MAV_MISSION_INVALID_PARAM2)?,
        minute: part(item.param3, 59.0, R::MAV_MISSION_INVALID_PARAM3)?,
        second: part(item.param4, 59.0, R::MAV_MISSION_INVALID_PARAM4)?,
    })
}

/// Parameter 1 is the number of turns. Parameter 3 is the radius: negative means counterclockwise, and 0 or NaN selects
/// the default.
fn circle(item: &MISSION_ITEM_INT_DATA) -> ItemResult {
    check_range(item.param1, (0.0, 1_000.0), MavMissionResult::MAV_MISSION_INVALID_PARAM1)?;
    let radius = item.param3.abs();
    let known = radius.is_nan() || radius == 0.0 || CIRCLE_RADII_M.contains(&radius);
    if known { Ok(()) } else { Err(MavMissionResult::MAV_MISSION_INVALID_PARAM3) }
}

/// Parameters: 1 angle in degrees, 2 rate in deg/s (0: default), 3 direction, 4 whether the angle is relative to the
/// current heading.
fn turn(item: &MISSION_ITEM_INT_DATA) -> ItemResult {
    use MavMissionResult as R;
    if !(-360.0..=360.0).contains(&item.param1) {
        return Err(R::MAV_MISSION_INVALID_PARAM1);
    }
    check_range(item.param3, (-1.0, 1.0), R::MAV_MISSION_INVALID_PARAM3)?;
    if [0.0, 1.0].contains(&item.param4) { Ok(()) } else { Err(R::MAV_MISSION_INVALID_PARAM4) }
}

/// Parameter 1 is the speed type (ground speed or airspeed, which are the same for a multirotor), 2 the speed.
fn speed(item: &MISSION_ITEM_INT_DATA) -> ItemResult {
    if !(item.param1.is_nan() || [0.0, 1.0].contains(&item.param1)) {
        return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM1);
    }
    if [-1.0, -2.0].contains(&item.param2) {
        return Ok(());
    }
    check_range(item.param2, ALLOWED_SPEEDS_M_S, MavMissionResult::MAV_MISSION_INVALID_PARAM2)
}

/// Rejects a mission with an endless jump loop that contains no flight or wait items.
pub(super) fn whole(items: &[MISSION_ITEM_INT_DATA]) -> ItemResult {
    let idle = |item: &MISSION_ITEM_INT_DATA| {
        (item.command as u16) > NAV_LAST
            && item.command != MavCmd::MAV_CMD_CONDITION_GATE
            && !matches!(item.command, MavCmd::MAV_CMD_CONDITION_DELAY if item.param1 > 0.0)
    };
    let endless = |item: &MISSION_ITEM_INT_DATA| {
        item.command == MavCmd::MAV_CMD_DO_JUMP && !(0.0..ENDLESS_REPETITIONS).contains(&item.param2)
    };
    let after = |at: usize| if endless(&items[at]) { items[at].param1 as usize } else { at + 1 };
    for (start, _) in items.iter().enumerate().filter(|(_, item)| endless(item)) {
        let mut at = start;
        for _ in 0..=items.len() {
            if items.get(at).is_none_or(|item| !idle(item)) {
                break;
            }
            at = after(at);
        }
        if items.get(at).is_some_and(idle) {
            return Err(MavMissionResult::MAV_MISSION_INVALID_PARAM1);
        }
    }
    Ok(())
}

/// MAV_CMD_NAV_LAST: commands up to this number navigate or wait.
const NAV_LAST: u16 = 95;

/// Returns a mission item; DO_SET_ROI_WPNEXT_OFFSET is resolved to the position of the next waypoint.
pub(crate) fn resolve_next_waypoint(items: &[MISSION_ITEM_INT_DATA], index: usize) -> Option<MISSION_ITEM_INT_DATA> {
    let item = items.get(index)?;
    if item.command != MavCmd::MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET {
        return Some(item.clone());
    }
    let flown = |item: &&MISSION_ITEM_INT_DATA| has_position(item.command) && !has_no_position(item);
    let command = MavCmd::MAV_CMD_DO_SET_ROI_LOCATION;
    let next = items.iter().skip(index + 1).find(flown);
    // After the last position there is no target.
    let none = || MISSION_ITEM_INT_DATA { command: MavCmd::MAV_CMD_DO_SET_ROI_NONE, ..item.clone() };
    Some(next.map_or_else(none, |next| MISSION_ITEM_INT_DATA { command, ..next.clone() }))
}

fn has_position(command: MavCmd) -> bool {
    (command as u16) <= NAV_LAST || command == MavCmd::MAV_CMD_CONDITION_GATE
}

/// Checks that DO_SET_ROI_WPNEXT_OFFSET has no offsets: pitch in parameter 5, roll in 6 and yaw in 7 are not supported.
fn check_no_offsets(item: &MISSION_ITEM_INT_DATA) -> ItemResult {
    use MavMissionResult as R;
    let none = |offset: i32| matches!(offset, 0 | i32::MAX);
    match (none(item.x), none(item.y), item.z == 0.0 || item.z.is_nan()) {
        (false, ..) => Err(R::MAV_MISSION_INVALID_PARAM5_X),
        (_, false, _) => Err(R::MAV_MISSION_INVALID_PARAM6_Y),
        (.., false) => Err(R::MAV_MISSION_INVALID_PARAM7),
        _ => Ok(()),
    }
}

/// Converts an item to an autopilot step. `home_height_m` is home's height above the origin in meters.
pub(super) fn step(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, home_up_m: f64) -> MissionStep {
    let number = |x: f32, or: f64| if x.is_finite() { f64::from(x) } else { or };
    let somewhere = |make: fn(spandrel_model::frames::Vec3<spandrel_model::frames::Ned>) -> MissionStep| {
        place(item, plane, home_up_m).map_or(MissionStep::Payload, make)
    };
    match item.command {
        MavCmd::MAV_CMD_NAV_WAYPOINT
        | MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT
        | MavCmd::MAV_CMD_NAV_LOITER_TIME
        | MavCmd::MAV_CMD_NAV_LOITER_UNLIM
        | MavCmd::MAV_CMD_NAV_LOITER_TO_ALT
        | MavCmd::MAV_CMD_CONDITION_GATE => waypoint(item, plane, home_up_m),
        MavCmd::MAV_CMD_NAV_LOITER_TURNS => match place(item, plane, home_up_m) {
            Some(center_m) => MissionStep::Circle {
                center_m,
                radius_m: if item.param3.abs() > 0.0 { number(item.param3, DEFAULT_RADIUS_M) } else { DEFAULT_RADIUS_M },
                turns: number(item.param1, 1.0),
            },
            None => MissionStep::Payload,
        },
        MavCmd::MAV_CMD_NAV_TAKEOFF => {
            let over_sea = relative(item.frame) == Some(false);
            let base = if over_sea { -plane.origin().altitude_m } else { home_up_m };
            MissionStep::Takeoff { up_m: (!item.z.is_nan()).then(|| base + f64::from(item.z)) }
        }
        MavCmd::MAV_CMD_NAV_LAND => {
            MissionStep::Land { position_m: if has_no_position(item) { None } else { place(item, plane, home_up_m) } }
        }
        MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH => MissionStep::Return,
        MavCmd::MAV_CMD_DO_CHANGE_SPEED if item.param2 > 0.0 => MissionStep::Speed(Some(number(item.param2, 5.0))),
        MavCmd::MAV_CMD_DO_CHANGE_SPEED if item.param2 == -2.0 => MissionStep::Speed(None),
        MavCmd::MAV_CMD_NAV_DELAY if item.param1 == -1.0 => {
            time_of_day(item).map_or(MissionStep::Payload, MissionStep::DelayUntil)
        }
        MavCmd::MAV_CMD_DO_LAND_START => MissionStep::LandingSequence,
        MavCmd::MAV_CMD_NAV_DELAY | MavCmd::MAV_CMD_CONDITION_DELAY => MissionStep::Delay(number(item.param1, 0.0).max(0.0)),
        MavCmd::MAV_CMD_CONDITION_DISTANCE => MissionStep::Near(number(item.param1, 0.0)),
        MavCmd::MAV_CMD_CONDITION_YAW => heading(item),
        MavCmd::MAV_CMD_DO_SET_HOME if item.param1 == 1.0 => MissionStep::Home(None),
        MavCmd::MAV_CMD_DO_SET_HOME => somewhere(|place| MissionStep::Home(Some(place))),
        MavCmd::MAV_CMD_DO_FENCE_ENABLE => MissionStep::Fence(item.param1 == 1.0),
        MavCmd::MAV_CMD_DO_SET_ROI_NONE => MissionStep::LookAt(None),
        MavCmd::MAV_CMD_DO_SET_ROI if has_no_position(item) => MissionStep::LookAt(None),
        MavCmd::MAV_CMD_DO_SET_ROI_LOCATION | MavCmd::MAV_CMD_DO_SET_ROI => somewhere(|place| MissionStep::LookAt(Some(place))),
        MavCmd::MAV_CMD_DO_JUMP => {
            let times = number(item.param2, 0.0);
            // -1 repeats forever (MAVLink common).
            let times = if times < 0.0 { u32::MAX } else { times as u32 };
            MissionStep::Jump { to: number(item.param1, 0.0).max(0.0) as usize, times }
        }
        _ => MissionStep::Payload,
    }
}

/// Converts a waypoint. For LOITER_TO_ALT and CONDITION_GATE, the first parameter is not a hold time.
fn waypoint(item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, home_up_m: f64) -> MissionStep {
    let Some(position_m) = place(item, plane, home_up_m) else { return MissionStep::Payload };
    let passes = item.command == MavCmd::MAV_CMD_NAV_WAYPOINT;
    let stays = !matches!(item.command, MavCmd::MAV_CMD_NAV_LOITER_TO_ALT | MavCmd::MAV_CMD_CONDITION_GATE);
    let stay_s = if stays && item.param1.is_finite() { f64::from(item.param1).max(0.0) } else { 0.0 };
    MissionStep::Waypoint {
        position_m,
        // 0 selects the current parameter value.
        acceptance_radius_m: if passes && item.param2.is_finite() && item.param2 > 0.0 { f64::from(item.param2) } else { 0.0 },
        hold_s: if item.command == MavCmd::MAV_CMD_NAV_LOITER_UNLIM { f64::INFINITY } else { stay_s },
        yaw_rad: (passes && item.param4.is_finite()).then(|| f64::from(item.param4).to_radians()),
    }
}

fn heading(item: &MISSION_ITEM_INT_DATA) -> MissionStep {
    let relative = item.param4 == 1.0;
    let angle = f64::from(item.param1).to_radians();
    let rate_rad_s = Some(item.param2).filter(|rate| *rate > 0.0 && rate.is_finite()).map(|rate| f64::from(rate).to_radians());
    MissionStep::Turn { yaw_rad: if relative && item.param3 < 0.0 { -angle } else { angle }, relative, rate_rad_s }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jump(to: f32, times: f32) -> MISSION_ITEM_INT_DATA {
        MISSION_ITEM_INT_DATA { command: MavCmd::MAV_CMD_DO_JUMP, param1: to, param2: times, ..Default::default() }
    }

    fn other(command: MavCmd) -> MISSION_ITEM_INT_DATA {
        MISSION_ITEM_INT_DATA { command, ..Default::default() }
    }

    #[test]
    fn exact_endless_jump_loops_without_flight_items_are_rejected() {
        let fly = || other(MavCmd::MAV_CMD_NAV_WAYPOINT);
        let photo = || other(MavCmd::MAV_CMD_IMAGE_START_CAPTURE);
        let refused = Err(MavMissionResult::MAV_MISSION_INVALID_PARAM1);
        for (items, expected) in [
            (vec![jump(0.0, -1.0)], refused),
            (vec![fly(), jump(0.0, -1.0)], Ok(())),
            (vec![photo(), jump(0.0, 1e6)], refused),
            (vec![photo(), jump(0.0, 3.0)], Ok(())),
            // A jump that skips the waypoint.
            (vec![jump(2.0, -1.0), fly(), jump(0.0, -1.0)], refused),
            (vec![jump(2.0, -1.0), fly(), photo()], Ok(())),
        ] {
            assert_eq!(whole(&items), expected, "{items:?}");
        }
    }
}
