//! Camera, gimbal and lamp: one row a command. The same rows serve commands from the wire and items of a mission.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::super::Payload;
use super::super::gimbal::{Aim, DEVICE};
use super::super::view::View;
use super::Command;
use crate::base::frames::{Enu, Ned, Vec3};
use crate::base::geodesy::Geo;
use crate::mav::dialect::{MavCmd, MavResult};

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
/// GIMBAL_MANAGER_FLAGS_RETRACT and _NEUTRAL; this gimbal does not retract.
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;

/// What a command does to the payload.
type Act = fn(&Command, &View, &mut Payload) -> MavResult;

/// Commands that the camera component takes too.
const CAMERA: &[(MavCmd, Act)] = &[
    (MavCmd::MAV_CMD_IMAGE_START_CAPTURE, |c, v, p| verdict(p.camera.start(c.p[1], c.p[2], v.now))),
    (MavCmd::MAV_CMD_IMAGE_STOP_CAPTURE, |_, _, p| {
        p.camera.stop();
        ACCEPTED
    }),
    (MavCmd::MAV_CMD_DO_DIGICAM_CONTROL, |c, v, p| verdict(c.is_one(4) && p.camera.start(0.0, 1.0, v.now))),
    (MavCmd::MAV_CMD_DO_SET_CAM_TRIGG_DIST, |c, v, p| {
        verdict(p.camera.start_by_distance(c.p[0], c.is_one(2), v.estimate.position_m.enu(), v.now))
    }),
    // Only pictures: changing to picture mode is granted, any other mode is not.
    (MavCmd::MAV_CMD_SET_CAMERA_MODE, |c, _, _| verdict(c.p[1] == 0.0)),
];

/// Commands that only the autopilot's component takes: gimbal and lamp hang on it.
const MOUNTED: &[(MavCmd, Act)] = &[
    (MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, pitch_yaw),
    (MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, |c, _, p| configure(c, p)),
    (MavCmd::MAV_CMD_DO_MOUNT_CONTROL, |c, v, p| aim(Aim::Angle(c.p[0].to_radians()), c, v, p)),
    (MavCmd::MAV_CMD_DO_SET_ROI_LOCATION, roi),
    (MavCmd::MAV_CMD_DO_SET_ROI, roi),
    (MavCmd::MAV_CMD_DO_SET_ROI_NONE, |c, v, p| aim(Aim::Angle(0.0), c, v, p)),
    (MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, |c, v, p| lamp(c.p[0], v, p)),
    (MavCmd::MAV_CMD_DO_ILLUMINATOR_CONFIGURE, |c, _, _| brightness(c)),
    (MavCmd::MAV_CMD_DO_SET_RELAY, |c, v, p| if c.p[0] == 0.0 { lamp(c.p[1], v, p) } else { DENIED }),
    (MavCmd::MAV_CMD_DO_SET_ACTUATOR, |c, v, p| match c.given(0) {
        Some(value) => lamp(if value > 0.0 { 1.0 } else { 0.0 }, v, p),
        None => ACCEPTED,
    }),
];

fn verdict(ok: bool) -> MavResult {
    if ok { ACCEPTED } else { DENIED }
}

/// True for what the payload does.
pub(in super::super) fn knows(command: MavCmd) -> bool {
    CAMERA.iter().chain(MOUNTED).any(|(known, _)| *known == command)
}

fn row(number: u16, rows: &'static [(MavCmd, Act)]) -> Option<Act> {
    rows.iter().find(|(command, _)| *command as u16 == number).map(|(_, act)| *act)
}

/// As the camera component.
pub(super) fn camera(c: &Command, view: &View, payload: &mut Payload) -> Option<MavResult> {
    Some(row(c.number, CAMERA)?(c, view, payload))
}

/// As the autopilot's component.
pub(in super::super) fn handle(c: &Command, view: &View, payload: &mut Payload) -> Option<MavResult> {
    camera(c, view, payload).or_else(|| Some(row(c.number, MOUNTED)?(c, view, payload)))
}

fn aim(aim: Aim, c: &Command, view: &View, payload: &mut Payload) -> MavResult {
    let gimbal = &mut payload.gimbal;
    verdict(gimbal.obeys(c.from) && gimbal.set(aim, &view.vehicle.camera))
}

/// Pitch or pitch rate in degrees; yaw follows the vehicle whatever is asked.
fn pitch_yaw(c: &Command, view: &View, payload: &mut Payload) -> MavResult {
    if !(c.p[6] == 0.0 || c.p[6] == f64::from(DEVICE)) {
        return DENIED;
    }
    let flags = c.given(4).map_or(0, |flags| flags as u32);
    if flags & RETRACT != 0 {
        return DENIED;
    }
    if flags & NEUTRAL != 0 {
        return aim(Aim::Angle(0.0), c, view, payload);
    }
    match (c.given(0), c.given(2)) {
        (Some(pitch), _) => aim(Aim::Angle(pitch.to_radians()), c, view, payload),
        (None, Some(rate)) => aim(Aim::Rate(rate.to_radians()), c, view, payload),
        (None, None) => ACCEPTED,
    }
}

/// Primary control in parameters 1 and 2, secondary in 3 and 4: -1 leaves, -2 takes for the sender, -3 releases (MAVLink common).
fn configure(c: &Command, payload: &mut Payload) -> MavResult {
    let gimbal = &mut payload.gimbal;
    let chosen = |system: f64, component: f64, now: (u8, u8)| match system {
        -1.0 => Some(now),
        -2.0 => Some(c.from),
        // Only who has it can let go of it.
        -3.0 => Some(if now == c.from { (0, 0) } else { now }),
        id if (0.0..=255.0).contains(&id) => Some((id as u8, component.clamp(0.0, 255.0) as u8)),
        _ => None,
    };
    let secondary = if c.p[2] == 0.0 { Some(gimbal.secondary) } else { chosen(c.p[2], c.p[3], gimbal.secondary) };
    match (chosen(c.p[0], c.p[1], gimbal.control), secondary) {
        (Some(primary), Some(secondary)) => {
            (gimbal.control, gimbal.secondary) = (primary, secondary);
            ACCEPTED
        }
        _ => DENIED,
    }
}

/// Where a command makes the vehicle look: `None` for another command or no usable place, `Some(None)` for looking nowhere any more.
pub(in super::super) fn looked_at(c: &Command, view: &View) -> Option<Option<Vec3<Ned>>> {
    match c.number {
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_NONE as u16 => Some(None),
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_LOCATION as u16 || n == MavCmd::MAV_CMD_DO_SET_ROI as u16 => {
            Some(Some(place(c, view)?.ned()))
        }
        _ => None,
    }
}

/// The place in parameters 5 to 7.
fn place(c: &Command, view: &View) -> Option<Vec3<Enu>> {
    let (lat, lon, alt) = (c.given(4)?, c.given(5)?, c.given(6)?);
    if lat.abs() > 90.0 || lon.abs() > 180.0 || alt.abs() > 1e5 {
        return None;
    }
    let origin = view.plane.origin();
    let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
    let altitude_m = if matches!(c.frame, 3 | 6 | 10 | 11) { origin.altitude_m + home_up + alt } else { alt };
    Some(view.plane.enu_from_geo(Geo { latitude_deg: lat, longitude_deg: lon, altitude_m }))
}

fn roi(c: &Command, view: &View, payload: &mut Payload) -> MavResult {
    place(c, view).map_or(DENIED, |place| aim(Aim::Place(place), c, view, payload))
}

fn lamp(value: f64, view: &View, payload: &mut Payload) -> MavResult {
    if !(value == 0.0 || value == 1.0) || view.vehicle.lamp.flux_lm <= 0.0 {
        return DENIED;
    }
    payload.lamp.on = value > 0.5;
    ACCEPTED
}

/// Mode in parameter 1 (0 and 1 leave it as it is), brightness in per cent in parameter 2: this lamp is on or off, it neither dims nor
/// strobes, and the light of a picture is judged by that.
fn brightness(c: &Command) -> MavResult {
    let mode = matches!(c.given(0), None | Some(0.0 | 1.0));
    verdict(mode && matches!(c.given(1), None | Some(100.0)))
}
