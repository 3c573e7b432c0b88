//! Commands for arming, modes, takeoff, go-to and landing.

use super::super::{calibration, storage};
use super::{VehicleCommand, result};
use crate::autopilot::orbit::{OrbitRequest, OrbitYaw};
use crate::autopilot::{AutopilotRequest, FlightMode, RequestOutcome, TurnCommand};
use crate::endpoint::flavour::ModeRow;
use crate::endpoint::{CommandContext, FailureInjection};
use crate::faults::{FailureType, FailureUnit, Faults};
use mavlink::MessageData;
use spandrel_mavlink::dialect::{GPS_GLOBAL_ORIGIN_DATA, HOME_POSITION_DATA, MISSION_CURRENT_DATA, MavCmd, MavResult};
use spandrel_model::math;

/// MAV_CMD_DO_JUMP_TAG; defined here because not every dialect has it.
const DO_JUMP_TAG: u16 = 601;

/// How a command is handled.
enum Step {
    /// Answered immediately with this result.
    Answer(MavResult),
    /// Forwarded to the autopilot.
    Request(AutopilotRequest),
}

use Step::{Answer, Request};

pub(super) fn handle(c: &VehicleCommand, x: &mut CommandContext) -> Option<MavResult> {
    let mut step = modes(c, x);
    for group in [places, missions, limits, services] {
        step = step.or_else(|| group(c, x));
    }
    let request = match step? {
        Answer(result) => return Some(result),
        Request(request) => request,
    };
    let outcome = x.autopilot.request(request, x.view.now);
    if matches!(request, AutopilotRequest::SetHome(_)) && outcome == RequestOutcome::Accepted && x.view.flavour.home_item {
        x.payload.changes.add_message(GPS_GLOBAL_ORIGIN_DATA::ID);
        x.payload.changes.add_message(HOME_POSITION_DATA::ID);
    }
    Some(result(outcome, x))
}

/// Arming and modes.
fn modes(c: &VehicleCommand, x: &mut CommandContext) -> Option<Step> {
    use MavCmd as M;
    Some(match c.number {
        n if n == M::MAV_CMD_COMPONENT_ARM_DISARM as u16 => match arm(c, x) {
            Some(AutopilotRequest::Arm { force }) => Answer(arm_motors(c, force, x)),
            Some(other) => Request(other),
            None => Answer(x.deny("Arming: parameter 1 must be 1 (arm) or 0 (disarm)")),
        },
        n if n == M::MAV_CMD_DO_SET_MODE as u16 => Answer(set_mode(c, x)),
        n if n == M::MAV_CMD_DO_SET_STANDARD_MODE as u16 => {
            let row = c.finite_param(0).and_then(|number| x.view.flavour.standard(number as u32));
            Answer(match row {
                Some(row) => enter(row, x),
                None => x.deny(&format!("No such standard mode {}", c.p[0])),
            })
        }
        n if n == M::MAV_CMD_NAV_RETURN_TO_LAUNCH as u16 => Request(AutopilotRequest::SetMode(FlightMode::Return)),
        n if n == M::MAV_CMD_NAV_LOITER_UNLIM as u16 => {
            let flavour = x.view.flavour;
            let row =
                flavour.loiters.and_then(|number| flavour.row(number)).unwrap_or_else(|| flavour.default_mode(FlightMode::Hold));
            Answer(enter(row, x))
        }
        n if n == M::MAV_CMD_DO_FLIGHTTERMINATION as u16 => match c.p[0] {
            p if p > 0.5 => Request(AutopilotRequest::Disarm { force: true }),
            0.0 => Answer(MavResult::MAV_RESULT_ACCEPTED),
            _ => Answer(MavResult::MAV_RESULT_DENIED),
        },
        _ => return None,
    })
}

/// Takeoff, landing and go-to commands.
fn places(c: &VehicleCommand, x: &mut CommandContext) -> Option<Step> {
    use MavCmd as M;
    Some(match c.number {
        n if n == M::MAV_CMD_NAV_TAKEOFF as u16 => match (x.view.flavour.take_off)(c, x) {
            Ok(height_m) => Request(AutopilotRequest::Takeoff { height_m }),
            Err(refusal) => Answer(refusal),
        },
        n if n == M::MAV_CMD_NAV_LAND as u16 => Request(AutopilotRequest::Land),
        n if n == M::MAV_CMD_NAV_VTOL_LAND as u16 && x.view.flavour.home_item => Request(AutopilotRequest::Land),
        n if n == M::MAV_CMD_DO_REPOSITION as u16 => Answer(go(c, x)),
        n if n == M::MAV_CMD_DO_ORBIT as u16 => match orbit(c, x) {
            Some(orbit) => Request(AutopilotRequest::Orbit(orbit)),
            None => Answer(x.deny("Orbit: center within 20 km, yaw behavior 0 to 5")),
        },
        n if n == M::MAV_CMD_CONDITION_YAW as u16 => match turn(c, x) {
            Some(request) => Request(request),
            None => Answer(x.deny("Yaw: angle is not a number")),
        },
        n if n == M::MAV_CMD_DO_SET_HOME as u16 => match home(c, x) {
            Some(request) => Request(request),
            None => Answer(x.deny("Home: latitude, longitude, altitude within 20 km")),
        },
        _ => return None,
    })
}

/// Mission commands: start, pause, jump.
fn missions(c: &VehicleCommand, x: &mut CommandContext) -> Option<Step> {
    use MavCmd as M;
    Some(match c.number {
        // Missions never contain tags, so a lookup always fails.
        DO_JUMP_TAG if x.view.flavour.home_item => {
            let is_tag = c.finite_param(0).is_some_and(|tag| (0.0..=f64::from(u16::MAX)).contains(&tag));
            Answer(if is_tag { MavResult::MAV_RESULT_FAILED } else { MavResult::MAV_RESULT_DENIED })
        }
        n if n == M::MAV_CMD_DO_LAND_START as u16 => {
            let row = x.view.flavour.modes.iter().find(|row| row.request == AutopilotRequest::LandingSequence)?;
            Answer(enter(row, x))
        }
        n if n == M::MAV_CMD_DO_PAUSE_CONTINUE as u16 && x.view.flavour.pauses => Answer(pause(c, x)),
        n if n == M::MAV_CMD_DO_PAUSE_CONTINUE as u16 => Request(if c.is_one(0) {
            AutopilotRequest::StartMission { first: None }
        } else {
            AutopilotRequest::SetMode(FlightMode::Hold)
        }),
        n if n == M::MAV_CMD_MISSION_START as u16 => {
            // ArduPilot always starts a mission from its first item.
            if x.view.flavour.home_item && c.p[..2].iter().any(|item| *item != 0.0) {
                return Some(Answer(x.deny("Mission start: first and last item are not supported")));
            }
            Request(AutopilotRequest::StartMission { first: c.finite_param(0).filter(|f| *f > 0.0).map(|f| index(f, x)) })
        }
        n if n == M::MAV_CMD_DO_SET_MISSION_CURRENT as u16 => {
            Answer(if set_current(c, x) { MavResult::MAV_RESULT_ACCEPTED } else { x.deny("No such mission item") })
        }
        _ => return None,
    })
}

/// Speed and geofence commands.
fn limits(c: &VehicleCommand, x: &mut CommandContext) -> Option<Step> {
    use MavCmd as M;
    Some(match c.number {
        // Climb and descent speeds have parameters of their own.
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 && c.finite_param(0).is_some_and(|kind| kind > 1.0) => {
            Answer(x.deny("Speed: types 0, 1; set climb rates by parameters"))
        }
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 => match c.finite_param(1) {
            // -1 means no change, -2 restores the parameter's value (MAVLink common).
            Some(-1.0) => Answer(MavResult::MAV_RESULT_ACCEPTED),
            Some(-2.0) => Request(AutopilotRequest::SetSpeed(None)),
            Some(speed) if speed > 0.0 => Request(AutopilotRequest::SetSpeed(Some(speed))),
            _ => Answer(x.deny("Speed: above 0 m/s, -1 no change, -2 default")),
        },
        n if n == M::MAV_CMD_DO_FENCE_ENABLE as u16 => match c.p[0] {
            0.0 => Request(AutopilotRequest::EnableFence(false)),
            1.0 => Request(AutopilotRequest::EnableFence(true)),
            _ => Answer(x.deny("Fence: 0 disables, 1 enables")),
        },
        _ => return None,
    })
}

/// Commands that don't involve the autopilot: failure injection, calibration, storage, checks, reboot.
fn services(c: &VehicleCommand, x: &mut CommandContext) -> Option<Step> {
    use MavCmd as M;
    Some(Answer(match c.number {
        n if n == M::MAV_CMD_INJECT_FAILURE as u16 => inject(c, x),
        n if n == M::MAV_CMD_PREFLIGHT_CALIBRATION as u16 => calibration::command(c, x),
        n if n == M::MAV_CMD_PREFLIGHT_STORAGE as u16 => storage::preflight(c, x),
        n if n == M::MAV_CMD_RUN_PREARM_CHECKS as u16 => checks(x),
        n if n == M::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16 => reboot(c, x),
        _ => return None,
    }))
}

/// Parameters 1 unit, 2 failure type, 3 instance. As in PX4, denied unless SYS_FAILURE_EN is set.
fn inject(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    if x.params.whole("SYS_FAILURE_EN") != Some(1) {
        x.warn_all("Failure injection is off (SYS_FAILURE_EN)");
        return MavResult::MAV_RESULT_DENIED;
    }
    let whole = |k: usize| c.finite_param(k).map(|value| value as i64);
    let (unit, kind) = (whole(0).and_then(FailureUnit::from_number), whole(1).and_then(FailureType::from_number));
    let (Some(unit), Some(kind)) = (unit, kind) else { return MavResult::MAV_RESULT_UNSUPPORTED };
    let instance = usize::try_from(whole(2).unwrap_or(0)).unwrap_or(usize::MAX);
    let rotors = x.view.vehicle.rotors.len();
    let cells = x.view.vehicle.battery.cells as usize;
    if unit == FailureUnit::Battery && instance > cells {
        x.warn_all(&format!("No battery cell {instance} (1 to {cells}, 0: whole pack)"));
        return MavResult::MAV_RESULT_DENIED;
    }
    if !Faults::new(0).inject(unit, kind, instance, rotors) {
        return MavResult::MAV_RESULT_UNSUPPORTED;
    }
    x.faults.push_back(FailureInjection { unit, kind, instance });
    MavResult::MAV_RESULT_ACCEPTED
}

/// Parameter 1: 0 does nothing, 1 and 3 reboot the autopilot. A client cannot shut the simulated vehicle down.
fn reboot(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    match c.p[0] {
        0.0 => MavResult::MAV_RESULT_ACCEPTED,
        1.0 | 3.0 if x.view.status.armed => {
            x.warn_all("Reboot denied: armed");
            x.view.flavour.refusals.for_now
        }
        1.0 | 3.0 => {
            *x.restart = true;
            MavResult::MAV_RESULT_ACCEPTED
        }
        _ => MavResult::MAV_RESULT_DENIED,
    }
}

fn arm(c: &VehicleCommand, x: &CommandContext) -> Option<AutopilotRequest> {
    let force = x.view.flavour.force.iter().any(|number| (c.p[1] - number).abs() < 0.5);
    match c.p[0] {
        p if (p - 1.0).abs() < 1e-6 => Some(AutopilotRequest::Arm { force }),
        0.0 => Some(AutopilotRequest::Disarm { force }),
        _ => None,
    }
}

/// Arms the motors. If the flavour reports them, each failed check is sent as a separate text. In the mode that accepts go-to
/// commands (GUIDED), arming by a transmitter switch must be allowed (`GUID_OPTIONS`).
fn arm_motors(c: &VehicleCommand, force: bool, x: &mut CommandContext) -> MavResult {
    let (flavour, now) = (x.view.flavour, x.view.now);
    if let Some(words) = flavour.arm_words
        && !x.autopilot.status().armed
    {
        let row = flavour.row_of(x.autopilot.status().mode, *x.requested_mode);
        let mut reasons = if force { Vec::new() } else { x.autopilot.arming_reasons(now) };
        let allowed = row.armable || row.mode == FlightMode::Mission && x.params.arms_in_auto();
        let by_transmitter = c.own && x.in_guided_mode();
        let allowed = allowed && (!by_transmitter || x.autopilot.tuning.rules.guided.transmitter_arms);
        if !allowed && !force {
            reasons.insert(0, format!("{} mode not armable", row.name.to_uppercase()));
        }
        if !reasons.is_empty() {
            reasons.iter().for_each(|reason| x.warn_all(&format!("{words}{reason}")));
            return flavour.refusals.for_now;
        }
    }
    let outcome = x.autopilot.request(AutopilotRequest::Arm { force }, now);
    result(outcome, x)
}

fn enter(row: &ModeRow, x: &mut CommandContext) -> MavResult {
    let outcome = x.view.flavour.enter(row, x.requested_mode, x.autopilot, x.view.now);
    result(outcome, x)
}

/// Only the custom mode is used; the other bits of base_mode are ignored.
fn set_mode(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    let custom = c.finite_param(0).is_some_and(|base| (base as i64) & 1 == 1);
    let Some(main) = c.finite_param(1).filter(|_| custom) else {
        x.warn_all("No custom mode specified");
        return MavResult::MAV_RESULT_DENIED;
    };
    let number = (x.view.flavour.custom_mode)(main, c.finite_param(2).unwrap_or(0.0));
    match x.view.flavour.row(number) {
        Some(row) => enter(row, x),
        None => {
            x.warn_all(&format!("No such mode {main}"));
            x.view.flavour.refusals.no_mode
        }
    }
}

/// Converts a mission sequence number to the autopilot's item index.
fn index(seq: f64, x: &CommandContext) -> usize {
    (seq as usize).saturating_sub(usize::from(x.view.plans.lead))
}

/// Parameter 1 is the item, -1 the current one (rejected by ArduPilot); 1 in parameter 2 resets the mission's progress.
/// Broadcasts MISSION_CURRENT, as MISSION_SET_CURRENT does.
fn set_current(c: &VehicleCommand, x: &mut CommandContext) -> bool {
    let item = match c.finite_param(0) {
        Some(-1.0) if !x.view.flavour.home_item => x.autopilot.status().mission_current,
        Some(seq) if seq >= 0.0 => index(seq, x),
        _ => return false,
    };
    let set = x.autopilot.set_mission_current(item, c.is_one(1));
    if set {
        x.payload.changes.add_message(MISSION_CURRENT_DATA::ID);
    }
    set
}

/// DO_REPOSITION. If the flavour has a go-to mode (GUIDED), it must be active, or parameter 2 must request the change
/// (MAV_DO_REPOSITION_FLAGS_CHANGE_MODE).
fn go(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    let changes = c.finite_param(1).is_some_and(|flags| (flags as i64) & 1 == 1);
    let errands = x.view.flavour.errands;
    if !(errands.is_none() || changes || x.in_guided_mode()) {
        return x.deny("Go-to: not allowed in this mode");
    }
    let Some(request) = reposition(c, x) else { return x.deny("Go-to: beyond 20 km or unknown frame") };
    let outcome = x.autopilot.request(request, x.view.now);
    if outcome == RequestOutcome::Accepted {
        *x.requested_mode = errands.unwrap_or(*x.requested_mode);
    }
    result(outcome, x)
}

fn reposition(c: &VehicleCommand, x: &CommandContext) -> Option<AutopilotRequest> {
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let origin = x.view.plane.origin();
    let relative = c.is_home_relative()?;
    let up_m = c.finite_param(6).map(|z| if relative { home_up + z } else { z - origin.altitude_m });
    let north_east_m = match (c.finite_param(4), c.finite_param(5)) {
        (Some(lat), Some(lon)) => {
            if lat.abs() > 90.0 || lon.abs() > 180.0 {
                return None;
            }
            let geo = spandrel_model::geodesy::Geo { latitude_deg: lat, longitude_deg: lon, altitude_m: origin.altitude_m };
            let local = x.view.plane.enu_from_geo(geo);
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

/// Pauses or resumes. Flavours with this command can pause only missions and go-to commands.
fn pause(c: &VehicleCommand, x: &mut CommandContext) -> MavResult {
    let pausable = x.in_guided_mode() || x.autopilot.status().mode == FlightMode::Mission;
    let pause = match c.p[0] {
        0.0 => true,
        1.0 => false,
        _ => return MavResult::MAV_RESULT_DENIED,
    };
    let failed = || RequestOutcome::Failed(if pause { "Failed to pause" } else { "Failed to resume" }.into());
    let outcome = if pausable { x.autopilot.request(AutopilotRequest::Pause(pause), x.view.now) } else { failed() };
    result(outcome, x)
}

/// ORBIT_YAW_BEHAVIOUR_UNCHANGED.
const YAW_UNCHANGED: i64 = 5;

/// Parameters 1 radius, 2 speed, 3 yaw behavior, 4 arc in radians, 5 to 7 center.
fn orbit(c: &VehicleCommand, x: &CommandContext) -> Option<OrbitRequest> {
    let AutopilotRequest::GoTo { north_east_m, up_m, .. } = reposition(c, x)? else { return None };
    let yaw = match c.finite_param(2).map(|number| number.round() as i64) {
        None | Some(YAW_UNCHANGED) => None,
        Some(number) => Some(OrbitYaw::from_number(number)?),
    };
    let arc_rad = c.finite_param(3).unwrap_or(0.0).abs();
    Some(OrbitRequest { centre_m: north_east_m, up_m, radius_m: c.finite_param(0), speed_m_s: c.finite_param(1), yaw, arc_rad })
}

/// Parameters 1 angle in degrees, 2 rate in deg/s (0: default), 3 direction, 4 whether relative to the current heading.
fn turn(c: &VehicleCommand, x: &CommandContext) -> Option<AutopilotRequest> {
    let angle = c.finite_param(0)?.to_radians();
    let relative = c.is_one(3);
    let signed = if c.p[2] < 0.0 { -angle } else { angle };
    let now = x.view.estimate.attitude.yaw_rad();
    let rate_rad_s = c.finite_param(1).filter(|rate| *rate > 0.0).map(f64::to_radians);
    let clockwise = c.finite_param(2).filter(|direction| *direction != 0.0).map(|direction| direction > 0.0);
    let yaw_rad = math::wrap_pi(if relative { now + signed } else { angle });
    Some(AutopilotRequest::Turn(TurnCommand { yaw_rad, rate_rad_s, clockwise }))
}

fn home(c: &VehicleCommand, x: &CommandContext) -> Option<AutopilotRequest> {
    let unnamed = x.view.flavour.zero_is_here && c.p[4] == 0.0 && c.p[5] == 0.0;
    if c.is_one(0) || unnamed {
        return x.view.estimate.position_valid.then_some(AutopilotRequest::SetHome(x.view.estimate.position_m));
    }
    let (lat, lon, alt) = (c.finite_param(4)?, c.finite_param(5)?, c.finite_param(6)?);
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let alt = if c.is_home_relative()? { x.view.plane.origin().altitude_m + home_up + alt } else { alt };
    let geo = spandrel_mavlink::units::geo(spandrel_mavlink::units::deg_e7(lat), spandrel_mavlink::units::deg_e7(lon), alt)?;
    let local = x.view.plane.enu_from_geo(geo);
    (local.norm() < 20_000.0).then(|| AutopilotRequest::SetHome(local.ned()))
}

fn checks(x: &mut CommandContext) -> MavResult {
    *x.report = true;
    let reasons = x.view.status.arming_reasons.clone();
    for reason in &reasons {
        x.warn_all(&format!("{}{reason}", x.view.flavour.check_words));
    }
    MavResult::MAV_RESULT_ACCEPTED
}
