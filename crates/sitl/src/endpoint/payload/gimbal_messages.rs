//! Messages that move the gimbal.

use super::PayloadLink;
use super::gimbal::{BUILTIN_GIMBAL_DEVICE_ID, GimbalState, GimbalTarget};
use super::inbound::PayloadMessage;
use spandrel_mavlink::dialect::{
    GIMBAL_DEVICE_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_ATTITUDE_DATA, GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA,
    GIMBAL_MANAGER_SET_PITCHYAW_DATA,
};
use spandrel_model::frames::{Frd, Ned, Rotation};

/// Returns the gimbal if the sender may move it; `None` for another device or if another client has control.
fn gimbal<'p>(p: &'p mut PayloadLink, device: u8, a: &PayloadMessage) -> Option<&'p mut GimbalState> {
    let gimbal = &mut p.equipment.gimbal;
    (matches!(device, 0 | BUILTIN_GIMBAL_DEVICE_ID) && gimbal.accepts_control_from(a.from)).then_some(gimbal)
}

/// Flags that have the same values for the manager and the device: RETRACT and NEUTRAL (MAVLink common).
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;

/// Applies a pitch angle with an optional rate, or a rate alone, in radians. Out-of-range angles are clamped, as for
/// stick input. This gimbal cannot retract.
fn move_gimbal(gimbal: &mut GimbalState, flags: u32, (pitch_rad, rate_rad_s): (f32, f32), a: &PayloadMessage) {
    let camera = &a.input.vehicle.camera;
    let number = |value: f32| Some(f64::from(value)).filter(|value| value.is_finite());
    let pitch = number(pitch_rad).map(|pitch| pitch.clamp(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad));
    let aim = if flags & NEUTRAL != 0 { Some(GimbalTarget::Neutral) } else { GimbalTarget::of(pitch, number(rate_rad_s)) };
    if let Some(aim) = aim.filter(|_| flags & RETRACT == 0) {
        gimbal.set(aim, camera);
    }
}

/// Returns a quaternion's pitch, or NaN if the quaternion is not set.
fn pitch_of(q: [f32; 4]) -> f32 {
    Rotation::<Frd, Ned>::from_wxyz(q.map(f64::from)).map_or(f32::NAN, |attitude| attitude.euler().1 as f32)
}

pub(super) fn attitude(p: &mut PayloadLink, m: &GIMBAL_MANAGER_SET_ATTITUDE_DATA, a: &mut PayloadMessage) {
    if let Some(gimbal) = gimbal(p, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

/// Handles the gimbal device message from senders that control the gimbal.
pub(super) fn device_attitude(p: &mut PayloadLink, m: &GIMBAL_DEVICE_SET_ATTITUDE_DATA, a: &mut PayloadMessage) {
    if let Some(gimbal) = gimbal(p, BUILTIN_GIMBAL_DEVICE_ID, a) {
        move_gimbal(gimbal, u32::from(m.flags.bits()), (pitch_of(m.q), m.angular_velocity_y), a);
    }
}

pub(super) fn pitch_yaw(p: &mut PayloadLink, m: &GIMBAL_MANAGER_SET_PITCHYAW_DATA, a: &mut PayloadMessage) {
    if let Some(gimbal) = gimbal(p, m.gimbal_device_id, a) {
        move_gimbal(gimbal, m.flags.bits(), (m.pitch, m.pitch_rate), a);
    }
}

pub(super) fn manual_control(p: &mut PayloadLink, m: &GIMBAL_MANAGER_SET_MANUAL_CONTROL_DATA, a: &mut PayloadMessage) {
    let camera = &a.input.vehicle.camera;
    let Some(gimbal) = gimbal(p, m.gimbal_device_id, a) else { return };
    if m.flags.bits() & (RETRACT | NEUTRAL) != 0 {
        move_gimbal(gimbal, m.flags.bits(), (f32::NAN, f32::NAN), a);
    } else if m.pitch.is_finite() {
        gimbal.set(GimbalState::stick_to_angle(camera, f64::from(m.pitch)), camera);
    } else if m.pitch_rate.is_finite() {
        let rate = f64::from(m.pitch_rate).clamp(-1.0, 1.0) * camera.gimbal_rate_rad_s;
        gimbal.set(GimbalTarget::Rate(rate), camera);
    }
}
