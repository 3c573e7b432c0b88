//! Messages that steer: sticks, modes, external set-points, the gimbal.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::Endpoint;
use super::arrival::Arrival;
use super::buttons::{self, Seen};
use super::commands;
use super::gimbal::{Aim, DEVICE, Gimbal};
use super::offboard::{self, Reading};
use crate::base::frames::{Frd, Ned, Rotation};
use crate::mav::dialect::{
    GIMBAL_DEVICE_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA,
    GIMBAL_MANAGER_SET_PITCHYAW_DATA, HEARTBEAT_DATA, MANUAL_CONTROL_DATA, MavModeFlag, MavResult, MavSeverity, MavType,
    RC_CHANNELS_OVERRIDE_DATA, SET_ATTITUDE_TARGET_DATA, SET_MODE_DATA, SET_POSITION_TARGET_GLOBAL_INT_DATA,
    SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use crate::sitl::autopilot::{Landed, Mode, Outcome, Request};

pub(super) fn heartbeat(_: &mut Endpoint, beat: &HEARTBEAT_DATA, a: &mut Arrival) {
    if beat.mavtype == MavType::MAV_TYPE_GCS {
        a.autopilot.ground_station_alive(a.view.now);
    }
}

pub(super) fn manual_control(e: &mut Endpoint, m: &MANUAL_CONTROL_DATA, a: &mut Arrival) {
    if !e.sticks_pass {
        return;
    }
    let from = (a.link, a.from);
    if let Some(sticks) = e.manual.manual_control(from, m, a.view.now) {
        a.autopilot.sticks(sticks, a.view.now);
    }
    if let Some(pitch) = e.manual.gimbal(from, m)
        && let Some(gimbal) = gimbal(e, DEVICE, a)
    {
        let camera = &a.view.vehicle.camera;
        gimbal.set(Gimbal::deflected(camera, pitch), camera);
    }
    if e.manual.is_holder(from) {
        press_buttons(e, m, a);
    }
    tell_hands(e);
}

pub(super) fn channels(e: &mut Endpoint, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut Arrival) {
    if !e.sticks_pass {
        return;
    }
    if let Some(sticks) = e.manual.channels((a.link, a.from), c, a.view.now) {
        a.autopilot.sticks(sticks, a.view.now);
    }
    tell_hands(e);
}

fn press_buttons(e: &mut Endpoint, m: &MANUAL_CONTROL_DATA, a: &mut Arrival) {
    for button in e.manual.presses.of(m) {
        let camera = &a.view.vehicle.camera;
        let seen = Seen {
            lamp_on: e.payload.lamp.on,
            pitch_deg: e.payload.gimbal.pitch_rad.to_degrees(),
            reach_deg: (camera.gimbal_pitch_min_rad.to_degrees(), camera.gimbal_pitch_max_rad.to_degrees()),
            take_off_m: a.autopilot.tuning.takeoff_height_m,
        };
        let Some(command) = buttons::command(button, &e.params, &seen, a.from) else { continue };
        let refused = e.obey(&command, a).is_some_and(|result| result != MavResult::MAV_RESULT_ACCEPTED);
        if refused && commands::payload::handles(&command) {
            let why = commands::payload::why(&command, a.view, &e.payload);
            e.tell(MavSeverity::MAV_SEVERITY_CRITICAL, &format!("Button: {why}"));
        }
    }
}

/// Every change of hands is told to everybody.
fn tell_hands(e: &mut Endpoint) {
    while let Some(text) = e.manual.poll_text() {
        e.tell(MavSeverity::MAV_SEVERITY_NOTICE, &text);
    }
}

pub(super) fn set_mode(e: &mut Endpoint, m: &SET_MODE_DATA, a: &mut Arrival) {
    if !e.flavour.custom_flag || m.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED) {
        enter_mode(e, m.custom_mode, a);
    }
}

/// SET_MODE has no acknowledgement: a refusal becomes a text.
pub(super) fn enter_mode(e: &mut Endpoint, custom_mode: u32, a: &mut Arrival) {
    let outcome = match e.flavour.row(custom_mode) {
        Some(row) => e.flavour.enter(row, &mut e.chosen, a.autopilot, a.view.now),
        None => Outcome::Denied(format!("No such mode {custom_mode}")),
    };
    if let Outcome::TemporarilyRejected(reason) | Outcome::Denied(reason) | Outcome::Failed(reason) = outcome {
        e.tell(MavSeverity::MAV_SEVERITY_CRITICAL, &reason);
    }
}

/// A set-point that cannot be flown is told, and does not count as one.
fn fly(e: &mut Endpoint, reading: Reading, a: &mut Arrival) {
    match reading {
        Ok(setpoint) => {
            a.autopilot.offboard(setpoint, a.view.now);
            follow(e, a);
        }
        Err(why) => e.complain(why, a.view.now),
    }
}

/// Where a mode flies errands as they come, a set-point in it is flown without being asked for, and ends a take-off that has left the ground.
fn follow(e: &Endpoint, a: &mut Arrival) {
    let status = a.autopilot.status();
    let here = Some(e.flavour.row_of(status.mode, e.chosen).number) == e.flavour.errands;
    let waits = matches!(status.mode, Mode::Hold | Mode::Takeoff) && status.landed == Landed::InAir;
    if here && waits && status.failsafe.is_none() {
        a.autopilot.request(Request::SetMode(Mode::Offboard), a.view.now);
    }
}

pub(super) fn local_target(e: &mut Endpoint, t: &SET_POSITION_TARGET_LOCAL_NED_DATA, a: &mut Arrival) {
    fly(e, offboard::local(t, a.view), a);
}

pub(super) fn global_target(e: &mut Endpoint, t: &SET_POSITION_TARGET_GLOBAL_INT_DATA, a: &mut Arrival) {
    fly(e, offboard::global(t, a.view), a);
}

pub(super) fn attitude_target(e: &mut Endpoint, t: &SET_ATTITUDE_TARGET_DATA, a: &mut Arrival) {
    fly(e, offboard::attitude(t), a);
}

/// The gimbal as the message's sender may move it: none for another device, or while somebody else is in control.
fn gimbal<'e>(e: &'e mut Endpoint, device: u8, a: &Arrival) -> Option<&'e mut Gimbal> {
    let gimbal = &mut e.payload.gimbal;
    (matches!(device, 0 | DEVICE) && gimbal.obeys(a.from)).then_some(gimbal)
}

/// Flags of the manager and of the device that have the same numbers: RETRACT and NEUTRAL (MAVLink common).
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;

/// An angle, at a rate or as fast as can be, or a rate alone, radians. Aims out of reach go to the stop, as a stick does; this gimbal does
/// not retract.
fn move_gimbal(gimbal: &mut Gimbal, flags: u32, (pitch_rad, rate_rad_s): (f32, f32), a: &Arrival) {
    let camera = &a.view.vehicle.camera;
    let number = |value: f32| Some(f64::from(value)).filter(|value| value.is_finite());
    let pitch = number(pitch_rad).map(|pitch| pitch.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad));
    let aim = if flags & NEUTRAL != 0 { Some(Aim::Neutral) } else { Aim::of(pitch, number(rate_rad_s)) };
    if let Some(aim) = aim.filter(|_| flags & RETRACT == 0) {
        gimbal.set(aim, camera);
    }
}

/// Pitch of a quaternion that is given, NaN where none is.
fn pitch_of(q: [f32; 4]) -> f32 {
    Rotation::<Frd, Ned>::from_wxyz(q.map(f64::from)).map_or(f32::NAN, |attitude| attitude.euler().1 as f32)
}

pub(super) fn gimbal_attitude(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_ATTITUDE_DATA, a: &mut Arrival) {
    if let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

/// The device's own message, from whom the manager would obey.
pub(super) fn gimbal_device(e: &mut Endpoint, m: &GIMBAL_DEVICE_SET_ATTITUDE_DATA, a: &mut Arrival) {
    if let Some(gimbal) = gimbal(e, DEVICE, a) {
        move_gimbal(gimbal, u32::from(m.flags.bits()), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

pub(super) fn gimbal_pitch_yaw(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_PITCHYAW_DATA, a: &mut Arrival) {
    if let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (m.pitch, m.pitch_rate), a);
    }
}

pub(super) fn gimbal_manual(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA, a: &mut Arrival) {
    let camera = &a.view.vehicle.camera;
    let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) else { return };
    if m.flags.bits() & (RETRACT | NEUTRAL) != 0 {
        move_gimbal(gimbal, m.flags.bits(), (f32::NAN, f32::NAN), a);
    } else if m.pitch.is_finite() {
        gimbal.set(Gimbal::deflected(camera, f64::from(m.pitch)), camera);
    } else if m.pitch_rate.is_finite() {
        let rate = f64::from(m.pitch_rate).clamp(-1.0, 1.0) * camera.gimbal_rate_rad_s;
        gimbal.set(Aim::Rate(rate), camera);
    }
}
