//! Commands for arming, modes, takeoff, go-to and landing.

use super::super::flavor::ModeRow;
use super::super::host_requests::FailureInjection;
use super::super::inbound::InboundMessage;
use super::super::params::ParamValue;
use super::super::{VehicleLink, calibration};
use super::{storage, take_off};
use crate::autopilot::orbit::{OrbitRequest, OrbitYaw};
use crate::autopilot::{AutopilotRequest, FlightMode, RequestOutcome, TurnCommand};
use crate::endpoint::numbered_requests::RequestNumber;
use crate::endpoint::refused_request::queue_or_refuse;
use crate::endpoint::vehicle_command::VehicleCommand;
use mavlink::MessageData;
use spandrel_mavlink::contract::stick_request::{PARAMETER, StickRequest};
use spandrel_mavlink::dialect::{
    GPS_GLOBAL_ORIGIN_DATA, HOME_POSITION_DATA, MISSION_CURRENT_DATA, MavCmd, MavResult, MavSeverity,
};
use spandrel_model::math;

/// MAV_CMD_DO_JUMP_TAG; defined here because not every dialect has it.
const DO_JUMP_TAG: u16 = 601;

/// How a command is handled.
enum CommandHandling {
    /// Answered immediately with this result.
    Answer(MavResult),
    /// Forwarded to the autopilot.
    Request(AutopilotRequest),
}

use CommandHandling::{Answer, Request};

pub(super) fn handle(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<MavResult> {
    let mut step = modes(c, v, a);
    for group in [navigation, missions, limits, services] {
        step = step.or_else(|| group(c, v, a));
    }
    let request = match step? {
        Answer(result) => return Some(result),
        Request(request) => request,
    };
    let outcome = a.autopilot.request(request, a.now());
    if matches!(request, AutopilotRequest::SetHome(_)) && outcome == RequestOutcome::Accepted && v.flavor.home_item {
        v.announce(GPS_GLOBAL_ORIGIN_DATA::ID);
        v.announce(HOME_POSITION_DATA::ID);
    }
    Some(v.result_of(outcome))
}

/// Handles arming and mode commands.
fn modes(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<CommandHandling> {
    use MavCmd as M;
    Some(match c.number {
        n if n == M::MAV_CMD_COMPONENT_ARM_DISARM as u16 => match arm(c, v) {
            Some(AutopilotRequest::Arm { force }) => Answer(arm_motors(c, force, v, a)),
            Some(other) => Request(other),
            None => Answer(v.deny("Arming: parameter 1 must be 1 (arm) or 0 (disarm)")),
        },
        n if n == M::MAV_CMD_DO_SET_MODE as u16 => Answer(set_mode(c, v, a)),
        n if n == M::MAV_CMD_DO_SET_STANDARD_MODE as u16 => {
            let row = c.finite_param(0).and_then(|number| v.flavor.standard(number as u32));
            Answer(match row {
                Some(row) => enter(row, v, a),
                None => v.deny(&format!("No such standard mode {}", c.p[0])),
            })
        }
        n if n == M::MAV_CMD_NAV_RETURN_TO_LAUNCH as u16 => Request(AutopilotRequest::SetMode(FlightMode::Return)),
        n if n == M::MAV_CMD_NAV_LOITER_UNLIM as u16 => {
            let flavor = v.flavor;
            let row =
                flavor.loiter_mode.and_then(|number| flavor.row(number)).unwrap_or_else(|| flavor.default_mode(FlightMode::Hold));
            Answer(enter(row, v, a))
        }
        n if n == M::MAV_CMD_DO_FLIGHTTERMINATION as u16 => match c.p[0] {
            p if p > 0.5 => Request(AutopilotRequest::Disarm { force: true }),
            0.0 => Answer(MavResult::MAV_RESULT_ACCEPTED),
            _ => Answer(MavResult::MAV_RESULT_DENIED),
        },
        _ => return None,
    })
}

/// Handles takeoff, landing and go-to commands.
fn navigation(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<CommandHandling> {
    use MavCmd as M;
    Some(match c.number {
        n if n == M::MAV_CMD_NAV_TAKEOFF as u16 => match take_off::height_m(c, v, a) {
            Ok(height_m) => Request(AutopilotRequest::Takeoff { height_m }),
            Err(refusal) => Answer(refusal),
        },
        n if n == M::MAV_CMD_NAV_LAND as u16 => Request(AutopilotRequest::Land),
        n if n == M::MAV_CMD_NAV_VTOL_LAND as u16 && v.flavor.home_item => Request(AutopilotRequest::Land),
        n if n == M::MAV_CMD_DO_REPOSITION as u16 => Answer(go_to(c, v, a)),
        n if n == M::MAV_CMD_DO_ORBIT as u16 => match orbit(c, a) {
            Some(orbit) => Request(AutopilotRequest::Orbit(orbit)),
            None => Answer(v.deny("Orbit: center must be within 20 km, yaw mode 0-5")),
        },
        n if n == M::MAV_CMD_CONDITION_YAW as u16 => match condition_yaw(c, a) {
            Some(request) => Request(request),
            None => Answer(v.deny("Yaw: angle is not a number")),
        },
        n if n == M::MAV_CMD_DO_SET_HOME as u16 => match home(c, v, a) {
            Some(request) => Request(request),
            None => Answer(v.deny("Home: invalid position or beyond 20 km")),
        },
        _ => return None,
    })
}

/// Handles mission commands: start, pause, and jump.
fn missions(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<CommandHandling> {
    use MavCmd as M;
    Some(match c.number {
        // Missions never contain tags, so a lookup always fails.
        DO_JUMP_TAG if v.flavor.home_item => {
            let is_tag = c.finite_param(0).is_some_and(|tag| (0.0..=f64::from(u16::MAX)).contains(&tag));
            Answer(if is_tag { MavResult::MAV_RESULT_FAILED } else { MavResult::MAV_RESULT_DENIED })
        }
        n if n == M::MAV_CMD_DO_LAND_START as u16 => {
            let row = v.flavor.modes.iter().find(|row| row.request == AutopilotRequest::LandingSequence)?;
            Answer(enter(row, v, a))
        }
        n if n == M::MAV_CMD_DO_PAUSE_CONTINUE as u16 && v.flavor.pauses => Answer(pause(c, v, a)),
        n if n == M::MAV_CMD_DO_PAUSE_CONTINUE as u16 => Request(if c.is_one(0) {
            AutopilotRequest::StartMission { first: None }
        } else {
            AutopilotRequest::SetMode(FlightMode::Hold)
        }),
        n if n == M::MAV_CMD_MISSION_START as u16 => {
            // ArduPilot always starts a mission from its first item.
            if v.flavor.home_item && c.p[..2].iter().any(|item| *item != 0.0) {
                return Some(Answer(v.deny("Mission start: item ranges are not supported")));
            }
            Request(AutopilotRequest::StartMission { first: c.finite_param(0).filter(|f| *f > 0.0).map(|f| index(f, v)) })
        }
        n if n == M::MAV_CMD_DO_SET_MISSION_CURRENT as u16 => {
            Answer(if set_current(c, v, a) { MavResult::MAV_RESULT_ACCEPTED } else { v.deny("No such mission item") })
        }
        _ => return None,
    })
}

/// Handles speed and geofence commands.
fn limits(c: &VehicleCommand, v: &mut VehicleLink, _: &mut InboundMessage) -> Option<CommandHandling> {
    use MavCmd as M;
    Some(match c.number {
        // Climb and descent speeds have their own parameters.
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 && c.finite_param(0).is_some_and(|kind| kind > 1.0) => {
            Answer(v.deny("Speed: type must be 0 or 1 (not climb or descent)"))
        }
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 => match c.finite_param(1) {
            // -1 means no change, and -2 restores the parameter's value (MAVLink common).
            Some(-1.0) => Answer(MavResult::MAV_RESULT_ACCEPTED),
            Some(-2.0) => Request(AutopilotRequest::SetSpeed(None)),
            Some(speed) if speed > 0.0 => Request(AutopilotRequest::SetSpeed(Some(speed))),
            _ => Answer(v.deny("Speed: must be > 0, -1 (keep) or -2 (default)")),
        },
        n if n == M::MAV_CMD_DO_FENCE_ENABLE as u16 => match c.p[0] {
            0.0 => Request(AutopilotRequest::EnableFence(false)),
            1.0 => Request(AutopilotRequest::EnableFence(true)),
            _ => Answer(v.deny("Fence: parameter 1 must be 0 (off) or 1 (on)")),
        },
        _ => return None,
    })
}

/// Handles commands that don't involve the autopilot: freeze and rewind, response to the sticks, failure injection, calibration,
/// storage, checks, and reboot.
fn services(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> Option<CommandHandling> {
    use MavCmd as M;
    if let Some(result) = v.practice_requests.take(&a.aircraft.practice, c, &mut v.texts) {
        return Some(Answer(result));
    }
    if let Some(request) = StickRequest::of(c.number, c.p[0]) {
        let result = request.and_then(|request| change_stick_response(request, c, v, a));
        return Some(Answer(result.unwrap_or_else(|text| v.deny(text))));
    }
    Some(Answer(match c.number {
        n if n == M::MAV_CMD_INJECT_FAILURE as u16 => inject(c, v, a),
        n if n == M::MAV_CMD_PREFLIGHT_CALIBRATION as u16 => calibration::command(c, v, a),
        n if n == M::MAV_CMD_PREFLIGHT_STORAGE as u16 => storage::preflight_storage(c, v, a),
        n if n == M::MAV_CMD_RUN_PREARM_CHECKS as u16 => prearm_checks(v, a),
        n if n == M::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16 => reboot(c, v, a),
        _ => return None,
    }))
}

/// Changes the response to the sticks, which is a parameter, and reports the active one. A repeated command changes nothing.
fn change_stick_response(
    request: StickRequest,
    c: &VehicleCommand,
    v: &mut VehicleLink,
    a: &mut InboundMessage,
) -> Result<MavResult, &'static str> {
    let number = RequestNumber::of(c)?;
    if v.stick_requests.is_repeated(number) {
        return Ok(MavResult::MAV_RESULT_ACCEPTED);
    }
    let response = request.response_after(v.params.stick_response());
    if v.params.set_value(PARAMETER, ParamValue::Int(response.number())).is_err() {
        return Ok(MavResult::MAV_RESULT_UNSUPPORTED);
    }
    v.stick_requests.remember(number);
    v.parameter_changed(PARAMETER, a);
    v.push_text(MavSeverity::MAV_SEVERITY_NOTICE, &format!("Sticks: {}", response.name()));
    Ok(MavResult::MAV_RESULT_ACCEPTED)
}

/// Queues a failure. As in PX4, the command is denied unless SYS_FAILURE_EN is set.
fn inject(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    if v.params.whole("SYS_FAILURE_EN") != Some(1) {
        v.warn("Failure injection is disabled (SYS_FAILURE_EN)");
        return MavResult::MAV_RESULT_DENIED;
    }
    queue_or_refuse(FailureInjection::from_command(c, a.aircraft.vehicle), &mut v.injections, &mut v.texts)
}

/// Parameter 1: 0 does nothing, and 1 or 3 reboots the autopilot. Clients cannot shut down the simulated vehicle.
fn reboot(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    match c.p[0] {
        0.0 => MavResult::MAV_RESULT_ACCEPTED,
        1.0 | 3.0 if a.autopilot.status().armed => {
            v.warn("Reboot denied: vehicle is armed");
            v.flavor.refusals.temporary_rejection
        }
        1.0 | 3.0 => {
            v.restart_requested = true;
            MavResult::MAV_RESULT_ACCEPTED
        }
        _ => MavResult::MAV_RESULT_DENIED,
    }
}

fn arm(c: &VehicleCommand, v: &VehicleLink) -> Option<AutopilotRequest> {
    let force = v.flavor.force.iter().any(|number| (c.p[1] - number).abs() < 0.5);
    match c.p[0] {
        p if (p - 1.0).abs() < 1e-6 => Some(AutopilotRequest::Arm { force }),
        0.0 => Some(AutopilotRequest::Disarm { force }),
        _ => None,
    }
}

/// Arms the motors. If the flavor reports failed checks, each one is sent as a separate text. In the mode that accepts
/// go-to commands (GUIDED), a transmitter switch can arm only if `GUID_OPTIONS` allows it.
fn arm_motors(c: &VehicleCommand, force: bool, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let (flavor, now) = (v.flavor, a.now());
    if let Some(words) = flavor.arming_check_prefix
        && !a.autopilot.status().armed
    {
        let row = flavor.row_of(a.autopilot.status().mode, v.requested_mode);
        let mut reasons = if force { Vec::new() } else { a.autopilot.arming_reasons(now) };
        let allowed = row.armable || row.mode == FlightMode::Mission && v.params.can_arm_in_auto();
        let by_transmitter = c.own && v.is_guided(a.autopilot);
        let allowed = allowed && (!by_transmitter || a.autopilot.tuning.rules.guided.transmitter_can_arm);
        if !allowed && !force {
            reasons.insert(0, format!("{} mode not armable", row.name.to_uppercase()));
        }
        if !reasons.is_empty() {
            reasons.iter().for_each(|reason| v.warn(&format!("{words}{reason}")));
            return flavor.refusals.temporary_rejection;
        }
    }
    let outcome = a.autopilot.request(AutopilotRequest::Arm { force }, now);
    v.result_of(outcome)
}

fn enter(row: &ModeRow, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let now = a.now();
    let outcome = v.flavor.enter(row, &mut v.requested_mode, a.autopilot, now);
    v.result_of(outcome)
}

/// Only the custom mode is used; the other bits of base_mode are ignored.
fn set_mode(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let custom = c.finite_param(0).is_some_and(|base| (base as i64) & 1 == 1);
    let Some(main) = c.finite_param(1).filter(|_| custom) else {
        v.warn("No custom mode specified");
        return MavResult::MAV_RESULT_DENIED;
    };
    let number = (v.flavor.custom_mode)(main, c.finite_param(2).unwrap_or(0.0));
    match v.flavor.row(number) {
        Some(row) => enter(row, v, a),
        None => {
            v.warn(&format!("No such mode {main}"));
            v.flavor.refusals.unknown_mode
        }
    }
}

/// Converts a mission sequence number to the autopilot's item index.
fn index(seq: f64, v: &VehicleLink) -> usize {
    (seq as usize).saturating_sub(usize::from(v.plans.summary().lead))
}

/// Parameter 1 is the item (-1: the current one, which ArduPilot rejects); 1 in parameter 2 resets the mission's
/// progress. Broadcasts MISSION_CURRENT, as MISSION_SET_CURRENT does.
fn set_current(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> bool {
    let item = match c.finite_param(0) {
        Some(-1.0) if !v.flavor.home_item => a.autopilot.status().mission_current,
        Some(seq) if seq >= 0.0 => index(seq, v),
        _ => return false,
    };
    let set = a.autopilot.set_mission_current(item, c.is_one(1));
    if set {
        v.announce(MISSION_CURRENT_DATA::ID);
    }
    set
}

/// DO_REPOSITION. If the flavor has a go-to mode (GUIDED), it must be active, or parameter 2 must request the change
/// (MAV_DO_REPOSITION_FLAGS_CHANGE_MODE).
fn go_to(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let changes = c.finite_param(1).is_some_and(|flags| (flags as i64) & 1 == 1);
    let errands = v.flavor.goto_mode;
    if !(errands.is_none() || changes || v.is_guided(a.autopilot)) {
        return v.deny("Go-to: not allowed in this mode");
    }
    let Some(request) = reposition(c, a) else { return v.deny("Go-to: target beyond 20 km or unknown frame") };
    let outcome = a.autopilot.request(request, a.now());
    if outcome == RequestOutcome::Accepted {
        v.requested_mode = errands.unwrap_or(v.requested_mode);
    }
    v.result_of(outcome)
}

fn reposition(c: &VehicleCommand, a: &InboundMessage) -> Option<AutopilotRequest> {
    let home_up = a.home_height_m();
    let origin = a.aircraft.plane.origin();
    let relative = c.is_home_relative()?;
    let up_m = c.finite_param(6).map(|z| if relative { home_up + z } else { z - origin.altitude_m });
    let north_east_m = match (c.finite_param(4), c.finite_param(5)) {
        (Some(lat), Some(lon)) => {
            if lat.abs() > 90.0 || lon.abs() > 180.0 {
                return None;
            }
            let geo = spandrel_model::geodesy::Geo { latitude_deg: lat, longitude_deg: lon, altitude_m: origin.altitude_m };
            let local = a.aircraft.plane.enu_from_geo(geo);
            if local.norm() > 20_000.0 {
                return None;
            }
            Some((local.north(), local.east()))
        }
        _ => None,
    };
    let speed_m_s = c.finite_param(0).filter(|s| *s > 0.0);
    Some(AutopilotRequest::GoTo { north_east_m, up_m, yaw_rad: c.finite_param(3), speed_m_s })
}

/// Pauses or resumes a flight. Flavors with this command can pause only missions and go-to commands.
fn pause(c: &VehicleCommand, v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    let pausable = v.is_guided(a.autopilot) || a.autopilot.status().mode == FlightMode::Mission;
    let pause = match c.p[0] {
        0.0 => true,
        1.0 => false,
        _ => return MavResult::MAV_RESULT_DENIED,
    };
    let failed = || RequestOutcome::Failed(if pause { "Failed to pause" } else { "Failed to resume" }.into());
    let outcome = if pausable { a.autopilot.request(AutopilotRequest::Pause(pause), a.now()) } else { failed() };
    v.result_of(outcome)
}

/// The value of ORBIT_YAW_BEHAVIOUR_UNCHANGED.
const YAW_UNCHANGED: i64 = 5;

/// Parameters: 1 radius, 2 speed, 3 yaw behavior, 4 arc in radians, 5 to 7 center.
fn orbit(c: &VehicleCommand, a: &InboundMessage) -> Option<OrbitRequest> {
    let AutopilotRequest::GoTo { north_east_m, up_m, .. } = reposition(c, a)? else { return None };
    let yaw = match c.finite_param(2).map(|number| number.round() as i64) {
        None | Some(YAW_UNCHANGED) => None,
        Some(number) => Some(OrbitYaw::from_number(number)?),
    };
    let arc_rad = c.finite_param(3).unwrap_or(0.0).abs();
    Some(OrbitRequest { center_m: north_east_m, up_m, radius_m: c.finite_param(0), speed_m_s: c.finite_param(1), yaw, arc_rad })
}

/// Parameters: 1 angle in degrees, 2 rate in deg/s (0: default), 3 direction, 4 whether the angle is relative to the
/// current heading.
fn condition_yaw(c: &VehicleCommand, a: &InboundMessage) -> Option<AutopilotRequest> {
    let angle = c.finite_param(0)?.to_radians();
    let relative = c.is_one(3);
    let signed = if c.p[2] < 0.0 { -angle } else { angle };
    let now = a.autopilot.estimate().attitude.yaw_rad();
    let rate_rad_s = c.finite_param(1).filter(|rate| *rate > 0.0).map(f64::to_radians);
    let clockwise = c.finite_param(2).filter(|direction| *direction != 0.0).map(|direction| direction > 0.0);
    let yaw_rad = math::wrap_pi(if relative { now + signed } else { angle });
    Some(AutopilotRequest::Turn(TurnCommand { yaw_rad, rate_rad_s, clockwise }))
}

fn home(c: &VehicleCommand, v: &VehicleLink, a: &InboundMessage) -> Option<AutopilotRequest> {
    let unnamed = v.flavor.zero_means_current_position && c.p[4] == 0.0 && c.p[5] == 0.0;
    if c.is_one(0) || unnamed {
        let estimate = a.autopilot.estimate();
        return estimate.position_valid.then_some(AutopilotRequest::SetHome(estimate.position_m));
    }
    let (lat, lon, alt) = (c.finite_param(4)?, c.finite_param(5)?, c.finite_param(6)?);
    let home_up = a.home_height_m();
    let alt = if c.is_home_relative()? { a.aircraft.plane.origin().altitude_m + home_up + alt } else { alt };
    let geo = spandrel_mavlink::units::geo(spandrel_mavlink::units::deg_e7(lat), spandrel_mavlink::units::deg_e7(lon), alt)?;
    let local = a.aircraft.plane.enu_from_geo(geo);
    (local.norm() < 20_000.0).then(|| AutopilotRequest::SetHome(local.ned()))
}

fn prearm_checks(v: &mut VehicleLink, a: &mut InboundMessage) -> MavResult {
    v.events.requested = true;
    let reasons = a.autopilot.status().arming_blockers.clone();
    for reason in &reasons {
        v.warn(&format!("{}{reason}", v.flavor.prearm_reason_prefix));
    }
    MavResult::MAV_RESULT_ACCEPTED
}
