//! Gimbal commands: gimbal manager, regions of interest, and the older mount commands.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use super::super::equipment::Payload;
use super::super::gimbal::{BUILTIN_GIMBAL_DEVICE_ID, GimbalState, GimbalTarget};
use super::super::input::PayloadInput;
use super::handler::{ACCEPTED, DENIED, PayloadCommand, accepted_if};
use super::region_of_interest::position;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::dialect::{GIMBAL_MANAGER_STATUS_DATA, MavCmd, MavResult};

/// Values of GIMBAL_MANAGER_FLAGS_RETRACT and GIMBAL_MANAGER_FLAGS_NEUTRAL. This gimbal cannot retract.
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;

pub(super) const ROWS: &[PayloadCommand] = &[
    (MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, pitch_yaw),
    (MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, |c, _, p| configure(c, p)),
    (MavCmd::MAV_CMD_DO_MOUNT_CONTROL, mount_control),
    (MavCmd::MAV_CMD_DO_MOUNT_CONFIGURE, mount_configure),
    (MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, roi),
    (MavCmd::MAV_CMD_DO_SET_ROI, roi),
    (MavCmd::MAV_CMD_DO_SET_ROI_NONE, |c, i, p| aim(GimbalTarget::Angle(0.0), c, i, p)),
];

/// Checks whether the sender may move the gimbal; the vehicle's own mission always may.
fn may_move(c: &VehicleCommand, gimbal: &GimbalState) -> bool {
    c.own || gimbal.accepts_control_from(c.from)
}

fn aim(aim: GimbalTarget, c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    let gimbal = &mut payload.gimbal;
    accepted_if(may_move(c, gimbal) && gimbal.set(aim, &input.vehicle.camera))
}

/// Checks whether the device ID in parameter 7 refers to this gimbal: 0 (all) or its own ID.
fn targets_this_gimbal(c: &VehicleCommand) -> bool {
    c.finite_param(6).is_none_or(|device| device == 0.0 || device == f64::from(BUILTIN_GIMBAL_DEVICE_ID))
}

/// Sets a pitch angle with an optional rate, or a pitch rate alone, in degrees relative to the horizon. Yaw always
/// follows the vehicle; a command for yaw alone is denied.
fn pitch_yaw(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    let flags = c.small_integer(4).map_or(0, |flags| flags as u32);
    if !targets_this_gimbal(c) || flags & RETRACT != 0 {
        return DENIED;
    }
    if flags & NEUTRAL != 0 {
        return aim(GimbalTarget::Neutral, c, input, payload);
    }
    let radians = |k: usize| c.finite_param(k).map(f64::to_radians);
    match GimbalTarget::of(radians(0), radians(2)) {
        Some(target) => aim(target, c, input, payload),
        None => accepted_if([1, 3].iter().all(|k| c.finite_param(*k).is_none_or(|yaw| yaw == 0.0))),
    }
}

/// Sets who controls the gimbal. Parameters 1 and 2 are the primary controller's system and component ID; 3 and 4 are
/// the secondary controller's. 0 means no one, -1 no change, -2 the sender, and -3 no one if the sender is in control
/// (MAVLink common).
fn configure(c: &VehicleCommand, payload: &mut Payload) -> MavResult {
    let gimbal = &mut payload.gimbal;
    let id_of = |id: f64, now: u8, own: u8, is_own: bool| match id {
        -1.0 => Some(now),
        -2.0 => Some(own),
        -3.0 => Some(if is_own { 0 } else { now }),
        id if (0.0..=255.0).contains(&id) => Some(id as u8),
        _ => None,
    };
    let controller = |k: usize, now: (u8, u8)| {
        let is_own = now == c.from;
        let pair = (id_of(c.p[k], now.0, c.from.0, is_own)?, id_of(c.p[k + 1], now.1, c.from.1, is_own)?);
        // A system ID of 0 releases control, regardless of the component ID.
        Some(if pair.0 == 0 { (0, 0) } else { pair })
    };
    let (Some(primary), Some(secondary), true) =
        (controller(0, gimbal.control), controller(2, gimbal.secondary), targets_this_gimbal(c))
    else {
        return DENIED;
    };
    (gimbal.control, gimbal.secondary) = (primary, secondary);
    payload.changes.add_message(GIMBAL_MANAGER_STATUS_DATA::ID);
    ACCEPTED
}

fn roi(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    if c.clears_region_of_interest() {
        return aim(GimbalTarget::Angle(0.0), c, input, payload);
    }
    let place = c.finite_param(6).and_then(|altitude_m| position(c, input, altitude_m));
    place.map_or(DENIED, |place| aim(GimbalTarget::Position(place), c, input, payload))
}

/// Mount modes that this gimbal supports (MAV_MOUNT_MODE).
enum MountMode {
    Neutral,
    /// Angles from MAVLink or a stick.
    Targeting,
    Point,
    Home,
}

impl MountMode {
    /// Returns `None` for unsupported modes: retract, follow another system, point at the next waypoint.
    fn of(number: f64) -> Option<Self> {
        match number {
            1.0 => Some(Self::Neutral),
            2.0 | 3.0 => Some(Self::Targeting),
            4.0 => Some(Self::Point),
            6.0 => Some(Self::Home),
            _ => None,
        }
    }
}

fn point_at_home(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    input.home_m.map_or(DENIED, |home| aim(GimbalTarget::Position(home.enu()), c, input, payload))
}

/// Parameter 7 is the mode. Parameter 1 is the pitch angle, or a rate if DO_MOUNT_CONFIGURE selected rates; 5, 6 and 4
/// are the target position.
fn mount_control(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    match MountMode::of(c.finite_param(6).unwrap_or(2.0)) {
        Some(MountMode::Neutral) => aim(GimbalTarget::Neutral, c, input, payload),
        Some(MountMode::Targeting) => {
            let pitch = c.p[0].to_radians();
            let target =
                if payload.gimbal.mount_values_are_rates { GimbalTarget::Rate(pitch) } else { GimbalTarget::Angle(pitch) };
            aim(target, c, input, payload)
        }
        Some(MountMode::Point) => {
            let place = c.finite_param(3).and_then(|altitude_m| position(c, input, altitude_m));
            place.map_or(DENIED, |place| aim(GimbalTarget::Position(place), c, input, payload))
        }
        Some(MountMode::Home) => point_at_home(c, input, payload),
        None => DENIED,
    }
}

/// Parameter 1 is the mode; 6 selects whether pitch is an angle (0, 2) or a rate (1). Roll and pitch are always
/// stabilized, regardless of 2 to 4.
fn mount_configure(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    let rates = match c.small_integer(5) {
        None | Some(0.0 | 2.0) => false,
        Some(1.0) => true,
        Some(_) => return DENIED,
    };
    let done = match MountMode::of(c.p[0]) {
        Some(MountMode::Neutral) => aim(GimbalTarget::Neutral, c, input, payload),
        Some(MountMode::Home) => point_at_home(c, input, payload),
        Some(MountMode::Targeting | MountMode::Point) => accepted_if(may_move(c, &payload.gimbal)),
        None => DENIED,
    };
    if done == ACCEPTED {
        payload.gimbal.mount_values_are_rates = rates;
    }
    done
}
