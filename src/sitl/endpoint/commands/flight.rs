//! Arming, modes, take-off, go-to, landing.

use super::super::{px4, storage};
use super::{Command, result};
use crate::mav::dialect::{MavCmd, MavResult};
use crate::sitl::autopilot::orbit::{OrbitWish, OrbitYaw};
use crate::sitl::autopilot::{Mode, Request};
use crate::sitl::endpoint::{Context, Injection};
use crate::sitl::faults::{Faults, Kind, Unit};

/// The number that forces arming and disarming (MAVLink common, COMPONENT_ARM_DISARM param2).
const FORCE: f64 = 21196.0;

pub(super) fn handle(c: &Command, x: &mut Context) -> Option<MavResult> {
    use MavCmd as M;
    const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
    let request = match c.number {
        n if n == M::MAV_CMD_COMPONENT_ARM_DISARM as u16 => arm(c)?,
        n if n == M::MAV_CMD_DO_SET_MODE as u16 => return Some(set_mode(c, x)),
        n if n == M::MAV_CMD_DO_SET_STANDARD_MODE as u16 => match standard_mode(c) {
            Some(mode) => Request::SetMode(mode),
            None => return Some(DENIED),
        },
        n if n == M::MAV_CMD_NAV_TAKEOFF as u16 => match take_off_height(c, x) {
            Ok(height_m) => Request::Takeoff { height_m },
            Err(()) => return Some(DENIED),
        },
        n if n == M::MAV_CMD_NAV_LAND as u16 => Request::Land,
        n if n == M::MAV_CMD_NAV_RETURN_TO_LAUNCH as u16 => Request::SetMode(Mode::Return),
        n if n == M::MAV_CMD_NAV_LOITER_UNLIM as u16 => Request::SetMode(Mode::Hold),
        n if n == M::MAV_CMD_DO_REPOSITION as u16 => match reposition(c, x) {
            Some(request) => request,
            None => return Some(DENIED),
        },
        n if n == M::MAV_CMD_DO_PAUSE_CONTINUE as u16 => {
            if c.is_one(0) {
                Request::StartMission { first: None }
            } else {
                Request::SetMode(Mode::Hold)
            }
        }
        n if n == M::MAV_CMD_MISSION_START as u16 => {
            Request::StartMission { first: c.given(0).filter(|f| *f > 0.0).map(|f| f as usize) }
        }
        // Climbing and sinking have parameters of their own.
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 && c.given(0).is_some_and(|kind| kind > 1.0) => return Some(DENIED),
        n if n == M::MAV_CMD_DO_CHANGE_SPEED as u16 => match c.given(1) {
            // -1 changes nothing, -2 goes back to the parameter's (MAVLink common).
            Some(-1.0) => return Some(MavResult::MAV_RESULT_ACCEPTED),
            Some(-2.0) => Request::SetSpeed(x.params.cruise_m_s()),
            Some(speed) if speed > 0.0 => Request::SetSpeed(speed),
            _ => return Some(DENIED),
        },
        n if n == M::MAV_CMD_DO_ORBIT as u16 => match orbit(c, x) {
            Some(wish) => Request::Orbit(wish),
            None => return Some(DENIED),
        },
        n if n == M::MAV_CMD_CONDITION_YAW as u16 => turn(c, x)?,
        n if n == M::MAV_CMD_DO_SET_HOME as u16 => match home(c, x) {
            Some(request) => request,
            None => return Some(DENIED),
        },
        n if n == M::MAV_CMD_DO_FENCE_ENABLE as u16 => match c.p[0] {
            0.0 => Request::EnableFence(false),
            1.0 => Request::EnableFence(true),
            _ => return Some(DENIED),
        },
        n if n == M::MAV_CMD_DO_FLIGHTTERMINATION as u16 => match c.p[0] {
            p if p > 0.5 => Request::Disarm { force: true },
            0.0 => return Some(MavResult::MAV_RESULT_ACCEPTED),
            _ => return Some(DENIED),
        },
        n if n == M::MAV_CMD_INJECT_FAILURE as u16 => return Some(inject(c, x)),
        n if n == M::MAV_CMD_PREFLIGHT_STORAGE as u16 => return Some(storage::preflight(c, x)),
        n if n == M::MAV_CMD_RUN_PREARM_CHECKS as u16 => return Some(checks(x)),
        n if n == M::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16 => {
            return Some(reboot(c, x));
        }
        n if n == M::MAV_CMD_DO_SET_MISSION_CURRENT as u16 => {
            let known = c.given(0).is_some_and(|seq| seq >= 0.0 && x.autopilot.set_mission_current(seq as usize));
            return Some(if known { MavResult::MAV_RESULT_ACCEPTED } else { DENIED });
        }
        _ => return None,
    };
    let outcome = x.autopilot.request(request, x.view.now);
    Some(result(outcome, x))
}

/// Parameters 1 unit, 2 kind, 3 instance. As in PX4 nothing happens unless SYS_FAILURE_EN allows it.
fn inject(c: &Command, x: &mut Context) -> MavResult {
    if x.params.whole("SYS_FAILURE_EN") != Some(1) {
        x.tell("Failure injection is off (SYS_FAILURE_EN)");
        return MavResult::MAV_RESULT_DENIED;
    }
    let whole = |k: usize| c.given(k).map(|value| value as i64);
    let (unit, kind) = (whole(0).and_then(Unit::from_number), whole(1).and_then(Kind::from_number));
    let (Some(unit), Some(kind)) = (unit, kind) else { return MavResult::MAV_RESULT_UNSUPPORTED };
    let instance = usize::try_from(whole(2).unwrap_or(0)).unwrap_or(usize::MAX);
    let rotors = x.view.vehicle.rotors.len();
    if !Faults::new(0).inject(unit, kind, instance, rotors) {
        return MavResult::MAV_RESULT_UNSUPPORTED;
    }
    x.faults.push_back(Injection { unit, kind, instance });
    MavResult::MAV_RESULT_ACCEPTED
}

/// Parameter 1: 0 nothing, 1 and 3 the autopilot starts again; a simulated vehicle is not shut down by a client.
fn reboot(c: &Command, x: &mut Context) -> MavResult {
    match c.p[0] {
        0.0 => MavResult::MAV_RESULT_ACCEPTED,
        1.0 | 3.0 if x.view.status.armed => {
            x.tell("Reboot denied: armed");
            MavResult::MAV_RESULT_TEMPORARILY_REJECTED
        }
        1.0 | 3.0 => {
            *x.restart = true;
            MavResult::MAV_RESULT_ACCEPTED
        }
        _ => MavResult::MAV_RESULT_DENIED,
    }
}

fn arm(c: &Command) -> Option<Request> {
    let force = (c.p[1] - FORCE).abs() < 0.5;
    match c.p[0] {
        p if (p - 1.0).abs() < 1e-6 => Some(Request::Arm { force }),
        0.0 => Some(Request::Disarm { force }),
        _ => None,
    }
}

fn set_mode(c: &Command, x: &mut Context) -> MavResult {
    // Only the custom mode counts; the bits of base_mode beside it are the vehicle's own business.
    let custom = c.given(0).is_some_and(|base| (base as i64) & 1 == 1);
    let mode = match (custom, c.given(1), c.given(2)) {
        (true, Some(main), sub) => px4::from_numbers(main as u32, sub.unwrap_or(0.0) as u32),
        _ => None,
    };
    match mode {
        Some(mode) => {
            let outcome = x.autopilot.request(Request::SetMode(mode), x.view.now);
            result(outcome, x)
        }
        None => {
            x.tell("No such mode");
            MavResult::MAV_RESULT_DENIED
        }
    }
}

fn standard_mode(c: &Command) -> Option<Mode> {
    let wanted = c.given(0)? as u32;
    if wanted == 0 {
        return None;
    }
    px4::MODES.iter().find(|row| row.standard as u32 == wanted).map(|row| row.mode)
}

/// Whether a command's height counts from home; `None` for a frame that is no place over the ground.
fn over_home(c: &Command) -> Option<bool> {
    match c.frame {
        0 | 5 => Some(false),
        3 | 6 | 10 | 11 => Some(true),
        _ => None,
    }
}

/// Height over home: parameter 7 is over the sea; not given or too near the ground, the parameter's height.
fn take_off_height(c: &Command, x: &Context) -> Result<Option<f64>, ()> {
    const LOWEST_M: f64 = 0.5;
    const HIGHEST_M: f64 = 500.0;
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let relative = over_home(c).ok_or(())?;
    let Some(z) = c.given(6) else { return Ok(None) };
    let height_m = if relative { z } else { z - x.view.plane.origin().altitude_m - home_up };
    if height_m > HIGHEST_M { Err(()) } else { Ok(Some(height_m).filter(|h| *h >= LOWEST_M)) }
}

fn reposition(c: &Command, x: &Context) -> Option<Request> {
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let origin = x.view.plane.origin();
    let relative = over_home(c)?;
    let up_m = c.given(6).map(|z| if relative { home_up + z } else { z - origin.altitude_m });
    let north_east_m = match (c.given(4), c.given(5)) {
        (Some(lat), Some(lon)) => {
            if lat.abs() > 90.0 || lon.abs() > 180.0 {
                return None;
            }
            let geo = crate::base::geodesy::Geo { latitude_deg: lat, longitude_deg: lon, altitude_m: origin.altitude_m };
            let local = x.view.plane.enu_from_geo(geo);
            if local.norm() > 20_000.0 {
                return None;
            }
            Some((local.north(), local.east()))
        }
        _ => None,
    };
    let speed_m_s = c.given(0).filter(|s| *s > 0.0);
    Some(Request::GoTo { north_east_m, up_m, yaw_rad: c.given(3), speed_m_s })
}

/// Parameters 1 radius, 2 speed, 3 where the nose points, 4 how far round in radians, 5 to 7 the middle.
fn orbit(c: &Command, x: &Context) -> Option<OrbitWish> {
    let Request::GoTo { north_east_m, up_m, .. } = reposition(c, x)? else { return None };
    let yaw = c.given(2).map_or(Some(OrbitYaw::Centre), |number| OrbitYaw::from_number(number as i64))?;
    let arc_rad = c.given(3).unwrap_or(0.0).abs();
    Some(OrbitWish { centre_m: north_east_m, up_m, radius_m: c.given(0), speed_m_s: c.given(1), yaw, arc_rad })
}

fn turn(c: &Command, x: &Context) -> Option<Request> {
    let angle = c.given(0)?.to_radians();
    let relative = c.is_one(3);
    let signed = if c.p[2] < 0.0 { -angle } else { angle };
    let now = x.view.estimate.attitude.yaw_rad();
    Some(Request::Turn { yaw_rad: if relative { now + signed } else { angle } })
}

fn home(c: &Command, x: &Context) -> Option<Request> {
    if c.is_one(0) {
        return x.view.estimate.position_valid.then_some(Request::SetHome(x.view.estimate.position_m));
    }
    let (lat, lon, alt) = (c.given(4)?, c.given(5)?, c.given(6)?);
    let home_up = x.view.status.home_m.map_or(0.0, |h| -h.down());
    let alt = if over_home(c)? { x.view.plane.origin().altitude_m + home_up + alt } else { alt };
    let geo = crate::mav::units::geo(crate::mav::units::deg_e7(lat), crate::mav::units::deg_e7(lon), alt)?;
    let local = x.view.plane.enu_from_geo(geo);
    (local.norm() < 20_000.0).then(|| Request::SetHome(local.ned()))
}

fn checks(x: &mut Context) -> MavResult {
    let reasons = x.view.status.arming_reasons.clone();
    for reason in &reasons {
        x.tell(&format!("Preflight Fail: {reason}"));
    }
    MavResult::MAV_RESULT_ACCEPTED
}
