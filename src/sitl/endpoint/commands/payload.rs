//! Camera, gimbal and lamp.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::super::gimbal::{Aim, DEVICE};
use super::Command;
use crate::base::geodesy::Geo;
use crate::mav::dialect::{MavCmd, MavResult};
use crate::sitl::endpoint::Context;

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;

fn verdict(ok: bool) -> MavResult {
    if ok { ACCEPTED } else { DENIED }
}

pub(super) fn handle(c: &Command, x: &mut Context) -> Option<MavResult> {
    use MavCmd as M;
    let now = x.view.now;
    Some(match c.number {
        n if n == M::MAV_CMD_IMAGE_START_CAPTURE as u16 => verdict(x.payload.camera.start(c.p[1], c.p[2], now)),
        n if n == M::MAV_CMD_IMAGE_STOP_CAPTURE as u16 => {
            x.payload.camera.stop();
            ACCEPTED
        }
        n if n == M::MAV_CMD_DO_DIGICAM_CONTROL as u16 => verdict(c.is_one(4) && x.payload.camera.start(0.0, 1.0, now)),
        // Only pictures: changing to picture mode is granted, any other mode is not.
        n if n == M::MAV_CMD_SET_CAMERA_MODE as u16 => verdict(c.p[1] == 0.0),
        n if n == M::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW as u16 => pitch_yaw(c, x),
        n if n == M::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE as u16 => configure(c, x),
        n if n == M::MAV_CMD_DO_MOUNT_CONTROL as u16 => aim(Aim::Angle(c.p[0].to_radians()), x),
        n if n == M::MAV_CMD_DO_SET_ROI_LOCATION as u16 || n == M::MAV_CMD_DO_SET_ROI as u16 => roi(c, x),
        n if n == M::MAV_CMD_DO_SET_ROI_NONE as u16 => aim(Aim::Angle(0.0), x),
        n if n == M::MAV_CMD_ILLUMINATOR_ON_OFF as u16 => lamp(c.p[0], x),
        n if n == M::MAV_CMD_DO_ILLUMINATOR_CONFIGURE as u16 => brightness(c, x),
        n if n == M::MAV_CMD_DO_SET_RELAY as u16 => {
            if c.p[0] == 0.0 {
                lamp(c.p[1], x)
            } else {
                DENIED
            }
        }
        n if n == M::MAV_CMD_DO_SET_ACTUATOR as u16 => match c.given(0) {
            Some(value) => lamp(if value > 0.0 { 1.0 } else { 0.0 }, x),
            None => ACCEPTED,
        },
        _ => return None,
    })
}

fn aim(aim: Aim, x: &mut Context) -> MavResult {
    let camera = x.view.vehicle.camera;
    verdict(x.payload.gimbal.set(aim, &camera))
}

/// Pitch or pitch rate in degrees; yaw follows the vehicle whatever is asked.
fn pitch_yaw(c: &Command, x: &mut Context) -> MavResult {
    if !matches!(c.p[6] as u8, 0 | DEVICE) {
        return DENIED;
    }
    match (c.given(0), c.given(2)) {
        (Some(pitch), _) => aim(Aim::Angle(pitch.to_radians()), x),
        (None, Some(rate)) => aim(Aim::Rate(rate.to_radians()), x),
        (None, None) => ACCEPTED,
    }
}

/// -1 leaves, -2 takes for the sender, -3 releases (MAVLink common).
fn configure(c: &Command, x: &mut Context) -> MavResult {
    let Some(system) = c.given(0) else { return DENIED };
    x.payload.gimbal.control = match system as i32 {
        -1 => x.payload.gimbal.control,
        -2 => c.from,
        -3 => (0, 0),
        id @ 0..=255 => (id as u8, c.given(1).unwrap_or(0.0).clamp(0.0, 255.0) as u8),
        _ => return DENIED,
    };
    ACCEPTED
}

fn roi(c: &Command, x: &mut Context) -> MavResult {
    let (Some(lat), Some(lon), Some(alt)) = (c.given(4), c.given(5), c.given(6)) else { return DENIED };
    if lat.abs() > 90.0 || lon.abs() > 180.0 {
        return DENIED;
    }
    let origin = x.view.plane.origin();
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let altitude_m = if matches!(c.frame, 3 | 6 | 10 | 11) { origin.altitude_m + home_up + alt } else { alt };
    let place = x.view.plane.enu_from_geo(Geo { latitude_deg: lat, longitude_deg: lon, altitude_m });
    aim(Aim::Place(place), x)
}

fn lamp(value: f64, x: &mut Context) -> MavResult {
    if !(value == 0.0 || value == 1.0) || x.view.vehicle.lamp.flux_lm <= 0.0 {
        return DENIED;
    }
    x.payload.lamp.on = value > 0.5;
    ACCEPTED
}

/// Mode in parameter 1, brightness in per cent in parameter 2; strobing is not fitted.
fn brightness(c: &Command, x: &mut Context) -> MavResult {
    match c.given(1) {
        Some(pct) if (0.0..=100.0).contains(&pct) => {
            x.payload.lamp.brightness_pct = pct;
            ACCEPTED
        }
        _ => DENIED,
    }
}
