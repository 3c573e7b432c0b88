//! Camera, gimbal and lamp commands: one row per command, used for received commands and for mission items.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::super::Payload;
use super::super::snapshot::VehicleSnapshot;
use super::{VehicleCommand, camera, gimbal, lamp};
use spandrel_mavlink::dialect::{MavCmd, MavResult};
use spandrel_model::frames::{Enu, Ned, Vec3};

pub(super) const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;
pub(super) const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;

/// Executes a command on the payload.
pub(super) type PayloadHandler = fn(&VehicleCommand, &VehicleSnapshot, &mut Payload) -> MavResult;
/// A command and its handler.
pub(super) type PayloadCommand = (MavCmd, PayloadHandler);

/// Commands accepted only by the autopilot component, which the gimbal and the lamp belong to.
const MOUNTED: [&[PayloadCommand]; 2] = [gimbal::ROWS, lamp::ROWS];

pub(super) fn verdict(ok: bool) -> MavResult {
    if ok { ACCEPTED } else { DENIED }
}

/// Checks whether the payload supports this command.
pub(in super::super) fn is_supported(command: MavCmd) -> bool {
    camera::ROWS.iter().chain(MOUNTED.into_iter().flatten()).any(|(known, _)| *known == command)
}

fn row(number: u16, rows: &'static [PayloadCommand]) -> Option<PayloadHandler> {
    rows.iter().find(|(command, _)| *command as u16 == number).map(|(_, act)| *act)
}

/// Handles a command addressed to the camera component.
pub(super) fn camera(c: &VehicleCommand, view: &VehicleSnapshot, payload: &mut Payload) -> Option<MavResult> {
    Some(row(c.number, camera::ROWS)?(c, view, payload))
}

/// Handles a command addressed to the autopilot component.
pub(in super::super) fn handle(c: &VehicleCommand, view: &VehicleSnapshot, payload: &mut Payload) -> Option<MavResult> {
    let mounted = || MOUNTED.into_iter().find_map(|rows| row(c.number, rows));
    camera(c, view, payload).or_else(|| Some(mounted()?(c, view, payload)))
}

/// Checks whether the payload handles this command.
pub(in super::super) fn handles(c: &VehicleCommand) -> bool {
    camera::ROWS.iter().chain(MOUNTED.into_iter().flatten()).any(|(known, _)| *known as u16 == c.number)
}

/// Returns the reason why a command was rejected, as text.
pub(in super::super) fn refusal_text(c: &VehicleCommand, view: &VehicleSnapshot, payload: &Payload) -> String {
    if row(c.number, gimbal::ROWS).is_some() {
        let (gimbal, camera) = (&payload.gimbal, &view.vehicle.camera);
        if !(c.own || gimbal.accepts_control_from(c.from)) {
            return format!("gimbal is controlled by {}/{}", gimbal.control.0, gimbal.control.1);
        }
        let [low, high] = [camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad].map(f64::to_degrees);
        return format!("gimbal pitch range {low:.0} to {high:.0} deg, no yaw or retract");
    }
    if row(c.number, lamp::ROWS).is_some() {
        let there = view.vehicle.lamp.flux_lm > 0.0;
        return if there { "lamp is relay 0 or servo 9, on or off only" } else { "this aircraft has no lamp" }.into();
    }
    "camera rejects these values or this mode".into()
}

/// Returns the position that a command makes the vehicle face. `None` for other commands or an unusable position, `Some(None)` if
/// it clears the target.
pub(in super::super) fn looked_at(c: &VehicleCommand, view: &VehicleSnapshot) -> Option<Option<Vec3<Ned>>> {
    match c.number {
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_NONE as u16 => Some(None),
        n if n == MavCmd::MAV_CMD_DO_SET_ROI_LOCATION as u16 || n == MavCmd::MAV_CMD_DO_SET_ROI as u16 => {
            if c.clears_region_of_interest() { Some(None) } else { Some(Some(place(c, view, c.finite_param(6)?)?.ned())) }
        }
        _ => None,
    }
}

/// Returns the position in parameters 5 and 6. The altitude is in the command's frame, or above mean sea level for flavours that
/// ignore the frame.
pub(super) fn place(c: &VehicleCommand, view: &VehicleSnapshot, altitude_m: f64) -> Option<Vec3<Enu>> {
    let (latitude_deg, longitude_deg) = (c.finite_param(4)?, c.finite_param(5)?);
    if latitude_deg.abs() > 90.0 || longitude_deg.abs() > 180.0 || altitude_m.abs() > 1e5 {
        return None;
    }
    let origin = view.plane.origin();
    let home_up = view.status.home_m.map_or(0.0, |h| -h.down());
    let relative = c.is_home_relative() == Some(true) && (c.own || !view.flavour.looks_over_sea);
    let altitude_m = if relative { origin.altitude_m + home_up + altitude_m } else { altitude_m };
    Some(view.plane.enu_from_geo(spandrel_model::geodesy::Geo { latitude_deg, longitude_deg, altitude_m }))
}
