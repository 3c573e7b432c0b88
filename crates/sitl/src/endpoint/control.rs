//! Messages that control the vehicle: sticks, modes, offboard setpoints, gimbal.
#![allow(deprecated, reason = "clients still send what MAVLink has superseded")]

use super::Endpoint;
use super::aux_functions;
use super::buttons::{self, ButtonContext};
use super::commands;
use super::gimbal::{DEVICE, GimbalState, GimbalTarget};
use super::inbound::InboundMessage;
use super::manual;
use super::offboard::{self, SetpointResult};
use crate::autopilot::follow::FollowTarget;
use crate::autopilot::{AutopilotRequest, FlightMode, LandedState, RequestOutcome, Sticks};
use spandrel_mavlink::dialect::{
    FOLLOW_TARGET_DATA, GIMBAL_DEVICE_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_ATTITUDE_DATA,
    GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA, GIMBAL_MANAGER_SET_PITCHYAW_DATA, GLOBAL_POSITION_INT_DATA, HEARTBEAT_DATA,
    MANUAL_CONTROL_DATA, MavModeFlag, MavResult, MavSeverity, MavType, RC_CHANNELS_OVERRIDE_DATA, SET_ATTITUDE_TARGET_DATA,
    SET_MODE_DATA, SET_POSITION_TARGET_GLOBAL_INT_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use spandrel_mavlink::units;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

pub(super) fn heartbeat(e: &mut Endpoint, beat: &HEARTBEAT_DATA, a: &mut InboundMessage) {
    if beat.mavtype == MavType::MAV_TYPE_GCS && is_accepted_station(e, a) {
        a.autopilot.ground_station_alive(a.view.now);
    }
}

/// Checks whether the sender is the configured ground station, if a parameter names one.
fn is_accepted_station(e: &Endpoint, a: &InboundMessage) -> bool {
    e.params.ground_station().is_none_or(|system| system == a.from.0)
}

/// Applies stick input. In the mode that accepts go-to commands, the yaw stick does not take over.
fn fly_by_sticks(e: &Endpoint, sticks: Sticks, a: &mut InboundMessage) {
    let row = e.flavour.row_of(a.autopilot.status().mode, e.chosen);
    a.autopilot.note_errands(e.flavour.errands == Some(row.number));
    a.autopilot.sticks(sticks, a.view.now);
}

pub(super) fn manual_control(e: &mut Endpoint, m: &MANUAL_CONTROL_DATA, a: &mut InboundMessage) {
    if !e.sticks_pass || !is_accepted_station(e, a) {
        return;
    }
    let from = (a.link, a.from);
    if let Some(sticks) = e.manual.manual_control(from, m, a.view.now) {
        fly_by_sticks(e, sticks, a);
    }
    if let Some(pitch) = e.manual.gimbal(from, m)
        && let Some(gimbal) = gimbal(e, DEVICE, a)
    {
        let camera = &a.view.vehicle.camera;
        gimbal.set(GimbalState::deflected(camera, pitch), camera);
    }
    if e.manual.is_holder(from) {
        press_buttons(e, m, a);
    }
    announce_stick_changes(e);
}

pub(super) fn channels(e: &mut Endpoint, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    // A receiver signals a lost transmitter by an unusually short throttle pulse; its channels are then ignored.
    let lost = e.params.throttle_loss_us().is_some_and(|least| c.chan3_raw > 0 && c.chan3_raw < least);
    if !e.sticks_pass || !is_accepted_station(e, a) || lost {
        return;
    }
    let from = (a.link, a.from);
    let held = e.manual.is_holder(from);
    if let Some(sticks) = e.manual.channels(from, c, a.view.now) {
        fly_by_sticks(e, sticks, a);
    } else if held && !e.manual.is_holder((a.link, a.from)) {
        a.autopilot.release_sticks();
    }
    e.manual.take_aux(from, c, a.view.now);
    apply_mode_switch(e, c, a);
    aux_functions::read_switches(e, c, a);
    announce_stick_changes(e);
}

/// Upper limits of the first five positions of a six-position mode switch, microseconds (ArduPilot: RC_Channel,
/// read_6pos_switch).
const POSITIONS_US: [u16; 5] = [1230, 1360, 1490, 1620, 1749];
const MODE_OF_POSITION: [&str; 6] = ["FLTMODE1", "FLTMODE2", "FLTMODE3", "FLTMODE4", "FLTMODE5", "FLTMODE6"];

/// Enters the mode assigned to a new position of the mode switch (FLTMODE_CH).
fn apply_mode_switch(e: &mut Endpoint, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    let pulses = manual::aux_of(c);
    let channel = e.params.whole("FLTMODE_CH").and_then(|channel| usize::try_from(channel - 5).ok());
    let Some(pulse) = channel.and_then(|k| pulses.get(k)).filter(|us| manual::PULSES_US.contains(us)) else { return };
    let position = POSITIONS_US.iter().filter(|end| *pulse > **end).count();
    if e.mode_switch.replace(position) == Some(position) {
        return;
    }
    if let Some(mode) = mode_for_switch(e, position) {
        enter_mode(e, mode, a);
    }
}

/// Returns the mode assigned to a position of the mode switch.
pub(super) fn mode_for_switch(e: &Endpoint, position: usize) -> Option<u32> {
    e.params.whole(MODE_OF_POSITION.get(position)?).map(i32::unsigned_abs)
}

/// Handles the position of a follow-me target (PX4, ArduPilot).
pub(super) fn follow_target(_: &mut Endpoint, t: &FOLLOW_TARGET_DATA, a: &mut InboundMessage) {
    // Like PX4, accepts a velocity regardless of the capability bits (MAVSDK sets only the position bit), but ignores a zero
    // velocity without its bit.
    let given = t.est_capabilities & FOLLOW_VELOCITY != 0 || t.vel != [0.0; 3];
    let velocity = Some(t.vel.map(f64::from)).filter(|v| given && v.iter().all(|c| c.is_finite()));
    if t.est_capabilities & FOLLOW_POSITION != 0 {
        report_target(a, (t.lat, t.lon, f64::from(t.alt)), velocity.map(|[n, e, d]| Vec3::new(n, e, d)), None);
    }
}

/// Bits of FOLLOW_TARGET.est_capabilities.
const FOLLOW_POSITION: u8 = 1;
const FOLLOW_VELOCITY: u8 = 2;

/// Handles another vehicle's position for flavours that follow it (ArduPilot: FOLL_SYSID, 0 for any vehicle).
pub(super) fn other_position(e: &mut Endpoint, p: &GLOBAL_POSITION_INT_DATA, a: &mut InboundMessage) {
    let Some(followed) = e.params.whole("FOLL_SYSID") else { return };
    if a.from.0 == e.system_id || (followed != 0 && i32::from(a.from.0) != followed) {
        return;
    }
    let velocity = Vec3::new(f64::from(p.vx), f64::from(p.vy), f64::from(p.vz)) * 0.01;
    let heading_rad = (p.hdg != u16::MAX).then(|| (f64::from(p.hdg) * 0.01).to_radians());
    report_target(a, (p.lat, p.lon, f64::from(p.alt) * 0.001), Some(velocity), heading_rad);
}

fn report_target(
    a: &mut InboundMessage,
    (lat, lon, alt_m): (i32, i32, f64),
    velocity_m_s: Option<Vec3<Ned>>,
    heading_rad: Option<f64>,
) {
    let Some(geo) = units::geo(lat, lon, alt_m).filter(|_| alt_m.is_finite()) else { return };
    let position_m = a.view.plane.enu_from_geo(geo).ned();
    let velocity_m_s = velocity_m_s.unwrap_or_else(|| a.autopilot.target_velocity(position_m, a.view.now));
    if position_m.norm() < FAR_M && velocity_m_s.norm() < FAST_M_S {
        a.autopilot.report_target(FollowTarget { position_m, velocity_m_s, heading_rad }, a.view.now);
    }
}

/// Maximum distance of a target from the origin, m, and maximum speed, m/s; others are ignored.
const FAR_M: f64 = 20_000.0;
const FAST_M_S: f64 = 1_000.0;

fn press_buttons(e: &mut Endpoint, m: &MANUAL_CONTROL_DATA, a: &mut InboundMessage) {
    for button in e.manual.presses.of(m) {
        let camera = &a.view.vehicle.camera;
        let seen = ButtonContext {
            lamp_on: e.payload.lamp.on,
            pitch_deg: e.payload.gimbal.pitch_rad.to_degrees(),
            reach_deg: (camera.gimbal_pitch_min_rad.to_degrees(), camera.gimbal_pitch_max_rad.to_degrees()),
            take_off_m: a.autopilot.tuning.takeoff_height_m,
        };
        let Some(command) = buttons::command(button, &e.params, &seen, a.from) else { continue };
        let refused = e.execute(&command, a).is_some_and(|result| result != MavResult::MAV_RESULT_ACCEPTED);
        if refused && commands::payload::handles(&command) {
            let why = commands::payload::refusal_text(&command, a.view, &e.payload);
            e.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &format!("Button: {why}"));
        }
    }
}

/// Broadcasts every change of the stick control source.
fn announce_stick_changes(e: &mut Endpoint) {
    while let Some(text) = e.manual.poll_text() {
        e.push_text(MavSeverity::MAV_SEVERITY_NOTICE, &text);
    }
}

pub(super) fn set_mode(e: &mut Endpoint, m: &SET_MODE_DATA, a: &mut InboundMessage) {
    if !e.flavour.custom_flag || m.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED) {
        enter_mode(e, m.custom_mode, a);
    }
}

/// Enters a mode. SET_MODE has no acknowledgment, so a rejection is sent as a text.
pub(super) fn enter_mode(e: &mut Endpoint, custom_mode: u32, a: &mut InboundMessage) {
    let outcome = match e.flavour.row(custom_mode) {
        Some(row) => e.flavour.enter(row, &mut e.chosen, a.autopilot, a.view.now),
        None => RequestOutcome::Denied(format!("No such mode {custom_mode}")),
    };
    if let RequestOutcome::TemporarilyRejected(reason) | RequestOutcome::Denied(reason) | RequestOutcome::Failed(reason) = outcome
    {
        e.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &reason);
    }
}

/// Applies a setpoint. Reports and ignores one that cannot be flown.
fn apply_setpoint(e: &mut Endpoint, reading: SetpointResult, a: &mut InboundMessage) {
    match reading {
        Ok(setpoint) => {
            a.autopilot.offboard(setpoint, a.view.now);
            enter_setpoint_mode(e, a);
        }
        Err(why) => e.warn_all(why, a.view.now),
    }
}

/// Enters the setpoint mode if the current mode accepts setpoints directly. A takeoff that has left the ground ends.
fn enter_setpoint_mode(e: &Endpoint, a: &mut InboundMessage) {
    let status = a.autopilot.status();
    let here = Some(e.flavour.row_of(status.mode, e.chosen).number) == e.flavour.errands;
    let waits = matches!(status.mode, FlightMode::Hold | FlightMode::Takeoff) && status.landed == LandedState::InAir;
    if here && waits && status.failsafe.is_none() {
        a.autopilot.request(AutopilotRequest::SetMode(FlightMode::Offboard), a.view.now);
    }
}

pub(super) fn local_target(e: &mut Endpoint, t: &SET_POSITION_TARGET_LOCAL_NED_DATA, a: &mut InboundMessage) {
    apply_setpoint(e, offboard::local(t, a.view), a);
}

pub(super) fn global_target(e: &mut Endpoint, t: &SET_POSITION_TARGET_GLOBAL_INT_DATA, a: &mut InboundMessage) {
    apply_setpoint(e, offboard::global(t, a.view), a);
}

pub(super) fn attitude_target(e: &mut Endpoint, t: &SET_ATTITUDE_TARGET_DATA, a: &mut InboundMessage) {
    apply_setpoint(e, offboard::attitude(t, &a.autopilot.tuning), a);
}

/// Returns the gimbal if the sender may move it; `None` for another device or if another client has control.
fn gimbal<'e>(e: &'e mut Endpoint, device: u8, a: &InboundMessage) -> Option<&'e mut GimbalState> {
    let gimbal = &mut e.payload.gimbal;
    (matches!(device, 0 | DEVICE) && gimbal.accepts_control_from(a.from)).then_some(gimbal)
}

/// Flags with the same values for manager and device: RETRACT and NEUTRAL (MAVLink common).
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;

/// Applies a pitch angle with an optional rate, or a rate alone, radians. Angles out of range are clamped, as for a stick. This
/// gimbal cannot retract.
fn move_gimbal(gimbal: &mut GimbalState, flags: u32, (pitch_rad, rate_rad_s): (f32, f32), a: &InboundMessage) {
    let camera = &a.view.vehicle.camera;
    let number = |value: f32| Some(f64::from(value)).filter(|value| value.is_finite());
    let pitch = number(pitch_rad).map(|pitch| pitch.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad));
    let aim = if flags & NEUTRAL != 0 { Some(GimbalTarget::Neutral) } else { GimbalTarget::of(pitch, number(rate_rad_s)) };
    if let Some(aim) = aim.filter(|_| flags & RETRACT == 0) {
        gimbal.set(aim, camera);
    }
}

/// Returns the pitch of a quaternion; NaN if it is not set.
fn pitch_of(q: [f32; 4]) -> f32 {
    Rotation::<Frd, Ned>::from_wxyz(q.map(f64::from)).map_or(f32::NAN, |attitude| attitude.euler().1 as f32)
}

pub(super) fn gimbal_attitude(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_ATTITUDE_DATA, a: &mut InboundMessage) {
    if let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

/// Handles the device's own message, from senders that have gimbal control.
pub(super) fn gimbal_device(e: &mut Endpoint, m: &GIMBAL_DEVICE_SET_ATTITUDE_DATA, a: &mut InboundMessage) {
    if let Some(gimbal) = gimbal(e, DEVICE, a) {
        move_gimbal(gimbal, u32::from(m.flags.bits()), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

pub(super) fn gimbal_pitch_yaw(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_PITCHYAW_DATA, a: &mut InboundMessage) {
    if let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (m.pitch, m.pitch_rate), a);
    }
}

pub(super) fn gimbal_manual(e: &mut Endpoint, m: &GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA, a: &mut InboundMessage) {
    let camera = &a.view.vehicle.camera;
    let Some(gimbal) = gimbal(e, m.gimbal_device_id, a) else { return };
    if m.flags.bits() & (RETRACT | NEUTRAL) != 0 {
        move_gimbal(gimbal, m.flags.bits(), (f32::NAN, f32::NAN), a);
    } else if m.pitch.is_finite() {
        gimbal.set(GimbalState::deflected(camera, f64::from(m.pitch)), camera);
    } else if m.pitch_rate.is_finite() {
        let rate = f64::from(m.pitch_rate).clamp(-1.0, 1.0) * camera.gimbal_rate_rad_s;
        gimbal.set(GimbalTarget::Rate(rate), camera);
    }
}
